//! Cam of a model: its lift, its shape, and its document.

use std::f64::consts::TAU;

use corner_impact::cam::{Cam, Jet, Outline, within_a_turn};
use corner_impact::model::Model;
use corner_impact::study::cam::CamSheet;
use serde::Serialize;

use crate::PageRefusal;

/// Lift and shape of a cam, with the document of `cam --json`.
#[derive(Serialize)]
pub struct CamShape {
    angle_deg: Vec<f64>,
    lift_m: Vec<f64>,
    slope_m_rad: Vec<f64>,
    curvature_m_rad2: Vec<f64>,
    outline: Outline,
    sheet: CamSheet,
}

/// Number of angles in a whole turn.
const ANGLES: usize = 721;

impl CamShape {
    /// Computes the lift at evenly spaced angles, and the shape.
    pub(crate) fn of(model: &Model) -> Result<Self, PageRefusal> {
        let cam = Cam::new(model)?;
        let angles: Vec<f64> = (0..ANGLES).map(|index| TAU * index as f64 / (ANGLES - 1) as f64).collect();
        let lifts: Vec<_> = angles.iter().map(|angle| cam.lift(within_a_turn(*angle))).collect();
        Ok(Self {
            angle_deg: angles.iter().map(|angle| angle.to_degrees()).collect(),
            lift_m: lifts.iter().map(|lift| lift.value).collect(),
            slope_m_rad: lifts.iter().map(|lift| lift.slope).collect(),
            curvature_m_rad2: lifts.iter().map(|lift| lift.curvature).collect(),
            outline: Outline::of(model, &cam),
            sheet: CamSheet::new(model, &cam, Jet::HIGHEST_JUMP)?,
        })
    }
}
