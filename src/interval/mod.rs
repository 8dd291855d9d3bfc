//! Intervals of doubles that enclose the results of a formula for all numbers in its arguments.
//!
//! Each operation is rounded to nearest. Then its ends, except an exact 0, are moved outwards by one ulp, which is more than the rounding
//! error. Sine and cosine are alternating series, summed in doubles and widened by bounds on the rounding and on the omitted terms. A
//! result that is unbounded on both sides, or NaN, is the whole real line: every comparison then fails, so that nothing is concluded from
//! it.

pub mod dual;
pub mod mean_value_form;
pub mod roots;

use std::f64::consts::FRAC_PI_2;
use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::elementary;
use crate::tolerance;

/// Number type of a formula: a double, or an interval between two doubles.
pub trait Number:
    Copy
    + From<f64>
    + Neg<Output = Self>
    + Add<Output = Self>
    + Add<f64, Output = Self>
    + Sub<Output = Self>
    + Sub<f64, Output = Self>
    + Mul<Output = Self>
    + Mul<f64, Output = Self>
    + Div<Output = Self>
    + Div<f64, Output = Self>
{
    /// Sine and cosine of an angle, rad.
    fn sin_cos(self) -> (Self, Self);
    /// Square root that is not negative.
    fn sqrt(self) -> Self;
    /// Largest absolute value in it.
    fn magnitude(self) -> f64;
    /// Remainder of a truncated sum, of at most this size. It is 0 for doubles.
    fn left_out(size: f64) -> Self;
    /// Quotient by `n!`, for `n` up to 34.
    fn over_factorial(self, n: usize) -> Self;
}

/// Inverse factorials `1/n!`, within two units in the last place. A factorial up to 34! is exact before it is rounded to a double.
const INVERSE_FACTORIALS: [f64; 35] = {
    let (mut all, mut factorial, mut n) = ([1.0; 35], 1_u128, 1);
    while n < all.len() {
        factorial *= n as u128;
        all[n] = 1.0 / factorial as f64;
        n += 1;
    }
    all
};

impl Number for f64 {
    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        elementary::sin_cos(self)
    }

    #[inline]
    fn sqrt(self) -> Self {
        self.sqrt()
    }

    #[inline]
    fn magnitude(self) -> f64 {
        self.abs()
    }

    #[inline]
    fn over_factorial(self, n: usize) -> Self {
        self * INVERSE_FACTORIALS[n]
    }

    #[inline]
    fn left_out(_: f64) -> Self {
        0.0
    }
}

/// Interval of all real numbers from one double to another, larger or equal one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    low: f64,
    high: f64,
}

impl From<f64> for Interval {
    #[inline]
    fn from(number: f64) -> Self {
        Self::new(number, number)
    }
}

impl Interval {
    /// Whole real line.
    pub const EVERYTHING: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY };
    /// First 33 bits of pi/2, whose multiples are exact, and an enclosure of the remaining part of pi/2.
    const QUARTER_HIGH: f64 = f64::from_bits(FRAC_PI_2.to_bits() & !0xf_ffff);
    const QUARTER_REST: Self = {
        let rest = FRAC_PI_2 - Self::QUARTER_HIGH + 6.123_233_995_736_766e-17;
        Self { low: rest.next_down(), high: rest.next_up() }
    };
    const QUARTER: Self = Self { low: FRAC_PI_2, high: FRAC_PI_2.next_up() };
    /// Enclosure of 2 pi; its lower end is the double that counts turns of the cam.
    pub const TURN: Self = Self { low: 4.0 * Self::QUARTER.low, high: 4.0 * Self::QUARTER.high };

    /// Returns the interval from `low` to `high`, or the whole real line unless `low <= high`.
    #[inline]
    pub fn new(low: f64, high: f64) -> Self {
        if low <= high { Self { low, high } } else { Self::EVERYTHING }
    }

    /// Moves each end outwards by an ulp, except an end at 0, since a sum or a root is 0 only if it is exactly 0. Moving a 0 by an ulp
    /// would also give a subnormal number, which no processor multiplies at full speed.
    ///
    /// `x + u (1 + 2 u) |x|`, u half an ulp of 1, is rounded to the next double after x (Rump, Zimmermann, Boldo, Melquiond 2009), unless x
    /// is so small that its ulp has no half.
    #[inline]
    fn rounded(low: f64, high: f64) -> Self {
        const OUT: f64 = 0.5 * tolerance::ULP.value * (1.0 + tolerance::ULP.value);
        const SMALL: f64 = f64::MIN_POSITIVE / (tolerance::ULP.value * tolerance::ULP.value);
        let is_large = |x: f64| x == 0.0 || x.abs() > SMALL;
        if is_large(low) && is_large(high) {
            Self::new(low - OUT * low.abs(), high + OUT * high.abs())
        } else {
            Self::new(low.next_down(), high.next_up())
        }
    }

    /// Widens a product or a quotient past an end at 0 if a nonzero result underflowed to 0.
    #[inline]
    fn unless_lost(self, is_lost: impl FnOnce() -> bool) -> Self {
        let at_zero = self.low == 0.0 || self.high == 0.0;
        if at_zero && is_lost() { self.hull(Self::left_out(0.0_f64.next_up())) } else { self }
    }

    /// Lower end.
    #[inline]
    pub fn low(self) -> f64 {
        self.low
    }

    /// Upper end.
    #[inline]
    pub fn high(self) -> f64 {
        self.high
    }

    /// Number near its middle; 0 if an end is infinite.
    #[inline]
    pub fn middle(self) -> f64 {
        let middle = 0.5 * self.low + 0.5 * self.high;
        if middle.is_finite() { middle.clamp(self.low, self.high) } else { 0.0 }
    }

    /// Width, rounded.
    #[inline]
    pub fn width(self) -> f64 {
        self.high - self.low
    }

    /// Whether it contains 0.
    #[inline]
    pub fn holds_zero(self) -> bool {
        self.low <= 0.0 && 0.0 <= self.high
    }

    /// Whether all of it is above 0.
    #[inline]
    pub fn is_positive(self) -> bool {
        self.low > 0.0
    }

    /// Whether all of it is below 0.
    #[inline]
    pub fn is_negative(self) -> bool {
        self.high < 0.0
    }

    /// Whether it lies strictly inside another interval.
    #[inline]
    pub fn is_inside(self, other: Self) -> bool {
        other.low < self.low && self.high < other.high
    }

    /// Intersection with another interval; `None` if they are disjoint.
    #[inline]
    pub fn common(self, other: Self) -> Option<Self> {
        let (low, high) = (self.low.max(other.low), self.high.min(other.high));
        (low <= high).then_some(Self { low, high })
    }

    /// Intersection of two enclosures of one number; the whole real line if they are disjoint.
    #[inline]
    pub(crate) fn and(self, other: Self) -> Self {
        // Two enclosures of one number have it in common; if they are disjoint, both are wrong.
        self.common(other).unwrap_or(Self::EVERYTHING)
    }

    /// Smallest interval that contains both.
    #[inline]
    pub fn hull(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Half of each number, exactly.
    #[inline]
    pub(crate) fn half(self) -> Self {
        Self { low: 0.5 * self.low, high: 0.5 * self.high }
    }

    /// Both halves, which share one number.
    #[inline]
    pub fn halves(self) -> [Self; 2] {
        let middle = self.middle();
        [Self { high: middle, ..self }, Self { low: middle, ..self }]
    }

    /// Square of each number.
    #[inline]
    pub fn squared(self) -> Self {
        let product = self * self;
        Self { low: product.low.max(0.0), ..product }
    }

    /// Sine and cosine of one double.
    fn circular(angle: f64) -> (Self, Self) {
        /// Number of quarter turns beyond which the reduced angle is too inaccurate.
        const MOST_QUARTERS: f64 = 1e6;
        /// Number of terms: for an eighth of a turn the twentieth power over 20! is below an ulp.
        const TERMS: u32 = 9;
        /// Bound on the error of the sum in doubles, a unit in the last place of 1. Each step rounds its product and its quotient, at most
        /// 0.31, by half a unit of their size, and its difference, below 1, by a quarter of a unit. It also carries 0.31 times the error of
        /// the step before, whose own part is 0.33 at most. That makes 0.31 + 0.25 + 0.31 * 0.33 < 0.67. The ends are rounded by a quarter
        /// more, and the omitted terms are below a hundredth.
        const OFF: f64 = tolerance::ULP.value;
        let all = Self { low: -1.0, high: 1.0 };
        let quarters = (angle / FRAC_PI_2).round();
        if !(quarters.abs() <= MOST_QUARTERS) {
            return (all, all);
        }
        // The first difference is exact as well: its operands are near each other, or one is 0.
        let rest = Self::from(angle - quarters * Self::QUARTER_HIGH) - Self::QUARTER_REST * quarters;
        let square = rest.squared();
        // 1 - x^2/(a b) (1 - x^2/(c d) (1 - ...)): the terms decrease and alternate, and the sum changes by at most half of the change of
        // x^2.
        let series = |first: u32| {
            let middle = square.middle();
            let sum = (0..TERMS).rev().fold(1.0, |inner, term| {
                let below = f64::from((first + 2 * term) * (first + 2 * term + 1));
                1.0 - middle * inner / below
            });
            let room = OFF + 0.5 * square.width();
            Self { low: sum - room, high: sum + room }
        };
        let (sin, cos) = (rest * series(2), series(1));
        let (sin, cos) = match quarters.rem_euclid(4.0) as u8 {
            0 => (sin, cos),
            1 => (cos, -sin),
            2 => (-sin, -cos),
            _ => (-cos, sin),
        };
        (sin.and(all), cos.and(all))
    }
}

impl Number for Interval {
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = Self::circular(self.low);
        if self.low == self.high {
            return (sin, cos);
        }
        let quarters = self / Self::QUARTER;
        if !(quarters.width() < 4.0) {
            return (Self { low: -1.0, high: 1.0 }, Self { low: -1.0, high: 1.0 });
        }
        let (sin_high, cos_high) = Self::circular(self.high);
        let (mut sin, mut cos) = (sin.hull(sin_high), cos.hull(cos_high));
        // Between the ends the largest and smallest values are at whole quarter turns.
        let mut quarter = quarters.low.ceil();
        while quarter <= quarters.high {
            match quarter.rem_euclid(4.0) as u8 {
                0 => cos.high = 1.0,
                1 => sin.high = 1.0,
                2 => cos.low = -1.0,
                _ => sin.low = -1.0,
            }
            quarter += 1.0;
        }
        (sin, cos)
    }

    /// Returns the whole real line if part of the interval is below 0.
    #[inline]
    fn sqrt(self) -> Self {
        Self::rounded(self.low.sqrt(), self.high.sqrt())
    }

    #[inline]
    fn magnitude(self) -> f64 {
        self.low.abs().max(self.high.abs())
    }

    #[inline]
    fn over_factorial(self, n: usize) -> Self {
        let factor = INVERSE_FACTORIALS[n];
        self * Self { low: factor.next_down().next_down(), high: factor.next_up().next_up() }
    }

    #[inline]
    fn left_out(size: f64) -> Self {
        Self::new(-size, size)
    }
}

impl Neg for Interval {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        Self { low: -self.high, high: -self.low }
    }
}

impl Add for Interval {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        Self::rounded(self.low + other.low, self.high + other.high)
    }
}

impl Sub for Interval {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Interval {
    type Output = Self;

    #[inline]
    fn mul(self, other: Self) -> Self {
        let products = [self.low * other.low, self.low * other.high, self.high * other.low, self.high * other.high];
        // 0 times infinity is NaN, and would be lost among the others; a product unbounded on both sides is everything, too.
        let [a, b, c, d] = products;
        if (a + b + (c + d)).is_nan() {
            return Self::EVERYTHING;
        }
        let min = |x: f64, y: f64| if x < y { x } else { y };
        let max = |x: f64, y: f64| if x > y { x } else { y };
        let product = Self::rounded(min(min(a, b), min(c, d)), max(max(a, b), max(c, d)));
        product.unless_lost(|| {
            let is_lost = |x: f64, y: f64| x * y == 0.0 && x != 0.0 && y != 0.0;
            [self.low, self.high].iter().any(|x| is_lost(*x, other.low) || is_lost(*x, other.high))
        })
    }
}

impl Div for Interval {
    type Output = Self;

    /// Returns the whole real line if the divisor may be 0.
    #[inline]
    fn div(self, other: Self) -> Self {
        if other.holds_zero() {
            return Self::EVERYTHING;
        }
        // The ends of the quotients are rounded outwards, and the ends of the products again.
        self * Self::rounded(1.0 / other.high, 1.0 / other.low)
    }
}

impl Add<f64> for Interval {
    type Output = Self;

    #[inline]
    fn add(self, number: f64) -> Self {
        self + Self::from(number)
    }
}

impl Sub<f64> for Interval {
    type Output = Self;

    #[inline]
    fn sub(self, number: f64) -> Self {
        self - Self::from(number)
    }
}

impl Mul<f64> for Interval {
    type Output = Self;

    #[inline]
    fn mul(self, number: f64) -> Self {
        let (one, two) = (self.low * number, self.high * number);
        let product = if number < 0.0 { Self::rounded(two, one) } else { Self::rounded(one, two) };
        product.unless_lost(|| number != 0.0 && (one == 0.0 && self.low != 0.0 || two == 0.0 && self.high != 0.0))
    }
}

impl Div<f64> for Interval {
    type Output = Self;

    /// Returns the whole real line if the divisor is 0.
    #[inline]
    fn div(self, number: f64) -> Self {
        if number == 0.0 {
            return Self::EVERYTHING;
        }
        let (one, two) = (self.low / number, self.high / number);
        let quotient = if number < 0.0 { Self::rounded(two, one) } else { Self::rounded(one, two) };
        quotient.unless_lost(|| one == 0.0 && self.low != 0.0 || two == 0.0 && self.high != 0.0)
    }
}
