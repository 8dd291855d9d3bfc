//! What the follower and the cam bear at a speed at which they part: impacts, gaps, time off the cam and energy, of what attracts.

use std::f64::consts::TAU;

use serde::Serialize;

use crate::model::{Model, Units};
use crate::orbit::long_run::{Budget, LongRun};
use crate::orbit::runs::LongRuns;
use crate::progress::Unwatched;
use crate::section::trace;
use crate::simulate::{EventKind, Machine, Motion, SimulateError};
use crate::study::survey::{Attractor, Place, Placed, Start, attractors_of};

/// What a load is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Load {
    /// The largest speed of follower and cam against each other at an impact.
    ImpactSpeed,
    /// The largest gap.
    Gap,
    /// The energy that impacts take in a revolution.
    Energy,
    /// The largest force between follower and cam while they touch, but for impacts.
    Force,
}

named!(Load);

impl Load {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::ImpactSpeed, Self::Gap, Self::Energy, Self::Force];

    /// A value in the unit that it is told in as it is inside.
    pub fn inside(self, units: &Units, value: f64) -> f64 {
        if self == Self::Force { units.force.inside(value) } else { value }
    }

    /// A value of the SI in the unit that it is told in; of a force as it is.
    pub fn of_si(self, units: &Units, value: f64) -> f64 {
        match self {
            Self::ImpactSpeed | Self::Gap => units.length.told(value),
            Self::Energy | Self::Force => value,
        }
    }

    /// The unit that it is told in.
    pub fn unit(self, units: &Units) -> String {
        match self {
            Self::ImpactSpeed => units.spelled("m/s"),
            Self::Gap => units.spelled("m"),
            Self::Energy => "J".into(),
            Self::Force => units.force.name().into(),
        }
    }
}

/// The loads of what one machine's runs come to: the largest among several starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loads {
    /// Of which machine.
    pub place: Place,
    /// Of follower and cam against each other at the fastest impact, m/s; 0 without any.
    pub impact_speed: f64,
    /// The largest gap, m.
    pub gap: f64,
    /// The part of the time that the follower is off the cam.
    pub off_cam: f64,
    /// What impacts take in a revolution, J: `sum m (1 - r^2) u^2/2`.
    pub energy: f64,
    /// The largest force while they touch, but for impacts, kg m/s^2 with the model's length.
    pub force: f64,
    /// How far a measured cam may have moved these, in their order; none where nothing is open, or not known.
    pub errors: Option<[f64; 5]>,
}

document!(Loads as it {
    speed_rpm: it.place.rpm,
    value if_any: it.place.value,
    impact_speed_m_s: it.impact_speed,
    gap_m: it.gap,
    off_cam_share: it.off_cam,
    energy_lost_j: it.energy,
    largest_force_n: it.force,
    impact_speed_error_m_s if_any: it.errors.map(|errors| errors[0]),
    gap_error_m if_any: it.errors.map(|errors| errors[1]),
    off_cam_error if_any: it.errors.map(|errors| errors[2]),
    energy_lost_error_j if_any: it.errors.map(|errors| errors[3]),
    largest_force_error_n if_any: it.errors.map(|errors| errors[4]),
});

impl Loads {
    /// Revolutions after a rest before anything is recorded: what follows a rest has forgotten the start, but may rest elsewhere for some time.
    const AFTER_A_REST: u64 = 20;
    /// Revolutions that are recorded.
    pub const RECORD: u64 = 8;
    /// Starts at each speed: on the cam at as many angles, let go as fast as the cam moves there, and at rest at 0.
    pub const STARTS: u32 = 4;
    /// Moments of a revolution at which gap and force are looked at.
    const MOMENTS: u32 = 360;
    /// Moments where one run stands for all that come to its motion: each of them would look at other moments.
    const FINE: u32 = 4 * Self::MOMENTS;

    /// That load.
    pub fn of(&self, load: Load) -> f64 {
        match load {
            Load::ImpactSpeed => self.impact_speed,
            Load::Gap => self.gap,
            Load::Energy => self.energy,
            Load::Force => self.force,
        }
    }

    /// The largest loads of the motions that several starts come to, the usual starts if none are given; and these motions.
    pub fn among(
        model: &Model,
        machine: &Machine,
        given: Option<&[Start]>,
        budget: Budget,
    ) -> Result<(Self, Vec<Attractor>), SimulateError> {
        let usual = |start: u32| {
            let cam_angle = TAU * f64::from(start) / f64::from(Self::STARTS);
            let fast = machine.angular_velocity() * machine.cam().lift(cam_angle).slope.abs();
            Start { cam_angle, follower: Placed::OnCam(if start == 0 { 0.0 } else { fast }) }
        };
        let starts: Vec<Start> = given.map_or_else(|| (0..Self::STARTS).map(usual).collect(), <[_]>::to_vec);
        let runs = LongRuns::unaided(machine, budget);
        let start = |index: usize| starts[index].motion(machine).map(Some);
        let found = attractors_of(&runs, starts.len(), start, &Unwatched).map_err(|(_, error)| error)?;
        let mut worst = Self::NONE;
        for attractor in &found.attractors {
            let mut motion = attractor.motion;
            if let LongRun::Sticking(_) = attractor.ending {
                machine.revolve(&mut motion, Self::AFTER_A_REST)?;
            }
            // As many as one period has, and of what never repeats as many as each of its runs would have.
            let repeats =
                attractor.ending.period().map_or(Self::RECORD * attractor.starts.len() as u64, |(turns, _)| turns);
            let revolutions = repeats.clamp(Self::RECORD, budget.longest.max(Self::RECORD));
            for loads in Self::seen(model, machine, motion, (revolutions, Self::FINE))? {
                worst = worst.or_more(&loads);
            }
        }
        Ok((Self { place: place(machine), ..worst }, found.attractors))
    }

    /// The largest loads of the motions that the usual starts come to, which are not judged.
    pub fn at(model: &Model, machine: &Machine) -> Result<Self, SimulateError> {
        Ok(Self::among(model, machine, None, Budget { record: 0, ..Budget::DESIGN })?.0)
    }

    const NONE: Self = Self {
        place: Place { rpm: 0.0, value: None },
        impact_speed: 0.0,
        gap: 0.0,
        off_cam: 0.0,
        energy: 0.0,
        force: 0.0,
        errors: None,
    };

    /// The numbers, in their order.
    pub fn numbers(&self) -> [f64; 5] {
        [self.impact_speed, self.gap, self.off_cam, self.energy, self.force]
    }

    fn or_more(&self, other: &Self) -> Self {
        Self {
            place: other.place,
            impact_speed: self.impact_speed.max(other.impact_speed),
            gap: self.gap.max(other.gap),
            off_cam: self.off_cam.max(other.off_cam),
            energy: self.energy.max(other.energy),
            force: self.force.max(other.force),
            errors: None,
        }
    }

    /// Of each of so many revolutions of a motion.
    pub fn recorded(
        model: &Model,
        machine: &Machine,
        motion: Motion,
        revolutions: u64,
    ) -> Result<Vec<Self>, SimulateError> {
        Self::seen(model, machine, motion, (revolutions, Self::MOMENTS))
    }

    /// The loads of each of so many revolutions of a motion, looked at so many moments of each.
    fn seen(
        model: &Model,
        machine: &Machine,
        motion: Motion,
        (revolutions, moments): (u64, u32),
    ) -> Result<Vec<Self>, SimulateError> {
        let (follower, units) = (&model.follower, &model.units);
        let (samples, events) = trace(machine, motion, revolutions, moments)?;
        let first = samples.first().map_or(0.0, |sample| sample.turned);
        let mut found = vec![Self { place: place(machine), ..Self::NONE }; revolutions as usize];
        let place = |turned: f64| (((turned - first) / TAU) as usize).min((revolutions as usize).saturating_sub(1));
        for pair in samples.windows(2) {
            let [one, two] = pair else { continue };
            let Some(loads) = found.get_mut(place(one.turned)) else { continue };
            loads.gap = loads.gap.max(one.gap);
            loads.force = loads.force.max(follower.mass * one.pressing);
            loads.off_cam += if one.contact { 0.0 } else { (two.turned - one.turned) / TAU };
        }
        // kg L^2/s^2 of the unit of length L.
        let joule = units.length.inside(units.length.inside(1.0));
        for event in events.iter().filter(|event| event.kind == EventKind::Impact) {
            let Some(loads) = found.get_mut(place(event.turned_since(0.0))) else { continue };
            let speed = (event.velocity_before - event.cam_velocity).abs();
            loads.impact_speed = loads.impact_speed.max(speed);
            loads.energy += joule * 0.5 * follower.mass * (1.0 - follower.restitution.powi(2)) * speed * speed;
        }
        // The first revolution's samples may begin a rounding before it.
        found.iter_mut().for_each(|loads| loads.off_cam = loads.off_cam.min(1.0));
        Ok(found)
    }
}

/// The speed of a machine, as its angular velocity has it.
fn place(machine: &Machine) -> Place {
    Place::of_speed(machine.angular_velocity() / TAU * 60.0)
}
