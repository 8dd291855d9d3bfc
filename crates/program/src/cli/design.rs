//! `corner-impact design [MODEL]`.

use std::path::PathBuf;

use super::diagram::load;
use super::picture::{Canvas, PictureArguments, picture};
use super::start::{BudgetArguments, StartArguments, axis, positive, rpm_or_range};
use super::{CommandError, Exit, ModelArgument, Session, progress::watched};
use crate::figures::design_figure;
use corner_impact::orbit::long_run::Budget;
use corner_impact::study::design::loads::Load;
use corner_impact::study::design::needs::{Lever, Need, in_si};
use corner_impact::study::design::{Asked, design};
use corner_impact::study::survey::{Axis, Values};

/// Tells up to which speed the follower stays on the cam, how hard it hits beyond, and what must be changed.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n\
    \x20 corner-impact design\n\
    \x20 corner-impact design models/laws/program.toml --need \"no separation to 600 rpm\"\n\
    \x20 corner-impact design models/laws/program.toml --rpm 300 --out force.svg\n\
    \x20 corner-impact design --rpm 200 --over mass=1:2:5\n\
    \n\
    Where runs are looked at, it is those from four starts at each speed: another motion may do worse.\n\
    Exit code: 0 done, 2 bad model file, usage or file, or a run that cannot go on.")]
pub(super) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    /// Lowest and highest speed, or one, at which the force is told round the cam [default: half to one and a half times the
    /// speed at which the follower first leaves the cam].
    #[arg(long, value_name = "R|LO:HI", value_parser = rpm_or_range, allow_hyphen_values = true)]
    rpm: Option<[f64; 2]>,
    /// A number of the model that the table goes over in place of the speed, at the one of --rpm: from where to where, at how many values, and whether
    /// these are spaced by their logarithm.
    #[arg(long, value_name = "NAME=LO:HI:N[:log]", value_parser = axis, allow_hyphen_values = true)]
    over: Option<(String, Values)>,
    /// Speeds of a range.
    #[arg(long, value_name = "N", default_value_t = 21, value_parser = clap::value_parser!(u32).range(2..=10_000))]
    speeds: u32,
    /// A need: "no separation to 4500 rpm", "impact speed below 0.5 m/s to 6000 rpm"; also gap and energy (may
    /// be repeated).
    #[arg(long, value_name = "TEXT", value_parser = need)]
    need: Vec<(String, Need)>,
    /// Tell where a load is first more than this, in the units of the model or one that is named: impact-speed=0.5m/s; also gap, energy and force (may
    /// be repeated).
    #[arg(long, value_name = "NAME=VALUE", value_parser = limit)]
    limit: Vec<(Load, f64, Option<f64>)>,
    /// Table of what each need takes for several values of preload, stiffness, damping or mass, in the units of the model.
    #[arg(long, value_name = "NAME=LO:HI:N", value_parser = against, requires = "need", allow_hyphen_values = true)]
    against: Option<(Lever, Values)>,
    #[command(flatten)]
    start: StartArguments,
    #[command(flatten)]
    budget: BudgetArguments,
    /// Print one JSON document instead of the page.
    #[arg(long)]
    json: bool,
    /// Draw forces and loads against the speed, the force round the cam at one speed, or what --against asks (.svg, .png, .pdf).
    #[arg(long, value_name = "FILE", value_parser = picture, group = "picture")]
    out: Option<PathBuf>,
    #[command(flatten)]
    picture: PictureArguments,
}

fn need(text: &str) -> Result<(String, Need), String> {
    Ok((text.into(), text.parse()?))
}

/// A load, what it may be at most, and what the unit is of the SI's where one is named.
fn limit(text: &str) -> Result<(Load, f64, Option<f64>), String> {
    let (name, value) = text.split_once('=').ok_or("must be NAME=VALUE: a load, and what it may be at most")?;
    let load = load(name.trim())?;
    let number = value.trim_end_matches(|letter: char| letter.is_ascii_alphabetic() || letter == '/');
    let unit = Some(value[number.len()..].trim()).filter(|unit| !unit.is_empty() && !number.trim().is_empty());
    let number = if unit.is_some() { number } else { value };
    Ok((load, positive(number.trim())?, unit.map(|unit| in_si(load, unit)).transpose()?))
}

fn against(text: &str) -> Result<(Lever, Values), String> {
    let (name, values) = axis(text)?;
    let lever = Lever::ALL.into_iter().find(|lever| lever.to_string() == name);
    let lever =
        lever.ok_or_else(|| format!("must be one of: {}", Lever::ALL.map(|lever| lever.to_string()).join(", ")))?;
    if values.low <= 0.0 { Err("must be above 0".into()) } else { Ok((lever, values)) }
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let model = arguments.model.read(session)?;
    let canvas = arguments.out.as_ref().map(|path| Canvas::create(path, arguments.picture.look()?)).transpose()?;
    arguments.start.doubt(session);
    let over = arguments.over.as_ref().map(|(name, values)| -> Result<Axis, CommandError> {
        Ok(Axis::new(arguments.model.varied(&model, name, "--over")?, values))
    });
    let asked = Asked {
        rpm: arguments.rpm,
        over: over.transpose()?,
        speeds: arguments.speeds,
        needs: arguments.need.clone(),
        limits: arguments
            .limit
            .iter()
            .map(|(load, value, one)| (*load, one.map_or(*value, |one| load.of_si(&model.units, value * one))))
            .collect(),
        against: arguments
            .against
            .as_ref()
            .map(|(lever, values)| (*lever, [values.low, values.high], values.count as u32)),
        starts: arguments.start.given(),
        budget: Some(arguments.budget.budget(Budget::DESIGN)?),
    };
    let found = watched("", |watch| design(&model, &asked, watch))?;
    if let Some(canvas) = canvas {
        super::commit(vec![canvas.draw(design_figure(&found), &model.units)?])?;
    }
    session.answer(&found, arguments.json)
}
