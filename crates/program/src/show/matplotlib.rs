//! Figures as short Python scripts that draw them with matplotlib, from a table that [`super::csv::figure`] writes beside them.

use std::fmt::Write;

use corner_impact_plot::formula::{Part, sentence};
use corner_impact_plot::layout::{Frame, LARGEST, Layout, SAMPLE, TEXT, TITLE, Text};
use corner_impact_plot::ticks::Tick;
use corner_impact_plot::{Beside, Data, Figure, Look, Mark, Marker, Panel, Series, dashes, dot_size, stroke_width};

/// Common part of the scripts, which reads the table and draws.
const DRAWING: &str = include_str!("matplotlib.py");

/// Writes a script that reads the table called `data` and draws the figure in this look.
pub(crate) fn matplotlib(figure: &Figure, look: &Look, data: &str) -> String {
    const MILLIMETRE: f64 = 72.0 / 25.4;
    let layout = Layout::new(figure, look);
    let mut out = String::new();
    let _ = writeln!(out, "\"\"\"Draws a figure with matplotlib from {data}, which is beside this script.\"\"\"\n");
    let _ = writeln!(out, "DATA = {}", quoted(data));
    let _ = writeln!(out, "WIDTH = {:.2}  # mm", look.points() / MILLIMETRE);
    let _ = writeln!(out, "PAGE = ({:?}, {:?})", look.across(), layout.height);
    let _ = writeln!(out, "MARKS = {}", lines(&figure.marks));
    let _ = writeln!(out, "PANELS = [");
    for (panel, place) in figure.panels.iter().zip(&layout.panels) {
        let Frame { left, top, width, height } = place.frame;
        let _ = writeln!(out, "    {{");
        let _ = writeln!(out, "        \"frame\": ({left:.2}, {top:.2}, {width:.2}, {height:.2}),");
        let _ = writeln!(out, "        {},", axis(place.range, &place.ticks));
        let across = &place.across;
        let flags = [across.name.is_some(), !across.is_own].map(python);
        let flags = format!("\"is_labelled\": {}, \"has_marks\": {}", flags[0], flags[1]);
        let _ = writeln!(out, "        \"across\": {{{}, {flags}}},", axis(across.range, &across.ticks));
        let _ = writeln!(out, "        \"marks\": {},", lines(&panel.marks));
        let _ = writeln!(out, "        \"words\": [{}],", words(panel).join(", "));
        let over_regions = panel.series.iter().any(|series| matches!(series.data, Data::Region { .. }));
        let _ = writeln!(out, "        \"rim\": {},", if over_regions { "2.6" } else { "0" });
        let _ = writeln!(out, "        \"series\": [");
        for (index, series) in panel.series.iter().enumerate() {
            let entry = place.legend.iter().find(|(of, _)| *of == index).map(|(_, text)| text.at);
            let _ = writeln!(out, "            {},", style(series, entry));
        }
        let _ = writeln!(out, "        ],\n    }},");
    }
    let _ = writeln!(out, "]\nTEXTS = [");
    for (text, angle, size) in texts(&layout) {
        let [x, y] = text.at;
        let _ = writeln!(out, "    ({x:.2}, {y:.2}, {}, {angle}, {size:?}),", quoted(&marked_up(&text.text)));
    }
    let _ = writeln!(out, "]\n\n{}", DRAWING.trim_end());
    out
}

/// All words outside the frames, except the legend's, each with its angle in degrees and the height of its letters.
fn texts(layout: &Layout) -> Vec<(&Text, u32, f64)> {
    let title = layout.title.iter().map(|text| (text, 0, TITLE));
    let names = layout.panels.iter().flat_map(|panel| &panel.name).map(|text| (text, 90, TEXT));
    let marks = layout.panels.iter().flat_map(|panel| &panel.marks).chain(&layout.marks).filter(|mark| mark.inside);
    let across = layout.panels.iter().filter_map(|panel| panel.across.name.as_ref());
    let labels = marks.filter_map(|mark| mark.label.as_ref()).chain(across).chain(&layout.note);
    title.chain(names).chain(labels.map(|text| (text, 0, TEXT))).collect()
}

/// Writes a string in Python.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

/// Writes a Boolean in Python.
fn python(is: bool) -> &'static str {
    if is { "True" } else { "False" }
}

/// Writes a number in Python.
fn number(value: f64) -> String {
    if value.is_finite() { format!("{value:?}") } else { "float(\"nan\")".into() }
}

/// Range and ticks of an axis.
fn axis([low, high]: [f64; 2], ticks: &[Tick]) -> String {
    let at: Vec<String> = ticks.iter().map(|tick| number(tick.at)).collect();
    let labels: Vec<String> = ticks.iter().map(|tick| quoted(&tick.label)).collect();
    let (at, labels, low, high) = (at.join(", "), labels.join(", "), number(low), number(high));
    format!("\"range\": ({low}, {high}), \"ticks\": [{at}], \"labels\": [{labels}]")
}

/// Reference lines, each with whether it is dashed.
fn lines(marks: &[Mark]) -> String {
    let line = |mark: &Mark| format!("({}, {})", number(mark.at), python(!mark.label.is_empty()));
    format!("[{}]", marks.iter().map(line).collect::<Vec<_>>().join(", "))
}

/// Words with the position and the side of each.
fn words(panel: &Panel) -> Vec<String> {
    let all = panel.series.iter().filter_map(|series| match &series.data {
        Data::Words(words) => Some(words),
        _ => None,
    });
    let there = all.flatten().filter(|word| word.at.iter().all(|part| part.abs() < LARGEST));
    let word = |word: &corner_impact_plot::Label| {
        let [x, y] = word.at.map(number);
        let (across, up) = match word.beside {
            Beside::Right => ("left", "center"),
            Beside::Left => ("right", "center"),
            Beside::Above => ("center", "bottom"),
            Beside::Below => ("center", "top"),
            Beside::AboveRight => ("left", "bottom"),
            Beside::AboveLeft => ("right", "bottom"),
            Beside::BelowRight => ("left", "top"),
            Beside::BelowLeft => ("right", "top"),
        };
        format!("({x}, {y}, {}, {}, {})", quoted(&marked_up(&word.text)), quoted(across), quoted(up))
    };
    there.map(word).collect()
}

/// Name, colour, stroke and marker of a series, and the position of its entry in the legend.
fn style(series: &Series, entry: Option<[f64; 2]>) -> String {
    let colour = series.colour.shades().1;
    let kind = match &series.data {
        Data::Line { .. } => "line",
        Data::Area { .. } => "area",
        Data::Arrow { .. } => "arrow",
        Data::Band { .. } => "band",
        Data::Points { .. } => "point",
        Data::Words(_) => "words",
        Data::Density(_) => "cell",
        Data::Region { .. } => "region",
    };
    let (_, stroke, marker, strength) = series.data.style();
    let mut out = format!("{{\"kind\": {}, \"label\": {}", quoted(kind), quoted(&marked_up(&series.label)));
    let _ = write!(out, ", \"colour\": {}", quoted(colour));
    if let Some(stroke) = stroke {
        let dashes: Vec<&str> = dashes(stroke).split_whitespace().collect();
        let _ = write!(out, ", \"width\": {:?}, \"dashes\": [{}]", stroke_width(stroke), dashes.join(", "));
    }
    if let Some(marker) = marker {
        let (shape, size) = match marker {
            Marker::Dot => ("o", 3.4),
            Marker::Disc => ("o", 6.4),
            Marker::Ring => ("o", 5.4),
            Marker::Square => ("s", 5.0),
            Marker::Diamond => ("D", 5.0),
            Marker::Triangle | Marker::Below => ("^", 6.4),
            Marker::Cross => ("x", 5.4),
            Marker::Plus => ("+", 6.8),
        };
        let is_filled = matches!(marker, Marker::Dot | Marker::Disc | Marker::Below);
        let filled = python(is_filled);
        let _ = write!(out, ", \"marker\": {}, \"size\": {size:?}, \"filled\": {filled}", quoted(shape));
    }
    match &series.data {
        Data::Region { .. } => {
            let _ = write!(out, ", \"strength\": {strength:?}");
        }
        Data::Density(cells) => {
            let _ = write!(out, ", \"size\": {:?}", dot_size(cells.occupied()));
        }
        _ => {}
    }
    if let Some([x, y]) = entry {
        let _ = write!(out, ", \"legend\": ({:.2}, {:.2})", x - SAMPLE - 6.0, y - 0.35 * TEXT);
    }
    out + "}"
}

/// Writes text with its formulas for matplotlib.
fn marked_up(text: &str) -> String {
    let mut out = String::new();
    for part in sentence(text) {
        let escaped = |text: &str| text.replace('$', "\\$");
        match part {
            Part::Plain(text) | Part::Letter(text) => out.push_str(&escaped(&text)),
            Part::Below(text) => out.push_str(&format!("$_{{\\mathrm{{{}}}}}$", escaped(&text))),
            Part::Above(text) => out.push_str(&format!("$^{{\\mathrm{{{}}}}}$", escaped(&text))),
        }
    }
    out
}
