//! Curves of corner impacts in two parameters, as lines of CSV and in words.

use std::fmt::{self, Write};

use crate::border_collision::scenario;
use crate::orbit::branch::{Branch, BranchPoint, Kind, Special};
use crate::orbit::eigenvalues;

/// The columns of a table of curves.
pub const COLUMNS: &str = "rpm,parameter,value,revolutions,impacts,cam_angle_rad,jump_order,scenario,multiplier_minus_1_re,\
    multiplier_minus_1_im,multiplier_minus_2_re,multiplier_minus_2_im,multiplier_plus_1_re,multiplier_plus_1_im,\
    multiplier_plus_2_re,multiplier_plus_2_im,special,curve\n";

/// What is the same all along a curve: the impact at the corner, by its number, and the order of the jump.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AtCorner {
    /// Index of the impact, of those from angle 0 on.
    pub contact: usize,
    /// The lowest derivative that jumps.
    pub jump_order: usize,
}

/// What Feigin's counts say at a point of the curve.
pub fn kind(point: &BranchPoint, at: AtCorner) -> &'static str {
    if at.jump_order != 2 {
        return "not-piecewise-linear";
    }
    point.sides.as_ref().and_then(|sides| scenario(sides).ok()).map_or("degenerate", |scenario| scenario.name())
}

/// Appends one corner impact.
pub fn line(lines: &mut String, parameter: &str, index: usize, at: AtCorner, point: &BranchPoint) {
    let BranchPoint { rpm, value, orbit, special, sides } = point;
    let angle = orbit.impacts().nth(at.contact).map_or(f64::NAN, |impact| impact.cam_angle);
    let name = special.map_or("", |special| special.kind.name());
    let impacts = orbit.impacts().count();
    let _ = write!(
        lines,
        "{rpm},{parameter},{value},{},{impacts},{angle},{},{}",
        orbit.revolutions,
        at.jump_order,
        kind(point, at)
    );
    for value in sides.iter().flatten().flat_map(eigenvalues) {
        let _ = write!(lines, ",{},{}", value.re, value.im);
    }
    let _ = writeln!(lines, ",{name},{index}");
}

/// What a curve passes and where it ends, for people.
pub fn account(curve: &Branch, parameter: &str, index: usize, at: AtCorner) -> Result<String, fmt::Error> {
    let mut page = String::new();
    let (Some(first), Some(last)) = (curve.points.first(), curve.points.last()) else { return Ok(page) };
    let impacts = first.orbit.impacts().count();
    let angle = first.orbit.impacts().nth(at.contact).map_or(f64::NAN, |impact| impact.cam_angle.to_degrees());
    writeln!(
        page,
        "curve {index}: {} corner impacts, impact {} of {impacts} at {angle:.4} deg, jump of order {}",
        curve.points.len(),
        at.contact + 1,
        at.jump_order
    )?;
    writeln!(page, "  begins at {parameter} = {:.9}, {:.6} rpm: {}", first.value, first.rpm, curve.ends[0].words())?;
    let (mut before, mut place) = (None, first);
    for pair in curve.points.windows(2) {
        let [point, next] = pair else { continue };
        let now = kind(point, at);
        if point.special.is_none() && before != Some(now) {
            // From the special point on, if one came right before.
            writeln!(page, "  {parameter} = {:.9}, {:.6} rpm: {now} from here", place.value, place.rpm)?;
            before = Some(now);
        }
        place = if next.special.is_some() || point.special.is_none() { next } else { place };
        if let Some(Special { kind, .. }) = next.special {
            let what = match kind {
                Kind::Type { after_corner, multiplier } => {
                    let side = if after_corner { "after" } else { "before" };
                    format!("a multiplier with the law {side} the corner is {multiplier}")
                }
                Kind::Fold => "the curve turns round".into(),
                Kind::Corner { contact, .. } if contact == at.contact => "the model as it is".into(),
                Kind::Corner { .. } => "another impact of the orbit is at a corner".into(),
                _ => kind.name().into(),
            };
            writeln!(page, "  {parameter} = {:.9}, {:.6} rpm: {what}", next.value, next.rpm)?;
        }
    }
    writeln!(page, "  ends at {parameter} = {:.9}, {:.6} rpm: {}", last.value, last.rpm, curve.ends[1].words())?;
    Ok(page)
}
