//! `corner-impact basins [MODEL] --rpm R --grid NxM`.

use std::io::Write;
use std::path::PathBuf;
use std::time::Instant;

use super::start::{finite, range, rpm, turn};
use super::{CommandError, Exit, ModelArgument, Session, picture, picture::Target, progress::Progress};
use crate::cam::Cam;
use crate::draw::Figure;
use crate::figures::basins_figure;
use crate::flight::State;
use crate::model::Model;
use crate::orbit::{Course, PeriodicOrbit, Search, search};
use crate::pages::BasinsSummary;
use crate::section::StroboscopicMap;
use crate::show::csv;
use crate::simulate::{Machine, angular_velocity};
use crate::study::basins::{Basins, Curve, Ending, Extent, Grid, Patience, Reversed, Saddle};

/// Runs a grid of starts at one speed and says what each ends on, as a table or a picture.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n\
    \x20 corner-impact basins --rpm 678 --strobe 5.76 --grid 60x40\n\
    \x20 corner-impact basins models/osorio-2008.toml --rpm 678 --strobe 5.76 --grid 200x150 --out basins.png\n\
    \n\
    Exit code: 0 done, 2 bad model file, usage or file, or a run that cannot go on.")]
pub(super) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    /// Speed of the cam, rpm.
    #[arg(long, value_name = "RPM", value_parser = rpm, allow_hyphen_values = true)]
    rpm: f64,
    /// Cells along the positions and along the velocities.
    #[arg(long, value_name = "NxM", value_parser = cells)]
    grid: [usize; 2],
    /// The section: the cam angle at which the starts are, rad.
    #[arg(long, value_name = "RAD", value_parser = finite, default_value_t = 0.0, allow_hyphen_values = true)]
    strobe: f64,
    /// Positions [default: from the cam to twice as far from it as any orbit of one impact a revolution].
    #[arg(long, value_name = "LO:HI", value_parser = range, allow_hyphen_values = true)]
    position: Option<[f64; 2]>,
    /// Velocities [default: three times the range of those orbits and of the cam].
    #[arg(long, value_name = "LO:HI", value_parser = range, allow_hyphen_values = true)]
    velocity: Option<[f64; 2]>,
    /// Revolutions within which a start must have settled on an orbit, or else ends on none.
    #[arg(long, value_name = "N", default_value_t = Patience::default().revolutions, value_parser = clap::value_parser!(u64).range(1..=1_000_000_000))]
    revolutions: u64,
    /// The longest period of an orbit, revolutions.
    #[arg(long, value_name = "N", default_value_t = Patience::default().longest, value_parser = clap::value_parser!(u64).range(1..=Search::MOST_REVOLUTIONS))]
    longest: u64,
    /// Threads [default: one for each core].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// A table (.csv, or - for standard output) or a picture (.svg, .png).
    #[arg(long, value_name = "FILE", value_parser = picture::picture_or_table)]
    out: Option<PathBuf>,
    /// Print a summary as one JSON document.
    #[arg(long)]
    summary: bool,
}

/// `NxM`.
fn cells(text: &str) -> Result<[usize; 2], String> {
    let count = |part: &str| part.trim().parse::<usize>().map_err(|_| format!("\"{part}\" is not a number of cells"));
    let Some((columns, rows)) = text.split_once('x') else {
        return Err("must be NxM: cells along the positions and along the velocities".into());
    };
    let (columns, rows) = (count(columns)?, count(rows)?);
    match columns.checked_mul(rows) {
        Some(1..=Grid::MOST) => Ok([columns, rows]),
        _ => Err(format!("must be 1 to {} cells", Grid::MOST)),
    }
}

/// Where an orbit of impacts crosses the section.
fn crossing(machine: &Machine, orbit: &PeriodicOrbit, cam_angle: f64) -> Option<State> {
    match &orbit.course {
        Course::Impacts(cycle) => Some(cycle.at_section(machine, cam_angle).0),
        Course::Sticking(_) | Course::Free => None,
    }
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let to_standard = picture::out_is_standard(arguments.out.as_ref(), arguments.summary)?;
    let model = arguments.model.read(session)?;
    let cam = Cam::new(&model)?;
    let machine = Machine::new(cam, &model.follower, angular_velocity(arguments.rpm));
    let map = StroboscopicMap { machine, cam_angle: turn(arguments.strobe) };
    let orbits = search(&map.machine, &Search { revolutions: 1, impacts: Some(1) })?;
    let grid = grid(arguments, &map, &orbits)?;
    let patience = Patience { revolutions: arguments.revolutions, longest: arguments.longest };
    let clock = Instant::now();
    let threads = arguments.threads.map(usize::from);
    let progress = Progress::new((grid.columns * grid.rows) as u64);
    let basins = grid.basins_watched(&map.machine, patience, threads, &progress)?;
    drop(progress);
    let wall_s = clock.elapsed().as_secs_f64();
    if let Some(path) = &arguments.out {
        let table = |table: &mut dyn Write| Ok(table.write_all(csv::basins(&basins).as_bytes())?);
        let picture = || Ok(draw(&model, &map, &orbits, &basins, arguments.rpm));
        Target::create(path, &mut *session.out)?.fill(table, picture)?;
    }
    let summary = BasinsSummary::new(&model.name, arguments.rpm, &basins, wall_s);
    if !to_standard {
        session.answer(&summary, arguments.summary, |width| summary.page(width))?;
    }
    Ok(Exit::Agrees)
}

fn grid(arguments: &Arguments, map: &StroboscopicMap, orbits: &[PeriodicOrbit]) -> Result<Grid, CommandError> {
    let lift = map.machine.cam().lift(map.cam_angle);
    let cam_velocity = map.machine.angular_velocity() * lift.slope;
    let crossings = orbits.iter().filter_map(|orbit| crossing(&map.machine, orbit, map.cam_angle));
    let (mut highest, mut velocities) = (map.machine.cam().top(), [cam_velocity.min(-1.0), cam_velocity.max(1.0)]);
    for State { position, velocity } in crossings {
        highest = highest.max(position);
        velocities = [velocities[0].min(velocity), velocities[1].max(velocity)];
    }
    let span = velocities[1] - velocities[0];
    let grid = Grid {
        cam_angle: map.cam_angle,
        positions: arguments.position.unwrap_or([lift.value, lift.value + 2.0 * (highest - lift.value)]),
        velocities: arguments.velocity.unwrap_or([velocities[0] - span, velocities[1] + span]),
        columns: arguments.grid[0],
        rows: arguments.grid[1],
    };
    let is_range = |[low, high]: [f64; 2]| low < high && (high - low).is_finite();
    if is_range(grid.positions) && is_range(grid.velocities) {
        return Ok(grid);
    }
    Err(CommandError::Words("no range to put starts in: give --position and --velocity".into()))
}

fn draw(model: &Model, map: &StroboscopicMap, orbits: &[PeriodicOrbit], basins: &Basins, rpm: f64) -> Figure {
    let machine = &map.machine;
    let endings = basins.parts.iter().filter_map(|part| match &part.ending {
        Ending::Orbit(orbit) => crossing(machine, orbit, map.cam_angle),
        _ => None,
    });
    let saddles: Vec<Saddle> = orbits
        .iter()
        .filter_map(|orbit| match &orbit.course {
            Course::Impacts(cycle) => Saddle::new(machine, cycle, map.cam_angle),
            _ => None,
        })
        .collect();
    let [low, high] = basins.grid.positions;
    let extent = Extent::of(high - low);
    let reversed = Reversed::new(&model.follower, map);
    let halves = |saddle: &Saddle| {
        reversed.iter().flat_map(|r| [1.0, -1.0].map(|s| Curve::stable(r, saddle, s, &extent))).collect::<Vec<_>>()
    };
    let curves: Vec<Curve> = saddles.iter().flat_map(halves).collect();
    let title = format!("{} at {rpm} rpm: what each start ends on", model.name);
    let stable: Vec<State> = endings.collect();
    let saddles: Vec<State> = saddles.iter().map(|saddle| saddle.state).collect();
    basins_figure(&title, basins, &stable, &saddles, &curves)
}
