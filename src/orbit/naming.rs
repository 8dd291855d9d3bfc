//! Names of one motion: a cycle may begin with any revolution, and an angle near a seam of the cam belongs to either segment. This module
//! decides which cycles are the same motion, and which name is kept.

use std::f64::consts::TAU;

use super::cycle::{Cycle, Impact};
use crate::simulate::Machine;
use crate::tolerance;

impl Cycle {
    /// Renames impacts by their own revolution and segment: an angle past the end of a revolution, or of a segment that meets the next
    /// smoothly, belongs to the next.
    ///
    /// An angle past a corner keeps its segment.
    pub fn renamed(&self, machine: &Machine, is_corner: impl Fn(usize) -> bool) -> Self {
        let segments = machine.cam().segments();
        let mut renamed = self.clone();
        for impact in &mut renamed.impacts {
            // After one move for each segment, the impact is back where it was.
            for _ in 0..segments.len() {
                let segment = &segments[impact.segment];
                if impact.cam_angle < segment.start && !is_corner(impact.segment) {
                    if impact.segment == 0 {
                        impact.segment = segments.len() - 1;
                        impact.cam_angle += TAU;
                        impact.revolution -= 1;
                    } else {
                        impact.segment -= 1;
                    }
                } else if impact.cam_angle >= segment.end && !is_corner((impact.segment + 1) % segments.len()) {
                    if impact.segment + 1 == segments.len() {
                        impact.segment = 0;
                        impact.cam_angle -= TAU;
                        impact.revolution += 1;
                    } else {
                        impact.segment += 1;
                    }
                } else {
                    break;
                }
            }
        }
        renamed
    }

    /// Counts revolutions from 0, and sorts the impacts.
    pub fn in_order(mut self) -> Self {
        let revolutions = self.revolutions.max(1) as i64;
        for impact in &mut self.impacts {
            impact.revolution = impact.revolution.rem_euclid(revolutions);
        }
        self.impacts.sort_by(|one, other| {
            one.revolution.cmp(&other.revolution).then(one.cam_angle.total_cmp(&other.cam_angle))
        });
        self
    }

    /// Index of an impact once the impacts are [in order](Self::in_order).
    pub fn place_in_order(&self, impact: usize) -> usize {
        let key = |impact: &Impact| (impact.revolution.rem_euclid(self.revolutions.max(1) as i64), impact.cam_angle);
        let (revolution, angle) = key(&self.impacts[impact]);
        let earlier = |other: &&Impact| {
            let (turn, place) = key(other);
            (turn, place) < (revolution, angle)
        };
        self.impacts.iter().filter(earlier).count()
    }

    /// Moves the cycle's start by `revolutions`.
    pub fn begun_later(&self, revolutions: u64) -> Self {
        let mut later = self.clone();
        for impact in &mut later.impacts {
            impact.revolution -= revolutions as i64;
        }
        later.in_order()
    }

    /// The angle of an impact, rad, counted on through revolutions and, past the last impact, through periods.
    fn angle(&self, index: usize) -> f64 {
        let (period, index) = (index / self.impacts.len(), index % self.impacts.len());
        self.impacts[index].turned() + TAU * period as f64 * self.revolutions as f64
    }

    /// Whether each impact is `turned` rad before the impact of another cycle whose index is larger by `impacts`.
    fn is_before(&self, other: &Self, impacts: usize, turned: f64) -> bool {
        let off = |index: usize| other.angle(index + impacts) - self.angle(index) - turned;
        (0..self.impacts.len()).all(|index| off(index).abs() <= tolerance::SAME_ORBIT.value)
    }

    /// Whether two cycles are the same motion, whichever impact and revolution they begin with.
    pub fn is_same(&self, other: &Self) -> bool {
        let turned = |impacts: usize| TAU * ((other.angle(impacts) - self.angle(0)) / TAU).round();
        self.revolutions == other.revolutions
            && self.impacts.len() == other.impacts.len()
            && (0..self.impacts.len()).any(|impacts| self.is_before(other, impacts, turned(impacts)))
    }

    /// Whether the motion repeats sooner than after `revolutions`.
    pub fn repeats_sooner(&self) -> bool {
        let divides = |sooner: &u64| self.revolutions.is_multiple_of(*sooner);
        (1..self.revolutions).filter(divides).any(|sooner| self.repeats_after(sooner))
    }

    fn repeats_after(&self, revolutions: u64) -> bool {
        let impacts = self.impacts.len() * revolutions as usize / self.revolutions as usize;
        self.is_before(self, impacts, TAU * revolutions as f64)
    }

    /// Index of the impact half a period after `impact`, if it is on the same segment.
    pub fn second_half(&self, impact: usize) -> Option<usize> {
        let half = self.impacts.len() / 2;
        let even = self.revolutions.is_multiple_of(2) && self.impacts.len().is_multiple_of(2);
        let (one, two) = (self.impacts.get(impact)?, self.impacts.get(impact + half)?);
        let later = two.revolution - one.revolution == self.revolutions as i64 / 2;
        (even && later && one.segment == two.segment).then_some(impact + half)
    }

    /// Repeats the motion over twice as many revolutions.
    pub fn twice(&self) -> Self {
        let later = |impact: &Impact| Impact { revolution: impact.revolution + self.revolutions as i64, ..*impact };
        let impacts = self.impacts.iter().copied().chain(self.impacts.iter().map(later));
        Self { revolutions: 2 * self.revolutions, impacts: impacts.collect() }
    }

    /// Shortens the cycle to the fewest revolutions after which the motion repeats.
    pub fn shortest(self) -> Self {
        let cycle = self.in_order();
        let sooner = |revolutions: &u64| cycle.repeats_after(*revolutions);
        match (1..cycle.revolutions).filter(|sooner| cycle.revolutions.is_multiple_of(*sooner)).find(sooner) {
            None => cycle,
            Some(revolutions) => {
                let impacts = cycle.impacts.iter().filter(|impact| impact.revolution < revolutions as i64);
                Self { revolutions, impacts: impacts.copied().collect() }
            }
        }
    }
}
