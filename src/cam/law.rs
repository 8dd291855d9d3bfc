//! Lift laws: one smooth formula each, with its derivatives and certain bounds on them over a range of angles.

use super::arc::Arc;
use super::harmonics::Harmonics;
use super::jet::Jet;
use super::lift::Lift;
use super::offset_arc::OffsetArc;
use super::polynomial::Polynomial;
use super::sinusoid::Sinusoid;
use crate::interval::{Interval, Number};

/// Smooth lift law, valid on its segment and some way past its ends.
#[derive(Clone, Debug, PartialEq)]
#[doc(hidden)]
pub enum Law {
    /// Constant lift, m.
    Dwell(f64),
    /// Circle seen from the cam's axis.
    Arc(Arc),
    /// Circle seen along a line beside the cam's axis.
    OffsetArc(OffsetArc),
    /// Polynomial in the angle.
    Polynomial(Polynomial),
    /// Sine on a straight line.
    Sinusoid(Sinusoid),
    /// Sum of cosines of period 2 pi.
    Harmonics(Harmonics),
}

/// Dispatches on the kind of a law: one expression for a dwell, another for all other kinds.
macro_rules! of_law {
    ($law:expr, $lift:ident => $dwell:expr, $other:ident => $given:expr) => {
        match $law {
            Law::Dwell($lift) => $dwell,
            Law::Arc($other) => $given,
            Law::OffsetArc($other) => $given,
            Law::Polynomial($other) => $given,
            Law::Sinusoid($other) => $given,
            Law::Harmonics($other) => $given,
        }
    };
}

impl Law {
    /// Name of the kind of law.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Dwell(_) => "dwell",
            Self::Arc(_) => "arc",
            Self::OffsetArc(_) => "offset-arc",
            Self::Polynomial(_) => "polynomial",
            Self::Sinusoid(_) => "sinusoid",
            Self::Harmonics(_) => "harmonics",
        }
    }

    /// Lift and derivatives at `angle`, rad.
    #[inline]
    pub fn lift<N: Number>(&self, angle: N) -> Lift<N> {
        of_law!(self, value => Lift::constant(*value), law => law.lift(angle))
    }

    /// Enclosure of lift and derivatives over a range of angles, rad; unbounded where the law is not defined.
    ///
    /// A formula evaluated on an interval overestimates, because each occurrence of the angle varies independently. Therefore each
    /// derivative is also evaluated at the middle m and extended by the next derivative: `c(m + x) = c(m) + x c'(...)`.
    pub fn lift_over(&self, angles: Interval) -> Lift<Interval> {
        let (whole, middle) = (self.lift(angles), self.lift(Interval::from(angles.middle())));
        let away = angles - angles.middle();
        let curvature = whole.curvature.and(middle.curvature + away * whole.third);
        let slope = whole.slope.and(middle.slope + away * curvature);
        Lift { value: whole.value.and(middle.value + away * slope), slope, curvature, third: whole.third }
    }

    /// `c(from + turn) - c(from)` without cancellation, m.
    #[inline]
    pub fn rise(&self, from: f64, turn: f64) -> f64 {
        of_law!(self, _still => 0.0, law => law.rise(from, turn))
    }

    /// Returns [`Law::rise`] and the [`Law::lift`] at the end of the turn, with common terms computed once.
    #[inline]
    pub fn climb(&self, from: f64, turn: f64) -> (f64, Lift) {
        match self {
            Self::Arc(arc) => arc.climb(from, turn),
            _ => (self.rise(from, turn), self.lift(from + turn)),
        }
    }

    /// Bound on `|d^3c/dtheta^3|` over `[start, end]`, m/rad^3; infinite where the law is not defined.
    #[inline]
    pub fn third_bound(&self, start: f64, end: f64) -> f64 {
        of_law!(self, _still => 0.0, law => law.third_bound(start, end))
    }

    /// Bound on `|d^4c/dtheta^4|` over `[start, end]`, m/rad^4; infinite where the law is not defined.
    pub fn fourth_bound(&self, start: f64, end: f64) -> f64 {
        of_law!(self, _still => 0.0, law => law.fourth_bound(start, end))
    }

    /// Lift and its derivatives up to a high order at `angle`, rad.
    pub fn jet(&self, angle: f64) -> Jet {
        of_law!(self, value => Jet::constant(*value), law => law.jet(angle))
    }

    /// Sizes of the terms whose sums are the derivatives at `angle`; for laws without cancellation, the derivatives themselves.
    pub(super) fn terms(&self, angle: f64) -> Jet {
        match self {
            Self::Polynomial(polynomial) => polynomial.terms(angle),
            law => law.jet(angle),
        }
    }

    /// Polar distance, m, and direction, rad, of the centre of the contour's circle that this law follows; `None` for another law or for a
    /// circle about the axis.
    pub fn circle_centre(&self) -> Option<[f64; 2]> {
        match *self {
            Self::Arc(Arc { distance, direction, .. }) | Self::OffsetArc(OffsetArc { distance, direction, .. }) => {
                Some([distance, direction])
            }
            // Under a flat face: rho + kappa cos(phi).
            Self::Sinusoid(Sinusoid { start, tilt: 0.0, sine: 0.0, cosine, frequency: 1.0, .. }) => {
                Some([-cosine, start])
            }
            _ => None,
        }
    }

    /// Returns this law with every lift multiplied by a ratio.
    pub(super) fn times(&self, ratio: f64) -> Self {
        match self {
            Self::Dwell(value) => Self::Dwell(ratio * value),
            Self::Arc(arc) => Self::Arc(Arc { distance: ratio * arc.distance, radius: ratio * arc.radius, ..*arc }),
            Self::OffsetArc(OffsetArc { distance, direction, radius, offset }) => Self::OffsetArc(OffsetArc {
                distance: ratio * distance,
                direction: *direction,
                radius: ratio * radius,
                offset: ratio * offset,
            }),
            Self::Polynomial(polynomial) => Self::Polynomial(polynomial.times(ratio)),
            Self::Sinusoid(sinusoid) => Self::Sinusoid(Sinusoid {
                value: ratio * sinusoid.value,
                tilt: ratio * sinusoid.tilt,
                sine: ratio * sinusoid.sine,
                cosine: ratio * sinusoid.cosine,
                ..*sinusoid
            }),
            Self::Harmonics(harmonics) => Self::Harmonics(harmonics.times(ratio)),
        }
    }

    /// Returns this law shifted by a revolution: its value at `angle + turn` equals this law's value at `angle`, for `turn` of 2 pi or -2
    /// pi.
    ///
    /// At 0 and 2 pi, where the two meet, the distance from the law's start rounds to the same bits.
    pub(super) fn turned(&self, turn: f64) -> Self {
        match self {
            Self::Dwell(value) => Self::Dwell(*value),
            Self::Arc(arc) => Self::Arc(Arc { direction: arc.direction + turn, ..*arc }),
            Self::OffsetArc(arc) => Self::OffsetArc(OffsetArc { direction: arc.direction + turn, ..*arc }),
            Self::Polynomial(polynomial) => Self::Polynomial(polynomial.turned(turn)),
            Self::Sinusoid(sinusoid) => Self::Sinusoid(Sinusoid { start: sinusoid.start + turn, ..*sinusoid }),
            Self::Harmonics(harmonics) => Self::Harmonics(harmonics.clone()),
        }
    }
}
