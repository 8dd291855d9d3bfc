//! Is the lift on a measured contour that of its envelope, and is what the geometry forbids refused with its place?

use std::f64::consts::{PI, TAU};

use approx::{assert_abs_diff_eq, assert_relative_eq};
use corner_impact::cam::{Cam, Lift, apart};
use corner_impact::measured::PlausibleCams;
use corner_impact::model::{FollowerContact, Model};
use corner_impact::study::cam::CamGeometry;
use corner_impact::study::design::contact::Contact;
use corner_impact::study::design::{SeparationPlace, known, separation_places};
use corner_impact::uncertainty::PlausibleMachines;
use serde_json::json;
use tempfile::TempDir;

use crate::common::{self, corner_impact, text};

const FOLLOWER: &str = "[units]\nlength = \"mm\"\nstiffness = \"N/mm\"\n[follower]\nmass = 0.5\ndamping = 0.0\nstiffness = 2.0\npreload = 30.0\n\
                        gravity = 0.0\nrestitution = 0.5\n[cam]\nlaw = \"contour\"\n";
const FLAT: &str = "contact = \"flat\"";
const ROLLERS: [(f64, f64); 4] = [(5.0, 0.0), (5.0, 8.0), (12.0, -6.0), (2.0, 3.0)];

fn roller((radius, offset): (f64, f64)) -> String {
    format!("contact = {{ roller_radius = {radius:?}, offset = {offset:?} }}")
}

/// A model with a contour of rows, or the complaint; `fields` are further lines of `[cam]`.
fn read(csv: &str, fields: &str) -> Result<(Model, Cam), String> {
    let folder = TempDir::new().unwrap();
    std::fs::write(folder.path().join("contour.csv"), csv).unwrap();
    let file = folder.path().join("model.toml");
    std::fs::write(&file, format!("{FOLLOWER}file = \"contour.csv\"\n{fields}\n")).unwrap();
    let model = Model::read(&file).map_err(|error| error.to_string())?;
    let cam = Cam::new(&model).map_err(|error| error.to_string())?;
    Ok((model, cam))
}

fn cam(csv: &str, fields: &str) -> Cam {
    read(csv, fields).unwrap().1
}

/// Rows of polar angle and radius.
fn polar(count: u32, radius: impl Fn(f64) -> f64) -> String {
    let row = |index: u32| {
        let degrees = 360.0 * f64::from(index) / f64::from(count);
        format!("{degrees:?},{:?}\n", radius(degrees.to_radians()))
    };
    "angle [deg],radius [mm]\n".to_owned() + &(0..count).map(row).collect::<String>()
}

/// Rows of x and y.
fn points(count: u32, point: impl Fn(f64) -> [f64; 2]) -> String {
    let row = |index: u32| {
        let [x, y] = point(TAU * f64::from(index) / f64::from(count));
        format!("{x:?};{y:?}\n")
    };
    "x [mm];y [mm]\n".to_owned() + &(0..count).map(row).collect::<String>()
}

/// A circle of radius 20 whose centre is 6 from the axis.
fn eccentric(angle: f64) -> f64 {
    let [e, rho] = [6.0_f64, 20.0];
    e * angle.cos() + (rho * rho - (e * angle.sin()).powi(2)).sqrt()
}

fn close(found: &Lift, expected: [f64; 3], within: [f64; 3]) {
    assert_abs_diff_eq!(found.value, expected[0], epsilon = within[0]);
    assert_abs_diff_eq!(found.slope, expected[1], epsilon = within[1]);
    assert_abs_diff_eq!(found.curvature, expected[2], epsilon = within[2]);
}

/// Closed forms: `c = rho + e cos(theta)` under a face; of a roller the circle of its centre, met by a line at its offset.
#[test]
fn an_eccentric_circle_lifts_as_closed_forms_say() {
    let csv = polar(360, eccentric);
    let angles = (0..1000).map(|index| TAU * f64::from(index) / 1000.0);
    let (face, point) = (cam(&csv, &format!("spline = \"quintic\"\n{FLAT}")), cam(&csv, "spline = \"quintic\""));
    for angle in angles.clone() {
        let (sin, cos) = angle.sin_cos();
        close(&face.lift(angle), [20.0 + 6.0 * cos, -6.0 * sin, -6.0 * cos], [1e-10, 1e-7, 1e-5]);
        assert_abs_diff_eq!(point.lift(angle).value, eccentric(angle), epsilon = 1e-10);
    }
    for (radius, offset) in ROLLERS {
        let rolled = cam(&csv, &format!("spline = \"quintic\"\n{}", roller((radius, offset))));
        for angle in angles.clone() {
            let (sin, cos) = angle.sin_cos();
            let (s, p) = (6.0 * sin + offset, 6.0 * cos);
            let w = ((20.0 + radius).powi(2) - s * s).sqrt();
            let w1 = -s * p / w;
            let w2 = (6.0 * sin * s - p * p - w1 * w1) / w;
            close(&rolled.lift(angle), [p + w, w1 - 6.0 * sin, w2 - p], [1e-10, 1e-7, 1e-5]);
        }
    }
}

/// Pieces that meet with five derivatives; the same lift from polar rows, from points, and from either order of them.
#[test]
fn the_contour_may_be_written_in_every_way() {
    let place = |angle: f64| [eccentric(angle) * angle.cos(), eccentric(angle) * angle.sin()];
    let fields = format!("spline = \"quintic\"\n{}", roller((5.0, 8.0)));
    let expected = cam(&polar(180, eccentric), &fields);
    let whole = points(180, place);
    let shuffled = |turn: f64, sign: f64| points(180, |angle| place(sign * angle + turn));
    let first = whole.lines().nth(1).unwrap().to_owned();
    let swapped = whole.replace("x [mm];y [mm]", "y [mm];x [mm]");
    let swapped = swapped.lines().enumerate().map(|(index, line)| match (index, line.split_once(';')) {
        (1.., Some((x, y))) => format!("{y};{x}\n"),
        _ => format!("{line}\n"),
    });
    let inches = points(180, |angle| place(angle).map(|it| it / 25.4)).replace("[mm]", "[in]");
    let plain = polar(180, eccentric);
    let radians = plain.lines().enumerate().map(|(index, line)| match line.split_once(',') {
        Some((angle, radius)) if index > 0 => format!("{:?},{radius}\n", angle.parse::<f64>().unwrap().to_radians()),
        _ => "phi [rad],r [mm]\n".to_owned(),
    });
    let without_header = whole.lines().skip(1).collect::<Vec<_>>().join("\n");
    let cases = [
        (whole.clone(), ""),
        (whole.clone() + &first + "\n", ""),
        (shuffled(TAU / 3.0, 1.0), ""),
        (shuffled(TAU / 2.0, -1.0), ""),
        (shuffled(0.0, -1.0), ""),
        (swapped.collect(), ""),
        (inches, ""),
        (radians.collect(), ""),
        (without_header, "coordinates = \"xy\""),
        (whole.replace("x [mm];y [mm]", "u [mm];v [mm]"), "x_column = \"u\"\ny_column = 2"),
        (polar(180, eccentric).replace("radius", "lift"), "radius_column = \"lift\""),
    ];
    for (csv, more) in cases {
        let found = cam(&csv, &format!("{fields}\n{more}"));
        for angle in (0..97).map(|index| TAU * f64::from(index) / 97.0) {
            let (one, other) = (found.lift(angle), expected.lift(angle));
            close(&one, [other.value, other.slope, other.curvature], [1e-9, 1e-6, 1e-4]);
        }
    }
}

/// The circles of the paper, in mm, and their contour as rows.
const ARCS: &str =
    "base_radius = 40.0\nflank_radius = 85.0\nnose_radius = 15.0\nflank_start_deg = 90.0\nnose_end_deg = 160.0\n";

fn arcs(contact: &str) -> Cam {
    let text = FOLLOWER.replace("contour", "arcs") + ARCS + contact;
    Cam::new(&Model::parse("arcs.toml", &text).unwrap()).unwrap()
}

#[test]
fn three_arcs_as_a_table_lift_as_three_arcs() {
    let own = arcs("");
    let csv = polar(720, |angle| own.lift(angle).value);
    let corners: Vec<f64> = own.corners().iter().map(|corner| corner.angle.to_degrees()).collect();
    let dwells = [[-90.0, 90.0], [160.0, 200.0]];
    let spline = format!("spline = \"smoothing\"\ncorners_deg = {corners:?}\ndwells_deg = {dwells:?}\n");
    for contact in [FLAT.to_owned(), roller((10.0, 0.0)), roller((10.0, 5.0)), roller((30.0, -12.0))] {
        let (expected, found) = (arcs(&contact), cam(&csv, &(spline.clone() + &contact)));
        let own_corners: Vec<_> = found.corners().iter().filter(|corner| !found.is_knot(corner)).collect();
        assert_eq!(own_corners.len(), expected.corners().len(), "{contact}");
        for (one, other) in own_corners.iter().zip(expected.corners()) {
            // On the common normal, which the slope of the spline turns by a hundredth of a degree.
            assert_abs_diff_eq!(one.angle, other.angle, epsilon = 3e-4);
            assert_eq!(one.jump_order, 2);
            assert_relative_eq!(one.jump, other.jump, max_relative = 0.1);
        }
        for angle in (0..500).map(|index| TAU * (f64::from(index) + 0.5) / 500.0) {
            let (one, other) = (found.lift(angle), expected.lift(angle));
            assert_abs_diff_eq!(one.value, other.value, epsilon = 1e-4);
            assert_abs_diff_eq!(one.slope, other.slope, epsilon = 1e-2);
        }
    }
}

/// Rows of three arcs, as far apart as a gauge has them, show the corners of flank, nose and top, and no other; and the first separation of a face or
/// a roller is that of the arcs to its ±. Where the flank leaves the base circle the radius has too small a jump for a corner.
#[test]
#[ignore = "slow"]
fn three_arcs_are_found_in_their_rows() {
    let own = arcs("");
    let all = own.corners().iter().map(|corner| corner.angle.to_degrees());
    let corners: Vec<f64> = all.filter(|corner| (100.0..260.0).contains(corner)).collect();
    assert_eq!(corners.len(), 4);
    for count in [360, 720, 1440] {
        let csv = polar(count, |angle| (1e4 * own.lift(angle).value).round() / 1e4);
        for contact in [FLAT.to_owned(), roller((10.0, 0.0))] {
            let (model, found) = read(&csv, &format!("spline = \"smoothing\"\n{contact}")).unwrap();
            let likely = PlausibleCams::of(&model).unwrap().unwrap();
            let told = &likely.measured.corners_deg;
            let is_there = |one: &f64| told.iter().any(|other| (one - other).abs() < 1.0);
            assert!(corners.iter().all(is_there) && told.len() == corners.len(), "{count}: {told:?}, {corners:?}");
            let speed = |model: &Model, cam: &Cam| Contact::new(cam, model.follower).separation().speed();
            let (one, other) = (speed(&model, &found), speed(&model, &arcs(&contact)));
            let error = likely.errors(&[one], |model, cam| Some(vec![speed(model, cam)])).unwrap()[0];
            assert!(
                (one - other).abs() <= error && error < 0.06 * other,
                "{count} {contact}: {one} ± {error}, {other}"
            );
        }
    }
}

/// The spline's own envelope, by a search among half a million points of SciPy's spline through the same rows.
#[test]
#[ignore = "slow"]
fn lifts_are_those_of_points_of_the_spline() {
    let wavy = |angle: f64| 30.0 + 4.0 * angle.cos() + 0.7 * (2.0 * angle + 0.3).sin() + 0.1 * (3.0 * angle).cos();
    let contacts = [FLAT.to_owned()].into_iter().chain(ROLLERS.map(roller));
    let models: Vec<(Model, Cam)> =
        contacts.map(|contact| read(&polar(60, wavy), &format!("spline = \"cubic\"\n{contact}")).unwrap()).collect();
    let angles: Vec<f64> = (0..23).map(|index| (f64::from(index) + 0.31) * TAU / 23.0).collect();
    let cams: Vec<_> = models.iter().map(|(model, _)| json!(model.cam)).collect();
    let answer = common::python(&["tests/it/envelope.py"], &json!({ "cams": cams, "angles": angles }));
    let found: Vec<Vec<f64>> =
        serde_json::from_slice(&answer.stdout).unwrap_or_else(|_| panic!("{}", text(answer.stderr)));
    for ((_, cam), found) in models.iter().zip(found) {
        for (angle, found) in angles.iter().zip(found) {
            assert_abs_diff_eq!(cam.lift(*angle).value, found, epsilon = 1e-8);
        }
    }
}

/// A motion from rest to rest on a base circle of 30 mm, for a roller of 5 mm with an offset of 20 mm, and the contour that gives it: `contact`
/// takes the contour from the lift, where the law takes the lift from the contour.
fn designed() -> (Model, Cam, String) {
    let base = (32.0_f64.powi(2) - 20.0 * 20.0).sqrt();
    let motions = "[[cam.segment]]\nmotion = \"poly4567\"\nspan_deg = 130\nrise = 12\n[[cam.segment]]\nmotion = \"poly4567\"\nspan_deg = 130\n\
                   rise = -12\n[[cam.segment]]\nmotion = \"dwell\"\nspan_deg = 100\n";
    let text = FOLLOWER.replace("contour", "program") + &format!("base = {base:?}\n{motions}");
    let model = Model::parse("designed.toml", &text).unwrap();
    let cam = Cam::new(&model).unwrap();
    let contact = FollowerContact::Roller { roller_radius: 5.0, offset: 20.0 };
    let row = |index: u32| {
        let angle = TAU * f64::from(index) / 1200.0;
        let [along, left] = contact.touches(angle, &cam.lift(angle)).place;
        let polar = (angle + left.atan2(along)).to_degrees();
        format!("{:.5},{:.5}\n", polar, along.hypot(left))
    };
    let csv = "angle [deg],radius [mm]\n".to_owned() + &(0..1200).map(row).collect::<String>();
    (model, cam, csv)
}

#[test]
fn the_contour_of_an_offset_roller_gives_its_motion_back() {
    let (model, cam, csv) = designed();
    let (contour, found) = read(&csv, &format!("spline = \"smoothing\"\n{}", roller((5.0, 20.0)))).unwrap();
    for angle in (0..720).map(|index| TAU * f64::from(index) / 720.0) {
        assert_abs_diff_eq!(found.lift(angle).value, cam.lift(angle).value, epsilon = 3e-5);
        assert_abs_diff_eq!(found.lift(angle).curvature, cam.lift(angle).curvature, epsilon = 0.3);
    }
    let speed = |model: &Model, cam: &Cam| Contact::new(cam, model.follower).separation().speed();
    let (expected, own) = (speed(&model, &cam), speed(&contour, &found));
    assert_relative_eq!(own, expected, max_relative = 2e-3);
    // The rounding of the rows is what the ± is of.
    let likely = PlausibleCams::of(&contour).unwrap().unwrap();
    assert_relative_eq!(likely.measured.step_m.unwrap(), 1e-5, max_relative = 1e-9);
    let error = likely.errors(&[own], |model, cam| Some(vec![speed(model, cam)])).unwrap()[0];
    assert!((own - expected).abs() <= error && error < 0.02 * own, "{own} ± {error}, {expected}");
    // Without the follower, the radius alone leaves the cam elsewhere.
    let (radius, point) = read(&csv, "spline = \"smoothing\"").unwrap();
    assert!((speed(&radius, &point) / expected - 1.0).abs() > 0.1);
}

/// The pieces meet with five derivatives, and rows as close as a thousandth of a degree leave no noise in them.
#[test]
#[ignore = "slow"]
fn pieces_meet_but_at_corners() {
    for (count, spline) in [(24, "quintic"), (360, "quintic"), (36_000, "quintic"), (360, "cubic")] {
        let contour = polar(count, |angle| 30.0 + 3.0 * angle.cos());
        for contact in [FLAT.to_owned(), roller((5.0, 8.0))] {
            let cam = cam(&contour, &format!("spline = \"{spline}\"\n{contact}"));
            let orders: std::collections::BTreeSet<_> = cam.corners().iter().map(|corner| corner.jump_order).collect();
            assert!(orders.iter().all(|order| *order == if spline == "cubic" { 3 } else { 5 }), "{orders:?}");
            assert!(cam.corners().iter().all(|corner| cam.is_knot(corner)));
            for index in 0..cam.segments().len() {
                let (before, after) = (&cam.segments()[cam.before(index)], &cam.segments()[index]);
                let (one, other) = (before.law.lift(before.end), after.law.lift(after.start));
                close(&one, [other.value, other.slope, other.curvature], [1e-12, 1e-11, 1e-8]);
            }
            // A piece bends no more than the cam.
            let most = cam.segments().iter().map(|segment| segment.bounds.third).fold(0.0, f64::max);
            assert!(most < 30.0, "{count} {spline} {contact}: {most}");
        }
    }
}

/// The lift is the farthest to which any point of the contour lifts the follower, as found by trying points; under a flat face the radius of
/// curvature at the touching point is the lift with its second derivative, whose rounding is 2e-8 mm. Between coarse rows the lift is no
/// polynomial of degree 11.
#[test]
#[ignore = "slow"]
fn the_lift_is_the_largest_over_all_points() {
    const POINTS: usize = 2000;
    for (count, waves, depth) in [(12, 1.0, 9.0), (18, 2.0, 4.5), (36, 3.0, 2.2), (120, 9.0, 0.3)] {
        let contour = polar(count, |angle| 30.0 + depth * (waves * angle).cos());
        let spline = "spline = \"quintic\"\n";
        let point = cam(&contour, spline);
        for (contact, radius, offset) in
            [(FLAT.to_owned(), f64::INFINITY, 0.0), (roller((3.0, 0.0)), 3.0, 0.0), (roller((3.0, 8.0)), 3.0, 8.0)]
        {
            let cam = cam(&contour, &format!("{spline}{contact}"));
            for step in 0..80 {
                let angle = TAU * (f64::from(step) + 0.3) / 80.0;
                // Lift to which the point at a polar angle lifts the follower, and its derivative by that angle.
                let lifted = |from: f64| {
                    let at = point.lift((angle + from).rem_euclid(TAU));
                    let (sin, cos) = from.sin_cos();
                    let [along, across] = [at.value * cos, at.value * sin - offset];
                    let [along_rate, across_rate] = [at.slope * cos - at.value * sin, at.slope * sin + at.value * cos];
                    if radius.is_infinite() {
                        return (along, along_rate);
                    }
                    let height = (radius * radius - across * across).sqrt();
                    (along + height, along_rate - across * across_rate / height)
                };
                let from = |index: usize| PI * (index as f64 / POINTS as f64 - 0.5);
                let best = (0..=POINTS).max_by(|one, two| {
                    let [one, two] = [*one, *two].map(|index| lifted(from(index)).0);
                    one.max(0.0).total_cmp(&two.max(0.0))
                });
                let [mut low, mut high] = [best.unwrap() - 1, best.unwrap() + 1].map(from);
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    if lifted(middle).1 > 0.0 { low = middle } else { high = middle }
                }
                let (found, expected) = (cam.lift(angle), lifted(low).0);
                assert_abs_diff_eq!(found.value, expected, epsilon = 1e-12 * 2.0 * depth);
                if radius.is_infinite() {
                    let at = point.lift((angle + low).rem_euclid(TAU));
                    let curvature = at.value.hypot(at.slope).powi(3)
                        / (at.value.powi(2) + 2.0 * at.slope.powi(2) - at.value * at.curvature);
                    assert_abs_diff_eq!(found.value + found.curvature, curvature, epsilon = 1e-9 * 2.0 * depth + 2e-8);
                }
            }
        }
    }
}

/// An ellipse under a flat face is left first at either end: angle 0 is one place, on whichever side of it likely contours have it.
#[test]
fn places_about_angle_0_are_one() {
    let ellipse = |angle: f64| 500.0 / (25.0 * angle.sin()).hypot(20.0 * angle.cos());
    let csv = polar(360, |angle| (100.0 * ellipse(angle)).round() / 100.0);
    let (model, cam) = read(&csv, &format!("spline = \"smoothing\"\n{FLAT}")).unwrap();
    let machines = PlausibleMachines::of(&model, &cam).unwrap();
    let (separation, _) = known(Contact::new(&cam, model.follower).separation(), &machines);
    let places = separation_places(separation, &machines);
    let [one, other] = &places[..] else { panic!("{separation:?} {places:?}") };
    assert_abs_diff_eq!(one.share + other.share, 1.0, epsilon = 1e-12);
    let middle = |place: &SeparationPlace| 0.5 * (place.cam_angles[0] + place.cam_angles[1]);
    assert_abs_diff_eq!(apart(middle(one), middle(other)), PI, epsilon = 0.1);
}

/// The limit of a roller is the sharpest hollow, not the first one that is too sharp.
#[test]
fn the_sharpest_hollow_limits_a_roller() {
    let hollow = polar(360, |angle| 30.0 + 6.0 * (3.0 * angle).cos());
    for radius in [20.0, 25.0, 30.0] {
        let refused = read(&hollow, &format!("spline = \"cubic\"\n{}", roller((radius, 0.0)))).unwrap_err();
        let limit = refused.split("must be below ").nth(1).unwrap().split(' ').next().unwrap();
        assert_relative_eq!(limit.parse::<f64>().unwrap(), 24.0 * 24.0 / 30.0, max_relative = 1e-3);
    }
}

/// A hollow is named with the row at its place, or the last row before it: the last row of all before the first.
#[test]
fn a_hollow_is_named_with_the_row_before_it() {
    for (first, turned) in [(0.0, 61.5), (5.0, 63.0), (5.0, 2.5), (5.0, 118.5)] {
        let angles: Vec<f64> = (0..72).map(|row| 5.0 * f64::from(row) + first).collect();
        let row = |angle: &f64| {
            let from = 3.0 * (angle - turned).to_radians();
            format!("{angle},{:.6}\n", 30.0 - 6.0 * (1.0 + 0.1 * (from / 3.0).cos()) * from.cos())
        };
        let csv = "angle [deg],radius [mm]\n".to_owned() + &angles.iter().map(row).collect::<String>();
        let refused = read(&csv, &format!("spline = \"cubic\"\n{FLAT}")).unwrap_err();
        let number = |before: &str| -> f64 {
            refused.split(before).nth(1).unwrap().split([' ', ',']).next().unwrap().parse().unwrap()
        };
        let (place, line) = (number(" near "), number(", line ") as usize);
        let row = line - 2;
        let [from, to] = [angles[row], angles.get(row + 1).map_or(angles[0] + 360.0, |next| *next)];
        let place = if place < angles[0] { place + 360.0 } else { place };
        assert!((from - 0.005..to - 0.005).contains(&place), "{place} is not from {from} to {to}: {refused}");
        assert!(apart(place.to_radians(), turned.to_radians()) < 0.1, "{refused}");
    }
}

#[test]
fn what_the_geometry_forbids_is_refused_with_its_place() {
    // Hollow at 60 deg, with a radius of curvature of 24^2/(54 - 24) = 19.2 mm.
    let hollow = polar(360, |angle| 30.0 + 6.0 * (3.0 * angle).cos());
    let round = polar(360, eccentric);
    let cubic = |contact: &str| format!("spline = \"cubic\"\n{contact}");
    let heart = points(200, |t| [20.0 * t.cos() - 19.0 * (2.0 * t).cos(), 20.0 * t.sin() - 19.0 * (2.0 * t).sin()]);
    let eight = points(200, |t| [30.0 * t.cos(), 20.0 * (2.0 * t).sin() + 1.0]);
    let aside = points(200, |t| [40.0 + 20.0 * t.cos(), 20.0 * t.sin()]);
    let twice = points(200, |t| [30.0 * (2.0 * t).cos(), 30.0 * (2.0 * t).sin()]);
    let open = points(200, |t| [30.0 * (0.7 * t).cos(), 30.0 * (0.7 * t).sin()]);
    let head = |csv: &str, old: &str, new: &str| csv.replacen(old, new, 1);
    for (csv, fields, says) in [
        (&hollow, cubic(FLAT), "cam.contact = \"flat\": must not be a flat face here: the contour is hollow"),
        (&hollow, cubic(&roller((40.0, 0.0))), "cam.contact.roller_radius = 40.0: must be below"),
        (&round, cubic(&roller((5.0, 18.0))), ""),
        (&round, cubic(&roller((50.0, 0.0))), "cam.contact.roller_radius = 50.0: must be at most"),
        (&round, cubic(&roller((5.0, 20.0))), "cam.contact.offset = 20.0: is too large"),
        (&round, cubic(&roller((5.0, -40.0))), "cam.contact.offset = -40.0: is too large"),
        (&heart, cubic(""), "the contour crosses itself"),
        (&eight, cubic(""), "the contour crosses itself"),
        (&aside, cubic(""), "the axis, x = 0 and y = 0, is outside of the contour"),
        (&twice, cubic(""), "goes round the cam's axis 2.0 times"),
        (&open, cubic(""), "a whole turn is needed"),
        (&head(&round, "26.0\n", "-26.0\n"), cubic(""), "contour.csv:2: radius"),
        (&head(&round, "radius", "lift"), cubic(""), "use law = \"table\""),
        (&head(&round, "radius", "velocity"), cubic(""), "must name the angle, then the radius"),
        (&round, cubic("radius_column = 2\nx_column = 1"), "belongs to other coordinates"),
        (&aside.replace("x [mm];y [mm]\n", ""), cubic(""), "then set coordinates = \"xy\" in [cam]"),
        (&round, cubic("lift_column = 2"), "unknown field"),
        (&aside, cubic("angle_unit = \"rad\""), "is for angles, but the table has x and y"),
        (&round, cubic("coordinates = \"cubic\""), "must be one of: \"polar\", \"xy\""),
    ] {
        match read(csv, &fields) {
            Ok(_) => assert!(says.is_empty(), "{fields}: {says}"),
            Err(refused) => {
                assert!(!says.is_empty() && refused.contains(says), "{fields}: {refused}");
                assert!(refused.contains("model.toml:") || refused.contains("contour.csv:"), "{refused}");
            }
        }
    }
    // A roller that is smaller than the hollow fits, and the page tells how sharp that is.
    let (model, cam) = read(&hollow, &cubic(&roller((3.0, 2.0)))).unwrap();
    let geometry = CamGeometry::of(&model, &cam).unwrap();
    assert!(geometry.is_touchable);
    assert_relative_eq!(geometry.hollow_radius_m.unwrap(), 19.2, max_relative = 1e-3);
    // At 0 deg, (R^2 - R R'')/R^3 = 1/36 + 54/36^2 of curvature.
    assert_relative_eq!(geometry.least_radius_m, 36.0 * 36.0 / 90.0, max_relative = 1e-3);
    let (model, cam) = read(&round, &cubic(FLAT)).unwrap();
    let geometry = CamGeometry::of(&model, &cam).unwrap();
    assert_relative_eq!(geometry.least_radius_m, 20.0, max_relative = 1e-3);
    assert_relative_eq!(geometry.face_width_m.unwrap(), 12.0, max_relative = 1e-6);
}

/// A table of radii is no table of lifts, and the complaint says which law takes it.
#[test]
fn a_radius_under_the_law_of_tables_names_the_law_of_contours() {
    let folder = TempDir::new().unwrap();
    std::fs::write(folder.path().join("polar.csv"), polar(360, eccentric)).unwrap();
    let file = folder.path().join("polar.toml");
    let model = FOLLOWER.replace("contour", "table") + "file = \"polar.csv\"\nspline = \"cubic\"\n";
    std::fs::write(&file, model).unwrap();
    let out = folder.path().join("cam.svg");
    let answer = corner_impact(["cam", file.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    let said = text(answer.stderr).split_whitespace().collect::<Vec<_>>().join(" ");
    assert_eq!((answer.status.code(), out.exists()), (Some(2), false));
    assert!(said.contains("use law = \"contour\""), "{said}");
}

/// A model that stands alone has its contour as polar rows; it is the same cam.
#[test]
fn a_contour_survives_being_written() {
    let place = |angle: f64| [eccentric(angle) * angle.cos(), eccentric(angle) * angle.sin()];
    let fields = format!("spline = \"smoothing\"\n{}\nlever_ratio = 1.5", roller((5.0, 8.0)));
    let (model, cam) = read(&points(180, place), &fields).unwrap();
    let again = Model::parse("again.toml", &model.text()).unwrap();
    assert_eq!(again.text(), model.text());
    let again = Cam::new(&again).unwrap();
    for angle in (0..97).map(|index| TAU * f64::from(index) / 97.0) {
        assert_abs_diff_eq!(again.lift(angle).value, cam.lift(angle).value, epsilon = 1e-12);
    }
}

#[test]
#[ignore = "slow"]
fn the_page_says_what_was_read_and_proofs_are_refused_with_a_sentence() {
    let folder = TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    std::fs::write(path("contour.csv"), polar(360, |angle| (1e3 * eccentric(angle)).round() / 1e3)).unwrap();
    let file = path("model.toml");
    std::fs::write(&file, FOLLOWER.to_owned() + "file = \"contour.csv\"\nspline = \"smoothing\"\ncontact = \"flat\"\n")
        .unwrap();
    let said = |words: &[&str]| {
        let answer = corner_impact(words);
        (text(answer.stdout) + &text(answer.stderr)).split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let page = said(&["cam", &file]);
    for says in
        ["law \"contour\"", "a flat face square to its motion", "radii: column 2, in mm", "radius rounded to 0.001 mm"]
    {
        assert!(page.contains(says), "{says}: {page}");
    }
    let refused = said(&["certify", &file, "--orbits", "--rpm", "500"]);
    assert!(refused.contains("cam.law = \"contour\": gives a contour; proofs are for lifts"), "{refused}");
}
