//! Doubts about what the rows of a table mean: sentences for those who read them.

use super::rows::TableRow;
use super::table::TableProfile;
use crate::tolerance;

impl TableProfile {
    /// Doubts about what the rows mean, a sentence each.
    pub fn doubts(&self) -> Vec<String> {
        /// Part of the rise that a lift may be below 0 by the errors of a gauge.
        const BELOW: f64 = 0.01;
        let (reading, mut doubts) = (&self.reading, Vec::new());
        if reading.layout.as_ref().is_some_and(|layout| layout.is_of_crank) && reading.turn_deg.is_none() {
            let words = "cam.turn_deg: the header of the table names a crank's angle, and 360 deg are read as one turn of the cam; if the cam \
                         turns once in two turns of the crank, say turn_deg = 720 in [cam]";
            doubts.push(words.to_owned());
        }
        let lowest = self.rows.iter().map(|row| row.lift).fold(f64::INFINITY, f64::min);
        if lowest < -BELOW * self.rise() {
            doubts.push(format!(
                "{}: the lowest lift is {} {}; lifts below 0 are read as they are written: does the gauge count the other way round, or from the \
                 nose?",
                self.place(),
                reading.in_model.told(lowest),
                reading.unit
            ));
        }
        doubts.extend([self.coarse(), self.slipped(), self.missing()].into_iter().flatten());
        doubts
    }

    /// Rows with the gap to the next one, degrees.
    fn gaps(&self) -> Vec<f64> {
        let next =
            |index: usize| self.rows.get(index + 1).map_or(self.rows[0].angle_deg + 360.0, |next| next.angle_deg);
        self.rows.iter().enumerate().map(|(index, row)| next(index) - row.angle_deg).collect()
    }

    /// Place of a row for a sentence.
    fn row_place(&self, row: &TableRow) -> String {
        self.file.as_ref().map_or_else(|| "cam.rows".to_owned(), |file| format!("{file}, line {}", row.line))
    }

    /// Rows too far apart for an acceleration.
    fn coarse(&self) -> Option<String> {
        /// Gap between rows from which on they leave an acceleration open, degrees.
        const COARSE: f64 = 15.0;
        let mut gaps = self.gaps();
        let middle = gaps.len() / 2;
        let (_, median, _) = gaps.select_nth_unstable_by(middle, f64::total_cmp);
        (*median >= COARSE).then(|| {
            format!(
                "{}: the rows are {} deg apart, too far to know an acceleration, on which separation and impacts depend; give rows 5 deg apart \
                 or closer",
                self.place(),
                (*median * 1000.0).round() / 1000.0
            )
        })
    }

    /// A step of the lift between two level stretches, as a gauge leaves that slips.
    fn slipped(&self) -> Option<String> {
        /// Rows on either side that must be level.
        const LEVEL: usize = 5;
        /// Range of the lifts on a level side, over the step.
        const RANGE: f64 = 0.2;
        /// Largest step over the rise: a larger one is a motion.
        const LARGEST: f64 = 0.2;
        let count = self.rows.len();
        if count < 4 * LEVEL {
            return None;
        }
        // Rounding leaves a step between two level stretches, too, where the lift creeps.
        let least = (6.0 * self.reading.half_step()).max(tolerance::ON_BASE.value * self.rise());
        let lift = |index: usize| self.rows[index % count].lift;
        let range = |from: usize| {
            let lifts = (from..from + LEVEL).map(lift);
            lifts.clone().fold(f64::NEG_INFINITY, f64::max) - lifts.fold(f64::INFINITY, f64::min)
        };
        let step = |index: usize| lift(index + LEVEL) - lift(index + LEVEL - 1);
        let is_slip = |index: &usize| {
            let size = step(*index).abs();
            size > least && size < LARGEST * self.rise() && range(*index).max(range(index + LEVEL)) <= RANGE * size
        };
        let index = (0..count).find(is_slip)?;
        let row = self.rows[(index + LEVEL) % count];
        let reading = &self.reading;
        let size = reading.in_model.told(step(index));
        Some(format!(
            "{}: the lift steps by {} {} at {} deg between two level stretches: has the gauge slipped? Then the lift does not come back, and the step \
             counts as a motion",
            self.row_place(&row),
            (size * 1e6).round() / 1e6,
            reading.unit,
            row.angle_deg
        ))
    }

    /// Rows that are missing where the lift changes.
    fn missing(&self) -> Option<String> {
        /// Gap over those beside it from which on rows are missing.
        const WIDE: f64 = 2.5;
        /// Part of the rise by which the lift changes over the gap.
        const CHANGE: f64 = 0.01;
        let (gaps, count) = (self.gaps(), self.rows.len());
        let change = |index: usize| (self.rows[(index + 1) % count].lift - self.rows[index].lift).abs();
        let is_wide = |index: &usize| {
            let beside = gaps[(index + 1) % count].max(gaps[(index + count - 1) % count]);
            gaps[*index] >= WIDE * beside && change(*index) > CHANGE * self.rise()
        };
        let index = (0..count).find(is_wide)?;
        let (row, reading) = (self.rows[index], &self.reading);
        let size = reading.in_model.told(change(index));
        Some(format!(
            "{}: no row between {} and {} deg, where the lift changes by {} {}: are rows missing? The spline makes up what lies between",
            self.row_place(&row),
            row.angle_deg,
            ((row.angle_deg + gaps[index]) % 360.0 * 1e9).round() / 1e9,
            (size * 1e6).round() / 1e6,
            reading.unit
        ))
    }
}
