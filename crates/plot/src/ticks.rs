//! Ticks at 1, 2 or 5 times a power of ten, at the usual parts of a circle, or at powers of ten and their multiples.

use serde::Serialize;

/// Spacing of ticks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum TickSpacing {
    /// Multiples of 1, 2 or 5 times a power of ten.
    Decimal,
    /// Multiples of 15, 30, 45, 60, 90, … degrees; decimal below 10.
    Degrees,
    /// Powers of ten and their multiples, for data that are decimal logarithms.
    Logarithmic,
    /// No ticks, on an axis without numbers.
    Nothing,
}

/// Steps of degrees, from ten on.
const PARTS_OF_A_CIRCLE: [f64; 8] = [10.0, 15.0, 30.0, 45.0, 60.0, 90.0, 180.0, 360.0];

/// Tolerance for ticks outside the range, as a share of a step; it allows for rounding.
const ROUNDING: f64 = 1e-6;

/// Smallest number of labels of an axis: two do not show whether a scale is even.
pub const LEAST_LABELS: usize = 3;
/// Steps between 1 and 10 that are tried in turn if the usual steps give too few labels.
const CLOSER: [&[f64]; 3] = [&[1.0, 2.0, 5.0], &[2.5, 4.0], &[1.5, 3.0, 6.0, 8.0]];

/// Size above which values, or below [`SMALL`] all values, are shown with a power of ten beside the unit.
const LARGE: f64 = 1e5;
const SMALL: f64 = 1e-2;

/// Labelled position on an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// Position in the axis's unit.
    pub at: f64,
    /// Text of the label.
    pub label: String,
}

/// Ticks of one axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ticks {
    /// Ticks from low to high.
    pub ticks: Vec<Tick>,
    /// Power of ten by which labels are multiplied.
    pub exponent: i32,
}

/// Computes the finest ticks, at most `most`, whose labels do not touch by `fits`.
pub fn ticks(range: [f64; 2], spacing: TickSpacing, most: usize, fits: impl Fn(&[Tick]) -> bool) -> Ticks {
    let [low, high] = range;
    let span = high - low;
    if spacing == TickSpacing::Nothing || !(span > 0.0 && span.is_finite()) {
        return Ticks::default();
    }
    if spacing == TickSpacing::Logarithmic {
        return Ticks { ticks: powers([low, high], most.max(2), fits), exponent: 0 };
    }
    let exponent = exponent(low.abs().max(high.abs()));
    let (most, mut step) = (most.max(2) as f64, first_step(span / most.max(2) as f64, spacing));
    loop {
        let ticks = multiples(low, high, step, exponent);
        // A step above twice the span gives at most one tick, so no labels can overlap.
        if (ticks.len() as f64 <= most && fits(&ticks)) || step > 2.0 * span {
            return Ticks { ticks, exponent };
        }
        step = next_step(step, spacing);
    }
}

/// Computes the [`ticks`] of an axis with at least [`LEAST_LABELS`] labels, if it has room for them. If the usual ticks are fewer, the
/// coarsest sufficient ticks are used whose labels do not touch by `closer`.
pub fn enough_ticks(
    range: [f64; 2],
    spacing: TickSpacing,
    most: usize,
    fits: impl Fn(&[Tick]) -> bool,
    closer: impl Fn(&[Tick]) -> bool,
) -> Ticks {
    let few = ticks(range, spacing, most, fits);
    if few.ticks.len() >= LEAST_LABELS || spacing == TickSpacing::Nothing {
        return few;
    }
    let is_logarithmic = spacing == TickSpacing::Logarithmic;
    if is_logarithmic {
        let mut ticks: Vec<Tick> = Vec::new();
        for tick in multiples_of_powers(range, &[1, 2, 3, 4, 5, 6, 7, 8, 9], 1) {
            let is_apart = ticks.last().is_none_or(|last| closer(&[last.clone(), tick.clone()]));
            ticks.extend(is_apart.then_some(tick));
        }
        if ticks.len() >= LEAST_LABELS {
            return Ticks { ticks, exponent: 0 };
        }
    }
    let [low, high] = if is_logarithmic { range.map(|end| libm::pow(10.0, end)) } else { range };
    let span = high - low;
    if !(span > 0.0 && span.is_finite()) {
        return few;
    }
    let power = libm::log10(span).floor() as i32;
    let exponent = exponent(low.abs().max(high.abs()));
    let parts = |spacing| if spacing == TickSpacing::Degrees { &PARTS_OF_A_CIRCLE[..] } else { &[] };
    let circle = parts(spacing).iter().rev().copied();
    let decimal = CLOSER.iter().flat_map(|steps| {
        let of = move |power: i32| steps.iter().rev().map(move |step| step * libm::pow(10.0, f64::from(power)));
        (power - 2..=power).rev().flat_map(of)
    });
    let place = |tick: Tick| Tick { at: if is_logarithmic { libm::log10(tick.at) } else { tick.at }, ..tick };
    let at = |step: f64| multiples(low, high, step, exponent).into_iter().map(place).collect::<Vec<_>>();
    let found = circle.chain(decimal).map(at).find(|ticks| ticks.len() >= LEAST_LABELS && closer(ticks));
    found.map_or(few, |ticks| Ticks { ticks, exponent })
}

/// Multiples of every n-th power of ten (`every`), in a range of exponents.
fn multiples_of_powers([low, high]: [f64; 2], multiples: &[i32], every: usize) -> Vec<Tick> {
    /// Exponents of powers of ten that are written in full.
    const PLAIN: std::ops::Range<i32> = -4..5;
    let decades = (low.floor() as i32)..=(high.ceil() as i32);
    let label = |digit: i32, power: i32| match digit {
        _ if PLAIN.contains(&power) => format!("{}", f64::from(digit) * 10_f64.powi(power)),
        1 => unit("", power),
        digit => format!("{digit}·{}", unit("", power)),
    };
    let powers = decades.filter(|power| power.rem_euclid(every as i32) == 0);
    let all = powers.flat_map(|power| multiples.iter().map(move |digit| (*digit, power)));
    let place = |(digit, power): (i32, i32)| f64::from(power) + libm::log10(f64::from(digit));
    let inside = all.filter(|of| (low - ROUNDING..=high + ROUNDING).contains(&place(*of)));
    inside.map(|of| Tick { at: place(of).clamp(low, high), label: label(of.0, of.1) }).collect()
}

/// Finest powers of ten and their multiples that fit, in a range of exponents.
fn powers([low, high]: [f64; 2], most: usize, fits: impl Fn(&[Tick]) -> bool) -> Vec<Tick> {
    const MULTIPLES: [&[i32]; 3] = [&[1, 2, 3, 4, 5, 6, 7, 8, 9], &[1, 2, 5], &[1]];
    let decades = (high.ceil() - low.floor()) as usize + 1;
    let finest = MULTIPLES.iter().map(|multiples| multiples_of_powers([low, high], multiples, 1));
    let coarser = (2..=decades.max(2)).map(|every| multiples_of_powers([low, high], &[1], every));
    finest.chain(coarser).find(|ticks| ticks.len() <= most && fits(ticks)).unwrap_or_default()
}

fn exponent(largest: f64) -> i32 {
    let plain = (SMALL..LARGE).contains(&largest) || largest == 0.0;
    if plain { 0 } else { (libm::log10(largest) / 3.0).floor() as i32 * 3 }
}

fn first_step(least: f64, spacing: TickSpacing) -> f64 {
    let power = libm::pow(10_f64, libm::log10(least).floor());
    let decimal = [1.0, 2.0, 5.0, 10.0].into_iter().map(|part| part * power).find(|step| *step >= least);
    let step = decimal.unwrap_or(10.0 * power);
    match spacing {
        TickSpacing::Degrees if step >= 10.0 => {
            let part = PARTS_OF_A_CIRCLE.into_iter().find(|part| *part >= least);
            part.unwrap_or_else(|| 360.0 * first_step(least / 360.0, TickSpacing::Decimal))
        }
        _ => step,
    }
}

fn next_step(step: f64, spacing: TickSpacing) -> f64 {
    // Slightly above the step, to find the next one of the series.
    first_step(step * 1.01, spacing)
}

fn multiples(low: f64, high: f64, step: f64, exponent: i32) -> Vec<Tick> {
    let (first, last) = ((low / step - ROUNDING).ceil(), (high / step + ROUNDING).floor());
    let count = (last - first + 1.0).clamp(0.0, 1000.0) as usize;
    let scale = 10_f64.powi(exponent);
    let places = decimals(step / scale);
    let tick = |index: usize| {
        let at = (first + index as f64) * step;
        let text = format!("{:.places$}", at / scale);
        let zero = text.chars().all(|letter| "-0.".contains(letter));
        let label = if zero { text.replace('-', "") } else { text.replace('-', "−") };
        Tick { at: at.clamp(low, high), label }
    };
    (0..count).map(tick).collect()
}

/// Number of decimals that show a step of one or two digits, or of whole degrees.
fn decimals(step: f64) -> usize {
    let first = (-(libm::log10(step) + ROUNDING).floor()).clamp(0.0, 17.0) as usize;
    let shown = step * libm::pow(10.0, first as f64);
    if step < 10.0 && (shown - libm::round(shown)).abs() > ROUNDING { first + 1 } else { first }
}

/// Text in brackets beside an axis name: ten with `exponent` in raised digits, and the unit.
pub fn unit(unit: &str, exponent: i32) -> String {
    if exponent == 0 {
        return unit.to_owned();
    }
    let digits = exponent.to_string();
    let raised = digits.chars().map(|letter| match letter {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => digit.to_digit(10).and_then(|digit| char::from_u32(0x2070 + digit)).unwrap_or(digit),
    });
    let power: String = "10".chars().chain(raised).collect();
    if unit.is_empty() { power } else { format!("{power} {unit}") }
}
