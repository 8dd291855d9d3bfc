//! Trapping regions of the local map, which prove that a motion stays bounded.
//!
//! A motion that has not left for some thousand steps may still leave: near the end of an attractor, motions stay for millions of steps and
//! then leave. A region that the map sends into its own interior proves that they stay. Here it consists of convex polygons, one for each
//! word of the last few sides visited. A side's part of a polygon has a convex image, so that only its corners need a check. A polygon
//! starts as the hull of the visited points and grows to include images outside it, until none is outside. Most attractors need one
//! polygon; attractors in several pieces need one for each side visited last.

use nalgebra::Vector2;

use super::local_map::LocalMap;
use crate::cam::Side;
use crate::tolerance;

/// Largest length of the words of sides by which polygons are distinguished.
const LONGEST_MEMORY: u32 = 3;
/// Number of rounds of growth after which the search fails.
const ROUNDS: usize = 400;

/// Corners of a convex polygon, counter-clockwise, in units in which the motion has size 1; two for a segment.
type Polygon = Vec<Vector2<f64>>;

/// Region that the map sends into its own interior.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TrappingRegion {
    /// Number of convex polygons.
    pub polygons: usize,
    /// Total number of corners.
    pub corners: usize,
}

impl LocalMap {
    /// Finds a region around the `visited` points of one motion, in order and all at `mu`, that the map sends into its interior by
    /// [`tolerance::TRAPPED`]. The motion then stays in it for ever. `None` if no region was found, although one may exist.
    pub fn region(&self, visited: &[Vector2<f64>], mu: f64) -> Option<TrappingRegion> {
        let scaled = Scaled { map: self, mu, units: self.units() };
        (0..=LONGEST_MEMORY).find_map(|memory| scaled.region(visited, memory))
    }
}

struct Scaled<'a> {
    map: &'a LocalMap,
    mu: f64,
    units: Vector2<f64>,
}

impl Scaled<'_> {
    /// Region with one polygon for each word of `memory` sides.
    fn region(&self, visited: &[Vector2<f64>], memory: u32) -> Option<TrappingRegion> {
        // Too few points give no word, so there is no region.
        if visited.len() <= memory as usize {
            return None;
        }
        let words = 1_usize << memory;
        let next = |word: usize, side: Side| ((word << 1) | usize::from(side == Side::Plus)) & (words - 1);
        let mut clouds = vec![Vec::new(); words];
        let mut word = 0;
        for (step, point) in visited.iter().enumerate() {
            // Before that, the word is not yet a word of the motion.
            if step >= memory as usize {
                clouds.get_mut(word)?.push(point.component_div(&self.units));
            }
            word = next(word, self.map.side(*point, self.mu));
        }
        let largest = visited.iter().map(|point| point.component_div(&self.units).amax()).fold(0.0, f64::max);
        if largest == 0.0 {
            return None;
        }
        let mut polygons: Vec<Polygon> = clouds.into_iter().map(hull).collect();
        for _ in 0..ROUNDS {
            let mut sent_out = vec![Vec::new(); words];
            for (word, polygon) in polygons.iter().enumerate() {
                for side in [Side::Minus, Side::Plus] {
                    let to = next(word, side);
                    let images = self.part(polygon, side).into_iter().map(|corner| self.image(corner, side));
                    let target = polygons.get(to)?;
                    sent_out.get_mut(to)?.extend(images.filter(|image| !is_inside(target, *image, largest)));
                }
            }
            if sent_out.iter().all(Vec::is_empty) {
                let corners = polygons.iter().map(Vec::len).sum();
                return Some(TrappingRegion {
                    polygons: polygons.iter().filter(|polygon| !polygon.is_empty()).count(),
                    corners,
                });
            }
            for (polygon, out) in polygons.iter_mut().zip(sent_out).filter(|(_, out)| !out.is_empty()) {
                let center = polygon.iter().sum::<Vector2<f64>>() / polygon.len().max(1) as f64;
                // A little further than necessary, so that the growth ends.
                polygon.extend(out.iter().map(|image| image + (image - center) * tolerance::TAKEN_IN.value));
                *polygon = hull(std::mem::take(polygon));
            }
            // A motion that leaves has no region.
            if polygons.iter().flatten().any(|corner| !(corner.amax() * tolerance::LEAVING.value < largest)) {
                return None;
            }
        }
        None
    }

    /// Height `e x + f mu` in these units.
    fn height(&self, point: Vector2<f64>) -> f64 {
        self.map.height(point.component_mul(&self.units), self.mu).0
    }

    fn image(&self, point: Vector2<f64>, side: Side) -> Vector2<f64> {
        let map = self.map.of(side);
        (map.a * point.component_mul(&self.units) + map.b * self.mu).component_div(&self.units)
    }

    /// Corners of a side's part of a polygon.
    fn part(&self, polygon: &Polygon, side: Side) -> Polygon {
        let sign = if side == Side::Minus { -1.0 } else { 1.0 };
        let mut part = Vec::new();
        for (from, to) in edges(polygon) {
            let (one, other) = (sign * self.height(from), sign * self.height(to));
            if one >= 0.0 {
                part.push(from);
            }
            if one * other < 0.0 {
                part.push(from + (to - from) * (one / (one - other)));
            }
        }
        part
    }
}

/// Edges of a polygon; for a point, one edge of length 0.
fn edges(polygon: &Polygon) -> impl Iterator<Item = (Vector2<f64>, Vector2<f64>)> {
    polygon.iter().zip(polygon.iter().cycle().skip(1)).map(|(from, to)| (*from, *to))
}

/// Twice the area of a triangle, positive if `third` is on the left of the line from `first` to `second`.
fn turn(first: Vector2<f64>, second: Vector2<f64>, third: Vector2<f64>) -> f64 {
    (second - first).perp(&(third - first))
}

/// Whether a point lies inside a polygon by a margin: [`tolerance::TRAPPED`] times `largest`.
///
/// A segment has no interior: the margin across it is 0, because a map of a line does not move points across.
fn is_inside(polygon: &Polygon, point: Vector2<f64>, largest: f64) -> bool {
    let margin = tolerance::TRAPPED.value * largest;
    match polygon.as_slice() {
        [] | [_] => false,
        [from, to] => {
            let along = to - from;
            let (part, length) = ((point - from).dot(&along) / along.norm(), along.norm());
            turn(*from, *to, point) == 0.0 && part >= margin && part <= length - margin
        }
        _ => edges(polygon).all(|(from, to)| turn(from, to, point) >= margin * (to - from).norm()),
    }
}

/// Convex hull, by the monotone chain of Andrew (1979).
fn hull(mut points: Vec<Vector2<f64>>) -> Polygon {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let mut corners = half(points.iter().copied());
    corners.extend(half(points.iter().rev().copied()));
    corners
}

/// Lower half of a hull, from points sorted to the right, without its last corner; or the upper half from points sorted to the left.
fn half(points: impl Iterator<Item = Vector2<f64>>) -> Polygon {
    let row = |points: &Polygon| match points.as_slice() {
        [.., before, last] => Some((*before, *last)),
        _ => None,
    };
    let mut corners = Polygon::new();
    for point in points {
        while row(&corners).is_some_and(|(before, last)| turn(before, last, point) <= 0.0) {
            corners.pop();
        }
        corners.push(point);
    }
    corners.pop();
    corners
}
