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

/// Sweeps over speeds or a number: what the motion settles on.
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
    /// Lowest speed, highest speed, and how many [default: 400]; with --over the one speed.
    #[arg(long, value_name = "LO:HI[:N]|R", value_parser = speeds, allow_hyphen_values = true)]
    rpm: Option<Speeds>,
    /// A number of the model to go over in place of the speed: from where to where, at how many values, and whether these are spaced by their logarithm.
    #[arg(long, value_name = "NAME=LO:HI[:N][:log]", value_parser = axis, allow_hyphen_values = true)]
    over: Option<NamedSpan>,
    #[command(flatten)]
    budget: BudgetArguments,
    /// Record what happens at the cam, or the state at one cam angle.
    #[arg(long, value_enum, default_value = "impact")]
    section: SectionName,
    /// That angle, rad or as 90deg [default: 0].
    #[arg(long, value_name = "RAD", value_parser = angle, allow_hyphen_values = true)]
    strobe: Option<f64>,
    /// Start of each value: the same for all, or on from the next lower (up) or next higher one (down), on one thread.
    #[arg(long = "start", value_enum, default_value = "fixed")]
    following: FollowingName,
    /// Record each attractor: those that 64 starts, or those of --state, come to at a value, from a point on the attractor. They are found as by `speeds`.
    #[arg(long, conflicts_with = "following")]
    attractors: bool,
    #[command(flatten)]
    start: StartArguments,
    /// A table (.csv, or - for standard output) or a picture (.svg, .png, .pdf).
    #[arg(long, value_name = "FILE", value_parser = picture::picture_or_table, group = "picture")]
    out: Option<PathBuf>,
    #[command(flatten)]
    picture: picture::PictureArguments,
    /// Write one row a value: what the run comes to, its period, impacts, growth and fastest impact, as in `chart`.
    #[arg(long, requires = "out", conflicts_with_all = ["attractors", "following", "section", "strobe", "lyapunov", "json"])]
    one_row: bool,
    /// Show a load of each revolution that is recorded: the fastest impact, the largest gap, the energy that impacts take, or the largest
    /// contact force; a table has all of them.
    #[arg(long, value_name = "LOAD", value_parser = load, requires = "out",
        conflicts_with_all = ["attractors", "following", "section", "strobe", "lyapunov", "json", "one_row"])]
    show: Option<Load>,
    /// Add the Lyapunov exponent of each value, per revolution, and its error: two columns, or a second panel. Of a motion that
    /// repeats it is that of its multipliers; -inf where the follower came to stick to the cam, be it once.
    #[arg(long, requires = "out")]
    lyapunov: bool,
    #[command(flatten)]
    answer: AnswerArguments,
}

/// Values of an axis of which no number is written.
const VALUES: usize = 400;

/// Starts of the sample, as many as `speeds` runs.
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
        return Err(CommandError::Words("--strobe is the angle of --section strobe, which is not there".into()));
    }
    let model = arguments.model.read_as_drawn(session)?;
    arguments.start.doubt(session);
    let corners = corner_marks(&Cam::new(&model)?);
    let (rpm, axis) = over((&arguments.model, &model), arguments.rpm, arguments.over.as_ref(), VALUES)?;
    let across = Across::of(&axis, &model.units);
    // Attractors are those of `speeds`.
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

/// A load of each revolution.
pub(super) fn load(text: &str) -> Result<Load, String> {
    let names = || format!("must be one of: {}", Load::ALL.map(|load| load.to_string()).join(", "));
    Load::ALL.into_iter().find(|load| load.to_string() == text).ok_or_else(names)
}

/// Loads of each revolution, as a table or a picture of one of them.
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

/// A row for each value, in a table.
fn one_row(arguments: &Arguments, survey: &Survey, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let Some(Target::Table(mut file)) = arguments
        .out
        .as_deref()
        .map(|path| Target::create(path, &mut *session.out, arguments.picture.request()?))
        .transpose()?
    else {
        return Err(CommandError::Words("--one-row is a table: --out must end in .csv or be -".into()));
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
