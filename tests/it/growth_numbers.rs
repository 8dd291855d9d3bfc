//! Does a deviation grow as the motion has it, where that is known in closed form?

use std::path::Path;

use approx::{assert_abs_diff_eq, assert_relative_eq};
use corner_impact::flight::State;
use corner_impact::model::Model;
use corner_impact::simulate::{Machine, Motion, Record, growth};

use crate::common;
use crate::orbit_numbers::machine;

/// The frequency of a follower that swings over a cam that it never meets, rad/s, and the angular velocity of the cam, of one turn a second.
const SWINGS: f64 = 10.0;
const TURNS: f64 = std::f64::consts::TAU;

fn swinging() -> (Machine, Motion) {
    let text = "[follower]\nmass = 1\ndamping = 0\nstiffness = 100\ngravity = 0\nrest_position = 1\nrestitution = 0.5\n[cam]\n\
                law = \"harmonic\"\noffset = 0.0\namplitudes = [0.01]\nphases_deg = [0.0]\n";
    let machine = machine(&Model::parse("swinging.toml", text).unwrap(), 60.0);
    let mut motion = machine.start(1.0, State { position: 1.1, velocity: 0.3 }).unwrap();
    // Revolutions are counted from where it begins, and not from 0.
    machine.revolve(&mut motion, 3).unwrap();
    (machine, motion)
}

/// By how much a deviation of 0.6 in position and 0.8 in velocity over the cam's has grown after so many revolutions, as a natural logarithm.
fn swung(revolutions: u64) -> f64 {
    let (sin, cos) = (SWINGS * revolutions as f64).sin_cos();
    let position = 0.6 * cos + 0.8 * TURNS / SWINGS * sin;
    let velocity = 0.8 * cos - 0.6 * SWINGS / TURNS * sin;
    position.hypot(velocity).ln()
}

/// Impacts carry a deviation as they carry two motions that begin next to each other.
#[test]
fn a_deviation_is_what_two_motions_differ_by() {
    let models = [
        common::osorio(),
        common::read(Path::new("models/damped-light.toml")),
        common::read(Path::new("models/overdamped.toml")),
    ];
    for (model, rpm) in models.iter().zip([670.0, 690.0, 700.0]) {
        let machine = machine(model, rpm);
        let mut motion = machine.start_on_cam(0.0, 3.0).unwrap();
        machine.revolve(&mut motion, 3).unwrap();
        let (angle, State { position, velocity }) = (motion.cam_angle, motion.state);
        let omega = machine.angular_velocity();
        let beside = |by: f64, revolutions: u64| {
            let state = State { position: position + 0.6 * by, velocity: velocity + 0.8 * omega * by };
            let mut motion = machine.start(angle, state).unwrap();
            machine.revolve(&mut motion, revolutions).unwrap();
            motion.state
        };
        for revolutions in [1, 2, 3] {
            let [one, other] = [-1e-7, 1e-7].map(|by| beside(by, revolutions));
            let apart = (other.position - one.position).hypot((other.velocity - one.velocity) / omega) / 2e-7;
            let begun = machine.start(angle, motion.state).unwrap();
            let mean = growth(&machine, begun, revolutions).unwrap();
            assert_abs_diff_eq!(mean * revolutions as f64, apart.ln(), epsilon = 1e-5);
            let mut record = Record::over(1);
            record.take(&machine, &mut begun.clone(), revolutions).unwrap();
            assert!(record.met.impacts > 0, "{}", model.name);
            assert_abs_diff_eq!(record.growth().value, mean, epsilon = 1e-12);
        }
    }
}

/// A follower that never leaves the cam forgets a deviation. In no revolution nothing grows.
#[test]
fn a_deviation_vanishes_on_the_cam() {
    let machine = machine(&common::osorio(), 80.0);
    let motion = machine.start_on_cam(1.0, 0.0).unwrap();
    assert!(motion.contact);
    assert_eq!(growth(&machine, motion, 0).unwrap(), 0.0);
    assert_eq!(growth(&machine, motion, 3).unwrap(), f64::NEG_INFINITY);
}

/// What no impact changes swings as the follower does.
#[test]
fn a_deviation_swings_with_its_follower() {
    let (machine, motion) = swinging();
    for revolutions in [1, 2, 3, 7, 50] {
        let mean = growth(&machine, motion, revolutions).unwrap();
        assert_abs_diff_eq!(mean * revolutions as f64, swung(revolutions), epsilon = 1e-9);
    }
    assert_eq!(growth(&machine, motion, 0).unwrap(), 0.0);
}

/// A record has the mean of each block that is over, in however many parts it is taken; its halves are those of the blocks, and the most is
/// from where the deviation was least to where it is most after that.
#[test]
fn a_record_is_made_of_its_blocks() {
    const BLOCK: u64 = 2;
    let (machine, mut motion) = swinging();
    let mut record = Record::over(BLOCK);
    for part in [1, 3, 7] {
        record.take(&machine, &mut motion, part).unwrap();
    }
    // The last revolution is of no block that is over.
    assert_eq!((record.revolutions, record.met.impacts, record.rests()), (11, 0, false));
    let at: Vec<f64> = (0..=5).map(|block| swung(BLOCK * block)).collect();
    let blocks: Vec<f64> = at.windows(2).map(|two| (two[1] - two[0]) / BLOCK as f64).collect();
    let mean = blocks.iter().sum::<f64>() / 5.0;
    let spread = blocks.iter().map(|one| (one - mean).powi(2)).sum::<f64>() / 4.0;
    assert_abs_diff_eq!(record.growth().value, mean, epsilon = 1e-9);
    assert_abs_diff_eq!(record.growth().error, (spread / 5.0).sqrt(), epsilon = 1e-9);
    let [first, second] = record.halves();
    assert_abs_diff_eq!(first, at[2] - at[0], epsilon = 1e-9);
    assert_abs_diff_eq!(second, at[5] - at[2], epsilon = 1e-9);
    let rises = at.iter().enumerate().flat_map(|(index, from)| at[index..].iter().map(move |to| to - from));
    let most = rises.fold(0.0, f64::max);
    assert!(most > 0.1, "{at:?}");
    assert_relative_eq!(record.most(), most, max_relative = 1e-9);
}

/// On the paper's orbit of one impact, of which each loses the same share of the velocity, a deviation shrinks by that share in a revolution;
/// a start at rest on the cam counts from where the cam lets go.
#[test]
fn a_deviation_shrinks_by_what_an_impact_loses() {
    let machine = machine(&common::osorio(), 700.0);
    let mut motion = machine.start_on_cam(0.0, 0.0).unwrap();
    assert!(motion.contact && growth(&machine, motion, 5).unwrap().is_finite());
    machine.revolve(&mut motion, 2000).unwrap();
    let mut record = Record::over(50);
    record.take(&machine, &mut motion, 500).unwrap();
    assert_abs_diff_eq!(record.growth().value, 0.8_f64.ln(), epsilon = 0.01);
    assert_eq!((record.met.impacts, record.revolutions, record.rests()), (500, 500, false));
}

/// Where the follower comes to rest nothing is left of a deviation: the record ends there, and no block of it counts that one.
#[test]
fn a_record_ends_where_the_follower_rests() {
    let machine = machine(&common::osorio(), 183.0);
    let mut motion = machine.start(1.0, State { position: 0.9, velocity: 3.0 }).unwrap();
    machine.revolve(&mut motion, 10).unwrap();
    for per_block in [1, 2] {
        let (mut record, mut motion) = (Record::over(per_block), motion);
        record.take(&machine, &mut motion, 20).unwrap();
        assert!(record.rests() && record.most().is_finite(), "{record:?}");
        assert!(
            !record.growth().value.is_infinite() && record.halves().iter().all(|half| half.is_finite()),
            "{record:?}"
        );
        assert_eq!(growth(&machine, motion, 3).unwrap(), f64::NEG_INFINITY);
    }
}
