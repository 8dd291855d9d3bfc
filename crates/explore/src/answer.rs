//! Function from question to answer.

use corner_impact::cam::Cam;
use corner_impact::command::{command, shell_word};
use corner_impact::known::Evidence;
use corner_impact::model::{Model, Units};
use corner_impact::orbit::long_run::Budget;
use corner_impact::orbit::{Parameter, Search};
use corner_impact::progress::Unwatched;
use corner_impact::study::attractors::{Resolution, Step};
use corner_impact::study::basins::{BasinSection, SectionStarts};
use corner_impact::study::design::{Asked, Design, design};
use corner_impact::study::local::NextToCorner;
use corner_impact::study::orbit::{OrbitQuery, Orbits, orbits};
use corner_impact::study::simulate::Simulation;
use corner_impact::study::speeds::{SpeedSurvey, speeds};
use corner_impact::study::survey::{Over, long_run};
use corner_impact::study::verify::{External, Verification, verify};
use serde::Serialize;

use crate::diagram::{Diagram, GridBasins};
use crate::machine::CamShape;
use crate::model::{ModelPage, Template};
use crate::motion::{LongRunFound, MotionFound};
use crate::question::{AxisRequest, BasinsRequest, PageQuestion, View};
use crate::{ChangedModel, PageRefusal};

/// Answer: results and their evidence, or the reason why there are none.
#[derive(Serialize)]
pub struct PageAnswer {
    /// View of the question.
    pub view: &'static str,
    /// Command line that computes the same results; `None` if no command does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub command: Option<String>,
    /// Evidence for the answer as a whole; parts may have separate evidence.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub known: Option<Evidence>,
    /// Results of the view.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub found: Option<Found>,
    /// Reason why there are no results.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<PageRefusal>,
}

/// Results of a view: the document of the command with the same subject, if there is one.
#[derive(Serialize)]
#[serde(untagged)]
pub enum Found {
    Model(Box<ModelPage>),
    Template(Template),
    Cam(Box<CamShape>),
    Motion(MotionFound),
    LongRun(LongRunFound),
    Diagram(Diagram),
    Speeds(Box<SpeedSurvey>),
    Orbit(Box<Orbits>),
    Basins(Box<GridBasins>),
    Verify(Box<Verification>),
    Local(NextToCorner),
    Design(Box<Design>),
}

impl PageAnswer {
    /// Builds an answer with only a reason.
    pub(crate) fn refused(view: &'static str, error: PageRefusal) -> Self {
        Self { view, command: None, known: None, found: None, error: Some(error) }
    }
}

/// Answers a question, and returns the units in which the answer is to be written.
pub fn answer(question: &PageQuestion) -> (PageAnswer, Units) {
    let view = question.view.name();
    if let View::Template { law } = &question.view {
        return match Template::of(law) {
            Ok(found) => (whole(view, None, Evidence::Read, Found::Template(found)), Units::default()),
            Err(error) => (PageAnswer::refused(view, error), Units::default()),
        };
    }
    let [given, model] = match question.model.read() {
        Ok(models) => models,
        Err(error) => return (PageAnswer::refused(view, error), Units::default()),
    };
    let found = find(&question.model, &given, &model, &question.view);
    let answer = match found {
        Ok((found, options, known)) => {
            let command = options.map(|(name, options)| command(name, &model, &options));
            whole(view, command, known, found)
        }
        Err(error) => PageAnswer::refused(view, error),
    };
    (answer, model.units)
}

fn whole(view: &'static str, command: Option<String>, known: Evidence, found: Found) -> PageAnswer {
    PageAnswer { view, command, known: Some(known), found: Some(found), error: None }
}

/// Results of a view, the command with its options, and the evidence.
type Finding = (Found, Option<(&'static str, String)>, Evidence);

fn find(changed: &ChangedModel, given: &Model, model: &Model, view: &View) -> Result<Finding, PageRefusal> {
    let again = |name, options: String| Some((name, options));
    Ok(match view {
        View::Template { .. } => return Err(PageRefusal::of_words("template: needs no model")),
        View::Model => (Found::Model(Box::new(ModelPage::of(changed, given, model)?)), None, Evidence::Read),
        View::Cam => {
            (Found::Cam(Box::new(CamShape::of(model)?)), again("cam", "--json".to_owned()), Evidence::Computed)
        }
        View::Motion(asked) => {
            let found = MotionFound::of(model, asked)?;
            let length = asked.transient.saturating_add(asked.revolutions);
            let shown = match asked.samples {
                0 => "--events events.csv".to_owned(),
                samples => format!("--drawn {} --points-per-revolution {samples} --out motion.csv", asked.revolutions),
            };
            let options = format!("--rpm {} --revolutions {length}{} {shown}", asked.rpm, asked.start.options());
            (Found::Motion(found), again("simulate", options), Evidence::Computed)
        }
        View::LongRun { rpm, start, budget } => {
            let simulation = Simulation::new(model, *rpm, start.start()?)?;
            let judged = long_run(&simulation.machine, simulation.first, budget.budget())?;
            let options = format!("--rpm {rpm}{}{} --lyapunov --json", start.options(), budget.options());
            (Found::LongRun(LongRunFound::of(judged)), again("simulate", options), Evidence::Sampled)
        }
        View::Diagram(asked) => {
            let attractors =
                if asked.attractors { format!(" --attractors --patience {}", asked.patience) } else { String::new() };
            let options = format!(
                "{} --transient {} --record {}{attractors}{} --out diagram.csv",
                asked.over.options(asked.rpm),
                asked.transient,
                asked.record,
                asked.start.options()
            );
            (Found::Diagram(Diagram::of(model, asked)?), again("diagram", options), Evidence::Computed)
        }
        View::Speeds { rpm, over, starts, budget } => {
            let options = format!("{} --starts {starts}{} --json", over.options(*rpm), budget.options());
            let found = survey(model, *rpm, over, (*starts, budget.budget()))?;
            (Found::Speeds(Box::new(found)), again("speeds", options), Evidence::Sampled)
        }
        View::Orbit { rpm, revolutions, impacts } => {
            let wanted = OrbitQuery::All(Search { revolutions: *revolutions, impacts: *impacts });
            let found = orbits(model, *rpm, wanted, &Unwatched)?;
            let impacts = impacts.map_or(String::new(), |impacts| format!(" --impacts {impacts}"));
            let options = format!("--rpm {rpm} --revolutions {revolutions}{impacts} --json");
            (Found::Orbit(Box::new(found)), again("orbit", options), Evidence::Computed)
        }
        View::Basins(asked) => {
            (Found::Basins(Box::new(basins(model, asked)?)), again("basins", basins_options(asked)), Evidence::Sampled)
        }
        View::Verify => {
            let found = verify(model, External::LeftOut)?;
            (Found::Verify(Box::new(found)), again("verify", "--no-external --json".to_owned()), Evidence::Computed)
        }
        View::Local => {
            let found = verify(model, External::LeftOut)?;
            (Found::Local(NextToCorner::new(model, &Cam::new(model)?, &found)?), None, Evidence::Computed)
        }
        View::Design { rpm, count, needs } => {
            let needs = needs.iter().map(|text| Ok((text.clone(), text.parse().map_err(need(text))?)));
            let needs = needs.collect::<Result<Vec<_>, PageRefusal>>()?;
            let asked = Asked { rpm: *rpm, speeds: *count, needs, ..Asked::default() };
            let found = design(model, &asked, &Unwatched)?;
            let range = rpm.map_or(String::new(), |[low, high]| format!("--rpm {low}:{high} "));
            let needs: String = asked.needs.iter().map(|(text, _)| format!(" --need {}", shell_word(text))).collect();
            (
                Found::Design(Box::new(found)),
                again("design", format!("{range}--speeds {count}{needs} --json")),
                Evidence::Computed,
            )
        }
    })
}

fn need(text: &str) -> impl Fn(String) -> PageRefusal {
    move |words| PageRefusal::of_words(format!("need \"{text}\": {words}"))
}

/// Attractors over an axis, as in the command `speeds`.
fn survey(
    model: &Model,
    rpm: Option<f64>,
    over: &AxisRequest,
    (starts, budget): (usize, Budget),
) -> Result<SpeedSurvey, PageRefusal> {
    let values = over.values()?;
    let parameter = Parameter::named(model, &over.name)?;
    let range = [values.low, values.high];
    let count = u32::try_from(values.count).unwrap_or(u32::MAX);
    let resolution = Resolution { budget, ..Resolution::new(Step::for_values(range, count, values.spacing), starts) };
    Ok(speeds(&Over::new(model, parameter, rpm)?, range, &resolution, &Unwatched)?)
}

/// Largest number of cells of a grid on the page.
const MOST_CELLS: usize = 100_000;

/// Basins of a grid, as in the command `basins`.
fn basins(model: &Model, asked: &BasinsRequest) -> Result<GridBasins, PageRefusal> {
    if asked.grid[0].saturating_mul(asked.grid[1]) > MOST_CELLS || asked.grid.contains(&0) {
        let [columns, rows] = asked.grid;
        let words = format!("basins: grid = {columns}x{rows}: must have at least 1 cell and at most {MOST_CELLS}");
        return Err(PageRefusal::of_words(words));
    }
    let section = BasinSection::new(model, asked.rpm, asked.cam_angle_rad)?;
    let grid = section.grid(asked.grid, asked.position, asked.velocity)?;
    let found = SectionStarts::Grid(grid).basins(&section.map.machine, Budget::SURVEY, None, &Unwatched)?;
    let border = asked.boundary.then(|| section.border(&grid, &found));
    Ok(GridBasins::of(found, &grid, border.as_ref()))
}

fn basins_options(asked: &BasinsRequest) -> String {
    let [columns, rows] = asked.grid;
    let range = |name: &str, ends: Option<[f64; 2]>| {
        ends.map_or(String::new(), |[low, high]| format!(" --{name}={low}:{high}"))
    };
    format!(
        "--rpm {} --strobe {} --grid {columns}x{rows}{}{} --out basins.csv",
        asked.rpm,
        asked.cam_angle_rad,
        range("position", asked.position),
        range("velocity", asked.velocity)
    )
}
