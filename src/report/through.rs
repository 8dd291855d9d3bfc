//! The motion at speeds on either side of the corner impact, as a document: what the slider of the page shows. Numbers are
//! rounded to what a picture or its readout can show.

use serde::Serialize;

use crate::cam::{Cam, Lift};
use crate::draw::ticks::{ticks, unit};
use crate::draw::{Spacing, extent};
use crate::elementary;
use crate::figures::through_corner::{Moment, Place, Shown, profile};
use crate::figures::{CornerMark, Outline, corner_marks};
use crate::model::Units;

/// Why there is nothing to show.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("at {rpm} rpm a number of the motion is not finite")]
pub struct NotFinite {
    /// The speed.
    pub rpm: f64,
}

/// What the slider shows.
#[derive(Clone, Debug, Serialize)]
pub struct ThroughCorner {
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
    pub frames: Vec<Moment>,
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
    fn new(moments: &[Moment], cam: &[(f64, Lift)]) -> Self {
        let span = |of: fn(&Lift) -> f64| {
            let [low, high] = extent(cam.iter().map(|(_, lift)| of(lift)));
            high - low
        };
        let orbits = moments.iter().flat_map(|moment| &moment.orbits);
        let velocities = orbits.flat_map(|orbit| [orbit.velocity_before_m_s, orbit.velocity_after_m_s]);
        let steps = moments.windows(2).map(|pair| pair[1].rpm - pair[0].rpm);
        Self {
            speed: of_extent(steps.fold(f64::INFINITY, f64::min), 1).max(2),
            position: of_extent(span(|lift| lift.value), POSITION),
            velocity: of_extent(velocities.fold(0.0_f64, |most, velocity| most.max(velocity.abs())), VELOCITY),
            acceleration: of_extent(span(|lift| lift.curvature), ACCELERATION),
            angle: ANGLE,
            multiplier: MULTIPLIER,
        }
    }

    /// Rounds every number of a speed; whether all of them are finite.
    fn round(&self, moment: &mut Moment) -> bool {
        let numbers = moment.orbits.iter_mut().flat_map(|orbit| self.numbers(orbit));
        let mut finite = true;
        for (number, places) in numbers.chain([(&mut moment.rpm, self.speed)]) {
            finite &= number.is_finite();
            *number = rounded(*number, places);
        }
        let orbits = moment.orbits.iter_mut().map(|orbit| &mut orbit.path);
        for path in orbits.chain(&mut moment.slowing.paths) {
            for [angle, position] in path.iter_mut() {
                finite &= angle.is_finite() && position.is_finite();
                (*angle, *position) = (rounded(*angle, DRAWN_ANGLE), rounded(*position, self.position));
            }
            path.dedup();
        }
        finite
    }

    /// The numbers of an orbit, each with its places.
    fn numbers<'a>(&self, orbit: &'a mut Shown) -> [(&'a mut f64, i32); 10] {
        let [one, other] = &mut orbit.multipliers;
        [
            (&mut orbit.angle_deg, ANGLE),
            (&mut orbit.from_corner_deg, ANGLE),
            (&mut orbit.position_m, self.position),
            (&mut orbit.velocity_before_m_s, self.velocity),
            (&mut orbit.velocity_after_m_s, self.velocity),
            (&mut one.re, MULTIPLIER),
            (&mut one.im, MULTIPLIER),
            (&mut other.re, MULTIPLIER),
            (&mut other.im, MULTIPLIER),
            (&mut orbit.modulus, MULTIPLIER),
        ]
    }
}

/// The places after the point that give the extent of a quantity so many digits.
fn of_extent(extent: f64, digits: i32) -> i32 {
    const MOST: i32 = 15;
    if !(extent > 0.0 && extent.is_finite()) {
        return digits;
    }
    (digits - 1 - elementary::log10(extent).floor() as i32).clamp(0, MOST)
}

fn rounded(value: f64, places: i32) -> f64 {
    let scale = 10_f64.powi(places);
    // Without the sign of a zero.
    (value * scale).round() / scale + 0.0
}

impl ThroughCorner {
    /// The motions `frames` of a machine by rising speed, of which that of index `at_corner` has its impact at `corner`, rad.
    ///
    /// An error where a number is not finite: the page's data have no way to write one.
    pub fn new((mut frames, at_corner): (Vec<Moment>, usize), cam: &Cam, corner: f64) -> Result<Self, NotFinite> {
        let (corner_deg, profile, marks) = (corner.to_degrees(), profile(cam), corner_marks(cam));
        let places = Places::new(&frames, &profile);
        for moment in &mut frames {
            let rpm = moment.rpm;
            if !places.round(moment) {
                return Err(NotFinite { rpm });
            }
        }
        let told = |(angle, lift): &(f64, Lift)| {
            let angle = rounded(angle.to_degrees(), ANGLE);
            [angle, rounded(lift.value, places.position), rounded(lift.curvature, places.acceleration)]
        };
        let (cam, drawn_on_m): (Vec<[f64; 3]>, f64) = (profile.iter().map(told).collect(), Outline::new(cam).added);
        // Not every corner has a label of its own.
        let unnamed = CornerMark { angle_rad: corner, name: String::new() };
        let hit = marks.iter().find(|mark| mark.angle_rad == corner).unwrap_or(&unnamed);
        let [_, high] = extent(cam.iter().map(|point| point[1]));
        Ok(Self {
            places,
            corner: hit.label(),
            corner_deg: rounded(corner_deg, ANGLE),
            at_corner,
            axes: Axes::new(&frames, &cam, corner_deg),
            drawn_on_m,
            drawn_radius_m: high + drawn_on_m,
            corners: marks.iter().map(|mark| (rounded(mark.angle_rad.to_degrees(), ANGLE), mark.label())).collect(),
            cam,
            frames,
        })
    }
}

impl ThroughCorner {
    /// With the lengths on its axes told in the length of a model.
    pub(crate) fn in_units(mut self, units: &Units) -> Self {
        if units.are_given {
            for axis in [&mut self.axes.position, &mut self.axes.acceleration] {
                // Behind a power of ten, if there is one.
                let (power, unit) = axis.unit.rsplit_once(' ').unwrap_or(("", &axis.unit));
                axis.unit = format!("{power} {}", units.spelled(unit)).trim().to_owned();
            }
        }
        self
    }
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
    fn new(frames: &[Moment], cam: &[[f64; 3]], corner_deg: f64) -> Self {
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
