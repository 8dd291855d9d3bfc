//! Model as the page shows it: its numbers with ranges for sliders, its notes, and templates as starting points.

use corner_impact::cam::{Cam, Jet};
use corner_impact::model::{Dimension, FollowerContact, Model, ModelNumber, ModelTemplate, TEMPLATES, Unit};
use corner_impact::study::cam::CamSheet;
use corner_impact::study::design::contact::{Contact, Separation};
use corner_impact::study::design::known;
use corner_impact::study::speeds::usual_range;
use corner_impact::uncertainty::PlausibleMachines;
use serde::Serialize;

use crate::{ChangedModel, PageRefusal};

/// Model with its numbers.
#[derive(Serialize)]
pub struct ModelPage {
    name: String,
    source: String,
    file: String,
    /// Whole model file, with the changes.
    text: String,
    notes: Vec<String>,
    law: &'static str,
    contact: Option<&'static str>,
    laws: Vec<&'static str>,
    units: UnitNames,
    numbers: Vec<SliderNumber>,
    /// Lowest and highest speed of interest, rpm.
    speeds: [f64; 2],
    /// Range of speeds in which corner impacts are searched, rpm.
    study: Option<[f64; 2]>,
    separation: Option<SeparationFound>,
    corners: Vec<CornerFound>,
}

/// Names of the units of answers.
#[derive(Serialize)]
struct UnitNames {
    length: String,
    velocity: String,
    mass: String,
    force: String,
    stiffness: String,
    damping: String,
    /// Whether angles are in degrees.
    degrees: bool,
}

/// Number of the model with the range of its slider.
#[derive(Serialize)]
struct SliderNumber {
    path: String,
    name: String,
    symbol: &'static str,
    meaning: &'static str,
    unit: String,
    value: f64,
    /// Value in the text.
    given: f64,
    /// Standard deviation.
    error: Option<f64>,
    /// Allowed values in words.
    allowed: String,
    slider: [f64; 2],
    scale: &'static str,
}

/// Speed and cam angle at which the follower first leaves the cam.
#[derive(Serialize)]
struct SeparationFound {
    rpm: f64,
    error_rpm: Option<f64>,
    cam_angle_deg: f64,
}

/// Corner of the cam.
#[derive(Serialize)]
struct CornerFound {
    angle_deg: f64,
    order: usize,
    jump: f64,
}

impl ModelPage {
    /// Builds the page of a model; `given` is the model without changes.
    pub(crate) fn of(changed: &ChangedModel, given: &Model, model: &Model) -> Result<Self, PageRefusal> {
        let cam = Cam::new(model)?;
        let machines = PlausibleMachines::of(model, &cam)?;
        let (separation, errors) = known(Contact::new(&cam, model.follower).separation(), &machines);
        let sheet = CamSheet::new(model, &cam, Jet::HIGHEST_JUMP)?;
        let scales = Scales::of(model, &cam);
        let own: Vec<(&str, f64)> = given.numbers().collect();
        let numbers = model.numbers().filter_map(|(path, value)| {
            let number = ModelNumber::of(path)?;
            let was = own.iter().find(|(other, _)| *other == path).map_or(value, |(_, value)| *value);
            let (slider, scale) = scales.slider(number, was);
            Some(SliderNumber {
                path: path.to_owned(),
                name: path.rsplit('.').next().unwrap_or(path).to_owned(),
                symbol: number.symbol,
                meaning: number.meaning,
                unit: model.units.of_number(path),
                value,
                given: was,
                error: model.error_of(path),
                allowed: number.allowed(),
                slider,
                scale,
            })
        });
        Ok(Self {
            name: model.name.clone(),
            source: model.source.clone(),
            file: changed.file.clone().unwrap_or_else(|| given.file().to_owned()),
            text: model.text(),
            notes: sheet.doubts.iter().cloned().chain(model.doubt(None)?).collect(),
            law: sheet.law,
            contact: model.cam.contact().map(|contact| match contact {
                FollowerContact::Point => "point",
                FollowerContact::Flat => "flat",
                FollowerContact::Roller { .. } => "roller",
            }),
            laws: TEMPLATES.iter().map(|template| template.law).collect(),
            units: UnitNames::of(model),
            numbers: numbers.collect(),
            speeds: usual_range(model)?,
            study: model.study.map(|study| [study.rpm_min, study.rpm_max]),
            separation: match separation {
                Separation::At { rpm, cam_angle, .. } => Some(SeparationFound {
                    rpm,
                    error_rpm: errors.map(|[error, _]| error.total()).filter(|error| error.is_finite()),
                    cam_angle_deg: cam_angle.to_degrees(),
                }),
                _ => None,
            },
            corners: sheet
                .own_corners
                .iter()
                .map(|corner| CornerFound {
                    angle_deg: corner.angle.to_degrees(),
                    order: corner.jump_order,
                    jump: corner.jump,
                })
                .collect(),
        })
    }
}

impl UnitNames {
    fn of(model: &Model) -> Self {
        let units = &model.units;
        let name = |unit: &Unit| unit.name().to_owned();
        Self {
            length: name(&units.length),
            velocity: units.spelled("m/s"),
            mass: name(&units.mass),
            force: name(&units.force),
            stiffness: name(&units.stiffness),
            damping: name(&units.damping),
            degrees: units.degrees,
        }
    }
}

/// Sizes that determine the ranges of sliders, in the units of the file.
struct Scales {
    /// Difference between highest and lowest lift.
    stroke: f64,
    /// Critical damping, in the file's unit; 0 without a spring.
    critical: f64,
    /// Acceleration of gravity on Earth, in the file's unit.
    gravity: f64,
}

impl Scales {
    fn of(model: &Model, cam: &Cam) -> Self {
        const GROUND: f64 = 9.80665;
        let (follower, units) = (&model.follower, &model.units);
        Self {
            stroke: cam.top() - cam.lowest().value,
            critical: units.damping.told(2.0 * (follower.mass * follower.stiffness).sqrt()),
            gravity: GROUND / units.length.inside(1.0),
        }
    }

    /// Range and scale of the slider of a number with this value in the file. A number that cannot be negative has a range from a quarter
    /// to four times the value; another has one around the value, within the range of its kind.
    fn slider(&self, number: &ModelNumber, value: f64) -> ([f64; 2], &'static str) {
        const TIMES: f64 = 4.0;
        const DEGREES: f64 = 30.0;
        let around = |half: f64| ([number.nearest(value - half), number.nearest(value + half)], "linear");
        let from_zero = |most: f64| ([0.0, if most > 0.0 { most } else { 1.0 }], "linear");
        let size = value.abs();
        match number.dimension {
            Dimension::Pure if number.nearest(f64::INFINITY).is_finite() => {
                ([number.nearest(f64::NEG_INFINITY), number.nearest(f64::INFINITY)], "linear")
            }
            Dimension::Damping => from_zero((TIMES * size).max(0.5 * self.critical)),
            Dimension::Acceleration => around((2.0 * size).max(2.0 * self.gravity)),
            Dimension::Degrees => around(DEGREES),
            Dimension::Length if number.nearest(-1.0) < 0.0 => around((2.0 * self.stroke).max(size)),
            _ if value > 0.0 => ([value / TIMES, TIMES * value], "log"),
            Dimension::LengthPerPower => around((2.0 * size).max(self.stroke)),
            _ => from_zero(TIMES * size),
        }
    }
}

/// Model file as a starting point.
#[derive(Serialize)]
pub struct Template {
    text: String,
}

impl Template {
    /// Builds the file of a law.
    pub(crate) fn of(law: &str) -> Result<Self, PageRefusal> {
        let laws = || TEMPLATES.iter().map(|template| template.law).collect::<Vec<_>>().join(", ");
        let template = ModelTemplate::of(law);
        let template =
            template.ok_or_else(|| PageRefusal::of_words(format!("law \"{law}\": must be one of {}", laws())))?;
        Ok(Self { text: template.whole() })
    }
}
