//! The first root of the gap on one segment of the cam, certified: no impact is passed over.
//!
//! With `|g'''| <= M` ahead of an instant, `g + g' h + g'' h^2/2 - M h^3/6` lies below the gap. Marching to the first root
//! of that minorant, again and again, comes to the first contact from the left and never crosses it, however short the
//! dip; close to a crossing each step triples the digits.

/// The gap between follower and cam at an instant, and what is known of it from there on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Gap {
    /// g, m.
    pub value: f64,
    /// How far rounding may have moved `value`, m.
    pub rounding: f64,
    /// g', m/s.
    pub rate: f64,
    /// g'', m/s^2.
    pub curvature: f64,
    /// A bound on `|g'''|` from here to the end of the segment, m/s^3.
    pub third_bound: f64,
}

/// What the search found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Outcome {
    /// No contact up to the end.
    None,
    /// The first contact, s after the start.
    Contact(f64),
    /// On the cam, at rest against it, with nothing that would lift the follower.
    Resting,
    /// Inside the cam already.
    Below { depth: f64, time: f64 },
    /// The gap is not a number.
    NotFinite,
}

/// The first contact within `[0, end]`, s.
pub(super) fn first_contact(gap_at: impl Fn(f64) -> Gap, end: f64) -> Outcome {
    let mut time = 0.0;
    loop {
        let gap = gap_at(time);
        if !(gap.value.is_finite() && gap.rate.is_finite() && gap.curvature.is_finite() && gap.third_bound.is_finite()) {
            return Outcome::NotFinite;
        }
        if gap.value < -gap.rounding && (time == 0.0 || gap.rate >= 0.0) {
            return Outcome::Below { depth: -gap.value, time };
        }
        if gap.value <= gap.rounding && gap.rate < 0.0 {
            return Outcome::Contact(polish(&gap_at, time, &gap, end));
        }
        let step = free_time(gap, end - time);
        if time + step >= end {
            return Outcome::None;
        }
        if time + step == time {
            // Contact to the last digit: approaching it is an impact, resting on it is not.
            return if gap.rate < 0.0 { Outcome::Contact(time) } else { Outcome::Resting };
        }
        time += step;
    }
}

/// One Newton step from a contact known to rounding.
fn polish(gap_at: impl Fn(f64) -> Gap, time: f64, gap: &Gap, end: f64) -> f64 {
    let better = (time - gap.value / gap.rate).clamp(0.0, end);
    if gap_at(better).value.abs() <= gap.value.abs() { better } else { time }
}

/// A time ahead, at most `end`, before which the gap is certainly open.
fn free_time(gap: Gap, end: f64) -> f64 {
    // Leaving a tangency: the parabola opens upwards for this long whatever the third derivative does.
    let mut best = if gap.curvature > 0.0 && gap.rate >= 0.0 { end.min(3.0 * gap.curvature / gap.third_bound) } else { 0.0 };
    let mut reach = end;
    // Over [0, reach] the cubic minorant lies above the parabola with curvature g'' - M reach/3. A shorter reach bends it
    // less: three rounds bring it within a part in eight of the cubic's own root.
    for _ in 0..4 {
        let root = first_root(gap.value.max(0.0), gap.rate, gap.curvature - gap.third_bound * reach / 3.0);
        best = best.max(root.min(reach));
        if root >= 0.5 * reach || root == 0.0 {
            break;
        }
        reach = 2.0 * root;
    }
    best
}

/// The first positive root of `g + b h + c h^2/2` for `g >= 0`; 0 where it falls at once, infinite where it never reaches 0.
fn first_root(g: f64, b: f64, c: f64) -> f64 {
    let discriminant = b * b - 2.0 * c * g;
    if discriminant < 0.0 || (b >= 0.0 && c >= 0.0) {
        return f64::INFINITY;
    }
    if g == 0.0 && b <= 0.0 {
        return 0.0;
    }
    // Each form adds numbers of one sign only.
    if b > 0.0 { (b + discriminant.sqrt()) / -c } else { 2.0 * g / (discriminant.sqrt() - b) }
}
