//! Eigenvalues of the matrix that carries a small deviation once around an orbit.

use crate::elementary;
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
    /// Distance from 0.
    pub fn modulus(self) -> f64 {
        elementary::hypot(self.re, self.im)
    }
}

/// Both eigenvalues of a 2x2 matrix, the one with the larger real part first. Of a complex pair the one with positive imaginary part comes
/// first.
///
/// NaN where the matrix is not finite. The entries off the diagonal have units, and only their product is used, so that the eigenvalues do
/// not depend on the units:
///
/// ```text
/// m = (a + d)/2,  h = (a - d)/2        m +- sqrt(h^2 + b c) = d + z, d - b c/z,  z = h +- sqrt(h^2 + b c), which does not cancel
/// ```
///
/// with d the smaller of a and d. With the larger one, d - b c/z would keep no digits of an eigenvalue that is far smaller still.
pub fn eigenvalues(matrix: &Matrix2<f64>) -> [Eigenvalue; 2] {
    let real = |re: f64| Eigenvalue { re, im: 0.0 };
    if !matrix.iter().all(|entry| entry.is_finite()) {
        return [real(f64::NAN); 2].map(|unknown| Eigenvalue { im: f64::NAN, ..unknown });
    }
    let across = matrix[(0, 1)] * matrix[(1, 0)];
    let [a, d] = [matrix[(0, 0)], matrix[(1, 1)]];
    let (a, d) = if d.abs() <= a.abs() { (a, d) } else { (d, a) };
    let half = 0.5 * (a - d);
    let square = half * half + across;
    if square < 0.0 {
        let (re, im) = (0.5 * (a + d), (-square).sqrt());
        return [Eigenvalue { re, im }, Eigenvalue { re, im: -im }];
    }
    let z = half + square.sqrt().copysign(half);
    let pair = if z == 0.0 { [a, d] } else { [d + z, d - across / z] };
    [pair[0].max(pair[1]), pair[0].min(pair[1])].map(real)
}
