//! Next event of a flight, found before the run reaches it.

use crate::cam::Lift;
use crate::flight::State;

/// Next event of a flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Ahead {
    /// Repetition of the previous impact, one turn later.
    Again(Again),
    /// Return of the flight to the top of the cam.
    Top {
        /// Time until the return, s.
        time: f64,
        /// State of the follower at the return.
        state: State,
    },
    /// Flight that certainly clears some segments.
    Leap(Leap),
    /// Flight over the rest of its segment.
    Over {
        /// Time over the rest of the segment, s.
        end: f64,
        passage: Passage,
    },
    /// Flight that never returns to the top.
    Never,
}

/// Impact one turn later.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Again {
    pub time: f64,
    pub cam_angle: f64,
    pub velocity: f64,
    pub lift: Lift,
}

/// End of a leap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Leap {
    /// Last segment that the flight clears.
    pub segment: usize,
    /// Time of the flight to that segment's end, s.
    pub time: f64,
    /// Whether the flight meets the cam on the next segment.
    pub lands: bool,
}

/// Outcome of a flight over a window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Passage {
    /// No contact up to the end.
    Free { state: State, gap: Option<f64> },
    /// First contact, s after the start, with the velocity at that moment.
    Contact { time: f64, velocity: f64, lift: Lift },
    /// Search with more steps than allowed; s after the start.
    NoProgress { time: f64 },
    /// NaN or infinite number.
    NotFinite,
}
