//! All results for one model in one value: the contents of the HTML page.

pub(crate) mod quantities;

use serde::Serialize;

use crate::figures::{
    Captioned, FigureContext, NO_STUDY, RenderedFigure, corner_marks, design_figure, impacts_by_speed, plates,
    speeds_figure,
};
use crate::report::quantities::{ReportQuantity, quantities};
use crate::show::words;
use corner_impact::agreement::by_quantity;
use corner_impact::cam::{Cam, Jet, Side};
use corner_impact::command::command;
use corner_impact::measured::Measured;
use corner_impact::model::{Model, ModelError, Units};
use corner_impact::paper::{Claims, Context, LedgerError};
use corner_impact::progress::Watch;
use corner_impact::study::attractors::{AttractorsError, Resolution, Step};
use corner_impact::study::cam::CamSheet;
use corner_impact::study::design::contact::{Contact, Separation};
use corner_impact::study::design::denser::DRAWN;
use corner_impact::study::design::{Asked, Design, SeparationPlace, design, known, separation_places};
use corner_impact::study::speeds::{SpeedSurvey, speeds, usual_range};
use corner_impact::study::survey::{Over, Spacing};
use corner_impact::study::verify::{ComparisonTally, External, Verification, verify_watched};
use corner_impact::uncertainty::{PlausibleMachines, SourcedUncertainty};
use corner_impact_plot::Look;
use corner_impact_plot::layout::WIDTH;

/// Report on one model; serializes to the document `corner-impact/report/1`.
#[derive(Clone, Debug)]
pub struct Report {
    /// Whether no check disagrees.
    pub agrees: bool,
    /// Whether follower and cam are the paper's.
    pub is_paper: bool,
    /// Description of the model.
    pub model: ModelSheet,
    /// Corner impact and its map by every route, or the reason why there is none.
    pub verification: Result<Verification, String>,
    /// The paper's statements, if the model is the paper's.
    pub claims: Option<Claims>,
    /// Speed at which the follower first leaves the cam, from the contact force.
    pub separation: Separation,
    /// Uncertainty of the machine in the separation speed, rpm; `None` if the machine is exact.
    pub separation_error: Option<SourcedUncertainty>,
    /// Places that compete for the first separation; empty if its angle is certain.
    pub separation_places: Vec<SeparationPlace>,
    /// Accuracy of the cam, if it is measured.
    pub measured: Option<Measured>,
    /// Contact force below separation; `None` if the follower leaves the cam at any speed, or never.
    pub margin: Option<Margin>,
    /// Look of the figures.
    pub look: Look,
    /// Units of the model's lengths in the report.
    pub units: Units,
    /// The model.
    pub parsed: Model,
    /// Motions at other speeds, or the reason why they are unknown.
    pub speeds: Result<SpeedSurvey, String>,
    /// Impact phases over these speeds: the picture of the answer.
    pub overview: Option<RenderedFigure>,
    /// Loads on cam and follower over the range; `None` if a run cannot continue.
    pub design: Option<Design>,
    /// Figure of these loads.
    pub loads: Option<RenderedFigure>,
    /// Figure of the overview with every attractor and its share of the starts.
    pub attractors: Option<RenderedFigure>,
    /// Figures, in the paper's order.
    pub plates: Vec<RenderedFigure>,
    /// Commands that reproduce the report, each with its purpose.
    pub commands: Vec<(String, &'static str)>,
}

/// Remaining contact force below the speed at which it becomes zero.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Margin {
    /// Separation speed, at which the force becomes zero, rpm.
    pub separation_rpm: f64,
    /// Speed of this margin, rpm.
    pub speed_rpm: f64,
    /// Least force over a turn of the cam at that speed, and on the resting cam, in `force_unit`.
    pub least_force: [f64; 2],
    /// Cam angle of the least force at that speed, deg.
    pub cam_angle_deg: f64,
    /// Unit of the force.
    pub force_unit: String,
}

/// Computes the margin at four fifths of the separation speed.
fn margin(contact: &Contact<'_>, units: &Units) -> Option<Margin> {
    const SHARE: f64 = 0.8;
    let Separation::At { rpm, .. } = contact.separation() else { return None };
    let [there, still] = [SHARE * rpm, 0.0].map(|rpm| contact.least(rpm));
    Some(Margin {
        separation_rpm: rpm,
        speed_rpm: SHARE * rpm,
        least_force: [there, still].map(|least| units.force.told(least.value)),
        cam_angle_deg: there.angle.to_degrees(),
        force_unit: units.force.name().to_owned(),
    })
}

/// Version of this program.
pub(crate) const VERSION: &str = env!("CARGO_PKG_VERSION");

corner_impact::document!(Report as it {
    schema: "corner-impact/report/1",
    version: VERSION,
    agrees: it.agrees,
    is_paper: it.is_paper,
    headline: Headline(it),
    model: it.model,
    verification: it.verification.as_ref().ok(),
    nothing_to_verify: it.verification.as_ref().err(),
    corner_deg: it.verification.as_ref().ok().map(|found| found.at.corner.angle.to_degrees()),
    tables: it
        .verification
        .iter()
        .flat_map(|found| [Side::Minus, Side::Plus].map(|side| MapTable { found, side }))
        .collect::<Vec<_>>(),
    quantities: it.verification.iter().flat_map(|found| by_quantity(&found.comparisons)).collect::<Vec<_>>(),
    claims: it.claims,
    separation_rpm: it.margin.as_ref().map(|margin| margin.separation_rpm),
    margin: it.margin,
    design if_any: it.design,
    speeds: it.speeds.as_ref().ok(),
    no_speeds: it.speeds.as_ref().err(),
    plates: it.plates,
    commands: it.commands,
});

/// Summary of the findings.
struct Headline<'a>(&'a Report);

corner_impact::document!(Headline<'_> as it {
    comparisons: it.0.tally().comparisons,
    agreeing: it.0.tally().agreeing,
    following: it.0.tally().following,
    following_agreeing: it.0.tally().following_agreeing,
    shared_decimals: it.0.tally().shared_decimals,
    routes: it.0.verification.iter().flat_map(names).collect::<Vec<_>>(),
    failed: it.0.failed(),
    printed: it.0.tally().printed,
    printed_right: it.0.tally().printed_right,
    printed_wrong: it.0.tally().printed_wrong,
    printed_otherwise: it.0.tally().printed_otherwise,
    claims_otherwise: it.0.claims_otherwise(),
});

/// Matrices of one side by every route.
struct MapTable<'a> {
    found: &'a Verification,
    side: Side,
}

corner_impact::document!(MapTable<'_> as it { side: it.side, routes: names(it.found), rows: it.found.entries(it.side) });

/// Names of the routes that ran.
fn names(found: &Verification) -> Vec<String> {
    found.routes_by_name().map(|route| words::route(route.name)).collect()
}

/// Description of the model.
#[derive(Clone, Debug, Serialize)]
pub struct ModelSheet {
    /// Name of the model.
    pub name: String,
    /// Source of its numbers.
    pub source: String,
    /// Model file as given.
    pub file: String,
    /// All numbers of the model.
    pub quantities: Vec<ReportQuantity>,
    /// Segments and corners of the cam.
    pub cam: CamSheet,
}

/// Reason why there is no report.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ReportError {
    /// Impossible model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// Ledger that cannot be checked against the model.
    #[error(transparent)]
    Ledger(#[from] LedgerError),
}

/// Number of speeds for the section on speeds, and of starts at each speed.
const SPEEDS: (u32, usize) = (30, 12);
/// Number of speeds and of starts for the paper's machine, whose chaos is quick to simulate.
const PAPERS_SPEEDS: (u32, usize) = (100, 32);
/// Number of speeds at which loads are computed.
const LOADED: u32 = 21;
/// Share of the work that is done at the end of each stage.
const VERIFIED: f64 = 0.1;
const HELD: f64 = 0.25;
const SURVEYED: f64 = 0.55;
const LOADS: f64 = 0.58;

impl Report {
    /// Computes the report on a model, at speeds of this range, rpm, or of the model's own.
    ///
    /// The report of a model without a corner impact states this.
    pub fn of(
        model: &Model,
        external: External,
        rpm: Option<[f64; 2]>,
        watch: &dyn Watch,
    ) -> Result<Self, ReportError> {
        let part = |from, to| Part { watch, from, to };
        let cam = Cam::new(model)?;
        let is_paper = model.is_the_papers()?;
        let verification = verify_watched(model, external, &part(0.0, VERIFIED)).map_err(|error| match model.study {
            Some(_) => error.to_string(),
            None => NO_STUDY.into(),
        });
        let claims = match &verification {
            Ok(found) if is_paper => Some(Claims::hold(&Context::new(model, &cam, found)?, &part(VERIFIED, HELD))?),
            _ => None,
        };
        let range = rpm.map_or_else(|| usual_range(model), Ok)?;
        let (count, starts) = if is_paper { PAPERS_SPEEDS } else { SPEEDS };
        let resolution = Resolution::new(Step::for_values(range, count, Spacing::Linear), starts);
        let surveyed = Over::speed(model).map_err(AttractorsError::from);
        let surveyed = surveyed.and_then(|over| speeds(&over, range, &resolution, &part(HELD, SURVEYED)));
        let speeds = surveyed.map_err(|error| error.to_string());
        let overview = speeds.as_ref().ok().map(|found| overview(model, &cam, found));
        let attractors = speeds.as_ref().ok().map(|found| attractors(model, &cam, found));
        let asked = Asked { rpm: Some(range), speeds: LOADED, drawn: Some(DRAWN), ..Asked::default() };
        let design = design(model, &asked, &part(SURVEYED, LOADS)).ok();
        let loads = design.as_ref().map(|found| loads(model, found, range));
        let subject = FigureContext::with(model, verification.clone(), rpm)?;
        let drawing = part(LOADS, 1.0);
        let plates = plates(&subject, &mut |done, total| drawing.at("the figures", done as u64, total as u64));
        let agrees = verification.as_ref().map_or(true, |found| found.agrees)
            && claims.as_ref().is_none_or(|claims| claims.agrees);
        let sheet = ModelSheet {
            name: model.name.clone(),
            source: model.source.clone(),
            file: model.file().to_owned(),
            quantities: quantities(model),
            cam: CamSheet::new(model, &cam, Jet::HIGHEST_JUMP)?,
        };
        let commands = commands(model, range, verification.is_ok());
        let contact = Contact::new(&cam, model.follower);
        let machines = PlausibleMachines::of(model, &cam)?;
        let (separation, separation_errors) = known(contact.separation(), &machines);
        let separation_places = separation_places(separation, &machines);
        let (margin, units) = (margin(&contact, &model.units), model.units.clone());
        Ok(Self {
            agrees,
            is_paper,
            model: sheet,
            verification,
            claims,
            separation,
            separation_error: separation_errors.map(|[error, _]| error),
            measured: machines.measured(),
            separation_places,
            margin,
            look: Look::default(),
            units,
            parsed: model.clone(),
            speeds,
            overview,
            design,
            loads,
            attractors,
            plates,
            commands,
        })
    }

    /// Counts of comparisons and printed numbers by their result; empty without a corner impact.
    pub(crate) fn tally(&self) -> ComparisonTally {
        self.verification.as_ref().map(Verification::tally).unwrap_or_default()
    }

    /// Routes that should have run and failed.
    pub(crate) fn failed(&self) -> Vec<String> {
        let skipped = self.verification.iter().flat_map(|found| &found.skipped);
        skipped.filter(|skipped| skipped.failed).map(|skipped| words::spoken(&skipped.route)).collect()
    }

    /// Number of statements whose check disagrees with the ledger.
    pub(crate) fn claims_otherwise(&self) -> usize {
        self.claims.iter().flat_map(|ledger| &ledger.claims).filter(|claim| !claim.as_found).count()
    }
}

/// Figure of impact phases over speeds.
fn overview(model: &Model, cam: &Cam, found: &SpeedSurvey) -> RenderedFigure {
    let figure = impacts_by_speed(found, &corner_marks(cam));
    let title = figure.title.clone();
    let [low, high] = found.range;
    let several =
        if found.coexistence.is_empty() { "" } else { " Grey marks speeds at which runs settle on several motions." };
    let caption =
        format!("Cam angles at which the follower of {} hits the cam, {low} to {high} rpm.{several}", model.name);
    let command = command("speeds", model, &format!("--rpm {low}:{high} --out impacts.svg"));
    RenderedFigure { id: "overview", place: "", title, command, drawn: Ok(Captioned { figure, caption }) }
}

/// Figure of the loads on cam and follower.
fn loads(model: &Model, found: &Design, [low, high]: [f64; 2]) -> RenderedFigure {
    let figure = design_figure(found).in_units(|unit| model.units.spelled(unit));
    let title = figure.title.clone();
    let caption = format!(
        "The least and the greatest force between cam and follower of {}. Above the separation speed, force, impacts, gap, time off the cam \
         and energy are the largest values of runs from four starts.",
        model.name
    );
    let command = command("design", model, &format!("--rpm {low}:{high} --out loads.svg"));
    RenderedFigure { id: "loads", place: "", title, command, drawn: Ok(Captioned { figure, caption }) }
}

/// Figure of the attractors of runs.
fn attractors(model: &Model, cam: &Cam, found: &SpeedSurvey) -> RenderedFigure {
    let figure = speeds_figure(found, &corner_marks(cam), WIDTH);
    let title = figure.title.clone();
    let caption = "Motions on which runs settle, against the speed: the cam angles of the impacts, a bar for each attractor, and the share of \
                   the starts that settle on it."
        .to_owned();
    let [low, high] = found.range;
    let command = command("speeds", model, &format!("--rpm {low}:{high} --out attractors.svg"));
    RenderedFigure { id: "attractors", place: "", title, command, drawn: Ok(Captioned { figure, caption }) }
}

/// Part of the work, which reports its progress as a share of the whole.
struct Part<'a> {
    watch: &'a dyn Watch,
    from: f64,
    to: f64,
}

impl Watch for Part<'_> {
    fn at(&self, what: &str, done: u64, total: u64) {
        const STEPS: f64 = 1000.0;
        let share = if total > 0 { done as f64 / total as f64 } else { 0.0 };
        self.watch.at(what, (STEPS * (self.from + (self.to - self.from) * share)) as u64, STEPS as u64);
    }
}

fn commands(model: &Model, [low, high]: [f64; 2], verified: bool) -> Vec<(String, &'static str)> {
    let again = |name: &str, what| (command(name, model, ""), what);
    let mut commands = vec![again("report", "writes this page")];
    if verified {
        commands.push(again("verify", "finds the corner impact, computes its map by every route, and compares"));
        commands.push(again("claims", "checks the statements of the paper with this model"));
    }
    commands.push(again("cam", "lists segments and corners of the cam"));
    let speeds = command("speeds", model, &format!("--rpm {low}:{high}"));
    commands.push((speeds, "finds the motions at each speed, with more speeds than here"));
    commands
}
