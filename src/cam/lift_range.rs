//! Enclosure of the lift over a range of angles that may cross segments and turns.

use std::f64::consts::TAU;

use super::{Cam, Lift};
use crate::interval::Interval;

impl Cam {
    /// Enclosure of lift, slope and curvature over a range of angles, rad, in any turn. All are unbounded if the range has a full turn or
    /// more. The curvature is unbounded if the range passes a corner at which the velocity jumps.
    ///
    /// `sharp` lists the segments that begin at such a corner. At any other corner the slopes of both sides count as equal: the model means
    /// a continuous slope, and only rounding makes them differ.
    pub fn lift_over(&self, angles: Interval, sharp: &[usize]) -> Lift<Interval> {
        let everything = Interval::EVERYTHING;
        let mut over = Lift { value: everything, slope: everything, curvature: everything, third: everything };
        if !(angles.width() < TAU) {
            return over;
        }
        let turns = (angles.low() / TAU).floor();
        let mut before = Interval::TURN * turns;
        // Rounding of the turn may put the lowest angle at the end of the turn before.
        if (angles - before).low() <= 0.0 {
            before = Interval::TURN * (turns - 1.0);
        }
        let mut segment = self.segment_at((angles - before).low());
        let mut is_first = true;
        loop {
            let here = &self.segments()[segment];
            let end = before + if segment + 1 == self.segments().len() { Interval::TURN } else { here.end.into() };
            if let Some(part) = angles.common(Interval::new((before + here.start).low(), end.high())) {
                let lift = here.law.lift_over(part - before);
                over = match is_first {
                    true => lift,
                    false => Lift {
                        value: over.value.hull(lift.value),
                        slope: over.slope.hull(lift.slope),
                        curvature: if sharp.contains(&segment) {
                            everything
                        } else {
                            over.curvature.hull(lift.curvature)
                        },
                        third: everything,
                    },
                };
                is_first = false;
            }
            if !(end.low() <= angles.high()) {
                return over;
            }
            segment += 1;
            if segment == self.segments().len() {
                (segment, before) = (0, before + Interval::TURN);
            }
        }
    }
}
