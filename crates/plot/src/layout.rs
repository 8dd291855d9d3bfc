//! Layout of a figure on the page, such that no label covers another.
//!
//! The page is as wide, in units, as its look says, by default [`WIDTH`], and as high as necessary. Widths of
//! letters are estimated generously, because an SVG in a page is shown in whatever sans-serif font is available.

use super::ticks::{self, Tick, ticks};
use super::{Data, Figure, FigureAxis, Mark, Panel};

/// Default width of the page.
pub const WIDTH: f64 = 720.0;
/// Height of most letters.
pub const TEXT: f64 = 12.5;
/// Height of the title's letters.
pub const TITLE: f64 = 15.0;
/// Width of a sample in a legend.
pub const SAMPLE: f64 = 24.0;
/// Limit from which on values are not drawn: differences of them would overflow.
pub const LARGEST: f64 = 1e300;

/// Span, relative to the values, above which an axis shows them apart: labels of ticks that differ in the tenth digit cannot be read, and
/// rounding would draw itself.
const DRAWN_SPAN: f64 = 1e-9;

const LINE: f64 = 16.0;
const EDGE: f64 = 12.0;
const GAP: f64 = 6.0;
const LEADER: f64 = 14.0;
/// Range, without ticks, of an axis whose range is unknown.
const UNKNOWN: [f64; 2] = [0.0, 1.0];

/// A rectangle of the page.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(missing_docs, reason = "edges and lengths of a rectangle")]
pub struct Frame {
    pub left: f64,
    pub top: f64,
    pub width: f64,
    pub height: f64,
}

impl Frame {
    /// The right edge.
    pub fn right(&self) -> f64 {
        self.left + self.width
    }

    /// Position of the lower edge.
    pub fn bottom(&self) -> f64 {
        self.top + self.height
    }
}

/// A line of text; `at` is the left end of its base line.
#[derive(Clone, Debug, PartialEq)]
pub struct Text {
    /// Left end of the base line.
    pub at: [f64; 2],
    /// The text itself.
    pub text: String,
}

/// A reference line with its label.
#[derive(Clone, Debug, PartialEq)]
pub struct MarkLine {
    /// Position on the page where the line crosses its axis.
    pub at: f64,
    /// Whether the line is within the range of the axis.
    pub inside: bool,
    /// Label, if any.
    pub label: Option<Text>,
}

/// Layout of one panel.
#[derive(Clone, Debug, PartialEq)]
pub struct PanelLayout {
    /// Frame of the data.
    pub frame: Frame,
    /// Ends of the vertical axis.
    pub range: [f64; 2],
    /// Ticks of the vertical axis.
    pub ticks: Vec<Tick>,
    /// Name of the vertical axis.
    pub name: Text,
    /// Legend entries: index of the series, and its name at the sample's position.
    pub legend: Vec<(usize, Text)>,
    /// Horizontal reference lines.
    pub marks: Vec<MarkLine>,
    /// Whether the panel has no drawable data.
    pub empty: bool,
}

/// Layout of a whole figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// Height of the page.
    pub height: f64,
    /// Lines of the title.
    pub title: Vec<Text>,
    /// Ends of the horizontal axis.
    pub range: [f64; 2],
    /// Ticks of the horizontal axis.
    pub ticks: Vec<Tick>,
    /// Name of the horizontal axis.
    pub name: Text,
    /// Vertical reference lines.
    pub marks: Vec<MarkLine>,
    /// The panels.
    pub panels: Vec<PanelLayout>,
    /// Lines of the note.
    pub note: Vec<Text>,
}

/// Width of a text, estimated generously.
pub fn width(text: &str, size: f64) -> f64 {
    let letter = |letter: char| match letter {
        'i' | 'j' | 'l' | '.' | ',' | ':' | ';' | '\'' | '|' | '!' => 0.34,
        ' ' | '(' | ')' | 'f' | 't' | 'r' | 'I' | '/' | '°' => 0.45,
        'm' | 'w' | 'M' | 'W' | '−' | '=' | '+' => 0.95,
        letter if letter.is_uppercase() => 0.74,
        _ => 0.62,
    };
    size * text.chars().map(letter).sum::<f64>()
}

/// Widens a range at both ends by a share of its span; a single value gets a span.
pub fn widened([low, high]: [f64; 2], room: f64) -> [f64; 2] {
    let size = low.abs().max(high.abs());
    if high - low > DRAWN_SPAN * size {
        let room = room * (high - low);
        return [low - room, high + room];
    }
    let room = if size > 0.0 { 0.05 * size } else { 1.0 };
    [low - room, high + room]
}

/// Relative position of a value in a range; NaN if the value cannot be drawn.
pub fn share(value: f64, [low, high]: [f64; 2]) -> f64 {
    if value.abs() < LARGEST { (value - low) / (high - low) } else { f64::NAN }
}

fn valid(range: Option<[f64; 2]>) -> Option<[f64; 2]> {
    range
        .filter(|[low, high]| low.abs() < LARGEST && high.abs() < LARGEST && low < high)
        .filter(|range| widened(*range, 0.0) == *range)
}

/// Extent of values, if there are any.
fn known(values: impl IntoIterator<Item = f64>) -> Option<[f64; 2]> {
    Some(super::extent(values)).filter(|[low, high]| low <= high)
}

/// Extent of the drawable part of a panel's series in one direction.
fn extent(panel: &Panel, direction: usize) -> Option<[f64; 2]> {
    let drawable = |point: &&[f64; 2]| point.iter().all(|part| part.abs() < LARGEST);
    let extents = panel.series.iter().filter_map(|series| match &series.data {
        Data::Density(density) | Data::Region { cells: density, .. } => {
            (density.occupied() > 0).then(|| density.ranges()[direction])
        }
        // Words stand at what is drawn.
        data => known(data.points()?.iter().filter(drawable).map(|point| point[direction])),
    });
    known(extents.flatten())
}

/// Vertical range of a panel; `None` if it has neither a range nor data.
fn vertical_range(panel: &Panel) -> Option<[f64; 2]> {
    valid(panel.y.range).or_else(|| {
        let marks = panel.marks.iter().map(|mark| mark.at).filter(|at| at.abs() < LARGEST);
        known(marks.chain(extent(panel, 1)?)).map(|range| widened(range, 0.07))
    })
}

fn horizontal_range(figure: &Figure) -> Option<[f64; 2]> {
    valid(figure.x.range).or_else(|| {
        let extents = figure.panels.iter().filter_map(|panel| extent(panel, 0));
        known(extents.flatten()).map(|range| widened(range, 0.02))
    })
}

/// Name of an axis with its unit in brackets.
fn name(axis: &FigureAxis, exponent: i32) -> String {
    let unit = ticks::unit(&axis.unit, exponent);
    if unit.is_empty() { axis.label.clone() } else { format!("{} ({unit})", axis.label) }
}

fn vertical_ticks(panel: &Panel, range: Option<[f64; 2]>, height: f64) -> ticks::Ticks {
    let Some(range) = range else { return ticks::Ticks::default() };
    let fits = |ticks: &[Tick]| {
        ticks.windows(2).all(|pair| height * (share(pair[1].at, range) - share(pair[0].at, range)) >= LINE)
    };
    let few = ticks(range, panel.y.spacing, (height / 30.0) as usize, fits);
    // One tick shows no scale: add as many as have room.
    if few.ticks.len() == 1 { ticks(range, panel.y.spacing, (height / LINE) as usize, fits) } else { few }
}

fn horizontal_ticks(axis: &FigureAxis, range: Option<[f64; 2]>, across: f64) -> ticks::Ticks {
    let Some(range) = range else { return ticks::Ticks::default() };
    let half = |tick: &Tick| width(&tick.label, TEXT) / 2.0;
    ticks(range, axis.spacing, (across / 44.0) as usize, |ticks| {
        ticks.windows(2).all(|pair| {
            let apart = across * (share(pair[1].at, range) - share(pair[0].at, range));
            apart >= half(&pair[0]) + half(&pair[1]) + GAP
        })
    })
}

/// Breaks text at word ends into lines of at most `room`.
fn lines(text: &str, size: f64, room: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if width(line, size) + width(word, size) + 0.45 * size <= room => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

fn is_inside(mark: &Mark, range: [f64; 2]) -> bool {
    (0.0..=1.0).contains(&share(mark.at, range))
}

/// Indices of the marks within the axis that have a label, ascending by `place`.
fn labelled(marks: &[Mark], range: [f64; 2], place: impl Fn(&Mark) -> f64) -> Vec<usize> {
    let has_label = |index: &usize| is_inside(&marks[*index], range) && !marks[*index].label.is_empty();
    let mut order: Vec<usize> = (0..marks.len()).filter(has_label).collect();
    order.sort_by(|one, other| place(&marks[*one]).total_cmp(&place(&marks[*other])));
    order
}

/// Each mark at its `place`, with its label if it has one.
fn mark_lines(
    marks: &[Mark],
    range: [f64; 2],
    place: impl Fn(&Mark) -> f64,
    label: impl Fn(usize) -> Option<[f64; 2]>,
) -> Vec<MarkLine> {
    let line = |(index, mark): (usize, &Mark)| MarkLine {
        at: place(mark),
        inside: is_inside(mark, range),
        label: label(index).map(|at| Text { at, text: mark.label.clone() }),
    };
    marks.iter().enumerate().map(line).collect()
}

/// Labels of horizontal lines beside the frame, moved apart where lines are close.
fn beside(marks: &[Mark], range: [f64; 2], frame: &Frame) -> Vec<MarkLine> {
    let at = |mark: &Mark| frame.bottom() - frame.height * share(mark.at, range);
    let order = labelled(marks, range, at);
    let mut middles: Vec<f64> = order.iter().map(|index| at(&marks[*index])).collect();
    for index in 1..middles.len() {
        middles[index] = middles[index].max(middles[index - 1] + LINE);
    }
    // Labels below the frame move up again, together with the labels in their way.
    let mut limit = frame.bottom();
    for middle in middles.iter_mut().rev() {
        *middle = middle.min(limit);
        limit = *middle - LINE;
    }
    mark_lines(marks, range, at, |index| {
        let place = order.iter().position(|ordered| *ordered == index)?;
        Some([frame.right() + LEADER, middles[place] + 0.35 * TEXT])
    })
}

/// Labels of vertical lines above the frame, right of their lines, in rows such that no line crosses a label.
fn above(marks: &[Mark], range: [f64; 2], frame: &Frame) -> (Vec<MarkLine>, usize) {
    let at = |mark: &Mark| frame.left + frame.width * share(mark.at, range);
    let mut rows: Vec<(f64, usize, usize)> = Vec::new();
    for index in labelled(marks, range, |mark| -at(mark)) {
        let (left, right) = (at(&marks[index]), at(&marks[index]) + GAP + width(&marks[index].label, TEXT));
        // The line of a mark further right rises to its own label's row, so this label goes above all labels that it spans.
        let row = rows.iter().filter(|(other, _, _)| *other <= right).map(|(_, row, _)| row + 1).max().unwrap_or(0);
        rows.push((left, row, index));
    }
    let count = rows.iter().map(|(_, row, _)| row + 1).max().unwrap_or(0);
    let lines = mark_lines(marks, range, at, |index| {
        let (left, row, _) = rows.iter().find(|(_, _, other)| *other == index)?;
        Some([left + 3.0, frame.top - 5.0 - *row as f64 * LINE])
    });
    (lines, count)
}

/// Legend beside the axis name if both fit, else in rows below it: entries at `[x, row]`, and the number of rows.
fn legend(panel: &Panel, name: &str, left: f64, right: f64) -> (Vec<(usize, [f64; 2])>, usize) {
    let entries: Vec<(usize, f64)> = panel
        .series
        .iter()
        .enumerate()
        .filter(|(_, series)| !series.label.is_empty())
        .map(|(index, series)| (index, SAMPLE + GAP + width(&series.label, TEXT) + 2.0 * GAP))
        .collect();
    let whole: f64 = entries.iter().map(|(_, wide)| wide).sum();
    let beside = EDGE + width(name, TEXT) + 2.0 * GAP + whole <= right;
    let (mut x, mut row) = if beside { (right - whole + 2.0 * GAP, 0) } else { (left, 1) };
    let mut places = Vec::new();
    for (index, wide) in entries {
        if x > left && x + wide > right + 2.0 * GAP + 1.0 {
            (x, row) = (left, row + 1);
        }
        places.push((index, [x, row as f64]));
        x += wide;
    }
    (places, row + 1)
}

impl Layout {
    /// Computes the layout of a figure under a title on a page of this width, in units.
    pub fn new(figure: &Figure, title: &str, wide: f64) -> Self {
        // Letters keep their size in a narrow figure: its panels are relatively higher, to have room for ticks.
        let tall = wide * (WIDTH / wide).sqrt().clamp(1.0, 1.5);
        let height = |panel: &Panel| tall * if panel.height.is_nan() { 0.5 } else { panel.height.clamp(0.08, 2.0) };
        let mut heights: Vec<f64> = figure.panels.iter().map(height).collect();
        let ranges: Vec<_> = figure.panels.iter().map(vertical_range).collect();
        let vertical: Vec<_> = figure
            .panels
            .iter()
            .zip(&ranges)
            .zip(&heights)
            .map(|((panel, range), height)| vertical_ticks(panel, *range, *height))
            .collect();
        let known = horizontal_range(figure);
        let range = known.unwrap_or(UNKNOWN);
        let widest = vertical.iter().flat_map(|ticks| &ticks.ticks).map(|tick| width(&tick.label, TEXT));
        let left = EDGE + widest.fold(20.0, f64::max) + 9.0;
        let labels = figure.panels.iter().flat_map(|panel| &panel.marks).filter(|mark| !mark.label.is_empty());
        let right = labels.map(|mark| LEADER + width(&mark.label, TEXT)).fold(12.0, f64::max);
        let overhang = |across: f64| {
            let past = |mark: &Mark| GAP + width(&mark.label, TEXT) - across * (1.0 - share(mark.at, range));
            let labelled = figure.marks.iter().filter(|mark| !mark.label.is_empty() && share(mark.at, range) <= 1.0);
            labelled.map(past).fold(0.0, f64::max)
        };
        let right = wide - EDGE - right.max(overhang(wide - left - right - EDGE));
        let across = (right - left).max(0.3 * wide);
        for ((panel, height), range_y) in figure.panels.iter().zip(&mut heights).zip(&ranges) {
            let ratio = range_y.map_or(f64::NAN, |[low, high]| (high - low) / (range[1] - range[0]));
            if panel.y.to_scale && ratio.is_finite() {
                *height = (across * ratio).clamp(0.08 * wide, 2.0 * wide);
            }
        }
        let horizontal = horizontal_ticks(&figure.x, known, across);

        let mut y = EDGE;
        let mut down = |by: f64| {
            y += by;
            y
        };
        let title = lines(title, TITLE, wide - 2.0 * EDGE);
        let title = title.into_iter().map(|text| Text { at: [EDGE, down(TITLE + 4.0) - 4.0], text });
        let title: Vec<Text> = title.collect();
        down(if title.is_empty() { 0.0 } else { GAP });
        let mut panels = Vec::new();
        let mut marks = Vec::new();
        for (index, panel) in figure.panels.iter().enumerate() {
            let (range_y, ticks) = (ranges[index].unwrap_or(UNKNOWN), &vertical[index]);
            let name = name(&panel.y, ticks.exponent);
            let (entries, rows) = legend(panel, &name, left, left + across);
            let mut base = down(LINE + 4.0) - 4.0;
            down((rows - 1) as f64 * LINE + GAP);
            if index == 0 {
                let frame = Frame { left, top: 0.0, width: across, height: heights[0] };
                let (lines, mut rows) = above(&figure.marks, range, &frame);
                let first = lines.iter().filter_map(|line| line.label.as_ref()).map(|label| label.at[0]);
                // The axis's name moves into the lowest row of labels where it has room.
                if rows > 0 && entries.is_empty() && first.fold(wide, f64::min) > EDGE + width(&name, TEXT) + GAP {
                    rows -= 1;
                    base += rows as f64 * LINE;
                }
                let top = down(rows as f64 * LINE);
                marks = above(&figure.marks, range, &Frame { top, ..frame }).0;
            }
            let name = Text { at: [EDGE, base], text: name };
            let entry = |(series, [x, row]): (usize, [f64; 2])| {
                let at = [x + SAMPLE + GAP, base + row * LINE];
                (series, Text { at, text: panel.series[series].label.clone() })
            };
            let legend = entries.into_iter().map(entry).collect();
            let frame = Frame { left, top: down(0.0), width: across, height: heights[index] };
            down(heights[index] + GAP);
            panels.push(PanelLayout {
                frame,
                range: range_y,
                ticks: ticks.ticks.clone(),
                name,
                legend,
                marks: beside(&panel.marks, range_y, &frame),
                empty: extent(panel, 1).is_none(),
            });
        }
        let below = down(LINE + 4.0);
        let text = name(&figure.x, horizontal.exponent);
        let middle = left + (across - width(&text, TEXT)).max(0.0) / 2.0;
        let name = Text { at: [middle, down(LINE - 2.0).max(below)], text };
        let note = lines(&figure.note, TEXT, wide - 2.0 * EDGE);
        down(if note.is_empty() { 0.0 } else { GAP });
        let note = note.into_iter().map(|text| Text { at: [EDGE, down(LINE)], text }).collect();
        let height = down(EDGE).ceil();
        Self { height, title, range, ticks: horizontal.ticks, name, marks, panels, note }
    }
}
