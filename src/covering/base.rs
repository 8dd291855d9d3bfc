//! Initial h-sets: at saddles of few impacts, along the directions that the map stretches and shrinks.

use super::HSet;
use super::frame::HSetFrame;
use super::map::ImpactMap;
use crate::orbit::{PeriodicOrbit, Search, search};
use crate::simulate::{Machine, SimulateError};

/// Longest period of the saddles, turns of the cam.
const MOST_REVOLUTIONS: u64 = 3;
/// Largest number of impacts of a saddle.
const MOST_IMPACTS: usize = 4;

/// Returns every impact of every saddle of few impacts, as an h-set of size 0 at a speed, rpm.
pub(super) fn bases(machine: &Machine, rpm: f64) -> Result<Vec<HSet>, SimulateError> {
    let mut bases = Vec::new();
    for revolutions in 1..=MOST_REVOLUTIONS {
        for orbit in search(machine, &Search { revolutions, impacts: None })? {
            let is_saddle = orbit.multipliers().iter().any(|multiplier| multiplier.modulus() > 1.0)
                && orbit.multipliers().iter().all(|multiplier| multiplier.im == 0.0);
            if is_saddle && orbit.impacts().count() <= MOST_IMPACTS {
                bases.extend(of_orbit(machine, &orbit, rpm));
            }
        }
    }
    Ok(bases)
}

/// Returns the h-set at each impact of an orbit.
fn of_orbit(machine: &Machine, orbit: &PeriodicOrbit, rpm: f64) -> Vec<HSet> {
    let map = ImpactMap::new(machine);
    let impacts = orbit.impacts().count() as u64;
    let at = |[angle, velocity]: [f64; 2]| {
        let centre = [rounded(angle.to_degrees()), rounded(velocity)];
        let plain = HSet {
            rpm: [rpm; 2],
            centre,
            unstable: [1.0, 0.0],
            stable: [0.0, 1.0],
            x: [0.0; 2],
            y: [0.0; 2],
            cone_slope: None,
            strips: Vec::new(),
        };
        let derivative = HSetFrame::new(&plain).derivative(&map, impacts, plain.rpm)?;
        let [one, two] = directions(derivative)?;
        Some(HSet { unstable: one, stable: two, ..plain })
    };
    orbit.impacts().filter_map(|event| at([event.cam_angle, event.velocity_after - event.cam_velocity])).collect()
}

/// Eigenvectors of a matrix with real eigenvalues, the most stretched first, scaled so that the larger component is 1.
fn directions([[a, b], [c, d]]: [[f64; 2]; 2]) -> Option<[[f64; 2]; 2]> {
    let (half, determinant) = (0.5 * (a + d), a * d - b * c);
    let root = (half * half - determinant).sqrt();
    if !(root > 0.0) {
        return None;
    }
    let large = half + root.copysign(half);
    Some([large, determinant / large].map(|value| {
        // The row of (A - lambda) v = 0 with larger entries is used.
        let vector =
            if b.abs() + (value - a).abs() > c.abs() + (value - d).abs() { [b, value - a] } else { [value - d, c] };
        let size = if vector[0].abs() > vector[1].abs() { vector[0] } else { vector[1] };
        vector.map(|part| rounded(part / size))
    }))
}

/// Rounds to four digits, which keeps h-sets readable and costs nothing.
pub(super) fn rounded(number: f64) -> f64 {
    format!("{number:.3e}").parse().unwrap_or(number)
}
