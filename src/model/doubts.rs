//! Doubts about the meaning of a table's rows, in sentences for the user.

use super::rows::TableRow;
use super::table::TableProfile;
use crate::tolerance;

impl TableProfile {
    /// Doubts about the meaning of the rows, one sentence each.
    pub fn doubts(&self) -> Vec<String> {
        /// Part of the rise by which a lift may be below 0 through errors of a gauge.
        const BELOW: f64 = 0.01;
        let (reading, mut doubts) = (&self.reading, Vec::new());
        if reading.layout.as_ref().is_some_and(|layout| layout.is_of_crank) && reading.turn_deg.is_none() {
            let words = "cam.turn_deg: the header of the table names a crank's angle, and 360 deg are read as one turn of the cam; if the cam \
                         turns once in two turns of the crank, set turn_deg = 720 in [cam]";
            doubts.push(words.to_owned());
        }
        let lowest = self.rows.iter().map(|row| row.lift).fold(f64::INFINITY, f64::min);
        if lowest < -BELOW * self.rise() {
            doubts.push(format!(
                "{}: the lowest lift is {} {}; lifts below 0 are taken as written: does the gauge count the other way round, or from the \
                 nose?",
                self.place(),
                reading.in_model.told(lowest),
                reading.unit
            ));
        }
        doubts.extend([self.coarse(), self.slipped(), self.missing()].into_iter().flatten());
        doubts
    }

    /// Gaps from each row to the next one, degrees.
    fn gaps(&self) -> Vec<f64> {
        let next =
            |index: usize| self.rows.get(index + 1).map_or(self.rows[0].angle_deg + 360.0, |next| next.angle_deg);
        self.rows.iter().enumerate().map(|(index, row)| next(index) - row.angle_deg).collect()
    }

    /// Place of a row, for a sentence.
    fn row_place(&self, row: &TableRow) -> String {
        self.file.as_ref().map_or_else(|| "cam.rows".to_owned(), |file| format!("{file}, line {}", row.line))
    }

    /// Doubt about too few rows on a lobe, or in a hollow, for its accelerations.
    fn coarse(&self) -> Option<String> {
        let highest = self.rows.iter().map(|row| row.lift).fold(f64::NEG_INFINITY, f64::max);
        let rise = self.rise();
        let above = |row: &TableRow| 1.0 - (highest - row.lift) / rise;
        let [lobe, hollow] = [self.rows_of_one(above), self.rows_of_one(|row| 1.0 - above(row))];
        let (rows, what) = if lobe <= hollow { (lobe, "lobe") } else { (hollow, "hollow") };
        let fewest = tolerance::LOBE_ROWS.value.recip();
        (rows < fewest).then(|| {
            format!(
                "{}: {rows:.0} rows on a {what} are too few for its accelerations, on which separation and impacts depend; give {fewest} or more",
                self.place(),
            )
        })
    }

    /// Number of rows per lobe; `part` is the height of a row relative to the largest, from 0 to 1.
    fn rows_of_one(&self, part: impl Fn(&TableRow) -> f64) -> f64 {
        /// Relative heights: a lobe begins above the first and counts above the second.
        const FOOT: f64 = 0.05;
        const BODY: f64 = 0.5;
        let heights: Vec<f64> = self.rows.iter().map(part).collect();
        let from = heights.iter().enumerate().min_by(|one, two| one.1.total_cmp(two.1)).map_or(0, |(index, _)| index);
        let (mut lobes, mut rows, mut is_on) = (0_u32, 0_u32, false);
        for height in heights[from..].iter().chain(&heights[..from]) {
            rows += u32::from(*height > FOOT);
            lobes += u32::from(!is_on && *height > BODY);
            is_on = *height > BODY || is_on && *height > FOOT;
        }
        f64::from(rows) / f64::from(lobes.max(1))
    }

    /// Doubt about a step of the lift between two level ranges, as left by a slipping gauge.
    fn slipped(&self) -> Option<String> {
        /// Number of rows on either side that must be level.
        const LEVEL: usize = 5;
        /// Range of the lifts on a level side, relative to the step.
        const RANGE: f64 = 0.2;
        /// Largest step relative to the rise: a larger one is a motion.
        const LARGEST: f64 = 0.2;
        let count = self.rows.len();
        if count < 4 * LEVEL {
            return None;
        }
        // Rounding also leaves steps between two level ranges where the lift changes slowly.
        let rise = self.rise();
        let least = (6.0 * self.reading.half_step()).max(tolerance::ON_BASE.value * rise);
        let lift = |index: usize| self.rows[index % count].lift;
        let range = |from: usize| {
            let lifts = (from..from + LEVEL).map(lift);
            lifts.clone().fold(f64::NEG_INFINITY, f64::max) - lifts.fold(f64::INFINITY, f64::min)
        };
        let step = |index: usize| lift(index + LEVEL) - lift(index + LEVEL - 1);
        let is_slip = |index: &usize| {
            let size = step(*index).abs();
            size > least && size < LARGEST * rise && range(*index).max(range(index + LEVEL)) <= RANGE * size
        };
        let index = (0..count).find(is_slip)?;
        let row = self.rows[(index + LEVEL) % count];
        let reading = &self.reading;
        let size = reading.in_model.told(step(index));
        Some(format!(
            "{}: the lift steps by {} {} at {} deg between two level stretches: has the gauge slipped? The lift does not step back, so the step \
             counts as part of the motion",
            self.row_place(&row),
            (size * 1e6).round() / 1e6,
            reading.unit,
            row.angle_deg
        ))
    }

    /// Doubt about missing rows where the lift changes or turns.
    fn missing(&self) -> Option<String> {
        /// Gap relative to neighbouring gaps from which rows count as missing.
        const WIDE: f64 = 2.5;
        /// Part of the rise by which the lift changes over the gap.
        const CHANGE: f64 = 0.01;
        /// Difference of the slopes at the ends of a gap, relative to the largest slope, from which the lift turns within the gap.
        const TURNS: f64 = 0.05;
        let (gaps, count) = (self.gaps(), self.rows.len());
        let change = |index: usize| (self.rows[(index + 1) % count].lift - self.rows[index].lift).abs();
        let slope = |index: usize| {
            let index = index % count;
            (self.rows[(index + 1) % count].lift - self.rows[index].lift) / gaps[index]
        };
        let steepest = (0..count).map(|index| slope(index).abs()).fold(0.0, f64::max);
        // Slope at the edge of a gap, of the parabola through the three nearest rows on that side.
        let at_edge = |near: usize, far: usize| {
            let [near_gap, far_gap] = [near, far].map(|index| gaps[index % count]);
            slope(near) + (slope(near) - slope(far)) * near_gap / (near_gap + far_gap)
        };
        let turns = |index: usize| {
            let before = at_edge(index + count - 1, index + count - 2);
            (at_edge(index + 1, index + 2) - before).abs() > TURNS * steepest
        };
        let least = CHANGE * self.rise();
        let changes = |index: usize| change(index) > least;
        let is_wide = |index: &usize| {
            let beside = gaps[(index + 1) % count].max(gaps[(index + count - 1) % count]);
            gaps[*index] >= WIDE * beside && (changes(*index) || turns(*index))
        };
        let index = (0..count).find(is_wide)?;
        let (row, reading) = (self.rows[index], &self.reading);
        let value = reading.holds.value();
        let what = match changes(index) {
            true => {
                let size = reading.in_model.told(change(index));
                format!("the {value} changes by {} {}", (size * 1e6).round() / 1e6, reading.unit)
            }
            false => format!("the {value} has a turning point"),
        };
        Some(format!(
            "{}: no row between {} and {} deg, where {what}: are rows missing? The spline fills the gap",
            self.row_place(&row),
            row.angle_deg,
            ((row.angle_deg + gaps[index]) % 360.0 * 1e9).round() / 1e9,
        ))
    }
}
