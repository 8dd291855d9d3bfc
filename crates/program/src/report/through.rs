//! The motion at speeds on either side of the corner impact, as a document for the slider of the page. Numbers are
//! rounded to the precision of a picture or its readout.

use serde::Serialize;

use crate::figures::through_corner::{ImpactSide, Moment, ShownOrbit, profile};
use crate::figures::{CornerMark, corner_marks};
use corner_impact::cam::{Cam, Lift, Outline};
use corner_impact::elementary;
use corner_impact::model::Units;
use corner_impact_plot::ticks::{ticks, unit};
use corner_impact_plot::{TickSpacing, extent};

/// Reason why there is nothing to show.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("at {rpm} rpm a number of the motion is not finite")]
pub struct NotFinite {
    /// Speed, rpm.
    pub rpm: f64,
}

/// Data of the slider.
#[derive(Clone, Debug, Serialize)]
pub struct ThroughCorner {
    /// Decimal places of its numbers.
    pub places: DecimalPlaces,
    /// Letter of the corner, or its cam angle.
    pub corner: String,
    /// Cam angle of the corner, deg.
    pub corner_deg: f64,
    /// Index of the frame at the corner impact.
    pub at_corner: usize,
    /// Axes of the drawings.
    pub axes: Axes,
    /// Profile: angle, deg; lift, m; acceleration, m/rad^2. Each corner appears twice, with the law before it and the law after it.
    pub cam: Vec<[f64; 3]>,
    /// Radius added to the lift where the cam is drawn as a shape, m.
    pub drawn_on_m: f64,
    /// Largest radius of the drawn shape, m.
    pub drawn_radius_m: f64,
    /// Labelled corners: angle, deg, and label.
    pub corners: Vec<(f64, String)>,
    /// Frames in order of rising speed.
    pub frames: Vec<Moment>,
}

/// Axes of the drawings.
#[derive(Clone, Debug, Serialize)]
pub struct Axes {
    /// Speed, rpm.
    pub speed: AxisEntry,
    /// Cam angle over one revolution, deg.
    pub angle: AxisEntry,
    /// Position, m.
    pub position: AxisEntry,
    /// Cam angles of impacts near the corner, deg.
    pub near: AxisEntry,
    /// Acceleration of the cam near the corner, m/rad^2.
    pub acceleration: AxisEntry,
    /// Real and imaginary part of multipliers.
    pub plane: AxisEntry,
}

/// An axis.
#[derive(Clone, Debug, Serialize)]
pub struct AxisEntry {
    /// Ends of the axis.
    pub range: [f64; 2],
    /// Unit, with the power of ten by which labels are multiplied.
    pub unit: String,
    /// Positions and labels of the ticks.
    pub ticks: Vec<(f64, String)>,
}

/// Decimal places of an angle in degrees, and of an angle that is only drawn.
const ANGLE: i32 = 4;
const DRAWN_ANGLE: i32 = 1;
/// Significant digits relative to a quantity's extent: more than a picture can show, few enough to keep the page small.
const POSITION: i32 = 5;
const VELOCITY: i32 = 6;
const ACCELERATION: i32 = 5;
/// Decimal places of a multiplier.
const MULTIPLIER: i32 = 6;
/// Largest real or imaginary part of a multiplier for which the plane has room.
const WIDEST: f64 = 2.5;
/// Margin of an axis, as a share of its data.
const MARGIN: f64 = 0.06;

/// Decimal places of each quantity; they depend on the model, because its unit of length may be any.
#[derive(Clone, Copy, Debug, Serialize)]
#[expect(missing_docs, reason = "each is of the quantity that it is named after")]
pub struct DecimalPlaces {
    /// Enough places that neighbouring frames differ.
    pub speed: i32,
    /// Places that follow from the cam's travel.
    pub position: i32,
    pub velocity: i32,
    pub acceleration: i32,
    pub angle: i32,
    pub multiplier: i32,
}

impl DecimalPlaces {
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

    /// Rounds all numbers of a frame; returns whether all are finite.
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

    /// Numbers of an orbit, each with its decimal places.
    fn numbers<'a>(&self, orbit: &'a mut ShownOrbit) -> [(&'a mut f64, i32); 10] {
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

/// Decimal places that give the extent of a quantity this many digits.
fn of_extent(extent: f64, digits: i32) -> i32 {
    const MOST: i32 = 15;
    if !(extent > 0.0 && extent.is_finite()) {
        return digits;
    }
    (digits - 1 - elementary::log10(extent).floor() as i32).clamp(0, MOST)
}

fn rounded(value: f64, places: i32) -> f64 {
    let scale = 10_f64.powi(places);
    // Adding 0 removes the sign of a negative zero.
    (value * scale).round() / scale + 0.0
}

impl ThroughCorner {
    /// Collects the motions `frames` of a machine, by rising speed. The frame `at_corner` has its impact at the cam angle `corner`, rad.
    ///
    /// Fails if a number is not finite, because the page's data cannot represent it.
    pub fn new((mut frames, at_corner): (Vec<Moment>, usize), cam: &Cam, corner: f64) -> Result<Self, NotFinite> {
        let (corner_deg, profile, marks) = (corner.to_degrees(), profile(cam), corner_marks(cam));
        let places = DecimalPlaces::new(&frames, &profile);
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
        let (cam, drawn_on_m): (Vec<[f64; 3]>, f64) =
            (profile.iter().map(told).collect(), Outline::new(cam, None).added);
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
    /// Converts the lengths on its axes to the model's unit.
    pub(crate) fn in_units(mut self, units: &Units) -> Self {
        if units.are_given {
            for axis in [&mut self.axes.position, &mut self.axes.acceleration] {
                // The unit follows a power of ten, if there is one.
                let (power, unit) = axis.unit.rsplit_once(' ').unwrap_or(("", &axis.unit));
                axis.unit = format!("{power} {}", units.spelled(unit)).trim().to_owned();
            }
        }
        self
    }
}

impl AxisEntry {
    fn over([low, high]: [f64; 2], name: &str, spacing: TickSpacing, most: usize) -> Self {
        let found = ticks([low, high], spacing, most, |_| true);
        Self {
            range: [low, high],
            unit: unit(name, found.exponent),
            ticks: found.ticks.into_iter().map(|tick| (tick.at, tick.label)).collect(),
        }
    }

    fn around([low, high]: [f64; 2], name: &str, most: usize) -> Self {
        // A constant also gets room above and below.
        let wide = if high > low { high - low } else { high.abs().max(1.0) };
        Self::over([low - MARGIN * wide, high + MARGIN * wide], name, TickSpacing::Decimal, most)
    }
}

impl Axes {
    fn new(frames: &[Moment], cam: &[[f64; 3]], corner_deg: f64) -> Self {
        let orbits = || frames.iter().flat_map(|frame| &frame.orbits);
        let of_orbits = orbits().flat_map(|orbit| &orbit.path);
        let of_runs = frames.iter().flat_map(|frame| frame.slowing.paths.iter().flatten());
        let lifts = cam.iter().map(|point| point[1]);
        let positions = extent(of_orbits.chain(of_runs).map(|point| point[1]).chain(lifts));
        let beside = orbits().filter(|orbit| orbit.place != ImpactSide::Elsewhere);
        let [first, last] = extent(beside.map(|orbit| corner_deg + orbit.from_corner_deg).chain([corner_deg]));
        // At least a few degrees, so that the corner is visible even if nothing moves across it.
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
            speed: AxisEntry::over(speeds, "rpm", TickSpacing::Decimal, 6),
            angle: AxisEntry::over([0.0, 360.0], "deg", TickSpacing::Degrees, 5),
            position: AxisEntry::around(positions, "m", 6),
            near: AxisEntry::over(near, "deg", TickSpacing::Degrees, 6),
            acceleration: AxisEntry::around(accelerations, "m/rad²", 6),
            plane: AxisEntry::over([-plane, plane], "", TickSpacing::Decimal, 5),
        }
    }
}
