//! Loads on follower and cam at speeds above separation: impacts, gaps, time off the cam and energy, taken from the attractors.

use std::f64::consts::TAU;

use serde::Serialize;

use crate::model::{Model, Units};
use crate::orbit::long_run::{Budget, LongRun};
use crate::orbit::runs::LongRuns;
use crate::progress::Unwatched;
use crate::section::trace;
use crate::simulate::{EventKind, Machine, Motion, SimulateError};
use crate::study::survey::{Attractor, Place, Placed, Start, attractors_of};
use crate::uncertainty::{SourcedUncertainty, UncertaintyParts};

/// A kind of load.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Load {
    /// Largest relative speed of follower and cam at an impact.
    ImpactSpeed,
    /// Largest gap.
    Gap,
    /// Energy lost in impacts per revolution.
    Energy,
    /// Largest force between follower and cam in contact, without impacts.
    Force,
}

named!(Load);

impl Load {
    /// All loads.
    pub const ALL: [Self; 4] = [Self::ImpactSpeed, Self::Gap, Self::Energy, Self::Force];

    /// Converts a value from the displayed unit to the internal unit.
    pub fn inside(self, units: &Units, value: f64) -> f64 {
        if self == Self::Force { units.force.inside(value) } else { value }
    }

    /// Converts a value from SI to the displayed unit; energies are displayed in SI.
    pub fn of_si(self, units: &Units, value: f64) -> f64 {
        match self {
            Self::ImpactSpeed | Self::Gap => units.length.told(value),
            Self::Energy => value,
            // Internally kg times the unit of length over s^2.
            Self::Force => units.force.told(units.length.told(value)),
        }
    }

    /// Unit in which the load is displayed.
    pub fn unit(self, units: &Units) -> String {
        match self {
            Self::ImpactSpeed => units.spelled("m/s"),
            Self::Gap => units.spelled("m"),
            Self::Energy => "J".into(),
            Self::Force => units.force.name().into(),
        }
    }
}

/// Loads of the motions that one machine's runs converge to: the largest over several starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loads {
    /// The machine's place on the axis.
    pub place: Place,
    /// Relative speed of follower and cam at the fastest impact, m/s; 0 without impacts.
    pub impact_speed: f64,
    /// Largest gap, m.
    pub gap: f64,
    /// Share of the time that the follower is off the cam.
    pub off_cam: f64,
    /// Energy lost in impacts per revolution, J: `sum m (1 - r^2) u^2/2`.
    pub energy: f64,
    /// Largest contact force without impacts, kg m/s^2 with the model's length.
    pub force: f64,
    /// Uncertainties of these numbers, in their order; none if there is no uncertainty or it is unknown.
    pub errors: Option<[SourcedUncertainty; 5]>,
}

document!(Loads as it {
    speed_rpm: it.place.rpm,
    value if_any: it.place.value,
    impact_speed_m_s: it.impact_speed,
    gap_m: it.gap,
    off_cam_share: it.off_cam,
    energy_lost_j: it.energy,
    largest_force_n: it.force,
    impact_speed_error_m_s if_any: it.error(0),
    gap_error_m if_any: it.error(1),
    off_cam_error if_any: it.error(2),
    energy_lost_error_j if_any: it.error(3),
    largest_force_error_n if_any: it.error(4),
    impact_speed_error_parts if_any: it.parts(0, "_m_s"),
    gap_error_parts if_any: it.parts(1, "_m"),
    off_cam_error_parts if_any: it.parts(2, ""),
    energy_lost_error_parts if_any: it.parts(3, "_j"),
    largest_force_error_parts if_any: it.parts(4, "_n"),
});

impl Loads {
    /// Revolutions run after a rest before recording. The start is forgotten then, but the follower may rest elsewhere for some time.
    const AFTER_A_REST: u64 = 20;
    /// Revolutions recorded.
    pub const RECORD: u64 = 8;
    /// Starts at each speed: on the cam at evenly spaced angles, released as fast as the cam moves there; at angle 0 at rest.
    pub const STARTS: u32 = 4;
    /// Moments per revolution at which gap and force are sampled.
    const MOMENTS: u32 = 360;
    /// Moments per revolution where one run represents all that converge to its motion; each of those would sample other moments.
    const FINE: u32 = 4 * Self::MOMENTS;

    /// Index of the share of time off the cam among [`Self::numbers`].
    const OFF_CAM: usize = 2;
    /// Index of the largest force.
    pub(super) const FORCE: usize = 4;

    /// Uncertainty of the number at `index`.
    fn error(&self, index: usize) -> Option<f64> {
        self.errors.map(|errors| errors[index].total())
    }

    /// The range that the uncertainty of the number at `index` leaves; no load is below 0.
    pub fn bounds(&self, index: usize) -> Option<[f64; 2]> {
        let [low, high] = self.errors?[index].around(self.numbers()[index]);
        Some([low.max(0.0), high])
    }

    fn parts(&self, index: usize, unit: &'static str) -> Option<UncertaintyParts> {
        self.errors.map(|errors| UncertaintyParts(errors[index], unit))
    }

    /// Value of a load.
    pub fn of(&self, load: Load) -> f64 {
        match load {
            Load::ImpactSpeed => self.impact_speed,
            Load::Gap => self.gap,
            Load::Energy => self.energy,
            Load::Force => self.force,
        }
    }

    /// Returns the largest loads of the motions that several starts converge to, and these motions. Uses the usual starts if none are
    /// given.
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
            // Records the length of one period; a motion that never repeats gets the record of each of its runs.
            let repeats =
                attractor.ending.period().map_or(Self::RECORD * attractor.starts.len() as u64, |(turns, _)| turns);
            let revolutions = repeats.clamp(Self::RECORD, budget.longest.max(Self::RECORD));
            for loads in Self::seen(model, machine, motion, (revolutions, Self::FINE))? {
                worst = worst.or_more(&loads);
            }
        }
        Ok((Self { place: place(machine), ..worst }, found.attractors))
    }

    /// Returns the largest loads of the motions that the usual starts converge to, without judging these motions.
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

    /// The five loads, in the order of the fields.
    pub fn numbers(&self) -> [f64; 5] {
        [self.impact_speed, self.gap, self.off_cam, self.energy, self.force]
    }

    /// The loads with the uncertainties of these numbers. The follower is off the cam for no more than the whole time.
    pub(super) fn with_errors(self, errors: Option<[SourcedUncertainty; 5]>) -> Self {
        let errors = errors.map(|mut errors| {
            errors[Self::OFF_CAM] = errors[Self::OFF_CAM].at_most(1.0 - self.off_cam);
            errors
        });
        Self { errors, ..self }
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

    /// Loads of each of `revolutions` revolutions of a motion.
    pub fn recorded(
        model: &Model,
        machine: &Machine,
        motion: Motion,
        revolutions: u64,
    ) -> Result<Vec<Self>, SimulateError> {
        Self::seen(model, machine, motion, (revolutions, Self::MOMENTS))
    }

    /// Loads of each of `revolutions` revolutions of a motion, sampled at `moments` moments per revolution.
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
        // The first revolution's samples may begin before it by a rounding error.
        found.iter_mut().for_each(|loads| loads.off_cam = loads.off_cam.min(1.0));
        Ok(found)
    }
}

/// Place of a machine on the speed axis, computed from its angular velocity.
fn place(machine: &Machine) -> Place {
    Place::of_speed(machine.angular_velocity() / TAU * 60.0)
}
