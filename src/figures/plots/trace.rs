//! The motion itself: follower and cam against time, and the gap against its velocity.

use std::f64::consts::TAU;

use crate::draw::{Axis, Colour, Data, Figure, Marker, Series, Stroke};
use crate::figures::plots::{panel, plain, zero};

/// The motion at one moment. Points stand in order of time; before and after an impact, one each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TracePoint {
    /// How far the cam has turned since the start, rad.
    pub turned_rad: f64,
    /// Time, s.
    pub time_s: f64,
    /// Follower position q, m.
    pub position_m: f64,
    /// Cam position c, m.
    pub cam_m: f64,
    /// Gap q - c, m.
    pub gap_m: f64,
    /// Gap velocity q' - c', m/s.
    pub gap_velocity_m_s: f64,
    /// Whether the follower rides on the cam.
    pub contact: bool,
}

/// An impact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpactPoint {
    /// How far the cam has turned since the start, rad.
    pub turned_rad: f64,
    /// Time, s.
    pub time_s: f64,
    /// Where it happens, m.
    pub position_m: f64,
}

/// What runs along the horizontal axis of a [`time_trace`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Against {
    /// Time, s.
    Time,
    /// Revolutions of the cam.
    Revolutions,
}

/// A stretch of motion.
#[derive(Clone, Copy, Debug)]
pub struct Trace<'a> {
    /// The figure's title.
    pub title: &'a str,
    /// The motion.
    pub points: &'a [TracePoint],
    /// Its impacts.
    pub impacts: &'a [ImpactPoint],
    /// The horizontal axis.
    pub against: Against,
    /// Whether a lower panel shows the gap.
    pub gap: bool,
}

/// Follower and cam against time or revolutions, with impacts and contact marked.
pub fn time_trace(trace: &Trace<'_>) -> Figure {
    let along = |turned: f64, time: f64| match trace.against {
        Against::Time => time,
        Against::Revolutions => turned / TAU,
    };
    let line = |value: fn(&TracePoint) -> f64| -> Vec<[f64; 2]> {
        trace.points.iter().map(|point| [along(point.turned_rad, point.time_s), value(point)]).collect()
    };
    let riding = |value: fn(&TracePoint) -> f64| -> Vec<[f64; 2]> {
        let point = |(point, at): (&TracePoint, [f64; 2])| if point.contact { at } else { [f64::NAN; 2] };
        trace.points.iter().zip(line(value)).map(point).collect()
    };
    let impacts = |height: fn(&ImpactPoint) -> f64| -> Vec<[f64; 2]> {
        trace.impacts.iter().map(|impact| [along(impact.turned_rad, impact.time_s), height(impact)]).collect()
    };
    let named = |label: &str, colour, data| Series { label: label.into(), colour, data };
    let (sticks, hits) = (trace.points.iter().any(|point| point.contact), !trace.impacts.is_empty());
    let marks =
        |series: &mut Vec<Series>, value: fn(&TracePoint) -> f64, height: fn(&ImpactPoint) -> f64, legend: bool| {
            let label = |name: &str| if legend { name.to_owned() } else { String::new() };
            if sticks {
                let data = Data::Line { points: riding(value), stroke: Stroke::Thick };
                series.push(named(&label("in contact"), Colour::Green, data));
            }
            if hits {
                let data = Data::Points { points: impacts(height), marker: Marker::Below };
                series.push(named(&label("impact"), Colour::Ink, data));
            }
        };
    let area = Data::Area { points: line(|point| point.cam_m), stroke: Stroke::Thin };
    let mut series = vec![named("cam c", Colour::Grey, area)];
    let follower = Data::Line { points: line(|point| point.position_m), stroke: Stroke::Solid };
    marks(&mut series, |point| point.position_m, |impact| impact.position_m, true);
    series.insert(1, named("follower q", Colour::Blue, follower));
    let mut panels = vec![panel(Axis::new("position", "m"), 0.34, series, Vec::new())];
    if trace.gap {
        let mut series = vec![plain(line(|point| point.gap_m), Colour::Blue, Stroke::Solid)];
        marks(&mut series, |point| point.gap_m, |_| 0.0, false);
        panels.push(panel(Axis::new("gap q − c", "m"), 0.2, series, vec![zero()]));
    }
    let x = match trace.against {
        Against::Time => Axis::new("time t", "s"),
        Against::Revolutions => Axis::new("revolutions of the cam", ""),
    };
    let finite = || trace.points.iter().map(|point| along(point.turned_rad, point.time_s)).filter(|x| x.is_finite());
    let ends = [finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max)];
    Figure { title: trace.title.into(), x: x.over(ends), marks: Vec::new(), panels, note: String::new() }
}

/// The gap against its velocity.
pub fn phase_plane(title: &str, points: &[TracePoint]) -> Figure {
    let points = points.iter().map(|point| [point.gap_m, point.gap_velocity_m_s]).collect();
    let line = plain(points, Colour::Blue, Stroke::Thin);
    Figure {
        title: title.into(),
        x: Axis::new("gap q − c", "m"),
        marks: vec![zero()],
        panels: vec![panel(Axis::new("gap velocity q' − c'", "m/s"), 0.6, vec![line], vec![zero()])],
        note: String::new(),
    }
}
