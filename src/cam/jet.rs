//! Derivatives of a lift law up to a high order, by power series: they show which derivative jumps where two laws meet.

/// Lift and its derivatives at an angle, order 0 first.
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct Jet(pub [f64; Jet::ORDERS]);

impl Jet {
    /// Number of orders: 0 to 12. The last one serves only to judge the rounding of the one before.
    pub const ORDERS: usize = 13;

    /// Highest order at which a jump is searched for; laws that agree up to it count as one smooth curve.
    pub const HIGHEST_JUMP: usize = Self::ORDERS - 2;

    pub(super) fn constant(value: f64) -> Self {
        let mut orders = [0.0; Self::ORDERS];
        orders[0] = value;
        Self(orders)
    }

    /// Builds the derivatives `n! c_n` from the coefficients of `sum c_n t^n`.
    pub(super) fn from_series(mut series: [f64; Self::ORDERS]) -> Self {
        let mut factorial = 1.0;
        for (order, coefficient) in series.iter_mut().enumerate().skip(1) {
            factorial *= order as f64;
            *coefficient *= factorial;
        }
        Self(series)
    }

    /// The coefficients of `sum c_n t^n`.
    pub(super) fn series(self) -> [f64; Self::ORDERS] {
        let mut series = self.0;
        let mut factorial = 1.0;
        for (order, derivative) in series.iter_mut().enumerate().skip(1) {
            factorial *= order as f64;
            *derivative /= factorial;
        }
        series
    }

    /// The derivatives of `a sin(w t) + b cos(w t)` at t = 0: `(a w, -b w^2)`, times `-w^2` for every two orders.
    pub(super) fn of_sinusoid(a: f64, b: f64, w: f64) -> Self {
        let mut orders = [0.0; Self::ORDERS];
        let (mut this, mut next) = (b, a * w);
        for order in &mut orders {
            *order = this;
            (this, next) = (next, -w * w * this);
        }
        Self(orders)
    }

    pub(super) fn plus(mut self, other: &Self) -> Self {
        for (order, other) in self.0.iter_mut().zip(other.0) {
            *order += other;
        }
        self
    }
}
