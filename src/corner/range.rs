//! Every corner impact of a range of speeds that can be found: exhaustively those of one impact, by search those of more.

use super::candidates::{Candidates, candidates};
use super::confirm::Candidate;
use super::corner_impact::CornerImpact;
use super::locate::Rejected;
use super::period_equation::{PeriodEquation, Root, Roots, Verdict};
use crate::cam::{Cam, Corner, Side};
use crate::model::{Model, Study};
use crate::simulate::angular_velocity;
use crate::tolerance;

/// What was found in a range of speeds, and what was looked at.
#[derive(Clone, Debug)]
pub struct FoundCornerImpacts {
    /// By rising speed.
    pub found: Vec<CornerImpact>,
    /// Speeds at which the equations hold and the cam has no such orbit, by rising speed.
    pub rejected: Vec<Rejected>,
    /// The corners of the cam, in order of angle.
    pub corners: Vec<Corner>,
    /// How orbits of several impacts were looked for.
    pub searched: Candidates,
}

/// Why a range of speeds cannot be looked through.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum RangeError {
    /// Ends that are no range.
    #[error("{low}:{high} rpm: a range goes from a speed above 0 to a higher one")]
    NoRange {
        /// Lower end, rpm.
        low: f64,
        /// Upper end, rpm.
        high: f64,
    },
    /// Too many oscillations of the follower.
    #[error(
        "{low}:{high} rpm spans too much: from end to end the flight grows by {radians:.3e} radians of the follower's motion, \
         and at most {:.3e} are searched",
        PeriodEquation::MOST_RADIANS
    )]
    TooWide {
        /// Lower end, rpm.
        low: f64,
        /// Upper end, rpm.
        high: f64,
        /// How many radians.
        radians: f64,
    },
    /// Overflow.
    #[error("{low}:{high} rpm: the follower's motion overflows a double: check the model's magnitudes")]
    NotFinite {
        /// Lower end, rpm.
        low: f64,
        /// Upper end, rpm.
        high: f64,
    },
}

/// Looks through a range of speeds for orbits that repeat after `revolutions`, with an impact on any corner.
pub fn find_corner_impacts(
    model: &Model,
    cam: &Cam,
    range: Study,
    revolutions: u64,
) -> Result<FoundCornerImpacts, RangeError> {
    let Study { rpm_min: low, rpm_max: high } = range;
    if !(low > 0.0 && high > low && angular_velocity(high).is_finite()) {
        return Err(RangeError::NoRange { low, high });
    }
    let corners = cam.corners();
    let mut all =
        FoundCornerImpacts { found: Vec::new(), rejected: Vec::new(), corners, searched: Candidates::default() };
    for corner in all.corners.clone() {
        // Where the velocity jumps, each side throws its own way.
        let sides = if corner.jump_order == 1 { &[Side::Minus, Side::Plus][..] } else { &[Side::Plus] };
        for side in sides {
            let equation = PeriodEquation::new(&model.follower, &corner, *side, revolutions);
            match equation.roots(range) {
                Roots::Some(roots) => roots.into_iter().for_each(|root| {
                    let verdict = if corner.jump_order == 1 {
                        one_side(model, cam, &equation, root)
                    } else {
                        equation.orbit(model, cam, root)
                    };
                    all.keep(&corner, 60.0 / root.period, verdict);
                }),
                Roots::TooMany { radians } => return Err(RangeError::TooWide { low, high, radians }),
                Roots::NotFinite => return Err(RangeError::NotFinite { low, high }),
                Roots::All { slowest } => {
                    let verdict = if equation.rests() {
                        equation.graze(model, cam, slowest)
                    } else {
                        let why = "flights of every period start and end there, so nothing fixes a speed";
                        Verdict::Rejected(why.into())
                    };
                    all.keep(&corner, 60.0 / slowest, verdict);
                }
            }
        }
    }
    all.searched = candidates(model, cam, range, revolutions);
    for candidate in all.searched.list.clone() {
        let (corner, rpm) = (candidate.corner, 60.0 / candidate.period);
        if low <= rpm && rpm <= high && !all.has(&candidate) {
            all.keep(&corner, rpm, verdict(candidate, model, cam));
        }
    }
    all.found.sort_by(|one, two| one.speed_rpm().total_cmp(&two.speed_rpm()));
    all.rejected.sort_by(|one, two| one.speed_rpm.total_cmp(&two.speed_rpm));
    Ok(all)
}

/// A root at a corner of velocity, where a simulation in doubles cannot tell which side is hit: its flight is simulated.
fn one_side(model: &Model, cam: &Cam, equation: &PeriodEquation<'_>, root: Root) -> Verdict {
    match equation.candidate(cam, root) {
        Some(candidate) => verdict(candidate, model, cam),
        None => Verdict::Rejected("the flight would need an unbounded velocity: the period is in resonance".into()),
    }
}

fn verdict(candidate: Candidate, model: &Model, cam: &Cam) -> Verdict {
    candidate.confirmed(model, cam).map_or_else(Verdict::Rejected, |orbit| Verdict::Orbit(Box::new(orbit)))
}

impl FoundCornerImpacts {
    fn keep(&mut self, corner: &Corner, speed_rpm: f64, verdict: Verdict) {
        let cam_angle = corner.angle;
        let why = match verdict {
            Verdict::Orbit(orbit) => return self.found.push(*orbit),
            Verdict::Rejected(why) => why,
            Verdict::Grazing(velocity) => {
                format!(
                    "a graze, v = c' = {velocity:.6} m/s: the corner is touched, not hit, and the map has no linear part"
                )
            }
        };
        let again = |other: &Rejected| other.cam_angle == cam_angle && is_same_speed(other.speed_rpm, speed_rpm);
        if !self.rejected.iter().any(again) {
            self.rejected.push(Rejected { cam_angle, speed_rpm, why });
        }
    }

    /// Whether a corner impact has been found already, on another branch.
    fn has(&self, at: &Candidate) -> bool {
        self.found.iter().any(|known| {
            known.corner.segment == at.corner.segment
                && (known.corner.jump_order > 1 || known.side == at.side)
                && is_same_speed(known.speed_rpm(), 60.0 / at.period)
                && known.cycle.is_same(&at.cycle)
        })
    }
}

fn is_same_speed(one: f64, two: f64) -> bool {
    (one - two).abs() <= tolerance::SAME_ORBIT.value * one.abs()
}
