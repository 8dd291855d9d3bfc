//! Roots and borders of one number, by three methods, each with what it asks for and what it guarantees.
//!
//! | method | asks for | guarantees |
//! |---|---|---|
//! | [`halve`] | a yes or no that differs at the ends | a bracket as narrow as was asked for, with one change in it; bisection |
//! | `regula_falsi` | signs that differ at the ends | a bracket as narrow as rounding lets the sign be known, in fewer steps where the function is smooth (Dowell and Jarratt 1971) |
//! | `secants` | two guesses close by | nothing: that the last point is a root is for the caller to see |
//!
//! The event loop has methods of its own: a contact takes two or three of Halley's steps inside a certified bracket, with the
//! cam and the follower evaluated once for value, slope and curvature, and a closure would cost as much as a step. So has
//! the fall to a level, whose Newton steps know the velocity.

use std::ops::RangeInclusive;

/// When a bracket is narrow enough.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Width {
    /// As a part of its second end.
    Relative(f64),
    /// In the unit of its ends.
    Absolute(f64),
    /// After so many halvings: a guess for a method that goes on from there.
    Halvings(u32),
}

/// Halves the bracket `[from, to]`, of which `is_beyond` holds at `to` and not at `from`, until it is narrow enough.
///
/// `is_beyond` is asked at neither end. Either end may be the larger.
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
        // Toward 0 the relative width stays as it is until there is no number in between.
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

/// A point at which a function was evaluated: where, its value there, and what came with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Seen<P> {
    pub at: f64,
    pub value: f64,
    pub with: P,
}

/// Secants that keep the bracket `ends`, in rising order; where an end stays twice its weight is halved, so that both come in.
///
/// Ends at a root, at a bracket of `width`, or where `value` gives nothing. Where rounding decides the signs the bracket goes
/// out again from the point nearest to a root. Its ends, and that point, of all but the first end.
pub(crate) fn regula_falsi<P: Clone, E>(
    ends: [Seen<P>; 2],
    width: f64,
    mut value: impl FnMut(f64) -> Result<Option<(f64, P)>, E>,
) -> Result<([Seen<P>; 2], Seen<P>), E> {
    /// Bisection would take fifty.
    const STEPS: usize = 60;
    /// Near a root a function is a line: twice as far it is twice as large, but for what rounding adds.
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
        // The last two points. Values of an ulp and of two have the ratio 2 by chance, so that one ratio alone tells nothing.
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

/// Secants from two guesses and their values, at most `steps` of them: up to a root, or to a step of less than the part `width`
/// of where it begins. The last two points, of which the second is the nearer, and whether it has come so far; a root
/// that is met exactly stands for both.
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
