//! Polynomials over a set of points that are orthonormal there, and the part of a column that they leave.

use nalgebra::DVector;

/// Values at the points of polynomials that are orthonormal over them, by rising degree.
pub(super) struct Orthonormal(Vec<DVector<f64>>);

impl Orthonormal {
    /// The polynomials up to a degree; none where there are too few points. Points near `[-1, 1]` keep all digits.
    pub fn new(points: &[f64], degree: i32) -> Option<Self> {
        let mut known = Self(Vec::new());
        for power in 0..=degree {
            let mut column = DVector::from_iterator(points.len(), points.iter().map(|point| point.powi(power)));
            // Once more for what rounding leaves of the lower ones.
            known.take(&mut column);
            known.take(&mut column);
            known.0.push(column.try_normalize(0.0)?);
        }
        Some(known)
    }

    /// Subtracts from a column its part along the polynomials, and returns the squares of what belongs to each.
    pub fn take(&self, column: &mut DVector<f64>) -> Vec<f64> {
        self.0.iter().map(|one| take(column, one).powi(2)).collect()
    }
}

/// Subtracts from a column its part along a column of length 1, and returns the size of that part.
pub(super) fn take(column: &mut DVector<f64>, one: &DVector<f64>) -> f64 {
    let along = column.dot(one);
    column.axpy(-along, one, 1.0);
    along
}
