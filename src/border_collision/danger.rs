//! Danger at a corner impact that Feigin's counts do not show: basins that shrink to nothing, or several attractors.
//!
//! *Dangerous* (Hassouneh, Abed and Nusse 2004; Ganguli and Banerjee 2005): motions diverge at mu = 0, although the local map has an
//! attractor on either side of the corner impact, such as a stable fixed point. The map looks the same at every scale. So its basins at
//! mu are those at mu = 1 or -1, scaled by |mu|. The motions that diverge at mu = 0 bound the basins, which shrink to nothing as mu goes to 0.
//!
//! *Multiple attractors* (Dutta, Nusse, Ott, Yorke and Yuan 1999): the local map has several attractors at one sign of mu. They and
//! the borders between their basins shrink to one point as mu goes to 0. So the smallest disturbance there decides between them.

use std::convert::Infallible;
use std::f64::consts::TAU;

use nalgebra::Vector2;
use serde::Serialize;

use super::feigin::{Classification, Speeds};
use super::local_map::{LocalMap, MapOrbit};
use super::long_run::{EscapeReason, LocalLongRun};
use super::outcome::LocalOutcome;
use super::word::Word;
use crate::bracket::{Width, halve};
use crate::elementary;
use crate::known::Evidence;
use crate::tolerance;

/// Kind of danger.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum DangerKind {
    /// Attractors on either side, whose basins shrink to nothing at omega*.
    Dangerous,
    /// Several attractors on one side, which meet at omega*.
    MultipleAttractors,
}

named!(DangerKind);

/// Danger at a corner impact, by the local map.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Danger {
    /// Kind of danger; dangerous if both kinds apply.
    pub kind: DangerKind,
    /// Evidence for the kind: the evidence of its weakest premise.
    pub known: Evidence,
    /// Motions that diverge at omega*; `None` if the danger is several attractors alone.
    #[serde(rename = "diverges")]
    pub divergence: Option<Divergence>,
    /// Attractors on either side.
    pub attractors: Vec<LocalAttractor>,
}

/// Motions of the local map that diverge at omega*.
#[derive(Clone, Debug, PartialEq)]
#[doc(hidden)]
pub struct Divergence {
    /// Share of directions, in the map's natural units, in which motions diverge. If computed or proved, it is a lower bound; 1 then means
    /// that the motion of every start except the corner impact itself diverges.
    pub share: f64,
    /// `Computed` by intervals from the doubles of the map; `Proved` if the intervals contain the matrices of a certificate.
    pub known: Evidence,
    /// Word that one of the motions repeats, and its growth factor per repetition.
    pub follows: Option<(Word, f64)>,
}

document!(Divergence as it {
    share_of_directions: it.share,
    known: it.known,
    word: it.follows.as_ref().map(|(word, _)| word.to_string()),
    multiplier: it.follows.as_ref().map(|(_, multiplier)| *multiplier),
});

/// Attractor of the local map.
#[derive(Clone, Debug, PartialEq)]
#[doc(hidden)]
pub struct LocalAttractor {
    /// Speeds at which it exists.
    pub speeds: Speeds,
    /// Evidence that it is an attractor.
    pub known: Evidence,
    /// Long-run motion on the attractor.
    pub end: LocalLongRun,
    /// Disturbances that return to it; `None` for chaos, and if the basin is not examined.
    pub returns: Option<Returns>,
}

document!(LocalAttractor as it {
    speeds: it.speeds,
    known: it.known,
    end: it.end.name(),
    word: it.word().map(Word::to_string),
    returns: it.returns,
});

/// Disturbances of a periodic orbit that return to it; all smaller sampled ones return as well. All are per unit of the distance of the
/// speed from omega*, with which they grow. `None` if every tried disturbance returns.
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct Returns {
    /// Largest disturbance of the position on the section, m per rpm.
    pub position: Option<f64>,
    /// Largest disturbance of the velocity on the section, m/s per rpm.
    pub velocity: Option<f64>,
    /// Largest disturbance of both, the least of sixteen directions: its size `|(q, v/omega)|`, m per rpm.
    pub any: Option<f64>,
}

document!(Returns as it {
    known: Evidence::Sampled,
    position_m_per_rpm: it.position,
    velocity_m_s_per_rpm: it.velocity,
    any_m_per_rpm: it.any,
});

/// Classification with the danger that it does not show, written as one document.
#[derive(Serialize)]
pub(crate) struct WithDanger<'a> {
    #[serde(flatten)]
    pub kind: &'a Classification,
    pub danger: Option<&'a Danger>,
}

impl LocalAttractor {
    /// Word of a periodic orbit.
    pub fn word(&self) -> Option<&Word> {
        match &self.end {
            LocalLongRun::Periodic(orbit) => Some(&orbit.word),
            _ => None,
        }
    }
}

impl Danger {
    /// Attractors at these speeds.
    pub fn at(&self, speeds: Speeds) -> impl Iterator<Item = &LocalAttractor> {
        self.attractors.iter().filter(move |attractor| attractor.speeds == speeds)
    }

    /// Records a proof of the share of directions in which motions diverge. With `is_attracting` the attractors count as proved, too, if
    /// all are fixed points.
    pub fn prove(&mut self, share: f64, is_attracting: bool) {
        if let Some(divergence) = self.divergence.as_mut().filter(|_| share > 0.0) {
            (divergence.share, divergence.known) = (share, Evidence::Proved);
            if is_attracting && self.attractors.iter().all(|attractor| attractor.end.fixed_on().is_some()) {
                self.attractors.iter_mut().for_each(|attractor| attractor.known = Evidence::Proved);
                self.known = Evidence::Proved;
            }
        }
    }
}

impl LocalMap {
    /// Danger at a corner impact with period `period`, s, from the motions of the local map on either side of it and at it.
    pub fn danger(&self, outcomes: &[LocalOutcome], period: f64) -> Option<Danger> {
        let mut attractors: Vec<LocalAttractor> = outcomes.iter().flat_map(attractors).collect();
        let count = |speeds| attractors.iter().filter(|attractor| attractor.speeds == speeds).count();
        let [faster, slower] = [Speeds::Faster, Speeds::Slower].map(count);
        let divergence = if faster > 0 && slower > 0 { self.divergence() } else { None };
        let kind = match &divergence {
            Some(_) => DangerKind::Dangerous,
            None if faster > 1 || slower > 1 => DangerKind::MultipleAttractors,
            None => return None,
        };
        let known = attractors.iter().map(|attractor| attractor.known);
        let known = known.chain(divergence.as_ref().map(|it| it.known)).max().unwrap_or(Evidence::Sampled);
        for attractor in &mut attractors {
            if let LocalLongRun::Periodic(orbit) = &attractor.end {
                attractor.returns = Some(self.returns(orbit, attractor.speeds, period));
            }
        }
        Some(Danger { kind, known, divergence, attractors })
    }

    /// Motions that diverge at mu = 0, if any.
    pub fn divergence(&self) -> Option<Divergence> {
        /// Number of directions in which motions start.
        const SAMPLED: u32 = 64;
        let scales = self.scales();
        let end = |index: u32| {
            // The angles avoid the axes, which can be invariant.
            let angle = TAU * (f64::from(index) + 0.3) / f64::from(SAMPLED);
            self.end(Vector2::new(elementary::cos(angle) * scales[0], elementary::sin(angle) * scales[1]), 0.0)
        };
        let escapes: Vec<EscapeReason> = (0..SAMPLED)
            .filter_map(|index| match end(index) {
                LocalLongRun::Escapes(escape) => Some(escape),
                _ => None,
            })
            .collect();
        let follows = escapes.iter().find_map(|escape| match escape {
            EscapeReason::Follows { word, multiplier } => Some((word.clone(), *multiplier)),
            EscapeReason::Grown => None,
        });
        let (computed, sampled) =
            (self.homogeneous().diverging(!escapes.is_empty()), escapes.len() as f64 / f64::from(SAMPLED));
        let (share, known) = if computed > 0.0 { (computed, Evidence::Computed) } else { (sampled, Evidence::Sampled) };
        (share > 0.0).then_some(Divergence { share, known, follows })
    }

    /// Disturbances of a stable orbit that return to it.
    fn returns(&self, orbit: &MapOrbit, speeds: Speeds, period: f64) -> Returns {
        /// Number of directions of a disturbance.
        const DIRECTIONS: u32 = 16;
        let mu = if speeds == Speeds::Faster { -1.0 } else { 1.0 };
        // |dT| = T^2/60 |d rpm|, and the local map scales with |dT|.
        let per_rpm = period * period / 60.0;
        let smallest = |directions: &[Vector2<f64>]| {
            let each = orbit.points.iter().flat_map(|point| directions.iter().map(move |along| (point, along)));
            each.filter_map(|(point, along)| self.first_lost(orbit, *point, *along, mu)).reduce(f64::min)
        };
        let axis = |along: Vector2<f64>| smallest(&[along, -along]).map(|size| size * per_rpm);
        // Multiplication by an angular velocity makes a velocity of a length.
        let omega = TAU / period;
        let around = |index: u32| {
            let angle = TAU * f64::from(index) / f64::from(DIRECTIONS);
            Vector2::new(elementary::cos(angle), elementary::sin(angle) * omega)
        };
        let around: Vec<_> = (0..DIRECTIONS).map(around).collect();
        Returns {
            position: axis(Vector2::x()),
            velocity: axis(Vector2::y()),
            any: smallest(&around).map(|size| size * per_rpm),
        }
    }

    /// Smallest disturbance of a point of a stable orbit, in one direction, that does not return to the orbit.
    fn first_lost(&self, orbit: &MapOrbit, point: Vector2<f64>, along: Vector2<f64>, mu: f64) -> Option<f64> {
        /// Ratio of successive disturbances.
        const GROWTH: f64 = 1.25;
        /// Largest disturbance that is tried, in the map's natural units.
        const MOST: f64 = 1e3;
        // Length of one natural unit of the map in this direction.
        let unit = 1.0 / along.component_div(&self.units()).norm();
        let along = along * unit;
        let word = orbit.word.least_rotation().0;
        let is_lost = |size: f64| match self.end(point + along * size, mu) {
            LocalLongRun::Periodic(reached) => reached.word.least_rotation().0 != word,
            _ => true,
        };
        let (mut returned, mut size) = (0.0, tolerance::LEAST_DISTURBANCE.value);
        while size < MOST {
            if is_lost(size) {
                let Ok([inside, _]) = halve([returned, size], Width::Relative(tolerance::BASIN_EDGE.value), |size| {
                    Ok::<_, Infallible>(is_lost(size))
                });
                return Some(inside * unit);
            }
            returned = size;
            size *= GROWTH;
        }
        None
    }
}

/// Attractors of the local map at one sign of mu: the stable orbits listed, and further ends of motions.
fn attractors(outcome: &LocalOutcome) -> Vec<LocalAttractor> {
    let Some(speeds) = Speeds::of(outcome.mu) else { return Vec::new() };
    let attractor = |end, known| LocalAttractor { speeds, known, end, returns: None };
    let stable = outcome.orbits.iter().filter(|orbit| orbit.stable());
    let mut all: Vec<_> =
        stable.map(|orbit| attractor(LocalLongRun::Periodic(orbit.clone()), Evidence::Computed)).collect();
    for fate in &outcome.fates {
        let known = match &fate.end {
            LocalLongRun::Periodic(_) => Evidence::Computed,
            LocalLongRun::Chaotic(_) => Evidence::Sampled,
            _ => continue,
        };
        if !all.iter().any(|other| other.end.is_like(&fate.end)) {
            all.push(attractor(fate.end.clone(), known));
        }
    }
    all
}
