//! The border between two basins, from runs alone; and how near a saddle's unstable manifold comes to its stable manifold.

use super::{Curve, Saddle};
use crate::bracket::{Width, halve};
use crate::elementary;
use crate::flight::State;
use crate::orbit::long_run::{Budget, LongRun};
use crate::orbit::runs::LongRuns;
use crate::progress::Unwatched;
use crate::section::StroboscopicMap;
use crate::simulate::SimulateError;
use crate::study::survey::attractors_of;
use crate::tolerance;

/// Where, between two starts on the section, runs change what they end on: the middle of a bracket that is halved down to
/// the width of a rounding; `None` where both ends end alike.
///
/// Of several such places one is found.
pub fn border(map: &StroboscopicMap, [from, to]: [State; 2], budget: Budget) -> Result<Option<State>, SimulateError> {
    let at = |share: f64| State {
        position: from.position + share * (to.position - from.position),
        velocity: from.velocity + share * (to.velocity - from.velocity),
    };
    let runs = LongRuns::new(&map.machine, budget)?;
    let end = |share: f64| -> Result<LongRun, SimulateError> {
        let start = |_| map.machine.start(map.cam_angle, at(share)).map(Some);
        let mut found = attractors_of(&runs, 1, start, &Unwatched).map_err(|(_, error)| error)?;
        Ok(found.attractors.swap_remove(0).ending)
    };
    let (first, last) = (end(0.0)?, end(1.0)?);
    if first.is_same(&last) {
        return Ok(None);
    }
    // A chaotic run may come to rest by chance: an orbit, where one end has it, tells the two sides apart.
    let is_orbit = matches!(last, LongRun::Orbit(_));
    let ends_low = |ending: &LongRun| if is_orbit { !ending.is_same(&last) } else { ending.is_same(&first) };
    let width = Width::Absolute(tolerance::BORDER_BRACKET.value);
    let [low, high] = halve([0.0, 1.0], width, |share| Ok(!ends_low(&end(share)?)))?;
    Ok(Some(at(0.5 * (low + high))))
}

/// How near the unstable manifold of a saddle comes back to its stable one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ManifoldApproach {
    /// The least distance, m.
    pub distance: f64,
    /// Where on the unstable manifold that is.
    pub nearest: State,
}

/// Where the half of a saddle's unstable manifold that begins along its direction, times `sign`, comes nearest to `curve`,
/// a piece of the stable one: `samples` starts from a point to its image, run until they are `away`, m, and `revolutions`
/// further.
///
/// A chaotic motion on that side of the curve fills the same set as the manifold; where it touches the curve it is lost.
pub fn approach(
    map: &StroboscopicMap,
    saddle: &Saddle,
    sign: f64,
    curve: &Curve,
    away: f64,
    [samples, revolutions]: [u32; 2],
) -> Result<ManifoldApproach, SimulateError> {
    /// Where a start is, of `away`: the manifold is straight there to the square of it.
    const FIRST: f64 = 1e-5;
    let (multiplier, along) = saddle.unstable;
    let leaving = (-elementary::ln(FIRST) / elementary::ln(multiplier)).ceil() as u32;
    let bounds = curve.bounds();
    let mut found = ManifoldApproach { distance: f64::INFINITY, nearest: saddle.state };
    for sample in 0..samples {
        let from = sign * FIRST * away * elementary::powf(multiplier, f64::from(sample) / f64::from(samples));
        let mut state = State {
            position: saddle.state.position + from * along[0],
            velocity: saddle.state.velocity + from * along[1],
        };
        for revolution in 1..=leaving + revolutions {
            state = map.apply(state)?.state;
            // Most are too far from all of the curve to be looked at closely.
            if revolution > leaving && bounds.distance(state) < found.distance {
                let distance = curve.distance_below(found.distance, state);
                if distance < found.distance {
                    found = ManifoldApproach { distance, nearest: state };
                }
            }
        }
    }
    Ok(found)
}
