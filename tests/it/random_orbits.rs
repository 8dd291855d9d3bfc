//! Are the orbits of random machines orbits, and the special points of their branches points where something changes?
//!
//! The cases are the same in every run. `PROPTEST_CASES=2000 PROPTEST_RNG_SEED=7` looks at others.

use std::sync::atomic::{AtomicU32, Ordering};

use crate::random;
use corner_impact::orbit::branch::{Branch, Following};
use corner_impact::orbit::{Course, Parameter, PeriodicOrbit, Search, Stability, search};
use corner_impact::section::StroboscopicMap;
use corner_impact::simulate::{Machine, angular_velocity};
use proptest::prelude::*;
use random::check;

/// How far one simulated period misses the state, over what rounding may make of it; `None` where the simulator gives up.
fn missed(machine: &Machine, orbit: &PeriodicOrbit) -> Option<f64> {
    let map = StroboscopicMap { machine: machine.clone(), cam_angle: 0.0 };
    let omega = machine.angular_velocity();
    let (state, force) = (orbit.state, machine.flight().force(machine.cam().top()).abs());
    let (end, matrix) = map.carry(state, orbit.revolutions).ok()?;
    let off = (end.position - state.position).hypot((end.velocity - state.velocity) / omega);
    let size =
        state.position.abs() + machine.cam().top().abs() + state.velocity.abs() / omega + force / (omega * omega);
    // Velocities over omega, so that the entries have one unit.
    let growth = 1.0 + matrix.m11.abs() + matrix.m22.abs() + matrix.m12.abs() * omega + matrix.m21.abs() / omega;
    // Past an accumulation of impacts nothing is left of a deviation.
    let growth = if growth.is_finite() { growth } else { 1.0 };
    let turns: Vec<f64> = orbit.impacts().map(|event| event.turned_since(0.0)).collect();
    let shortest = turns.windows(2).map(|pair| pair[1] - pair[0]).fold(1.0, f64::min);
    Some(off / (1e-9 * size + 1e-14 * growth / shortest * size))
}

#[test]
#[ignore = "slow"]
fn every_orbit_found_closes() {
    static FOUND: [AtomicU32; 3] = [AtomicU32::new(0), AtomicU32::new(0), AtomicU32::new(0)];
    check(25, |case| {
        for revolutions in [1, 2] {
            let Ok(orbits) = search(&case.machine, &Search { revolutions, impacts: None }) else { continue };
            for orbit in &orbits {
                prop_assert_eq!(orbit.revolutions, revolutions);
                prop_assert!(orbit.residual <= 1e-9, "{orbit:?}");
                let kind = match orbit.course {
                    Course::Impacts(_) => 0,
                    Course::Sticking(_) => 1,
                    Course::Free => 2,
                };
                FOUND[kind].fetch_add(1, Ordering::Relaxed);
                if let Some(missed) = missed(&case.machine, orbit) {
                    prop_assert!(missed <= 1.0, "{missed:e} {orbit:?}");
                }
                // The verdict, which is made by the trace and the determinant, against the moduli of the eigenvalues.
                let modulus = orbit.multipliers().iter().fold(0.0_f64, |most, one| most.max(one.modulus()));
                let by_modulus = Stability::of_modulus(modulus, orbit.judgement.error);
                prop_assert!(
                    [by_modulus, orbit.judgement.stability].contains(&Stability::Neutral)
                        || by_modulus == orbit.judgement.stability,
                    "{orbit:?}"
                );
                prop_assert_eq!(orbits.iter().filter(|other| other.is_same(orbit)).count(), 1);
            }
        }
        Ok(())
    });
    let [impacts, sticking, free] = FOUND.each_ref().map(|count| count.load(Ordering::Relaxed));
    assert!(impacts > 25 && sticking > 2 && free > 1, "{impacts} with impacts, {sticking} that stick, {free} free");
}

#[test]
#[ignore = "slow"]
fn every_point_of_a_branch_closes() {
    static FOUND: [AtomicU32; 2] = [AtomicU32::new(0), AtomicU32::new(0)];
    check(25, |case| {
        let Ok(orbits) = search(&case.machine, &Search { revolutions: 1, impacts: None }) else { return Ok(()) };
        let range = [0.7 * case.rpm, 1.4 * case.rpm];
        let following = Following { parameter: Parameter::Speed, range, longest_step: 0.05, most_points: 100 };
        for orbit in orbits.iter().take(4) {
            let Ok(branch) = Branch::through(&case.model, case.rpm, orbit, &following) else { continue };
            for point in &branch.points {
                prop_assert!(point.orbit.residual <= 1e-9, "{point:?}");
                FOUND[0].fetch_add(1, Ordering::Relaxed);
                if let Some(special) = point.special {
                    FOUND[1].fetch_add(1, Ordering::Relaxed);
                    let [low, high] = special.bracket;
                    prop_assert!(
                        low <= point.value * (1.0 + 1e-12) && point.value <= high * (1.0 + 1e-12),
                        "{point:?}"
                    );
                    prop_assert!(special.residual <= 1e-6 || special.kind.name() == "chatter", "{point:?}");
                    continue;
                }
                let machine = case.machine.at_speed(angular_velocity(point.rpm));
                if let Some(missed) = missed(&machine, &point.orbit) {
                    prop_assert!(missed <= 1.0, "{missed:e} {point:?} {:?}", branch.ends);
                }
            }
        }
        Ok(())
    });
    let [points, specials] = FOUND.each_ref().map(|count| count.load(Ordering::Relaxed));
    assert!(points > 500 && specials > 30, "{points} points, {specials} special");
}
