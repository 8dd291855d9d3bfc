//! Numbers with their derivatives by two unknowns: a formula that is fed with them gives its own.

use std::ops::{Add, Mul, Neg, Sub};

use crate::interval::Interval;

/// A number, and what it changes by with each unknown.
#[derive(Clone, Copy, Debug)]
pub(super) struct Varied {
    pub value: Interval,
    pub by: [Interval; 2],
}

impl Varied {
    /// A function of something that changes by `by`: its value and its derivative.
    pub fn of(value: Interval, derivative: Interval, by: [Interval; 2]) -> Self {
        Self { value, by: by.map(|by| derivative * by) }
    }

    fn each(self, other: Self, value: Interval, by: impl Fn(Interval, Interval) -> Interval) -> Self {
        Self { value, by: [by(self.by[0], other.by[0]), by(self.by[1], other.by[1])] }
    }
}

impl Neg for Varied {
    type Output = Self;

    fn neg(self) -> Self {
        Self { value: -self.value, by: self.by.map(Neg::neg) }
    }
}

impl Add for Varied {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        self.each(other, self.value + other.value, |one, other| one + other)
    }
}

impl Sub for Varied {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Varied {
    type Output = Self;

    #[expect(clippy::suspicious_arithmetic_impl, reason = "the derivative of a product is a sum")]
    fn mul(self, other: Self) -> Self {
        let (one, two) = (self.value, other.value);
        self.each(other, one * two, |by_one, by_two| by_one * two + one * by_two)
    }
}

impl Mul<Interval> for Varied {
    type Output = Self;

    fn mul(self, number: Interval) -> Self {
        Self { value: self.value * number, by: self.by.map(|by| by * number) }
    }
}
