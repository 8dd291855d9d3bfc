//! Proofs that the strips of an h-set cover it and keep cones, or the place where the proof fails.
//!
//! A strip S covers N if its flights are proved over all of it and its two edges are carried beyond opposite sides of N. No part of it may
//! be carried to a point with x inside N's range and y outside. Let its derivative be [[a, b], [c, d]], with a of one sign over all of S.
//! S keeps the cones `|dy| <= L |dx|`, and stretches differences in them, if
//!
//! ```text
//! |a| - L |b| > 1        |c| + L |d| <= L (|a| - L |b|)
//! ```
//!
//! Both are true of a mean of derivatives if they are true of each, so they are shown box by box. With them exactly one motion follows a
//! sequence in both directions. The map can be run backwards, and each impact shrinks `u dtheta du` by exactly `r^2 e^{-2 zeta t}`. So the
//! impacts of one past, which lie between two graphs of slope L or less, lie on one graph. Two of them with one future would differ within
//! the cone, and separate. The argument needs losses, and u above 0 over all of N.

use rayon::prelude::*;
use serde::Serialize;

use super::frame::{HSetFrame, Image, SectionBox, angular_velocities};
use super::map::{ImpactMap, UnprovedFlight};
use super::{HSet, Strip};
use crate::interval::{Interval, Number};
use crate::simulate::Machine;

/// Proved properties of a strip.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Covered {
    /// Number of impacts until it is carried across the h-set.
    pub impacts: u64,
    /// Number of turns of the cam until then.
    pub revolutions: u64,
    /// Range of y of the image, where it lies over the h-set.
    pub image_y: [f64; 2],
    /// Least factor by which a difference in the cone is stretched; `None` if cones were not requested.
    pub growth: Option<f64>,
    /// Number of boxes of the proof.
    pub boxes: usize,
}

/// Condition of the proof.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Relation {
    /// Disjoint strips inside an h-set that is a parallelogram.
    Apart,
    /// First and transversal impact at the end of each flight.
    Flight,
    /// Edges of the strip, carried beyond opposite sides of the h-set.
    Edges,
    /// Height of the strip's image: no part is carried above or below the h-set.
    Height,
    /// Cones that are kept.
    Cones,
    /// Losses of energy by impacts or flights. If cones are kept, they make the motion of a sequence unique.
    Losses,
}

named!(Relation);

/// Failed proof that a strip covers the h-set.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Refused {
    /// Relation that failed.
    pub relation: Relation,
    /// Number of impacts of the strip.
    pub impacts: u64,
    /// Coordinates x and y of the failure.
    pub at: [f64; 2],
    /// Reason why the flight is not proved.
    pub flight: Option<UnprovedFlight>,
    /// Whether the relation is refuted; otherwise the boxes ran out.
    pub is_refuted: bool,
}

/// Part of a strip, with its image if it is already computed.
type Part = (SectionBox, Option<Image>);

/// Number of boxes after which the proof of a relation fails. A strip that covers with a margin needs some hundreds.
const MOST_BOXES: usize = 1 << 12;

/// Proves that each strip covers the h-set, at the set's speeds and not the machine's. The error belongs to a strip without a proof.
pub fn prove(machine: &Machine, set: &HSet) -> Result<Vec<Covered>, Refused> {
    stands(set)?;
    loses(machine, set)?;
    set.strips.par_iter().map(|strip| covered(machine, set, strip, MOST_BOXES)).collect()
}

/// Whether two numbers are the ends of a finite interval that is not empty.
fn is_range([low, high]: [f64; 2]) -> bool {
    low < high && (high - low).is_finite()
}

/// Checks that an h-set is a parallelogram of impacts with disjoint strips in it.
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

/// Checks that there are losses if cones are requested: only with losses do cones make the motion of a sequence unique.
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

/// Proves that one strip covers the h-set, and keeps cones if they are requested.
pub(super) fn covered(machine: &Machine, set: &HSet, strip: &Strip, most_boxes: usize) -> Result<Covered, Refused> {
    let proof = Proof { map: ImpactMap::new(machine), frame: HSetFrame::new(set), set, strip, most_boxes };
    let (y, omega) = (Interval::new(set.y[0], set.y[1]), angular_velocities(set.rpm));
    let whole = Interval::new(set.x[0], set.x[1]);
    let beyond = |left: bool, image: &Image| {
        let x = if left { image.value[0].high() < whole.low() } else { whole.high() < image.value[0].low() };
        let fails = if left { whole.low() <= image.centre[0].low() } else { image.centre[0].high() <= whole.high() };
        if x { Some(true) } else { fails.then_some(false) }
    };
    // The middle of one edge shows which edge goes to which side.
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
        // a is not 0 in any box, and neighbouring boxes share points that are in both enclosures: so a has one sign everywhere.
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

/// Proof for one strip.
struct Proof<'a> {
    map: ImpactMap<'a>,
    frame: HSetFrame,
    set: &'a HSet,
    strip: &'a Strip,
    most_boxes: usize,
}

impl Proof<'_> {
    /// Proves that `holds` is true of the images of some boxes, which are halved until each part is decided. Returns the parts with their
    /// images.
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

    /// Halves a box across the side that contributes most to the width of its image, or of the image of its middle.
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
