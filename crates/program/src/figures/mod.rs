//! Figures, one per file: data, plot, title, caption and row of the table. Figures that only a command draws ([`basins_figure`],
//! [`curve_figure`], ...) are not in the table.

mod basins;
mod branches;
mod cam;
mod cam_shape;
mod chaos;
mod chart;
mod composition;
mod curve;
mod design;
mod discontinuity_mapping;
mod impacts;
mod local_map;
mod phase_plane;
pub mod section;
mod speeds;
mod subject;
mod trace;

use serde::Serialize;

use corner_impact::command::command;
use corner_impact::model::Units;
use corner_impact::orbit::Stability;
use corner_impact::study::survey::{self, Spacing};
use corner_impact_plot::{self, Colour, Figure, FigureAxis, Series, Stroke};

pub use basins::{basins_figure, shares_figure};
pub use branches::branches_figure;
pub use cam::{CornerMark, corner_marks};
pub use cam_shape::{cam_figure, shape_figure};
pub use chaos::chaos_figure;
pub use chart::{Coloured, chart_figure};
pub use composition::{Composition, Line, Neighbour};
pub use curve::curve_figure;
pub use design::{design_figure, loads_diagram};
pub use impacts::{Shown, impact_diagram, strobe_diagram};
pub use phase_plane::phase_plane;
pub use speeds::{impacts_by_speed, speeds_figure};
pub(crate) use subject::NO_STUDY;
pub use subject::{Effort, Fast, FigureContext, ShownSpeeds, Slow};
pub use trace::{TracedRun, time_trace, with_force};

/// All figures of the report, in the paper's order.
pub(crate) static FIGURES: [Entry; 15] = [
    cam_shape::CAM_SHAPE,
    cam::CAM,
    trace::SLOW_TRACE,
    phase_plane::SLOW_PHASE_PLANE,
    impacts::SLOW_IMPACTS,
    trace::INTERRUPTED_TRACE,
    branches::FAST_IMPACTS,
    section::FAST_SECTION,
    trace::CORNER_ORBIT,
    trace::BEYOND_TRACE,
    section::BEYOND_ATTRACTOR,
    chaos::CHAOTIC_SET,
    composition::COMPOSITION,
    discontinuity_mapping::DISCONTINUITY_MAPPING,
    local_map::LOCAL_MAP,
];

/// Name of the figure that shows proved chaos.
pub(crate) fn chaotic_set() -> &'static str {
    chaos::CHAOTIC_SET.id
}

/// Name of the figure that shows impacts and orbits at speeds around the corner impact.
pub(crate) fn around_corner() -> &'static str {
    branches::FAST_IMPACTS.id
}

/// Row of the table of figures.
pub(crate) struct Entry {
    /// Name in commands.
    pub(crate) id: &'static str,
    /// Corresponding figure of the paper; empty for none.
    place: &'static str,
    /// Whether it is drawn at the speeds of `--rpm`, and not at those of the corner impact.
    pub(crate) takes_rpm: bool,
    title: fn(&FigureContext) -> String,
    /// Draws the figure under a title, or returns the reason why there is none.
    draw: fn(&FigureContext, &str) -> Result<Captioned, String>,
}

/// One figure of the report.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderedFigure {
    /// Name in commands.
    pub id: &'static str,
    /// Corresponding figure of the paper; empty for none.
    pub place: &'static str,
    /// Title of the figure.
    pub title: String,
    /// Command that draws this figure.
    pub command: String,
    /// Figure, or the reason why there is none.
    pub drawn: Result<Captioned, String>,
}

/// Figure with its caption.
#[derive(Clone, Debug, PartialEq)]
pub struct Captioned {
    /// The figure.
    pub figure: Figure,
    /// Explanation of the figure, in one to three sentences.
    pub caption: String,
}

pub(crate) fn drawn(figure: Figure, caption: impl Into<String>) -> Result<Captioned, String> {
    Ok(Captioned { figure, caption: caption.into() })
}

corner_impact::document!(RenderedFigure as plate {
    id: plate.id,
    place: plate.place,
    title: plate.title,
    caption: plate.drawn.as_ref().map_or("", |drawn| &drawn.caption),
    command: plate.command,
    figure: plate.drawn.as_ref().ok().map(|drawn| &drawn.figure),
    absent: plate.drawn.as_ref().err(),
});

/// Figure that a command can draw.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Listed {
    /// Name in commands.
    pub id: &'static str,
    /// Corresponding figure of the paper; empty for none.
    pub place: &'static str,
    /// Title of the figure.
    pub title: String,
}

/// Lists the figures of a model, in order.
pub fn listed(subject: &FigureContext) -> Vec<Listed> {
    FIGURES.iter().map(|entry| Listed { id: entry.id, place: entry.place, title: (entry.title)(subject) }).collect()
}

const SCHEMA: &str = "corner-impact/figure/1";

/// Figures of a model: the document of `figure --json`.
#[derive(Clone, Debug, Serialize)]
pub struct FigureList {
    schema: &'static str,
    model: String,
    /// The figures, in order.
    pub figures: Vec<Listed>,
}

impl FigureList {
    /// Lists the figures of a model.
    pub fn new(subject: &FigureContext) -> Self {
        Self { schema: SCHEMA, model: subject.model.name.clone(), figures: listed(subject) }
    }
}

/// Figure with every number that it shows: the document of `figure ID --json`.
#[derive(Clone, Debug, Serialize)]
pub struct OneFigure {
    schema: &'static str,
    model: String,
    /// The figure.
    #[serde(flatten)]
    pub plate: RenderedFigure,
}

impl OneFigure {
    /// Builds the document of a figure of a model.
    pub fn new(subject: &FigureContext, plate: RenderedFigure) -> Self {
        Self { schema: SCHEMA, model: subject.model.name.clone(), plate }
    }
}

/// Draws every figure; `progress` gets the number done and the total.
pub fn plates(subject: &FigureContext, progress: &mut dyn FnMut(usize, usize)) -> Vec<RenderedFigure> {
    let plates = FIGURES.iter().enumerate().map(|(index, entry)| {
        progress(index, FIGURES.len());
        entry.plate(subject)
    });
    let plates = plates.collect();
    progress(FIGURES.len(), FIGURES.len());
    plates
}

/// Draws the figure of this name; `None` if the table has no such name.
pub fn plate(subject: &FigureContext, id: &str) -> Option<RenderedFigure> {
    FIGURES.iter().find(|entry| entry.id == id).map(|entry| entry.plate(subject))
}

impl Entry {
    pub(crate) fn plate(&self, subject: &FigureContext) -> RenderedFigure {
        let title = (self.title)(subject);
        let units = &subject.model.units;
        let in_units =
            |drawn: Captioned| Captioned { figure: drawn.figure.in_units(|unit| units.spelled(unit)), ..drawn };
        let drawn = (self.draw)(subject, &title).map(in_units);
        let chosen = subject.rpm.filter(|_| self.takes_rpm);
        let speeds = chosen.map_or(String::new(), |[low, high]| format!(" --rpm {low}:{high}"));
        let command = command("figure", &subject.model, &format!("{}{speeds} --out {}.svg", self.id, self.id));
        RenderedFigure { id: self.id, place: self.place, title, command, drawn }
    }
}

/// Name and unit of the axis of speeds.
const SPEED: [&str; 2] = ["cam speed ω", "rpm"];

/// Horizontal axis of a survey: a number or its decimal logarithm, with the positions of values.
#[derive(Clone, Debug)]
pub struct Across {
    axis: FigureAxis,
    spacing: Spacing,
}

impl Across {
    /// Axis of the named number, in the units of a model, from one value to another.
    pub fn new(name: &str, spacing: Spacing, ends: [f64; 2], units: &Units) -> Self {
        Self::named(name, &units.of_number(name), spacing, ends)
    }

    /// Axis of the named number, in this unit, from one value to another.
    pub(crate) fn named(name: &str, unit: &str, spacing: Spacing, ends: [f64; 2]) -> Self {
        let label = if name == "rpm" { SPEED[0] } else { name.rsplit('.').next().unwrap_or(name) };
        let axis = FigureAxis::new(label, unit).over(ends.map(|end| spacing.place(end)));
        let ticks = if spacing == Spacing::Logarithmic {
            corner_impact_plot::TickSpacing::Logarithmic
        } else {
            corner_impact_plot::TickSpacing::Decimal
        };
        Self { axis: FigureAxis { spacing: ticks, ..axis }, spacing }
    }

    /// Axis of a survey, in the units of a model.
    pub fn of(axis: &survey::Axis, units: &Units) -> Self {
        Self::new(axis.parameter.name(), axis.spacing, axis.ends(), units)
    }

    /// Position of a value on the axis.
    pub fn place(&self, value: f64) -> f64 {
        self.spacing.place(value)
    }

    /// Sets this axis in a figure, with the figure's range.
    pub fn under(&self, figure: Figure) -> Figure {
        let axis = FigureAxis { range: figure.x.range, ..self.axis() };
        Figure { x: axis, ..figure }
    }

    /// Axis as drawn; a single value gets room on both sides.
    pub(crate) fn axis(&self) -> FigureAxis {
        match self.axis.range {
            Some([low, high]) if low == high => self.axis.clone().over([0.99 * low, 1.01 * low]),
            _ => self.axis.clone(),
        }
    }
}

/// Axis of positions at the section.
fn position() -> FigureAxis {
    FigureAxis::new("follower position q at the section", "m")
}

/// Lines for each stability that occurs: stable solid, unstable dashed, neutral dotted.
fn by_stability<'a>(
    label: impl Fn(Stability) -> &'a str,
    points: impl Fn(Stability) -> Vec<[f64; 2]>,
) -> impl Iterator<Item = Series> {
    let strokes = [
        (Stability::Stable, Colour::Blue, Stroke::Solid),
        (Stability::Unstable, Colour::Vermilion, Stroke::Dashed),
        (Stability::Neutral, Colour::Green, Stroke::Dotted),
    ];
    strokes.into_iter().filter_map(move |(stability, colour, stroke)| {
        Series::line(label(stability), colour, stroke, points(stability)).if_any()
    })
}
