//! Fast cams, 660 to 750 rpm: the motion of one impact a revolution, how it is lost on either side, what is beside it.

use std::ops::ControlFlow;

use super::{corners, last_impact, machine, settles};
use crate::diagram::{exponent, growth};
use crate::paper::context::{Context, Decision, decide};
use crate::published::Verdict;
use crate::section::{Periodic, StroboscopicMap};
use crate::simulate::{Event, EventKind, Machine, Motion, SimulateError};
use crate::tolerance;

/// The speeds between 660 and 750 rpm at which runs are held against the paper's diagrams.
const ABOVE: [f64; 6] = [673.3, 680.0, 700.0, 720.0, 735.0, 739.0];

/// x*, on a machine of another speed.
pub(super) fn from_x_star(context: &Context<'_>, machine: &Machine) -> Result<Motion, SimulateError> {
    machine.start(context.findings.at.section_angle(), context.findings.at.state)
}

/// Whether `revolutions` from x* at `rpm` end on one impact a revolution.
pub(super) fn is_period_one(context: &Context<'_>, rpm: f64, revolutions: u64) -> Result<bool, SimulateError> {
    let machine = machine(context, rpm);
    settles(&machine, &mut from_x_star(context, &machine)?, revolutions)
}

/// The motion of one impact a revolution at `rpm`, stable or not, followed from omega* in steps of 1 rpm or less.
fn followed(context: &Context<'_>, rpm: f64) -> Result<Option<Periodic>, SimulateError> {
    let (from, mut guess) = (context.findings.at.speed_rpm(), context.findings.at.state);
    let steps = (rpm - from).abs().ceil().max(1.0) as u32;
    let mut found = None;
    for step in 1..=steps {
        let map = map(context, from + (rpm - from) * f64::from(step) / f64::from(steps));
        found = map.periodic(guess, 1)?;
        let Some(periodic) = found else { return Ok(None) };
        guess = periodic.state;
    }
    Ok(found)
}

pub(super) fn map(context: &Context<'_>, rpm: f64) -> StroboscopicMap {
    StroboscopicMap { machine: machine(context, rpm), cam_angle: context.findings.at.section_angle() }
}

/// The speed where a multiplier of the motion of one impact a revolution passes -1, rpm; NaN where none does.
fn flip(context: &Context<'_>) -> Result<f64, SimulateError> {
    let (mut low, mut high) = (735.0, 745.0);
    let Some(start) = followed(context, low)? else { return Ok(f64::NAN) };
    // det(I + A) falls through 0: Newton's method from the motion at the bracket's lower end, half a bracket away at most.
    let mut guess = start.state;
    while high - low > tolerance::ROOT_WIDTH.value * high {
        let middle = 0.5 * (low + high);
        let Some(periodic) = map(context, middle).periodic(guess, 1)? else { return Ok(f64::NAN) };
        if periodic.flip() > 0.0 {
            (low, guess) = (middle, periodic.state);
        } else {
            high = middle;
        }
    }
    Ok(high)
}

/// The motion of two revolutions that the flip leaves at `rpm`, by running from x* and Newton's method; and the angles of
/// its two impacts, rad, the larger last.
fn of_two_revolutions(context: &Context<'_>, rpm: f64) -> Result<Option<(Periodic, [f64; 2])>, SimulateError> {
    /// Enough for a start that is left by a multiplier as near to 1 as here.
    const TRANSIENT: u64 = 20_000;
    let map = map(context, rpm);
    let mut motion = from_x_star(context, &map.machine)?;
    map.machine.revolve(&mut motion, TRANSIENT)?;
    let Some(periodic) = map.periodic(motion.state, 2)? else { return Ok(None) };
    let first = last_impact(&map, periodic.state)?;
    let second = last_impact(&map, map.apply(periodic.state)?.state)?;
    Ok(Some((periodic, [first.min(second), first.max(second)])))
}

fn listed(numbers: &[f64]) -> String {
    numbers.iter().map(f64::to_string).collect::<Vec<_>>().join(", ")
}

pub(in crate::paper) fn period_one_above(context: &Context<'_>) -> Decision {
    let mut settled = Vec::new();
    for rpm in ABOVE {
        if is_period_one(context, rpm, 3000)? {
            settled.push(rpm);
        }
    }
    let evidence = format!(
        "of 3000 revolutions from x* each, those at {} rpm end on one impact a revolution, in one state; a multiplier of it \
         passes -1 at {:.6} rpm",
        listed(&settled),
        flip(context)?
    );
    decide(settled.len() == ABOVE.len(), Verdict::Refuted, evidence)
}

/// One impact line from 673.23 up, many impacts below; and what the diagram's upper end does.
pub(in crate::paper) fn impact_diagram(context: &Context<'_>) -> Decision {
    let (mut one_line, mut scattered) = (true, true);
    for rpm in ABOVE {
        one_line &= is_period_one(context, rpm, 3000)?;
    }
    for rpm in [661.0, 665.0, 670.0, 673.0] {
        scattered &= !is_period_one(context, rpm, 3000)?;
    }
    let mut beyond = true;
    for rpm in [740.0, 745.0, 750.0] {
        beyond &= !is_period_one(context, rpm, 3000)?;
    }
    let evidence = format!(
        "one impact, in one place, at all of {} rpm: {one_line}; none such at 661, 665, 670, 673 rpm: {scattered}; nor at \
         740, 745, 750 rpm: {beyond}",
        listed(&ABOVE)
    );
    decide(one_line && scattered && beyond, Verdict::Refuted, evidence)
}

pub(in crate::paper) fn chaos_below(context: &Context<'_>) -> Decision {
    /// Blocks of so many revolutions each.
    const BLOCKS: (u32, u64) = (20, 250);
    /// How many standard errors the exponent must be above 0.
    const SIGNIFICANT: f64 = 10.0;
    // A chaotic mean moves in its second digit with the machine's sine: the evidence says what it is compared with.
    let threshold = tolerance::CHAOTIC_GROWTH.value;
    let chaotic = machine(context, 670.0);
    let below = exponent(&chaotic, from_x_star(context, &chaotic)?, BLOCKS.0, BLOCKS.1)?;
    let is_chaotic = below.growth.value > threshold && below.growth.value > SIGNIFICANT * below.growth.error;
    let periodic = machine(context, 680.0);
    let above = growth(&periodic, from_x_star(context, &periodic)?, 4000)?;
    let evidence = format!(
        "largest Lyapunov exponent from x*: at 670 rpm, by {} blocks of {} revolutions, above {threshold} a revolution and \
         more than {SIGNIFICANT} standard errors above 0: {is_chaotic}; at 680 rpm {above:.3}, the logarithm of r",
        BLOCKS.0, BLOCKS.1
    );
    decide(is_chaotic && above < 0.0, Verdict::Refuted, evidence)
}

/// Both ends of the line of one impact: at P, and, of the motion of two revolutions that it has flipped to, at Q.
pub(in crate::paper) fn transitions_at_corners(context: &Context<'_>) -> Decision {
    let [_, p, q, ..] = corners(context);
    let at = &context.findings.at;
    let flip = flip(context)?;
    let (mut low, mut high) = (flip + 0.01, 739.5);
    // The line of the later impact meets Q where the motion of two revolutions ends.
    let mut reached = f64::NAN;
    while high - low > tolerance::SPEED_BRACKETED.value {
        let middle = 0.5 * (low + high);
        match of_two_revolutions(context, middle)? {
            Some((_, [_, later])) if later < q => (low, reached) = (middle, later),
            _ => high = middle,
        }
    }
    let machine = machine(context, high + 0.1);
    let mut motion = from_x_star(context, &machine)?;
    machine.revolve(&mut motion, 1000)?;
    let chaotic = growth(&machine, motion, 4000)? > tolerance::CHAOTIC_GROWTH.value;
    let evidence = format!(
        "the line of one impact meets P ({:.2} deg) at {:.6} rpm; upwards it flips at {flip:.4} rpm to two revolutions, and the \
         later of their impacts, at {:.1} deg, meets Q ({:.1} deg) at {high:.3} rpm; 0.1 rpm further the Lyapunov exponent is \
         above {} a revolution: {chaotic}",
        p.to_degrees(),
        at.speed_rpm(),
        reached.to_degrees(),
        q.to_degrees(),
        tolerance::CHAOTIC_GROWTH.value
    );
    let at_corners = (at.corner.angle - p).abs() <= tolerance::CORNER_ANGLE.value
        && (reached - q).to_degrees().abs() <= tolerance::DRAWN_DEGREES.value;
    decide(at_corners && chaotic, Verdict::Refuted, evidence)
}

/// Chaos that comes to rest on the cam has no past: from then on it repeats.
pub(in crate::paper) fn chaos_for_good(context: &Context<'_>) -> Decision {
    /// Some dozen times what the follower takes to come to rest.
    const REVOLUTIONS: u64 = 200_000;
    let [.., q_mirrored, _, _] = corners(context);
    let machine = machine(context, 664.0);
    let mut motion = machine.start_on_cam(0.0, 0.0)?;
    machine.revolve(&mut motion, 1)?;
    let (goal, mut releases) = (motion.after(REVOLUTIONS), Vec::new());
    let _ = machine.advance(&mut motion, goal, &mut |event: &Event| {
        if event.kind == EventKind::Release {
            releases.push((event.cam_angle, event.position, event.velocity_after));
        }
        if releases.len() > 2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })?;
    let repeats = releases.len() > 2 && releases.iter().all(|release| *release == releases[0]);
    let at_q = releases.iter().all(|release| release.0 == q_mirrored);
    let evidence = format!(
        "at 664 rpm the follower comes to rest on the cam's top, once in some thousand revolutions, and is released at Q', \
         each time in the same state: {}; what follows can only repeat",
        repeats && at_q
    );
    decide(!(repeats && at_q), Verdict::Refuted, evidence)
}

pub(in crate::paper) fn orbit_at_700(context: &Context<'_>) -> Decision {
    let map = map(context, 700.0);
    let mut motion = from_x_star(context, &map.machine)?;
    map.machine.revolve(&mut motion, 1000)?;
    let (impact, corner) = (last_impact(&map, motion.state)?, context.findings.at.corner.angle);
    let evidence = format!(
        "at 700 rpm the impact is at {:.2} deg, the corner at {:.2} deg; they meet at {:.6} rpm",
        impact.to_degrees(),
        corner.to_degrees(),
        context.findings.at.speed_rpm()
    );
    decide((impact - corner).abs() <= tolerance::CORNER_ANGLE.value, Verdict::Misprint, evidence)
}
