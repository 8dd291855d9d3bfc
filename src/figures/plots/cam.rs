//! The cam against its angle: lift and two derivatives, jumps left open.

use std::f64::consts::TAU;

use crate::cam::{Cam, Corner, Law, Lift};
use crate::draw::{Axis, Colour, Figure, Mark, Stroke};
use crate::figures::plots::{panel, plain, zero};

/// How many corners are labelled at most.
const LABELLED: usize = 12;
/// Samples of a revolution: four to a unit of the page.
const SAMPLES: usize = 2400;

/// A corner as figures show it.
#[derive(Clone, Debug, PartialEq)]
pub struct CornerMark {
    /// Cam angle, rad.
    pub angle_rad: f64,
    /// Its letter, where it has one.
    pub name: String,
}

impl CornerMark {
    /// The reference line: the angle in degrees, after the letter.
    pub(crate) fn mark(&self) -> Mark {
        let at = self.angle_rad.to_degrees();
        let angle = format!("{at:.1}°");
        Mark { at, label: if self.name.is_empty() { angle } else { format!("{} {angle}", self.name) } }
    }

    /// Its letter, or the angle in degrees where it has none.
    pub(crate) fn label(&self) -> String {
        if self.name.is_empty() { self.mark().label } else { self.name.clone() }
    }
}

/// The corners worth a label: a dozen at most, those of the lowest order first, then those of the largest jump, in order of
/// angle. Corners of a cam of three circles bear the letters of the paper's drawing, with an apostrophe on the way down.
pub fn corner_marks(cam: &Cam) -> Vec<CornerMark> {
    let corners = cam.corners();
    let letters: &[&str] = if of_circles(cam, &corners) { &["R", "P", "Q", "Q'", "P'", "R'"] } else { &[] };
    let mut order: Vec<usize> = (0..corners.len()).collect();
    let rank = |index: &usize| (corners[*index].jump_order, -corners[*index].jump.abs());
    order.sort_by(|one, other| {
        let ((order, size), (other_order, other_size)) = (rank(one), rank(other));
        order.cmp(&other_order).then(size.total_cmp(&other_size))
    });
    order.truncate(LABELLED);
    order.sort_unstable();
    let mark = |index: usize| CornerMark {
        angle_rad: corners[index].angle,
        name: letters.get(index).copied().unwrap_or_default().to_owned(),
    };
    order.into_iter().map(mark).collect()
}

fn derivative(lift: &Lift, order: usize) -> f64 {
    match order {
        0 => lift.value,
        1 => lift.slope,
        2 => lift.curvature,
        _ => lift.third,
    }
}

/// Whether the cam is base circle, flank, nose, top and the same back.
pub(crate) fn of_circles(cam: &Cam, corners: &[Corner]) -> bool {
    let dwells: Vec<bool> = cam.segments().iter().map(|segment| matches!(segment.law, Law::Dwell(_))).collect();
    let arcs = cam.segments().iter().all(|segment| matches!(segment.law, Law::Dwell(_) | Law::Arc(_)));
    arcs && corners.len() == 6 && dwells == [true, false, false, true, false, false, true]
}

/// Lift, velocity and acceleration of the cam against its angle in degrees, its corners marked.
pub fn cam_figure(cam: &Cam, title: &str) -> Figure {
    let corners = cam.corners();
    let marks = corner_marks(cam);
    let note = if marks.len() < corners.len() {
        format!(
            "{} of {} corners are marked: those of the lowest derivatives, then of the largest jumps.",
            marks.len(),
            corners.len()
        )
    } else {
        String::new()
    };
    let line = |order: usize| plain(samples(cam, &corners, order), Colour::Blue, Stroke::Solid);
    let panels = vec![
        panel(Axis::new("lift c", "m"), 0.21, vec![line(0)], vec![]),
        panel(Axis::new("velocity dc/dθ", "m/rad"), 0.21, vec![line(1)], vec![zero()]),
        panel(Axis::new("acceleration d²c/dθ²", "m/rad²"), 0.21, vec![line(2)], vec![zero()]),
    ];
    Figure {
        title: title.into(),
        x: Axis::degrees("cam angle θ").over([0.0, 360.0]),
        marks: marks.iter().map(CornerMark::mark).collect(),
        panels,
        note,
    }
}

/// One derivative against degrees, evenly sampled, with both sides of each corner where it jumps and a break between.
fn samples(cam: &Cam, corners: &[Corner], order: usize) -> Vec<[f64; 2]> {
    let Some(last) = cam.segments().last() else { return Vec::new() };
    let mut jumps = corners.iter().filter(|corner| corner.jump_order <= order && corner.angle > 0.0).peekable();
    let mut points = Vec::new();
    for sample in 0..SAMPLES {
        let angle = TAU * sample as f64 / SAMPLES as f64;
        while let Some(corner) = jumps.next_if(|corner| corner.angle <= angle) {
            let at = corner.angle.to_degrees();
            points.extend([[at, derivative(&corner.minus, order)], [f64::NAN; 2]]);
            points.push([at, derivative(&corner.plus, order)]);
        }
        points.push([angle.to_degrees(), derivative(&cam.lift(angle), order)]);
    }
    for corner in jumps {
        let at = corner.angle.to_degrees();
        points.extend([[at, derivative(&corner.minus, order)], [f64::NAN; 2]]);
        points.push([at, derivative(&corner.plus, order)]);
    }
    points.push([360.0, derivative(&last.law.lift(last.end), order)]);
    points
}
