//! Impact map over a box of impacts and speeds: the next impact is enclosed with its derivatives, and proved to be the first.
//!
//! An impact is given by the cam angle theta and the velocity u after it relative to the cam, above 0. For a flight from there,
//!
//! ```text
//! g(t)  = c(theta) + v s(t) + f p(t) - c(theta + omega t)        v = omega c'(theta) + u, f the force at c(theta)
//! g'(t) = v s'(t) + f s(t) - omega c'(theta + omega t)
//! ```
//!
//! the next impact is at the first t > 0 with g = 0, and leaves with `u = -r g'(t)`. Newton's method on intervals finds it over the whole
//! box at once, with g' < 0. So it is transversal, and its time is a Lipschitz function on the box. A proof for each part of the flight
//! excludes earlier impacts: near the launch by u, near the landing by g' < 0, between them by the Taylor sum about the middle of the part.
//! At corners c'' is the hull of both sides.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use serde::Serialize;

use crate::cam::{Lift, Segment};
use crate::interval::Interval;
use crate::interval::mean_value_form::MeanValueForm;
use crate::interval::roots::falls_to_zero;
use crate::simulate::{Event, EventKind, Machine};

/// Number over a box of two coordinates and the speed.
pub(super) type Over<'a> = MeanValueForm<'a, 3>;

/// Reason why nothing is proved about a flight.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum UnprovedFlight {
    /// Follower that may stay on the cam, or may not return to it within the limit.
    NoImpact,
    /// Next impact that may be a graze, or may not be the same one over the whole box.
    NotTransversal,
    /// Follower that may meet the cam earlier.
    NotFirst,
}

named!(UnprovedFlight);

/// Longest flight, turns of the cam.
const MOST_TURNS: u64 = 20;

/// Impact, over a box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Impact<'a> {
    /// Angle theta, rad, less the turns.
    pub angle: Over<'a>,
    /// Velocity u, m/s.
    pub velocity: Over<'a>,
    /// Turns of the cam.
    pub turns: i64,
}

/// Lift and slope at an angle, and an enclosure of the curvature. `over` encloses all three over a range of angles.
fn lift_of<'a>(angle: Over<'a>, over: impl Fn(Interval) -> Lift<Interval>) -> ([Over<'a>; 2], Interval) {
    let (whole, centre) = (over(angle.value()), over(angle.centre));
    let lift = angle.of(centre.value, whole.value, whole.slope);
    ([lift, angle.of(centre.slope, whole.slope, whole.curvature)], whole.curvature)
}

/// Follower and cam at some time of a flight.
struct Gap<'a> {
    /// Angle theta + omega t.
    angle: Over<'a>,
    /// Gap g.
    value: Over<'a>,
    /// Rate g' of the gap.
    rate: Over<'a>,
    /// Velocity of the follower.
    velocity: Over<'a>,
    /// Enclosure of g''.
    bend: Interval,
}

/// Impact map of a machine over a range of speeds.
#[derive(Debug)]
pub struct ImpactMap<'a> {
    machine: &'a Machine,
    /// Segments of the cam that begin at a corner of velocity.
    sharp: Vec<usize>,
}

/// Flight from an impact.
struct Launch<'a, 'b> {
    map: &'b ImpactMap<'b>,
    angle: Over<'a>,
    omega: Over<'a>,
    lift: Over<'a>,
    velocity: Over<'a>,
    force: Over<'a>,
}

impl<'a> ImpactMap<'a> {
    /// Builds the impact map of a machine, at any speed.
    pub fn new(machine: &'a Machine) -> Self {
        let corners = machine.cam().corners();
        let sharp = corners.iter().filter(|corner| corner.jump_order == 1).map(|corner| corner.segment).collect();
        Self { machine, sharp }
    }

    /// Lift and slope of the cam at an angle, and an enclosure of the curvature.
    fn lift<'b>(&self, angle: Over<'b>) -> ([Over<'b>; 2], Interval) {
        let over = |angles: Interval| -> Lift<Interval> { self.machine.cam().lift_over(angles, &self.sharp) };
        lift_of(angle, over)
    }

    /// Returns the impact that follows `from`, at the cam's speed, rad/s.
    pub(super) fn next<'b>(&self, from: &Impact<'b>, omega: Over<'b>) -> Result<Impact<'b>, UnprovedFlight> {
        if !from.velocity.value().is_positive() {
            return Err(UnprovedFlight::NoImpact);
        }
        let landing = self.land(from, &self.launch(from, omega))?;
        let turns = (landing.angle.centre.middle() / TAU).floor();
        Ok(Impact {
            angle: landing.angle + -(Interval::TURN * turns),
            // u = -r g'
            velocity: landing.rate * Interval::from(-self.machine.restitution()),
            turns: from.turns + turns as i64,
        })
    }

    /// Derivative of the impact map with respect to the angle and the follower's velocity before an impact, in the same coordinates of the
    /// next impact, by rows. It is enclosed over a rectangle of angles, rad, on one segment of the cam, and velocities after the impact
    /// relative to the cam, m/s.
    ///
    /// The next impact is where g = 0, and neither its angle nor the follower's velocity there depends on c''. So at a corner this
    /// derivative jumps only with the angle at which the flight begins, and each segment has its own.
    pub(super) fn derivative_before(
        &self,
        segment: &Segment,
        place: [Interval; 2],
        omega: Interval,
    ) -> Result<[[Interval; 2]; 2], UnprovedFlight> {
        let restitution = Interval::from(self.machine.restitution());
        // v- = c' - u/r
        let before = omega * segment.law.lift_over(place[0]).slope - place[1] / restitution;
        let place = [place[0], before, omega];
        let centre = place.map(|side| Interval::from(side.middle()));
        let over = std::array::from_fn(|side| place[side] - centre[side]);
        let [angle, before, omega] = std::array::from_fn(|side| MeanValueForm::unknown(side, centre[side], &over));
        let ([lift, slope], _) = lift_of(angle, |angles| segment.law.lift_over(angles));
        let velocity = (omega * slope - before) * restitution;
        let from = Impact { angle, velocity, turns: 0 };
        if !velocity.value().is_positive() {
            return Err(UnprovedFlight::NoImpact);
        }
        let landing = self.land(&from, &self.launched(&from, omega, [lift, slope]))?;
        Ok([landing.angle, landing.velocity].map(|row| [row.whole.by[0], row.whole.by[1]]))
    }

    /// Returns the gap at the first impact, which is proved to be first and transversal.
    fn land<'b>(&self, from: &Impact<'b>, launch: &Launch<'b, '_>) -> Result<Gap<'b>, UnprovedFlight> {
        let guess = self.guess(from, launch.omega).ok_or(UnprovedFlight::NoImpact)?;
        let time = launch.landing(guess)?;
        if !launch.is_first(time.value(), from.velocity.value()) {
            return Err(UnprovedFlight::NotFirst);
        }
        Ok(launch.gap(time))
    }

    fn launch<'b, 'c>(&'c self, from: &Impact<'b>, omega: Over<'b>) -> Launch<'b, 'c> {
        let (lift, _) = self.lift(from.angle);
        self.launched(from, omega, lift)
    }

    fn launched<'b, 'c>(&'c self, from: &Impact<'b>, omega: Over<'b>, [lift, slope]: [Over<'b>; 2]) -> Launch<'b, 'c> {
        let spring = -self.machine.flight().omega0_squared();
        let force = |lift: Interval| self.machine.flight().force(lift);
        Launch {
            map: self,
            angle: from.angle,
            omega,
            lift,
            velocity: omega * slope + from.velocity,
            force: lift.of(force(lift.centre), force(lift.value()), spring.into()),
        }
    }

    /// Encloses every angle and velocity of the next impact if flights of the box may graze the cam. Each rectangle belongs to a part of
    /// time in which the gap may reach 0. A graze does not change the motion, so both the touch and the impact after it are included.
    ///
    /// `shortest`, s, is the limit below which no part is halved. A velocity of 0 in the box must be one with which the follower leaves the
    /// cam.
    pub(super) fn contacts<'b>(
        &self,
        from: &Impact<'b>,
        omega: Over<'b>,
        shortest: f64,
    ) -> Result<Vec<[Interval; 2]>, UnprovedFlight> {
        /// First step of a flight, in units of the shortest step.
        const STEPS: f64 = 64.0;
        // Values below 0 result from rounding: cells have none.
        let velocity = from.velocity.value();
        let velocity = Interval::new(velocity.low().max(0.0), velocity.high());
        let launch = self.launch(from, omega);
        let most = MOST_TURNS as f64 * TAU / omega.centre.middle();
        let mut found = Vec::new();
        let (mut time, mut step) = (0.0, STEPS * shortest);
        while time < most {
            let times = Interval::new(time, time + step);
            let whole = launch.over(times);
            // g = t (u + t/2 g''(...)) is above 0 for u = 0 as well, if g'' is.
            let is_clear = if time == 0.0 {
                whole.bend.is_positive() || Launch::leaves(times, &whole, velocity)
            } else {
                launch.is_clear(times, &whole)
            };
            if is_clear {
                (time, step) = (times.high(), 1.5 * step);
                continue;
            }
            if step > shortest {
                step *= 0.5;
                continue;
            }
            if time == 0.0 {
                return Err(UnprovedFlight::NoImpact);
            }
            let away = times - times.middle();
            let middle = launch.over(times.middle().into());
            let rate = (middle.rate.value() + away * whole.bend).and(whole.rate.value());
            // The gap falls to 0 from above.
            if rate.low() <= 0.0 {
                // u = -r g'
                let after = rate * Interval::from(-self.machine.restitution());
                found.push([whole.angle.value(), Interval::new(after.low().max(0.0), after.high())]);
                if launch.over(times.high().into()).value.value().is_negative() {
                    return Ok(found);
                }
            }
            time = times.high();
        }
        Err(UnprovedFlight::NoImpact)
    }

    /// Simulated time to the next impact from the box's centre, s: the guess from which the proof starts.
    fn guess(&self, from: &Impact<'_>, omega: Over<'_>) -> Option<f64> {
        let omega = omega.centre.middle();
        let machine = self.machine.at_speed(omega);
        let angle = from.angle.centre.middle();
        let mut motion = machine.start_on_cam(angle, from.velocity.centre.middle()).ok()?;
        let mut turned = None;
        let goal = motion.after(MOST_TURNS);
        let mut first = |event: &Event| {
            turned = (event.kind == EventKind::Impact).then(|| event.turned_since(angle));
            ControlFlow::Break(())
        };
        let _ = machine.advance(&mut motion, goal, &mut first).ok()?;
        turned.map(|turned| turned / omega)
    }
}

impl<'a> Launch<'a, '_> {
    fn gap(&self, time: Over<'a>) -> Gap<'a> {
        let flight = self.map.machine.flight();
        let whole = flight.response_over(time.value());
        let centre = if time.centre == time.value() { whole } else { flight.response_over(time.centre) };
        let (damping, spring) = (2.0 * flight.zeta(), flight.omega0_squared());
        let step = time.of(centre.step, whole.step, whole.impulse);
        let impulse = time.of(centre.impulse, whole.impulse, whole.impulse_rate);
        // s'' = -2 zeta s' - w0^2 s
        let bend = -(whole.impulse_rate * damping + whole.impulse * spring);
        let impulse_rate = time.of(centre.impulse_rate, whole.impulse_rate, bend);
        let angle = self.angle + self.omega * time;
        let ([lift, slope], curvature) = self.map.lift(angle);
        let displacement = self.velocity * impulse + self.force * step;
        let velocity = self.velocity * impulse_rate + self.force * impulse;
        // q'' = f - w0^2 (q - q0) - 2 zeta q'
        let acceleration = self.force.value() - displacement.value() * spring - velocity.value() * damping;
        Gap {
            angle,
            value: displacement - (lift - self.lift),
            rate: velocity - self.omega * slope,
            velocity,
            bend: acceleration - self.omega.value().squared() * curvature,
        }
    }

    fn over(&self, times: Interval) -> Gap<'a> {
        self.gap(self.angle.fixed(times))
    }

    /// Encloses the time of the impact near a guess, s, over the whole box, with its derivatives.
    fn landing(&self, guess: f64) -> Result<Over<'a>, UnprovedFlight> {
        let at_centre = |times| {
            let gap = self.over(times);
            [gap.value.centre, gap.rate.centre]
        };
        let all_over = |times| {
            let gap = self.over(times);
            [gap.value.value(), gap.rate.value()]
        };
        let centre = falls_to_zero(guess, at_centre).ok_or(UnprovedFlight::NotTransversal)?;
        let whole = falls_to_zero(guess, all_over).ok_or(UnprovedFlight::NotTransversal)?;
        let gap = self.over(whole);
        // dt = -dg/g'
        let by = gap.value.whole.by.map(|by| -(by / gap.rate.value()));
        Ok(gap.value.solved(centre, whole, by))
    }

    /// Whether the gap is above 0 after the launch, with a velocity, over a part of the flight that begins there.
    fn leaves(times: Interval, whole: &Gap<'_>, velocity: Interval) -> bool {
        // g = t (u + t/2 g''(...))
        (velocity + times * whole.bend.half()).is_positive()
    }

    /// Whether the gap is above 0 over a whole part.
    fn is_clear(&self, times: Interval, whole: &Gap<'_>) -> bool {
        // g(m + x) = g(m) + x g'(m) + x^2/2 g''(...)
        whole.value.value().is_positive() || {
            let away = times - times.middle();
            let Gap { value, rate, .. } = self.over(times.middle().into());
            (value.value() + away * rate.value() + away.squared().half() * whole.bend).is_positive()
        }
    }

    /// Whether the gap is above 0 between the launch, with a velocity, and the landing at a time.
    fn is_first(&self, landing: Interval, velocity: Interval) -> bool {
        /// First step, as a part of the flight, and the length below which the proof fails.
        const STEP: f64 = 0.125;
        const SHORTEST: f64 = 1.0 / 8192.0;
        let end = landing.low();
        if !(end > 0.0) {
            return false;
        }
        let (mut time, mut step) = (0.0, STEP * end);
        while time < end {
            let times = Interval::new(time, end.min(time + step));
            // Up to the first landing of the box's starts: from there on each gap falls to 0, as Newton's method has shown.
            let is_last = times.high() == end;
            let whole = self.over(times);
            let is_clear = if times.low() == 0.0 {
                Self::leaves(times, &whole, velocity)
            } else if is_last {
                let away = times - times.middle();
                whole.rate.value().is_negative()
                    || (self.over(times.middle().into()).rate.value() + away * whole.bend).is_negative()
            } else {
                self.is_clear(times, &whole)
            };
            if is_clear {
                (time, step) = (times.high(), 1.5 * step);
            } else if step < SHORTEST * end {
                return false;
            } else {
                step *= 0.5;
            }
        }
        true
    }
}
