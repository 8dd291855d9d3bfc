//! Conversion of points of a contour, x and y, to radii over polar angles.

use super::ModelError;
use super::lines::Table;
use super::rows::TableRow;

impl Table<'_> {
    /// Turns points about the cam's axis, x = 0 and y = 0, into polar angles, degrees from -180 to 180, and radii.
    ///
    /// Rejects points that do not go round the axis exactly once in one direction: an angle would not have exactly one radius.
    pub(super) fn polar(&self, rows: &mut [TableRow]) -> Result<(), ModelError> {
        for row in rows.iter_mut() {
            let (x, y) = (row.angle_deg, row.lift);
            row.lift = crate::elementary::hypot(x, y);
            if !(row.lift > 0.0 && row.lift.is_finite()) {
                let words = "is on the cam's axis, x = 0 and y = 0, which must be inside of the contour".into();
                return Err(self.reject(row.line, "x, y", &format!("{x}, {y}"), words));
            }
            row.angle_deg = crate::elementary::atan2(y, x).to_degrees();
        }
        let turn = |from: &TableRow, to: &TableRow| {
            let turn = (to.angle_deg - from.angle_deg).rem_euclid(360.0);
            if turn > 180.0 { turn - 360.0 } else { turn }
        };
        let turns: Vec<f64> = rows.windows(2).map(|pair| turn(&pair[0], &pair[1])).collect();
        let sum: f64 = turns.iter().sum();
        let closing = rows.last().zip(rows.first()).map_or(0.0, |(last, first)| turn(last, first));
        let back = turns.iter().position(|turn| turn * sum.signum() < 0.0);
        let Some(back) = back else {
            // The last row may repeat the first.
            return match sum.abs() > 540.0 {
                true => Err(self.complain(
                    rows.first().map(|row| row.line),
                    format!("goes round the cam's axis {:.1} times; a contour goes round once", sum.abs() / 360.0),
                )),
                false => Ok(()),
            };
        };
        let words = match ((sum + closing) / 360.0).round().abs() {
            0.0 => {
                "turns back as seen from the cam's axis: the axis, x = 0 and y = 0, is outside of the contour, or the contour crosses itself"
            }
            _ => {
                "turns back as seen from the cam's axis, x = 0 and y = 0: the contour crosses itself there, or has two radii at one angle; each \
                 angle must have one"
            }
        };
        let row = rows[back + 1];
        let (sin, cos) = crate::elementary::sin_cos(row.angle_deg.to_radians());
        let point = format!("{:.6}, {:.6}", row.lift * cos, row.lift * sin);
        Err(self.reject(row.line, "x, y", &point, words.into()))
    }

    /// Rejects a radius that is not above 0.
    pub(super) fn radii(&self, rows: &[TableRow]) -> Result<(), ModelError> {
        match rows.iter().find(|row| !(row.lift > 0.0)) {
            Some(row) => {
                let words = "must be above 0: the cam's axis is inside of its contour".into();
                Err(self.reject(row.line, "radius", &row.lift.to_string(), words))
            }
            None => Ok(()),
        }
    }
}
