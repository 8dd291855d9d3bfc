//! The global picture: are the basins' borders the saddle's stable manifold, where is the chaotic motion lost, how does the
//! motion leave a place without an orbit?

use crate::common;
use corner_impact::border_collision::{LocalMap, passage};
use corner_impact::corner::variational::border as border_of_the_map;
use corner_impact::corner::{range, variational};
use corner_impact::flight::State;
use corner_impact::model::{Model, Study};
use corner_impact::orbit::long_run::{Budget, LongRun};
use corner_impact::orbit::{Course, Search, search};
use corner_impact::progress::Unwatched;
use corner_impact::section::StroboscopicMap;
use corner_impact::simulate::{Machine, Motion, angular_velocity};
use corner_impact::simulate::{Record, growth};
use corner_impact::study::basins::boundary::{approach, border};
use corner_impact::study::basins::{Curve, Extent, Grid, Reversed, Saddle, SectionStarts};
use corner_impact::study::survey::long_run;
use corner_impact::study::verify::{External, verify};

/// A budget within which runs are told that are not waited for.
const SOON: Budget = Budget { patience: 0, ..Budget::SURVEY };

/// Half a revolution from P.
pub const SECTION: f64 = 5.762717154756;
const EXTENT: Extent = Extent { stretches: 27, first: 1e-6, finest: 0.01, farthest: 2.0 };

fn map(model: &Model, rpm: f64) -> StroboscopicMap {
    let machine = Machine::new(common::cam(model), &model.follower, angular_velocity(rpm));
    StroboscopicMap { machine, cam_angle: SECTION }
}

/// The saddle of one impact, where there is one.
pub fn saddle(map: &StroboscopicMap) -> Saddle {
    let orbits = search(&map.machine, &Search { revolutions: 1, impacts: Some(1) }).unwrap();
    let of = |orbit: &corner_impact::orbit::PeriodicOrbit| match &orbit.course {
        Course::Impacts(cycle) => Saddle::new(&map.machine, cycle, map.cam_angle),
        _ => None,
    };
    orbits.iter().find_map(of).unwrap()
}

fn towards_the_cam(direction: f64) -> f64 {
    -direction.signum()
}

/// Run backwards and forwards again, states of a chaotic motion come back; on another cam there is no run backwards.
#[test]
fn a_run_backwards_undoes_a_revolution() {
    let model = common::osorio();
    let map = map(&model, 678.0);
    let reversed = Reversed::new(&model.follower, &map).unwrap();
    let mut state = State { position: 0.9, velocity: -12.0 };
    let mut undone = 0;
    for _ in 0..200 {
        let next = map.apply(state).unwrap();
        // Deviations grow sixfold or so backwards through each of several impacts.
        if let Some(before) = reversed.apply(next.state) {
            assert!((before.position - state.position).abs() < 1e-9, "{before:?} {state:?}");
            assert!((before.velocity - state.velocity).abs() < 1e-7, "{before:?} {state:?}");
            undone += 1;
        }
        state = next.state;
    }
    assert!(undone > 150, "{undone}");
    let without_mirror = common::read(std::path::Path::new("models/laws/program.toml"));
    let other = StroboscopicMap {
        machine: Machine::new(common::cam(&without_mirror), &without_mirror.follower, 50.0),
        cam_angle: 0.0,
    };
    assert!(Reversed::new(&without_mirror.follower, &other).is_none());
}

/// The stable manifold, grown by runs backwards from the saddle, against the border, found by halving between runs forwards.
#[test]
fn the_border_of_the_basins_is_the_saddles_stable_manifold() {
    let model = common::osorio();
    let map = map(&model, 678.0);
    let saddle = saddle(&map);
    let reversed = Reversed::new(&model.follower, &map).unwrap();
    let curves = [1.0, -1.0].map(|sign| Curve::stable(&reversed, &saddle, sign, &EXTENT));
    let mut distances = Vec::new();
    for velocity in [-30.0, -24.0, -18.0, -12.0, -6.0, 0.0, 4.0] {
        let line = [0.6, 6.0].map(|position| State { position, velocity });
        let found = border(&map, line, SOON).unwrap().unwrap();
        distances.push(curves.iter().map(|curve| curve.distance(found)).fold(f64::INFINITY, f64::min));
    }
    let farthest = distances.iter().copied().fold(0.0, f64::max);
    assert!(farthest < 1e-5, "{distances:?}");
    // The curve is long, and not the distance from everything small.
    assert!(curves[0].distance(State { position: 1.0, velocity: -10.0 }) > 0.1);
}

/// Points of the stable manifold come to the saddle, those of the unstable one came from it.
#[test]
fn manifolds_are_invariant() {
    let model = common::osorio();
    let map = map(&model, 678.0);
    let saddle = saddle(&map);
    let near = |state: State| (state.position - saddle.state.position).abs() < 1e-3;
    let reversed = Reversed::new(&model.follower, &map).unwrap();
    let sign = towards_the_cam(saddle.stable.1[0]);
    let stable = Curve::stable(&reversed, &saddle, sign, &EXTENT);
    let far: Vec<State> = stable.points().filter(|state| state.position < 2.0).step_by(20).collect();
    assert!(far.len() > 10, "{}", far.len());
    for mut state in far {
        let arrives = (0..40).any(|_| {
            state = map.apply(state).unwrap().state;
            near(state)
        });
        assert!(arrives, "{state:?}");
    }
    let extent = Extent { stretches: 125, ..EXTENT };
    let sign = towards_the_cam(saddle.unstable.1[0]);
    let unstable = Curve::unstable(&map, &saddle, sign, &extent);
    let between = |state: &State| (0.05..0.3).contains(&(saddle.state.position - state.position));
    let far: Vec<State> = unstable.points().filter(between).collect();
    assert!(far.len() > 5, "{}", far.len());
    for mut state in far {
        // Backwards the other direction grows by 1.7 a revolution: rounding is 1e-6 m after 45.
        let came = (0..45).any(|_| {
            state = reversed.apply(state).unwrap();
            (state.position - saddle.state.position).abs() < 5e-3
        });
        assert!(came, "{state:?}");
    }
}

/// Starts are a hundred-thousandth of the way off and run until they have gone it; what they pass in so many revolutions more counts.
#[test]
fn what_leaves_a_saddle_is_as_far_as_it_has_grown() {
    let paper = common::osorio();
    let map = map(&paper, 678.0);
    let saddle = saddle(&map);
    let (multiplier, along) = saddle.unstable;
    let extent = Extent { stretches: 1, first: 1e-6, finest: 1.0, farthest: 1.0 };
    let mut curve = Curve::unstable(&map, &saddle, 1.0, &extent);
    // The nearest to the saddle itself is the start that was the nearest, after the first revolution that counts.
    curve.pieces = vec![vec![saddle.state]];
    let away = 1e-3;
    let leaving = (1e5_f64.ln() / multiplier.ln()).ceil();
    for sign in [1.0, -1.0] {
        let found = approach(&map, &saddle, sign, &curve, away, [4, 2]).unwrap();
        // The map is as good as linear over so short a way.
        approx::assert_relative_eq!(found.distance, 1e-5 * away * multiplier.powf(leaving + 1.0), max_relative = 0.02);
        let off = (found.nearest.position - saddle.state.position) * sign * along[0];
        assert!(off > 0.0, "{found:?}");
    }
}

/// The border is on the line that it is looked for on, where position and velocity change.
#[test]
fn the_border_is_on_the_line_between_two_starts() {
    let map = map(&common::osorio(), 678.0);
    let line = [(0.6, -24.0), (6.0, 4.0)].map(|(position, velocity)| State { position, velocity });
    let found = border(&map, line, SOON).unwrap().unwrap();
    let share = (found.position - 0.6) / 5.4;
    assert!(share > 0.0 && share < 1.0, "{found:?}");
    approx::assert_abs_diff_eq!(found.velocity, -24.0 + 28.0 * share, epsilon = 1e-9);
}

/// With rising speed the unstable manifold comes nearer to the stable one, and touches it between 682.2 and 682.22 rpm.
#[test]
#[ignore = "slow"]
fn the_chaotic_motion_is_lost_where_the_manifolds_touch() {
    let model = common::osorio();
    let distance = |rpm: f64| {
        let map = map(&model, rpm);
        let saddle = saddle(&map);
        let reversed = Reversed::new(&model.follower, &map).unwrap();
        let sign = towards_the_cam(saddle.stable.1[0]);
        let curve = Curve::stable(&reversed, &saddle, sign, &Extent { stretches: 24, ..EXTENT });
        let sign = towards_the_cam(saddle.unstable.1[0]);
        approach(&map, &saddle, sign, &curve, 0.3, [1000, 40]).unwrap().distance
    };
    let [far, near] = [682.0, 682.18].map(distance);
    assert!((far - 3.8e-3).abs() < 2e-4 && (near - 4.6e-4).abs() < 1e-4, "{far} {near}");
    let zero = 682.18 + near * 0.18 / (far - near);
    assert!((682.2..682.22).contains(&zero), "{zero}");
}

/// Each start is judged by itself: the same on one thread and on three, and as a run of its own.
#[test]
fn basins_do_not_depend_on_threads() {
    let map = map(&common::osorio(), 678.0);
    let grid = Grid { cam_angle: SECTION, positions: [0.0, 6.0], velocities: [-60.0, 60.0], cells: [16, 9] };
    let one = SectionStarts::Grid(grid).basins(&map.machine, Budget::SURVEY, Some(1), &Unwatched).unwrap();
    assert_eq!(one, SectionStarts::Grid(grid).basins(&map.machine, Budget::SURVEY, Some(3), &Unwatched).unwrap());
    let LongRun::Orbit(orbit) = &one.parts[0].ending else { panic!("{:?}", one.parts) };
    assert!(orbit.is_stable() && orbit.impacts().count() == 1 && orbit.revolutions == 1);
    assert!(matches!(one.parts[1].ending, LongRun::Chaotic(_)), "{:?}", one.parts[1]);
    let share = one.parts[0].share;
    assert!((share.value - 0.6).abs() < 0.1, "{share:?}");
    let starts = one.starts as f64;
    let drawn = (share.value * (1.0 - share.value) / starts).sqrt();
    assert!((share.error / drawn - 1.0).abs() < 1.0 / starts, "{share:?}");
    // The first column, at 0.19 m, is below the cam.
    assert!(one.cells.iter().filter(|cell| cell.is_none()).count() == 9, "{:?}", one.cells);
    assert_eq!(one.starts, 15 * 9);
    for cell in [20, 77, 140] {
        let motion = map.machine.start(SECTION, grid.start(cell));
        let part = motion.ok().map(|motion| long_run(&map.machine, motion, SOON).unwrap().ending);
        let found = one.cells[cell].map(|part| &one.parts[part].ending);
        assert!(found.zip(part.as_ref()).is_some_and(|(one, two)| one.is_same(two)), "{cell}");
    }
}

/// Below the corner impact, by the piecewise-linear map and by runs.
#[test]
fn the_motion_leaves_logarithmically() {
    let model = common::osorio();
    let findings = verify(&model, External::LeftOut).unwrap();
    let local = LocalMap::new(&findings.map, findings.border);
    let decade = passage::revolutions_per_decade(&local).unwrap();
    // ln 10/ln 1.00514740546535501
    assert!((decade - 448.4796).abs() < 1e-3, "{decade}");
    let mut before = None;
    for below in [1e-3, 1e-5, 1e-6, 1e-7, 1e-8] {
        let rpm = findings.at.speed_rpm() - below;
        let dt = 60.0 / rpm - findings.at.period;
        let linear = passage::linear(&local, dt, 1e-3, 10_000).unwrap();
        let machine = Machine::new(common::cam(&model), &model.follower, angular_velocity(rpm));
        let map = StroboscopicMap { machine, cam_angle: findings.at.section_angle() };
        let run = passage::simulated(&map, findings.at.state, 1e-3, 10_000).unwrap().unwrap();
        assert!(linear.abs_diff(run) <= 1, "{below:e}: {linear} {run}");
        if let Some(before) = before.filter(|_| below < 1e-5) {
            // A root would make it a factor of 3.2.
            assert!(((run - before) as f64 - decade).abs() < 10.0, "{below:e}: {run} after {before}");
        }
        before = Some(run);
    }
    // Above it there is an orbit, and nothing leaves.
    let dt = 60.0 / (findings.at.speed_rpm() + 1e-5) - findings.at.period;
    assert_eq!(passage::linear(&local, dt, 1e-3, 10_000), None);
}

/// Where the impact falls is told by the flight to it: at this corner the acceleration jumps upwards, and the impact is before
/// the corner where `C dx + D dT` is below 0, not after it as at the paper's.
#[test]
#[ignore = "slow"]
fn the_motion_leaves_where_the_acceleration_jumps_upwards() {
    let model = common::osorio();
    let cam = common::cam(&model);
    let range = Study { rpm_min: 276.0, rpm_max: 295.0 };
    let found = range::find_corner_impacts(&model, &cam, range, 1, &Unwatched).unwrap().found;
    let at = found.iter().find(|at| (at.speed_rpm() - 277.022185).abs() < 1e-6).unwrap();
    let corner_map = variational::route(&model, &cam, at).map;
    let local = LocalMap::new(&corner_map, border_of_the_map(&model, &cam, at));
    assert!((corner_map.c() * local.border.0.transpose())[0] > 0.0, "{local:?}");
    let swapped = LocalMap { minus: local.plus, plus: local.minus, ..local };
    let mut differs = false;
    for off in [-1e-6, 1e-6, -1e-7, 1e-7] {
        let rpm = at.speed_rpm() + off;
        let machine = Machine::new(cam.clone(), &model.follower, angular_velocity(rpm));
        let map = StroboscopicMap { machine, cam_angle: at.section_angle() };
        let dt = 60.0 / rpm - at.period;
        let run = passage::simulated(&map, at.state, 1e-4, 1000).unwrap();
        assert_eq!(passage::linear(&local, dt, 1e-4, 1000), run, "{off:e}");
        differs |= passage::linear(&swapped, dt, 1e-4, 1000) != run;
    }
    assert!(differs);
}

/// The mean of the blocks is the mean of all, and four times as many blocks halve the error.
#[test]
fn exponents_have_errors() {
    let map = map(&common::osorio(), 672.0);
    let start = map.machine.start_on_cam(0.0, 0.0).unwrap();
    let taken = |machine: &Machine, mut motion: Motion, blocks: u64| {
        let mut record = Record::over(200);
        // In parts, each from where the one before was left.
        for _ in 0..2 {
            record.take(machine, &mut motion, 100 * blocks).unwrap();
        }
        assert!(!record.rests());
        record
    };
    let few = taken(&map.machine, start, 10);
    let [first, second] = few.halves();
    let few = few.growth();
    assert!((few.value - growth(&map.machine, start, 2000).unwrap()).abs() < 1e-12, "{few:?}");
    assert!((first + second - 2000.0 * few.value).abs() < 1e-9 && first != second, "{first} {second}");
    let many = taken(&map.machine, start, 160).growth();
    println!("{few:?} {many:?}");
    let sixteenth = many.error / few.error;
    assert!((0.1..0.6).contains(&sixteenth), "{few:?} {many:?}");
    assert!((many.value - few.value).abs() < 4.0 * few.error, "{few:?} {many:?}");
    // On the periodic orbit every block is ln r.
    let periodic = self::map(&common::osorio(), 680.0);
    let orbit = periodic.machine.start(SECTION, State { position: 4.2629536, velocity: 2.3242428 }).unwrap();
    let exact = taken(&periodic.machine, orbit, 10).growth();
    assert!((exact.value - 0.8f64.ln()).abs() < 1e-2 && exact.error < 1e-2, "{exact:?}");
}

#[test]
fn the_command_keeps_its_columns_and_fields() {
    let run = |more: &[&str]| {
        let arguments = ["basins", "models/osorio-2008.toml", "--rpm", "678", "--strobe", "5.762717154756"];
        common::program(arguments).args(more).output().unwrap()
    };
    let table = run(&["--grid", "4x3", "--position", "0.3:6", "--velocity=-60:60", "--out", "-"]);
    assert_eq!(table.status.code(), Some(0), "{}", String::from_utf8_lossy(&table.stderr));
    let table = String::from_utf8(table.stdout).unwrap();
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines[0], "position_m,velocity_m_s,ending,part,revolutions,impacts,followed");
    assert_eq!(lines.len(), 13);
    assert!(lines[1].starts_with("1.0125,-40,chaotic,1,,"), "{table}");
    assert!(lines[2].starts_with("2.4375,-40,"), "{table}");
    assert!(lines[8].starts_with("5.2875,0,periodic,0,1,1,"), "{table}");
    let summary = run(&["--grid", "4x3", "--position", "0.3:6", "--velocity=-60:60", "--summary"]);
    let summary: serde_json::Value = serde_json::from_slice(&summary.stdout).unwrap();
    assert_eq!(summary["schema"], "corner-impact/basins/1");
    let shares: f64 = summary["endings"].as_array().unwrap().iter().map(|e| e["share"].as_f64().unwrap()).sum();
    assert!((shares - 1.0).abs() < 1e-12, "{summary}");
    for wrong in [&["--grid", "0x3"][..], &["--grid", "4"], &["--grid", "4x3", "--position", "2:1"]] {
        let output = run(wrong);
        assert_eq!(output.status.code(), Some(2), "{wrong:?}");
        assert!(output.stdout.is_empty() && !output.stderr.is_empty(), "{wrong:?}");
    }
}
