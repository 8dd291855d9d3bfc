//! `corner-impact speeds [MODEL]`.

use std::path::PathBuf;

use super::numbers::{NamedSpan, Span, Speeds, axis, positive, speeds as typed};
use super::over::{values, varied};
use super::picture::{PictureArguments, Target, is_standard, picture_or_table};
use super::start::{BudgetArguments, StartArguments};
use super::{AnswerArguments, CommandError, Exit, ModelArgument, Session, progress::watched};
use crate::figures::{corner_marks, speeds_figure};
use crate::show::csv;
use corner_impact::cam::Cam;
use corner_impact::orbit::Parameter;
use corner_impact::orbit::long_run::Budget;
use corner_impact::study::attractors::{Resolution, Step};
use corner_impact::study::speeds::{speeds, usual_range};
use corner_impact::study::survey::{Over, Spacing};

/// Finds the motions that a machine settles on, and at which speeds.
///
/// The result has the beginning and the end of each motion, and the share of starts that settle on it. With `--over`, another number varies.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n\
    \x20 corner-impact speeds\n\
    \x20 corner-impact speeds models/osorio-2008.toml --rpm 600:800 --speeds 100 --out speeds.svg\n\
    \x20 corner-impact speeds --over restitution=0.5:0.9:100 --rpm 700\n\
    \n\
    The values that are run are multiples of a step, whatever the range. So a part of a range gives the same answer there, with the same --step.\n\
    Exit code: 0 done, 2 bad model file, usage, or a run that cannot go on.")]
pub(super) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    /// Lowest and highest speed; with --over, the one speed [default: from below the speed at which the follower first leaves the cam to the end of the model's [study]. Without a [study] it ends at twice that speed, or at twice the spring's own speed if the follower never leaves].
    #[arg(long, value_name = "LO:HI[:N]|R", value_parser = typed, allow_hyphen_values = true)]
    rpm: Option<Speeds>,
    /// Number of the model to vary in place of the speed: its lowest and highest value, and the least number of values. `:log` spaces them logarithmically.
    #[arg(long, value_name = "NAME=LO:HI[:N][:log]", value_parser = axis, allow_hyphen_values = true)]
    over: Option<NamedSpan>,
    /// Least number of values to run.
    #[arg(long, value_name = "N", default_value_t = 300, value_parser = clap::value_parser!(u32).range(2..=100_000))]
    speeds: u32,
    /// Longest step from one value to the next, in decades on a logarithmic axis. The step is 1, 2, 3 or 5 times a power of ten [default: the step that gives the number of values asked for].
    #[arg(long, value_name = "STEP", value_parser = positive, allow_hyphen_values = true, conflicts_with = "speeds")]
    step: Option<f64>,
    /// Number of starts at each value.
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..=1_000_000),
        conflicts_with_all = ["state", "relative_velocity"])]
    starts: u32,
    #[command(flatten)]
    start: StartArguments,
    #[command(flatten)]
    budget: BudgetArguments,
    /// Also start on the stable orbits of two impacts in one revolution. A search by intervals finds all of them, except next to a fold, a graze or a corner. It takes up to some seconds for each value.
    #[arg(long, conflicts_with_all = ["state", "relative_velocity"])]
    two_impacts: bool,
    #[command(flatten)]
    answer: AnswerArguments,
    /// Draw impacts, attractors and shares over the speeds (.svg, .png, .pdf), or write a table (.csv, or - for standard output).
    #[arg(long, value_name = "FILE", value_parser = picture_or_table, group = "picture")]
    out: Option<PathBuf>,
    #[command(flatten)]
    picture: PictureArguments,
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let model = arguments.model.read(session)?;
    let corners = corner_marks(&Cam::new(&model)?);
    let (rpm, what) = varied(arguments.rpm, arguments.over.as_ref())?;
    let (name, span) = match what {
        Some(what) => what,
        None => {
            let usual = Span { ends: usual_range(&model)?, count: None, spacing: Spacing::Linear };
            (Parameter::Speed.name().to_owned(), usual)
        }
    };
    let Span { ends: range, count, spacing } = span;
    let parameter = arguments.model.varied(&model, &name, "--over")?;
    let count = match count {
        None => arguments.speeds,
        Some(count) => values(count)?,
    };
    let step =
        arguments.step.map_or_else(|| Step::for_values(range, count, spacing), |step| Step::at_most(step, spacing));
    arguments.start.doubt(session);
    let (sample, budget) =
        (arguments.start.sample(arguments.starts as usize), arguments.budget.budget(Budget::SURVEY)?);
    let resolution = Resolution { step, sample, budget, two_impacts: arguments.two_impacts };
    let over = Over::new(&model, parameter, rpm)?;
    let found = watched("motions that runs settle on", |watch| speeds(&over, range, &resolution, watch))?;
    if let Some(path) = &arguments.out {
        let table = || csv::speeds(&found);
        let request = arguments.picture.request()?;
        let across = request.across();
        Target::create(path, &mut *session.out, request)?
            .fill(&model.units, table, || Ok(speeds_figure(&found, &corners, across)))?;
    }
    if is_standard(arguments.out.as_ref()) { Ok(Exit::Agrees) } else { session.answer(&found, &arguments.answer) }
}
