//! `corner-impact curve [MODEL] --rpm LO:HI --parameter NAME=LO:HI`.

use std::path::PathBuf;

use super::picture::{PictureArguments, Target, picture_or_table};
use super::start::{parameter, positive, rpm_range};
use super::{CommandError, Exit, ModelArgument, Session, progress::watched};
use crate::figures::curve_figure;
use crate::pages;
use crate::show::{csv, words};
use corner_impact::orbit::branch::{Bifurcation, Following};
use corner_impact::orbit::{Parameter, Search};
use corner_impact::study::curve::{Curves, curves};
use corner_impact_plot::{extent, layout::widened};

/// Follows corner impacts, folds, flips, grazes, detachment and the onset of resting through a number of the model: their speed, and where their type changes.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n\
    \x20 corner-impact curve --rpm 600:760 --parameter restitution=0.5:0.95\n\
    \x20 corner-impact curve --rpm 600:760 --parameter restitution=0.5:0.95 --out curve.svg\n\
    \x20 corner-impact curve --rpm 600:760 --parameter restitution=0.5:0.95 --event fold --event flip\n\
    \n\
    Prints the table; what each curve passes and where it ends goes to standard error.\n\
    Exit code: 0 done, also where there is none, 2 bad model file, usage or file.")]
pub(super) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    /// Speeds between which events of the model are looked for.
    #[arg(long, value_name = "LO:HI", value_parser = rpm_range, allow_hyphen_values = true)]
    rpm: [f64; 2],
    /// The number to vary, with its lowest and highest value: a number of the model file, such as restitution.
    #[arg(long, value_name = "NAME=LO:HI", value_parser = parameter)]
    parameter: (String, [f64; 2]),
    /// Which events are followed; may be repeated [default: all].
    #[arg(long = "event", value_name = "EVENT", value_parser = event)]
    events: Vec<Bifurcation>,
    /// Turns of the cam in one period.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..=Search::MOST_REVOLUTIONS))]
    revolutions: u64,
    /// Only orbits that were found with this many impacts.
    #[arg(long, value_name = "M")]
    impacts: Option<usize>,
    /// The longest step, of the ranges and of a radian.
    #[arg(long, value_name = "STEP", default_value_t = LONGEST_STEP, value_parser = positive)]
    step: f64,
    /// A table (.csv, or - for standard output) or a picture (.svg, .png, .pdf).
    #[arg(long, value_name = "FILE", default_value = "-", value_parser = picture_or_table, group = "picture")]
    out: PathBuf,
    #[command(flatten)]
    picture: PictureArguments,
}

fn event(text: &str) -> Result<Bifurcation, String> {
    let names = Bifurcation::ALL.map(|event| event.to_string());
    let found = Bifurcation::ALL.into_iter().zip(&names).find(|(_, name)| *name == text);
    found.map(|(event, _)| event).ok_or_else(|| format!("must be one of: {}", names.join(", ")))
}

/// The longest step of a curve, of the ranges and of a radian, where none is given.
pub(super) const LONGEST_STEP: f64 = 0.02;
/// Points of a curve after which it is given up, in either direction.
pub(super) const MOST_POINTS: usize = 2000;

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let model = arguments.model.read_as_drawn(session)?;
    let (name, range) = &arguments.parameter;
    let parameter = Parameter::named(&model, name)?;
    let target = Target::create(&arguments.out, &mut *session.out, arguments.picture.look()?)?;
    let wanted = Search { revolutions: arguments.revolutions, impacts: arguments.impacts };
    let following = Following { parameter, range: *range, longest_step: arguments.step, most_points: MOST_POINTS };
    let events = if arguments.events.is_empty() { &Bifurcation::ALL } else { arguments.events.as_slice() };
    let Curves { own, sharp, curves } =
        watched("", |watch| curves(&model, arguments.rpm, &wanted, events, &following, watch))?;
    let (name, [low, high]) = (following.parameter.name(), arguments.rpm);
    let accounts =
        curves.iter().zip(1..).map(|(found, index)| pages::branches::curve(found, (name, own), index, &sharp));
    let mut accounts: String = accounts.collect();
    if curves.is_empty() {
        let turns = wanted.revolutions;
        accounts = format!(
            "no {} of an orbit of {turns} revolution(s) found between {low} and {high} rpm\n",
            words::any_of(events)
        );
    }
    // Nobody is left to tell where standard error is closed.
    let _ = session.err.write_all(accounts.as_bytes());
    let table = || csv::curves(name, &curves, &model.units);
    target.fill(&model.units, table, || {
        let title = format!("{}: events against {name}", model.name);
        let speeds = curves.iter().flat_map(|found| &found.points).map(|point| point.rpm);
        let found = extent(speeds);
        let shown = if found[0] < found[1] { widened(found, 0.04) } else { arguments.rpm };
        Ok(curve_figure(&title, (name, &model.units.of_number(name), *range, own), shown, &curves))
    })?;
    Ok(Exit::Agrees)
}
