//! Normal form of a border collision, in which the border is independent of the parameter and both sides are in companion form.
//!
//! The paper's steps with three slips repaired. The shift of coordinates moves the image as well as the point (so `A - I`, not `A`, in B
//! tilde). The new coordinates are `W x~` (not `W^{-1} x~`). B bar follows from both.

use nalgebra::{Matrix2, RowVector2, Vector2};

use super::Degenerate;
use crate::corner::CornerMap;
use crate::corner::map::rows;
use crate::tolerance;

/// Normal form `x -> A_bar x + B_bar dT` with the border at `C_bar x = 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct NormalForm {
    /// Vector B after the shift `x~ = x + e1 D dT/c1`; equal on both sides.
    pub b_tilde: Vector2<f64>,
    /// Change to companion form, `x_bar = W x~`.
    pub w: Matrix2<f64>,
    /// Matrix `W A- W^{-1}`.
    pub a_bar_minus: Matrix2<f64>,
    /// Matrix `W A+ W^{-1}`.
    pub a_bar_plus: Matrix2<f64>,
    /// Vector `W B~`.
    pub b_bar: Vector2<f64>,
    /// Row `C W^{-1}`.
    pub c_bar: RowVector2<f64>,
}

document!(NormalForm as form {
    B_tilde: form.b_tilde.as_slice(),
    W: rows(&form.w),
    A_bar_minus: rows(&form.a_bar_minus),
    A_bar_plus: rows(&form.a_bar_plus),
    B_bar: form.b_bar.as_slice(),
    C_bar: form.c_bar.as_slice(),
});

/// Computes the normal form of a continuous piecewise-linear map.
#[doc(hidden)]
pub fn normal_form(map: &CornerMap) -> Result<NormalForm, Degenerate> {
    let (a, c, d) = (map.minus.a, map.c(), map.d());
    let c1 = c[0];
    let terms = map.plus.a[(0, 0)].abs() + a[(0, 0)].abs();
    if !(c1.abs() > tolerance::DEGENERATE.value * terms) {
        return Err(Degenerate::Vanishes { what: "the first entry of C", value: c1 });
    }
    // B~ = B - (A - I) e1 D/c1
    let b_tilde = map.minus.b - (a - Matrix2::identity()).column(0) * (d / c1);
    // W = T- O-,  O- = [C; C A-],  T- = [[1, 0], [d1, 1]],  d1 = -trace A-
    let observability = Matrix2::from_rows(&[c, c * a]);
    let triangle = Matrix2::new(1.0, 0.0, -a.trace(), 1.0);
    let w = triangle * observability;
    let size = observability.row(0).norm() * observability.row(1).norm();
    let determinant = observability.determinant();
    let inverse = w.try_inverse().filter(|_| determinant.abs() > tolerance::DEGENERATE.value * size);
    let Some(inverse) = inverse else {
        return Err(Degenerate::Vanishes { what: "the determinant of [C; C A-]", value: determinant });
    };
    Ok(NormalForm {
        b_tilde,
        w,
        a_bar_minus: w * a * inverse,
        a_bar_plus: w * map.plus.a * inverse,
        b_bar: w * b_tilde,
        c_bar: c * inverse,
    })
}
