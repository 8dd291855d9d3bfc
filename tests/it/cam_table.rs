//! Is a table of lifts read row by row, and is the spline through it the one that its name says?

use std::f64::consts::TAU;
use std::path::PathBuf;

use crate::common;
use approx::{assert_abs_diff_eq, assert_relative_eq};
use corner_impact::cam::Cam;
use corner_impact::measured::{CamUncertainty, PlausibleCams};
use corner_impact::model::Model;
use serde_json::json;

fn folder() -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("cam_table");
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn model_text(table: &str, spline: &str) -> String {
    format!(
        "[follower]\nmass = 1\ndamping = 0\nstiffness = 1\ngravity = 0\nrest_position = 0\nrestitution = 1\n\
         [cam]\nlaw = \"table\"\nfile = \"{table}\"\nspline = \"{spline}\"\n"
    )
}

fn csv(rows: &[(f64, f64)]) -> String {
    let rows: Vec<String> = rows.iter().map(|(angle, lift)| format!("{angle:?},{lift:?}\n")).collect();
    format!("angle_deg,lift\n{}", rows.concat())
}

/// Writes model and table beside each other and reads the model; `name` keeps tests apart.
fn cam_of(name: &str, text: &str, spline: &str) -> Result<Cam, String> {
    cam_with(name, text, spline, "")
}

/// The same with `more` fields of the cam.
fn cam_with(name: &str, text: &str, spline: &str, more: &str) -> Result<Cam, String> {
    std::fs::write(folder().join(format!("{name}.csv")), text).unwrap();
    let file = folder().join(format!("{name}.toml"));
    std::fs::write(&file, model_text(&format!("{name}.csv"), spline) + more).unwrap();
    let model = Model::read(&file).map_err(|error| error.to_string())?;
    Cam::new(&model).map_err(|error| error.to_string())
}

/// Angles that are not evenly spaced, the first one not at 0.
fn uneven(count: u32) -> Vec<f64> {
    let step = 360.0 / f64::from(count);
    (0..count).map(|k| f64::from(k) * step + step * (0.5 + 0.1 * (f64::from(k * k % 7) - 3.0))).collect()
}

fn smooth(angle_deg: f64) -> f64 {
    let theta = angle_deg.to_radians();
    0.1 + 0.02 * (theta - 0.3).cos() + 0.003 * (3.0 * theta).sin()
}

const SPLINES: [(&str, usize); 2] = [("cubic", 3), ("quintic", 5)];

/// Every row is met, and every derivative below the spline's degree is one from both sides, through 360 degrees too.
#[test]
fn splines_interpolate_and_are_as_smooth_as_their_degree_allows() {
    for (spline, degree) in SPLINES {
        for angles in [uneven(37), uneven(3), (0..72).map(|k| 5.0 * f64::from(k)).collect()] {
            let rows: Vec<(f64, f64)> = angles.iter().map(|angle| (*angle, smooth(*angle))).collect();
            let cam = cam_of(&format!("smooth-{spline}-{}", rows.len()), &csv(&rows), spline).unwrap();
            for (angle, lift) in &rows {
                assert_abs_diff_eq!(cam.lift(angle.to_radians()).value, *lift, epsilon = 1e-16);
            }
            let segments = cam.segments();
            assert_eq!(segments.len(), rows.len() + usize::from(rows[0].0 > 0.0));
            let mut largest_jump = 0.0_f64;
            for (index, segment) in segments.iter().enumerate() {
                let before = &segments[(index + segments.len() - 1) % segments.len()];
                let (minus, plus) = (before.law.jet(before.end), segment.law.jet(segment.start));
                for order in 0..degree {
                    let scale = 0.1 * (f64::from(rows.len() as u32)).powi(order as i32);
                    assert_abs_diff_eq!(minus.0[order], plus.0[order], epsilon = 1e-13 * scale);
                }
                largest_jump = largest_jump.max((plus.0[degree] - minus.0[degree]).abs());
            }
            assert!(largest_jump > 1e-3, "{spline}");
            assert_eq!(cam.corners().len(), rows.len());
        }
    }
}

/// Halving the spacing divides the error by 2^(degree + 1), and that of the k-th derivative by 2^(degree + 1 - k).
#[test]
fn splines_converge_at_their_order() {
    let exact = |theta: f64| {
        let (first, third) = (theta - 0.3, 3.0 * theta);
        let value = 0.1 + 0.02 * first.cos() + 0.003 * third.sin();
        [value, -0.02 * first.sin() + 0.009 * third.cos(), -0.02 * first.cos() - 0.027 * third.sin()]
    };
    for (spline, degree) in SPLINES {
        let errors = |count: u32| {
            let rows: Vec<(f64, f64)> =
                (0..count).map(|k| 360.0 * f64::from(k) / f64::from(count)).map(|a| (a, smooth(a))).collect();
            let cam = cam_of(&format!("order-{spline}-{count}"), &csv(&rows), spline).unwrap();
            let mut errors = [0.0_f64; 3];
            for k in 0..3000 {
                let theta = TAU * f64::from(k) / 3000.0;
                let lift = cam.lift(theta);
                for (error, (found, exact)) in
                    errors.iter_mut().zip([lift.value, lift.slope, lift.curvature].into_iter().zip(exact(theta)))
                {
                    *error = error.max((found - exact).abs());
                }
            }
            errors
        };
        let (coarse, fine) = (errors(36), errors(72));
        for order in 0..3 {
            let expected = 2.0_f64.powi((degree + 1 - order) as i32);
            assert_relative_eq!(coarse[order] / fine[order], expected, max_relative = 0.15);
        }
    }
}

/// Where the rows lie on a polynomial that the spline can be, far from what is not, the spline is that polynomial.
#[test]
fn splines_reproduce_polynomials_of_their_degree() {
    for (spline, degree) in [("cubic", 3), ("quintic", 5)] {
        // On [60, 300] a power of the distance from 180; beyond it, a line back.
        let lift = |angle: f64| {
            let u = f64::clamp((angle - 180.0) / 120.0, -1.0, 1.0);
            let power = 0.1 + 0.02 * u.powi(degree) - 0.01 * u * u;
            if (60.0..=300.0).contains(&angle) { power } else { 0.1 }
        };
        let rows: Vec<(f64, f64)> = (0..360).map(|k| (f64::from(k), lift(f64::from(k)))).collect();
        let cam = cam_of(&format!("power-{spline}"), &csv(&rows), spline).unwrap();
        for k in 0..100 {
            // What happens 60 rows away has died out by 0.43^60.
            let angle = 130.0 + f64::from(k);
            let u = (angle + 0.37 - 180.0) / 120.0;
            let per_radian = 180.0 / std::f64::consts::PI / 120.0;
            let found = cam.lift((angle + 0.37).to_radians());
            let n = f64::from(degree);
            assert_abs_diff_eq!(found.value, lift(angle + 0.37), epsilon = 1e-15);
            let slope = (0.02 * n * u.powi(degree - 1) - 0.02 * u) * per_radian;
            assert_abs_diff_eq!(found.slope, slope, epsilon = 1e-13);
            let curvature = (0.02 * n * (n - 1.0) * u.powi(degree - 2) - 0.02) * per_radian * per_radian;
            assert_abs_diff_eq!(found.curvature, curvature, epsilon = 1e-10);
        }
    }
}

#[test]
fn rows_that_say_the_same_otherwise() {
    let rows: Vec<(f64, f64)> = (0..36).map(|k| (10.0 * f64::from(k), smooth(10.0 * f64::from(k)))).collect();
    let plain = csv(&rows);
    let cam = cam_of("plain", &plain, "cubic").unwrap();
    // A last row that repeats the first, line ends of another system, a spreadsheet's mark, blanks.
    let closed = format!("{plain}360.0,{:?}\n", rows[0].1);
    for (name, text) in [
        ("closed", closed),
        ("crlf", plain.replace('\n', "\r\n")),
        ("marked", format!("\u{feff}{plain}")),
        ("blank", format!("{}\n\n", plain.replace(',', " , "))),
    ] {
        assert_eq!(cam_of(name, &text, "cubic").unwrap(), cam, "{name}");
    }
    // A row at 360 without one at 0 is the row at 0.
    let turned = csv(&rows[1..]) + &format!("360,{:?}\n", rows[0].1);
    let turned = cam_of("turned", &turned, "cubic").unwrap();
    for k in 0..100 {
        let theta = TAU * f64::from(k) / 100.0;
        assert_abs_diff_eq!(turned.lift(theta).value, cam.lift(theta).value, epsilon = 1e-15);
    }
    // Equal lifts are a round cam without a corner.
    let flat = cam_of("flat", &csv(&[(0.0, 0.1), (100.0, 0.1), (220.0, 0.1)]), "quintic").unwrap();
    assert!(flat.corners().is_empty() && flat.lift(1.0).value == 0.1);
}

/// The first row has decimals behind a comma in both columns, or a blank before the comma that parts them, or other signs than its header.
#[test]
fn a_row_of_numbers_says_what_parts_the_columns() {
    let cam = cam_of("parted", "0.5,1.25\n120.5,2.5\n240.5,1.75\n", "cubic").unwrap();
    for (name, text) in [
        ("decimal-commas", "0,5 1,25\n120,5 2,5\n240,5 1,75\n"),
        ("blank-before", "0.5 ,1.25\n120.5 ,2.5\n240.5 ,1.75\n"),
        ("commas-in-header", "angle [deg], lift [m]\n0.5 1.25\n120.5 2.5\n240.5 1.75\n"),
        ("semicolon-in-header", "angle deg; from the nose, lift m\n0.5,1.25\n120.5,2.5\n240.5,1.75\n"),
    ] {
        assert_eq!(cam_of(name, text, "cubic").unwrap(), cam, "{name}");
    }
    // A comma between two digits alone is a decimal one.
    let whole = cam_of("whole", "0,15\n120,25\n240,17\n", "cubic").unwrap();
    for (name, text) in [
        ("whole-after-blanks", "0 ,15\n120 ,25\n240 ,17\n"),
        ("whole-before-blanks", "0, 15\n120, 25\n240, 17\n"),
        ("named-after-blanks", "angle ,lift\n0 ,15\n120 ,25\n240 ,17\n"),
    ] {
        assert_eq!(cam_of(name, text, "cubic").unwrap(), whole, "{name}");
    }
    // What is no number beside a decimal comma has its columns parted by it.
    let refused = cam_of("unit-in-row", "0,15 mm\n120,25 mm\n240,17 mm\n", "cubic").unwrap_err();
    assert!(refused.contains("lift = 15 mm"), "{refused}");
}

/// A unit alone names its column, and so does a sign; of several words the first is a name, be it that of a unit. What a header says is not
/// said otherwise beside it.
#[test]
fn units_are_named_by_a_word_or_a_sign() {
    let rows = |per_degree: f64| -> String {
        [(0.0, 1.25), (120.0, 2.5), (240.0, 1.75)]
            .map(|(angle, lift)| format!("{},{lift}\n", angle * per_degree))
            .concat()
    };
    let (degrees, radians) = (rows(1.0), rows(1.0_f64.to_radians()));
    for (name, header, rows) in [
        ("deg-alone", "deg,mm", &degrees),
        ("sign-alone", "°,mm", &degrees),
        ("rad-alone", "rad,mm", &radians),
        ("name-of-a-unit", "angle,M (mm)", &degrees),
    ] {
        let text = format!("{header}\n{rows}");
        let unit = if *rows == radians { "rad" } else { "deg" };
        let cam = cam_with(name, &text, "cubic", &format!("angle_unit = \"{unit}\"\n")).unwrap();
        for (angle, lift) in [(0.0, 1.25), (120.0, 2.5), (240.0, 1.75)] {
            assert_relative_eq!(cam.lift(f64::to_radians(angle)).value, 1e-3 * lift, max_relative = 1e-12);
        }
        if header.starts_with("angle") {
            continue;
        }
        let other = if unit == "rad" { "deg" } else { "rad" };
        let refused = cam_with(name, &text, "cubic", &format!("angle_unit = \"{other}\"\n")).unwrap_err();
        assert!(refused.contains(&format!("must be the unit in the header of the table: {unit}")), "{name}: {refused}");
    }
}

/// The same again is the same to ten digits: 1e-10 of the largest lift at 0.1 m, and of 1,000 m.
#[test]
fn a_turn_later_the_lift_is_the_same_to_as_many_digits() {
    for (name, lift, off, closes) in [
        ("closed-small", 0.1, 5e-11, true),
        ("open-small", 0.1, 1e-9, false),
        ("closed-large", 1e3, 5e-7, true),
        ("open-large", 1e3, 1e-5, false),
    ] {
        let rows = [(0.0, lift), (120.0, 0.9 * lift), (240.0, 0.8 * lift), (360.0, lift + off)];
        let cam = cam_of(name, &csv(&rows), "cubic");
        assert_eq!(cam.is_ok(), closes, "{name}: {cam:?}");
        assert!(cam.is_ok() || cam.unwrap_err().contains("one turn before; or leave the row out"), "{name}");
    }
}

/// Half a turn to a hundredth of the mean gap: of three rows 180 less 1.2 degrees.
#[test]
fn half_a_turn_without_a_row_is_half_a_turn_to_its_digits() {
    let with = |last: f64| cam_of("half", &csv(&[(0.0, 1.0), (90.0, 2.0), (last, 1.0)]), "cubic");
    assert!(with(181.3).is_ok());
    let refused = with(181.0).unwrap_err();
    assert!(refused.contains("no row from 181 to 360: the rows cover 181 degrees"), "{refused}");
}

/// Twelve rows are enough for what is measured to be told from the motion, and eleven are not.
#[test]
fn twelve_rows_may_be_smoothed() {
    for (count, are_enough) in [(11, false), (12, true)] {
        let model = even(count, |angle| (1e4 * (1.0 - angle.cos())).round() / 1e4);
        assert_eq!(PlausibleCams::of(&model).unwrap().is_some(), are_enough, "{count}");
    }
}

/// A model with a cubic spline through rows that are evenly spaced.
fn even(count: u32, lift: impl Fn(f64) -> f64) -> Model {
    let rows: Vec<[f64; 2]> = (0..count)
        .map(|row| 360.0 * f64::from(row) / f64::from(count))
        .map(|angle| [angle, lift(angle.to_radians())])
        .collect();
    let follower =
        json!({ "mass": 1, "damping": 0, "stiffness": 1, "gravity": 0, "rest_position": 0, "restitution": 1 });
    let cam = json!({ "law": "table", "spline": "cubic", "rows": rows });
    Model::of_document("even", &json!({ "follower": follower, "cam": cam })).unwrap()
}

/// Noise is seen from a billionth of the lift's rise on, here 2 cm on a base of 10 m: 2e-10 m is, and 1e-12 m is not.
#[test]
fn noise_is_seen_over_the_rise_of_the_lift() {
    let table = |noise: f64| even(4001, |angle| 10.0 + 0.01 * angle.cos() + noise * (1e9 * (angle + 1.0).sin()).sin());
    assert!(matches!(CamUncertainty::of(&table(2e-10)).unwrap(), Some(CamUncertainty::Noise(_))));
    assert!(CamUncertainty::of(&table(1e-12)).unwrap().is_none());
}

/// Text that is no table, each with what the message must say; the model's own name where its field is at fault.
#[test]
fn tables_that_are_refused() {
    let degrees = |skip: std::ops::Range<u32>| {
        let kept = (0..360).filter(move |k| !skip.contains(k));
        csv(&kept.map(|k| (f64::from(k), smooth(f64::from(k)))).collect::<Vec<_>>())
    };
    let cases: [(&str, String, &[&str]); 20] = [
        ("empty", String::new(), &[".csv: is empty", "angle_deg,lift"]),
        ("header", "place,height\n0,1\n".into(), &[".csv:1: header = place,height", "such as angle_deg,lift"]),
        (
            "inches",
            "angle [deg],lift [mille]\n0,1\n".into(),
            &[".csv:1: header = lift [mille]", "the unit of the lift must be one of: m, cm, mm"],
        ),
        ("hours", "angle (hours),lift\n0,1\n".into(), &["the unit of the angle must be one of: deg, rad"]),
        (
            "lifts-alone",
            "lift,lift\n1,0\n".into(),
            &[".csv:1: header = lift,lift", "must name the angle, then the lift"],
        ),
        ("text", "angle_deg,lift\n0,1\n120,high\n".into(), &[".csv:3: lift = high: must be a finite number"]),
        ("nan", "angle_deg,lift\n0,1\n120,nan\n".into(), &[".csv:3: lift = nan"]),
        ("inf", "angle_deg,lift\n0,1\n\n120,-inf\n".into(), &[".csv:4: lift = -inf"]),
        ("huge", "angle_deg,lift\n0,1e999\n".into(), &[".csv:2: lift = 1e999"]),
        ("angle", "angle_deg,lift\nnan,1\n".into(), &[".csv:2: angle_deg = nan: must be a finite number"]),
        ("past", "angle_deg,lift\n0,1\n400,1\n".into(), &[".csv:3: angle_deg = 400", "from 0 to 360"]),
        ("back", "angle_deg,lift\n-1,1\n100,1\n380,1\n".into(), &[".csv:4: angle_deg = 380", "from -1 to 359"]),
        ("one-column", "angle_deg,lift\n0\n".into(), &[".csv:2: row = 0: must be two numbers"]),
        (
            "three-columns",
            "angle_deg,lift\n0,1,2\n".into(),
            &[".csv:2: row = 0,1,2: has 3 columns, and the header has 2"],
        ),
        ("repeat", "angle_deg,lift\n0,1\n120,1\n120,2\n".into(), &[".csv:4: angle_deg = 120: repeats", "line 3"]),
        (
            "unsorted",
            "angle_deg,lift\n0,1\n120,1\n60,2\n".into(),
            &[".csv:4: angle_deg = 60: angles must rise", "above 120"],
        ),
        ("one-row", "angle_deg,lift\n0,1\n".into(), &[".csv: has 1 different angles; 3 to 1000000 are needed"]),
        ("two-rows", "angle_deg,lift\n0,1\n180,1\n360,1\n".into(), &[".csv: has 2 different angles"]),
        ("gap", degrees(100..120), &[".csv:101: angle_deg = 99: no row from 99 to 120: rows are missing", "10"]),
        ("open", format!("{}360,0.2\n", degrees(0..0)), &[".csv:362: lift = 0.2: must be 0.119", "on line 2"]),
    ];
    for (name, text, says) in cases {
        for (spline, _) in SPLINES {
            let message = cam_of(name, &text, spline).unwrap_err();
            assert!(message.contains(&format!("{name}.csv")), "{name}: {message}");
            for part in says {
                assert!(message.contains(part), "{name}: no \"{part}\" in: {message}");
            }
        }
    }
    // The end of the turn is a gap like any other; one just below the limit is none.
    assert!(cam_of("end", &degrees(330..360), "cubic").unwrap_err().contains("no row from 329 to 360"));
    assert!(cam_of("below", &degrees(100..109), "cubic").is_ok());
    assert!(cam_of("at", &degrees(100..110), "cubic").is_err());
    // Lifts at the end of a double.
    let huge = cam_of("overflow", &csv(&[(0.0, 1e308), (120.0, -1e308), (240.0, 1e308)]), "quintic").unwrap_err();
    assert!(huge.contains(".toml:10: cam.file") && huge.contains("too large"), "{huge}");
    // The file itself.
    let text = model_text("there-is-no-such.csv", "cubic");
    let missing = Model::parse("folder/model.toml", &text).unwrap_err().to_string();
    assert!(
        missing.starts_with("folder/model.toml:10: cam.file = \"there-is-no-such.csv\": cannot be read"),
        "{missing}"
    );
    assert!(missing.contains("folder/there-is-no-such.csv"), "{missing}");
    std::fs::write(folder().join("binary.csv"), [0xff, 0xfe, 0x00]).unwrap();
    let file = folder().join("binary.toml");
    std::fs::write(&file, model_text("binary.csv", "cubic")).unwrap();
    assert!(Model::read(&file).unwrap_err().to_string().contains("cannot be read"));
    let linear = cam_of("linear", &degrees(0..0), "linear").unwrap_err();
    assert!(
        linear.contains("cam.spline = \"linear\": must be one of: \"cubic\", \"quintic\", \"smoothing\""),
        "{linear}"
    );
}

/// Exit code 2, nothing printed, one message that names the table's file and line.
#[test]
fn commands_refuse_a_bad_table() {
    std::fs::write(folder().join("bad.csv"), "angle_deg,lift\n0,1\n120,x\n").unwrap();
    let file = folder().join("bad.toml");
    std::fs::write(&file, model_text("bad.csv", "cubic")).unwrap();
    for command in ["cam", "verify"] {
        let output = common::program([command]).arg(&file).output().unwrap();
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(output.stdout.is_empty() && message.starts_with("error: ") && message.contains("bad.csv:3: lift = x"));
    }
}

/// As many rows as a file holds; more than a million, be they short, are too many.
#[test]
#[ignore = "slow"]
fn hundreds_of_thousands_of_rows() {
    let count = 400_000_u32;
    let rows: Vec<(f64, f64)> =
        (0..count).map(|k| 360.0 * f64::from(k) / f64::from(count)).map(|a| (a, smooth(a))).collect();
    let text = csv(&rows);
    for (spline, _) in SPLINES {
        let cam = cam_of("million", &text, spline).unwrap();
        assert_eq!(cam.segments().len(), rows.len());
        for k in 0..1000 {
            let angle = 0.36 * f64::from(k) + 1e-4;
            assert_abs_diff_eq!(cam.lift(angle.to_radians()).value, smooth(angle), epsilon = 1e-15);
        }
        assert_relative_eq!(cam.top(), 0.12, max_relative = 0.05);
    }
    let more: String = (0..1_000_001).map(|k| format!("{:.5},.1\n", 0.000_359 * f64::from(k))).collect();
    let more = format!("angle_deg,lift\n{more}");
    assert!(cam_of("more", &more, "cubic").unwrap_err().contains("more.csv:1000002: has more than 1000000 rows"));
}
