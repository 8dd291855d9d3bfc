//! Computes A and B as a product over one period of the orbit: propagators of flights, saltation matrices of impacts.
//!
//! A deviation `xi` of the state at one cam angle changes in a flight from y over an angle `turn`, and in an impact, as
//!
//! ```text
//! flight   xi -> Phi xi + f(end) turn/(2 pi) dT + dy_p dp          dy' = M dy + M_p y + f_p,   dy(0) = 0
//! impact   xi -> S (xi - (c_p, 0) dp) + (c_p, (1 + r) dc'_p + r_p (c' - v)) dp
//! ```
//!
//! with `y' = f(y) = M y + f`, the propagator `Phi` of [`crate::flight`] and the saltation matrix S of [`crate::impact`]. At an impact the
//! speed enters only by `c' = w dc/dtheta`: `dc' = -c' dT/T`. At the corner S and c' use the side's lift, which is the only difference of
//! the sides. Nothing is simulated.

use nalgebra::{Matrix2, Matrix2x3, RowVector2, SMatrix, Vector2};

use super::corner_impact::CornerImpact;
use super::map::{CornerMap, LinearForm, Own, Route, RouteName, SideMap, Sides, Uncertainty};
use super::varied::{Change, LiftChange, NoChange, Varied};
use crate::cam::{Cam, Side};
use crate::flight::State;
use crate::impact::ImpactRates;
use crate::model::{Follower, Model};
use crate::simulate::Machine;

/// Computes the map with B for the period.
pub fn route(model: &Model, cam: &Cam, at: &CornerImpact) -> Route {
    let around = Around::new(model, cam, at);
    let map = CornerMap::of_each(|side| around.side_map(side, &Change::of_period(at.cycle.impacts.len())));
    let own = Own::border(around.border());
    Route { name: RouteName::Variational, map, own, uncertainty: None }
}

/// Computes the map with B for any number. If the cam's shape depends on the number, the error is that of the differences that give the
/// derivative of the lift.
pub fn route_by(model: &Model, cam: &Cam, at: &CornerImpact, varied: &Varied) -> Result<Route, NoChange> {
    let around = Around::new(model, cam, at);
    let found = Sides::try_of_each(|side| {
        let change = Change::new(model, at, varied, side)?;
        let map = around.side_map(side, &change);
        let mut off = SideMap::ZERO;
        for (impact, uncertain) in change.lift_errors.iter().enumerate() {
            for moved in [LiftChange { slope: 0.0, ..*uncertain }, LiftChange { value: 0.0, ..*uncertain }] {
                let mut other = change.clone();
                other.lifts[impact].value += moved.value;
                other.lifts[impact].slope += moved.slope;
                off.b += (around.side_map(side, &other).b - map.b).abs();
            }
        }
        Ok::<_, NoChange>((map, off))
    })?;
    let (map, error) = (found.map(|(map, _)| *map), found.map(|(_, off)| *off));
    let uncertainty = matches!(varied, Varied::Number(_)).then_some(Uncertainty::Extrapolation(error));
    Ok(Route { name: RouteName::Variational, map, own: Own::default(), uncertainty })
}

/// Returns `(e, f)`: to first order `e dx + f dT` is the distance of the follower from the cam when the corner passes, without the impact
/// on it. If it is negative, the impact comes before the corner.
pub fn border(model: &Model, cam: &Cam, at: &CornerImpact) -> LinearForm {
    Around::new(model, cam, at).border()
}

/// Orbit, with its follower and its machine.
struct Around<'a> {
    follower: &'a Follower,
    at: &'a CornerImpact,
    machine: Machine,
}

impl<'a> Around<'a> {
    fn new(model: &'a Model, cam: &Cam, at: &'a CornerImpact) -> Self {
        let machine = Machine::new(cam.clone(), &model.follower, at.angular_velocity());
        Self { follower: &model.follower, at, machine }
    }

    fn side_map(&self, side: Side, change: &Change) -> SideMap {
        let around = self.go(side, change, false);
        SideMap { a: around.fixed_view::<2, 2>(0, 0).into(), b: around.column(2).into() }
    }

    fn border(&self) -> LinearForm {
        let gap = self.go(self.at.side, &Change::of_period(self.at.cycle.impacts.len()), true);
        (RowVector2::new(gap[(0, 0)], gap[(0, 1)]), gap[(0, 2)])
    }

    /// Derivatives of the deviation with respect to both components of the start and the varied number: over one period, or up to just
    /// before the corner.
    fn go(&self, side: Side, change: &Change, to_corner: bool) -> Matrix2x3<f64> {
        let (flights, last) = self.at.course();
        let mut deviation = Matrix2x3::identity();
        let mut state = self.at.state;
        for (turn, impact) in flights {
            deviation = self.fly(deviation, state, turn, change);
            if to_corner && impact == self.at.impact {
                return deviation;
            }
            deviation = self.hit(deviation, impact, side, change);
            state = self.at.cycle.flight(&self.machine, impact).0;
        }
        self.fly(deviation, state, last, change)
    }

    fn fly(&self, deviation: Matrix2x3<f64>, start: State, turn: f64, change: &Change) -> Matrix2x3<f64> {
        // Half a revolution is half a period to the last digit.
        let part = turn / std::f64::consts::TAU;
        let time = part * self.at.period;
        let flight = self.machine.flight();
        let mut after = flight.propagator(time) * deviation;
        let (_, end) = flight.fly(start, time);
        let later = Vector2::new(end.velocity, flight.acceleration(end)) * (part * change.period);
        let other = if change.flies_differently() { self.differ(start, time, change) } else { Vector2::zeros() };
        let by = after.column(2) + later + other;
        after.set_column(2, &by);
        after
    }

    /// Derivative `dy` at the end of a flight: `exp` of `[[M, M_p, f_p], [0, M, f], [0, 0, 0]] t`, applied to `(0, y, 1)`.
    fn differ(&self, start: State, time: f64, change: &Change) -> Vector2<f64> {
        let Follower { mass, damping, stiffness, gravity, rest_position, .. } = *self.follower;
        let matrix = Matrix2::new(0.0, 1.0, -stiffness / mass, -damping / mass);
        let force = Vector2::new(0.0, stiffness * rest_position / mass - gravity);
        let mut whole = SMatrix::<f64, 5, 5>::zeros();
        whole.fixed_view_mut::<2, 2>(0, 0).copy_from(&matrix);
        whole.fixed_view_mut::<2, 2>(0, 2).copy_from(&change.matrix);
        whole.fixed_view_mut::<2, 1>(0, 4).copy_from(&change.force);
        whole.fixed_view_mut::<2, 2>(2, 2).copy_from(&matrix);
        whole.fixed_view_mut::<2, 1>(2, 4).copy_from(&force);
        let end = (whole * time).exp() * SMatrix::<f64, 5, 1>::from([0.0, 0.0, start.position, start.velocity, 1.0]);
        end.fixed_rows::<2>(0).into()
    }

    fn hit(&self, deviation: Matrix2x3<f64>, impact: usize, side: Side, change: &Change) -> Matrix2x3<f64> {
        let omega = self.at.angular_velocity();
        let lift = self.at.lift(&self.machine, impact, side);
        let rates = ImpactRates {
            cam_velocity: omega * lift.slope,
            cam_acceleration: omega * omega * lift.curvature,
            ..self.at.cycle.rates(&self.machine, impact)
        };
        let (r, v, velocity) = (rates.restitution, rates.velocity_before, rates.cam_velocity);
        let LiftChange { value, slope } = change.lifts[impact];
        // A cam that has risen by c_p acts like a gap reduced by c_p.
        let mut gap = deviation;
        gap[(0, 2)] -= value;
        let mut after = rates.saltation() * gap;
        // eq:ftaylormapcornerT, contribution of the impact if T varies: -R dy/dT, dy/dT = (0, -c'/T) at the corner
        let faster = omega * slope - velocity * change.period / self.at.period;
        after[(0, 2)] += value;
        after[(1, 2)] += (1.0 + r) * faster + change.restitution * (velocity - v);
        after
    }
}
