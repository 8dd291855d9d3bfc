//! A flight over many short segments at once, as a cam given by a table has them.
//!
//! Looking for a contact on each of 360 segments costs more than all the flights of a revolution. Where a lower bound of the
//! flight stays above chords of the lift, segment after segment, one flight goes over all of them.

use super::{Machine, Motion};
use crate::cam::Segment;

/// A stretch of cam, of one segment or of several, as far as a flight that clears it has to know it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chord {
    /// Where it ends, rad.
    end: f64,
    /// The lift at either end, m.
    lift: [f64; 2],
    /// The lift is at most so far above the straight line between its ends, m.
    rise: f64,
    /// An eighth of the square of its width, rad^2.
    square: f64,
}

/// The chords of a cam of so many segments that going over them one by one is slow: of each, and of ever larger groups of them.
#[derive(Clone, Debug, Default)]
pub(super) struct Chords {
    levels: Vec<Vec<Chord>>,
}

/// Groups of one level that make one of the next.
const GROUP: usize = 4;

impl Chords {
    /// None where there are few segments; `kinks` is whether the lift's slope falls, or the lift steps, where each begins: a
    /// slope that rises keeps the lift below its chord.
    pub fn of_many(segments: &[Segment], kinks: &[bool]) -> Self {
        /// Of fewer, most flights pass a handful.
        const MANY: usize = 64;
        if segments.len() < MANY {
            return Self::default();
        }
        let chord =
            |(segments, kinks): (&[Segment], &[bool])| Chord::of(segments, kinks.iter().skip(1).any(|kink| *kink));
        let of = |size: usize| segments.chunks_exact(size).zip(kinks.chunks_exact(size)).filter_map(chord).collect();
        /// Of one segment, of 4, of 16 and of 64.
        const LEVELS: u32 = 4;
        Self { levels: (0..LEVELS).map(|level| of(GROUP.pow(level))).collect() }
    }
}

impl Chord {
    fn of(segments: &[Segment], kinks: bool) -> Option<Self> {
        let (first, last) = (segments.first()?, segments.last()?);
        let square = (last.end - first.start).powi(2) / 8.0;
        // c <= chord + (-min c'') h^2/8
        let least = segments.iter().map(|segment| segment.bounds.curvature[0]).fold(0.0, f64::min);
        let rise = if kinks { f64::INFINITY } else { square * -least };
        let lift = [first.law.lift(first.start).value, last.law.lift(last.end).value];
        Some(Self { end: last.end, lift, rise, square })
    }
}

/// The end of a leap.
pub(super) struct Leap {
    /// The last segment that the flight goes over.
    pub segment: usize,
    /// When it comes to that segment's end, s.
    pub time: f64,
}

impl Machine {
    /// Two or more segments that a flight from the start of one certainly clears, up to `left` rad from there.
    #[inline]
    pub(super) fn leap(&self, motion: &Motion, left: f64) -> Option<Leap> {
        let levels = &self.terrain.chords.levels;
        let begins = self.cam().segments()[motion.segment].start == motion.cam_angle;
        if levels.is_empty() || !begins || motion.gap == Some(0.0) {
            return None;
        }
        let (state, omega) = (motion.state, self.angular_velocity);
        let (acceleration, jerk) = (self.flight.acceleration(state), self.flight.jerk_bound(state));
        // By the cam's angle: q >= q0 + q' x + q'' x^2/2 - J x^3/6
        let by_angle = 1.0 / omega;
        let (first, half, sixth) =
            (state.velocity * by_angle, 0.5 * acceleration * by_angle * by_angle, jerk * by_angle.powi(3) / 6.0);
        // The bound is bent upwards by q'' at most, so that it is no further below its chords than q'' h^2/8.
        let hollow = (2.0 * half).max(0.0);
        let rounding = self.gap_rounding(state.position);
        let (mut segment, mut before, mut turned) = (motion.segment, state.position, 0.0);
        let mut clear = |chord: &Chord| {
            let turn = chord.end - motion.cam_angle;
            let after = state.position + turn * (first + turn * (half - turn * sixth));
            let open = (before - chord.lift[0]).min(after - chord.lift[1]);
            let clears = turn < left && open > rounding + chord.rise + hollow * chord.square;
            if clears {
                (before, turned) = (after, turn);
            }
            clears
        };
        // The largest group that begins here; where that is not cleared, a smaller one, and after it no larger one before its end.
        let (mut level, mut size) = (0, 1);
        'over: loop {
            while level + 1 < levels.len() && segment % (GROUP * size) == 0 {
                (level, size) = (level + 1, GROUP * size);
            }
            while !levels[level].get(segment / size).is_some_and(&mut clear) {
                if level == 0 {
                    break 'over;
                }
                (level, size) = (level - 1, size / GROUP);
            }
            segment += size;
        }
        (segment > motion.segment + 1).then(|| Leap { segment: segment - 1, time: turned / omega })
    }
}
