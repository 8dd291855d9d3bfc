//! Cam of each profile that a model may have; profiles that need some geometry have separate files.

use std::f64::consts::{PI, TAU};

use super::envelope::Unfollowed;
use super::harmonics::Harmonics;
use super::law::Law;
use super::polynomial::Polynomial;
use super::sinusoid::Sinusoid;
use super::{Cam, Joint, Segment, arcs, program, table, tolerance, within_a_turn};
use crate::model::{
    CamProfile, ContourProfile, HarmonicProfile, Model, ModelError, PolynomialSegment, RectifiedSineProfile,
};

impl Cam {
    /// Builds the cam of a model; the error names the field that makes it impossible.
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
            CamProfile::Contour(profile) => contour(model, profile),
            CamProfile::Modified { change, plain } => {
                let sharp = Self::of(model, plain)?;
                let rounded = match change.corner_rounding_deg {
                    0.0 => sharp,
                    degrees => sharp.rounded(model, degrees)?,
                };
                Ok(rounded.levered(change.lever_ratio))
            }
        }
    }
}

/// Lift of the follower on a contour; the error names the reason why it cannot follow it.
fn contour(model: &Model, profile: &ContourProfile) -> Result<Cam, ModelError> {
    let table = &profile.table;
    let reject = |polar: f64, why: Unfollowed| {
        let degrees = within_a_turn(polar).to_degrees();
        let after = table.rows.partition_point(|row| row.angle_deg <= degrees);
        let row = table.rows[after.checked_sub(1).unwrap_or(table.rows.len() - 1)];
        let place = match &table.file {
            Some(file) => format!("line {} of {file}", row.line),
            None => format!("the row on line {}", row.line),
        };
        let at = format!("near {degrees:.2} deg of its polar angle, {place}");
        let unit = model.units.length.name();
        match why {
            Unfollowed::NoRadius => model.reject(
                table.place(),
                format!("has no radius above 0 {at}: the spline through its rows meets the axis"),
            ),
            Unfollowed::Hollow { radius } => {
                let shape = if radius.abs() < 1e9 * table.rise() {
                    format!("hollow, with a radius of curvature of {:.4} {unit},", radius.abs())
                } else {
                    "straight".to_owned()
                };
                let words = format!(
                    "must not be a flat face here: the contour is {shape} {at}, where a flat face cannot touch it; if the rows are only rough there, set \
                     spline = \"smoothing\""
                );
                model.reject("cam.contact", words)
            }
            Unfollowed::Undercut { radius } => {
                let words = format!(
                    "must be below {:.4} {unit}, the radius of curvature of the hollow {at}: a larger roller does not fit into it \
                     (undercutting)",
                    radius.abs()
                );
                model.reject("cam.contact.roller_radius", words)
            }
            Unfollowed::Beside => {
                let words = format!(
                    "is too large: {at} the line of motion does not cross the path of the roller's centre, and the pressure angle is 90 deg"
                );
                model.reject("cam.contact.offset", words)
            }
            Unfollowed::Sharp => {
                let words = format!(
                    "turns too sharply {at} for the lift of this follower: give rows closer together there, or smooth them"
                );
                model.reject(table.place(), words)
            }
        }
    };
    let radius = table::build(model, table)?;
    let largest = radius.highest().value;
    let cam = radius.enveloped(profile.contact, reject)?;
    profile.contact.fits(model, largest).map(|()| cam)
}

/// One smooth segment all round.
fn harmonic(profile: &HarmonicProfile) -> Cam {
    Cam::from_laws(vec![(0.0, Law::Harmonics(Harmonics::new(profile)))], Joint::Free)
}

/// Two equal humps, on `[0, pi]` and `[pi, 2 pi]`.
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
    // If the first segment starts after 0, the last one also covers the angles before it.
    let moved = segments.first().is_some_and(|segment| segment.start_deg > 0.0);
    let cam = |laws: &[(f64, Polynomial)]| {
        let laws = laws.iter().map(|(start, law)| (*start, Law::Polynomial(law.clone()))).collect();
        Cam::from_laws(laws, Joint::Free).without_steps(|segment| {
            (model, format!("cam.segment[{}].coefficients[0]", segment.saturating_sub(usize::from(moved))))
        })
    };
    let as_typed = cam(&typed)?;
    joined(&typed).map_or(Ok(as_typed), |joined| cam(&joined))
}

/// Number of derivatives, from the lift on, that are made to agree where polynomials meet.
const JOINED: usize = 4;

/// Removes small mismatches of the lift and its derivatives where polynomials meet, and spreads them over the turn. Numbers typed to ten
/// digits leave a mismatch in the tenth digit. It would make corners that nobody meant, and no two routes to a map would agree. A mismatch
/// of up to [`tolerance::CAM_CLOSURE`] of the terms is removed; `None` if all are rounding.
///
/// ```text
/// c_i(u) + sum_n e_{n,i} u^n/n!,    e_{n,i+1} = sum_{k >= n} e_{k,i} h_i^{k-n}/(k-n)! - (c_{i+1}^(n)(0) - c_i^(n)(h_i))
/// ```
///
/// over spans `h_i`, from the highest n down. An equal addition to the derivative n + 1 everywhere closes the turn in the derivative n.
fn joined(typed: &[(f64, Polynomial)]) -> Option<Vec<(f64, Polynomial)>> {
    let next = |index: usize| (index + 1) % typed.len();
    let span = |index: usize| typed[next(index)].0 - typed[index].0 + if next(index) == 0 { TAU } else { 0.0 };
    let mut is_rounding = true;
    let mut missed = |index: usize| {
        let ((start, law), (after_start, after)) = (&typed[index], &typed[next(index)]);
        let end = start + span(index);
        let (minus, plus) = (law.jet(end), after.jet(*after_start));
        let terms: [f64; JOINED + 1] = std::array::from_fn(|n| law.terms(end).0[n].max(after.terms(*after_start).0[n]));
        std::array::from_fn(|n| {
            let missed = plus.0[n] - minus.0[n];
            // A larger mismatch is a corner.
            let missed = if missed.abs() <= tolerance::CAM_CLOSURE.value * terms[n] { missed } else { 0.0 };
            is_rounding &= missed.abs() <= tolerance::JET_ROUNDING.value * (terms[n] + terms[n + 1]);
            missed
        })
    };
    let missed: Vec<[f64; JOINED]> = (0..typed.len()).map(&mut missed).collect();
    if is_rounding {
        return None;
    }
    let mut added = vec![[0.0; JOINED + 1]; typed.len()];
    for n in (0..JOINED).rev() {
        let rise = |index: usize, added: &[f64; JOINED + 1]| {
            let (mut power, mut sum) = (1.0, 0.0);
            for (order, derivative) in added[n + 1..].iter().enumerate() {
                power *= span(index) / (order + 1) as f64;
                sum += derivative * power;
            }
            sum
        };
        let open: f64 = (0..typed.len()).map(|index| missed[index][n] - rise(index, &added[index])).sum();
        added.iter_mut().for_each(|added| added[n + 1] += open / TAU);
        for index in 0..typed.len() - 1 {
            added[index + 1][n] = added[index][n] + rise(index, &added[index]) - missed[index][n];
        }
    }
    Some(typed.iter().zip(&added).map(|((start, law), added)| (*start, law.plus(added))).collect())
}
