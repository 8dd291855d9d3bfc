//! Answers an engineer's questions about a cam and its follower: up to which speed they stay in contact, how hard they press, what happens
//! beyond, and what must be changed.

pub mod contact;
pub mod denser;
pub mod loads;
mod need;
pub mod needs;
mod rounded;
mod separation;
mod table;
mod trades;

use rayon::prelude::*;
use serde::Serialize;

use super::{ModelLabel, StudyError};
use crate::cam::Cam;
use crate::known::Evidence;
use crate::measured::Measured;
use crate::model::{FollowerErrors, Model, Units};
use crate::orbit::long_run::Budget;
use crate::progress::{Pieces, Watch};
use crate::study::cam::CamGeometry;
use crate::study::survey::{Axis, Over, Spacing, Start, Values, VariedNumber};
use crate::uncertainty::{PlausibleMachines, SourcedUncertainty};
use contact::{Contact, Separation};
use loads::{Load, Loads};
use needs::{Answer, Changed, Lever, Need};
pub use rounded::Rounded;
use rounded::rounded;
use separation::Separated;
pub use separation::{SeparationPlace, known, separation_places};
pub use table::{AttractorsAt, ForceAt, LoadCurves, Passed};
use table::{LoadTable, round};
use trades::trades;
pub use trades::{RequiredPair, Trade};

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
    /// Separation of the follower from the cam. Its error includes the uncertainty of the machine.
    pub separation: Separation,
    /// Uncertainty of the machine in the separation's speed, rpm, and cam angle, rad; none if the machine is exact.
    pub separation_errors: Option<[SourcedUncertainty; 2]>,
    /// Places where the follower may leave the cam first, if the uncertainty of a measured cam spreads them over more than 10 degrees.
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
    /// Limits, each with the value at which it is first exceeded.
    pub limits: Vec<Passed>,
    /// Values that meet each need.
    pub needs: Vec<Answer>,
    /// Effect of rounding the jumps of the acceleration.
    pub rounded: Vec<Rounded>,
    /// Values that meet each need, against another number.
    pub trades: Vec<Trade>,
}

document!(Design as it {
    schema: "corner-impact/design/1",
    model: it.model,
    geometry if_any: it.geometry,
    lever_ratio: it.lever_ratio,
    over if_any: it.over.rpm.map(|_| &it.over.name),
    separation: Separated::new(it.separation, it.separation_errors, &it.places),
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
    /// Number at whose values each need is answered, besides at the model's own.
    pub against: Option<Axis>,
    /// Starts of the table's runs; none for the usual starts.
    pub starts: Option<Vec<Start>>,
    /// Budget of the runs; none for the usual one.
    pub budget: Option<Budget>,
    /// Number of values of the curves in a picture; none if there is no picture.
    pub drawn: Option<usize>,
}

impl Design {
    fn told_round(&self) -> Vec<RoundEntry> {
        self.round.iter().map(|[angle, force]| RoundEntry { cam_angle_rad: *angle, force_n: *force }).collect()
    }

    /// Standard deviations of the follower's numbers in the table: the number that varies is exact.
    pub fn table_errors(&self) -> FollowerErrors {
        self.errors.without(&self.over.name)
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

/// The machines of the table, and its values.
fn load_table<'a>(
    machines: &'a PlausibleMachines<'a>,
    separation: Separation,
    asked: &'a Asked,
) -> Result<LoadTable<'a>, StudyError> {
    /// Default speed range, as multiples of the separation speed.
    const USUAL: [f64; 2] = [0.5, 1.5];
    let model = machines.model;
    let range = asked.rpm.or(match separation {
        Separation::At { rpm, .. } => Some(USUAL.map(|part| part * rpm)),
        _ => model.study.map(|study| [study.rpm_min, study.rpm_max]),
    });
    let (over, values) = match (&asked.over, asked.rpm) {
        (Some(_), Some([low, high])) if low < high => return Err(StudyError::RangeAndNumber { low, high }),
        (Some(axis), rpm) => (Over::new(model, axis.parameter.clone(), rpm.map(|[rpm, _]| rpm))?, axis.values.to_vec()),
        (None, _) => {
            let [low, high] = range.ok_or(StudyError::NoSpeeds)?;
            let speeds = Values::linear(low, high, if low == high { 1 } else { asked.speeds.max(2) as usize });
            (Over::speed(model)?, speeds.all().collect())
        }
    };
    let spacing = asked.over.as_ref().map_or(Spacing::Linear, |axis| axis.spacing);
    let (starts, budget) = (asked.starts.as_deref(), asked.budget.unwrap_or(Budget::DESIGN));
    Ok(LoadTable { over, values, spacing, machines, separation, starts, budget })
}

/// Answers the questions about a model; `watch` receives the progress of the runs.
pub fn design(model: &Model, asked: &Asked, watch: &dyn Watch) -> Result<Design, StudyError> {
    /// Moments of the force round the cam, besides the ends of segments.
    const MOMENTS: usize = 720;
    let cam = Cam::new(model)?;
    let contact = Contact::new(&cam, model.follower);
    let machines = PlausibleMachines::of(model, &cam)?;
    let (separation, separation_errors) = known(contact.separation(), &machines);
    let places = separation_places(separation, &machines);
    let table = load_table(&machines, separation, asked)?;
    let at_each = table.values.iter().map(|value| table.force(*value)).collect::<Result<Vec<_>, _>>()?;
    // If the cam's velocity jumps, there is no contact force, and the follower leaves the cam at any speed.
    let parted = table.values.iter().zip(&at_each).filter(|(_, at)| at.is_none_or(|(_, is_parted)| is_parted));
    let parted: Vec<f64> = parted.map(|(value, _)| *value).collect();
    let round = match (table.values.as_slice(), at_each.as_slice()) {
        ([rpm], [Some(_)]) if table.over.is_speed() => round(&contact, *rpm, MOMENTS),
        _ => Vec::new(),
    };
    let pieces = Pieces::new(watch, "attractors where the follower leaves the cam", parted.len());
    let found = parted.par_iter().map(|value| pieces.each(|| table.loads(*value))).collect::<Result<Vec<_>, _>>()?;
    let (loads, attractors): (Vec<Loads>, Vec<AttractorsAt>) = found.into_iter().unzip();
    let forces: Vec<ForceAt> = at_each.iter().flatten().map(|(at, _)| *at).collect();
    let curves = asked.drawn.filter(|_| table.values.len() > 1);
    let curves = curves.map(|count| table.curves((&forces, &loads), count, watch)).transpose()?;
    let passed = |limit: &(Load, f64)| table.passed(*limit, &at_each, &loads);
    let limits = asked.limits.iter().map(passed).collect::<Result<_, _>>()?;
    let changed = Changed::new(model, &contact);
    let mut needs = Vec::new();
    let total = (asked.needs.len() * Lever::ALL.len()) as u64;
    for (text, need) in &asked.needs {
        for lever in Lever::ALL {
            watch.at(&format!("the {lever} for \"{text}\""), needs.len() as u64, total);
            needs.push(needs::answer(&changed, (need, text), lever, machines.uncertain())?);
        }
    }
    let trades = asked.against.as_ref().map(|axis| trades(&machines, &asked.needs, axis, watch)).transpose()?;
    let (over, budget) = (table.over.varied(table.spacing), table.budget);
    Ok(Design {
        model: ModelLabel::of(model),
        units: model.units.clone(),
        geometry: CamGeometry::of(model, &cam),
        lever_ratio: model.cam.lever_ratio(),
        separation,
        separation_errors,
        places,
        errors: model.errors,
        over,
        forces,
        round,
        loads,
        curves,
        attractors,
        budget,
        limits,
        needs,
        rounded: rounded(model, &cam, separation),
        trades: trades.unwrap_or_default(),
        measured: machines.measured(),
    })
}
