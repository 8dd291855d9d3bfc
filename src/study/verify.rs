//! Verification of one model through the whole pipeline: the corner impact, every route, every comparison, the classification, the
//! paper's numbers.

use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};
use std::thread::JoinHandle;

use nalgebra::{Matrix2, Vector2};
use serde::Serialize;

use crate::agreement::{Agreement, NamedOrbit, Quantity, compare_orbits, fewest_shared_decimals};
use crate::border_collision::feigin::{Scenario, Speeds};
use crate::border_collision::validity::{self, Range};
use crate::border_collision::{
    Classification, Condition, Danger, Degenerate, LocalMap, LocalOutcome, NormalForm, Refusal, RoundedCorner,
    WithDanger, conditions, normal_form, rounded,
};
use crate::cam::{Cam, Side};
use crate::cancel;
use crate::corner::external::{self, Outside, PROGRAMS, Program};
use crate::corner::map::{LinearForm, RouteName, SideMap, Sides};
use crate::corner::second_order::{CurvedMap, second_order};
use crate::corner::{self, CornerImpact, CornerMap, LocateError, Route};
use crate::corner::{closed_form, simulated_orbit, variational};
use crate::measured::Measured;
use crate::model::{FollowerErrors, Model};
use crate::progress::{Unwatched, Watch};
use crate::published::{PrintedNumber, PublishedError, compare_published};
use crate::python::PythonError;
use crate::study::ModelLabel;
use crate::study::certify::{self, Certificate, CertifyError, Outcome};
use crate::study::routes::{self, Log, Skipped};
use crate::uncertainty::{PlausibleMachines, SourcedUncertainty, UncertaintyParts};

/// Results of a verification: the document `corner-impact/verify/1`.
#[derive(Clone, Debug)]
pub struct Verification {
    /// The model.
    pub model: ModelLabel,
    /// The corner impact that was verified: the slowest in `[study]`.
    pub at: CornerImpact,
    /// Further corner impacts in `[study]`.
    pub others: Vec<CornerImpact>,
    /// The map by the closed form.
    pub map: CornerMap,
    /// Uncertainty of speed and map, and the cam's accuracy; none if the cam is not measured and the follower's numbers are exact.
    pub uncertainty: Option<LeftOpen>,
    /// Proof of the corner impact, if there is one.
    pub certificate: Option<Certificate>,
    /// The map by each route that ran.
    pub routes: Vec<Route>,
    /// The orbit by each route that finds it: x*, m from the equilibrium and m/s, and T*, s.
    pub orbits: Vec<NamedOrbit>,
    /// Every comparison of two routes.
    pub comparisons: Vec<Agreement>,
    /// `(e, f)`: the impact comes before the corner where `e dx + f dT < 0`.
    pub border: LinearForm,
    /// The map in normal form, in which the border does not depend on the parameter.
    pub normal_form: Result<NormalForm, Degenerate>,
    /// Classification of the corner impact.
    pub classification: Result<Classification, Refusal>,
    /// Conditions of classification, stability and normal form, each with its distance from failing.
    pub conditions: Vec<Condition>,
    /// The local map's own motions at dT = -1, 1 and 0; empty without a classification.
    pub outcomes: Vec<LocalOutcome>,
    /// Danger at the corner impact that the classification does not show, if there is any.
    pub danger: Option<Danger>,
    /// The map to second order; none without a classification.
    pub second_order: Option<Sides<CurvedMap>>,
    /// Effect of rounding the corner, if it is a nonsmooth fold.
    pub rounded_corner: Option<RoundedCorner>,
    /// Ranges in which the local map is valid; empty without a classification.
    pub ranges: Vec<Range>,
    /// The paper's numbers; empty for another model.
    pub published: Vec<PrintedNumber>,
    /// Routes and results that were not computed, with the reason.
    pub skipped: Vec<Skipped>,
    /// Whether every comparison agrees, every printed number is as the ledger says, and every route ran that should have.
    pub agrees: bool,
}

document!(Verification as found {
    schema: "corner-impact/verify/1",
    model: found.model,
    corner_impact: Whole(&found.at),
    other_corner_impacts: found.others.iter().map(Place).collect::<Vec<_>>(),
    certificate if_any: found.certificate,
    hypotheses if_any: found.certificate.as_ref().map(Certificate::hypotheses),
    uncertainty if_any: found.uncertainty,
    routes: found.routes.iter().map(|route| (route.name, route)).collect::<BTreeMap<_, _>>(),
    orbits: found.orbits.iter().map(|(name, x, period)| (*name, Orbit(x, *period))).collect::<BTreeMap<_, _>>(),
    agreement: found.comparisons,
    eigenvalues: found.map.map(SideMap::eigenvalues),
    normal_form: found.normal_form.as_ref().ok(),
    classification: found.classification.as_ref().ok().map(|kind| WithDanger { kind, danger: found.danger.as_ref() }),
    refusal: found.classification.as_ref().err().map(Refusal::to_string),
    conditions: found.conditions,
    local_map: found.outcomes,
    second_order: found.second_order,
    rounded_corner if_any: found.rounded_corner,
    linear_range: found.ranges,
    published: found.published,
    skipped: found.skipped,
    agrees: found.agrees,
});

/// The orbit by one route.
struct Orbit<'a>(&'a Vector2<f64>, f64);

document!(Orbit<'_> as it { period_s: it.1, state: it.0.as_slice() });

/// Uncertainty of a corner impact and its map.
#[derive(Clone, Debug)]
#[doc(hidden)]
pub struct LeftOpen {
    /// Accuracy of the cam, if it is measured.
    pub cam: Option<Measured>,
    /// Standard deviations of the follower's numbers.
    pub errors: FollowerErrors,
    /// Uncertainties of the speed and the map. None if nothing is uncertain, or if too few of the likely machines have the corner impact.
    pub error: Option<CornerUncertainty>,
    /// Number of the likely machines with each verdict, or with none: those with an equally likely cam, and those drawn from the errors of the
    /// follower's numbers. Machines without the corner impact are left out.
    pub verdicts: Vec<Verdicts>,
}

document!(LeftOpen as it {
    speed_rpm: it.error.as_ref().map(|error| error.speed.total()),
    speed_parts if_any: it.error.as_ref().map(|error| UncertaintyParts(error.speed, "_rpm")),
    minus: it.error.as_ref().map(|error| error.total().minus),
    plus: it.error.as_ref().map(|error| error.total().plus),
    parts if_any: it.error.as_ref().map(CornerUncertainty::parts),
    verdicts: it.verdicts,
    measured if_any: it.cam,
    uncertain if_any: it.errors.if_any(),
});

/// Uncertainties of the speed and the map of a corner impact.
#[derive(Clone, Debug)]
#[doc(hidden)]
pub struct CornerUncertainty {
    /// Uncertainty of the speed, rpm.
    pub speed: SourcedUncertainty,
    /// Uncertainty of each entry of the map: A by rows, then B.
    pub entries: Sides<[SourcedUncertainty; 6]>,
}

impl CornerUncertainty {
    /// Whole uncertainty of each entry.
    pub fn total(&self) -> CornerMap {
        self.of(|error| error.total())
    }

    /// One part of the uncertainty of each entry.
    pub fn of(&self, part: impl Fn(&SourcedUncertainty) -> f64) -> CornerMap {
        self.entries.map(|entries| {
            let [a, b, c, d, e, f] = entries.each_ref().map(&part);
            SideMap { a: Matrix2::new(a, b, c, d), b: Vector2::new(e, f) }
        })
    }

    /// The map's uncertainty by its sources: the cam, all numbers, and each number that has a part of its own.
    pub fn parts(&self) -> BTreeMap<&'static str, CornerMap> {
        let mut parts =
            BTreeMap::from([("cam", self.of(|error| error.cam)), ("numbers", self.of(|error| error.numbers))]);
        for (index, name) in FollowerErrors::names().enumerate() {
            let part = self.of(|error| error.each.map_or(0.0, |each| each[index]));
            if [part.minus, part.plus].iter().flat_map(SideMap::entries).any(|entry| entry > 0.0) {
                parts.insert(name, part);
            }
        }
        parts
    }
}

/// A verdict, and the number of machines with it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Verdicts {
    /// Scenario at the corner impact; none if its map is refused.
    pub scenario: Option<Scenario>,
    /// Number of machines, each with a likely cam.
    pub cams: usize,
}

impl LeftOpen {
    /// Computes the uncertainty of a corner impact and its map from the likely machines. None if the cam is not measured and the numbers are
    /// exact.
    fn new(
        machines: PlausibleMachines<'_>,
        at: &CornerImpact,
        map: &CornerMap,
        sticking: Option<Side>,
    ) -> Option<Self> {
        let is_uncertain = machines.uncertain().is_some();
        if !is_uncertain && machines.cams.is_none() {
            return None;
        }
        let numbers =
            |speed: f64, map: &CornerMap| [&[speed], &map.minus.entries()[..], &map.plus.entries()[..]].concat();
        let found = |model: &Model, cam: &Cam| {
            let (first, others) = corner::locate(model, cam).ok()?;
            let found = std::iter::once(first).chain(others).find(|found| at.is_near(found))?;
            let map = closed_form::route(model, &found).map;
            Some((found, map))
        };
        let there = |model: &Model, cam: &Cam| found(model, cam).map(|(found, map)| numbers(found.speed_rpm(), &map));
        let seen = Mutex::new(Vec::new());
        let judged = |model: &Model, cam: &Cam| {
            let (found, map) = found(model, cam)?;
            let verdict = routes::classified(&map, variational::border(model, cam, &found), sticking).ok();
            seen.lock().unwrap_or_else(PoisonError::into_inner).push(verdict.map(|kind| kind.scenario));
            Some(numbers(found.speed_rpm(), &map))
        };
        let own = numbers(at.speed_rpm(), map);
        let (of_cam, of_numbers) = (machines.errors_of_cam(&own, judged), machines.errors_of_numbers(&own, there));
        machines.drawn(judged);
        let error = of_cam.zip(of_numbers).filter(|_| is_uncertain);
        let error = error.and_then(|(of_cam, of_numbers)| {
            let errors = SourcedUncertainty::joined(of_cam, of_numbers);
            let side = |from: usize| std::array::from_fn(|entry| errors[from + entry]);
            Some(CornerUncertainty { speed: *errors.first()?, entries: Sides { minus: side(1), plus: side(7) } })
        });
        let mut verdicts: Vec<Verdicts> = Vec::new();
        for scenario in seen.into_inner().unwrap_or_else(PoisonError::into_inner) {
            match verdicts.iter_mut().find(|known| known.scenario == scenario) {
                Some(known) => known.cams += 1,
                None => verdicts.push(Verdicts { scenario, cams: 1 }),
            }
        }
        // The order must not depend on the threads.
        verdicts.sort_by_key(|told| (Reverse(told.cams), told.scenario.map(|scenario| scenario.to_string())));
        let errors = machines.deviations();
        Some(Self { verdicts, error, errors, cam: machines.measured() })
    }
}

/// A corner impact with all its known quantities.
pub(super) struct Whole<'a>(pub(super) &'a CornerImpact);

document!(Whole<'_> as it {
    period_s: it.0.period,
    period_bracket_s: it.0.bracket,
    period_residual: it.0.residual,
    speed_rpm: it.0.speed_rpm(),
    cam_angle_rad: it.0.corner.angle,
    state: it.0.x_star().as_slice(),
    state_origin_m: it.0.origin,
    closure: it.0.closure,
    position_m: it.0.corner.plus.value,
    velocity_before_m_s: it.0.velocity_before,
    velocity_after_m_s: it.0.velocity_after,
    cam_velocity_m_s: it.0.cam_velocity,
    cam_acceleration_m_s2: it.0.cam_acceleration(),
});

/// A corner impact with its place only.
struct Place<'a>(&'a CornerImpact);

document!(Place<'_> as it { speed_rpm: it.0.speed_rpm(), cam_angle_rad: it.0.corner.angle });

impl Verification {
    /// The routes in the order of their names.
    pub fn routes_by_name(&self) -> impl Iterator<Item = &Route> {
        self.routes.iter().map(|route| (route.name, route)).collect::<BTreeMap<_, _>>().into_values()
    }

    /// Returns the entries of A and B of one side by every route.
    pub fn entries(&self, side: Side) -> Vec<Entry> {
        let maps: Vec<[f64; 6]> = self.routes_by_name().map(|route| route.map.of(side).entries()).collect();
        let printed = |quantity| self.published.iter().find(|number| number.agreement.quantity == quantity);
        let (a, b) = (printed(Quantity::A(side)), printed(Quantity::B(side)));
        let printed: Vec<&String> = [a, b].into_iter().flatten().flat_map(|number| &number.printed).collect();
        let one = |(index, entry): (usize, &'static str)| {
            let values: Vec<f64> = maps.iter().map(|entries| entries[index]).collect();
            let least = values.iter().copied().fold(f64::INFINITY, f64::min);
            let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            Entry { entry, values, spread: most - least, printed: printed.get(index).map(|digits| (*digits).clone()) }
        };
        ["A11", "A12", "A21", "A22", "B1", "B2"].into_iter().enumerate().map(one).collect()
    }

    /// Counts comparisons and printed numbers by their result.
    pub fn tally(&self) -> ComparisonTally {
        let numbers = &self.published;
        let (following, pairs): (Vec<_>, Vec<_>) = self.comparisons.iter().partition(|pair| pair.follows);
        let right = numbers.iter().filter(|number| number.as_found && number.agreement.agrees).count();
        let otherwise = numbers.iter().filter(|number| !number.as_found).count();
        ComparisonTally {
            comparisons: pairs.len(),
            agreeing: pairs.iter().filter(|pair| pair.agrees).count(),
            following: following.len(),
            following_agreeing: following.iter().filter(|pair| pair.agrees).count(),
            shared_decimals: fewest_shared_decimals(&self.comparisons),
            printed: numbers.len(),
            printed_right: right,
            printed_wrong: numbers.len() - right - otherwise,
            printed_otherwise: otherwise,
        }
    }
}

/// Numbers of comparisons and printed numbers of each kind.
#[derive(Clone, Copy, Debug, Default)]
#[doc(hidden)]
pub struct ComparisonTally {
    /// Comparisons of two routes, without those that follow from A and B.
    pub comparisons: usize,
    /// Agreeing comparisons among these.
    pub agreeing: usize,
    /// Comparisons that follow from A and B. They test nothing more.
    pub following: usize,
    /// Agreeing comparisons among those that follow.
    pub following_agreeing: usize,
    /// Decimals that every entry of A and B shares between any two routes; none if they are equal in all digits.
    pub shared_decimals: Option<u32>,
    /// Printed numbers of the paper that were checked.
    pub printed: usize,
    /// Printed numbers that are right.
    pub printed_right: usize,
    /// Printed numbers that are wrong as the ledger says.
    pub printed_wrong: usize,
    /// Printed numbers whose result differs from the ledger.
    pub printed_otherwise: usize,
}

/// One entry of A or B by every route.
#[derive(Clone, Debug, Serialize)]
#[doc(hidden)]
pub struct Entry {
    /// `A11` to `B2`.
    pub entry: &'static str,
    /// Values by each route, in the order of the routes' names.
    pub values: Vec<f64>,
    /// Largest value minus smallest value.
    pub spread: f64,
    /// Number as printed in the paper.
    pub printed: Option<String>,
}

/// Whether to run the routes outside this program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum External {
    /// Run them. A route that cannot run counts as disagreeing.
    Run,
    /// Leave them out, and log that.
    LeftOut,
}

/// Locates the corner impact of a model, computes its map by every route, and compares.
///
/// Fails only if there is nothing to compare. A failed route is listed as skipped, and then the verification disagrees.
pub fn verify(model: &Model, external: External) -> Result<Verification, LocateError> {
    verify_watched(model, external, &Unwatched)
}

/// Runs [`verify`] and notifies `watch` at each step.
#[doc(hidden)]
pub fn verify_watched(model: &Model, external: External, watch: &dyn Watch) -> Result<Verification, LocateError> {
    watch.at("looking for the corner impact", 0, 0);
    let cam = Cam::new(model)?;
    let (at, others) = corner::locate(model, &cam)?;
    let mut log = Log::default();
    // The programs outside take seconds, this program's routes a few hundredths: they run in parallel.
    let outside = start_outside(model, external)?;
    let is_beyond = certify::is_beyond(model);
    let proving = (external == External::Run && !is_beyond).then(|| {
        let (model, place) = (model.clone(), certify::candidate(model, &cam, &at));
        std::thread::spawn(cancel::carry(move || certify::prove(&model, vec![place], certify::BITS)))
    });

    watch.at("the map by the routes of this program", 0, 0);
    let closed = closed_form::route(model, &at);
    let map = closed.map;
    let (mut routes, sticking) = routes::routes(model, &cam, &at, &mut log);
    let uncertainty = LeftOpen::new(PlausibleMachines::of(model, &cam)?, &at, &map, sticking);

    let mut orbits: Vec<NamedOrbit> = vec![(RouteName::Located, at.x_star(), at.period)];
    if model.follower.stiffness > 0.0 {
        let transcribed = log.keep("x_star by closed_form", closed_form::orbit(model, &at));
        orbits.extend(transcribed.map(|(x, period)| (RouteName::ClosedForm, x, period)));
    } else {
        let why = "without stiffness there is no equilibrium to measure the paper's x from";
        log.leave_out("x_star by closed_form", why);
    }
    let simulated = log.keep("x_star by simulation", simulated_orbit::orbit(model, &cam, &at));
    orbits.extend(simulated.map(|(x, period)| (RouteName::Simulation, x, period)));

    for (program, answer) in outside {
        watch.at(&format!("the map by {}, in Python", program.name), 0, 0);
        match answer.map(JoinHandle::join) {
            None => log.leave_out(program.name, "left out by --no-external"),
            Some(Ok(result)) => {
                if let Some(Outside { route, x_star, period }) = log.keep(program.name, result) {
                    routes.push(route);
                    orbits.push((program.name, x_star, period));
                }
            }
            Some(Err(_)) => log.fail(program.name, "its thread ended without an answer"),
        }
    }
    let border = variational::border(model, &cam, &at);
    let classification = routes::classified(&map, border, sticking);
    watch.at("the proof, in Python", 0, 0);
    let certificate = certificate(proving, (classification.is_err(), is_beyond), &mut log);
    if let Some(certificate) = &certificate {
        let (name, x_star) = (RouteName::Certificate, Vector2::from_fn(|row, _| certificate.state[row].value()));
        routes.push(Route { name, map: certificate.map(), own: certificate.own(), uncertainty: None });
        orbits.push((name, x_star, certificate.period_s.value()));
    }
    let mut comparisons = routes::comparisons(&at, &routes, &mut log);
    comparisons.extend(compare_orbits(&orbits));
    let normal_form = normal_form(&map);
    log.refused("normal_form", &normal_form);
    log.refused("classification", &classification);
    watch.at("motions of the local map", 0, 0);
    let local = LocalMap::new(&map, border);
    let (mut outcomes, mut danger, mut ranges) = (Vec::new(), None, Vec::new());
    let rounded_corner = classification.as_ref().ok().and_then(|kind| rounded(kind, &at));
    let curved = classification.is_ok().then(|| second_order(model, &cam, &at));
    if let Some(curved) = &curved {
        outcomes.extend(local.outcomes());
        danger = local.danger(&outcomes, at.period);
        let chaos =
            outcomes.iter_mut().filter_map(|outcome| Some((Speeds::of(outcome.mu)?, outcome.robust_chaos.as_mut()?)));
        for (speeds, chaos) in chaos {
            if let Some(certificate) = &certificate {
                certificate.prove(chaos, speeds);
            }
        }
        if let (Some(certificate), Some(danger)) = (&certificate, &mut danger) {
            certificate.prove_danger(danger, &local);
        }
        ranges = validity::ranges(model, &cam, &at, &local, curved);
    }
    let published = match compare_published(model, &at, &closed, normal_form.as_ref().ok()) {
        Err(error @ PublishedError::OtherModel) => {
            log.leave_out("published", error);
            Vec::new()
        }
        result => log.keep("published", result).unwrap_or_default(),
    };

    let agrees = log.agrees(&comparisons) && published.iter().all(|number| number.as_found);
    Ok(Verification {
        model: ModelLabel::of(model),
        at,
        others,
        map,
        uncertainty,
        certificate,
        routes,
        orbits,
        comparisons,
        border,
        normal_form,
        classification,
        conditions: conditions(&local),
        outcomes,
        danger,
        second_order: curved,
        rounded_corner,
        ranges,
        published,
        skipped: log.0,
        agrees,
    })
}

type Proving = JoinHandle<Result<Vec<Outcome>, CertifyError>>;

/// Waits for the certificate. A refusal is a failure, unless the corner impact is not classified either.
fn certificate(
    proving: Option<Proving>,
    (is_unclassified, is_beyond): (bool, bool),
    log: &mut Log,
) -> Option<Certificate> {
    let name = RouteName::Certificate;
    let Some(proving) = proving else {
        let beyond = "takes only splines through the rows of a table, not near them, with a thousand rows at most, and no contour";
        log.leave_out(name, if is_beyond { beyond } else { "left out by --no-external" });
        return None;
    };
    let outcome = proving.join().map(|proved| proved.map(|mut outcomes| outcomes.pop()));
    match outcome {
        Ok(Ok(Some(Outcome::Certificate(certificate)))) => return Some(*certificate),
        Ok(Ok(Some(Outcome::Refused(why)))) if is_unclassified => log.leave_out(name, why),
        Ok(Ok(Some(Outcome::Refused(why)))) => log.fail(name, why),
        Ok(Err(error)) => log.fail(name, error),
        Ok(Ok(None)) | Err(_) => log.fail(name, "it ended without an answer"),
    }
    None
}

type Started = (Program, Option<JoinHandle<Result<Outside, PythonError>>>);

/// Starts every program outside, or none.
fn start_outside(model: &Model, external: External) -> Result<Vec<Started>, LocateError> {
    let told = external::told(model, model.study()?)?;
    let start = |program: Program| {
        let told = told.clone();
        std::thread::spawn(cancel::carry(move || external::run(program, &told)))
    };
    Ok(PROGRAMS.map(|program| (program, (external == External::Run).then(|| start(program)))).into())
}
