//! Is the lift of a flat face, a roller and a point that of the contour, and does the page say which follower it is of?

use std::f64::consts::{PI, TAU};

use approx::{assert_abs_diff_eq, assert_relative_eq};
use corner_impact::cam::{Cam, OffsetArc, Outline};
use corner_impact::model::Model;
use corner_impact::study::cam::{CamGeometry, CamSheet};
use corner_impact::study::design::contact::{Contact, Separation};
use serde_json::json;

use crate::common::{self, corner_impact, text};

/// Three circles of textbooks: base 30 mm, nose 5 mm, no dwell at the top.
const TEXTBOOK: &str = "base_radius = 30.0\nflank_radius = 82.422115269221\nnose_radius = 5.0\nflank_start_deg = 105.0\nnose_end_deg = 180.0\n";
/// The paper's circles.
const PAPER: &str =
    "base_radius = 0.4\nflank_radius = 0.85\nnose_radius = 0.15\nflank_start_deg = 90.0\nnose_end_deg = 160.0\n";

fn read(units: &str, circles: &str, contact: &str) -> Result<Model, String> {
    let text = format!(
        "[units]\n{units}\n[follower]\nmass = 0.5\ndamping = 0.0\nstiffness = 10.0\npreload = 100.0\ngravity = 0.0\n\
         restitution = 0.5\n[cam]\nlaw = \"arcs\"\n{circles}{contact}\n"
    );
    let model = Model::parse("follower.toml", &text).map_err(|error| error.to_string())?;
    Cam::new(&model).map_err(|error| error.to_string()).map(|_| model)
}

fn textbook(contact: &str) -> Model {
    read("length = \"mm\"\nstiffness = \"N/mm\"", TEXTBOOK, contact).unwrap()
}

fn paper(contact: &str) -> Model {
    read("", PAPER, contact).unwrap()
}

const ROLLERS: [&str; 4] = [
    "contact = { roller_radius = 0.2 }",
    "contact = { roller_radius = 0.1, offset = 0.05 }",
    "contact = { roller_radius = 0.3, offset = -0.1 }",
    "contact = { roller_radius = 0.01, offset = 0.2 }",
];

#[test]
#[ignore = "slow"]
fn lifts_are_those_of_points_of_the_contour() {
    let contacts = ["", "contact = \"point\"", "contact = \"flat\""].into_iter().chain(ROLLERS);
    let models: Vec<Model> = contacts.map(paper).collect();
    let angles: Vec<f64> = (0..37).map(|index| (f64::from(index) + 0.31) * TAU / 37.0).collect();
    let cams: Vec<_> = models.iter().map(|model| json!(model.cam)).collect();
    let answer = common::python(&["tests/it/envelope.py"], &json!({ "cams": cams, "angles": angles }));
    let found: Vec<Vec<f64>> =
        serde_json::from_slice(&answer.stdout).unwrap_or_else(|_| panic!("{}", text(answer.stderr)));
    for (model, found) in models.iter().zip(found) {
        let cam = common::cam(model);
        for (angle, found) in angles.iter().zip(found) {
            // Points less than a ten thousandth of a radian apart.
            assert_abs_diff_eq!(cam.lift(*angle).value, found, epsilon = 1e-9);
        }
    }
}

/// Whatever follows it, the outline is the contour: a point follower is lifted there to its radius.
#[test]
fn the_outline_is_the_contour_under_each_follower() {
    let point = common::cam(&paper(""));
    let rollers = [[0.2, 0.0], [0.1, 0.05], [0.3, -0.1], [0.01, 0.2]].map(Some);
    let contacts = ["", "contact = \"point\"", "contact = \"flat\""].map(|contact| (contact, None));
    for (contact, roller) in contacts.into_iter().chain(ROLLERS.into_iter().zip(rollers)) {
        let model = paper(contact);
        let cam = common::cam(&model);
        let (outline, first) = (Outline::of(&model, &cam), cam.lift(0.0).value);
        assert_eq!((outline.added, outline.pieces.len()), (0.0, cam.segments().len()));
        for (piece, segment) in outline.pieces.iter().zip(cam.segments()) {
            let span = segment.end - segment.start;
            // Four points a degree.
            let steps = (span / TAU * 1440.0).ceil().max(2.0);
            assert_eq!(piece.points.len(), steps as usize + 1);
            for (step, [x, y]) in piece.points.iter().enumerate() {
                let polar = x.atan2(*y).rem_euclid(TAU);
                assert_abs_diff_eq!(x.hypot(*y), point.lift(polar).value, epsilon = 1e-12);
                if !contact.contains(['f', '{']) {
                    let turned = polar - segment.start - span * step as f64 / steps;
                    assert_abs_diff_eq!((turned + PI).rem_euclid(TAU) - PI, 0.0, epsilon = 1e-12);
                }
            }
        }
        let circles: Vec<_> = outline.pieces.iter().filter_map(|piece| Some((piece, piece.centre?))).collect();
        assert!(circles.len() >= 3 || contact.contains(['f', '{']), "flanks and nose: {}", circles.len());
        for (piece, [x, y]) in circles {
            let radii: Vec<f64> = piece.points.iter().map(|[u, v]| (u - x).hypot(v - y)).collect();
            assert!(radii.iter().all(|radius| (radius - radii[0]).abs() < 1e-12), "{contact}");
        }
        let points: Vec<[f64; 2]> = outline.pieces.iter().flat_map(|piece| piece.points.clone()).collect();
        for (angle, place) in &outline.corners {
            let begins = cam.segments().iter().position(|segment| segment.start == *angle).unwrap();
            assert_eq!(outline.pieces[begins].points[0], *place, "{contact}");
        }
        match roller {
            Some([radius, offset]) => {
                for (part, at) in [(0, [0.0, radius]), (18, [radius, 0.0]), (36, [0.0, -radius]), (72, [0.0, radius])] {
                    assert_abs_diff_eq!(outline.follower[part][0], offset + at[0], epsilon = 1e-15);
                    assert_abs_diff_eq!(outline.follower[part][1], first + at[1], epsilon = 1e-15);
                }
                assert_eq!((outline.follower.len(), outline.pitch.len()), (73, points.len()));
                for ([x, y], [u, v]) in outline.pitch.iter().zip(&points) {
                    assert_abs_diff_eq!((x - u).hypot(y - v), radius, epsilon = 1e-12);
                }
            }
            None if contact.contains("flat") => {
                let [[left, low], [right, high]] = outline.follower[..] else { panic!("{:?}", outline.follower) };
                assert_eq!((low, high), (first, first));
                // The face touches the cam as far from the axis as the lift is steep.
                let slopes: Vec<f64> = (0..3600).map(|tenth| cam.lift(f64::from(tenth) / 3600.0 * TAU).slope).collect();
                assert_abs_diff_eq!(left, slopes.iter().copied().fold(0.0, f64::min), epsilon = 1e-3);
                assert_abs_diff_eq!(right, slopes.iter().copied().fold(0.0, f64::max), epsilon = 1e-3);
            }
            None => assert!(outline.follower.is_empty() && outline.pitch.is_empty()),
        }
        let all = points.iter().chain(&outline.follower).chain(&outline.pitch);
        let farthest = all.fold(0.0_f64, |far, [x, y]| far.max(x.hypot(*y)));
        assert_relative_eq!(outline.farthest(), farthest, max_relative = 1e-15);
    }
    // A lift that is no radius gets one: twice the stroke at the lowest point.
    let wave = "[follower]\nmass = 1\ndamping = 0\nstiffness = 100\ngravity = 0\nrest_position = 1\nrestitution = 0.5\n[cam]\n\
                law = \"harmonic\"\noffset = 0.0\namplitudes = [0.01]\nphases_deg = [0.0]\n";
    let wave = Model::parse("wave.toml", wave).unwrap();
    let outline = Outline::of(&wave, &common::cam(&wave));
    assert_abs_diff_eq!(outline.added, 0.05, epsilon = 1e-12);
    assert!(outline.pieces.iter().all(|piece| piece.centre.is_none()));
    for [x, y] in outline.pieces.iter().flat_map(|piece| &piece.points) {
        assert_abs_diff_eq!(x.hypot(*y), 0.05 + 0.01 * x.atan2(*y).cos(), epsilon = 1e-12);
    }
}

/// Under a flat face the radius of curvature is `c + c''`: where circles meet c'' jumps by the difference of their radii, at the angle of their
/// common normal. Of a roller the common normal is where its centre is; with an offset it comes earlier by `asin(e/R)`.
#[test]
fn corners_are_where_the_circles_have_their_common_normal() {
    let corners = |contact: &str| common::cam(&paper(contact)).corners().to_vec();
    let [base, flank, nose] = [0.4_f64, 0.85, 0.15];
    let centres = |turn: f64| {
        let span = 70.0_f64.to_radians();
        // O2 on the ray at Q from O1 behind the axis, in axes with R at 0.
        let ahead =
            ((flank - nose).powi(2) - ((flank - base) * span.sin()).powi(2)).sqrt() - (flank - base) * span.cos();
        let (x, y) = (ahead * span.cos() + flank - base, ahead * span.sin());
        (y.atan2(x) + turn, ahead + nose)
    };
    let (normal, top) = centres(0.5 * PI);
    let flat = corners("contact = \"flat\"");
    let [start, end] = [90.0_f64, 160.0].map(f64::to_radians);
    let expected = [
        (start, flank - base),
        (normal, nose - flank),
        (end, top - nose),
        (TAU - end, nose - top),
        (TAU - normal, flank - nose),
        (TAU - start, base - flank),
    ];
    assert_eq!(flat.len(), 6);
    for (corner, (angle, jump)) in flat.iter().zip(expected) {
        assert_eq!(corner.jump_order, 2);
        assert_relative_eq!(corner.angle, angle, max_relative = 1e-12);
        assert_relative_eq!(corner.jump, jump, max_relative = 1e-9);
    }
    for (radius, offset) in [(0.2, 0.0), (0.1, 0.05), (0.3, -0.1)] {
        let found = corners(&format!("contact = {{ roller_radius = {radius:?}, offset = {offset:?} }}"));
        // The centre of the roller over the point of contact, from the axis.
        let at = |angle: f64, distance: f64| {
            let centre = distance + radius;
            angle - f64::asin(offset / centre)
        };
        let ray = |angle: f64| [angle.cos(), angle.sin()];
        let [one, two] =
            [(base - flank, start), (flank + radius, normal)].map(|(size, angle)| ray(angle).map(|it| it * size));
        let pitch = [one[0] + two[0], one[1] + two[1]];
        let meets = pitch[1].atan2(pitch[0]);
        let early = f64::asin(offset / f64::hypot(pitch[0], pitch[1]));
        let expected = [
            at(start, base),
            meets - early,
            at(end, top),
            at(TAU - end, top),
            TAU - meets - early,
            at(TAU - start, base),
        ];
        assert_eq!(found.len(), 6, "{radius} {offset}");
        for (corner, angle) in found.iter().zip(expected) {
            assert_relative_eq!(corner.angle, angle, max_relative = 1e-12);
            assert_eq!(corner.jump_order, 2, "{radius} {offset}");
        }
    }
}

/// Where the line passes the circle no bound holds.
#[test]
fn a_line_that_misses_the_circle_has_no_bound() {
    let arc = OffsetArc { distance: 0.5, direction: 0.0, radius: 0.3, offset: 0.1 };
    assert!(arc.third_bound(-0.1, 0.1).is_finite() && arc.fourth_bound(-0.1, 0.1).is_finite());
    assert_eq!([arc.third_bound(0.0, PI), arc.fourth_bound(0.0, PI)], [f64::INFINITY; 2]);
}

/// An offset may bring the flank before angle 0, or the last dwell there.
#[test]
fn an_offset_may_turn_a_circle_past_angle_0() {
    let circles =
        "base_radius = 0.4\nflank_radius = 0.5\nnose_radius = 0.3\nflank_start_deg = 2.0\nnose_end_deg = 170.0\n";
    for offset in [0.1, -0.1] {
        let with = |offset: f64| {
            let contact = format!("contact = {{ roller_radius = 0.2, offset = {offset:?} }}");
            common::cam(&read("", circles, &contact).unwrap())
        };
        let (cam, straight) = (with(offset), with(0.0));
        assert_eq!(cam.corners().len(), straight.corners().len());
        for corner in cam.corners() {
            let [before, after] = [corner.minus.value, corner.plus.value];
            assert_abs_diff_eq!(before, after, epsilon = 1e-15);
        }
        for index in 0..1000 {
            let lift = cam.lift(TAU * f64::from(index) / 1000.0).value;
            assert!((0.55..0.8).contains(&lift), "{offset} {index}: {lift}");
        }
    }
}

/// A flank that starts at angle 0 ends on the way down at the end of the turn: there is no base circle.
#[test]
fn a_flank_may_start_at_angle_0() {
    let with = |start: f64| {
        let circles = "base_radius = 0.4\nflank_radius = 0.5\nnose_radius = 0.3\nnose_end_deg = 170.0\n";
        common::cam(&read("", &format!("{circles}flank_start_deg = {start:?}\n"), "").unwrap())
    };
    let (cam, near) = (with(0.0), with(1e-9));
    for index in 0..1000 {
        let angle = TAU * f64::from(index) / 1000.0;
        assert_abs_diff_eq!(cam.lift(angle).value, near.lift(angle).value, epsilon = 1e-9);
    }
    assert_eq!(cam.segments().len() + 2, near.segments().len());
}

#[test]
fn a_flat_face_separates_four_times_as_fast_as_a_point() {
    // Of the flat face where the nose begins, at `c = rho + kappa cos(phi)`: `m w^2 (c - rho) = F + k (c - c_min)`.
    for (contact, expected) in [("", 251.28), ("contact = \"flat\"", 1_010.024_321)] {
        let model = textbook(contact);
        let Separation::At { rpm, .. } = Contact::new(&common::cam(&model), model.follower).separation() else {
            panic!("{contact}")
        };
        assert_abs_diff_eq!(rpm, expected, epsilon = if contact.is_empty() { 0.005 } else { 1e-6 });
    }
}

/// The contour is the same whatever touches it: its least radius of curvature is that of the nose, and a face is touched where the follower is fast.
#[test]
fn the_geometry_is_that_of_the_circles() {
    let geometry = |model: &Model| CamGeometry::of(model, &common::cam(model)).unwrap();
    for contact in ["", "contact = \"flat\""].into_iter().chain(ROLLERS) {
        let model = paper(contact);
        let found = geometry(&model);
        assert_relative_eq!(found.least_radius_m, 0.15, max_relative = 1e-9);
        let contour: Vec<_> = common::cam(&model).contour(found.contact).collect();
        let farthest = contour.iter().map(|point| point.place[0].hypot(point.place[1])).fold(0.0, f64::max);
        let nearest = contour.iter().map(|point| point.place[0].hypot(point.place[1])).fold(1.0, f64::min);
        assert_relative_eq!(nearest, 0.4, max_relative = 1e-12);
        assert_relative_eq!(farthest, 0.15 + 0.404_081, max_relative = 1e-3);
        assert_eq!(found.face_width_m.is_some(), contact.contains("flat"), "{contact}");
    }
    // Rounded over a degree, with the lift kept, the way into the nose is hollow.
    let rounded = |contact: &str| geometry(&textbook(&format!("corner_rounding_deg = 1.0\n{contact}"))).is_touchable;
    assert!(rounded("") && !rounded("contact = \"flat\"") && rounded("contact = { roller_radius = 8.0 }"));
    assert!(geometry(&textbook("contact = \"flat\"")).is_touchable);
    // tan(alpha) = c'/c of a point; sin(alpha) = e/R on the base circle of an offset roller.
    let point = geometry(&paper(""));
    let lift = common::cam(&paper("")).lift(point.pressure_angle_at_rad);
    assert_relative_eq!(point.pressure_angle_rad.tan(), (lift.slope / lift.value).abs(), max_relative = 1e-12);
    let cam = common::cam(&paper(ROLLERS[1]));
    let contact = geometry(&paper(ROLLERS[1])).contact;
    assert_relative_eq!(contact.touches(0.0, &cam.lift(0.0)).pressure_angle.sin(), -0.05 / 0.5, max_relative = 1e-12);
    // From the fastest way up to the fastest way down, which are as fast.
    let flat = paper("contact = \"flat\"");
    let cam = common::cam(&flat);
    let fastest = (0..100_000).map(|index| cam.lift(TAU * f64::from(index) / 1e5).slope);
    assert_relative_eq!(geometry(&flat).face_width_m.unwrap(), 2.0 * fastest.fold(0.0, f64::max), max_relative = 1e-4);
    // A lift without a contour has none.
    let harmonic = common::read(&std::path::Path::new(common::ROOT).join("models/laws/harmonic.toml"));
    assert!(CamGeometry::of(&harmonic, &common::cam(&harmonic)).is_none());
}

#[test]
fn a_lever_multiplies_every_lift() {
    for file in common::model_files() {
        let model = common::read(&file);
        let plain = common::cam(&model);
        let cam = common::cam(&model.with_number("cam.lever_ratio", 1.7).unwrap());
        assert_eq!(cam.corners().len(), plain.corners().len(), "{}", file.display());
        for (one, other) in cam.corners().iter().zip(plain.corners()) {
            assert_eq!((one.angle, one.jump_order), (other.angle, other.jump_order));
            assert_relative_eq!(one.jump, 1.7 * other.jump, max_relative = 1e-9);
        }
        for angle in (0..97).map(|index| TAU * f64::from(index) / 97.0) {
            let (one, other) = (cam.lift(angle), plain.lift(angle));
            let pairs = [
                (one.value, other.value),
                (one.slope, other.slope),
                (one.curvature, other.curvature),
                (one.third, other.third),
            ];
            for (one, other) in pairs {
                assert_abs_diff_eq!(one, 1.7 * other, epsilon = 1e-12 * (1.0 + other.abs()));
            }
        }
    }
}

/// A mass at the valve is R² times as heavy at the tappet, with R² times the stiffness and R times the preload.
#[test]
fn a_lever_is_a_reduced_mass() {
    let speed = |model: &Model| Contact::new(&common::cam(model), model.follower).separation().speed();
    for contact in ["", "contact = \"flat\"", "contact = { roller_radius = 10.0, offset = 2.0 }"] {
        let model = textbook(contact);
        let at_valve = speed(&model.with_number("cam.lever_ratio", 1.6).unwrap());
        let numbers = [("mass", 0.5 * 2.56), ("stiffness", 10.0 * 2.56), ("preload", 100.0 * 1.6)];
        let at_tappet = speed(&model.changed(&numbers.map(|(name, number)| (name.into(), number))).unwrap());
        assert_relative_eq!(at_valve, at_tappet, max_relative = 1e-12);
        assert!((at_valve / speed(&model) - 1.0).abs() > 0.01);
    }
}

/// The lengths of the cam stay those of the cam, and its page names the lever.
#[test]
fn a_lever_leaves_the_geometry_of_the_cam() {
    let ratio = 1.5;
    for contact in ["", "contact = \"flat\"", ROLLERS[1]] {
        let model = paper(contact);
        let levered = model.with_number("cam.lever_ratio", ratio).unwrap();
        let [one, other] = [&model, &levered].map(|model| CamGeometry::of(model, &common::cam(model)).unwrap());
        assert_relative_eq!(one.least_radius_m, other.least_radius_m, max_relative = 1e-9);
        assert_relative_eq!(one.pressure_angle_rad, other.pressure_angle_rad, max_relative = 1e-9);
        assert_eq!(one.is_steep, other.is_steep);
        let [one, other] = [one, other].map(|it| it.face_width_m.unwrap_or_default());
        assert_abs_diff_eq!(one, other, epsilon = 1e-12);
    }
    let folder = tempfile::TempDir::new().unwrap();
    let file = folder.path().join("lever.toml");
    std::fs::write(&file, toml(&paper("")) + "lever_ratio = 1.5\n").unwrap();
    let path = file.to_str().unwrap();
    for command in [&["cam", path][..], &["design", path, "--rpm", "100"]] {
        let page = text(corner_impact(command).stdout).split_whitespace().collect::<Vec<_>>().join(" ");
        let says = "least radius of curvature of the cam 0.15 m; a lever of ratio 1.5 moves the follower: lifts and forces are those at the \
                    follower, and the cam presses 1.5 times as hard";
        assert!(page.contains(says), "{page}");
    }
    let document = text(corner_impact(["design", path, "--rpm", "100", "--json"]).stdout);
    let document: serde_json::Value = serde_json::from_str(&document).unwrap();
    assert_eq!(document["lever_ratio"], json!(1.5));
    assert_relative_eq!(document["geometry"]["least_radius_m"].as_f64().unwrap(), 0.15, max_relative = 1e-9);
    assert_eq!(document["geometry"]["is_steep"], json!(false));
}

#[test]
fn a_lever_that_is_none_is_refused() {
    for ratio in ["0.0", "-1.5", "nan", "\"long\""] {
        let refused = read("", PAPER, &format!("lever_ratio = {ratio}")).unwrap_err();
        assert!(refused.contains(&format!("cam.lever_ratio = {ratio}: must be a finite number above 0")), "{refused}");
    }
}

#[test]
fn what_no_follower_is_is_refused() {
    for (contact, says) in [
        ("contact = \"knife\"", "cam.contact = \"knife\": must be a name or a roller"),
        ("contact = 3", "cam.contact = 3: must be a name or a roller"),
        ("contact = { offset = 0.1 }", "cam.contact.roller_radius is missing"),
        ("contact = { roller_radius = 0.0 }", "cam.contact.roller_radius = 0.0: must be a finite number above 0"),
        ("contact = { roller_radius = -1.0 }", "cam.contact.roller_radius = -1.0: must be a finite number above 0"),
        ("contact = { roller_radius = nan }", "cam.contact.roller_radius = nan: must be a finite number above 0"),
        ("contact = { roller_radius = 0.6 }", "cam.contact.roller_radius = 0.6: must be at most 0.553"),
        ("contact = { roller_radius = 0.1, ofset = 0.1 }", "did you mean offset?"),
        ("contact = { roller_radius = 0.1, offset = 0.5 }", "cam.contact.offset = 0.5: must be between -0.5 and 0.5"),
        ("contact = { roller_radius = 0.1, offset = -0.5 }", "cam.contact.offset = -0.5: must be between"),
    ] {
        let refused = read("", PAPER, contact).unwrap_err();
        assert!(refused.contains(says), "{contact}: {refused}");
    }
}

#[test]
fn the_page_and_the_document_say_which_follower() {
    let folder = tempfile::TempDir::new().unwrap();
    let page = |model: &Model, says: &[&str]| {
        let sheet = CamSheet::new(model, &common::cam(model), 2).unwrap();
        assert_eq!(
            json!(sheet)["geometry"]["contact"],
            json!(model.cam).get("contact").cloned().unwrap_or("point".into())
        );
        let file = folder.path().join("model.toml");
        std::fs::write(&file, toml(model)).unwrap();
        let page = text(corner_impact(["cam", file.to_str().unwrap()]).stdout).replace('\n', " ");
        let page = page.split_whitespace().collect::<Vec<_>>().join(" ");
        says.iter().for_each(|says| assert!(page.contains(says), "{says}: {page}"));
    };
    page(
        &paper(""),
        &[
            "follower: a point on a line through the cam's axis; largest pressure angle 27.3 deg",
            "radius of curvature of the cam 0.15 m",
        ],
    );
    page(
        &paper("contact = \"flat\""),
        &["a flat face square to its motion; the cam touches 0.488022 m", "of the face"],
    );
    page(&paper(ROLLERS[1]), &["a roller of radius 0.1 m, whose centre moves on a line 0.05 m beside the cam's axis"]);
    let harmonic = text(corner_impact(["cam", "models/laws/harmonic.toml"]).stdout);
    assert!(harmonic.contains("follower: the lift is that of the follower"), "{harmonic}");
}

/// The model as a file.
fn toml(model: &Model) -> String {
    let follower =
        "[follower]\nmass = 0.5\ndamping = 0.0\nstiffness = 10.0\npreload = 100.0\ngravity = 0.0\nrestitution = 0.5\n";
    let contact = match json!(model.cam)["contact"].clone() {
        serde_json::Value::Null => String::new(),
        serde_json::Value::String(name) => format!("contact = {name:?}\n"),
        roller => {
            format!("contact = {{ roller_radius = {}, offset = {} }}\n", roller["roller_radius"], roller["offset"])
        }
    };
    format!("{follower}[cam]\nlaw = \"arcs\"\n{PAPER}{contact}")
}
