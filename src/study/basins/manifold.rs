//! The stable and unstable manifolds of a saddle orbit on a section.
//!
//! Next to the saddle both curves are straight, along the eigenvectors of its matrix. The map carries a stretch of the unstable manifold,
//! from a point to its image, on and on; the inverse of the map does so for the stable manifold. The inverse is a run backwards in time,
//! in which an impact multiplies the relative velocity by `-1/r`.

use std::f64::consts::TAU;

use nalgebra::{Matrix2, Vector2};

use crate::elementary;
use crate::flight::State;
use crate::model::Follower;
use crate::orbit::cycle::lift_size;
use crate::orbit::{Cycle, eigenvalues};
use crate::section::StroboscopicMap;
use crate::simulate::{EventKind, Machine};
use crate::tolerance;

/// An orbit of one revolution with one real multiplier inside and one outside the unit circle, both positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Saddle {
    /// State where the orbit crosses the section.
    pub state: State,
    /// The multiplier below 1, and its direction: position, m, and velocity, m/s.
    pub stable: (f64, Vector2<f64>),
    /// The multiplier above 1, and its direction.
    pub unstable: (f64, Vector2<f64>),
}

impl Saddle {
    /// Builds the saddle of a cycle of one revolution at `cam_angle`, rad, in `[0, 2 pi)`; `None` if the cycle is not a saddle.
    pub fn new(machine: &Machine, cycle: &Cycle, cam_angle: f64) -> Option<Self> {
        let (state, matrix) = cycle.at_section(machine, cam_angle);
        let [above, below] = eigenvalues(&matrix);
        // The product of the multipliers is 1 at most: if one is above 1, both are real and the other is below 1.
        if !(above.re > 1.0 && below.re > 0.0 && cycle.revolutions == 1) {
            return None;
        }
        // Lengths are compared with velocities over omega, in m/rad.
        let omega = machine.angular_velocity();
        let along = |multiplier: f64| (multiplier, direction(&matrix, multiplier, omega));
        Some(Self { state, stable: along(below.re), unstable: along(above.re) })
    }
}

/// Returns the eigenvector of a 2x2 matrix, of length 1 with the velocity over omega.
fn direction(matrix: &Matrix2<f64>, multiplier: f64, omega: f64) -> Vector2<f64> {
    // (A - lambda) x = 0, by the longer row.
    let rows = [
        Vector2::new(matrix[(0, 1)], multiplier - matrix[(0, 0)]),
        Vector2::new(multiplier - matrix[(1, 1)], matrix[(1, 0)]),
    ];
    let size = |row: &Vector2<f64>| elementary::hypot(row[0], row[1] / omega);
    let longer = if size(&rows[0]) >= size(&rows[1]) { rows[0] } else { rows[1] };
    longer / size(&longer)
}

/// The inverse of the stroboscopic map of a cam that is its own mirror image.
#[derive(Clone, Debug)]
pub struct Reversed {
    map: StroboscopicMap,
    backwards: StroboscopicMap,
}

impl Reversed {
    /// Builds the inverse of the map of `follower`. `None` if the cam is not its own mirror image, `c(2 pi - theta) = c(theta)`.
    /// Also `None` if r = 0: such an impact cannot be inverted.
    pub fn new(follower: &Follower, map: &StroboscopicMap) -> Option<Self> {
        /// Angles at which the lift is compared with its mirror image.
        const LOOKED_AT: u32 = 720;
        let (cam, size) = (map.machine.cam(), lift_size(&map.machine));
        let mirrored = |index: u32| {
            let angle = TAU * f64::from(index) / f64::from(LOOKED_AT);
            let (here, there) = (cam.lift(angle), cam.lift((TAU - angle) % TAU));
            (here.value - there.value).abs() <= tolerance::CAM_CLOSURE.value * size
        };
        if !(follower.restitution > 0.0 && (1..LOOKED_AT).all(mirrored)) {
            return None;
        }
        // t -> -t: the mirrored cam turns on, the damping drives the follower, and an impact gives 1/r.
        let restitution = 1.0 / follower.restitution;
        let follower = Follower { damping: -follower.damping, restitution, ..*follower };
        let machine = Machine::new(cam.clone(), &follower, map.machine.angular_velocity());
        let cam_angle = if map.cam_angle == 0.0 { 0.0 } else { TAU - map.cam_angle };
        Some(Self { map: map.clone(), backwards: StroboscopicMap { machine, cam_angle } })
    }

    /// Returns the state one revolution before `state`. `None` if no state leads there, or only one that begins or ceases to stick on the
    /// way. The result of the run backwards is checked by a run forwards.
    pub fn apply(&self, state: State) -> Option<State> {
        let turned = |state: State| State { velocity: -state.velocity, ..state };
        let back = self.backwards.apply(turned(state)).ok()?;
        let before = turned(back.state);
        let again = self.map.apply(before).ok()?;
        let sticks = again.events.iter().chain(&back.events).any(|event| event.kind != EventKind::Impact);
        let size = size(before, self.map.machine.angular_velocity());
        let miss = again.state.apart(state, self.map.machine.angular_velocity());
        (!sticks && miss <= tolerance::ORBIT_CLOSURE.value * size).then_some(before)
    }
}

/// Size of a state, m, with the velocity over omega.
fn size(state: State, omega: f64) -> f64 {
    elementary::hypot(state.position, state.velocity / omega)
}

/// Length and resolution of a curve that is followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// Number of times that the first stretch is carried on.
    pub stretches: u32,
    /// Distance from the saddle, m, at which the first stretch begins. There the curve's bend is of the order of its square.
    pub first: f64,
    /// Largest distance between neighbouring points, m.
    pub finest: f64,
    /// Largest distance from the saddle, m, to which a curve is followed.
    pub farthest: f64,
}

impl Extent {
    /// Suits a picture, or a part of the section, of this size, m.
    pub fn of(size: f64) -> Self {
        Self { stretches: 40, first: 1e-7 * size, finest: 1e-3 * size, farthest: 2.0 * size }
    }
}

/// A curve on the section, as a polyline that may be broken into pieces.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// The pieces, each as states in order.
    pub pieces: Vec<Vec<State>>,
    omega: f64,
    /// Largest distance between neighbours in a piece, m.
    finest: f64,
}

impl Curve {
    /// Follows one half of the saddle's unstable manifold: along the saddle's direction, or against it if `sign` is -1.
    pub fn unstable(map: &StroboscopicMap, saddle: &Saddle, sign: f64, extent: &Extent) -> Self {
        let (multiplier, along) = saddle.unstable;
        let carry = |state| map.apply(state).ok().map(|end| end.state);
        Self::grow(saddle.state, sign * along, multiplier, carry, extent, map.machine.angular_velocity())
    }

    /// Follows one half of the saddle's stable manifold.
    pub fn stable(reversed: &Reversed, saddle: &Saddle, sign: f64, extent: &Extent) -> Self {
        let (multiplier, along) = saddle.stable;
        let carry = |state| reversed.apply(state);
        let omega = reversed.map.machine.angular_velocity();
        Self::grow(saddle.state, sign * along, 1.0 / multiplier, carry, extent, omega)
    }

    /// Maps a stretch near the saddle on and on. A number s from 0 to `stretches` gives the image under `floor(s)` maps of the point
    /// `first * multiplier^fract(s)` from the saddle. Steps in s are halved until neighbouring images are close.
    fn grow(
        saddle: State,
        along: Vector2<f64>,
        multiplier: f64,
        carry: impl Fn(State) -> Option<State>,
        extent: &Extent,
        omega: f64,
    ) -> Self {
        /// Initial number of points in one stretch.
        const POINTS: u32 = 16;
        /// Halvings after which two neighbours that are still apart are on either side of a break.
        const HALVINGS: u32 = 16;
        let at = |s: f64| -> Option<State> {
            let from = extent.first * elementary::powf(multiplier, s.fract());
            let first =
                State { position: saddle.position + from * along[0], velocity: saddle.velocity + from * along[1] };
            let carried = (0..s as u32).try_fold(first, |state, _| carry(state))?;
            (carried.apart(saddle, omega) <= extent.farthest).then_some(carried)
        };
        let mut curve = Self { pieces: vec![vec![saddle]], omega, finest: extent.finest.max(extent.first) };
        let total = extent.stretches * POINTS;
        let place = |index: u32| f64::from(index) / f64::from(POINTS);
        let mut last = (0.0, at(0.0));
        curve.push(last.1);
        for index in 1..total {
            // The values of s still to be reached, the next on top.
            let mut ahead = vec![(place(index), at(place(index)), 0)];
            while let Some((s, state, halvings)) = ahead.pop() {
                let close = match (last.1, state) {
                    (Some(one), Some(two)) => one.apart(two, omega) <= extent.finest,
                    (None, None) => true,
                    _ => false,
                };
                if !close && halvings < HALVINGS {
                    let middle = 0.5 * (last.0 + s);
                    ahead.push((s, state, halvings + 1));
                    ahead.push((middle, at(middle), halvings + 1));
                    continue;
                }
                if !close {
                    curve.pieces.push(Vec::new());
                }
                curve.push(state);
                last = (s, state);
            }
        }
        curve.pieces.retain(|piece| !piece.is_empty());
        curve
    }

    fn push(&mut self, state: Option<State>) {
        if let (Some(state), Some(piece)) = (state, self.pieces.last_mut()) {
            piece.push(state);
        }
    }

    /// Points of the curve.
    pub fn points(&self) -> impl Iterator<Item = State> {
        self.pieces.iter().flatten().copied()
    }

    /// Bounding rectangle of the curve.
    pub fn bounds(&self) -> SectionBounds {
        let none = [f64::INFINITY, f64::NEG_INFINITY];
        let join = |[low, high]: [f64; 2], value: f64| [low.min(value), high.max(value)];
        let bounds = SectionBounds { positions: none, scaled_velocities: none, omega: self.omega };
        self.points().fold(bounds, |bounds, state| SectionBounds {
            positions: join(bounds.positions, state.position),
            scaled_velocities: join(bounds.scaled_velocities, state.velocity / self.omega),
            ..bounds
        })
    }

    /// Distance of a state from the curve, m.
    pub fn distance(&self, state: State) -> f64 {
        self.distance_below(f64::INFINITY, state)
    }

    /// Distance of a state from the curve, m, or `limit` if the distance is not below it.
    pub fn distance_below(&self, limit: f64, state: State) -> f64 {
        let flat = |state: &State| Vector2::new(state.position, state.velocity / self.omega);
        let point = flat(&state);
        self.pieces.iter().fold(limit, |mut nearest, piece| {
            let mut index = 0;
            while let Some(start) = piece.get(index).map(flat) {
                let away = (point - start).norm();
                nearest = nearest.min(away);
                // Neighbours are no farther apart than `finest`: points that cannot be nearer are skipped.
                let passed = (away - nearest) / self.finest;
                if let (true, Some(end)) = (passed < 1.0, piece.get(index + 1).map(flat)) {
                    let along = end - start;
                    let share = ((point - start).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
                    // Two coincident points have no direction.
                    let foot = if share.is_finite() { start + share * along } else { start };
                    nearest = nearest.min((point - foot).norm());
                }
                index = index.saturating_add((passed as usize).max(1));
            }
            nearest
        })
    }
}

/// A rectangle of the section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SectionBounds {
    positions: [f64; 2],
    scaled_velocities: [f64; 2],
    omega: f64,
}

impl SectionBounds {
    /// Distance of a state from the rectangle, m; 0 inside.
    pub fn distance(&self, state: State) -> f64 {
        let beyond = |value: f64, [low, high]: [f64; 2]| (low - value).max(value - high).max(0.0);
        elementary::hypot(
            beyond(state.position, self.positions),
            beyond(state.velocity / self.omega, self.scaled_velocities),
        )
    }
}
