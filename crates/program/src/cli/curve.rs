//! `corner-impact curve [MODEL] --rpm LO:HI --over NAME=LO:HI`.

use std::path::PathBuf;

use super::numbers::{followed, positive, rpm_range};
use super::picture::{PictureArguments, Target, picture_or_table, table};
use super::{CommandError, Exit, ModelArgument, Session, progress::watched, session::in_columns};
use crate::figures::curve_figure;
use crate::pages;
use crate::show::{csv, words};
use corner_impact::json;
use corner_impact::orbit::branch::{Bifurcation, Following};
use corner_impact::orbit::{Parameter, Search};
use corner_impact::study::curve::{Curves, curves};
use corner_impact_plot::{extent, layout::widened};

/// Follows bifurcations through a number of the model.
///
/// Follows corner impacts, folds, flips, grazes, detachment and the onset of resting. The result is the speed of each, and the values at which its type changes.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n\
    \x20 corner-impact curve --rpm 600:760 --over restitution=0.5:0.95\n\
    \x20 corner-impact curve --rpm 600:760 --over restitution=0.5:0.95 --out curve.svg\n\
    \x20 corner-impact curve --rpm 600:760 --over restitution=0.5:0.95 --event fold --event flip\n\
    \n\
    Prints the table. The special points of each curve and its end go to standard error.\n\
    Exit code: 0 done, also if no curve was found, 2 bad model file, usage or file.")]
pub(super) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    /// Range of speeds in which events are looked for.
    #[arg(long, value_name = "LO:HI", value_parser = rpm_range, allow_hyphen_values = true)]
    rpm: [f64; 2],
    /// Number of the model to vary, such as restitution, with its lowest and highest value.
    #[arg(long, value_name = "NAME=LO:HI", value_parser = followed, alias = "parameter", allow_hyphen_values = true)]
    over: (String, [f64; 2]),
    /// Event to follow (repeatable) [default: all].
    #[arg(long = "event", value_name = "EVENT", value_parser = event)]
    events: Vec<Bifurcation>,
    /// Revolutions of the cam in one period.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..=Search::MOST_REVOLUTIONS))]
    revolutions: u64,
    /// Follow only events of orbits that were found with this many impacts.
    #[arg(long, value_name = "M")]
    impacts: Option<usize>,
    /// Longest step, as a fraction of the ranges and of a radian.
    #[arg(long, value_name = "STEP", default_value_t = LONGEST_STEP, value_parser = positive)]
    step: f64,
    /// Write a table (.csv, or - for standard output) or a picture (.svg, .png, .pdf) [default: -].
    #[arg(long, value_name = "FILE", value_parser = picture_or_table, group = "picture")]
    out: Option<PathBuf>,
    /// Print one JSON document instead of the table.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    picture: PictureArguments,
}

fn event(text: &str) -> Result<Bifurcation, String> {
    let names = Bifurcation::ALL.map(|event| event.to_string());
    let found = Bifurcation::ALL.into_iter().zip(&names).find(|(_, name)| *name == text);
    found.map(|(event, _)| event).ok_or_else(|| format!("must be one of: {}", names.join(", ")))
}

/// Longest step of a curve, relative to the ranges and to a radian, by default.
pub(super) const LONGEST_STEP: f64 = 0.02;
/// Number of points in either direction after which a curve ends.
pub(super) const MOST_POINTS: usize = 2000;

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let model = arguments.model.read_as_drawn(session)?;
    let (name, range) = &arguments.over;
    let parameter = Parameter::named(&model, name)?;
    let (request, columns) = (arguments.picture.request()?, session.columns_err());
    let out = table(arguments.out.as_ref(), arguments.json)?;
    let target = out.map(|path| Target::create(path, &mut *session.out, request)).transpose()?;
    let wanted = Search { revolutions: arguments.revolutions, impacts: arguments.impacts };
    let following = Following { parameter, range: *range, longest_step: arguments.step, most_points: MOST_POINTS };
    let events = if arguments.events.is_empty() { &Bifurcation::ALL } else { arguments.events.as_slice() };
    let found =
        watched("looking for events", |watch| curves(&model, arguments.rpm, &wanted, events, &following, watch))?;
    let Curves { own, sharp, curves, .. } = &found;
    let own = *own;
    let (name, [low, high]) = (following.parameter.name(), arguments.rpm);
    let accounts = curves
        .iter()
        .zip(1..)
        .map(|(found, index)| pages::branches::curve(found, (name, own, &model.units), index, sharp));
    let mut accounts: String = accounts.collect();
    if curves.is_empty() {
        let turns = wanted.revolutions;
        accounts = format!(
            "no {} of an orbit of {turns} revolution(s) found between {low} and {high} rpm\n",
            words::any_of(events)
        );
    }
    if !session.quiet {
        // If standard error is closed, the failure cannot be reported.
        let _ = session.err.write_all(in_columns(&accounts, columns).as_bytes());
    }
    let rows = || csv::curves(name, curves, &model.units);
    let drawn = || {
        let title = format!("{}: events against {name}", model.name);
        let speeds = curves.iter().flat_map(|curve| &curve.points).map(|point| point.rpm);
        let ends = extent(speeds);
        let shown = if ends[0] < ends[1] { widened(ends, 0.04) } else { arguments.rpm };
        Ok(curve_figure(&title, (name, &model.units.of_number(name), *range, own), shown, curves))
    };
    target.map(|target| target.fill(&model.units, rows, drawn)).transpose()?;
    if arguments.json {
        session.print(&json::render(&found, &model.units)?)?;
    }
    Ok(Exit::Agrees)
}
