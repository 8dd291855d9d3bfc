//! Tables as lines of CSV. Numbers have the fewest digits that read back as the same double, without a point if they are whole and never
//! with a power of ten. The csv crate is not used, because it writes `1.0` and `1e-7`.

use std::fmt::{Display, Write};

use crate::show::digits::Digits;
use crate::show::sources::Sources;
use corner_impact::border_collision::EventCurve;
use corner_impact::estimate::Estimate;
use corner_impact::flight::State;
use corner_impact::model::{Model, Units};
use corner_impact::orbit::Eigenvalue;
use corner_impact::orbit::branch::{Branch, SpecialKind};
use corner_impact::orbit::long_run::LongRun;
use corner_impact::section::TraceSample;
use corner_impact::simulate::{Event, Machine, Motion};
use corner_impact::study::attractors::Transition;
use corner_impact::study::basins::{Basin, Basins, BasinsOver};
use corner_impact::study::chart::{Chart, Charted, class};
use corner_impact::study::design::loads::Loads;
use corner_impact::study::speeds::{At, AttractorRow, SpeedSurvey};
use corner_impact::study::survey::{Axis, Beginning, GridResults, Point, RecordBlock, RecordRow, Section, Seen, Sweep};
use corner_impact_plot::{Data, Figure};

/// Columns of a run's events.
pub(crate) const EVENTS: &str =
    "revolution,time_s,cam_angle_rad,event,position_m,velocity_before_m_s,velocity_after_m_s,cam_velocity_m_s\n";

/// Appends an event of a run at `angular_velocity`, rad/s, that started at `start_angle`, rad.
pub(crate) fn event(line: &mut String, event: &Event, start_angle: f64, angular_velocity: f64, units: &Units) {
    let cam_angle = units.angle(event.cam_angle);
    let Event { revolution, position, velocity_before, velocity_after, cam_velocity, .. } = event;
    let (time, kind) = (event.turned_since(start_angle) / angular_velocity, event.kind.name());
    // Writing to a string does not fail.
    let _ = writeln!(
        line,
        "{revolution},{time},{cam_angle},{kind},{position},{velocity_before},{velocity_after},{cam_velocity}"
    );
}

/// Columns of a run's states at one angle.
pub(crate) const STROBE: &str = "revolution,position_m,velocity_m_s,gap_m,contact\n";

/// Appends the state of a run at a section.
pub(crate) fn strobe(line: &mut String, machine: &Machine, motion: &Motion) {
    let State { position, velocity } = motion.state;
    let (gap, contact) = (machine.gap(motion), motion.contact);
    let _ = writeln!(line, "{},{position},{velocity},{gap},{contact}", motion.revolution);
}

/// Columns of a run's samples.
pub(crate) const TRACE: &str = "time_s,cam_angle_rad,position_m,velocity_m_s,gap_m,contact_force_n\n";

/// Samples of a run at `angular_velocity`, rad/s: time since `start_angle`, rad, and the contact force of the cam on the follower.
pub(crate) fn trace(samples: &[TraceSample], start_angle: f64, angular_velocity: f64, model: &Model) -> String {
    let (mut lines, units) = (String::new(), &model.units);
    for TraceSample { turned, cam_angle, state: State { position, velocity }, gap, pressing, .. } in samples {
        let time = (turned - start_angle) / angular_velocity;
        let force = units.force.told(model.follower.mass * pressing);
        let _ = writeln!(lines, "{time},{},{position},{velocity},{gap},{force}", units.angle(*cam_angle));
    }
    lines
}

/// Columns of a diagram.
pub(crate) fn diagram(sweep: &Sweep) -> String {
    let seen = match sweep.section {
        Section::Impacts => "cam_angle_rad,event,position_m,velocity_before_m_s,velocity_after_m_s",
        Section::Strobe(_) => "position_m,velocity_m_s",
    };
    let growth = sweep.growth.as_ref().map_or("", |_| ",lyapunov_per_revolution,lyapunov_error");
    let motion = if matches!(sweep.starts, Beginning::Found(_)) { ",attractor" } else { "" };
    sweep.over.units().columns(&format!("{},revolution,{seen}{growth}{motion}\n", sweep.over.axis().parameter.name()))
}

/// Lines of a diagram, as one worker writes them.
#[derive(Debug, Default)]
pub(crate) struct Lines {
    pub text: String,
    units: Units,
}

impl Lines {
    /// Number of characters after which lines are sent on.
    const FULL: usize = 1 << 15;
}

impl RecordBlock for Lines {
    fn of(sweep: &Sweep) -> Self {
        Self { text: String::new(), units: sweep.over.units().clone() }
    }

    fn push(&mut self, row: &RecordRow) {
        let line = &mut self.text;
        let RecordRow { value, revolution, motion, seen, growth } = row;
        let _ = match seen {
            Seen::Event(event) => {
                let Event { position, velocity_before, velocity_after, .. } = event;
                let (cam_angle, kind) = (self.units.angle(event.cam_angle), event.kind.name());
                write!(line, "{value},{revolution},{cam_angle},{kind},{position},{velocity_before},{velocity_after}")
            }
            Seen::Section(State { position, velocity }) => write!(line, "{value},{revolution},{position},{velocity}"),
        };
        if let Some(Estimate { value, error, .. }) = growth {
            let _ = write!(line, ",{value},{error}");
        }
        if let Some(motion) = motion {
            let _ = write!(line, ",{motion}");
        }
        line.push('\n');
    }

    fn is_full(&self) -> bool {
        self.text.len() >= Self::FULL
    }
}

/// Writes the value, or an empty cell.
fn cell(value: Option<impl Display>) -> String {
    value.map_or(String::new(), |value| value.to_string())
}

/// Two multipliers, each as real and imaginary part.
fn multipliers([one, two]: [Eigenvalue; 2]) -> String {
    format!("{},{},{},{}", one.re, one.im, two.re, two.im)
}

/// Table of starts, a line each, row by row; `ending` is empty if the start is below the cam.
pub(crate) fn basins(basins: &Basins, units: &Units) -> String {
    let mut lines = units.columns("position_m,velocity_m_s,ending,part,revolutions,impacts,followed");
    for (index, part) in basins.cells.iter().enumerate() {
        let State { position, velocity } = basins.begun.state(index);
        let ending = part.map(|part| &basins.parts[part].ending);
        let (name, part) = (cell(ending.map(LongRun::kind)), cell(*part));
        let period = ending.and_then(LongRun::period);
        let (turns, impacts) = (cell(period.map(|period| period.0)), cell(period.map(|period| period.1)));
        let followed = cell(basins.followed.get(index).copied().flatten());
        let _ = writeln!(lines, "{position},{velocity},{name},{part},{turns},{impacts},{followed}");
    }
    lines
}

/// Table of motions, a line for each at each value: the share of the starts that end on it.
pub(crate) fn basins_over(found: &BasinsOver) -> String {
    let mut lines = format!(
        "{},ending,part,revolutions,impacts,growth_rate,growth_error,starts,share,share_error,followed\n",
        found.over.name
    );
    for at in &found.at {
        let value = at.place.across();
        for (part, it) in at.found.iter().flat_map(|found| &found.parts).enumerate() {
            let (name, period, growth) = (it.ending.kind(), it.ending.period(), it.ending.growth());
            let (turns, impacts) = (cell(period.map(|period| period.0)), cell(period.map(|period| period.1)));
            let Basin { starts, share: Estimate { value: share, error, .. }, followed, .. } = it;
            let (rate, rate_error) = (growth.value, growth.error);
            let _ = writeln!(
                lines,
                "{value},{name},{part},{turns},{impacts},{rate},{rate_error},{starts},{share},{error},{followed}"
            );
        }
    }
    lines
}

/// Columns of a run's motion. No cell is empty, so that numerical programs can read all columns except the class.
const POINT: &str =
    "class,revolutions,impacts,growth_rate,growth_error,impact_speed_m_s,impacts_per_revolution,followed\n";

/// Appends the cells of [`POINT`].
fn point(lines: &mut String, point: &Result<Point, String>) {
    let class = class(point.as_ref().ok().map(|point| point.kind));
    let _ = match point {
        Ok(Point { revolutions, impacts, impact_rate, growth, impact_speed, followed, .. }) => {
            let Estimate { value, error, .. } = growth;
            writeln!(lines, "{class},{revolutions},{impacts},{value},{error},{impact_speed},{impact_rate},{followed}")
        }
        Err(_) => writeln!(lines, "{class},0,0,NaN,NaN,NaN,NaN,0"),
    };
}

/// Table of the points of a chart, a line each, row by row.
pub(crate) fn chart(found: &Charted) -> String {
    let Chart { x, y, model, .. } = &found.chart;
    let mut lines = model.units.columns(&format!("x,y,{POINT}"));
    for (index, point) in found.points.iter().enumerate() {
        let (x, y) = (x.values[index % x.values.len()], y.values[index / x.values.len()]);
        let _ = write!(lines, "{x},{y},");
        self::point(&mut lines, point);
    }
    lines
}

/// Table of the motions at each value, a line each.
pub(crate) fn one_row(over: &Axis, points: &GridResults<Point>, units: &Units) -> String {
    let mut lines = units.columns(&format!("{},{POINT}", over.parameter.name()));
    for (value, point) in over.values.iter().zip(points) {
        let _ = write!(lines, "{value},");
        self::point(&mut lines, point);
    }
    lines
}

/// Table of the loads on follower and cam, a line for each revolution of a sweep.
pub(crate) fn loads(over: &str, sweep: &[Vec<Loads>], units: &Units) -> String {
    let columns = format!("{over},revolution,impact_speed_m_s,gap_m,off_cam_share,energy_lost_j,largest_force_n");
    let mut lines = units.columns(&columns);
    for (revolution, Loads { place, impact_speed, gap, off_cam, energy, force, .. }) in
        sweep.iter().flat_map(|at| at.iter().enumerate())
    {
        let (value, force) = (place.across(), units.force.told(*force));
        let _ = writeln!(lines, "{value},{revolution},{impact_speed},{gap},{off_cam},{energy},{force}");
    }
    lines
}

/// Columns for the beginning and end of an attractor, with the parts of the uncertainty, for a machine that is not exact.
const ENDS: &str = ",from,from_error,from_error_cam,from_error_numbers,to,to_error,to_error_cam,to_error_numbers";

/// Cells of [`ENDS`]; empty if an attractor does not end within the range, and for an unknown uncertainty.
fn ends(attractor: &AttractorRow) -> String {
    let of_end = |end: &Option<Transition>| {
        let error = end.as_ref().and_then(|end| end.error);
        let parts = [error.map(|it| it.total()), error.map(|it| it.cam), error.map(|it| it.numbers)].map(cell);
        format!(",{},{}", cell(end.as_ref().map(Transition::value)), parts.join(","))
    };
    [&attractor.birth, &attractor.death].map(of_end).concat()
}

/// Table of the attractors at each value of the grid.
pub(crate) fn speeds(found: &SpeedSurvey) -> String {
    let is_uncertain = Sources::of(&found.measured, found.errors).if_any().is_some();
    let mut lines = format!(
        "{},attractor,kind,revolutions,impacts,growth_rate,growth_error,share,share_error,coexisting,followed{}\n",
        found.over.name,
        if is_uncertain { ENDS } else { "" }
    );
    let mut all: Vec<(&AttractorRow, &At)> =
        found.attractors.iter().flat_map(|attractor| attractor.at.iter().map(move |at| (attractor, at))).collect();
    all.sort_by(|(_, one), (_, two)| one.value().total_cmp(&two.value()));
    for (attractor, at) in &all {
        let value = at.value();
        let coexisting = all.iter().filter(|(_, other)| other.value() == value).count();
        let (period, growth) = (at.ending.period(), at.ending.growth());
        let (turns, impacts) = (cell(period.map(|period| period.0)), cell(period.map(|period| period.1)));
        let (rate, error, followed) = (growth.value, growth.error, at.followed);
        let (id, kind, share, share_error) = (&attractor.id, at.ending.kind(), at.share.value, at.share.error);
        let ends = if is_uncertain { ends(attractor) } else { String::new() };
        let _ = writeln!(
            lines,
            "{value},{id},{kind},{turns},{impacts},{rate},{error},{share},{share_error},{coexisting},{followed}{ends}"
        );
    }
    lines
}

/// Table of every orbit of every branch, with its first impact and the state just after it. An orbit without impacts has the state at angle
/// 0.
pub(crate) fn branches(parameter: &str, branches: &[Branch], units: &Units) -> String {
    let mut lines = units.columns(
        "rpm,parameter,value,revolutions,impacts,cam_angle_rad,position_m,velocity_m_s,multiplier_1_re,multiplier_1_im,\
         multiplier_2_re,multiplier_2_im,stable,special,branch,jump_order,bracket_low,bracket_high,special_residual,stability,\
         graze_class",
    );
    let points = branches.iter().zip(1..).flat_map(|(branch, index)| branch.points.iter().map(move |p| (index, p)));
    for (index, point) in points {
        let (rpm, value, orbit, special) = (point.rpm, point.value, &point.orbit, point.special);
        let (turns, stable, impacts) = (orbit.revolutions, orbit.is_stable(), orbit.impacts().count());
        let first = orbit.impacts().next().map(|first| (first.cam_angle, first.position, first.velocity_after));
        let (angle, position, velocity) = first.unwrap_or((0.0, orbit.state.position, orbit.state.velocity));
        let angle = units.angle(angle);
        let (order, class) = match special.map(|special| special.kind) {
            Some(SpecialKind::Corner { jump_order, .. }) => (Some(jump_order), None),
            Some(SpecialKind::Graze { first, .. }) => (None, first.map(|first| first.class)),
            _ => (None, None),
        };
        let (order, low) = (cell(order), cell(special.map(|special| special.bracket[0])));
        let (high, residual) = (cell(special.map(|special| special.bracket[1])), cell(special.map(|s| s.residual)));
        let (special, both) = (special.map_or("", |special| special.kind.name()), multipliers(orbit.multipliers()));
        let _ = write!(lines, "{rpm},{parameter},{value},{turns},{impacts},{angle},{position},{velocity},{both},");
        let (stability, class) = (orbit.judgement.stability, cell(class));
        let _ = writeln!(lines, "{stable},{special},{index},{order},{low},{high},{residual},{stability},{class}");
    }
    lines
}

/// Table of every event of every curve; columns for corner impacts only are empty for other events.
pub(crate) fn curves(parameter: &str, curves: &[EventCurve], units: &Units) -> String {
    let mut lines = units.columns(
        "rpm,parameter,value,revolutions,impacts,cam_angle_rad,jump_order,scenario,multiplier_minus_1_re,\
         multiplier_minus_1_im,multiplier_minus_2_re,multiplier_minus_2_im,multiplier_plus_1_re,multiplier_plus_1_im,\
         multiplier_plus_2_re,multiplier_plus_2_im,special,curve,event",
    );
    let points = curves.iter().zip(1..).flat_map(|(curve, index)| curve.points.iter().map(move |p| (curve, index, p)));
    for (curve, index, point) in points {
        let (rpm, value, angle, turns) = (point.rpm, point.value, units.angle(point.cam_angle), point.revolutions);
        let order = if let SpecialKind::Corner { jump_order, .. } = curve.kind { Some(jump_order) } else { None };
        let (count, order, happening) = (point.impacts, cell(order), cell(point.happening));
        let _ = write!(lines, "{rpm},{parameter},{value},{turns},{count},{angle},{order},{happening}");
        let each = |index: usize| point.multipliers.get(index).map(|value| [value.re, value.im]);
        let _ = (0..4).try_for_each(|index| {
            let [re, im] = [0, 1].map(|part| cell(each(index).map(|value| value[part])));
            write!(lines, ",{re},{im}")
        });
        let (special, event) = (cell(point.special.map(|special| special.kind.name())), cell(curve.kind.bifurcation()));
        let _ = writeln!(lines, ",{special},{index},{event}");
    }
    lines
}

/// Numbers of digits across and up that suffice to draw a figure again, however narrow its range.
const FIGURE_DIGITS: [usize; 2] = [12, 9];

/// Table of a figure's data: a row for each point of its lines and marks, and for each cell of its clouds with the number of points in it.
/// A region has a row for each rectangle, with the number of cells, and a band one for each x. Cells have one digit less, because there are
/// two thousand side by side.
pub(crate) fn figure(figure: &Figure) -> String {
    let mut rows = String::from("panel,series,kind,x,y,count,width,height,panel_number,series_number\n");
    let word = |text: &str| format!("\"{}\"", text.replace('"', "\"\""));
    for (panel_number, panel) in figure.panels.iter().enumerate() {
        for (series_number, series) in panel.series.iter().enumerate() {
            let x = panel.own_x.as_ref().unwrap_or(&figure.x);
            let across = [x, &panel.y].map(|axis| format!("{} ({})", axis.label, axis.unit).replace(" ()", ""));
            let heads = format!(
                "{},{}",
                word(&across.join(", ")),
                word(if series.label.is_empty() { &series.name } else { &series.label })
            );
            let tails = format!("{panel_number},{series_number}");
            let mut row = |kind: &str, [x, y]: [f64; 2], count: usize, [wide, high]: [f64; 2]| {
                let is_cell = kind == "cell";
                let [across, up] = FIGURE_DIGITS.map(|digits| digits - usize::from(is_cell));
                let [x, y, wide, high] =
                    [(x, across), (y, up), (wide, across), (high, up)].map(|(it, to)| shown(it, to));
                rows.push_str(&format!("{heads},{kind},{x},{y},{count},{wide},{high},{tails}\n"));
            };
            const NO_SIZE: [f64; 2] = [f64::NAN; 2];
            match &series.data {
                Data::Line { points, .. } | Data::Area { points, .. } | Data::Arrow { points, .. } => {
                    points.iter().for_each(|point| row("line", *point, 1, NO_SIZE));
                }
                Data::Band { edges } => edges.iter().for_each(|[x, low, high]| {
                    row("band", [*x, 0.5 * (low + high)], 1, [f64::NAN, high - low]);
                }),
                Data::Points { points, .. } => points.iter().for_each(|point| row("point", *point, 1, NO_SIZE)),
                Data::Density(cells) => {
                    cells.counted().for_each(|(at, count)| row("cell", at, usize::from(count), NO_SIZE));
                }
                Data::Region { cells, .. } => {
                    cells.rectangles().into_iter().for_each(|(at, size, count)| row("region", at, count, size));
                }
                Data::Words(_) => {}
            }
        }
    }
    rows
}

/// Value with its digits; empty at a break of a line.
fn shown(value: f64, digits: usize) -> String {
    if value.is_nan() { String::new() } else { Digits::Significant(digits).typed(value) }
}
