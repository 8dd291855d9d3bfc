//! `corner-impact chart [MODEL] --over NAME=LO:HI --over NAME=LO:HI`.

use std::path::{Path, PathBuf};

use clap::ValueEnum;

use super::curve::{LONGEST_STEP, MOST_POINTS};
use super::numbers::{NamedSpan, axis, rpm};
use super::start::{BudgetArguments, StartArguments};
use super::{AnswerArguments, CommandError, Exit, ModelArgument, Session, picture, picture::Target, progress::watched};
use crate::figures::{Coloured, chart_figure};
use crate::show::csv;
use corner_impact::orbit::branch::{Bifurcation, Following};
use corner_impact::orbit::long_run::Budget;
use corner_impact::orbit::{Parameter, Search};
use corner_impact::study::chart::Chart;
use corner_impact::study::chart::store::{SIDES, Shard, Store, status};
use corner_impact::study::curve::curves;
use corner_impact::study::survey::Axis;

/// Charts the motion that runs settle on over two numbers.
///
/// The chart has its period, its growth rate and its impact speed.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n\
    \x20 corner-impact chart --over rpm=600:760:80 --over restitution=0.5:0.95:60 --out periods.svg\n\
    \x20 corner-impact chart --over mass=1:2:30 --over stiffness=1000:2000:30 --rpm 700 --show impact-speed --out speeds.png\n\
    \x20 corner-impact chart --over rpm=600:760:80 --over restitution=0.5:0.95:60 --with-curves --out curves.svg\n\
    \x20 corner-impact chart models/damped-light.toml --over rpm=600:760:40 --over damping=0:20:20 --out chart.csv\n\
    \n\
    Exit code: 0 done, 2 bad model file, usage or file.")]
pub(super) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    /// Horizontal axis, then vertical axis. NAME is rpm or a number of the model. LO and HI are its lowest and highest value, N is the number of values
    /// [default: 60]. `:log` spaces them logarithmically.
    #[arg(long, value_name = "NAME=LO:HI[:N][:log]", value_parser = axis, required_unless_present_any = ["status", "x"], conflicts_with_all = ["x", "y"],
        allow_hyphen_values = true)]
    over: Vec<NamedSpan>,
    /// An older name of the first --over.
    #[arg(long, value_name = "AXIS", hide = true, value_parser = axis, requires = "y", allow_hyphen_values = true)]
    x: Option<NamedSpan>,
    /// An older name of the second.
    #[arg(long, value_name = "AXIS", hide = true, value_parser = axis, requires = "x", allow_hyphen_values = true)]
    y: Option<NamedSpan>,
    /// Speed of the cam, rpm, if neither axis is rpm.
    #[arg(long, value_name = "RPM", value_parser = rpm, allow_hyphen_values = true)]
    rpm: Option<f64>,
    #[command(flatten)]
    budget: BudgetArguments,
    #[command(flatten)]
    start: StartArguments,
    /// Quantity that the colours of a picture show. A table and a store hold all quantities.
    #[arg(long, value_enum, default_value = "period")]
    show: ShowName,
    /// Draw curves of bifurcations over the picture, as `curve` follows them. They are corner impacts, folds, flips, grazes, detachment and the onset of
    /// resting, of motions that repeat after one revolution. One axis must be rpm.
    #[arg(long, requires = "out", conflicts_with = "status")]
    with_curves: bool,
    /// Write a table (.csv, or - for standard output), a picture (.svg, .png, .pdf) or a zarr store (.zarr). A store is a folder of blocks of 100 x 100
    /// points. Blocks that exist already are not run again.
    #[arg(long, value_name = "FILE", value_parser = out, group = "picture")]
    out: Option<PathBuf>,
    #[command(flatten)]
    picture: picture::PictureArguments,
    /// Run part I of N of a store's blocks. Other processes run the other parts, at the same time or later.
    #[arg(long, value_name = "I/N", value_parser = shard, requires = "out")]
    shard: Option<Shard>,
    /// Print how much of a store is done, and run nothing. With --json, print a document.
    #[arg(long, value_name = "STORE", conflicts_with_all = ["over", "x", "y", "out"])]
    status: Option<PathBuf>,
    #[command(flatten)]
    answer: AnswerArguments,
}

/// Number of values of an axis if none is given.
const VALUES: usize = 60;

#[derive(Clone, Copy, Debug, ValueEnum)]
enum ShowName {
    Period,
    Growth,
    Regime,
    Impacts,
    ImpactSpeed,
}

/// Parses `I/N`.
fn shard(text: &str) -> Result<Shard, String> {
    let number = |text: &str| text.trim().parse::<usize>().ok();
    let parts = text.split_once('/').and_then(|(index, of)| Some((number(index)?, number(of)?)));
    match parts {
        Some((index, of)) if (1..=of).contains(&index) => Ok(Shard { index, of }),
        _ => Err("must be I/N: part I of N parts, with I from 1 to N".into()),
    }
}

/// Parses the file name of a picture, a table or a store, for clap.
fn out(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    if is_store(&path) {
        return Ok(path);
    }
    picture::picture_or_table(text).map_err(|_| "must end in .csv, .zarr, .svg, .png or .pdf, or be -".into())
}

fn is_store(path: &Path) -> bool {
    picture::ends_in(path, &["zarr"])
}

impl ShowName {
    fn coloured(self) -> Coloured {
        match self {
            Self::Period => Coloured::Period,
            Self::Growth => Coloured::Growth,
            Self::Regime => Coloured::Regime,
            Self::Impacts => Coloured::Impacts,
            Self::ImpactSpeed => Coloured::ImpactSpeed,
        }
    }
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    if let Some(folder) = &arguments.status {
        session.answer(&status(folder)?, &arguments.answer)?;
        return Ok(Exit::Agrees);
    }
    let to_standard = picture::out_is_standard(arguments.out.as_ref(), arguments.answer.json)?;
    let model = arguments.model.read_as_drawn(session)?;
    let axes: Vec<&NamedSpan> = arguments.over.iter().chain(&arguments.x).chain(&arguments.y).collect();
    let [x, y] = axes.as_slice() else {
        let words = match axes.len() {
            1 => "--over is given once, but a chart has two axes; `speeds` and `diagram` have one".to_owned(),
            count => format!("--over is given {count} times, but a chart has two axes"),
        };
        return Err(CommandError::Words(words));
    };
    let axis = |(name, span): &NamedSpan| -> Result<Axis, CommandError> {
        Ok(Axis::new(arguments.model.varied(&model, name, "--over")?, &span.values(VALUES)))
    };
    let (x, y) = (axis(x)?, axis(y)?);
    arguments.start.doubt(session);
    let budget = arguments.budget.budget(Budget::CHART)?;
    let chart = Chart::new(&model, arguments.rpm, [x, y], arguments.start.start()?, budget)?;
    let drawn = arguments.out.as_deref().is_some_and(|path| picture::kind(path).is_some());
    if arguments.with_curves && !drawn {
        return Err(CommandError::Words("--with-curves is for a picture: --out must end in .svg, .png or .pdf".into()));
    }
    let threads = session.threads;
    let folder = arguments.out.as_deref().filter(|path| is_store(path));
    if let (Some(_), None) = (arguments.shard, folder) {
        return Err(CommandError::Words("--shard is for a store: --out must end in .zarr".into()));
    }
    if let Some(folder) = folder {
        let store = Store::open(folder, &chart, SIDES)?;
        let filled = watched("blocks", |watch| store.fill(arguments.shard.unwrap_or(Shard::ALL), threads, watch))?;
        session.answer(&filled, &arguments.answer)?;
        return Ok(Exit::Agrees);
    }
    // Invalid arguments are rejected before the work: computing the points takes most of the time.
    let ground = if arguments.with_curves { Some(ground(&chart)?) } else { None };
    let run = || watched("runs of each point", |watch| chart.run(threads, watch));
    let found = match &arguments.out {
        None => run()?,
        Some(path) => {
            // Begun before the work, so that an impossible name is reported at once.
            let target = Target::create(path, &mut *session.out, arguments.picture.request()?)?;
            let found = run()?;
            let model = &found.chart.model;
            let wanted = Search { revolutions: 1, impacts: None };
            let events = |(rpm, following): ([f64; 2], Following)| {
                watched("looking for events", |watch| curves(model, rpm, &wanted, &Bifurcation::ALL, &following, watch))
            };
            let over = ground.map(events).transpose()?.map(|found| found.curves).unwrap_or_default();
            let table = || csv::chart(&found);
            target.fill(&model.units, table, || {
                Ok(chart_figure(&found, arguments.show.coloured(), &over, &model.units))
            })?;
            found
        }
    };
    if !to_standard {
        session.answer(&found, &arguments.answer)?;
    } else if let Some(why) = found.failure() {
        let failed = found.points.iter().filter(|point| point.is_err()).count();
        session.failures("points", [failed, found.points.len()], why);
    }
    Ok(Exit::Agrees)
}

/// Speeds of a chart, and the settings to follow curves through its other number.
fn ground(chart: &Chart) -> Result<([f64; 2], Following), CommandError> {
    let (speeds, other) = match [&chart.x, &chart.y] {
        [speeds, other] | [other, speeds] if speeds.parameter == Parameter::Speed => (speeds.ends(), other),
        _ => {
            return Err(CommandError::Words(
                "--with-curves follows events through speeds: one axis must be rpm".into(),
            ));
        }
    };
    let (parameter, range) = (other.parameter.clone(), other.ends());
    Ok((speeds, Following { parameter, range, longest_step: LONGEST_STEP, most_points: MOST_POINTS }))
}
