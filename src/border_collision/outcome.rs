//! Predictions of the local map near the corner impact, for mu = 1, -1 and 0.

use nalgebra::Vector2;

use super::feigin::speeds_at;
use super::local_map::{LocalMap, MapOrbit};
use super::long_run::{EscapeReason, LocalChaos, LocalLongRun, MEASURED, STEPS};
use super::robust_chaos::RobustChaos;
use super::trapping::TrappingRegion;
use super::word::Word;
use crate::cam::Side;
use crate::elementary;
use crate::estimate::Estimate;
use crate::tolerance;

/// Largest length of the words for which periodic orbits are listed.
pub const LONGEST_WORD: usize = 8;

/// Motions of the local map for one sign of mu.
#[derive(Clone, Debug, PartialEq)]
#[doc(hidden)]
pub struct LocalOutcome {
    /// Parameter: 1, -1 or 0; everything scales with its size.
    pub mu: f64,
    /// Fixed points of both sides, admissible or not; empty if mu is 0.
    pub fixed_points: Vec<MapOrbit>,
    /// Orbit LR, admissible or not; `None` if mu is 0 or if the orbit is not isolated.
    pub period_two: Option<MapOrbit>,
    /// All admissible periodic orbits of at most `LONGEST_WORD` steps, fixed points included.
    pub orbits: Vec<MapOrbit>,
    /// Theorem of robust chaos, if its saddles exist.
    pub robust_chaos: Option<RobustChaos>,
    /// Ends of motions, each kind once. The first is the end of the motion from x = 0, the state of the corner impact.
    pub fates: Vec<Fate>,
}

/// End of some of the motions.
#[derive(Clone, Debug, PartialEq)]
pub struct Fate {
    pub end: LocalLongRun,
    /// Number of starts with this end, out of [`LocalOutcome::starts`].
    pub starts: usize,
}

document!(LocalOutcome as outcome {
    speeds: speeds_at(outcome.mu),
    fixed_points: outcome.fixed_points,
    period_two: outcome.period_two,
    periodic_orbits: outcome.orbits,
    robust_chaos if_any: outcome.robust_chaos,
    starts: outcome.starts(),
    ends: outcome.fates,
});

document!(Fate as fate {
    end: fate.end.name(),
    word if_any: match &fate.end {
        LocalLongRun::Periodic(orbit) => Some(orbit.word.to_string()),
        _ => None,
    },
    exponent if_any: fate.end.exponent().map(|exponent| exponent.value),
    standard_error if_any: fate.end.exponent().map(|exponent| exponent.error),
    starts: fate.starts,
    basis: fate.end.basis(),
});

impl LocalOutcome {
    /// Number of starts that were run.
    pub fn starts(&self) -> usize {
        self.fates.iter().map(|fate| fate.starts).sum()
    }
}

impl LocalMap {
    /// Motions of the map on either side of the corner impact, and at it.
    pub fn outcomes(&self) -> [LocalOutcome; 3] {
        [-1.0, 1.0, 0.0].map(|mu| self.outcome(mu))
    }

    /// Simulates the map for `mu` from x = 0 and from circles around it, a tenth, one and ten times its size. The size is its natural
    /// units, or the distance of its fixed points if that is larger.
    pub fn outcome(&self, mu: f64) -> LocalOutcome {
        const DIRECTIONS: u32 = 8;
        const CIRCLES: [f64; 3] = [0.1, 1.0, 10.0];
        let [left, right, two] = ["L", "R", "LR"].map(Word::read);
        let orbit = |word: &Word| if mu == 0.0 { None } else { self.orbit(word, mu) };
        let fixed_points: Vec<_> = [left, right].iter().flatten().filter_map(orbit).collect();
        let there = fixed_points.iter().filter(|orbit| orbit.admissible()).flat_map(|orbit| orbit.points.clone());
        let scales = there.fold(self.scales(), |scales, point| scales.sup(&point.abs()));
        let around = CIRCLES.iter().flat_map(|radius| {
            (0..DIRECTIONS).map(move |index| {
                // The angles avoid the axes, which can be invariant.
                let angle = std::f64::consts::TAU * (f64::from(index) + 0.3) / f64::from(DIRECTIONS);
                Vector2::new(elementary::cos(angle) * scales[0], elementary::sin(angle) * scales[1]) * *radius
            })
        });
        let center = (mu != 0.0).then(Vector2::zeros);
        let mut fates: Vec<Fate> = Vec::new();
        for start in center.into_iter().chain(around) {
            let end = self.end(start, mu);
            match fates.iter_mut().find(|fate| fate.end.is_like(&end)) {
                Some(fate) => fate.starts += 1,
                None => fates.push(Fate { end, starts: 1 }),
            }
        }
        LocalOutcome {
            mu,
            fixed_points,
            period_two: two.as_ref().and_then(orbit),
            orbits: if mu == 0.0 { Vec::new() } else { self.admissible_orbits(mu, LONGEST_WORD) },
            robust_chaos: if mu == 0.0 { None } else { self.robust_chaos(mu) },
            fates,
        }
    }
}

impl LocalLongRun {
    /// Name in documents.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Periodic(orbit) if orbit.word.sides().len() == 1 => "fixed-point",
            Self::Periodic(_) => "periodic",
            Self::Chaotic(..) => "chaotic",
            Self::Undecided(_) => "undecided",
            Self::Corner => "corner",
            Self::Escapes(_) => "escapes",
        }
    }

    /// Basis of the decision.
    pub fn basis(&self) -> String {
        match self {
            Self::Periodic(orbit) => {
                let largest =
                    orbit.multipliers.iter().map(|value| elementary::hypot(value.re, value.im)).fold(0.0, f64::max);
                format!(
                    "the motion repeats {}; this orbit lies on its own sides and has multipliers up to {largest:.6}",
                    orbit.word
                )
            }
            Self::Chaotic(LocalChaos { region: TrappingRegion { polygons, corners }, least_exponent, .. }) => {
                let above = match least_exponent {
                    Some(least) => {
                        format!("every motion has a Lyapunov exponent of at least {least:.6}, by an invariant cone")
                    }
                    None => format!(
                        "its Lyapunov exponent, a mean over {MEASURED} steps, is above 0 by {:.0} standard errors or more",
                        1.0 / tolerance::CHAOTIC_EXPONENT.value
                    ),
                };
                format!(
                    "the map sends a region around the motion, {polygons} convex polygon(s) with {corners} corners, into itself, so \
                     the motion stays there; {above}"
                )
            }
            Self::Undecided(_) => format!(
                "bounded and without a stable word over the run of {STEPS} steps. But either its Lyapunov exponent, a mean over \
                 {MEASURED} of them, is not known to be above 0, or no region was found that it stays in. Then it may leave later"
            ),
            Self::Corner => "the motion shrinks below any size".into(),
            Self::Escapes(EscapeReason::Follows { word, multiplier }) => {
                format!("the motion diverges along the sequence {word}, by a factor of {multiplier:.6} per period")
            }
            Self::Escapes(EscapeReason::Grown) => {
                format!("the motion grew past {:.0e} times its scale", 1.0 / tolerance::ESCAPED.value)
            }
        }
    }

    /// Whether both are the same kind of end, and the same orbit or exponent up to error.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Periodic(one), Self::Periodic(other)) => one.word == other.word,
            (Self::Chaotic(LocalChaos { exponent: one, .. }), Self::Chaotic(LocalChaos { exponent: other, .. })) => {
                let apart = (one.value - other.value).abs() * tolerance::CHAOTIC_EXPONENT.value;
                apart <= elementary::hypot(one.error, other.error).max(tolerance::DEGENERATE.value)
            }
            _ => self.name() == other.name(),
        }
    }

    /// Exponent of a motion that repeats no word.
    fn exponent(&self) -> Option<&Estimate> {
        match self {
            Self::Chaotic(LocalChaos { exponent, .. }) | Self::Undecided(exponent) => Some(exponent),
            _ => None,
        }
    }

    /// Side of a fixed point.
    pub fn fixed_on(&self) -> Option<Side> {
        match self {
            Self::Periodic(orbit) => match orbit.word.sides() {
                [side] => Some(*side),
                _ => None,
            },
            _ => None,
        }
    }
}
