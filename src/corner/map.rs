//! Piecewise-linear map at a corner impact, and the results of a route for it.

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
    /// Identity map, the first factor of a product.
    pub(crate) const IDENTITY: Self = Self { a: Matrix2::new(1.0, 0.0, 0.0, 1.0), ..Self::ZERO };
    /// Map to 0.
    pub(crate) const ZERO: Self = Self { a: Matrix2::new(0.0, 0.0, 0.0, 0.0), b: Vector2::new(0.0, 0.0) };

    /// Composition of this map after another one, for the same varied number: `x -> A (A' x + B' p) + B p`.
    pub(crate) fn after(&self, first: &Self) -> Self {
        Self { a: self.a * first.a, b: self.a * first.b + self.b }
    }

    /// Entries of A by rows, then of B.
    pub fn entries(&self) -> [f64; 6] {
        [self.a[(0, 0)], self.a[(0, 1)], self.a[(1, 0)], self.a[(1, 1)], self.b[0], self.b[1]]
    }

    /// Both eigenvalues of A: the one with the larger real part first; of a complex pair, the one with positive imaginary part.
    ///
    /// NaN if A is not finite.
    pub fn eigenvalues(&self) -> [Eigenvalue; 2] {
        eigenvalues(&self.a)
    }
}

document!(SideMap as side { A: rows(&side.a), B: side.b.as_slice() });

/// Rows of a matrix, as written to documents.
pub(crate) fn rows(matrix: &Matrix2<f64>) -> [[f64; 2]; 2] {
    matrix.transpose().into()
}

/// Pair of values, one per side: `minus` for impacts before the corner, `plus` for impacts after it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[doc(hidden)]
pub struct Sides<T> {
    /// Value with c'' before the corner.
    pub minus: T,
    /// Value with c'' after the corner.
    pub plus: T,
}

impl<T> Sides<T> {
    /// Computes both sides by a function of the side.
    pub fn of_each(of: impl Fn(Side) -> T) -> Self {
        Self { minus: of(Side::Minus), plus: of(Side::Plus) }
    }

    /// Computes both sides by a function that may fail.
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
    /// Formulas of the paper.
    ClosedForm,
    /// Differences of simulated periods.
    FiniteDifference,
    /// Polynomial fitted to simulated periods.
    LeastSquares,
    /// Equation for the period.
    Located,
    /// Digits in print.
    Published,
    /// Integration in Python.
    Scipy,
    /// One simulated period.
    Simulation,
    /// Derived expressions in Python, to 30 digits.
    Symbolic,
    /// Product of propagators and saltation matrices.
    Variational,
}

named!(RouteName);

/// Method for the map, with its results.
#[derive(Clone, Debug, PartialEq)]
pub struct Route {
    /// Method.
    pub name: RouteName,
    /// Map.
    pub map: CornerMap,
    /// Further results, by the route's own method.
    pub own: Own,
    /// Uncertainty of each entry, in the map's own shape: a standard error or an error estimate.
    pub uncertainty: Option<Uncertainty>,
}

/// Linear form of a deviation of state and period: the coefficients of (dx1, dx2), and the coefficient of dT.
#[doc(hidden)]
pub type LinearForm = (RowVector2<f64>, f64);

/// Results besides A and B that a route computes by its own method, not from A and B by the functions that all routes share.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[doc(hidden)]
pub struct Own {
    /// Line `(C, D)`, by another method than the difference of the two sides.
    pub jump: Option<LinearForm>,
    /// Eigenvalues of both sides, by another method than [`SideMap::eigenvalues`].
    pub eigenvalues: Option<Sides<[Eigenvalue; 2]>>,
    /// Border `(e, f)`: the impact comes before the corner if `e dx + f dT < 0`.
    pub border: Option<LinearForm>,
    /// Largest estimated error of a border entry, if there is an estimate.
    pub border_error: Option<f64>,
}

impl Own {
    /// Results with a border alone.
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
        /// Estimated bias of each entry, if there is an estimate.
        systematic: Option<CornerMap>,
        /// Ratio of the largest to the smallest singular value.
        condition_number: f64,
    },
    /// Extrapolation: the last correction of each entry plus its rounding.
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
    /// C, by the route's own method if it has one.
    pub fn c(&self) -> RowVector2<f64> {
        self.own.jump.map_or_else(|| self.map.c(), |(c, _)| c)
    }

    /// D, m/s, by the route's own method if it has one.
    pub fn d(&self) -> f64 {
        self.own.jump.map_or_else(|| self.map.d(), |(_, d)| d)
    }

    /// Eigenvalues of both sides, by the route's own method if it has one.
    pub fn eigenvalues(&self) -> Sides<[Eigenvalue; 2]> {
        self.own.eigenvalues.unwrap_or_else(|| self.map.map(SideMap::eigenvalues))
    }

    /// Standard errors, bias and condition number of a fit.
    fn fit(&self) -> Option<(CornerMap, Option<CornerMap>, f64)> {
        match self.uncertainty {
            Some(Uncertainty::Fit { standard, systematic, condition_number }) => {
                Some((standard, systematic, condition_number))
            }
            _ => None,
        }
    }
}
