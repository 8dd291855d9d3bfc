//! Is a danger the same one in any coordinates and at any scale, and are attractors of every kind told?

use corner_impact::border_collision::danger::{Danger, DangerKind, Divergence, LocalAttractor, Returns};
use corner_impact::border_collision::feigin::Speeds;
use corner_impact::border_collision::{LocalMap, LocalOutcome};
use corner_impact::corner::SideMap;
use corner_impact::known::Evidence;
use nalgebra::{Matrix2, RowVector2, Vector2};

use crate::common;

const PERIOD: f64 = 0.5;

fn danger(map: &LocalMap, period: f64) -> Option<Danger> {
    map.danger(&[-1.0, 1.0].map(|mu| map.outcome(mu)), period)
}

/// The same map of `y = m x`.
fn seen(map: &LocalMap, m: Matrix2<f64>) -> LocalMap {
    let inverse = m.try_inverse().unwrap();
    let side = |side: SideMap| SideMap { a: m * side.a * inverse, b: m * side.b };
    LocalMap { minus: side(map.minus), plus: side(map.plus), border: (map.border.0 * inverse, map.border.1) }
}

/// Stretched by powers of two, with the period that angular velocities then ask for, every number is the same to the last bit, but for its unit.
#[test]
#[ignore = "slow"]
fn a_danger_in_other_units_is_the_same_one() {
    for (traces, determinants) in [([-0.3, -1.7], [0.9025, 0.9025]), ([0.19, -1.28], [0.64, 0.87])] {
        let map = common::normal_form(traces, determinants);
        let own = danger(&map, PERIOD).unwrap();
        for [one, two] in [[4.0, 0.125], [4096.0, 2.0_f64.powi(-20)], [1.0, 1024.0]] {
            let other = danger(&seen(&map, Matrix2::new(one, 0.0, 0.0, two)), PERIOD * one / two).unwrap();
            assert_eq!((other.kind, other.known, &other.divergence), (own.kind, own.known, &own.divergence));
            assert_eq!(other.attractors.len(), own.attractors.len());
            // dT goes with the square of the period.
            let per_rpm = (one / two).powi(2);
            for (attractor, of_own) in other.attractors.iter().zip(&own.attractors) {
                assert_eq!((attractor.speeds, attractor.word()), (of_own.speeds, of_own.word()));
                let Returns { position, velocity, any } = of_own.returns.unwrap();
                let expected = Returns {
                    position: position.map(|size| size * one * per_rpm),
                    velocity: velocity.map(|size| size * two * per_rpm),
                    any: any.map(|size| size * one * per_rpm),
                };
                assert_eq!(attractor.returns, Some(expected));
            }
        }
    }
}

/// What a motion does in the long run: whether it has come to the fixed point of the minus side, and its Lyapunov exponent by the growth of a small
/// deviation.
fn long_run(map: &LocalMap, start: Vector2<f64>, mu: f64) -> (bool, f64) {
    const STEPS: u32 = 4000;
    let (mut x, mut off, mut grown) = (start, Vector2::new(0.8, 0.6), 0.0);
    for step in 0..2 * STEPS {
        off = map.of(map.side(x, mu)).a * off;
        if step >= STEPS {
            grown += off.norm().ln();
        }
        off /= off.norm();
        x = map.apply(x, mu);
    }
    ((map.apply(x, mu) - x).norm() < 1e-9, grown / f64::from(STEPS))
}

/// Beside the fixed point of the minus side some motions are chaotic: they stay, and part by more than a hundredth each step.
#[test]
#[ignore = "slow"]
fn chaos_beside_a_fixed_point_is_an_attractor_of_its_own() {
    let map = common::normal_form([1.15, -2.12], [0.88, -0.05]);
    let (mut fixed, mut parting) = (0, 0);
    for index in 0..100 {
        let angle = f64::from(index) * 2.4;
        let start = Vector2::new(angle.cos(), angle.sin()) * (0.2 * f64::from(index));
        let (is_fixed, exponent) = long_run(&map, start, -1.0);
        assert!(if is_fixed { exponent < -0.01 } else { (0.01..1.0).contains(&exponent) }, "{exponent}");
        *(if is_fixed { &mut fixed } else { &mut parting }) += 1;
    }
    assert!(fixed > 10 && parting > 10, "{fixed} {parting}");
    let found = map.danger(&[map.outcome(-1.0)], PERIOD).unwrap();
    // That chaos stays where it is is known by a region; that it is chaos by its exponent.
    assert_eq!((found.kind, found.known), (DangerKind::MultipleAttractors, Evidence::Sampled));
    let told =
        |it: &LocalAttractor| (it.end.name(), it.known, it.word().map(ToString::to_string), it.returns.is_some());
    let mut told: Vec<_> = found.at(Speeds::Faster).map(told).collect();
    told.sort_by_key(|it| it.0);
    assert_eq!(told[0], ("chaotic", Evidence::Sampled, None, false));
    assert_eq!(told[1], ("fixed-point", Evidence::Computed, Some("L".to_owned()), true));
    assert_eq!(told.len(), 2);
}

/// What starts where x < 0 grows by half each step, and so does what starts where y > x > 0, which is there after one; the rest shrinks: 225 degrees of
/// 360, in units of any size. The growth is the same in all directions, so that no sector is certain of its neighbours.
#[test]
#[ignore = "slow"]
fn the_share_of_directions_that_are_sampled_is_that_of_the_circle() {
    for [one, two] in [[1.0, 1.0], [100.0, 0.01], [0.001, 3.0]] {
        for quarters in 0..4 {
            let (sin, cos) = [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)][quarters];
            let plane = LocalMap {
                minus: SideMap { a: Matrix2::identity() * 1.5, b: Vector2::new(1.0, 1.0) },
                plus: SideMap { a: Matrix2::new(0.5, -0.5, 0.0, 0.0), b: Vector2::new(1.0, 1.0) },
                border: (RowVector2::new(1.0, 0.0), 0.0),
            };
            let turned = seen(&plane, Matrix2::new(cos, -sin, sin, cos));
            let found = seen(&turned, Matrix2::new(one, 0.0, 0.0, two)).divergence().unwrap();
            assert_eq!((found.share, found.known), (40.0 / 64.0, Evidence::Sampled), "{one} {two}");
        }
    }
}

/// Turned by an angle and stretched by a 500th each step, motions of every start diverge; by nothing, or shrunk, none.
#[test]
fn a_divergence_that_is_slow_is_computed() {
    let turned = |stretch: f64| {
        let side = SideMap { a: Matrix2::new(0.6, -0.8, 0.8, 0.6) * stretch, b: Vector2::new(1.2, -0.4) };
        LocalMap { minus: side, plus: side, border: (RowVector2::new(1.0, 0.3), 0.2) }.divergence()
    };
    assert_eq!(turned(1.002), Some(Divergence { share: 1.0, known: Evidence::Computed, follows: None }));
    assert_eq!((turned(1.0), turned(0.99)), (None, None));
}

/// An orbit that motions end on is an attractor, even where its word is longer than those that are listed.
#[test]
fn an_orbit_that_motions_end_on_is_an_attractor_without_being_listed() {
    let map = common::normal_form([0.19, -1.28], [0.64, 0.87]);
    let own = map.outcome(1.0);
    let told = |outcome: LocalOutcome| {
        let told = |it: &LocalAttractor| (it.word().map(ToString::to_string), it.known, it.returns.is_some());
        let danger = map.danger(&[outcome], PERIOD).unwrap();
        let mut told: Vec<_> = danger.attractors.iter().map(told).collect();
        told.sort();
        (danger.kind, danger.known, told)
    };
    let unlisted = LocalOutcome { orbits: Vec::new(), ..own.clone() };
    let listed = told(own);
    assert_eq!((listed.0, listed.2.len()), (DangerKind::MultipleAttractors, 2));
    assert_eq!(told(unlisted), listed);
}
