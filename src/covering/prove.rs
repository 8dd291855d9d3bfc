//! Proves that the strips of an h-set cover it and keep cones, or reports where the proof fails.
//!
//! A strip S covers N where its flights are proved all over it, one of its edges is carried beyond one side of N, the other edge beyond the
//! other side, and no part of it to a point with x inside N's range and y outside. It keeps the cones `|dy| <= L |dx|`, and stretches
//! differences in them, where the derivative [[a, b], [c, d]], with a of one sign all over it, has
//!
//! ```text
//! |a| - L |b| > 1        |c| + L |d| <= L (|a| - L |b|)
//! ```
//!
//! Both hold for a mean of derivatives where they hold for each, so they are shown box by box. With them exactly one motion follows a
//! sequence in both directions: the map can be run backwards, and each impact shrinks `u dtheta du` by exactly `r^2 e^{-2 zeta t}`. So the
//! impacts of one past, which lie between two graphs of slope L or less, lie on one graph. Two of them with one future would differ within
//! the cone, and separate. The argument needs losses, and u above 0 all over N.

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
    /// Impacts until it is carried across the h-set.
    pub impacts: u64,
    /// Turns of the cam until then.
    pub revolutions: u64,
    /// Range of y of the image, where it lies over the h-set.
    pub image_y: [f64; 2],
    /// Least factor that stretches a difference in the cone; `None` where cones were not requested.
    pub growth: Option<f64>,
    /// Number of boxes of the proof.
    pub boxes: usize,
}

/// Condition of the proof.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Relation {
    /// The h-set is a parallelogram, and its strips are in it and disjoint.
    Apart,
    /// Each flight ends with a first impact that is transversal.
    Flight,
    /// The edges of the strip are carried beyond the h-set, each beyond its own side.
    Edges,
    /// No part of the strip is carried above or below the h-set.
    Height,
    /// Cones are kept.
    Cones,
    /// Impacts or flights take energy from the motion. Where cones are kept, this makes the motion of a sequence unique.
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
    /// x and y of the failure.
    pub at: [f64; 2],
    /// Reason why the flight is not proved.
    pub flight: Option<UnprovedFlight>,
    /// Whether the relation is refuted; otherwise the boxes ran out.
    pub is_refuted: bool,
}

/// A part of a strip, with its image if it is computed already.
type Part = (SectionBox, Option<Image>);

/// Boxes after which the proof of a relation is given up. A strip that covers with a margin takes some hundreds.
const MOST_BOXES: usize = 1 << 12;

/// Proves that each strip covers the h-set, at its speeds whatever the machine's own. The error is that of a strip without a proof.
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

/// Checks that there are losses where cones are requested: cones make the motion of a sequence unique only with losses.
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

/// Proves that one strip covers the h-set, and keeps cones where they are requested.
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
