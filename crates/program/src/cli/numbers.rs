//! Numbers, speeds and axes as they are typed, in every form that a command can use.
//!
//! | argument | form |
//! |---|---|
//! | a speed | `R` |
//! | a range of speeds | `LO:HI` |
//! | speeds | `LO:HI:N`, and `:log` behind it where they are spaced by their logarithm |
//! | an axis | `NAME=LO:HI`, and with `:N` how many values |
//!
//! A command that has no use for a form says which one it takes.

use corner_impact::model;
use corner_impact::study::survey::{Spacing, Values, limits};
use corner_impact::untrusted;

pub(super) fn finite(text: &str) -> Result<f64, String> {
    model::finite(text, "")
}

/// An angle, rad: `1.57`, `1.57rad` or `90deg`.
pub(super) fn angle(text: &str) -> Result<f64, String> {
    match text.trim().strip_suffix("deg").or_else(|| text.trim().strip_suffix('\u{b0}')) {
        Some(degrees) => finite(degrees).map(f64::to_radians),
        None => model::finite(text, "rad"),
    }
}

pub(super) fn positive(text: &str) -> Result<f64, String> {
    let number = finite(text)?;
    if number > 0.0 { Ok(number) } else { Err("must be a finite number above 0".into()) }
}

pub(super) fn not_negative(text: &str) -> Result<f64, String> {
    let number = finite(text)?;
    if number >= 0.0 { Ok(number) } else { Err("must be a finite number, 0 or more".into()) }
}

/// How many of something.
pub(super) fn count(text: &str) -> Result<u64, String> {
    text.trim().parse().map_err(|_| format!("must be a whole number from 0 to {}, written in digits", u64::MAX))
}

/// A range with the number of values in it, where that is written, and their spacing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Span {
    pub(super) ends: [f64; 2],
    pub(super) count: Option<usize>,
    pub(super) spacing: Spacing,
}

impl Span {
    /// The values, as many as are written or else `usual`.
    pub(super) fn values(self, usual: usize) -> Values {
        let [low, high] = self.ends;
        Values { low, high, count: self.count.unwrap_or(usual), spacing: self.spacing }
    }

    /// The range of a command that chooses its own values.
    fn bare(self) -> Result<[f64; 2], String> {
        match (self.count, self.spacing) {
            (None, Spacing::Linear) => Ok(self.ends),
            _ => Err("has a number of values, and this command takes a range alone: LO:HI".into()),
        }
    }
}

/// `LO:HI`, `LO:HI:N`, `LO:HI:log` or `LO:HI:N:log` of what `number` takes; `what` is the word for one.
fn span(text: &str, number: fn(&str) -> Result<f64, String>, what: &str) -> Result<Span, String> {
    let parts: Vec<&str> = text.split(':').collect();
    let (low, high, count, spacing) = match parts.as_slice() {
        [low, high] => (low, high, None, None),
        [low, high, spacing] if spacing.trim() == "log" => (low, high, None, Some(spacing)),
        [low, high, count] => (low, high, Some(count), None),
        [low, high, count, spacing] => (low, high, Some(count), Some(spacing)),
        _ => {
            return Err(format!(
                "must be LO:HI: lowest and highest {what}; then :N, how many, and :log for a logarithmic axis"
            ));
        }
    };
    let spacing = match spacing.map(|word| word.trim()) {
        None => Spacing::Linear,
        Some("log") => Spacing::Logarithmic,
        Some(other) => return Err(format!("\"{}\" is no spacing: it can only be log", untrusted::value(other))),
    };
    let ends = [number(low)?, number(high)?];
    let count = count.map(|count| {
        count.trim().parse().map_err(|_| format!("\"{}\" is not a number of {what}s", untrusted::value(count)))
    });
    let found = Span { ends, count: count.transpose()?, spacing };
    match found.count {
        Some(count) => found.values(count).checked(what).map(|_| found),
        None => {
            limits::range(ends)?;
            limits::spaced(ends[0], spacing)?;
            Ok(found)
        }
    }
}

/// `LO:HI`, any numbers.
pub(super) fn range(text: &str) -> Result<[f64; 2], String> {
    span(text, finite, "value")?.bare()
}

/// A speed that a simulation can turn at.
fn speed(text: &str) -> Result<f64, String> {
    limits::speed(model::finite(text, "rpm")?)
}

/// One speed, or several of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Speeds {
    One(f64),
    Span(Span),
}

/// A speed, a range, or speeds.
pub(super) fn speeds(text: &str) -> Result<Speeds, String> {
    if text.contains(':') { span(text, speed, "speed").map(Speeds::Span) } else { speed(text).map(Speeds::One) }
}

/// One speed.
pub(super) fn rpm(text: &str) -> Result<f64, String> {
    match speeds(text)? {
        Speeds::One(rpm) => Ok(rpm),
        Speeds::Span(_) => {
            Err("is a range, and this command takes one speed: R; `speeds` and `diagram` take a range".into())
        }
    }
}

/// A range of speeds.
pub(super) fn rpm_range(text: &str) -> Result<[f64; 2], String> {
    match speeds(text)? {
        Speeds::One(_) => {
            Err("is one speed, and this command takes a range: LO:HI; `simulate` and `orbit` take one speed".into())
        }
        Speeds::Span(span) => span.bare(),
    }
}

/// A range of speeds, or one speed as the range of itself.
pub(super) fn rpm_or_range(text: &str) -> Result<[f64; 2], String> {
    match speeds(text)? {
        Speeds::One(rpm) => Ok([rpm; 2]),
        Speeds::Span(span) => span.bare(),
    }
}

/// What varies, and over which values.
pub(super) type NamedSpan = (String, Span);

/// An axis.
pub(super) fn axis(text: &str) -> Result<NamedSpan, String> {
    let Some((name, values)) = text.split_once('=') else {
        return Err(
            "must be NAME=LO:HI: what changes, and from where to where; then :N, at how many values, and :log".into()
        );
    };
    let name = name.trim();
    let span = if name == "rpm" { span(values, speed, "speed") } else { span(values, finite, "value") };
    Ok((name.into(), span?))
}

/// An axis of a command that chooses its own values.
pub(super) fn followed(text: &str) -> Result<(String, [f64; 2]), String> {
    let (name, span) = axis(text)?;
    Ok((name, span.bare()?))
}
