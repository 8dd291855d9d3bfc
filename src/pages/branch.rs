//! Branches of orbits as lines of CSV, and what there is to say about them.

use std::fmt::{self, Write};

use crate::orbit::branch::{Branch, BranchPoint, Kind, Special};

const COLUMNS: &str = "rpm,parameter,value,revolutions,impacts,cam_angle_rad,position_m,velocity_m_s,multiplier_1_re,\
    multiplier_1_im,multiplier_2_re,multiplier_2_im,stable,special,branch,jump_order,bracket_low,bracket_high,special_residual\n";

/// Every orbit of every branch.
pub fn table(parameter: &str, branches: &[Branch]) -> String {
    let mut lines = COLUMNS.to_owned();
    for (index, branch) in branches.iter().enumerate() {
        branch.points.iter().for_each(|point| line(&mut lines, parameter, index + 1, point));
    }
    lines
}

/// Appends one orbit of a branch: of its impacts the first, where the state is that right after it; of an orbit without
/// any, the state at angle 0.
fn line(lines: &mut String, parameter: &str, index: usize, point: &BranchPoint) {
    let BranchPoint { rpm, value, orbit, special, .. } = point;
    let impacts = orbit.impacts().count();
    let (angle, position, velocity) =
        orbit.impacts().next().map_or((0.0, orbit.state.position, orbit.state.velocity), |impact| {
            (impact.cam_angle, impact.position, impact.velocity_after)
        });
    let [one, two] = orbit.multipliers();
    let name = special.map_or("", |special| special.kind.name());
    let order = match special {
        Some(Special { kind: Kind::Corner { jump_order, .. }, .. }) => jump_order.to_string(),
        _ => String::new(),
    };
    let known = special
        .map_or(",,".into(), |Special { bracket: [low, high], residual, .. }| format!("{low},{high},{residual}"));
    // Writing to a string does not fail.
    let _ = writeln!(
        lines,
        "{rpm},{parameter},{value},{},{impacts},{angle},{position},{velocity},{},{},{},{},{},{name},{index},{order},{known}",
        orbit.revolutions,
        one.re,
        one.im,
        two.re,
        two.im,
        orbit.is_stable(),
    );
}

/// What a branch passes and where it ends, for people.
pub fn account(branch: &Branch, parameter: &str, index: usize) -> Result<String, fmt::Error> {
    /// Special points that are listed.
    const LISTED: usize = 40;
    let mut page = String::new();
    let points = &branch.points;
    let (Some(first), Some(last)) = (points.first(), points.last()) else { return Ok(page) };
    writeln!(page, "branch {index}: {} orbits", points.len())?;
    writeln!(page, "  begins at {parameter} = {:.9}: {}", first.value, branch.ends[0].words())?;
    let special: Vec<(&BranchPoint, Special)> =
        points.iter().filter_map(|point| point.special.map(|special| (point, special))).collect();
    for (point, Special { kind, bracket, residual }) in special.iter().take(LISTED) {
        let what = match kind {
            Kind::Fold => "fold: a multiplier is 1".into(),
            Kind::Branching => "branching: a multiplier is 1, and another branch crosses".into(),
            Kind::Flip => "flip: a multiplier is -1".into(),
            Kind::Corner { impact, jump_order, .. } => {
                let angle = point.orbit.impacts().nth(*impact).map_or(f64::NAN, |impact| impact.cam_angle.to_degrees());
                format!("corner impact: impact {} at {angle:.4} deg, jump of order {jump_order}", impact + 1)
            }
            Kind::Graze { before, after } => format!("graze: from {before} to {after} impacts"),
            Kind::Type { after_corner, multiplier } => {
                let side = if *after_corner { "after" } else { "before" };
                format!("a multiplier with the law {side} the corner is {multiplier}")
            }
            Kind::Chatter => "chatter: the follower ceases to stick to the cam".into(),
            Kind::Detachment => "detachment: the follower leaves the cam for the first time".into(),
        };
        let width = bracket[1] - bracket[0];
        writeln!(page, "  {parameter} = {:.9}  {what}  (bracket {width:.1e}, residual {residual:.1e})", point.value)?;
    }
    if special.len() > LISTED {
        writeln!(page, "  and {} more special points, in the table", special.len() - LISTED)?;
    }
    writeln!(page, "  ends at {parameter} = {:.9}: {}", last.value, branch.ends[1].words())?;
    Ok(page)
}
