//! Numbers with their derivatives with respect to some unknowns (forward differentiation): a formula evaluated with them returns its
//! derivatives.

use std::ops::{Add, Mul, Neg, Sub};

use super::Interval;

/// Number and its derivative with respect to each unknown.
#[derive(Clone, Copy, Debug)]
pub struct Dual<const N: usize> {
    /// Enclosure of the number.
    pub value: Interval,
    /// Enclosure of the derivative with respect to each unknown.
    pub by: [Interval; N],
}

impl<const N: usize> Dual<N> {
    /// Chain rule: the value of a function, and its derivative times the derivatives `by` of its argument.
    pub fn of(value: Interval, derivative: Interval, by: [Interval; N]) -> Self {
        Self { value, by: by.map(|by| derivative * by) }
    }

    fn each(self, other: Self, value: Interval, by: impl Fn(Interval, Interval) -> Interval) -> Self {
        Self { value, by: std::array::from_fn(|unknown| by(self.by[unknown], other.by[unknown])) }
    }
}

impl<const N: usize> Neg for Dual<N> {
    type Output = Self;

    fn neg(self) -> Self {
        Self { value: -self.value, by: self.by.map(Neg::neg) }
    }
}

impl<const N: usize> Add for Dual<N> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        self.each(other, self.value + other.value, |one, other| one + other)
    }
}

impl<const N: usize> Sub for Dual<N> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<const N: usize> Mul for Dual<N> {
    type Output = Self;

    #[expect(clippy::suspicious_arithmetic_impl, reason = "the derivative of a product is a sum")]
    fn mul(self, other: Self) -> Self {
        let (one, two) = (self.value, other.value);
        self.each(other, one * two, |by_one, by_two| by_one * two + one * by_two)
    }
}

impl<const N: usize> Mul<Interval> for Dual<N> {
    type Output = Self;

    fn mul(self, number: Interval) -> Self {
        Self { value: self.value * number, by: self.by.map(|by| by * number) }
    }
}
