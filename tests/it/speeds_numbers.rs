//! Are rests, the hardest impact and the smallest basin of a range of speeds what the counts make them?

use approx::assert_relative_eq;
use corner_impact::estimate::{ErrorIs, Estimate};
use corner_impact::model::Model;
use corner_impact::orbit::long_run::{Budget, Kind, LongRun, StickingOrbit};
use corner_impact::progress::Unwatched;
use corner_impact::study::attractors::{
    Attractors, AttractorsAtValue, AttractorsError, Cause, GridValue, Transition, attractors, families,
};
use corner_impact::study::speeds::{At, AttractorRow, SpeedSurvey};
use corner_impact::study::survey::{Over, Place, RunError, Sample, Wandering};

use crate::attractors::{ball, by_growth};
use crate::common;
use crate::orbit_numbers::model;
use crate::study_numbers::resolution;

fn attractor(at: Vec<At>) -> AttractorRow {
    AttractorRow {
        id: "A1".into(),
        kind: Kind::Chaotic,
        revolutions: None,
        impacts: None,
        ends: [1.0, 2.0].map(Place::of_speed),
        birth: None,
        death: None,
        at,
    }
}

/// Once in so many revolutions of runs that wandered, with the error of a count; of none the bound that chance passes once in twenty times.
#[test]
fn rests_of_chaos_are_counted_where_runs_were_long_enough() {
    let growth = Estimate { value: 1.0, error: 0.1, error_is: ErrorIs::Standard };
    let wanders = |revolutions: u64, rested: u64| At {
        place: Place::of_speed(1.0),
        share: growth,
        ending: by_growth(1.0, 0.1),
        followed: revolutions,
        wandering: Wandering { revolutions, left: 0, rested },
        impact_angles: Vec::new(),
        impact_speed: None,
    };
    assert_eq!(attractor(vec![wanders(99_999, 3)]).rests(), None);
    let found = attractor(vec![wanders(99_999, 3), wanders(1, 1)]).rests().unwrap();
    assert_eq!((found.rests, found.revolutions, found.rate, found.rate_error), (4, 100_000, 4e-5, Some(2e-5)));
    let found = attractor(vec![wanders(100_000, 0)]).rests().unwrap();
    assert_eq!((found.rests, found.rate_error), (0, None));
    assert_relative_eq!(found.rate, -(0.05_f64.ln()) * 1e-5, max_relative = 1e-12);
    // What rests often is not chaos that rests.
    let rests = |growth: f64| {
        let resting = StickingOrbit { releases: vec![1.0], revolutions: 7, impacts: 5, impact_speed: 1.0, growth };
        At { ending: LongRun::Sticking(resting), ..wanders(100_000, 1) }
    };
    assert_eq!(attractor(vec![rests(1.0)]).rests(), None);
    assert_eq!(attractor(vec![rests(60.0), wanders(1, 0)]).rests().unwrap().revolutions, 100_001);
}

#[test]
fn the_hardest_impact_and_the_smallest_basin_are_told() {
    let found = common::speeds(&model("laws/polynomial"), [420.0, 422.0], resolution(0.5, 3), &Unwatched).unwrap();
    let fastest: Vec<[f64; 2]> =
        found.attractors.iter().flat_map(|it| &it.at).filter_map(|at| Some([at.impact_speed?, at.value()])).collect();
    let [speed, rpm] = found.hardest().unwrap();
    assert!(fastest.contains(&[speed, rpm]) && fastest.iter().all(|it| it[0] <= speed));
    let missed = |starts: usize| {
        SpeedSurvey { sample: Sample::Spread(starts), attractors: Vec::new(), ..found.clone() }.missed()
    };
    // exp(-3 %) of 100 starts.
    assert_relative_eq!((-missed(100) * 100.0).exp(), 0.05, max_relative = 1e-12);
    assert_eq!([missed(1), missed(2)], [1.0, 1.0]);
    assert!(missed(3) < 1.0);
    assert_eq!(SpeedSurvey { attractors: Vec::new(), ..found }.hardest(), None);
}

fn over(model: &Model, range: [f64; 2], step: f64, starts: usize) -> Result<Attractors, AttractorsError> {
    attractors(&Over::speed(model).unwrap(), range, resolution(step, starts), &Unwatched)
}

/// Few speeds are no too many however high they are, but a step that rounding takes.
#[test]
fn a_range_is_as_fine_as_its_speeds_are_apart() {
    let paper = common::osorio();
    // From eight steps below the range to eight above it.
    assert_eq!(over(&paper, [100.0, 100.01], 0.001, 1).unwrap().grid.len(), 27);
    let next = 1000.0 * (1.0 + f64::EPSILON);
    assert!(matches!(over(&paper, [1000.0, next], 1e-13, 1), Err(AttractorsError::TooFine { .. })));
    // A range that begins at the first speed of the grid has it once.
    let found = over(&paper, [5.0, 10.0], 5.0, 1).unwrap();
    let speeds: Vec<f64> = found.grid.iter().map(|it| it.value).collect();
    assert_eq!(speeds[..3], [5.0, 10.0, 15.0]);
}

/// Where the follower leaves the cam is told where that is in the range, and neither from the margin nor where it is off at all speeds.
#[test]
#[ignore = "slow"]
fn where_the_cam_is_left_is_told_within_the_range() {
    // a omega^2 = g of a table that goes up and down by a millimetre.
    let leaves = crate::design_numbers::rpm((9.81_f64 / 0.001).sqrt());
    for (range, is_told) in [([945.0, 947.0], true), ([947.0, 949.0], false), ([942.0, 944.0], false)] {
        let found =
            common::speeds(&ball(), range, resolution(1.0, 1), &Unwatched).unwrap().detachment().map(|[rpm, _]| rpm);
        assert_eq!(found.is_some(), is_told, "{range:?}");
        assert!(found.is_none_or(|rpm| (rpm - leaves).abs() < 1e-6), "{found:?}");
    }
    // A spring that holds it above the cam.
    let text = "[follower]\nmass = 2.0\nrestitution = 0.5\ndamping = 3.0\nstiffness = 800.0\ngravity = 9.81\nrest_position = 0.25\n\
                [cam]\nlaw = \"harmonic\"\noffset = 0.1\namplitudes = [0.02]\nphases_deg = [0.0]\n";
    let held = Model::parse("held.toml", text).unwrap();
    assert_eq!(common::speeds(&held, [50.0, 150.0], resolution(50.0, 1), &Unwatched).unwrap().detachment(), None);
}

/// A motion that rests at most of the speeds of a grid, and is chaotic at some, is one that rests.
#[test]
fn a_kind_is_that_of_most_speeds() {
    let found = over(&common::osorio(), [425.0, 445.0], 3.0, 3).unwrap();
    let mut mixed = 0;
    for row in &found.families {
        let kinds: Vec<Kind> = row
            .at
            .iter()
            .map(|(index, part)| found.grid[*index].found.as_ref().unwrap().attractors[*part].ending.kind())
            .collect();
        let count = |kind: Kind| kinds.iter().filter(|it| **it == kind).count();
        assert!(kinds.iter().all(|kind| count(*kind) <= count(row.kind(&found.grid))), "{kinds:?}");
        mixed += usize::from(kinds.iter().any(|kind| *kind > row.kind(&found.grid)));
    }
    assert!(mixed > 0);
}

/// At 493.8275 rpm an impact of the orbit goes over a corner, and on both sides the orbit is stable: it is one attractor, that does not
/// end there.
#[test]
#[ignore = "slow"]
fn an_orbit_goes_on_over_a_corner() {
    let found = over(&model("persistence"), [493.5, 494.5], 0.5, 1).unwrap();
    let orbits: Vec<_> = found.families.iter().filter(|row| row.period() == Some((1, 1))).collect();
    let [orbit] = orbits[..] else { panic!("{orbits:?}") };
    assert!(orbit.range[0] < 493.82 && orbit.range[1] == 494.5, "{:?}", orbit.range);
}

/// Over a sine that is turned up at its zeros two orbits are half a turn apart, each of which runs come to first at some speeds: each is
/// one attractor, whose impact goes on from speed to speed.
#[test]
fn two_orbits_of_one_kind_are_not_mixed_up() {
    let found = over(&model("laws/rectified-sine"), [20.0, 20.2], 0.1, 8).unwrap();
    let mut first = Vec::new();
    for row in &found.families {
        assert_eq!((row.period(), row.range), (Some((1, 1)), found.range));
        let angle = |index: &usize| match &found.grid[*index].found.as_ref().unwrap().attractors[row.at[index]].ending {
            LongRun::Orbit(orbit) => orbit.impacts().next().unwrap().cam_angle,
            other => panic!("{other:?}"),
        };
        let angles: Vec<f64> = row.at.keys().map(angle).collect();
        assert!(angles.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 0.1), "{angles:?}");
        first.push(row.at.values().filter(|part| **part == 0).count());
    }
    assert!(first.len() == 2 && first.iter().all(|count| *count > 0), "{first:?}");
}

/// The motions over a grid of a few speeds, rpm, from two starts each: turns and impacts, lowest and highest speed, and why they begin and end.
type Motions = Vec<(Option<(u64, u64)>, [f64; 2], [Option<Cause>; 2])>;

/// Those of a ball on a table in another unit of time, in which all speeds are `2^power` times as high; as if no run had come to an orbit at the
/// speed of an index.
fn motions(grid: &[f64], power: i32, unseen: Option<usize>) -> Motions {
    let (ball, scale) = (ball(), 2.0_f64.powi(power));
    let ball = ball.with_number("follower.gravity", ball.follower.gravity * scale * scale).unwrap();
    let over = Over::speed(&ball).unwrap();
    let at = |rpm: &f64| {
        let value = rpm * scale;
        let found = AttractorsAtValue::new(&over.machine(value).unwrap(), &Sample::Spread(2), Budget::SURVEY);
        GridValue { value, found: found.map_err(RunError::from) }
    };
    let mut grid: Vec<_> = grid.iter().map(at).collect();
    if let Some(GridValue { found: Ok(here), .. }) = unseen.and_then(|index| grid.get_mut(index)) {
        here.attractors.retain(|it| !matches!(it.ending, LongRun::Orbit(_)));
    }
    let apart = grid.windows(2).map(|pair| pair[1].value - pair[0].value).fold(0.0, f64::max);
    let rows =
        families(&over, (&grid, [f64::NEG_INFINITY, f64::INFINITY]), &|_| apart, (&Sample::Spread(2), Budget::SURVEY));
    let cause = |end: &Option<Transition>| end.as_ref().map(|end| end.cause);
    rows.iter().map(|row| (row.period(), row.range.map(|rpm| rpm / scale), row.ends.each_ref().map(cause))).collect()
}

/// The motion of one impact begins and ends where the textbook has it, and where one ends in a flip that of twice as many begins, however far
/// apart the speeds are that are looked at.
#[test]
fn flips_of_a_ball_follow_one_another_from_speeds_that_are_far_apart() {
    for last in [1000.0, 80_000.0] {
        let found = motions(&[900.0, last], 0, None);
        let of = |impacts: u64| found.iter().find(|(period, ..)| *period == Some((impacts, impacts))).unwrap();
        let one = of(1);
        assert_relative_eq!(one.1[0], 558.804_078_677, max_relative = 1e-11);
        assert_relative_eq!(one.1[1], 978.740_280_410, max_relative = 1e-11);
        assert_eq!(one.2, [Some(Cause::Fold), Some(Cause::Flip)]);
        for (first, then) in [1, 2, 4].map(|impacts| (of(impacts), of(2 * impacts))) {
            assert_eq!((first.2[1], then.2), (Some(Cause::Flip), [Some(Cause::Flip); 2]), "{last}: {then:?}");
            assert_relative_eq!(first.1[1], then.1[0], max_relative = 1e-12);
        }
    }
}

/// In a unit of time that is a power of two all of it is the same to the last bit.
#[test]
fn motions_of_a_ball_are_the_same_in_any_unit_of_time() {
    let found = motions(&[900.0, 1000.0], 0, None);
    assert!(found.len() > 10 && motions(&[900.0, 1000.0], 20, None) == found, "{found:?}");
}

/// An orbit that no run comes to at one speed of three is the same orbit on either side of it.
#[test]
fn an_orbit_that_runs_miss_at_one_speed_is_one() {
    for power in [0, 20, -20] {
        let found = motions(&[700.0, 800.0, 900.0], power, Some(1));
        assert_eq!(found.iter().filter(|(period, ..)| *period == Some((1, 1))).count(), 1, "{power}: {found:?}");
    }
}

/// A ball that loses all is thrown once a revolution, comes down and rests: an impact a revolution for as many as a picture has room for. One that
/// bounces before it rests has more than there is room for.
#[test]
fn a_picture_has_as_many_impacts_as_there_are_or_as_there_is_room_for() {
    for (restitution, rpm, shown) in [(0.0, 1300.0, 120), (0.3, 1100.0, 600)] {
        let ball = ball().with_number("follower.restitution", restitution).unwrap();
        let found = common::speeds(&ball, [rpm, rpm + 1.0], resolution(1.0, 2), &Unwatched).unwrap();
        let [one] = &found.attractors[..] else { panic!("{found:?}") };
        for at in &one.at {
            let impacts = at.ending.period().unwrap().1;
            assert_eq!((at.impact_angles.len(), (120 * impacts).min(600)), (shown, shown as u64), "{at:?}");
        }
    }
}
