//! Do charts and their stores keep what they promise at the ends of what they may be asked?

use std::path::Path;

use corner_impact::flight::State;
use corner_impact::model::Model;
use corner_impact::orbit::Parameter;
use corner_impact::orbit::long_run::{Budget, Kind};
use corner_impact::progress::Unwatched;
use corner_impact::study::chaos::chaos;
use corner_impact::study::chart::store::{CLASSES, Shard, Store, StoreError, VARIABLES, blocks_of, status};
use corner_impact::study::chart::{Blocks, Chart};
use corner_impact::study::survey::Point;
use corner_impact::study::survey::{Axis, OverError, Placed, Start, SurveyError, Values};
use serde_json::{Value, json};

use crate::common;
use crate::orbit_numbers::{machine, model};

pub const START: Start = Start { cam_angle: 0.0, follower: Placed::OnCam(0.0) };

fn axis(model: &Model, name: &str, low: f64, high: f64, count: usize) -> Axis {
    Axis::new(Parameter::named(model, name).unwrap(), &Values::linear(low, high, count))
}

pub fn chart(model: &Model, record: u64) -> Chart {
    let axes = [axis(model, "rpm", 100.0, 180.0, 5), axis(model, "restitution", 0.1, 0.7, 4)];
    Chart::new(model, None, axes, START, Budget { transient: 20, record, ..Budget::CHART }).unwrap()
}

/// Bytes of the checksum at the end of a block.
const CHECKSUM: usize = 4;

/// In blocks of two columns and three rows, of which the last are not whole: what a block lacks is what no point has.
#[test]
fn a_store_of_small_blocks_is_the_chart() {
    let paper = common::osorio();
    let (folder, chart) = (tempfile::TempDir::new().unwrap(), chart(&paper, 8));
    let store = Store::open(folder.path(), &chart, [2, 3]).unwrap();
    assert_eq!(store.blocks(), [3, 2]);
    let filled = |part: Shard| store.fill(part, Some(1), &Unwatched).unwrap();
    let first = filled(Shard { index: 1, of: 4 });
    // Blocks 0 and 4: six points, and one row of two columns.
    assert_eq!((first.blocks, first.points), (Blocks { computed: 2, done: 2, total: 6 }, 8));
    assert_eq!(blocks_of(folder.path()).unwrap(), [true, false, false, false, true, false]);
    let last = filled(Shard { index: 4, of: 4 });
    assert_eq!((last.blocks, last.points), (Blocks { computed: 1, done: 3, total: 6 }, 2));
    assert_eq!(store.fill_block(3, Some(1)).unwrap(), None);
    let all = filled(Shard::ALL);
    assert_eq!((all.blocks, all.points), (Blocks { computed: 3, done: 6, total: 6 }, 6 + 3 + 1));
    assert_eq!(status(folder.path()).unwrap(), Blocks { computed: 0, done: 6, total: 6 });
    let document = serde_json::to_value(&all).unwrap();
    assert_eq!(document["revolutions"], 10 * 28);
    assert!(matches!(store.fill_block(6, None), Err(StoreError::NoBlock { block: 6, total: 6 })));
    let points = chart.clone().run(Some(1), &Unwatched).unwrap();
    for variable in &VARIABLES {
        for block in 0..6 {
            let (column, row) = (block % 3, block / 3);
            let bytes = std::fs::read(folder.path().join(variable.name).join(format!("c/{row}/{column}"))).unwrap();
            let size = variable.whole.unwrap_or(8);
            assert_eq!(bytes.len(), 6 * size + CHECKSUM);
            for (index, bytes) in bytes[..6 * size].chunks(size).enumerate() {
                let number = match bytes {
                    [byte] => f64::from(*byte as i8),
                    bytes if size == 4 => f64::from(i32::from_le_bytes(bytes.try_into().unwrap())),
                    bytes => f64::from_le_bytes(bytes.try_into().unwrap()),
                };
                let [x, y] = [column * 2 + index % 2, row * 3 + index / 2];
                let fill = if variable.whole.is_some() { -1.0 } else { f64::NAN };
                let expected = if x < 5 && y < 4 { variable.of(&points.points[y * 5 + x]) } else { fill };
                assert!(number == expected || number.is_nan() && expected.is_nan(), "{} {x} {y}", variable.name);
            }
        }
    }
    for sides in [[0, 1], [1, 0], [1 << 13, (1 << 11) + 1]] {
        let [columns, rows] = sides;
        let refused = Store::open(folder.path(), &chart, sides).map(|_| ()).unwrap_err();
        assert!(
            matches!(refused, StoreError::Sides { columns: c, rows: r, most } if [c, r, most] == [columns, rows, 1 << 24])
        );
    }
}

/// The class says that a point failed, the other arrays have there what no point has; and only of classes there are names.
#[test]
fn a_point_that_failed_is_none_in_any_array() {
    let failed = Err("no cam turns at it".to_string());
    let told: Vec<f64> = VARIABLES.iter().map(|variable| variable.of(&failed)).collect();
    assert_eq!(told[..2], [-1.0, -1.0]);
    assert!(told[2..6].iter().all(|value| value.is_nan()), "{told:?}");
    let units = common::osorio().units;
    for (variable, value) in VARIABLES.iter().zip(told) {
        let attributes = &variable.document(&units)["attributes"];
        let names = attributes["flag_meanings"].as_str().map(|names| names.split(' ').count());
        let is_class = variable.name == "class";
        assert_eq!(names, is_class.then_some(CLASSES.len()), "{}", variable.name);
        assert!(!is_class || CLASSES[value as usize].is_none() && attributes["flag_values"][value as usize] == value);
    }
}

/// What stands where a store's own description is to be, and cannot be read, is not written over; and the times of blocks are added up.
#[test]
fn a_store_that_cannot_be_read_is_not_begun_anew() {
    let (folder, chart) = (tempfile::TempDir::new().unwrap(), chart(&common::osorio(), 8));
    std::fs::create_dir(folder.path().join("zarr.json")).unwrap();
    let refused = Store::open(folder.path(), &chart, [2, 3]).map(|_| ()).unwrap_err();
    assert!(matches!(&refused, StoreError::None { .. }), "{refused}");
    std::fs::remove_dir(folder.path().join("zarr.json")).unwrap();
    let store = Store::open(folder.path(), &chart, [2, 3]).unwrap();
    assert!(store.fill_block(0, Some(1)).unwrap().unwrap().1[1] > 0.0);
}

/// Processors count in hundredths of a second: of blocks that take several each, the times are added up.
#[test]
fn the_times_of_blocks_are_added_up() {
    let paper = common::osorio();
    let axes = [axis(&paper, "rpm", 670.0, 671.0, 4), axis(&paper, "restitution", 0.8, 0.801, 2)];
    let chart =
        Chart::new(&paper, None, axes, START, Budget { transient: 60_000, record: 10, ..Budget::CHART }).unwrap();
    let folder = tempfile::TempDir::new().unwrap();
    let store = Store::open(folder.path(), &chart, [2, 2]).unwrap();
    let [processor, clock] = store.fill(Shard::ALL, Some(1), &Unwatched).unwrap().times;
    assert!(processor > 0.02 && clock > 0.02 && processor < 1.5 * clock + 0.1, "{processor} {clock}");
}

/// By the first thing that is another; and what is no store is told from one.
#[test]
fn another_chart_is_told_by_what_is_another() {
    let paper = common::osorio();
    let (folder, own) = (tempfile::TempDir::new().unwrap(), chart(&paper, 8));
    let at = folder.path();
    Store::open(at, &own, [2, 3]).unwrap();
    let refused = |chart: &Chart, sides: [usize; 2]| Store::open(at, chart, sides).map(|_| ()).unwrap_err().to_string();
    let says = |chart: &Chart, sides: [usize; 2], how: &str| {
        assert_eq!(refused(chart, sides), format!("{}: holds another chart: {how}", at.display()));
    };
    says(&own, [3, 2], "its number of rows and columns of a block is [3,2], and not [2,3]");
    says(&chart(&paper, 9), [2, 3], "its record is 8, and not 9");
    let mut longer = own.clone();
    longer.budget.transient = 21;
    says(&longer, [2, 3], "its transient is 20, and not 21");
    let mut elsewhere = own.clone();
    elsewhere.start = Start { cam_angle: 1.0, follower: Placed::At(State { position: 2.0, velocity: 3.0 }) };
    let start = "its start is {\"cam_angle_rad\":0.0,\"relative_velocity_m_s\":0.0}, and not {\"cam_angle_rad\":1.0,\"position_m\":2.0,\"velocity_m_s\":3.0}";
    says(&elsewhere, [2, 3], start);
    let mut heavier = paper.with_number("follower.mass", 2.0).unwrap();
    heavier.name.clone_from(&paper.name);
    says(&chart(&heavier, 8), [2, 3], "numbers of its model differ");
    let mut other = own.clone();
    other.y.values = [0.1, 0.3, 0.5, 0.8].into();
    says(&other, [2, 3], "other values of follower.restitution");
    let mut other = own.clone();
    other.x.values = [100.0, 120.0, 140.0, 160.0, 180.1].into();
    says(&other, [2, 3], "other values of rpm");
    let group = at.join("zarr.json");
    let text = std::fs::read_to_string(&group).unwrap();
    std::fs::write(&group, text.replace("kind of motion", "kind of rest")).unwrap();
    says(&own, [2, 3], "the description of its arrays differs");
    let document = |change: &dyn Fn(&mut Value)| {
        let mut document: Value = serde_json::from_str(&text).unwrap();
        change(&mut document["consolidated_metadata"]["metadata"]["class"]);
        std::fs::write(&group, document.to_string()).unwrap();
        blocks_of(at).map_err(|error| error.to_string())
    };
    assert_eq!(document(&|_| ()).unwrap().len(), 6);
    for broken in [
        &|class: &mut Value| class["shape"] = json!([4]),
        &|class: &mut Value| class["shape"] = json!([0, 5]),
        &|class: &mut Value| class["chunk_grid"]["configuration"]["chunk_shape"] = json!([3, 0]),
        &|class: &mut Value| *class = json!({}),
    ] as [&dyn Fn(&mut Value); 4]
    {
        assert_eq!(document(broken), Err(format!("{}: holds no store of a chart: it has no classes", at.display())));
    }
    std::fs::write(&group, "{").unwrap();
    for said in [refused(&own, [2, 3]), blocks_of(at).unwrap_err().to_string(), status(at).unwrap_err().to_string()] {
        assert!(said.contains("no store of a chart: EOF"), "{said}");
    }
    assert!(matches!(status(Path::new("nowhere.zarr")), Err(StoreError::None { .. })));
}

#[test]
fn charts_that_cannot_be_are_refused_and_speeds_that_cannot_are_points() {
    let paper = common::osorio();
    let budget = Budget { transient: 20, record: 8, ..Budget::CHART };
    let new = |rpm, axes: [Axis; 2]| Chart::new(&paper, rpm, axes, START, budget);
    let (speed, mass) = (axis(&paper, "rpm", 100.0, 180.0, 3), axis(&paper, "mass", 1.0, 2.0, 2));
    let damping = axis(&paper, "damping", 0.0, 1.0, 2);
    let told = |found: Result<Chart, SurveyError>| found.map(|_| ()).unwrap_err();
    assert_eq!(told(new(None, [speed.clone(), speed.clone()])), SurveyError::OneNumber("rpm".into()));
    assert_eq!(told(new(None, [damping.clone(), mass.clone()])), SurveyError::Over(OverError::NoSpeed(None)));
    assert_eq!(told(new(Some(700.0), [speed.clone(), mass.clone()])), SurveyError::Over(OverError::TwoSpeeds));
    let none = Axis { values: [].into(), ..mass.clone() };
    assert_eq!(told(new(None, [speed.clone(), none.clone()])), SurveyError::Points { points: 0 });
    assert!(none.ends().iter().all(|end| end.is_nan()) && speed.ends() == [100.0, 180.0]);
    let found = new(Some(150.0), [damping.clone(), mass.clone()]).unwrap();
    assert_eq!(found.speed(), Some(150.0));
    let odd = Axis { values: [-3.0, 0.0, f64::INFINITY, 150.0, 120.0].into(), ..speed.clone() };
    for axes in [[odd.clone(), mass.clone()], [mass.clone(), odd.clone()]] {
        let found = new(None, axes).unwrap();
        assert_eq!(found.speed(), None);
        let is_across = found.x.parameter == Parameter::Speed;
        let all = found.run(Some(1), &Unwatched).unwrap();
        let kind = |speed: usize, mass: usize| {
            let index = if is_across { mass * 5 + speed } else { speed * 2 + mass };
            all.points[index].as_ref().ok().map(|it| it.kind)
        };
        assert_eq!([0, 1, 2].map(|speed| kind(speed, 0)), [None; 3]);
        assert_eq!([3, 4].map(|speed| kind(speed, 1)), [Some(Kind::Resting); 2]);
        assert_eq!(all.counts(), [(Some(Kind::Stays), 1), (Some(Kind::Resting), 3), (None, 6)]);
        assert!(all.failure().is_some());
    }
}

/// A ball that nothing draws to the cam leaves it, and what flies on is not chaos however two of them part.
#[test]
fn what_flies_off_for_good_is_not_chaotic() {
    let text = "[follower]\nmass = 1\ndamping = 0\nstiffness = 0\ngravity = -1\nrest_position = 0\nrestitution = 0.5\n[cam]\n\
                law = \"harmonic\"\noffset = 0.0\namplitudes = [0.01]\nphases_deg = [0.0]\n";
    let away = Model::parse("away.toml", text).unwrap();
    let machine = machine(&away, 100.0);
    let start = Start { cam_angle: 1.0, follower: Placed::OnCam(0.1) };
    let found = Point::of(&machine, start.motion(&machine).unwrap(), Budget::CHART).unwrap();
    assert_eq!((found.kind, found.impacts, found.impact_rate, found.impact_speed), (Kind::Undecided, 0, 0.0, 0.0));
    // Of one cam of one law nothing is taken for granted but its numbers; of one of several that they meet.
    let hypotheses = |model: &Model, rpm: f64| chaos(model, [rpm; 2], false, &Unwatched).unwrap().hypotheses.len();
    assert_eq!([hypotheses(&away, 100.0), hypotheses(&model("laws/polynomial"), 700.0)], [1, 2]);
}

/// Of a motion that repeats after several revolutions, a revolution has its part of the impacts and of the growth: that of the distance of
/// two runs.
#[test]
fn what_repeats_after_several_revolutions_is_told_for_one() {
    let machine = machine(&common::osorio().with_number("follower.restitution", 0.3).unwrap(), 558.6440677966102);
    let found = Point::of(&machine, START.motion(&machine).unwrap(), Budget::CHART).unwrap();
    assert_eq!((found.kind, found.revolutions, found.impacts), (Kind::Periodic, 7, 15));
    assert_eq!(found.impact_rate, 15.0 / 7.0);
    let mut motion = START.motion(&machine).unwrap();
    machine.revolve(&mut motion, 7000).unwrap();
    let after = |off: f64| {
        let mut motion = motion;
        motion.state.position += off;
        machine.revolve(&mut motion, 140).unwrap();
        motion.state
    };
    const OFF: f64 = 1e-7;
    let [near, far] =
        [after(0.0), after(OFF)].map(|state| [state.position, state.velocity / machine.angular_velocity()]);
    let shrunk = (near[0] - far[0]).hypot(near[1] - far[1]) / OFF;
    // What is lost or won by the direction that the runs are apart in is the same after any number of revolutions.
    assert!(
        (shrunk.ln() / 140.0 - found.growth.value).abs() < 0.3 * found.growth.value.abs(),
        "{shrunk} {:?}",
        found.growth
    );
}

/// A store is described twice, whole and array by array, with the unit of the one axis that has one.
#[test]
fn a_store_is_described_alike_as_a_whole_and_by_its_arrays() {
    let paper = common::osorio();
    let (folder, chart) = (tempfile::TempDir::new().unwrap(), chart(&paper, 8));
    Store::open(folder.path(), &chart, [2, 3]).unwrap().fill(Shard::ALL, Some(1), &Unwatched).unwrap();
    let read = |path: &str| -> Value {
        serde_json::from_slice(&std::fs::read(folder.path().join(path).join("zarr.json")).unwrap()).unwrap()
    };
    let whole = read("");
    let arrays = whole["consolidated_metadata"]["metadata"].as_object().unwrap();
    assert_eq!(arrays.len(), VARIABLES.len() + 2);
    for (name, described) in arrays {
        assert_eq!(read(name), *described, "{name}");
    }
    let units = [&chart.x, &chart.y].map(|axis| arrays[axis.parameter.name()]["attributes"].clone());
    assert_eq!(units, [json!({ "units": "rpm" }), json!({})]);
}

/// Threads that share processors wait for each other: no more seconds of processors are told than there are processors.
#[test]
#[cfg(target_os = "linux")]
fn seconds_of_threads_are_those_of_processors() {
    let paper = common::osorio();
    let axes = [axis(&paper, "rpm", 600.0, 700.0, 10), axis(&paper, "restitution", 0.1, 0.7, 64)];
    let chart = Chart::new(&paper, None, axes, START, Budget { transient: 50, record: 50, ..Budget::CHART }).unwrap();
    let processors = std::thread::available_parallelism().unwrap().get();
    let [processor, clock] = chart.run(Some(8 * processors), &Unwatched).unwrap().times;
    assert!(processor > 0.0 && processor < 1.2 * processors as f64 * clock, "{processor} {clock}");
}

/// The revolutions that a chart tells are the sum over its points.
#[test]
fn runs_of_a_chart_are_followed_for_the_sum_of_its_points() {
    let found = chart(&common::osorio(), 8).run(Some(1), &Unwatched).unwrap();
    let sum: u64 = found.points.iter().flatten().map(|point| point.followed).sum();
    assert_eq!((found.points.len(), found.followed()), (20, sum));
    assert!(sum >= 20, "{sum}");
    assert_eq!(serde_json::to_value(&found).unwrap()["followed"], sum);
}
