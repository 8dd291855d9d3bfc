//! Lift and derivatives at one angle: the value of every law.

use crate::interval::Interval;

/// Lift and its derivatives with respect to the cam angle: m, m/rad, m/rad^2, m/rad^3.
///
/// The numbers are doubles, or intervals that contain the values over a range of angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lift<N = f64> {
    /// c(theta), m.
    pub value: N,
    /// dc/dtheta, m/rad.
    pub slope: N,
    /// d^2c/dtheta^2, m/rad^2.
    pub curvature: N,
    /// d^3c/dtheta^3, m/rad^3.
    pub third: N,
}

impl<N: From<f64>> Lift<N> {
    /// Constant lift, m.
    pub fn constant(value: f64) -> Self {
        Self { value: value.into(), slope: 0.0.into(), curvature: 0.0.into(), third: 0.0.into() }
    }
}

impl Lift<Interval> {
    /// Hull of both enclosures.
    pub(crate) fn hull(self, other: Self) -> Self {
        Self {
            value: self.value.hull(other.value),
            slope: self.slope.hull(other.slope),
            curvature: self.curvature.hull(other.curvature),
            third: self.third.hull(other.third),
        }
    }
}

impl Lift {
    /// Lift after a turn, rad, by the Taylor sum of these derivatives; the third derivative is kept constant.
    #[inline]
    pub fn after(&self, turn: f64) -> Self {
        let Self { value, slope, curvature, third } = *self;
        Self {
            value: value + turn * (slope + turn * (0.5 * curvature + turn * third / 6.0)),
            slope: slope + turn * (curvature + 0.5 * turn * third),
            curvature: curvature + turn * third,
            third,
        }
    }
}
