//! Branches of orbits over the brute-force diagram: stable unbroken, unstable broken, special points marked.

use crate::border_collision::feigin::Scenario;
use crate::draw::{Axis, BREAK, Colour, Data, Density, Figure, Marker, Panel, Series};
use crate::figures::cam::{CornerMark, corner_marks};
use crate::figures::impacts::{WHOLE_CAM, impact_angles, shown_impacts};
use crate::figures::{Entry, Fast, SPEED, Subject, by_stability, drawn};
use crate::orbit::branch::{Branch, BranchPoint, Kind, find_branches};
use crate::orbit::{Course, Search};

/// Around the corner impact.
pub(crate) const FAST_IMPACTS: Entry = Entry {
    id: "fast-impacts",
    place: "Figure 5(c)",
    title: |subject| {
        subject.fast_title("impacts and orbits around the corner impact", |Fast { range: [low, high], .. }| {
            format!("impacts and orbits, {low} to {high} rpm")
        })
    },
    draw: |subject, title| {
        let range = subject.shown.fast.clone()?.range;
        let mut runs = Density::new(range, WHOLE_CAM);
        subject.fast_runs(range, false)?.iter().for_each(|[rpm, angle]| runs.push(*rpm, angle.to_degrees()));
        let shown = shown_impacts(&runs);
        let corners = corner_marks(&subject.cam);
        let mut figure = branches_figure(title, ("rpm", range), subject.branches()?, Some(runs), &corners);
        if let Some(panel) = figure.panels.first_mut() {
            panel.y.range = shown.or(panel.y.range);
        }
        let line = "At the corner impact the line of one impact a revolution goes on";
        let end = match subject.scenario() {
            Some(Scenario::NonsmoothFold) => " At the corner impact two lines of one impact a revolution meet and end.",
            Some(Scenario::NonsmoothFlip) => &format!(" {line}, and one of two in two begins."),
            Some(Scenario::Persistence) => &format!(" {line}."),
            None => "",
        };
        let caption = format!(
            "Where impacts fall on the cam: grey is what runs with rising and with falling speed settle on, lines are the \
             orbits of one impact in one revolution and of two in two, stable unbroken and unstable broken.{end}",
        );
        drawn(figure, caption)
    },
};

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

/// Impact phases along branches against the parameter of this name over its range, above what runs settle on: the parameter
/// across, impact phases in degrees up.
pub fn branches_figure(
    title: &str,
    (name, range): (&str, [f64; 2]),
    branches: &[Branch],
    settled: Option<Density>,
    corners: &[CornerMark],
) -> Figure {
    let runs = settled.map(|density| Series::new("runs", Colour::Grey, Data::Density(density)));
    let mut series: Vec<Series> = runs.into_iter().collect();
    series.extend(by_stability(["stable", "unstable"], |stable| lines(branches, stable)));
    let points = || branches.iter().flat_map(|branch| &branch.points);
    let sticking = points().filter(|point| matches!(point.orbit.course, Course::Sticking(_)));
    let sticking =
        sticking.flat_map(|point| point.orbit.impacts().map(|impact| [point.value, impact.cam_angle.to_degrees()]));
    series.extend(Series::points("stable, sticking", Colour::Blue, Marker::Dot, sticking).if_any());
    for (which, (label, colour)) in MARKED.into_iter().enumerate() {
        let points: Vec<[f64; 2]> = points().filter_map(|point| place(point, which)).collect();
        let marker = if points.len() > MANY { Marker::SmallRing } else { Marker::Ring };
        series.extend(Series::points(label, colour, marker, points).if_any());
    }
    let [label, unit] = if name == "rpm" { SPEED } else { [name, ""] };
    let panel = Panel::new(impact_angles().over(WHOLE_CAM), 0.52, series);
    let panel = Panel { marks: corners.iter().map(CornerMark::mark).collect(), ..panel };
    Figure::new(title, Axis::new(label, unit).over(range), vec![panel])
}

/// Where a special point of one of the marked kinds is drawn: at the impact that it is about, or the first.
fn place(point: &BranchPoint, which: usize) -> Option<[f64; 2]> {
    let special = point.special.filter(|special| mark(&special.kind) == which)?;
    let index = if let Kind::Corner { impact, .. } = special.kind { impact } else { 0 };
    let impact = point.orbit.impacts().nth(index).or_else(|| point.orbit.impacts().next())?;
    Some([point.value, impact.cam_angle.to_degrees()])
}

/// The phases of each impact along the branches where they are stable, or not, with a break before each line.
fn lines(branches: &[Branch], stable: bool) -> Vec<[f64; 2]> {
    let all = branches.iter().flat_map(Branch::lines).filter(|line| line.stable == stable);
    all.flat_map(|line| {
        let points = line.points.into_iter().map(|[value, angle]| [value, angle.to_degrees()]);
        std::iter::once(BREAK).chain(points)
    })
    .collect()
}

impl Subject {
    /// The branches of orbits of one impact in one revolution, and of two in two, over the fast speeds that are shown.
    pub(crate) fn branches(&self) -> Result<&[Branch], String> {
        let found = self.followed.get_or_init(|| {
            let range = self.shown.fast.clone()?.range;
            let mut branches = Vec::new();
            for wanted in [(1, 1), (2, 2)].map(|(revolutions, impacts)| Search { revolutions, impacts: Some(impacts) })
            {
                branches
                    .extend(find_branches(&self.model, range, &wanted).map_err(|error| error.to_string())?.branches);
            }
            Ok(branches)
        });
        found.as_deref().map_err(Clone::clone)
    }
}
