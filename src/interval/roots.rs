//! Search for all roots of equations in a box, which is halved until each part contains no root, or certainly one.
//!
//! Krawczyk's operator about the middle m of a box X, with C near the inverse of the derivative J,
//!
//! ```text
//! K(X) = m - C F(m) + (1 - C J(X)) (X - m)
//! ```
//!
//! contains every root of X. If it lies inside X there is exactly one (Krawczyk 1969, Moore 1977); if the two are disjoint there is none. A
//! root near the border of a box is searched in a somewhat larger box.

use std::ops::Add as _;

use nalgebra::SMatrix;

use super::{Interval, Number};
use crate::tolerance;

/// Encloses the root, near a guess, of a function that decreases there. `of` returns the value and the derivative over any range. `None` if
/// no root is proved.
///
/// Applies Newton's method on intervals: `t - g(t)/g'(T)`, with the guess t, over a range T that it maps into itself. T contains exactly
/// one root.
pub fn falls_to_zero(guess: f64, of: impl Fn(Interval) -> [Interval; 2]) -> Option<Interval> {
    /// Number of attempts, each of which widens or narrows the range.
    const TRIES: usize = 8;
    let guessed = Interval::from(guess);
    let [value, rate] = of(guessed);
    let mut image = guessed - value / rate;
    for _ in 0..TRIES {
        let room = 0.1 * image.width() + tolerance::ULP.value * guess;
        // The range must contain the guess, from which the mean value of g' is taken.
        let range = (image + Interval::new(-room, room)).hull(guessed);
        let [_, rate] = of(range);
        if !rate.is_negative() {
            return None;
        }
        image = guessed - value / rate;
        if image.is_inside(range) {
            let [_, rate] = of(image.hull(guessed));
            return Some((guessed - value / rate).and(image));
        }
    }
    None
}

/// Box: an interval for each unknown.
pub type IntervalBox<const N: usize> = [Interval; N];

/// Equations over a box: the values of N functions, and their derivatives with respect to each unknown.
#[derive(Clone, Copy, Debug)]
pub struct BoxValues<const N: usize> {
    /// Values of the functions whose roots are sought.
    pub values: [Interval; N],
    /// Derivatives, row by row.
    pub derivatives: [[Interval; N]; N],
    /// Whether the box may contain a wanted root.
    pub is_wanted: bool,
}

/// Result of a search for all roots in a box.
#[derive(Clone, Debug, Default)]
pub struct Isolated<const N: usize> {
    /// Boxes that contain one root each, as narrow as rounding allows.
    pub roots: Vec<IntervalBox<N>>,
    /// Undecided boxes, which may contain roots: halving would not help, or the limit was reached. All other roots are in `roots`.
    pub undecided: Vec<IntervalBox<N>>,
    /// Number of boxes examined.
    pub boxes: usize,
}

/// Isolates all roots in `place`, in at most `most` boxes.
///
/// `over` returns the values and derivatives over a box, which may reach somewhat beyond `place`.
pub fn isolate<const N: usize>(
    place: IntervalBox<N>,
    most: usize,
    over: impl Fn(&IntervalBox<N>) -> BoxValues<N>,
) -> Isolated<N> {
    let narrowest = place.map(|side| {
        (tolerance::NARROWEST_BOX.value * side.width()).max(tolerance::ROOT_WIDTH.value * side.magnitude())
    });
    let mut found = Isolated { roots: Vec::new(), undecided: Vec::new(), boxes: 0 };
    // Each root with a box that contains no other root.
    let mut alone: Vec<(IntervalBox<N>, IntervalBox<N>)> = Vec::new();
    let mut left = vec![place];
    while let Some(here) = left.pop() {
        found.boxes += 1;
        if found.boxes > most {
            found.undecided.push(here);
            continue;
        }
        let mut rest = here;
        match look(&here, &over) {
            Look::Nothing => continue,
            Look::Rounding => {
                found.undecided.push(here);
                continue;
            }
            Look::Unknown => {}
            Look::Within(image) => {
                let wider = around(&here, &image);
                let one = [here, wider].into_iter().find(|wide| {
                    let image = if *wide == here { Some(image) } else { step(wide, &over) };
                    image.is_some_and(|image| is_inside(&image, wide))
                });
                if let Some(wide) = one {
                    let root = closed_in(wide, &over);
                    let is_known = alone.iter().any(|(_, alone)| is_inside(&root, alone));
                    if common(&root, &here).is_some() && !is_known {
                        alone.push((root, wide));
                    }
                    continue;
                }
                match common(&image, &here) {
                    None => continue,
                    Some(less) => rest = less,
                }
            }
        }
        let part = |side: usize| here[side].width() / place[side].width();
        let widest = (0..N).max_by(|one, two| part(*one).total_cmp(&part(*two))).unwrap_or(0);
        let is_less = rest[widest].width() < 0.5 * here[widest].width();
        if is_less {
            left.push(rest);
        } else if (0..N).all(|side| rest[side].width() <= narrowest[side]) {
            found.undecided.push(rest);
        } else {
            let [low, high] = rest[widest].halves();
            for half in [high, low] {
                let mut part = rest;
                part[widest] = half;
                left.push(part);
            }
        }
    }
    found.roots = alone.into_iter().map(|(root, _)| root).collect();
    found
}

/// Result of examining one box.
enum Look<const N: usize> {
    /// Box without a root.
    Nothing,
    /// Box that contains all roots of the examined box, if any.
    Within(IntervalBox<N>),
    /// Derivative that may be singular.
    Unknown,
    /// Values that are all 0 up to rounding, so that halving the box would decide nothing.
    Rounding,
}

fn look<const N: usize>(here: &IntervalBox<N>, over: &impl Fn(&IntervalBox<N>) -> BoxValues<N>) -> Look<N> {
    let whole = over(here);
    if !whole.is_wanted || whole.values.iter().any(|value| !value.holds_zero()) {
        return Look::Nothing;
    }
    let middle = over(&here.map(|side| side.middle().into()));
    // F(X) is also in F(m) + J(X) (X - m).
    let centred = |row: usize| {
        (0..N).fold(middle.values[row], |sum, column| {
            sum + whole.derivatives[row][column] * (here[column] - here[column].middle())
        })
    };
    if (0..N).any(|row| !centred(row).holds_zero()) {
        return Look::Nothing;
    }
    if whole.values.iter().zip(&middle.values).all(|(all, one)| one.holds_zero() && all.width() <= 2.0 * one.width()) {
        return Look::Rounding;
    }
    image(here, &whole, &middle).map_or(Look::Unknown, Look::Within)
}

/// Applies Krawczyk's operator; `None` if the derivative in the middle has no inverse.
fn image<const N: usize>(here: &IntervalBox<N>, whole: &BoxValues<N>, middle: &BoxValues<N>) -> Option<IntervalBox<N>> {
    let derivative = SMatrix::<f64, N, N>::from_fn(|row, column| whole.derivatives[row][column].middle());
    let inverse = derivative.try_inverse().filter(|inverse| inverse.iter().all(|entry| entry.is_finite()))?;
    let contracted = |row: usize, column: usize| {
        let unit = if row == column { 1.0 } else { 0.0 };
        let product = (0..N).map(|inner| whole.derivatives[inner][column] * inverse[(row, inner)]);
        -product.fold(Interval::from(0.0), Interval::add) + unit
    };
    Some(std::array::from_fn(|row| {
        (0..N).fold(here[row].middle().into(), |image: Interval, column| {
            let away = here[column] - here[column].middle();
            image - middle.values[column] * inverse[(row, column)] + contracted(row, column) * away
        })
    }))
}

fn step<const N: usize>(
    here: &IntervalBox<N>,
    over: &impl Fn(&IntervalBox<N>) -> BoxValues<N>,
) -> Option<IntervalBox<N>> {
    image(here, &over(here), &over(&here.map(|side| side.middle().into())))
}

/// Box around both boxes, with room on each side for a root on the border.
fn around<const N: usize>(here: &IntervalBox<N>, image: &IntervalBox<N>) -> IntervalBox<N> {
    std::array::from_fn(|side| {
        let room = 0.25 * here[side].width();
        let most = Interval::new(here[side].low() - room, here[side].high() + room);
        // A far image would extend the box to a region with different derivatives.
        here[side].hull(image[side] + Interval::new(-0.5 * room, 0.5 * room)).and(most)
    })
}

/// Narrows the box of the only root in `here` until rounding stops its width from shrinking.
fn closed_in<const N: usize>(
    mut here: IntervalBox<N>,
    over: &impl Fn(&IntervalBox<N>) -> BoxValues<N>,
) -> IntervalBox<N> {
    /// Step limit: Newton's method converges quadratically once the box is narrow.
    const STEPS: usize = 100;
    for _ in 0..STEPS {
        let Some(next) = step(&here, over).and_then(|image| common(&image, &here)) else { break };
        let is_last = (0..N).all(|side| next[side].width() >= 0.99 * here[side].width());
        here = next;
        if is_last {
            break;
        }
    }
    here
}

fn is_inside<const N: usize>(one: &IntervalBox<N>, other: &IntervalBox<N>) -> bool {
    one.iter().zip(other).all(|(one, other)| one.is_inside(*other))
}

fn common<const N: usize>(one: &IntervalBox<N>, other: &IntervalBox<N>) -> Option<IntervalBox<N>> {
    let mut both = *one;
    for (side, other) in both.iter_mut().zip(other) {
        *side = side.common(*other)?;
    }
    Some(both)
}
