//! Where a sweep's points lie: impacts on the cam, or the follower at the section, without all that a row holds.

use super::{Block, Row, Seen};
use crate::simulate::EventKind;

/// Points of a diagram, as a worker makes them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Places {
    /// Speed, rpm, and the cam angle of an impact, rad, or the position at the section, m.
    pub places: Vec<[f64; 2]>,
    /// Speed, rpm, and Lyapunov exponent per revolution, if asked for.
    pub exponent: Option<[f64; 2]>,
}

/// Points after which a block is sent on.
const FULL: usize = 1024;

impl Block for Places {
    fn push(&mut self, row: &Row) {
        self.exponent = row.growth.map(|growth| [row.rpm, growth.value]);
        match row.seen {
            Seen::Event(event) if event.kind == EventKind::Impact => self.places.push([row.rpm, event.cam_angle]),
            Seen::Event(_) => {}
            Seen::Section(state) => self.places.push([row.rpm, state.position]),
        }
    }

    fn is_full(&self) -> bool {
        self.places.len() >= FULL
    }
}
