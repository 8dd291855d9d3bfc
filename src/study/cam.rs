//! The segments of a cam, and the corners where they meet.

use serde::Serialize;

use crate::cam::{Cam, ContourPoint, Corner, Jet, Law, Segment};
use crate::measured::{Measured, PlausibleCams};
use crate::model::{CamProfile, FollowerContact, Model, ModelError, StandardMotion, TableProfile};

/// Segments and corners of a model's cam; serializes to the document `corner-impact/cam/1`.
#[derive(Clone, Debug, Serialize)]
pub struct CamSheet {
    schema: &'static str,
    /// Name of the model.
    pub model: String,
    /// Source of its numbers.
    pub source: String,
    /// Name of the law in `[cam]`.
    pub law: &'static str,
    /// Lowest and highest lift.
    pub lift_m: [f64; 2],
    /// Ratio of the lever between cam and follower, 1 without one.
    pub lever_ratio: f64,
    /// Contour of the cam, if its lift follows from one, with the demands on the follower.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub geometry: Option<CamGeometry>,
    /// Accuracy of the cam, if it is measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measured: Option<Measured>,
    /// Doubts about what the rows of a table mean, a sentence each.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub doubts: Vec<String>,
    /// Segments, in order of angle.
    pub segments: Vec<Segment>,
    /// The user's name of each segment: the motion of a program, the circle of a cam of arcs, else the kind of its law.
    pub motions: Vec<&'static str>,
    /// Largest velocity, acceleration and jerk between corners, with their places.
    pub largest: [Largest; 3],
    /// Highest order of the listed jumps.
    pub highest_order: usize,
    /// Corners, in order of angle.
    pub corners: Vec<Corner>,
    /// Corners of the cam itself, without the knots of a smoothing spline.
    #[serde(skip)]
    pub own_corners: Vec<Corner>,
}

/// Contour of a cam and the end of the follower that touches it, computed at 361 angles of each segment. Where a lever lies between cam and
/// follower, the lengths are those at the cam.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct CamGeometry {
    /// End of the follower that touches the cam.
    pub contact: FollowerContact,
    /// Least radius of curvature of the contour where it is convex, m.
    pub least_radius_m: f64,
    /// Least radius of curvature of its hollows, m; none for a convex contour.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hollow_radius_m: Option<f64>,
    /// Whether this follower can touch all of the contour: a flat face touches no hollow, and a roller none that is narrower than itself.
    pub is_touchable: bool,
    /// Largest angle between the contour's normal and the follower's motion, rad, without its sign.
    pub pressure_angle_rad: f64,
    /// Cam angle of that angle, rad.
    pub pressure_angle_at_rad: f64,
    /// Whether the largest pressure angle is above [`CamGeometry::LARGE_PRESSURE_ANGLE`].
    pub is_steep: bool,
    /// Width along which the cam touches a flat face, m; none for other followers.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub face_width_m: Option<f64>,
}

impl CamGeometry {
    /// Pressure angle from which a guide takes large forces across, rad: a rule of thumb of textbooks.
    pub const LARGE_PRESSURE_ANGLE: f64 = std::f64::consts::FRAC_PI_6;

    /// Computes the geometry of a model's cam. `None` if the model gives a lift and no contour.
    pub fn of(model: &Model, cam: &Cam) -> Option<Self> {
        let contact = model.cam.contact()?;
        let cam = cam.levered(model.cam.lever_ratio().recip());
        let steepness = |point: &ContourPoint| point.pressure_angle.abs();
        let steepest = cam.contour(contact).max_by(|one, two| steepness(one).total_cmp(&steepness(two)))?;
        let widest = match contact {
            FollowerContact::Point => 0.0,
            FollowerContact::Flat => f64::INFINITY,
            FollowerContact::Roller { roller_radius, .. } => roller_radius,
        };
        let is_touched = |point: ContourPoint| point.radius >= 0.0 || point.radius <= -widest;
        let radii = |sign: f64| {
            let radii = cam.contour(contact).map(move |point| sign * point.radius);
            radii.filter(|radius| *radius > 0.0).fold(f64::INFINITY, f64::min)
        };
        let slope = |sign: f64| cam.least([0.0, sign, 0.0, 0.0]).value;
        Some(Self {
            contact,
            least_radius_m: radii(1.0),
            hollow_radius_m: Some(radii(-1.0)).filter(|radius| radius.is_finite()),
            is_touchable: cam.contour(contact).all(is_touched),
            pressure_angle_rad: steepness(&steepest),
            pressure_angle_at_rad: steepest.cam_angle,
            is_steep: steepness(&steepest) > Self::LARGE_PRESSURE_ANGLE,
            face_width_m: (contact == FollowerContact::Flat).then(|| -slope(1.0) - slope(-1.0)),
        })
    }
}

/// The largest size of a derivative of the lift between corners.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Largest {
    /// Order of the derivative: 1 velocity, 2 acceleration, 3 jerk.
    pub order: usize,
    /// Value with its sign, m/rad^order.
    pub value_m: f64,
    /// Cam angle, rad.
    pub cam_angle_rad: f64,
}

impl Largest {
    /// Finds the largest size of one derivative on a cam.
    pub(super) fn of(cam: &Cam, order: usize) -> Self {
        let least = |sign: f64| {
            let mut weights = [0.0; 4];
            weights[order] = sign;
            let least = cam.least(weights);
            Self { order, value_m: sign * least.value, cam_angle_rad: least.angle }
        };
        let (lowest, highest) = (least(1.0), least(-1.0));
        if lowest.value_m.abs() > highest.value_m.abs() { lowest } else { highest }
    }
}

/// Returns the user's name of each segment.
fn motions(model: &Model, cam: &Cam) -> Vec<&'static str> {
    /// Arcs from the middle of the base circle on, as in Appendix A.
    const ARCS: [&str; 7] = ["base circle", "flank", "nose", "top dwell", "nose", "flank", "base circle"];
    let names = |at: &dyn Fn(usize, f64) -> Option<&'static str>| {
        let name = |(index, segment): (usize, &Segment)| {
            at(index, 0.5 * (segment.start + segment.end).to_degrees()).unwrap_or(segment.law.name())
        };
        cam.segments().iter().enumerate().map(name).collect()
    };
    let is_dwell = |segment: Option<&Segment>| segment.is_some_and(|it| matches!(it.law, Law::Dwell(_)));
    match model.cam.plain() {
        CamProfile::Program(program) => names(&|_, middle| {
            let mut end = 0.0;
            let motion = program.segments.iter().find(|motion| {
                end += motion.span_deg;
                middle < end
            })?;
            StandardMotion::NAMES.iter().find(|(_, of)| *of == motion.motion).map(|(name, _)| *name)
        }),
        // An offset may turn the base circle past angle 0.
        CamProfile::Arcs(_) if cam.segments().len() == ARCS.len() && is_dwell(cam.segments().first()) => {
            names(&|index, _| ARCS.get(index).copied())
        }
        _ => names(&|_, _| None),
    }
}

impl CamSheet {
    /// Whether the cam is a smoothing spline near the rows of a table.
    pub fn is_smoothed(&self) -> bool {
        self.measured.as_ref().is_some_and(|measured| measured.is_smoothed)
    }

    /// Lists the segments of a model's cam, and its corners up to an order.
    pub fn new(model: &Model, cam: &Cam, highest_order: usize) -> Result<Self, ModelError> {
        let segments = cam.segments().to_vec();
        let highest_order = highest_order.min(Jet::HIGHEST_JUMP);
        let corners: Vec<Corner> =
            cam.corners().iter().copied().filter(|corner| corner.jump_order <= highest_order).collect();
        let is_own = |corner: &Corner| !model.is_smoothed() || !cam.is_knot(corner);
        Ok(Self {
            schema: "corner-impact/cam/1",
            model: model.name.clone(),
            source: model.source.clone(),
            law: model.cam.law(),
            lever_ratio: model.cam.lever_ratio(),
            lift_m: [cam.lowest().value, -cam.least([-1.0, 0.0, 0.0, 0.0]).value],
            motions: motions(model, cam),
            geometry: CamGeometry::of(model, cam),
            largest: [1, 2, 3].map(|order| Largest::of(cam, order)),
            measured: PlausibleCams::of(model)?.map(|likely| likely.measured),
            doubts: model.table().map_or_else(Vec::new, TableProfile::doubts),
            segments,
            highest_order,
            own_corners: corners.iter().copied().filter(is_own).collect(),
            corners,
        })
    }
}
