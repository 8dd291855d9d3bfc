//! Are the lists of orbits that are said to be all there is, all there is; and is nothing said where nothing can be?

use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicU32, Ordering};

use crate::{common, random};
use corner_impact::cam::{Cam, apart};
use corner_impact::corner::range::find_corner_impacts;
use corner_impact::known::Evidence;
use corner_impact::model::{Model, Study};
use corner_impact::orbit::{Course, PeriodicOrbit, Search, Searched, search, search_all};
use corner_impact::progress::Unwatched;
use corner_impact::simulate::{Event, EventKind, Goal, Machine, angular_velocity};
use proptest::prelude::*;
use random::check;

fn machine(model: &Model, rpm: f64) -> Machine {
    Machine::new(Cam::new(model).unwrap(), &model.follower, angular_velocity(rpm))
}

fn all(machine: &Machine, impacts: usize) -> Searched {
    search_all(machine, &Search { revolutions: 1, impacts: Some(impacts) }, &Unwatched).unwrap()
}

fn file(name: &str) -> Model {
    common::read(&Path::new(common::ROOT).join("models").join(name))
}

fn is_complete(searched: &Searched) -> bool {
    let [complete] = searched.complete[..] else { panic!("{searched:?}") };
    assert_eq!(complete.known == Evidence::Proved, searched.undecided.is_empty(), "{searched:?}");
    complete.known == Evidence::Proved
}

/// Impacts of each orbit, in degrees.
fn angles(searched: &Searched) -> Vec<Vec<f64>> {
    let of = |orbit: &PeriodicOrbit| orbit.impacts().map(|event| event.cam_angle.to_degrees()).collect();
    searched.orbits.iter().map(of).collect()
}

#[track_caller]
fn are(searched: &Searched, expected: &[&[f64]]) {
    assert!(
        is_complete(searched) && searched.orbits.iter().all(|orbit| orbit.known == Evidence::Proved),
        "{searched:?}"
    );
    let angles = angles(searched);
    let near = |one: &[f64], other: &[f64]| {
        one.len() == other.len() && one.iter().zip(other).all(|(a, b)| (a - b).abs() < 1e-7)
    };
    assert!(
        angles.len() == expected.len() && angles.iter().zip(expected).all(|(one, other)| near(one, other)),
        "{angles:?}"
    );
}

#[test]
fn the_papers_orbits_are_all_found() {
    let paper = common::osorio();
    are(&all(&machine(&paper, 700.0), 1), &[&[104.160829387844754], &[155.303685602748752]]);
    are(&all(&machine(&paper, 700.0), 2), &[&[24.927658265, 158.084998107]]);
    are(&all(&machine(&paper, 736.2), 1), &[&[97.621339376], &[157.321765949]]);
    let three: [&[f64]; 3] =
        [&[49.083027701, 157.337522837], &[89.8553963, 154.9548612], &[90.009638838, 154.942675475]];
    are(&all(&machine(&paper, 736.2), 2), &three);
    are(&all(&machine(&paper, 660.0), 1), &[]);
}

/// One revolution a period, but for models of the folder that need a follower or a speed of their own.
#[test]
fn every_kind_of_follower_and_cam_has_its_list() {
    let mut counts = Vec::new();
    for name in ["damped-light", "damped-heavy", "overdamped", "ballistic", "preloaded", "sharp-nose"] {
        let model = file(&format!("{name}.toml"));
        let study = model.study().unwrap();
        for rpm in [study.rpm_min, 0.5 * (study.rpm_min + study.rpm_max), study.rpm_max] {
            let searched = all(&machine(&model, rpm), 1);
            assert!(is_complete(&searched), "{name} at {rpm}: {searched:?}");
            counts.push(searched.orbits.len());
        }
    }
    assert!(counts.iter().any(|count| *count >= 2) && counts.contains(&0), "{counts:?}");
}

/// A table of 800 rows has 160,000 pairs of segments within half a turn. Nearly all are dropped together with their neighbours.
#[test]
fn the_list_of_a_fine_table_is_complete() {
    let lift = |index: i32| {
        let x = if index <= 400 { f64::from(index) / 400.0 } else { 2.0 - f64::from(index) / 400.0 };
        0.01 * x.powi(3) * (10.0 - 15.0 * x + 6.0 * x * x)
    };
    let rows: String = (0..800).map(|index| format!("[{:?}, {:?}],", 0.45 * f64::from(index), lift(index))).collect();
    let follower = "mass = 0.5\ndamping = 0.0\nstiffness = 1000.0\npreload = 50.0\ngravity = 0.0\nrestitution = 0.6\n";
    let text = format!("[follower]\n{follower}[cam]\nlaw = \"table\"\nspline = \"quintic\"\nrows = [{rows}]\n");
    let table = all(&machine(&Model::parse("table.toml", &text).unwrap(), 1500.0), 2);
    let motion = "motion = \"poly345\"\nspan_deg = 180.0\nrise = ";
    let segments = format!("[[cam.segment]]\n{motion}0.01\n[[cam.segment]]\n{motion}-0.01\n");
    let text = format!("[follower]\n{follower}[cam]\nlaw = \"program\"\nbase = 0.0\n{segments}");
    let program = all(&machine(&Model::parse("program.toml", &text).unwrap(), 1500.0), 2);
    assert!(is_complete(&table) && is_complete(&program), "{table:?} {program:?}");
    let [of_table, of_program] = [&table, &program].map(angles);
    assert_eq!(of_table.len(), of_program.len());
    for (one, other) in of_table.concat().iter().zip(of_program.concat()) {
        assert!((one - other).abs() < 1e-3, "{of_table:?} {of_program:?}");
    }
}

/// Two orbits meet at 131.75 degrees and are gone; the speed itself is left undecided.
#[test]
#[ignore = "slow"]
fn a_fold_is_passed() {
    let (model, fold) = (file("persistence.toml"), 493.811509867092714);
    let [below, at, above] = [fold - 1e-6, fold, fold + 1e-6].map(|rpm| all(&machine(&model, rpm), 1));
    assert!(is_complete(&below) && is_complete(&above), "{below:?} {above:?}");
    assert_eq!(above.orbits.len().abs_diff(below.orbits.len()), 2, "{below:?} {above:?}");
    let near =
        |ends: &[f64; 2]| (ends[0].to_degrees() - 131.75).abs() < 0.01 && (ends[1].to_degrees() - 131.75).abs() < 0.01;
    assert!(!is_complete(&at) && at.undecided.iter().all(|it| near(&it.cam_angles[0])), "{at:?}");
    // Next to it to the last digits one or both may be found, and neither is proved.
    for ulps in -40..=40 {
        let there = all(&machine(&model, fold * (1.0 + f64::from(ulps) * f64::EPSILON)), 1);
        let proved = there.orbits.iter().filter(|orbit| orbit.known == Evidence::Proved).count();
        assert!(is_complete(&there) || proved == below.orbits.len().min(above.orbits.len()), "{ulps}: {there:?}");
    }
}

/// Of two impacts, one on a corner: next to its speed, to the last digits, no more orbits are proved than there are on that side of it.
#[test]
#[ignore = "slow"]
fn a_corner_of_one_of_two_impacts_is_left_undecided() {
    let (paper, corner) = (common::osorio(), 736.110_814_038_711_4);
    let [below, above] = [-1e-6, 1e-6].map(|off| all(&machine(&paper, corner + off), 2));
    assert!(is_complete(&below) && is_complete(&above), "{below:?} {above:?}");
    let [below, above] = [below, above].map(|searched| searched.orbits.len());
    assert_ne!(below, above);
    for ulps in -40..=40 {
        let there = all(&machine(&paper, corner * (1.0 + f64::from(ulps) * f64::EPSILON)), 2);
        let proved = there.orbits.iter().filter(|orbit| orbit.known == Evidence::Proved).count();
        let most = if ulps < -4 {
            below
        } else if ulps > 4 {
            above
        } else {
            below.max(above)
        };
        assert!(proved <= most, "{ulps}: {there:?}");
    }
}

/// At the speed of the corner impact the impact is on neither side for certain.
#[test]
fn a_corner_is_left_undecided() {
    let (paper, corner) = (common::osorio(), 150.179371797);
    let [below, at, above] = [-1e-6, 0.0, 1e-6].map(|off| all(&machine(&paper, 673.234445003812032781 + off), 1));
    assert!(is_complete(&below) && is_complete(&above), "{below:?} {above:?}");
    assert_eq!(above.orbits.len().abs_diff(below.orbits.len()), 2, "{:?} {:?}", angles(&below), angles(&above));
    assert!(!is_complete(&at), "{at:?}");
    let near = |angle: f64| (angle.to_degrees() - corner).abs() < 1e-4;
    assert!(at.undecided.iter().all(|it| near(it.cam_angles[0][0]) && near(it.cam_angles[0][1])), "{at:?}");
}

/// On its way, at angles beyond that of the impact: no flight, and nothing is left undecided.
#[test]
fn a_flight_that_meets_the_cam_beyond_the_angle_that_it_comes_back_to_is_refused() {
    let case = &random::drawn(random::cases_of_every_law(), 7)[6];
    for part in [0.7, 0.9] {
        are(&all(&machine(&case.model, part * case.rpm), 1), &[]);
    }
}

/// All corner impacts of one impact from 600 to 760 rpm are one, and a flight that leaves into the cam is refused with a proof.
#[test]
fn the_papers_corner_impacts_are_all_found() {
    let (paper, range) = (common::osorio(), Study { rpm_min: 600.0, rpm_max: 760.0 });
    let looked_at = find_corner_impacts(&paper, &Cam::new(&paper).unwrap(), range, 1, &Unwatched).unwrap();
    assert_eq!((looked_at.complete[0].known, &looked_at.undecided[..]), (Evidence::Proved, &[][..]));
    let of_one: Vec<f64> =
        looked_at.found.iter().filter(|it| it.cycle.impacts.len() == 1).map(|it| it.speed_rpm()).collect();
    assert!(of_one.len() == 1 && (of_one[0] - 673.234445003812033).abs() < 1e-10, "{of_one:?}");
    let refused = looked_at.rejected.iter().any(|it| (it.speed_rpm - 634.33).abs() < 0.01 && it.cam_angle > 3.6);
    assert!(refused, "{:?}", looked_at.rejected);
}

/// Whether the first thing that happens to a follower thrown off the cam is that it comes back a revolution later.
fn comes_back(machine: &Machine, angle: f64, velocity: f64) -> bool {
    let Ok(mut motion) = machine.start_on_cam(angle, velocity) else { return false };
    let mut first = None;
    let goal = Goal { revolution: 1, cam_angle: angle + 1e-6 };
    let _ = machine.advance(&mut motion, goal, &mut |event: &Event| {
        first = Some(*event);
        ControlFlow::Break(())
    });
    first.is_some_and(|event| event.kind == EventKind::Impact && (event.turned_since(angle) - TAU).abs() < 1e-6)
}

/// Angles at which dense samples find an orbit of one impact: none of this uses intervals.
fn sampled(machine: &Machine) -> Vec<f64> {
    let (omega, r, flight) = (machine.angular_velocity(), machine.restitution(), machine.flight());
    let response = flight.response(TAU / omega);
    let (p, s, s1) = (response.step, response.impulse, response.impulse_rate);
    let mut angles = Vec::new();
    for segment in machine.cam().segments() {
        let at = |angle: f64| {
            let lift = segment.law.lift(angle);
            let after = -flight.force(lift.value) * p / s;
            let approach = omega * lift.slope - (after * s1 + flight.force(lift.value) * s);
            // What restitution is off by, and how fast follower and cam meet.
            (after - omega * lift.slope - r * approach, approach)
        };
        let samples = 20_000.0 * (segment.end - segment.start) / TAU + 2.0;
        let angle = |index: f64| segment.start + (segment.end - segment.start) * index / samples;
        for index in 0..samples as u32 {
            let (mut low, mut high) = (angle(f64::from(index)), angle(f64::from(index) + 1.0));
            let sign = at(low).0 < 0.0;
            if sign == (at(high).0 < 0.0) {
                continue;
            }
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if (at(middle).0 < 0.0) == sign { low = middle } else { high = middle }
            }
            let approach = at(low).1;
            if approach > 0.0 && low < TAU - 1e-5 && comes_back(machine, low, r * approach) {
                angles.push(low);
            }
        }
    }
    angles
}

/// Without damping the long one of two flights may be half a swing about the equilibrium, which comes back to the cam however it leaves,
/// as long as the two contacts are as far above the equilibrium as below. The equations say no more of it then; that the impacts do not
/// throw the follower as fast as the flights ask for does.
#[test]
fn a_flight_of_half_a_swing_between_impacts_that_do_not_throw_so_is_refused() {
    for (ratio, phase) in [(1.3, 30.0), (1.2, 135.0), (1.05, 120.0)] {
        let text = format!(
            "[follower]\nmass = 1.0\ndamping = 0.0\nstiffness = 100.0\ngravity = 0.0\nrest_position = 0.1\nrestitution = 0.3\n\
             [cam]\nlaw = \"harmonic\"\noffset = 0.1\namplitudes = [0.02, 0.01]\nphases_deg = [180.0, {phase}]\n"
        );
        // The cam turns by more than half a turn in half a swing, and by less than a whole one.
        let model = Model::parse("half-a-swing.toml", &text).unwrap();
        let searched = all(&machine(&model, 10.0 * ratio * 60.0 / TAU), 2);
        assert!(is_complete(&searched) && searched.orbits.len() == 1, "{ratio} {phase}: {searched:?}");
    }
}

/// An orbit that anything else finds is one of those that are said to be all, or where it is said that one may be missing.
fn is_told(searched: &Searched, angles: &[f64]) -> bool {
    let impacts = |orbit: &PeriodicOrbit| orbit.impacts().map(|event| event.cam_angle).collect::<Vec<_>>();
    let same = |others: Vec<f64>| others.iter().zip(angles).all(|(one, other)| apart(*one, *other) < 1e-6);
    let near = |[low, high]: [f64; 2], angle: f64| low - 1e-6 <= angle && angle <= high + 1e-6;
    let is_at = |ends: &[f64; 2]| {
        angles.iter().any(|angle| near(*ends, *angle) || near(*ends, angle + TAU) || near(*ends, angle - TAU))
    };
    let is_proved =
        |orbit: &&PeriodicOrbit| orbit.known == Evidence::Proved && matches!(orbit.course, Course::Impacts(_));
    searched.orbits.iter().filter(is_proved).any(|orbit| same(impacts(orbit)))
        || searched.undecided.iter().any(|it| it.cam_angles.iter().all(is_at))
}

static SEEN: [AtomicU32; 4] = [const { AtomicU32::new(0) }; 4];

#[test]
#[ignore = "slow"]
fn samples_find_no_orbit_of_one_impact_that_is_not_told() {
    check(60, |case| {
        // A run that cannot go on is an error where there is no orbit.
        let Ok(searched) = search_all(&case.machine, &Search { revolutions: 1, impacts: Some(1) }, &Unwatched) else {
            return Ok(());
        };
        let proved = u32::from(searched.complete[0].known == Evidence::Proved);
        SEEN[1].fetch_add(proved, Ordering::Relaxed);
        for angle in sampled(&case.machine) {
            SEEN[0].fetch_add(1, Ordering::Relaxed);
            prop_assert!(is_told(&searched, &[angle]), "{angle} {searched:?}");
        }
        Ok(())
    });
    let [found, proved] = [0, 1].map(|index: usize| SEEN[index].load(Ordering::Relaxed));
    assert!(found >= 20 && proved >= 50, "{found} orbits, {proved} lists proved");
}

#[test]
#[ignore = "slow"]
fn runs_find_no_orbit_of_two_impacts_that_is_not_told() {
    check(24, |case| {
        let Ok(searched) = search_all(&case.machine, &Search { revolutions: 1, impacts: Some(2) }, &Unwatched) else {
            return Ok(());
        };
        let proved = u32::from(searched.complete[0].known == Evidence::Proved);
        SEEN[3].fetch_add(proved, Ordering::Relaxed);
        let Ok(orbits) = search(&case.machine, &Search { revolutions: 1, impacts: Some(2) }) else { return Ok(()) };
        for orbit in orbits.iter().filter(|orbit| matches!(orbit.course, Course::Impacts(_))) {
            SEEN[2].fetch_add(1, Ordering::Relaxed);
            let angles: Vec<f64> = orbit.impacts().map(|event| event.cam_angle).collect();
            prop_assert!(is_told(&searched, &angles), "{angles:?} {searched:?}");
        }
        Ok(())
    });
    let [found, proved] = [2, 3].map(|index: usize| SEEN[index].load(Ordering::Relaxed));
    assert!(found >= 2 && proved >= 6, "{found} orbits, {proved} lists proved");
}
