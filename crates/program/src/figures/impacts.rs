//! Diagrams over speeds: cam angles of impacts, or follower positions at the section.

use crate::figures::cam::{CornerMark, corner_marks};
use crate::figures::{Effort, Entry, FigureContext, SPEED, Slow, drawn, position};
use corner_impact::orbit::Parameter;
use corner_impact::study::survey::{
    Axis as Over, Beginning, Placed, Places, Section, Spacing, Start, Survey, Sweep, SweepError, SweepStart, Values,
};
use corner_impact_plot::layout::widened;
use corner_impact_plot::{Cloud, Colour, Data, Density, Figure, FigureAxis, Panel, Series, Stroke};

/// Impacts above the speed at which the follower first leaves the cam.
pub(crate) const SLOW_IMPACTS: Entry = Entry {
    id: "slow-impacts",
    place: "Figure 5(a)",
    takes_rpm: true,
    title: |subject| {
        subject.slow_title("impacts on the cam above detachment", |Slow { range: [low, high], .. }| {
            format!("impacts on the cam, {low} to {high} rpm")
        })
    },
    draw: |subject, title| {
        let range = subject.shown.slow.clone()?.range;
        let points = cloud(range, &subject.slow_impacts(range)?);
        let corners = corner_marks(&subject.cam);
        let lines = match (subject.cam.corners().len(), corners.len()) {
            (0, _) => "The cam has no corner.",
            (all, marked) if marked < all => "Horizontal lines are the largest of the cam's corners.",
            _ => "Horizontal lines are the cam's corners.",
        };
        let caption = format!(
            "Cam angles of the impacts at each speed, in {} revolutions after {}. A curve is an impact that repeats, and scattered \
             points are motions that do not; curves crowd where impacts accumulate before the follower rests. {lines}",
            subject.slow_effort.record, subject.slow_effort.transient,
        );
        drawn(impact_diagram(title, points, &corners, None), caption)
    },
};

/// Points of a picture of a sweep: impact angles, in degrees, or positions at the section, m, and Lyapunov exponents. The horizontal axis
/// has the spacing of the values.
#[derive(Clone, Debug)]
pub struct Shown {
    in_degrees: bool,
    spacing: Spacing,
    cloud: Cloud,
    /// Position of each value with a Lyapunov exponent, and the exponent per revolution.
    pub exponents: Vec<[f64; 2]>,
}

impl Shown {
    /// Builds an empty picture of a sweep.
    pub fn new(sweep: &Sweep) -> Self {
        let spacing = sweep.over.axis().spacing;
        let [low, high] = sweep.over.axis().ends().map(|end| spacing.place(end));
        let cloud = Cloud::new(if high > low { [low, high] } else { [0.99 * low, 1.01 * low] });
        Self { in_degrees: sweep.section == Section::Impacts, spacing, cloud, exponents: Vec::new() }
    }

    /// Adds the results of a block.
    pub fn take(&mut self, found: &Places) {
        for [value, place] in &found.places {
            self.cloud.push(self.spacing.place(*value), if self.in_degrees { place.to_degrees() } else { *place });
        }
        let is_new = |new: &[f64; 2]| self.exponents.last().is_none_or(|last| last[0] != new[0]);
        let placed = |[value, exponent]: [f64; 2]| [self.spacing.place(value), exponent];
        self.exponents.extend(found.exponent.map(placed).filter(is_new));
    }

    /// Returns the density of the points, and the exponents.
    pub fn places(self) -> (Density, Vec<[f64; 2]>) {
        (self.cloud.finish(), self.exponents)
    }
}

/// Range of cam angles, degrees.
pub(crate) const WHOLE_CAM: [f64; 2] = [0.0, 360.0];
/// Note below a diagram with an exponent that cannot be drawn.
const FORGETS: &str = "λ = −∞, not drawn, where the follower sticks to the cam: every deviation is lost there";

/// Draws impact phases in degrees against speed in rpm, with the cam's corners as lines. A second panel shows
/// `[rpm, Lyapunov exponent per revolution]`.
pub fn impact_diagram(title: &str, points: Density, corners: &[CornerMark], exponents: Option<&[[f64; 2]]>) -> Figure {
    let shown = shown_impacts(&points);
    let mut figure = figure(title, points, impact_angles(), shown, exponents);
    if let Some(panel) = figure.panels.first_mut() {
        panel.marks = corners.iter().map(CornerMark::mark).collect();
    }
    figure
}

/// Draws positions at the section, m, against speed in rpm, with exponents as in [`impact_diagram`].
pub fn strobe_diagram(title: &str, points: Density, exponents: Option<&[[f64; 2]]>) -> Figure {
    let shown = points.extent().map(|extent| widened(extent, 0.02));
    figure(title, points, position(), shown, exponents)
}

/// Cloud of impacts over a range of values; each impact is a value of the horizontal axis and a cam angle, rad.
pub(crate) fn cloud(range: [f64; 2], impacts: &[[f64; 2]]) -> Density {
    let mut cloud = Density::new(range, WHOLE_CAM);
    impacts.iter().for_each(|[value, angle]| cloud.push(*value, angle.to_degrees()));
    cloud
}

/// Axis of impact phases.
pub(crate) fn impact_angles() -> FigureAxis {
    FigureAxis::degrees("cam angle at impact φ")
}

/// Range of the points' impact phases, degrees, slightly widened, and at most the whole cam.
pub(crate) fn shown_impacts(points: &Density) -> Option<[f64; 2]> {
    Some(at_most_the_cam(widened(points.extent()?, 0.02)))
}

/// Limits a range of angles, degrees, to one revolution.
pub(crate) fn at_most_the_cam([low, high]: [f64; 2]) -> [f64; 2] {
    [low.max(WHOLE_CAM[0]), high.min(WHOLE_CAM[1])]
}

fn figure(
    title: &str,
    points: Density,
    axis: FigureAxis,
    shown: Option<[f64; 2]>,
    exponents: Option<&[[f64; 2]]>,
) -> Figure {
    let [rpm, all] = points.ranges();
    let forgets = exponents.is_some_and(|points| points.iter().any(|[_, exponent]| *exponent == f64::NEG_INFINITY));
    let cloud = Series::new("", Colour::Blue, Data::Density(points));
    let mut panels = vec![Panel::new(axis.over(shown.unwrap_or(all)), 0.52, vec![cloud])];
    panels.extend(exponents.map(|points| {
        let line = Series::line("", Colour::Vermilion, Stroke::Thin, points.iter().copied());
        Panel::new(FigureAxis::new("Lyapunov exponent λ", "per revolution"), 0.2, vec![line]).with_zero()
    }));
    let note = if forgets { FORGETS.into() } else { String::new() };
    Figure { note, ..Figure::new(title, FigureAxis::new(SPEED[0], SPEED[1]).over(rpm), panels) }
}

impl FigureContext {
    fn sweep(
        &self,
        range: [f64; 2],
        section: Section,
        following: SweepStart,
        effort: Effort,
    ) -> Result<Vec<[f64; 2]>, String> {
        let [low, high] = range;
        let speeds = Over::new(Parameter::Speed, &Values::linear(low, high, effort.speeds));
        let sweep = Sweep {
            over: Survey::new(&self.model, None, speeds, None).map_err(|error| error.to_string())?,
            starts: Beginning::One(Start { cam_angle: 0.0, follower: Placed::OnCam(0.0) }),
            following,
            transient: effort.transient,
            record: effort.record,
            section,
            growth: None,
        };
        let mut places = Vec::new();
        let kept = sweep.run(None, |_, found: Places| {
            places.extend(found.places);
            Ok::<(), SweepError>(())
        });
        kept.map(|_| places).map_err(|error| error.to_string())
    }

    /// Impacts above detachment: speed, rpm, and cam angle, rad.
    pub fn slow_impacts(&self, range: [f64; 2]) -> Result<Vec<[f64; 2]>, String> {
        self.sweep(range, Section::Impacts, SweepStart::Nothing, self.slow_effort)
    }

    /// Points on which runs with rising and with falling speed settle around the corner impact: speed, rpm, and cam angle of
    /// impacts, rad, or position at the section of the corner impact's map, m.
    pub fn fast_runs(&self, range: [f64; 2], at_section: bool) -> Result<Vec<[f64; 2]>, String> {
        let section = if at_section { Section::Strobe(self.found()?.at.section_angle()) } else { Section::Impacts };
        let run = |following| self.sweep(range, section, following, self.fast_effort);
        let (rising, falling) = rayon::join(|| run(SweepStart::Up), || run(SweepStart::Down));
        let mut both = rising?;
        both.extend(falling?);
        Ok(both)
    }
}
