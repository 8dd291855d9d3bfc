//! Exact free flight of the follower, for every damping and stiffness.
//!
//! `m q'' + b q' + k (q - rest) = -m g`, so `q'' = -2 zeta q' - w0^2 (q - rest) - g`. The flow is written
//! with two responses of the follower, both from rest: `s(t)` to a unit impulse and `p(t)` to a unit step,
//!
//! ```text
//! q(t) = q0 + v0 s(t) + f0 p(t)        f0 = -w0^2 (q0 - rest) - g
//! v(t) =      v0 s'(t) + f0 s(t)       s'' + 2 zeta s' + w0^2 s = 0,  s(0) = 0, s'(0) = 1,  p' = s, p(0) = 0
//! ```
//!
//! The form needs no equilibrium, so stiffness 0 is no special case, and `q(t) - q0` has no cancellation.

mod response;

use std::f64::consts::{PI, TAU};

use nalgebra::Matrix2;

use crate::elementary;
use crate::interval::Number;
use crate::model::Follower;
use crate::tolerance;
pub use response::Response;

/// Position (m, in the cam's coordinates) and velocity (m/s) of the follower.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// q, m.
    pub position: f64,
    /// v = q', m/s.
    pub velocity: f64,
}

impl State {
    /// Distance between two states, m: velocities are divided by `omega`, rad/s.
    pub(crate) fn apart(self, other: Self, omega: f64) -> f64 {
        elementary::hypot(self.position - other.position, (self.velocity - other.velocity) / omega)
    }
}

/// State of a flight at an instant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Flown {
    /// Time since the start, s.
    pub time: f64,
    /// `q - q0`, m.
    pub displacement: f64,
    /// State at that time.
    pub state: State,
}

impl Flown {
    /// Returns the start of a flight.
    #[inline]
    pub fn not_yet(state: State) -> Self {
        Self { time: 0.0, displacement: 0.0, state }
    }
}

/// Free flight of the follower, away from the cam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flight {
    zeta: f64,
    omega0_squared: f64,
    rest_position: f64,
    gravity: f64,
    regime: Regime,
}

/// Solutions of `s'' + 2 zeta s' + w0^2 s = 0`, by the roots of the characteristic polynomial.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Regime {
    /// Roots `+-i w0`.
    Undamped {
        /// w0, 1/s.
        omega: f64,
    },
    /// Roots `-zeta +- i w`.
    Underdamped {
        /// w, 1/s.
        omega: f64,
    },
    /// Roots `-slow` and `-fast`, with `slow <= fast` and `slow fast = w0^2`. Both rates are 0 or more, except for a negative damping, as
    /// in a run backwards. With stiffness 0, the root nearer to 0 is 0.
    Monotone {
        /// Rate of the root nearer to 0 for positive damping, 1/s.
        slow: f64,
        /// Rate of the other root, 1/s.
        fast: f64,
    },
}

impl Flight {
    /// Builds the free flight of a model's follower.
    pub fn new(follower: &Follower) -> Self {
        let zeta = follower.damping / (2.0 * follower.mass);
        let omega0_squared = follower.stiffness / follower.mass;
        let omega_squared = omega0_squared - zeta * zeta;
        let regime = if omega_squared > 0.0 {
            let omega = omega_squared.sqrt();
            if zeta == 0.0 { Regime::Undamped { omega } } else { Regime::Underdamped { omega } }
        } else {
            let far = zeta + (-omega_squared).sqrt().copysign(zeta);
            let near = if far == 0.0 { 0.0 } else { omega0_squared / far };
            Regime::Monotone { slow: near.min(far), fast: near.max(far) }
        };
        Self { zeta, omega0_squared, rest_position: follower.rest_position, gravity: follower.gravity, regime }
    }

    /// zeta = b/2m, 1/s.
    #[inline]
    pub fn zeta(&self) -> f64 {
        self.zeta
    }

    /// w0^2 = k/m, 1/s^2.
    #[inline]
    pub fn omega0_squared(&self) -> f64 {
        self.omega0_squared
    }

    /// g, m/s^2.
    #[inline]
    pub(crate) fn gravity(&self) -> f64 {
        self.gravity
    }

    /// Frequency of the free oscillation, rad/s, or `None` if there is no oscillation.
    pub fn damped_frequency(&self) -> Option<f64> {
        match self.regime {
            Regime::Undamped { omega } | Regime::Underdamped { omega } => Some(omega),
            Regime::Monotone { .. } => None,
        }
    }

    /// Rate at which a deviation without oscillation finally decays, 1/s; 0 without a spring. `None` if it oscillates.
    pub fn slowest_rate(&self) -> Option<f64> {
        match self.regime {
            Regime::Monotone { slow, .. } => Some(slow),
            Regime::Undamped { .. } | Regime::Underdamped { .. } => None,
        }
    }

    /// `q''` in free flight, m/s^2.
    #[inline]
    pub fn acceleration(&self, state: State) -> f64 {
        // eq:fb1   q'' = -2 zeta q' - w0^2 (q - rest) - g; the paper measures q from the slack spring, rest = 0
        self.acceleration_at(state.position, state.velocity)
    }

    /// `q''` in free flight at a position, m, with a velocity, m/s: m/s^2.
    #[inline]
    pub(crate) fn acceleration_at<N: Number>(&self, position: N, velocity: N) -> N {
        self.force(position) - velocity * (2.0 * self.zeta)
    }

    /// Acceleration at rest at `position`: spring and gravity alone, m/s^2.
    #[inline]
    pub fn force<N: Number>(&self, position: N) -> N {
        (position - self.rest_position) * -self.omega0_squared - self.gravity
    }

    /// `q'''` in free flight, m/s^3.
    #[inline]
    pub fn jerk(&self, state: State) -> f64 {
        -2.0 * self.zeta * self.acceleration(state) - self.omega0_squared * state.velocity
    }

    /// Bound on `|q'''|` at `state` and at every later instant of the same flight, m/s^3.
    ///
    /// The acceleration obeys the same damped equation as the position, so `j^2 + w0^2 a^2` never grows.
    #[inline]
    pub fn jerk_bound(&self, state: State) -> f64 {
        self.never_above(self.acceleration(state), self.jerk(state))
    }

    /// Bound on `|q''''|` at `state` and at every later instant of the same flight, m/s^4. The jerk obeys the same damped equation.
    #[inline]
    pub fn fourth_bound(&self, state: State) -> f64 {
        let (acceleration, jerk) = (self.acceleration(state), self.jerk(state));
        self.never_above(jerk, -2.0 * self.zeta * jerk - self.omega0_squared * acceleration)
    }

    /// Bound on the rate of any quantity that obeys the damped equation, from its value and its rate.
    #[inline]
    fn never_above(&self, value: f64, rate: f64) -> f64 {
        let bound = (rate * rate + self.omega0_squared * value * value).sqrt();
        // The squares may overflow or underflow although their root does not.
        if bound.is_normal() { bound } else { elementary::hypot(rate, self.omega0_squared.sqrt() * value) }
    }

    /// Returns the displacement `q(t) - q0` and the state after a flight of `t` from `start`.
    #[inline]
    pub fn fly(&self, start: State, t: f64) -> (f64, State) {
        self.fly_by(start, &self.response(t))
    }

    /// State at `time`, s, of a flight from `start`, computed from its state at another instant. With damping a short step needs only a few
    /// terms of a series, while the whole flight needs an exponential, a sine and a cosine.
    #[inline(always)]
    pub(crate) fn fly_near(&self, start: State, known: &Flown, time: f64) -> Flown {
        let more = time - known.time;
        if self.zeta == 0.0 || !self.is_short(more) {
            let (displacement, state) = self.fly(start, time);
            return Flown { time, displacement, state };
        }
        let (displacement, state) = self.fly(known.state, more);
        Flown { time, displacement: known.displacement + displacement, state }
    }

    /// Returns the displacement and the state after a flight from `start`, from the responses over that time.
    pub fn fly_by(&self, start: State, response: &Response) -> (f64, State) {
        let Response { step, impulse, impulse_rate } = *response;
        let force = self.force(start.position);
        let displacement = start.velocity * impulse + force * step;
        let velocity = start.velocity * impulse_rate + force * impulse;
        (displacement, State { position: start.position + displacement, velocity })
    }

    /// `d(q, v)/d(q0, v0)` over a flight of `t`, s: the 2x2 propagator of a deviation, by rows.
    ///
    /// Follows from `q = q0 + v0 s + f0 p`, `v = v0 s' + f0 s` with `df0/dq0 = -w0^2`.
    pub fn propagator(&self, t: f64) -> Matrix2<f64> {
        self.propagator_by(&self.response(t))
    }

    /// Propagator of a deviation, from the responses over the time of the flight.
    pub fn propagator_by(&self, response: &Response) -> Matrix2<f64> {
        let Response { step, impulse, impulse_rate } = *response;
        let spring = self.omega0_squared;
        Matrix2::new(1.0 - spring * step, impulse, -spring * impulse, impulse_rate)
    }

    /// First time, s, after the start with `v = 0`, up to which the position changes in one direction only.
    ///
    /// Infinite if there is none. Follows from `v = v0 s' + f0 s`.
    pub fn turning_point(&self, start: State) -> f64 {
        let State { position, velocity } = start;
        let force = self.force(position);
        match self.regime {
            Regime::Undamped { omega } | Regime::Underdamped { omega } => {
                // First root of v0 cos + (f0 - zeta v0)/w sin = 0 in (0, pi]; from rest, half an oscillation later.
                let (along, across) = (self.zeta * velocity - force, omega * velocity.abs());
                if across == 0.0 {
                    return if force == 0.0 { f64::INFINITY } else { PI / omega };
                }
                elementary::atan2(across, if velocity > 0.0 { along } else { -along }) / omega
            }
            Regime::Monotone { slow, fast } => {
                // s'/s = -f0/v0 =: x, and s'/s falls from infinity to -l1: e^{-(l2 - l1) t} = 1 - (l2 - l1)/(l2 + x).
                let ratio = -force / velocity;
                // NaN for a follower at rest, which moves in one direction only.
                if !(ratio + slow > 0.0 && ratio.is_finite()) {
                    return f64::INFINITY;
                }
                let part = (fast - slow) / (fast + ratio);
                let stretch = if part == 0.0 { 1.0 } else { -elementary::ln_1p(-part) / part };
                stretch / (fast + ratio)
            }
        }
    }

    /// Time (s) and state at which a flight comes down to `level`, m, or `None` if it never does.
    ///
    /// The flight must be above the level, or certain to rise above it; its course before it has risen is not examined. Two signs decide
    /// whether it falls to the level: the force at the level, and the height of the valley above the level. Rounding may make the fall
    /// earlier by an ulp, but never postpones it to the next swing.
    #[inline]
    pub fn fall_to(&self, level: f64, start: State) -> Option<(f64, State)> {
        let omega = match self.regime {
            Regime::Undamped { omega } => omega,
            Regime::Monotone { slow: 0.0, fast: 0.0 } if self.gravity > 0.0 => {
                return self.fall_freely(level, start);
            }
            _ => return self.fall_by_search(level, start),
        };
        // On the circle (x, v/w0) about the equilibrium, from (x0, y0) to (l, -h), h^2 = x0^2 + y0^2 - l^2.
        let offset = self.rest_position - self.gravity / self.omega0_squared;
        let (x, y, l) = (start.position - offset, start.velocity / omega, level - offset);
        // x - l would lose digits of the two positions if the equilibrium is far.
        let drop = start.position - level;
        let descent = drop * (x + l);
        let height_squared = descent + y * y;
        // If the equilibrium is not below the level, a swing may stay above the level. If it is below, every flight falls to the level.
        if l <= 0.0 && !(height_squared > 0.0) {
            return None;
        }
        let height = height_squared.max(0.0).sqrt();
        let sine = if y < 0.0 && x * l > 0.0 {
            // y l + x h = l (y + h) + h (x - l), with y + h = (x^2 - l^2)/(h - y): no cancellation on the way down.
            l * descent / (height - y) + height * drop
        } else {
            y * l + x * height
        };
        let angle = elementary::atan2(sine, x * l - y * height);
        let time = if angle < 0.0 { angle + TAU } else { angle } / omega;
        Some((time, State { position: level, velocity: -omega * height }))
    }

    /// Falls under gravity alone: `q0 - l + v0 t - g t^2/2 = 0`, solved in a form without cancellation.
    fn fall_freely(&self, level: f64, State { position, velocity }: State) -> Option<(f64, State)> {
        let drop = position - level;
        let speed = (velocity * velocity + 2.0 * self.gravity * drop).max(0.0).sqrt();
        let time = match velocity > 0.0 {
            true => (velocity + speed) / self.gravity,
            // A drop too small for its square root takes no time.
            false if speed == velocity => 0.0,
            false => 2.0 * drop / (speed - velocity),
        };
        time.is_finite().then_some((time, State { position: level, velocity: -speed }))
    }

    /// Falls with any follower: between two turning points the position changes in one direction, so that a bracket contains one root.
    fn fall_by_search(&self, level: f64, start: State) -> Option<(f64, State)> {
        /// Steps of Halley's method, after which the bracket is halved. If the equilibrium equals the level up to rounding, the position
        /// stays the same over a long time and the steps do not converge.
        const STEPS: u32 = 16;
        let at = |time: f64| self.fly(start, time).1;
        let rising = start.velocity > 0.0 || (start.velocity == 0.0 && self.force(start.position) > 0.0);
        let peak = if rising { self.turning_point(start) } else { 0.0 };
        if !peak.is_finite() {
            return None;
        }
        let begin = if rising { at(peak) } else { start };
        let valley = match (rising, self.damped_frequency()) {
            (false, _) => self.turning_point(start),
            (true, Some(omega)) => peak + PI / omega,
            // With two real rates there is one turning point.
            (true, None) => f64::INFINITY,
        };
        let drop = begin.position - level;
        // An equilibrium below the level, or gravity without a spring, draws every flight down.
        let comes_down = self.force(level) < 0.0
            || match valley.is_finite() {
                // Valleys lie below the equilibrium, and later ones are shallower.
                true => at(valley).position < level,
                // Without a valley: spring or damping stops the flight above the level. Damping alone stops it after v/(2 zeta).
                false => {
                    let is_stopped = self.omega0_squared > 0.0 || drop >= -begin.velocity / (2.0 * self.zeta);
                    !(self.zeta > 0.0 && is_stopped)
                }
            };
        if !comes_down {
            return None;
        }
        // Time of a fall with the acceleration at its beginning.
        let fastest = (begin.velocity * begin.velocity - 2.0 * self.acceleration(begin) * drop).sqrt();
        let short = 2.0 * drop / (fastest - begin.velocity);
        let mut high = valley;
        if valley.is_infinite() {
            // Falls of doubling length from the highest point, each longer than the rounding of its time.
            let decay = match self.regime {
                Regime::Monotone { fast, .. } if fast > 0.0 => 1.0 / fast,
                _ => 1.0,
            };
            let mut fall = if short.is_normal() { 2.0 * short } else { decay }.max(tolerance::ULP.value * peak);
            high = peak + fall;
            while !(at(high).position < level) {
                fall *= 2.0;
                high = peak + fall;
                // The equilibrium is below the level by less than the rounding of a position.
                if !high.is_finite() {
                    return None;
                }
            }
        }
        let guess = peak + short;
        let mut low = peak;
        // Strictly inside the bracket: at its lower end the search would make no progress.
        let mut time = if (low.next_up()..high).contains(&guess) { guess } else { 0.5 * (low + high) };
        let (mut steps, mut known) = (0, Flown { time: peak, displacement: 0.0, state: begin });
        while high - low > tolerance::ROOT_WIDTH.value * high {
            steps += 1;
            known = self.fly_near(start, &known, time);
            let state = known.state;
            if state.position >= level {
                low = time
            } else {
                high = time
            }
            // Halley's method has third order, and the acceleration follows from the state.
            let (acceleration, newton) = (self.acceleration(state), (level - state.position) / state.velocity);
            let bend = 0.5 * newton * acceleration / state.velocity;
            let step = newton / (1.0 + bend);
            // The step leaves at most the fraction bend^2 + (w0^2 + 4 zeta^2) step^2 of the error.
            let rates = self.omega0_squared + 4.0 * self.zeta * self.zeta;
            if (bend * bend + rates * step * step) * step.abs() <= tolerance::ULP.value * time {
                let velocity = state.velocity + step * (acceleration + 0.5 * step * self.jerk(state));
                return Some((time + step, State { position: level, velocity }));
            }
            let better = time + step;
            let is_near = steps < STEPS && (low.next_up()..high).contains(&better);
            time = if is_near { better } else { 0.5 * (low + high) };
        }
        Some((time, State { position: level, ..at(time) }))
    }
}
