//! Test for a jump of the second derivative in the rows near an angle.
//!
//! At a corner the rows on both sides fit a cubic plus jumps of its second and third derivatives. A smooth motion with a steep rise of the
//! second derivative may fit nearly as well. Therefore each such rise is tried in place of the jump, with its middle where the least
//! squares remain. The rises extend over at least four rows or four degrees, whichever is more, and grow wider step by step. A quartic with
//! a jump of the third derivative alone is tried as well. The evidence for a corner is
//!
//! ```text
//! F = (least squares left by a smooth motion - squares left by the jump) / mean square left by the jump
//! ```
//!
//! In the denominator the noise of all rows counts as some additional rows, because a few rows may agree by chance. Two thresholds on F,
//! [`tolerance::CORNER_CERTAIN`] and [`tolerance::CORNER_DOUBTFUL`], were set on simulated cams without corners; the rate of false alarms
//! is in `docs/reliability.md`.

use nalgebra::DVector;

use super::orthonormal::{Orthonormal, take};
use crate::tolerance;

/// A likely jump of the second derivative.
pub(super) struct Jump {
    /// Evidence against a smooth motion.
    pub evidence: f64,
    /// Place, rad.
    pub at: f64,
}

/// Properties of all rows that the test depends on.
pub(super) struct Scales {
    /// Mean gap between rows, rad.
    pub gap: f64,
    /// Standard deviation of the noise, m.
    pub noise: f64,
    /// Largest second derivative, m/rad^2.
    pub curvature: f64,
}

/// Change of the second derivative in the middle of the rows.
#[derive(Clone, Copy)]
enum Change {
    /// A jump.
    Jump,
    /// A rise at a constant rate over this angle on either side, in units of the reach.
    Rise(f64),
    /// No change of the second derivative; a term of fourth degree instead.
    Quartic,
}

/// Best fit with one kind of change.
struct Fitted {
    /// Sum of the squared distances from the rows.
    squares: f64,
    /// Place of the change, in units of the reach from the middle row.
    at: f64,
    /// Size of the change, m per squared unit of the reach.
    jump: f64,
}

/// Rows near an angle, less the cubic that fits them best.
struct Window {
    /// Angles from the middle row, in units of the reach.
    angles: Vec<f64>,
    cubics: Orthonormal,
    lifts: DVector<f64>,
}

/// Searches for a jump among rows of angle and lift, with equally many rows on either side of the middle one. Returns `None` if the
/// evidence or the jump is small.
pub(super) fn jump(rows: &[(f64, f64)], scales: &Scales) -> Option<Jump> {
    /// Width of the steepest rise of a smooth motion, in rows or degrees, whichever is more. A rise over fewer rows looks like a jump, and
    /// a jump over fewer degrees acts as a corner on every follower.
    const STEEPEST: f64 = 4.0;
    /// Number of rows that the noise of all rows counts as.
    const OF_NOISE: f64 = 6.0;
    /// Ratio of the widths of successive rises.
    const WIDER: f64 = 1.4;
    /// Widest rise on either side, in units of the reach.
    const WIDEST: f64 = 0.75;
    let reach = rows.len() / 2;
    let unit = reach as f64 * scales.gap;
    let middle = rows[reach];
    let angles: Vec<f64> = rows.iter().map(|(angle, _)| (angle - middle.0) / unit).collect();
    let cubics = Orthonormal::new(&angles, 3)?;
    let mut lifts = DVector::from_iterator(rows.len(), rows.iter().map(|(_, lift)| lift - middle.1));
    cubics.take(&mut lifts);
    let window = Window { angles, cubics, lifts };
    let jump = window.best(Change::Jump);
    // Number of rows less the parameters of two polynomials and the angle where they meet.
    let freedom = (rows.len() - 7) as f64;
    // Two cubics do not fit a motion exactly: the remainder is not noise, and hides more than one jump.
    let coarse = tolerance::CORNER_MISFIT.value * scales.curvature * scales.gap * scales.gap;
    let [noise, coarse] = [scales.noise.max(coarse), coarse].map(|size| size * size);
    let mean = jump.squares / freedom;
    let left = ((jump.squares + OF_NOISE * noise) / (freedom + OF_NOISE)).max(mean).max(coarse);
    let least = tolerance::CORNER_SHARE.value * scales.curvature * unit * unit;
    if mean > 4.0 * noise || jump.jump.abs() < least {
        return None;
    }
    let evidence = |change: Change| (window.best(change).squares - jump.squares) / left;
    let mut least = evidence(Change::Quartic);
    let steepest = 0.5 * STEEPEST * scales.gap.max(1_f64.to_radians()) / unit;
    let rises = std::iter::successors(Some(steepest), |rise| Some(WIDER * rise).filter(|rise| *rise <= WIDEST));
    for rise in rises {
        if tolerance::CORNER_DOUBTFUL.value * least < 1.0 {
            break;
        }
        least = least.min(evidence(Change::Rise(rise)));
    }
    (tolerance::CORNER_DOUBTFUL.value * least >= 1.0).then_some(Jump { evidence: least, at: middle.0 + jump.at * unit })
}

impl Window {
    /// Least squares with a change of this kind, over all its places.
    fn best(&self, change: Change) -> Fitted {
        /// Steps tried on either side of the best place in a round, and the number of rounds.
        const PARTS: i32 = 6;
        const ROUNDS: i32 = 9;
        let mut step = 0.5 / f64::from(PARTS);
        let mut best = Fitted { squares: f64::INFINITY, at: 0.0, jump: 0.0 };
        for _ in 0..ROUNDS {
            let middle = best.at;
            for at in (-PARTS..=PARTS).map(|part| middle + f64::from(part) * step) {
                if let Some(fitted) = self.fitted(at, change).filter(|fitted| fitted.squares < best.squares) {
                    best = fitted;
                }
            }
            step *= 2.0 / f64::from(PARTS);
        }
        best
    }

    /// Fits a cubic, this change at `at` and a jump of the third derivative there; `None` if the rows cannot distinguish them.
    fn fitted(&self, at: f64, change: Change) -> Option<Fitted> {
        let column = |value: &dyn Fn(f64) -> f64| {
            let values = self.angles.iter().map(|angle| value(angle - at));
            let mut column = DVector::from_iterator(self.angles.len(), values);
            self.cubics.take(&mut column);
            column
        };
        let mut changed = match change {
            Change::Jump => column(&|u| u.max(0.0).powi(2)),
            // Double integral of a second derivative that rises from 0 to 2.
            Change::Rise(rise) => {
                column(&|u| ((u + rise).max(0.0).powi(3) - (u - rise).max(0.0).powi(3)) / (6.0 * rise))
            }
            Change::Quartic => column(&|u| u.powi(4)),
        };
        let third = column(&|u| u.max(0.0).powi(3)).try_normalize(0.0)?;
        let size = changed.norm();
        take(&mut changed, &third);
        let rest = changed.norm();
        let changed = changed.try_normalize(tolerance::SAME_KNOT.value * size)?;
        let mut left = self.lifts.clone();
        take(&mut left, &third);
        let jump = 2.0 * take(&mut left, &changed) / rest;
        Some(Fitted { squares: left.norm_squared(), at, jump })
    }
}
