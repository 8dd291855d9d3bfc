//! `corner-impact simulate [MODEL] --rpm R`.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::ArgGroup;

use super::numbers::{angle, count, rpm};
use super::picture::{self, Canvas, PictureArguments, is_standard, picture as drawn_only, picture_or_table};
use super::start::{BudgetArguments, StartArguments, cam_angle};
use super::{AnswerArguments, CommandError, Exit, ModelArgument, Session, progress::watched};
use crate::figures::{self, phase_plane as phase_plane_figure, time_trace, with_force};
use crate::show::csv;
use corner_impact::file::{self, Output};
use corner_impact::orbit::long_run::Budget;
use corner_impact::study::simulate::{RunLoads, RunRequest, Sight, Simulation, Until};

/// Simulates one run of a model and summarises it.
#[derive(clap::Args)]
#[command(group = ArgGroup::new("picture").multiple(true))]
#[command(after_help = "Examples:\n\
    \x20 corner-impact simulate --rpm 183 --revolutions 10 --events -\n\
    \x20 corner-impact simulate models/osorio-2008.toml --rpm 183 --out trace.svg\n\
    \n\
    Exit code: 0 done, 2 bad model file, usage or file, or a run that cannot go on.")]
pub(super) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    /// Speed of the cam, rpm.
    #[arg(long, value_name = "R", value_parser = rpm, allow_hyphen_values = true)]
    rpm: f64,
    /// Revolutions of the cam.
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = count, allow_hyphen_values = true,
        conflicts_with = "impacts")]
    revolutions: u64,
    /// Run until this many impacts instead.
    #[arg(long, value_name = "N", value_parser = count, allow_hyphen_values = true)]
    impacts: Option<u64>,
    #[command(flatten)]
    start: StartArguments,
    /// Write impacts, sticks and releases as CSV; - is standard output.
    #[arg(long, value_name = "FILE")]
    events: Option<PathBuf>,
    /// Write the state each time the cam passes this angle, rad or as 90deg, to the file of --strobe-out.
    #[arg(long, value_name = "RAD", value_parser = angle, requires = "strobe_out", allow_hyphen_values = true)]
    strobe: Option<f64>,
    /// File for the states of --strobe, as CSV; - is standard output.
    #[arg(long, value_name = "FILE", requires = "strobe")]
    strobe_out: Option<PathBuf>,
    #[command(flatten)]
    answer: AnswerArguments,
    /// Add the motion that the run settles on, and the growth rate of a small deviation per revolution, as a natural logarithm. For a motion that repeats,
    /// the rate follows from the multipliers. It is -inf (null in JSON) if the follower comes to rest on the cam. Otherwise it is a mean with its standard
    /// error. For this, the run is followed as long as --transient, --record, --longest and --patience ask, however short it is.
    #[arg(long)]
    lyapunov: bool,
    #[command(flatten)]
    budget: BudgetArguments,
    /// Draw follower, cam, gap and contact force over the last revolutions (.svg, .png or .pdf), or write them as CSV (.csv).
    #[arg(long, value_name = "FILE", value_parser = picture_or_table, alias = "trace", conflicts_with = "impacts", group = "picture")]
    out: Option<PathBuf>,
    /// Draw the gap against its velocity over the last revolutions (.svg, .png or .pdf).
    #[arg(long, value_name = "FILE", value_parser = drawn_only, conflicts_with = "impacts", group = "picture")]
    phase_plane: Option<PathBuf>,
    /// Moments of each revolution that --out shows, besides the events [default: 3600 in a picture, 360 in a table].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000), requires = "out")]
    points_per_revolution: Option<u32>,
    /// Number of revolutions to draw [default: 2].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1000))]
    drawn: Option<u64>,
    #[command(flatten)]
    picture: PictureArguments,
}

/// Number of revolutions that are drawn by default.
const DRAWN: u64 = 2;

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let streams = [&arguments.events, &arguments.strobe_out, &arguments.out].map(|path| is_standard(path.as_ref()));
    let streams = streams.into_iter().chain([arguments.answer.json]).filter(|to_standard| *to_standard).count();
    if streams > 1 {
        let words = "--events -, --strobe-out -, --out - and --json all print to standard output: keep one, give the others files";
        return Err(CommandError::Words(words.into()));
    }
    let Arguments { events, strobe_out, out: trace, phase_plane, .. } = arguments;
    let results =
        [("--events", events), ("--strobe-out", strobe_out), ("--out", trace), ("--phase-plane", phase_plane)];
    let request = arguments.picture.request()?;
    let beside = request.files();
    let drawings = [trace, phase_plane].into_iter().flatten().filter(|path| picture::kind(path).is_some()).count();
    if beside.is_some() && drawings > 1 {
        return Err(CommandError::Words(
            "--script draws one picture, but --out and --phase-plane are two: leave one out".into(),
        ));
    }
    let files = results.iter().filter_map(|(option, path)| Some((*option, path.as_deref()?)));
    let beside = beside.iter().flatten().map(|(option, path)| (*option, path.as_path()));
    file::distinct(files.chain(beside).filter(|(_, path)| path.as_os_str() != "-"))?;
    if arguments.drawn.is_some() && trace.is_none() && phase_plane.is_none() {
        return Err(CommandError::Words("--drawn needs --out or --phase-plane".into()));
    }
    let model = arguments.model.read_as_drawn(session)?;
    arguments.start.doubt(session);
    let simulation = Simulation::new(&model, arguments.rpm, arguments.start.start()?)?;
    let (machine, first) = (&simulation.machine, &simulation.first);
    let shown = trace.is_some() || phase_plane.is_some();
    let drawn = if shown { arguments.drawn.unwrap_or(DRAWN) } else { 0 };
    let wanted = RunRequest {
        until: arguments.impacts.map_or(Until::Revolutions(arguments.revolutions), Until::Impacts),
        events: events.is_some(),
        strobe: arguments.strobe.map(|angle| cam_angle("--strobe", angle, session)),
        drawn,
        long_run: arguments.lyapunov.then(|| arguments.budget.budget(Budget::SURVEY)).transpose()?,
    };

    // Every file is begun before the run, so that an impossible name is reported at once.
    let plane = phase_plane.as_deref().map(|path| Canvas::create(path, request.clone())).transpose()?;
    // At most one of the tables is standard output.
    let mut out = Some(&mut *session.out);
    let mut open = |path: &Path, columns: &str| -> Result<Output<'_>, CommandError> {
        let standard = if path.as_os_str() == "-" { out.take() } else { None };
        let mut file = standard.map_or_else(|| Output::file(path), |out| Output::create(path, out))?;
        file.write_all(columns.as_bytes())?;
        Ok(file)
    };
    let mut events = events.as_deref().map(|path| open(path, &model.units.columns(csv::EVENTS))).transpose()?;
    let mut states = strobe_out.as_deref().map(|path| open(path, &model.units.columns(csv::STROBE))).transpose()?;
    let is_drawn = |path: &&Path| picture::kind(path).is_some();
    let trace = trace.as_deref();
    let written =
        trace.filter(|path| !is_drawn(path)).map(|path| open(path, &model.units.columns(csv::TRACE))).transpose()?;
    let trace = trace.filter(is_drawn).map(|path| Canvas::create(path, request)).transpose()?;
    let mut lines = String::new();
    let see = |sight: Sight<'_>| -> Result<(), CommandError> {
        lines.clear();
        let file = match sight {
            Sight::Events(seen) => {
                let omega = machine.angular_velocity();
                seen.iter().for_each(|event| csv::event(&mut lines, event, first.cam_angle, omega, &model.units));
                &mut events
            }
            Sight::State(motion) => {
                csv::strobe(&mut lines, machine, motion);
                &mut states
            }
        };
        Ok(file.as_mut().map_or(Ok(()), |file| file.write_all(lines.as_bytes()))?)
    };
    let mut run = watched("following the motion", |watch| simulation.run(wanted, watch, see))?;
    if arguments.answer.json || streams == 0 {
        run.loads = RunLoads::of(&model, machine, &run)?;
    }
    let seen = |points: u32| {
        let points = arguments.points_per_revolution.unwrap_or(points);
        figures::TracedRun::new(machine, run.before_drawn, drawn.min(arguments.revolutions), points)
    };
    let written = written.map(|mut file| -> Result<_, CommandError> {
        let omega = machine.angular_velocity();
        let lines = csv::trace(&seen(figures::TracedRun::WRITTEN)?.samples, first.cam_angle, omega, &model);
        file.write_all(lines.as_bytes())?;
        Ok(file)
    });
    let mut files: Vec<Output<'_>> = [events, states, written.transpose()?].into_iter().flatten().collect();
    let title = format!("{} at {} rpm", model.name, arguments.rpm);
    if let Some(canvas) = trace {
        let run = seen(figures::TracedRun::DRAWN)?;
        let figure = with_force(time_trace(&title, &run), &run, model.follower.mass, &model.units.force);
        files.extend(canvas.draw(figure, &model.units)?);
    }
    if let Some(canvas) = plane {
        files.extend(canvas.draw(phase_plane_figure(&title, &seen(figures::TracedRun::DRAWN)?), &model.units)?);
    }
    Output::commit_all(files)?;
    if arguments.answer.json || streams == 0 {
        session.answer(&run, &arguments.answer)?;
    }
    Ok(Exit::Agrees)
}
