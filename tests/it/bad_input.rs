//! Is bad input refused with exit 2 and a message that names file, line, field, value and what is allowed?

use crate::common;
use std::path::PathBuf;
use std::process::Output;

struct Case {
    changes: &'static [(&'static str, &'static str)],
    /// Parts of the message, in order of reading.
    says: &'static [&'static str],
}

fn folder() -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("bad_input");
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn verify(arguments: &[&std::ffi::OsStr]) -> Output {
    common::program(["verify", "--no-external"]).args(arguments).output().unwrap()
}

/// Runs `verify` on `text` and demands exit 2, an empty standard output and one message with these parts.
#[track_caller]
fn refuses(name: &str, text: &[u8], says: &[&str]) {
    let file = folder().join(format!("{name}.toml"));
    std::fs::write(&file, text).unwrap();
    let output = verify(&[file.as_os_str()]);
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{name}: {message}");
    assert!(output.stdout.is_empty(), "{name}: nothing is printed");
    assert!(message.starts_with("error: ") && message.matches("error:").count() == 1, "{name}: {message}");
    assert!(message.contains(&format!("{name}.toml")), "{name}: {message}");
    for part in says {
        assert!(message.contains(part), "{name}: no \"{part}\" in: {message}");
    }
}

#[test]
fn single_fields() {
    let cases = [
        Case { changes: &[("mass", "-1.0")], says: &[".toml:7: follower.mass = -1.0", "above 0"] },
        Case { changes: &[("mass", "0")], says: &["follower.mass = 0", "above 0"] },
        Case { changes: &[("mass", "nan")], says: &["follower.mass = nan", "finite"] },
        Case { changes: &[("mass", "inf")], says: &["follower.mass = inf", "finite"] },
        Case { changes: &[("mass", "1e999")], says: &["follower.mass = 1e999", "finite"] },
        Case { changes: &[("mass", "\"heavy\"")], says: &["follower.mass = \"heavy\"", "finite number above 0"] },
        Case { changes: &[("mass", "[1.0]")], says: &["follower.mass = [1.0]"] },
        Case { changes: &[("mass", "true")], says: &["follower.mass = true"] },
        Case { changes: &[("damping", "-0.1")], says: &["follower.damping = -0.1", "0 or more"] },
        Case { changes: &[("stiffness", "-inf")], says: &["follower.stiffness = -inf", "0 or more"] },
        Case { changes: &[("gravity", "nan")], says: &["follower.gravity = nan", "finite"] },
        Case { changes: &[("rest_position", "inf")], says: &["follower.rest_position = inf", "finite"] },
        Case { changes: &[("restitution", "1.01")], says: &["follower.restitution = 1.01", "from 0 to 1"] },
        Case { changes: &[("restitution", "-0.01")], says: &["follower.restitution = -0.01", "from 0 to 1"] },
        Case { changes: &[("law", "\"arc\"")], says: &["cam.law = \"arc\"", "must be one of: \"arcs\""] },
        Case { changes: &[("law", "7")], says: &["cam.law = 7", "text in quotes"] },
        Case { changes: &[("base_radius", "0.0")], says: &["cam.base_radius = 0.0", "above 0"] },
        Case { changes: &[("flank_start_deg", "-1.0")], says: &["cam.flank_start_deg = -1.0", "from 0 to 180"] },
        Case { changes: &[("nose_end_deg", "181.0")], says: &["cam.nose_end_deg = 181.0", "from 0 to 180"] },
        Case { changes: &[("rpm_min", "0.0")], says: &["study.rpm_min = 0.0", "above 0"] },
        Case { changes: &[("rpm_max", "600.0")], says: &["study.rpm_max = 600.0", "above study.rpm_min = 600"] },
        Case { changes: &[("rpm_max", "-5.0")], says: &["study.rpm_max = -5.0", "above 0"] },
        Case { changes: &[("rpm_min", "inf")], says: &["study.rpm_min = inf", "finite"] },
    ];
    for (index, case) in cases.iter().enumerate() {
        refuses(&format!("field-{index}"), common::osorio_text(case.changes).as_bytes(), case.says);
    }
}

#[test]
fn circles_that_cannot_touch() {
    let cases = [
        Case {
            changes: &[("flank_radius", "0.4")],
            says: &[":17: cam.flank_radius = 0.4", "above cam.base_radius = 0.4"],
        },
        Case { changes: &[("nose_radius", "0.9")], says: &["cam.nose_radius = 0.9", "below cam.flank_radius = 0.85"] },
        Case {
            changes: &[("nose_radius", "0.41")],
            says: &["cam.nose_radius = 0.41", "below 0.4", "touch the flank circle"],
        },
        Case {
            changes: &[("nose_end_deg", "90.0")],
            says: &["cam.nose_end_deg = 90.0", "above cam.flank_start_deg = 90"],
        },
    ];
    for (index, case) in cases.iter().enumerate() {
        refuses(&format!("circles-{index}"), common::osorio_text(case.changes).as_bytes(), case.says);
    }
}

#[test]
fn fields_that_are_missing_or_unknown() {
    let text = common::osorio_text(&[]);
    let without = |field: &str| {
        let lines = text.lines().filter(|line| !line.starts_with(&format!("{field} =")));
        lines.collect::<Vec<_>>().join("\n")
    };
    refuses("missing-mass", without("mass").as_bytes(), &[":6: follower.mass is missing"]);
    let mistyped = text.replace("restitution =", "restitutoin =");
    refuses("mistyped", mistyped.as_bytes(), &["follower.restitution is missing; found there:", "restitutoin"]);
    refuses("missing-law", without("law").as_bytes(), &["cam.law is missing"]);
    refuses("missing-speed", without("rpm_max").as_bytes(), &["study.rpm_max is missing"]);
    refuses("missing-follower", b"[cam]\nlaw = \"arcs\"\n", &["follower.mass is missing"]);
    let unknown = text.replace("damping = 0.0", "damping = 0.0\nfriction = 0.1");
    refuses(
        "unknown-field",
        unknown.as_bytes(),
        &[":9: follower.friction = 0.1", "unknown field", "[follower]", "restitution"],
    );
    let unknown = format!("{text}\n[cams]\nx = 1\n");
    refuses(
        "unknown-table",
        unknown.as_bytes(),
        &["cams is an unknown field; allowed at the top of the file", "cam, follower, study"],
    );
    let study = text.split("[study]").next().unwrap();
    refuses("no-study", study.as_bytes(), &["study.rpm_min", "gives the speeds at which to search"]);
    refuses("scalar-table", b"follower = 3\n", &["follower.mass is missing"]);
}

#[test]
fn files_that_do_not_read() {
    refuses("not-toml", b"name = \"x\"\n[follower\nmass = 1\n", &[":2: not valid TOML"]);
    refuses("twice", b"name = \"x\"\nname = \"y\"\n", &["not valid TOML"]);
    refuses("empty", b"", &["follower.mass is missing"]);
    refuses("not-text", &[0xff, 0xfe, 0x00, 0x01], &["cannot be read"]);
    for missing in [folder().join("there-is-no-such.toml"), folder()] {
        let output = verify(&[missing.as_os_str()]);
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(output.stdout.is_empty() && message.contains("cannot be read"), "{message}");
    }
}

#[test]
fn speeds_without_a_corner_impact() {
    let text = common::osorio_text(&[("rpm_min", "700.0")]);
    refuses(
        "no-root",
        text.as_bytes(),
        &[":23: study.rpm_min = 700.0", "no corner impact", "study.rpm_max = 760", "90.0000, 150.1794"],
    );
    // There the free flight passes the corner, but through the cam.
    let text = common::osorio_text(&[("rpm_min", "100.0"), ("rpm_max", "600.0")]);
    let says =
        ["no corner impact", "found instead", "rpm at", "below the cam", "a graze, v = c'", "meets the cam elsewhere"];
    refuses("through-the-cam", text.as_bytes(), &says);
}

/// At 326.9 rpm the undamped spring swings once a revolution. Pushed up from 1.2 m it clears the cam but for the corner,
/// which it touches with the cam's own velocity. The corners mirror each other: rounding picks the one that is named.
#[test]
fn grazing_impacts() {
    let speed = (1430.8_f64 / 1.221).sqrt() * 60.0 / std::f64::consts::TAU;
    let (low, high) = (format!("{}", speed - 5.0), format!("{}", speed + 5.0));
    let text = common::osorio_text(&[("rest_position", "1.2"), ("rpm_min", &low), ("rpm_max", &high)]);
    refuses(
        "resonance",
        text.as_bytes(),
        &["grazing impact at 326.8", "touches the corner at", "v = c'", "no linear part"],
    );
    // A follower that rests where the top of the cam just reaches it.
    let top = 0.403933207238214137 + 0.15;
    let text = common::osorio_text(&[("rest_position", &format!("{top}")), ("rpm_min", "750.0")]);
    refuses("at-rest", text.as_bytes(), &["grazing impact", "deg with v = c' = 0 in the model's units"]);
    // One that rests on the base circle is carried off by the flank: no orbit at all.
    let text = common::osorio_text(&[("rest_position", "0.4"), ("rpm_min", "750.0")]);
    refuses("carried", text.as_bytes(), &["no corner impact", "a graze, v = c', and no orbit"]);
}

#[test]
fn an_elastic_undamped_follower_bounces_at_every_speed() {
    let text = common::osorio_text(&[("restitution", "1.0"), ("rpm_min", "800.0"), ("rpm_max", "900.0")]);
    refuses("family", text.as_bytes(), &["no corner impact", "nothing fixes a speed"]);
}

/// A range too wide to search is refused, not searched thinly; magnitudes that overflow are named as such.
#[test]
fn ranges_and_magnitudes_that_cannot_be_searched() {
    let text = common::osorio_text(&[("rpm_min", "1e-3")]);
    refuses("too-wide", text.as_bytes(), &["study.rpm_min = 1e-3", "spans too much", "radians"]);
    let text = common::osorio_text(&[("stiffness", "1e300"), ("mass", "1e-300")]);
    refuses("overflow", text.as_bytes(), &["follower.mass = 1e-300: makes mass 1e-300, below 1e-75"]);
}

/// Numbers at the edge of a double end in a message, never in a panic.
#[test]
#[ignore = "slow"]
fn extreme_numbers() {
    for (index, (field, value)) in [
        ("mass", "1e-308"),
        ("mass", "1e308"),
        ("stiffness", "1e308"),
        ("stiffness", "1e-308"),
        ("damping", "1e300"),
        ("gravity", "-1e308"),
        ("rest_position", "1e308"),
        ("rest_position", "-1e308"),
        ("rpm_max", "1e308"),
        ("rpm_min", "1e-308"),
        ("base_radius", "1e-300"),
        ("flank_radius", "1e300"),
        ("nose_radius", "1e-300"),
        ("nose_end_deg", "90.0000000001"),
        ("nose_end_deg", "180.0"),
        ("flank_start_deg", "0.0"),
    ]
    .into_iter()
    .enumerate()
    {
        let file = folder().join(format!("extreme-{index}.toml"));
        std::fs::write(&file, common::osorio_text(&[(field, value)])).unwrap();
        let output = verify(&[file.as_os_str()]);
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(matches!(output.status.code(), Some(0..=2)), "{field} = {value}: {:?} {message}", output.status);
        assert!(!message.contains("panicked"), "{field} = {value}: {message}");
    }
}

/// The paper's follower over another cam.
fn with_cam(table: &str) -> String {
    let text = common::osorio_text(&[]);
    let (follower, _) = text.split_once("[cam]").unwrap();
    format!("{follower}[cam]\n{table}")
}

fn program(segments: &[(&str, &str, &str)]) -> String {
    let segment = |(motion, span, rise): &(&str, &str, &str)| {
        format!("[[cam.segment]]\nmotion = \"{motion}\"\nspan_deg = {span}\nrise = {rise}\n")
    };
    let segments: Vec<String> = segments.iter().map(segment).collect();
    with_cam(&format!("law = \"program\"\nbase = 0.1\n{}", segments.concat()))
}

fn polynomials(segments: &[(&str, &str)]) -> String {
    let segment = |(start, coefficients): &(&str, &str)| {
        format!("[[cam.segment]]\nstart_deg = {start}\ncoefficients = {coefficients}\n")
    };
    let segments: Vec<String> = segments.iter().map(segment).collect();
    with_cam(&format!("law = \"polynomial\"\n{}", segments.concat()))
}

/// [cam] is line 14: `law` stands on line 15, the first segment of a program on line 17.
#[test]
fn laws_of_the_cam() {
    let harmonic = |fields: &str| with_cam(&format!("law = \"harmonic\"\noffset = 0.1\n{fields}\n"));
    let cases: [(String, &[&str]); 33] = [
        (
            with_cam("law = \"helix\"\n"),
            &[":15: cam.law = \"helix\": must be one of: \"arcs\", \"harmonic\"", "\"table\""],
        ),
        (harmonic("amplitudes = [0.1]"), &[":14: cam.phases_deg is missing; found there: amplitudes"]),
        (
            harmonic("amplitudes = [0.1, 0.2]\nphases_deg = [0.0]"),
            &[":18: cam.phases_deg = [0.0]: has 1 numbers; one for each of the 2"],
        ),
        (harmonic("amplitudes = []\nphases_deg = []"), &[":17: cam.amplitudes = []: has 0 numbers; 1 to 1000"]),
        (harmonic("amplitudes = 0.1\nphases_deg = [0.0]"), &["cam.amplitudes = 0.1: must be a list of numbers"]),
        (
            harmonic("amplitudes = [0.1,\n nan]\nphases_deg = [0.0, 1.0]"),
            &[":18: cam.amplitudes[1] = nan: must be a finite number"],
        ),
        (
            harmonic("amplitudes = [0.1, \"x\"]\nphases_deg = [0.0, 1.0]"),
            &[":17: cam.amplitudes[1] = \"x\": must be a finite number"],
        ),
        (harmonic("amplitudes = [[0.1]]\nphases_deg = [0.0]"), &["cam.amplitudes[0] = [0.1]: must be a finite number"]),
        (
            harmonic("amplitudes = [1e308]\nphases_deg = [0]\nk = [1]"),
            &[
                ":19: cam.k = [1]: unknown field; allowed in [cam]: amplitudes, corner_rounding_deg, law, lever_ratio, offset, phases_deg",
            ],
        ),
        (
            harmonic("amplitudes = [1e308, 1e308]\nphases_deg = [0, 0]"),
            &[":15: cam.law = \"harmonic\": gives lifts or derivatives too large"],
        ),
        (
            with_cam("law = \"rectified-sine\"\noffset = inf\namplitude = 1"),
            &[":16: cam.offset = inf: must be a finite number"],
        ),
        (with_cam("law = \"rectified-sine\"\noffset = 0\namplitude = true"), &[":17: cam.amplitude = true"]),
        (with_cam("law = \"program\"\nbase = 0.1\n"), &[":14: cam.segment is missing; found there: base, law"]),
        (with_cam("law = \"program\"\nbase = 0.1\nsegment = 3\n"), &["cam.segment = 3: must be a list of tables"]),
        (with_cam("law = \"program\"\nbase = 0.1\nsegment = []\n"), &["cam.segment = []: has 0 tables; 1 to 10000"]),
        (
            with_cam("law = \"program\"\nbase = 0.1\nsegment = [1]\n"),
            &["cam.segment[0] = 1: must be a table under [[cam.segment]]"],
        ),
        (
            program(&[("glide", "360", "0")]),
            &[":18: cam.segment[0].motion = \"glide\": must be one of: \"dwell\"", "\"poly4567\""],
        ),
        (program(&[("dwell", "360", "0.1")]), &[":20: cam.segment[0].rise = 0.1: must be 0: a dwell does not rise"]),
        (
            program(&[("dwell", "0", "0"), ("dwell", "360", "0")]),
            &[":19: cam.segment[0].span_deg = 0: must be a finite number above 0, up to 360"],
        ),
        (program(&[("dwell", "-10", "0")]), &["cam.segment[0].span_deg = -10"]),
        (
            program(&[("dwell", "100", "0"), ("dwell", "259", "0")]),
            &[":23: cam.segment[1].span_deg = 259: spans add up to 359: must be 360 degrees"],
        ),
        (
            program(&[("poly345", "100", "0.1"), ("harmonic", "260", "-0.2")]),
            &[":24: cam.segment[1].rise = -0.2: rises add up to -0.1: must be 0, or the lift jumps at 360 degrees"],
        ),
        (program(&[("poly345", "360", "nan")]), &["cam.segment[0].rise = nan"]),
        (
            program(&[("dwell", "360", "0\nsteps = 4")]),
            &[":21: cam.segment[0].steps = 4: unknown field; allowed in [cam.segment[0]]: motion, rise, span_deg"],
        ),
        (
            program(&[("dwell", "360", "0")]).replace("span_deg", "span"),
            &[":17: cam.segment[0].span_deg is missing; found there: motion, rise, span"],
        ),
        (polynomials(&[("0", "[]")]), &["cam.segment[0].coefficients = []: has 0 numbers; 1 to 32"]),
        (polynomials(&[("0", "[0.1, inf]")]), &["cam.segment[0].coefficients[1] = inf"]),
        (
            polynomials(&[("0", "[0.1]"), ("0", "[0.1]")]),
            &["cam.segment[1].start_deg = 0: must be above 0, the start of the previous segment"],
        ),
        (polynomials(&[("360", "[0.1]")]), &["cam.segment[0].start_deg = 360: must be below 360"]),
        (
            polynomials(&[("0", "[0.1]"), ("90", "[0.2]")]),
            &["cam.segment[0].coefficients[0] = 0.1: makes the lift jump from 0.2 to 0.1 at 0 degrees"],
        ),
        (
            polynomials(&[("10", "[0.1]"), ("90", "[0.1]"), ("180", "[0.2]")]),
            &["cam.segment[0].coefficients[0] = 0.1: makes the lift jump from 0.2 to 0.1 at 10 degrees"],
        ),
        (
            polynomials(&[("10", "[0.1]"), ("90", "[0.1, 0.0, 1.0]"), ("180", "[0.1]")]),
            &["cam.segment[2].coefficients[0] = 0.1: makes the lift jump from 2.56"],
        ),
        (with_cam("law = \"table\"\nfile = \"x.csv\"\n"), &[":14: cam.spline is missing"]),
    ];
    for (index, (text, says)) in cases.iter().enumerate() {
        refuses(&format!("law-{index}"), text.as_bytes(), says);
    }
}

/// No law panics, whatever finite numbers it is given: it is a cam, or a message.
#[test]
fn extreme_cams() {
    use corner_impact::cam::{Cam, Side};
    use corner_impact::model::Model;
    let numbers = ["0", "1e-308", "5e-324", "-1e308", "1e308", "1e154", "-1e-154", "1e-9", "0.1"];
    let mut texts = Vec::new();
    for a in numbers {
        for b in numbers {
            texts.push(with_cam(&format!(
                "law = \"harmonic\"\noffset = {a}\namplitudes = [{b}, {a}]\nphases_deg = [{b}, 1e300]"
            )));
            texts.push(with_cam(&format!("law = \"rectified-sine\"\noffset = {a}\namplitude = {b}")));
            texts.push(polynomials(&[("1e-300", &format!("[{a}, {b}, {a}, {b}, {a}, {b}, {a}, {b}]"))]));
            for motion in
                ["parabolic", "harmonic", "cycloidal", "modified-trapezoid", "modified-sine", "poly345", "poly4567"]
            {
                let back = if let Some(rest) = a.strip_prefix('-') { rest.into() } else { format!("-{a}") };
                texts.push(program(&[(motion, b, a), ("dwell", "360", "0"), (motion, "1e-12", &back)]));
            }
        }
    }
    let mut cams = 0;
    for text in &texts {
        let Ok(cam) = Model::parse("extreme.toml", text).and_then(|model| Cam::new(&model)) else { continue };
        cams += 1;
        assert!(!cam.top().is_nan() && cam.lift(1.0).value.is_finite(), "{text}");
        for corner in cam.corners() {
            let _ = cam.continued(corner, Side::Minus, 1e-3).or(cam.continued(corner, Side::Plus, 1e-3));
        }
    }
    assert!(cams > 100, "{cams} of {}", texts.len());
}

#[test]
fn usage() {
    for arguments in [["--no-such-flag", "x.toml"], ["a.toml", "b.toml"]] {
        let arguments: Vec<_> = arguments.iter().map(std::ffi::OsStr::new).collect();
        let output = verify(&arguments);
        assert_eq!(output.status.code(), Some(2));
        assert!(output.stdout.is_empty() && !output.stderr.is_empty());
    }
}
