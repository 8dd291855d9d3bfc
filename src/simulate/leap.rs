//! Flights over many short segments at once, as on a cam given by a table.
//!
//! A search for a contact on each of 360 segments costs more than all the flights of a revolution. If a lower bound of the flight stays
//! above chords of the lift, segment after segment, one flight passes over all of them.

use super::ahead::Leap;
use super::{Machine, Motion};
use crate::cam::Segment;

/// Bound on the lift over one or several segments, used by flights that clear them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chord {
    /// End of the chord, rad.
    end: f64,
    /// Lift at the end, m, and slope of the straight line from the beginning of the chord, m/rad.
    lift: f64,
    slope: f64,
    /// Largest height of the lift above that line, m.
    rise: f64,
    /// Square of the chord's width over eight, rad^2.
    square: f64,
}

/// Chords of a cam with many segments: from the start of each segment over 1, 4, 16 and 64 segments.
#[derive(Clone, Debug, Default)]
pub(super) struct Chords {
    from: Vec<[Chord; SIZES.len()]>,
}

/// Numbers of segments that chords span.
const SIZES: [usize; 4] = [1, 4, 16, 64];

/// Consecutive segments that will get a chord.
#[derive(Clone, Copy)]
struct SegmentSpan {
    start: f64,
    end: f64,
    /// Lift at either end, m.
    lift: [f64; 2],
    /// Lower bound of `c''`, m/rad^2. Minus infinity if the slope falls from one segment to the next, or the lift steps: only a rising
    /// slope keeps the lift below its chord.
    curvature: f64,
}

impl Chords {
    /// Builds the chords; none for few segments. `kinks` gives for each segment whether the slope falls or the lift steps at its start.
    pub fn of_many(segments: &[Segment], kinks: &[bool]) -> Self {
        /// Number of segments below which most flights pass only a handful.
        const MANY: usize = 64;
        if segments.len() < MANY {
            return Self::default();
        }
        let of_one = |segment: &Segment| SegmentSpan {
            start: segment.start,
            end: segment.end,
            lift: [segment.start, segment.end].map(|angle| segment.law.lift(angle).value),
            curvature: segment.bounds.curvature[0],
        };
        let mut stretches: Vec<SegmentSpan> = segments.iter().map(of_one).collect();
        let mut from = vec![[Chord::NONE; SIZES.len()]; segments.len()];
        let mut size = 1;
        for (level, longer) in SIZES.into_iter().enumerate() {
            // Joins consecutive spans of the level before; the last ones have no successors.
            let joined = stretches.iter().enumerate().map_while(|(first, stretch)| {
                let mut others = (first..first + longer).step_by(size).skip(1);
                others.try_fold(*stretch, |all, next| Some(all.and(stretches.get(next)?, kinks[next])))
            });
            stretches = joined.collect();
            size = longer;
            for (chords, stretch) in from.iter_mut().zip(&stretches) {
                chords[level] = stretch.chord();
            }
        }
        Self { from }
    }
}

impl Chord {
    /// Chord that is never cleared.
    const NONE: Self = Self { end: f64::INFINITY, lift: 0.0, slope: 0.0, rise: f64::INFINITY, square: 0.0 };
}

impl SegmentSpan {
    fn and(self, next: &Self, kink: bool) -> Self {
        let curvature = if kink { f64::NEG_INFINITY } else { self.curvature.min(next.curvature) };
        Self { end: next.end, lift: [self.lift[0], next.lift[1]], curvature, ..self }
    }

    fn chord(&self) -> Chord {
        let width = self.end - self.start;
        let square = width * width / 8.0;
        // c <= chord + (-min c'') h^2/8
        let rise = square * (-self.curvature).max(0.0);
        let [from, lift] = self.lift;
        Chord { end: self.end, lift, slope: (lift - from) / width, rise, square }
    }
}

impl Machine {
    /// Returns the segments that a flight off the cam certainly clears, from its present position to the end of a segment.
    #[inline]
    pub(super) fn leap(&self, motion: &Motion) -> Option<Leap> {
        let chords = &self.terrain.chords.from;
        if chords.is_empty() || motion.gap == Some(0.0) {
            return None;
        }
        // A leap gains nothing where a contact is expected.
        let end = self.cam().segments()[motion.segment].end;
        if motion.expected.is_some_and(|angle| motion.cam_angle <= angle && angle < end) {
            return None;
        }
        let (state, omega) = (motion.state, self.angular_velocity);
        // By the cam's angle: q >= q0 + q' x + q'' x^2/2 + q''' x^3/6 - |q''''| x^4/24
        let by_angle = 1.0 / omega;
        let square = by_angle * by_angle;
        let first = state.velocity * by_angle;
        let half = 0.5 * self.flight.acceleration(state) * square;
        let sixth = self.flight.jerk(state) * (by_angle * square / 6.0);
        let last = self.flight.fourth_bound(state) * (square * square / 24.0);
        let rounding = self.gap_rounding(state.position);
        let (mut segment, mut before, mut turned) = (motion.segment, state.position, 0.0);
        /// Index of the chord size that most leaps begin with.
        const FIRST: usize = 2;
        // Longer chords while they are cleared, then shorter ones.
        let (mut level, mut rises) = (FIRST, true);
        let mut lands = false;
        while let Some(chord) = chords.get(segment).map(|from| &from[level]) {
            let turn = chord.end - motion.cam_angle;
            let after = state.position + turn * (first + turn * (half + turn * (sixth - turn * last)));
            let gaps = [before - chord.lift + chord.slope * (turn - turned), after - chord.lift];
            // The bound bends upwards by at most q'' + q''' x, so that it is below its chord by at most h^2/8 times that.
            let bent = (2.0 * half + 6.0 * sixth.max(0.0) * turn).max(0.0);
            let least = rounding + chord.rise + bent * chord.square;
            if gaps[0] > least && gaps[1] > least {
                segment += SIZES[level];
                (before, turned) = (after, turn);
                level += usize::from(rises && level + 1 < SIZES.len());
            } else if level > 0 {
                (level, rises) = (level - 1, false);
            } else {
                // The flight exceeds its bound at most by |q''''| x^4/24 with either sign.
                lands = gaps[1] + 2.0 * last * turn.powi(4) < 0.0;
                break;
            }
        }
        (segment > motion.segment).then(|| Leap { segment: segment - 1, time: turned / omega, lands })
    }
}
