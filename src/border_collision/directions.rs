//! Directions in which motions of the local map diverge at the corner impact, by interval arithmetic.
//!
//! At mu = 0 the map is `F(x) = A x` with the matrix of the side of x. It sends rays to rays, so that it is a map of the circle of
//! directions with a growth factor along each. Points on the edge of a square divide the directions into sectors. For each sector,
//! intervals give
//!
//! ```text
//! the sectors that its image may meet,     r = a lower bound of |F(x)|/|x|,   |x| = max(|x_1|, |x_2|)
//! h(sector) = r min over those sectors of max(1, h)
//! ```
//!
//! The iteration rises from h = 0. A motion that starts in a sector with h > 1 has grown by h or more after some of its first steps. If no
//! image leaves a set of such sectors, every motion in its directions diverges. The largest such set is found. If it contains all sectors,
//! the motion of every start but 0 diverges. Often isolated rays along which motions may shrink are left out.

use nalgebra::Vector2;

use super::local_map::LocalMap;
use crate::cam::Side;
use crate::elementary;
use crate::interval::Interval;

/// Numbers of sectors on half an edge of the square; the proof is first tried with few. Powers of two make the points between sectors
/// exact.
const HALF_EDGES: [usize; 2] = [64, 1024];
/// Largest number of rounds of the iteration. Most maps need a few dozen.
const ROUNDS: usize = 512;
/// Bound on growth above which more growth proves nothing more.
const ENOUGH: f64 = 1e6;
/// Number of points by which a guessed end of an image may be moved until it is certain.
const MOVED: usize = 3;

/// Local map at mu = 0, for all matrices and borders in intervals.
#[derive(Clone, Copy, Debug)]
pub struct Homogeneous {
    /// Matrices A by rows, minus first.
    matrices: [[[Interval; 2]; 2]; 2],
    /// Border e.
    border: [Interval; 2],
}

/// Image of a sector under one side's matrix.
struct Image {
    /// Lower bound of the growth.
    growth: f64,
    /// Sectors that it meets: the first, and their number.
    sectors: (usize, usize),
}

impl Homogeneous {
    /// Builds the map from the matrices by rows, minus first, and e, in coordinates with about these units.
    pub fn new(matrices: [[[Interval; 2]; 2]; 2], border: [Interval; 2], units: Vector2<f64>) -> Self {
        // Powers of two, so that the change of units is exact.
        let [one, two] = [units[0], units[1]].map(|unit| 2.0_f64.powi(elementary::log2(unit).round() as i32));
        let matrices = matrices.map(|[[a, b], [c, d]]| [[a, b * (two / one)], [c * (one / two), d]]);
        Self { matrices, border: [border[0] * one, border[1] * two] }
    }

    /// Lower bound of the share of sectors in which every motion provably diverges; 1 if all diverge. The search is thorough if `is_likely`
    /// is set.
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
        // Removes sectors whose image leaves the set, until no image leaves it.
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

    /// Images of a sector, one for each side on which a part of it may be.
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

    /// Image between the images of a sector's ends; `None` if it is not certain.
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
        // Indices continue around the square. The whole image lies to the left of its first point, and to the right of its last point.
        let is_right_of = |index: usize| [start, end].iter().all(|of| cross(corner(index), *of).is_positive());
        let is_left_of = |index: usize| [start, end].iter().all(|of| cross(*of, corner(index)).is_positive());
        let (from, to) = (at(start)?.floor() as usize + count, at(end)?.ceil() as usize + count);
        let first = (0..MOVED).map(|moved| from - moved).find(|index| is_right_of(*index))?;
        let last = (0..MOVED).map(|moved| to + moved).find(|index| is_left_of(*index))?;
        if !cross(corner(first), corner(last)).is_positive() {
            return None;
        }
        let sectors = (first, (last + count - first) % count);
        // The norm |x| is 1 on the edge of the square.
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

/// Point on the edge of the square, counted counter-clockwise from its lower right corner.
fn point(index: usize, half_edge: usize) -> [f64; 2] {
    let along = (index % (2 * half_edge)) as f64 / half_edge as f64 - 1.0;
    match (index / (2 * half_edge)) % 4 {
        0 => [1.0, along],
        1 => [-along, 1.0],
        2 => [-1.0, -along],
        _ => [along, -1.0],
    }
}

/// Unrounded index of the intersection of the ray through `(x, y)` with the edge of the square; `None` for the zero vector.
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
    /// Map at mu = 0, with its doubles taken as exact.
    pub fn homogeneous(&self) -> Homogeneous {
        let rows = |side| {
            let a = self.of(side).a;
            [0, 1].map(|row| [0, 1].map(|column| Interval::from(a[(row, column)])))
        };
        let (e, _) = self.border;
        Homogeneous::new([Side::Minus, Side::Plus].map(rows), [e[0], e[1]].map(Interval::from), self.units())
    }
}
