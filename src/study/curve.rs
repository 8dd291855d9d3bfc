//! Where events such as corner impacts, folds, flips and grazes go when a number of the model changes: their speed, and where
//! their type changes.

use super::{StudyError, inside};
use crate::border_collision::EventCurve;
use crate::model::Model;
use crate::orbit::branch::{Bifurcation, Branch, Following, Kind, special_points};
use crate::orbit::{Parameter, Search};
use crate::progress::Watch;

/// The curves through the events of a model.
#[derive(Clone, Debug)]
pub struct Curves {
    /// The model's own value of what changes.
    pub own: f64,
    /// One for each event that was found and is on none before it: those of one kind after the other, as they were asked for.
    pub curves: Vec<EventCurve>,
}

/// Follows the events that a search finds between two speeds, rpm.
pub fn curves(
    model: &Model,
    rpm: [f64; 2],
    wanted: &Search,
    events: &[Bifurcation],
    following: &Following,
    watch: &dyn Watch,
) -> Result<Curves, StudyError> {
    if following.parameter == Parameter::Speed {
        return Err(StudyError::SpeedFollowed);
    }
    let own = inside(model, rpm[0], following)?;
    watch.at("looking for events of the model", 0, 0);
    let is_wanted = |kind: Kind| kind.bifurcation().is_some_and(|event| events.contains(&event));
    let points = special_points(model, rpm, wanted, is_wanted)?.points;
    let of_event = |event: Bifurcation| {
        points
            .iter()
            .filter_map(move |point| Some((point, point.special?.kind)))
            .filter(move |(_, kind)| kind.bifurcation() == Some(event))
    };
    let mut curves = Vec::<EventCurve>::new();
    for (index, (point, kind)) in events.iter().flat_map(|event| of_event(*event)).enumerate() {
        watch.at("following the events found", index as u64, points.len() as u64);
        if let Some(curve) = Branch::of_event(model, point, rpm, following)? {
            curves.push(EventCurve::new(&curve, kind));
        }
    }
    Ok(Curves { own, curves })
}
