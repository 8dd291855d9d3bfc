//! The least value round the cam of a lift, or of a force that its derivatives make.

use std::f64::consts::TAU;

use super::{Cam, Law, Lift, Segment, apart};
use crate::bracket::{Width, halve};
use crate::tolerance;

/// Where on a cam something is least.
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct Least {
    /// Index of the segment: at a corner either side may have it.
    pub segment: usize,
    /// Cam angle, rad.
    pub angle: f64,
    /// Least value.
    pub value: f64,
    /// Lift and derivatives there, of that segment.
    pub lift: Lift,
}

/// Angles examined in a turn, and at least in a segment; for a cosine, in each of its periods.
const OF_A_TURN: f64 = 1440.0;
const OF_A_SEGMENT: usize = 8;

/// The highest lift is where this is least.
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

    /// The places that are as high as the highest but for rounding, each once, by rising angle; of a dwell its ends.
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

    /// Place where `a_0 c + a_1 c' + a_2 c'' + a_3 c'''` is least: from the sign of its derivative between neighbouring angles. The
    /// shortest wave of the cam has eight of these.
    pub fn least(&self, weights: [f64; 4]) -> Least {
        let segments = self.segments().iter().enumerate();
        let of_segments = segments.map(|(index, segment)| of_segment(index, segment, weights));
        // A cam has a segment.
        of_segments.min_by(|one, other| one.value.total_cmp(&other.value)).unwrap_or(Least {
            segment: 0,
            angle: 0.0,
            value: f64::NAN,
            lift: Lift::constant(f64::NAN),
        })
    }
}

impl Segment {
    /// Its lowest and its highest lift, m.
    pub fn extremes(&self) -> [f64; 2] {
        [of_segment(0, self, [1.0, 0.0, 0.0, 0.0]).value, -of_segment(0, self, UPSIDE_DOWN).value]
    }
}

fn of_segment(index: usize, segment: &Segment, weights: [f64; 4]) -> Least {
    let places = places(index, segment, weights);
    places.into_iter().reduce(|least, found| if found.value < least.value { found } else { least }).unwrap_or_else(
        || {
            let lift = segment.law.lift(segment.start);
            Least { segment: index, angle: segment.start, value: f64::NAN, lift }
        },
    )
}

/// The ends of a segment, the lower first, and the places between them that are lower than their neighbours.
fn places(index: usize, segment: &Segment, weights: [f64; 4]) -> Vec<Least> {
    let Segment { start, end, law, .. } = segment;
    let at = |angle: f64| {
        let lift = law.lift(angle);
        let value =
            weights[0] * lift.value + weights[1] * lift.slope + weights[2] * lift.curvature + weights[3] * lift.third;
        Least { segment: index, angle, value, lift }
    };
    let waves = match law {
        Law::Harmonics(harmonics) => harmonics.highest(),
        _ => 0,
    };
    let part = (end - start) / TAU;
    let count = (OF_A_TURN * part).ceil().max(OF_A_SEGMENT as f64).max(part * (OF_A_SEGMENT * waves) as f64) as usize;
    let angle = |place: usize| start + (end - start) * place as f64 / count as f64;
    let falls = |angle: f64| {
        let Lift { slope, curvature, third, .. } = law.lift(angle);
        let fourth = if weights[3] == 0.0 { 0.0 } else { law.jet(angle).0[4] };
        weights[0] * slope + weights[1] * curvature + weights[2] * third + weights[3] * fourth < 0.0
    };
    let looked: Vec<Least> = (0..=count).map(|place| at(angle(place))).collect();
    let mut all = if looked[count].value < looked[0].value {
        vec![looked[count], looked[0]]
    } else {
        vec![looked[0], looked[count]]
    };
    // The least may be between either end and its neighbour: the turn of a cosine begins and ends anywhere, and a damper pulls right
    // before a dwell.
    for place in 0..=count {
        let [before, here, after] = [looked[place.saturating_sub(1)], looked[place], looked[count.min(place + 1)]];
        if here.value <= before.value && here.value <= after.value && falls(before.angle) && !falls(after.angle) {
            let ends = [before.angle, after.angle];
            let Ok(found) = halve::<std::convert::Infallible>(ends, Width::Halvings(60), |angle| Ok(!falls(angle)));
            let found = at(found[1]);
            all.push(if found.value < here.value { found } else { here });
        }
    }
    all
}
