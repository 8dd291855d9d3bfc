//! Coordinates of an h-set, and the images of boxes in them.

use super::map::{Impact, ImpactMap, Over, UnprovedFlight};
use super::{HSet, Strip};
use crate::interval::mean_value_form::MeanValueForm;
use crate::interval::{Interval, Number};

/// Box of x, y and the speed of the cam, rad/s.
pub type SectionBox = [Interval; 3];

/// Coordinates of an h-set.
#[derive(Debug)]
pub struct HSetFrame {
    centre: [Interval; 2],
    unstable: [Interval; 2],
    stable: [Interval; 2],
}

/// Image of a box of a strip.
#[derive(Clone, Copy, Debug)]
pub struct Image {
    /// Coordinates x and y at the box's centre.
    pub centre: [Interval; 2],
    /// Coordinates x and y over the whole box.
    pub value: [Interval; 2],
    /// Derivatives of these with respect to x, y and the speed.
    pub by: [[Interval; 3]; 2],
}

/// Returns the radians in a degree.
fn degree() -> Interval {
    Interval::TURN / 360.0
}

/// Converts a range of speeds from rpm to rad/s.
pub(super) fn angular_velocities([low, high]: [f64; 2]) -> Interval {
    Interval::new(low, high) * Interval::TURN / 60.0
}

impl HSetFrame {
    /// Builds the coordinates of an h-set.
    pub fn new(set: &HSet) -> Self {
        let number = |pair: [f64; 2]| pair.map(Interval::from);
        Self { centre: number(set.centre), unstable: number(set.unstable), stable: number(set.stable) }
    }

    /// Impact at x and y.
    fn impact<'a>(&self, [x, y]: [Over<'a>; 2]) -> Impact<'a> {
        let along = |side: usize| x * self.unstable[side] + y * self.stable[side] + self.centre[side];
        Impact { angle: along(0) * degree(), velocity: along(1), turns: 0 }
    }

    /// Rectangles that together contain a strip of an h-set: the cam's angle, rad, and the velocity, m/s.
    pub fn rectangles(&self, set: &HSet, strip: &Strip) -> Vec<[Interval; 2]> {
        /// Number of parts of either side. The rectangles reach beyond the strip by at most one part.
        const PARTS: usize = 64;
        let part = |[low, high]: [f64; 2], part: usize| {
            let at = |part: usize| low + (high - low) * part as f64 / PARTS as f64;
            Interval::new(at(part), if part + 1 == PARTS { high } else { at(part + 1) })
        };
        let parts = (0..PARTS).flat_map(|x| (0..PARTS).map(move |y| [x, y]));
        let rectangle = |[x, y]: [usize; 2]| {
            let (x, y) = (part(strip.x, x), part(set.y, y));
            let along = |side: usize| x * self.unstable[side] + y * self.stable[side] + self.centre[side];
            [along(0) * degree(), along(1)]
        };
        parts.map(rectangle).collect()
    }

    /// Coordinates x and y of an impact, less this number of turns of the cam.
    fn coordinates<'a>(&self, impact: &Impact<'a>, revolutions: u64) -> [Over<'a>; 2] {
        let turns = (impact.turns - revolutions as i64) as f64;
        let angle = (impact.angle + Interval::TURN * turns) * (Interval::from(1.0) / degree()) + -self.centre[0];
        let velocity = impact.velocity + -self.centre[1];
        let ([u0, u1], [s0, s1]) = (self.unstable, self.stable);
        let determinant = u0 * s1 - u1 * s0;
        [
            angle * (s1 / determinant) + velocity * -(s0 / determinant),
            angle * -(u1 / determinant) + velocity * (u0 / determinant),
        ]
    }

    /// Encloses the image of a box of a strip.
    pub fn image(&self, map: &ImpactMap<'_>, strip: &Strip, place: &SectionBox) -> Result<Image, UnprovedFlight> {
        let centre = place.map(|side| Interval::from(side.middle()));
        let over = std::array::from_fn(|side| place[side] - centre[side]);
        let [x, y, omega] = std::array::from_fn(|side| MeanValueForm::unknown(side, centre[side], &over));
        let mut impact = self.impact([x, y]);
        for _ in 0..strip.impacts {
            impact = map.next(&impact, omega)?;
        }
        let image = self.coordinates(&impact, strip.revolutions);
        Ok(Image {
            centre: image.map(|side| side.centre),
            value: image.map(|side| side.value()),
            by: image.map(|side| side.whole.by),
        })
    }

    /// Encloses the image of a point, at the middle of a range of speeds, rpm.
    pub(super) fn at_point(
        &self,
        map: &ImpactMap<'_>,
        strip: &Strip,
        [x, y]: [f64; 2],
        rpm: [f64; 2],
    ) -> Result<Image, UnprovedFlight> {
        self.image(map, strip, &[x.into(), y.into(), angular_velocities(rpm).middle().into()])
    }

    /// Derivative with respect to x and y at the centre after this number of impacts, in doubles.
    pub(super) fn derivative(&self, map: &ImpactMap<'_>, impacts: u64, rpm: [f64; 2]) -> Option<[[f64; 2]; 2]> {
        let strip = Strip { impacts, revolutions: 0, x: [0.0; 2] };
        let image = self.at_point(map, &strip, [0.0; 2], rpm).ok()?;
        Some(image.by.map(|row| [row[0].middle(), row[1].middle()]))
    }
}

impl Image {
    /// Least factor by which differences within the cone `|dy| <= L |dx|` are stretched, with the slope L; `None` if the cone may not be
    /// kept.
    pub fn stretched(&self, slope: f64) -> Option<f64> {
        stretched(self.by.map(|[x, y, _]| [x, y]), slope)
    }

    /// Whether the cone is kept at no point of the box.
    pub fn misses(&self, slope: f64) -> bool {
        let least =
            |number: Interval| if number.holds_zero() { 0.0 } else { number.low().abs().min(number.high().abs()) };
        let [[a, b, _], [c, d, _]] = self.by;
        let most = a.magnitude() - slope * least(b);
        most <= 1.0 || least(c) + slope * least(d) > slope * most
    }
}

/// Least factor by which a derivative, by rows, stretches differences within the cone `|dy| <= L |dx|`, with the slope L. `None` if it may
/// not keep the cone.
pub(super) fn stretched([[a, b], [c, d]]: [[Interval; 2]; 2], slope: f64) -> Option<f64> {
    if !(slope > 0.0) {
        return None;
    }
    let size = |number: Interval| Interval::from(number.magnitude());
    // Not above 0 if a may be 0.
    let least = if a.is_positive() { a.low() } else { -a.high() };
    // |a| - L |b| > 1 and |c| + L |d| <= L (|a| - L |b|)
    let growth = Interval::from(least) - size(b) * slope;
    let is_kept = (growth * slope - size(c) - size(d) * slope).low() >= 0.0;
    (growth.low() > 1.0 && is_kept).then_some(growth.low())
}
