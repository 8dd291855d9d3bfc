//! A and B as the paper estimates them: a least-squares fit to simulated revolutions from perturbed starts.
//!
//! The paper fits a linear map, and its estimates of B keep three decimals: the curvature of the real map goes into them.
//! Here the perturbations are scaled by the impact's own scales, placed on a grid of Chebyshev nodes, and fitted with all
//! monomials up to the fourth degree, so that what the linear coefficients take on from the map's curvature is of the
//! fifth. Their standard errors come from the residual.

use faer::linalg::solvers::SolveLstsqCore;
use faer::{Conj, Mat};
use nalgebra::{Matrix2, Vector2, Vector3};

use super::locate::CornerImpact;
use super::map::{CornerMap, Route, SideMap, Uncertainty};
use super::one_sided::{OneSidedMap, SampleError};
use crate::cam::{Cam, Side};
use crate::model::Model;

/// Highest total degree of the fitted monomials.
const DEGREE: u32 = 4;
/// Nodes in each direction: one more than the degree, so that the grid determines every monomial, with room for a residual.
const NODES: usize = DEGREE as usize + 1;

/// Half-width of the grid in units of the impact's scales: what the fifth degree puts into the linear coefficients falls
/// with its fourth power, rounding rises with its inverse; they meet near here.
const SPREAD: f64 = 0.25;

/// The map by least squares, with a standard error for each entry and the condition number of the design.
pub fn route(model: &Model, cam: &Cam, at: &CornerImpact) -> Result<Route, SampleError> {
    let minus = side_map(&OneSidedMap::new(model, cam, at, Side::Minus)?)?;
    let plus = side_map(&OneSidedMap::new(model, cam, at, Side::Plus)?)?;
    Ok(Route {
        name: "least_squares",
        map: CornerMap { minus: minus.value, plus: plus.value },
        uncertainty: Some(Uncertainty::StandardError {
            error: CornerMap { minus: minus.error, plus: plus.error },
            condition_number: minus.condition_number.max(plus.condition_number),
        }),
    })
}

struct SideFit {
    value: SideMap,
    error: SideMap,
    condition_number: f64,
}

fn side_map(map: &OneSidedMap<'_>) -> Result<SideFit, SampleError> {
    let scales = map.scales() * SPREAD;
    let grid = grid();
    let ends = grid.iter().map(|z| map.sample(z.component_mul(&scales)).map(|sample| sample.end)).collect::<Result<Vec<_>, _>>()?;
    let monomials = monomials();
    let design = Mat::from_fn(grid.len(), monomials.len(), |row, column| power(grid[row], monomials[column]));
    let response = Mat::from_fn(grid.len(), 2, |row, component| ends[row][component]);
    let fit = fit(&design, &response)?;
    // The linear monomials follow the constant, in the order of the directions.
    let entry = |of: &Mat<f64>, component: usize, direction: usize| of[(1 + direction, component)] / scales[direction];
    let side = |of: &Mat<f64>| SideMap {
        a: Matrix2::from_fn(|row, column| entry(of, row, column)),
        b: Vector2::from_fn(|row, _| entry(of, row, 2)),
    };
    Ok(SideFit { value: side(&fit.coefficients), error: side(&fit.standard_errors), condition_number: fit.condition_number })
}

/// The design points in units of the scales: Chebyshev nodes in each direction, all combinations.
fn grid() -> Vec<Vector3<f64>> {
    let nodes: Vec<f64> = (0..NODES).map(|k| ((2 * k + 1) as f64 * std::f64::consts::PI / (2 * NODES) as f64).cos()).collect();
    let mut grid = Vec::with_capacity(NODES.pow(3));
    for &first in &nodes {
        for &second in &nodes {
            grid.extend(nodes.iter().map(|&third| Vector3::new(first, second, third)));
        }
    }
    grid
}

/// Exponents of all monomials in three variables up to the degree, by degree; within one, first variable first.
fn monomials() -> Vec<[u32; 3]> {
    let of_degree = |degree: u32| (0..=degree).rev().flat_map(move |i| (0..=degree - i).rev().map(move |j| [i, j, degree - i - j]));
    (0..=DEGREE).flat_map(of_degree).collect()
}

fn power(z: Vector3<f64>, exponents: [u32; 3]) -> f64 {
    (0..3).map(|k| z[k].powi(exponents[k] as i32)).product()
}

struct Fit {
    /// One column for each response.
    coefficients: Mat<f64>,
    /// In the same shape.
    standard_errors: Mat<f64>,
    condition_number: f64,
}

/// Ordinary least squares by QR: `min |X beta - Y|`, with `se_j^2 = sigma^2 [(X'X)^{-1}]_jj`, `sigma^2 = |residual|^2/(n - p)`.
fn fit(design: &Mat<f64>, response: &Mat<f64>) -> Result<Fit, SampleError> {
    let (rows, columns) = (design.nrows(), design.ncols());
    let singular = SampleError::Singular { what: "coefficients of the fit" };
    let singular_values = design.singular_values().map_err(|_| singular)?;
    let (largest, smallest) = (singular_values[0], singular_values[columns - 1]);
    if !(smallest > f64::EPSILON * largest) || rows <= columns {
        return Err(singular);
    }
    let qr = design.qr();
    let mut solution = response.clone();
    qr.solve_lstsq_in_place_with_conj(Conj::No, solution.as_mut());
    let coefficients = solution.get(..columns, ..).to_owned();
    let residual = response - design * &coefficients;
    // (X'X)^{-1} = R^{-1} R^{-T}: its diagonal is the squared length of the rows of R^{-1}.
    let triangle = qr.thin_R();
    let mut inverse = Mat::<f64>::identity(columns, columns);
    faer::linalg::triangular_solve::solve_upper_triangular_in_place(triangle, inverse.as_mut(), faer::Par::Seq);
    let standard_errors = Mat::from_fn(columns, response.ncols(), |j, component| {
        let variance = residual.col(component).squared_norm_l2() / (rows - columns) as f64;
        (variance * inverse.row(j).squared_norm_l2()).sqrt()
    });
    Ok(Fit { coefficients, standard_errors, condition_number: largest / smallest })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A line through four points, by the textbook: x = 0, 1, 2, 3 and y = 1, 3, 4, 4 give slope 1, intercept 1.5,
    /// residuals -1/2, 1/2, 1/2, -1/2, sigma^2 = 1/2, se(slope)^2 = sigma^2/5, se(intercept)^2 = sigma^2 (1/4 + 9/20).
    #[test]
    fn standard_errors_are_those_of_the_textbook() {
        let design = Mat::from_fn(4, 2, |row, column| if column == 0 { 1.0 } else { row as f64 });
        let response = Mat::from_fn(4, 1, |row, _| [1.0, 3.0, 4.0, 4.0][row]);
        let Ok(fit) = fit(&design, &response) else { unreachable!("four points determine a line") };
        approx::assert_relative_eq!(fit.coefficients[(0, 0)], 1.5, epsilon = 1e-14);
        approx::assert_relative_eq!(fit.coefficients[(1, 0)], 1.0, epsilon = 1e-14);
        approx::assert_relative_eq!(fit.standard_errors[(0, 0)], (0.5_f64 * 0.7).sqrt(), epsilon = 1e-14);
        approx::assert_relative_eq!(fit.standard_errors[(1, 0)], (0.5_f64 / 5.0).sqrt(), epsilon = 1e-14);
        // X'X = [[4, 6], [6, 14]] has eigenvalues 9 +- sqrt(61).
        let ratio = (9.0 + 61.0_f64.sqrt()) / (9.0 - 61.0_f64.sqrt());
        approx::assert_relative_eq!(fit.condition_number, ratio.sqrt(), epsilon = 1e-13);
    }

    #[test]
    fn a_design_without_rank_is_refused() {
        let design = Mat::from_fn(4, 2, |_, _| 1.0);
        assert!(fit(&design, &Mat::zeros(4, 1)).is_err());
    }

    #[test]
    fn monomials_start_with_the_constant_and_the_three_linear_ones() {
        let monomials = monomials();
        assert_eq!(monomials.len(), 35);
        assert_eq!(monomials[..4], [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]);
    }
}
