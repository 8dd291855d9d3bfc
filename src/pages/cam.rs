//! The cam as a document: its segments and its corners, as JSON and as a page of text.

use std::fmt::{self, Write};

use serde::Serialize;

use crate::cam::{Cam, Corner, Jet, Segment};
use crate::model::Model;
use crate::show::block::{Column, Table, Words};
use crate::show::digits::Digits;
use crate::show::page::{Page, WIDTH};

/// What `cam` shows; serializes to the document `corner-impact/cam/1`.
#[derive(Clone, Debug, Serialize)]
pub struct CamDocument {
    /// `corner-impact/cam/1`.
    pub schema: &'static str,
    /// Name of the model.
    pub model: String,
    /// Where its numbers come from.
    pub source: String,
    /// The law that `[cam]` names.
    pub law: &'static str,
    /// A range that holds every lift, lowest and highest.
    pub lift_m: [f64; 2],
    /// In order of angle.
    pub segments: Vec<SegmentEntry>,
    /// The highest order of a jump that is listed.
    pub highest_order: usize,
    /// In order of angle.
    pub corners: Vec<CornerEntry>,
}

/// A stretch of cam with one law.
#[derive(Clone, Debug, Serialize)]
pub struct SegmentEntry {
    /// Where it starts.
    pub start_deg: f64,
    /// Where it ends.
    pub end_deg: f64,
    /// What kind of law it has.
    pub law: &'static str,
    /// A range that holds its lift.
    pub lift_m: [f64; 2],
}

/// A point where a derivative of the lift jumps.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct CornerEntry {
    /// Where.
    pub cam_angle_rad: f64,
    /// The same in degrees.
    pub angle_deg: f64,
    /// The lowest derivative that jumps.
    pub jump_order: usize,
    /// What it jumps by, after less before, m/rad^order.
    pub jump: f64,
    /// c.
    pub lift_m: f64,
    /// c' before it, m/rad.
    pub slope_before: f64,
    /// c' after it, m/rad.
    pub slope_after: f64,
    /// c'' before it, m/rad^2.
    pub curvature_before: f64,
    /// c'' after it, m/rad^2.
    pub curvature_after: f64,
}

impl From<&Segment> for SegmentEntry {
    fn from(segment: &Segment) -> Self {
        Self {
            start_deg: segment.start.to_degrees(),
            end_deg: segment.end.to_degrees(),
            law: segment.law.name(),
            lift_m: segment.bounds.lift,
        }
    }
}

impl From<Corner> for CornerEntry {
    fn from(corner: Corner) -> Self {
        let Corner { angle, jump_order, jump, minus, plus, .. } = corner;
        Self {
            cam_angle_rad: angle,
            angle_deg: angle.to_degrees(),
            jump_order,
            jump,
            lift_m: plus.value,
            slope_before: minus.slope,
            slope_after: plus.slope,
            curvature_before: minus.curvature,
            curvature_after: plus.curvature,
        }
    }
}

impl CamDocument {
    /// Longest list that is printed line by line.
    const LONGEST: usize = 40;

    /// Lays out a model's cam, with corners up to an order.
    pub fn new(model: &Model, cam: &Cam, highest_order: usize) -> Self {
        let segments: Vec<SegmentEntry> = cam.segments().iter().map(SegmentEntry::from).collect();
        let lowest = segments.iter().fold(f64::INFINITY, |lowest, segment| lowest.min(segment.lift_m[0]));
        let highest_order = highest_order.min(Jet::HIGHEST_JUMP);
        let listed = cam.corners().into_iter().filter(|corner| corner.jump_order <= highest_order);
        Self {
            schema: "corner-impact/cam/1",
            model: model.name.clone(),
            source: model.source.clone(),
            law: model.cam.law(),
            lift_m: [lowest, cam.top()],
            segments,
            highest_order,
            corners: listed.map(CornerEntry::from).collect(),
        }
    }

    /// The page, as wide as where nothing says how wide, without marks.
    pub fn text(&self) -> Result<String, fmt::Error> {
        Ok(self.page(WIDTH)?.plain().to_owned())
    }

    /// The page for a terminal of `width` columns.
    pub fn page(&self, width: usize) -> Result<Page, fmt::Error> {
        let mut page = Page::new(width);
        page.title(&format!("Cam of {}", self.model))?;
        page.paragraph_at(2, &self.source)?;
        let [low, high] = self.lift_m.map(|lift| Digits::Significant(9).text(lift));
        writeln!(page, "\n  law \"{}\", lift from {low} to {high} m", self.law)?;
        self.write_segments(&mut page)?;
        self.write_corners(&mut page)?;
        Ok(page)
    }

    fn write_segments(&self, page: &mut Page) -> fmt::Result {
        page.heading(&format!("Segments ({})", self.segments.len()))?;
        if self.segments.len() > Self::LONGEST {
            let spans = self.segments.iter().map(|segment| segment.end_deg - segment.start_deg);
            let (least, most) =
                spans.fold((f64::INFINITY, 0.0), |(least, most): (f64, f64), span| (least.min(span), most.max(span)));
            let (least, most) = (Digits::Significant(6).text(least), Digits::Significant(6).text(most));
            return writeln!(page, "  spans from {least} to {most} degrees; --json lists them");
        }
        let columns = [
            Column::right("from deg", 12),
            Column::right("to deg", 12),
            Column::left("law", 2, 12),
            Column::right("lowest m", 16),
            Column::right("highest m", 16),
        ];
        let mut table = Table::new("Segments", columns);
        for segment in &self.segments {
            let [low, high] = segment.lift_m.map(|lift| Digits::Significant(9).text(lift));
            let SegmentEntry { start_deg, end_deg, law, .. } = segment;
            let [start, end] = [start_deg, end_deg].map(|angle| format!("{angle:.6}"));
            table.row([start, end, law.to_string(), low, high].map(Words::from));
        }
        page.table(&table)
    }

    fn write_corners(&self, page: &mut Page) -> fmt::Result {
        page.heading(&format!("Corners ({})", self.corners.len()))?;
        if self.corners.is_empty() {
            let words = "No derivative of the lift up to order";
            return writeln!(page, "  {words} {} jumps as far as can be told.", self.highest_order);
        }
        let words = "order: of the lowest derivative of the lift that jumps (1 velocity, 2 acceleration, 3 jerk); jump: of \
                     that derivative, after less before, m/rad^order; slopes in m/rad.";
        page.paragraph_at(2, words)?;
        writeln!(page)?;
        let of_order = |order: usize| self.corners.iter().filter(move |corner| corner.jump_order == order);
        let long: Vec<usize> =
            (1..=self.highest_order).filter(|order| of_order(*order).count() > Self::LONGEST).collect();
        let lines: Vec<_> = self.corners.iter().filter(|corner| !long.contains(&corner.jump_order)).collect();
        let columns = [
            Column::right("angle deg", 12),
            Column::right("order", 7),
            Column::right("jump", 16),
            Column::right("lift m", 16),
            Column::right("slope before", 16),
            Column::right("slope after", 16),
        ];
        let mut table = Table::new("Corners", columns);
        for corner in lines {
            let CornerEntry { angle_deg, jump_order, .. } = corner;
            let [jump, lift, before, after] = [corner.jump, corner.lift_m, corner.slope_before, corner.slope_after]
                .map(|number| Digits::Short.text(number));
            let row = [format!("{angle_deg:.6}"), jump_order.to_string(), jump, lift, before, after];
            table.row(row.map(Words::from));
        }
        if !table.rows.is_empty() {
            page.table(&table)?;
        }
        for order in long {
            let Some(largest) = of_order(order).max_by(|a, b| a.jump.abs().total_cmp(&b.jump.abs())) else { continue };
            let (count, jump) = (of_order(order).count(), Digits::Short.text(largest.jump));
            writeln!(page, "  {count} of order {order}, the largest jump {jump} at {:.6} deg", largest.angle_deg)?;
        }
        Ok(())
    }
}
