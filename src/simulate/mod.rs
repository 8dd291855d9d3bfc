//! The only event loop: fly to the first contact, resolve it, go on.
//!
//! [`Machine::turn`] is `next_contact`, `fly`, `rebound`, repeated until the cam has turned far enough. Time runs from the
//! last event, so that a short hop keeps its digits; the cam angle is kept in `[0, 2 pi)`.

mod contact;

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use crate::cam::{Cam, Segment};
use crate::flight::{Flight, State};
use crate::impact::rebound;
use crate::tolerance;
use contact::{Gap, Outcome, first_contact};

/// A cam, a follower over it, and the speed at which the cam turns.
#[derive(Clone, Debug)]
pub struct Machine {
    /// The lift profile.
    pub cam: Cam,
    /// The follower away from the cam.
    pub flight: Flight,
    /// r, 0 to 1.
    pub restitution: f64,
    /// omega, rad/s, positive.
    pub angular_velocity: f64,
}

/// An impact of the follower on the cam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// Cam angle turned since the start of the run, rad.
    pub turned: f64,
    /// Cam angle, rad, in `[0, 2 pi)`.
    pub cam_angle: f64,
    /// q = c, m.
    pub position: f64,
    /// v-, m/s.
    pub velocity_before: f64,
    /// v+, m/s.
    pub velocity_after: f64,
    /// c', m/s.
    pub cam_velocity: f64,
}

/// Why a run could not go on.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SimulateError {
    /// The follower started inside the cam.
    #[error("simulate: the follower starts {depth:.3e} m below the cam, at cam angle {:.4} deg", cam_angle.to_degrees())]
    BelowCam {
        /// How far, m.
        depth: f64,
        /// Where, rad.
        cam_angle: f64,
    },
    /// The follower rests on the cam: contact with no relative velocity and none to come.
    #[error("simulate: the follower stays on the cam from {:.4} deg on; sticking is not simulated", cam_angle.to_degrees())]
    Sticking {
        /// Where, rad.
        cam_angle: f64,
    },
    /// More impacts than a run may have.
    #[error("simulate: {impacts} impacts and still at {:.4} deg: the impacts accumulate", cam_angle.to_degrees())]
    Accumulating {
        /// How many.
        impacts: usize,
        /// Where, rad.
        cam_angle: f64,
    },
    /// A number that is not finite entered the run.
    #[error("simulate: a state that is not finite near {:.4} deg", cam_angle.to_degrees())]
    NotFinite {
        /// Where, rad.
        cam_angle: f64,
    },
}

/// A stretch of flight within one segment of the cam: where it starts, seen from the flight's own start.
struct Piece {
    segment: usize,
    angle: f64,
    time: f64,
    rise: f64,
}

/// A flight from its start to the next contact or to the end of the run.
struct Landing {
    contact: bool,
    turned: f64,
    segment: usize,
    cam_angle: f64,
    state: State,
}

impl Machine {
    /// Impacts after which a run is given up: a bouncing follower makes tens in a revolution, an accumulating one no end.
    const MOST_IMPACTS: usize = 100_000;

    /// Turns the cam by `turn`, rad, from `cam_angle`, rad, in `[0, 2 pi)`, and returns the state there.
    ///
    /// `observe` sees every impact, and may end the run right after one; an impact in the last instant is left to the run
    /// that goes on from there.
    pub fn turn(
        &self,
        cam_angle: f64,
        start: State,
        turn: f64,
        mut observe: impl FnMut(&Impact) -> ControlFlow<()>,
    ) -> Result<State, SimulateError> {
        let segment = self.cam.segment_at(cam_angle);
        let lift = self.cam.lift(cam_angle).value;
        let mut gap = start.position - lift;
        if gap.abs() <= tolerance::GAP_ROUNDING.value * (start.position.abs() + lift.abs()) {
            gap = 0.0;
        }
        let mut now = Landing { contact: false, turned: 0.0, segment, cam_angle, state: start };
        for _ in 0..Self::MOST_IMPACTS {
            let landing = self.next_contact(&now, gap, turn - now.turned)?;
            now = Landing { turned: now.turned + landing.turned, ..landing };
            if !now.contact {
                return Ok(now.state);
            }
            let lift = self.cam.segments()[now.segment].law.lift(now.cam_angle);
            let cam_velocity = lift.slope * self.angular_velocity;
            let velocity_before = now.state.velocity;
            let mut velocity_after = rebound(self.restitution, velocity_before, cam_velocity);
            // Impacts that accumulate die out here, and not in the rounding of two velocities.
            if (velocity_after - cam_velocity).abs() <= tolerance::RELATIVE_VELOCITY_ROUNDING.value * cam_velocity.abs()
            {
                velocity_after = cam_velocity;
            }
            now.state = State { position: lift.value, velocity: velocity_after };
            gap = 0.0;
            let (turned, cam_angle, position) = (now.turned, now.cam_angle % TAU, lift.value);
            let impact = Impact { turned, cam_angle, position, velocity_before, velocity_after, cam_velocity };
            if observe(&impact).is_break() {
                return Ok(now.state);
            }
        }
        Err(SimulateError::Accumulating { impacts: Self::MOST_IMPACTS, cam_angle: now.cam_angle })
    }

    /// The flight from `from`, `gap` above the cam, to its first contact within `turn`, rad, or to the end of that turn.
    fn next_contact(&self, from: &Landing, gap: f64, turn: f64) -> Result<Landing, SimulateError> {
        let segments = self.cam.segments();
        let mut piece = Piece { segment: from.segment, angle: from.cam_angle, time: 0.0, rise: 0.0 };
        let mut turned = 0.0;
        loop {
            let segment = &segments[piece.segment];
            let left = turn - turned;
            let within = segment.end - piece.angle;
            let last = left < within;
            let span = if last { left.max(0.0) } else { within };
            let angle_at = |time: f64| piece.angle + time * self.angular_velocity;
            let gap_at = |time: f64| self.gap(from.state, gap, &piece, time);
            let land = |contact: bool, time: f64| {
                let step = if contact { time * self.angular_velocity } else { span };
                Landing {
                    contact,
                    turned: turned + step,
                    segment: piece.segment,
                    // A contact found at the segment's end belongs to it, whatever the last bit says.
                    cam_angle: (piece.angle + step).min(segment.end),
                    state: self.flight.fly(from.state, piece.time + time).1,
                }
            };
            let third_bound = |time: f64, reach: f64| self.third_bound(from.state, &piece, time, reach);
            match first_contact(gap_at, third_bound, span / self.angular_velocity) {
                Outcome::None if last => return Ok(land(false, span / self.angular_velocity)),
                Outcome::None => {
                    let next = (piece.segment + 1) % segments.len();
                    piece = Piece {
                        segment: next,
                        angle: segments[next].start,
                        time: piece.time + span / self.angular_velocity,
                        rise: piece.rise + segment.law.rise(piece.angle, span) + step(segment, &segments[next]),
                    };
                    turned += span;
                }
                Outcome::Contact(time) => return Ok(land(true, time)),
                Outcome::Resting(time) => return Err(SimulateError::Sticking { cam_angle: angle_at(time) }),
                Outcome::Below { depth, time } => {
                    return Err(SimulateError::BelowCam { depth, cam_angle: angle_at(time) });
                }
                Outcome::NotFinite(time) => return Err(SimulateError::NotFinite { cam_angle: angle_at(time) }),
            }
        }
    }

    /// The gap `time` after the start of `piece`, for a flight that left `start` with `gap`.
    fn gap(&self, start: State, gap: f64, piece: &Piece, time: f64) -> Gap {
        let omega = self.angular_velocity;
        let segment = &self.cam.segments()[piece.segment];
        let (displacement, state) = self.flight.fly(start, piece.time + time);
        let rise = piece.rise + segment.law.rise(piece.angle, omega * time);
        let lift = segment.law.lift(piece.angle + omega * time);
        Gap {
            value: gap + displacement - rise,
            rounding: tolerance::GAP_ROUNDING.value * (gap.abs() + displacement.abs() + rise.abs()),
            rate: state.velocity - omega * lift.slope,
            curvature: self.flight.acceleration(state) - omega * omega * lift.curvature,
            third: 2.0 * (self.flight.jerk(state) - omega.powi(3) * lift.third).abs(),
        }
    }

    /// A bound on `|g'''|` over `[time, time + reach]` of `piece`.
    fn third_bound(&self, start: State, piece: &Piece, time: f64, reach: f64) -> f64 {
        let omega = self.angular_velocity;
        let angle = piece.angle + omega * time;
        let (_, state) = self.flight.fly(start, piece.time + time);
        let law = &self.cam.segments()[piece.segment].law;
        self.flight.jerk_bound(state) + omega.powi(3) * law.third_bound(angle, angle + omega * reach)
    }
}

/// What the lift jumps by from one segment to the next, m.
///
/// Only a continued law leaves a step at its far end; where segments meet, two evaluations of one lift differ by rounding,
/// which a follower that has just left the cam there must not be measured by.
fn step(before: &Segment, after: &Segment) -> f64 {
    let (end, start) = (before.law.lift(before.end).value, after.law.lift(after.start).value);
    let step = start - end;
    if step.abs() <= tolerance::GAP_ROUNDING.value * (start.abs() + end.abs()) { 0.0 } else { step }
}
