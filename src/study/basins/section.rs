//! The starts on a section of a model, the orbits that cross it, and the curves that separate the basins.

use serde::Serialize;

use super::{Basins, Curve, Extent, Grid, Reversed, Saddle};
use crate::flight::State;
use crate::model::{Follower, Model};
use crate::orbit::long_run::LongRun;
use crate::orbit::{Course, PeriodicOrbit, Search, search};
use crate::section::StroboscopicMap;
use crate::study::{StudyError, machine};

/// The basins of a grid of starts: the document of `basins --json`.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    schema: &'static str,
    /// The model's name.
    pub model: String,
    /// Speed, rpm.
    pub rpm: f64,
    /// The starts, and the motions that they end on.
    #[serde(flatten)]
    pub basins: Basins,
    /// Seconds that the runs took.
    pub wall_s: f64,
}

impl Summary {
    /// Builds the summary of `basins` for a model at a speed, rpm.
    pub fn new(model: &Model, rpm: f64, basins: Basins, wall_s: f64) -> Self {
        Self { schema: "corner-impact/basins/1", model: model.name.clone(), rpm, basins, wall_s }
    }
}

/// The section of a model at one cam angle, with its orbits of one impact a revolution.
#[derive(Clone, Debug)]
pub struct BasinSection {
    follower: Follower,
    /// The map of the section.
    pub map: StroboscopicMap,
    orbits: Vec<PeriodicOrbit>,
}

/// Orbits and curves that a picture of a section shows beside the basins.
#[derive(Clone, Debug, PartialEq)]
pub struct BasinBoundary {
    /// States where the stable orbits that starts end on cross the section.
    pub stable: Vec<State>,
    /// States where the saddles cross the section.
    pub saddles: Vec<State>,
    /// Stable manifolds of the saddles, which separate the basins.
    pub curves: Vec<Curve>,
}

impl BasinSection {
    /// Builds the section at `cam_angle`, rad, in `[0, 2 pi)`.
    pub fn new(model: &Model, rpm: f64, cam_angle: f64) -> Result<Self, StudyError> {
        let machine = machine(model, rpm)?;
        let orbits = search(&machine, &Search { revolutions: 1, impacts: Some(1) })?;
        Ok(Self { follower: model.follower, map: StroboscopicMap { machine, cam_angle }, orbits })
    }

    /// State where an orbit with impacts crosses the section.
    fn crossing(&self, orbit: &PeriodicOrbit) -> Option<State> {
        match &orbit.course {
            Course::Impacts(cycle) => Some(cycle.at_section(&self.map.machine, self.map.cam_angle).0),
            Course::Sticking(_) | Course::Free => None,
        }
    }

    /// Builds a grid of starts. Without a given range, the positions go from the cam to twice the distance of its top or of the farthest
    /// orbit. The velocities then cover three times the range of the velocities of the orbits and the cam. A range narrower than the speed
    /// of the cam's whole height in a radian is replaced by that speed in both directions, since cam and orbits may hardly move at the
    /// section.
    pub fn grid(
        &self,
        cells: [usize; 2],
        positions: Option<[f64; 2]>,
        velocities: Option<[f64; 2]>,
    ) -> Result<Grid, StudyError> {
        let StroboscopicMap { machine, cam_angle } = &self.map;
        let lift = machine.cam().lift(*cam_angle);
        let cam_velocity = machine.angular_velocity() * lift.slope;
        let (mut highest, mut range) = (machine.cam().top(), [cam_velocity.min(0.0), cam_velocity.max(0.0)]);
        for State { position, velocity } in self.orbits.iter().filter_map(|orbit| self.crossing(orbit)) {
            highest = highest.max(position);
            range = [range[0].min(velocity), range[1].max(velocity)];
        }
        let fast = machine.angular_velocity() * (machine.cam().top() - machine.cam().lowest().value);
        if range[1] - range[0] < fast {
            range = [-fast, fast];
        }
        let span = range[1] - range[0];
        let positions = positions.unwrap_or([lift.value, lift.value + 2.0 * (highest - lift.value)]);
        let velocities = velocities.unwrap_or([range[0] - span, range[1] + span]);
        let is_range = |[low, high]: [f64; 2]| low < high && (high - low).is_finite();
        let grid = Grid { cam_angle: *cam_angle, positions, velocities, cells };
        if is_range(positions) && is_range(velocities) { Ok(grid) } else { Err(StudyError::NoStarts) }
    }

    /// Returns the orbits and curves that separate the basins, to the resolution of a picture of the grid.
    pub fn border(&self, grid: &Grid, basins: &Basins) -> BasinBoundary {
        let cycles = self.orbits.iter().filter_map(|orbit| match &orbit.course {
            Course::Impacts(cycle) => Some(cycle),
            _ => None,
        });
        let saddles: Vec<Saddle> =
            cycles.filter_map(|cycle| Saddle::new(&self.map.machine, cycle, self.map.cam_angle)).collect();
        let [low, high] = grid.positions;
        let (extent, reversed) = (Extent::of(high - low), Reversed::new(&self.follower, &self.map));
        let halves = saddles.iter().flat_map(|saddle| [(saddle, 1.0), (saddle, -1.0)]);
        let curve = |(saddle, sign)| reversed.as_ref().map(|reversed| Curve::stable(reversed, saddle, sign, &extent));
        let stable = basins.parts.iter().filter_map(|part| match &part.ending {
            LongRun::Orbit(orbit) => self.crossing(orbit),
            _ => None,
        });
        BasinBoundary {
            stable: stable.collect(),
            curves: halves.filter_map(curve).collect(),
            saddles: saddles.iter().map(|saddle| saddle.state).collect(),
        }
    }
}
