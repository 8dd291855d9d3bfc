//! Command `corner-impact basins [MODEL] --rpm R --grid NxM`.

use std::path::PathBuf;
use std::time::Instant;

use super::numbers::{NamedSpan, Speeds, angle, axis, range, speeds};
use super::over::over;
use super::start::{BudgetArguments, cam_angle, state};
use super::{AnswerArguments, CommandError, Exit, ModelArgument, Session, picture, picture::Target, progress::watched};
use crate::figures::{basins_figure, shares_figure};
use crate::show::csv;
use corner_impact::flight::State;
use corner_impact::model::Model;
use corner_impact::orbit::long_run::Budget;
use corner_impact::study::basins::{BasinSection, BasinsOver, Begun, Grid, SectionStarts, States, Summary};
use corner_impact::study::survey::Over;
use corner_impact::untrusted;

/// Finds the motion that each start of a grid settles on.
///
/// At one speed, the result is a table or a picture of the starts. With `--over`, it is the share of the starts that settle on each motion.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n\
    \x20 corner-impact basins --rpm 678 --strobe 5.76 --grid 60x40\n\
    \x20 corner-impact basins models/osorio-2008.toml --rpm 678 --strobe 5.76 --grid 200x150 --out basins.png\n\
    \x20 corner-impact basins --over restitution=0.5:0.9:9 --rpm 700 --grid 20x20 --out shares.svg\n\
    \n\
    Exit code: 0 done, 2 bad model file, usage or file, or a run that cannot go on.")]
pub(super) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    /// Speed of the cam, rpm; or the lowest speed, the highest speed and their number [default: 9].
    #[arg(long, value_name = "R|LO:HI[:N]", value_parser = speeds, required_unless_present = "over", allow_hyphen_values = true)]
    rpm: Option<Speeds>,
    /// Vary a number of the model at the speed of --rpm, and give the share of each motion at each value. LO and HI are the lowest and highest value, N is
    /// their number [default: 9]. `:log` spaces them logarithmically.
    #[arg(long, value_name = "NAME=LO:HI[:N][:log]", value_parser = axis, allow_hyphen_values = true)]
    over: Option<NamedSpan>,
    /// Number of cells along the positions and along the velocities.
    #[arg(long, value_name = "NxM", value_parser = cells, required_unless_present = "state")]
    grid: Option<Cells>,
    /// Cam angle of the starts, in rad or as 90deg.
    #[arg(long, value_name = "RAD", value_parser = angle, default_value_t = 0.0, allow_hyphen_values = true)]
    strobe: f64,
    /// Range of positions [default: from the cam to twice the largest distance of any orbit with one impact a revolution].
    #[arg(long, value_name = "LO:HI", value_parser = range, allow_hyphen_values = true)]
    position: Option<[f64; 2]>,
    /// Range of velocities [default: three times the range of those orbits and of the cam. If that range is less than the lift per radian of rotation, that lift in both directions is tripled instead].
    #[arg(long, value_name = "LO:HI", value_parser = range, allow_hyphen_values = true)]
    velocity: Option<[f64; 2]>,
    /// Position and velocity of one start, in place of a grid (repeatable).
    #[arg(long, value_name = "Q,V", value_parser = state, allow_hyphen_values = true, conflicts_with_all = ["grid", "position", "velocity"])]
    state: Vec<State>,
    #[command(flatten)]
    budget: BudgetArguments,
    /// An older name of --transient.
    #[arg(long, value_name = "N", hide = true, conflicts_with = "transient", value_parser = clap::value_parser!(u64).range(1..=Budget::MOST))]
    revolutions: Option<u64>,
    /// Write a table (.csv, or - for standard output) or a picture (.svg, .png, .pdf).
    #[arg(long, value_name = "FILE", value_parser = picture::picture_or_table, group = "picture")]
    out: Option<PathBuf>,
    #[command(flatten)]
    picture: picture::PictureArguments,
    #[command(flatten)]
    answer: AnswerArguments,
}

/// Number of values of an axis if none is given.
const VALUES: usize = 9;

/// Numbers of cells along the positions and along the velocities.
#[derive(Clone, Copy)]
struct Cells([usize; 2]);

/// Parses `NxM`.
fn cells(text: &str) -> Result<Cells, String> {
    let count = |part: &str| {
        part.trim().parse::<usize>().map_err(|_| format!("\"{}\" is not a number of cells", untrusted::value(part)))
    };
    let Some((columns, rows)) = text.split_once('x') else {
        return Err("must be NxM, such as 60x40: the number of cells along positions and along velocities".into());
    };
    let (columns, rows) = (count(columns)?, count(rows)?);
    match columns.checked_mul(rows) {
        Some(1..=Grid::MOST) => Ok(Cells([columns, rows])),
        _ => Err(format!("must be 1 to {} cells", Grid::MOST)),
    }
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let to_standard = picture::out_is_standard(arguments.out.as_ref(), arguments.answer.json)?;
    let model = arguments.model.read_as_drawn(session)?;
    let angle = cam_angle("--strobe", arguments.strobe, session);
    let rpm = match (arguments.rpm, &arguments.over) {
        (Some(Speeds::One(rpm)), None) => rpm,
        _ => return shares(arguments, &model, angle, session),
    };
    let section = BasinSection::new(&model, rpm, angle)?;
    let grid =
        arguments.grid.map(|Cells(cells)| section.grid(cells, arguments.position, arguments.velocity)).transpose()?;
    let budget = arguments.budget()?;
    let (clock, threads) = (Instant::now(), session.threads);
    let begun = match grid {
        Some(grid) => SectionStarts::Grid(grid),
        None => SectionStarts::Given(States { cam_angle: section.map.cam_angle, states: arguments.state.clone() }),
    };
    if grid.is_none() && arguments.out.as_deref().is_some_and(|path| picture::kind(path).is_some()) {
        return Err(CommandError::Words("a picture needs a grid: give its cells by --grid NxM".into()));
    }
    let basins = watched("runs of each start", |watch| begun.basins(&section.map.machine, budget, threads, watch))?;
    let wall_s = clock.elapsed().as_secs_f64();
    if let Some(path) = &arguments.out {
        let table = || csv::basins(&basins, &model.units);
        let picture = || {
            let title = format!("{} at {rpm} rpm: what each start settles on", model.name);
            // A missing grid is rejected above.
            let grid = grid.ok_or_else(|| CommandError::Words("a picture needs a grid".into()))?;
            Ok(basins_figure(&title, &grid, &basins, &section.border(&grid, &basins)))
        };
        Target::create(path, &mut *session.out, arguments.picture.request()?)?.fill(&model.units, table, picture)?;
    }
    let summary = Summary::new(&model, rpm, basins, wall_s);
    if !to_standard {
        session.answer(&summary, &arguments.answer)?;
    } else if let Some(why) = &summary.basins.failure {
        session.failures("starts", [summary.basins.failed, summary.basins.begun.count()], why);
    }
    Ok(Exit::Agrees)
}

impl Arguments {
    fn budget(&self) -> Result<Budget, CommandError> {
        let budget = self.budget.budget(Budget::SURVEY)?;
        Ok(Budget { transient: self.revolutions.unwrap_or(budget.transient), ..budget })
    }
}

/// Shares of the starts that end on each motion, at each value of a number.
fn shares(
    arguments: &Arguments,
    model: &Model,
    cam_angle: f64,
    session: &mut Session<'_>,
) -> Result<Exit, CommandError> {
    let (rpm, axis) = over((&arguments.model, model), arguments.rpm, arguments.over.as_ref(), VALUES)?;
    let over = Over::new(model, axis.parameter.clone(), rpm)?;
    let begun = match arguments.grid {
        Some(Cells(cells)) => Begun::Grid(cells, [arguments.position, arguments.velocity]),
        None => Begun::Given(arguments.state.clone()),
    };
    let (budget, threads) = (arguments.budget()?, session.threads);
    let to_standard = picture::out_is_standard(arguments.out.as_ref(), arguments.answer.json)?;
    let found = watched("runs of each start", |watch| {
        BasinsOver::new(&over, &axis, (cam_angle, &begun), budget, threads, watch)
    });
    if let Some(path) = &arguments.out {
        let table = || csv::basins_over(&found);
        Target::create(path, &mut *session.out, arguments.picture.request()?)?
            .fill(&model.units, table, || Ok(shares_figure(&found)))?;
    }
    let failed = || found.at.iter().filter_map(|at| Some((at, at.failure()?)));
    if !to_standard {
        session.answer(&found, &arguments.answer)?;
    } else if let Some((at, why)) = failed().next() {
        let first = found.over.words(at.place.across());
        session.failures("values", [failed().count(), found.at.len()], &format!("{first}: {why}"));
    }
    Ok(Exit::Agrees)
}
