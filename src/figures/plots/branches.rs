//! Branches of orbits over the brute-force diagram: stable unbroken, unstable broken, special points marked.

use crate::draw::{Axis, Colour, Data, Density, Figure, Marker, Series, Stroke};
use crate::figures::plots::cam::CornerMark;
use crate::figures::plots::panel;
use crate::orbit::Course;
use crate::orbit::branch::{Branch, BranchPoint, Kind};

/// What is drawn.
#[derive(Clone, Debug)]
pub struct Branches<'a> {
    /// The figure's title.
    pub title: &'a str,
    /// The name of the parameter, and its range.
    pub parameter: (&'a str, [f64; 2]),
    /// The branches.
    pub branches: &'a [Branch],
    /// What runs settle on, drawn below: the parameter across, impact phases in degrees up.
    pub settled: Option<Density>,
    /// The cam's corners.
    pub corners: &'a [CornerMark],
}

/// More points than this of one kind are small, or they would hide the branch.
const MANY: usize = 40;

/// The kinds of point that are marked, with name and colour.
const MARKED: [(&str, Colour); 6] = [
    ("corner impact", Colour::Ink),
    ("fold", Colour::Vermilion),
    ("flip", Colour::Purple),
    ("graze", Colour::Green),
    ("chatter, detachment", Colour::Blue),
    ("branching", Colour::Grey),
];

fn mark(kind: &Kind) -> usize {
    match kind {
        Kind::Corner { .. } => 0,
        Kind::Fold => 1,
        Kind::Flip => 2,
        Kind::Branching => 5,
        Kind::Graze { .. } => 3,
        Kind::Chatter | Kind::Detachment => 4,
        // Of another figure.
        Kind::Type { .. } => MARKED.len(),
    }
}

/// Impact phases along branches against the parameter.
pub fn branches_figure(drawn: Branches<'_>) -> Figure {
    let Branches { title, parameter: (name, range), branches, settled, corners } = drawn;
    let mut series = Vec::new();
    if let Some(density) = settled {
        series.push(Series { label: "runs".into(), colour: Colour::Grey, data: Data::Density(density) });
    }
    for (stable, label, colour, stroke) in
        [(true, "stable", Colour::Blue, Stroke::Solid), (false, "unstable", Colour::Vermilion, Stroke::Dashed)]
    {
        let points = lines(branches, stable);
        if !points.is_empty() {
            series.push(Series { label: label.into(), colour, data: Data::Line { points, stroke } });
        }
    }
    let sticking = branches.iter().flat_map(|branch| &branch.points);
    let sticking = sticking.filter(|point| matches!(point.orbit.course, Course::Sticking(_)));
    let points: Vec<[f64; 2]> = sticking
        .flat_map(|point| point.orbit.impacts().map(|impact| [point.value, impact.cam_angle.to_degrees()]))
        .collect();
    if !points.is_empty() {
        let data = Data::Points { points, marker: Marker::Dot };
        series.push(Series { label: "stable, sticking".into(), colour: Colour::Blue, data });
    }
    for (which, (label, colour)) in MARKED.into_iter().enumerate() {
        let points: Vec<[f64; 2]> =
            branches.iter().flat_map(|branch| &branch.points).filter_map(|point| place(point, which)).collect();
        if !points.is_empty() {
            let marker = if points.len() > MANY { Marker::SmallRing } else { Marker::Ring };
            series.push(Series { label: label.into(), colour, data: Data::Points { points, marker } });
        }
    }
    let marks = corners.iter().map(CornerMark::mark).collect();
    let axis = Axis::degrees("cam angle at impact φ");
    let (label, unit) = if name == "rpm" { ("cam speed ω", "rpm") } else { (name, "") };
    Figure {
        title: title.into(),
        x: Axis::new(label, unit).over(range),
        marks: Vec::new(),
        panels: vec![panel(axis.over([0.0, 360.0]), 0.52, series, marks)],
        note: String::new(),
    }
}

/// Where a special point of one of the marked kinds is drawn: at the impact that it is about, or the first.
fn place(point: &BranchPoint, which: usize) -> Option<[f64; 2]> {
    let special = point.special.filter(|special| mark(&special.kind) == which)?;
    let index = if let Kind::Corner { contact, .. } = special.kind { contact } else { 0 };
    let impact = point.orbit.impacts().nth(index).or_else(|| point.orbit.impacts().next())?;
    Some([point.value, impact.cam_angle.to_degrees()])
}

/// The phases of each impact along the branches where they are stable, or not, with a break after each line.
fn lines(branches: &[Branch], stable: bool) -> Vec<[f64; 2]> {
    const BREAK: [f64; 2] = [f64::NAN, f64::NAN];
    let all = branches.iter().flat_map(Branch::lines).filter(|line| line.stable == stable);
    all.flat_map(|line| {
        let points = line.points.into_iter().map(|[value, angle]| [value, angle.to_degrees()]);
        std::iter::once(BREAK).chain(points)
    })
    .collect()
}
