//! Free flight of the follower, exactly, for every damping and stiffness.
//!
//! `m q'' + b q' + k (q - rest) = -m g`, so `q'' = -2 zeta q' - w0^2 (q - rest) - g`. The flow is written
//! with two responses of the follower, both from rest: `s(t)` to a unit impulse and `p(t)` to a unit step,
//!
//! ```text
//! q(t) = q0 + v0 s(t) + f0 p(t)        f0 = -w0^2 (q0 - rest) - g
//! v(t) =      v0 s'(t) + f0 s(t)       s'' + 2 zeta s' + w0^2 s = 0,  s(0) = 0, s'(0) = 1,  p' = s, p(0) = 0
//! ```
//!
//! No equilibrium is needed, so stiffness 0 is no special case, and `q(t) - q0` comes without cancellation.

use crate::model::Follower;

/// Position (m, in the cam's coordinates) and velocity (m/s) of the follower.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// q, m.
    pub position: f64,
    /// v = q', m/s.
    pub velocity: f64,
}

/// The follower away from the cam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flight {
    zeta: f64,
    omega0_squared: f64,
    rest_position: f64,
    gravity: f64,
}

/// What the follower does `t` after a unit impulse and a unit step, from rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// `p(t)`, s^2: displacement under a unit acceleration switched on.
    pub step: f64,
    /// `s(t)`, s: displacement after a unit velocity; also the velocity under a unit step.
    pub impulse: f64,
    /// `s'(t)`: velocity left of a unit velocity.
    pub impulse_rate: f64,
}

impl Flight {
    /// The free flight of a model's follower.
    pub fn new(follower: &Follower) -> Self {
        Self {
            zeta: follower.damping / (2.0 * follower.mass),
            omega0_squared: follower.stiffness / follower.mass,
            rest_position: follower.rest_position,
            gravity: follower.gravity,
        }
    }

    /// `q''` in free flight, m/s^2.
    pub fn acceleration(&self, state: State) -> f64 {
        self.force(state.position) - 2.0 * self.zeta * state.velocity
    }

    /// Acceleration at rest at `position`: spring and gravity alone, m/s^2.
    pub fn force(&self, position: f64) -> f64 {
        -self.omega0_squared * (position - self.rest_position) - self.gravity
    }

    /// `q'''` in free flight, m/s^3.
    pub fn jerk(&self, state: State) -> f64 {
        -2.0 * self.zeta * self.acceleration(state) - self.omega0_squared * state.velocity
    }

    /// A bound on `|q'''|` at `state` and at every later instant of the same flight, m/s^3.
    ///
    /// The acceleration obeys the same damped equation as the position, so `j^2 + w0^2 a^2` never grows.
    pub fn jerk_bound(&self, state: State) -> f64 {
        let acceleration = self.acceleration(state);
        self.jerk(state).hypot(self.omega0_squared.sqrt() * acceleration)
    }

    /// Displacement `q(t) - q0` and the state after flying for `t` from `start`.
    pub fn fly(&self, start: State, t: f64) -> (f64, State) {
        let Response { step, impulse, impulse_rate } = self.response(t);
        let force = self.force(start.position);
        let displacement = start.velocity * impulse + force * step;
        let velocity = start.velocity * impulse_rate + force * impulse;
        (displacement, State { position: start.position + displacement, velocity })
    }

    /// The responses at `t`, s, zero or more.
    pub fn response(&self, t: f64) -> Response {
        let (zeta, omega0_squared) = (self.zeta, self.omega0_squared);
        let angle_squared = omega0_squared * t * t;
        // p(t) = (1 - s' - 2 zeta s) / w0^2 cancels where little of an oscillation has passed.
        if angle_squared < 0.25 && zeta * t < 1.0 {
            return self.response_by_series(t);
        }
        let omega_squared = omega0_squared - zeta * zeta;
        if omega_squared > 0.0 {
            let omega = omega_squared.sqrt();
            let decay = (-zeta * t).exp();
            let (sin, cos) = (omega * t).sin_cos();
            // s = e^{-zeta t} sin(w t)/w
            let impulse = decay * sin / omega;
            // s' = e^{-zeta t} cos(w t) - zeta s
            let impulse_rate = decay * cos - zeta * impulse;
            return Response {
                step: (1.0 - impulse_rate - 2.0 * zeta * impulse) / omega0_squared,
                impulse,
                impulse_rate,
            };
        }
        // Overdamped, critical, and stiffness 0: rates l1 <= l2 of e^{-l1 t}, e^{-l2 t}, with l1 l2 = w0^2.
        let half_gap = (-omega_squared).sqrt();
        let fast = zeta + half_gap;
        let slow = omega0_squared / fast;
        // s = e^{-l1 t} (1 - e^{-(l2 - l1) t})/(l2 - l1)
        let impulse = (-slow * t).exp() * t * mean_decay(2.0 * half_gap * t);
        // s' = e^{-l2 t} - l1 s
        let impulse_rate = (-fast * t).exp() - slow * impulse;
        let step = if angle_squared < 0.25 {
            // p = t (E(l1 t) - E(l2 t))/(l2 - l1),  E(x) = (1 - e^{-x})/x
            t * (mean_decay(slow * t) - mean_decay(fast * t)) / (2.0 * half_gap)
        } else {
            (1.0 - impulse_rate - 2.0 * zeta * impulse) / omega0_squared
        };
        Response { step, impulse, impulse_rate }
    }

    /// `p(t) = sum p_n`, with `(n+2)(n+1) p_{n+2} = -2 zeta t (n+1) p_{n+1} - w0^2 t^2 p_n`, `p_2 = t^2/2`.
    fn response_by_series(&self, t: f64) -> Response {
        let damping = 2.0 * self.zeta * t;
        let spring = self.omega0_squared * t * t;
        // In units of t^2 for p, t for s and 1 for s': s = p', s' = p''.
        let (mut before, mut term) = (0.0, 0.5);
        let (mut step, mut impulse, mut impulse_rate) = (0.5, 1.0, 1.0);
        // 2 zeta t < 2 and w0^2 t^2 < 1/4: the terms fall below an ulp of the sums before the 32nd.
        for n in 1..32 {
            let n = f64::from(n);
            let next = (-damping * (n + 1.0) * term - spring * before) / ((n + 2.0) * (n + 1.0));
            step += next;
            impulse += (n + 2.0) * next;
            impulse_rate += (n + 2.0) * (n + 1.0) * next;
            (before, term) = (term, next);
        }
        Response { step: t * t * step, impulse: t * impulse, impulse_rate }
    }
}

/// `(1 - e^{-x})/x`, 1 at 0: the mean of `e^{-y}` over `0..x`.
fn mean_decay(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { -(-x).exp_m1() / x }
}
