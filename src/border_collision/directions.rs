//! Directions in which motions of the local map diverge at the corner impact, by interval arithmetic.
//!
//! At mu = 0 the map is `F(x) = A x` with the matrix of the side that x is on. It sends rays to rays, so that it is a map of the
//! circle of directions and a growth along each. The directions are cut into sectors by points on the edge of a square. For each
//! sector, intervals hold
//!
//! ```text
//! the sectors that its image may meet,     r = a lower bound of |F(x)|/|x|,   |x| = max(|x_1|, |x_2|)
//! h(sector) = r min over those sectors of max(1, h)
//! ```
//!
//! From h = 0 the iteration rises. A motion that starts in a sector with h > 1 has grown after some of its first steps: by h or
//! more. A set of such sectors that no image leaves is therefore a set of directions in which every motion diverges. The largest
//! such set is found; the set of all sectors means that the motion of every start but 0 diverges. Often isolated rays are left out,
//! along which motions may shrink.

use nalgebra::Vector2;

use super::local_map::LocalMap;
use crate::cam::Side;
use crate::elementary;
use crate::interval::Interval;

/// Sectors on half an edge of the square; the proof is tried with few first. Powers of two: the points between sectors are exact.
const HALF_EDGES: [usize; 2] = [64, 1024];
/// Rounds of the iteration. Most maps need a few dozen.
const ROUNDS: usize = 512;
/// A bound of growth above which more growth proves nothing more.
const ENOUGH: f64 = 1e6;
/// Points that a guess of where an image begins or ends is moved by until it is certain.
const MOVED: usize = 3;

/// The local map at mu = 0, for all matrices and borders in intervals.
#[derive(Clone, Copy, Debug)]
pub struct Homogeneous {
    /// A by rows, minus first.
    matrices: [[[Interval; 2]; 2]; 2],
    /// e.
    border: [Interval; 2],
}

/// The image of a sector under one side's matrix.
struct Image {
    /// A lower bound of the growth.
    growth: f64,
    /// The sectors that it meets: the first, and how many.
    sectors: (usize, usize),
}

impl Homogeneous {
    /// From the matrices by rows, minus first, and e, in coordinates with about these units.
    pub fn new(matrices: [[[Interval; 2]; 2]; 2], border: [Interval; 2], units: Vector2<f64>) -> Self {
        // Powers of two, so that the change of units is exact.
        let [one, two] = [units[0], units[1]].map(|unit| 2.0_f64.powi(elementary::log2(unit).round() as i32));
        let matrices = matrices.map(|[[a, b], [c, d]]| [[a, b * (two / one)], [c * (one / two), d]]);
        Self { matrices, border: [border[0] * one, border[1] * two] }
    }

    /// The share of directions in which every motion provably diverges, as a share of the sectors: at least so much, 1 for all. The
    /// search is thorough where `is_likely` says that some do.
    pub fn diverging(&self, is_likely: bool) -> f64 {
        let mut share = 0.0;
        for half_edge in HALF_EDGES {
            share = self.share(half_edge);
            if share == 1.0 || !(is_likely || share > 0.0) {
                break;
            }
        }
        share
    }

    fn share(&self, half_edge: usize) -> f64 {
        let images: Vec<Vec<Image>> = (0..8 * half_edge).map(|sector| self.images(sector, half_edge)).collect();
        let count = images.len();
        let met = |image: &Image| {
            let (first, number) = image.sectors;
            (first..first + number).map(move |sector| sector % count)
        };
        let mut grown = vec![0.0_f64; count];
        for _ in 0..ROUNDS {
            let mut is_done = true;
            for sector in 0..count {
                // h = r min max(1, h)
                let of = |image: &Image| {
                    let next = met(image).map(|to| grown[to].max(1.0)).fold(ENOUGH, f64::min);
                    (image.growth * next).next_down()
                };
                let least = images[sector].iter().map(of).fold(ENOUGH, f64::min);
                if least > grown[sector] {
                    grown[sector] = least;
                    is_done = false;
                }
            }
            if is_done {
                break;
            }
        }
        // What leaves the set is taken out of it, until nothing leaves.
        let mut stays: Vec<bool> = grown.iter().map(|grown| *grown > 1.0).collect();
        loop {
            let leaves = |sector: &usize| stays[*sector] && images[*sector].iter().flat_map(met).any(|to| !stays[to]);
            let leaving: Vec<usize> = (0..count).filter(leaves).collect();
            if leaving.is_empty() {
                break;
            }
            leaving.into_iter().for_each(|sector| stays[sector] = false);
        }
        stays.iter().filter(|stays| **stays).count() as f64 / count as f64
    }

    /// The images of a sector, one for each side that a part of it may be on.
    fn images(&self, sector: usize, half_edge: usize) -> Vec<Image> {
        let ends = [sector, sector + 1].map(|index| point(index, half_edge).map(Interval::from));
        let heights = ends.map(|end| self.border[0] * end[0] + self.border[1] * end[1]);
        let is_on = |side: &usize| match side {
            0 => heights.iter().any(|height| height.low() < 0.0),
            _ => heights.iter().any(|height| height.high() >= 0.0),
        };
        let image = |side: usize| {
            let ends = ends.map(|[x, y]| self.matrices[side].map(|[one, two]| one * x + two * y));
            self.image(ends, half_edge).unwrap_or(Image { growth: 0.0, sectors: (0, 0) })
        };
        [0, 1].into_iter().filter(is_on).map(image).collect()
    }

    /// The image between the images of a sector's ends; none where it is not certain.
    fn image(&self, ends: [[Interval; 2]; 2], half_edge: usize) -> Option<Image> {
        let turn = cross(ends[0], ends[1]);
        let [start, end] = match (turn.is_positive(), turn.is_negative()) {
            (true, _) => ends,
            (_, true) => [ends[1], ends[0]],
            _ => return None,
        };
        let count = 8 * half_edge;
        let at = |[x, y]: [Interval; 2]| place([x.middle(), y.middle()], half_edge);
        let corner = |index: usize| point(index, half_edge).map(Interval::from);
        // Indices go on around the square. The whole image is on the left of the point that it begins after, and on the right of the one that it ends before.
        let is_right_of = |index: usize| [start, end].iter().all(|of| cross(corner(index), *of).is_positive());
        let is_left_of = |index: usize| [start, end].iter().all(|of| cross(*of, corner(index)).is_positive());
        let (from, to) = (at(start)?.floor() as usize + count, at(end)?.ceil() as usize + count);
        let first = (0..MOVED).map(|moved| from - moved).find(|index| is_right_of(*index))?;
        let last = (0..MOVED).map(|moved| to + moved).find(|index| is_left_of(*index))?;
        if !cross(corner(first), corner(last)).is_positive() {
            return None;
        }
        let sectors = (first, (last + count - first) % count);
        // |x| is 1 on the edge of the square.
        let away = |row: usize| {
            let hull = start[row].hull(end[row]);
            hull.low().max(-hull.high()).max(0.0)
        };
        Some(Image { growth: away(0).max(away(1)), sectors })
    }
}

fn cross([a, b]: [Interval; 2], [c, d]: [Interval; 2]) -> Interval {
    a * d - b * c
}

/// A point on the edge of the square, counted counter-clockwise from its lower right corner.
fn point(index: usize, half_edge: usize) -> [f64; 2] {
    let along = (index % (2 * half_edge)) as f64 / half_edge as f64 - 1.0;
    match (index / (2 * half_edge)) % 4 {
        0 => [1.0, along],
        1 => [-along, 1.0],
        2 => [-1.0, -along],
        _ => [along, -1.0],
    }
}

/// The index at which the edge of the square is cut by the ray through `(x, y)`, not rounded to a whole one; none of 0.
fn place([x, y]: [f64; 2], half_edge: usize) -> Option<f64> {
    let size = x.abs().max(y.abs());
    let (x, y) = (x / size, y / size);
    let (edge, along) = match () {
        () if x == 1.0 => (0.0, y),
        () if y == 1.0 => (1.0, -x),
        () if x == -1.0 => (2.0, -y),
        () => (3.0, x),
    };
    let index = (2.0 * edge + 1.0 + along) * half_edge as f64;
    index.is_finite().then_some(index)
}

impl LocalMap {
    /// The map at mu = 0 with its doubles as they are.
    pub fn homogeneous(&self) -> Homogeneous {
        let rows = |side| {
            let a = self.of(side).a;
            [0, 1].map(|row| [0, 1].map(|column| Interval::from(a[(row, column)])))
        };
        let (e, _) = self.border;
        Homogeneous::new([Side::Minus, Side::Plus].map(rows), [e[0], e[1]].map(Interval::from), self.units())
    }
}
