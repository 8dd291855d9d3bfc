//! The next event of a flight, known before the run reaches it.

use crate::cam::Lift;
use crate::flight::State;

/// The next event of a flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Ahead {
    /// The previous impact repeats, one turn on.
    Again(Again),
    /// The flight comes down to the top of the cam.
    Top {
        /// Time until then, s.
        time: f64,
        /// State of the follower then.
        state: State,
    },
    /// The flight clears some segments.
    Leap(Leap),
    /// The flight goes over the rest of its segment.
    Over {
        /// Time that this takes, s.
        end: f64,
        passage: Passage,
    },
    /// The flight never comes down to the top.
    Never,
}

/// An impact one turn on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Again {
    pub time: f64,
    pub cam_angle: f64,
    pub velocity: f64,
    pub lift: Lift,
}

/// The end of a leap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Leap {
    /// Last segment that the flight goes over.
    pub segment: usize,
    /// Time when it reaches that segment's end, s.
    pub time: f64,
    /// Whether it meets the cam on the next segment.
    pub lands: bool,
}

/// Outcome of a flight over a window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Passage {
    /// No contact up to the end.
    Free { state: State, gap: Option<f64> },
    /// The first contact, s after the start, with the velocity at that moment.
    Contact { time: f64, velocity: f64, lift: Lift },
    /// More steps than a window may take; s after the start.
    NoProgress { time: f64 },
    /// A number is NaN or infinite.
    NotFinite,
}
