//! Eigenvalues of the matrix that carries a small deviation once around an orbit.

use nalgebra::Matrix2;
use serde::Serialize;

/// An eigenvalue, real and imaginary part.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Eigenvalue {
    /// Real part.
    pub re: f64,
    /// Imaginary part; exactly 0 for a real one.
    pub im: f64,
}

impl Eigenvalue {
    /// Its distance from 0.
    pub fn modulus(self) -> f64 {
        self.re.hypot(self.im)
    }
}

/// Both eigenvalues of a 2x2 matrix, the one with the larger real part first, of a pair the one with positive imaginary
/// part.
///
/// Not a number where the matrix is not finite.
pub fn eigenvalues(matrix: &Matrix2<f64>) -> [Eigenvalue; 2] {
    let unknown = Eigenvalue { re: f64::NAN, im: f64::NAN };
    let finite = matrix.iter().all(|entry| entry.is_finite());
    let matrix = faer::Mat::from_fn(2, 2, |row, column| matrix[(row, column)]);
    let Some(values) = finite.then(|| matrix.eigenvalues().ok()).flatten() else {
        return [unknown; 2];
    };
    let mut pair = [values[0], values[1]].map(|value| Eigenvalue { re: value.re, im: value.im });
    pair.sort_by(|x, y| y.re.total_cmp(&x.re).then(y.im.total_cmp(&x.im)));
    pair
}
