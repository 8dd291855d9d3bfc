//! Table of the numbers of a model file: path, symbol, meaning, dimension, allowed range and laws of each.
//!
//! A row determines limits, suggestions of names, units, axes of figures, reports, `explain`, and how a number of the follower is read. The
//! laws that use the number are separate: `docs/extending.md` lists them.

use std::borrow::Cow;
use std::fmt;

/// Range of finite numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Allowed {
    low: f64,
    low_is_allowed: bool,
    high: f64,
}

impl Allowed {
    pub(super) const POSITIVE: Self = Self { low: 0.0, low_is_allowed: false, high: f64::INFINITY };
    pub(super) const NOT_NEGATIVE: Self = Self { low: 0.0, low_is_allowed: true, high: f64::INFINITY };
    pub(super) const FINITE: Self = Self { low: f64::NEG_INFINITY, low_is_allowed: false, high: f64::INFINITY };

    pub(super) const fn between(low: f64, high: f64) -> Self {
        Self { low, low_is_allowed: true, high }
    }

    /// Builds the range above `low`, up to and including `high`.
    pub(super) const fn above(low: f64, high: f64) -> Self {
        Self { low, low_is_allowed: false, high }
    }

    pub(super) fn contains(self, number: f64) -> bool {
        let above = if self.low_is_allowed { number >= self.low } else { number > self.low };
        number.is_finite() && above && number <= self.high
    }

    /// Nearest number of the closed range.
    pub(super) fn nearest(self, number: f64) -> f64 {
        number.clamp(self.low, self.high)
    }
}

impl fmt::Display for Allowed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "must be a finite number")?;
        match (self.low.is_finite(), self.low_is_allowed, self.high.is_finite()) {
            (true, false, true) => write!(f, " above {}, up to {}", self.low, self.high),
            (true, true, true) => write!(f, " from {} to {}", self.low, self.high),
            (true, true, false) => write!(f, ", {} or more", self.low),
            (true, false, false) => write!(f, " above {}", self.low),
            _ => Ok(()),
        }
    }
}

/// Dimension of a number, which determines its unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[doc(hidden)]
pub enum Dimension {
    /// Number without a unit.
    Pure,
    Mass,
    Damping,
    Stiffness,
    Acceleration,
    Force,
    Length,
    /// Angle in degrees, as in names that end in `deg`.
    Degrees,
    /// Revolutions per minute.
    Speed,
    /// Length over a power of a radian: the power is the position in the list.
    LengthPerPower,
}

impl Dimension {
    /// Name of the SI unit; empty for a pure number.
    pub fn si(self) -> &'static str {
        match self {
            Self::Pure => "",
            Self::Mass => "kg",
            Self::Damping => "N s/m",
            Self::Stiffness => "N/m",
            Self::Acceleration => "m/s²",
            Self::Force => "N",
            Self::Length => "m",
            Self::Degrees => "deg",
            Self::Speed => "rpm",
            Self::LengthPerPower => "m/rad^place",
        }
    }
}

/// Number of the model file's format.
#[doc(hidden)]
pub struct ModelNumber {
    /// Path without positions in lists: `follower.mass`, `cam.segment.rise`.
    pub path: &'static str,
    /// Symbol in the paper; empty if it has none.
    pub symbol: &'static str,
    /// Meaning in words.
    pub meaning: &'static str,
    /// Dimension.
    pub dimension: Dimension,
    /// Allowed range.
    pub(super) allowed: Allowed,
    /// Laws of the cam that have the number; empty for a number of every model.
    pub laws: &'static [&'static str],
    /// Default value if the file leaves it out; `None` for a required number.
    pub(super) default: Option<f64>,
}

const fn number(
    path: &'static str,
    symbol: &'static str,
    meaning: &'static str,
    dimension: Dimension,
    allowed: Allowed,
    laws: &'static [&'static str],
) -> ModelNumber {
    ModelNumber { path, symbol, meaning, dimension, allowed, laws, default: None }
}

/// All numbers of the format, in the order of reports.
#[doc(hidden)]
#[rustfmt::skip]
pub static MODEL_NUMBERS: [ModelNumber; 29] = {
    use Dimension::*;
    const POSITIVE: Allowed = Allowed::POSITIVE;
    const NOT_NEGATIVE: Allowed = Allowed::NOT_NEGATIVE;
    const FINITE: Allowed = Allowed::FINITE;
    const HALF_A_TURN: Allowed = Allowed::between(0.0, 180.0);
    const A_TURN: Allowed = Allowed::between(0.0, 360.0);
    [
        number("follower.mass", "m", "mass of the follower", Mass, POSITIVE, &[]),
        number("follower.damping", "b", "damping", Damping, NOT_NEGATIVE, &[]),
        number("follower.stiffness", "k", "stiffness of the spring", Stiffness, NOT_NEGATIVE, &[]),
        number("follower.gravity", "g", "gravity", Acceleration, FINITE, &[]),
        number("follower.rest_position", "", "position where the spring is slack", Length, FINITE, &[]),
        number("follower.preload", "", "force of the spring at the lowest lift", Force, NOT_NEGATIVE, &[]),
        number("follower.restitution", "r", "coefficient of restitution", Pure, Allowed::between(0.0, 1.0), &[]),
        number("cam.base_radius", "ρ₀", "radius of the base circle", Length, POSITIVE, &["arcs"]),
        number("cam.flank_radius", "ρ₁", "radius of the flank", Length, POSITIVE, &["arcs"]),
        number("cam.nose_radius", "ρ₂", "radius of the nose", Length, POSITIVE, &["arcs"]),
        number("cam.flank_start_deg", "", "cam angle where the flank starts", Degrees, HALF_A_TURN, &["arcs"]),
        number("cam.nose_end_deg", "", "cam angle where the nose ends", Degrees, HALF_A_TURN, &["arcs"]),
        number("cam.contact.roller_radius", "", "radius of the roller", Length, POSITIVE, &["arcs", "contour"]),
        number("cam.contact.offset", "", "distance of the line of motion from the axis", Length, FINITE, &["arcs", "contour"]).or(0.0),
        number("cam.offset", "", "middle of the lift", Length, FINITE, &["harmonic", "rectified-sine"]),
        number("cam.amplitude", "", "amplitude of the lift", Length, FINITE, &["rectified-sine"]),
        number("cam.base", "", "lift at angle 0", Length, FINITE, &["program"]),
        number("cam.tolerance", "", "largest distance of a smoothing spline from a row", Pure, POSITIVE, &["table", "contour"]),
        number("cam.corner_rounding_deg", "", "angle over which corners are rounded", Degrees, A_TURN, &[]).or(0.0),
        number("cam.lever_ratio", "", "lift of the follower over lift at the cam", Pure, POSITIVE, &[]).or(1.0),
        number("cam.amplitudes", "", "amplitudes", Length, FINITE, &["harmonic"]),
        number("cam.phases_deg", "", "phases", Degrees, FINITE, &["harmonic"]),
        number("cam.segment.span_deg", "", "span", Degrees, Allowed::above(0.0, 360.0), &["program"]),
        number("cam.segment.rise", "", "rise", Length, FINITE, &["program"]),
        number("cam.segment.start_deg", "", "start", Degrees, A_TURN, &["polynomial"]),
        number("cam.segment.coefficients", "", "coefficients", LengthPerPower, FINITE, &["polynomial"]),
        number("study.rpm_min", "", "lowest speed of the search for a corner impact", Speed, POSITIVE, &[]),
        number("study.rpm_max", "", "highest speed of the search for a corner impact", Speed, POSITIVE, &[]),
        number("rpm", "", "speed of the cam", Speed, POSITIVE, &[]),
    ]
};

impl ModelNumber {
    /// Makes the number optional, with a default.
    const fn or(self, default: f64) -> Self {
        Self { default: Some(default), ..self }
    }

    /// Number at a path, for any positions in lists.
    pub fn of(path: &str) -> Option<&'static Self> {
        let plain = match path.contains('[') {
            true => path.split('[').map(|part| part.split_once(']').map_or(part, |(_, rest)| rest)).collect(),
            false => Cow::Borrowed(path),
        };
        MODEL_NUMBERS.iter().find(|number| number.path == plain)
    }

    /// Name in its table.
    pub fn name(&self) -> &'static str {
        self.path.rsplit('.').next().unwrap_or(self.path)
    }

    /// Names of the follower's numbers, which may have an error.
    pub(super) fn of_follower() -> impl Iterator<Item = &'static str> {
        MODEL_NUMBERS.iter().filter_map(|number| number.path.strip_prefix("follower."))
    }

    /// Error message about a number that cannot have an error.
    pub(super) fn without_error() -> String {
        let names: Vec<&str> = Self::of_follower().collect();
        format!(
            "must be a number without an error; only these numbers of [follower] may have one: {}",
            names.join(", ")
        )
    }

    /// Number of the closed allowed range that is nearest to another number.
    pub fn nearest(&self, number: f64) -> f64 {
        self.allowed.nearest(number)
    }

    /// Allowed range in words, for an error message.
    pub fn allowed(&self) -> String {
        self.allowed.to_string()
    }
}
