//! Are all roots found, each once, and is a number over a box held with its derivatives, hardly wider than it is?
//!
//! Polynomials over binary fractions, whose values are doubles: what is said of them is exact but for the ulps that each operation
//! moves its ends out by.

use corner_impact::interval::Interval;
use corner_impact::interval::dual::Dual;
use corner_impact::interval::mean_value_form::MeanValueForm;
use corner_impact::interval::roots::{BoxValues, IntervalBox, Isolated, isolate};

/// Whether it is from `low` to `high`, or wider by some ulps of numbers as large as 100.
fn is_about(range: Interval, low: f64, high: f64) -> bool {
    const ROOM: f64 = 1e-12;
    (low - ROOM..=low).contains(&range.low()) && (high..=high + ROOM).contains(&range.high())
}

fn number(value: f64) -> Interval {
    value.into()
}

/// The unknowns of a box.
fn unknowns<const N: usize>(place: &IntervalBox<N>) -> [Dual<N>; N] {
    std::array::from_fn(|which| Dual {
        value: place[which],
        by: std::array::from_fn(|unknown| number(if unknown == which { 1.0 } else { 0.0 })),
    })
}

fn fixed<const N: usize>(value: f64) -> Dual<N> {
    Dual { value: number(value), by: [number(0.0); N] }
}

#[test]
fn a_number_over_a_box_has_its_derivatives() {
    let [x, y] = unknowns(&[Interval::new(1.0, 2.0), Interval::new(-1.0, 3.0)]);
    for (of, value, by) in [
        (x + y, [0.0, 5.0], [[1.0, 1.0], [1.0, 1.0]]),
        (x - y, [-2.0, 3.0], [[1.0, 1.0], [-1.0, -1.0]]),
        (-x, [-2.0, -1.0], [[-1.0, -1.0], [0.0, 0.0]]),
        (x * y, [-2.0, 6.0], [[-1.0, 3.0], [1.0, 2.0]]),
        (x * x * y, [-4.0, 12.0], [[-4.0, 12.0], [1.0, 4.0]]),
        (y * number(-4.0), [-12.0, 4.0], [[0.0, 0.0], [-4.0, -4.0]]),
        (Dual::of(Interval::new(5.0, 7.0), Interval::new(2.0, 3.0), y.by), [5.0, 7.0], [[0.0, 0.0], [2.0, 3.0]]),
    ] {
        assert!(is_about(of.value, value[0], value[1]), "{of:?} {value:?}");
        assert!(of.by.iter().zip(by).all(|(range, [low, high])| is_about(*range, low, high)), "{of:?} {by:?}");
    }
}

/// In mean value form: at the centre, and from there by the derivatives over the box, or what intervals say where that is less.
#[test]
fn a_number_over_a_box_is_near_its_centre() {
    let over = [Interval::new(-0.25, 0.5), Interval::new(-0.5, 0.5)];
    let x = MeanValueForm::unknown(0, number(4.0), &over);
    let y = MeanValueForm::unknown(1, number(2.0), &over);
    let two = x.fixed(number(2.0));
    for (of, centre, value, by) in [
        (x, 4.0, [3.75, 4.5], [[1.0, 1.0], [0.0, 0.0]]),
        (y, 2.0, [1.5, 2.5], [[0.0, 0.0], [1.0, 1.0]]),
        (two, 2.0, [2.0, 2.0], [[0.0, 0.0], [0.0, 0.0]]),
        (-x, -4.0, [-4.5, -3.75], [[-1.0, -1.0], [0.0, 0.0]]),
        (x + y, 6.0, [5.25, 7.0], [[1.0, 1.0], [1.0, 1.0]]),
        (x - y, 2.0, [1.25, 3.0], [[1.0, 1.0], [-1.0, -1.0]]),
        // Where it is wide intervals forget that both are one x.
        (x - x, 0.0, [0.0, 0.0], [[0.0, 0.0], [0.0, 0.0]]),
        (x + number(8.0), 12.0, [11.75, 12.5], [[1.0, 1.0], [0.0, 0.0]]),
        (x * number(-2.0), -8.0, [-9.0, -7.5], [[-2.0, -2.0], [0.0, 0.0]]),
        // 8 + [1.5, 2.5] [-0.25, 0.5] + [3.75, 4.5] [-0.5, 0.5], and [3.75, 4.5] [1.5, 2.5].
        (x * y, 8.0, [5.625, 11.25], [[1.5, 2.5], [3.75, 4.5]]),
        // 6 + 2 [7.5, 9] [-0.25, 0.5] above, by intervals below.
        (x * (x - two), 8.0, [6.5625, 11.25], [[5.5, 7.0], [0.0, 0.0]]),
        // 10 + 3 [-0.25, 0.5] above, 9.5 below, as it is known otherwise.
        (
            x.of(number(10.0), Interval::new(9.5, 20.0), Interval::new(2.0, 3.0)),
            10.0,
            [9.5, 11.5],
            [[2.0, 3.0], [0.0, 0.0]],
        ),
        (
            x.solved(number(1.0), Interval::EVERYTHING, [number(2.0), number(-4.0)]),
            1.0,
            [-1.5, 4.0],
            [[2.0, 2.0], [-4.0, -4.0]],
        ),
    ] {
        assert!(is_about(of.centre, centre, centre) && is_about(of.value(), value[0], value[1]), "{of:?} {value:?}");
        assert!(of.whole.by.iter().zip(by).all(|(range, [low, high])| is_about(*range, low, high)), "{of:?} {by:?}");
    }
}

fn over<const N: usize>(values: [Dual<N>; N]) -> BoxValues<N> {
    BoxValues { values: values.map(|value| value.value), derivatives: values.map(|value| value.by), is_wanted: true }
}

/// The product of x - r, all over a box.
fn with_roots(roots: &[f64], place: &IntervalBox<1>) -> BoxValues<1> {
    let [x] = unknowns(place);
    over([roots.iter().fold(fixed(1.0), |product, root| product * (x - fixed(*root)))])
}

fn holds<const N: usize>(place: &IntervalBox<N>, root: [f64; N]) -> bool {
    place.iter().zip(root).all(|(side, root)| side.low() <= root && root <= side.high())
}

/// Each root in a box of its own, a few ulps wide; how many boxes were looked at, and how often the equations were
/// asked, which is what it costs.
#[track_caller]
fn finds<const N: usize>(
    place: IntervalBox<N>,
    roots: &[[f64; N]],
    over: impl Fn(&IntervalBox<N>) -> BoxValues<N>,
) -> [usize; 2] {
    let asked = std::cell::Cell::new(0);
    let counted = |place: &IntervalBox<N>| {
        asked.set(asked.get() + 1);
        over(place)
    };
    let Isolated { roots: found, undecided, boxes } = isolate(place, 10_000, counted);
    assert!(undecided.is_empty() && found.len() == roots.len(), "{found:?} {undecided:?}");
    for root in roots {
        let held: Vec<_> = found.iter().filter(|place| holds(place, *root)).collect();
        assert!(held.len() == 1 && held[0].iter().all(|side| side.width() < 1e-13), "{root:?}: {found:?}");
    }
    [boxes, asked.get()]
}

#[test]
fn every_root_is_found_once() {
    let between = |low: f64, high: f64| [Interval::new(low, high)];
    for (roots, place, looks) in [
        (&[1.0][..], between(0.0, 4.0), [1, 8]),
        (&[0.5, 1.0, 1.5], between(-2.0, 2.0), [25, 160]),
        (&[-0.75, -0.5, 0.25, 1.375], between(-3.0, 5.0), [39, 211]),
        // Next to each other, and on the border.
        (&[1.0, 1.0 + 1.0 / 1024.0], between(0.0, 4.0), [40, 144]),
        (&[0.0, 1.0], between(0.0, 1.0), [5, 86]),
        (&[-1.0, 2.0], between(0.0, 1.0), [1, 1]),
    ] {
        let inside: Vec<[f64; 1]> = roots.iter().map(|root| [*root]).filter(|root| holds(&place, *root)).collect();
        assert_eq!(finds(place, &inside, |place| with_roots(roots, place)), looks, "{roots:?}");
    }
}

/// As a sum of powers, in which intervals forget that each is of one x: the mean value form tells more.
#[test]
fn a_sum_of_powers_has_the_same_roots() {
    let powers = |place: &IntervalBox<1>| {
        let [x] = unknowns(place);
        over([x * x * x - x * x * number(6.0) + x * number(11.0) - fixed(6.0)])
    };
    assert_eq!(finds([Interval::new(-8.0, 9.0)], &[[1.0], [2.0], [3.0]], powers), [64, 238]);
}

/// A circle and a line or a parabola, in boxes that are not square.
#[test]
fn every_root_of_two_equations_is_found_once() {
    let circle_and_line = |place: &IntervalBox<2>| {
        let [x, y] = unknowns(place);
        over([x * x + y * y - fixed(25.0), x * number(3.0) - y * number(4.0)])
    };
    let place = |x: f64, y: f64, width: f64, height: f64| [Interval::new(x, x + width), Interval::new(y, y + height)];
    for (place, roots, looks) in [
        (place(-8.0, -7.0, 16.0, 15.0), &[[4.0, 3.0], [-4.0, -3.0]][..], [23, 125]),
        (place(-8.0, -7.0, 200.0, 15.0), &[[4.0, 3.0], [-4.0, -3.0]], [119, 393]),
        (place(4.0, 3.0, 2.0, 100.0), &[[4.0, 3.0]], [9, 34]),
        (place(4.5, -3.0, 2.0, 100.0), &[], [33, 93]),
    ] {
        assert_eq!(finds(place, roots, circle_and_line), looks, "{place:?}");
    }
    let parabolas = |place: &IntervalBox<2>| {
        let [x, y] = unknowns(place);
        over([x * x - y, y * y - x])
    };
    assert_eq!(finds(place(-1.0, -1.0, 2.5, 2.5), &[[0.0, 0.0], [1.0, 1.0]], parabolas), [22, 135]);
}

/// A double root is nothing that halving would decide; all else is.
#[test]
fn a_double_root_is_left_undecided() {
    let place = [Interval::new(0.0, 3.0)];
    let found = isolate(place, 10_000, |place| with_roots(&[1.0, 1.0, 2.5], place));
    assert!(found.roots.len() == 1 && holds(&found.roots[0], [2.5]), "{found:?}");
    assert!(found.undecided.iter().any(|place| holds(place, [1.0])), "{found:?}");
    assert!(found.undecided.iter().all(|[side]| (side.middle() - 1.0).abs() < 1e-6), "{found:?}");
    assert_eq!([found.boxes, found.undecided.len()], [65, 1]);
    // Far from 0 no box is narrower than numbers are apart there.
    let (root, far) = (1e6 + 0.046875, [Interval::new(1e6, 1e6 + 0.125)]);
    let found = isolate(far, 10_000, |place| with_roots(&[root, root], place));
    assert!(found.roots.is_empty() && found.undecided.iter().any(|place| holds(place, [root])), "{found:?}");
    assert_eq!([found.boxes, found.undecided.len()], [79, 2]);
}

/// Where all values are 0 but for rounding no box is halved for ever.
#[test]
fn what_rounding_hides_is_not_halved() {
    let noise = Interval::new(-0.125, 0.125);
    let line = |value: f64, slope: f64| {
        move |place: &IntervalBox<1>| {
            let [x] = unknowns(place);
            let line = x * number(slope) + fixed(value);
            over([Dual { value: line.value + noise, ..line }])
        }
    };
    let found = isolate([Interval::new(-1.0, 1.0)], 10_000, line(0.0, 1e-6));
    assert!(found.roots.is_empty() && found.undecided.len() == 1 && found.boxes == 1, "{found:?}");
    // In the middle of the box it is not: where it may be is told.
    let found = isolate([Interval::new(-1.0, 1.0)], 10_000, line(0.15, 0.05));
    assert!(found.roots.is_empty() && found.undecided.iter().all(|[side]| side.high() < 0.0), "{found:?}");
    assert!(found.undecided.iter().any(|place| holds(place, [-1.0])), "{found:?}");
}

/// What is not wanted is not looked for, and nothing that was not looked at is lost.
#[test]
fn no_root_is_lost_when_boxes_run_out() {
    let roots = [-1.5, -0.5, 0.25, 0.75, 1.75];
    let place = [Interval::new(-2.0, 2.0)];
    let [needed, _] = finds(place, &roots.map(|root| [root]), |place| with_roots(&roots, place));
    for most in 0..=needed {
        let found = isolate(place, most, |place| with_roots(&roots, place));
        for root in roots {
            let held = found.roots.iter().chain(&found.undecided).filter(|place| holds(place, [root])).count();
            assert!(held > 0, "{root} is lost: {found:?}");
        }
        assert_eq!(found.undecided.is_empty(), most == needed, "{most}: {found:?}");
    }
    let right = |place: &IntervalBox<1>| BoxValues { is_wanted: place[0].high() > 0.0, ..with_roots(&roots, place) };
    let found = isolate(place, 10_000, right);
    assert!(found.roots.len() == 3 && found.undecided.is_empty(), "{found:?}");
}

/// The middle of two neighbouring doubles is one of them: a root that is the other is not lost.
#[test]
fn no_root_is_lost_between_two_doubles() {
    for root in [1.0, 1.0_f64.next_up(), -1.0, (-1.0_f64).next_up()] {
        for place in [Interval::new(root, root.next_up()), Interval::new(root.next_down(), root)] {
            let falls = |place: &IntervalBox<1>| over([-unknowns(place)[0] + fixed(root)]);
            for found in [isolate([place], 100, |place| with_roots(&[root], place)), isolate([place], 100, falls)] {
                assert!(
                    found.roots.iter().chain(&found.undecided).any(|place| holds(place, [root])),
                    "{place:?}: {found:?}"
                );
            }
        }
    }
}
