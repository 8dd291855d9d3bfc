//! Are runs followed for as long, and told by as much, as the budget and the rules of the long run say?

use std::cell::Cell;

use approx::assert_relative_eq;
use corner_impact::cam::Corner;
use corner_impact::corner::CornerImpact;
use corner_impact::estimate::{ErrorIs, Estimate};
use corner_impact::flight::State;
use corner_impact::model::Model;
use corner_impact::orbit::long_run::{Budget, Kind, LongRun, Recorded, StickingOrbit};
use corner_impact::orbit::runs::{AfterRelease, LongRuns, RunOutcome};
use corner_impact::progress::Unwatched;
use corner_impact::simulate::{ImpactTally, Machine, Motion, SimulateError};
use corner_impact::study::attractors::{AttractorsAtValue, Cause, Resolution, has_reached};
use corner_impact::study::basins::{SectionStarts, States};
use corner_impact::study::design::contact::Separation;
use corner_impact::study::speeds::{Off, SpeedSurvey, passed_once};
use corner_impact::study::survey::{
    Ensemble, Place, Placed, Sample, Start, Wandering, attractors_of, long_run, outlasts, soon_rested,
};

use crate::attractors::ball;
use crate::common;
use crate::orbit_numbers::{machine, model};
use crate::settling::enlarged;
use crate::study_numbers::resolution;

/// A record with so much growth over its halves, which is seen beyond doubt.
fn record(halves: [f64; 2], impacts: u64) -> Recorded {
    let value = (halves[0] + halves[1]) / 100.0;
    let growth = Estimate { value, error: 0.01 * value, error_is: ErrorIs::Standard };
    Recorded {
        growth,
        halves,
        met: ImpactTally { impacts, impact_speed: 1.0 },
        revolutions: 100,
        runs: 1,
        rested: false,
    }
}

fn kind(halves: [f64; 2]) -> Kind {
    LongRun::by_growth(record(halves, 7)).kind()
}

/// A next rest is waited for over a fifth of the patience and as long as a run may settle; one that comes while growth is recorded, for as
/// long as that has taken as well.
#[test]
fn a_rest_is_waited_for_over_a_share_of_the_patience() {
    let budget = |transient, record, patience| Budget { transient, record, longest: 8, patience };
    for (budget, rest, later) in [
        (budget(200, 1600, 100_000), 20_000, 20_000),
        (budget(300, 100, 0), 300, 400),
        (budget(30, 1000, 500), 100, 1030),
    ] {
        assert_eq!((budget.rest(), budget.later_rest()), (rest, later), "{budget:?}");
    }
}

/// A deviation that grows as `n^d` gains `d ln 2` from the middle of `N` revolutions to their end and `d ln(N/2)` before: that is no chaos up to
/// the cube, nor at any power over many revolutions. What grows as `exp(a n)` gains as much over either half, and is.
#[test]
fn a_power_is_no_chaos_and_an_exponential_is() {
    for revolutions in [200.0_f64, 2000.0, 1e5] {
        let power = |d: f64| [d * (0.5 * revolutions).ln(), d * 2.0_f64.ln()];
        for d in [1.0, 2.0, 2.99, 5.0, 20.0] {
            assert_eq!(kind(power(d)), Kind::Undecided, "{d} {revolutions}");
        }
        for gained in [2.2, 3.0, 5.0, 50.0, 1e4] {
            assert_eq!(kind([gained; 2]), Kind::Chaotic, "{gained}");
        }
        // As exponential, but gained too little for the cube to be excluded.
        for gained in [0.1, 1.0, 2.0] {
            assert_eq!(kind([gained; 2]), Kind::Undecided, "{gained}");
        }
    }
    // By chance one half has less.
    assert_eq!([kind([10.0, 4.0]), kind([4.0, 10.0])], [Kind::Chaotic; 2]);
    // A fall without an impact is no motion of an impact oscillator, and a growth that is not seen is none.
    assert_eq!(LongRun::by_growth(record([50.0; 2], 0)).kind(), Kind::Undecided);
    let mut unseen = record([50.0; 2], 7);
    unseen.growth.error = unseen.growth.value;
    assert_eq!(LongRun::by_growth(unseen).kind(), Kind::Undecided);
}

/// Several records together have the means of their halves and the sums of their revolutions, of which each run has its share.
#[test]
fn records_together_have_their_means() {
    let halves = [[2.0, 4.0], [6.0, 10.0], [4.0, 1.0]];
    let together = Recorded::together(&halves.map(|halves| record(halves, 7)));
    assert_eq!(together.halves, [4.0, 5.0]);
    assert_eq!((together.revolutions, together.runs, together.met.impacts), (300, 3, 21));
    assert_eq!(together.each(), 100);
}

/// Chaos and what rests so seldom that rounding decides when are left by chance alone; what repeats or stays is not left.
#[test]
fn what_wanders_is_left_by_chance() {
    let rests = |growth: f64| {
        LongRun::Sticking(StickingOrbit { releases: vec![1.0], revolutions: 7, impacts: 5, impact_speed: 1.0, growth })
    };
    assert!(LongRun::by_growth(record([50.0; 2], 7)).wanders() && LongRun::by_growth(record([0.0; 2], 7)).wanders());
    assert!(rests(60.0).wanders() && !rests(1.0).wanders() && !LongRun::PermanentContact.wanders());
}

/// A start from high above the cam.
fn high(machine: &Machine, index: usize) -> Result<Option<Motion>, SimulateError> {
    machine.start(0.0, State { position: 2.0 + 0.31 * index as f64, velocity: 0.0 }).map(Some)
}

fn ensemble(machine: &Machine, count: usize, budget: Budget) -> Ensemble {
    let runs = LongRuns::unaided(machine, budget);
    attractors_of(&runs, count, |index| high(machine, index), &Unwatched).unwrap()
}

/// A run that rests was followed up to where the cam lets go of it, and from there for as long as it took to tell what follows, however many
/// turns the cam had made before.
#[test]
fn a_run_that_rests_is_followed_to_its_release_and_on() {
    let budget = Budget { transient: 300, record: 50, longest: 8, patience: 0 };
    for rpm in [175.0, 183.0, 190.0] {
        let machine = machine(&common::osorio(), rpm);
        let start = machine.start(1.0, State { position: 60.0, velocity: 0.0 }).unwrap();
        let runs = LongRuns::unaided(&machine, budget);
        let mut motion = start;
        let RunOutcome::Released(angle) = runs.run(&mut motion, budget.transient).unwrap() else {
            panic!("{rpm} rpm: never released")
        };
        let onward = runs.after_release(angle, budget.rest(), |_| None).unwrap().1;
        let before = motion.revolution;
        assert!(before > 2 && onward > 0, "{rpm}: {before} {onward}");
        let mut later = start;
        later.revolution = 1000;
        for start in [start, later] {
            let found = long_run(&machine, start, budget).unwrap();
            assert_eq!((found.ending.kind(), found.followed), (Kind::Resting, before + onward), "{rpm} rpm");
        }
    }
}

/// Chaos is followed until it might have settled, and then for its record, which several runs have together.
#[test]
fn chaos_is_followed_for_its_record() {
    let machine = machine(&common::osorio(), 671.0);
    let budget = Budget { patience: 0, ..Budget::SURVEY };
    for count in [1, 3] {
        let found = ensemble(&machine, count, budget);
        let [chaos] = &found.attractors[..] else { panic!("{found:?}") };
        let recorded = chaos.ending.of_growth().unwrap();
        assert_eq!(chaos.ending.kind(), Kind::Chaotic);
        assert_eq!((recorded.runs, chaos.starts.len()), (count as u64, count));
        assert!(recorded.revolutions >= budget.record * recorded.runs);
        assert_eq!(chaos.followed, vec![budget.transient + recorded.revolutions / recorded.runs; count]);
        assert_eq!(chaos.followed(), chaos.followed.iter().sum::<u64>());
    }
}

/// Runs that wander share the patience: a quarter of it at once, in equal parts of whole revolutions of which 32 are the least, until all have
/// run for as long together.
#[test]
fn runs_that_wander_share_any_patience() {
    let machine = machine(&common::osorio(), 671.0);
    for (count, patience, revolutions) in [
        // Four times 3 x 333, and 3 x 32 for the last four.
        (3, 4000, 3996 + 96),
        // Four times 2 x 125.
        (2, 1000, 1000),
        // 32 each, until that is 400 and more.
        (4, 400, 512),
    ] {
        let budget = Budget { patience, ..Budget::SURVEY };
        let wandering = ensemble(&machine, count, budget).wandering;
        assert_eq!(wandering, Wandering { revolutions, left: 0, rested: 0 }, "{count} {patience}");
    }
}

/// Of runs whose growth tells nothing four have eight records each, and those that are left have as many between them.
#[test]
fn runs_beyond_the_fourth_share_their_records() {
    // A ball that loses nothing, on a dwell.
    let text = "[follower]\nmass = 1.0\ndamping = 0.0\nstiffness = 0.0\ngravity = 9.81\nrest_position = 0.0\nrestitution = 1.0\n\
                [cam]\nlaw = \"program\"\nbase = 0.05\n[[cam.segment]]\nmotion = \"dwell\"\nspan_deg = 360.0\nrise = 0.0\n";
    let machine = machine(&Model::parse("level.toml", text).unwrap(), 60.0);
    let budget = Budget { transient: 10, record: 16, longest: 4, patience: 0 };
    let start =
        |index: usize| machine.start(0.0, State { position: 0.3 + 0.0713 * index as f64, velocity: 0.0 }).map(Some);
    for (count, records) in [(4, 8), (8, 8), (12, 4), (20, 2), (68, 1)] {
        let found = attractors_of(&LongRuns::unaided(&machine, budget), count, start, &Unwatched).unwrap();
        let [undecided] = &found.attractors[..] else { panic!("{count}: {}", found.attractors.len()) };
        assert_eq!(undecided.ending.kind(), Kind::Undecided);
        let expected: Vec<u64> = (0..count).map(|index| 10 + 16 * if index < 4 { 8 } else { records }).collect();
        assert_eq!(undecided.followed, expected, "{count}");
    }
}

/// Starts that leave the cam for good are told with the values at which they do, and as all of them only where that is so at each value.
#[test]
fn starts_that_leave_for_good_are_told_by_their_values() {
    // A spring that holds it above the cam.
    let text = "[follower]\nmass = 2.0\nrestitution = 0.5\ndamping = 3.0\nstiffness = 800.0\ngravity = 9.81\nrest_position = 0.25\n\
                [cam]\nlaw = \"harmonic\"\noffset = 0.1\namplitudes = [0.02]\nphases_deg = [0.0]\n";
    let held = Model::parse("held.toml", text).unwrap();
    let found = common::speeds(&held, [50.0, 150.0], resolution(50.0, 2), &Unwatched).unwrap();
    assert_eq!((found.run, found.off.len()), (3, 3));
    assert!(found.off.iter().all(|off| off.share.value == 1.0));
    let all = found.off_for_good().unwrap();
    assert!(all.words.starts_with("Every start leaves the cam for good") && all.shares == found.off, "{all:?}");
    let off = |share: f64, rpm: f64| Off {
        at: Place::of_speed(rpm),
        share: Estimate { value: share, error: 0.1, error_is: ErrorIs::Standard },
    };
    let some = SpeedSurvey { off: vec![off(0.5, 60.0), off(1.0, 70.0), off(0.25, 80.0)], run: 5, ..found.clone() };
    let words = some.off_for_good().unwrap().words;
    assert!(words.contains(" at 3 of 5 ") && words.contains("all of them at 1.") && words.contains("60"), "{words}");
    // As many values with starts that leave as were run, but not with all.
    let each = SpeedSurvey { run: 3, ..some };
    assert!(each.off_for_good().unwrap().words.contains("at 3 of 3"));
    assert_eq!(SpeedSurvey { off: Vec::new(), ..found }.off_for_good(), None);
}

/// The speed at which the cam is left is told where it is in the range, and not below or above.
#[test]
fn the_speed_of_detachment_is_told_in_the_range_alone() {
    let found = common::speeds(&model("laws/polynomial"), [420.0, 420.5], resolution(0.5, 1), &Unwatched).unwrap();
    assert!(found.off.is_empty() && found.off_for_good().is_none());
    for (rpm, is_told) in [(419.0, false), (420.0, true), (420.2, true), (420.5, true), (421.0, false)] {
        let separation =
            Some(Separation::At { rpm, error: 1e-9, cam_angle: 1.0, angle_error: None, within_errors: false });
        let told = SpeedSurvey { separation, attractors: Vec::new(), ..found.clone() }.detachment();
        assert_eq!(told, is_told.then_some([rpm, 1e-9]));
    }
}

/// A motion that rests has its fastest impact in the period that it repeats.
#[test]
fn a_row_has_the_fastest_impact_of_its_motion() {
    let found = common::speeds(&common::osorio(), [182.0, 184.0], resolution(1.0, 2), &Unwatched).unwrap();
    let mut rests = 0;
    for at in found.attractors.iter().flat_map(|row| &row.at) {
        if let LongRun::Sticking(resting) = &at.ending {
            assert_relative_eq!(at.impact_speed.unwrap(), resting.impact_speed, max_relative = 1e-6);
            rests += 1;
        }
    }
    assert!(rests >= 3, "{rests}");
    // Of an orbit by what the impacts leave of it: r u.
    let found = common::speeds(&common::osorio(), [700.0, 701.0], resolution(1.0, 1), &Unwatched).unwrap();
    let mut orbits = 0;
    for at in found.attractors.iter().flat_map(|row| &row.at) {
        if let LongRun::Orbit(orbit) = &at.ending {
            let left = orbit.impacts().map(|impact| impact.velocity_after - impact.cam_velocity).fold(0.0, f64::max);
            assert_relative_eq!(0.8 * at.impact_speed.unwrap(), left, max_relative = 1e-9);
            orbits += 1;
        }
    }
    assert!(orbits > 0);
}

/// An attractor is of the kind that it has at most speeds, of those that it has at any.
#[test]
#[ignore = "slow"]
fn a_row_is_of_the_kind_of_most_of_its_speeds() {
    let mut mixed = 0;
    // Of the second range the speeds alone, and none beside it.
    for range in [[410.0, 440.0], [411.0, 418.0]] {
        let found = common::speeds(&common::osorio(), range, resolution(3.0, 1), &Unwatched).unwrap();
        for row in &found.attractors {
            let count = |kind: Kind| row.at.iter().filter(|at| at.ending.kind() == kind).count();
            assert!(row.at.iter().all(|at| count(at.ending.kind()) <= count(row.kind)), "{:?}", row.kind);
            mixed += usize::from(row.at.iter().any(|at| at.ending.kind() != row.kind));
        }
    }
    assert!(mixed > 0);
}

/// A corner impact with danger is told once where it is in the range, and not where it is beyond either end, however near.
#[test]
#[ignore = "slow"]
fn a_danger_is_told_in_the_range_alone() {
    let model = Model::parse("dangerous.toml", include_str!("../../crates/explore/src/page/dangerous.toml")).unwrap();
    let budget = Budget { transient: 300, record: 50, longest: 4, patience: 0 };
    for (range, is_told) in [([59.99, 60.01], true), ([59.98, 59.995], false), ([60.005, 60.02], false)] {
        let resolution = Resolution { budget, ..Resolution::new(common::step(0.01), 1) };
        let found = common::speeds(&model, range, &resolution, &Unwatched).unwrap();
        assert_eq!(found.dangers.len(), usize::from(is_told), "{range:?}: {:?}", found.dangers);
        for danger in found.dangers {
            assert_relative_eq!(danger.at.rpm, 60.0, max_relative = 1e-9);
            let named = |id: &String| found.attractors.iter().any(|row| row.id == *id);
            assert!(!danger.attractors.is_empty() && danger.attractors.iter().all(named), "{:?}", danger.attractors);
        }
    }
}

/// The speed at which a motion on the cam ends is told with what rounding may put it off by, to either side.
#[test]
fn a_detachment_is_told_with_its_rounding() {
    // a omega^2 = g of a table that goes up and down by a millimetre.
    let leaves = crate::design_numbers::rpm((9.81_f64 / 0.001).sqrt());
    let found = common::speeds(&ball(), [945.0, 947.0], resolution(1.0, 1), &Unwatched).unwrap();
    let mut told = 0;
    for end in found.attractors.iter().flat_map(|row| row.birth.iter().chain(&row.death)) {
        if end.cause == Cause::Detachment {
            let [low, high] = end.bracket;
            assert!(low < high && low <= end.at.rpm && end.at.rpm <= high, "{low} {high}: {}", end.at.rpm);
            assert!(low <= leaves && leaves <= high && high - low < 1e-9, "{low} {high}: {leaves}");
            told += 1;
            // Where the force between them tells no speed, by that end, and half of what it is open by.
            let found = SpeedSurvey { separation: None, ..found.clone() };
            assert_eq!(found.detachment(), Some([end.at.rpm, 0.5 * (high - low)]));
        }
    }
    assert!(told > 0);
}

/// In whatever unit lengths are, a run comes to the same orbit after as many revolutions.
#[test]
fn a_run_comes_to_its_orbit_in_any_unit() {
    for rpm in [700.0, 736.0] {
        let told = [0, -40, 40].map(|power| {
            let machine = machine(&enlarged(power), rpm);
            let runs = LongRuns::unaided(&machine, Budget { transient: 1000, record: 0, longest: 4, patience: 0 });
            let mut motion = machine.start_on_cam(1.0, 2.0_f64.powi(power)).unwrap();
            let RunOutcome::Arrives(orbit) = runs.run(&mut motion, 400).unwrap() else {
                panic!("{rpm} rpm, 2^{power}")
            };
            let angles: Vec<f64> = orbit.impacts().map(|impact| impact.cam_angle).collect();
            (angles, motion.revolution)
        });
        assert!(told[0] == told[1] && told[0] == told[2], "{rpm} rpm: {told:?}");
    }
}

/// Starts from rest that leave the cam for good are not counted among those of the sample.
#[test]
fn starts_from_rest_are_not_counted_with_the_sample() {
    let text = "[follower]\nmass = 0.5\nrestitution = 0.5\nstiffness = 0.0\nrest_position = 0.0\ngravity = 0.0\ndamping = 0.0\n\
                [cam]\nlaw = \"harmonic\"\noffset = 0.02\namplitudes = [0.0, 0.02]\nphases_deg = [0.0, 0.0]\n";
    let free = Model::parse("free.toml", text).unwrap();
    let here = AttractorsAtValue::new(&machine(&free, 100.0), &Sample::Spread(4), Budget::SURVEY).unwrap();
    assert!(here.rests > 0 && here.sampled == 4 && here.off_for_good == 4, "{here:?}");
}

/// Long runs are on another motion if ten times as many rests were to be expected as came. 100 rests in 10,000 revolutions make at least 8 in a
/// thousand to be expected.
#[test]
fn runs_that_rest_a_tenth_as_often_are_on_another_motion() {
    let seen = |revolutions, rested| Wandering { revolutions, left: 0, rested };
    let soon = seen(10_000, 100);
    for (long, wanted) in [
        (seen(1_240, 0), false),
        (seen(1_260, 0), true),
        (seen(2_490, 1), false),
        (seen(2_510, 1), true),
        (seen(12_490, 9), false),
        (seen(12_510, 9), true),
    ] {
        assert_eq!(outlasts(long, soon), wanted, "{long:?}");
    }
    // Fewer than four rests may have been none.
    assert!(!outlasts(seen(1_000_000_000, 0), seen(10, 4)) && outlasts(seen(1_000_000_000, 0), seen(10, 5)));
    assert!(!outlasts(seen(1_000, 0), Wandering::default()));
}

/// A release that is known to come to no rest is not followed again if it was followed for as long as a rest is waited for now; a release that
/// is known to recur is never.
#[test]
fn what_follows_a_known_release_is_not_asked_again() {
    let machine = machine(&common::osorio(), 183.0);
    let budget = |patience| Budget { transient: 100, record: 50, longest: 8, patience };
    let long = LongRuns::unaided(&machine, budget(1_000));
    let short = LongRuns::unaided(&machine, budget(0));
    assert!(long.budget.rest() == long.budget.later_rest() && short.budget.rest() < short.budget.later_rest());
    let start = machine.start(1.0, State { position: 60.0, velocity: 0.0 }).unwrap();
    let asked = Cell::new(0);
    let wanders = |angle: f64| {
        asked.set(asked.get() + 1);
        let released = long.released(angle).unwrap();
        Some(AfterRelease::Wanders { released, end: released })
    };
    let kind = |runs: &LongRuns<'_>, known: &dyn Fn(f64) -> Option<AfterRelease>| {
        runs.by_growth(start, 3, known).unwrap().kind()
    };
    for runs in [&long, &short] {
        assert_eq!(kind(runs, &|_| None), Kind::Resting);
    }
    assert_ne!(kind(&long, &wanders), Kind::Resting);
    // It goes on from where the first such release has led, and ends at the second.
    assert_eq!(asked.get(), 2);
    assert_eq!(kind(&short, &wanders), Kind::Resting);
    let recurs = |angle: f64| {
        let orbit =
            StickingOrbit { releases: vec![angle], revolutions: 77, impacts: 1, impact_speed: 1.0, growth: 0.0 };
        Some(AfterRelease::Recurs(orbit))
    };
    for runs in [&long, &short] {
        assert_eq!(runs.by_growth(start, 3, &recurs).unwrap().period().map(|(turns, _)| turns), Some(77));
    }
}

/// The first rests are counted over the revolutions in which a run that has forgotten its start might have rested: 50 later, and of runs that
/// rested or wander. What has settled or could not go on rests no more.
#[test]
fn the_first_rests_are_counted_over_the_runs_that_may_rest() {
    let machine = machine(&common::osorio(), 700.0);
    let orbit = LongRuns::new(&machine, Budget::SURVEY).unwrap().known().next().unwrap().clone();
    let seen = |revolutions, rested| Wandering { revolutions, left: 0, rested };
    for (run, revolutions, wanted) in [
        (Ok(RunOutcome::Released(1.0)), 75, seen(25, 1)),
        (Ok(RunOutcome::Released(1.0)), 49, seen(0, 0)),
        (Ok(RunOutcome::Wanders), 400, seen(350, 0)),
        (Ok(RunOutcome::Arrives(orbit)), 400, seen(0, 0)),
        (Ok(RunOutcome::PermanentContact), 400, seen(0, 0)),
        (Err(SimulateError::NoProgress { events: 1, revolution: 1, cam_angle: 1.0 }), 400, seen(0, 0)),
    ] {
        assert_eq!(soon_rested(&run, revolutions), wanted, "{run:?}");
    }
}

/// Releases that chaos follows count by the revolutions that they were followed for, which two of them are as long as eight hundred. Half of
/// the patience is for the runs themselves: 600, and three times 3 x 100 are left.
#[test]
fn releases_take_half_of_the_patience_at_most() {
    let budget = Budget { transient: 400, record: 50, longest: 8, patience: 1200 };
    let here = AttractorsAtValue::new(&machine(&common::osorio(), 671.0), &Sample::Spread(3), budget).unwrap();
    assert_eq!(here.wandering, Wandering { revolutions: 1200, left: 0, rested: 0 });
}

/// A ball that loses nothing bounces on a level table for ever, and nothing tells what it does: that is no motion that another value has.
#[test]
fn what_is_undecided_is_not_come_to() {
    let text = "[follower]\nmass = 1.0\ndamping = 0.0\nstiffness = 0.0\ngravity = 9.81\nrest_position = 0.0\nrestitution = 1.0\n\
                [cam]\nlaw = \"program\"\nbase = 0.05\n[[cam.segment]]\nmotion = \"dwell\"\nspan_deg = 360.0\nrise = 0.0\n";
    let machine = machine(&Model::parse("level.toml", text).unwrap(), 60.0);
    let budget = Budget { transient: 10, record: 16, longest: 4, patience: 0 };
    let high = Start { cam_angle: 0.0, follower: Placed::At(State { position: 0.3713, velocity: 0.0 }) };
    let here = AttractorsAtValue::new(&machine, &Sample::Given(vec![high]), budget).unwrap();
    let [undecided] = &here.attractors[..] else { panic!("{here:?}") };
    assert_eq!(undecided.ending.kind(), Kind::Undecided);
    assert_eq!(here.come_to(&machine, &undecided.motion).unwrap(), None);
}

/// Shares are of the starts of the sample that could be run. A run from elsewhere that failed takes nothing from them.
#[test]
fn a_start_that_could_not_be_run_is_none_of_the_sample() {
    let machine = machine(&common::osorio(), 700.0);
    let mut here = AttractorsAtValue::new(&machine, &Sample::Spread(4), Budget::SURVEY).unwrap();
    assert_eq!((here.run(), here.sampled), (4, 4));
    let failure = machine.start(0.0, State { position: -1.0, velocity: 0.0 }).unwrap_err();
    here.failed = [0, 3, 4, 5].map(|start| (start, failure)).to_vec();
    assert_eq!(here.run(), 2);
    here.failed = (0..4).map(|start| (start, failure)).collect();
    assert_eq!(here.run(), 1, "a share of none is one of one");
}

/// A given start below the cam is one that could not be run. Starts below the cam are counted where a grid has them.
#[test]
fn a_start_that_is_given_below_the_cam_is_one_that_failed() {
    let machine = machine(&common::osorio(), 700.0);
    let states = [0.6, -1.0, 0.7].map(|position| State { position, velocity: 0.0 }).to_vec();
    let starts = SectionStarts::Given(States { cam_angle: 0.0, states });
    let budget = Budget { transient: 100, record: 16, longest: 4, patience: 0 };
    let found = starts.basins(&machine, budget, Some(1), &Unwatched).unwrap();
    assert_eq!((found.starts, found.failed, found.below_cam), (2, 1, 0));
}

/// A motion that a run has reached is not asked of a neighbour once more. What only a run that began on it has is.
#[test]
fn what_runs_have_reached_is_known_by_its_class() {
    let mut here =
        AttractorsAtValue::new(&machine(&common::osorio(), 700.0), &Sample::Spread(4), Budget::SURVEY).unwrap();
    let ending = here.attractors.iter().find(|it| it.ending.kind() == Kind::Periodic).unwrap().ending.clone();
    assert!(has_reached(&here, &ending) && !has_reached(&here, &LongRun::PermanentContact));
    let begun_on = here.sampled + here.rests;
    here.attractors.iter_mut().for_each(|it| it.starts = vec![begun_on]);
    assert!(!has_reached(&here, &ending));
}

/// A corner impact that several attractors pass is told once, with each of them. At another value, or at another corner at the same value, as of
/// a cam of equal lobes, it is another.
#[test]
fn a_corner_impact_is_told_once() {
    let model = common::osorio();
    let at = corner_impact::corner::locate(&model, &common::cam(&model)).unwrap().0;
    let passed = |value: f64, angle: f64, name: &str| {
        (value, CornerImpact { corner: Corner { angle, ..at.corner }, ..at.clone() }, name.to_owned())
    };
    let told = passed_once(vec![
        passed(700.0, 1.0, "A1"),
        passed(700.0, 4.0, "A1"),
        passed(700.0005, 1.0, "A1"),
        passed(699.9995, 1.0, "A2"),
        passed(690.0, 1.0, "A2"),
        passed(0.0, 1.0, "A3"),
        passed(0.0, 1.0, "A4"),
    ]);
    let told: Vec<(f64, f64, &[String])> =
        told.iter().map(|(value, at, names)| (*value, at.corner.angle, &names[..])).collect();
    let names = |all: &[&str]| all.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
    let expected = [
        (0.0, 1.0, names(&["A3", "A4"])),
        (690.0, 1.0, names(&["A2"])),
        (700.0, 1.0, names(&["A1", "A2"])),
        (700.0, 4.0, names(&["A1"])),
    ];
    assert_eq!(told.len(), expected.len(), "{told:?}");
    for (told, (value, angle, names)) in told.iter().zip(&expected) {
        assert_eq!((told.0, told.1, told.2), (*value, *angle, &names[..]));
    }
}
