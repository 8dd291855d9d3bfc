//! Periodic orbits as a document: for scripts and for people.

use std::fmt::{self, Write};

use serde::Serialize;

use crate::orbit::{Course, Eigenvalue, PeriodicOrbit};
use crate::show::block::Mark;
use crate::show::page::{Page, WIDTH};
use crate::simulate::Event;

/// The orbits of one machine.
#[derive(Clone, Debug, Serialize)]
pub struct OrbitDocument {
    /// `corner-impact/orbit/1`.
    pub schema: &'static str,
    /// The model's name.
    pub model: String,
    /// Speed, rpm.
    pub speed_rpm: f64,
    /// Where `state` is taken, rad.
    pub section_angle_rad: f64,
    /// What was found.
    pub orbits: Vec<OrbitEntry>,
}

/// One orbit.
#[derive(Clone, Debug, Serialize)]
pub struct OrbitEntry {
    /// Turns of the cam in one period.
    pub revolutions: u64,
    /// Those that are flown one by one: of infinitely many before it sticks, the first.
    pub impacts: Vec<ImpactEntry>,
    /// Where it sticks and is released, if it does.
    pub contact: Vec<ContactEntry>,
    /// Position (m) and velocity (m/s) when the cam is at the section.
    pub state: [f64; 2],
    /// The eigenvalues of the matrix that carries a small deviation around it.
    pub multipliers: [Eigenvalue; 2],
    /// Whether small deviations die out.
    pub stable: bool,
    /// `impacts`, `sticking` or `free`.
    pub course: &'static str,
    /// How far it is from closing, over its size.
    pub residual: f64,
}

/// An impact.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ImpactEntry {
    /// Revolution of the period, from 0.
    pub revolution: u64,
    /// rad, in [0, 2 pi).
    pub cam_angle_rad: f64,
    /// m/s.
    pub velocity_before_m_s: f64,
    /// m/s.
    pub velocity_after_m_s: f64,
}

/// The start or end of sticking.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ContactEntry {
    /// `stick` or `release`.
    pub event: &'static str,
    /// Revolution of the period, from 0.
    pub revolution: u64,
    /// rad, in [0, 2 pi).
    pub cam_angle_rad: f64,
}

impl OrbitDocument {
    /// Orbits of a model at a speed, rpm.
    pub fn new(model: &str, speed_rpm: f64, orbits: &[PeriodicOrbit]) -> Self {
        let orbits = orbits.iter().map(OrbitEntry::from).collect();
        Self { schema: "corner-impact/orbit/1", model: model.into(), speed_rpm, section_angle_rad: 0.0, orbits }
    }

    /// For people, as wide as where nothing says how wide, without marks.
    pub fn text(&self) -> Result<String, fmt::Error> {
        Ok(self.page(WIDTH)?.plain().to_owned())
    }

    /// For people, in `width` columns.
    pub fn page(&self, width: usize) -> Result<Page, fmt::Error> {
        /// Impacts that are shown of each orbit.
        const SHOWN: usize = 8;
        let mut page = Page::new(width);
        let title = format!("{} at {} rpm: {} found", self.model, self.speed_rpm, orbits(self.orbits.len()));
        page.marked(Mark::Heading, &title);
        writeln!(page)?;
        for (index, orbit) in self.orbits.iter().enumerate() {
            let (mark, stable) = if orbit.stable { (Mark::Good, "stable") } else { (Mark::Doubtful, "unstable") };
            let turns = if orbit.revolutions == 1 {
                "1 revolution".into()
            } else {
                format!("{} revolutions", orbit.revolutions)
            };
            let what = match orbit.course {
                "sticking" => "sticks to the cam".to_owned(),
                "free" => "stays clear of the cam".to_owned(),
                _ if orbit.impacts.len() == 1 => "1 impact".to_owned(),
                _ => format!("{} impacts", orbit.impacts.len()),
            };
            write!(page, "\n  {}. {turns}, {what}, ", index + 1)?;
            page.marked(mark, stable);
            writeln!(page)?;
            let [one, two] = orbit.multipliers;
            writeln!(page, "     multipliers   {}   {}", multiplier(one), multiplier(two))?;
            let [q, v] = orbit.state;
            writeln!(page, "     at cam angle 0   q = {q:.12} m, v = {v:.9} m/s")?;
            for impact in orbit.impacts.iter().take(SHOWN) {
                let ImpactEntry { revolution, cam_angle_rad, velocity_before_m_s, velocity_after_m_s } = impact;
                writeln!(
                    page,
                    "     impact at {:>11.6} deg of revolution {revolution}   v {velocity_before_m_s:>14.6} -> {velocity_after_m_s:.6} m/s",
                    cam_angle_rad.to_degrees(),
                )?;
            }
            if orbit.impacts.len() > SHOWN {
                writeln!(page, "     and {} more", orbit.impacts.len() - SHOWN)?;
            }
            for ContactEntry { event, revolution, cam_angle_rad } in &orbit.contact {
                writeln!(
                    page,
                    "     {event:<7} at {:>10.6} deg of revolution {revolution}",
                    cam_angle_rad.to_degrees()
                )?;
            }
        }
        Ok(page)
    }
}

fn orbits(count: usize) -> String {
    match count {
        0 => "no periodic orbit".into(),
        1 => "1 periodic orbit".into(),
        _ => format!("{count} periodic orbits"),
    }
}

fn multiplier(Eigenvalue { re, im }: Eigenvalue) -> String {
    if im == 0.0 {
        format!("{re:.10}")
    } else {
        format!("{re:.10} {} {:.10}i", if im < 0.0 { '-' } else { '+' }, im.abs())
    }
}

impl From<&PeriodicOrbit> for OrbitEntry {
    fn from(orbit: &PeriodicOrbit) -> Self {
        let impact = |event: &Event| ImpactEntry {
            revolution: event.revolution,
            cam_angle_rad: event.cam_angle,
            velocity_before_m_s: event.velocity_before,
            velocity_after_m_s: event.velocity_after,
        };
        let contact = |event: &Event| ContactEntry {
            event: event.kind.name(),
            revolution: event.revolution,
            cam_angle_rad: event.cam_angle,
        };
        let others = orbit.events.iter().filter(|event| event.kind != crate::simulate::EventKind::Impact);
        Self {
            revolutions: orbit.revolutions,
            impacts: orbit.impacts().map(impact).collect(),
            contact: others.map(contact).collect(),
            state: [orbit.state.position, orbit.state.velocity],
            multipliers: orbit.multipliers(),
            stable: orbit.is_stable(),
            course: match orbit.course {
                Course::Impacts(_) => "impacts",
                Course::Sticking(_) => "sticking",
                Course::Free => "free",
            },
            residual: orbit.residual,
        }
    }
}
