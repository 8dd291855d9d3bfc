//! Events and states as lines of CSV: numbers in the fewest digits that read back as the same double.

use std::fmt::Write;

use crate::diagram::{Block, Row, Seen};
use crate::flight::State;
use crate::simulate::{Event, Machine, Motion};
use crate::study::basins::{Basins, Ending};

/// The columns of a run's events.
pub const EVENTS: &str =
    "revolution,time_s,cam_angle_rad,event,position_m,velocity_before_m_s,velocity_after_m_s,cam_velocity_m_s\n";

/// The columns of a run's states at one angle.
pub const STROBE: &str = "revolution,position_m,velocity_m_s,gap_m,contact\n";

/// The columns of a diagram of impacts.
pub const IMPACT_DIAGRAM: &str = "rpm,revolution,cam_angle_rad,event,position_m,velocity_before_m_s,velocity_after_m_s";

/// The columns of a stroboscopic diagram.
pub const STROBE_DIAGRAM: &str = "rpm,revolution,position_m,velocity_m_s";

/// The column that a diagram has on request.
pub const LYAPUNOV: &str = ",lyapunov_per_revolution";

/// Appends an event of a run at `angular_velocity`, rad/s, that started at `start_angle`, rad.
pub fn event(line: &mut String, event: &Event, start_angle: f64, angular_velocity: f64) {
    let Event { revolution, cam_angle, position, velocity_before, velocity_after, cam_velocity, .. } = event;
    let (time, kind) = (event.turned_since(start_angle) / angular_velocity, event.kind.name());
    // Writing to a string does not fail.
    let _ = writeln!(
        line,
        "{revolution},{time},{cam_angle},{kind},{position},{velocity_before},{velocity_after},{cam_velocity}"
    );
}

/// Appends the state of a run at a section.
pub fn strobe(line: &mut String, machine: &Machine, motion: &Motion) {
    let State { position, velocity } = motion.state;
    let (gap, contact) = (machine.gap(motion), motion.contact);
    let _ = writeln!(line, "{},{position},{velocity},{gap},{contact}", motion.revolution);
}

/// Lines of a diagram, as a worker makes them.
#[derive(Debug, Default)]
pub struct Lines(pub String);

impl Lines {
    /// Characters after which lines are sent on.
    const FULL: usize = 1 << 15;
}

impl Block for Lines {
    fn push(&mut self, row: &Row) {
        let line = &mut self.0;
        let Row { rpm, revolution, seen, lyapunov } = row;
        let _ = match seen {
            Seen::Event(event) => {
                let Event { cam_angle, position, velocity_before, velocity_after, .. } = event;
                let kind = event.kind.name();
                write!(line, "{rpm},{revolution},{cam_angle},{kind},{position},{velocity_before},{velocity_after}")
            }
            Seen::Section(State { position, velocity }) => write!(line, "{rpm},{revolution},{position},{velocity}"),
        };
        if let Some(exponent) = lyapunov {
            let _ = write!(line, ",{exponent}");
        }
        line.push('\n');
    }

    fn is_full(&self) -> bool {
        self.0.len() >= Self::FULL
    }
}

/// The columns of a grid of starts; those of an orbit are empty where there is none, `ending` where the start is below the
/// cam.
pub const BASINS: &str = "position_m,velocity_m_s,ending,part,revolutions,impacts\n";

/// A line for each start, row by row.
pub fn basins(basins: &Basins) -> String {
    let mut lines = String::from(BASINS);
    for (cell, part) in basins.cells.iter().enumerate() {
        let State { position, velocity } = basins.grid.start(cell);
        let _ = write!(lines, "{position},{velocity},");
        let _ = match part.map(|index| (index, &basins.parts[index].ending)) {
            None => writeln!(lines, ",,,"),
            Some((index, Ending::Orbit(orbit))) => {
                writeln!(lines, "orbit,{index},{},{}", orbit.revolutions, orbit.impacts().count())
            }
            Some((index, ending)) => writeln!(lines, "{},{index},,", ending.name()),
        };
    }
    lines
}
