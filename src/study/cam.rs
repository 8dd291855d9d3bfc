//! What is a cam made of? Its segments, and the corners where they meet.

use serde::Serialize;

use crate::cam::{Cam, Corner, Jet, Segment};
use crate::model::Model;

/// Segments and corners of a model's cam; serializes to the document `corner-impact/cam/1`.
#[derive(Clone, Debug, Serialize)]
pub struct CamSheet {
    schema: &'static str,
    /// Name of the model.
    pub model: String,
    /// Where its numbers come from.
    pub source: String,
    /// The law that `[cam]` names.
    pub law: &'static str,
    /// Its lowest and its highest lift.
    pub lift_m: [f64; 2],
    /// In order of angle.
    pub segments: Vec<Segment>,
    /// The highest order of a jump that is listed.
    pub highest_order: usize,
    /// In order of angle.
    pub corners: Vec<Corner>,
}

impl CamSheet {
    /// What a model's cam is made of, with corners up to an order.
    pub fn new(model: &Model, cam: &Cam, highest_order: usize) -> Self {
        let segments = cam.segments().to_vec();
        let highest_order = highest_order.min(Jet::HIGHEST_JUMP);
        Self {
            schema: "corner-impact/cam/1",
            model: model.name.clone(),
            source: model.source.clone(),
            law: model.cam.law(),
            lift_m: [cam.lowest().value, -cam.least([-1.0, 0.0, 0.0]).value],
            segments,
            highest_order,
            corners: cam.corners().into_iter().filter(|corner| corner.jump_order <= highest_order).collect(),
        }
    }
}
