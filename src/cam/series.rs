//! Truncated power series, given by their coefficients: products, quotients, roots and derivatives.

use std::array::from_fn;

/// Series of `a b`.
pub(super) fn product<const N: usize>(a: &[f64; N], b: &[f64; N]) -> [f64; N] {
    from_fn(|n| (0..=n).map(|k| a[k] * b[n - k]).sum())
}

/// Series of `q = a/b`: `q_n b_0 = a_n - sum_{k<n} q_k b_{n-k}`.
pub(super) fn quotient<const N: usize>(a: &[f64; N], b: &[f64; N]) -> [f64; N] {
    let mut q = [0.0; N];
    for n in 0..N {
        let products: f64 = (0..n).map(|k| q[k] * b[n - k]).sum();
        q[n] = (a[n] - products) / b[0];
    }
    q
}

/// Series of `w = sqrt(u)`: `w_0 = sqrt(u_0)`, `2 w_0 w_n = u_n - sum_{0<k<n} w_k w_{n-k}`.
pub(super) fn square_root<const N: usize>(u: [f64; N]) -> [f64; N] {
    let mut w = [0.0; N];
    w[0] = u[0].sqrt();
    for n in 1..N {
        let products: f64 = (1..n).map(|k| w[k] * w[n - k]).sum();
        w[n] = (u[n] - products) / (2.0 * w[0]);
    }
    w
}

/// Series of `a'`; its last coefficient is 0, as if the series ended.
pub(super) fn derivative<const N: usize>(a: &[f64; N]) -> [f64; N] {
    from_fn(|n| if n + 1 < N { (n + 1) as f64 * a[n + 1] } else { 0.0 })
}
