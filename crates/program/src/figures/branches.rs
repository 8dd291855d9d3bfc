//! Branches of orbits over the brute-force diagram. Stable branches are solid, unstable ones dashed; each kind of special point has its own
//! shape; attractors of runs are drawn behind them. No distinction needs colour.

use crate::figures::cam::{CornerMark, corner_marks};
use crate::figures::impacts::{WHOLE_CAM, at_most_the_cam, cloud, impact_angles, shown_impacts};
use crate::figures::{Entry, Fast, FigureContext, SPEED, by_stability, drawn};
use crate::show::words;
use corner_impact::border_collision::feigin::Scenario;
use corner_impact::orbit::branch::{Branch, BranchPoint, SpecialKind, find_branches};
use corner_impact::orbit::{Course, Search, Stability};
use corner_impact::study::survey::recurrence;
use corner_impact_plot::layout::widened;
use corner_impact_plot::{BREAK, Colour, Data, Figure, FigureAxis, Marker, Panel, Series, extent};

/// Branches and impacts around the corner impact.
pub(crate) const FAST_IMPACTS: Entry = Entry {
    id: "fast-impacts",
    place: "Figure 5(c)",
    takes_rpm: false,
    title: |subject| {
        subject.fast_title("impacts and orbits around the corner impact", |Fast { range: [low, high], .. }| {
            format!("impacts and orbits, {low} to {high} rpm")
        })
    },
    draw: |subject, title| {
        let range = subject.shown.fast.clone()?.range;
        let runs = subject.fast_runs(range, false)?;
        let shown = shown_impacts(&cloud(range, &runs));
        let corners = corner_marks(&subject.cam);
        let mut figure = branches_figure(title, ("rpm", SPEED[1], range), subject.branches()?, &runs, &corners);
        if let Some(panel) = figure.panels.first_mut() {
            panel.y.range = shown.or(panel.y.range);
        }
        let line = "At the corner impact, the line of one impact a revolution continues";
        let end = match subject.scenario() {
            Some(Scenario::NonsmoothFold) => {
                " At the corner impact, two lines of one impact a revolution meet and end."
            }
            Some(Scenario::NonsmoothFlip) => &format!(" {line}, and one of two impacts in two revolutions begins."),
            Some(Scenario::Persistence) => &format!(" {line}."),
            None => "",
        };
        let caption = format!(
            "Cam angles of impacts. Grey: motions on which runs with rising and with falling speed settle, broad if they repeat; lines: \
             orbits of one impact in one revolution and of two in two, solid if stable and broken if unstable.{end}",
        );
        drawn(figure, caption)
    },
};

/// Kinds of special point that are marked, with name, colour and shape.
const MARKED: [(&str, Colour, Marker); 6] = [
    ("corner impact", Colour::Ink, Marker::Ring),
    ("fold", Colour::Ink, Marker::Square),
    ("flip", Colour::Purple, Marker::Diamond),
    ("graze", Colour::Green, Marker::Triangle),
    ("chatter, detachment", Colour::Ink, Marker::Cross),
    ("branching", Colour::Ink, Marker::Plus),
];

fn mark(kind: &SpecialKind) -> usize {
    match kind {
        SpecialKind::Corner { .. } => 0,
        SpecialKind::Fold => 1,
        SpecialKind::Flip => 2,
        SpecialKind::Branching => 5,
        SpecialKind::Graze { .. } => 3,
        SpecialKind::Chatter | SpecialKind::Detachment => 4,
        // These kinds belong to another figure.
        SpecialKind::Type { .. }
        | SpecialKind::Cusp
        | SpecialKind::Class(_)
        | SpecialKind::Place
        | SpecialKind::Turn => MARKED.len(),
    }
}

/// Draws impact phases, degrees, along branches against the named parameter over its range, over the impacts on which runs settle. These
/// impacts are sorted by the parameter. The parameter is drawn across; phases are drawn up, over the range of the branches.
pub fn branches_figure(
    title: &str,
    (name, unit, range): (&str, &str, [f64; 2]),
    branches: &[Branch],
    settled: &[[f64; 2]],
    corners: &[CornerMark],
) -> Figure {
    let (repeating, others) = by_recurrence(settled);
    let repeating = repeating.into_iter().map(|[value, angle]| [value, angle.to_degrees()]);
    let repeating = Series::points("runs that repeat", Colour::Grey, Marker::Dot, repeating).if_any();
    let others = (!others.is_empty()).then(|| cloud(range, &others));
    let others = others.map(|cloud| Series::new("other runs", Colour::Grey, Data::Density(cloud)));
    let mut series: Vec<Series> = repeating.into_iter().chain(others).collect();
    series.extend(by_stability(words::stability, |stability| lines(branches, stability)));
    let points = || branches.iter().flat_map(|branch| &branch.points);
    let sticking = points().filter(|point| matches!(point.orbit.course, Course::Sticking(_)));
    let sticking =
        sticking.flat_map(|point| point.orbit.impacts().map(|impact| [point.value, impact.cam_angle.to_degrees()]));
    series.extend(Series::points("stable, sticking", Colour::Blue, Marker::Dot, sticking).if_any());
    for (which, (label, colour, marker)) in MARKED.into_iter().enumerate() {
        let points = points().filter_map(|point| place(point, which));
        series.extend(Series::points(label, colour, marker, points).if_any());
    }
    let label = if name == "rpm" { SPEED[0] } else { name };
    let points = branches.iter().flat_map(|branch| &branch.points).flat_map(|point| point.orbit.impacts());
    let reach = extent(points.map(|impact| impact.cam_angle.to_degrees()));
    let up = if reach[0] <= reach[1] { at_most_the_cam(widened(reach, 0.07)) } else { WHOLE_CAM };
    let panel = Panel::new(impact_angles().over(up), 0.52, series);
    let panel = Panel { marks: corners.iter().map(CornerMark::mark).collect(), ..panel };
    Figure::new(title, FigureAxis::new(label, unit).over(range), vec![panel])
}

/// Splits the impacts of runs: one period at each value where the run is periodic, and all impacts at the other values.
fn by_recurrence(settled: &[[f64; 2]]) -> (Vec<[f64; 2]>, Vec<[f64; 2]>) {
    let (mut repeating, mut others) = (Vec::new(), Vec::new());
    for run in settled.chunk_by(|[one, _], [other, _]| one == other) {
        let angles: Vec<f64> = run.iter().map(|[_, angle]| *angle).collect();
        match recurrence(&angles) {
            Some(period) => repeating.extend(&run[..period]),
            None => others.extend(run),
        }
    }
    (repeating, others)
}

/// Position of a special point of one of the marked kinds: at its own impact, or at the first impact. For an orbit without impacts, it is
/// at the grazing point.
fn place(point: &BranchPoint, which: usize) -> Option<[f64; 2]> {
    let special = point.special.filter(|special| mark(&special.kind) == which)?;
    let index = if let SpecialKind::Corner { impact, .. } = special.kind { impact } else { 0 };
    let impact = point.orbit.impacts().nth(index).or_else(|| point.orbit.impacts().next());
    let angle = match (impact, special.kind) {
        (Some(impact), _) => impact.cam_angle,
        (None, SpecialKind::Graze { turned, .. }) => turned,
        (None, _) => return None,
    };
    Some([point.value, angle.to_degrees()])
}

/// Phases of each impact along the parts of branches with this stability, with a break before each line.
fn lines(branches: &[Branch], stability: Stability) -> Vec<[f64; 2]> {
    let all = branches.iter().flat_map(Branch::lines).filter(|line| line.stability == stability);
    all.flat_map(|line| {
        let points = line.points.into_iter().map(|[value, angle]| [value, angle.to_degrees()]);
        std::iter::once(BREAK).chain(points)
    })
    .collect()
}

impl FigureContext {
    /// Branches of orbits of one impact in one revolution, and of two in two, over the fast speeds that are shown.
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
