//! `corner-impact diagram [MODEL] --rpm LO:HI:N`.

use std::io::Write;
use std::path::PathBuf;
use std::sync::Arc;

use clap::ValueEnum;

use super::numbers::{NamedSpan, Speeds, angle, axis, speeds};
use super::over::over;
use super::start::{BudgetArguments, StartArguments, cam_angle};
use super::{
    AnswerArguments, CommandError, Exit, ModelArgument, Session, picture, picture::Target, progress::Progress,
    progress::watched,
};
use crate::figures::{Across, Shown, corner_marks, impact_diagram, loads_diagram, strobe_diagram};
use crate::show::csv;
use corner_impact::cam::Cam;
use corner_impact::model::Model;
use corner_impact::orbit::Parameter;
use corner_impact::orbit::long_run::Budget;
use corner_impact::study::design::loads::Load;
use corner_impact::study::diagram::{self as swept, Swept, on_attractors};
use corner_impact::study::survey::{Beginning, Counted, Growth, Places, Section, Survey, Sweep, SweepStart, growth};

/// Sweeps over speeds or another number, and records what the motion settles on.
///
/// The result is a table or a picture.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n\
    \x20 corner-impact diagram --rpm 660:750:400 --out impacts.svg\n\
    \x20 corner-impact diagram models/osorio-2008.toml --rpm 660:750:400 --start down --out impacts.csv\n\
    \x20 corner-impact diagram --over restitution=0.5:0.95:200 --rpm 700 --out impacts.svg\n\
    \n\
    Exit code: 0 done, 2 bad model file, usage or file, or a run that cannot go on.")]
pub(super) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    /// Lowest speed, highest speed and number of speeds [default: 400]; with --over, the one speed.
    #[arg(long, value_name = "LO:HI[:N]|R", value_parser = speeds, allow_hyphen_values = true)]
    rpm: Option<Speeds>,
    /// Number of the model to vary in place of the speed: its lowest and highest value, and the number of values [default: 400]. `:log` spaces them logarithmically.
    #[arg(long, value_name = "NAME=LO:HI[:N][:log]", value_parser = axis, allow_hyphen_values = true)]
    over: Option<NamedSpan>,
    #[command(flatten)]
    budget: BudgetArguments,
    /// Record the events on the cam (impact), or the state at one cam angle (strobe).
    #[arg(long, value_enum, default_value = "impact")]
    section: SectionName,
    /// Cam angle of --section strobe, in rad or as 90deg [default: 0].
    #[arg(long, value_name = "RAD", value_parser = angle, allow_hyphen_values = true)]
    strobe: Option<f64>,
    /// Start at each value: the same for all (fixed), or the end of the run at the next lower value (up) or at the next higher value (down). up and down use one thread.
    #[arg(long = "start", value_enum, default_value = "fixed")]
    following: FollowingName,
    /// Record every attractor that is found, each from a point on it. As in `speeds`, the search runs 64 starts at each value, or those of --state.
    #[arg(long, conflicts_with = "following")]
    attractors: bool,
    #[command(flatten)]
    start: StartArguments,
    /// Write a table (.csv, or - for standard output) or a picture (.svg, .png, .pdf).
    #[arg(long, value_name = "FILE", value_parser = picture::picture_or_table, group = "picture")]
    out: Option<PathBuf>,
    #[command(flatten)]
    picture: picture::PictureArguments,
    /// Write one row for each value, as `chart` does: the kind of motion, its period, impacts, growth rate and fastest impact.
    #[arg(long, requires = "out", conflicts_with_all = ["attractors", "following", "section", "strobe", "lyapunov", "json"])]
    one_row: bool,
    /// Show a load of each recorded revolution: the fastest impact, the largest gap, the energy lost in impacts, or the largest contact force. A table has
    /// all of them.
    #[arg(long, value_name = "LOAD", value_parser = load, requires = "out",
        conflicts_with_all = ["attractors", "following", "section", "strobe", "lyapunov", "json", "one_row"])]
    show: Option<Load>,
    /// Add the Lyapunov exponent per revolution and its error at each value: two columns, or a second panel. For a motion that repeats, it follows from the
    /// multipliers. It is -inf where the follower stuck to the cam at least once.
    #[arg(long, requires = "out")]
    lyapunov: bool,
    #[command(flatten)]
    answer: AnswerArguments,
}

/// Number of values of an axis if none is given.
const VALUES: usize = 400;

/// Number of starts of the sample, as in `speeds`.
const SAMPLED: usize = 64;

#[derive(Clone, Copy, Debug, ValueEnum)]
enum SectionName {
    Impact,
    Strobe,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum FollowingName {
    Fixed,
    Up,
    Down,
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let to_standard = picture::out_is_standard(arguments.out.as_ref(), arguments.answer.json)?;
    if arguments.strobe.is_some() && matches!(arguments.section, SectionName::Impact) {
        return Err(CommandError::Words("--strobe is the angle of --section strobe: give both or neither".into()));
    }
    let model = arguments.model.read_as_drawn(session)?;
    arguments.start.doubt(session);
    let corners = corner_marks(&Cam::new(&model)?);
    let (rpm, axis) = over((&arguments.model, &model), arguments.rpm, arguments.over.as_ref(), VALUES)?;
    let across = Across::of(&axis, &model.units);
    // Attractors are found as in `speeds`.
    let (sample, found) = (arguments.start.sample(SAMPLED), arguments.budget.lengths(Budget::SURVEY)?);
    let budget = match arguments.lyapunov {
        true => arguments.budget.budget(Budget::CHART)?,
        false => arguments.budget.lengths(Budget::CHART)?,
    };
    let sweep = Sweep {
        over: Survey::new(&model, rpm, axis, None)?,
        starts: match arguments.attractors {
            true => Beginning::Found(Arc::new(move |machine| on_attractors(machine, &sample, found))),
            false => Beginning::One(arguments.start.start()?),
        },
        following: match arguments.following {
            FollowingName::Fixed => SweepStart::Nothing,
            FollowingName::Up => SweepStart::Up,
            FollowingName::Down => SweepStart::Down,
        },
        transient: budget.transient,
        record: budget.record,
        section: match arguments.section {
            SectionName::Impact => Section::Impacts,
            SectionName::Strobe => Section::Strobe(cam_angle("--strobe", arguments.strobe.unwrap_or(0.0), session)),
        },
        growth: arguments
            .lyapunov
            .then(|| -> Growth { Arc::new(move |machine, motion| growth(machine, motion, budget)) }),
    };
    if let Some(load) = arguments.show {
        return loads(arguments, &model, (&sweep.over, &across), load, session);
    }
    if arguments.one_row {
        return one_row(arguments, &sweep.over, session);
    }
    let (threads, target) = (session.threads, arguments.out.as_deref());
    let (name, progress) = (model.name.as_str(), Progress::spinner("runs of each value"));
    let swept =
        match target.map(|path| Target::create(path, &mut *session.out, arguments.picture.request()?)).transpose()? {
            None => Swept::new(name, &sweep, threads, &progress, |_: Counted| Ok::<(), CommandError>(()))?,
            Some(Target::Table(mut file)) => {
                file.write_all(csv::diagram(&sweep).as_bytes())?;
                let take = |lines: csv::Lines| Ok::<(), CommandError>(file.write_all(lines.text.as_bytes())?);
                let swept = Swept::new(name, &sweep, threads, &progress, take)?;
                file.commit()?;
                swept
            }
            Some(Target::Picture(canvas)) => {
                let mut shown = Shown::new(&sweep);
                let take = |found: Places| -> Result<(), CommandError> {
                    shown.take(&found);
                    Ok(())
                };
                let swept = Swept::new(name, &sweep, threads, &progress, take)?;
                let (places, exponents) = shown.places();
                let (title, exponents) = (title(name, &sweep), arguments.lyapunov.then_some(exponents.as_slice()));
                let figure = match sweep.section {
                    Section::Impacts => impact_diagram(&title, places, &corners, exponents),
                    Section::Strobe(_) => strobe_diagram(&title, places, exponents),
                };
                canvas.write(across.under(figure), &model.units)?;
                swept
            }
        };
    drop(progress);
    if !to_standard {
        session.answer(&swept, &arguments.answer)?;
    }
    if target.is_none() && !arguments.answer.json {
        session.note("the rows are not kept: --out FILE.csv writes them, --out FILE.svg draws them");
    }
    Ok(Exit::Agrees)
}

/// Parses a load of each revolution.
pub(super) fn load(text: &str) -> Result<Load, String> {
    let names = || format!("must be one of: {}", Load::ALL.map(|load| load.to_string()).join(", "));
    Load::ALL.into_iter().find(|load| load.to_string() == text).ok_or_else(names)
}

/// Writes the loads of each revolution, as a table or a picture of one load.
fn loads(
    arguments: &Arguments,
    model: &Model,
    (survey, across): (&Survey, &Across),
    load: Load,
    session: &mut Session<'_>,
) -> Result<Exit, CommandError> {
    let Some(path) = arguments.out.as_deref() else { return Ok(Exit::BadInput) };
    let target = Target::create(path, &mut *session.out, arguments.picture.request()?)?;
    let (start, threads) = (arguments.start.start()?, session.threads);
    let budget = arguments.budget.lengths(Budget::CHART)?;
    let found = watched("runs of each value", |watch| swept::loads(survey, start, budget, threads, watch))?;
    let table = || csv::loads(survey.axis().parameter.name(), &found, &model.units);
    let over = match &survey.axis().parameter {
        Parameter::Speed => "cam speed",
        Parameter::Field(path) => path,
    };
    let at = survey.speed().map_or(String::new(), |rpm| format!(" at {rpm} rpm"));
    let title = format!("{}: {} against {over}{at}", model.name, load.to_string().replace('-', " "));
    target.fill(&model.units, table, || Ok(loads_diagram(&title, across, &found, load, &model.units)))?;
    Ok(Exit::Agrees)
}

/// Writes a table with one row for each value.
fn one_row(arguments: &Arguments, survey: &Survey, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let Some(Target::Table(mut file)) = arguments
        .out
        .as_deref()
        .map(|path| Target::create(path, &mut *session.out, arguments.picture.request()?))
        .transpose()?
    else {
        return Err(CommandError::Words("--one-row writes a table: --out must end in .csv or be -".into()));
    };
    let (start, threads) = (arguments.start.start()?, session.threads);
    let budget = arguments.budget.budget(Budget::CHART)?;
    let points = watched("runs of each value", |watch| swept::one_row(survey, start, budget, threads, watch))?;
    file.write_all(csv::one_row(survey.axis(), &points, survey.units()).as_bytes())?;
    file.commit()?;
    let failed = || points.iter().enumerate().filter_map(|(index, point)| Some((index, point.as_ref().err()?)));
    if let Some((index, why)) = failed().next() {
        let first = format!("{}: {why}", survey.words(index));
        session.failures("values", [failed().count(), points.len()], &first);
    }
    Ok(Exit::Agrees)
}

fn title(model: &str, sweep: &Sweep) -> String {
    let what = match sweep.section {
        Section::Impacts => "impacts".to_owned(),
        Section::Strobe(angle) => format!("states at {:.4}°", angle.to_degrees()),
    };
    let is_speed = sweep.over.axis().parameter == Parameter::Speed;
    let how = match sweep.following {
        SweepStart::Nothing if matches!(sweep.starts, Beginning::Found(_)) => "on each attractor",
        SweepStart::Nothing => "from one start",
        SweepStart::Up if is_speed => "speed going up",
        SweepStart::Down if is_speed => "speed going down",
        SweepStart::Up => "each value from the end of the next lower",
        SweepStart::Down => "each value from the end of the next higher",
    };
    let at = sweep.over.speed().map_or(String::new(), |rpm| format!(", at {rpm} rpm"));
    format!("{model}: {what} of {} revolutions after {}, {how}{at}", sweep.record, sweep.transient)
}
