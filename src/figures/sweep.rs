//! What runs settle on over a range of speeds, and the branches of periodic orbits there.

use crate::diagram::{Following, Placed, Places, Section, Speeds, Start, Sweep, SweepError};
use crate::figures::Subject;
use crate::orbit::branch::{Branch, BranchPoint, find_branches};
use crate::orbit::{Course, Cycle, Search};
use crate::simulate::{Machine, angular_velocity};

/// How fine a sweep is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Speeds, evenly over the range.
    pub speeds: usize,
    /// Revolutions at each before anything is recorded.
    pub transient: u64,
    /// Revolutions that are recorded.
    pub record: u64,
}

impl Effort {
    /// Of a report above detachment: a follower that chatters has forgotten its start once it has come to rest.
    pub const SLOW: Self = Self { speeds: 800, transient: 40, record: 5 };
    /// Of a report around the corner impact.
    pub const FAST: Self = Self { speeds: 480, transient: 300, record: 150 };
}

/// A piece of a branch at the section: one crossing of the orbits along it.
#[derive(Clone, Debug, PartialEq)]
pub struct Crossings {
    /// Whether the orbits are stable.
    pub stable: bool,
    /// Speed, rpm, and position at the section, m.
    pub points: Vec<[f64; 2]>,
}

impl Subject {
    fn sweep(
        &self,
        range: [f64; 2],
        section: Section,
        following: Following,
        effort: Effort,
    ) -> Result<Vec<[f64; 2]>, String> {
        let [low, high] = range;
        let sweep = Sweep {
            machine: self.machine(low),
            speeds: Speeds { low, high, count: effort.speeds },
            start: Start { cam_angle: 0.0, follower: Placed::OnCam(0.0) },
            following,
            transient: effort.transient,
            record: effort.record,
            section,
            lyapunov: false,
        };
        let mut places = Vec::new();
        let kept = sweep.run(None, |_, found: Places| {
            places.extend(found.places);
            Ok::<(), SweepError>(())
        });
        kept.map(|_| places).map_err(|error| error.to_string())
    }

    /// Impacts above detachment: speed, rpm, and cam angle, rad.
    pub fn slow_impacts(&self, range: [f64; 2]) -> Result<Vec<[f64; 2]>, String> {
        self.sweep(range, Section::Impacts, Following::Nothing, self.slow_effort)
    }

    /// What runs with rising and with falling speed settle on around the corner impact: speed, rpm, and cam angle, rad, of
    /// impacts, or position at the section of its map, m.
    pub fn fast_runs(&self, range: [f64; 2], at_section: bool) -> Result<Vec<[f64; 2]>, String> {
        let section = if at_section { Section::Strobe(self.found()?.at.section_angle()) } else { Section::Impacts };
        let run = |following| self.sweep(range, section, following, self.fast_effort);
        let (rising, falling) = rayon::join(|| run(Following::Up), || run(Following::Down));
        let mut both = rising?;
        both.extend(falling?);
        Ok(both)
    }

    /// The branches of orbits of one impact in one revolution, and of two in two, over the fast speeds that are shown.
    pub fn branches(&self) -> Result<&[Branch], String> {
        let found = self.followed.get_or_init(|| self.follow(self.shown.fast.clone()?.range));
        found.as_deref().map_err(Clone::clone)
    }

    fn follow(&self, range: [f64; 2]) -> Result<Vec<Branch>, String> {
        let wanted = [Search { revolutions: 1, impacts: Some(1) }, Search { revolutions: 2, impacts: Some(2) }];
        let mut branches = Vec::new();
        for wanted in wanted {
            branches.extend(find_branches(&self.model, range, &wanted).map_err(|error| error.to_string())?.branches);
        }
        Ok(branches)
    }

    /// Where the orbits of branches cross the section of the corner impact's map.
    pub fn crossings(&self, branches: &[Branch]) -> Result<Vec<Crossings>, String> {
        let at = &self.found()?.at;
        let (angle, machine) = (at.section_angle(), self.machine(at.speed_rpm()));
        let mut all = Vec::new();
        for branch in branches {
            let most = branch.points.iter().map(|point| point.orbit.revolutions).max().unwrap_or(1);
            for turn in 0..most {
                let mut open: Option<Crossings> = None;
                for pair in branch.points.windows(2) {
                    let [one, other] = pair else { continue };
                    let ends = crossing(&machine, one, angle, turn).zip(crossing(&machine, other, angle, turn));
                    // A piece takes the stability of its end that is no special point.
                    let stable = if one.special.is_some() { other } else { one }.orbit.is_stable();
                    let Some((from, to)) = ends else {
                        all.extend(open.take());
                        continue;
                    };
                    match &mut open {
                        Some(line) if line.stable == stable => line.points.push(to),
                        _ => all.extend(open.replace(Crossings { stable, points: vec![from, to] })),
                    }
                }
                all.extend(open);
            }
        }
        Ok(all)
    }
}

/// Speed, rpm, and position, m, at the section in one revolution of an orbit that never sticks.
fn crossing(machine: &Machine, point: &BranchPoint, cam_angle: f64, turn: u64) -> Option<[f64; 2]> {
    let Course::Impacts(cycle) = &point.orbit.course else { return None };
    let later: Cycle = if turn == 0 { cycle.clone() } else { cycle.begun_later(turn) };
    let machine = machine.at_speed(angular_velocity(point.rpm));
    (turn < cycle.revolutions).then(|| [point.rpm, later.at_section(&machine, cam_angle).0.position])
}
