//! Points counted on a grid finer than print: any number of points in bounded memory.

use serde::{Serialize, Serializer};

use super::layout::{LARGEST, widened};

/// Number of cells across and up: three per unit of a full-width figure, about 300 to the inch in print.
const CELLS: [usize; 2] = [1800, 1200];

/// Number of shades of a cell.
pub const SHADES: u8 = 5;

/// Number of points that are stored before a range is chosen for them.
const KEPT: usize = 4096;

/// Largest growth of the grid, as a multiple of its initial range. The limit excludes only points that would make a range overflow: even if
/// the first points all agree up to rounding, any later range shows all of them.
const GROWTH: f64 = 1e18;

/// Counts of points in the cells of a grid over fixed ranges; the number of points is unlimited.
///
/// The closer the ranges fit the data, the finer the picture; [`Cloud`] finds the vertical range itself.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Density {
    x: [f64; 2],
    y: [f64; 2],
    columns: usize,
    rows: usize,
    /// Counts of the cells, serialized as `[cell, count]` for occupied cells. The index of a cell is its row, from below, times the number
    /// of columns, plus its column. A count stops at 65535: shades depend on its logarithm, and two bytes per cell save half the memory.
    #[serde(serialize_with = "occupied")]
    counts: Vec<u16>,
    outside: u64,
}

fn occupied<S: Serializer>(counts: &[u16], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(counts.iter().enumerate().filter(|(_, count)| **count > 0))
}

/// Relative position of `value` in `range`; `None` outside it, or for NaN.
fn share(value: f64, [low, high]: [f64; 2]) -> Option<f64> {
    let share = (value - low) / (high - low);
    (0.0..=1.0).contains(&share).then_some(share)
}

impl Density {
    /// Creates an empty grid over these ranges, the lower end first. A grid with invalid ranges counts no points.
    pub fn new(x: [f64; 2], y: [f64; 2]) -> Self {
        let [columns, rows] = CELLS;
        Self { x, y, columns, rows, counts: vec![0; columns * rows], outside: 0 }
    }

    /// Counts a point; a point outside the ranges only adds to the number of points outside.
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

    /// Counts the cells along the straight line between two points; on a long line, `most` cells, evenly spaced.
    pub fn join(&mut self, from: [f64; 2], to: [f64; 2], most: usize) {
        let wide = (to[0] - from[0]).abs() / (self.x[1] - self.x[0]) * self.columns as f64;
        let high = (to[1] - from[1]).abs() / (self.y[1] - self.y[0]) * self.rows as f64;
        let steps = wide.max(high).min(most as f64).max(1.0).ceil();
        for step in 0..steps as usize {
            let share = (step as f64 + 0.5) / steps;
            self.push(from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1]));
        }
    }

    /// Ranges of the grid, across and up.
    pub fn ranges(&self) -> [[f64; 2]; 2] {
        [self.x, self.y]
    }

    /// Number of cells across and up.
    pub fn cells(&self) -> [usize; 2] {
        [self.columns, self.rows]
    }

    /// Column and row, from below, of each occupied cell, and its count.
    pub fn occupied_cells(&self) -> impl Iterator<Item = ([usize; 2], u16)> {
        let counts = self.counts.iter().enumerate().filter(|(_, count)| **count > 0);
        counts.map(|(cell, count)| ([cell % self.columns, cell / self.columns], *count))
    }

    /// Centre of each occupied cell, and its count.
    pub fn counted(&self) -> impl Iterator<Item = ([f64; 2], u16)> {
        let middle = |index: usize, count: usize, [low, high]: [f64; 2]| {
            low + (high - low) * (index as f64 + 0.5) / count as f64
        };
        self.occupied_cells().map(move |([column, row], count)| {
            ([middle(column, self.columns, self.x), middle(row, self.rows, self.y)], count)
        })
    }

    /// Returns the occupied cells as rectangles, formed by merging equal rows: the centre, width, height and number of cells.
    pub fn rectangles(&self) -> Vec<([f64; 2], [f64; 2], usize)> {
        // Columns of the runs of the row below, and the row in which each rectangle begins.
        let mut open: Vec<(usize, usize, usize)> = Vec::new();
        let mut closed = Vec::new();
        let [wide, high] = [(self.x[1] - self.x[0]) / self.columns as f64, (self.y[1] - self.y[0]) / self.rows as f64];
        let mut close = |(from, to, first): (usize, usize, usize), row: usize| {
            let middle = |low: f64, side: f64, from: usize, to: usize| low + side * 0.5 * (from + to) as f64;
            let at = [middle(self.x[0], wide, from, to), middle(self.y[0], high, first, row)];
            closed.push((at, [wide * (to - from) as f64, high * (row - first) as f64], (to - from) * (row - first)));
        };
        for row in 0..=self.rows {
            let cells = self.counts.get(row * self.columns..(row + 1) * self.columns).unwrap_or_default();
            let mut runs: Vec<(usize, usize)> = Vec::new();
            for (column, _) in cells.iter().enumerate().filter(|(_, count)| **count > 0) {
                match runs.last_mut() {
                    Some((_, to)) if *to == column => *to += 1,
                    _ => runs.push((column, column + 1)),
                }
            }
            let (go_on, end): (Vec<_>, Vec<_>) = open.iter().partition(|(from, to, _)| runs.contains(&(*from, *to)));
            end.into_iter().for_each(|rectangle| close(rectangle, row));
            let begun = runs.into_iter().filter(|(from, to)| !go_on.iter().any(|(a, b, _)| (a, b) == (from, to)));
            let begun: Vec<_> = begun.map(|(from, to)| (from, to, row)).collect();
            open = go_on.into_iter().chain(begun).collect();
        }
        closed
    }

    /// Number of occupied cells.
    pub fn occupied(&self) -> usize {
        self.counts.iter().filter(|count| **count > 0).count()
    }

    /// Number of points outside the ranges or with NaN.
    pub fn outside(&self) -> u64 {
        self.outside
    }

    /// Vertical range of the occupied rows, in data values; `None` if no cell is occupied.
    pub fn extent(&self) -> Option<[f64; 2]> {
        let has =
            |row: &usize| self.counts[row * self.columns..(row + 1) * self.columns].iter().any(|count| *count > 0);
        let (low, high) = ((0..self.rows).find(has)?, (0..self.rows).rev().find(has)?);
        let at = |row: usize| self.y[0] + (self.y[1] - self.y[0]) * row as f64 / self.rows as f64;
        Some([at(low), at(high + 1)])
    }

    /// Computes a shade for each cell from the logarithm of its count. With `spread`, a point also shades the eight cells around it, so
    /// that single points remain visible in print.
    pub fn shades(&self, spread: bool) -> Shades {
        // Histogram of the counts: sorting them would take as much memory as the grid.
        let most = self.counts.iter().max().copied().unwrap_or(0);
        let mut cells = vec![0_u32; usize::from(most) + 1];
        self.counts.iter().for_each(|count| cells[usize::from(*count)] += 1);
        // Periodic motions put many points into few cells: the densest tenth must not reduce the others to the faintest shade.
        let mut denser = self.occupied() / 10;
        let full = (1..cells.len()).rev().find(|count| {
            let here = cells[*count] as usize;
            let found = here > denser;
            denser = denser.saturating_sub(here);
            found
        });
        let full = full.unwrap_or(1) as f64;
        let shade = |count: usize| {
            let share = libm::log1p(count as f64) / libm::log1p(full.max(2.0));
            if count == 0 { 0 } else { ((share * f64::from(SHADES)) as u8).clamp(1, SHADES) }
        };
        let by_count: Vec<u8> = (0..=usize::from(most)).map(shade).collect();
        let reach = usize::from(spread);
        let mut packed = Vec::with_capacity(self.columns.div_ceil(2) * self.rows);
        for row in 0..self.rows {
            // The largest nearby count determines the shade.
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

    /// Doubles the range upwards or downwards at half the resolution, so that it approaches `y`.
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

/// Shades of a grid's cells, 0 for empty, else 1 to [`SHADES`]. Two share a byte, as in a PNG of few colours, because the counts of the
/// grid are in memory, too.
pub struct Shades {
    columns: usize,
    packed: Vec<u8>,
}

impl Shades {
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Rows from below, two cells in a byte.
    pub fn rows(&self) -> std::slice::Chunks<'_, u8> {
        self.packed.chunks(self.columns.div_ceil(2))
    }

    /// Cells of a row.
    pub fn cells(&self, row: &[u8]) -> impl Iterator<Item = u8> {
        row.iter().flat_map(|pair| [pair >> 4, pair & 15]).take(self.columns)
    }

    /// Gives every occupied cell the full shade.
    pub fn solid(mut self) -> Self {
        let full = |shade: u8| if shade == 0 { 0 } else { SHADES };
        self.packed.iter_mut().for_each(|pair| *pair = (full(*pair >> 4) << 4) | full(*pair & 15));
        self
    }
}

/// Points whose vertical range is unknown at first, collected in a [`Density`] that starts from the first few thousand and grows.
#[derive(Clone, Debug)]
pub struct Cloud {
    x: [f64; 2],
    kept: Vec<[f64; 2]>,
    grid: Option<(Density, f64)>,
}

impl Cloud {
    /// Creates an empty cloud; `x` is the horizontal range.
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

    /// Returns the grid of all points.
    pub fn finish(mut self) -> Density {
        self.settle();
        self.grid.map_or_else(|| Density::new(self.x, [0.0, 1.0]), |(grid, _)| grid)
    }

    /// Chooses a range from the kept points, slightly widened.
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
