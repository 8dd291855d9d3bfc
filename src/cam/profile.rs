//! The cam of each profile that a model may have; those that take some geometry have files of their own.

use std::f64::consts::{PI, TAU};

use super::harmonics::Harmonics;
use super::law::Law;
use super::polynomial::Polynomial;
use super::sinusoid::Sinusoid;
use super::{Cam, Joint, Segment, arcs, program, table, tolerance};
use crate::model::{CamProfile, HarmonicProfile, Model, ModelError, PolynomialSegment, RectifiedSineProfile};

impl Cam {
    /// The cam of a model, or the complaint about the field that makes it impossible.
    pub fn new(model: &Model) -> Result<Self, ModelError> {
        let cam = Self::of(model, &model.cam)?;
        let sizes =
            |segment: &Segment| [segment.bounds.third, segment.bounds.lift[0].abs(), segment.bounds.lift[1].abs()];
        let is_sized = |size: f64| size <= tolerance::LEAST_SIZE.value.recip();
        if cam.segments.iter().flat_map(sizes).all(is_sized) {
            Ok(cam)
        } else {
            let most = tolerance::LEAST_SIZE.value.recip();
            Err(model
                .reject("cam.law", format!("gives lifts or derivatives too large, above {most:.0e}: use other units")))
        }
    }

    fn of(model: &Model, profile: &CamProfile) -> Result<Self, ModelError> {
        match profile {
            CamProfile::Arcs(profile) => arcs::build(model, profile),
            CamProfile::Harmonic(profile) => Ok(harmonic(profile)),
            CamProfile::RectifiedSine(profile) => Ok(rectified_sine(profile)),
            CamProfile::Program(profile) => program::build(model, profile),
            CamProfile::Polynomial(segments) => polynomial(model, segments),
            CamProfile::Table(profile) => table::build(model, profile),
            CamProfile::Rounded { corner_rounding_deg, sharp } => {
                Self::of(model, sharp)?.rounded(model, *corner_rounding_deg)
            }
        }
    }
}

/// One smooth segment all round.
fn harmonic(profile: &HarmonicProfile) -> Cam {
    Cam::from_laws(vec![(0.0, Law::Harmonics(Harmonics::new(profile)))], Joint::Free)
}

/// A hump on `[0, pi]`, and the same again.
fn rectified_sine(profile: &RectifiedSineProfile) -> Cam {
    let RectifiedSineProfile { offset, amplitude } = *profile;
    // offset + a sin u = offset + a u - a (u - sin u)
    let hump =
        |start: f64| Sinusoid { start, value: offset, tilt: amplitude, sine: -amplitude, cosine: 0.0, frequency: 1.0 };
    Cam::from_laws(vec![(0.0, Law::Sinusoid(hump(0.0))), (PI, Law::Sinusoid(hump(PI)))], Joint::Free)
}

fn polynomial(model: &Model, segments: &[PolynomialSegment]) -> Result<Cam, ModelError> {
    let law = |segment: &PolynomialSegment| {
        let start = segment.start_deg.to_radians();
        (start, Polynomial::new(start, &segment.coefficients))
    };
    let typed: Vec<(f64, Polynomial)> = segments.iter().map(law).collect();
    // Where the first one starts past 0, the last one comes first as well.
    let moved = segments.first().is_some_and(|segment| segment.start_deg > 0.0);
    let cam = |laws: &[(f64, Polynomial)]| {
        let laws = laws.iter().map(|(start, law)| (*start, Law::Polynomial(law.clone()))).collect();
        Cam::from_laws(laws, Joint::Free).without_steps(|segment| {
            (model, format!("cam.segment[{}].coefficients[0]", segment.saturating_sub(usize::from(moved))))
        })
    };
    let as_typed = cam(&typed)?;
    match joined(&as_typed, &typed) {
        Some(joined) => cam(&joined),
        None => Ok(as_typed),
    }
}

/// Polynomials of numbers that were typed to ten digits miss each other by the tenth where they meet, in the lift and, where the velocity
/// does not jump, in the slope: two cams to whoever asks on either side, on which no two routes to a map agree. So what they miss is taken
/// out, and spread over the turn. `None` where it is rounding.
///
/// ```text
/// c_i + a_i + (t_i + t) u + q u^2          t_{i+1} = t_i + 2 q h_i - (c'_{i+1}(0) - c'_i(h_i))
///                                          a_{i+1} = a_i + (t_i + t) h_i + q h_i^2 - (c_{i+1}(0) - c_i(h_i))
/// ```
///
/// with the spans `h_i`, and q and t as the turn closes.
fn joined(cam: &Cam, typed: &[(f64, Polynomial)]) -> Option<Vec<(f64, Polynomial)>> {
    let next = |index: usize| (index + 1) % typed.len();
    let spans: Vec<f64> = (0..typed.len())
        .map(|index| typed[next(index)].0 - typed[index].0 + if next(index) == 0 { TAU } else { 0.0 })
        .collect();
    let mut is_rounding = true;
    let mut missed = |index: usize| {
        let ((start, law), (end, after)) = (&typed[index], &typed[next(index)]);
        let (minus, plus) = (law.jet(start + spans[index]), after.jet(*end));
        let (minus_terms, plus_terms) = (law.terms(start + spans[index]), after.terms(*end));
        let jumps = cam.corners().iter().any(|corner| corner.angle == *end && corner.jump_order == 1);
        [0, 1].map(|order| {
            let terms = minus_terms.0[order].max(plus_terms.0[order]) + minus_terms.0[order + 1];
            let missed = if order == 1 && jumps { 0.0 } else { plus.0[order] - minus.0[order] };
            is_rounding &= missed.abs() <= tolerance::JET_ROUNDING.value * terms;
            missed
        })
    };
    let missed: Vec<[f64; 2]> = (0..typed.len()).map(&mut missed).collect();
    if is_rounding {
        return None;
    }
    let q = missed.iter().map(|[_, slope]| slope).sum::<f64>() / (2.0 * TAU);
    let (mut tilts, mut own) = (Vec::new(), 0.0);
    for ([_, slope], span) in missed.iter().zip(&spans) {
        tilts.push(own);
        own += 2.0 * q * span - slope;
    }
    let rise = |index: usize| spans[index] * (tilts[index] + q * spans[index]);
    let tilt = (0..typed.len()).map(|index| missed[index][0] - rise(index)).sum::<f64>() / TAU;
    let (mut joined, mut lift) = (Vec::new(), 0.0);
    for (index, (start, law)) in typed.iter().enumerate() {
        joined.push((*start, law.plus([lift, tilts[index] + tilt, q])));
        lift += rise(index) + tilt * spans[index] - missed[index][0];
    }
    Some(joined)
}
