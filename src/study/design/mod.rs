//! Answers an engineer's questions about a cam and its follower: up to which speed they stay in contact, how hard they press, what happens
//! beyond, and what must be changed.

pub mod contact;
pub mod denser;
pub mod loads;
pub mod needs;

use std::f64::consts::{PI, TAU};

use rayon::prelude::*;
use serde::Serialize;

use super::{ModelLabel, StudyError};
use crate::bracket::{Width, halve};
use crate::cam::{Cam, Least, nearest_turn};
use crate::known::Evidence;
use crate::measured::Measured;
use crate::model::{CORNER_ROUNDING, FollowerErrors, Model, Units};
use crate::orbit::long_run::Budget;
use crate::progress::{Pieces, Watch};
use crate::simulate::{Machine, angular_velocity};
use crate::study::cam::CamGeometry;
use crate::study::survey::{Attractor, Axis, Over, Place, Spacing, Start, Values, VariedNumber};
use crate::tolerance;
use crate::uncertainty::{PlausibleMachines, SourcedUncertainty, UncertaintyParts};
use contact::{Contact, Separation};
use loads::{Load, Loads};
use needs::{Answer, Changed, Lever, Need, UncertainMachine};

/// The document of `design --json`.
#[derive(Clone, Debug)]
pub struct Design {
    /// The model's label.
    pub model: ModelLabel,
    /// Units of the displayed numbers.
    pub units: Units,
    /// Contour of the cam, if its lift follows from one.
    pub geometry: Option<CamGeometry>,
    /// Ratio of the lever between cam and follower, 1 without one. Forces are those on the follower.
    pub lever_ratio: f64,
    /// Where the follower first leaves the cam; the error includes the uncertainty of the machine.
    pub separation: Separation,
    /// Uncertainty of the machine in the separation's speed, rpm, and cam angle, rad; none if the machine is exact.
    pub separation_errors: Option<[SourcedUncertainty; 2]>,
    /// Places where the follower may leave the cam first, if a measured cam leaves open which it is by more than 10 degrees.
    pub places: Vec<SeparationPlace>,
    /// Quality of the measured cam; none for an exact cam.
    pub measured: Option<Measured>,
    /// Standard deviations of the follower's numbers.
    pub errors: FollowerErrors,
    /// The number that varies in the table.
    pub over: VariedNumber,
    /// Least force at each value, in the internal unit.
    pub forces: Vec<ForceAt>,
    /// Force round the cam, if a single speed is asked for.
    pub round: Vec<[f64; 2]>,
    /// Loads of the attractors at values where the follower leaves the cam.
    pub loads: Vec<Loads>,
    /// Forces and loads for a picture, at more values than the table's; none if no picture is asked for.
    pub curves: Option<LoadCurves>,
    /// The attractors that these loads belong to.
    pub attractors: Vec<AttractorsAt>,
    /// Budget of the runs.
    pub budget: Budget,
    /// Where each limit is first exceeded.
    pub limits: Vec<Passed>,
    /// Values that meet each need.
    pub needs: Vec<Answer>,
    /// Effect of rounding the jumps of the acceleration.
    pub rounded: Vec<Rounded>,
    /// Values that meet each need, against another number.
    pub trades: Vec<Trade>,
}

/// Least contact force of one machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceAt {
    /// The machine's place on the axis.
    pub place: Place,
    /// Least force and its place.
    pub least: Least,
    /// Uncertainty of the least force; none if there is none, or if it is unknown.
    pub error: Option<SourcedUncertainty>,
    /// Largest force round the cam.
    pub largest: f64,
}

/// Forces and loads at the values of a picture.
#[derive(Clone, Debug, Default)]
pub struct LoadCurves {
    /// Least force at each value.
    pub forces: Vec<ForceAt>,
    /// Loads at values where the follower leaves the cam. Uncertainties between the values of the table are interpolated.
    pub loads: Vec<Loads>,
    /// Uncertainty of the largest force on the cam at each value of the table.
    pub largest_errors: Vec<(f64, Option<[SourcedUncertainty; 1]>)>,
}

impl LoadCurves {
    /// Returns the largest contact force by rising value, with its uncertainty: of the cam as long as the follower stays on it, else of the
    /// motions, without impacts.
    pub fn greatest_forces(&self) -> Vec<(Place, f64, Option<f64>)> {
        let parted = |place: Place| self.loads.iter().any(|loads| loads.place == place);
        let error = |at: &ForceAt| denser::errors(&self.largest_errors, at.place.across()).map(|[error]| error.total());
        let on_cam = self.forces.iter().filter(|at| !parted(at.place));
        let on_cam = on_cam.map(|at| (at.place, at.largest, error(at)));
        let off_cam =
            self.loads.iter().map(|loads| (loads.place, loads.force, loads.errors.map(|errors| errors[4].total())));
        let mut all: Vec<_> = on_cam.chain(off_cam).collect();
        all.sort_by(|(one, ..), (other, ..)| one.across().total_cmp(&other.across()));
        all
    }
}

document!(ForceAt as it {
    speed_rpm: it.place.rpm,
    value if_any: it.place.value,
    least_n: it.least.value,
    cam_angle_rad: it.least.angle,
    error_n if_any: it.error.map(|error| error.total()),
    error_parts if_any: it.error.map(|error| UncertaintyParts(error, "_n")),
    largest_n: it.largest,
});

/// The motions that the starts of one machine converge to.
#[derive(Clone, Debug)]
#[doc(hidden)]
pub struct AttractorsAt {
    /// The machine's place on the axis.
    pub place: Place,
    /// The motions, in the order of their first starts.
    pub found: Vec<Attractor>,
}

document!(AttractorsAt as it {
    speed_rpm: it.place.rpm,
    value if_any: it.place.value,
    endings: it.found.iter().map(Ended).collect::<Vec<_>>(),
});

struct Ended<'a>(&'a Attractor);

document!(Ended<'_> as it {
    ending: it.0.ending.kind(),
    revolutions if_any: it.0.ending.period().map(|(revolutions, _)| revolutions),
    impacts if_any: it.0.ending.period().map(|(_, impacts)| impacts),
    growth: it.0.ending.growth().value,
    growth_error: it.0.ending.growth().error,
    followed: it.0.followed(),
    starts: it.0.starts.len(),
});

/// A limit set by the user, and where it is first exceeded among the values of the table.
#[derive(Clone, Debug, PartialEq)]
pub struct Passed {
    /// The limited load.
    pub limit: Load,
    /// Limit, in the displayed unit.
    pub value: f64,
    /// Unit of the limit.
    pub unit: String,
    /// Where the limit is first exceeded, located to a thousandth below the first table value that exceeds it. If that is the first value
    /// of the table, it is returned itself. None if no value exceeds the limit.
    pub at: Option<Place>,
}

document!(Passed as it {
    limit: it.limit,
    value: it.value,
    unit: it.unit,
    speed_rpm: it.at.map(|at| at.rpm),
    at if_any: it.at.and_then(|at| at.value),
});

/// The value of one number that meets a need, at one value of another number.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RequiredPair {
    /// Value of the given number.
    pub given: f64,
    /// Value of the number that is found.
    pub found: Option<f64>,
    /// Uncertainty of `found`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<f64>,
    /// Limit on the other side, if there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub other: Option<f64>,
    /// Uncertainty of `other`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub other_error: Option<f64>,
    /// A tried value beyond `other` that meets the need again.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub again: Option<f64>,
}

/// The values of one number that meet a need, for each value of another number.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Trade {
    /// The need, in the user's words.
    pub need: String,
    /// The number that is found.
    pub parameter: Lever,
    /// Unit of the found number.
    pub unit: String,
    /// The number that is given.
    pub against: Lever,
    /// Unit of the given number.
    pub against_unit: String,
    /// Pairs of a given and a found value; the found value is none if no value meets the need.
    pub pairs: Vec<RequiredPair>,
    /// How the values are known, as for the need alone.
    pub known: Evidence,
}

document!(Design as it {
    schema: "corner-impact/design/1",
    model: it.model,
    geometry if_any: it.geometry,
    lever_ratio: it.lever_ratio,
    over if_any: it.over.rpm.map(|_| &it.over.name),
    separation: it.separated(),
    separates: it.separation.name(),
    measured if_any: it.measured,
    uncertain if_any: it.errors.if_any(),
    contact_force: it.forces,
    force_round_the_cam: it.told_round(),
    loads: it.loads,
    loads_known: Evidence::Sampled,
    attractors: it.attractors,
    budget: it.budget,
    limits: it.limits,
    needs: it.needs,
    rounded: it.rounded,
    trades: it.trades,
});

/// Separation and jerk of the machine with the corners of its cam rounded.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Rounded {
    /// Angle of the rounding, degrees.
    pub corner_rounding_deg: f64,
    /// Speed at which the follower first leaves the rounded cam, rpm; none if it leaves at every speed or at none.
    pub separation_rpm: Option<f64>,
    /// Largest absolute value of the jerk, m/rad^3.
    pub jerk: f64,
}

/// Rounds the corners over several angles, as far as the cam allows. Returns nothing if the acceleration has no
/// jump, or if the corners are already rounded.
fn rounded(model: &Model, cam: &Cam) -> Vec<Rounded> {
    /// Angles of the rounding, degrees.
    const ANGLES: [f64; 4] = [1.0, 2.0, 5.0, 10.0];
    let jumps = cam.corners().iter().any(|corner| corner.jump_order == 2);
    let at = |angle: f64| {
        let model = model.with_number(CORNER_ROUNDING, angle).ok()?;
        let cam = Cam::new(&model).ok()?;
        let jerk = |sign: f64| -cam.least([0.0, 0.0, 0.0, sign]).value;
        let speed = Contact::new(&cam, model.follower).separation().speed();
        let separation_rpm = (speed > 0.0 && speed.is_finite()).then_some(speed);
        Some(Rounded { corner_rounding_deg: angle, separation_rpm, jerk: jerk(1.0).max(jerk(-1.0)) })
    };
    if jumps { ANGLES.into_iter().filter_map(at).collect() } else { Vec::new() }
}

/// The questions to be answered by [`design`].
#[derive(Clone, Debug, Default)]
pub struct Asked {
    /// Lowest and highest speed, rpm; if they are equal, the force round the cam is reported. None: a range around the separation.
    pub rpm: Option<[f64; 2]>,
    /// Number that varies in the table instead of the speed, at one fixed speed.
    pub over: Option<Axis>,
    /// Number of speeds in the range.
    pub speeds: u32,
    /// The needs, each with the user's words.
    pub needs: Vec<(String, Need)>,
    /// Limits of loads, in the units of the model.
    pub limits: Vec<(Load, f64)>,
    /// A number with its lowest and highest value in its unit, and how many values.
    pub against: Option<(Lever, [f64; 2], u32)>,
    /// Starts of the table's runs; none for the usual starts.
    pub starts: Option<Vec<Start>>,
    /// Budget of the runs; none for the usual one.
    pub budget: Option<Budget>,
    /// Number of values of the curves in a picture; none if there is no picture.
    pub drawn: Option<usize>,
}

/// A place where the follower may leave a measured cam first.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SeparationPlace {
    /// Cam angles between which likely cams let go here, rad; the second may be of the next turn.
    #[serde(rename = "cam_angles_rad")]
    pub cam_angles: [f64; 2],
    /// Share of the likely cams that let go here first.
    pub share: f64,
    /// Number of likely cams that the share is of.
    pub cams: usize,
}

#[derive(Serialize)]
struct Separated<'a> {
    speed_rpm: f64,
    error_rpm: f64,
    cam_angle_rad: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    error_parts: Option<UncertaintyParts>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cam_angle_error_rad: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cam_angle_error_parts: Option<UncertaintyParts>,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    places: &'a [SeparationPlace],
    located: bool,
}

impl Design {
    fn separated(&self) -> Option<Separated<'_>> {
        match self.separation {
            Separation::At { rpm, error, cam_angle, angle_error } => Some(Separated {
                speed_rpm: rpm,
                error_rpm: error,
                cam_angle_rad: cam_angle,
                error_parts: self.separation_errors.map(|[of_speed, _]| UncertaintyParts(of_speed, "_rpm")),
                cam_angle_error_rad: angle_error,
                cam_angle_error_parts: angle_error
                    .and(self.separation_errors)
                    .map(|[_, of_angle]| UncertaintyParts(of_angle, "_rad")),
                places: &self.places,
                located: true,
            }),
            _ => None,
        }
    }

    fn told_round(&self) -> Vec<RoundEntry> {
        self.round.iter().map(|[angle, force]| RoundEntry { cam_angle_rad: *angle, force_n: *force }).collect()
    }

    /// Returns what a picture of forces and loads shows.
    pub fn load_curves(&self) -> LoadCurves {
        let table =
            || LoadCurves { forces: self.forces.clone(), loads: self.loads.clone(), largest_errors: Vec::new() };
        self.curves.clone().unwrap_or_else(table)
    }

    /// Converts a force to the displayed unit.
    pub fn force(&self, force: f64) -> f64 {
        self.units.force.told(force)
    }
}

#[derive(Serialize)]
struct RoundEntry {
    cam_angle_rad: f64,
    force_n: f64,
}

/// Adds the uncertainty of the machine to a separation's speed and angle, and returns it by its sources; NaN if it is unknown.
#[doc(hidden)]
pub fn known(
    separation: Separation,
    machines: &PlausibleMachines<'_>,
) -> (Separation, Option<[SourcedUncertainty; 2]>) {
    let (Some(machines), Separation::At { rpm, error, cam_angle, .. }) = (machines.uncertain(), separation) else {
        return (separation, None);
    };
    let of = |model: &Model, cam: &Cam| match Contact::new(cam, model.follower).separation() {
        Separation::At { rpm, cam_angle: of_other, .. } => Some([rpm, nearest_turn(of_other, cam_angle)]),
        _ => None,
    };
    let errors = machines.error([rpm, cam_angle], of).unwrap_or([SourcedUncertainty::UNKNOWN; 2]);
    let [open, angle_error] = errors.map(|error| error.total());
    // An angle at a corner of an exact cam stays there.
    let angle_error = Some(angle_error).filter(|error| !(*error <= tolerance::UNCERTAINTY_SEEN.value));
    (Separation::At { rpm, error: error + open, cam_angle, angle_error }, Some(errors))
}

/// Returns the places where likely machines let go first, the likeliest first; none where they agree to 10 degrees.
pub fn separation_places(separation: Separation, machines: &PlausibleMachines<'_>) -> Vec<SeparationPlace> {
    /// Error up to which an angle is one place, and distance from which on two angles are two, rad.
    const ONE: f64 = PI / 18.0;
    let Separation::At { angle_error: Some(error), .. } = separation else { return Vec::new() };
    if !(error > ONE) {
        return Vec::new();
    }
    let of = |model: &Model, cam: &Cam| match Contact::new(cam, model.follower).separation() {
        Separation::At { cam_angle: of_other, .. } => Some(of_other.rem_euclid(TAU)),
        _ => None,
    };
    let mut angles: Vec<f64> = machines.each(of);
    angles.sort_by(f64::total_cmp);
    // A place at angle 0 has some of them at the end of the turn: from the first one that is far from the one before it on.
    let count = angles.len();
    let is_far = |index: &usize| (angles[*index] - angles[(index + count - 1) % count]).rem_euclid(TAU) > ONE;
    let first = (0..count).find(is_far).unwrap_or(0);
    angles.rotate_left(first);
    let turned = count - first;
    angles.iter_mut().skip(turned).for_each(|angle| *angle += TAU);
    let place = |alike: &[f64]| {
        let from = alike[0].rem_euclid(TAU);
        SeparationPlace {
            cam_angles: [from, from + alike[alike.len() - 1] - alike[0]],
            share: alike.len() as f64 / angles.len() as f64,
            cams: angles.len(),
        }
    };
    let mut places: Vec<SeparationPlace> = angles.chunk_by(|one, two| two - one <= ONE).map(place).collect();
    places.sort_by(|one, two| two.share.total_cmp(&one.share));
    places
}

/// Answers the questions about a model; `watch` receives the progress of the runs.
pub fn design(model: &Model, asked: &Asked, watch: &dyn Watch) -> Result<Design, StudyError> {
    /// Moments of the force round the cam, besides the ends of segments.
    const MOMENTS: usize = 720;
    /// Default speed range, as multiples of the separation speed.
    const USUAL: [f64; 2] = [0.5, 1.5];
    let cam = Cam::new(model)?;
    let contact = Contact::new(&cam, model.follower);
    let machines = PlausibleMachines::of(model, &cam)?;
    let (separation, separation_errors) = known(contact.separation(), &machines);
    let places = separation_places(separation, &machines);
    // To meet a need for certain on a measured cam, its speed is raised by the relative uncertainty of the separation.
    let of_cam = match (separation, separation_errors) {
        (Separation::At { rpm, .. }, Some([error, _])) => error.cam / rpm,
        _ => 0.0,
    };
    let uncertain = UncertainMachine { of_cam, machines: machines.uncertain() };
    let range = asked.rpm.or(match separation {
        Separation::At { rpm, .. } => Some(USUAL.map(|part| part * rpm)),
        _ => model.study.map(|study| [study.rpm_min, study.rpm_max]),
    });
    let (over, values): (Over<'_>, Vec<f64>) = match (&asked.over, asked.rpm) {
        (Some(_), Some([low, high])) if low < high => return Err(StudyError::RangeAndNumber { low, high }),
        (Some(axis), rpm) => (Over::new(model, axis.parameter.clone(), rpm.map(|[rpm, _]| rpm))?, axis.values.to_vec()),
        (None, _) => {
            let [low, high] = range.ok_or(StudyError::NoSpeeds)?;
            let speeds = Values::linear(low, high, if low == high { 1 } else { asked.speeds.max(2) as usize });
            (Over::speed(model)?, speeds.all().collect())
        }
    };
    let parts_at = |contact: &Contact<'_>| if over.is_speed() { separation } else { contact.separation() };
    let force_at = |value: &f64, has_error: bool| -> Result<Option<(ForceAt, bool)>, StudyError> {
        let (model, cam) = over.model(*value)?;
        let here = if over.is_speed() { None } else { Some(machines.elsewhere(&model, &cam)) };
        let noisy = here.as_ref().unwrap_or(&machines).uncertain().filter(|_| has_error);
        let (contact, place) = (Contact::new(&cam, model.follower), over.place(*value));
        let parts = parts_at(&contact);
        let is_parted = place.rpm > parts.speed();
        if matches!(parts, Separation::Kink { .. }) {
            return Ok(None);
        }
        let least = contact.least(place.rpm);
        let of = |model: &Model, cam: &Cam| Some([Contact::new(cam, model.follower).least(place.rpm).value]);
        let error = noisy.and_then(|machines| machines.error([least.value], of));
        let largest = contact.largest(place.rpm);
        // On a dwell rounding is the only uncertainty.
        let rounding = tolerance::JET_ROUNDING.value * largest.abs();
        let error = error.map(|[error]| error).filter(|error| error.total() > rounding);
        Ok(Some((ForceAt { place, least, error, largest }, is_parted)))
    };
    let at_each = values.iter().map(|value| force_at(value, true)).collect::<Result<Vec<_>, _>>()?;
    // Where the cam's velocity jumps there is no contact force, and the follower leaves the cam at any speed.
    let parted = values.iter().zip(&at_each).filter(|(_, at)| at.is_none_or(|(_, is_parted)| is_parted));
    let parted: Vec<f64> = parted.map(|(value, _)| *value).collect();
    let round = match (values.as_slice(), at_each.as_slice()) {
        ([rpm], [Some(_)]) if over.is_speed() => round(&contact, *rpm, MOMENTS),
        _ => Vec::new(),
    };
    let pieces = Pieces::new(watch, "what attracts where the follower leaves the cam", parted.len());
    let budget = asked.budget.unwrap_or(Budget::DESIGN);
    // Loads are the same whether the motions are judged or not.
    let unjudged = Budget { record: 0, ..budget };
    let loads_at = |value: f64, budget: Budget| -> Result<(Loads, Vec<Attractor>), StudyError> {
        let (model, machine) = (over.family.model(&[value])?, over.machine(value)?);
        let (loads, found) = Loads::among(&model, &machine, asked.starts.as_deref(), budget)?;
        // As asked for, not as recomputed from the angular velocity.
        Ok((Loads { place: over.place(value), ..loads }, found))
    };
    let with_errors = |value: &f64| -> Result<(Loads, AttractorsAt), StudyError> {
        let (loads, found) = loads_at(*value, budget)?;
        let place = over.place(*value);
        let of = |model: &Model, cam: &Cam| {
            let machine = Machine::new(cam.clone(), &model.follower, angular_velocity(place.rpm));
            Loads::among(model, &machine, asked.starts.as_deref(), unjudged).ok().map(|(loads, _)| loads.numbers())
        };
        let (model, cam) = over.model(*value)?;
        let here = if over.is_speed() { None } else { Some(machines.elsewhere(&model, &cam)) };
        let noisy = here.as_ref().unwrap_or(&machines).uncertain();
        let errors = noisy.and_then(|machines| machines.error(loads.numbers(), of));
        Ok((Loads { errors, ..loads }, AttractorsAt { place, found }))
    };
    let found = parted.par_iter().map(|value| pieces.each(|| with_errors(value))).collect::<Result<Vec<_>, _>>()?;
    let (loads, attractors): (Vec<Loads>, Vec<AttractorsAt>) = found.into_iter().unzip();
    let forces: Vec<ForceAt> = at_each.iter().flatten().map(|(at, _)| *at).collect();
    let spacing = asked.over.as_ref().map_or(Spacing::Linear, |axis| axis.spacing);
    let curves = |count: usize| -> Result<LoadCurves, StudyError> {
        let more = denser::between(&values, spacing, count);
        let known: Vec<_> = forces.iter().map(|at| (at.place.across(), at.error.map(|error| [error]))).collect();
        let known_loads: Vec<_> = loads.iter().map(|loads| (loads.place.across(), loads.errors)).collect();
        let pieces = Pieces::new(watch, "loads between the values of the table", more.len());
        let at = |value: &f64| -> Result<(Option<ForceAt>, Option<Loads>), StudyError> {
            let found = force_at(value, false)?;
            let force = found.map(|(at, _)| ForceAt { error: denser::errors(&known, *value).map(|[it]| it), ..at });
            if found.is_some_and(|(_, is_parted)| !is_parted) {
                return Ok((force, None));
            }
            let loads = loads_at(*value, unjudged)?.0;
            Ok((force, Some(Loads { errors: denser::errors(&known_loads, *value), ..loads })))
        };
        let found: Vec<_> =
            more.par_iter().map(|value| pieces.each(|| at(value))).collect::<Result<Vec<_>, StudyError>>()?;
        let largest_error = |at: &ForceAt| -> Result<(f64, Option<[SourcedUncertainty; 1]>), StudyError> {
            let (value, rpm) = (at.place.across(), at.place.rpm);
            let (model, cam) = over.model(value)?;
            let here = if over.is_speed() { None } else { Some(machines.elsewhere(&model, &cam)) };
            let noisy = here.as_ref().unwrap_or(&machines).uncertain();
            let of = |model: &Model, cam: &Cam| Some([Contact::new(cam, model.follower).largest(rpm)]);
            Ok((value, noisy.and_then(|machines| machines.error([at.largest], of))))
        };
        let largest_errors = forces.iter().map(largest_error).collect::<Result<_, _>>()?;
        let mut curves = LoadCurves { forces: forces.clone(), loads: loads.clone(), largest_errors };
        for (force, loads) in found {
            curves.forces.extend(force);
            curves.loads.extend(loads);
        }
        curves.forces.sort_by(|one, other| one.place.across().total_cmp(&other.place.across()));
        curves.loads.sort_by(|one, other| one.place.across().total_cmp(&other.place.across()));
        Ok(curves)
    };
    let curves = asked.drawn.filter(|_| values.len() > 1).map(curves).transpose()?;
    let passed = |(limit, value): &(Load, f64)| -> Result<Passed, StudyError> {
        let most = limit.inside(&model.units, *value);
        // Up to the separation, the load is the contact force of the cam.
        let is_passed = |value: f64| -> Result<bool, StudyError> {
            let (of_value, cam) = over.model(value)?;
            let (contact, rpm) = (Contact::new(&cam, of_value.follower), over.place(value).rpm);
            let is_parted = rpm > parts_at(&contact).speed();
            Ok(match limit {
                Load::Force if !is_parted => contact.largest(rpm) > most,
                _ => is_parted && loads_at(value, unjudged)?.0.of(*limit) > most,
            })
        };
        let on_cam = at_each.iter().flatten().filter(|(_, is_parted)| *limit == Load::Force && !is_parted);
        let on_cam = on_cam.map(|(at, _)| (at.place.across(), at.largest));
        let all = on_cam.chain(loads.iter().map(|loads| (loads.place.across(), loads.of(*limit))));
        let beyond: Vec<f64> = all.filter(|(_, load)| *load > most).map(|(value, _)| value).collect();
        let first = values.iter().position(|value| beyond.contains(value));
        // Between that value and the one before.
        let bracket = first.and_then(|first| Some([values[first.checked_sub(1)?], values[first]]));
        let width = Width::Relative(tolerance::NEEDED_BY_RUNS.value);
        let located = bracket.map(|bracket| halve(bracket, width, is_passed)).transpose()?;
        let at = located.map(|[_, passed]| passed).or(first.map(|first| values[first]));
        let at = at.map(|value| over.place(value));
        Ok(Passed { limit: *limit, value: *value, unit: limit.unit(&model.units), at })
    };
    let limits = asked.limits.iter().map(passed).collect::<Result<_, _>>()?;
    let changed = Changed::new(model, &contact);
    let mut needs = Vec::new();
    let total = (asked.needs.len() * Lever::ALL.len()) as u64;
    for (text, need) in &asked.needs {
        for lever in Lever::ALL {
            watch.at(&format!("the {lever} for \"{text}\""), needs.len() as u64, total);
            needs.push(needs::answer(&changed, (need, text), lever, &uncertain)?);
        }
    }
    let mut trades = Vec::new();
    if let Some((against, [from, to], count)) = asked.against {
        let (_, against_unit) = changed.told(against, 0.0);
        let inside =
            |value: f64| model.units.of_follower(&against.to_string()).map_or(value, |unit| unit.inside(value));
        for (text, need) in &asked.needs {
            for parameter in Lever::ALL.into_iter().filter(|lever| *lever != against) {
                watch.at(&format!("the {parameter} against the {against} for \"{text}\""), 0, 0);
                let value = |index: u32| from + (to - from) * f64::from(index) / f64::from(count.max(2) - 1);
                let pair = |index: u32| -> Result<RequiredPair, StudyError> {
                    let changed = changed.given(against, inside(value(index)));
                    let found = needs::answer(&changed, (need, text), parameter, &uncertain)?;
                    let given = value(index);
                    let Answer { value, other, again, .. } = found;
                    let [error, other_error] = [found.error, found.other_error].map(|it| it.map(|it| it.total()));
                    // For a number with an upper bound, the least value that will do comes first; it is 0 if no lower limit was found.
                    Ok(match found.is_upper_bound && !parameter.is_upper_bound() {
                        true => RequiredPair {
                            given,
                            found: Some(other.unwrap_or(0.0)),
                            error: other_error,
                            other: value,
                            other_error: error,
                            again,
                        },
                        false => RequiredPair { given, found: value, error, other, other_error, again },
                    })
                };
                let pairs = (0..count).into_par_iter().map(pair).collect::<Result<_, _>>()?;
                let (unit, against_unit) = (changed.told(parameter, 0.0).1, against_unit.clone());
                let known = need.known();
                trades.push(Trade { need: text.clone(), parameter, unit, against, against_unit, pairs, known });
            }
        }
    }
    let (label, units) = (ModelLabel::of(model), model.units.clone());
    Ok(Design {
        model: label,
        units,
        geometry: CamGeometry::of(model, &cam),
        lever_ratio: model.cam.lever_ratio(),
        separation,
        separation_errors,
        places,
        measured: machines.measured(),
        errors: model.errors,
        over: over.varied(spacing),
        forces,
        round,
        loads,
        curves,
        attractors,
        budget,
        limits,
        needs,
        rounded: rounded(model, &cam),
        trades,
    })
}

/// Cam angle, rad, and force, at evenly spaced moments and at both sides of every corner.
fn round(contact: &Contact<'_>, rpm: f64, moments: usize) -> Vec<[f64; 2]> {
    let omega = angular_velocity(rpm);
    let mut points = Vec::new();
    for segment in contact.cam.segments() {
        let part = (segment.end - segment.start) / TAU;
        let count = (part * moments as f64).ceil().max(1.0) as usize;
        let angle = |index: usize| segment.start + (segment.end - segment.start) * index as f64 / count as f64;
        points.extend((0..=count).map(|index| [angle(index), contact.force(&segment.law.lift(angle(index)), omega)]));
    }
    points
}
