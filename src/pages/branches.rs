//! The accounts of `continue` and `curve`: what a branch of orbits and a curve of corner impacts pass, and where they end.

use crate::border_collision::ImpactCurve;
use crate::border_collision::impact_curve::CurveImpact;
use crate::orbit::branch::{Branch, BranchPoint, Kind, Special};

/// What a branch passes and where it ends.
pub(crate) fn branch(branch: &Branch, parameter: &str, index: usize) -> String {
    /// Special points that are listed.
    const LISTED: usize = 40;
    let points = &branch.points;
    let (Some(first), Some(last)) = (points.first(), points.last()) else { return String::new() };
    let place = |point: &BranchPoint| format!("{parameter} = {:.9}", point.value);
    let special = |point: &BranchPoint| {
        let Special { kind, bracket, residual } = point.special?;
        let (what, width) = (passed(point, kind), bracket[1] - bracket[0]);
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

fn passed(point: &BranchPoint, kind: Kind) -> String {
    match kind {
        Kind::Fold => "fold: a multiplier is 1".into(),
        Kind::Branching => "branching: a multiplier is 1, and another branch crosses".into(),
        Kind::Flip => "flip: a multiplier is -1".into(),
        Kind::Corner { impact, jump_order, .. } => {
            let angle = point.orbit.impacts().nth(impact).map_or(f64::NAN, |impact| impact.cam_angle.to_degrees());
            format!("corner impact: impact {} at {angle:.4} deg, jump of order {jump_order}", impact + 1)
        }
        Kind::Graze { before, after } => format!("graze: from {before} to {after} impacts"),
        Kind::Type { after_corner, multiplier } => of_type(after_corner, multiplier),
        Kind::Chatter => "chatter: the follower ceases to stick to the cam".into(),
        Kind::Detachment => "detachment: the follower leaves the cam for the first time".into(),
    }
}

fn of_type(after_corner: bool, multiplier: f64) -> String {
    let side = if after_corner { "after" } else { "before" };
    format!("a multiplier with the law {side} the corner is {multiplier}")
}

/// What a curve passes and where it ends.
pub(crate) fn curve(curve: &ImpactCurve, parameter: &str, index: usize) -> String {
    let (Some(first), Some(last)) = (curve.impacts.first(), curve.impacts.last()) else { return String::new() };
    let (at, count, impacts) = (curve.at, curve.impacts.len(), first.impacts);
    let (angle, impact, order) = (first.cam_angle.to_degrees(), at.impact + 1, at.jump_order);
    let place = |impact: &CurveImpact| format!("{parameter} = {:.9}, {:.6} rpm", impact.value, impact.rpm);
    let mut lines = vec![
        format!(
            "curve {index}: {count} corner impacts, impact {impact} of {impacts} at {angle:.4} deg, jump of order {order}"
        ),
        format!("  begins at {}: {}", place(first), curve.ends[0].words()),
    ];
    let (mut before, mut from) = (None, first);
    for pair in curve.impacts.windows(2) {
        let [point, next] = pair else { continue };
        let now = point.happening;
        if point.special.is_none() && before != Some(now) {
            // From the special point on, if one came right before.
            lines.push(format!("  {}: {now} from here", place(from)));
            before = Some(now);
        }
        from = if next.special.is_some() || point.special.is_none() { next } else { from };
        if let Some(Special { kind, .. }) = next.special {
            let what = match kind {
                Kind::Type { after_corner, multiplier } => of_type(after_corner, multiplier),
                Kind::Fold => "the curve turns round".into(),
                Kind::Corner { impact, .. } if impact == at.impact => "the model as it is".into(),
                Kind::Corner { .. } => "another impact of the orbit is at a corner".into(),
                _ => kind.name().into(),
            };
            lines.push(format!("  {}: {what}", place(next)));
        }
    }
    lines.push(format!("  ends at {}: {}\n", place(last), curve.ends[1].words()));
    lines.join("\n")
}
