//! Map of one side to second order: the terms near a corner impact that the piecewise-linear map leaves out.
//!
//! The state and the time of each impact are followed over one period as polynomials of second degree in the deviation
//! `z = (dx1, dx2, dT)`, without terms of third degree. Each flight lasts its part of T. Each impact is carried back to the moment when the
//! cam is at the angle of the orbit's impact:
//!
//! ```text
//! flight of t + h   eta -> F eta + h (f + G F eta) + h^2/2 f',   f = (v, a), f' = (a, j) at the end, G = [[0, 1], [-w0^2, -2 zeta]]
//! contact at s      delta_1 + (v + delta_2 - rho c') s + (a - rho^2 c'') s^2/2 = 0,   rho = T*/T
//! kick at s         kappa = (1 + r) (rho c' + rho^2 c'' s + c''' s^2/2 - v - delta_2 - (a - 2 zeta delta_2 - w0^2 delta_1) s - j s^2/2)
//! carried back      delta + kappa (e2 - s G e2 + s^2/2 G^2 e2) - (0, v+ - v)
//! ```
//!
//! v, a and j are the velocity before the impact with its derivatives in flight, c', c'', c''' the derivatives of the lift in time. The
//! terms of first degree equal A and B. Nothing is simulated.

use std::f64::consts::TAU;
use std::ops::{Add, Mul, Sub};

use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};

use super::corner_impact::CornerImpact;
use super::map::{SideMap, Sides};
use crate::cam::{Cam, Side};
use crate::flight::State;
use crate::model::Model;
use crate::simulate::Machine;

/// One side of the map to second order: `dx' = A dx + B dT + 1/2 (z' H_1 z, z' H_2 z)`, z = (dx, dT).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvedMap {
    /// Matrices A and B.
    pub linear: SideMap,
    /// Second derivatives of the new position and of the new velocity with respect to dx1 (m), dx2 (m/s) and dT (s); symmetric, 3x3.
    pub second: [Matrix3<f64>; 2],
}

document!(CurvedMap as map {
    second_derivatives: map.second.map(<[[f64; 3]; 3]>::from),
    fixed_point_per_unit_period: map.fixed_point().map(|[first, _]| [first[0], first[1]]),
    fixed_point_per_unit_period_squared: map.fixed_point().map(|[_, second]| [second[0], second[1]]),
});

impl CurvedMap {
    /// Terms of second degree at a deviation.
    fn curve(&self, dx: Vector2<f64>, dt: f64) -> Vector2<f64> {
        let z = Vector3::new(dx[0], dx[1], dt);
        let [position, velocity] = self.second.map(|second| 0.5 * z.dot(&(second * z)));
        Vector2::new(position, velocity)
    }

    /// Image of x* at dT = 1 s: terms of first and of second degree in dT, m and m/s per s and per s^2.
    pub fn image(&self) -> [Vector2<f64>; 2] {
        [self.linear.b, self.curve(Vector2::zeros(), 1.0)]
    }

    /// Fixed point on this side: terms of first and of second degree in dT; `None` if `I - A` is singular.
    pub fn fixed_point(&self) -> Option<[Vector2<f64>; 2]> {
        // x = x1 dT + x2 dT^2 + O(dT^3):   (I - A) x1 = B,   (I - A) x2 = 1/2 (z' H z) at z = (x1, 1)
        let inverse = (Matrix2::identity() - self.linear.a).try_inverse()?;
        let first = inverse * self.linear.b;
        Some([first, inverse * self.curve(first, 1.0)])
    }
}

/// Computes both sides' maps to second order, for an orbit with any number of impacts.
pub fn second_order(model: &Model, cam: &Cam, at: &CornerImpact) -> Sides<CurvedMap> {
    let machine = Machine::new(cam.clone(), &model.follower, at.angular_velocity());
    Sides::of_each(|side| once_around(&machine, at, side))
}

fn once_around(machine: &Machine, at: &CornerImpact, side: Side) -> CurvedMap {
    let (flights, last) = at.course();
    let mut deviation = [Polynomial::unknown(0), Polynomial::unknown(1)];
    let mut state = at.state;
    for (turn, impact) in flights {
        deviation = fly(machine, at.period, state, turn, deviation);
        deviation = hit(machine, at, impact, side, deviation);
        state = at.cycle.flight(machine, impact).0;
    }
    let [position, velocity] = fly(machine, at.period, state, last, deviation);
    CurvedMap {
        linear: SideMap {
            a: Matrix2::new(position.first[0], position.first[1], velocity.first[0], velocity.first[1]),
            b: Vector2::new(position.first[2], velocity.first[2]),
        },
        second: [position.second, velocity.second],
    }
}

/// Flight of the part `turn/(2 pi)` of T from `start`.
fn fly(machine: &Machine, period: f64, start: State, turn: f64, eta: [Polynomial; 2]) -> [Polynomial; 2] {
    let (flight, part) = (machine.flight(), turn / TAU);
    let time = part * period;
    let end = flight.fly(start, time).1;
    let flown = times(flight.propagator(time), eta);
    let turned = times(field(machine), flown);
    let later = Polynomial::unknown(2) * part;
    let (acceleration, jerk) = (flight.acceleration(end), flight.jerk(end));
    let (rate, bend) = ([end.velocity, acceleration], [acceleration, jerk]);
    [0, 1]
        .map(|row| flown[row] + later * (turned[row] + Polynomial::from(rate[row])) + later * later * (0.5 * bend[row]))
}

/// Impact, as a jump at the moment when the cam is at the orbit's angle.
fn hit(machine: &Machine, at: &CornerImpact, impact: usize, side: Side, delta: [Polynomial; 2]) -> [Polynomial; 2] {
    let (flight, omega) = (machine.flight(), machine.angular_velocity());
    let lift = at.lift(machine, impact, side);
    let [c1, c2, c3] = [omega * lift.slope, omega.powi(2) * lift.curvature, omega.powi(3) * lift.third];
    let v = at.cycle.impacts[impact].velocity_before;
    let before = State { position: lift.value, velocity: v };
    let (a, j) = (flight.acceleration(before), flight.jerk(before));
    let (r, u) = (machine.restitution(), c1 - v);
    let [position, velocity] = delta;
    // rho = T*/T = 1 - dT/T* + (dT/T*)^2
    let longer = Polynomial::unknown(2) * (1.0 / at.period);
    let rho = Polynomial::from(1.0) - longer + longer * longer;
    // u s = delta_1 + (delta_2 + (1 - rho) c') s + (a - c'') s^2/2: each round is correct to one more degree.
    let mut s = Polynomial::default();
    for _ in 0..2 {
        let faster = velocity + (Polynomial::from(1.0) - rho) * c1;
        s = (position + faster * s + s * s * (0.5 * (a - c2))) * (1.0 / u);
    }
    let bent = velocity * (-2.0 * flight.zeta()) - position * flight.omega0_squared();
    let cam = rho * c1 + rho * rho * s * c2 + s * s * (0.5 * c3);
    let follower = velocity + Polynomial::from(v) + (bent + Polynomial::from(a)) * s + s * s * (0.5 * j);
    let kappa = (cam - follower) * (1.0 + r);
    // e2 - s G e2 + s^2/2 G^2 e2
    let turn = field(machine);
    let (once, twice) = (turn.column(1).into_owned(), turn * turn.column(1));
    let back = |index: usize| s * s * (0.5 * twice[index]) - s * once[index];
    let jump = Polynomial::from((1.0 + r) * u);
    [position + kappa * back(0), velocity + kappa * (back(1) + Polynomial::from(1.0)) - jump]
}

/// Matrix G.
fn field(machine: &Machine) -> Matrix2<f64> {
    let flight = machine.flight();
    Matrix2::new(0.0, 1.0, -flight.omega0_squared(), -2.0 * flight.zeta())
}

fn times(matrix: Matrix2<f64>, [x, y]: [Polynomial; 2]) -> [Polynomial; 2] {
    [0, 1].map(|row| x * matrix[(row, 0)] + y * matrix[(row, 1)])
}

/// Polynomial of second degree in z, by its value and derivatives at z = 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Polynomial {
    value: f64,
    first: Vector3<f64>,
    second: Matrix3<f64>,
}

impl Polynomial {
    /// Polynomial of one component of z.
    fn unknown(index: usize) -> Self {
        Self { first: Vector3::ith(index, 1.0), ..Self::default() }
    }
}

impl From<f64> for Polynomial {
    fn from(value: f64) -> Self {
        Self { value, ..Self::default() }
    }
}

impl Add for Polynomial {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let Self { value, first, second } = other;
        Self { value: self.value + value, first: self.first + first, second: self.second + second }
    }
}

impl Sub for Polynomial {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + other * -1.0
    }
}

impl Mul<f64> for Polynomial {
    type Output = Self;

    fn mul(self, by: f64) -> Self {
        Self { value: self.value * by, first: self.first * by, second: self.second * by }
    }
}

impl Mul for Polynomial {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let crossed = self.first * other.first.transpose();
        Self {
            value: self.value * other.value,
            first: self.first * other.value + other.first * self.value,
            second: self.second * other.value + other.second * self.value + crossed + crossed.transpose(),
        }
    }
}
