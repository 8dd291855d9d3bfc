//! Does the follower do what its local map predicts next to the corner impact, and how far from it?

use std::f64::consts::{PI, TAU};
use std::path::Path;

use crate::common;
use approx::assert_relative_eq;
use corner_impact::border_collision::local_map::MapOrbit;
use corner_impact::border_collision::long_run::{EscapeReason, LocalLongRun};
use corner_impact::border_collision::validity::{ComparedMotion, Ends, ranges};
use corner_impact::border_collision::word::Word;
use corner_impact::border_collision::{Degenerate, LocalMap, Refusal};
use corner_impact::cam::Side;
use corner_impact::estimate::Estimate;
use corner_impact::flight::State;
use corner_impact::model::Model;
use corner_impact::orbit::Stability;
use corner_impact::progress::Unwatched;
use corner_impact::section::StroboscopicMap;
use corner_impact::simulate::Machine;
use corner_impact::simulate::growth;
use corner_impact::study::local::{Crossings, NextToCorner};
use corner_impact::study::locate::{Happens, locate};
use corner_impact::study::verify::{External, Verification, verify};
use corner_impact_cli::show::Paged;
use nalgebra::{Matrix2, Vector2};
use serde_json::json;

/// What a motion from 0 does, in a word.
fn kind(end: &LocalLongRun) -> String {
    match end {
        LocalLongRun::Periodic(orbit) => orbit.word.to_string(),
        other => other.name().into(),
    }
}

fn word(text: &str) -> Word {
    Word::read(text).unwrap()
}

fn exponent(end: &LocalLongRun) -> Estimate {
    match end {
        LocalLongRun::Chaotic(chaos) => chaos.exponent,
        other => panic!("{other:?}"),
    }
}

fn paper() -> Verification {
    verify(&common::osorio(), External::LeftOut).unwrap()
}

/// Next to the paper's corner impact: a stable fixed point above omega*, and below it nothing, not even chaos. What the
/// follower does there is not in the local map.
#[test]
fn the_papers_local_map_has_nothing_below_its_speed() {
    let found = paper();
    let [faster, slower, at] = found.outcomes.as_slice() else { panic!("{:?}", found.outcomes) };
    assert_eq!((faster.mu, slower.mu, at.mu), (-1.0, 1.0, 0.0));
    let words = |orbits: &[MapOrbit]| orbits.iter().map(|orbit| orbit.word.to_string()).collect::<Vec<_>>();
    assert_eq!(words(&faster.orbits), ["L", "R"]);
    assert_eq!(faster.fates[0].end.fixed_on(), Some(Side::Plus));
    assert!(slower.orbits.is_empty() && slower.fixed_points.len() == 2);
    for outcome in [slower, at] {
        match &outcome.fates[..] {
            [one] => match &one.end {
                LocalLongRun::Escapes(EscapeReason::Follows { word, multiplier }) => {
                    assert_eq!(word.to_string(), "L");
                    assert_relative_eq!(*multiplier, 1.00514740546535501, max_relative = 1e-12);
                }
                other => panic!("{other:?}"),
            },
            other => panic!("{other:?}"),
        }
    }
    // The saddle is 27 times further than the stable point, and past it motions leave.
    assert_eq!(kind(&faster.fates[1].end), "escapes");
    let point = |index: usize| faster.orbits[index].points[0];
    assert_relative_eq!(point(0)[0], -44230.730719534362, max_relative = 1e-9);
    assert_relative_eq!(point(1)[0], -1626.2702446096217, max_relative = 1e-9);
}

/// Each range ends where the simulated machine, run anew, is a tenth off the prediction, and less the nearer it is.
#[test]
fn the_local_map_is_a_tenth_off_where_its_range_ends() {
    let model = common::osorio();
    let found = paper();
    let (at, map) = (&found.at, found.map);
    let omega = TAU / at.period;
    let size = |x: Vector2<f64>| x[0].hypot(x[1] / omega);
    let compared: Vec<_> =
        found.ranges.iter().filter(|range| range.order == 1).map(|range| (range.compared, range.sign)).collect();
    let expected = [
        (ComparedMotion::OneRevolution, -1.0),
        (ComparedMotion::FixedPointMinus, -1.0),
        (ComparedMotion::FixedPointPlus, -1.0),
        (ComparedMotion::OneRevolution, 1.0),
    ];
    assert_eq!(compared, expected);
    for range in found.ranges.iter().filter(|range| range.order == 1) {
        assert_eq!(range.ends, Ends::Differs, "{range:?}");
        assert_relative_eq!(range.speed_rpm, 60.0 / (at.period + range.period_change), max_relative = 1e-14);
        let off = |dt: f64| {
            let section = section_at(&model, &found, dt);
            let mut state = at.state;
            let predicted = match range.compared {
                // Faster, the corner passes before the follower is there.
                ComparedMotion::OneRevolution => {
                    state = section.apply(state).unwrap().state;
                    let side = if dt < 0.0 { &map.plus } else { &map.minus };
                    side.b * dt
                }
                // The stable one by running to it.
                ComparedMotion::FixedPointPlus => {
                    for _ in 0..1000 {
                        state = section.apply(state).unwrap().state;
                    }
                    (Matrix2::identity() - map.plus.a).try_inverse().unwrap() * map.plus.b * dt
                }
                // The unstable one by what it does: it comes back.
                ComparedMotion::FixedPointMinus => {
                    let predicted = (Matrix2::identity() - map.minus.a).try_inverse().unwrap() * map.minus.b * dt;
                    state.position += predicted[0];
                    state.velocity += predicted[1];
                    state = section.periodic(state, 1).unwrap().unwrap().state;
                    let back = section.apply(state).unwrap().state;
                    assert_relative_eq!(back.position, state.position, epsilon = 1e-9);
                    predicted
                }
            };
            let real = Vector2::new(state.position - at.state.position, state.velocity - at.state.velocity);
            size(real - predicted) / size(predicted)
        };
        assert_relative_eq!(off(range.period_change), 0.1, max_relative = 1e-5);
        // What is left out is of second order: over the displacement it falls with dT.
        let small = 0.02 * range.period_change;
        assert_relative_eq!(off(small), 2.0 * off(0.5 * small), max_relative = 0.02);
    }
}

fn read(name: &str) -> Model {
    common::read(&Path::new(common::ROOT).join(format!("models/{name}.toml")))
}

/// The machine at a period `dt` from T*.
fn section_at(model: &Model, found: &Verification, dt: f64) -> StroboscopicMap {
    let machine = Machine::new(common::cam(model), &model.follower, TAU / (found.at.period + dt));
    StroboscopicMap { machine, cam_angle: found.at.section_angle() }
}

/// The sides of the impacts of `count` revolutions after a long run from x*, at a period `dt` from T*; `?` where a revolution
/// has another number of impacts than one.
fn real_word(name: &str, dt: f64, count: usize) -> (String, Verification) {
    let model = read(name);
    let found = verify(&model, External::LeftOut).unwrap();
    let section = section_at(&model, &found, dt);
    let mut state = found.at.state;
    for _ in 0..20_000 {
        state = section.apply(state).unwrap().state;
    }
    let mut letter = || {
        let back = section.apply(state).unwrap();
        state = back.state;
        match back.events.as_slice() {
            [impact] if impact.turned_since(section.cam_angle) < PI => 'L',
            [_] => 'R',
            _ => '?',
        }
    };
    ((0..count).map(|_| letter()).collect(), found)
}

/// What the local map predicts is what the simulated follower does, next to the corner impact: a stable orbit of four
/// revolutions on the faster side of a nonsmooth flip, the same side's fixed point on the slower one.
#[test]
fn the_follower_does_what_the_local_map_predicts_where_it_is_periodic() {
    for (dt, predicted, outcome) in [(-1e-7, "LLLR", 0), (1e-7, "L", 1)] {
        let (real, found) = real_word("nonsmooth-flip", dt, 256);
        assert_eq!(kind(&found.outcomes[outcome].fates[0].end), predicted);
        let real: Vec<Side> = word(&real).sides().to_vec();
        assert_eq!(Word::repeated(&real, 8).unwrap().least_rotation().0.to_string(), predicted);
    }
}

/// And in chaos: the exponent of the simulated follower's own variational flow is the local map's.
#[test]
fn the_follower_does_what_the_local_map_predicts_where_it_is_chaotic() {
    const DT: f64 = -1e-9;
    for (name, phi) in [("damped-heavy", 0.975), ("overdamped", 0.987)] {
        let (real, found) = real_word(name, DT, 4000);
        let local = exponent(&found.outcomes[0].fates[0].end);
        let theorem = found.outcomes[0].robust_chaos.unwrap();
        assert!(theorem.holds() && (theorem.hypotheses[4].value - phi).abs() < 1e-3, "{name}: {theorem:?}");
        let page = found.text().unwrap().split_whitespace().collect::<Vec<_>>().join(" ");
        // Neither fixed point is one that a motion follows, so nothing is said to have no fixed point to follow.
        assert!(page.contains("Both are unstable") && !page.contains("no fixed point to follow"), "{page}");
        assert!(page.contains("theorem: the local map has robust chaos") && page.contains("phi = 0.9"), "{page}");
        assert!(real.chars().all(|letter| letter != '?') && real.contains('L') && real.contains('R'), "{name}");
        let section = section_at(&read(name), &found, DT);
        let motion = section.machine.start(section.cam_angle, found.at.state).unwrap();
        let grown = growth(&section.machine, motion, 40_000).unwrap();
        // Both are means over about as many turns.
        assert!((grown - local.value).abs() < 5.0 * 2.0_f64.sqrt() * local.error, "{name}: {grown} {local:?}");
    }
}

/// Below the paper's speed the follower leaves x* as the local map does, by A-'s eigenvalue above 1 a revolution, and on the
/// flank's side.
#[test]
fn the_follower_leaves_the_papers_corner_impact_as_the_local_map_predicts() {
    let found = paper();
    let section = section_at(&common::osorio(), &found, 1e-9);
    let mut state = found.at.state;
    let mut steps = Vec::new();
    // Far enough for the other eigenvalue to be gone, and too near for terms of second order.
    for _ in 0..200 {
        let back = section.apply(state).unwrap();
        assert!(matches!(back.events.as_slice(), [impact] if impact.turned_since(section.cam_angle) < PI));
        steps.push(back.state.position - state.position);
        state = back.state;
    }
    assert_relative_eq!(steps[199] / steps[198], 1.00514740546535501, max_relative = 1e-5);
}

/// A follower without restitution sticks to the flank: there is no map of two linear sides, so there is no verdict on it.
#[test]
fn sticking_is_refused_with_its_reason() {
    let plastic = common::osorio_with(&[("restitution", "0.0"), ("rpm_max", "1500.0")]);
    let found = verify(&plastic, External::LeftOut).unwrap();
    assert!(matches!(found.classification, Err(Refusal::Sticking { .. })), "{:?}", found.classification);
    assert!(found.outcomes.is_empty() && found.ranges.is_empty());
    let page = found.text().unwrap();
    assert!(page.contains("verdict             none") && page.contains("sticking: next to the corner"), "{page}");
    // That it forgets: from wherever it starts next to x*, a revolution with the impact on the flank ends in one place.
    let section = section_at(&plastic, &found, 1e-6);
    let after = |dx: f64| {
        let start = State { position: found.at.state.position - dx, ..found.at.state };
        section.apply(start).unwrap().state
    };
    let (one, other) = (after(1e-5), after(2e-5));
    assert!((one.position - other.position).abs() < 1e-12 && (one.velocity - other.velocity).abs() < 1e-10);
    let listed = locate(&plastic, plastic.study().unwrap(), 1, &Unwatched).unwrap();
    assert!(
        matches!(&listed.found[..], [one] if matches!(one.local, Happens::BorderCollision(Err(Refusal::Sticking { .. }))))
    );
    assert_eq!(serde_json::to_value(&listed).unwrap()["corner_impacts"][0]["classification"]["scenario"], "sticking");
}

/// Where the machine does not do what the orbit does, there is no range and the reason is said: from below the cam, and from
/// so little above it that there are other impacts.
#[test]
fn another_motion_ends_the_range_at_once() {
    let model = common::osorio();
    let found = paper();
    let cam = common::cam(&model);
    let map = LocalMap::new(&found.map, found.border);
    let lift = cam.lift(found.at.section_angle()).value;
    for position in [lift - 0.1, lift + 1e-3] {
        let mut at = found.at.clone();
        at.state = State { position, velocity: 0.0 };
        let curved = found.second_order.unwrap();
        for range in ranges(&model, &cam, &at, &map, &curved)
            .iter()
            .filter(|range| range.compared == ComparedMotion::OneRevolution)
        {
            assert_eq!(
                (range.ends, range.period_change, range.difference),
                (Ends::OtherMotion, 0.0, None),
                "{position}"
            );
        }
    }
}

/// The document says what was found, in the fields of the contract's `verify` and more.
#[test]
fn the_document_carries_the_local_map_unchanged() {
    let model = read("damped-heavy");
    let found = verify(&model, External::LeftOut).unwrap();
    let document = serde_json::to_value(&found).unwrap();
    assert!(document["refusal"].is_null());
    for (entry, condition) in document["conditions"].as_array().unwrap().iter().zip(&found.conditions) {
        assert_eq!(entry["name"], condition.name);
        assert_eq!(entry["value"].as_f64().unwrap(), condition.value);
        assert_eq!(entry["distance"].as_f64().unwrap(), condition.distance);
        assert_eq!((entry["holds"].as_bool(), &entry["decides"]), (Some(true), &json!(condition.decides)));
    }
    for ((entry, outcome), speeds) in
        document["local_map"].as_array().unwrap().iter().zip(&found.outcomes).zip(["faster", "slower", "at"])
    {
        assert_eq!((entry["speeds"].as_str(), entry["starts"].as_u64()), (Some(speeds), Some(outcome.starts() as u64)));
        assert_eq!(entry["period_two"].is_null(), outcome.mu == 0.0);
        assert_eq!(entry["fixed_points"].as_array().unwrap().len(), outcome.fixed_points.len());
        for (entry, orbit) in entry["periodic_orbits"].as_array().unwrap().iter().zip(&outcome.orbits) {
            assert_eq!(entry["word"], orbit.word.to_string());
            assert_eq!(entry["points"][0][1].as_f64().unwrap(), orbit.points[0][1]);
            assert_eq!(entry["multipliers"][0]["re"].as_f64().unwrap(), orbit.multipliers[0].re);
            assert_eq!(entry["stable"], orbit.stable());
        }
        for (entry, fate) in entry["ends"].as_array().unwrap().iter().zip(&outcome.fates) {
            assert_eq!(
                (entry["end"].as_str(), entry["starts"].as_u64()),
                (Some(fate.end.name()), Some(fate.starts as u64))
            );
        }
    }
    let chaotic = exponent(&found.outcomes[0].fates[0].end);
    assert_eq!(document["local_map"][0]["ends"][0]["exponent"].as_f64().unwrap(), chaotic.value);
    assert_eq!(document["local_map"][0]["ends"][0]["standard_error"].as_f64().unwrap(), chaotic.error);
    for (entry, range) in document["linear_range"].as_array().unwrap().iter().zip(&found.ranges) {
        assert_eq!((&entry["compared"], &entry["ends"]), (&json!(range.compared), &json!(range.ends)));
        assert_eq!((entry["order"].as_u64(), entry["within"].as_f64()), (Some(range.order.into()), Some(range.within)));
        assert_eq!(entry["speeds"], if range.sign < 0.0 { "faster" } else { "slower" });
        assert_eq!(entry["period_change_s"].as_f64().unwrap(), range.period_change);
        assert_eq!(entry["difference"].as_f64(), range.difference);
    }
    assert_eq!(document["linear_range"].as_array().unwrap().len(), found.ranges.len());
}

/// A document without a verdict says why, and which condition failed.
#[test]
fn a_degenerate_case_has_no_verdict_but_a_reason() {
    let mut found = paper();
    found.classification = Err(Refusal::from(Degenerate::Vanishes { what: "the determinant of I - A", value: 1e-17 }));
    found.conditions[2].distance = 1e-17;
    (found.outcomes, found.ranges) = (Vec::new(), Vec::new());
    let document = serde_json::to_value(&found).unwrap();
    assert_eq!(document["refusal"].as_str(), Some("degenerate: the determinant of I - A is 1e-17, zero to rounding"));
    let page = found.text().unwrap();
    assert!(page.contains("degenerate: the determinant of I - A is 1e-17") && page.contains("11 of 12 hold"), "{page}");
    assert!(page.contains("  fails               det(I - A-) ="), "{page}");
    assert!(!page.contains("nonsmooth-fold") && !page.contains("Range of the local map"), "{page}");
}

/// The figure of the local map has each orbit as a ray, and beside it the machine's own orbit, from the corner impact up to where it is far
/// from the ray.
#[test]
fn the_machines_orbits_leave_the_corner_impact_along_the_rays() {
    for (model, words, left) in [
        (common::osorio(), vec!["L", "R"], vec![1.0]),
        (common::read(Path::new("models/nonsmooth-flip.toml")), vec!["R", "LR", "L"], vec![]),
    ] {
        let found = verify(&model, External::LeftOut).unwrap();
        let shown = NextToCorner::new(&model, &common::cam(&model), &found).unwrap();
        assert_eq!(shown.rays.iter().map(|ray| &*ray.word).collect::<Vec<_>>(), words);
        assert_eq!(shown.left, left);
        assert_eq!((shown.period, shown.position), (found.at.period, found.at.state.position));
        // Three times as far as the nearer of the fixed points is within a tenth of its ray.
        let held = |of: ComparedMotion| {
            let ends = found.ranges.iter().filter(|range| (range.order, range.compared) == (1, of));
            ends.map(|range| range.period_change.abs()).filter(|change| *change != 0.0).fold(f64::INFINITY, f64::min)
        };
        let held = held(ComparedMotion::FixedPointMinus).min(held(ComparedMotion::FixedPointPlus));
        assert_relative_eq!(shown.reach, 3.0 * held, max_relative = 1e-15);
        let changes = || shown.machine.iter().flat_map(|line| &line.points).map(|point| point[0]);
        let farthest = changes().map(f64::abs).fold(0.0, f64::max);
        assert_relative_eq!(farthest, shown.reach, max_relative = 1e-9);
        let omega = TAU / shown.period;
        for ray in &shown.rays {
            assert!(ray.positions.len() == ray.word.len() && ray.velocities.len() == ray.word.len());
            for (position, velocity) in ray.positions.iter().zip(&ray.velocities) {
                let allowed = 0.1 * position.hypot(velocity / omega);
                let follows = |line: &&Crossings| {
                    let near = |point: &&[f64; 2]| (0.01 * held..=0.5 * held).contains(&(point[0] * ray.sign));
                    let mut points = line.points.iter().filter(near).peekable();
                    points.peek().is_some()
                        && points.all(|[change, at]| (at / change.abs() - position).abs() <= allowed)
                };
                let beside: Vec<Stability> = shown.machine.iter().filter(follows).map(|line| line.stability).collect();
                assert_eq!(beside, [ray.stability], "{} of {}", ray.word, model.name);
            }
        }
        // A line ends only where its stability does.
        for pair in shown.machine.windows(2) {
            assert!(pair[0].points.last() != pair[1].points.first() || pair[0].stability != pair[1].stability);
        }
        // Orbits that strike far from the corner are not shown.
        let highest = shown.rays.iter().flat_map(|ray| &ray.positions).fold(0.0_f64, |most, one| most.max(one.abs()));
        for [_, position] in shown.machine.iter().flat_map(|line| &line.points) {
            assert!(position.abs() <= 1.5 * highest * shown.reach, "{position} of {}", model.name);
        }
    }
}
