//! Contact force between cam and follower while they touch, and the speed at which it first reaches zero.
//!
//! On the cam q = c(w t), so the contact force is
//!
//! ```text
//! N(theta, w) = m w^2 c'' + b w c' + k (c - rest_position) + m g
//! ```
//!
//! The follower separates where N would have to be negative, since the cam cannot pull. Zero force does not separate it, as on a dwell on
//! which a slack spring does not press. Values of N within rounding count as 0.
//!
//! This module makes no runs. `speeds` takes the separation speed from here; its runs check whether the follower stays, and tests compare
//! both.

use std::f64::consts::TAU;

use crate::cam::{Bounds, Cam, Least, Lift, Segment, halved};
use crate::model::Follower;
use crate::simulate::angular_velocity;
use crate::tolerance;

/// A cam and the follower on it.
#[derive(Clone, Debug)]
#[doc(hidden)]
pub struct Contact<'a> {
    /// The cam.
    pub cam: &'a Cam,
    /// The follower.
    pub follower: Follower,
    /// Cam angle at which the cam's velocity jumps, rad.
    kink: Option<f64>,
    /// Lowest lifts before which a damper may hold the follower back; none without a damper.
    bottoms: Vec<Bottom>,
}

/// A place of the lowest lift that the follower reaches falling.
#[derive(Clone, Copy, Debug)]
struct Bottom {
    segment: usize,
    /// Cam angle, rad.
    angle: f64,
    /// Order n of `c - c_min = a x^n + ...` at a distance x before it.
    order: usize,
}

/// Separation: the lowest speed at which the follower leaves the cam, if there is such a speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Separation {
    /// Separation at a certain speed and cam angle.
    At {
        /// Speed, rpm.
        rpm: f64,
        /// Rounding error, rpm.
        error: f64,
        /// Cam angle, rad.
        cam_angle: f64,
        /// Uncertainty of the cam angle for a measured cam, rad; none for an exact cam.
        angle_error: Option<f64>,
        /// Whether, on this or another likely cam, spring and weight press at the place with less force than an error of a row changes.
        within_errors: bool,
    },
    /// Separation at any speed, however slow. Here the spring does not press the follower on the cam, or a damper holds back a follower
    /// without load. In some range of higher speeds, inertia may press it on.
    NotPressed {
        /// Cam angle, rad.
        cam_angle: f64,
    },
    /// Separation at any speed, however slow: the cam's velocity jumps here.
    Kink {
        /// Cam angle, rad.
        cam_angle: f64,
    },
    /// No separation at any speed: the cam nowhere accelerates downwards.
    Never,
}

impl Separation {
    /// Name in documents.
    pub fn name(&self) -> &'static str {
        match self {
            Self::At { .. } => "at-a-speed",
            Self::NotPressed { .. } | Self::Kink { .. } => "at-every-speed",
            Self::Never => "never",
        }
    }

    /// Speed up to which the follower stays on the cam, rpm.
    pub fn speed(&self) -> f64 {
        match self {
            Self::At { rpm, .. } => *rpm,
            Self::NotPressed { .. } | Self::Kink { .. } => 0.0,
            Self::Never => f64::INFINITY,
        }
    }

    /// The speed, rpm, if the follower leaves at some speeds and not at others.
    pub fn at_speed(&self) -> Option<f64> {
        Some(self.speed()).filter(|rpm| *rpm > 0.0 && rpm.is_finite())
    }
}

impl<'a> Contact<'a> {
    /// Places a follower on a cam.
    pub fn new(cam: &'a Cam, follower: Follower) -> Self {
        let kink = cam.corners().iter().copied().find(|corner| corner.jump_order == 1).map(|corner| corner.angle);
        let mut contact = Self { cam, follower, kink, bottoms: Vec::new() };
        // Without a damper only inertia can hold the follower back, and inertia does not do so near the lowest lift.
        if follower.damping > 0.0 {
            contact.bottoms = contact.bottoms();
        }
        contact
    }

    /// Force of spring and weight at lift 0.
    fn constant(&self) -> f64 {
        let Follower { mass, stiffness, gravity, rest_position, .. } = self.follower;
        mass * gravity - stiffness * rest_position
    }

    /// Contact force N for this lift at an angular velocity, rad/s; in kg times the model's length over s^2.
    pub fn force(&self, lift: &Lift, omega: f64) -> f64 {
        let [of_lift, of_slope, of_curvature, _] = self.weights(omega);
        of_curvature * lift.curvature + of_slope * lift.slope + of_lift * lift.value + self.constant()
    }

    /// Force of spring and weight on the cam at an angle, rad, in kg times the model's length over s^2.
    pub(super) fn static_force(&self, cam_angle: f64) -> f64 {
        self.force(&self.cam.lift(cam_angle), 0.0)
    }

    /// Coefficients of c, c' and c'' in N.
    fn weights(&self, omega: f64) -> [f64; 4] {
        let Follower { mass, damping, stiffness, .. } = self.follower;
        [stiffness, damping * omega, mass * omega * omega, 0.0]
    }

    /// Least N at a speed, rpm, and its place. A value within rounding is returned as 0.
    pub fn least(&self, rpm: f64) -> Least {
        let omega = angular_velocity(rpm);
        let weights = self.weights(omega);
        // A damper may hold the follower back between two neighbouring sampled angles.
        let before =
            self.bottoms.iter().filter_map(|bottom| self.cam.least_before(bottom.segment, bottom.angle, weights));
        let least =
            before.fold(self.cam.least(weights), |least, found| if found.value < least.value { found } else { least });
        let value = least.value + self.constant();
        let is_rounding = value.abs() <= self.rounding(least.segment, omega);
        Least { value: if is_rounding { 0.0 } else { value }, ..least }
    }

    /// Whether the follower leaves the cam at a speed, rpm: N is negative somewhere, or the velocity of the cam jumps.
    pub fn leaves(&self, rpm: f64) -> bool {
        self.kink.is_some() || self.least(rpm).value < 0.0
    }

    /// Rounding errors of c, c' and c'' on a segment, in their units; their ranges are widened by the same rule.
    fn of_lift(&self, segment: usize) -> [f64; 3] {
        let Bounds { lift, slope, curvature, third } = self.cam.segments()[segment].bounds;
        let [lift, slope, curvature] = [lift, slope, curvature].map(|[low, high]| low.abs().max(high.abs()));
        // The angle is rounded, too, which moves each derivative by a part of the next one.
        let terms = [lift + TAU * slope, slope + TAU * curvature, curvature + TAU * third];
        terms.map(|term| tolerance::RANGE_ROUNDING.value * term)
    }

    /// Rounding errors of N on a segment: of the constant term and of the coefficients of w and w^2.
    fn roundings(&self, segment: usize) -> [f64; 3] {
        let Follower { mass, damping, stiffness, gravity, rest_position, .. } = self.follower;
        let [lift, slope, curvature] = self.of_lift(segment);
        let kept = stiffness * rest_position.abs() + mass * gravity.abs();
        [stiffness * lift + tolerance::RANGE_ROUNDING.value * kept, damping * slope, mass * curvature]
    }

    /// Rounding error of N on a segment at an angular velocity, rad/s.
    fn rounding(&self, segment: usize, omega: f64) -> f64 {
        let [still, linear, square] = self.roundings(segment);
        still + omega * (linear + omega * square)
    }

    /// Largest N at a speed, rpm.
    pub fn largest(&self, rpm: f64) -> f64 {
        self.constant() - self.cam.least(self.weights(angular_velocity(rpm)).map(|weight| -weight)).value
    }

    /// Least angular velocity above `from` beyond which N is negative for this lift on a segment. Returns infinity if rounding leaves no
    /// root.
    ///
    /// ```text
    /// N(from + d) = N(from) + (b c' + 2 m c'' from) d + m c'' d^2
    /// ```
    fn root(&self, segment: usize, lift: &Lift, from: f64) -> f64 {
        let Follower { mass, damping, .. } = self.follower;
        let about = |[still, linear, square]: [f64; 3]| [still, linear + 2.0 * square * from, square];
        let [still, linear, square] = about([self.force(lift, from), damping * lift.slope, mass * lift.curvature]);
        let [_, of_linear, of_square] = about(self.roundings(segment));
        // A root that rounding may have made does not count.
        let beyond = first_root([still + self.rounding(segment, from), linear + of_linear, square + of_square]);
        from + if beyond.is_finite() { first_root([still.max(0.0), linear, square]).min(beyond) } else { beyond }
    }

    /// Places of the lowest lift that the follower reaches falling.
    fn bottoms(&self) -> Vec<Bottom> {
        let lowest = self.cam.lowest();
        let is_lowest = |(index, segment): &(usize, &Segment)| {
            segment.law.lift(segment.end).value - lowest.value <= self.of_lift(*index)[0]
        };
        let ends =
            self.cam.segments().iter().enumerate().filter(is_lowest).map(|(index, segment)| (index, segment.end));
        let places = ends.chain([(lowest.segment, lowest.angle)]);
        let bottom = |(segment, angle): (usize, f64)| {
            let order = self.cam.segments()[segment].order_at(angle)?;
            Some(Bottom { segment, angle, order })
        };
        places.filter_map(bottom).collect()
    }

    /// Cam angle, rad, at which a follower without load at the lowest lift is held back at any speed, however slow; none if it is not.
    ///
    /// Without a spring, nothing presses the follower on the cam. With a spring, a damper may hold it back on the way down to the lowest
    /// lift:
    ///
    /// ```text
    /// k = 0    N = w (b c' + m w c'')
    /// k > 0    N = a x^(n-2) (k x^2 - n b w x + n (n - 1) m w^2)    negative at some x of the size of w where n b^2 > 4 (n - 1) k m
    /// ```
    fn held_back(&self) -> Option<f64> {
        let Follower { mass, damping, stiffness, .. } = self.follower;
        if stiffness == 0.0 {
            let least = self.cam.least(if damping > 0.0 { [0.0, 1.0, 0.0, 0.0] } else { [0.0, 0.0, 1.0, 0.0] });
            return (least.value < 0.0).then_some(least.angle);
        }
        let holds = |order: usize| {
            let n = order as f64;
            n * damping * damping > 4.0 * (n - 1.0) * stiffness * mass
        };
        self.bottoms.iter().find(|bottom| holds(bottom.order)).map(|bottom| bottom.angle)
    }

    /// Places on the way down to a lowest lift where a damper may hold the follower back, each with the least angular velocity beyond which
    /// N is negative there. They include the place where this velocity is least, and the place where N is least at any velocity. With a
    /// damper and a small load, the first may be nearer to the lowest lift than any sampled angle. With a load that the damper hardly
    /// overcomes, N is negative next to the second alone.
    fn first_before(&self, &Bottom { segment, angle: bottom, .. }: &Bottom, from: f64) -> Vec<(f64, Least)> {
        /// Number of times that a third of the bracket is dropped.
        const THIRDS: usize = 60;
        let way = bottom - self.cam.segments()[segment].start;
        let at = |before: f64| self.place(segment, bottom - before);
        let root = |lift: &Lift| self.root(segment, lift, from);
        let deepest = |lift: &Lift| self.least_force(lift, from);
        let mut places = Vec::new();
        for sought in [&root as &dyn Fn(&Lift) -> f64, &deepest] {
            let sought = |before: f64| sought(&at(before).lift);
            let best = halved(way).min_by(|one, two| sought(*one).total_cmp(&sought(*two))).unwrap_or(way);
            let (mut low, mut high) = (0.5 * best, (2.0 * best).min(way));
            for _ in 0..THIRDS {
                let third = (high - low) / 3.0;
                if sought(low + third) < sought(high - third) {
                    high -= third;
                } else {
                    low += third;
                }
            }
            places.extend([best, low].map(at));
        }
        places.into_iter().map(|place| (root(&place.lift), place)).collect()
    }

    /// Least N for this lift at any angular velocity above `from`, rad/s, where the cam is hollow; infinity elsewhere.
    ///
    /// ```text
    /// dN/dw = 2 m w c'' + b c'
    /// ```
    fn least_force(&self, lift: &Lift, from: f64) -> f64 {
        let Follower { mass, damping, .. } = self.follower;
        let omega = -damping * lift.slope / (2.0 * mass * lift.curvature);
        if lift.curvature > 0.0 { self.force(lift, omega.max(from)) } else { f64::INFINITY }
    }

    fn place(&self, segment: usize, angle: f64) -> Least {
        Least { segment, angle, value: f64::NAN, lift: self.cam.segments()[segment].law.lift(angle) }
    }

    /// Returns where the follower first leaves the cam.
    pub fn separation(&self) -> Separation {
        self.separation_from(0.0)
    }

    /// Returns where the follower first leaves the cam above a speed, rpm. A follower that leaves at a lower speed may be on the cam again,
    /// since inertia presses it on at the lowest lift, and more so at higher speeds.
    pub fn separation_above(&self, rpm: f64) -> Separation {
        let first = self.separation();
        if first.speed() > rpm { first } else { self.separation_from(angular_velocity(rpm)) }
    }

    /// Returns where the follower first leaves the cam above an angular velocity, rad/s.
    ///
    /// Starts from the least root over closely spaced angles. At that speed N is least at some angle, whose own root is a lower speed,
    /// and so on; the error is squared in each step (Dinkelbach 1967).
    fn separation_from(&self, from: f64) -> Separation {
        /// Angles sampled for the first guess.
        const LOOKED: usize = 1440;
        const STEPS: usize = 50;
        if let Some(cam_angle) = self.kink {
            return Separation::Kink { cam_angle };
        }
        let rpm = |omega: f64| omega / TAU * 60.0;
        let pressed = self.least(rpm(from));
        if pressed.value < 0.0 {
            return Separation::NotPressed { cam_angle: pressed.angle };
        }
        if from == 0.0
            && pressed.value == 0.0
            && let Some(cam_angle) = self.held_back()
        {
            return Separation::NotPressed { cam_angle };
        }
        let segments = self.cam.segments().iter().enumerate();
        let ends =
            segments.flat_map(|(index, segment)| [segment.start, segment.end].map(|angle| self.place(index, angle)));
        let between = (0..LOOKED).map(|index| {
            let angle = index as f64 * TAU / LOOKED as f64;
            self.place(self.cam.segment_at(angle), angle)
        });
        let looked = ends.chain(between).map(|place| (self.root(place.segment, &place.lift, from), place));
        let before = self.bottoms.iter().flat_map(|bottom| self.first_before(bottom, from));
        let first = looked.chain(before).min_by(|one, other| one.0.total_cmp(&other.0));
        let Some((mut omega, mut at)) = first.filter(|(omega, _)| omega.is_finite()) else { return Separation::Never };
        for _ in 0..STEPS {
            let here = self.least(rpm(omega));
            let next = self.root(here.segment, &here.lift, from);
            // A dwell, where N may be 0 as well, has no root and is no place of separation.
            if next.is_finite() {
                at = here;
            }
            if !(next < omega) {
                break;
            }
            omega = next;
        }
        // dN/dw = 2 m w c'' + b c'
        let rate = 2.0 * self.follower.mass * omega * at.lift.curvature + self.follower.damping * at.lift.slope;
        let error = rpm(self.rounding(at.segment, omega) / rate.abs()) + tolerance::ULP.value * rpm(omega);
        Separation::At { rpm: rpm(omega), error, cam_angle: at.angle, angle_error: None, within_errors: false }
    }
}

/// Returns the first positive root of `still + linear w + square w^2`, or infinity if there is none.
fn first_root([still, linear, square]: [f64; 3]) -> f64 {
    let root = (linear * linear - 4.0 * square * still).sqrt();
    // Avoids the difference of two numbers of similar size; NaN where the discriminant is negative.
    let omega = 2.0 * still / (root - linear);
    if omega > 0.0 { omega } else { f64::INFINITY }
}
