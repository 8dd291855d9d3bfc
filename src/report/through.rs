//! The motion at speeds on either side of the corner impact, as a document: what the slider of the page shows. Numbers are
//! rounded to what a picture or its readout can show.

use std::collections::BTreeSet;

use serde::Serialize;

use crate::draw::ticks::{ticks, unit};
use crate::draw::{Spacing, extent};
use crate::figures::through_corner::{Moment, Place, Run, Shown};
use crate::figures::{CornerMark, ThroughCorner};
use crate::orbit::Eigenvalue;
use crate::simulate::Event;

/// Why there is nothing to show.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("at {rpm} rpm a number of the motion is not finite")]
pub struct NotFinite {
    /// The speed.
    pub rpm: f64,
}

/// What the slider shows.
#[derive(Clone, Debug, Serialize)]
pub struct ThroughEntry {
    /// How finely its numbers are told.
    pub places: Places,
    /// Letter of the corner, or its angle.
    pub corner: String,
    /// Its cam angle.
    pub corner_deg: f64,
    /// Index of the frame at the corner impact.
    pub at_corner: usize,
    /// Axes of the drawings.
    pub axes: Axes,
    /// Angle, deg; lift, m; acceleration, m/rad^2; each corner twice, with the law before it and the law after it.
    pub cam: Vec<[f64; 3]>,
    /// Added to the lift where the cam is drawn as a shape, m.
    pub drawn_on_m: f64,
    /// Largest radius of that shape, m.
    pub drawn_radius_m: f64,
    /// Corners that have a label: angle, deg, and label.
    pub corners: Vec<(f64, String)>,
    /// By rising speed.
    pub frames: Vec<FrameEntry>,
}

/// The axes.
#[derive(Clone, Debug, Serialize)]
pub struct Axes {
    /// Speed, rpm.
    pub speed: AxisEntry,
    /// Cam angle, deg, once round.
    pub angle: AxisEntry,
    /// Position, m.
    pub position: AxisEntry,
    /// Cam angles of impacts near the corner, deg.
    pub near: AxisEntry,
    /// Acceleration of the cam there, m/rad^2.
    pub acceleration: AxisEntry,
    /// Real and imaginary part.
    pub plane: AxisEntry,
}

/// An axis.
#[derive(Clone, Debug, Serialize)]
pub struct AxisEntry {
    /// Its ends.
    pub range: [f64; 2],
    /// Its unit, with the power of ten that labels are to be multiplied by.
    pub unit: String,
    /// Where ticks stand, and their labels.
    pub ticks: Vec<(f64, String)>,
}

/// One speed.
#[derive(Clone, Debug, Serialize)]
pub struct FrameEntry {
    /// The speed.
    pub rpm: f64,
    /// Orbits of one impact a revolution.
    pub orbits: Vec<OrbitFrame>,
    /// What a run settles on that came from faster speeds.
    pub slowing: RunFrame,
    /// What a run settles on that came from slower speeds.
    pub speeding: RunFrame,
}

/// An orbit at one speed, with its impact.
#[derive(Clone, Debug, Serialize)]
#[expect(missing_docs, reason = "names carry what a number is, and its unit")]
pub struct OrbitFrame {
    /// `before`, `after` or `elsewhere`: where the impact is, seen from the corner.
    pub place: Place,
    pub stable: bool,
    /// Cam angle of the impact.
    pub angle_deg: f64,
    /// That angle less the corner's.
    pub from_corner_deg: f64,
    pub position_m: f64,
    pub velocity_before_m_s: f64,
    pub velocity_after_m_s: f64,
    pub multipliers: [Eigenvalue; 2],
    /// The larger modulus of the two.
    pub modulus: f64,
    /// One revolution: cam angle, deg, and position, m.
    pub path: Vec<[f64; 2]>,
}

/// What a run settles on.
#[derive(Clone, Debug, Serialize)]
pub struct RunFrame {
    /// Cam angles of its impacts, deg, each once.
    pub impacts_deg: Vec<f64>,
    /// In words.
    pub words: String,
    /// Some of its revolutions: cam angle, deg, and position, m.
    pub paths: Vec<Vec<[f64; 2]>>,
}

/// Places after the point of an angle in degrees, and of one that is only drawn.
const ANGLE: i32 = 4;
const DRAWN_ANGLE: i32 = 1;
/// Digits of a quantity's extent: more than a picture can show, fewer than fill a page.
const POSITION: i32 = 5;
const VELOCITY: i32 = 6;
const ACCELERATION: i32 = 5;
/// Places of a multiplier.
const MULTIPLIER: i32 = 6;
/// The largest part of a multiplier that the plane has room for.
const WIDEST: f64 = 2.5;
/// Margins of an axis, of what it shows.
const MARGIN: f64 = 0.06;

/// Places after the point: a model's unit of length is its own.
#[derive(Clone, Copy, Debug, Serialize)]
#[expect(missing_docs, reason = "each is of the quantity that it is named after")]
pub struct Places {
    /// So many that neighbouring frames differ.
    pub speed: i32,
    /// By the cam's travel.
    pub position: i32,
    pub velocity: i32,
    pub acceleration: i32,
    pub angle: i32,
    pub multiplier: i32,
}

impl Places {
    fn new(through: &ThroughCorner) -> Self {
        let span = |values: [f64; 2]| values[1] - values[0];
        let lifts = || through.cam.iter().map(|(_, lift)| lift);
        let impacts = through.moments.iter().flat_map(|moment| &moment.orbits).map(|orbit| &orbit.impact);
        let fastest = impacts
            .fold(0.0_f64, |most, impact| most.max(impact.velocity_before.abs()).max(impact.velocity_after.abs()));
        let steps = through.moments.windows(2).map(|pair| pair[1].rpm - pair[0].rpm);
        Self {
            speed: of_extent(steps.fold(f64::INFINITY, f64::min), 1).max(2),
            position: of_extent(span(extent(lifts().map(|lift| lift.value))), POSITION),
            velocity: of_extent(fastest, VELOCITY),
            acceleration: of_extent(span(extent(lifts().map(|lift| lift.curvature))), ACCELERATION),
            angle: ANGLE,
            multiplier: MULTIPLIER,
        }
    }
}

/// The places after the point that give the extent of a quantity so many digits.
fn of_extent(extent: f64, digits: i32) -> i32 {
    const MOST: i32 = 15;
    if !(extent > 0.0 && extent.is_finite()) {
        return digits;
    }
    (digits - 1 - extent.log10().floor() as i32).clamp(0, MOST)
}

fn rounded(value: f64, places: i32) -> f64 {
    let scale = 10_f64.powi(places);
    // Without the sign of a zero.
    (value * scale).round() / scale + 0.0
}

fn path(points: &[[f64; 2]], places: Places) -> Vec<[f64; 2]> {
    let drawn =
        |[angle, position]: [f64; 2]| [rounded(angle.to_degrees(), DRAWN_ANGLE), rounded(position, places.position)];
    let mut path: Vec<[f64; 2]> = points.iter().copied().map(drawn).collect();
    path.dedup();
    path
}

impl ThroughEntry {
    /// What was computed, with the labels of the cam's corners.
    ///
    /// An error where a number is not finite: the page's data have no way to write one.
    pub fn new(through: &ThroughCorner, corner: f64, marks: &[CornerMark]) -> Result<Self, NotFinite> {
        if let Some(moment) = through.moments.iter().find(|moment| !is_finite(moment)) {
            return Err(NotFinite { rpm: moment.rpm });
        }
        let (corner_deg, places) = (corner.to_degrees(), Places::new(through));
        let frames: Vec<FrameEntry> =
            through.moments.iter().map(|moment| FrameEntry::new(moment, corner_deg, places)).collect();
        let cam: Vec<[f64; 3]> = through
            .cam
            .iter()
            .map(|(angle, lift)| {
                let angle = rounded(angle.to_degrees(), ANGLE);
                [angle, rounded(lift.value, places.position), rounded(lift.curvature, places.acceleration)]
            })
            .collect();
        // Not every corner has a label of its own.
        let unnamed = CornerMark { angle_rad: corner, name: String::new() };
        let hit = marks.iter().find(|mark| mark.angle_rad == corner).unwrap_or(&unnamed);
        let [_, high] = extent(cam.iter().map(|point| point[1]));
        Ok(Self {
            places,
            corner: hit.label(),
            corner_deg: rounded(corner_deg, ANGLE),
            at_corner: through.at_corner,
            axes: Axes::new(&frames, &cam, corner_deg),
            drawn_on_m: through.drawn_on,
            drawn_radius_m: high + through.drawn_on,
            corners: marks.iter().map(|mark| (rounded(mark.angle_rad.to_degrees(), ANGLE), mark.label())).collect(),
            cam,
            frames,
        })
    }
}

impl FrameEntry {
    fn new(moment: &Moment, corner_deg: f64, places: Places) -> Self {
        Self {
            rpm: rounded(moment.rpm, places.speed),
            orbits: moment.orbits.iter().map(|orbit| OrbitFrame::new(orbit, corner_deg, places)).collect(),
            slowing: RunFrame::new(&moment.slowing, Some(places)),
            speeding: RunFrame::new(&moment.speeding, None),
        }
    }
}

impl OrbitFrame {
    fn new(shown: &Shown, corner_deg: f64, places: Places) -> Self {
        let Shown { place, impact, multipliers, stable, path: points } = shown;
        let angle = impact.cam_angle.to_degrees();
        let modulus = multipliers.iter().fold(0.0_f64, |largest, multiplier| largest.max(multiplier.modulus()));
        Self {
            place: *place,
            stable: *stable,
            angle_deg: rounded(angle, ANGLE),
            from_corner_deg: rounded((angle - corner_deg + 540.0).rem_euclid(360.0) - 180.0, ANGLE),
            position_m: rounded(impact.position, places.position),
            velocity_before_m_s: rounded(impact.velocity_before, places.velocity),
            velocity_after_m_s: rounded(impact.velocity_after, places.velocity),
            multipliers: multipliers.map(|multiplier| Eigenvalue {
                re: rounded(multiplier.re, MULTIPLIER),
                im: rounded(multiplier.im, MULTIPLIER),
            }),
            modulus: rounded(modulus, MULTIPLIER),
            path: path(points, places),
        }
    }
}

impl RunFrame {
    /// Different places of impact that are still told one by one.
    const TOLD: usize = 4;

    /// With its paths where their places are given.
    fn new(run: &Run, places: Option<Places>) -> Self {
        const ROUND: i64 = 3600;
        let tenth = |angle: &f64| ((angle.to_degrees() * 10.0).round() as i64).rem_euclid(ROUND);
        let tenths: BTreeSet<i64> = run.impacts.iter().map(tenth).collect();
        let impacts_deg: Vec<f64> = tenths.into_iter().map(|tenth| rounded(tenth as f64 / 10.0, DRAWN_ANGLE)).collect();
        let words = match impacts_deg.as_slice() {
            [] => "no impact: it stays on the cam, or clear of it".to_owned(),
            [angle] => format!("all its impacts at {angle}°"),
            angles if angles.len() <= Self::TOLD => {
                let angles: Vec<String> = angles.iter().map(|angle| format!("{angle}°")).collect();
                format!("impacts at {}", angles.join(", "))
            }
            angles => format!(
                "impacts at {} angles, to a tenth of a degree, in {} revolutions",
                angles.len(),
                run.revolutions
            ),
        };
        let drawn = |places| run.paths.iter().map(|points| path(points, places)).collect();
        let paths = places.map(drawn).unwrap_or_default();
        Self { impacts_deg, words, paths }
    }
}

fn is_finite(moment: &Moment) -> bool {
    let orbit = |orbit: &Shown| {
        let [one, other] = orbit.multipliers;
        let Event { cam_angle, position, velocity_before, velocity_after, .. } = orbit.impact;
        let numbers = [cam_angle, position, velocity_before, velocity_after, one.re, one.im, other.re, other.im];
        numbers.iter().chain(orbit.path.iter().flatten()).all(|number| number.is_finite())
    };
    let run =
        |run: &Run| run.impacts.iter().chain(run.paths.iter().flatten().flatten()).all(|number| number.is_finite());
    moment.rpm.is_finite() && moment.orbits.iter().all(orbit) && run(&moment.slowing) && run(&moment.speeding)
}

impl AxisEntry {
    fn over([low, high]: [f64; 2], name: &str, spacing: Spacing, most: usize) -> Self {
        let found = ticks([low, high], spacing, most, |_| true);
        Self {
            range: [low, high],
            unit: unit(name, found.exponent),
            ticks: found.ticks.into_iter().map(|tick| (tick.at, tick.label)).collect(),
        }
    }

    fn around([low, high]: [f64; 2], name: &str, most: usize) -> Self {
        // What is the same all over still has room above and below.
        let wide = if high > low { high - low } else { high.abs().max(1.0) };
        Self::over([low - MARGIN * wide, high + MARGIN * wide], name, Spacing::Decimal, most)
    }
}

impl Axes {
    fn new(frames: &[FrameEntry], cam: &[[f64; 3]], corner_deg: f64) -> Self {
        let orbits = || frames.iter().flat_map(|frame| &frame.orbits);
        let of_orbits = orbits().flat_map(|orbit| &orbit.path);
        let of_runs = frames.iter().flat_map(|frame| frame.slowing.paths.iter().flatten());
        let lifts = cam.iter().map(|point| point[1]);
        let positions = extent(of_orbits.chain(of_runs).map(|point| point[1]).chain(lifts));
        let beside = orbits().filter(|orbit| orbit.place != Place::Elsewhere);
        let [first, last] = extent(beside.map(|orbit| corner_deg + orbit.from_corner_deg).chain([corner_deg]));
        // At least a few degrees, so that a corner shows that nothing moves over.
        let reach = 0.12 * (last - first).max(20.0);
        let near = [rounded(first - reach, 1), rounded(last + reach, 1)];
        let seen = |point: &&[f64; 3]| {
            [-360.0, 0.0, 360.0].iter().any(|turn| (near[0]..=near[1]).contains(&(point[0] + turn)))
        };
        let accelerations = extent(cam.iter().filter(seen).map(|point| point[2]));
        let parts = orbits().flat_map(|orbit| orbit.multipliers).flat_map(|multiplier| [multiplier.re, multiplier.im]);
        let widest = parts.fold(1.0_f64, |widest, part| widest.max(part.abs())).min(WIDEST);
        let plane = rounded(1.15 * widest, 2);
        let speeds = extent(frames.iter().map(|frame| frame.rpm));
        Self {
            speed: AxisEntry::over(speeds, "rpm", Spacing::Decimal, 6),
            angle: AxisEntry::over([0.0, 360.0], "deg", Spacing::Degrees, 5),
            position: AxisEntry::around(positions, "m", 6),
            near: AxisEntry::over(near, "deg", Spacing::Degrees, 6),
            acceleration: AxisEntry::around(accelerations, "m/rad²", 6),
            plane: AxisEntry::over([-plane, plane], "", Spacing::Decimal, 5),
        }
    }
}
