//! What does an engineer ask of a cam and its follower? Up to which speed they touch and how hard, what happens beyond, and what must
//! be changed.

pub mod contact;
pub mod loads;
pub mod needs;

use std::f64::consts::{PI, TAU};

use rayon::prelude::*;
use serde::Serialize;

use super::{ModelLabel, StudyError};
use crate::bracket::{Width, halve};
use crate::cam::{Cam, Least};
use crate::known::Known;
use crate::measured::{Likely, Measured};
use crate::model::{CORNER_ROUNDING, Model, Units};
use crate::orbit::long_run::Budget;
use crate::progress::{Pieces, Watch};
use crate::simulate::{Machine, angular_velocity};
use crate::study::survey::{Attractor, Axis, Over, Place, Spacing, Start, Values};
use crate::tolerance;
use contact::{Contact, Separation};
use loads::{Load, Loads};
use needs::{Answer, Changed, Lever, Need};

/// The document of `design --json`.
#[derive(Clone, Debug)]
pub struct Design {
    /// Which model.
    pub model: ModelLabel,
    /// What its numbers are told in.
    pub units: Units,
    /// Where the follower first leaves the cam; its error has what a measured cam leaves open.
    pub separation: Separation,
    /// How well the cam is known, if it is measured.
    pub measured: Option<Measured>,
    /// The number that the table goes over; none where that is the speed.
    pub over: Option<String>,
    /// How its values lie.
    pub spacing: Spacing,
    /// The least force at each value, in the unit inside.
    pub forces: Vec<ForceAt>,
    /// The force round the cam at the one speed that is asked for.
    pub round: Vec<[f64; 2]>,
    /// What attracts where the follower leaves the cam.
    pub loads: Vec<Loads>,
    /// The motions that these are of.
    pub attractors: Vec<AttractorsAt>,
    /// For how long runs were followed.
    pub budget: Budget,
    /// Where a limit is first passed.
    pub limits: Vec<Passed>,
    /// What must be changed.
    pub needs: Vec<Answer>,
    /// What rounding the jumps of the acceleration gives.
    pub rounded: Vec<Rounded>,
    /// What must be changed, against another number.
    pub trades: Vec<Trade>,
}

/// The least force on one machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceAt {
    /// Which.
    pub place: Place,
    /// Where it is, and how large.
    pub least: Least,
    /// How far a measured cam may have moved that; none where nothing is open.
    pub error: Option<f64>,
    /// The largest force round the cam.
    pub largest: f64,
}

document!(ForceAt as it {
    speed_rpm: it.place.rpm,
    value if_any: it.place.value,
    least_n: it.least.value,
    cam_angle_rad: it.least.angle,
    error_n if_any: it.error,
    largest_n: it.largest,
});

/// What the starts of one machine come to.
#[derive(Clone, Debug)]
pub struct AttractorsAt {
    /// Of which.
    pub place: Place,
    /// The motions, in the order of the first start of each.
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

/// A limit that the user sets, and where it is passed first, as far as the values of the table tell.
#[derive(Clone, Debug, PartialEq)]
pub struct Passed {
    /// Of which load.
    pub limit: Load,
    /// In the unit that is told.
    pub value: f64,
    /// The unit.
    pub unit: String,
    /// Where it is passed: to a thousandth below the first value of the table at which it is, at the lowest of them that value
    /// itself; none where it is passed at none.
    pub at: Option<Place>,
}

document!(Passed as it {
    limit: it.limit,
    value: it.value,
    unit: it.unit,
    speed_rpm: it.at.map(|at| at.rpm),
    at if_any: it.at.and_then(|at| at.value),
});

/// What one number has to be at one value of another.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Pair {
    /// The value that is given.
    pub given: f64,
    /// What is found.
    pub found: Option<f64>,
    /// How far it may be off where the cam is measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<f64>,
    /// Where it does no more on the other side, if it does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub other: Option<f64>,
    /// How far that may be off.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub other_error: Option<f64>,
    /// A value beyond, of those tried, with which it is as it is needed to be again.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub again: Option<f64>,
}

/// What one number has to be for each value of another.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Trade {
    /// What is needed.
    pub need: String,
    /// The number that is found, and its unit.
    pub parameter: Lever,
    /// Its unit.
    pub unit: String,
    /// The number that is given.
    pub against: Lever,
    /// Its unit.
    pub against_unit: String,
    /// Pairs of what is given and what is found; nothing where no value does it.
    pub pairs: Vec<Pair>,
    /// As of the need alone.
    pub known: Known,
}

document!(Design as it {
    schema: "corner-impact/design/1",
    model: it.model,
    over if_any: it.over.as_ref(),
    separation: it.separated(),
    separates: it.separation.name(),
    measured if_any: it.measured,
    contact_force: it.forces,
    force_round_the_cam: it.told_round(),
    loads: it.loads,
    loads_known: Known::Sampled,
    attractors: it.attractors,
    budget: it.budget,
    limits: it.limits,
    needs: it.needs,
    rounded: it.rounded,
    trades: it.trades,
});

/// The same machine with the corners of its cam rounded.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Rounded {
    /// Over this angle.
    pub corner_rounding_deg: f64,
    /// Where the follower first leaves the cam then, rpm; none where it does at every speed or at none.
    pub separation_rpm: Option<f64>,
    /// The largest size of the jerk, m/rad^3.
    pub jerk: f64,
}

/// Over some angles, as far as the cam allows; nothing where there is no jump of the acceleration, or it is rounded already.
fn rounded(model: &Model, cam: &Cam) -> Vec<Rounded> {
    /// Degrees.
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

/// What is asked.
#[derive(Clone, Debug, Default)]
pub struct Asked {
    /// Lowest and highest speed, rpm; of one speed the force is told round the cam. None: around the separation.
    pub rpm: Option<[f64; 2]>,
    /// What the table goes over, in place of the speed, at one speed then.
    pub over: Option<Axis>,
    /// Speeds of a range.
    pub speeds: u32,
    /// Each as it was said.
    pub needs: Vec<(String, Need)>,
    /// In the units of the model.
    pub limits: Vec<(Load, f64)>,
    /// A number, its lowest and highest value and how many, in its unit.
    pub against: Option<(Lever, [f64; 2], u32)>,
    /// Where the runs of the table begin; none for the usual starts.
    pub starts: Option<Vec<Start>>,
    /// For how long they are followed; none for as long as is usual.
    pub budget: Option<Budget>,
}

#[derive(Serialize)]
struct Separated {
    speed_rpm: f64,
    error_rpm: f64,
    cam_angle_rad: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    cam_angle_error_rad: Option<f64>,
    located: bool,
}

impl Design {
    fn separated(&self) -> Option<Separated> {
        match self.separation {
            Separation::At { rpm, error, cam_angle, angle_error } => Some(Separated {
                speed_rpm: rpm,
                error_rpm: error,
                cam_angle_rad: cam_angle,
                cam_angle_error_rad: angle_error,
                located: true,
            }),
            _ => None,
        }
    }

    /// The one speed of a table that goes over another number, rpm.
    pub fn rpm(&self) -> f64 {
        let places = self.forces.iter().map(|at| at.place).chain(self.loads.iter().map(|loads| loads.place));
        places.map(|place| place.rpm).next().unwrap_or(f64::NAN)
    }

    fn told_round(&self) -> Vec<RoundEntry> {
        self.round.iter().map(|[angle, force]| RoundEntry { cam_angle_rad: *angle, force_n: *force }).collect()
    }

    /// A force as it is told.
    pub fn force(&self, force: f64) -> f64 {
        self.units.force.told(force)
    }
}

#[derive(Serialize)]
struct RoundEntry {
    cam_angle_rad: f64,
    force_n: f64,
}

/// A separation with what a measured cam leaves open of its speed and angle; not a number where that is not known.
pub fn known(separation: Separation, likely: Option<&Likely>) -> Separation {
    let Some(likely) = likely.filter(|likely| likely.best.is_some()) else { return separation };
    let Separation::At { rpm, error, cam_angle, .. } = separation else { return separation };
    // Past angle 0 it is as near as on this side of it.
    let near = |angle: f64| cam_angle + (angle - cam_angle + PI).rem_euclid(TAU) - PI;
    let of = |model: &Model, cam: &Cam| match Contact::new(cam, model.follower).separation() {
        Separation::At { rpm, cam_angle, .. } => Some([rpm, near(cam_angle)]),
        _ => None,
    };
    let [open, angle_error] = likely.error([rpm, cam_angle], of).unwrap_or([f64::NAN; 2]);
    Separation::At { rpm, error: error + open, cam_angle, angle_error: Some(angle_error) }
}

/// Answers what is asked of a model; `watch` is told how far the runs are.
pub fn design(model: &Model, asked: &Asked, watch: &dyn Watch) -> Result<Design, StudyError> {
    /// Moments of the force round the cam, beside the ends of segments.
    const MOMENTS: usize = 720;
    /// Of the separation, where nothing says which speeds.
    const USUAL: [f64; 2] = [0.5, 1.5];
    let cam = Cam::new(model)?;
    let contact = Contact::new(&cam, model.follower);
    let likely = Likely::of(model)?;
    let separation = known(contact.separation(), likely.as_ref());
    // A need that is to be met for certain is one at a speed that is higher by as much as the separation is uncertain.
    let uncertain = match separation {
        Separation::At { rpm, error, .. } if likely.as_ref().is_some_and(|likely| likely.best.is_some()) => error / rpm,
        _ => 0.0,
    };
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
    // By another number the loads move along with the cam: how far is not known.
    let noisy = likely.as_ref().filter(|likely| likely.best.is_some() && over.is_speed());
    let parts_at = |contact: &Contact<'_>| if over.is_speed() { separation } else { contact.separation() };
    let force_at = |value: &f64| -> Result<Option<(ForceAt, bool)>, StudyError> {
        let (model, cam) = over.model(*value)?;
        let (contact, place) = (Contact::new(&cam, model.follower), over.place(*value));
        let parts = parts_at(&contact);
        let is_parted = place.rpm > parts.speed();
        if matches!(parts, Separation::Kink { .. }) {
            return Ok(None);
        }
        let least = contact.least(place.rpm);
        let of = |model: &Model, cam: &Cam| Some([Contact::new(cam, model.follower).least(place.rpm).value]);
        let (error, largest) = (noisy.and_then(|likely| likely.error([least.value], of)), contact.largest(place.rpm));
        // On a dwell nothing is open but the rounding.
        let rounding = tolerance::JET_ROUNDING.value * largest.abs();
        let error = error.map(|[error]| error).filter(|error| *error > rounding);
        Ok(Some((ForceAt { place, least, error, largest }, is_parted)))
    };
    let at_each = values.iter().map(force_at).collect::<Result<Vec<_>, _>>()?;
    // Where the cam's velocity jumps, it has no force, and the follower leaves it at any speed.
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
        // As it was asked for, and not as the angular velocity has it.
        Ok((Loads { place: over.place(value), ..loads }, found))
    };
    let with_errors = |value: &f64| -> Result<(Loads, AttractorsAt), StudyError> {
        let (loads, found) = loads_at(*value, budget)?;
        let place = over.place(*value);
        let of = |model: &Model, cam: &Cam| {
            let machine = Machine::new(cam.clone(), &model.follower, angular_velocity(place.rpm));
            Loads::among(model, &machine, asked.starts.as_deref(), unjudged).ok().map(|(loads, _)| loads.numbers())
        };
        let errors = noisy.and_then(|likely| likely.error(loads.numbers(), of));
        Ok((Loads { errors, ..loads }, AttractorsAt { place, found }))
    };
    let found = parted.par_iter().map(|value| pieces.each(|| with_errors(value))).collect::<Result<Vec<_>, _>>()?;
    let (loads, attractors): (Vec<Loads>, Vec<AttractorsAt>) = found.into_iter().unzip();
    let forces: Vec<ForceAt> = at_each.iter().flatten().map(|(at, _)| *at).collect();
    let passed = |(limit, value): &(Load, f64)| -> Result<Passed, StudyError> {
        let most = limit.inside(&model.units, *value);
        // Up to the separation the follower bears what the cam presses with.
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
            needs.push(needs::answer(&changed, (need, text), lever, uncertain)?);
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
                let pair = |index: u32| -> Result<Pair, StudyError> {
                    let changed = changed.with(against, inside(value(index)));
                    let found = needs::answer(&changed, (need, text), parameter, uncertain)?;
                    let given = value(index);
                    let Answer { value, error, other, other_error, again, .. } = found;
                    // Of what is not to be too much as little as will do comes first, and none at all does where nothing else is said.
                    Ok(match found.is_upper_bound && !parameter.is_upper_bound() {
                        true => Pair {
                            given,
                            found: Some(other.unwrap_or(0.0)),
                            error: other_error,
                            other: value,
                            other_error: error,
                            again,
                        },
                        false => Pair { given, found: value, error, other, other_error, again },
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
        separation,
        measured: likely.map(|likely| likely.measured),
        over: (!over.is_speed()).then(|| over.parameter.name().to_owned()),
        spacing: asked.over.as_ref().map_or(Spacing::Linear, |axis| axis.spacing),
        forces,
        round,
        loads,
        attractors,
        budget,
        limits,
        needs,
        rounded: rounded(model, &cam),
        trades,
    })
}

/// Cam angle, rad, and force, at moments evenly spaced and at both sides of every corner.
fn round(contact: &Contact<'_>, rpm: f64, moments: usize) -> Vec<[f64; 2]> {
    let omega = angular_velocity(rpm);
    let mut points = Vec::new();
    for segment in contact.cam.segments() {
        let part = (segment.end - segment.start) / std::f64::consts::TAU;
        let count = (part * moments as f64).ceil().max(1.0) as usize;
        let angle = |index: usize| segment.start + (segment.end - segment.start) * index as f64 / count as f64;
        points.extend((0..=count).map(|index| [angle(index), contact.force(&segment.law.lift(angle(index)), omega)]));
    }
    points
}
