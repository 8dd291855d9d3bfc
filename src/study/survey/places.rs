//! Positions of a sweep's points: impacts on the cam, or the follower at the section, without the rest of each row.

use super::pipeline::RecordBlock;
use super::sweep::{RecordRow, Seen};
use crate::simulate::EventKind;

/// Points of a diagram, as produced by a worker.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Places {
    /// The value with the cam angle of an impact, rad, or with the position at the section, m.
    pub places: Vec<[f64; 2]>,
    /// The value with the Lyapunov exponent per revolution, if asked for.
    pub exponent: Option<[f64; 2]>,
}

/// Number of points after which a block is sent.
const FULL: usize = 1024;

impl RecordBlock for Places {
    fn push(&mut self, row: &RecordRow) {
        self.exponent = row.growth.map(|growth| [row.value, growth.value]);
        match row.seen {
            Seen::Event(event) if event.kind == EventKind::Impact => self.places.push([row.value, event.cam_angle]),
            Seen::Event(_) => {}
            Seen::Section(state) => self.places.push([row.value, state.position]),
        }
    }

    fn is_full(&self) -> bool {
        self.places.len() >= FULL
    }
}
