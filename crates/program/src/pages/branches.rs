//! Texts of `continue` and `curve`: special points along a branch of orbits and along a curve of events, and their ends.

use crate::show::digits::Digits;
use crate::show::words;
use corner_impact::border_collision::event_curve::EventPoint;
use corner_impact::border_collision::{EventCurve, RoundedCorner};
use corner_impact::model::Units;
use corner_impact::orbit::branch::{Branch, BranchPoint, Special, SpecialKind, UndecidedGraze};
use corner_impact::tolerance;

/// Special points of a branch, and its ends.
pub(crate) fn branch(branch: &Branch, (parameter, units): (&str, &Units), index: usize) -> String {
    /// Largest number of special points that are listed.
    const LISTED: usize = 40;
    let points = &branch.points;
    let (Some(first), Some(last)) = (points.first(), points.last()) else { return String::new() };
    let unit = unit_after(parameter, units);
    let place = |point: &BranchPoint| format!("{parameter} = {:.9}{unit}", point.value);
    let special = |point: &BranchPoint| {
        let Special { kind, bracket, residual } = point.special?;
        let (what, width) = (passed(point, kind, units), bracket[1] - bracket[0]);
        Some(format!("  {}  {what}  (bracket {width:.1e}, residual {residual:.1e})", place(point)))
    };
    let mut lines = vec![
        format!("branch {index}: {} orbits", points.len()),
        format!("  begins at {}: {}", place(first), branch.ends[0].words()),
    ];
    lines.extend(points.iter().filter_map(special).take(LISTED));
    let more = points.iter().filter(|point| point.special.is_some()).count().saturating_sub(LISTED);
    lines.extend((more > 0).then(|| format!("  and {more} more special points, in the table")));
    lines.push(format!("  ends at {}: {}\n", place(last), branch.ends[1].words()));
    lines.join("\n")
}

/// The unit of a number, after a blank. The name of the speed is its unit.
fn unit_after(parameter: &str, units: &Units) -> String {
    match units.of_number(parameter) {
        unit if unit.is_empty() || unit == parameter => String::new(),
        unit => format!(" {unit}"),
    }
}

fn passed(point: &BranchPoint, kind: SpecialKind, units: &Units) -> String {
    match kind {
        SpecialKind::Fold => "fold: a multiplier is 1".into(),
        SpecialKind::Branching => "branching: a multiplier is 1, and another branch crosses".into(),
        SpecialKind::Flip => "flip: a multiplier is -1".into(),
        SpecialKind::Corner { impact, jump_order, .. } => {
            let angle = point.orbit.impacts().nth(impact).map_or(f64::NAN, |impact| impact.cam_angle.to_degrees());
            let angle = Digits::Fixed(4).text(angle);
            format!("corner impact: impact {} at {angle} deg, jump of order {jump_order}", impact + 1)
        }
        SpecialKind::Graze { before, after, first, .. } => {
            let beyond = first.map_or_else(String::new, |touch| words::first_touch(touch, units));
            format!("graze: from {before} to {after} impacts{beyond}")
        }
        SpecialKind::Type { .. }
        | SpecialKind::Cusp
        | SpecialKind::Class(_)
        | SpecialKind::Place
        | SpecialKind::Turn => on_curve(kind),
        SpecialKind::Chatter => "chatter: the follower ceases to stick to the cam".into(),
        SpecialKind::Detachment => "detachment: the follower leaves the cam for the first time".into(),
    }
}

/// Quantity that changes along a curve.
fn on_curve(kind: SpecialKind) -> String {
    match kind {
        SpecialKind::Type { after_corner, multiplier } => {
            let side = match after_corner {
                Some(true) => "with the law after the corner",
                Some(false) => "with the law before the corner",
                None => "of the orbit without the graze",
            };
            format!("a multiplier {side} is {multiplier}")
        }
        SpecialKind::Cusp => "cusp: two folds meet".into(),
        SpecialKind::Class(UndecidedGraze::Eigenvalue(value)) => {
            format!("a multiplier of the orbit without impacts is {value:.4}")
        }
        SpecialKind::Class(UndecidedGraze::Resonance(passages)) => {
            let passages = words::many(passages, "passage");
            format!("resonance: {passages} of the cam's top after an impact, the follower is back at its equilibrium")
        }
        SpecialKind::Place => "the follower leaves the cam at two places at once".into(),
        SpecialKind::Turn => "the curve turns round".into(),
        SpecialKind::Corner { impact, .. } => format!("impact {} of the orbit is at a corner", impact + 1),
        SpecialKind::Graze { before, after, .. } => {
            format!("a flight touches the cam: from {before} to {after} impacts")
        }
        _ => "the place where the search for events began".into(),
    }
}

/// Special points and ends of a curve over the named number, whose value in the model is `own`.
pub(crate) fn curve(
    curve: &EventCurve,
    (parameter, own, units): (&str, f64, &Units),
    index: usize,
    sharp: &[(f64, RoundedCorner)],
) -> String {
    let (Some(first), Some(last)) = (curve.points.first(), curve.points.last()) else { return String::new() };
    let here = curve.points.iter().find(|point| point.value == own).unwrap_or(first);
    let (count, impacts, angle) = (curve.points.len(), here.impacts, here.cam_angle.to_degrees());
    let unit = unit_after(parameter, units);
    let place = |point: &EventPoint| format!("{parameter} = {:.9}{unit}, {:.6} rpm", point.value, point.rpm);
    let what = words::events(curve.kind);
    let of_orbit =
        || format!("of {} in {}", words::many(impacts as u64, "impact"), words::many(here.revolutions, "revolution"));
    let of_what = match curve.kind {
        // If an event could not be followed at all, its cam angle is unknown.
        SpecialKind::Graze { .. } if !angle.is_finite() => format!("from {impacts} to {} impacts", impacts + 1),
        _ if !angle.is_finite() => of_orbit(),
        SpecialKind::Corner { impact, jump_order, .. } => {
            format!("impact {} of {impacts} at {angle:.4} deg, jump of order {jump_order}", impact + 1)
        }
        SpecialKind::Graze { after, first: Some(touch), .. } => {
            let side = words::touch_side(touch.larger);
            format!("from 0 to {after} impacts {side}, at {angle:.4} deg")
        }
        SpecialKind::Graze { .. } => format!("from {impacts} to {} impacts, at {angle:.4} deg", impacts + 1),
        SpecialKind::Detachment => format!("at {angle:.4} deg"),
        SpecialKind::Chatter => format!("where the cam releases the follower at {angle:.4} deg"),
        _ => of_orbit(),
    };
    let mut lines = vec![
        format!("curve {index}: {count} {what}, {of_what}"),
        format!("  begins at {}: {}", place(first), curve.ends[0].words()),
    ];
    // The last point is the second of a pair below.
    lines.extend(first.special.map(|special| format!("  {}: {}", place(first), on_curve(special.kind))));
    let (mut before, mut from) = (None, first);
    for pair in curve.points.windows(2) {
        let [point, next] = pair else { continue };
        if let Some(now) = point.happening.filter(|now| point.special.is_none() && before != Some(*now)) {
            // Start at the special point, if one came directly before.
            lines.push(format!("  {}: {now} from here", place(from)));
            before = Some(now);
        }
        from = if next.special.is_some() || point.special.is_none() { next } else { from };
        if let Some(Special { kind, .. }) = next.special {
            let what = if next.value == own { "the model as it is".into() } else { on_curve(kind) };
            lines.push(format!("  {}: {what}", place(next)));
        }
    }
    lines.push(format!("  ends at {}: {}", place(last), curve.ends[1].words()));
    lines.extend(rounding(curve, sharp));
    lines.join("\n") + "\n"
}

/// Origin of a fold of rounded corners, compared with the closed form.
fn rounding(curve: &EventCurve, sharp: &[(f64, RoundedCorner)]) -> Option<String> {
    let least = curve.points.iter().min_by(|one, two| one.value.total_cmp(&two.value))?;
    let off = |rpm: f64| (least.rpm - rpm).abs();
    let (rpm, RoundedCorner { rpm_per_degree, degrees }) = sharp
        .iter()
        .filter(|_| curve.kind == SpecialKind::Fold)
        .min_by(|one, two| off(one.0).total_cmp(&off(two.0)))?;
    let followed = (least.rpm - rpm) / least.value;
    let within = tolerance::ROUNDED_AWAY.value;
    Some(format!(
        "  moves from the corner impact at {rpm:.9} rpm by {followed:.6} rpm per degree (closed form: {rpm_per_degree:.6}), \
         at most {within} rpm up to {degrees:.4} deg"
    ))
}
