//! Questions of the page: a model with changed numbers, and a view of it.

use std::collections::BTreeMap;

use corner_impact::flight::State;
use corner_impact::model::{Model, OSORIO_2008};
use corner_impact::orbit::Parameter;
use corner_impact::orbit::long_run::Budget;
use corner_impact::study::survey::{Axis, Placed, Spacing, Start, Values, limits};
use serde::Deserialize;

use crate::PageRefusal;

/// Question of the page.
#[derive(Clone, Debug, Deserialize)]
pub struct PageQuestion {
    /// Model of the question.
    #[serde(default)]
    pub model: ChangedModel,
    /// Requested view.
    #[serde(flatten)]
    pub view: View,
}

/// Text of a model file with changed numbers; the paper's model if it has no text.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChangedModel {
    /// Name of the file in commands and error messages.
    #[serde(default)]
    pub file: Option<String>,
    /// Text of the file.
    #[serde(default)]
    pub text: Option<String>,
    /// Changed numbers by name, as for `--set NAME=VALUE`.
    #[serde(default)]
    pub set: BTreeMap<String, f64>,
}

impl ChangedModel {
    /// Reads the model as in its file, and with its changes.
    pub(crate) fn read(&self) -> Result<[Model; 2], PageRefusal> {
        let given = match (&self.file, &self.text) {
            // A question cannot read any other file of this machine.
            (Some(file), Some(text)) => Model::parse_alone(file, text)?,
            (None, Some(text)) => Model::parse_alone("model.toml", text)?,
            (Some(file), None) => Model::parse(file, OSORIO_2008)?,
            (None, None) => Model::built_in()?,
        };
        let set: Vec<(String, f64)> = self.set.iter().map(|(name, value)| (name.clone(), *value)).collect();
        let changed = if set.is_empty() { given.clone() } else { given.changed(&set)? };
        Ok([given, changed])
    }
}

/// View of a model.
#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "view", rename_all = "snake_case")]
pub enum View {
    /// Numbers, notes and corners of the model.
    Model,
    /// Text of a model file as a starting point.
    Template {
        /// Law of the cam.
        law: String,
    },
    /// Lift and shape of the cam.
    Cam,
    /// Run at one speed, moment by moment.
    Motion(MotionRequest),
    /// Long-run motion of a run.
    LongRun {
        /// Speed, rpm.
        rpm: f64,
        /// Start of the run.
        #[serde(default)]
        start: StartRequest,
        /// Budget of the run.
        #[serde(default)]
        budget: BudgetName,
    },
    /// Impacts as a function of the speed or another number.
    Diagram(DiagramRequest),
    /// Attractors as a function of the speed or another number, with the beginning and end of each.
    Speeds {
        /// Speed, rpm, if another number varies.
        #[serde(default)]
        rpm: Option<f64>,
        /// Number that varies.
        over: AxisRequest,
        /// Number of starts at each value.
        #[serde(default = "few_starts")]
        starts: usize,
        /// Budget of the runs at each value.
        #[serde(default)]
        budget: BudgetName,
    },
    /// Periodic orbits at one speed.
    Orbit {
        /// Speed, rpm.
        rpm: f64,
        /// Number of revolutions in a period.
        #[serde(default = "one")]
        revolutions: u64,
        /// Number of impacts in a period; any number if absent.
        #[serde(default)]
        impacts: Option<usize>,
    },
    /// Motion on which each start of a grid ends.
    Basins(BasinsRequest),
    /// Corner impact, its map and its scenario.
    Verify,
    /// Orbits of the local map, compared with those of the machine.
    Local,
    /// Contact forces, separation and needs.
    Design {
        /// Lowest and highest speed, rpm; around the separation if absent.
        #[serde(default)]
        rpm: Option<[f64; 2]>,
        /// Number of speeds.
        #[serde(default = "some_speeds")]
        count: u32,
        /// Needs, as for `--need`.
        #[serde(default)]
        needs: Vec<String>,
    },
}

impl View {
    /// Name in questions and answers.
    pub(crate) fn name(&self) -> &'static str {
        match self {
            Self::Model => "model",
            Self::Template { .. } => "template",
            Self::Cam => "cam",
            Self::Motion(_) => "motion",
            Self::LongRun { .. } => "long_run",
            Self::Diagram(_) => "diagram",
            Self::Speeds { .. } => "speeds",
            Self::Orbit { .. } => "orbit",
            Self::Basins(_) => "basins",
            Self::Verify => "verify",
            Self::Local => "local",
            Self::Design { .. } => "design",
        }
    }
}

fn one() -> u64 {
    1
}

fn few_starts() -> usize {
    8
}

fn some_speeds() -> u32 {
    41
}

/// Budget of a run by its name.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BudgetName {
    /// Budget of `simulate` and `speeds`.
    #[default]
    Whole,
    /// Budget of `chart`, for answers while a number is dragged and for events of many values.
    Quick,
}

impl BudgetName {
    /// Returns the budget.
    pub(crate) fn budget(self) -> Budget {
        match self {
            Self::Whole => Budget::SURVEY,
            Self::Quick => Budget::CHART,
        }
    }

    /// Options of a command for this budget, each after a blank.
    pub(crate) fn options(self) -> String {
        let Budget { transient, record, patience, .. } = self.budget();
        format!(" --transient {transient} --record {record} --patience {patience}")
    }
}

/// Start of a run: at rest on the cam if no field is given.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StartRequest {
    /// Cam angle, rad.
    #[serde(default)]
    pub cam_angle_rad: f64,
    /// Position, in the model's unit of length.
    #[serde(default)]
    pub position: Option<f64>,
    /// Velocity.
    #[serde(default)]
    pub velocity: Option<f64>,
    /// Velocity relative to the cam with which the follower leaves it, instead of position and velocity.
    #[serde(default)]
    pub relative_velocity: Option<f64>,
}

impl StartRequest {
    /// Builds the start.
    pub(crate) fn start(self) -> Result<Start, PageRefusal> {
        let cam_angle = self.cam_angle_rad;
        match (self.position, self.velocity, self.relative_velocity) {
            _ if !(0.0..std::f64::consts::TAU).contains(&cam_angle) => {
                Err(PageRefusal::of_words(format!("start: cam_angle_rad = {cam_angle}: must be from 0 to below 2 pi")))
            }
            (None, None, leaving) => Ok(Start { cam_angle, follower: Placed::OnCam(leaving.unwrap_or(0.0)) }),
            (Some(position), Some(velocity), None) => {
                Ok(Start { cam_angle, follower: Placed::At(State { position, velocity }) })
            }
            _ => Err(PageRefusal::of_words("start: give both position and velocity, or relative_velocity alone")),
        }
    }

    /// Options of a command for this start, each after a blank.
    pub(crate) fn options(self) -> String {
        let state = self.position.zip(self.velocity);
        let leaving =
            self.relative_velocity.map_or(String::new(), |velocity| format!(" --relative-velocity {velocity}"));
        let state = state.map_or(leaving, |(position, velocity)| format!(" --state={position},{velocity}"));
        if self.cam_angle_rad == 0.0 { state } else { format!(" --start-angle {}{state}", self.cam_angle_rad) }
    }
}

/// Run at one speed.
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct MotionRequest {
    /// Speed, rpm.
    pub rpm: f64,
    /// Start of the run.
    #[serde(default)]
    pub start: StartRequest,
    /// Number of revolutions before those that are shown.
    #[serde(default = "usual_transient")]
    pub transient: u64,
    /// Number of revolutions that are shown.
    #[serde(default = "two")]
    pub revolutions: u64,
    /// Number of moments in each revolution; 0 for the events alone.
    #[serde(default = "each_degree")]
    pub samples: u32,
}

fn usual_transient() -> u64 {
    300
}

fn two() -> u64 {
    2
}

fn each_degree() -> u32 {
    360
}

/// Diagram as a function of one number.
#[derive(Clone, Debug, Deserialize)]
pub struct DiagramRequest {
    /// Speed, rpm, if another number varies.
    #[serde(default)]
    pub rpm: Option<f64>,
    /// Number that varies.
    pub over: AxisRequest,
    /// Start of the run at each value.
    #[serde(default)]
    pub start: StartRequest,
    /// Number of revolutions before those that are recorded.
    #[serde(default = "usual_transient")]
    pub transient: u64,
    /// Number of revolutions that are recorded.
    #[serde(default = "hundred")]
    pub record: u64,
    /// Whether to record all attractors found from 64 starts.
    #[serde(default)]
    pub attractors: bool,
    /// Number of revolutions for which runs that do not settle are followed before they are called chaotic, if attractors are recorded.
    #[serde(default = "usual_patience")]
    pub patience: u64,
}

fn usual_patience() -> u64 {
    Budget::SURVEY.patience
}

fn hundred() -> u64 {
    100
}

/// Values of a number.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AxisRequest {
    /// Name of the number: `rpm`, or as for `--over`.
    pub name: String,
    /// Lowest value.
    pub low: f64,
    /// Highest value.
    pub high: f64,
    /// Number of values.
    #[serde(default = "many")]
    pub count: usize,
    /// Whether values are spaced by their logarithm.
    #[serde(default)]
    pub log: bool,
}

fn many() -> usize {
    200
}

impl AxisRequest {
    /// Largest number of values of a diagram on the page.
    const MOST: usize = 20_000;

    /// Returns the parameter and its values.
    pub(crate) fn axis(&self, model: &Model) -> Result<Axis, PageRefusal> {
        Ok(Axis::new(Parameter::named(model, &self.name)?, &self.values()?))
    }

    /// Returns the values.
    pub(crate) fn values(&self) -> Result<Values, PageRefusal> {
        let spacing = if self.log { Spacing::Logarithmic } else { Spacing::Linear };
        let values = Values { low: self.low, high: self.high, count: self.count, spacing };
        if self.count > Self::MOST {
            return Err(PageRefusal::of_words(format!("over: count = {}: must be at most {}", self.count, Self::MOST)));
        }
        let what = if self.name == "rpm" { "speed" } else { "value" };
        let values = values.checked(what).map_err(|words| PageRefusal::of_words(format!("over: {words}")))?;
        if self.name == "rpm" {
            limits::speed(values.low)
                .map_err(|words| PageRefusal::of_words(format!("rpm = {}: {words}", values.low)))?;
        }
        Ok(values)
    }

    /// Options of a command for this axis; `rpm` is the speed if another number varies.
    pub(crate) fn options(&self, rpm: Option<f64>) -> String {
        let Self { name, low, high, count, log } = self;
        let log = if *log { ":log" } else { "" };
        match rpm {
            None if name == "rpm" => format!("--rpm {low}:{high}:{count}{log}"),
            _ => format!("--rpm {} --over {name}={low}:{high}:{count}{log}", rpm.unwrap_or(f64::NAN)),
        }
    }
}

/// Grid of starts on a section.
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct BasinsRequest {
    /// Speed, rpm.
    pub rpm: f64,
    /// Angle of the section, rad.
    #[serde(default)]
    pub cam_angle_rad: f64,
    /// Cells along the positions and along the velocities.
    pub grid: [usize; 2],
    /// Lowest and highest position; around the orbits if absent.
    #[serde(default)]
    pub position: Option<[f64; 2]>,
    /// Lowest and highest velocity.
    #[serde(default)]
    pub velocity: Option<[f64; 2]>,
    /// Whether to search the saddles and the curves that separate the basins, too, which may take seconds.
    #[serde(default)]
    pub boundary: bool,
}
