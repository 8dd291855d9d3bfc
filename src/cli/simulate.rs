//! `corner-impact simulate [MODEL] --rpm R`.

use std::io::Write;
use std::ops::ControlFlow;
use std::path::{Component, Path, PathBuf};
use std::time::{Duration, Instant};

use super::picture::{Canvas, is_standard, picture};
use super::start::{StartArguments, count, finite, rpm, turn};
use super::{CommandError, Exit, ModelArgument, Session, progress::Progress};
use crate::cam::Cam;
use crate::cli::file::Output;
use crate::diagram::growth_and_error;
use crate::figures::run::Exponent;
use crate::figures::{self, RunSummary, phase_plane, time_trace};
use crate::model::Model;
use crate::show::csv;
use crate::simulate::{Event, EventKind, Goal, Machine, Motion, angular_velocity};

/// Runs one motion of a model and says what happened.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n\
    \x20 corner-impact simulate --rpm 183 --revolutions 10 --events -\n\
    \x20 corner-impact simulate models/osorio-2008.toml --rpm 183 --trace trace.svg\n\
    \n\
    Exit code: 0 done, 2 bad model file, usage or file, or a run that cannot go on.")]
pub(super) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    /// Speed of the cam.
    #[arg(long, value_name = "R", value_parser = rpm, allow_hyphen_values = true)]
    rpm: f64,
    /// Turns of the cam.
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = count, allow_hyphen_values = true,
        conflicts_with = "impacts")]
    revolutions: u64,
    /// Run up to this many impacts instead.
    #[arg(long, value_name = "N", value_parser = count, allow_hyphen_values = true)]
    impacts: Option<u64>,
    #[command(flatten)]
    start: StartArguments,
    /// Write impacts, sticks and releases as CSV; - is standard output.
    #[arg(long, value_name = "FILE")]
    events: Option<PathBuf>,
    /// Write the state each time the cam passes this angle, rad, to the file of --strobe-out.
    #[arg(long, value_name = "RAD", value_parser = finite, requires = "strobe_out", allow_hyphen_values = true)]
    strobe: Option<f64>,
    /// Where the states go, as CSV; - is standard output.
    #[arg(long, value_name = "FILE", requires = "strobe")]
    strobe_out: Option<PathBuf>,
    /// Print the summary as one JSON document.
    #[arg(long)]
    summary: bool,
    /// Add the growth of a small deviation per revolution to the summary, a natural logarithm, with its standard error over
    /// twenty blocks of revolutions: -inf (null in JSON) where the follower came to stick to the cam, be it once.
    #[arg(long, conflicts_with = "impacts")]
    lyapunov: bool,
    /// Draw follower, cam and gap over the last revolutions (.svg or .png).
    #[arg(long, value_name = "FILE", value_parser = picture, conflicts_with = "impacts")]
    trace: Option<PathBuf>,
    /// Draw the gap against its velocity over the last revolutions (.svg or .png).
    #[arg(long, value_name = "FILE", value_parser = picture, conflicts_with = "impacts")]
    phase_plane: Option<PathBuf>,
    /// How many revolutions are drawn [default: 2].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1000))]
    drawn: Option<u64>,
}

/// Events that are kept before they are written.
const KEPT: usize = 4096;
/// Revolutions between two looks at the progress.
const STRIDE: u64 = 4096;
/// Revolutions that are drawn where nothing else is asked for.
const DRAWN: u64 = 2;
/// Blocks of revolutions whose exponents tell the error of their mean.
const BLOCKS: u32 = 20;
/// Revolutions without an impact after which none is waited for.
const PATIENCE: u64 = 100_000;

/// What has been counted and kept on the way.
#[derive(Default)]
struct Seen {
    impacts: u64,
    sticks: u64,
    releases: u64,
    kept: Vec<Event>,
}

impl Seen {
    fn take(&mut self, event: &Event, keep: bool) -> bool {
        match event.kind {
            EventKind::Impact => self.impacts += 1,
            EventKind::Stick => self.sticks += 1,
            EventKind::Release => self.releases += 1,
        }
        if keep {
            self.kept.push(*event);
        }
        self.kept.len() >= KEPT
    }
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let streams = [&arguments.events, &arguments.strobe_out].map(|path| is_standard(path.as_ref()));
    let streams = streams.into_iter().chain([arguments.summary]).filter(|to_standard| *to_standard).count();
    if streams > 1 {
        let words = "--events -, --strobe-out - and --summary all print to standard output: give the tables files";
        return Err(CommandError::Words(words.into()));
    }
    let Arguments { events, strobe_out, trace, phase_plane, .. } = arguments;
    distinct(&[
        ("--events", events),
        ("--strobe-out", strobe_out),
        ("--trace", trace),
        ("--phase-plane", phase_plane),
    ])?;
    if arguments.drawn.is_some() && trace.is_none() && phase_plane.is_none() {
        return Err(CommandError::Words(
            "--drawn says how much --trace and --phase-plane draw: neither is there".into(),
        ));
    }
    let model = arguments.model.read(session)?;
    let cam = Cam::new(&model)?;
    let machine = Machine::new(cam, &model.follower, angular_velocity(arguments.rpm));
    let start = arguments.start.start();
    let first = start.motion(&machine)?;
    let drawn = first.after(arguments.revolutions.saturating_sub(arguments.drawn.unwrap_or(DRAWN)));

    // Every file is begun before the run: a name that cannot be is told at once.
    let trace = arguments.trace.as_deref().map(Canvas::create).transpose()?;
    let plane = arguments.phase_plane.as_deref().map(Canvas::create).transpose()?;
    let (run, mut files) = simulate(arguments, &machine, first, drawn, &mut *session.out)?;
    let Run { motion, seen, wall, before_drawn } = run;
    let turned = (motion.revolution as f64) + (motion.cam_angle - first.cam_angle) / std::f64::consts::TAU;
    let progress = arguments.lyapunov.then(|| Progress::spinner("how fast a small deviation grows"));
    // A run of its own: it begins where the follower leaves the cam, and stops after each revolution.
    let grown = || growth_and_error(&machine, first, arguments.revolutions, BLOCKS);
    let grown = arguments.lyapunov.then(grown).transpose()?;
    drop(progress);
    files.extend(draw(arguments, &model, &machine, before_drawn, [trace, plane])?);
    super::commit(files)?;
    let summary = RunSummary {
        schema: "corner-impact/simulate/1",
        model: model.name.clone(),
        rpm: arguments.rpm,
        revolutions: turned,
        impacts: seen.impacts,
        sticks: seen.sticks,
        releases: seen.releases,
        end: figures::run::End::from(&motion),
        lyapunov_per_revolution: grown.map(|(mean, _)| Exponent(mean)),
        lyapunov_standard_error: grown.and_then(|(_, error)| error),
        wall_s: wall.as_secs_f64(),
    };
    if arguments.summary || streams == 0 {
        session.answer(&summary, arguments.summary, |width| summary.page(width))?;
    }
    Ok(Exit::Agrees)
}

/// Refuses two files of one name: the second would be all that is left.
fn distinct(files: &[(&str, &Option<PathBuf>)]) -> Result<(), CommandError> {
    // As far as names tell: ./x is x.
    let parts = |path: &Path| path.components().filter(|part| *part != Component::CurDir).collect::<PathBuf>();
    let mut names: Vec<(&str, PathBuf)> = Vec::new();
    let given = files.iter().filter_map(|(option, path)| Some((*option, path.as_deref()?)));
    for (option, path) in given.filter(|(_, path)| path.as_os_str() != "-") {
        let name = parts(path);
        if let Some((before, _)) = names.iter().find(|(_, other)| *other == name) {
            return Err(CommandError::Words(format!("{before} and {option} are both {}", path.display())));
        }
        names.push((option, name));
    }
    Ok(())
}

/// What a run came to, and the motion where the pictures begin.
struct Run {
    motion: Motion,
    seen: Seen,
    wall: Duration,
    before_drawn: Motion,
}

/// The run itself, with its tables, written but not yet files of their names; pictures begin at `drawn`.
fn simulate<'a>(
    arguments: &Arguments,
    machine: &Machine,
    first: Motion,
    drawn: Goal,
    out: &'a mut dyn Write,
) -> Result<(Run, Vec<Output<'a>>), CommandError> {
    // At most one of the tables is standard output.
    let mut out = Some(out);
    let mut open = |path: Option<&PathBuf>| -> Result<Option<Output<'a>>, CommandError> {
        let Some(path) = path else { return Ok(None) };
        let standard = if is_standard(Some(path)) { out.take() } else { None };
        Ok(Some(standard.map_or_else(|| Output::file(path), |out| Output::create(path, out))?))
    };
    let mut events = open(arguments.events.as_ref())?;
    let mut states = open(arguments.strobe_out.as_ref())?;
    write(&mut events, csv::EVENTS)?;
    write(&mut states, csv::STROBE)?;
    let strobe = arguments.strobe.map(turn);
    let most = arguments.impacts.unwrap_or(u64::MAX);
    let revolutions = if arguments.impacts.is_some() { u64::MAX } else { arguments.revolutions };
    let end = first.after(revolutions);
    let progress = Progress::new(arguments.impacts.unwrap_or(revolutions));

    let (mut motion, mut before_drawn, mut seen) = (first, first, Seen::default());
    let (mut wall, mut lines, mut last_impact) = (Duration::ZERO, String::new(), 0);
    while seen.impacts < most {
        let mut goal = earlier(end, motion.after(STRIDE));
        goal = strobe.map_or(goal, |angle| earlier(goal, motion.next(angle)));
        if (motion.revolution, motion.cam_angle) < (drawn.revolution, drawn.cam_angle) {
            goal = earlier(goal, drawn);
        }
        let keep = events.is_some();
        let impacts = seen.impacts;
        let clock = Instant::now();
        let flow = machine.advance(&mut motion, goal, &mut |event: &Event| {
            let full = seen.take(event, keep);
            if full || seen.impacts >= most { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        wall += clock.elapsed();
        for event in seen.kept.drain(..) {
            csv::event(&mut lines, &event, first.cam_angle, machine.angular_velocity());
        }
        write(&mut events, &lines)?;
        lines.clear();
        let flow = flow?;
        if seen.impacts > impacts {
            last_impact = motion.revolution;
        } else if arguments.impacts.is_some() && motion.revolution - last_impact > PATIENCE {
            let at = motion.cam_angle.to_degrees();
            return Err(CommandError::Words(format!(
                "simulate: no impact in {PATIENCE} revolutions after impact {impacts}; the cam is at {at:.4} deg of revolution {}",
                motion.revolution
            )));
        }
        if flow.is_break() {
            continue;
        }
        if goal == drawn {
            before_drawn = motion;
        }
        if strobe == Some(goal.cam_angle) {
            csv::strobe(&mut lines, machine, &motion);
            write(&mut states, &lines)?;
            lines.clear();
        }
        progress.set(if arguments.impacts.is_some() { seen.impacts } else { motion.revolution });
        if goal == end {
            break;
        }
    }
    Ok((Run { motion, seen, wall, before_drawn }, [events, states].into_iter().flatten().collect()))
}

fn earlier(one: Goal, other: Goal) -> Goal {
    if one <= other { one } else { other }
}

fn write(output: &mut Option<Output<'_>>, text: &str) -> Result<(), CommandError> {
    Ok(output.as_mut().map_or(Ok(()), |output| output.write_all(text.as_bytes()))?)
}

/// The pictures, of the revolutions from `motion` on.
fn draw(
    arguments: &Arguments,
    model: &Model,
    machine: &Machine,
    motion: Motion,
    [trace, plane]: [Option<Canvas>; 2],
) -> Result<Vec<Output<'static>>, CommandError> {
    let mut files = Vec::new();
    if trace.is_none() && plane.is_none() {
        return Ok(files);
    }
    let revolutions = arguments.drawn.unwrap_or(DRAWN).min(arguments.revolutions);
    let run = figures::Run::new(machine, motion, revolutions)?;
    let title = format!("{} at {} rpm", model.name, arguments.rpm);
    if let Some(canvas) = trace {
        files.push(canvas.draw(&time_trace(&title, &run))?);
    }
    if let Some(canvas) = plane {
        files.push(canvas.draw(&phase_plane(&title, &run))?);
    }
    Ok(files)
}
