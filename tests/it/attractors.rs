//! Are the attractors of a range of speeds those that there are, wherever the range begins and ends?

use approx::{assert_abs_diff_eq, assert_relative_eq};
use proptest::prelude::*;
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU32, Ordering};

use crate::common;
use crate::random::check;
use corner_impact::estimate::{ErrorIs, Estimate};
use corner_impact::model::Model;
use corner_impact::orbit::long_run::{Budget, Kind, LongRun, Recorded, StickingOrbit};
use corner_impact::orbit::runs::{AfterRelease, LongRuns, RunOutcome};
use corner_impact::orbit::{Course, Parameter, PeriodicOrbit, Search, search};
use corner_impact::progress::Unwatched;
use corner_impact::simulate::{Event, EventKind, ImpactTally, Machine, Motion, SimulateError, angular_velocity};
use corner_impact::study::attractors::{
    AttractorsAtValue, AttractorsError, Cause, GridValue, Resolution, StableRange, Step, Transition, attractors,
};
use corner_impact::study::basins::{Grid, SectionStarts};
use corner_impact::study::speeds::{At, AttractorRow, SpeedSurvey, usual_range};
use corner_impact::study::survey::{Over, Sample, Spacing, Starts};

/// A ball on a table that goes up and down by a millimetre.
pub fn ball() -> Model {
    let text = "[follower]\nmass = 1.0\ndamping = 0.0\nstiffness = 0.0\ngravity = 9.81\nrest_position = 0.0\nrestitution = 0.8\n\
                [cam]\nlaw = \"harmonic\"\noffset = 0.0\namplitudes = [0.001]\nphases_deg = [0.0]\n";
    Model::parse("ball.toml", text).unwrap()
}

/// What a motion comes to that settles on nothing, of so much growth with so much error, as much in the first half of its record as in the second.
pub fn by_growth(value: f64, error: f64) -> LongRun {
    let growth = Estimate { value, error, error_is: ErrorIs::Standard };
    let met = ImpactTally { impacts: 100, impact_speed: 1.0 };
    LongRun::by_growth(Recorded { growth, halves: [50.0 * value; 2], met, revolutions: 100, runs: 1, rested: false })
}

fn found(model: &Model, range: [f64; 2], step: f64, starts: usize) -> SpeedSurvey {
    let found = common::speeds(model, range, &Resolution::new(common::step(step), starts), &Unwatched).unwrap();
    for attractor in &found.attractors {
        let ends = [(attractor.range()[0], &attractor.birth), (attractor.range()[1], &attractor.death)];
        // What ends inside of the range does so for a reason.
        let for_nothing = ends.iter().find(|(rpm, end)| end.is_none() && range[0] < *rpm && *rpm < range[1]);
        assert!(for_nothing.is_none(), "{}: {attractor:?}", model.name);
    }
    found
}

fn machine(model: &Model, rpm: f64) -> Machine {
    Machine::new(common::cam(model), &model.follower, angular_velocity(rpm))
}

fn periodic(found: &SpeedSurvey, numbers: (u64, u64)) -> Option<&AttractorRow> {
    found
        .attractors
        .iter()
        .find(|attractor| (attractor.revolutions, attractor.impacts) == (Some(numbers.0), Some(numbers.1)))
}

/// What every attractor begins and ends with, where that was located: kind, cause, speed.
fn events(found: &SpeedSurvey) -> Vec<(Kind, Cause, f64)> {
    let ends = |attractor: &AttractorRow| {
        let kind = attractor.kind;
        let of = move |change: &Transition| (kind, change.cause, change.value());
        [&attractor.birth, &attractor.death].map(|end| end.as_ref().filter(|end| end.is_located()).map(of))
    };
    found.attractors.iter().flat_map(ends).flatten().collect()
}

/// Holmes' ball: it meets the table a cos(theta) once a revolution at one phase. A flight of one revolution begins with
/// `v+ = g T/2` and ends with `-g T/2`, so that the law of impact asks the table for the velocity
/// `-a omega sin(theta) = (1 - r)/(1 + r) g T/2`: it has that from `a omega^2 (1 + r) = pi g (1 - r)` on, and there the motion begins
/// in a fold.
#[test]
#[ignore = "slow"]
fn a_ball_on_a_table_has_the_motions_of_the_textbook_from_any_range() {
    let (a, g, r) = (0.001, 9.81, 0.8_f64);
    let rpm = |omega: f64| omega * 60.0 / std::f64::consts::TAU;
    let fold = rpm((std::f64::consts::PI * g * (1.0 - r) / (1.0 + r) / a).sqrt());
    let detachment = rpm((g / a).sqrt());
    // A multiplier is -1 where a omega^2 cos(theta) is g times (1 + r^2)/(1 + r)^2.
    let (sine, cosine) = (std::f64::consts::PI * (1.0 - r) / (1.0 + r), 2.0 * (1.0 + r * r) / (1.0 + r).powi(2));
    let flip = rpm((g / a * sine.hypot(cosine)).sqrt());
    assert_abs_diff_eq!(fold, 558.804079, epsilon = 1e-6);
    assert_abs_diff_eq!(flip, 978.740280, epsilon = 1e-6);
    for (range, step) in [([500.0, 1400.0], 50.0), ([530.0, 1000.0], 20.0), ([550.0, 960.0], 50.0)] {
        let found = found(&ball(), range, step, 24);
        assert_relative_eq!(found.detachment().unwrap()[0], detachment, max_relative = 1e-12);
        let one = periodic(&found, (1, 1)).unwrap();
        let birth = one.birth.as_ref().unwrap();
        assert_eq!(birth.cause, Cause::Fold);
        assert_relative_eq!(birth.value(), fold, max_relative = 1e-9);
        if let Some(death) = &one.death {
            assert_eq!(death.cause, Cause::Flip);
            assert_relative_eq!(death.value(), flip, max_relative = 1e-9);
        }
        assert_eq!(one.death.is_some(), range[1] > flip);
        // Below the detachment the ball may also stay on the table.
        let both = found.coexistence.iter().find(|over| over.range()[0] < 600.0 && over.range()[1] > 600.0).unwrap();
        assert_eq!(both.attractors.len(), 2);
        assert_abs_diff_eq!(both.range()[0], fold, epsilon = 1e-6);
    }
}

/// Up to 481 rpm some starts bounce on without a rest, beside those that rest now and then. From there these come to rest, too: what bounced
/// on does not go on in the other motion, and ends before the next speed.
#[test]
#[ignore = "slow"]
fn chaos_beside_a_long_motion_ends_before_the_next_speed() {
    let found = found(&common::osorio(), [479.0, 485.0], 2.0, 64);
    let chaotic: Vec<&AttractorRow> = found.attractors.iter().filter(|one| one.kind == Kind::Chaotic).collect();
    let [chaotic] = chaotic[..] else { panic!("{found:?}") };
    assert!(chaotic.range()[0] == 479.0 && (481.0..482.0).contains(&chaotic.range()[1]), "{:?}", chaotic.range());
    assert_eq!(found.coexistence.len(), 1, "{:?}", found.coexistence);
}

/// From the corner impact to where the saddle's manifolds touch, a stable orbit and a chaotic motion, from any range; the shares
/// against a grid of other starts.
#[test]
#[ignore = "slow"]
fn the_paper_s_cam_has_two_motions_up_to_682_rpm() {
    let model = common::osorio();
    let [narrow, wide] =
        [([674.0, 681.0], 1.0), ([660.0, 690.0], 2.0)].map(|(range, step)| found(&model, range, step, 48));
    for found in [&narrow, &wide] {
        let one = periodic(found, (1, 1)).unwrap();
        for rpm in [674.0, 676.0, 678.0, 680.0] {
            let at = found.attractors.iter().flat_map(|attractor| attractor.at.iter().map(move |at| (attractor, at)));
            let here: Vec<_> = at.filter(|(_, at)| at.value() == rpm).collect();
            let [(_, stable), (other, wild)] = here.as_slice() else {
                let [(other, wild), (_, stable)] = here.as_slice() else { panic!("{rpm}: {here:?}") };
                panic!("{rpm}: {other:?} {wild:?} {stable:?}");
            };
            let (stable, other, wild) =
                if other.id == one.id { (wild, here[0].0, stable) } else { (stable, *other, wild) };
            assert!(matches!(other.kind, Kind::Chaotic | Kind::Resting), "{rpm}: {:?}", other.kind);
            let [few, most] = [stable.share.value, wild.share.value];
            assert!(few > 0.0 && most > 0.5 && (few + most - 1.0).abs() < 1e-12);
        }
        assert!(found.coexistence.iter().any(|over| over.range()[0] < 678.0 && over.range()[1] > 678.0));
    }
    let wild =
        wide.attractors.iter().find(|attractor| attractor.range()[0] < 674.0 && attractor.death.is_some()).unwrap();
    let death = wild.death.as_ref().unwrap();
    // By the distance of the manifolds it is between 682.2 and 682.22 rpm; runs that are lost once in a hundred thousand
    // revolutions are taken for lasting ones.
    assert!(death.bracket[0] > 682.19 && death.bracket[1] < 682.23, "{death:?}");
}

/// Speeds that two sweeps, up and down, see two motions at: four hundred starts end alike there.
#[test]
#[ignore = "slow"]
fn one_long_motion_is_one() {
    let model = common::osorio();
    for rpm in [450.0, 541.8, 579.0] {
        let found = found(&model, [rpm - 0.1, rpm + 0.1], 0.1, 32);
        let here =
            found.attractors.iter().filter(|attractor| attractor.at.iter().any(|at| (at.value() - rpm).abs() < 1e-9));
        assert_eq!(here.count(), 1, "{rpm}: {found:?}");
        assert!(found.coexistence.is_empty(), "{rpm}: {:?}", found.coexistence);
        let machine = machine(&model, rpm);
        let grid = Grid { cam_angle: 0.0, positions: [0.4, 4.0], velocities: [-60.0, 60.0], cells: [20, 20] };
        let basins = SectionStarts::Grid(grid).basins(&machine, Budget::SURVEY, None, &Unwatched).unwrap();
        assert_eq!(basins.parts.len(), 1, "{rpm}: {:?}", basins.parts);
    }
}

/// At 478 rpm a motion that rests every hundred revolutions and chaos that does not in two million, side by side, though what rests
/// bounces as chaos does in between. At 358.3 rpm rounding decides whether a run from the cam comes to an orbit or rests again; it
/// comes to one in the end. At 682.25 rpm chaos is left, and at 682.15 rpm it is not.
#[test]
fn what_is_left_by_chance_is_no_attractor_and_what_outlasts_rests_is() {
    let model = common::osorio();
    let kinds = |rpm: f64| {
        let here = AttractorsAtValue::new(&machine(&model, rpm), &Sample::Spread(64), Budget::SURVEY).unwrap();
        here.attractors
            .iter()
            .map(|part| (part.ending.kind(), part.ending.is_long(), here.count(part)))
            .collect::<Vec<_>>()
    };
    let [(Kind::Resting, true, most), (Kind::Chaotic, _, few)] = kinds(478.0)[..] else { panic!("{:?}", kinds(478.0)) };
    assert!(few > 1 && most > 50 && few + most == 64, "{few} {most}");
    assert!(kinds(358.3).iter().all(|(kind, ..)| *kind == Kind::Periodic), "{:?}", kinds(358.3));
    assert!(matches!(kinds(682.25)[..], [(Kind::Periodic, ..)]), "{:?}", kinds(682.25));
    assert_eq!(kinds(682.15).len(), 2, "{:?}", kinds(682.15));
}

/// From rest alone, where the follower is let go and comes to wander: what is kept of that is chaos, and not how it began.
#[test]
fn what_wanders_from_a_rest_is_told_from_where_it_has_forgotten_that() {
    let here = AttractorsAtValue::new(&machine(&common::osorio(), 380.0), &Sample::Spread(0), Budget::SURVEY).unwrap();
    let [part] = &here.attractors[..] else { panic!("{here:?}") };
    assert!(matches!(part.ending, LongRun::Chaotic(_)) && part.motion.revolution > 50, "{part:?}");
}

/// A release is followed by the same motion each time, however long that is and whatever came before.
#[test]
fn a_motion_that_rests_repeats_from_its_release_on() {
    let model = common::osorio();
    for (rpm, long) in [(150.0, false), (236.0, false), (324.0, false), (300.0, true), (600.0, true)] {
        let machine = machine(&model, rpm);
        let settling = LongRuns::new(&machine, Budget { longest: 8, ..Budget::SURVEY }).unwrap();
        let mut motion = machine.start_on_cam(0.0, 0.0).unwrap();
        let RunOutcome::Released(release) = settling.run(&mut motion, 10_000).unwrap() else { panic!("{rpm}") };
        let AfterRelease::Recurs(rests) = settling.after_release(release, settling.budget.rest(), |_| None).unwrap().0
        else {
            panic!("{rpm}")
        };
        assert_eq!(rests.is_long(), long, "{rpm}: {rests:?}");
        // The event loop by itself, with neither: so many revolutions and impacts from one release to the same one.
        let mut motion = settling.released(rests.releases[0]).unwrap();
        let (begun, mut impacts, mut releases) = (motion, 0, 0);
        while releases < rests.releases.len() {
            let goal = motion.after(8);
            let flow = machine.advance(&mut motion, goal, &mut |event: &Event| {
                impacts += u64::from(event.kind == EventKind::Impact);
                if event.kind == EventKind::Release { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            });
            releases += usize::from(flow.unwrap().is_break());
            assert!(motion.revolution - begun.revolution < 50_000, "{rpm}");
        }
        assert_abs_diff_eq!(motion.cam_angle, begun.cam_angle, epsilon = 1e-9);
        if !long {
            assert_eq!((motion.revolution - begun.revolution, impacts), (rests.revolutions, rests.impacts), "{rpm}");
        }
        assert_eq!(LongRun::Sticking(rests).kind(), Kind::Resting);
    }
}

/// A run that passes by a stable orbit has not arrived; one that starts on it, or in its basin, has.
#[test]
fn a_run_arrives_where_its_distance_shrinks() {
    let model = common::osorio();
    let machine = machine(&model, 700.0);
    let settling = LongRuns::new(&machine, Budget { longest: 8, ..Budget::SURVEY }).unwrap();
    let orbit = settling.known().next().unwrap().clone();
    let mut on_it = machine.start(0.0, orbit.state).unwrap();
    assert!(matches!(settling.run(&mut on_it, 100).unwrap(), RunOutcome::Arrives(found) if found == orbit));
    let saddle =
        corner_impact::orbit::search(&machine, &corner_impact::orbit::Search { revolutions: 1, impacts: Some(1) })
            .unwrap()
            .into_iter()
            .find(|orbit| !orbit.is_stable())
            .unwrap();
    // On the saddle to the last bit a run stays for a while.
    let mut passing = machine.start(0.0, saddle.state).unwrap();
    assert_eq!(settling.run(&mut passing, 8).unwrap(), RunOutcome::Wanders);
}

/// Of the paper's cam at 356 rpm an orbit of two impacts in one revolution draws one start of eight. A single start, alike at all speeds nearby,
/// is none of them; the list of those orbits has it, and a run from a neighbouring speed, which begins on that of its own, comes to it.
#[test]
fn runs_begin_on_all_orbits_of_two_impacts_where_that_is_asked_for() {
    let paper = common::osorio();
    let at = |two_impacts: bool| {
        let resolution = Resolution { two_impacts, ..Resolution::new(common::step(0.01), 1) };
        common::speeds(&paper, [356.0, 356.01], &resolution, &Unwatched).unwrap()
    };
    let (without, with) = (at(false), at(true));
    assert!(periodic(&without, (1, 2)).is_none() && without.coexistence.is_empty(), "{without:?}");
    assert!(periodic(&with, (1, 2)).is_some() && with.coexistence.len() == 1, "{with:?}");
    assert_eq!([without.two_impacts, with.two_impacts], [false, true]);
}

#[test]
fn speeds_of_a_grid_are_the_same_for_every_range() {
    assert_eq!(Step::for_values([50.0, 760.0], 300, corner_impact::study::survey::Spacing::Linear).width(), 2.0);
    assert_eq!(Step::for_values([500.0, 1400.0], 300, corner_impact::study::survey::Spacing::Linear).width(), 3.0);
    assert_eq!(common::step(0.3).width(), 0.3);
    assert_eq!(common::step(0.5).width(), 0.5);
    assert_eq!(common::step(0.001).width(), 0.001);
    assert_eq!(common::step(19.9).width(), 10.0);
    let refused = |range, step| {
        let resolution = Resolution::new(common::step(step), 1);
        common::speeds(&common::osorio(), range, &resolution, &Unwatched).unwrap_err()
    };
    assert!(matches!(refused([0.0, 700.0], 1.0), AttractorsError::NoRange { .. }));
    assert!(matches!(refused([700.0, 700.0], 1.0), AttractorsError::NoRange { .. }));
    assert!(matches!(refused([700.0, f64::INFINITY], 1.0), AttractorsError::NoRange { .. }));
    assert!(matches!(refused([600.0, 700.0], 1e-9), AttractorsError::TooFine { .. }));
    assert!(matches!(refused([600.0, 700.0], 1e-300), AttractorsError::TooFine { .. }));
}

/// What located events there are, by rising speed.
fn sorted_events(found: &[SpeedSurvey]) -> Vec<(Kind, Cause, f64)> {
    let mut all: Vec<_> = found.iter().flat_map(events).collect();
    all.sort_by(|one, two| one.2.total_cmp(&two.2).then(one.1.name().cmp(two.1.name())));
    all
}

/// In so many parts of a range there are the located events of the whole, its kinds of motion at each speed, and its attractors side by
/// side.
fn parts_agree(model: &Model, whole: &SpeedSurvey, step: f64, parts: u32) {
    let [low, high] = whole.range;
    let ends: Vec<f64> = (0..=parts).map(|part| low + (high - low) * f64::from(part) / f64::from(parts)).collect();
    let each: Vec<SpeedSurvey> =
        ends.windows(2).map(|range| found(model, [range[0], range[1]], step, whole.sample.count())).collect();
    let (joined, all) = (sorted_events(&each), sorted_events(std::slice::from_ref(whole)));
    assert_eq!(joined.len(), all.len(), "{} in {parts}: {joined:?} {all:?}", model.name);
    for (one, two) in joined.iter().zip(&all) {
        assert_eq!((one.0, one.1.name()), (two.0, two.1.name()));
        assert_relative_eq!(one.2, two.2, max_relative = 1e-9);
    }
    let kinds = |found: &SpeedSurvey, rpm: f64| {
        let here = found.attractors.iter().flat_map(|attractor| &attractor.at).filter(|at| at.value() == rpm);
        let mut kinds: Vec<_> = here.map(|at| (at.ending.kind(), at.ending.period())).collect();
        kinds.sort();
        kinds
    };
    let several =
        |found: &SpeedSurvey, rpm: f64| found.coexistence.iter().any(|it| it.range()[0] < rpm && rpm < it.range()[1]);
    for rpm in whole.attractors.iter().flat_map(|attractor| attractor.at.iter().map(|at| at.value())) {
        let part = each.iter().find(|found| found.range[0] <= rpm && rpm <= found.range[1]).unwrap();
        assert_eq!(kinds(part, rpm), kinds(whole, rpm), "{} at {rpm}", model.name);
        let is_inside = part.range[0] < rpm && rpm < part.range[1];
        assert!(!is_inside || several(part, rpm) == several(whole, rpm), "{} at {rpm}", model.name);
    }
}

/// At half the step there are the located events of the whole step, and where that knows an end by runs, an end within its bracket.
fn resolutions_agree(model: &Model, coarse: &SpeedSurvey, step: f64) {
    let fine = found(model, coarse.range, 0.5 * step, coarse.sample.count());
    let changes = |found: &SpeedSurvey| -> Vec<Transition> {
        found.attractors.iter().flat_map(|attractor| [&attractor.birth, &attractor.death]).flatten().cloned().collect()
    };
    for end in changes(coarse) {
        let room = 1e-9 * end.value();
        let [low, high] = if end.is_located() { [end.value(); 2] } else { end.bracket };
        let is_there = |other: &Transition| {
            let [from, to] = if other.is_located() { [other.value(); 2] } else { other.bracket };
            from <= high + room && low - room <= to && (other.cause.name() == end.cause.name() || !end.is_located())
        };
        assert!(changes(&fine).iter().any(is_there), "{}: {end:?} is not among {:?}", model.name, changes(&fine));
    }
}

/// The attractors of the parts of a range are those of the whole, and those of twice the resolution, too. Here three models in 4 parts;
/// `make properties` has twelve, in 2 to 16, and both resolutions.
#[test]
#[ignore = "slow"]
fn a_part_of_a_range_has_its_part_of_the_answer() {
    let model = |name: &str| common::read(&std::path::Path::new(common::ROOT).join("models").join(name));
    let mut models = vec![
        (common::osorio(), [660.0, 700.0], 2.5),
        (ball(), [520.0, 1000.0], 40.0),
        (model("laws/polynomial.toml"), [60.0, 140.0], 5.0),
    ];
    let is_whole = crate::common::is_whole();
    if is_whole {
        models.extend([
            (model("damped-light.toml"), [660.0, 700.0], 2.5),
            (model("overdamped.toml"), [650.0, 690.0], 2.5),
            (model("nonsmooth-flip.toml"), [860.0, 900.0], 2.5),
            (model("persistence.toml"), [480.0, 510.0], 2.0),
            (model("ballistic.toml"), [220.0, 260.0], 2.5),
            (model("laws/harmonic.toml"), [600.0, 640.0], 2.5),
            (model("laws/rectified-sine.toml"), [300.0, 340.0], 2.5),
            (model("laws/program.toml"), [600.0, 640.0], 5.0),
            (model("laws/table-cubic.toml"), [665.0, 685.0], 2.5),
        ]);
    }
    let parts: &[u32] = if is_whole { &[2, 4, 8, 16] } else { &[4] };
    for (model, range, step) in models {
        let clock = std::time::Instant::now();
        let whole = found(&model, range, step, 24);
        parts.iter().for_each(|parts| parts_agree(&model, &whole, step, *parts));
        if is_whole {
            resolutions_agree(&model, &whole, step);
        }
        println!("{} {range:?}: {} events, {:.1} s", model.name, events(&whole).len(), clock.elapsed().as_secs_f64());
    }
}

/// Orbits that live between few speeds, at two resolutions: one of five revolutions whose branch comes back to its own start, and those of
/// twice the period that begin in flips, one of them over a twentieth of a revolution a minute. None is there twice.
#[test]
#[ignore = "slow"]
fn orbits_between_two_speeds_are_found() {
    let model = common::read(&std::path::Path::new(common::ROOT).join("models/nonsmooth-flip.toml"));
    for step in [2.0, 1.0] {
        let found = found(&model, [880.0, 884.0], step, 8);
        for (numbers, causes, rpm) in [
            ((5, 5), ["corner-impact", "flip"], [881.009_343_574, 883.652_699]),
            ((4, 4), ["", "flip"], [880.0, 881.772_288_078]),
            ((8, 8), ["flip", "corner-impact"], [881.772_288_078, 881.825_084_122]),
        ] {
            let one = periodic(&found, numbers).unwrap_or_else(|| panic!("no {numbers:?} at {step}: {found:?}"));
            let named = [&one.birth, &one.death].map(|end| end.as_ref().map_or("", |end| end.cause.name()));
            assert_eq!(named, causes, "{numbers:?} at {step}");
            assert_abs_diff_eq!(one.range()[0], rpm[0], epsilon = 1e-6);
            assert_abs_diff_eq!(one.range()[1], rpm[1], epsilon = 1e-6);
            let same = found
                .attractors
                .iter()
                .filter(|other| (other.revolutions, other.impacts) == (one.revolutions, one.impacts));
            assert_eq!(same.count(), 1, "{numbers:?} at {step}");
        }
    }
}

/// Whether a run that has settled, at cam angle 0, is on the motion that is listed: told by where it goes and what it meets in one period.
fn is_on(machine: &Machine, mut motion: Motion, ending: &LongRun) -> bool {
    let size = machine.cam().top().abs().max(motion.state.position.abs()) * 1e-4;
    let mut events = Vec::new();
    let mut goes_on = |motion: &mut Motion, revolutions: u64| {
        let goal = motion.after(revolutions);
        let mut see = |event: &Event| {
            events.push(*event);
            ControlFlow::Continue(())
        };
        machine.advance(motion, goal, &mut see).is_ok().then(|| std::mem::take(&mut events))
    };
    let before = motion.state;
    match ending {
        LongRun::Orbit(orbit) => {
            let Some(events) = goes_on(&mut motion, orbit.revolutions) else { return false };
            let fast = (motion.state.velocity - before.velocity) / machine.angular_velocity();
            let impacts = events.iter().filter(|event| event.kind == EventKind::Impact).count();
            let apart = (motion.state.position - before.position).hypot(fast);
            // What swings above the cam for ever, or drifts there, repeats nothing and meets nothing.
            impacts == orbit.impacts().count() && (apart < size || impacts == 0)
        }
        LongRun::PermanentContact => motion.contact && goes_on(&mut motion, 1).is_some_and(|events| events.is_empty()),
        LongRun::Sticking(resting) => {
            let Some(events) = goes_on(&mut motion, 20 * resting.between_rests().ceil() as u64) else { return false };
            let releases = events.iter().filter(|event| event.kind == EventKind::Release);
            let mut near =
                releases.map(|event| resting.releases.iter().any(|angle| (event.cam_angle - angle).abs() < 1e-3));
            resting.is_long() || near.next_back() == Some(true)
        }
        LongRun::Chaotic(_) | LongRun::Undecided(_) => true,
    }
}

/// Eight plain runs from other starts of the same rectangle, looked at after thousands of revolutions by nothing that tells what the
/// listed runs end on: where half of the starts or more are said to end on a motion, one of the eight does, and no more of them
/// end on none than a basin has that the sample may miss.
#[test]
#[ignore = "slow"]
fn plain_runs_end_on_what_is_listed() {
    static LOOKED_AT: AtomicU32 = AtomicU32::new(0);
    let cases = if common::is_whole() { 40 } else { 10 };
    check(cases, |case| {
        // Each of thousands of revolutions would be as many swings, or hundreds of impacts without loss.
        let swings = case.machine.flight().omega0_squared().sqrt() / case.machine.angular_velocity();
        if swings > 12.0 || case.model.follower.restitution == 1.0 {
            return Ok(());
        }
        let step = common::step(0.2 * case.rpm);
        let range = [0.8 * case.rpm, 1.2 * case.rpm];
        let budget = Budget { patience: 10_000, ..Budget::SURVEY };
        let resolution = Resolution { budget, ..Resolution::new(step, 32) };
        let Ok(found) = common::speeds(&case.model, range, &resolution, &Unwatched) else {
            return Ok(());
        };
        let listed = found.attractors.iter().flat_map(|attractor| &attractor.at);
        let mut all: BTreeMap<u64, Vec<&At>> = BTreeMap::new();
        listed.for_each(|at| all.entry(at.value().to_bits()).or_default().push(at));
        for here in all.values() {
            let machine = case.machine.at_speed(angular_velocity(here[0].value()));
            let starts = Starts::of(&machine);
            let settled = |index: usize| {
                let mut motion = starts.motion(&machine, index)?;
                machine.revolve(&mut motion, 3000)?;
                machine.turn_to(&mut motion, 0.0).map(|()| motion)
            };
            let Ok(runs) = (1_000_000..1_000_008).map(settled).collect::<Result<Vec<_>, SimulateError>>() else {
                continue;
            };
            let on = |at: &At| runs.iter().filter(|run| is_on(&machine, **run, &at.ending)).count();
            let missed = runs.iter().filter(|run| !here.iter().any(|at| is_on(&machine, **run, &at.ending))).count();
            // Of eight, four in a basin of a tenth are one chance in two hundred.
            prop_assert!(missed < 4, "{missed} of 8 at {} rpm are on none of {here:#?}", here[0].value());
            for at in here {
                prop_assert!(
                    at.share.value - at.share.error < 0.5 || on(at) > 0,
                    "at {} rpm none is on {at:#?}",
                    at.value()
                );
            }
            LOOKED_AT.fetch_add(1, Ordering::Relaxed);
        }
        Ok(())
    });
    assert!(LOOKED_AT.load(Ordering::Relaxed) > 3 * cases / 2, "{LOOKED_AT:?} speeds");
}

/// Two that rest are one motion where they have a release in common, or both rest so seldom that it is chance; chaos is one with what rests as
/// seldom, and an orbit with itself alone.
#[test]
fn endings_are_told_apart() {
    let rests = |releases: &[f64], growth: f64| {
        let releases = releases.to_vec();
        StickingOrbit { releases, revolutions: 7, impacts: 5, impact_speed: 1.0, growth }
    };
    let [short, long] = [1.0, 60.0];
    assert!(!rests(&[1.0], 22.0).is_long() && rests(&[1.0], 23.0).is_long());
    assert_eq!(rests(&[1.0, 2.0], short).between_rests(), 3.5);
    let one = LongRun::Sticking(rests(&[1.0, 2.0], short));
    let same = LongRun::Sticking(rests(&[2.0], short));
    let other = LongRun::Sticking(rests(&[3.0], short));
    let [seldom, as_seldom] = [4.0, 5.0].map(|release| LongRun::Sticking(rests(&[release], long)));
    let [chaotic, undecided] = [by_growth(1.0, 0.1), by_growth(0.01, 0.1)];
    assert_eq!([chaotic.kind(), undecided.kind()], [Kind::Chaotic, Kind::Undecided]);
    let model = common::osorio();
    let [orbits, others] = [700.0, 710.0].map(|rpm| {
        let machine = machine(&model, rpm);
        search(&machine, &Search { revolutions: 1, impacts: Some(1) }).unwrap()
    });
    let orbit = |orbit: &PeriodicOrbit| LongRun::Orbit(orbit.clone());
    let are = |one: &LongRun, two: &LongRun| one.is_same(two) && two.is_same(one);
    assert!(
        are(&one, &same)
            && are(&seldom, &as_seldom)
            && are(&seldom, &chaotic)
            && are(&LongRun::PermanentContact, &LongRun::PermanentContact)
    );
    assert!(are(&orbit(&orbits[0]), &orbit(&orbits[0])) && are(&undecided, &undecided));
    let apart = [
        &one,
        &other,
        &seldom,
        &undecided,
        &LongRun::PermanentContact,
        &orbit(&orbits[0]),
        &orbit(&orbits[1]),
        &orbit(&others[0]),
    ];
    for (index, one) in apart.iter().enumerate() {
        assert!(apart[..index].iter().all(|two| !one.is_same(two) && !two.is_same(one)), "{one:?}");
    }
    assert!(!one.is_same(&chaotic) && !chaotic.is_same(&one) && !undecided.is_same(&chaotic));
    assert_eq!([one.between_rests(), chaotic.between_rests()], [Some(3.5), None]);
    assert_eq!([&chaotic, &undecided].map(|it| (it.growth().value, it.growth().error)), [(1.0, 0.1), (0.01, 0.1)]);
    assert_eq!([&one, &LongRun::PermanentContact].map(|it| it.growth().value), [f64::NEG_INFINITY; 2]);
    // A stable orbit's is that of its multipliers: r a revolution of one impact.
    let settled = LongRun::Orbit(orbits.iter().find(|orbit| orbit.is_stable()).unwrap().clone());
    assert_relative_eq!(settled.growth().value, 0.5 * 0.64_f64.ln(), max_relative = 1e-3);
    // Followers that rest all the time, or for a while, and one that never meets the cam.
    let stuck = |rpm: f64| {
        let machine = machine(&model, rpm);
        let all = search(&machine, &Search { revolutions: 1, impacts: None }).unwrap();
        all.into_iter().find(|orbit| matches!(orbit.course, Course::Sticking(_))).unwrap()
    };
    let [always, at_150, at_160] = [100.0, 150.0, 160.0].map(stuck);
    let free = PeriodicOrbit { course: Course::Free, ..always.clone() };
    let twice = PeriodicOrbit { revolutions: 2, ..at_150.clone() };
    let apart = [&always, &at_150, &at_160, &twice, &free, &orbits[0]];
    for (index, one) in apart.iter().enumerate() {
        assert!(one.is_same(one), "{one:?}");
        assert!(apart[..index].iter().all(|two| !one.is_same(two) && !two.is_same(one)), "{one:?}");
    }
    assert_eq!([one.is_long(), seldom.is_long(), chaotic.is_long()], [false, true, false]);
    assert_eq!([one.period(), seldom.period(), LongRun::PermanentContact.period()], [Some((7, 5)), None, Some((1, 0))]);
}

/// From below where the follower leaves the cam, 0.8 of that speed, to twice it; where it never does, from half to twice the speed at
/// which the cam moves with the follower's own acceleration; to two digits.
#[test]
fn a_range_of_speeds_is_chosen_by_the_machine() {
    let range = |follower: &str, cam: &str| {
        let text = format!("[follower]\nmass = 2.0\nrestitution = 0.5\n{follower}\n[cam]\nlaw = \"harmonic\"\n{cam}\n");
        usual_range(&Model::parse("machine.toml", &text).unwrap()).unwrap()
    };
    let cam = "offset = 0.1\namplitudes = [0.02]\nphases_deg = [0.0]";
    let to_two = |value: f64, towards: fn(f64) -> f64| {
        let scale = 10_f64.powf(1.0 - value.log10().floor());
        towards(value * scale) / scale
    };
    let rpm = |squared: f64| squared.sqrt() * 60.0 / TAU;
    // w^2 A = k/m (c - rest) + g where the cam is highest, at c = 0.12.
    let pressed = "damping = 0.0\nstiffness = 800.0\ngravity = 9.81\nrest_position = 0.05";
    let leaves = rpm((400.0 * 0.07 + 9.81) / 0.02);
    assert_eq!(range(pressed, cam), [to_two(0.8 * leaves, f64::floor), to_two(2.0 * leaves, f64::ceil)]);
    // A spring that pulls it off at rest, k/m (rest - c_min) - g at c = 0.08: it is off the cam at any speed.
    let pulled = "damping = 3.0\nstiffness = 800.0\ngravity = 9.81\nrest_position = 0.25";
    let own = rpm(400.0 + (400.0 * (0.25 - 0.08) - 9.81) / 0.04);
    assert_eq!(range(pulled, cam), [to_two(0.5 * own, f64::floor), to_two(2.0 * own, f64::ceil)]);
    // A damper alone has b/m, and nothing at all no scale.
    let damped = "damping = 30.0\nstiffness = 0.0\ngravity = 0.0\nrest_position = 0.0";
    let own = 15.0 * 60.0 / TAU;
    assert_eq!(range(damped, cam), [to_two(0.5 * own, f64::floor), to_two(2.0 * own, f64::ceil)]);
    let nothing = "damping = 0.0\nstiffness = 0.0\ngravity = 0.0\nrest_position = 0.0";
    assert_eq!(range(nothing, cam), [50.0, 200.0]);
    // A cam that does not move has no height, by rounding neither: its own distance from 0 is taken for it.
    let own = rpm(400.0 + (400.0 * 0.05 - 9.81) / 0.1);
    let still = "offset = 0.1\namplitudes = [0.0]\nphases_deg = [0.0]";
    assert_eq!(range(pressed, still), [to_two(0.5 * own, f64::floor), to_two(2.0 * own, f64::ceil)]);
    // No more than of one without a force is known of a machine whose own speed is beyond all numbers.
    let beyond = "damping = 0.0\nstiffness = 1e70\ngravity = 0.0\nrest_position = 10.0";
    assert_eq!(range(beyond, &still.replace("0.1", "1e-250")), [50.0, 200.0]);
}

/// What twenty-four starts, and rest on the cam, come to at a speed.
fn from_starts(model: &Model, rpm: f64) -> AttractorsAtValue {
    AttractorsAtValue::new(&machine(model, rpm), &Sample::Spread(24), Budget::SURVEY).unwrap()
}

/// In a hundred thousand revolutions runs bounced on for long before they came to rest: a start that was not seen to rest was only not waited for.
#[test]
fn chaos_that_is_seen_to_rest_is_no_other_motion_than_what_rests() {
    for rpm in [655.0, 665.2, 668.1] {
        let here = from_starts(&common::osorio(), rpm);
        assert!(here.wandering.rested > 0 && here.wandering.revolutions >= 100_000, "{rpm}: {:?}", here.wandering);
        let wild: Vec<&LongRun> =
            here.attractors.iter().map(|part| &part.ending).filter(|it| it.period().is_none()).collect();
        assert!(matches!(wild[..], [it] if it.is_long()), "{rpm}: {wild:?}");
    }
}

/// The growth of deviations is averaged over the runs that wander: what is too short to tell it by itself counts with the others.
#[test]
fn runs_that_wander_are_told_together() {
    let here = from_starts(&ball().with_number("follower.restitution", 0.5).unwrap(), 2155.0);
    let kinds: Vec<Kind> = here.attractors.iter().map(|part| part.ending.kind()).collect();
    assert_eq!(kinds, [Kind::Resting, Kind::Chaotic], "{here:?}");
    assert_eq!(here.attractors[1].starts.len(), 3);
}

/// Whatever rests goes on as the cam lets go of it. Where all that is repeats, each run that wandered until it rested has left what it was on.
#[test]
fn what_wanders_and_rests_where_all_repeats_has_left() {
    for rpm in [304.8, 333.4, 334.0] {
        let here = from_starts(&common::osorio(), rpm);
        assert!(here.attractors.iter().all(|part| part.ending.period().is_some()), "{rpm}: {:?}", here.attractors);
        assert!(
            here.wandering.rested > 0 && here.wandering.left == here.wandering.rested,
            "{rpm}: {:?}",
            here.wandering
        );
    }
}

/// A run that wandered for long has come to an orbit in the end. Whatever goes on as it did is on its way there, whether it has rested or
/// not; what rests and repeats soon is a motion of its own, that a follower at rest on the table goes on with as well.
#[test]
fn what_is_left_in_the_end_is_left_from_its_rests_and_what_repeats_is_not() {
    for (restitution, rpm, rests) in [(0.65, 1052.9, 1), (0.7, 1257.9, 1)] {
        let model = ball().with_number("follower.restitution", restitution).unwrap();
        let here = from_starts(&model, rpm);
        assert!(here.wandering.left > 0, "{rpm}: {:?}", here.wandering);
        assert!(here.attractors.iter().all(|part| part.ending.period().is_some()), "{rpm}: {:?}", here.attractors);
        let resting = here.attractors.iter().filter(|part| part.ending.kind() == Kind::Resting);
        assert_eq!(resting.count(), rests, "{rpm}: {:?}", here.attractors);
    }
}

/// A ball that bounces little has motions of two and of three impacts a revolution over a few revolutions a minute, far between the
/// speeds of the grid: runs come to them right below the lower end of one that goes on from there.
#[test]
#[ignore = "slow"]
fn orbits_below_the_end_of_another_are_found() {
    let model = ball().with_number("follower.restitution", 0.1).unwrap();
    let found = found(&model, [1498.0, 1520.0], 200.0, 1);
    for (numbers, rpm) in [((1, 2), [1503.7839, 1514.5427]), ((1, 3), [1498.7194, 1500.5706])] {
        let one = periodic(&found, numbers).unwrap_or_else(|| panic!("no {numbers:?}: {found:?}"));
        assert_abs_diff_eq!(one.range()[0], rpm[0], epsilon = 1e-3);
        assert_abs_diff_eq!(one.range()[1], rpm[1], epsilon = 1e-3);
    }
}

/// A step leads from one value of a grid to the next, of logarithms as well.
#[test]
fn a_step_leads_from_one_value_to_the_next() {
    for (spacing, ends) in [(Spacing::Linear, [100.0, 101.0]), (Spacing::Logarithmic, [2.0, 2.1])] {
        let step = Step::at_most(0.01, spacing);
        let values: Vec<f64> = step.over(ends).collect();
        assert!(values.len() > 8, "{values:?}");
        for pair in values.windows(2) {
            assert_relative_eq!(step.near(pair[0]), pair[1] - pair[0], max_relative = 1e-9);
        }
    }
}

/// The stable orbit of one impact at a value.
fn one_impact(over: &Over<'_>, value: f64) -> PeriodicOrbit {
    let machine = over.machine(value).unwrap();
    LongRuns::new(&machine, Budget::SURVEY).unwrap().known().next().unwrap().clone()
}

/// A range of stable orbits has none beyond its ends.
#[test]
fn a_stable_range_has_no_orbit_beyond_its_ends() {
    let paper = common::osorio();
    let over = Over::speed(&paper).unwrap();
    let stable = StableRange::all(&over, 700.0, &one_impact(&over, 700.0), [700.0; 2], 1.0).unwrap();
    let [low, high] = stable.ends();
    assert!(low < 700.0 && 700.0 < high);
    for (value, is_there) in [(low - 1e-3, false), (low + 1e-3, true), (high - 1e-3, true), (high + 1e-3, false)] {
        assert_eq!(stable.near(value).is_some(), is_there, "{value}");
    }
    // Beyond the flip one of twice the period begins, whatever the steps of the grid.
    let next = stable.beyond(&over, 1e-9);
    let is_doubled = |orbit: &PeriodicOrbit| (orbit.revolutions, orbit.impacts().count()) == (2, 2);
    assert!(next.iter().any(|(rpm, orbit)| *rpm > high && is_doubled(orbit)), "{next:?}");
}

/// A branch that nothing ends is followed for 64 times the margin of three steps, and no farther.
#[test]
fn a_stable_range_that_nothing_ends_is_followed_no_farther() {
    let paper = common::osorio();
    let over = Over::new(&paper, Parameter::Field("follower.gravity".into()), Some(700.0)).unwrap();
    let stable = StableRange::all(&over, 0.0, &one_impact(&over, 0.0), [0.0; 2], 1e-6).unwrap();
    assert_eq!(stable.ends, [None, None]);
    let [low, high] = stable.ends();
    assert_abs_diff_eq!(low, -64.0 * 3e-6, epsilon = 1e-9);
    assert_abs_diff_eq!(high, 64.0 * 3e-6, epsilon = 1e-9);
}

/// An attractor that is found by runs alone ends at one value, and a second search on the same machine finds that end again. A motion that rests
/// every few revolutions counts as one with chaos, unless both are there at a value.
#[test]
fn an_end_by_runs_is_found_once_more() {
    let paper = common::osorio();
    let over = Over::speed(&paper).unwrap();
    let budget = Budget { transient: 300, record: 50, longest: 8, patience: 0 };
    let resolution = Resolution { budget, ..Resolution::new(common::step(5.0), 4) };
    let found = attractors(&over, [190.0, 245.0], &resolution, &Unwatched).unwrap();
    let runs = (&Sample::Spread(4), budget);
    let (mut ends, mut of_another_kind) = (0, 0);
    for family in &found.families {
        for (side, place) in [family.at.iter().next(), family.at.iter().next_back()].into_iter().enumerate() {
            let (Some(end), Some((index, attractor))) = (&family.ends[side], place) else { continue };
            let width = end.bracket[1] - end.bracket[0];
            let is_found = |grid: &[GridValue]| {
                let moved = family.moved(&over, grid, runs, side);
                moved.is_some_and(|rpm| (rpm - end.value()).abs() < 2.0 * width)
            };
            assert!(end.cause == Cause::Runs && is_found(&found.grid), "{side}: {end:?}");
            ends += 1;
            let mut grid = found.grid.clone();
            let here = grid[*index].found.as_mut().unwrap();
            if matches!(&here.attractors[*attractor].ending, LongRun::Sticking(resting) if resting.revolutions > 1) {
                here.attractors[*attractor].ending = by_growth(1.0, 0.1);
                assert!(is_found(&grid), "{side}: {end:?}");
                of_another_kind += 1;
            }
        }
    }
    assert!(ends >= 4 && of_another_kind >= 2, "{ends} {of_another_kind}");
}
