//! Parsers of numbers, speeds and axes, in all forms that a command accepts.
//!
//! | argument | form |
//! |---|---|
//! | a speed | `R` |
//! | a range of speeds | `LO:HI` |
//! | speeds | `LO:HI:N`, and `:log` after it for logarithmic spacing |
//! | an axis | `NAME=LO:HI`, with `:N` for the number of values |
//!
//! A command that does not accept a form names the form that it accepts.

use std::f64::consts::PI;
use std::ffi::OsString;
use std::path::Path;

use clap::CommandFactory;

use corner_impact::model;
use corner_impact::study::survey::{Spacing, Values, limits};
use corner_impact::untrusted;

pub(super) fn finite(text: &str) -> Result<f64, String> {
    model::finite(text, "")
}

/// Joins each unit to the word of the number before it: `--mass 0.12 kg` becomes `--mass "0.12 kg"`.
pub(super) fn with_units(words: impl IntoIterator<Item = OsString>) -> Vec<OsString> {
    /// Largest number of letters of a unit: `N/mm`.
    const LONGEST: usize = 4;
    let is_unit = |word: &str| {
        (1..=LONGEST).contains(&word.len())
            && word.chars().all(|letter| letter.is_alphabetic() || letter == '/')
            && super::Arguments::command().find_subcommand(word).is_none()
            && !Path::new(word).exists()
    };
    let is_number = |word: &str| {
        let (number, rest) = model::parted(word.rsplit('=').next().unwrap_or(word));
        !number.is_empty() && rest.is_empty()
    };
    let mut joined: Vec<OsString> = Vec::new();
    for word in words {
        let [.., option, number] = joined.as_mut_slice() else {
            joined.push(word);
            continue;
        };
        let is_option = option.to_string_lossy().starts_with("--") || number.to_string_lossy().starts_with("--");
        if is_option && word.to_str().is_some_and(is_unit) && number.to_str().is_some_and(is_number) {
            number.push(" ");
            number.push(word);
        } else {
            joined.push(word);
        }
    }
    joined
}

/// Parses an angle, rad: `1.57`, `1.57rad` or `90deg`.
pub(super) fn angle(text: &str) -> Result<f64, String> {
    match text.trim().strip_suffix("deg").or_else(|| text.trim().strip_suffix('\u{b0}')) {
        Some(degrees) => finite(degrees).map(f64::to_radians),
        None => model::finite(text, "rad").map_err(|words| match model::parted(text) {
            (number, unit) if !number.is_empty() && !unit.is_empty() && !unit.starts_with(',') => {
                format!("\"{}\" is not an angle: write {number}deg, or {number}rad", untrusted::value(text))
            }
            _ => words,
        }),
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

/// Parses a count.
pub(super) fn count(text: &str) -> Result<u64, String> {
    text.trim().parse().map_err(|_| format!("must be a whole number from 0 to {}, written in digits", u64::MAX))
}

/// Range with the number of values in it, if given, and their spacing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Span {
    pub(super) ends: [f64; 2],
    pub(super) count: Option<usize>,
    pub(super) spacing: Spacing,
}

impl Span {
    /// Returns the values; their number is `usual` if none is given.
    pub(super) fn values(self, usual: usize) -> Values {
        let [low, high] = self.ends;
        Values { low, high, count: self.count.unwrap_or(usual), spacing: self.spacing }
    }

    /// Returns the range for a command that chooses its own values.
    fn bare(self) -> Result<[f64; 2], String> {
        match (self.count, self.spacing) {
            (None, Spacing::Linear) => Ok(self.ends),
            _ => Err("has a number of values, but this command takes only a range: LO:HI".into()),
        }
    }
}

/// Parses `LO:HI`, `LO:HI:N`, `LO:HI:log` or `LO:HI:N:log` with numbers parsed by `number`; `what` names one of them in errors.
fn span(text: &str, number: fn(&str) -> Result<f64, String>, what: &str) -> Result<Span, String> {
    let parts: Vec<&str> = text.split(':').collect();
    let (low, high, count, spacing) = match parts.as_slice() {
        [low, high] => (low, high, None, None),
        [low, high, spacing] if spacing.trim() == "log" => (low, high, None, Some(spacing)),
        [low, high, count] => (low, high, Some(count), None),
        [low, high, count, spacing] => (low, high, Some(count), Some(spacing)),
        _ => {
            return Err(format!(
                "must be LO:HI, the lowest and highest {what}; after it may follow :N, their number, and :log, logarithmic spacing"
            ));
        }
    };
    let spacing = match spacing.map(|word| word.trim()) {
        None => Spacing::Linear,
        Some("log") => Spacing::Logarithmic,
        Some(other) => return Err(format!("\"{}\" is not a spacing: it can only be log", untrusted::value(other))),
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

/// Parses `LO:HI` with any numbers.
pub(super) fn range(text: &str) -> Result<[f64; 2], String> {
    if !text.contains(':') {
        return Err("must be LO:HI: the lowest and the highest value".into());
    }
    span(text, finite, "value")?.bare()
}

/// Parses a speed at which a simulation can run.
fn speed(text: &str) -> Result<f64, String> {
    let (number, unit) = model::parted(text);
    let in_rpm = match unit {
        "Hz" | "1/s" | "/s" | "rps" => 60.0,
        "rad/s" => 30.0 / PI,
        _ => return limits::speed(model::finite(text, "rpm")?),
    };
    let turns = in_rpm * number.parse::<f64>().unwrap_or(f64::NAN);
    Err(format!("\"{}\" is not in rpm: {turns} rpm, if that is the speed of the cam", untrusted::value(text)))
}

/// One speed, or several speeds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Speeds {
    One(f64),
    Span(Span),
}

/// Parses a speed, a range, or speeds.
pub(super) fn speeds(text: &str) -> Result<Speeds, String> {
    if text.contains(':') {
        return span(text, speed, "speed").map(Speeds::Span);
    }
    // Forms of a range in other programs and texts.
    let parts = ["..", " to ", "\u{2013}", "-", " "].iter().find_map(|between| text.trim().split_once(between));
    match parts.map(|(low, high)| (speed(low), speed(high))) {
        Some((Ok(low), Ok(high))) => Err(format!("a range has a colon: {low}:{high}")),
        _ => speed(text).map(Speeds::One),
    }
}

/// Parses one speed.
pub(super) fn rpm(text: &str) -> Result<f64, String> {
    match speeds(text)? {
        Speeds::One(rpm) => Ok(rpm),
        Speeds::Span(_) => {
            Err("is a range, but this command takes one speed: R; `speeds` and `diagram` take a range".into())
        }
    }
}

/// Parses a range of speeds.
pub(super) fn rpm_range(text: &str) -> Result<[f64; 2], String> {
    match speeds(text)? {
        Speeds::One(_) => {
            Err("is one speed, but this command takes a range: LO:HI; `simulate` and `orbit` take one speed".into())
        }
        Speeds::Span(span) => span.bare(),
    }
}

/// Parses a range of speeds; a single speed is both ends.
pub(super) fn rpm_or_range(text: &str) -> Result<[f64; 2], String> {
    match speeds(text)? {
        Speeds::One(rpm) => Ok([rpm; 2]),
        Speeds::Span(span) => span.bare(),
    }
}

/// Name of a number, and its range.
pub(super) type NamedSpan = (String, Span);

/// Parses an axis.
pub(super) fn axis(text: &str) -> Result<NamedSpan, String> {
    let Some((name, values)) = text.split_once('=') else {
        return Err(
            "must be NAME=LO:HI, a number with its lowest and highest value; after it may follow :N, the number of values, and :log"
                .into()
        );
    };
    let name = name.trim();
    let span = if name == "rpm" { span(values, speed, "speed") } else { span(values, finite, "value") };
    Ok((name.into(), span?))
}

/// Parses an axis of a command that chooses its own values.
pub(super) fn followed(text: &str) -> Result<(String, [f64; 2]), String> {
    if !text.contains(':') {
        return Err("must be NAME=LO:HI, a number with its lowest and highest value".into());
    }
    let (name, span) = axis(text)?;
    Ok((name, span.bare()?))
}
