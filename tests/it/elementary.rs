//! Are sine and exponential accurate, and are their bits, and those of a simulation, the same on every processor?

use corner_impact::elementary;

use crate::common::{PROGRAM, program, text};
use crate::interval::{held, many_angles, parts};

/// Reads lines `function x y result bound`; prints how many results are within the bound of the one of 200 bits, and how many lines there are.
const BY_200_BITS: &str = "
import sys
from flint import arb, ctx
ctx.prec = 200
true = {
    'sin': lambda x, y: x.sin(), 'cos': lambda x, y: x.cos(), 'exp': lambda x, y: x.exp(), 'exp_m1': lambda x, y: x.expm1(), 'exp2': lambda x, y: arb(2) ** x,
    'ln': lambda x, y: x.log(), 'ln_1p': lambda x, y: x.log1p(), 'atan2': arb.atan2, 'asin': lambda x, y: x.asin(),
    'powf': lambda x, y: x ** y, 'hypot': lambda x, y: (x * x + y * y).sqrt(), 'cbrt': lambda x, y: x.root(3) if x > 0 else -(-x).root(3),
    'sinh': lambda x, y: x.sinh(), 'cosh': lambda x, y: x.cosh(), 'log2': lambda x, y: x.log() / arb(2).log(),
    'log10': lambda x, y: x.log() / arb(10).log(),
}
near = count = 0
for line in sys.stdin:
    name, *numbers = line.split()
    x, y, result, bound = (arb(float(number)) for number in numbers)
    near += abs(true[name](x, y) - result) < bound
    count += 1
print(near, count)
";

type OfOne = fn(f64) -> f64;
type OfTwo = fn(f64, f64) -> f64;

/// Functions of one number, and how many ulps they may be off.
const OF_ONE: [(&str, OfOne, f64); 13] = [
    ("sin", elementary::sin, 1.0),
    ("cos", elementary::cos, 1.0),
    ("exp", elementary::exp, 1.0),
    ("exp2", elementary::exp2, 1.0),
    ("exp_m1", elementary::exp_m1, 1.0),
    ("ln", elementary::ln, 1.0),
    ("ln_1p", elementary::ln_1p, 1.0),
    ("asin", elementary::asin, 1.0),
    ("cbrt", elementary::cbrt, 1.0),
    ("sinh", elementary::sinh, 2.0),
    ("cosh", elementary::cosh, 2.0),
    ("log2", elementary::log2, 1.0),
    ("log10", elementary::log10, 1.0),
];
/// Functions of two.
const OF_TWO: [(&str, OfTwo, f64); 3] =
    [("atan2", elementary::atan2, 2.0), ("powf", elementary::powf, 1.0), ("hypot", elementary::hypot, 1.0)];

/// A line for `BY_200_BITS`, with a bound of so many ulps; none where the result is no normal double.
fn line(name: &str, x: f64, y: f64, result: f64, ulps: f64) -> Option<String> {
    let ulp = result.abs().next_up() - result.abs();
    result.is_normal().then(|| format!("{name} {x:?} {y:?} {result:?} {:?}\n", ulps * ulp))
}

/// A point of the function's domain, by two numbers from 0 to 1; points are spread over many sizes.
fn within(name: &str, part: f64, other: f64) -> (f64, f64) {
    let sized = |most: f64| (2.0 * part - 1.0) * 2.0_f64.powf(most * (2.0 * other - 1.0));
    match name {
        "exp" | "exp2" | "exp_m1" | "sinh" | "cosh" => (sized(9.0), 0.0),
        "ln" | "log2" | "log10" => (2.0_f64.powf(2000.0 * part - 1000.0), 0.0),
        "ln_1p" => (sized(30.0).max(-0.999_999), 0.0),
        "asin" => (2.0 * part - 1.0, 0.0),
        "powf" => (2.0_f64.powf(20.0 * part - 10.0), 40.0 * other - 20.0),
        "atan2" | "hypot" => (2.0 * part - 1.0, sized(20.0)),
        _ => (sized(20.0), 0.0),
    }
}

/// Sine and cosine of 250 000 angles, spread over all sizes and next to where an eighth of a turn ends.
#[test]
#[ignore = "slow"]
fn sine_and_cosine_are_within_an_ulp() {
    let lines: String = many_angles()
        .flat_map(|angle| {
            let (sin, cos) = elementary::sin_cos(angle);
            assert_eq!((sin, cos), (elementary::sin(angle), elementary::cos(angle)), "{angle:?}");
            [line("sin", angle, 0.0, sin, 1.0), line("cos", angle, 0.0, cos, 1.0)]
        })
        .flatten()
        .collect();
    assert!(lines.lines().count() > 490_000);
    held(BY_200_BITS, &lines);
}

/// The other functions, at 4000 points each: enough to see a wrong table or a wrong domain.
#[test]
fn elementary_functions_are_within_an_ulp() {
    const EACH: usize = 4000;
    let mut lines = String::new();
    for (part, other) in parts(EACH).zip(parts(2 * EACH).skip(EACH)) {
        for (name, function, ulps) in OF_ONE {
            let (x, _) = within(name, part, other);
            lines.extend(line(name, x, 0.0, function(x), ulps));
        }
        for (name, function, ulps) in OF_TWO {
            let (x, y) = within(name, part, other);
            lines.extend(line(name, x, y, function(x, y), ulps));
        }
    }
    assert!(lines.lines().count() > 15 * EACH);
    held(BY_200_BITS, &lines);
}

/// One number made of the bits of every function. It was computed on x86-64, and every processor must come to it.
#[test]
fn bits_are_those_of_every_processor() {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut take = |value: f64| hash = (hash ^ value.to_bits()).wrapping_mul(0x0000_0100_0000_01b3).rotate_left(23);
    // By sums and products alone, so that the numbers asked are the same everywhere.
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    for _ in 0..20_000 {
        let mut part = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let (x, y, large) = (20.0 * part() - 10.0, 8.0 * part() - 4.0, 1e6 * part());
        for (_, function, _) in OF_ONE {
            [x, part(), large].into_iter().for_each(|x| take(function(x)));
        }
        for (_, function, _) in OF_TWO {
            [(x, y), (large, y), (part(), x)].into_iter().for_each(|(x, y)| take(function(x, y)));
        }
    }
    assert_eq!(format!("{hash:016x}"), "8c1a2b2dcda30fbd");
}

/// With and without fused multiply-add in the C library, tables and pages are the same to the last byte.
///
/// The test says nothing where the C library is not glibc, or the processor has no fused multiply-add: both runs are then the same.
#[test]
#[ignore = "slow"]
fn fused_multiply_add_changes_no_byte() {
    const WITHOUT: &str = "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-AVX512F,-FMA_Usable,-FMA4_Usable,-AVX2_Usable";
    for words in [
        "simulate models/damped-heavy.toml --rpm 700 --revolutions 300 --events -",
        "simulate models/osorio-2008.toml --rpm 670 --revolutions 300 --lyapunov",
        "diagram models/ballistic.toml --rpm 400:700:4 --record 40 --out -",
        "diagram models/damped-heavy.toml --rpm 600:700:3 --one-row --out -",
        "chart models/damped-heavy.toml --x rpm=600:760:4 --y restitution=0.5:0.9:4 --out -",
        "speeds models/osorio-2008.toml --rpm 660:670 --step 10 --starts 2 --json",
    ] {
        let words: Vec<&str> = words.split_whitespace().collect();
        let [with, without] = [None, Some(WITHOUT)].map(|tunables| {
            let mut program = program(&words);
            program.env_remove("GLIBC_TUNABLES");
            if let Some(tunables) = tunables {
                program.env("GLIBC_TUNABLES", tunables);
            }
            let output = program.output().unwrap();
            assert!(output.status.success(), "{words:?}: {}", text(output.stderr));
            // But for the clock.
            text(output.stdout)
                .lines()
                .filter(|line| !line.ends_with(" ns a revolution"))
                .collect::<Vec<_>>()
                .join("\n")
        });
        assert!(with == without, "{words:?}");
        assert!(!with.is_empty());
    }
}

/// Powers of two by whole numbers are exact: sizes of boxes are rounded to them.
#[test]
fn whole_powers_of_two_are_exact() {
    for power in -1022..1024 {
        assert_eq!(elementary::exp2(f64::from(power)), 2.0_f64.powi(power), "{power}");
    }
}

/// nalgebra would multiply large matrices by kernels of the crate `matrixmultiply`, which asks the processor. No part of that crate is in the
/// program, whose symbols would name it as they name nalgebra.
#[test]
#[ignore = "slow"]
fn no_product_of_matrices_asks_the_processor() {
    let program = std::fs::read(PROGRAM).unwrap();
    let program = String::from_utf8_lossy(&program);
    assert!(program.contains("8nalgebra"));
    assert!(!program.contains("14matrixmultiply"));
}
