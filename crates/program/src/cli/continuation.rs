//! `corner-impact continue [MODEL] --rpm R --over NAME=LO:HI`.

use std::path::PathBuf;

use super::numbers::{followed, positive, rpm};
use super::picture::{PictureArguments, Target, picture_or_table, table};
use super::{CommandError, Exit, ModelArgument, Session, progress::watched, session::in_columns};
use crate::figures::{branches_figure, corner_marks};
use crate::pages;
use crate::show::csv;
use corner_impact::cam::Cam;
use corner_impact::json;
use corner_impact::orbit::branch::Following;
use corner_impact::orbit::{Parameter, Search};
use corner_impact::study::continuation::branches;

/// Follows periodic orbits through a number, round folds and corners.
///
/// The orbits to start from are those at one speed.
#[derive(clap::Args)]
#[command(
    name = "continue",
    after_help = "Examples:\n\
    \x20 corner-impact continue --rpm 700 --over rpm=660:760\n\
    \x20 corner-impact continue --rpm 700 --over restitution=0.5:0.95 --out branches.svg\n\
    \x20 corner-impact continue --rpm 738 --over rpm=735:745 --all\n\
    \n\
    Prints the table. The special points of each branch and its end go to standard error.\n\
    Exit code: 0 done, 2 bad model file, usage or file, or nothing to follow."
)]
pub(super) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    /// Speed at which the search for orbits starts.
    #[arg(long, value_name = "R", value_parser = rpm, alias = "from-rpm", allow_hyphen_values = true)]
    rpm: f64,
    /// Number to vary, with its lowest and highest value: rpm, or a number of the model such as restitution.
    #[arg(long, value_name = "NAME=LO:HI", value_parser = followed, alias = "parameter", allow_hyphen_values = true)]
    over: (String, [f64; 2]),
    /// Revolutions of the cam in one period.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..=Search::MOST_REVOLUTIONS))]
    revolutions: u64,
    /// Follow only orbits that start with this many impacts.
    #[arg(long, value_name = "M")]
    impacts: Option<usize>,
    /// Longest step, as a fraction of the range and of a radian.
    #[arg(long, value_name = "STEP", default_value_t = 0.02, value_parser = positive)]
    step: f64,
    /// Most orbits of a branch, in either direction.
    #[arg(long, value_name = "N", default_value_t = 2000, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    points: u32,
    /// Also follow branches of twice the period, which begin at flips, grazes and corner impacts, and branches that cross. Their own branches follow,
    /// DOUBLINGS times in all; without a number, 3 times.
    #[arg(long, value_name = "DOUBLINGS", num_args = 0..=1, require_equals = true, default_value_t = 0, default_missing_value = "3", value_parser = clap::value_parser!(u32).range(0..=10))]
    all: u32,
    /// Write a table (.csv, or - for standard output) or a picture (.svg, .png, .pdf) [default: -].
    #[arg(long, value_name = "FILE", value_parser = picture_or_table, group = "picture")]
    out: Option<PathBuf>,
    /// Print one JSON document instead of the table.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    picture: PictureArguments,
    /// Number of values at which a picture also shows what runs settle on; 0 for none.
    #[arg(long, value_name = "N", default_value_t = 400, value_parser = clap::value_parser!(u32).range(0..=100_000))]
    runs: u32,
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let model = arguments.model.read_as_drawn(session)?;
    let corners = corner_marks(&Cam::new(&model)?);
    let (name, range) = &arguments.over;
    let following = Following {
        parameter: Parameter::named(&model, name)?,
        range: *range,
        longest_step: arguments.step,
        most_points: arguments.points as usize,
    };
    let (request, columns) = (arguments.picture.request()?, session.columns_err());
    let out = table(arguments.out.as_ref(), arguments.json)?;
    let target = out.map(|path| Target::create(path, &mut *session.out, request)).transpose()?;
    let wanted = Search { revolutions: arguments.revolutions, impacts: arguments.impacts };
    let found = watched("following branches", |watch| {
        branches(&model, arguments.rpm, &wanted, following, arguments.all, watch)
    })?;
    let name = found.following.parameter.name();
    for (index, branch) in found.branches.iter().enumerate() {
        let account = in_columns(&pages::branches::branch(branch, (name, &model.units), index + 1), columns);
        if !session.quiet {
            // If standard error is closed, the failure cannot be reported.
            let _ = session.err.write_all(account.as_bytes());
        }
    }
    let rows = || csv::branches(name, &found.branches, &model.units);
    let drawn = || {
        let settled = watched("what runs settle on", |watch| found.settled(arguments.runs, watch))?;
        Ok(branches_figure(
            &found.title(),
            (name, &model.units.of_number(name), *range),
            &found.branches,
            &settled,
            &corners,
        ))
    };
    target.map(|target| target.fill(&model.units, rows, drawn)).transpose()?;
    if arguments.json {
        session.print(&json::render(&found, &model.units)?)?;
    }
    Ok(Exit::Agrees)
}
