//! Search for roots and changes of a function of one number, by four methods with their requirements and guarantees.
//!
//! | method | requires | guarantees |
//! |---|---|---|
//! | [`halve`] | a yes-or-no function that differs at the ends | a bracket of the required width, with one change in it; bisection |
//! | [`outward`] | a yes-or-no function, and a direction | a bracket for `halve`, unless the change is too far away |
//! | `regula_falsi` | signs that differ at the ends | a bracket as narrow as rounding allows, in fewer steps if smooth (Dowell and Jarratt 1971) |
//! | `secants` | two guesses close by | none: the caller must check that the last point is a root |
//!
//! The event loop has separate methods. A contact takes two or three of Halley's steps inside a certified bracket, with one evaluation of
//! value, slope and curvature each; a closure would cost as much as a step. The fall to a level has a separate method, too: its Halley
//! steps use the velocity and acceleration at hand.

use std::ops::RangeInclusive;

/// Width at which a bracket is narrow enough.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Width {
    /// Width relative to the second end.
    Relative(f64),
    /// Width in the unit of the ends.
    Absolute(f64),
    /// Number of halvings, for a guess from which another method continues.
    Halvings(u32),
}

/// Halves the bracket `[from, to]` until it is narrow enough. `is_beyond` must be true at `to` and false at `from`.
///
/// `is_beyond` is called at neither end. Either end may be the larger.
pub fn halve<E>(
    [mut from, mut to]: [f64; 2],
    width: Width,
    mut is_beyond: impl FnMut(f64) -> Result<bool, E>,
) -> Result<[f64; 2], E> {
    let mut halvings = 0;
    loop {
        let is_narrow = match width {
            Width::Relative(part) => !((to - from).abs() > part * to.abs()),
            Width::Absolute(width) => !((to - from).abs() > width),
            Width::Halvings(count) => halvings >= count,
        };
        if is_narrow {
            return Ok([from, to]);
        }
        let middle = 0.5 * (from + to);
        // Near 0 the relative width stays the same until no number lies in between.
        if middle == from || middle == to {
            return Ok([from, to]);
        }
        if is_beyond(middle)? {
            to = middle;
        } else {
            from = middle;
        }
        halvings += 1;
    }
}

/// Searches from `from` on, in up to `steps` steps of doubled length, for the step on which a yes-or-no function changes. `is_beyond` is
/// false at `from`.
pub fn outward<E>(
    from: f64,
    step: f64,
    steps: usize,
    mut is_beyond: impl FnMut(f64) -> Result<bool, E>,
) -> Result<Option<[f64; 2]>, E> {
    let (mut from, mut step) = (from, step);
    for _ in 0..steps {
        let next = from + step;
        if is_beyond(next)? {
            return Ok(Some([from, next]));
        }
        (from, step) = (next, 2.0 * step);
    }
    Ok(None)
}

/// Point at which a function was evaluated: its argument, its value, and further data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Seen<P> {
    pub at: f64,
    pub value: f64,
    pub with: P,
}

/// Finds a root by secants that keep the bracket `ends`, in rising order. If an end stays twice, its weight is halved, so that both ends
/// move in.
///
/// Stops at a root, at a bracket of `width`, or if `value` returns `None`. Where rounding decides the signs, the bracket is widened again
/// from the point nearest to a root. Returns the bracket's ends, and that nearest point, which is never the first end.
pub(crate) fn regula_falsi<P: Clone, E>(
    ends: [Seen<P>; 2],
    width: f64,
    mut value: impl FnMut(f64) -> Result<Option<(f64, P)>, E>,
) -> Result<([Seen<P>; 2], Seen<P>), E> {
    /// Step limit; bisection would take fifty.
    const STEPS: usize = 60;
    /// Accepted ratios of values at a doubled distance: near a root a function is a line, so the ratio is 2 except for rounding.
    const LARGER: RangeInclusive<f64> = 1.5..=3.0;
    let outer = ends.clone();
    let [mut low, mut high] = ends;
    let (sign, mut best, mut moved_high) = (high.value < 0.0, high.clone(), None);
    for _ in 0..STEPS {
        if best.value == 0.0 || high.at - low.at <= width {
            break;
        }
        let secant = low.at + (high.at - low.at) * low.value / (low.value - high.value);
        let at = if secant > low.at && secant < high.at { secant } else { 0.5 * (low.at + high.at) };
        let Some((value, with)) = value(at)? else { return Ok(([low, high], best)) };
        let seen = Seen { at, value, with };
        if value.abs() < best.value.abs() {
            best = seen.clone();
        }
        if (value < 0.0) == sign {
            high = seen;
            low.value *= if moved_high == Some(true) { 0.5 } else { 1.0 };
            moved_high = Some(true);
        } else {
            low = seen;
            high.value *= if moved_high == Some(false) { 0.5 } else { 1.0 };
            moved_high = Some(false);
        }
    }
    let mut sure = |end: &Seen<P>, direction: f64| -> Result<Seen<P>, E> {
        let mut reach = 0.5 * width;
        // The last two points. Values of one and two ulps have the ratio 2 by chance, so a single ratio proves nothing.
        let mut nearer: [Option<Seen<P>>; 2] = [None, None];
        loop {
            let at = best.at + direction * reach;
            let is_inside = (at - end.at) * direction < 0.0;
            let Some((value, with)) = (if is_inside { value(at)? } else { None }) else { return Ok(end.clone()) };
            let here = Seen { at, value, with };
            let is_seen = |nearer: &Seen<P>, further: &Seen<P>| {
                (nearer.value < 0.0) == (end.value < 0.0) && LARGER.contains(&(further.value / nearer.value))
            };
            nearer = match nearer {
                [Some(first), Some(second)] if is_seen(&first, &second) && is_seen(&second, &here) => return Ok(first),
                [_, second] => [second, Some(here)],
            };
            reach *= 2.0;
        }
    };
    Ok(([sure(&outer[0], -1.0)?, sure(&outer[1], 1.0)?], best))
}

/// Finds a root by at most `steps` secants from two guesses and their values: up to a root, or to a step below the fraction `width` of its
/// starting point. Returns the last two points, of which the second is the nearer, and whether the search converged. An exact root is
/// returned as both points.
pub(crate) fn secants<E>(
    [mut last, mut here]: [(f64, f64); 2],
    steps: usize,
    width: f64,
    mut value: impl FnMut(f64) -> Result<f64, E>,
) -> Result<([(f64, f64); 2], bool), E> {
    for _ in 0..steps {
        let next = here.0 - here.1 * (here.0 - last.0) / (here.1 - last.1);
        if here.1 == 0.0 || next == here.0 {
            return Ok(([here, here], true));
        }
        if !next.is_finite() {
            return Ok(([last, here], false));
        }
        let is_last = (next - here.0).abs() <= width * here.0.abs();
        (last, here) = (here, (next, value(next)?));
        if is_last {
            return Ok(([last, here], true));
        }
    }
    Ok(([last, here], false))
}
