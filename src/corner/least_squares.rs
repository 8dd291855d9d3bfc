//! A and B as the paper estimates them: a least-squares fit to simulated revolutions from perturbed starts.
//!
//! The paper fits a linear map, so the curvature of the real map biases its coefficients. Here the perturbations are measured in the
//! impact's scales, spread over a cube, and fitted with all monomials up to the fourth degree. The bias of the linear coefficients is then
//! of the fifth degree. Standard errors come from the residual. The residual does not show the bias in full, so a cube twice as wide gives
//! it.

use faer::Conj;
pub use faer::Mat;
use faer::linalg::solvers::{Qr, SolveLstsqCore};
use nalgebra::{Matrix2, RowVector2, Vector2, Vector3};

use super::corner_impact::CornerImpact;
use super::map::{Own, Route, RouteName, SideMap, Sides, Uncertainty};
use super::one_sided::{OneSidedMap, SampleError};
use super::varied::Varied;
use crate::cam::Cam;
use crate::elementary;
use crate::model::Model;
use crate::tolerance;

/// Highest total degree of the fitted monomials.
const DEGREE: u32 = 4;
/// Number of revolutions in a fit: four for each of the 35 monomials.
const POINTS: usize = 140;

/// Number of halvings of the cube, from the impact's scales down. The bias from missing degrees falls with the fourth power of the width,
/// and rounding rises with its inverse. The fit with the smallest sum of standard error and bias is used.
const WIDTHS: u32 = 8;

/// Computes the map by least squares, with a standard error for each entry and the condition number of the design.
pub fn route(model: &Model, cam: &Cam, at: &CornerImpact) -> Result<Route, SampleError> {
    route_by(model, cam, at, &Varied::Period)
}

/// Computes the map by least squares, with B for any number of the model.
pub fn route_by(model: &Model, cam: &Cam, at: &CornerImpact, varied: &Varied) -> Result<Route, SampleError> {
    let fits = Sides::try_of_each(|side| side_map(&OneSidedMap::by(model, cam, at, side, varied)?))?;
    let uncertainty = Uncertainty::Fit {
        standard: fits.map(|fit| fit.standard_error),
        systematic: Some(fits.map(|fit| fit.systematic_error)),
        condition_number: fits.minus.condition_number.max(fits.plus.condition_number),
    };
    let (map, own) = (fits.map(|fit| fit.value), fits.of(at.side).own);
    Ok(Route { name: RouteName::LeastSquares, map, own, uncertainty: Some(uncertainty) })
}

struct SideFit {
    value: SideMap,
    standard_error: SideMap,
    systematic_error: SideMap,
    /// Border only.
    own: Own,
    condition_number: f64,
}

fn side_map(map: &OneSidedMap<'_>) -> Result<SideFit, SampleError> {
    let scales = map.scales();
    let points = design_points();
    let monomials = monomials();
    let mut failure = None;
    let mut wider: Option<(SideMap, [f64; 3])> = None;
    let mut best: Option<(f64, SideFit)> = None;
    for halving in 0..=WIDTHS {
        let width = scales / f64::from(1_u32 << halving);
        let samples = points.iter().map(|z| map.sample(z.component_mul(&width))).collect::<Result<Vec<_>, _>>();
        let samples = match samples {
            Ok(samples) => samples,
            // Too wide for one impact near the corner: a narrower cube may succeed.
            Err(error) => {
                failure = Some(error);
                continue;
            }
        };
        let design = Mat::from_fn(points.len(), monomials.len(), |row, column| {
            power(samples[row].perturbation.component_div(&width), monomials[column])
        });
        // The end of the revolution, and the gap when the corner passes, whose sign gives the side on which the impact falls.
        let response = Mat::from_fn(points.len(), 3, |row, component| match component {
            2 => map.gap(&samples[row]),
            _ => samples[row].end[component],
        });
        let solver = Solver::new(&design)?;
        let fit = solver.fit(&response);
        // The linear monomials follow the constant, in the order of the directions.
        let entry =
            |of: &Mat<f64>, component: usize, direction: usize| of[(1 + direction, component)] / width[direction];
        let side = |of: &Mat<f64>| SideMap {
            a: Matrix2::from_fn(|row, column| entry(of, row, column)),
            b: Vector2::from_fn(|row, _| entry(of, row, 2)),
        };
        let (value, standard_error) = (side(&fit.coefficients), side(&fit.standard_errors));
        let gap = |of: &Mat<f64>| [0, 1, 2].map(|direction| entry(of, 2, direction));
        let border = gap(&fit.coefficients);
        if let Some((wider, wider_border)) = wider {
            // The bias falls with the fourth power of the width, so this fit has a fifteenth of the change by halving.
            let bias = |wide: f64, here: f64| (wide - here).abs() / 15.0;
            let systematic_error = SideMap { a: wider.a.zip_map(&value.a, bias), b: wider.b.zip_map(&value.b, bias) };
            let size = in_scales(&standard_error, &scales) + in_scales(&systematic_error, &scales);
            if best.as_ref().is_none_or(|(least, _)| size < *least) {
                let standard = gap(&fit.standard_errors);
                let error = (0..3)
                    .map(|entry| 3.0 * standard[entry] + bias(wider_border[entry], border[entry]))
                    .fold(0.0, f64::max);
                let border = (RowVector2::new(border[0], border[1]), border[2]);
                let own = Own { border_error: Some(error), ..Own::border(border) };
                let condition_number = solver.condition_number;
                best = Some((size, SideFit { value, standard_error, systematic_error, own, condition_number }));
            }
        }
        wider = Some((value, border));
    }
    let singular = SampleError::Singular { what: "coefficients of the fit" };
    best.map(|(_, fit)| fit).ok_or(failure.unwrap_or(singular))
}

/// Sum of a map's entries in units of the impact's scales, which makes them comparable.
fn in_scales(map: &SideMap, scales: &Vector3<f64>) -> f64 {
    let row = |row: usize| map.a[(row, 0)] * scales[0] + map.a[(row, 1)] * scales[1] + map.b[row] * scales[2];
    row(0) / scales[0] + row(1) / scales[1]
}

/// Design points in units of the scales: an additive recurrence, denser towards the faces like Chebyshev nodes.
///
/// No two points share a coordinate, unlike points of a grid. So the rounding from a perturbed period differs from point to point, and the
/// standard errors are valid.
fn design_points() -> Vec<Vector3<f64>> {
    // Fractional parts of n/g, n/g^2, n/g^3 with g^4 = g + 1 fill the cube evenly.
    const G: f64 = 1.2207440846057596;
    let coordinate =
        |n: usize, power: i32| elementary::cos(std::f64::consts::PI * (0.5 + n as f64 / G.powi(power)).fract());
    (0..POINTS).map(|n| Vector3::new(coordinate(n, 1), coordinate(n, 2), coordinate(n, 3))).collect()
}

/// Exponents of all monomials in three variables up to the degree, by degree; within a degree, by falling power of the first variable.
fn monomials() -> Vec<[u32; 3]> {
    let of_degree =
        |degree: u32| (0..=degree).rev().flat_map(move |i| (0..=degree - i).rev().map(move |j| [i, j, degree - i - j]));
    (0..=DEGREE).flat_map(of_degree).collect()
}

fn power(z: Vector3<f64>, exponents: [u32; 3]) -> f64 {
    (0..3).map(|k| z[k].powi(exponents[k] as i32)).product()
}

pub struct Fit {
    /// One column for each response.
    pub coefficients: Mat<f64>,
    /// Standard errors, in the shape of `coefficients`.
    pub standard_errors: Mat<f64>,
}

/// Solver for ordinary least squares by QR: `min |X beta - Y|`, with `se_j^2 = sigma^2 [(X'X)^{-1}]_jj`, `sigma^2 = |residual|^2/(n - p)`.
pub struct Solver<'a> {
    design: &'a Mat<f64>,
    factors: Qr<f64>,
    /// Lengths of the rows of R^{-1}: the square roots of the diagonal of (X'X)^{-1} = R^{-1} R^{-T}.
    row_lengths: Vec<f64>,
    /// Largest over smallest singular value of X.
    pub condition_number: f64,
}

impl<'a> Solver<'a> {
    pub fn new(design: &'a Mat<f64>) -> Result<Self, SampleError> {
        let (rows, columns) = (design.nrows(), design.ncols());
        let singular = || SampleError::Singular { what: "coefficients of the fit" };
        let singular_values = design.singular_values().map_err(|_| singular())?;
        let (largest, smallest) = (singular_values[0], singular_values[columns - 1]);
        if !(smallest > tolerance::ULP.value * rows as f64 * largest) || rows <= columns {
            return Err(singular());
        }
        let factors = design.qr();
        let mut inverse = Mat::<f64>::identity(columns, columns);
        faer::linalg::triangular_solve::solve_upper_triangular_in_place(
            factors.thin_R(),
            inverse.as_mut(),
            faer::Par::Seq,
        );
        let row_lengths = (0..columns).map(|j| inverse.row(j).norm_l2()).collect();
        Ok(Self { design, factors, row_lengths, condition_number: largest / smallest })
    }

    pub fn fit(&self, response: &Mat<f64>) -> Fit {
        let (rows, columns) = (self.design.nrows(), self.design.ncols());
        let mut solution = response.clone();
        self.factors.solve_lstsq_in_place_with_conj(Conj::No, solution.as_mut());
        let coefficients = solution.get(..columns, ..).to_owned();
        let residual = response - self.design * &coefficients;
        let standard_errors = Mat::from_fn(columns, response.ncols(), |j, component| {
            let sigma = residual.col(component).norm_l2() / ((rows - columns) as f64).sqrt();
            sigma * self.row_lengths[j]
        });
        Fit { coefficients, standard_errors }
    }
}
