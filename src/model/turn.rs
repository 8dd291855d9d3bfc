//! Conversion of a table's rows to one turn of the cam: half a lobe is mirrored, the base circle filled, and the angles are checked.

use std::f64::consts::TAU;

use super::ModelError;
use super::fields::Fields;
use super::lines::{Holds, Table};
use super::rows::{MOST_ROWS, TableRow};
use crate::tolerance;

/// Smallest number of rows: a periodic spline needs three for every row to have a neighbour on either side.
pub(super) const FEWEST_ROWS: usize = 3;

impl Table<'_> {
    /// Adds the mirror image of half a lobe about its nose, and returns the nose's angle. The nose is the row of the greatest lift at one
    /// of the ends; or half a step beyond it, if that angle is 0 or half a turn.
    pub(super) fn mirror(&self, fields: &Fields, rows: &mut Vec<TableRow>) -> Result<Option<f64>, ModelError> {
        let highest = rows.iter().copied().reduce(|highest, row| if row.lift > highest.lift { row } else { highest });
        let (Some(first), Some(last), Some(highest)) = (rows.first().copied(), rows.last().copied(), highest) else {
            return Ok(None);
        };
        let slack = tolerance::TURN_CLOSED.value * 360.0 / rows.len() as f64;
        if last.angle_deg - first.angle_deg > 180.0 + slack {
            let words = format!(
                "is set, but the rows cover {} degrees: half a lobe has 180 at most",
                last.angle_deg - first.angle_deg
            );
            return Err(fields.reject("cam.mirrored", words));
        }
        let step = rows.get(1).map_or(0.0, |second| second.angle_deg - first.angle_deg);
        let (end, outside) = if highest.lift == first.lift {
            (first.angle_deg, first.angle_deg - 0.5 * step)
        } else if highest.lift == last.lift {
            let before = rows[rows.len() - 2].angle_deg;
            (last.angle_deg, last.angle_deg + 0.5 * (last.angle_deg - before))
        } else {
            let words = format!(
                "needs the nose, the greatest {}, at one end of the rows: it is on {}",
                self.holds.value(),
                self.place(&highest)
            );
            return Err(fields.reject("cam.mirrored", words));
        };
        let whole = (outside / 180.0).round() * 180.0;
        let nose = if (outside - whole).abs() <= slack { whole } else { end };
        // A row half a turn from the nose is its own image.
        let is_other = |row: &&TableRow| {
            let from = (row.angle_deg - nose).abs();
            from > 0.0 && from < 180.0 - slack
        };
        let image = |row: &TableRow| TableRow { angle_deg: 2.0 * nose - row.angle_deg, ..*row };
        let images: Vec<TableRow> = rows.iter().rev().filter(is_other).map(image).collect();
        let place = if nose <= first.angle_deg { 0 } else { rows.len() };
        rows.splice(place..place, images);
        Ok(Some(nose.rem_euclid(360.0)))
    }

    /// Adds rows on the base circle over the widest gap, spaced like the others. Returns their number.
    fn fill(&self, fields: &Fields, rows: &mut Vec<TableRow>) -> Result<usize, ModelError> {
        let Some(first) = rows.first().copied() else { return Ok(0) };
        let next = |index: usize| {
            rows.get(index + 1).map_or(TableRow { angle_deg: first.angle_deg + 360.0, ..first }, |row| *row)
        };
        let mut gaps: Vec<f64> = (0..rows.len()).map(|index| next(index).angle_deg - rows[index].angle_deg).collect();
        let widest = (0..rows.len()).max_by(|one, two| gaps[*one].total_cmp(&gaps[*two])).unwrap_or_default();
        let (before, after, gap) = (rows[widest], next(widest), gaps[widest]);
        let middle = gaps.len() / 2;
        let (_, median, _) = gaps.select_nth_unstable_by(middle, f64::total_cmp);
        let count = ((gap / *median).round() as usize).saturating_sub(1).min(MOST_ROWS - rows.len().min(MOST_ROWS));
        let lifts = rows.iter().map(|row| row.lift);
        let (base, top) =
            lifts.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), lift| (low.min(lift), high.max(lift)));
        let little = tolerance::ON_BASE.value * (top - base);
        // From the gap inwards on either side: a rise from the circle begins with a small step and continues with larger ones.
        let inwards = |from: usize, back: bool| {
            [0, 1, 2].map(|step| rows[(from + if back { rows.len() - step } else { step }) % rows.len()].lift)
        };
        let is_high = |[one, ..]: [f64; 3]| one - base > little;
        let is_cut =
            |[one, two, three]: [f64; 3]| (two - one).abs() > little && (two - one).abs() > 0.5 * (three - two).abs();
        let sides = [(widest, before, true), ((widest + 1) % rows.len(), after, false)];
        if count > 0
            && rows.len() >= FEWEST_ROWS
            && let Some((lifts, row)) = sides
                .map(|(from, row, back)| (inwards(from, back), row))
                .into_iter()
                .find(|(lifts, _)| is_high(*lifts) || is_cut(*lifts))
        {
            let found = if is_high(lifts) {
                format!("is {} above the lowest", row.lift - base)
            } else {
                format!(
                    "is the lowest, but the next one already differs by {}: the flank is cut off",
                    (lifts[1] - lifts[0]).abs()
                )
            };
            let words = format!(
                "is set, but the rows do not begin and end on the base circle: the {} on {} {found}",
                self.holds.value(),
                self.place(&row)
            );
            return Err(fields.reject("cam.outside", words));
        }
        let added = (1..=count).map(|index| TableRow {
            angle_deg: before.angle_deg + gap * index as f64 / (count + 1) as f64,
            lift: base,
            line: before.line,
        });
        let added: Vec<TableRow> = added.collect();
        rows.splice(widest + 1..widest + 1, added);
        rows.iter_mut().for_each(|row| row.angle_deg = row.angle_deg.rem_euclid(360.0) % 360.0);
        rows.sort_by(|one, two| one.angle_deg.total_cmp(&two.angle_deg));
        Ok(count)
    }

    /// Orders the rows of one turn from 0 to below 360, from any first angle, and fills the base circle on request. Returns whether the
    /// last row repeated the first, and the number of rows added.
    pub(super) fn turned(
        &self,
        fields: &Fields,
        rows: &mut Vec<TableRow>,
        fills: bool,
    ) -> Result<(bool, usize), ModelError> {
        /// Smallest fall of the angle that begins a new turn, degrees.
        const BACK: f64 = 180.0;
        let (mut turns, mut begun) = (0.0, None);
        let first = rows.first().map_or(0.0, |row| row.angle_deg);
        // In radians, a turn is 2 pi to as many digits as were written.
        let slack = tolerance::TURN_CLOSED.value * 360.0 / rows.len() as f64;
        let mut before_written = first;
        for index in 1..rows.len() {
            let (before, row) = (rows[index - 1], &mut rows[index]);
            let written = row.angle_deg;
            let begins_turn = turns == 0.0 && before.angle_deg - written > BACK;
            if begins_turn {
                turns = 360.0;
                begun = Some(*row);
            }
            row.angle_deg += turns;
            let row = *row;
            self.in_order([(&before, before_written), (&row, written)], begins_turn)?;
            before_written = written;
            if row.angle_deg - first > 360.0 + slack {
                let [from, to] = [first - turns, first + 360.0 - turns].map(|angle| self.shown(angle));
                let words = format!("must be within a turn of the first row, from {from} to {to}");
                let twice = rows.last().is_some_and(|last| last.angle_deg - first <= 2.0 * (360.0 + slack));
                let over = rows.last().map_or(0.0, |last| last.angle_deg - first);
                let crank = "are these degrees of a crank? then set turn_deg = 720 in [cam]";
                let gon = "are these gon, 400 to a turn? then set angle_unit = \"gon\" in [cam]";
                let meant = twice.then(|| match self.repeats(rows, index, slack) {
                    _ if turns > 0.0 => {
                        let start = begun.map_or(row.line, |begun: TableRow| begun.line);
                        format!("angles begin again: does a second table begin on line {start}? then keep one of them")
                    }
                    _ if self.angles.is_of_cam() && (390.0..=400.0 + slack).contains(&over) => gon.to_owned(),
                    true => format!("the rows repeat those of the turn before: keep one turn of them; or {crank}"),
                    false => crank.to_owned(),
                });
                return Err(self.reject_angle(row.line, written, words).meaning(meant));
            }
        }
        let last = rows.last().copied().filter(|last| last.angle_deg - first >= 360.0 - slack);
        if let Some(last) = last {
            self.closes(rows, &rows[0], &last)?;
            rows.pop();
        }
        rows.iter_mut().for_each(|row| row.angle_deg = row.angle_deg.rem_euclid(360.0) % 360.0);
        let start = rows.iter().enumerate().min_by(|one, two| one.1.angle_deg.total_cmp(&two.1.angle_deg));
        let start = start.map_or(0, |(index, _)| index);
        rows.rotate_left(start);
        rows.windows(2).try_for_each(|pair| {
            let [before, row] = [&pair[0], &pair[1]].map(|row| (row, row.angle_deg));
            self.in_order([before, row], false)
        })?;
        let filled = if fills { self.fill(fields, rows)? } else { 0 };
        if rows.len() >= FEWEST_ROWS {
            self.even(fields, rows)?;
        }
        Ok((last.is_some(), filled))
    }

    /// Whether the rows from `index` on repeat those of the turn before.
    fn repeats(&self, rows: &[TableRow], index: usize, slack: f64) -> bool {
        let lifts = rows.iter().map(|row| row.lift.abs());
        let little = tolerance::ON_BASE.value * lifts.fold(0.0, f64::max);
        rows[index..].iter().all(|row| {
            let angle = row.angle_deg - 360.0;
            let at = rows.partition_point(|other| other.angle_deg < angle - slack);
            let is_it =
                |other: &TableRow| (other.angle_deg - angle).abs() <= slack && (other.lift - row.lift).abs() <= little;
            rows.get(at).is_some_and(is_it)
        })
    }

    fn place(&self, row: &TableRow) -> String {
        format!("{} {}", if self.has_lines { "line" } else { "row" }, row.line)
    }

    /// Angle, degrees of the cam, in the unit of the table.
    fn shown(&self, angle_deg: f64) -> f64 {
        // Polar angles of points have rounded digits.
        if self.holds == Holds::Points { (angle_deg * 1e9).round() / 1e9 } else { self.angles.told(angle_deg) }
    }

    fn reject_angle(&self, line: usize, angle_deg: f64, words: String) -> ModelError {
        let field = format!("angle_{}", self.angles.name());
        self.reject(line, &field, &self.shown(angle_deg).to_string(), words)
    }

    /// Rejects a row that is not above the one before it; each comes with its angle as written, degrees.
    fn in_order(&self, rows: [(&TableRow, f64); 2], begins_turn: bool) -> Result<(), ModelError> {
        let [(before, above), (row, written)] = rows;
        // Angles that are equal in radians count as equal.
        if row.angle_deg.to_radians() > before.angle_deg.to_radians() {
            return Ok(());
        }
        let repeats = row.angle_deg >= before.angle_deg;
        let again = || format!("repeats the angle of the row before with another {}", self.holds.value());
        let what = if repeats { again() } else { "angles must rise".to_owned() };
        let of_turn = if begins_turn { " less a turn" } else { "" };
        let words = format!("{what}: must be above {}{of_turn}, {}", self.shown(above), self.place(before));
        Err(self.reject_angle(row.line, written, words))
    }

    /// Checks that a last row one turn after the first has the same lift.
    fn closes(&self, rows: &[TableRow], first: &TableRow, last: &TableRow) -> Result<(), ModelError> {
        let largest = rows.iter().fold(0.0_f64, |largest, row| largest.max(row.lift.abs()));
        if (last.lift - first.lift).abs() > tolerance::CAM_CLOSURE.value * largest {
            let value = self.holds.value();
            let words = format!(
                "must be {}, the {value} at {} on {}, one turn before; or leave the row out",
                first.lift,
                self.shown(first.angle_deg),
                self.place(first)
            );
            return Err(self.reject(last.line, value, &last.lift.to_string(), words));
        }
        Ok(())
    }

    /// Rejects a gap where rows are missing.
    fn even(&self, fields: &Fields, rows: &[TableRow]) -> Result<(), ModelError> {
        /// Smallest gap that is rejected for any number of rows, degrees.
        const HALF: f64 = 180.0;
        /// Gap, degrees, above which the rows cover only a part of the turn.
        const PART: f64 = 90.0;
        let next = |index: usize| match rows.get(index + 1) {
            Some(row) => row.angle_deg,
            None => rows[0].angle_deg + 360.0,
        };
        let gaps: Vec<f64> = rows.iter().enumerate().map(|(index, row)| next(index) - row.angle_deg).collect();
        let mut sorted = gaps.clone();
        let (_, median, _) = sorted.select_nth_unstable_by(gaps.len() / 2, f64::total_cmp);
        let widest = *median / tolerance::TABLE_GAP.value;
        // Allows for the digits to which a turn is written.
        let half = HALF - tolerance::TURN_CLOSED.value * 360.0 / rows.len() as f64;
        let Some(index) = gaps.iter().position(|gap| *gap > widest || *gap > half) else {
            return Ok(());
        };
        // The difference of two angles has fewer digits than the angles.
        let covered = ((360.0 - gaps[index]) * 1e9).round() / 1e9;
        let words = if gaps[index] > PART {
            format!(
                "no row from {} to {}: the rows cover {covered} degrees, and a whole turn is needed, even for a cam that is its own \
                 mirror image",
                self.shown(rows[index].angle_deg),
                self.shown(next(index))
            )
        } else {
            format!(
                "no row from {} to {}: rows are missing; a gap may be at most {}, {} times the median one",
                self.shown(rows[index].angle_deg),
                self.shown(next(index)),
                self.shown(widest),
                1.0 / tolerance::TABLE_GAP.value
            )
        };
        let other = |unit: &str| match self.says_angles {
            true => format!("the header says {}: is it {unit}? then correct it there", self.angles.name()),
            false => format!("did you mean angle_unit = \"{unit}\" in [cam]?"),
        };
        let turn = TAU * (1.0 + tolerance::TURN_CLOSED.value);
        let meant = match (covered, fields.has("cam.outside"), fields.has("cam.mirrored")) {
            _ if !self.angles.is_of_cam() || gaps[index] <= PART => None,
            (covered, ..) if (0.5..=1.0).contains(&covered) => Some(other("turn")),
            (covered, ..) if covered <= turn => Some(other("rad")),
            (_, true, _) => None,
            (_, false, is_mirrored) => {
                let of_half = if is_mirrored { "" } else { "; if they cover half a lobe, set mirrored = true" };
                Some(format!(
                    "if the rows cover only the lobe, set outside = \"base\" in [cam], which fills the base circle{of_half}"
                ))
            }
        };
        Err(self.reject_angle(rows[index].line, rows[index].angle_deg, words).meaning(meant))
    }
}
