//! Elementary functions with the same bits on every processor.
//!
//! The standard library calls the C library, and glibc's sine rounds differently with and without fused multiply-add. In a chaotic motion
//! one different bit soon makes another motion. The crate `libm` is plain Rust: it uses sums, products and quotients of doubles, which IEEE
//! 754 rounds in one way. A lint (`clippy.toml`) keeps the standard library's functions out of `src`. Exceptions are square roots and
//! remainders, which IEEE 754 also rounds in one way, and whole powers, which are products.
//!
//! Each result is within an ulp of the true one, or within two where the function says so.

/// Sine and cosine of an angle, rad.
#[inline]
pub fn sin_cos(angle: f64) -> (f64, f64) {
    libm::sincos(angle)
}

/// The sine of an angle, rad.
#[inline]
pub fn sin(angle: f64) -> f64 {
    libm::sin(angle)
}

/// The cosine of an angle, rad.
#[inline]
pub fn cos(angle: f64) -> f64 {
    libm::cos(angle)
}

/// The angle of a point, rad, from -pi to pi, within two ulps.
#[inline]
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// Angle with this sine, rad, from -pi/2 to pi/2.
#[inline]
pub fn asin(sine: f64) -> f64 {
    libm::asin(sine)
}

/// Exponential `e^x`.
#[inline]
pub fn exp(x: f64) -> f64 {
    libm::exp(x)
}

/// Power `2^x`, exact if x is whole.
#[inline]
pub fn exp2(x: f64) -> f64 {
    libm::exp2(x)
}

/// Difference `e^x - 1`, accurate near 0.
#[inline]
pub fn exp_m1(x: f64) -> f64 {
    libm::expm1(x)
}

/// Hyperbolic sine `(e^x - e^-x)/2`, within two ulps.
#[inline]
pub fn sinh(x: f64) -> f64 {
    libm::sinh(x)
}

/// Hyperbolic cosine `(e^x + e^-x)/2`, within two ulps.
#[inline]
pub fn cosh(x: f64) -> f64 {
    libm::cosh(x)
}

/// The natural logarithm.
#[inline]
pub fn ln(x: f64) -> f64 {
    libm::log(x)
}

/// The natural logarithm of `1 + x`, accurate near 0.
#[inline]
pub fn ln_1p(x: f64) -> f64 {
    libm::log1p(x)
}

/// The logarithm to the base 2.
#[inline]
pub fn log2(x: f64) -> f64 {
    libm::log2(x)
}

/// The logarithm to the base 10.
#[inline]
pub fn log10(x: f64) -> f64 {
    libm::log10(x)
}

/// Power `base^exponent`.
#[inline]
pub fn powf(base: f64, exponent: f64) -> f64 {
    libm::pow(base, exponent)
}

/// The cube root.
#[inline]
pub fn cbrt(x: f64) -> f64 {
    libm::cbrt(x)
}

/// Length `sqrt(x^2 + y^2)`, without overflow or underflow in between.
#[inline]
pub fn hypot(x: f64, y: f64) -> f64 {
    libm::hypot(x, y)
}
