//! Least value over a turn of the lift, or of a linear combination of its derivatives, such as a force.

use std::f64::consts::TAU;

use super::{Cam, Law, Lift, Segment, apart};
use crate::bracket::{Width, halve};
use crate::tolerance;

/// Minimum of a quantity on a cam.
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct Least {
    /// Index of the segment; at a corner either side may be given.
    pub segment: usize,
    /// Cam angle, rad.
    pub angle: f64,
    /// Least value.
    pub value: f64,
    /// Lift and derivatives of that segment at the angle.
    pub lift: Lift,
}

/// Number of angles examined in a turn, and the least number in a segment or, for cosines, in each period.
const OF_A_TURN: f64 = 1440.0;
const OF_A_SEGMENT: usize = 8;

/// Weights whose combination is least at the highest lift.
const UPSIDE_DOWN: [f64; 4] = [-1.0, 0.0, 0.0, 0.0];

impl Cam {
    /// The lowest lift.
    pub fn lowest(&self) -> Least {
        self.least([1.0, 0.0, 0.0, 0.0])
    }

    /// The highest lift.
    pub fn highest(&self) -> Least {
        let least = self.least(UPSIDE_DOWN);
        Least { value: -least.value, ..least }
    }

    /// Highest places of the lift, equal up to rounding, each once, by rising angle; a dwell is given by its ends.
    pub fn tops(&self) -> Vec<Least> {
        let segments = self.segments().iter().enumerate();
        let all: Vec<Least> = segments.flat_map(|(index, segment)| places(index, segment, UPSIDE_DOWN)).collect();
        let highest = self.highest().value;
        let size = highest.abs().max(self.lowest().value.abs());
        let mut tops: Vec<Least> = Vec::new();
        for place in all.into_iter().map(|place| Least { value: -place.value, ..place }) {
            let is_new = |known: &Least| apart(known.angle, place.angle) > tolerance::CORNER_ANGLE.value;
            if highest - place.value <= tolerance::RANGE_ROUNDING.value * size && tops.iter().all(is_new) {
                tops.push(place);
            }
        }
        tops.sort_by(|one, other| one.angle.total_cmp(&other.angle));
        tops
    }

    /// Place where `a_0 c + a_1 c' + a_2 c'' + a_3 c'''` is least, from sign changes of its derivative between neighbouring angles. The
    /// shortest wave of the cam has eight of these angles.
    pub fn least(&self, weights: [f64; 4]) -> Least {
        let segments = self.segments().iter().enumerate();
        // Every cam has a segment.
        lowest(segments.flat_map(|(index, segment)| places(index, segment, weights))).unwrap_or(Least {
            segment: 0,
            angle: 0.0,
            value: f64::NAN,
            lift: Lift::constant(f64::NAN),
        })
    }

    /// Place where this combination is least on a segment before an angle. The distances from that angle halve down to its rounding.
    pub fn least_before(&self, segment: usize, angle: f64, weights: [f64; 4]) -> Option<Least> {
        let of = &self.segments()[segment];
        let angles = halved(angle - of.start).map(|before| angle - before);
        lowest(places_among(segment, &of.law, weights, angles))
    }
}

/// Distances from 0 that halve, from the largest down to the rounding of an angle.
pub(crate) fn halved(largest: f64) -> impl Iterator<Item = f64> {
    const HALVINGS: i32 = 48;
    (0..HALVINGS).map(move |halving| largest * 0.5_f64.powi(halving))
}

impl Segment {
    /// Lowest and highest lift, m.
    pub fn extremes(&self) -> [f64; 2] {
        let least = |weights| lowest(places(0, self, weights)).map_or(f64::NAN, |place| place.value);
        [least([1.0, 0.0, 0.0, 0.0]), -least(UPSIDE_DOWN)]
    }
}

/// First of the lowest places.
fn lowest(places: impl IntoIterator<Item = Least>) -> Option<Least> {
    places.into_iter().reduce(|least, found| if found.value < least.value { found } else { least })
}

/// Ends of a segment, the lower first, and its local minima.
fn places(index: usize, segment: &Segment, weights: [f64; 4]) -> Vec<Least> {
    let Segment { start, end, law, .. } = segment;
    let waves = match law {
        Law::Harmonics(harmonics) => harmonics.highest(),
        _ => 0,
    };
    let part = (end - start) / TAU;
    let count = (OF_A_TURN * part).ceil().max(OF_A_SEGMENT as f64).max(part * (OF_A_SEGMENT * waves) as f64) as usize;
    places_among(index, law, weights, (0..=count).map(|place| start + (end - start) * place as f64 / count as f64))
}

/// First and last of some rising angles, the lower first, and the local minima between them, where the derivative changes sign.
fn places_among(index: usize, law: &Law, weights: [f64; 4], angles: impl Iterator<Item = f64>) -> Vec<Least> {
    let at = |angle: f64| {
        let lift = law.lift(angle);
        let fourth = if weights[3] == 0.0 { 0.0 } else { law.jet(angle).0[4] };
        let of = |terms: [f64; 4]| {
            weights[0] * terms[0] + weights[1] * terms[1] + weights[2] * terms[2] + weights[3] * terms[3]
        };
        let falls = of([lift.slope, lift.curvature, lift.third, fourth]) < 0.0;
        let value = of([lift.value, lift.slope, lift.curvature, lift.third]);
        (Least { segment: index, angle, value, lift }, falls)
    };
    let looked: Vec<(Least, bool)> = angles.map(at).collect();
    let (Some((first, _)), Some((last, _))) = (looked.first(), looked.last()) else { return Vec::new() };
    let mut all = if last.value < first.value { vec![*last, *first] } else { vec![*first, *last] };
    for ends in looked.windows(2) {
        let [(before, true), (after, false)] = ends else { continue };
        let ends = [before.angle, after.angle];
        let Ok(found) = halve::<std::convert::Infallible>(ends, Width::Halvings(60), |angle| Ok(!at(angle).1));
        all.extend(lowest([at(found[1]).0, *before, *after]));
    }
    all
}
