//! `corner-impact design [MODEL]`.

use std::path::PathBuf;

use super::diagram::load;
use super::numbers::{NamedSpan, Speeds, axis, speeds};
use super::over::values;
use super::picture::{Canvas, PictureArguments, picture};
use super::start::{BudgetArguments, StartArguments};
use super::{AnswerArguments, CommandError, Exit, ModelArgument, Session, progress::watched};
use crate::figures::design_figure;
use corner_impact::model::{Model, finite, parted};
use corner_impact::orbit::Parameter;
use corner_impact::orbit::long_run::Budget;
use corner_impact::study::design::denser::DRAWN;
use corner_impact::study::design::loads::Load;
use corner_impact::study::design::needs::{Lever, Need, in_si};
use corner_impact::study::design::{Asked, design};
use corner_impact::study::survey::{Axis, Values};

/// Finds the speed up to which the follower stays on the cam.
///
/// Above that speed, it lists how hard the follower hits. With `--need`, it finds how stiff, light or preloaded the machine must be.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n\
    \x20 corner-impact design\n\
    \x20 corner-impact design models/laws/program.toml --need \"no separation to 600 rpm\"\n\
    \x20 corner-impact design models/laws/program.toml --rpm 300 --out force.svg\n\
    \x20 corner-impact design --rpm 200 --over mass=1:2:5\n\
    \n\
    Runs begin from four starts at each speed. Another motion may hit harder.\n\
    Exit code: 0 done, 2 bad model file, usage or file, or a run that cannot go on.")]
pub(super) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    /// One speed, a range, or the speeds at which the forces are listed [default: half to one and a half times the speed at which the follower first
    /// leaves the cam].
    #[arg(long, value_name = "R|LO:HI[:N]", value_parser = speeds, allow_hyphen_values = true)]
    rpm: Option<Speeds>,
    /// Number of the model to vary: its lowest and highest value, and the number of values. `:log` spaces them logarithmically. The table has the forces and
    /// loads at each value, at the one speed of --rpm. With --need, a table has what each need takes at each value, and --rpm may be left out.
    #[arg(long, value_name = "NAME=LO:HI[:N][:log]", value_parser = axis, alias = "against", allow_hyphen_values = true)]
    over: Option<NamedSpan>,
    /// Number of values in a range that is written without one.
    #[arg(long, value_name = "N", default_value_t = 21, value_parser = clap::value_parser!(u32).range(2..=10_000))]
    speeds: u32,
    /// Requirement (repeatable), such as "no separation to 4500 rpm" or "impact speed below 0.5 m/s to 6000 rpm". Gap and energy can take the place of impact speed.
    #[arg(long, value_name = "TEXT", value_parser = need)]
    need: Vec<(String, Need)>,
    /// Find where a load first exceeds VALUE (repeatable). NAME is impact-speed, gap, energy or force. The unit is the model's, or the one that you write:
    /// impact-speed=0.5m/s.
    #[arg(long, value_name = "NAME=VALUE", value_parser = limit)]
    limit: Vec<(Load, f64, Option<f64>)>,
    #[command(flatten)]
    start: StartArguments,
    #[command(flatten)]
    budget: BudgetArguments,
    #[command(flatten)]
    answer: AnswerArguments,
    /// Draw forces and loads against the speed, the force round the cam at one speed, or what each need takes (.svg, .png, .pdf).
    #[arg(long, value_name = "FILE", value_parser = picture, group = "picture")]
    out: Option<PathBuf>,
    #[command(flatten)]
    picture: PictureArguments,
}

fn need(text: &str) -> Result<(String, Need), String> {
    Ok((text.into(), text.parse()?))
}

/// Parses a load, its limit, and the factor of the limit's unit relative to the SI unit if a unit is given.
fn limit(text: &str) -> Result<(Load, f64, Option<f64>), String> {
    let (name, value) = text.split_once('=').ok_or("must be NAME=VALUE: a load and its limit")?;
    let load = load(name.trim())?;
    let unit = Some(parted(value).1).filter(|unit| !unit.is_empty() && !unit.starts_with(','));
    let number = finite(value, unit.unwrap_or_default())?;
    let number = if number > 0.0 { number } else { return Err("must be a finite number above 0".into()) };
    Ok((load, number, unit.map(|unit| in_si(load, unit)).transpose()?))
}

/// Number along whose values needs are answered, with the values; `None` if it is the speed.
fn against(arguments: &Arguments, model: &Model, usual: usize) -> Result<Option<Axis>, CommandError> {
    let Some((name, span)) = arguments.over.as_ref().filter(|_| !arguments.need.is_empty()) else { return Ok(None) };
    let own = |lever: &Lever| [lever.to_string(), lever.path()].contains(name);
    let axis_values = span.values(usual);
    let Values { low, high, count, .. } = axis_values;
    let parameter = match Lever::ALL.into_iter().find(own) {
        Some(_) if low <= 0.0 => {
            return Err(CommandError::Words(format!("--over {name}={low}:{high}: with --need it must be above 0")));
        }
        // A preload may also be set in a model that has a rest position.
        Some(lever) if lever == Lever::Preload => Parameter::Field(lever.path()),
        _ => arguments.model.varied(model, name, "--over")?,
    };
    if parameter == Parameter::Speed {
        return Ok(None);
    }
    values(count)?;
    Ok(Some(Axis::new(parameter, &axis_values)))
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let model = arguments.model.read(session)?;
    let canvas = arguments.out.as_ref().map(|path| Canvas::create(path, arguments.picture.request()?)).transpose()?;
    arguments.start.doubt(session);
    let (rpm, count) = match arguments.rpm {
        None => (None, None),
        Some(Speeds::One(rpm)) => (Some([rpm; 2]), None),
        Some(Speeds::Span(span)) => (Some(span.ends), span.count.map(values).transpose()?),
    };
    let usual = arguments.speeds as usize;
    let trade = against(arguments, &model, usual)?;
    // Without a speed, only a table of needs is requested.
    let table = arguments.over.as_ref().filter(|_| trade.is_none() || rpm.is_some());
    let over = table.map(|(name, span)| -> Result<Axis, CommandError> {
        Ok(Axis::new(arguments.model.varied(&model, name, "--over")?, &span.values(usual)))
    });
    let asked = Asked {
        rpm,
        over: over.transpose()?,
        speeds: count.unwrap_or(arguments.speeds),
        needs: arguments.need.clone(),
        limits: arguments
            .limit
            .iter()
            .map(|(load, value, one)| (*load, one.map_or(*value, |one| load.of_si(&model.units, value * one))))
            .collect(),
        against: trade,
        starts: arguments.start.given(),
        budget: Some(arguments.budget.budget(Budget::DESIGN)?),
        drawn: canvas.is_some().then_some(DRAWN),
    };
    let found = watched("loads of the cam", |watch| design(&model, &asked, watch))?;
    if let Some(canvas) = canvas {
        canvas.write(design_figure(&found), &model.units)?;
    }
    session.answer(&found, &arguments.answer)
}
