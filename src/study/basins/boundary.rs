//! The border between two basins, from runs alone, and the distance between a saddle's unstable and stable manifolds.

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

/// Finds a point between two starts on the section at which the ending of runs changes: the middle of a bracket, halved down to the width
/// of a rounding. `None` if both starts end alike.
///
/// If there are several such points, finds one of them.
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
    // A chaotic run may come to rest by chance. If one end settles on an orbit, that orbit distinguishes the two sides.
    let is_orbit = matches!(last, LongRun::Orbit(_));
    let ends_low = |ending: &LongRun| if is_orbit { !ending.is_same(&last) } else { ending.is_same(&first) };
    let width = Width::Absolute(tolerance::BORDER_BRACKET.value);
    let [low, high] = halve([0.0, 1.0], width, |share| Ok(!ends_low(&end(share)?)))?;
    Ok(Some(at(0.5 * (low + high))))
}

/// Closest approach of a saddle's unstable manifold to its stable manifold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ManifoldApproach {
    /// Smallest distance, m.
    pub distance: f64,
    /// Point of the unstable manifold at that distance.
    pub nearest: State,
}

/// Finds where one half of a saddle's unstable manifold comes nearest to `curve`, a piece of the stable manifold. The half begins along
/// the saddle's direction, times `sign`. `samples` starts between a point and its image are run until they are `away`, m, and
/// `revolutions` further.
///
/// A chaotic motion on that side of the curve fills the same set as the manifold. It is lost when the set touches the curve.
pub fn approach(
    map: &StroboscopicMap,
    saddle: &Saddle,
    sign: f64,
    curve: &Curve,
    away: f64,
    [samples, revolutions]: [u32; 2],
) -> Result<ManifoldApproach, SimulateError> {
    /// Distance of the start from the saddle, as a part of `away`. There the manifold is straight to the square of this number.
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
            // Most states are too far from the whole curve for a closer look.
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
