//! Points counted on a grid finer than print: any number of them in bounded memory.

use crate::elementary;
use serde::{Serialize, Serializer};

use super::layout::{LARGEST, widened};

/// Cells across and up: three to a unit of a full-width figure, about 300 to the inch in print.
const CELLS: [usize; 2] = [1800, 1200];

/// How many shades a cell may have.
pub(crate) const SHADES: u8 = 5;

/// How many points are kept before a range is chosen for them.
const KEPT: usize = 4096;

/// The grid never covers more than this many times the range that it started with: a first speed's points may all be one,
/// to rounding, and any later range shows all of them; only what would make a range overflow is left out.
const GROWTH: f64 = 1e18;

/// How many points fell into each cell of a grid over fixed ranges; points may be pushed for ever.
///
/// The finer the ranges fit what is shown, the finer it is drawn: [`Cloud`] finds the vertical one by itself.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Density {
    x: [f64; 2],
    y: [f64; 2],
    columns: usize,
    rows: usize,
    /// `[cell, count]` where there are any; a cell is its row, from below, times the columns, plus its column. A count
    /// stops at 65535: shades go by its logarithm, and two bytes a cell are half the memory of a picture.
    #[serde(serialize_with = "occupied")]
    counts: Vec<u16>,
    outside: u64,
}

fn occupied<S: Serializer>(counts: &[u16], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(counts.iter().enumerate().filter(|(_, count)| **count > 0))
}

/// Where `value` lies in `range`, of one; nothing outside it, nor what is not a number.
fn share(value: f64, [low, high]: [f64; 2]) -> Option<f64> {
    let share = (value - low) / (high - low);
    (0.0..=1.0).contains(&share).then_some(share)
}

impl Density {
    /// An empty grid over these ranges, the lower end first. Nothing falls into a grid whose ranges are none.
    pub fn new(x: [f64; 2], y: [f64; 2]) -> Self {
        let [columns, rows] = CELLS;
        Self { x, y, columns, rows, counts: vec![0; columns * rows], outside: 0 }
    }

    /// Counts a point; one outside the ranges is only counted as such.
    pub fn push(&mut self, x: f64, y: f64) {
        match share(x, self.x).zip(share(y, self.y)) {
            Some((right, up)) => {
                let column = ((right * self.columns as f64) as usize).min(self.columns - 1);
                let row = ((up * self.rows as f64) as usize).min(self.rows - 1);
                let count = &mut self.counts[row * self.columns + column];
                *count = count.saturating_add(1);
            }
            None => self.outside += 1,
        }
    }

    /// Counts every cell that the straight line between two points runs through; of a long line `most` of them, evenly.
    pub(crate) fn join(&mut self, from: [f64; 2], to: [f64; 2], most: usize) {
        let wide = (to[0] - from[0]).abs() / (self.x[1] - self.x[0]) * self.columns as f64;
        let high = (to[1] - from[1]).abs() / (self.y[1] - self.y[0]) * self.rows as f64;
        let steps = wide.max(high).min(most as f64).max(1.0).ceil();
        for step in 0..steps as usize {
            let share = (step as f64 + 0.5) / steps;
            self.push(from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1]));
        }
    }

    /// The ranges that it covers, across and up.
    pub(crate) fn ranges(&self) -> [[f64; 2]; 2] {
        [self.x, self.y]
    }

    pub(crate) fn cells(&self) -> [usize; 2] {
        [self.columns, self.rows]
    }

    /// The middle of each cell that has a point, and how many it has.
    pub(crate) fn counted(&self) -> impl Iterator<Item = ([f64; 2], u16)> {
        let middle = |index: usize, count: usize, [low, high]: [f64; 2]| {
            low + (high - low) * (index as f64 + 0.5) / count as f64
        };
        let counts = self.counts.iter().enumerate().filter(|(_, count)| **count > 0);
        counts.map(move |(cell, count)| {
            let [column, row] = [cell % self.columns, cell / self.columns];
            ([middle(column, self.columns, self.x), middle(row, self.rows, self.y)], *count)
        })
    }

    /// How many cells have a point.
    pub fn occupied(&self) -> usize {
        self.counts.iter().filter(|count| **count > 0).count()
    }

    /// How many points were outside the ranges or not numbers.
    pub fn outside(&self) -> u64 {
        self.outside
    }

    /// The lowest and highest of the rows that have points, as values; nothing where none has.
    pub fn extent(&self) -> Option<[f64; 2]> {
        let has =
            |row: &usize| self.counts[row * self.columns..(row + 1) * self.columns].iter().any(|count| *count > 0);
        let (low, high) = ((0..self.rows).find(has)?, (0..self.rows).rev().find(has)?);
        let at = |row: usize| self.y[0] + (self.y[1] - self.y[0]) * row as f64 / self.rows as f64;
        Some([at(low), at(high + 1)])
    }

    /// A shade for each cell, by the logarithm of the count. With `spread`, a point also shades the eight cells around it, so that
    /// single points are still seen in print.
    pub(crate) fn shades(&self, spread: bool) -> Shades {
        // How many cells have each count: sorted, they would take as much memory as the grid.
        let most = self.counts.iter().max().copied().unwrap_or(0);
        let mut cells = vec![0_u32; usize::from(most) + 1];
        self.counts.iter().for_each(|count| cells[usize::from(*count)] += 1);
        // Periodic motions fall into few cells many times: the densest tenth may not push the rest into the faintest shade.
        let mut denser = self.occupied() / 10;
        let full = (1..cells.len()).rev().find(|count| {
            let here = cells[*count] as usize;
            let found = here > denser;
            denser = denser.saturating_sub(here);
            found
        });
        let full = full.unwrap_or(1) as f64;
        let shade = |count: usize| {
            let share = elementary::ln_1p(count as f64) / elementary::ln_1p(full.max(2.0));
            if count == 0 { 0 } else { ((share * f64::from(SHADES)) as u8).clamp(1, SHADES) }
        };
        let by_count: Vec<u8> = (0..=usize::from(most)).map(shade).collect();
        let reach = usize::from(spread);
        let mut packed = Vec::with_capacity(self.columns.div_ceil(2) * self.rows);
        for row in 0..self.rows {
            // The shade of the most is the strongest of the shades.
            let near = row.saturating_sub(reach)..(row + reach + 1).min(self.rows);
            let mut upright = vec![0; self.columns];
            for counts in self.counts.chunks(self.columns).skip(near.start).take(near.len()) {
                upright.iter_mut().zip(counts).for_each(|(most, count)| *most = (*count).max(*most));
            }
            let shade = |at: usize| {
                let near = &upright[at.saturating_sub(reach)..(at + reach + 1).min(self.columns)];
                by_count[usize::from(near.iter().max().copied().unwrap_or(0))]
            };
            let pair = |at: usize| (shade(at) << 4) | if at + 1 < self.columns { shade(at + 1) } else { 0 };
            packed.extend((0..self.columns).step_by(2).map(pair));
        }
        Shades { columns: self.columns, packed }
    }

    /// Twice the range upwards or downwards at half the resolution, so that `y` comes nearer.
    fn double(&mut self, upwards: bool) {
        let span = self.y[1] - self.y[0];
        let mut counts = vec![0_u16; self.counts.len()];
        let shift = if upwards { 0 } else { self.rows / 2 };
        for (at, count) in self.counts.iter().enumerate() {
            let (row, column) = (at / self.columns, at % self.columns);
            let into = &mut counts[(row / 2 + shift) * self.columns + column];
            *into = into.saturating_add(*count);
        }
        self.counts = counts;
        if upwards { self.y[1] += span } else { self.y[0] -= span }
    }
}

/// A shade for each cell of a grid, 0 for none, else 1 to [`SHADES`]: two in a byte, as a picture is drawn beside the counts of its
/// grid, and as a PNG of few colours holds them.
pub(crate) struct Shades {
    columns: usize,
    packed: Vec<u8>,
}

impl Shades {
    pub(crate) fn columns(&self) -> usize {
        self.columns
    }

    /// The rows from below, two cells in a byte.
    pub(crate) fn rows(&self) -> std::slice::Chunks<'_, u8> {
        self.packed.chunks(self.columns.div_ceil(2))
    }

    /// The cells of a row.
    pub(crate) fn cells(&self, row: &[u8]) -> impl Iterator<Item = u8> {
        row.iter().flat_map(|pair| [pair >> 4, pair & 15]).take(self.columns)
    }

    /// The full shade wherever there is any.
    pub(crate) fn solid(mut self) -> Self {
        let full = |shade: u8| if shade == 0 { 0 } else { SHADES };
        self.packed.iter_mut().for_each(|pair| *pair = (full(*pair >> 4) << 4) | full(*pair & 15));
        self
    }
}

/// Points whose vertical range is not known beforehand: a [`Density`] that starts from the first few thousand and grows.
#[derive(Clone, Debug)]
pub struct Cloud {
    x: [f64; 2],
    kept: Vec<[f64; 2]>,
    grid: Option<(Density, f64)>,
}

impl Cloud {
    /// No points yet; `x` is the horizontal range.
    pub fn new(x: [f64; 2]) -> Self {
        Self { x, kept: Vec::new(), grid: None }
    }

    /// Counts a point.
    pub fn push(&mut self, x: f64, y: f64) {
        if self.grid.is_none() {
            self.kept.push([x, y]);
            if self.kept.len() >= KEPT {
                self.settle();
            }
        } else if let Some((grid, first_span)) = &mut self.grid {
            let [low, high] = grid.y;
            let reach = GROWTH * *first_span;
            if y > low - reach && y < high + reach {
                while (y > grid.y[1] || y < grid.y[0]) && grid.y[1] - grid.y[0] < reach {
                    grid.double(y > grid.y[1]);
                }
            }
            grid.push(x, y);
        }
    }

    /// The grid of every point so far.
    pub fn finish(mut self) -> Density {
        self.settle();
        self.grid.map_or_else(|| Density::new(self.x, [0.0, 1.0]), |(grid, _)| grid)
    }

    /// Chooses a range from the points kept, with a little room.
    fn settle(&mut self) {
        if self.grid.is_some() {
            return;
        }
        let drawn = self.kept.iter().map(|[_, y]| *y).filter(|y| y.abs() < LARGEST);
        let [low, high] = super::extent(drawn);
        let range = widened(if low <= high { [low, high] } else { [0.0, 1.0] }, 0.02);
        let mut grid = Density::new(self.x, range);
        for [x, y] in std::mem::take(&mut self.kept) {
            grid.push(x, y);
        }
        self.grid = Some((grid, range[1] - range[0]));
    }
}
