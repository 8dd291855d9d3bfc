//! Numbers over a box of unknowns, in mean value form: the value at the centre, and the derivatives over the box.
//!
//! With the centre m of a box X and the derivative of a function f over the box,
//!
//! ```text
//! f(X) is in f(m) + f'(X) (X - m)
//! ```
//!
//! which overestimates by the square of the box's size, while plain intervals overestimate by its size. A formula evaluated with such
//! numbers returns its enclosure, its value at the centre and its derivatives. Across a corner a derivative is the hull of both sides. The
//! form is still valid there, since the path from the centre is straight.

use std::ops::{Add, Mul, Neg, Sub};

use super::Interval;
use super::dual::Dual;

/// Number over a box, with N unknowns.
#[derive(Clone, Copy, Debug)]
pub struct MeanValueForm<'a, const N: usize> {
    /// Enclosure at the centre.
    pub centre: Interval,
    /// Enclosure of the number and of its derivatives over the whole box.
    pub whole: Dual<N>,
    /// Range X - m of each unknown.
    over: &'a [Interval; N],
}

impl<'a, const N: usize> MeanValueForm<'a, N> {
    fn new(centre: Interval, whole: Dual<N>, over: &'a [Interval; N]) -> Self {
        let away = whole.by.iter().zip(over).map(|(by, over)| *by * *over);
        let value = whole.value.and(away.fold(centre, Interval::add));
        Self { centre, whole: Dual { value, ..whole }, over }
    }

    /// Builds a number that does not depend on the unknowns.
    pub fn fixed(self, value: Interval) -> Self {
        Self { centre: value, whole: Dual { value, by: [Interval::from(0.0); N] }, ..self }
    }

    /// Builds one of the unknowns, with its value at the centre.
    pub fn unknown(which: usize, centre: Interval, over: &'a [Interval; N]) -> Self {
        let by = std::array::from_fn(|unknown| Interval::from(if unknown == which { 1.0 } else { 0.0 }));
        Self::new(centre, Dual { value: Interval::EVERYTHING, by }, over)
    }

    /// Builds a number that solves an equation, from its values at the centre and over the whole box, and its derivatives.
    pub fn solved(self, centre: Interval, whole: Interval, by: [Interval; N]) -> Self {
        Self::new(centre, Dual { value: whole, by }, self.over)
    }

    /// Applies a function to this number, from the function's values at the centre and over the whole box, and its derivative over the box.
    pub fn of(self, centre: Interval, whole: Interval, derivative: Interval) -> Self {
        Self::new(centre, Dual::of(whole, derivative, self.whole.by), self.over)
    }

    /// Enclosure over the whole box.
    pub fn value(&self) -> Interval {
        self.whole.value
    }
}

impl<const N: usize> Neg for MeanValueForm<'_, N> {
    type Output = Self;

    fn neg(self) -> Self {
        Self { centre: -self.centre, whole: -self.whole, ..self }
    }
}

impl<const N: usize> Add for MeanValueForm<'_, N> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::new(self.centre + other.centre, self.whole + other.whole, self.over)
    }
}

impl<const N: usize> Sub for MeanValueForm<'_, N> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<const N: usize> Mul for MeanValueForm<'_, N> {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self::new(self.centre * other.centre, self.whole * other.whole, self.over)
    }
}

impl<const N: usize> Mul<Interval> for MeanValueForm<'_, N> {
    type Output = Self;

    fn mul(self, number: Interval) -> Self {
        Self::new(self.centre * number, self.whole * number, self.over)
    }
}

impl<const N: usize> Add<Interval> for MeanValueForm<'_, N> {
    type Output = Self;

    fn add(self, number: Interval) -> Self {
        let whole = Dual { value: self.whole.value + number, ..self.whole };
        Self { centre: self.centre + number, whole, ..self }
    }
}
