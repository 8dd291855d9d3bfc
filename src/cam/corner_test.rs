//! Test for a jump of the second derivative in the rows around a place.
//!
//! At a corner the rows on both sides fit a cubic plus a jump of its second and third derivatives. A smooth motion may do nearly the same
//! with a steep rise of the second derivative, so that every such rise is tried in the place of the jump, each with its middle where it
//! leaves the least: over four rows or four degrees at least, whichever is more, and over ever more rows. A quartic with a jump of the third
//! derivative alone is tried as well. The evidence for a corner is
//!
//! ```text
//! F = (least squares left by a smooth motion - squares left by the jump) / mean square that the jump leaves
//! ```
//!
//! where the noise of all rows counts as some rows more, as so few rows may agree by chance. Two thresholds on F, [`tolerance::CORNER_CERTAIN`] and [`tolerance::CORNER_DOUBTFUL`], were set on simulated cams without corners; the rate of
//! false alarms is in `docs/reliability.md`.

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
    /// None; a term of fourth degree instead.
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

/// Rows around a place, without the cubic that is nearest to them.
struct Window {
    /// Angles from the middle row, in units of the reach.
    angles: Vec<f64>,
    cubics: Orthonormal,
    lifts: DVector<f64>,
}

/// Looks for a jump among rows of angle and lift, as many on either side of the middle one. None where the evidence or the jump is small.
pub(super) fn jump(rows: &[(f64, f64)], scales: &Scales) -> Option<Jump> {
    /// Steepest rise of a smooth motion, in rows or in degrees, whichever is more: one over fewer rows looks like a jump, and a jump over fewer
    /// degrees is one to every follower.
    const STEEPEST: f64 = 4.0;
    /// Number of rows that the noise of all rows counts as.
    const OF_NOISE: f64 = 6.0;
    /// Ratio of one width of a rise to the one before.
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
    // The rows less two polynomials and where they meet.
    let freedom = (rows.len() - 7) as f64;
    // Two cubics do not follow a motion exactly: the rest is no noise, and hides more than one jump.
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
    /// The least squares with a change of this kind, over its places.
    fn best(&self, change: Change) -> Fitted {
        /// Parts of half the stretch that are tried, at first and after each round.
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

    /// Fit of a cubic, this change at `at` and a jump of the third derivative there; none where the rows cannot distinguish them.
    fn fitted(&self, at: f64, change: Change) -> Option<Fitted> {
        let column = |value: &dyn Fn(f64) -> f64| {
            let values = self.angles.iter().map(|angle| value(angle - at));
            let mut column = DVector::from_iterator(self.angles.len(), values);
            self.cubics.take(&mut column);
            column
        };
        let mut changed = match change {
            Change::Jump => column(&|u| u.max(0.0).powi(2)),
            // The integral of the integral of a second derivative that rises from 0 to 2.
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
