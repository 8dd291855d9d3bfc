//! Robust chaos: the theorem by which a corner impact alone makes chaos, and its hypotheses.
//!
//! Let one side's fixed point, L, be a saddle with an eigenvalue above 1, and the other side's, R, a saddle with an eigenvalue below -1.
//! Let both determinants be positive, at a sign of mu at which both saddles exist:
//!
//! ```text
//! delta_L > 0,   delta_R > 0,   tau_L > 1 + delta_L,   tau_R < -(1 + delta_R)
//! phi = l (l - delta_L) + (l - 1)(l tau_R - delta_R) > 0,   l the eigenvalue of A_L above 1
//! ```
//!
//! Then there is a bounded region that the map sends into itself (Banerjee, Yorke and Grebogi 1998; proved by Glendinning and Simpson
//! 2021). Both matrices also send one cone of directions into itself and stretch it. In companion coordinates the stretch along x is at
//! least l-fold on L and k-fold on R; -k is the eigenvalue of A_R below -1 (`derivations/border_collision.py`). So every motion's Lyapunov
//! exponent is at least ln min(l, k), and no orbit of any period is stable. The cone does not need phi.
//!
//! For the follower the linear map is the limit of small |dT|. If both sides are twice continuously differentiable up to the border, the
//! terms left out are of the size of |dT|, also in the first derivatives. A region that is mapped into its interior and a cone that is
//! stretched persist under these terms (Simpson and Glendinning 2021, on terms of higher order). The theorem does not say how small |dT|
//! must be.

use super::conditions::{Condition, Decides};
use super::local_map::LocalMap;
use super::word::Word;
use crate::cam::Side;
use crate::corner::SideMap;
use crate::elementary;
use crate::interval::{Interval, Number};
use crate::known::Evidence;
use crate::orbit::Eigenvalue;
use crate::tolerance;

/// Theorem of robust chaos at one sign of mu, if the saddles exist.
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct RobustChaos {
    /// Side L.
    pub saddle: Side,
    /// Quantities that must be positive.
    pub hypotheses: [Condition; 5],
    /// Lower bound `ln min(l, k)` per step of every motion's Lyapunov exponent.
    pub least_exponent: f64,
    /// Evidence for the signs of the hypotheses.
    pub known: Evidence,
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

/// Quantities that must be positive, each with the sum of its terms' sizes, from the traces and determinants of L and of R.
fn hypotheses<N: Number>([tau_l, tau_r]: [N; 2], [delta_l, delta_r]: [N; 2]) -> [(N, f64); 5] {
    let one = N::from(1.0);
    // l = (tau_L + sqrt(tau_L^2 - 4 delta_L))/2
    let l = (tau_l + (tau_l * tau_l - delta_l * 4.0).sqrt()) * 0.5;
    // phi = l (l - delta_L) + (l - 1)(l tau_R - delta_R)
    let (rise, fall) = (l * (l - delta_l), (l - one) * (l * tau_r - delta_r));
    [
        (delta_l, delta_l.magnitude()),
        (delta_r, delta_r.magnitude()),
        (tau_l - delta_l - one, tau_l.magnitude() + delta_l.magnitude() + 1.0),
        (-tau_r - delta_r - one, tau_r.magnitude() + delta_r.magnitude() + 1.0),
        (rise + fall, rise.magnitude() + fall.magnitude()),
    ]
}

/// Name of each hypothesis, and the consequence of its failure.
const NAMES: [[&str; 2]; 5] = [
    ["delta_L", "the map does not keep the orientation"],
    ["delta_R", "the map does not keep the orientation"],
    ["tau_L - (1 + delta_L)", "L has no saddle with an eigenvalue above 1"],
    ["-tau_R - (1 + delta_R)", "R has no saddle with an eigenvalue below -1"],
    ["phi", "the saddle's unstable manifold leaves"],
];

impl RobustChaos {
    /// Marks the hypotheses as proved, if they are true for all matrices A of L and of R, by rows, with entries in these intervals.
    pub fn prove(&mut self, matrices: [[[Interval; 2]; 2]; 2]) {
        let traces = matrices.map(|[[a, _], [_, d]]| a + d);
        let determinants = matrices.map(|[[a, b], [c, d]]| a * d - b * c);
        if hypotheses(traces, determinants).iter().all(|(value, _)| value.is_positive()) {
            self.known = Evidence::Proved;
        }
    }
}

impl LocalMap {
    /// Theorem at `mu`; `None` if its saddles do not exist.
    pub fn robust_chaos(&self, mu: f64) -> Option<RobustChaos> {
        let sides = [(Side::Minus, Side::Plus, "L"), (Side::Plus, Side::Minus, "R")];
        sides.into_iter().find_map(|(saddle, other, word)| {
            let both = [self.of(saddle), self.of(other)];
            let [[Eigenvalue { re: l, .. }, _], [_, Eigenvalue { re: minus_k, .. }]] = both.map(SideMap::eigenvalues);
            let found = hypotheses(both.map(|side| side.a.trace()), both.map(|side| side.a.determinant()));
            let hypotheses: [Condition; 5] = std::array::from_fn(|index| {
                let ([name, meaning], (value, terms)) = (NAMES[index], found[index]);
                let (distance, least, decides) = (value / terms, tolerance::DEGENERATE, Decides::RobustChaos);
                Condition { name, meaning, value, distance, least, decides }
            });
            // If one saddle is on its own side, so is the other.
            let is_there = self.orbit(&Word::read(word)?, mu)?.admissible();
            (is_there && hypotheses.iter().take(4).all(Condition::holds)).then(|| RobustChaos {
                saddle,
                hypotheses,
                least_exponent: elementary::ln(l.min(-minus_k)),
                known: Evidence::Computed,
            })
        })
    }
}
