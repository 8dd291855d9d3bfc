//! What a run and a sweep came to, for scripts and for people.

use std::fmt::{self, Write};

use serde::Serialize;

use crate::diagram::Tally;
use crate::show::page::{Page, WIDTH};
use crate::simulate::Motion;

/// A run's summary.
#[derive(Clone, Debug, Serialize)]
pub struct RunSummary {
    /// `corner-impact/simulate/1`.
    pub schema: &'static str,
    /// The model's name.
    pub model: String,
    /// Speed, rpm.
    pub rpm: f64,
    /// Turns of the cam.
    pub revolutions: f64,
    /// Impacts.
    pub impacts: u64,
    /// How often the follower began to stay on the cam.
    pub sticks: u64,
    /// How often the cam let go of it.
    pub releases: u64,
    /// Where it ended.
    #[serde(rename = "final")]
    pub end: End,
    /// Growth of a small deviation per revolution, as a natural logarithm, if asked for; null where the follower
    /// came to stick to the cam.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lyapunov_per_revolution: Option<Exponent>,
    /// Its standard error, where there is one: that of the mean of twenty blocks, taken for independent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lyapunov_standard_error: Option<f64>,
    /// Seconds that the simulation took, without reading, writing and drawing.
    pub wall_s: f64,
}

/// A Lyapunov exponent; minus infinity, which JSON does not have, is null.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponent(pub f64);

impl Serialize for Exponent {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.0.is_finite() { serializer.serialize_f64(self.0) } else { serializer.serialize_none() }
    }
}

/// The end of a run.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct End {
    /// rad, in [0, 2 pi).
    pub cam_angle_rad: f64,
    /// m, in the cam's coordinates.
    pub position_m: f64,
    /// m/s.
    pub velocity_m_s: f64,
    /// Whether it sticks to the cam.
    pub contact: bool,
}

impl From<&Motion> for End {
    fn from(motion: &Motion) -> Self {
        Self {
            cam_angle_rad: motion.cam_angle,
            position_m: motion.state.position,
            velocity_m_s: motion.state.velocity,
            contact: motion.contact,
        }
    }
}

impl RunSummary {
    /// For people, as wide as where nothing says how wide, without marks.
    pub fn text(&self) -> Result<String, fmt::Error> {
        Ok(self.page(WIDTH)?.plain().to_owned())
    }

    /// For people, in `width` columns.
    pub fn page(&self, width: usize) -> Result<Page, fmt::Error> {
        let mut page = Page::new(width);
        let End { cam_angle_rad, position_m, velocity_m_s, contact } = self.end;
        let degrees = cam_angle_rad.to_degrees();
        writeln!(page, "{} at {} rpm, {} revolutions", self.model, self.rpm, self.revolutions)?;
        writeln!(page, "  impacts {}, sticks {}, releases {}", self.impacts, self.sticks, self.releases)?;
        let place = if contact { ", on the cam" } else { "" };
        writeln!(page, "  ends at {degrees:.4} deg with q = {position_m:.9} m, v = {velocity_m_s:.9} m/s{place}")?;
        if let Some(Exponent(exponent)) = self.lyapunov_per_revolution {
            let why =
                if exponent == f64::NEG_INFINITY { ": it stuck to the cam, where every deviation is lost" } else { "" };
            let error = self.lyapunov_standard_error.map_or(String::new(), |error| format!(" ± {error:.4}"));
            writeln!(page, "  Lyapunov exponent {exponent:.4}{error} per revolution{why}")?;
        }
        writeln!(page, "  {:.3} s{}", self.wall_s, per_turn(self.wall_s, self.revolutions))?;
        Ok(page)
    }
}

/// A sweep's summary.
#[derive(Clone, Debug, Serialize)]
pub struct SweepSummary {
    /// `corner-impact/diagram/1`.
    pub schema: &'static str,
    /// The model's name.
    pub model: String,
    /// Rows recorded.
    pub points: u64,
    /// Impacts recorded.
    pub impacts: u64,
    /// Turns of the cam, over all speeds, recorded or not.
    pub revolutions: u64,
    /// Threads used.
    pub threads: usize,
    /// Seconds that the sweep took, with writing what it found.
    pub wall_s: f64,
}

impl SweepSummary {
    /// Of a sweep that came to `tally`.
    pub fn new(model: &str, tally: Tally, threads: usize, wall_s: f64) -> Self {
        let Tally { points, impacts, revolutions } = tally;
        Self { schema: "corner-impact/diagram/1", model: model.into(), points, impacts, revolutions, threads, wall_s }
    }

    /// For people, as wide as where nothing says how wide, without marks.
    pub fn text(&self) -> Result<String, fmt::Error> {
        Ok(self.page(WIDTH)?.plain().to_owned())
    }

    /// For people, in `width` columns.
    pub fn page(&self, width: usize) -> Result<Page, fmt::Error> {
        let mut page = Page::new(width);
        let per_turn = per_turn(self.wall_s, self.revolutions as f64);
        writeln!(
            page,
            "{}: {} revolutions, {} rows, {} impacts",
            self.model, self.revolutions, self.points, self.impacts
        )?;
        let threads = if self.threads == 1 { "1 thread".to_owned() } else { format!("{} threads", self.threads) };
        writeln!(page, "  {:.3} s on {threads}{per_turn}", self.wall_s)?;
        Ok(page)
    }
}

/// The time that a revolution took, where there was one.
fn per_turn(wall_s: f64, revolutions: f64) -> String {
    if revolutions > 0.0 { format!(", {:.0} ns a revolution", wall_s / revolutions * 1e9) } else { String::new() }
}
