//! Richardson extrapolation: a limit for step to 0 from a few steps, with an estimate of its error.
//!
//! If the error of a quantity is a series of known powers of the step, each halving of the step removes one power. Rounding, which grows as
//! the step shrinks, ends this. The error of a table entry is estimated by the last correction made to it plus its rounding. The entry with
//! the smallest estimate is the limit.

use nalgebra::SVector;

/// Number of halvings of the step: enough to reach rounding on a cam with sharp arcs.
const HALVINGS: usize = 7;

/// Powers of the step in a quantity's error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Powers {
    /// Powers 2, 4, 6: for a quantity that is equal for a step and its opposite.
    Even,
    /// Powers 1, 2, 3.
    Every,
}

/// Returns the limit of `quantity(step)` for step to 0, from `step` down, and the size of its error. `rounding(step)` is the rounding error
/// of the quantity itself.
pub fn extrapolate<E, const N: usize>(
    step: f64,
    powers: Powers,
    rounding: impl Fn(f64) -> SVector<f64, N>,
    quantity: impl Fn(f64) -> Result<SVector<f64, N>, E>,
) -> Result<(SVector<f64, N>, SVector<f64, N>), E> {
    // Factor by which halving the step reduces the error of the lowest power.
    let shrinks = match powers {
        Powers::Even => 4_u32,
        Powers::Every => 2,
    };
    let mut row = vec![quantity(step)?];
    let mut best = (row[0], SVector::repeat(f64::INFINITY));
    for halving in 1..=HALVINGS {
        let step = step / f64::from(1_u32 << halving);
        let mut next = vec![quantity(step)?];
        for (order, coarse) in row.iter().enumerate() {
            let gain = f64::from(shrinks.pow(order as u32 + 1));
            let fine = next[order];
            let better = fine + (fine - coarse) / (gain - 1.0);
            let error = (better - coarse).abs() + rounding(step);
            for component in 0..N {
                if error[component] < best.1[component] {
                    best.0[component] = better[component];
                    best.1[component] = error[component];
                }
            }
            next.push(better);
        }
        row = next;
    }
    Ok(best)
}
