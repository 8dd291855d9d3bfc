//! Responses of the follower to a unit impulse and a unit step: over a time in doubles, over a range of times in intervals.

use super::{Flight, Regime, State};
use crate::elementary;
use crate::interval::{Interval, Number};
use crate::tolerance;

/// Responses of the follower at a time `t` after a unit impulse and after a unit step, from rest.
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct Response<N = f64> {
    /// `p(t)`, s^2: displacement under a constant unit acceleration.
    pub step: N,
    /// `s(t)`, s: displacement after a unit velocity; also the velocity under a unit step.
    pub impulse: N,
    /// `s'(t)`: velocity after a unit velocity at the start.
    pub impulse_rate: N,
}

impl Flight {
    /// Responses at `t`, s, zero or more.
    #[inline]
    pub fn response(&self, t: f64) -> Response {
        match self.regime {
            Regime::Undamped { omega } => {
                let (sin, cos) = elementary::sin_cos(omega * t);
                let impulse = sin / omega;
                // p = (1 - cos)/w^2 = s^2/(1 + cos): the form without cancellation is used.
                let step = if cos > 0.0 { impulse * impulse / (1.0 + cos) } else { (1.0 - cos) / self.omega0_squared };
                Response { step, impulse, impulse_rate: cos }
            }
            // Neither spring nor damper.
            Regime::Monotone { slow: 0.0, fast: 0.0 } => Response { step: 0.5 * t * t, impulse: t, impulse_rate: 1.0 },
            _ => self.damped_response(t),
        }
    }

    /// Responses over a flight from `start` to `end`, which takes `time`, s. Without damping they follow from the two states, without a sine.
    #[inline]
    pub(crate) fn response_between(&self, start: State, end: State, time: impl FnOnce() -> f64) -> Response {
        let Regime::Undamped { .. } = self.regime else { return self.response(time()) };
        let (spring, force) = (self.omega0_squared, self.force(start.position));
        // q - q0 = v0 s + f0 p and v - v0 = f0 s - w0^2 v0 p, for s and p.
        let square = force * force + spring * start.velocity * start.velocity;
        if !square.is_normal() {
            return self.response(time());
        }
        let (displacement, change) = (end.position - start.position, end.velocity - start.velocity);
        let impulse = (spring * start.velocity * displacement + force * change) / square;
        let step = (force * displacement - start.velocity * change) / square;
        Response { step, impulse, impulse_rate: 1.0 - spring * step }
    }

    /// Whether the series is accurate for a time `t`, s, of either sign: only a small part of an oscillation and of its decay.
    #[inline]
    pub(super) fn is_short(&self, t: f64) -> bool {
        self.omega0_squared * t * t < 0.25 && (self.zeta * t).abs() < 1.0
    }

    fn damped_response(&self, t: f64) -> Response {
        let (zeta, omega0_squared) = (self.zeta, self.omega0_squared);
        let angle_squared = omega0_squared * t * t;
        // p(t) = (1 - s' - 2 zeta s) / w0^2 cancels over a small part of an oscillation.
        if self.is_short(t) {
            return self.response_by_series(t);
        }
        match self.regime {
            Regime::Undamped { omega } | Regime::Underdamped { omega } => {
                let decay = elementary::exp(-zeta * t);
                let (sin, cos) = elementary::sin_cos(omega * t);
                // s = e^{-zeta t} sin(w t)/w
                let impulse = decay * sin / omega;
                // s' = e^{-zeta t} cos(w t) - zeta s
                let impulse_rate = decay * cos - zeta * impulse;
                Response { step: (1.0 - impulse_rate - 2.0 * zeta * impulse) / omega0_squared, impulse, impulse_rate }
            }
            // Rates l1 <= l2 of e^{-l1 t}, e^{-l2 t}, with l1 l2 = w0^2.
            Regime::Monotone { slow, fast } => {
                let gap = fast - slow;
                // s = e^{-l1 t} (1 - e^{-(l2 - l1) t})/(l2 - l1)
                let impulse = elementary::exp(-slow * t) * t * mean_decay(gap * t);
                // s' = e^{-l2 t} - l1 s
                let impulse_rate = elementary::exp(-fast * t) - slow * impulse;
                let step = if angle_squared < 0.25 {
                    // p = t (E(l1 t) - E(l2 t))/(l2 - l1),  E(x) = (1 - e^{-x})/x
                    t * (mean_decay(slow * t) - mean_decay(fast * t)) / gap
                } else {
                    (1.0 - impulse_rate - 2.0 * zeta * impulse) / omega0_squared
                };
                Response { step, impulse, impulse_rate }
            }
        }
    }

    /// `p(t) = sum d_n/n!`, with `d_n = t^n` times the n-th derivative at 0: `d_2 = t^2`, `d_{n+2} = -2 zeta t d_{n+1} - w0^2 t^2 d_n`.
    ///
    /// A division would take longer than everything else in a step.
    fn response_by_series<N: Number>(&self, t: N) -> Response<N> {
        let damping = t * (2.0 * self.zeta);
        let spring = t * self.omega0_squared * t;
        // |d_{n+2}| <= t^2 x^n, since x^2 >= 2 zeta t x + w0^2 t^2.
        let x = damping.magnitude() + spring.magnitude().sqrt();
        // In units of t^2 for p, t for s and 1 for s': s = p', s' = p''.
        let (mut before, mut last) = (N::from(0.0), N::from(1.0));
        let (mut step, mut impulse, mut impulse_rate) = (N::from(0.5), N::from(1.0), N::from(1.0));
        let (mut n, mut power, mut size) = (1, 1.0, 1.0);
        // x < 4: the terms of s', which are the largest, fall below a quarter of an ulp of 1 before the 34th.
        while n < 32 && size >= tolerance::SERIES_END.value {
            // Two terms at a time: a test of their size takes nearly as long as a term.
            for n in [n, n + 1] {
                (before, last) = (last, -damping * last - spring * before);
                impulse_rate = impulse_rate + last.over_factorial(n);
                impulse = impulse + last.over_factorial(n + 1);
                step = step + last.over_factorial(n + 2);
            }
            power *= x * x;
            size = f64::over_factorial(power, n + 1);
            n += 2;
        }
        // If a term x^n/n! is so small, x is less than half of n: the sum of all terms left out is smaller than this term.
        let tail = N::left_out(2.0 * size);
        Response { step: t * t * (step + tail), impulse: t * (impulse + tail), impulse_rate: impulse_rate + tail }
    }

    /// Encloses the responses over a range of times, s.
    ///
    /// Without damping, sine and cosine are used, which have exact ranges. With damping, the series is used near 0. At a time `m + x` the
    /// responses at m and at `x` are combined. The responses at m are combined from those at half of m, so that nothing cancels.
    pub fn response_over(&self, t: Interval) -> Response<Interval> {
        if let Regime::Undamped { .. } = self.regime {
            let omega = Interval::from(self.omega0_squared).sqrt();
            let (sin, cos) = (omega * t).sin_cos();
            let impulse = sin / omega;
            // p = (1 - cos)/w^2 = s^2/(1 + cos): the first form is narrow for long times, the second does not cancel for short times.
            let step = (-cos + 1.0) / self.omega0_squared;
            return Response { step: step.and(impulse.squared() / (cos + 1.0)), impulse, impulse_rate: cos };
        }
        let size = t.magnitude();
        // The series is accurate here, with room for rounding; an infinite range cannot be halved.
        if (self.omega0_squared * size * size < 3.9 && self.zeta * size < 0.9) || !size.is_finite() {
            return self.response_by_series(t);
        }
        let middle = t.middle();
        if t.low() == t.high() || t.holds_zero() {
            let half = self.response_over(t.half());
            return self.together(&half, &half);
        }
        self.together(&self.response_over(middle.into()), &self.response_over(t - middle))
    }

    /// `s''`, 1/s: the acceleration after a unit velocity, from the responses at that time.
    pub fn impulse_bend(&self, response: &Response<Interval>) -> Interval {
        // s'' = -2 zeta s' - w0^2 s
        -(response.impulse_rate * (2.0 * self.zeta) + response.impulse * self.omega0_squared)
    }

    /// Responses at the sum of two times.
    fn together(&self, one: &Response<Interval>, two: &Response<Interval>) -> Response<Interval> {
        // Under a unit step: at p, with velocity s and the remaining force 1 - w0^2 p.
        let left = -(one.step * self.omega0_squared) + 1.0;
        Response {
            step: one.step + one.impulse * two.impulse + left * two.step,
            // After a unit impulse: at s, with velocity s' and the force -w0^2 s.
            impulse: one.impulse_rate * two.impulse + one.impulse * (-(two.step * self.omega0_squared) + 1.0),
            impulse_rate: one.impulse_rate * two.impulse_rate - one.impulse * two.impulse * self.omega0_squared,
        }
    }
}

/// `(1 - e^{-x})/x`, 1 at 0: the mean of `e^{-y}` over `0..x`.
fn mean_decay(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { -elementary::exp_m1(-x) / x }
}
