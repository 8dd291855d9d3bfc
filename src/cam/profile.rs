//! The cam of each profile that a model may have; those that take some geometry have files of their own.

use std::f64::consts::PI;

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
        (start, Law::Polynomial(Polynomial::new(start, &segment.coefficients)))
    };
    // Where the first one starts past 0, the last one comes first as well.
    let moved = segments.first().is_some_and(|segment| segment.start_deg > 0.0);
    Cam::from_laws(segments.iter().map(law).collect(), Joint::Free).without_steps(|segment| {
        (model, format!("cam.segment[{}].coefficients[0]", segment.saturating_sub(usize::from(moved))))
    })
}
