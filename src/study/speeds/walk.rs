//! One walk through the speeds.

use super::change::{self, Change};
use super::run::{LONGER, long_run};
use super::{Care, Regime, RegimeError, Settled, Stretch};
use crate::model::Model;
use crate::simulate::{Machine, angular_velocity};

/// The walk, and the long run at each of its speeds, both by rising speed.
pub(super) fn walk(
    model: &Model,
    machine: &Machine,
    [low, high]: [f64; 2],
    care: Care,
    rising: bool,
    passed: &dyn Fn(),
) -> Result<(Vec<Stretch>, Vec<Settled>), RegimeError> {
    let count = care.speeds.max(2);
    let at = |index: usize| low + (high - low) * index as f64 / (count - 1) as f64;
    let mut order: Vec<usize> = (0..count).collect();
    if !rising {
        order.reverse();
    }
    let first = at(order[0]);
    let start = machine.at_speed(angular_velocity(first)).start_on_cam(0.0, 0.0);
    let mut motion = start.map_err(|error| RegimeError::Simulate { rpm: first, error })?;
    let (mut runs, mut stretches, mut changes) = (Vec::<Settled>::new(), Vec::<Stretch>::new(), Vec::<Change>::new());
    for index in order {
        let before = motion;
        // Where the run before has not settled either, there is no change to be slow after.
        let longer = if runs.last().is_some_and(|last| last.regime != Regime::Unsettled) { LONGER } else { 1 };
        let (now, end) = long_run(machine, at(index), &motion, care, longer)?;
        motion = end;
        match (stretches.last_mut(), runs.last()) {
            (Some(stretch), Some(last)) if now.is_like(last) => stretch.rpm[usize::from(rising)] = now.rpm,
            (Some(stretch), Some(last)) => {
                let mut end = &mut stretch.rpm[usize::from(rising)];
                let chain = change::narrowed(model, machine, (last, &before), &now, care)?;
                for (change, settled) in chain {
                    *end = change.rpm;
                    let rpm = if rising { [change.rpm, now.rpm] } else { [now.rpm, change.rpm] };
                    changes.push(change);
                    stretches.push(Stretch { rpm, settled, begins: None });
                    let Some(last) = stretches.last_mut() else { break };
                    end = &mut last.rpm[usize::from(rising)];
                }
            }
            _ => stretches.push(Stretch { rpm: [now.rpm, now.rpm], settled: now.clone(), begins: None }),
        }
        runs.push(now);
        passed();
    }
    if !rising {
        runs.reverse();
        stretches.reverse();
        changes.reverse();
    }
    stretches.iter_mut().skip(1).zip(changes).for_each(|(stretch, change)| stretch.begins = Some(change));
    Ok((stretches, runs))
}
