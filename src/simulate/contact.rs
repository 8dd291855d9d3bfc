//! Search for the first root of the gap on one segment of the cam, certified: no impact is missed.
//!
//! With `|g'''| <= M` after an instant, `g + g' h + g'' h^2/2 - M h^3/6` lies below the gap. Repeated steps to the first root of that
//! minorant converge to the first contact from the left and never cross it, however short the dip. Close to a crossing each step triples
//! the number of digits.

/// Gap between follower and cam at an instant, with bounds for later times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GapAt {
    /// g, m.
    pub value: f64,
    /// Rounding error of `value`, m.
    pub rounding: f64,
    /// g', m/s.
    pub rate: f64,
    /// Rounding error of `rate`, m/s.
    pub rate_rounding: f64,
    /// g'', m/s^2.
    pub curvature: f64,
    /// Estimate of `|g'''|` for later times, m/s^3. It sets only the first step that is tried; the proof uses the bound.
    pub third: f64,
}

/// Result of the search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// No contact up to the end.
    None,
    /// First contact, s after the start.
    Contact(f64),
    /// Search with more steps than allowed, or a step that takes no time; s after the start.
    NoProgress(f64),
    /// NaN or infinite gap; s after the start.
    NotFinite(f64),
}

/// Finds the first contact of the gap `gap_at(time)` within `[0, end]`, s; `third_bound(time, reach)` bounds `|g'''|` over
/// `[time, time + reach]`. A follower that is inside the cam and moves out of it counts as one that leaves the surface.
pub fn first_contact(
    gap_at: impl Fn(f64) -> GapAt,
    third_bound: impl Fn(f64, f64) -> f64,
    end: f64,
    most_steps: u32,
) -> Outcome {
    let mut time = 0.0;
    for _ in 0..most_steps {
        let gap = gap_at(time);
        if !(gap.value.is_finite() && gap.rate.is_finite() && gap.curvature.is_finite()) {
            return Outcome::NotFinite(time);
        }
        if gap.value <= gap.rounding && gap.rate < -gap.rate_rounding {
            return Outcome::Contact(polish(&gap_at, time, &gap, end));
        }
        let step = free_time(&gap, |reach| third_bound(time, reach), end - time);
        if time + step >= end {
            return Outcome::None;
        }
        if time + step == time {
            // Contact to the last digit if the follower approaches the cam, or does not move away.
            return if gap.rate <= gap.rate_rounding { Outcome::Contact(time) } else { Outcome::NoProgress(time) };
        }
        time += step;
    }
    Outcome::NoProgress(time)
}

/// Takes one Newton step from a contact found up to rounding, but not past the bottom of a graze, where the follower already moves away.
fn polish(gap_at: impl Fn(f64) -> GapAt, time: f64, gap: &GapAt, end: f64) -> f64 {
    let better = (time - gap.value / gap.rate).clamp(0.0, end);
    let there = gap_at(better);
    if there.rate < 0.0 && there.value.abs() <= gap.value.abs() { better } else { time }
}

/// Returns a time, at most `end`, before which the gap is certainly positive.
fn free_time(gap: &GapAt, third_bound: impl Fn(f64) -> f64, end: f64) -> f64 {
    /// Ratio of root to reach above which the reach is too short.
    const FAR: f64 = 16.0;
    // A gap negative within its rounding counts as 0: a flight that leaves a tangency needs a first step out of it.
    let value = (gap.value + gap.rounding).max(0.0);
    // Over [0, reach] the cubic minorant lies above the parabola with curvature g'' - M reach/3.
    let root = |reach: f64, bound: f64| first_root(value, gap.rate, gap.curvature - bound * reach / 3.0);
    let mut reach = end;
    // A shorter reach bends the parabola less: three rounds bring its root within an eighth of the cubic's root.
    for _ in 0..4 {
        let first = root(reach, gap.third);
        if first >= 0.5 * reach {
            break;
        }
        // After a tangency the parabola opens upwards for a time that its curvature sets.
        let upwards = if gap.curvature > 0.0 { gap.curvature / gap.third } else { 0.0 };
        let shorter = reach.min((2.0 * first).max(upwards));
        // If the rate alone keeps the gap positive, the root shrinks as the reach grows, as R^2/reach. The next reach would then be too
        // short by the factor by which this one was too long, and R is between them.
        let overshoots = root(shorter, gap.third) > FAR * shorter;
        reach = if overshoots { (shorter * reach).sqrt() } else { shorter };
    }
    let mut best: f64 = 0.0;
    // The guessed reach becomes certain: it shrinks until the bound over it leaves a good part free.
    for _ in 0..24 {
        let open = root(reach, third_bound(reach)).min(reach);
        best = best.max(open);
        if open >= 0.5 * reach {
            break;
        }
        reach = (2.0 * open).max(0.25 * reach);
    }
    best
}

/// Returns the first positive root of `g + b h + c h^2/2` for `g >= 0`; 0 if it falls at once, infinite if it never reaches 0.
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
