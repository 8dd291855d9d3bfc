//! Units of a table of lifts.

use super::units::LENGTHS;

/// Unit of the angles of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AngleUnit {
    /// Index in the names of the units.
    pub(super) index: usize,
    /// Degrees of the table in one turn of the cam: 720 for a crank's.
    pub(super) turn_deg: f64,
}

impl AngleUnit {
    pub(super) const DEGREES: Self = Self { index: 0, turn_deg: 360.0 };
    /// Names in a model file.
    pub(super) const NAMES: [&'static str; 4] = ["deg", "rad", "turn", "gon"];
    /// Degrees of a gon; a turn has 400 gon.
    const GON: f64 = 0.9;

    pub(super) fn name(self) -> &'static str {
        Self::NAMES[self.index]
    }

    /// Whether the table's numbers are degrees of the cam.
    pub(super) fn is_of_cam(self) -> bool {
        self == Self::DEGREES
    }

    /// Converts an angle as written to degrees of the cam.
    pub(super) fn degrees(self, angle: f64) -> f64 {
        let degrees = match self.index {
            0 => angle,
            1 => angle.to_degrees(),
            2 => 360.0 * angle,
            _ => Self::GON * angle,
        };
        if self.turn_deg == 360.0 { degrees } else { degrees * 360.0 / self.turn_deg }
    }

    /// Converts an angle, degrees of the cam, to the table's unit, with the digits that survive a conversion there and back.
    pub(super) fn told(self, angle_deg: f64) -> f64 {
        if self.is_of_cam() {
            return angle_deg;
        }
        let degrees = angle_deg * self.turn_deg / 360.0;
        let angle = match self.index {
            0 => degrees,
            1 => degrees.to_radians(),
            2 => degrees / 360.0,
            _ => degrees / Self::GON,
        };
        format!("{angle:.14e}").parse().unwrap_or(angle)
    }
}

/// Unit of lifts in a table: one of the units of length, or a decimal part of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LiftUnit {
    /// Index in the table of lengths.
    pub(super) index: usize,
    /// Decimal places: 2 for hundredths of the unit.
    pub(super) places: u32,
}

impl LiftUnit {
    /// Part of a unit of length, as a separate unit if it has a name: a thousandth of an inch is a thou.
    pub(super) fn part(index: usize, places: u32) -> Self {
        match LENGTHS.iter().position(|unit| unit.is_part_of(&LENGTHS[index], places)) {
            Some(index) => Self { index, places: 0 },
            None => Self { index, places },
        }
    }

    /// Name in a model file.
    pub(super) fn name(self) -> String {
        let unit = LENGTHS[self.index].name();
        if self.places == 0 { unit.to_owned() } else { format!("{} {unit}", decimal_part(self.places)) }
    }
}

/// Decimal part as a number: 0.01 for 2 places.
pub(super) fn decimal_part(places: u32) -> f64 {
    format!("1e-{places}").parse().unwrap_or(f64::NAN)
}
