//! Does a survey go over every value once, in order, with the machine of that value, and are the rows of a sweep all there and counted, on however
//! many threads?

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use approx::assert_relative_eq;
use corner_impact::model::Model;
use corner_impact::orbit::Parameter;
use corner_impact::progress::{Unwatched, Watch};
use corner_impact::simulate::{Event, EventKind, Machine, Motion, angular_velocity};
use corner_impact::study::diagram::Swept;
use corner_impact::study::survey::{
    Axis, Beginning, Counted, Over, Place, Places, RecordBlock, RecordRow, Sample, Section as Shows, Seen, Spacing,
    Survey, SurveyError, Sweep, SweepError, SweepStart, SweepTally, Values, settled_impacts,
};

use crate::chart_store::START;
use crate::common;
use crate::orbit_numbers::machine;
use crate::study_findings::sweep;

fn axis(name: &str, low: f64, high: f64, count: usize) -> Axis {
    Axis::new(Parameter::named(&common::osorio(), name).unwrap(), &Values::linear(low, high, count))
}

/// Rows as they come, in blocks of so many; with `GOES_ON` over values that cannot be run.
#[derive(Debug, Default)]
struct Kept<const SIZE: usize, const GOES_ON: bool = false> {
    rows: Vec<RecordRow>,
    failed: Vec<f64>,
}

impl<const SIZE: usize, const GOES_ON: bool> RecordBlock for Kept<SIZE, GOES_ON> {
    fn push(&mut self, row: &RecordRow) {
        self.rows.push(*row);
    }

    fn is_full(&self) -> bool {
        self.rows.len() >= SIZE
    }

    fn fail(&mut self, value: f64) -> bool {
        self.failed.push(value);
        GOES_ON
    }
}

/// All that a sweep hands on, and its tally.
fn taken<B: RecordBlock>(sweep: &Sweep, threads: usize) -> (Vec<(usize, B)>, SweepTally) {
    let mut all = Vec::new();
    let tally = sweep.run(Some(threads), |index, block| {
        all.push((index, block));
        Ok::<(), SweepError>(())
    });
    (all, tally.unwrap())
}

/// The rows of one value by a run of its own, and where it ends.
fn alone(sweep: &Sweep, model: &Model, rpm: f64, from: Option<Motion>) -> (Vec<RecordRow>, Motion) {
    let machine = machine(model, rpm);
    let mut motion = from.map_or_else(|| START.motion(&machine), |motion| machine.resume(&motion)).unwrap();
    machine.revolve(&mut motion, sweep.transient).unwrap();
    let mut rows = Vec::new();
    let row = |event: &Event| RecordRow {
        value: rpm,
        revolution: event.revolution,
        motion: None,
        seen: Seen::Event(*event),
        growth: None,
    };
    machine.watch(&mut motion, sweep.record, |event| rows.push(row(event))).unwrap();
    (rows, motion)
}

fn tally(rows: &[RecordRow], revolutions: u64) -> SweepTally {
    let is_impact = |row: &&RecordRow| matches!(row.seen, Seen::Event(event) if event.kind == EventKind::Impact);
    SweepTally { points: rows.len() as u64, impacts: rows.iter().filter(is_impact).count() as u64, revolutions }
}

/// Each value is a run of its own. Its rows come after those of the value before, whatever the threads and the blocks, and all are counted.
#[test]
fn rows_come_by_value_on_any_number_of_threads() {
    fn rows<const SIZE: usize>(sweep: &Sweep, threads: usize, expected: &[RecordRow]) {
        let (blocks, counted) = taken::<Kept<SIZE>>(sweep, threads);
        assert!(blocks.is_sorted_by_key(|(index, _)| *index));
        for (index, block) in &blocks {
            assert!(block.rows.iter().all(|row| row.value == sweep.over.value(*index)));
            assert!(block.rows.len() <= SIZE && block.failed.is_empty());
        }
        let found: Vec<RecordRow> = blocks.into_iter().flat_map(|(_, block)| block.rows).collect();
        assert!(found == expected, "{threads} threads, blocks of {SIZE}");
        assert_eq!(counted, tally(expected, 80 * 23));
    }
    let paper = common::osorio();
    // From runs that rest on the cam, of which some events are no impacts, to runs that fly.
    let all = sweep(&paper, 150.0, 750.0, 80, Shows::Impacts);
    let expected: Vec<RecordRow> =
        (0..80).flat_map(|index| alone(&all, &paper, all.over.value(index), None).0).collect();
    assert!(tally(&expected, 0).impacts < expected.len() as u64);
    for threads in 1..=3 {
        rows::<1>(&all, threads, &expected);
        rows::<7>(&all, threads, &expected);
        // After the rows of each value there is a block that says that they are all.
        let (blocks, counted) = taken::<Counted>(&all, threads);
        let indices: Vec<usize> = blocks.into_iter().map(|(index, _)| index).collect();
        assert_eq!(indices, (0..80).flat_map(|index| [index; 2]).collect::<Vec<_>>());
        assert_eq!(counted, tally(&expected, 80 * 23));
    }
}

/// What is followed goes from value to value, upwards or downwards, each from where the one before ended.
#[test]
fn a_value_that_is_followed_begins_where_its_neighbour_ended() {
    let paper = common::osorio();
    for following in [SweepStart::Up, SweepStart::Down] {
        let followed = Sweep { following, ..sweep(&paper, 660.0, 700.0, 9, Shows::Impacts) };
        let mut order: Vec<usize> = (0..9).collect();
        if following == SweepStart::Down {
            order.reverse();
        }
        let (mut expected, mut from) = (Vec::new(), None);
        for index in &order {
            let (rows, motion) = alone(&followed, &paper, followed.over.value(*index), from);
            (expected, from) = ([expected, rows].concat(), Some(motion));
        }
        let (blocks, counted) = taken::<Kept<3>>(&followed, 2);
        let mut indices: Vec<usize> = blocks.iter().map(|(index, _)| *index).collect();
        indices.dedup();
        assert_eq!(indices, order);
        assert!(blocks.into_iter().flat_map(|(_, block)| block.rows).eq(expected.iter().copied()));
        assert_eq!(counted, tally(&expected, 9 * 23));
    }
}

/// A section is passed once in each revolution of the record, be it where the run begins.
#[test]
fn a_section_is_passed_once_a_revolution() {
    for angle in [0.0, 1e-9, 1.0, 6.2] {
        let all = sweep(&common::osorio(), 690.0, 710.0, 3, Shows::Strobe(angle));
        let (blocks, counted) = taken::<Kept<2>>(&all, 1);
        assert_eq!(counted, SweepTally { points: 9, impacts: 0, revolutions: 3 * 23 });
        let rows: Vec<RecordRow> = blocks.into_iter().flat_map(|(_, block)| block.rows).collect();
        for three in rows.chunks(3) {
            let [first, second, third] = [0, 1, 2].map(|index| three[index].revolution);
            assert_eq!([second, third], [first + 1, first + 2], "{angle}");
        }
    }
}

/// A value may have several runs, which are told apart and all counted.
#[test]
fn runs_of_one_value_are_told_apart() {
    let mut all = sweep(&common::osorio(), 690.0, 710.0, 3, Shows::Strobe(1.0));
    let two = |machine: &Machine| Ok(vec![START.motion(machine)?, machine.start_on_cam(1.0, 20.0)?]);
    all.starts = Beginning::Found(Arc::new(two));
    let (blocks, counted) = taken::<Kept<2>>(&all, 1);
    assert_eq!(counted, SweepTally { points: 18, impacts: 0, revolutions: 2 * 3 * 23 });
    let which: Vec<_> = blocks.iter().flat_map(|(_, block)| &block.rows).map(|row| row.motion).collect();
    let of_one = [[Some(0); 3], [Some(1); 3]].concat();
    assert_eq!(which, [&of_one[..]; 3].concat());
}

/// A sweep ends with the first value that cannot be run, after the rows of those before it; what takes its blocks may have it go on.
#[test]
fn a_sweep_ends_where_it_cannot_go_on() {
    let mut all = sweep(&common::osorio(), 600.0, 700.0, 11, Shows::Strobe(1.0));
    let slow = |machine: &Machine| {
        let angle = if machine.angular_velocity() < angular_velocity(635.0) { 0.0 } else { -1.0 };
        Ok(vec![machine.start_on_cam(angle, 0.0)?])
    };
    all.starts = Beginning::Found(Arc::new(slow));
    for threads in [1, 2] {
        let mut points = 0;
        let found = all.run(Some(threads), |_, block: Kept<1>| {
            points += block.rows.len();
            Ok(())
        });
        let Err(SweepError::Run { place, .. }) = found else { panic!("{found:?}") };
        assert_eq!((place.as_str(), points), ("640 rpm", 4 * 3));
        let found = all.run(Some(threads), |_, _: Counted| Ok(()));
        assert!(matches!(found, Err(SweepError::Run { place, .. }) if place == "640 rpm"));
        let (blocks, counted) = taken::<Kept<1, true>>(&all, threads);
        assert_eq!(counted, SweepTally { points: 4 * 3, impacts: 0, revolutions: 4 * 23 });
        let failed: Vec<f64> = blocks.into_iter().flat_map(|(_, block)| block.failed).collect();
        assert_eq!(failed, (4..11).map(|index| all.over.value(index)).collect::<Vec<_>>());
    }
}

/// Once nobody wants its rows, or a value has failed, a worker begins no further value: on one thread each of the four tasks that may be open
/// has begun its first.
#[test]
fn a_sweep_that_has_ended_begins_no_further_value() {
    let begun = |fails: bool| {
        let (count, seen) = (Arc::new(AtomicUsize::new(0)), Arc::new(AtomicUsize::new(0)));
        let mut all = Sweep { record: 50, ..sweep(&common::osorio(), 690.0, 710.0, 64, Shows::Strobe(1.0)) };
        let counts = count.clone();
        let start = move |machine: &Machine| {
            counts.fetch_add(1, Ordering::Relaxed);
            Ok(vec![machine.start_on_cam(if fails { -1.0 } else { 0.0 }, 0.0)?])
        };
        all.starts = Beginning::Found(Arc::new(start));
        let found = all.run(Some(1), |_, block: Kept<1>| {
            seen.fetch_add(block.rows.len(), Ordering::Relaxed);
            if fails { Ok(()) } else { Err(SweepError::Threads("enough".into())) }
        });
        assert!(found.is_err());
        assert_eq!(seen.load(Ordering::Relaxed), usize::from(!fails));
        count.load(Ordering::Relaxed)
    };
    assert_eq!([true, false].map(begun), [4, 4]);
}

/// The document of a diagram has the tally of its sweep, for how long each run was followed, and on how many threads: not more than values,
/// and on one where each waits for its neighbour.
#[test]
fn a_diagram_tells_what_it_ran() {
    let all = sweep(&common::osorio(), 690.0, 710.0, 3, Shows::Strobe(1.0));
    let one_by_one = Sweep { following: SweepStart::Up, ..all.clone() };
    for (sweep, threads, used) in [(&all, 2, 2), (&all, 5, 3), (&one_by_one, 2, 1)] {
        let told =
            Swept::new("paper", sweep, Some(threads), &Unwatched, |_: Counted| Ok::<(), SweepError>(())).unwrap();
        assert_eq!(told.tally, SweepTally { points: 9, impacts: 0, revolutions: 3 * 23 });
        assert_eq!((told.followed, told.threads), (20 + 3, used));
    }
}

/// Both ends are values to the last bit, one value is the lowest, and neighbours are as far apart as the spacing says.
#[test]
fn values_go_from_end_to_end() {
    for spacing in [Spacing::Linear, Spacing::Logarithmic] {
        for (low, high) in [(0.2, 0.9), (0.3, 0.9), (0.4, 1.7), (1e-3, 10.0)] {
            for count in [2, 3, 8] {
                let values: Vec<f64> = Values { low, high, count, spacing }.all().collect();
                assert_eq!((values.len(), values[0], values[count - 1]), (count, low, high));
                let parts = (count - 1) as f64;
                for pair in values.windows(2) {
                    match spacing {
                        Spacing::Linear => {
                            assert_relative_eq!(pair[1] - pair[0], (high - low) / parts, max_relative = 1e-9)
                        }
                        Spacing::Logarithmic => {
                            assert_relative_eq!(
                                pair[1] / pair[0],
                                (high / low).powf(1.0 / parts),
                                max_relative = 1e-12
                            );
                        }
                    }
                }
            }
            assert_eq!(Values { low, high, count: 1, spacing }.all().collect::<Vec<_>>(), [low]);
        }
        for value in [0.01, 3.0, 1000.0] {
            assert_relative_eq!(spacing.value(spacing.place(value)), value, max_relative = 1e-12);
        }
    }
    assert_eq!([Spacing::Linear, Spacing::Logarithmic].map(|it| it.place(1000.0)), [1000.0, 3.0]);
    assert_eq!(Sample::Spread(5).count(), 5);
    assert_eq!(Sample::Given(vec![START; 3]).count(), 3);
}

/// What varies is told in its unit, and with the speed where it is another number.
#[test]
fn what_varies_is_told_in_words() {
    let paper = common::osorio();
    let varied = |name: &str, rpm: Option<f64>| {
        let over = Over::new(&paper, Parameter::named(&paper, name).unwrap(), rpm).unwrap();
        let varied = over.varied(Spacing::Linear);
        assert_eq!([over.is_speed(), varied.is_speed()], [rpm.is_none(); 2]);
        [varied.words(650.5), varied.range([600.0, 760.0]), varied.value().to_owned()]
    };
    assert_eq!(varied("rpm", None), ["650.5 rpm", "600 to 760 rpm", "speed"]);
    assert_eq!(varied("mass", Some(700.0)), ["650.5 kg", "mass 600 to 760 kg at 700 rpm", "value"]);
    assert_eq!(varied("restitution", Some(700.0)), ["650.5", "restitution 600 to 760 at 700 rpm", "value"]);
    assert_eq!(Place::of_speed(700.0).across(), 700.0);
    assert_eq!(Place { rpm: 700.0, value: Some(0.8) }.across(), 0.8);
}

/// A survey over one number or two has one speed unless that varies; of two the first is told.
#[test]
fn a_survey_tells_what_it_is_over() {
    let paper = common::osorio();
    let survey = |rpm: Option<f64>, across: Axis, up: Option<Axis>| Survey::new(&paper, rpm, across, up);
    let [mass, speed] = [axis("mass", 1.0, 3.0, 3), axis("rpm", 600.0, 700.0, 2)];
    let over = survey(Some(700.0), mass.clone(), None).unwrap();
    assert_eq!((over.speed(), over.count(), over.value(1)), (Some(700.0), 3, 2.0));
    assert_eq!([0, 2].map(|index| over.words(index)), ["follower.mass = 1", "follower.mass = 3"]);
    let over = survey(None, speed.clone(), None).unwrap();
    assert_eq!((over.speed(), over.count(), over.value(1), over.words(0)), (None, 2, 700.0, "600 rpm".into()));
    let over = survey(None, mass.clone(), Some(speed.clone())).unwrap();
    assert_eq!((over.speed(), over.count(), over.value(2)), (None, 3, 3.0));
    for one in [mass, speed] {
        let refused = survey(Some(700.0), one.clone(), Some(one)).map(|_| ()).unwrap_err();
        assert!(matches!(refused, SurveyError::OneNumber(_)), "{refused}");
    }
}

/// What is told of the pieces that are done.
#[derive(Default)]
struct Told(Mutex<Vec<(u64, u64)>>);

impl Watch for Told {
    fn at(&self, _: &str, done: u64, total: u64) {
        self.0.lock().unwrap().push((done, total));
    }
}

/// Each point has the machine of its own values, whichever of the axes is the speed, and points come row by row; what is told to be done is
/// all of it in the end.
#[test]
fn each_point_has_the_machine_of_its_values() {
    let paper = common::osorio();
    let [speed, restitution, mass] =
        [axis("rpm", 600.0, 700.0, 40), axis("restitution", 0.1, 0.9, 40), axis("mass", 1.0, 2.0, 3)];
    let seen = |at: [usize; 2], machine: &Machine| {
        let moves = machine.flight().force(0.0) - machine.flight().force(1.0);
        Ok((at, machine.angular_velocity(), machine.restitution(), moves))
    };
    let value = |axis: &Axis, name: &str, index: usize| (axis.parameter.name() == name).then(|| axis.values[index]);
    for (rpm, across, up) in [
        (None, &speed, &restitution),
        (None, &restitution, &speed),
        (None, &mass, &speed),
        (Some(650.0), &mass, &restitution),
        (Some(650.0), &restitution, &mass),
    ] {
        let survey = Survey::new(&paper, rpm, across.clone(), Some(up.clone())).unwrap();
        let [columns, rows] = [across, up].map(|axis| 1..axis.values.len());
        for threads in [1, 2] {
            let told = Told::default();
            let (found, _) = survey.part([columns.clone(), rows.clone()], Some(threads), &told, seen).unwrap();
            let places = rows.clone().flat_map(|y| columns.clone().map(move |x| [x, y]));
            for (place, found) in places.zip(&found) {
                let of = |name: &str| value(across, name, place[0]).or_else(|| value(up, name, place[1]));
                let (at, omega, r, moves) = found.clone().unwrap();
                assert_eq!(at, place);
                assert_eq!(omega, angular_velocity(of("rpm").or(rpm).unwrap()));
                assert_eq!(r, of("follower.restitution").unwrap_or(paper.follower.restitution));
                let mass = of("follower.mass").unwrap_or(paper.follower.mass);
                assert_relative_eq!(moves, paper.follower.stiffness / mass, max_relative = 1e-9);
            }
            assert_eq!(found.len(), columns.len() * rows.len());
            let (mut told, total) = (told.0.into_inner().unwrap(), rows.len() as u64);
            told.sort_unstable();
            assert!(told.windows(2).all(|two| two[0].0 < two[1].0) && told[0].0 > 0, "{told:?}");
            assert!(told.len() > 1 || total < 8, "{told:?}");
            assert!(told.iter().all(|it| it.1 == total) && told.last() == Some(&(total, total)), "{told:?}");
        }
    }
    let survey = Survey::new(&paper, None, speed.clone(), None).unwrap();
    let found = survey.run(Some(2), &Unwatched, |index, machine| seen([index, 0], machine)).unwrap();
    let speeds: Vec<(usize, f64)> = found.into_iter().map(|it| it.map(|it| (it.0[0], it.1)).unwrap()).collect();
    assert_eq!(speeds, speed.values.iter().map(|rpm| angular_velocity(*rpm)).enumerate().collect::<Vec<_>>());
}

/// A cam turns at a speed above 0 that is a number: at any other there is no machine, and the reason in its place.
#[test]
fn at_speeds_that_are_none_there_is_no_machine() {
    let paper = common::osorio();
    let speeds = Axis::of(Parameter::Speed, [-1.0, 0.0, f64::INFINITY, f64::NAN, 700.0].into());
    let alone = Survey::new(&paper, None, speeds.clone(), None).unwrap();
    let found = alone.run(Some(1), &Unwatched, |index, _| Ok(index)).unwrap();
    let rows = Survey::new(&paper, None, axis("restitution", 0.1, 0.9, 1), Some(speeds)).unwrap();
    let (in_rows, _) = rows.part([0..1, 0..5], Some(1), &Unwatched, |[_, y], _| Ok(y)).unwrap();
    for found in [found, in_rows] {
        assert!(found[..4].iter().all(|it| it.as_ref().is_err_and(|why| why.contains("rpm"))), "{found:?}");
        assert_eq!(found[4], Ok(4));
    }
}

/// While a thread waits it has no processor.
#[test]
#[cfg(target_os = "linux")]
fn waiting_is_no_time_of_a_processor() {
    if std::fs::read_to_string("/proc/thread-self/schedstat").is_err() {
        return;
    }
    let survey = Survey::new(&common::osorio(), Some(700.0), axis("mass", 1.0, 1.0, 1), None).unwrap();
    let waits = |_: [usize; 2], _: &Machine| {
        std::thread::sleep(std::time::Duration::from_millis(100));
        Ok(())
    };
    let (_, [processor, clock]) = survey.part([0..1, 0..1], Some(1), &Unwatched, waits).unwrap();
    assert!(clock >= 0.1 && processor < 0.5 * clock, "{processor} {clock}");
}

/// Of events a diagram shows the impacts, and of the section the follower; a block of it is sent on after 1024 of them.
#[test]
fn places_are_impacts_or_positions() {
    let paper = common::osorio();
    let all = sweep(&paper, 250.0, 250.0, 1, Shows::Impacts);
    let (rows, _) = alone(&all, &paper, 250.0, None);
    let of =
        |kind: EventKind| rows.iter().find(|row| matches!(row.seen, Seen::Event(event) if event.kind == kind)).unwrap();
    let [impact, stick, release] = [EventKind::Impact, EventKind::Stick, EventKind::Release].map(of);
    let (mut places, Seen::Event(event)) = (Places::default(), impact.seen) else { panic!("{impact:?}") };
    assert!(!places.is_full());
    [stick, impact, release].into_iter().for_each(|row| places.push(row));
    assert_eq!(places.places, [[250.0, event.cam_angle]]);
    let count = (1..5000).find(|_| {
        let is_full = places.is_full();
        places.push(impact);
        is_full
    });
    assert_eq!(count, Some(1024));
    // What a machine settles on has the same places, without those of other events.
    let angles = settled_impacts(&machine(&paper, 250.0), all.transient, all.record).unwrap();
    let expected = rows.iter().filter_map(|row| match row.seen {
        Seen::Event(event) if event.kind == EventKind::Impact => Some(event.cam_angle),
        _ => None,
    });
    assert_eq!(angles, expected.collect::<Vec<_>>());
}
