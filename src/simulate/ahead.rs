//! The next event of a flight, known before the run comes to it.

use crate::cam::Lift;
use crate::flight::State;

/// What a flight comes to next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Ahead {
    /// The impact before once more, one turn on.
    Again(Again),
    /// It comes down to the top of the cam.
    Top {
        /// After so long, s.
        time: f64,
        /// There.
        state: State,
    },
    /// It clears some segments.
    Leap(Leap),
    /// It goes over the rest of its segment.
    Over {
        /// Which takes so long, s.
        end: f64,
        passage: Passage,
    },
    /// It never comes down to the top.
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
    /// The last segment that the flight goes over.
    pub segment: usize,
    /// When it comes to that segment's end, s.
    pub time: f64,
    /// Whether it meets the cam on the next one.
    pub lands: bool,
}

/// What became of a flight over a window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Passage {
    /// No contact up to the end.
    Free {
        state: State,
        gap: Option<f64>,
    },
    /// The first contact, s after the start, with the velocity that it is met with.
    Contact {
        time: f64,
        velocity: f64,
        lift: Lift,
    },
    Below {
        depth: f64,
        time: f64,
    },
    /// More steps than a window may take; s after the start.
    NoProgress {
        time: f64,
    },
    /// Something is not a number.
    NotFinite,
}
