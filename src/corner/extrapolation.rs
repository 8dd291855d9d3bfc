//! A limit for step to 0 from a few steps (Richardson), with an estimate of its error.
//!
//! Where the error of a quantity is a series of known powers of the step, each halving of the step removes one power,
//! until rounding, which grows as the step shrinks, takes over. The error of a table entry is estimated by the last
//! correction that was made to it plus its rounding. The entry with the smallest estimate is the limit.

use nalgebra::SVector;

/// Halvings of the step: enough to bring a cam with sharp arcs to rounding.
const HALVINGS: usize = 7;

/// Powers of the step in a quantity's error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Powers {
    /// 2, 4, 6: for a quantity that is the same for a step and its opposite.
    Even,
    /// 1, 2, 3.
    Every,
}

/// The limit of `quantity(step)` for step to 0 from `step` down, and the size of its error. `rounding(step)` is the rounding error
/// of the quantity itself.
pub(super) fn extrapolate<E, const N: usize>(
    step: f64,
    powers: Powers,
    rounding: impl Fn(f64) -> SVector<f64, N>,
    quantity: impl Fn(f64) -> Result<SVector<f64, N>, E>,
) -> Result<(SVector<f64, N>, SVector<f64, N>), E> {
    // What the error of the lowest power shrinks by when the step is halved.
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

#[cfg(test)]
mod tests {
    use nalgebra::Vector2;

    use super::*;
    use crate::elementary;

    #[test]
    fn extrapolation_recovers_a_derivative_to_rounding() {
        let difference = |h: f64| {
            Ok::<_, ()>(Vector2::new(
                (elementary::exp(1.0 + h) - elementary::exp(1.0 - h)) / (2.0 * h),
                (elementary::sin(h)) / h,
            ))
        };
        let rounding = |h: f64| Vector2::repeat(f64::EPSILON / h);
        let nothing = (Vector2::zeros(), Vector2::zeros());
        let (limit, error) = extrapolate(0.5, Powers::Even, rounding, difference).unwrap_or(nothing);
        approx::assert_relative_eq!(limit[0], std::f64::consts::E, epsilon = 1e-12);
        approx::assert_relative_eq!(limit[1], 1.0, epsilon = 1e-12);
        assert!(error.max() < 1e-11 && error.min() > 0.0, "{error}");
    }

    #[test]
    fn a_limit_from_one_side_has_every_power() {
        let one_sided = |h: f64| Ok::<_, ()>(Vector2::new((elementary::exp(h) - 1.0) / h, 1.0 / (1.0 + h)));
        let rounding = |h: f64| Vector2::repeat(f64::EPSILON / h);
        let nothing = (Vector2::zeros(), Vector2::zeros());
        let (limit, error) = extrapolate(0.25, Powers::Every, rounding, one_sided).unwrap_or(nothing);
        assert!((limit - Vector2::new(1.0, 1.0)).abs() < error * 4.0 && error.max() < 1e-8, "{limit} {error}");
    }
}
