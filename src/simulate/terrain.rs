//! Cam as used by the event loop: changes from one segment to the next, and bounds over the whole cam.

use super::leap::Chords;
use crate::cam::{Cam, Segment};
use crate::tolerance;

/// Cam with quantities used at every step, computed once.
#[derive(Clone, Debug)]
pub(super) struct CamBounds {
    pub cam: Cam,
    /// Changes at the start of each segment.
    pub entries: Vec<Entry>,
    /// Upper bound of the lift, m.
    pub top: f64,
    /// Upper bound of the absolute lift, m: the scale for the rounding of any lift, even where the lift passes 0.
    pub size: f64,
    /// Upper bound of `|dc/dtheta|`, m/rad: the scale for the rounding of slopes.
    pub steepest: f64,
    /// Upper bound of `d^2c/dtheta^2`, m/rad^2; infinite if a velocity jumps upwards.
    pub largest_curvature: f64,
    /// Chords that flights over many short segments must clear; none for a cam with few segments.
    pub chords: Chords,
}

/// Changes from the end of the segment before to the start of this one; 0 if within rounding.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    /// Step of the lift, m; not 0 only at the far end of a continued law.
    pub lift_step: f64,
    /// Lift before the start, m, if the two lifts differ by more than rounding but count as equal. This happens for a cam whose numbers
    /// were typed to ten digits, or whose lift is 0 there.
    pub seam: Option<f64>,
    /// Lift at the start of this segment, m.
    pub lift: f64,
    /// Jump of the slope, m/rad.
    pub slope_jump: f64,
}

impl CamBounds {
    pub fn new(cam: Cam) -> Self {
        let segments = cam.segments();
        let before = segments.last().into_iter().chain(segments);
        let size = segments.iter().flat_map(|segment| segment.bounds.lift).map(f64::abs).fold(0.0, f64::max);
        let steepest = segments.iter().flat_map(|segment| segment.bounds.slope).map(f64::abs).fold(0.0, f64::max);
        let entries: Vec<Entry> = before
            .zip(segments)
            .map(|(before, after)| entry(before, after, cam.ends_a_continued_law(after), steepest))
            .collect();
        let kicks = entries.iter().any(|entry| entry.slope_jump > 0.0 || entry.lift_step > 0.0);
        let curvatures = segments.iter().map(|segment| segment.bounds.curvature[1]);
        let largest_curvature = if kicks { f64::INFINITY } else { curvatures.fold(f64::NEG_INFINITY, f64::max) };
        let top = cam.top();
        let kinks: Vec<bool> = entries.iter().map(|entry| entry.slope_jump < 0.0 || entry.lift_step != 0.0).collect();
        let chords = Chords::of_many(segments, &kinks);
        Self { cam, entries, top, size, steepest, largest_curvature, chords }
    }
}

/// Changes between two segments of a cam, whose largest slope is `steepest`, m/rad. The lift has a step only at the end of a law that is
/// continued past its segment.
fn entry(before: &Segment, after: &Segment, may_step: bool, steepest: f64) -> Entry {
    let (minus, plus) = (before.law.lift(before.end), after.law.lift(after.start));
    let jump = |minus: f64, plus: f64, rounding: f64| {
        if (plus - minus).abs() <= rounding { 0.0 } else { plus - minus }
    };
    // Two evaluations of one lift where segments meet differ by rounding. This difference must not change the gap of a follower that has
    // just left the cam there.
    let lift_rounding = tolerance::GAP_ROUNDING.value * (minus.value.abs() + plus.value.abs());
    let step = jump(minus.value, plus.value, lift_rounding);
    let scale = [minus, plus]
        .iter()
        .fold(0.0_f64, |scale, lift| scale.max(lift.value.abs()).max(lift.slope.abs()).max(lift.curvature.abs()));
    // On a dwell at 0 the numbers of a spline may be nearly 0, and so is their scale.
    let slope_rounding = (tolerance::CAM_JUMP.value * scale).max(tolerance::ULP.value * steepest);
    Entry {
        lift_step: if may_step { step } else { 0.0 },
        seam: (!may_step && step != 0.0).then_some(minus.value),
        lift: plus.value,
        slope_jump: jump(minus.slope, plus.slope, slope_rounding),
    }
}
