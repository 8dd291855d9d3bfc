//! Robust chaos: the theorem by which a corner impact makes chaos by itself, and whether its hypotheses hold.
//!
//! Let one side's fixed point, L, be a saddle with an eigenvalue above 1, and the other side's, R, one with an eigenvalue below
//! -1, both with positive determinants, at a sign of mu at which they are there:
//!
//! ```text
//! delta_L > 0,   delta_R > 0,   tau_L > 1 + delta_L,   tau_R < -(1 + delta_R)
//! phi = l (l - delta_L) + (l - 1)(l tau_R - delta_R) > 0,   l the eigenvalue of A_L above 1
//! ```
//!
//! Then there is a bounded region that the map sends into itself (Banerjee, Yorke and Grebogi 1998; proved by Glendinning and
//! Simpson 2021). And both matrices send one cone of directions into itself and stretch it, in companion coordinates along x, at
//! least l-fold on L and k-fold on R, -k the eigenvalue of A_R below -1 (`derivations/border_collision.py`): so of no motion is
//! the Lyapunov exponent below ln min(l, k), and no orbit of any period is stable. The cone needs no phi.
//!
//! For the follower the linear map is the limit of small |dT|. Where both sides are twice continuously differentiable up to the
//! border, what is left out is of the size of |dT|, in the first derivatives too; a region that goes into its inside and a cone
//! that is stretched stay so under it (Simpson and Glendinning 2021, on terms of higher order). How small |dT| must be is not
//! said.

use super::conditions::{Condition, Decides};
use super::local_map::LocalMap;
use super::word::Word;
use crate::cam::Side;
use crate::known::Known;
use crate::orbit::Eigenvalue;
use crate::tolerance;

/// The theorem at one sign of mu, where there are such saddles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RobustChaos {
    /// The side L.
    pub saddle: Side,
    /// What must be positive.
    pub hypotheses: [Condition; 5],
    /// `ln min(l, k)`, below which no motion's Lyapunov exponent is, a step.
    pub least_exponent: f64,
    /// How the signs of the hypotheses are known.
    pub known: Known,
}

document!(RobustChaos as chaos {
    saddle: chaos.saddle,
    hypotheses: chaos.hypotheses,
    holds: chaos.holds(),
    least_exponent: chaos.least_exponent,
    known: chaos.known,
});

impl RobustChaos {
    /// Whether every hypothesis holds.
    pub fn holds(&self) -> bool {
        self.hypotheses.iter().all(Condition::holds)
    }
}

impl LocalMap {
    /// The theorem at `mu`; `None` where its saddles are not there.
    pub fn robust_chaos(&self, mu: f64) -> Option<RobustChaos> {
        let sides = [(Side::Minus, Side::Plus, "L"), (Side::Plus, Side::Minus, "R")];
        sides.into_iter().find_map(|(saddle, other, word)| {
            let (first, second) = (self.of(saddle), self.of(other));
            let ([Eigenvalue { re: l, .. }, _], [_, Eigenvalue { re: minus_k, .. }]) =
                (first.eigenvalues(), second.eigenvalues());
            let [tau_l, tau_r] = [first, second].map(|side| side.a.trace());
            let [delta_l, delta_r] = [first, second].map(|side| side.a.determinant());
            let one = |name, meaning, terms: &[f64]| Condition {
                name,
                meaning,
                value: terms.iter().sum(),
                distance: terms.iter().sum::<f64>() / terms.iter().map(|term| term.abs()).sum::<f64>(),
                least: tolerance::DEGENERATE,
                decides: Decides::RobustChaos,
            };
            let (no_inside, lost) =
                ("the map does not keep the sense of turning", "the saddle's unstable manifold leaves");
            let hypotheses = [
                one("delta_L", no_inside, &[delta_l]),
                one("delta_R", no_inside, &[delta_r]),
                one("tau_L - (1 + delta_L)", "L has no saddle with an eigenvalue above 1", &[tau_l, -1.0, -delta_l]),
                one("-tau_R - (1 + delta_R)", "R has no saddle with an eigenvalue below -1", &[-tau_r, -1.0, -delta_r]),
                // phi = l (l - delta_L) + (l - 1)(l tau_R - delta_R)
                one("phi", lost, &[l * l, -l * delta_l, (l - 1.0) * l * tau_r, (1.0 - l) * delta_r]),
            ];
            // Where one saddle is on its own side, so is the other.
            let is_there = self.orbit(&Word::read(word)?, mu)?.admissible();
            (is_there && hypotheses.iter().take(4).all(Condition::holds)).then(|| RobustChaos {
                saddle,
                hypotheses,
                least_exponent: l.min(-minus_k).ln(),
                known: Known::Computed,
            })
        })
    }
}
