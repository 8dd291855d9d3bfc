//! A checked model file: follower, cam profile, and the speed range to search.
//!
//! The numbers of a [`Model`] passed the checks of a single field. Errors that need geometry (circles that cannot touch) are found in
//! [`crate::cam`], which reports them through [`Model::reject`]. So every error about a file names file, line, field and value.

mod above;
mod changed;
mod complaint;
mod document;
mod doubts;
mod exact;
mod fields;
mod follower_errors;
mod heading;
mod lines;
mod nearest;
mod numeral;
mod points;
mod profile;
mod quantity;
mod rows;
mod table;
mod table_fields;
mod table_file;
mod table_profile;
mod table_units;
mod template;
mod text;
mod toml;
mod turn;
mod units;

use std::path::Path;

use serde::de::value::{Error as Unread, MapDeserializer};
use serde::{Deserialize, Serialize};

pub use complaint::ModelError;
use fields::Fields;
pub use follower_errors::FollowerErrors;
pub(crate) use follower_errors::Moves;
pub use lines::{Holds, Separator};
pub use nearest::nearest;
pub use numeral::{Numeral, finite, parted};
pub(crate) use profile::{
    ArcsProfile, MOST_COEFFICIENTS, MotionSegment, PolynomialSegment, ProgramProfile, RectifiedSineProfile,
};
pub use profile::{CONTACTS, CORNER_ROUNDING, LEVER_RATIO};
pub use profile::{CamProfile, ContourProfile, FollowerContact, HarmonicProfile, ProfileChange, StandardMotion};
#[doc(hidden)]
pub use quantity::{Dimension, MODEL_NUMBERS, ModelNumber};
pub use rows::TableLayout;
pub(crate) use rows::TableRow;
pub use table::Reading;
pub use table::{MOST_PROVED_ROWS, Smoothing, SmoothingTolerance, Spline, TableProfile};
#[doc(hidden)]
pub use template::{ModelTemplate, TEMPLATE_NAME, TEMPLATES};
pub use units::{Converted, Unit, Units};

/// Model with the numbers that the paper prints, built in so that the binary needs no other file.
pub const OSORIO_2008: &str = include_str!("../../models/osorio-2008.toml");

/// A cam-follower system as described by a model file.
#[derive(Clone, Debug)]
pub struct Model {
    /// Label for headings, without influence on results.
    pub name: String,
    /// Source of the numbers, in the author's words.
    pub source: String,
    /// Follower: the moving body and its spring.
    pub follower: Follower,
    /// Cam profile as written.
    pub cam: CamProfile,
    /// Range of speeds that is searched for corner impacts.
    pub study: Option<Study>,
    /// Units of the model file's numbers and of the results.
    pub units: Units,
    /// Spring force on the base circle, in internal units; `None` if the file gives `rest_position` instead.
    pub preload: Option<f64>,
    /// Standard deviations of the follower's numbers.
    pub errors: FollowerErrors,
    /// Shifts of the follower's numbers from the file's values, as multiples of their standard deviations.
    pub(crate) moves: Moves,
    fields: Fields,
    changes: Vec<(String, f64)>,
}

/// Follower that obeys `m q'' + b q' + k (q - rest_position) = -m g` while `q > c(theta)`, and Newton's law of restitution at impacts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Follower {
    /// Mass m, kg, positive.
    pub mass: f64,
    /// Damping b, N s/m, zero or more.
    pub damping: f64,
    /// Stiffness k, N/m, zero or more; zero is a ballistic follower.
    pub stiffness: f64,
    /// Gravity g, m/s^2.
    pub gravity: f64,
    /// Position at which the spring is slack, m, in the cam's coordinates.
    pub rest_position: f64,
    /// Coefficient of restitution r, 0 (plastic) to 1 (elastic).
    pub restitution: f64,
}

impl Follower {
    /// Reads the follower's numbers, and the preload if the file gives it instead of the rest position.
    fn read(fields: &mut Fields, units: &Units) -> Result<(Self, Option<f64>), ModelError> {
        for name in FollowerErrors::names() {
            fields.part_error(&format!("follower.{name}"))?;
        }
        fields.may_hold("follower.preload");
        let is_preloaded = fields.has("follower.preload");
        let (mut numbers, mut preload) = (Vec::new(), None);
        for name in MODEL_NUMBERS.iter().filter_map(|number| number.path.strip_prefix("follower.")) {
            match name {
                "preload" if is_preloaded => preload = Some(units.number(fields, name)?),
                "preload" => {}
                // The rest position follows from the cam's lowest lift, which is not available here.
                "rest_position" if is_preloaded => {
                    fields.may_hold("follower.rest_position");
                    numbers.push((name, f64::NAN));
                }
                _ => numbers.push((
                    name,
                    units.number(fields, name).map_err(|error| match name {
                        "rest_position" if !fields.has("follower.rest_position") => {
                            error.found("; or give follower.preload, the force of the spring where the lift is lowest")
                        }
                        _ => error,
                    })?,
                )),
            }
        }
        let follower = Self::deserialize(MapDeserializer::<_, Unread>::new(numbers.into_iter()))
            .map_err(|error| fields.reject("follower", error.to_string()))?;
        let words = if preload.is_none() {
            None
        } else if fields.has("follower.rest_position") {
            Some("must not be given together with follower.rest_position: give one of them")
        } else if follower.stiffness == 0.0 {
            Some("needs a spring: follower.stiffness is 0")
        } else {
            None
        };
        words.map_or(Ok((follower, preload)), |words| Err(fields.reject("follower.preload", words)))
    }
}

/// Range of speeds that is searched for corner impacts, rpm.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Study {
    /// Lowest speed, positive.
    pub rpm_min: f64,
    /// Highest speed, above `rpm_min`.
    pub rpm_max: f64,
}

impl Model {
    /// Name of the built-in model in error messages, in place of a file name.
    pub(crate) const BUILT_IN: &str = "the built-in model";

    /// Parses and checks the text of a model file, except for checks that need the cam; errors name the file as `file`.
    pub(crate) fn written(file: &str, text: &str) -> Result<Self, ModelError> {
        Self::from_fields(Fields::parse(file, text)?)
    }

    /// Checks the text of a model file like [`Self::written`], and rejects a text that names a table, because no other file is read.
    pub(crate) fn written_alone(file: &str, text: &str) -> Result<Self, ModelError> {
        let fields = Fields::parse(file, text)?;
        if fields.has("cam.file") {
            return Err(
                fields.reject("cam.file", "names another file, which is not read here: write its rows as cam.rows")
            );
        }
        Self::from_fields(fields)
    }

    /// Checks a document with the fields of a model file, except for checks that need the cam; errors call it `name`.
    pub(crate) fn written_as(name: &str, document: &serde_json::Value) -> Result<Self, ModelError> {
        Self::from_fields(Fields::of_document(name, document)?)
    }

    fn from_fields(mut fields: Fields) -> Result<Self, ModelError> {
        let name = fields.text_or("name", "unnamed")?;
        let source = fields.text_or("source", "")?;
        let units = Units::read(&mut fields)?;
        let (follower, preload) = Follower::read(&mut fields, &units)?;
        let errors = FollowerErrors::read(&mut fields, &units)?;
        let cam = profile::read(&mut fields)?;
        fields.may_hold("study.rpm_min");
        let study = if fields.has("study") {
            let rpm_min = fields.number("study.rpm_min")?;
            let rpm_max = fields.number("study.rpm_max")?;
            if rpm_max <= rpm_min {
                return Err(fields.reject("study.rpm_max", format!("must be above study.rpm_min = {rpm_min}")));
            }
            Some(Study { rpm_min, rpm_max })
        } else {
            None
        };
        fields.finish()?;
        errors.check(&mut fields)?;
        let (moves, changes) = (Moves::default(), Vec::new());
        Ok(Self { name, source, follower, cam, study, units, preload, errors, moves, fields, changes })
    }

    /// Numeric fields that shape the motion, by dotted path, with their values. A study may vary these numbers.
    pub fn numbers(&self) -> impl Iterator<Item = (&str, f64)> {
        self.fields.numbers_in(&["follower", "cam"])
    }

    /// Standard deviation of the number at a dotted path, in its unit in the file; `None` for an exact number.
    pub fn error_of(&self, path: &str) -> Option<f64> {
        self.fields.error_at(path)
    }

    /// Range `[study]`, or an error if it is missing.
    pub fn study(&self) -> Result<Study, ModelError> {
        self.study.ok_or_else(|| {
            self.reject("study.rpm_min", "is missing: [study] gives the speeds at which to search for the corner impact; `locate --rpm LO:HI` and `certify --rpm LO:HI` search at any speeds")
        })
    }

    /// Table of lifts, or of radii of a contour, that gives the cam its profile, if any.
    pub fn table(&self) -> Option<&TableProfile> {
        match self.cam.plain() {
            CamProfile::Table(table) | CamProfile::Contour(ContourProfile { table, .. }) => Some(table),
            _ => None,
        }
    }

    /// Whether the cam is a smoothing spline near the rows of a table.
    pub(crate) fn is_smoothed(&self) -> bool {
        self.table().is_some_and(|table| table.spline.smoothing().is_some())
    }

    /// Builds an error about `field` in a later stage; `allowed` names the accepted values.
    pub fn reject(&self, field: &str, allowed: impl Into<String>) -> ModelError {
        self.fields.reject(field, allowed)
    }

    /// Path of the model file, to pass to commands for this model; `None` for the built-in model.
    pub fn path(&self) -> Option<&Path> {
        (self.file() != Self::BUILT_IN).then(|| Path::new(self.file()))
    }

    /// Name of the file from which the model was read.
    pub fn file(&self) -> &str {
        self.fields.file()
    }
}
