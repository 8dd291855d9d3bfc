//! Layout of a figure on the page, such that no label covers another.
//!
//! The page is as wide, in units, as its look requires, by default [`WIDTH`], and as high as necessary. Widths of letters are estimated
//! generously, because an SVG in a page is shown in the available sans-serif font.

use super::look::{LegendPlace, Look};
pub use super::look::{TEXT, WIDTH};
use super::ticks::{self, Tick, enough_ticks};
use super::{Data, Figure, FigureAxis, Mark, Panel};

/// Height of the title's letters.
pub const TITLE: f64 = 15.0;
/// Width of a sample in a legend.
pub const SAMPLE: f64 = 20.0;
/// Size from which values are not drawn: their differences would overflow.
pub const LARGEST: f64 = 1e300;

/// Smallest span, relative to the values, that an axis resolves: labels of ticks that differ in the tenth digit cannot be read, and the
/// drawing would show rounding.
const DRAWN_SPAN: f64 = 1e-9;

const LINE: f64 = 16.0;
/// Height of a row of a legend.
const LEGEND_LINE: f64 = 15.0;
/// Smallest height of a page, in legends: a legend takes at most a sixth of the height.
const LEGENDS_HIGH: f64 = 6.0;
/// Smallest height of a frame, with room for three labels at any position of the range.
const LEAST_HEIGHT: f64 = 66.0;
/// Distance between panels: half a label of each.
const BETWEEN: f64 = 15.0;
const EDGE: f64 = 12.0;
const GAP: f64 = 6.0;
const LEADER: f64 = 14.0;
/// Range, without ticks, of an axis whose range is unknown.
const UNKNOWN: [f64; 2] = [0.0, 1.0];

/// Rectangle of the page.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(missing_docs, reason = "edges and lengths of a rectangle")]
pub struct Frame {
    pub left: f64,
    pub top: f64,
    pub width: f64,
    pub height: f64,
}

impl Frame {
    /// Position of the right edge.
    pub fn right(&self) -> f64 {
        self.left + self.width
    }

    /// Position of the lower edge.
    pub fn bottom(&self) -> f64 {
        self.top + self.height
    }
}

/// Line of text; `at` is the left end of its base line.
#[derive(Clone, Debug, PartialEq)]
pub struct Text {
    /// Left end of the base line.
    pub at: [f64; 2],
    /// The text itself.
    pub text: String,
}

/// Reference line with its label.
#[derive(Clone, Debug, PartialEq)]
pub struct MarkLine {
    /// Position on the page where the line crosses its axis.
    pub at: f64,
    /// Whether the line is within the range of the axis.
    pub inside: bool,
    /// Label, if any.
    pub label: Option<Text>,
}

/// Layout of a panel's horizontal axis.
#[derive(Clone, Debug, PartialEq)]
pub struct AcrossLayout {
    /// Ends of the axis.
    pub range: [f64; 2],
    /// Ticks.
    pub ticks: Vec<Tick>,
    /// Name below the labels of the ticks; `None` if a panel further down has both.
    pub name: Option<Text>,
    /// Whether the axis belongs to this panel alone.
    pub is_own: bool,
}

/// Layout of one panel.
#[derive(Clone, Debug, PartialEq)]
pub struct PanelLayout {
    /// Frame of the data.
    pub frame: Frame,
    /// Horizontal axis.
    pub across: AcrossLayout,
    /// Ends of the vertical axis.
    pub range: [f64; 2],
    /// Ticks of the vertical axis.
    pub ticks: Vec<Tick>,
    /// Lines of the name of the vertical axis, written upwards; `at` is the middle of the base line.
    pub name: Vec<Text>,
    /// Legend entries: index of the series, and its name beside the sample.
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
    /// Vertical reference lines.
    pub marks: Vec<MarkLine>,
    /// The panels.
    pub panels: Vec<PanelLayout>,
    /// Lines of the note.
    pub note: Vec<Text>,
    /// Height of the rows of legends above and below frames.
    pub legend_height: f64,
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
        Data::Band { edges } => {
            let drawable = edges.iter().filter(|edge| edge.iter().all(|part| part.abs() < LARGEST));
            known(drawable.flat_map(|[x, low, high]| if direction == 0 { [*x, *x] } else { [*low, *high] }))
        }
        // Words are placed at drawn data.
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

/// Range of a horizontal axis, over these panels.
fn horizontal_range<'a>(axis: &FigureAxis, panels: impl Iterator<Item = &'a Panel>) -> Option<[f64; 2]> {
    valid(axis.range).or_else(|| {
        let extents = panels.filter_map(|panel| extent(panel, 0));
        known(extents.flatten()).map(|range| widened(range, 0.02))
    })
}

/// Whether a panel has the labels of its horizontal axis: its own axis, or the shared one in the last panel that shares it.
fn is_labelled(figure: &Figure, index: usize) -> bool {
    let is_own = |panel: &Panel| panel.own_x.is_some();
    is_own(&figure.panels[index]) || figure.panels[index + 1..].iter().all(is_own)
}

/// Ranges across and up that contain these ranges and have one scale in a frame of this width and height.
fn one_scale(ranges: [[f64; 2]; 2], lengths: [f64; 2]) -> [[f64; 2]; 2] {
    let per_unit = |index: usize| (ranges[index][1] - ranges[index][0]) / lengths[index];
    let scale = per_unit(0).max(per_unit(1));
    std::array::from_fn(|index| {
        let ([low, high], half) = (ranges[index], 0.5 * scale * lengths[index]);
        [0.5 * (low + high) - half, 0.5 * (low + high) + half]
    })
}

/// Name of an axis with its unit in brackets.
fn name(axis: &FigureAxis, exponent: i32) -> String {
    let unit = ticks::unit(&axis.unit, exponent);
    if unit.is_empty() { axis.label.clone() } else { format!("{} ({unit})", axis.label) }
}

fn vertical_ticks(panel: &Panel, range: Option<[f64; 2]>, height: f64) -> ticks::Ticks {
    let Some(range) = range else { return ticks::Ticks::default() };
    let apart = |ticks: &[Tick], least: f64| {
        ticks.windows(2).all(|pair| height * (share(pair[1].at, range) - share(pair[0].at, range)) >= least)
    };
    let most = (height / 30.0) as usize;
    enough_ticks(range, panel.y.spacing, most, |ticks| apart(ticks, LINE), |ticks| apart(ticks, TEXT))
}

fn horizontal_ticks(axis: &FigureAxis, range: Option<[f64; 2]>, across: f64) -> ticks::Ticks {
    let Some(range) = range else { return ticks::Ticks::default() };
    let half = |tick: &Tick| width(&tick.label, TEXT) / 2.0;
    let apart = |ticks: &[Tick], least: f64| {
        ticks.windows(2).all(|pair| {
            let apart = across * (share(pair[1].at, range) - share(pair[0].at, range));
            apart >= half(&pair[0]) + half(&pair[1]) + least
        })
    };
    let most = (across / 44.0) as usize;
    enough_ticks(range, axis.spacing, most, |ticks| apart(ticks, GAP), |ticks| apart(ticks, 0.0))
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

/// Indices of the labelled marks within the axis, ascending by `place`.
fn labelled(marks: &[Mark], range: [f64; 2], place: impl Fn(&Mark) -> f64) -> Vec<usize> {
    let has_label = |index: &usize| is_inside(&marks[*index], range) && !marks[*index].label.is_empty();
    let mut order: Vec<usize> = (0..marks.len()).filter(has_label).collect();
    order.sort_by(|one, other| place(&marks[*one]).total_cmp(&place(&marks[*other])));
    order
}

/// Each mark at its `place`, with its label, if any.
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

/// Labels of horizontal lines beside the frame, moved apart if lines are close.
fn beside(marks: &[Mark], range: [f64; 2], frame: &Frame) -> Vec<MarkLine> {
    let at = |mark: &Mark| frame.bottom() - frame.height * share(mark.at, range);
    let order = labelled(marks, range, at);
    let mut middles: Vec<f64> = order.iter().map(|index| at(&marks[*index])).collect();
    for index in 1..middles.len() {
        middles[index] = middles[index].max(middles[index - 1] + LINE);
    }
    // Labels below the frame are moved up again, together with the labels in their way.
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

/// Labels of vertical lines above the frame, right of their lines, in rows such that no line crosses a label. No line is left of the first
/// line, so that its label may move to the left if the page ends at `end`.
fn above(marks: &[Mark], range: [f64; 2], frame: &Frame, end: f64) -> (Vec<MarkLine>, usize) {
    let at = |mark: &Mark| frame.left + frame.width * share(mark.at, range);
    let order = labelled(marks, range, |mark| -at(mark));
    let first = order.last().copied();
    let mut rows: Vec<(f64, usize, usize)> = Vec::new();
    for index in order {
        let (left, right) = (at(&marks[index]), at(&marks[index]) + GAP + width(&marks[index].label, TEXT));
        // The line of a mark further right rises to its label's row, so this label is placed above all labels that it spans.
        let row = rows.iter().filter(|(other, _, _)| *other <= right).map(|(_, row, _)| row + 1).max().unwrap_or(0);
        rows.push((left, row, index));
    }
    let count = rows.iter().map(|(_, row, _)| row + 1).max().unwrap_or(0);
    let lines = mark_lines(marks, range, at, |index| {
        let (left, row, _) = rows.iter().find(|(_, _, other)| *other == index)?;
        let room = if first == Some(index) { end - width(&marks[index].label, TEXT) } else { f64::INFINITY };
        Some([(left + 3.0).min(room.max(EDGE)), frame.top - 5.0 - *row as f64 * LINE])
    });
    (lines, count)
}

/// Whether the box between two points overlaps the box of these ranges.
fn crosses(one: [f64; 2], other: [f64; 2], ranges: [[f64; 2]; 2]) -> bool {
    (0..2).all(|direction| {
        let [low, high] = super::extent([one[direction], other[direction]]);
        low <= ranges[direction][1] && high >= ranges[direction][0]
    })
}

/// Whether a part of a series is inside the ranges of its frame: a legend names only such series.
fn occurs(data: &Data, ranges: [[f64; 2]; 2]) -> bool {
    let has = |at: [f64; 2]| crosses(at, at, ranges);
    let line = |points: &[[f64; 2]]| {
        let is_joined = points.windows(2).any(|pair| crosses(pair[0], pair[1], ranges));
        is_joined || points.iter().any(|at| has(*at))
    };
    match data {
        Data::Words(words) => words.iter().any(|word| has(word.at)),
        Data::Density(cells) | Data::Region { cells, .. } => cells.counted().any(|(at, _)| has(at)),
        Data::Points { points, .. } => points.iter().any(|at| has(*at)),
        Data::Line { points, .. } | Data::Arrow { points, .. } => line(points),
        // An area is filled down to the frame.
        Data::Area { points, .. } => line(points) || points.iter().any(|[x, y]| has([*x, y.min(ranges[1][1])])),
        Data::Band { edges } => {
            edges.windows(2).any(|pair| crosses([pair[0][0], pair[0][1]], [pair[1][0], pair[1][2]], ranges))
        }
    }
}

/// Entry of a legend: its panel, the index of its series, and its width.
type Entry = (usize, usize, f64);

/// Entries of a panel's legend, in order.
fn entries(index: usize, panel: &Panel, ranges: [[f64; 2]; 2]) -> impl Iterator<Item = Entry> {
    let named = panel.series.iter().enumerate().filter(|(_, series)| !series.label.is_empty());
    let there = named.filter(move |(_, series)| occurs(&series.data, ranges));
    there.map(move |(series, it)| (index, series, SAMPLE + GAP + width(&it.label, TEXT)))
}

/// Arranges entries in rows of at most `room`: each with its position from the left end and its row, and the number of rows.
fn rows(entries: &[Entry], room: f64) -> (Vec<(Entry, f64, usize)>, usize) {
    let (mut x, mut row, mut places) = (0.0, 0, Vec::new());
    for entry in entries {
        if x > 0.0 && x + entry.2 > room {
            (x, row) = (0.0, row + 1);
        }
        places.push((*entry, x, row));
        x += entry.2 + 2.0 * GAP;
    }
    (places, if entries.is_empty() { 0 } else { row + 1 })
}

impl Layout {
    /// Computes the layout of a figure in this look. Frames become higher if a legend would take more than a sixth of the page, and fill
    /// the height of the look, if given.
    pub fn new(figure: &Figure, look: &Look) -> Self {
        /// Number of passes, after which heights are final; labels beside a frame change little with its height.
        const PASSES: usize = 4;
        let wide = look.across();
        // Letters keep their size in a narrow figure: its panels are relatively higher, to leave room for ticks.
        let tall = wide * (WIDTH / wide).sqrt().clamp(1.0, 1.5);
        let height = |panel: &Panel| tall * if panel.height.is_nan() { 0.5 } else { panel.height.clamp(0.08, 2.0) };
        let mut heights: Vec<f64> = figure.panels.iter().map(|panel| height(panel).max(LEAST_HEIGHT)).collect();
        let mut layout = Self::with_heights(figure, look, &heights);
        for _ in 0..PASSES {
            let extra = match look.height {
                Some(height) => height * wide / look.points() - layout.height,
                None => (LEGENDS_HIGH * layout.legend_height - layout.height).max(0.0),
            };
            // The width determines the height of a frame to scale, unless its own axis may show more.
            let free = || figure.panels.iter().map(|panel| !panel.y.to_scale || panel.own_x.is_some());
            let whole: f64 = heights.iter().zip(free()).filter(|(_, free)| *free).map(|(height, _)| height).sum();
            if extra.abs() < 0.5 || whole == 0.0 {
                break;
            }
            let scale = (whole + extra.ceil()) / whole;
            for (height, _) in heights.iter_mut().zip(free()).filter(|(_, free)| *free) {
                *height = (*height * scale).max(LEAST_HEIGHT);
            }
            layout = Self::with_heights(figure, look, &heights);
        }
        layout
    }

    /// Computes the layout with frames of these heights; the width determines the height of a frame to scale.
    fn with_heights(figure: &Figure, look: &Look, heights: &[f64]) -> Self {
        let (wide, title) = (look.across(), look.title(figure));
        let mut heights = heights.to_vec();
        let mut ranges: Vec<_> = figure.panels.iter().map(vertical_range).collect();
        let known = horizontal_range(&figure.x, figure.panels.iter().filter(|panel| panel.own_x.is_none()));
        let range = known.unwrap_or(UNKNOWN);
        let own_known = |panel: &Panel| match &panel.own_x {
            Some(axis) => horizontal_range(axis, std::iter::once(panel)),
            None => known,
        };
        let mut across_ranges: Vec<[f64; 2]> =
            figure.panels.iter().map(|panel| own_known(panel).unwrap_or(UNKNOWN)).collect();
        let ratio = |index: usize| {
            let [from, to] = range;
            let ratio = ranges[index].map_or(f64::NAN, |[low, high]| (high - low) / (to - from));
            let panel = &figure.panels[index];
            (panel.y.to_scale && panel.own_x.is_none() && ratio.is_finite()).then_some(ratio)
        };
        let to_scale = |across: f64, index: usize| Some((across * ratio(index)?).clamp(0.08 * wide, 2.0 * wide));
        for (index, height) in heights.iter_mut().enumerate() {
            // Estimate; the margins for the ticks determine the exact height.
            *height = to_scale(0.8 * wide, index).unwrap_or(*height);
        }
        let each = || figure.panels.iter().zip(&ranges).zip(&heights);
        let vertical: Vec<_> = each().map(|((panel, range), height)| vertical_ticks(panel, *range, *height)).collect();
        let names: Vec<Vec<String>> = figure
            .panels
            .iter()
            .zip(&vertical)
            .zip(&heights)
            .map(|((panel, ticks), height)| lines(&name(&panel.y, ticks.exponent), TEXT, *height + BETWEEN))
            .collect();
        let shown: Vec<Entry> = match look.legend {
            LegendPlace::None => Vec::new(),
            _ => (figure.panels.iter().zip(&ranges).enumerate())
                .flat_map(|(index, (panel, up))| entries(index, panel, [across_ranges[index], up.unwrap_or(UNKNOWN)]))
                .collect(),
        };
        let together = distinct(figure, &shown);
        let widest = vertical.iter().flat_map(|ticks| &ticks.ticks).map(|tick| width(&tick.label, TEXT));
        let deepest = names.iter().map(Vec::len).max().unwrap_or(0);
        let left = EDGE + deepest as f64 * LINE + widest.fold(8.0, f64::max) + 9.0;
        let labels = figure.panels.iter().flat_map(|panel| &panel.marks).filter(|mark| !mark.label.is_empty());
        let beside_frame = labels.map(|mark| LEADER + width(&mark.label, TEXT)).fold(12.0, f64::max);
        let column = together.iter().map(|entry| entry.2 + GAP).fold(0.0, f64::max);
        let beside_frame = beside_frame + if look.legend == LegendPlace::Right { column } else { 0.0 };
        let overhang = |across: f64| {
            let past = |mark: &Mark| GAP + width(&mark.label, TEXT) - across * (1.0 - share(mark.at, range));
            // The label of the first mark has room on its left.
            let others = labelled(&figure.marks, range, |mark| mark.at).into_iter().skip(1);
            others.map(|index| past(&figure.marks[index])).fold(0.0, f64::max)
        };
        let right = wide - EDGE - beside_frame.max(overhang(wide - left - beside_frame - EDGE));
        let across = (right - left).max(0.3 * wide);
        for (index, height) in heights.iter_mut().enumerate() {
            *height = to_scale(across, index).unwrap_or(*height);
        }
        for (index, panel) in figure.panels.iter().enumerate().filter(|(_, panel)| panel.own_x.is_some()) {
            if let Some(up) = ranges[index].filter(|_| panel.y.to_scale) {
                let [x, y] = one_scale([across_ranges[index], up], [across, heights[index]]);
                (across_ranges[index], ranges[index]) = (x, Some(y));
            }
        }
        let mut y = EDGE;
        let mut down = |by: f64| {
            y += by;
            y
        };
        let title = lines(title, TITLE, wide - 2.0 * EDGE);
        let title = title.into_iter().map(|text| Text { at: [EDGE, down(TITLE + 4.0) - 4.0], text });
        let title: Vec<Text> = title.collect();
        down(if title.is_empty() { 0.0 } else { GAP });
        let text = |(panel, series, _): Entry, at: [f64; 2]| {
            let label = &figure.panels[panel].series[series].label;
            (panel, (series, Text { at: [at[0] + SAMPLE + GAP, at[1]], text: label.clone() }))
        };
        let room = wide - 2.0 * EDGE;
        let (mut legend, mut legend_height) = (Vec::new(), 0.0);
        let mut panels = Vec::new();
        let mut marks = Vec::new();
        for (index, panel) in figure.panels.iter().enumerate() {
            let (range_y, ticks) = (ranges[index].unwrap_or(UNKNOWN), &vertical[index]);
            down(if index == 0 { 0.0 } else { BETWEEN });
            if look.legend == LegendPlace::Above {
                let of_panel: Vec<Entry> = shown.iter().copied().filter(|(owner, ..)| *owner == index).collect();
                let (places, count) = rows(&of_panel, room);
                let base = down(0.0) + 0.8 * LEGEND_LINE;
                legend.extend(
                    places.iter().map(|(entry, x, row)| text(*entry, [EDGE + x, base + *row as f64 * LEGEND_LINE])),
                );
                legend_height += count as f64 * LEGEND_LINE;
                down(count as f64 * LEGEND_LINE + if count > 0 { GAP } else { 0.0 });
            }
            if index == 0 {
                let frame = Frame { left, top: 0.0, width: across, height: heights[0] };
                let end = wide - EDGE;
                let rows = above(&figure.marks, range, &frame, end).1;
                let top = down(rows as f64 * LINE + if rows > 0 { 3.0 } else { 0.0 });
                marks = above(&figure.marks, range, &Frame { top, ..frame }, end).0;
            }
            let frame = Frame { left, top: down(0.0), width: across, height: heights[index] };
            down(heights[index]);
            let middle = frame.top + 0.5 * frame.height;
            // Lines of a shorter name are placed at the frame, too.
            let first = EDGE + (deepest - names[index].len()) as f64 * LINE + 0.75 * TEXT;
            let line = |(line, words): (usize, &String)| Text {
                at: [first + line as f64 * LINE, middle],
                text: words.clone(),
            };
            let axis = panel.own_x.as_ref().unwrap_or(&figure.x);
            let horizontal = horizontal_ticks(axis, own_known(panel).map(|_| across_ranges[index]), across);
            let below_frame = is_labelled(figure, index).then(|| {
                let below = down(LINE + 4.0 + GAP);
                let words = name(axis, horizontal.exponent);
                let middle = left + (across - width(&words, TEXT)).max(0.0) / 2.0;
                let middle = middle.min((wide - EDGE - width(&words, TEXT)).max(EDGE));
                Text { at: [middle, down(LINE - 2.0).max(below)], text: words }
            });
            panels.push(PanelLayout {
                frame,
                across: AcrossLayout {
                    range: across_ranges[index],
                    ticks: horizontal.ticks,
                    name: below_frame,
                    is_own: panel.own_x.is_some(),
                },
                range: range_y,
                ticks: ticks.ticks.clone(),
                name: names[index].iter().enumerate().map(line).collect(),
                legend: Vec::new(),
                marks: beside(&panel.marks, range_y, &frame),
                empty: extent(panel, 1).is_none(),
            });
        }
        match look.legend {
            LegendPlace::Below if !together.is_empty() => {
                let (places, count) = rows(&together, room);
                let base = down(GAP) + 0.8 * LEGEND_LINE;
                let place =
                    |(entry, x, row): &(Entry, f64, usize)| text(*entry, [EDGE + x, base + *row as f64 * LEGEND_LINE]);
                legend.extend(places.iter().map(place));
                legend_height += count as f64 * LEGEND_LINE;
                down(count as f64 * LEGEND_LINE);
            }
            LegendPlace::Right => {
                let (x, top) = (wide - EDGE - column + GAP, panels.first().map_or(EDGE, |panel| panel.frame.top));
                let at = |row: usize| [x, top + (row as f64 + 0.8) * LEGEND_LINE];
                legend.extend(together.iter().enumerate().map(|(row, entry)| text(*entry, at(row))));
                let missing = top + together.len() as f64 * LEGEND_LINE - down(0.0);
                down(missing.max(0.0));
            }
            _ => {}
        }
        for (panel, entry) in legend {
            panels[panel].legend.push(entry);
        }
        let note = lines(&figure.note, TEXT, wide - 2.0 * EDGE);
        down(if note.is_empty() { 0.0 } else { GAP });
        let note = note.into_iter().map(|text| Text { at: [EDGE, down(LINE)], text }).collect();
        let height = down(EDGE).ceil();
        Self { height, title, marks, panels, note, legend_height }
    }
}

/// Returns the entries without repetitions of a name in the same colour and with the same sample.
fn distinct(figure: &Figure, entries: &[Entry]) -> Vec<Entry> {
    let look = |(panel, series, _): &Entry| {
        let series = &figure.panels[*panel].series[*series];
        (&series.label, series.colour, series.data.style())
    };
    let is_first = |index: &usize| !entries[..*index].iter().any(|before| look(before) == look(&entries[*index]));
    (0..entries.len()).filter(is_first).map(|index| entries[index]).collect()
}
