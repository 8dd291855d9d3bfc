//! Checks of the chaotic motion that coexists with the motion of one impact a revolution.
//!
//! They are about the border of their basins, the speed at which the chaotic motion is lost, and the change to it when the orbit of one
//! impact has vanished.

use super::transition::{from_x_star, is_period_one, map};
use super::{listed, machine, one_impact};
use crate::border_collision::{LocalMap, passage};
use crate::bracket::secants;
use crate::flight::State;
use crate::orbit::long_run::Budget;
use crate::orbit::{Course, Search, search};
use crate::paper::context::{Context, Decision, decide};
use crate::published::Verdict;
use crate::section::StroboscopicMap;
use crate::simulate::growth;
use crate::simulate::{SimulateError, angular_velocity};
use crate::study::basins::boundary::{approach, border};
use crate::study::basins::{Curve, Extent, Reversed, Saddle};
use crate::tolerance;

/// Distances below the corner impact, rpm, at which the revolutions are counted until the motion has left x*; and the distance from x* that
/// counts as having left, m.
const BELOW: [f64; 4] = [1e-2, 1e-4, 1e-6, 1e-8];
const LEFT: f64 = 1e-3;

/// Lowers the speed of the settled motion through the corner impact in one small step, and checks how it leaves x*.
pub(in crate::paper) fn transition(context: &Context<'_>) -> Decision {
    const BESIDE: f64 = 1e-4;
    let at = &context.findings.at;
    let speed = at.speed_rpm();
    let machine = machine(context, speed + BESIDE);
    let mut motion = from_x_star(context, &machine)?;
    machine.revolve(&mut motion, 3000)?;
    let above = one_impact(&machine, motion, 100)?.is_some();
    let slower = machine.at_speed(angular_velocity(speed - BESIDE));
    let below = one_impact(&slower, slower.resume(&motion)?, 10_000)?.is_some();
    let local = LocalMap::new(&context.findings.map, context.findings.border);
    let (mut counts, mut agree) = (Vec::new(), true);
    for below in BELOW {
        let map = map(context, speed - below);
        let dt = 60.0 / (speed - below) - at.period;
        let linear = passage::linear(&local, dt, LEFT, PATIENCE);
        let run = passage::simulated(&map, at.state, LEFT, PATIENCE)?;
        agree &= passage::agree(linear, run);
        counts.push(format!("{}/{}", shown(linear), shown(run)));
    }
    let decade = passage::revolutions_per_decade(&local).unwrap_or(f64::NAN);
    let evidence = format!(
        "a run from x* at 1e-4 rpm above {speed:.6} rpm has one impact a revolution after 3000 revolutions: {above}. With the speed then \
         lowered to 1e-4 rpm below it, the run still has one after 10000 more: {below}. At {} rpm below it, the motion is {LEFT} m away \
         from x* after {} revolutions (piecewise-linear map/runs), {decade:.1} more for each factor of ten",
        listed(BELOW.map(|below| format!("{below:e}"))),
        listed(counts),
    );
    decide(above && !below && agree, Verdict::Refuted, evidence)
}

/// Number of revolutions within which a motion must have left.
const PATIENCE: u64 = 100_000;

fn shown(count: Option<u64>) -> String {
    count.map_or_else(|| "none".into(), |count| count.to_string())
}

/// Speeds above the corner impact at which a start on the cam is compared with x*.
const COEXISTING: [f64; 2] = [674.0, 682.0];

pub(in crate::paper) fn coexisting(context: &Context<'_>) -> Decision {
    let mut both = true;
    for rpm in COEXISTING {
        let machine = machine(context, rpm);
        let mut motion = machine.start_on_cam(0.0, 0.0)?;
        machine.revolve(&mut motion, 300)?;
        both &= growth(&machine, motion, 1000)? > tolerance::CHAOTIC_GROWTH.value;
        both &= one_impact(&machine, motion, 10_000)?.is_none() && is_period_one(context, rpm, 3000)?;
    }
    // Above that, runs leave the chaotic set within some hundred revolutions.
    let machine = machine(context, 683.0);
    let alone = one_impact(&machine, machine.start_on_cam(0.0, 0.0)?, 20_000)?.is_some();
    let (lines, farthest) = borders(context, 678.0)?;
    let parted = lines > 0 && farthest <= tolerance::BORDER_ON_MANIFOLD.value;
    let lost = lost(context)?;
    let evidence = format!(
        "at {} rpm, a start at rest on the cam does not settle in 10000 revolutions, with a Lyapunov exponent above {} a \
         revolution; a start at x* settles on one impact a revolution: {both}. At 678 rpm, the border of their basins, found by halving on \
         {lines} lines, is within {:e} m of the stable manifold of the unstable orbit of one impact, found by runs backwards in time: \
         {parted}. The unstable manifold of that orbit, which the chaotic motion fills, meets the stable one at {lost:.2} rpm. At 683 rpm \
         the start at rest settles on one impact a revolution, too: {alone}",
        listed(COEXISTING),
        tolerance::CHAOTIC_GROWTH.value,
        tolerance::BORDER_ON_MANIFOLD.value,
    );
    let between = lost > COEXISTING[1] && lost < 683.0;
    decide(both && alone && parted && between, Verdict::Refuted, evidence)
}

/// Returns the saddle of one impact a revolution, with the half of its stable manifold on the cam's side.
fn parting(
    context: &Context<'_>,
    map: &StroboscopicMap,
    stretches: u32,
) -> Result<Option<(Saddle, Curve)>, SimulateError> {
    let extent = Extent { stretches, first: 1e-6, finest: 0.01, farthest: 2.0 };
    let wanted = Search { revolutions: 1, impacts: Some(1) };
    let orbits = search(&map.machine, &wanted)?;
    let saddle = orbits.iter().find_map(|orbit| match &orbit.course {
        Course::Impacts(cycle) => Saddle::new(&map.machine, cycle, map.cam_angle),
        _ => None,
    });
    let curve = |saddle: Saddle| {
        let reversed = Reversed::new(&context.model.follower, map)?;
        let sign = -saddle.stable.1[0].signum();
        Some((saddle, Curve::stable(&reversed, &saddle, sign, &extent)))
    };
    Ok(saddle.and_then(curve))
}

/// Returns the number of lines of constant velocity on which the border was found, and its largest distance from the stable manifold, m.
fn borders(context: &Context<'_>, rpm: f64) -> Result<(usize, f64), SimulateError> {
    /// Velocities of the lines, between that of the saddle and that of the first cusp, m/s.
    const VELOCITIES: [f64; 6] = [-18.0, -14.0, -10.0, -6.0, -2.0, 2.0];
    let map = map(context, rpm);
    let Some((_, curve)) = parting(context, &map, 27)? else { return Ok((0, f64::NAN)) };
    let (mut found, mut farthest) = (0, 0.0_f64);
    for velocity in VELOCITIES {
        let line = [0.6, 6.0].map(|position| State { position, velocity });
        if let Some(state) = border(&map, line, Budget { patience: 0, ..Budget::SURVEY })? {
            (found, farthest) = (found + 1, farthest.max(curve.distance(state)));
        }
    }
    Ok((found, farthest))
}

/// Returns the speed at which the saddle's unstable manifold meets its stable one, rpm, by the secant method for the distance between
/// them; NaN where there is no saddle.
fn lost(context: &Context<'_>) -> Result<f64, SimulateError> {
    const SAMPLES: [u32; 2] = [1000, 40];
    const AWAY: f64 = 0.3;
    const SECANTS: usize = 3;
    let distance = |rpm: f64| -> Result<f64, SimulateError> {
        let map = map(context, rpm);
        let Some((saddle, curve)) = parting(context, &map, 24)? else { return Ok(f64::NAN) };
        let sign = -saddle.unstable.1[0].signum();
        Ok(approach(&map, &saddle, sign, &curve, AWAY, SAMPLES)?.distance)
    };
    let guesses = [(681.0, distance(681.0)?), (682.0, distance(682.0)?)];
    Ok(secants(guesses, SECANTS, 0.0, distance)?.0[1].0)
}
