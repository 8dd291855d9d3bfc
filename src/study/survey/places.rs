//! Where a sweep's points lie: impacts on the cam, or the follower at the section, without all that a row holds.

use super::pipeline::Block;
use super::sweep::{Row, Seen};
use crate::simulate::EventKind;

/// Points of a diagram, as a worker makes them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Places {
    /// The value, and the cam angle of an impact, rad, or the position at the section, m.
    pub places: Vec<[f64; 2]>,
    /// The value, and the Lyapunov exponent per revolution, if asked for.
    pub exponent: Option<[f64; 2]>,
}

/// Points after which a block is sent on.
const FULL: usize = 1024;

impl Block for Places {
    fn push(&mut self, row: &Row) {
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
