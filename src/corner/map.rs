//! The piecewise-linear map at a corner impact, and the results of a route for it.

use nalgebra::{Matrix2, RowVector2, Vector2};
use serde::{Deserialize, Serialize};

use crate::cam::Side;
pub use crate::orbit::Eigenvalue;
use crate::orbit::eigenvalues;

/// One side of the map, eq:linearmap: `dx' = A dx + B dT`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SideMap {
    /// A, 2x2; rows and columns are position (m) and velocity (m/s).
    pub a: Matrix2<f64>,
    /// B, m/s and m/s^2.
    pub b: Vector2<f64>,
}

impl SideMap {
    /// The map that moves nothing and adds nothing; a sum begins with it.
    pub(crate) const IDENTITY: Self = Self { a: Matrix2::new(1.0, 0.0, 0.0, 1.0), ..Self::ZERO };
    /// The map to 0.
    pub(crate) const ZERO: Self = Self { a: Matrix2::new(0.0, 0.0, 0.0, 0.0), b: Vector2::new(0.0, 0.0) };

    /// This map after another one, with the same number: `x -> A (A' x + B' p) + B p`.
    pub(crate) fn after(&self, first: &Self) -> Self {
        Self { a: self.a * first.a, b: self.a * first.b + self.b }
    }

    /// A by rows, then B.
    pub fn entries(&self) -> [f64; 6] {
        [self.a[(0, 0)], self.a[(0, 1)], self.a[(1, 0)], self.a[(1, 1)], self.b[0], self.b[1]]
    }

    /// Both eigenvalues of A, the one with the larger real part first, of a pair the one with positive imaginary part.
    ///
    /// Not a number where A is not finite.
    pub fn eigenvalues(&self) -> [Eigenvalue; 2] {
        eigenvalues(&self.a)
    }
}

document!(SideMap as side { A: rows(&side.a), B: side.b.as_slice() });

/// A matrix as documents have it, by rows.
pub(crate) fn rows(matrix: &Matrix2<f64>) -> [[f64; 2]; 2] {
    matrix.transpose().into()
}

/// A pair of values, one per side: `minus` for impacts before the corner, `plus` for impacts after it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[doc(hidden)]
pub struct Sides<T> {
    /// With c'' before the corner.
    pub minus: T,
    /// With c'' after the corner.
    pub plus: T,
}

impl<T> Sides<T> {
    /// Both sides from one function of the side.
    pub fn of_each(of: impl Fn(Side) -> T) -> Self {
        Self { minus: of(Side::Minus), plus: of(Side::Plus) }
    }

    /// Both sides from a function that may fail.
    pub fn try_of_each<E>(mut of: impl FnMut(Side) -> Result<T, E>) -> Result<Self, E> {
        Ok(Self { minus: of(Side::Minus)?, plus: of(Side::Plus)? })
    }

    /// Value of one side.
    pub fn of(&self, side: Side) -> &T {
        match side {
            Side::Minus => &self.minus,
            Side::Plus => &self.plus,
        }
    }

    /// Applies a function to both sides.
    pub fn map<U>(&self, of: impl Fn(&T) -> U) -> Sides<U> {
        Sides { minus: of(&self.minus), plus: of(&self.plus) }
    }
}

/// Both sides of the map, eq:pwlf.
pub type CornerMap = Sides<SideMap>;

impl CornerMap {
    /// `C = h (A+ - A-)`, h = [1 0].
    pub fn c(&self) -> RowVector2<f64> {
        let jump = self.plus.a - self.minus.a;
        RowVector2::new(jump[(0, 0)], jump[(0, 1)])
    }

    /// `D = h (B+ - B-)`, m/s.
    pub fn d(&self) -> f64 {
        self.plus.b[0] - self.minus.b[0]
    }
}

/// Method for the orbit, its map or its border, in the order of their names in documents.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum RouteName {
    /// Midpoints of balls in which the result is proved to lie.
    Certificate,
    /// The formulas of the paper.
    ClosedForm,
    /// Differences of simulated periods.
    FiniteDifference,
    /// A polynomial fitted to simulated periods.
    LeastSquares,
    /// The equation for the period.
    Located,
    /// The digits in print.
    Published,
    /// An integration in Python.
    Scipy,
    /// One simulated period.
    Simulation,
    /// The derived expressions in Python, to 30 digits.
    Symbolic,
    /// The product of propagators and saltation matrices.
    Variational,
}

named!(RouteName);

/// A method for the map, with its results.
#[derive(Clone, Debug, PartialEq)]
pub struct Route {
    /// Method.
    pub name: RouteName,
    /// The map.
    pub map: CornerMap,
    /// Further results, by the route's own method.
    pub own: Own,
    /// Uncertainty of each entry, in the map's own shape: a standard error or an error estimate.
    pub uncertainty: Option<Uncertainty>,
}

/// A line in the space of deviations of state and period: the coefficients of (dx1, dx2), and that of dT.
#[doc(hidden)]
pub type LinearForm = (RowVector2<f64>, f64);

/// Results besides A and B that a route computes itself, not from A and B by the function that all routes share.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[doc(hidden)]
pub struct Own {
    /// `(C, D)`, by another method than the difference of the two sides.
    pub jump: Option<LinearForm>,
    /// The eigenvalues of both sides, by another method than [`SideMap::eigenvalues`].
    pub eigenvalues: Option<Sides<[Eigenvalue; 2]>>,
    /// `(e, f)`: the impact comes before the corner where `e dx + f dT < 0`.
    pub border: Option<LinearForm>,
    /// Largest estimated error of a border entry, where there is an estimate.
    pub border_error: Option<f64>,
}

impl Own {
    /// A border alone.
    pub(crate) fn border(border: LinearForm) -> Self {
        Self { border: Some(border), ..Self::default() }
    }
}

/// Uncertainty of the entries of a numerical route.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Uncertainty {
    /// Fit: two kinds of error, and the condition number of the scaled design (the larger of both sides').
    Fit {
        /// Standard error of each entry.
        standard: CornerMap,
        /// Estimated bias of each entry, where there is an estimate.
        systematic: Option<CornerMap>,
        /// Largest over smallest singular value.
        condition_number: f64,
    },
    /// Extrapolation: the last correction to each entry and the rounding in it.
    Extrapolation(CornerMap),
}

document!(Route as route {
    minus: route.map.minus,
    plus: route.map.plus,
    C: route.c().as_slice(),
    D: route.d(),
    eigenvalues if_any: route.own.eigenvalues,
    border if_any: route.own.border.map(|(e, f)| [e[0], e[1], f]),
    standard_error if_any: route.fit().map(|(standard, ..)| standard),
    systematic_error if_any: route.fit().and_then(|(_, systematic, _)| systematic),
    condition_number if_any: route.fit().map(|(.., condition_number)| condition_number),
    extrapolation_error if_any: match route.uncertainty {
        Some(Uncertainty::Extrapolation(correction)) => Some(correction),
        _ => None,
    },
});

impl Route {
    /// C, by the route's own method where it has one.
    pub fn c(&self) -> RowVector2<f64> {
        self.own.jump.map_or_else(|| self.map.c(), |(c, _)| c)
    }

    /// D, m/s, likewise.
    pub fn d(&self) -> f64 {
        self.own.jump.map_or_else(|| self.map.d(), |(_, d)| d)
    }

    /// The eigenvalues of both sides, likewise.
    pub fn eigenvalues(&self) -> Sides<[Eigenvalue; 2]> {
        self.own.eigenvalues.unwrap_or_else(|| self.map.map(SideMap::eigenvalues))
    }

    /// Standard errors, bias and condition number, where it is a fit.
    fn fit(&self) -> Option<(CornerMap, Option<CornerMap>, f64)> {
        match self.uncertainty {
            Some(Uncertainty::Fit { standard, systematic, condition_number }) => {
                Some((standard, systematic, condition_number))
            }
            _ => None,
        }
    }
}
