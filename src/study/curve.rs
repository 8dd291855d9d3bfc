//! Curves of events such as corner impacts, folds, flips and grazes as a number of the model changes: their speed, and the points where
//! their type changes.

use super::StudyError;
use super::locate::{Happens, LocatedImpact, locate};
use crate::border_collision::{EventCurve, RoundedCorner, rounded};
use crate::model::{CORNER_ROUNDING, Model, Study};
use crate::orbit::branch::{Bifurcation, Branch, Following, SpecialKind, special_points, touches};
use crate::orbit::{Parameter, Search};
use crate::progress::Watch;

/// The curves through the events of a model.
#[derive(Clone, Debug)]
pub struct Curves {
    /// The model's name.
    pub model: String,
    /// Name of the number that changes.
    pub parameter: String,
    /// The model's own value of the number that changes. Events were looked for there, or at the nearest value of the range.
    pub own: f64,
    /// Nonsmooth folds of the cam with sharp corners, if the changing number is the angle over which corners are rounded: the speed, rpm,
    /// and the fold's shift by rounding.
    pub sharp: Vec<(f64, RoundedCorner)>,
    /// One curve for each event found that is on no earlier curve. Curves of one kind follow each other, in the order of the requested
    /// kinds.
    pub curves: Vec<EventCurve>,
}

document!(Curves as it {
    schema: "corner-impact/curve/1",
    model: it.model,
    parameter: it.parameter,
    own_value: it.own,
    curves: it.curves,
});

/// Follows the events that a search finds between two speeds, rpm.
pub fn curves(
    model: &Model,
    rpm: [f64; 2],
    wanted: &Search,
    events: &[Bifurcation],
    following: &Following,
    watch: &dyn Watch,
) -> Result<Curves, StudyError> {
    let Parameter::Field(path) = &following.parameter else { return Err(StudyError::SpeedFollowed) };
    let name = model.name.clone();
    let [low, high] = following.range;
    let own = following.parameter.value(model, rpm[0]).unwrap_or(f64::NAN);
    // A cam may have no event at its own value, as a sharp corner has no fold. Then events are looked for at the nearest value of the
    // range.
    let start = own.clamp(low, high);
    let model = &if start == own { model.clone() } else { model.with_number(path, start)? };
    let is_wanted = |kind: SpecialKind| kind.bifurcation().is_some_and(|event| events.contains(&event));
    let points = special_points(model, rpm, wanted, is_wanted, watch)?.points;
    let of_event = |event: Bifurcation| {
        points
            .iter()
            .filter_map(move |point| Some((point, point.special?.kind)))
            .filter(move |(_, kind)| kind.bifurcation() == Some(event))
    };
    let mut curves = Vec::<EventCurve>::new();
    for (index, (point, kind)) in events.iter().flat_map(|event| of_event(*event)).enumerate() {
        watch.at("following the events found", index as u64, points.len() as u64);
        let curve = Branch::of_event(model, point, rpm, following)?.map(|curve| EventCurve::new(&curve, kind));
        // One curve may go through several of the events.
        curves.extend(curve.filter(|curve| !curves.iter().any(|known| known.is_same(curve))));
    }
    // An orbit without impacts grazes at all speeds or at none: no branch in the speed meets it.
    let is_free = wanted.revolutions == 1 && wanted.impacts.is_none_or(|impacts| impacts == 0);
    if events.contains(&Bifurcation::Graze) && is_free {
        for (curve, kind) in touches(model, rpm, following)? {
            curves.push(EventCurve::new(&curve, kind));
        }
    }
    let sharp =
        if path == CORNER_ROUNDING { sharp(&model.with_number(path, 0.0)?, rpm, wanted, watch)? } else { Vec::new() };
    Ok(Curves { model: name, parameter: path.clone(), own, sharp, curves })
}

/// Finds the nonsmooth folds between two speeds, rpm, of a cam with sharp corners.
fn sharp(
    model: &Model,
    [rpm_min, rpm_max]: [f64; 2],
    wanted: &Search,
    watch: &dyn Watch,
) -> Result<Vec<(f64, RoundedCorner)>, StudyError> {
    let located = locate(model, Study { rpm_min, rpm_max }, wanted.revolutions, watch)?.found;
    let fold = |found: &LocatedImpact| match &found.local {
        Happens::BorderCollision(Ok(kind)) => Some((found.at.speed_rpm(), rounded(kind, &found.at)?)),
        _ => None,
    };
    Ok(located.iter().filter_map(fold).collect())
}
