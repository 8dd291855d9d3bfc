//! Do intervals hold what they say they hold, and are they no wider than they need be?
//!
//! A product, quotient or root is compared with the true one through the sign of a difference that is rounded once, sines and
//! cosines with sixty digits of mpmath, each as a double and what is left of it.

use corner_impact::cam::Cam;
use corner_impact::flight::{Flight, Response};
use corner_impact::interval::roots::falls_to_zero;
use corner_impact::interval::{Interval, Number};
use proptest::prelude::*;

use crate::common;

/// Angle, sine and cosine.
#[expect(clippy::approx_constant, reason = "doubles as they are, and not what they are near")]
const CIRCULAR: [(f64, [f64; 2], [f64; 2]); 18] = [
    (0.0, [0.0, 0.0], [1.0, 0.0]),
    (1e-09, [1e-09, -1.6666666666666669e-28], [1.0, -5e-19]),
    (0.1, [0.09983341664682815, 3.08001512929492e-18], [0.9950041652780258, -5.50210156918377e-17]),
    (0.7853981633974483, [0.7071067811865475, 4.1036934489363755e-17], [0.7071067811865476, -2.6687565161377232e-17]),
    (0.7853981633974484, [0.7071067811865476, 8.519254961036853e-18], [0.7071067811865475, 5.830114366949665e-18]),
    (1.0, [0.8414709848078965, 1.776845092935536e-18], [0.5403023058681398, -4.760954612604417e-17]),
    (1.5707963267948966, [1.0, -1.874699728327322e-33], [6.123233995736766e-17, -1.4973849048591698e-33]),
    (2.0, [0.9092974268256817, -1.4020906557816256e-17], [-0.4161468365471424, 1.990596398957495e-17]),
    (3.141592653589793, [1.2246467991473532e-16, -2.99476980971834e-33], [-1.0, 7.498798913309288e-33]),
    (3.141592653589794, [-7.657137397853899e-16, -2.7646673097874883e-32], [-1.0, 2.931587656480639e-31]),
    (4.0, [-0.7568024953079282, -4.892224089158451e-17], [-0.6536436208636119, 2.5846614087018284e-17]),
    (4.71238898038469, [-1.0, 1.6872297554945898e-32], [-1.8369701987210297e-16, -7.833796929500799e-33]),
    (6.283185307179586, [-2.4492935982947064e-16, 5.9895396194366814e-33], [1.0, -2.999519565323715e-32]),
    (-2.5, [-0.5984721441039565, 5.521403334082375e-17], [-0.8011436155469337, -1.8674742705085553e-17]),
    (22.0, [-0.008851309290403876, 2.8485303089220057e-19], [-0.9999608263946371, -8.51603380017413e-19]),
    (355.0, [-3.014435335948845e-05, 1.3012643991046347e-21], [-0.999999999545659, 1.0574612846643521e-17]),
    (1000.0, [0.8268795405320025, 3.867581909641312e-17], [0.5623790762907029, 5.1611423543848204e-17]),
    (123456.789, [-0.9986640823432246, 4.3073133377883266e-17], [0.05167253271870138, -6.512424953386242e-19]),
];

/// Whether a double and what is left of it lie in an interval: differences of doubles so close are exact.
fn holds(interval: Interval, [double, rest]: [f64; 2]) -> bool {
    (interval.low() - double) <= rest && rest <= (interval.high() - double)
}

#[test]
fn sine_and_cosine_are_held() {
    for (angle, sin, cos) in CIRCULAR {
        let (s, c) = Interval::from(angle).sin_cos();
        assert!(holds(s, sin) && holds(c, cos), "{angle}: {s:?}, {c:?}");
        let room = 4e-16 * angle.abs().max(4.0);
        assert!(s.width() <= room && c.width() <= room, "{angle}: {:e}, {:e}", s.width(), c.width());
    }
    let (s, c) = Interval::new(-0.5, 2.0).sin_cos();
    assert!(s.low() < -0.479 && s.high() == 1.0 && c.low() < -0.416 && c.high() == 1.0, "{s:?} {c:?}");
    assert!(Interval::new(1.0, 8.0).sin_cos().0.width() == 2.0);
}

/// Of lines `angle low high low high`, with the ends of sine and cosine, how many hold what 200 bits say, and of how many.
const BY_200_BITS: &str = "
import sys
from flint import arb, ctx
ctx.prec = 200
# No sine is beyond 1, which a ball about 1 does not say.
inside = lambda low, x, high: (low == -1 or arb(low) <= x) and (high == 1 or x <= arb(high))
held = count = 0
for line in sys.stdin:
    angle, *ends = map(float, line.split())
    sin, cos = arb(angle).sin_cos()
    count += 1
    held += bool(inside(ends[0], sin, ends[1]) and inside(ends[2], cos, ends[3]))
print(held, count)
";

/// 250 000 angles, spread over all sizes, and those where an eighth of a turn ends: some ulps about each.
pub fn many_angles() -> impl Iterator<Item = f64> {
    let spread = parts(225_000)
        .zip(parts(500_000).skip(250_000))
        .map(|(part, power)| (2.0 * part - 1.0) * 2.0_f64.powf(40.0 * power - 20.0));
    let ends = (0..5_000).flat_map(|step: i32| {
        let eighths = if step < 2_500 { f64::from(step) } else { f64::from(step) * 97.0 };
        let middle = eighths * std::f64::consts::FRAC_PI_4;
        [middle.next_down().next_down(), middle.next_down(), middle, middle.next_up(), -middle.next_up().next_up()]
    });
    let nasty = [0.0, f64::MIN_POSITIVE, 5e-324, 1e-300, 1e-9, 1e6, 1_570_796.0, 1_570_797.0, 1e15, 1e300, f64::MAX];
    spread.chain(ends).chain(nasty)
}

/// Sine and cosine are held at each of them.
#[test]
#[ignore = "slow"]
fn sine_and_cosine_of_many_angles_are_held() {
    let lines: String = many_angles()
        .map(|angle| {
            let (sin, cos) = Interval::from(angle).sin_cos();
            format!("{angle:?} {:?} {:?} {:?} {:?}\n", sin.low(), sin.high(), cos.low(), cos.high())
        })
        .collect();
    assert!(lines.lines().count() > 250_000 - 100);
    held(BY_200_BITS, &lines);
}

/// Asks a program of Python's how many lines hold what is true; all must.
#[track_caller]
pub fn held(by: &str, lines: &str) {
    use std::io::Write;
    let python = std::path::Path::new(common::ROOT).join(".venv/bin/python");
    let piped = std::process::Stdio::piped;
    let mut child = std::process::Command::new(python).args(["-c", by]).stdin(piped()).stdout(piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(lines.as_bytes()).unwrap();
    let said = common::text(child.wait_with_output().unwrap().stdout);
    let count = lines.lines().count();
    assert_eq!(said.trim(), format!("{count} {count}"));
}

/// The same of lines `operation a b c d low high`: ends of two ranges, and of what comes out. The true results are largest and smallest at
/// the ends of ranges, and where a sine turns. No sum of two doubles has more bits than these.
const OPERATIONS_EXACTLY: &str = "
import sys
from itertools import product
from flint import arb, ctx
operations = {'+': lambda x, y: x + y, '-': lambda x, y: x - y, '*': lambda x, y: x * y, '/': lambda x, y: x / y,
    'squared': lambda x, _: x * x, 'sqrt': lambda x, _: x.sqrt(), 'sin': lambda x, _: x.sin(), 'cos': lambda x, _: x.cos()}
held = count = 0
for line in sys.stdin:
    name, *numbers = line.split()
    a, b, c, d, low, high = map(float, numbers)
    ctx.prec = 2200 if name in '+-' else 300
    ends = [arb(a), arb(b)]
    if name == 'squared' and a < 0 < b:
        ends.append(arb(0))
    if name in ('sin', 'cos') and abs(b) < 1e9:
        quarter = arb.pi() / 2
        turns = range(int(a / 1.5707963267948966) - 1, min(int(b / 1.5707963267948966), int(a / 1.5707963267948966) + 6) + 2)
        ends += [quarter * turn for turn in turns if quarter * turn > arb(a) and quarter * turn < arb(b)]
    # Balls about -1 and 1, and about what is not beyond the largest double, do not say that they end there.
    beyond = 1 if name in ('sin', 'cos') else float('inf')
    low, high = (arb(end) if abs(end) < beyond else None for end in (low, high))
    results = [operations[name](x, y) for x, y in product(ends, [arb(c), arb(d)])]
    count += 1
    held += all((low is None or low <= x) and (high is None or x <= high) for x in results)
print(held, count)
";

/// Sums, products, quotients, squares, roots and circular functions of ranges of every size, from the smallest double to the largest.
#[test]
#[ignore = "slow"]
fn operations_on_ranges_are_held() {
    let every: Vec<f64> = parts(1_000_000).skip(7).step_by(7).collect();
    let number = |index: usize| match index % 23 {
        0 => [0.0, 5e-324, -5e-324, f64::MAX, f64::MIN, f64::MIN_POSITIVE, -1.0, 1e300][index / 23 % 8],
        // Half of them of one size, so that they cancel.
        turn => {
            let size =
                if turn < 12 { 2090.0 * every[index % 99_991] - 1070.0 } else { 8.0 * every[index % 99_989] - 4.0 };
            (2.0 * every[index % 99_971] - 1.0) * 2.0_f64.powf(size.min(1023.0))
        }
    };
    let range = |index: usize| {
        let (one, two) = (number(index), number(index + 1));
        // Points, ranges an ulp wide, ranges of any width.
        let two = [one, one.next_up(), two, one + one.abs() * every[index]][index % 4].clamp(f64::MIN, f64::MAX);
        Interval::new(one.min(two), one.max(two))
    };
    let mut lines = String::new();
    for index in 0..10_000 {
        let (x, y) = (range(2 * index), range(2 * index + 40_001));
        // Within the largest angle that is looked at.
        let angle = Interval::new(x.low().clamp(-1e6, 1e6), x.high().clamp(-1e6, 1e6));
        let (sin, cos) = angle.sin_cos();
        let root = Interval::new(x.low().abs().min(x.high().abs()), x.magnitude());
        let divides = !y.holds_zero();
        for (name, x, y, result, is_asked) in [
            ("+", x, y, x + y, true),
            ("-", x, y, x - y, true),
            ("*", x, y, x * y, true),
            ("/", x, y, x / y, divides),
            ("+", x, y.low().into(), x + y.low(), true),
            ("-", x, y.low().into(), x - y.low(), true),
            ("*", x, y.low().into(), x * y.low(), true),
            ("/", x, y.low().into(), x / y.low(), y.low() != 0.0),
            ("squared", x, x, x.squared(), true),
            ("sqrt", root, root, root.sqrt(), true),
            ("sin", angle, angle, sin, true),
            ("cos", angle, angle, cos, true),
        ] {
            let ends = [x.low(), x.high(), y.low(), y.high(), result.low(), result.high()];
            if is_asked {
                lines += &format!("{name} {}\n", ends.map(|end| format!("{end:?}")).join(" "));
            }
        }
    }
    held(OPERATIONS_EXACTLY, &lines);
}

/// A quotient is a product with a reciprocal, which is rounded first: one in a hundred needs room for both.
#[test]
fn a_quotient_is_held_whatever_its_reciprocal_is_rounded_to() {
    for (a, b) in parts(50_000).zip(parts(100_000).skip(50_000)) {
        let quotient = Interval::from(a) / Interval::from(b);
        assert!(
            quotient.low().mul_add(b, -a) <= 0.0 && quotient.high().mul_add(b, -a) >= 0.0,
            "{a} / {b}: {quotient:?}"
        );
    }
}

#[test]
fn what_is_no_number_says_nothing() {
    let (zero, all) = (Interval::new(-1.0, 1.0), Interval::EVERYTHING);
    for anything in [zero / zero, all - all, zero * all, Interval::from(-1.0).sqrt(), Interval::new(f64::NAN, 1.0)] {
        assert_eq!(anything, all);
    }
    assert!(!all.is_positive() && !all.is_negative() && all.holds_zero());
}

/// What is exactly 0 stays so: next to it there are only numbers that cost a processor a hundred times as much. What is too small for a
/// double is not 0.
#[test]
fn zero_is_kept_where_it_is_exact() {
    let [zero, one, tiny] = [0.0, 1.0, 1e-200].map(Interval::from);
    for exact in [zero * one, one * zero, zero / one, one - one, zero + zero, zero.sqrt(), zero.squared(), zero * tiny]
    {
        assert_eq!(exact, zero);
    }
    for lost in [tiny * tiny, tiny * -tiny, -tiny * tiny, tiny * Interval::new(-1e-200, 0.0), tiny.squared()] {
        assert!(lost != zero && lost.holds_zero() && lost.width() < 1e-300, "{lost:?}");
    }
    assert!((tiny * Interval::new(0.0, 1.0)).high() > 1e-200);
    // Where an ulp has no half, it is moved by whole ones.
    let least = Interval::from(f64::MIN_POSITIVE);
    for small in
        [least + least, least * Interval::from(0.7), least - Interval::from(3e-308), (-least) * Interval::from(0.7)]
    {
        assert!(small.low() < small.middle() && small.middle() < small.high(), "{small:?}");
    }
}

/// An end that is 0 because a product is too small for a double is moved past it, to whichever side; of what is 0 exactly none is.
#[test]
fn an_end_is_past_0_where_a_product_is_lost_and_only_there() {
    let [tiny, least] = [1e-200, 0.0_f64.next_up()];
    let over = Interval::new;
    for by in [over(tiny, tiny), over(tiny, 0.5)] {
        assert!((over(-tiny, 1.0) * by).low() < 0.0 && (over(-1.0, tiny) * by).high() > 0.0, "{by:?}");
    }
    assert!((over(-tiny, 1.0) * over(0.0, tiny)).low() < 0.0);
    assert_eq!(over(1.0, 2.0) * 0.0, over(0.0, 0.0));
    for (product, low, high) in [
        (over(-tiny, 1.0) * tiny, -least, tiny.next_up()),
        (over(-1.0, tiny) * tiny, (-tiny).next_down(), least),
        (over(-tiny, 1.0) / 1e200, -least, 1e-200_f64.next_up()),
    ] {
        assert_eq!([product.low(), product.high()], [low, high]);
    }
    for (one, other) in [(over(0.0, 1.0), over(1.0, 2.0)), (over(0.0, 0.5), over(tiny, 1.0))] {
        assert_eq!([(one * other).low(), (-one * other).high()], [0.0; 2]);
        for by in [other.high(), 2.0] {
            assert_eq!([(one * by).low(), (-one * by).high(), (one / by).low(), (-one / by).high()], [0.0; 4]);
        }
    }
}

/// Each end for itself: beside a large one a small one is moved as well.
#[test]
fn ends_are_moved_whatever_the_other_is() {
    for small in [1e-310, f64::MIN_POSITIVE, 1e-300, 1.0, 3.0, 1e300] {
        for (low, high) in [(-7.0, small), (-small, 7.0), (small.min(7.0), small.max(7.0))] {
            let moved = Interval::new(low, high) + Interval::from(0.0);
            assert_eq!([moved.low(), moved.high()], [low.next_down(), high.next_up()]);
        }
    }
}

/// What has no end on one side has a product with an end on the other, as long as nothing is 0 times infinity.
#[test]
fn products_of_half_lines_are_half_lines() {
    let upward = |low: f64| Interval::new(low, f64::INFINITY);
    for (product, low) in [
        (upward(1.0) * upward(1.0), 1.0_f64.next_down()),
        (Interval::new(1.0, 2.0) * upward(0.0), 0.0),
        (upward(0.0) * Interval::new(1.0, 2.0), 0.0),
        (upward(1.0) * Interval::new(2.0, 3.0), 2.0_f64.next_down()),
        (Interval::new(2.0, 3.0) * upward(1.0), 2.0_f64.next_down()),
    ] {
        assert_eq!([product.low(), product.high()], [low, f64::INFINITY]);
    }
}

/// What a formula leaves out counts in intervals, and not in doubles.
#[test]
fn what_is_left_out_is_on_both_sides() {
    assert_eq!(Interval::left_out(2.0), Interval::new(-2.0, 2.0));
    assert_eq!([f64::left_out(2.0), Number::magnitude(-2.0)], [0.0, 2.0]);
    assert_eq!([Interval::new(-3.0, 2.0), Interval::new(-2.0, 3.0)].map(Number::magnitude), [3.0; 2]);
}

/// Over more than a turn, or at angles that are too large to be told apart, sine and cosine are what they may be anywhere.
#[test]
fn sines_of_wide_ranges_are_all_there_are() {
    let all = Interval::new(-1.0, 1.0);
    for wide in [Interval::new(-4.0, 4.0), Interval::new(0.0, 1e9), Interval::EVERYTHING, 1e9.into()] {
        assert_eq!(wide.sin_cos(), (all, all), "{wide:?}");
    }
}

#[test]
fn an_end_belongs_to_an_interval() {
    let (below, above) = (Interval::new(-1.0, 0.0), Interval::new(0.0, 1.0));
    assert!(below.holds_zero() && above.holds_zero() && !below.is_negative() && !above.is_positive());
    assert!(!below.is_inside(Interval::new(-2.0, 0.0)) && !below.is_inside(Interval::new(-1.0, 1.0)));
    assert!(below.is_inside(Interval::new(-2.0, 1.0)));
}

/// Value and rate over a range of what falls at one rate up to a time, and at another from there on.
fn falls([before, after]: [f64; 2], bend: f64) -> impl Fn(Interval) -> [Interval; 2] {
    move |times: Interval| {
        let value = |time: f64| 1.0 - before * time.min(bend) - after * (time - bend).max(0.0);
        let rates =
            if times.high() < bend { [before; 2] } else { [if times.low() > bend { after } else { before }, after] };
        let rate = Interval::from(-rates[0]).hull((-rates[1]).into());
        [Interval::new(value(times.high()), value(times.low())), rate]
    }
}

#[test]
fn a_root_is_only_where_newton_s_method_holds_it() {
    // From the guess it seems to be at 0.1, and from there at 10: what lies between counts as well.
    let root = falls_to_zero(0.0, falls([10.0, 0.1], 0.05)).unwrap();
    assert!(root.low() < 5.05 && 5.05 < root.high(), "{root:?}");
    // e^-t is never 0, whatever is taken away from it.
    let decays = |times: Interval| [times.low(), times.high()].map(|time| (-time).exp());
    let falls_for_ever = |times: Interval| {
        let [most, least] = decays(times);
        [Interval::new(least, most), Interval::new(-most, -least)]
    };
    assert_eq!(falls_to_zero(0.0, falls_for_ever), None);
    assert_eq!(
        falls_to_zero(0.0, falls([1.0, -1.0], 2.0)).map(|root| root.low() < 1.0 && 1.0 < root.high()),
        Some(true)
    );
}

/// The root of 2 - t - t^3, from guesses on both sides: in how many looks, and how narrow.
#[test]
fn a_root_is_held_within_ulps() {
    let falls = |times: Interval| {
        let square = times.squared();
        [-(times * square) - times + 2.0, square * -3.0 - 1.0]
    };
    for (guess, looks, width) in [
        (1.0, 3, 8e-16),
        (1.0 + 1e-9, 3, 8e-16),
        (1.0 - 1e-9, 3, 8e-16),
        (1.1, 5, 0.0163),
        (0.9, 3, 0.0166),
        (1.4, 9, 1.84),
        (0.6, 3, 0.338),
    ] {
        let asked = std::cell::Cell::new(0);
        let counted = |times: Interval| {
            asked.set(asked.get() + 1);
            falls(times)
        };
        let root = falls_to_zero(guess, counted).unwrap();
        assert!(root.low() < 1.0 && 1.0 < root.high() && root.width() < width, "{guess}: {root:?}");
        assert_eq!(asked.get(), looks, "{guess}");
    }
}

fn double() -> impl Strategy<Value = f64> {
    (-1.0..1.0_f64, -30..30).prop_map(|(part, power)| part * 2.0_f64.powi(power))
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn operations_hold_the_true_result(a in double(), b in double()) {
        prop_assume!(a != 0.0 && b != 0.0 && a + b != 0.0);
        let (x, y) = (Interval::from(a), Interval::from(b));
        let product = x * y;
        prop_assert!(a.mul_add(b, -product.low()) >= 0.0 && a.mul_add(b, -product.high()) <= 0.0);
        let quotient = x / y;
        let side = |end: f64| end.mul_add(b, -a) * b.signum();
        prop_assert!(side(quotient.low()) <= 0.0 && side(quotient.high()) >= 0.0);
        let root = x.squared().sqrt();
        prop_assert!(root.low() <= a.abs() && a.abs() <= root.high());
        let root = Interval::from(a.abs()).sqrt();
        prop_assert!(root.low().mul_add(root.low(), -a.abs()) <= 0.0 && root.high().mul_add(root.high(), -a.abs()) >= 0.0);
        // What rounding takes from a sum is a double.
        let sum = a + b;
        let rest = if a.abs() > b.abs() { b - (sum - a) } else { a - (sum - b) };
        prop_assert!(holds(x + y, [sum, rest]) && holds(x - -y, [sum, rest]));
        // By a double instead of an interval of it.
        let (product, quotient) = (x * b, x / b);
        prop_assert!(a.mul_add(b, -product.low()) >= 0.0 && a.mul_add(b, -product.high()) <= 0.0);
        prop_assert!(side(quotient.low()) <= 0.0 && side(quotient.high()) >= 0.0);
        prop_assert!(holds(x + b, [sum, rest]) && holds(x - -b, [sum, rest]));
        let square = x.squared();
        prop_assert!(a.mul_add(a, -square.low()) >= 0.0 && a.mul_add(a, -square.high()) <= 0.0);
        for (interval, size) in [(product, a * b), (quotient, a / b), (x + y, a + b), (square, a * a)] {
            prop_assert!(interval.width() <= 1e-15 * size.abs() && interval.width() > 0.0, "{:?}", interval);
        }
    }

    #[test]
    fn an_operation_on_ranges_holds_that_on_their_numbers(ends in prop::array::uniform4(-3.0..3.0_f64), parts in prop::array::uniform2(0.0..1.0_f64)) {
        let [a, b, c, d] = ends;
        let (x, y) = (Interval::new(a.min(b), a.max(b)), Interval::new(c.min(d), c.max(d)));
        let within = |range: Interval, part: f64| Interval::from((range.low() + part * range.width()).clamp(range.low(), range.high()));
        let (p, q) = (within(x, parts[0]), within(y, parts[1]));
        let pairs = [
            (x + y, p + q), (x - y, p - q), (x * y, p * q), (x / y, p / q), (x.squared(), p.squared()),
            (x.sin_cos().0, p.sin_cos().0), (x.sin_cos().1, p.sin_cos().1),
        ];
        for (range, one) in pairs {
            prop_assert!(range == Interval::EVERYTHING || range.low() <= one.middle() && one.middle() <= range.high());
        }
    }
}

/// Numbers from 0 to 1 that are the same in every run.
pub fn parts(count: usize) -> impl Iterator<Item = f64> {
    (1..=count).map(|index| (index as f64 * 0.618_033_988_749_894_9).fract())
}

/// Lift, slope and curvature over ranges hold those at angles in them, for a law of every kind; and little else.
#[test]
fn every_law_stays_in_its_ranges() {
    let laws = ["contour", "harmonic", "polynomial", "program", "rectified-sine", "table-cubic", "table-quintic"];
    let files = laws.map(|law| format!("{}/models/laws/{law}.toml", common::ROOT));
    let files = files.iter().map(std::path::Path::new).map(common::read).chain([common::osorio()]);
    let mut kinds = std::collections::BTreeSet::new();
    for model in files {
        let cam = Cam::new(&model).unwrap();
        for segment in cam.segments() {
            kinds.insert(segment.law.name());
            for (start, width) in parts(40).zip(parts(1000).skip(333)) {
                let span = segment.end - segment.start;
                let low = segment.start + 0.9 * start * span;
                let angles = Interval::new(low, low + 0.1 * width * span);
                let over = segment.law.lift_over(angles);
                let ends = [angles.low(), angles.high()];
                for part in [0.0, 0.25, 0.5, 0.75, 1.0] {
                    let at = segment.law.lift((ends[0] + part * (ends[1] - ends[0])).min(ends[1]));
                    let pairs = [(over.value, at.value), (over.slope, at.slope), (over.curvature, at.curvature)];
                    for (range, value) in pairs {
                        // The value is rounded itself.
                        let room = 1e-13 * (at.value.abs() + at.slope.abs() + at.curvature.abs());
                        assert!(range.low() - room <= value && value <= range.high() + room, "{segment:?} {angles:?}");
                    }
                }
                // To first order the slope times the width; what more there is, is of second order.
                let [one, two] = ends.map(|end| segment.law.lift(end));
                let room = 10.0 * angles.width().powi(2) * over.curvature.magnitude() + 1e-13;
                assert!(
                    over.value.width() <= (one.slope.abs() + two.slope.abs()) * angles.width() + room,
                    "{segment:?}"
                );
            }
        }
    }
    assert_eq!(kinds.into_iter().collect::<Vec<_>>(), ["arc", "dwell", "harmonics", "polynomial", "sinusoid"]);
}

/// The lift of a whole cam over ranges of any turn, from segment to segment and across the end of a turn: it holds what every
/// segment has in them, on both sides of a corner, and hardly more; but for the curvature where the velocity jumps.
#[test]
fn every_cam_stays_in_its_ranges() {
    let files = ["osorio-2008", "laws/polynomial", "laws/program", "laws/rectified-sine"];
    for name in files {
        let model = common::read(std::path::Path::new(&format!("{}/models/{name}.toml", common::ROOT)));
        let cam = Cam::new(&model).unwrap();
        let sharp: Vec<usize> =
            cam.corners().iter().filter(|corner| corner.jump_order == 1).map(|corner| corner.segment).collect();
        assert_eq!(sharp.is_empty(), !name.ends_with("sine"), "{name}");
        let corners: Vec<f64> = cam.segments().iter().map(|segment| segment.start).collect();
        let mut passed = 0;
        for index in 0..600 {
            let turn = std::f64::consts::TAU * (f64::from(index % 7) - 3.0);
            let part = |number: f64| (f64::from(index + 1) * number.sqrt()).fract();
            let width = 2.0 * part(3.0).powi(4) + 1e-6;
            // Every other one is about a corner.
            let about = if index % 2 == 0 { 6.2 * part(2.0) } else { corners[index as usize / 2 % corners.len()] };
            let low = if index % 50 == 0 { turn } else { turn + about - width * part(5.0) };
            let angles = Interval::new(low, low + width);
            let over = cam.lift_over(angles, &sharp);
            // What each segment has where it and the range meet, in the turn before, in this one and in the next.
            let mut seen = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
            // A range that begins at a corner, to rounding, may pass it or not.
            let (mut is_sharp, mut begins_at) = (false, false);
            for from in [turn - std::f64::consts::TAU, turn, turn + std::f64::consts::TAU] {
                for (number, segment) in cam.segments().iter().enumerate() {
                    let begin = (angles.low() - from).max(segment.start);
                    let end = (angles.high() - from).min(segment.end);
                    if begin > end {
                        continue;
                    }
                    is_sharp |= sharp.contains(&number) && angles.low() < from + segment.start;
                    begins_at |= sharp.contains(&number) && (angles.low() - from - segment.start).abs() < 1e-12;
                    passed += u32::from(angles.low() < from + segment.start);
                    for step in 0..=40 {
                        let lift = segment.law.lift((begin + (end - begin) * f64::from(step) / 40.0).min(end));
                        for (seen, value) in seen.iter_mut().zip([lift.value, lift.slope, lift.curvature]) {
                            *seen = [seen[0].min(value), seen[1].max(value)];
                        }
                    }
                }
            }
            let case = format!("{name} {angles:?}: {over:?} {seen:?}");
            assert!(begins_at || (over.curvature == Interval::EVERYTHING) == is_sharp, "{case}");
            let size = 1.0 + seen[2][0].abs().max(seen[2][1].abs());
            for (range, [low, high]) in [over.value, over.slope, over.curvature].into_iter().zip(seen) {
                // An angle's own rounding, in the turn that it is counted by; and of second order what intervals take more.
                let room = 1e-12 * size;
                assert!(range.low() - room <= low && high <= range.high() + room, "{case}");
                let more = 3.0 * width * size + room;
                let is_tight = low - range.low() <= more && range.high() - high <= more;
                assert!(range == Interval::EVERYTHING || is_tight, "{case}");
            }
        }
        assert!(passed > 200, "{name}: {passed}");
    }
    let cam = Cam::new(&common::osorio()).unwrap();
    assert_eq!(cam.lift_over(Interval::new(-1.0, 6.0), &[]).value, Interval::EVERYTHING);
}

/// The responses over a range of times hold those at times in it, whatever the damping, and meet those in doubles.
#[test]
fn every_flight_stays_in_its_ranges() {
    for (stiffness, damping) in
        [(1430.8, 0.0), (1430.8, 5.0), (100.0, 20.0), (1430.8, 400.0), (0.0, 0.0), (0.0, 3.0), (1e-6, 0.0)]
    {
        let changes =
            [("mass", "1.0".into()), ("stiffness", format!("{stiffness:?}")), ("damping", format!("{damping:?}"))];
        let flight =
            Flight::new(&common::osorio_with(&changes.each_ref().map(|(name, value)| (*name, &value[..]))).follower);
        for (start, width) in parts(60).zip(parts(1000).skip(500)) {
            let times = Interval::new(0.3 * start, 0.3 * start + 0.05 * width * width);
            let over = flight.response_over(times);
            for part in [0.0, 0.3, 0.5, 0.9, 1.0] {
                let time = (times.low() + part * times.width()).min(times.high());
                let (at, one) = (flight.response(time), flight.response_over(time.into()));
                let of = |it: Response<Interval>| [it.step, it.impulse, it.impulse_rate];
                let doubles = [at.step, at.impulse, at.impulse_rate];
                for ((range, one), double) in of(over).into_iter().zip(of(one)).zip(doubles) {
                    let room = 1e-13 * (1.0 + double.abs());
                    assert!(
                        range.low() <= one.low() + room && one.high() - room <= range.high(),
                        "{flight:?} {times:?}"
                    );
                    assert!(
                        (one.middle() - double).abs() <= room && one.width() <= 10.0 * room,
                        "{one:?} {double} {flight:?} {time}"
                    );
                }
                let rate =
                    times.width() * (1.0 + flight.zeta() * times.width()) * (one.impulse.magnitude() + times.width());
                assert!(over.step.width() <= 20.0 * rate + 1e-13, "{flight:?} {times:?}: {:?}", over.step);
            }
        }
    }
}
