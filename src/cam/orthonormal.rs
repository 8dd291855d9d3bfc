//! Polynomials that are orthonormal over a set of points, and projections of columns onto them.

use nalgebra::DVector;

/// Values at the points of orthonormal polynomials, by rising degree.
pub(super) struct Orthonormal(Vec<DVector<f64>>);

impl Orthonormal {
    /// Polynomials up to a degree; `None` if there are too few points. Points near `[-1, 1]` keep all digits.
    pub fn new(points: &[f64], degree: i32) -> Option<Self> {
        let mut known = Self(Vec::new());
        for power in 0..=degree {
            let mut column = DVector::from_iterator(points.len(), points.iter().map(|point| point.powi(power)));
            // The second projection removes what rounding left of the lower polynomials.
            known.take(&mut column);
            known.take(&mut column);
            known.0.push(column.try_normalize(0.0)?);
        }
        Some(known)
    }

    /// Subtracts from a column its projection onto the polynomials, and returns the squared size of each part.
    pub fn take(&self, column: &mut DVector<f64>) -> Vec<f64> {
        self.0.iter().map(|one| take(column, one).powi(2)).collect()
    }
}

/// Subtracts from a column its projection onto a column of length 1, and returns the size of that part.
pub(super) fn take(column: &mut DVector<f64>, one: &DVector<f64>) -> f64 {
    let along = column.dot(one);
    column.axpy(-along, one, 1.0);
    along
}
