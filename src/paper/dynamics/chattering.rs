//! Slow cams: detachment, infinitely many impacts and sticking, and how they change up to 330 rpm.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use super::{Round, corners, listed, machine};
use crate::agreement::worse;
use crate::bracket::{Width, halve};
use crate::flight::Flight;
use crate::paper::context::{Context, Decision, decide};
use crate::published::Verdict;
use crate::simulate::growth;
use crate::simulate::{Event, Machine, SimulateError, angular_velocity};
use crate::study::attractors;
use crate::tolerance;

/// Returns the lowest speed, rpm, at which `is` is true, by halving `[low, high]` down to rounding; `is` must change once there.
fn first_speed(low: f64, high: f64, is: impl FnMut(f64) -> Result<bool, SimulateError>) -> Result<f64, SimulateError> {
    let [_, high] = halve([low, high], Width::Relative(tolerance::ROOT_WIDTH.value), is)?;
    Ok(high)
}

/// Compares the lowest speed with a release, by simulation, with the speed at which the nose would first have to pull, right after P:
/// `c'' w^2 = a(c)`.
pub(in crate::paper) fn detachment(context: &Context<'_>) -> Decision {
    let machine = machine(context, 100.0);
    let first_event = |rpm: f64| {
        let machine = machine.at_speed(angular_velocity(rpm));
        let mut motion = machine.start_on_cam(0.0, 0.0)?;
        let (goal, mut found) = (motion.after(1), None);
        let _ = machine.advance(&mut motion, goal, &mut |event: &Event| {
            found = Some(event.cam_angle);
            ControlFlow::Break(())
        })?;
        Ok::<_, SimulateError>(found)
    };
    let mut silent = 0;
    for rpm in 1..=114 {
        silent += usize::from(first_event(f64::from(rpm))?.is_none());
    }
    let found = attractors::detachment(context.model, [114.0, 116.0])?;
    let speed = found.ok_or("the lowest speed of detachment is not between 114 and 116 rpm")?;
    let at = first_event(speed)?.unwrap_or(f64::NAN);
    let corners = context.cam.corners();
    let nose = corners.get(1).map_or(f64::NAN, |corner| {
        let force = Flight::new(&context.model.follower).force(corner.plus.value);
        (force / corner.plus.curvature).sqrt() / angular_velocity(1.0)
    });
    let evidence = format!(
        "from rest on the cam, a revolution has no event at {silent} of the speeds 1, 2, ..., 114 rpm. The lowest speed with a \
         release is {speed:.6} rpm, at {:.4} deg; it rounds to {:.0} rpm. From {nose:.6} rpm on, the nose would have to pull the \
         follower at P to keep it in contact",
        at.to_degrees(),
        speed.round()
    );
    let at_p = corners.get(1).is_some_and(|corner| corner.angle == at);
    let same = (speed - nose).abs() <= tolerance::SPEED_FOUND.value;
    let otherwise = if silent == 114 && at_p && same { Verdict::InPart } else { Verdict::Refuted };
    decide(otherwise == Verdict::InPart && speed.round() == 114.0, otherwise, evidence)
}

/// Checks that after a release at P the impacts accumulate, that the follower then sticks up to P, and that it forgets its start.
pub(in crate::paper) fn chattering(context: &Context<'_>, rpm: f64) -> Decision {
    let [_, p, ..] = corners(context);
    let machine = machine(context, rpm);
    let round = Round::new(&machine, p)?;
    let ratios: Vec<f64> = round.impacts.windows(2).map(|two| two[1][1] / two[0][1]).collect();
    let ratio = ratios.last().copied().unwrap_or(f64::NAN);
    // The same from rest on the base circle; and nothing remains of a deviation.
    let mut motion = machine.start_on_cam(0.0, 0.0)?;
    machine.revolve(&mut motion, 3)?;
    let forgets = growth(&machine, motion, 2)? == f64::NEG_INFINITY;
    let evidence = format!(
        "after the release at P ({:.2} deg), the follower has {} impacts above 1e-6 m/s; in the end each has {ratio:.4} of the speed of \
         the one before. They accumulate {:.3} deg after P, at {:.3} deg, where the follower sticks. The next release at P is {} \
         revolution later. The motion keeps nothing of a deviation: {forgets}",
        p.to_degrees(),
        round.felt(),
        round.accumulation.to_degrees(),
        (p + round.accumulation).to_degrees().rem_euclid(360.0),
        round.period,
    );
    let geometric = (ratio - machine.restitution()).abs() <= tolerance::GEOMETRIC.value;
    decide(geometric && round.period == 1 && round.releases == 0 && forgets, Verdict::Refuted, evidence)
}

/// Checks that at every speed of the figure there are several impacts that accumulate, until the accumulation reaches P.
pub(in crate::paper) fn impact_diagram_of_slow_cams(context: &Context<'_>) -> Decision {
    const SEVERAL: usize = 10;
    let [_, p, ..] = corners(context);
    let at = |rpm: f64| Round::new(&machine(context, rpm), p);
    // Just above detachment the follower hops at only a thousandth of a millimetre per second.
    let mut all = true;
    for rpm in 115..=198 {
        let round = at(f64::from(rpm))?;
        all &= round.period == 1 && round.accumulation.is_finite() && round.impacts.len() > SEVERAL;
    }
    let felt = [at(115.0)?.felt(), at(120.0)?.felt(), at(198.0)?.felt()];
    let one_release = first_speed(130.0, 140.0, |rpm| Ok(at(rpm)?.releases == 0))?;
    let end = first_speed(198.0, 198.6, |rpm| Ok(at(rpm)?.period != 1))?;
    let reach = (p + at(end - tolerance::SPEED_FOUND.value)?.accumulation).to_degrees() - 360.0;
    // Rounding decides after how many revolutions it returns instead: each revolution multiplies a deviation by a large number.
    let above = at(200.0)?.period != 1;
    let evidence = format!(
        "at each of 115, 116, ..., 198 rpm there is one revolution from release to release at P, with more than {SEVERAL} impacts that \
         accumulate: {all}. At 115, 120 and 198 rpm, {}, {} and {} of them are above 1e-6 m/s. Up to \
         {one_release:.3} rpm the follower is released a second time, on the nose. At {end:.6} rpm the accumulation reaches P ({reach:.2} deg, a revolution later), \
         and this motion ends. At 200 rpm the follower returns later: {above}",
        felt[0], felt[1], felt[2]
    );
    let ends_at_p = (reach - p.to_degrees()).abs() <= tolerance::DRAWN_DEGREES.value;
    decide(all && ends_at_p && above, Verdict::Refuted, evidence)
}

/// Number of impacts that are followed after the release; and the step of the speeds between which crossings are searched for, rpm.
const FOLLOWED: usize = 8;
const STEP: f64 = 0.25;

/// Extremum of the angle of accumulation at a speed where the line of an impact crosses a corner.
#[derive(Clone, Copy, PartialEq)]
enum Turn {
    Peak,
    Dip,
    Neither,
}

/// Finds every crossing of a corner by the line of one of the first impacts, and checks whether the accumulation has a peak there.
pub(in crate::paper) fn resonant_peaks(context: &Context<'_>) -> Decision {
    /// Distance from the crossing at which the accumulation is compared, rpm.
    const BESIDE: f64 = 1e-3;
    /// Range of speeds, rpm. Just above detachment the hops are too low to be distinguished; above the range the accumulation is past P.
    const RANGE: [f64; 2] = [115.5, 198.5];
    const NAMES: [&str; 6] = ["R", "P", "Q", "Q'", "P'", "R'"];
    let p = corners(context)[1];
    let angles = corners(context).map(|corner| if corner > p { corner } else { corner + TAU });
    let paper = machine(context, RANGE[0]);
    let round = |rpm: f64| Round::new(&paper.at_speed(angular_velocity(rpm)), p);
    let past = |round: &Round, index: usize, corner: usize| Some(p + round.impacts.get(index)?[0] >= angles[corner]);
    let turn = |rpm: f64| {
        let [below, at, above] = [round(rpm - BESIDE)?, round(rpm)?, round(rpm + BESIDE)?].map(|r| r.accumulation);
        Ok::<_, SimulateError>(match (at > below, at > above) {
            (true, true) => Turn::Peak,
            (false, false) => Turn::Dip,
            _ => Turn::Neither,
        })
    };
    let (mut found, mut jumps) = (Vec::<(usize, Turn)>::new(), Vec::new());
    let mut slowest = 0.0_f64;
    let mut below = (RANGE[0], round(RANGE[0])?);
    while below.0 < RANGE[1] {
        let above = (below.0 + STEP, round(below.0 + STEP)?);
        for (index, corner) in (0..FOLLOWED).flat_map(|index| (0..NAMES.len()).map(move |corner| (index, corner))) {
            let sides = past(&below.1, index, corner).zip(past(&above.1, index, corner));
            let Some((_, side)) = sides.filter(|(one, other)| one != other) else { continue };
            let is_beyond = |rpm: f64| Ok::<_, SimulateError>(past(&round(rpm)?, index, corner) == Some(side));
            let [before, rpm] = halve([below.0, above.0], Width::Absolute(tolerance::SPEED_FOUND.value), is_beyond)?;
            let (before, here) = (round(before)?, round(rpm)?);
            let reached = here.impacts.get(index).map_or(f64::NAN, |[turned, _]| (p + turned - angles[corner]).abs());
            if reached.to_degrees() <= tolerance::DRAWN_DEGREES.value {
                found.push((corner, turn(rpm)?));
            } else {
                // A line does not cross the corner if it jumps over it, where its impact or an earlier one becomes a graze.
                let up_to_it = before.impacts.iter().take(index + 1).chain(here.impacts.iter().take(index + 1));
                slowest = worse(slowest, up_to_it.fold(f64::INFINITY, |least, [_, velocity]| least.min(*velocity)));
                jumps.push((corner, turn(rpm)?));
            }
        }
        below = above;
    }
    let count = |of: &[(usize, Turn)]| {
        [Turn::Peak, Turn::Dip, Turn::Neither].map(|turn| of.iter().filter(|(_, what)| *what == turn).count())
    };
    let by_corner = |of: &[(usize, Turn)]| {
        let lines = NAMES.iter().enumerate().filter_map(|(corner, name)| {
            let here: Vec<_> = of.iter().copied().filter(|(at, _)| *at == corner).collect();
            let [peaks, dips, neither] = count(&here);
            (!here.is_empty()).then(|| format!("{name} {peaks}/{dips}/{neither}"))
        });
        listed(lines)
    };
    let [peaks, dips, neither] = count(&found);
    let evidence = format!(
        "the lines of the first {FOLLOWED} impacts after the release cross a corner {0} times at {1} to {2} rpm. The angle where \
         impacts accumulate has a peak at {peaks} crossings, a dip at {dips}, and no extremum at {neither}; by corner (peaks/dips/neither): {3}. \
         Lines that jump over a corner do not cross it: {4}. At each jump, an impact of the line, or one before it, becomes a graze, at \
         {slowest:.0e} m/s or less",
        found.len(),
        RANGE[0],
        RANGE[1],
        by_corner(&found),
        by_corner(&jumps)
    );
    decide(peaks > 0 && dips + neither == 0, if peaks > 0 { Verdict::InPart } else { Verdict::Refuted }, evidence)
}

/// Speeds in windows of stable motions that return to the release at P after 2, 3, ..., 8 revolutions: each has one more
/// revolution of three impacts. Found by a scan of 240 to 330 rpm in steps of 1e-4 rpm and finer.
const ADDING_ONE: [f64; 7] = [299.5, 304.68, 305.52, 305.6775, 305.7079, 305.71384, 305.715005];

/// Speeds in such windows for 4, 6, 8, ..., 14 revolutions: each has two more revolutions, of two and four impacts.
const ADDING_TWO: [f64; 6] = [313.2617, 315.2107, 316.2112, 316.85478, 317.35962, 317.79971];

pub(in crate::paper) fn period_adding(context: &Context<'_>) -> Decision {
    let [_, p, ..] = corners(context);
    let machine: Machine = machine(context, 300.0);
    let period = |rpm: f64| Ok::<_, SimulateError>(Round::new(&machine.at_speed(angular_velocity(rpm)), p)?.period);
    let ones = ADDING_ONE.iter().map(|rpm| period(*rpm)).collect::<Result<Vec<_>, _>>()?;
    let twos = ADDING_TWO.iter().map(|rpm| period(*rpm)).collect::<Result<Vec<_>, _>>()?;
    let gaps: Vec<f64> = ADDING_ONE.windows(2).map(|two| two[1] - two[0]).collect();
    let shrinks = gaps.windows(2).all(|two| two[1] < two[0]);
    let steps = |periods: &[u64], step: u64| periods.windows(2).all(|two| two[1] == two[0] + step);
    let holds = steps(&ones, 1) && steps(&twos, 2) && shrinks;
    let evidence = format!(
        "there are stable motions of {} revolutions at {} rpm. Each has one more revolution of three impacts, and the windows \
         accumulate, five times closer each time. There are also motions of {} revolutions at {} rpm. Windows of other periods lie in \
         between. Up to 198.56 rpm there is no such window: every motion has period one",
        listed(&ones),
        listed(ADDING_ONE.iter().map(|rpm| format!("{rpm:.3}"))),
        listed(&twos),
        listed(ADDING_TWO.iter().map(|rpm| format!("{rpm:.3}")))
    );
    decide(holds, Verdict::Refuted, evidence)
}
