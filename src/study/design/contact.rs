//! The force between cam and follower as long as they touch, and the speed at which it first comes to nothing.
//!
//! On the cam q = c(w t), so that what the cam presses with is
//!
//! ```text
//! N(theta, w) = m w^2 c'' + b w c' + k (c - rest_position) + m g
//! ```
//!
//! No run is made: this is a second route to the detachment that `speeds` finds by runs.

use std::f64::consts::TAU;

use crate::cam::{Cam, Least, Lift};
use crate::model::Follower;
use crate::simulate::angular_velocity;
use crate::tolerance;

/// A cam and the follower on it.
#[derive(Clone, Debug)]
pub struct Contact<'a> {
    /// The cam.
    pub cam: &'a Cam,
    /// The follower.
    pub follower: Follower,
    /// Where the velocity of the cam jumps, rad.
    kink: Option<f64>,
}

/// Where the follower first leaves the cam as the speed rises from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Separation {
    /// At a speed, rpm, with what rounding may put it off by, at a cam angle, rad.
    At {
        /// Speed, rpm.
        rpm: f64,
        /// What rounding may be, rpm.
        error: f64,
        /// Cam angle, rad.
        cam_angle: f64,
        /// What a measured cam leaves open of that, rad; none of another.
        angle_error: Option<f64>,
    },
    /// However slow: the spring does not press it on the cam here.
    NotPressed {
        /// Cam angle, rad.
        cam_angle: f64,
    },
    /// However slow: the cam's velocity jumps here.
    Kink {
        /// Cam angle, rad.
        cam_angle: f64,
    },
    /// At no speed: the cam nowhere accelerates downwards.
    Never,
}

impl Separation {
    /// Its name in documents.
    pub fn name(&self) -> &'static str {
        match self {
            Self::At { .. } => "at-a-speed",
            Self::NotPressed { .. } | Self::Kink { .. } => "at-every-speed",
            Self::Never => "never",
        }
    }

    /// The speed up to which the follower stays on the cam, rpm.
    pub fn speed(&self) -> f64 {
        match self {
            Self::At { rpm, .. } => *rpm,
            Self::NotPressed { .. } | Self::Kink { .. } => 0.0,
            Self::Never => f64::INFINITY,
        }
    }
}

impl<'a> Contact<'a> {
    /// A follower on a cam.
    pub fn new(cam: &'a Cam, follower: Follower) -> Self {
        let kink = cam.corners().iter().copied().find(|corner| corner.jump_order == 1).map(|corner| corner.angle);
        Self { cam, follower, kink }
    }

    /// What the spring and the weight press with where the lift is 0.
    fn constant(&self) -> f64 {
        let Follower { mass, stiffness, gravity, rest_position, .. } = self.follower;
        mass * gravity - stiffness * rest_position
    }

    /// N, kg times the model's length over s^2, where the cam's lift is this, at an angular velocity, rad/s.
    pub fn force(&self, lift: &Lift, omega: f64) -> f64 {
        let [of_lift, of_slope, of_curvature, _] = self.weights(omega);
        of_curvature * lift.curvature + of_slope * lift.slope + of_lift * lift.value + self.constant()
    }

    /// Of c, c' and c'' in N.
    fn weights(&self, omega: f64) -> [f64; 4] {
        let Follower { mass, damping, stiffness, .. } = self.follower;
        [stiffness, damping * omega, mass * omega * omega, 0.0]
    }

    /// Where N is least at a speed, rpm.
    pub fn least(&self, rpm: f64) -> Least {
        let least = self.cam.least(self.weights(angular_velocity(rpm)));
        Least { value: least.value + self.constant(), ..least }
    }

    /// The largest N at a speed, rpm.
    pub fn largest(&self, rpm: f64) -> f64 {
        self.constant() - self.cam.least(self.weights(angular_velocity(rpm)).map(|weight| -weight)).value
    }

    /// The least angular velocity at which N is 0 where the cam's lift is this: the smaller positive root of
    /// `m c'' w^2 + b c' w + (k (c - rest) + m g) = 0`, infinite where there is none.
    fn root(&self, lift: &Lift) -> f64 {
        let Follower { mass, damping, .. } = self.follower;
        let (square, linear, still) = (mass * lift.curvature, damping * lift.slope, self.force(lift, 0.0));
        let root = (linear * linear - 4.0 * square * still).sqrt();
        // Without a difference of two numbers of one size; no number where the discriminant is negative.
        let omega = 2.0 * still / (root - linear);
        if omega > 0.0 { omega } else { f64::INFINITY }
    }

    /// Where the follower first leaves the cam.
    ///
    /// From the least root among angles close by each other: N at that speed is least somewhere, and 0 there at a lower speed yet,
    /// and so on; each step squares what is left (Dinkelbach 1967).
    pub fn separation(&self) -> Separation {
        /// Angles that are looked at first.
        const LOOKED: usize = 1440;
        const STEPS: usize = 50;
        if let Some(cam_angle) = self.kink {
            return Separation::Kink { cam_angle };
        }
        let still = self.least(0.0);
        if still.value <= 0.0 {
            return Separation::NotPressed { cam_angle: still.angle };
        }
        let ends = self
            .cam
            .segments()
            .iter()
            .flat_map(|segment| [segment.law.lift(segment.start), segment.law.lift(segment.end)]);
        let between = (0..LOOKED).map(|index| self.cam.lift(index as f64 * TAU / LOOKED as f64));
        let first = ends.chain(between).map(|lift| self.root(&lift)).fold(f64::INFINITY, f64::min);
        if !first.is_finite() {
            return Separation::Never;
        }
        let rpm = |omega: f64| omega / TAU * 60.0;
        let mut omega = first;
        let mut at = self.least(rpm(omega));
        for _ in 0..STEPS {
            let next = self.root(&at.lift);
            if !(next < omega) {
                break;
            }
            omega = next;
            at = self.least(rpm(omega));
        }
        let [of_lift, of_slope, of_curvature, _] = self.weights(omega).map(f64::abs);
        let Lift { value, slope, curvature, .. } = at.lift;
        let size =
            of_curvature * curvature.abs() + of_slope * slope.abs() + of_lift * value.abs() + self.constant().abs();
        // dN/dw = 2 m w c'' + b c'
        let rate = 2.0 * self.follower.mass * omega * curvature + self.follower.damping * slope;
        let error = rpm(tolerance::ULP.value * size / rate.abs()) + tolerance::ULP.value * rpm(omega);
        Separation::At { rpm: rpm(omega), error, cam_angle: at.angle, angle_error: None }
    }
}
