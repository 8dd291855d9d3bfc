//! Where corner impacts go when a number of the model changes: their speed, and where their type changes.

use super::{StudyError, inside};
use crate::border_collision::{AtCorner, ImpactCurve};
use crate::model::Model;
use crate::orbit::branch::{Branch, Following, corner_impacts};
use crate::orbit::{Parameter, Search};
use crate::progress::Watch;

/// The curves through the corner impacts of a model.
#[derive(Clone, Debug)]
pub struct Curves {
    /// The model's own value of what changes.
    pub own: f64,
    /// One for each corner impact that was found.
    pub curves: Vec<ImpactCurve>,
}

/// Follows the corner impacts that a search finds between two speeds, rpm.
pub fn curves(
    model: &Model,
    rpm: [f64; 2],
    wanted: &Search,
    following: &Following,
    watch: &dyn Watch,
) -> Result<Curves, StudyError> {
    if following.parameter == Parameter::Speed {
        return Err(StudyError::SpeedFollowed);
    }
    let own = inside(model, rpm[0], following)?;
    watch.at("looking for corner impacts of the model", 0, 0);
    let corners = corner_impacts(model, rpm, wanted)?.points;
    let mut curves = Vec::new();
    for (index, corner) in corners.iter().enumerate() {
        watch.at("following the corner impacts found", index as u64, corners.len() as u64);
        let Some(at) = AtCorner::of(corner) else { continue };
        curves.push(ImpactCurve::new(&Branch::of_corner_impacts(model, corner, rpm, following)?, at));
    }
    Ok(Curves { own, curves })
}
