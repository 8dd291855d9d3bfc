//! Whether the strips of an h-set cover it, and keep cones: proved, or how far it came.
//!
//! A strip S covers N where its flights are proved to be what they are all over it, one of its edges is carried beyond one side of N,
//! the other beyond the other side, and nothing of it to where x is N's and y is not. It keeps the cones `|dy| <= L |dx|`, and
//! stretches what is in them, where the derivative [[a, b], [c, d]], with a of one sign all over it, has
//!
//! ```text
//! |a| - L |b| > 1        |c| + L |d| <= L (|a| - L |b|)
//! ```
//!
//! Both hold for a mean of derivatives where they hold for each, so they need be shown box by box only. With them a sequence in both
//! directions is followed by one motion: the map can be run backwards, and each impact shrinks `u dtheta du` by exactly
//! `r^2 e^{-2 zeta t}`, so the impacts of one past, which lie between two graphs of slope L or less, lie on one; and two of them with one future
//! would differ within the cone, and part. That asks for losses, and for u above 0 all over N.

use rayon::prelude::*;
use serde::Serialize;

use super::frame::{HSetFrame, Image, SectionBox, angular_velocities};
use super::map::{ImpactMap, UnprovedFlight};
use super::{HSet, Strip};
use crate::interval::{Interval, Number};
use crate::simulate::Machine;

/// What is proved of a strip.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Covered {
    /// Impacts until it is carried across the h-set.
    pub impacts: u64,
    /// Turns of the cam until then.
    pub revolutions: u64,
    /// The range of its image's y, as far as that is over the h-set.
    pub image_y: [f64; 2],
    /// What a difference in the cone is stretched by at least; nothing where cones were not asked for.
    pub growth: Option<f64>,
    /// Boxes that it took.
    pub boxes: usize,
}

/// What must hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Relation {
    /// The h-set is a parallelogram, its strips are in it and apart.
    Apart,
    /// Each flight ends with a first impact that is transversal.
    Flight,
    /// The edges of the strip are carried beyond the h-set, each on a side of its own.
    Edges,
    /// Nothing of the strip is carried above or below the h-set.
    Height,
    /// Cones are kept.
    Cones,
    /// Impacts or flights take from the motion, which makes motions of one sequence one where cones are kept.
    Losses,
}

named!(Relation);

/// Why a strip is not proved to cover.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Refused {
    /// The relation that failed.
    pub relation: Relation,
    /// Impacts of the strip.
    pub impacts: u64,
    /// Where: x and y.
    pub at: [f64; 2],
    /// What is not proved of a flight.
    pub flight: Option<UnprovedFlight>,
    /// Whether it is shown not to hold, or the boxes ran out.
    pub is_refuted: bool,
}

/// A part of a strip, with its image where that is known.
type Part = (SectionBox, Option<Image>);

/// Boxes that a relation is given up after: a strip that covers with room to spare takes some hundreds.
const MOST_BOXES: usize = 1 << 12;

/// Proves that each strip covers the h-set, on a machine of any speed; the first one that is not proved to is the error.
pub fn prove(machine: &Machine, set: &HSet) -> Result<Vec<Covered>, Refused> {
    stands(set)?;
    loses(machine, set)?;
    set.strips.par_iter().map(|strip| covered(machine, set, strip, MOST_BOXES)).collect()
}

/// Whether an interval of numbers is one.
fn is_range([low, high]: [f64; 2]) -> bool {
    low < high && (high - low).is_finite()
}

/// Whether an h-set is a parallelogram of impacts with strips in it that are apart.
pub(super) fn stands(set: &HSet) -> Result<(), Refused> {
    let refused = |strip: &Strip| {
        let at = [strip.x[0], set.y[0]];
        Err(Refused { relation: Relation::Apart, impacts: strip.impacts, at, flight: None, is_refuted: true })
    };
    let determinant = Interval::from(set.unstable[0]) * set.stable[1] - Interval::from(set.unstable[1]) * set.stable[0];
    let [x, y] = [set.x, set.y].map(|[low, high]| Interval::new(low, high));
    let velocity = x * set.unstable[1] + y * set.stable[1] + set.centre[1];
    let is_sound = !determinant.holds_zero()
        && is_range(set.x)
        && is_range(set.y)
        && set.rpm[0] <= set.rpm[1]
        && velocity.is_positive();
    for (index, strip) in set.strips.iter().enumerate() {
        let is_inside = is_range(strip.x) && set.x[0] < strip.x[0] && strip.x[1] < set.x[1];
        let is_apart = set.strips[..index].iter().all(|other| other.x[1] < strip.x[0] || strip.x[1] < other.x[0]);
        if !(is_sound && is_inside && is_apart) {
            return refused(strip);
        }
    }
    Ok(())
}

/// Cones say of motions with losses that those of one sequence are one.
pub(super) fn loses(machine: &Machine, set: &HSet) -> Result<(), Refused> {
    let is_lossless = machine.restitution() >= 1.0 && machine.flight().zeta() == 0.0;
    match set.strips.first().filter(|_| set.cone_slope.is_some() && is_lossless) {
        None => Ok(()),
        Some(Strip { impacts, x, .. }) => {
            let (relation, impacts, at) = (Relation::Losses, *impacts, [x[0], set.y[0]]);
            Err(Refused { relation, impacts, at, flight: None, is_refuted: true })
        }
    }
}

/// Whether one strip covers the h-set, and keeps cones where they are asked for.
pub(super) fn covered(machine: &Machine, set: &HSet, strip: &Strip, most_boxes: usize) -> Result<Covered, Refused> {
    let proof = Proof { map: ImpactMap::new(machine), frame: HSetFrame::new(set), set, strip, most_boxes };
    let (y, omega) = (Interval::new(set.y[0], set.y[1]), angular_velocities(set.rpm));
    let whole = Interval::new(set.x[0], set.x[1]);
    let beyond = |left: bool, image: &Image| {
        let x = if left { image.value[0].high() < whole.low() } else { whole.high() < image.value[0].low() };
        let fails = if left { whole.low() <= image.centre[0].low() } else { image.centre[0].high() <= whole.high() };
        if x { Some(true) } else { fails.then_some(false) }
    };
    // Which edge goes to which side is seen in the middle of one of them.
    let edges = strip.x.map(|x| [x.into(), y, omega]);
    let middle = proof.frame.image(&proof.map, strip, &edges[0].map(|side: Interval| side.middle().into()));
    let is_left = middle.is_ok_and(|image| image.centre[0].middle() < whole.middle());
    for (edge, left) in edges.into_iter().zip([is_left, !is_left]) {
        proof.all(vec![(edge, None)], Relation::Edges, |image| beyond(left, image))?;
    }
    let boxes = vec![([Interval::new(strip.x[0], strip.x[1]), y, omega], None)];
    let inside = |image: &Image| {
        let [x, height] = image.value;
        let is_past = x.high() < whole.low() || whole.high() < x.low();
        if is_past || height.is_inside(y) {
            return Some(true);
        }
        let [x, height] = image.centre;
        (x.is_inside(whole) && (height.high() <= y.low() || y.high() <= height.low())).then_some(false)
    };
    let mut images = proof.all(boxes, Relation::Height, inside)?;
    let mut growth = None;
    if let Some(slope) = set.cone_slope {
        // a is not 0 in any box, and boxes that meet have what they share in both enclosures: so it has one sign all over.
        let keeps = |image: &Image| match image.stretched(slope) {
            Some(_) => Some(true),
            None => image.misses(slope).then_some(false),
        };
        images = proof.all(images, Relation::Cones, keeps)?;
        growth = images.iter().filter_map(|(_, image)| image.as_ref()?.stretched(slope)).reduce(f64::min);
    }
    let over = images.iter().filter_map(|(_, image)| *image).filter(|image| image.value[0].common(whole).is_some());
    let height = over.map(|image| image.value[1]).reduce(Interval::hull).unwrap_or(y);
    let (impacts, revolutions) = (strip.impacts, strip.revolutions);
    Ok(Covered { impacts, revolutions, image_y: [height.low(), height.high()], growth, boxes: images.len() })
}

/// The proof of one strip.
struct Proof<'a> {
    map: ImpactMap<'a>,
    frame: HSetFrame,
    set: &'a HSet,
    strip: &'a Strip,
    most_boxes: usize,
}

impl Proof<'_> {
    /// Whether something holds of the images of all parts of some boxes, which are halved until each part tells; those images.
    fn all(
        &self,
        mut left: Vec<Part>,
        relation: Relation,
        holds: impl Fn(&Image) -> Option<bool> + Sync,
    ) -> Result<Vec<Part>, Refused> {
        let look = |(place, image): Part| {
            let image = image.map_or_else(|| self.frame.image(&self.map, self.strip, &place), Ok);
            let holds = image.as_ref().ok().and_then(&holds);
            (place, image, holds)
        };
        let (mut proved, mut boxes) = (Vec::new(), 0);
        while !left.is_empty() {
            boxes += left.len();
            let looked: Vec<_> = left.into_par_iter().map(look).collect();
            left = Vec::new();
            for (place, image, holds) in looked {
                let is_refuted = holds == Some(false);
                if holds == Some(true) {
                    proved.push((place, image.ok()));
                } else if is_refuted || boxes > self.most_boxes {
                    let at = [place[0].middle(), place[1].middle()];
                    let relation = if image.is_ok() { relation } else { Relation::Flight };
                    return Err(Refused { relation, impacts: self.strip.impacts, at, flight: image.err(), is_refuted });
                } else {
                    left.extend(self.halves(&place, image.ok()).map(|half| (half, None)));
                }
            }
        }
        Ok(proved)
    }

    /// The halves of a box, across the side that its image is widest by, or that of its middle.
    fn halves(&self, place: &SectionBox, image: Option<Image>) -> [SectionBox; 2] {
        let sizes = [self.set.x, self.set.y].map(|[low, high]| high - low);
        let middle = || self.frame.image(&self.map, self.strip, &place.map(|side| side.middle().into())).ok();
        let image = image.or_else(middle);
        let weight = |side: usize| match &image {
            Some(image) => {
                let part = |row: usize| image.by[row][side].magnitude() * place[side].width() / sizes[row];
                part(0).max(part(1))
            }
            None => place[side].width(),
        };
        let widest = (0..3).max_by(|one, two| weight(*one).total_cmp(&weight(*two))).unwrap_or(0);
        place[widest].halves().map(|half| {
            let mut part = *place;
            part[widest] = half;
            part
        })
    }
}
