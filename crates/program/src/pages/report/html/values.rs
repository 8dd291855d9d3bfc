//! Values of a figure for the scripts of its page: the value under the pointer, and the figure's table.
//!
//! Lines have the points through which they are drawn. Numbers are whole multiples of a power of ten, each stored as its difference from
//! the one before, which compresses well.

use serde::Serialize;

use corner_impact::elementary;
use corner_impact_plot::{Data, Density, DrawnPanel, Figure, FigureAxis, Look, Series, TickSpacing};

/// Values of a figure, panel by panel.
#[derive(Debug, Serialize)]
pub(crate) struct FigureValues<'a> {
    panels: Vec<PanelValues<'a>>,
}

#[derive(Debug, Serialize)]
struct PanelValues<'a> {
    x: AxisName<'a>,
    y: AxisName<'a>,
    series: Vec<SeriesValues<'a>>,
}

#[derive(Debug, Serialize)]
struct AxisName<'a> {
    label: &'a str,
    unit: &'a str,
    /// Whether its values are decimal logarithms.
    logarithmic: bool,
}

#[derive(Debug, Serialize)]
struct SeriesValues<'a> {
    /// Index among the series of its panel.
    number: usize,
    name: &'a str,
    /// Kind of the row in the figure's table.
    kind: &'static str,
    #[serde(flatten)]
    values: Values,
}

#[derive(Debug, Serialize)]
#[serde(untagged)]
enum Values {
    /// Columns for the parts of a row.
    Rows {
        x: Column,
        y: Column,
        #[serde(skip_serializing_if = "Option::is_none")]
        count: Option<Column>,
        #[serde(skip_serializing_if = "Option::is_none")]
        width: Option<Column>,
        #[serde(skip_serializing_if = "Option::is_none")]
        height: Option<Column>,
    },
    /// Occupied cells of a grid. A cell's number is its column times the rows, plus its row; `gaps` are differences of numbers.
    Cells { grid: [CellAxis; 2], rows: usize, gaps: Vec<usize>, counts: Vec<u16> },
}

/// Cells along an axis: the lower edge of the first, and the width of each.
#[derive(Debug, Serialize)]
struct CellAxis {
    from: f64,
    each: f64,
    places: i32,
}

/// Values as whole multiples of 10 to the power `-places`; a step is the difference from the value before. A break has no number.
#[derive(Debug, Serialize)]
struct Column {
    places: i32,
    steps: Vec<Option<i64>>,
}

/// Number of digits relative to the length of the axis: a picture shows four.
const DIGITS: i32 = 6;

/// Decimal places that give a length this number of digits.
fn places(length: f64, digits: i32) -> i32 {
    let is_length = length > 0.0 && length.is_finite();
    if is_length { digits - 1 - elementary::log10(length).floor() as i32 } else { digits }
}

impl Column {
    fn new(values: impl IntoIterator<Item = f64>, length: f64) -> Self {
        let places = places(length, DIGITS);
        let mut last = 0;
        let mut step = |value: f64| {
            let scaled = (value * 10_f64.powi(places)).round();
            let step = (scaled.abs() < 1e15).then(|| scaled as i64 - last);
            last += step.unwrap_or(0);
            step
        };
        Self { places, steps: values.into_iter().map(&mut step).collect() }
    }
}

impl<'a> FigureValues<'a> {
    /// Builds the values of a figure as drawn in this look.
    pub(crate) fn new(figure: &'a Figure, look: &Look) -> Self {
        let drawn = look.drawn(figure);
        let panels = figure.panels.iter().zip(&drawn).map(|(panel, drawn)| PanelValues {
            x: AxisName::new(panel.own_x.as_ref().unwrap_or(&figure.x)),
            y: AxisName::new(&panel.y),
            series: (panel.series.iter().enumerate())
                .filter_map(|(number, series)| SeriesValues::new(number, series, drawn))
                .collect(),
        });
        Self { panels: panels.collect() }
    }
}

impl<'a> AxisName<'a> {
    fn new(axis: &'a FigureAxis) -> Self {
        Self { label: &axis.label, unit: &axis.unit, logarithmic: axis.spacing == TickSpacing::Logarithmic }
    }
}

impl<'a> SeriesValues<'a> {
    /// Builds the values of a series of a panel; `None` for words.
    fn new(number: usize, series: &'a Series, drawn: &DrawnPanel) -> Option<Self> {
        let lengths = drawn.ranges.map(|[low, high]| high - low);
        let points = |points: &[[f64; 2]]| {
            let row = |[x, y]: [f64; 2]| [x, y, f64::NAN, f64::NAN, f64::NAN];
            Values::rows(points, row, lengths)
        };
        let (kind, values) = match &series.data {
            Data::Line { .. } | Data::Area { .. } | Data::Arrow { .. } => ("line", points(&drawn.lines[number])),
            Data::Points { points: at, .. } => ("point", points(at)),
            Data::Band { edges } => {
                let row = |[x, low, high]: [f64; 3]| [x, 0.5 * (low + high), f64::NAN, f64::NAN, high - low];
                ("band", Values::rows(edges, row, lengths))
            }
            Data::Density(cells) => ("cell", Values::cells(cells)),
            Data::Region { cells, .. } => {
                let rows = cells.rectangles();
                let of =
                    |([x, y], [width, height], count): ([f64; 2], [f64; 2], usize)| [x, y, count as f64, width, height];
                ("region", Values::rows(&rows, of, lengths))
            }
            Data::Words(_) => return None,
        };
        let name = if series.label.is_empty() { &series.name } else { &series.label };
        Some(Self { number, name, kind, values })
    }
}

impl Values {
    /// Rows of x, y, count, width and height, on axes of these lengths; a column without numbers is left out.
    fn rows<Row: Copy>(rows: &[Row], of: impl Fn(Row) -> [f64; 5] + Copy, [across, up]: [f64; 2]) -> Self {
        let column = |index: usize| rows.iter().map(move |row| of(*row)[index]);
        let optional =
            |index: usize, length: f64| column(index).any(f64::is_finite).then(|| Column::new(column(index), length));
        Self::Rows {
            x: Column::new(column(0), across),
            y: Column::new(column(1), up),
            count: optional(2, 10_f64.powi(DIGITS - 1)),
            width: optional(3, across),
            height: optional(4, up),
        }
    }

    fn cells(cells: &Density) -> Self {
        let ([columns, rows], ranges) = (cells.cells(), cells.ranges());
        let axis = |[from, to]: [f64; 2], count: usize| {
            let each = (to - from) / count as f64;
            CellAxis { from, each, places: places(each, 2) }
        };
        let mut occupied: Vec<(usize, u16)> =
            cells.occupied_cells().map(|([column, row], count)| (column * rows + row, count)).collect();
        occupied.sort_unstable();
        let mut last = 0;
        let gaps = occupied.iter().map(|(cell, _)| cell - std::mem::replace(&mut last, *cell)).collect();
        let counts = occupied.iter().map(|(_, count)| *count).collect();
        Self::Cells { grid: [axis(ranges[0], columns), axis(ranges[1], rows)], rows, gaps, counts }
    }
}
