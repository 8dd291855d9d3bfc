//! Is a cam said to be made of what its user has made it of?

use std::f64::consts::TAU;

use corner_impact::model::Model;
use corner_impact::study::cam::CamSheet;
use corner_impact_cli::show::Paged;
use serde_json::json;

use crate::common;

fn sheet(model: &Model) -> CamSheet {
    CamSheet::new(model, &common::cam(model), 3).unwrap()
}

/// Seven arcs from the middle of the base circle on. Where their corners are rounded each arc is cut in pieces, which are no arcs of the drawing.
#[test]
fn arcs_are_named_as_they_are_drawn_and_what_rounding_leaves_by_its_law() {
    let paper = common::osorio();
    let drawn = ["base circle", "flank", "nose", "top dwell", "nose", "flank", "base circle"];
    assert_eq!(sheet(&paper).motions, drawn);
    let rounded = sheet(&paper.with_number("cam.corner_rounding_deg", 1.0).unwrap());
    let laws: Vec<&str> = rounded.segments.iter().map(|segment| segment.law.name()).collect();
    assert!(laws.len() > drawn.len() && rounded.motions == laws, "{:?}", rounded.motions);
}

/// The polynomials of a spline through the rows are listed in the details. Those of one near the rows are no part of what was measured: how many
/// there are is enough.
#[test]
fn polynomials_are_listed_where_they_are_the_cam_that_is_meant() {
    let lift = |angle: f64| (1e5 * (0.02 + 0.01 * (angle.to_radians()).cos())).round() / 1e5;
    let rows: Vec<(f64, f64)> = (0..72).map(|row| 5.0 * f64::from(row)).map(|angle| (angle, lift(angle))).collect();
    for (spline, lists) in [("cubic", true), ("smoothing", false)] {
        let follower =
            json!({ "mass": 1, "damping": 0, "stiffness": 0, "gravity": 9.81, "rest_position": 0, "restitution": 0.5 });
        let cam = json!({ "law": "table", "spline": spline, "rows": rows });
        let sheet = sheet(&Model::of_document("cam", &json!({ "follower": follower, "cam": cam })).unwrap());
        assert!(sheet.segments.len() >= rows.len() && sheet.segments.last().unwrap().end == TAU);
        assert_eq!(format!("{:?}", sheet.blocks()).contains("Segments of the cam"), lists, "{spline}");
        let told = sheet.text().unwrap();
        assert!(told.contains("deg long; --json lists them"), "{told}");
    }
}
