//! Lift and derivatives at one angle: what every law gives.

/// Lift and its derivatives with respect to the cam angle: m, m/rad, m/rad^2, m/rad^3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lift {
    /// c(theta), m.
    pub value: f64,
    /// dc/dtheta, m/rad.
    pub slope: f64,
    /// d^2c/dtheta^2, m/rad^2.
    pub curvature: f64,
    /// d^3c/dtheta^3, m/rad^3.
    pub third: f64,
}

impl Lift {
    /// The lift `turn`, rad, further on by the Taylor sum of what is known here; the third derivative stays.
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
