//! Table `[cam]`: one entry for each lift law, with its fields.

use serde::{Serialize, Serializer};

use super::ModelError;
use super::fields::Fields;
use super::table::TableProfile;
use super::table_file;
use crate::tolerance;

/// Lift law of a `[cam]` table.
#[derive(Clone, Debug, PartialEq)]
pub enum CamProfile {
    /// Base, flank and nose circles of Appendix A of the paper.
    Arcs(ArcsProfile),
    /// Sum of cosines.
    Harmonic(HarmonicProfile),
    /// Absolute value of a sine.
    RectifiedSine(RectifiedSineProfile),
    /// Rises, dwells and returns, in sequence.
    Program(ProgramProfile),
    /// Polynomials in the angle, ordered by their start.
    Polynomial(Vec<PolynomialSegment>),
    /// Spline through measured lifts.
    Table(TableProfile),
    /// Spline through measured radii of the cam's contour.
    Contour(ContourProfile),
    /// Profile with rounded corners of its acceleration, or with its lift scaled by a lever.
    Modified {
        /// Changes of the profile.
        change: ProfileChange,
        /// Profile without the changes.
        plain: Box<Self>,
    },
}

/// Changes that a `[cam]` table makes to the lift of its law.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ProfileChange {
    /// Angle over which each corner is rounded, degrees; 0 for none.
    #[serde(skip_serializing_if = "is_zero")]
    pub corner_rounding_deg: f64,
    /// Ratio of the follower's lift to the cam's; 1 without a lever.
    #[serde(skip_serializing_if = "is_one")]
    pub lever_ratio: f64,
}

impl ProfileChange {
    const NONE: Self = Self { corner_rounding_deg: 0.0, lever_ratio: 1.0 };
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
fn is_zero(number: &f64) -> bool {
    *number == 0.0
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
fn is_one(number: &f64) -> bool {
    *number == 1.0
}

impl CamProfile {
    /// Name of this lift law in the field `law`.
    pub fn law(&self) -> &'static str {
        match self.plain() {
            Self::Arcs(_) => "arcs",
            Self::Harmonic(_) => "harmonic",
            Self::RectifiedSine(_) => "rectified-sine",
            Self::Program(_) => "program",
            Self::Polynomial(_) => "polynomial",
            Self::Table(_) => "table",
            Self::Contour(_) => "contour",
            // A profile is modified at most once.
            Self::Modified { .. } => "",
        }
    }

    /// Profile without its changes.
    pub fn plain(&self) -> &Self {
        if let Self::Modified { plain, .. } = self { plain } else { self }
    }

    /// Table of a profile, if it has one.
    pub(super) fn table_mut(&mut self) -> Option<&mut TableProfile> {
        let plain = if let Self::Modified { plain, .. } = self { plain } else { self };
        match plain {
            Self::Table(table) | Self::Contour(ContourProfile { table, .. }) => Some(table),
            _ => None,
        }
    }

    /// Ratio of the follower's lift to the cam's by a lever between them; 1 without a lever.
    pub fn lever_ratio(&self) -> f64 {
        self.change().lever_ratio
    }

    fn change(&self) -> ProfileChange {
        if let Self::Modified { change, .. } = self { *change } else { ProfileChange::NONE }
    }

    /// End of the follower that touches the cam, if the lift follows from the cam's contour; `None` if the lift itself is given.
    pub fn contact(&self) -> Option<FollowerContact> {
        match self.plain() {
            Self::Arcs(profile) => Some(profile.contact),
            Self::Contour(profile) => Some(profile.contact),
            _ => None,
        }
    }
}

/// Serializes the profile as the table of a model file; a table of lifts has its rows instead of the file's name.
impl Serialize for CamProfile {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Named<T> {
            law: &'static str,
            #[serde(flatten)]
            change: ProfileChange,
            #[serde(flatten)]
            profile: T,
        }
        #[derive(Serialize)]
        struct Segments<'a> {
            segment: &'a [PolynomialSegment],
        }
        let (law, change) = (self.law(), self.change());
        match self.plain() {
            Self::Arcs(profile) => Named { law, change, profile }.serialize(to),
            Self::Harmonic(profile) => Named { law, change, profile }.serialize(to),
            Self::RectifiedSine(profile) => Named { law, change, profile }.serialize(to),
            Self::Program(profile) => Named { law, change, profile }.serialize(to),
            Self::Polynomial(segment) => Named { law, change, profile: Segments { segment } }.serialize(to),
            Self::Table(profile) => Named { law, change, profile }.serialize(to),
            Self::Contour(profile) => Named { law, change, profile }.serialize(to),
            Self::Modified { .. } => Named { law, change, profile: () }.serialize(to),
        }
    }
}

/// Base, flank and nose circles, mirrored about theta = pi. Centres and top radius follow from tangency.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ArcsProfile {
    /// Base radius rho0, m.
    pub base_radius: f64,
    /// Flank radius rho1, m.
    pub flank_radius: f64,
    /// Nose radius rho2, m.
    pub nose_radius: f64,
    /// Angle R = 90 - theta1, degrees from the middle of the base circle.
    pub flank_start_deg: f64,
    /// Angle Q = 90 - theta3, degrees from the middle of the base circle.
    pub nose_end_deg: f64,
    /// End of the follower that touches the cam.
    #[serde(skip_serializing_if = "FollowerContact::is_point")]
    pub contact: FollowerContact,
}

/// Contour of a cam, and the follower on it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ContourProfile {
    /// Radii over polar angles, which count against the cam's direction of rotation.
    #[serde(flatten)]
    pub table: TableProfile,
    /// End of the follower that touches the cam.
    pub contact: FollowerContact,
}

/// End of the follower that touches the cam; each end gives another lift.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum FollowerContact {
    /// Point on a line through the cam's axis, as in the paper.
    #[default]
    Point,
    /// Flat face perpendicular to the line of motion.
    Flat,
    /// Roller.
    Roller {
        /// Radius of the roller, m.
        roller_radius: f64,
        /// Distance of its line of motion from the cam's axis, m; positive if each point of the cam arrives earlier.
        offset: f64,
    },
}

impl FollowerContact {
    /// Whether it is a point.
    pub fn is_point(&self) -> bool {
        *self == Self::Point
    }
}

/// Serializes as the field `contact` of a model file.
impl Serialize for FollowerContact {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Roller {
            roller_radius: f64,
            offset: f64,
        }
        match *self {
            Self::Point => to.serialize_str("point"),
            Self::Flat => to.serialize_str("flat"),
            Self::Roller { roller_radius, offset } => Roller { roller_radius, offset }.serialize(to),
        }
    }
}

/// Sum of cosines `c = offset + sum a_k cos(k theta + p_k)`, k from 1.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[doc(hidden)]
pub struct HarmonicProfile {
    /// Mean lift, m.
    pub offset: f64,
    /// Amplitudes a_k, m; at least one.
    pub amplitudes: Vec<f64>,
    /// Phases p_k, degrees; as many as the amplitudes.
    pub phases_deg: Vec<f64>,
}

/// Rectified sine `c = offset + amplitude |sin theta|`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RectifiedSineProfile {
    /// Lift at the corners, m.
    pub offset: f64,
    /// Height of the two humps, m; negative for two hollows.
    pub amplitude: f64,
}

/// Sequence of motions, starting at theta = 0.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ProgramProfile {
    /// Lift at theta = 0, m.
    pub base: f64,
    /// Motions in order; at least one.
    #[serde(rename = "segment")]
    pub segments: Vec<MotionSegment>,
}

/// Motion of a program.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MotionSegment {
    /// Shape of the lift curve between the two ends.
    pub motion: StandardMotion,
    /// Cam angle of the motion, degrees, positive.
    pub span_deg: f64,
    /// Change of the lift, m; negative is a return, 0 a dwell.
    pub rise: f64,
}

/// Standard motion of cam design, between ends at rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[doc(hidden)]
pub enum StandardMotion {
    /// Constant lift.
    Dwell,
    /// Constant acceleration, then the same deceleration.
    Parabolic,
    /// Half a period of a cosine: simple harmonic motion.
    Harmonic,
    /// One period of a sine as acceleration.
    Cycloidal,
    /// Trapezoidal acceleration whose flanks are quarter periods of a sine.
    ModifiedTrapezoid,
    /// Sinusoidal acceleration, whose first and last eighth run three times as fast as the middle.
    ModifiedSine,
    /// Polynomial with velocity and acceleration 0 at both ends.
    Poly345,
    /// Polynomial with velocity, acceleration and jerk 0 at both ends.
    Poly4567,
}

impl StandardMotion {
    /// All motions, with their names in the field `motion`.
    pub const NAMES: [(&'static str, Self); 8] = [
        ("dwell", Self::Dwell),
        ("parabolic", Self::Parabolic),
        ("harmonic", Self::Harmonic),
        ("cycloidal", Self::Cycloidal),
        ("modified-trapezoid", Self::ModifiedTrapezoid),
        ("modified-sine", Self::ModifiedSine),
        ("poly345", Self::Poly345),
        ("poly4567", Self::Poly4567),
    ];
}

/// Polynomial `c = sum a_k (theta - start)^k` from its start to the start of the next segment.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PolynomialSegment {
    /// Start, degrees, from 0 to below 360.
    pub start_deg: f64,
    /// Coefficients a_k, m/rad^k, k from 0.
    pub coefficients: Vec<f64>,
}

/// Largest number of segments of a program or of polynomials: more than anyone writes by hand. A table may have more rows.
const MOST_SEGMENTS: usize = 10_000;
/// Largest number of cosines: the hundredth harmonic is already shorter than any cutter that could make it.
const MOST_HARMONICS: usize = 1000;

/// Largest number of coefficients of a polynomial: powers of a radian beyond the 31st add nothing.
pub const MOST_COEFFICIENTS: usize = 32;

type ReadProfile = fn(&mut Fields) -> Result<CamProfile, ModelError>;

/// All lift laws, with their names in the field `law`.
static CAM_LAWS: [(&str, ReadProfile); 7] = [
    ("arcs", arcs),
    ("harmonic", harmonic),
    ("rectified-sine", rectified_sine),
    ("program", program),
    ("polynomial", polynomial),
    ("table", |fields| table_file::read(fields).map(CamProfile::Table)),
    ("contour", |fields| {
        let contact = contact(fields)?;
        Ok(CamProfile::Contour(ContourProfile { table: table_file::read_contour(fields)?, contact }))
    }),
];

/// Values of the field `contact`, in words.
#[doc(hidden)]
pub const CONTACTS: &str = "a name or a roller: \"point\", \"flat\", { roller_radius = 0.01 }";
/// Field of the rounding angle of corners.
#[doc(hidden)]
pub const CORNER_ROUNDING: &str = "cam.corner_rounding_deg";
/// Field of the ratio of the lever between cam and follower.
#[doc(hidden)]
pub const LEVER_RATIO: &str = "cam.lever_ratio";

pub(super) fn read(fields: &mut Fields) -> Result<CamProfile, ModelError> {
    let read = fields.choice("cam.law", &CAM_LAWS)?;
    let (path, least) = (CORNER_ROUNDING, tolerance::LEAST_ROUNDING.value);
    let corner_rounding_deg = fields.number(path)?;
    if 0.0 < corner_rounding_deg && corner_rounding_deg < least {
        return Err(fields.reject(path, format!("must be 0, or {least} or more")));
    }
    let change = ProfileChange { corner_rounding_deg, lever_ratio: fields.number(LEVER_RATIO)? };
    let plain = read(fields)?;
    Ok(if change == ProfileChange::NONE { plain } else { CamProfile::Modified { change, plain: Box::new(plain) } })
}

fn arcs(fields: &mut Fields) -> Result<CamProfile, ModelError> {
    Ok(CamProfile::Arcs(ArcsProfile {
        base_radius: fields.number("cam.base_radius")?,
        flank_radius: fields.number("cam.flank_radius")?,
        nose_radius: fields.number("cam.nose_radius")?,
        flank_start_deg: fields.number("cam.flank_start_deg")?,
        nose_end_deg: fields.number("cam.nose_end_deg")?,
        contact: contact(fields)?,
    }))
}

fn contact(fields: &mut Fields) -> Result<FollowerContact, ModelError> {
    const PATH: &str = "cam.contact";
    if fields.is_table(PATH) {
        let roller_radius = fields.number("cam.contact.roller_radius")?;
        return Ok(FollowerContact::Roller { roller_radius, offset: fields.number("cam.contact.offset")? });
    }
    match fields.word(PATH, "point") {
        Some("point") => Ok(FollowerContact::Point),
        Some("flat") => Ok(FollowerContact::Flat),
        _ => Err(fields.reject(PATH, format!("must be {CONTACTS}"))),
    }
}

fn harmonic(fields: &mut Fields) -> Result<CamProfile, ModelError> {
    let offset = fields.number("cam.offset")?;
    let amplitudes = fields.numbers("cam.amplitudes", MOST_HARMONICS)?;
    let phases_deg = fields.numbers("cam.phases_deg", MOST_HARMONICS)?;
    if amplitudes.len() != phases_deg.len() {
        let words = format!(
            "has {} numbers; one for each of the {} cam.amplitudes is needed",
            phases_deg.len(),
            amplitudes.len()
        );
        return Err(fields.reject("cam.phases_deg", words));
    }
    Ok(CamProfile::Harmonic(HarmonicProfile { offset, amplitudes, phases_deg }))
}

fn rectified_sine(fields: &mut Fields) -> Result<CamProfile, ModelError> {
    Ok(CamProfile::RectifiedSine(RectifiedSineProfile {
        offset: fields.number("cam.offset")?,
        amplitude: fields.number("cam.amplitude")?,
    }))
}

fn program(fields: &mut Fields) -> Result<CamProfile, ModelError> {
    let base = fields.number("cam.base")?;
    let count = fields.tables("cam.segment", MOST_SEGMENTS)?;
    let segments = (0..count).map(|index| motion_segment(fields, index)).collect::<Result<_, _>>()?;
    Ok(CamProfile::Program(ProgramProfile { base, segments }))
}

fn motion_segment(fields: &mut Fields, index: usize) -> Result<MotionSegment, ModelError> {
    let path = |name: &str| format!("cam.segment[{index}].{name}");
    let motion = fields.choice(&path("motion"), &StandardMotion::NAMES)?;
    let span_deg = fields.number(&path("span_deg"))?;
    fields.may_hold(&path("rise"));
    let rise = match motion {
        StandardMotion::Dwell if !fields.has(&path("rise")) => 0.0,
        _ => fields.number(&path("rise"))?,
    };
    if motion == StandardMotion::Dwell && rise != 0.0 {
        return Err(fields.reject(&path("rise"), "must be 0: a dwell does not rise"));
    }
    Ok(MotionSegment { motion, span_deg, rise })
}

fn polynomial(fields: &mut Fields) -> Result<CamProfile, ModelError> {
    let count = fields.tables("cam.segment", MOST_SEGMENTS)?;
    let mut segments: Vec<PolynomialSegment> = Vec::with_capacity(count);
    for index in 0..count {
        let path = |name: &str| format!("cam.segment[{index}].{name}");
        let start_deg = fields.number(&path("start_deg"))?;
        if start_deg >= 360.0 {
            return Err(fields.reject(&path("start_deg"), "must be below 360, which is the same angle as 0"));
        }
        if let Some(before) = segments.last().filter(|before| start_deg <= before.start_deg) {
            let words = format!("must be above {}, the start of the previous segment", before.start_deg);
            return Err(fields.reject(&path("start_deg"), words));
        }
        let coefficients = fields.numbers(&path("coefficients"), MOST_COEFFICIENTS)?;
        segments.push(PolynomialSegment { start_deg, coefficients });
    }
    Ok(CamProfile::Polynomial(segments))
}
