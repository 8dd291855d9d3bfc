//! `corner-impact continue [MODEL] --from-rpm R --parameter NAME=LO:HI`.

use std::io::Write;
use std::path::PathBuf;

use super::picture::{Target, picture_or_table};
use super::start::{parameter, positive, rpm};
use super::{CommandError, Exit, ModelArgument, Session, progress::Progress};
use crate::cam::Cam;
use crate::diagram::settled_impacts;
use crate::draw::Density;
use crate::figures::{branches_figure, corner_marks};
use crate::model::Model;
use crate::orbit::branch::{Branch, Following};
use crate::orbit::{Family, Parameter, PeriodicOrbit, Search, search};
use crate::pages::branch;
use crate::progress::Watch;
use crate::simulate::{Machine, angular_velocity};

/// Follows the orbits of one speed through a parameter, round folds and through corners.
#[derive(clap::Args)]
#[command(
    name = "continue",
    after_help = "Examples:\n\
    \x20 corner-impact continue --from-rpm 700 --parameter rpm=660:760\n\
    \x20 corner-impact continue --from-rpm 700 --parameter restitution=0.5:0.95 --out branches.svg\n\
    \n\
    Prints the table; what each branch passes and where it ends goes to standard error.\n\
    Exit code: 0 done, 2 bad model file, usage or file, or nothing to follow."
)]
pub(super) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    /// Speed at which the orbits are looked for.
    #[arg(long, value_name = "R", value_parser = rpm, allow_hyphen_values = true)]
    from_rpm: f64,
    /// What changes, and from where to where: rpm, or a number of the model file, such as restitution.
    #[arg(long, value_name = "NAME=LO:HI", value_parser = parameter)]
    parameter: (String, [f64; 2]),
    /// Turns of the cam in one period.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..=Search::MOST_REVOLUTIONS))]
    revolutions: u64,
    /// Only orbits that start with this many impacts.
    #[arg(long, value_name = "M")]
    impacts: Option<usize>,
    /// The longest step, of the range and of a radian.
    #[arg(long, value_name = "STEP", default_value_t = 0.02, value_parser = positive)]
    step: f64,
    /// Orbits after which a branch is given up, in either direction.
    #[arg(long, value_name = "N", default_value_t = 2000, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    points: u32,
    /// A table (.csv, or - for standard output) or a picture (.svg, .png).
    #[arg(long, value_name = "FILE", default_value = "-", value_parser = picture_or_table)]
    out: PathBuf,
    /// Values of the parameter at which a picture shows what runs settle on; 0 for none.
    #[arg(long, value_name = "N", default_value_t = 400, value_parser = clap::value_parser!(u32).range(0..=100_000))]
    runs: u32,
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let model = arguments.model.read(session)?;
    let cam = Cam::new(&model)?;
    let corners = corner_marks(&cam);
    let (name, range) = &arguments.parameter;
    let parameter = Parameter::named(&model, name)?;
    let value = parameter.value(&model, arguments.from_rpm).unwrap_or(f64::NAN);
    if !(range[0] <= value && value <= range[1]) {
        let words = format!(
            "{}: orbits are looked for at {} = {value}, which is outside of {}:{}",
            model.file(),
            parameter.name(),
            range[0],
            range[1]
        );
        return Err(CommandError::Words(words));
    }
    let machine = Machine::new(cam, &model.follower, angular_velocity(arguments.from_rpm));
    let wanted = Search { revolutions: arguments.revolutions, impacts: arguments.impacts };
    let progress = Progress::spinner("looking for periodic orbits");
    let orbits = search(&machine, &wanted)?;
    drop(progress);
    if orbits.is_empty() {
        let words = format!(
            "{}: no periodic orbit of {} revolution(s) found at {} rpm to follow",
            model.file(),
            arguments.revolutions,
            arguments.from_rpm
        );
        return Err(CommandError::Words(words));
    }
    let following = Following {
        parameter: parameter.clone(),
        range: *range,
        longest_step: arguments.step,
        most_points: arguments.points as usize,
    };
    let target = Target::create(&arguments.out, &mut *session.out)?;
    let branches = follow(&model, arguments.from_rpm, value, &orbits, &following)?;
    for (index, found) in branches.iter().enumerate() {
        let account = branch::account(found, parameter.name(), index + 1)?;
        // Nobody is left to tell where standard error is closed.
        let _ = session.err.write_all(account.as_bytes());
    }
    let table = |table: &mut dyn Write| {
        table.write_all(branch::COLUMNS.as_bytes())?;
        for (index, found) in branches.iter().enumerate() {
            let mut lines = String::new();
            found.points.iter().for_each(|point| branch::line(&mut lines, parameter.name(), index + 1, point));
            table.write_all(lines.as_bytes())?;
        }
        Ok(())
    };
    target.fill(table, || {
        let settled = settled(&model, arguments, &parameter, *range)?;
        let what = if parameter == Parameter::Speed { "speed" } else { parameter.name() };
        let title = format!("{}: orbits found at {} rpm, followed in {what}", model.name, arguments.from_rpm);
        Ok(branches_figure(&title, (parameter.name(), *range), &branches, settled, &corners))
    })?;
    Ok(Exit::Agrees)
}

/// The branches through `orbits`, each once.
fn follow(
    model: &Model,
    rpm: f64,
    value: f64,
    orbits: &[PeriodicOrbit],
    following: &Following,
) -> Result<Vec<Branch>, CommandError> {
    let mut branches: Vec<Branch> = Vec::new();
    let progress = Progress::new(orbits.len() as u64);
    for (index, orbit) in orbits.iter().enumerate() {
        progress.at("following the orbits found", index as u64, orbits.len() as u64);
        if !branches.iter().any(|branch| branch.holds(value, orbit)) {
            branches.push(Branch::through(model, rpm, orbit, following)?);
        }
    }
    Ok(branches)
}

/// What runs settle on, value by value of the parameter: phases of impacts in degrees.
fn settled(
    model: &Model,
    arguments: &Arguments,
    parameter: &Parameter,
    [low, high]: [f64; 2],
) -> Result<Option<Density>, CommandError> {
    const TRANSIENT: u64 = 300;
    const RECORD: u64 = 100;
    if arguments.runs == 0 {
        return Ok(None);
    }
    let family = Family::new(model, arguments.from_rpm, vec![parameter.clone()])?;
    let mut density = Density::new([low, high], [0.0, 360.0]);
    let progress = Progress::new(u64::from(arguments.runs));
    for index in 0..arguments.runs {
        progress.at("what runs settle on", u64::from(index), u64::from(arguments.runs));
        let value = low + (high - low) * (f64::from(index) + 0.5) / f64::from(arguments.runs);
        // The edge of what the model allows has been told already.
        let Ok((machine, _)) = family.machine(&[value]) else { continue };
        for angle in settled_impacts(&machine, TRANSIENT, RECORD)? {
            density.push(value, angle.to_degrees());
        }
    }
    Ok(Some(density))
}
