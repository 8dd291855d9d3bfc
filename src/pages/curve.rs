//! Curves of corner impacts in two parameters, as lines of CSV and in words.

use std::fmt::{self, Write};

use crate::border_collision::ImpactCurve;
use crate::border_collision::impact_curve::CurveImpact;
use crate::orbit::branch::{Kind, Special};

const COLUMNS: &str = "rpm,parameter,value,revolutions,impacts,cam_angle_rad,jump_order,scenario,multiplier_minus_1_re,\
    multiplier_minus_1_im,multiplier_minus_2_re,multiplier_minus_2_im,multiplier_plus_1_re,multiplier_plus_1_im,\
    multiplier_plus_2_re,multiplier_plus_2_im,special,curve\n";

/// Every corner impact of every curve.
pub fn table(parameter: &str, curves: &[ImpactCurve]) -> String {
    let mut table = COLUMNS.to_owned();
    curves.iter().enumerate().for_each(|(index, curve)| lines(&mut table, parameter, index + 1, curve));
    table
}

/// Appends the corner impacts of a curve.
fn lines(lines: &mut String, parameter: &str, index: usize, curve: &ImpactCurve) {
    let order = curve.at.jump_order;
    for impact in &curve.impacts {
        let CurveImpact { rpm, value, cam_angle, revolutions, impacts, happening, multipliers, special } = impact;
        let name = special.map_or("", |special| special.kind.name());
        // Writing to a string does not fail.
        let _ = write!(lines, "{rpm},{parameter},{value},{revolutions},{impacts},{cam_angle},{order},{happening}");
        for value in multipliers {
            let _ = write!(lines, ",{},{}", value.re, value.im);
        }
        let _ = writeln!(lines, ",{name},{index}");
    }
}

/// What a curve passes and where it ends, for people.
pub fn account(curve: &ImpactCurve, parameter: &str, index: usize) -> Result<String, fmt::Error> {
    let mut page = String::new();
    let (Some(first), Some(last)) = (curve.impacts.first(), curve.impacts.last()) else { return Ok(page) };
    let (at, impacts, angle) = (curve.at, first.impacts, first.cam_angle.to_degrees());
    writeln!(
        page,
        "curve {index}: {} corner impacts, impact {} of {impacts} at {angle:.4} deg, jump of order {}",
        curve.impacts.len(),
        at.impact + 1,
        at.jump_order
    )?;
    writeln!(page, "  begins at {parameter} = {:.9}, {:.6} rpm: {}", first.value, first.rpm, curve.ends[0].words())?;
    let (mut before, mut place) = (None, first);
    for pair in curve.impacts.windows(2) {
        let [point, next] = pair else { continue };
        let now = point.happening;
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
                Kind::Corner { impact, .. } if impact == at.impact => "the model as it is".into(),
                Kind::Corner { .. } => "another impact of the orbit is at a corner".into(),
                _ => kind.name().into(),
            };
            writeln!(page, "  {parameter} = {:.9}, {:.6} rpm: {what}", next.value, next.rpm)?;
        }
    }
    writeln!(page, "  ends at {parameter} = {:.9}, {:.6} rpm: {}", last.value, last.rpm, curve.ends[1].words())?;
    Ok(page)
}
