//! Measured lifts of a model: the rows of a turn, the spline through or near them, and how they were read.

use std::sync::Arc;

use serde::Serialize;

use super::lines::Holds;
use super::rows::{TableLayout, TableRow};
use super::units::Unit;

/// Largest number of rows of a table in proofs.
#[doc(hidden)]
pub const MOST_PROVED_ROWS: usize = 1000;

/// Spline through the rows of a table, or near them.
#[derive(Clone, Debug, PartialEq)]
#[doc(hidden)]
pub struct TableProfile {
    /// Path of the file as in the model, relative to the model file; `None` if the model contains the rows.
    pub file: Option<String>,
    /// Kind of the spline.
    pub spline: Spline,
    /// Rows in order of angle, one for each angle in `[0, 360)`; shared, because a table may be long.
    pub rows: Arc<[TableRow]>,
    /// Interpretation of the rows.
    pub reading: Arc<Reading>,
}

document!(TableProfile as it {
    file if_any: it.file,
    spline: it.spline.name(),
    tolerance if_any: it.spline.smoothing().map(|smoothing| smoothing.tolerance),
    corners_deg if_any: it.spline.smoothing().and_then(|smoothing| smoothing.corners_deg.as_ref()),
    dwells_deg if_any: it.spline.smoothing().and_then(|smoothing| smoothing.dwells_deg.as_ref()),
    rows: &it.rows[..],
});

impl TableProfile {
    /// Whether there are enough rows to separate the motion from errors of measurement.
    pub(crate) fn may_be_smoothed(&self) -> bool {
        self.rows.len() >= FEWEST_SMOOTHED
    }

    /// Difference between the highest and the lowest lift.
    pub(crate) fn rise(&self) -> f64 {
        let lifts = self.rows.iter().map(|row| row.lift);
        lifts.clone().fold(f64::NEG_INFINITY, f64::max) - lifts.fold(f64::INFINITY, f64::min)
    }

    /// Field that gives the rows.
    pub fn place(&self) -> &'static str {
        if self.file.is_some() { "cam.file" } else { "cam.rows" }
    }
}

/// Periodic spline.
#[derive(Clone, Debug, PartialEq)]
#[doc(hidden)]
pub enum Spline {
    /// Pieces of degree 3 through the rows; the third derivative jumps at every row.
    Cubic,
    /// Pieces of degree 5 through the rows; the fifth derivative jumps at every row.
    Quintic,
    /// Pieces of degree 5 near the rows.
    Smoothing(Smoothing),
}

impl Spline {
    /// Name in a model file.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Cubic => "cubic",
            Self::Quintic => "quintic",
            Self::Smoothing(_) => "smoothing",
        }
    }

    /// Constraints of a smoothing spline; `None` for the other splines.
    pub fn smoothing(&self) -> Option<&Smoothing> {
        if let Self::Smoothing(smoothing) = self { Some(smoothing) } else { None }
    }
}

/// Constraints of a smoothing spline.
#[derive(Clone, Debug, Default, PartialEq)]
#[doc(hidden)]
pub struct Smoothing {
    /// Largest distance from a row.
    pub tolerance: SmoothingTolerance,
    /// Angles at which the second derivative may jump, degrees, ascending; `None` if they are to be found.
    pub corners_deg: Option<Vec<f64>>,
    /// Dwells, start and end, degrees, ascending by their start; `None` if they are to be found.
    pub dwells_deg: Option<Vec<[f64; 2]>>,
    /// Whether corners are only near the given angles, not exactly there.
    pub are_near: bool,
}

/// Largest distance of a smoothing spline from a row.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[doc(hidden)]
pub enum SmoothingTolerance {
    /// Estimate from the rows themselves.
    #[default]
    Auto,
    /// Given distance, in the model's unit of length.
    #[serde(untagged)]
    Within(f64),
    /// Distance that results from this weight of the rows, given by its logarithm; the weight comes from another table.
    #[serde(untagged)]
    Weighted(f64),
}

/// Interpretation of the rows of a table.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[doc(hidden)]
pub struct Reading {
    /// Quantities in its columns.
    #[serde(skip)]
    pub holds: Holds,
    /// Unit of lifts in the table.
    pub unit: String,
    /// Decimal part of that unit in which the table's numbers are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub part: Option<String>,
    /// Unit of lifts as a multiple of the model's unit of length.
    #[serde(skip)]
    pub in_model: Unit,
    /// Angle and lift of every row as written, in degrees and the unit of lifts. Empty if angles are in radians, if the lifts come from
    /// another table, or if there are more rows than proofs accept.
    #[serde(skip)]
    pub(crate) written: Vec<[String; 2]>,
    /// Unit of angles in the table.
    pub angle_unit: &'static str,
    /// Degrees of the table in one turn of the cam, if not 360.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub turn_deg: Option<f64>,
    /// Layout of its text; `None` if the model contains the rows.
    #[serde(flatten)]
    pub layout: Option<TableLayout>,
    /// Number of rows kept.
    pub rows: usize,
    /// Angle of the first row as written, degrees.
    pub first_deg: f64,
    /// Whether the angles fell from row to row as written.
    pub falls: bool,
    /// Number of rows that repeated the row before and were dropped.
    pub merged: usize,
    /// Whether the rows are half a lobe and its mirror image.
    #[serde(rename = "mirrored")]
    pub is_mirrored: bool,
    /// Angle of the axis of the mirror image, degrees of the cam.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nose_deg: Option<f64>,
    /// Number of rows added on the base circle.
    pub filled: usize,
    /// Whether the last row repeated the first and was dropped.
    pub repeats_first: bool,
    /// Step of the decimal grid of all lifts, in the table's unit; `None` if no such step is above the rounding of a double.
    pub step: Option<f64>,
}

impl Reading {
    /// Half of the step to which the lifts are rounded, in the model's unit of length; 0 without such a step.
    pub fn half_step(&self) -> f64 {
        self.step.map_or(0.0, |step| self.in_model.inside(0.5 * step))
    }
}

/// Smallest number of rows of a smoothing spline, which has to separate the motion from errors of measurement.
pub(super) const FEWEST_SMOOTHED: usize = 12;
