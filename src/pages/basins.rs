//! What a grid of starts came to, for scripts and for people.

use std::fmt::{self, Write};

use serde::Serialize;

use crate::show::page::{Page, WIDTH};
use crate::study::basins::{Basins, Ending, Part};

/// The summary of a grid of starts.
#[derive(Clone, Debug, Serialize)]
pub struct BasinsSummary {
    /// `corner-impact/basins/1`.
    pub schema: &'static str,
    /// The model's name.
    pub model: String,
    /// Speed, rpm.
    pub rpm: f64,
    /// The section, rad.
    pub cam_angle_rad: f64,
    /// Ends of the grid, m.
    pub position_m: [f64; 2],
    /// Ends of the grid, m/s.
    pub velocity_m_s: [f64; 2],
    /// Cells along the positions and along the velocities.
    pub cells: [usize; 2],
    /// Starts above the cam.
    pub starts: usize,
    /// What they end on, that of most starts first.
    pub endings: Vec<EndingEntry>,
    /// Seconds that the runs took.
    pub wall_s: f64,
}

/// The starts that end alike.
#[derive(Clone, Debug, Serialize)]
pub struct EndingEntry {
    /// `orbit`, `chaotic`, `resting` or `undecided`.
    pub ending: &'static str,
    /// Of an orbit: turns of the cam in one period.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub revolutions: Option<u64>,
    /// Of an orbit: impacts in one period.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub impacts: Option<usize>,
    /// How many starts.
    pub starts: usize,
    /// Of all starts above the cam.
    pub share: f64,
    /// Of the share, for starts drawn by chance: for a grid an upper bound.
    pub share_standard_error: f64,
}

impl BasinsSummary {
    /// Of `basins` at `rpm`.
    pub fn new(model: &str, rpm: f64, basins: &Basins, wall_s: f64) -> Self {
        let entry = |part: &Part| {
            let orbit = if let Ending::Orbit(orbit) = &part.ending { Some(orbit) } else { None };
            EndingEntry {
                ending: part.ending.name(),
                revolutions: orbit.map(|orbit| orbit.revolutions),
                impacts: orbit.map(|orbit| orbit.impacts().count()),
                starts: part.starts,
                share: part.share,
                share_standard_error: part.standard_error,
            }
        };
        let grid = &basins.grid;
        Self {
            schema: "corner-impact/basins/1",
            model: model.into(),
            rpm,
            cam_angle_rad: grid.cam_angle,
            position_m: grid.positions,
            velocity_m_s: grid.velocities,
            cells: [grid.columns, grid.rows],
            starts: basins.starts(),
            endings: basins.parts.iter().map(entry).collect(),
            wall_s,
        }
    }

    /// For people, as wide as where nothing says how wide, without marks.
    pub fn text(&self) -> Result<String, fmt::Error> {
        Ok(self.page(WIDTH)?.plain().to_owned())
    }

    /// For people, in `width` columns.
    pub fn page(&self, width: usize) -> Result<Page, fmt::Error> {
        let mut page = Page::new(width);
        writeln!(
            page,
            "{} at {} rpm, {} starts at {:.4} deg",
            self.model,
            self.rpm,
            self.starts,
            self.cam_angle_rad.to_degrees()
        )?;
        for entry in &self.endings {
            let EndingEntry { ending, starts, share, share_standard_error, .. } = entry;
            let orbit = match (entry.revolutions, entry.impacts) {
                (Some(revolutions), Some(impacts)) => format!(", revolutions {revolutions}, impacts {impacts}"),
                _ => String::new(),
            };
            writeln!(page, "  {share:.4} ± {share_standard_error:.4}  {ending}{orbit} ({starts})")?;
        }
        writeln!(page, "  {:.3} s", self.wall_s)?;
        Ok(page)
    }
}
