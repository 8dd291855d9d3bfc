//! Is a machine in millimetres the one in metres, in every answer, and does a preload say where the spring is slack?

use std::path::Path;

use corner_impact::json;
use corner_impact::model::{Model, OSORIO_2008};
use serde_json::Value;

use crate::common::{self, corner_impact, program, text};

/// A valve with a cam of cycloidal motions: its units, follower and rise as written.
fn valve(units: &str, [mass, stiffness, spring, rise]: [&str; 4]) -> String {
    let motion = |rise: &str| format!("[[cam.segment]]\nmotion = \"cycloidal\"\nspan_deg = 90\nrise = {rise}\n");
    format!(
        "name = \"valve\"\n{units}[follower]\nmass = {mass}\ndamping = 3\nstiffness = {stiffness}\ngravity = 9.81\n\
         {spring}\nrestitution = 0.3\n[cam]\nlaw = \"program\"\nbase = 0\n{}{}\
         [[cam.segment]]\nmotion = \"dwell\"\nspan_deg = 180\n",
        motion(rise),
        motion(&format!("-{rise}")),
    )
}

const MILLIMETRES: &str =
    "[units]\nlength = \"mm\"\nmass = \"g\"\nstiffness = \"N/mm\"\nforce = \"kN\"\nangle = \"deg\"\n";

fn both() -> [String; 2] {
    [valve("", ["0.11", "30000", "preload = 220", "0.01"]), valve(MILLIMETRES, ["110", "30", "preload = 0.22", "10"])]
}

/// What the program prints about a model whose text is given.
fn printed(text_of_model: &str, command: &str, rest: &[&str]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("valve.toml");
    std::fs::write(&file, text_of_model).unwrap();
    let output = program([command, file.to_str().unwrap()]).args(rest).output().unwrap();
    assert!(output.status.success(), "{}", text(output.stderr));
    text(output.stdout)
}

fn close(one: f64, other: f64, place: &str) {
    assert!((one - other).abs() <= 1e-11 * other.abs().max(1e-9), "{place}: {one} {other}");
}

/// Name in metres, name in millimetres and degrees, and how many of the latter one of the former is.
fn told(name: &str) -> (String, f64) {
    let ends = [
        ("_m_s", "_mm_s", 1e3),
        ("_m", "_mm", 1e3),
        ("_rad", "_deg", 180.0 / std::f64::consts::PI),
        ("_n", "_kn", 1e-3),
    ];
    let end = ends.iter().find(|(si, ..)| name.ends_with(si));
    end.map_or((name.to_owned(), 1.0), |(si, here, scale)| (name.replace(si, here), *scale))
}

#[test]
fn tables_are_the_same_in_any_units() {
    let tables: [(&str, &[&str]); 7] = [
        ("simulate", &["--rpm", "4500", "--revolutions", "3", "--events", "-"]),
        ("simulate", &["--rpm", "4500", "--revolutions", "3", "--trace", "-", "--points-per-revolution", "40"]),
        ("simulate", &["--rpm", "4500", "--revolutions", "3", "--strobe", "1", "--strobe-out", "-"]),
        ("diagram", &["--rpm", "4200:4800:3", "--transient", "5", "--record", "2", "--out", "-"]),
        ("diagram", &["--rpm", "4200:4800:3", "--transient", "5", "--record", "2", "--show", "force", "--out", "-"]),
        ("continue", &["--from-rpm", "4500", "--parameter", "rpm=4480:4520", "--out", "-"]),
        ("basins", &["--rpm", "4500", "--grid", "3x2", "--revolutions", "3", "--out", "-"]),
    ];
    let [metres, millimetres] = both();
    for (command, rest) in tables {
        // Starts of basins are of the machine's own size.
        let [one, other] = [&metres, &millimetres].map(|model| printed(model, command, rest));
        let rows = |table: &str| -> Vec<Vec<String>> {
            table.lines().map(|line| line.split(',').map(String::from).collect()).collect()
        };
        let (one, other) = (rows(&one), rows(&other));
        assert!(one.len() > 3 && one.len() == other.len(), "{command}: {} {}", one.len(), other.len());
        for (column, name) in one[0].iter().enumerate() {
            let (here, scale) = told(name);
            assert_eq!(other[0][column], here);
            for (row, other) in one.iter().zip(&other).skip(1) {
                match (row[column].parse::<f64>(), other[column].parse::<f64>()) {
                    (Ok(si), Ok(here)) => close(here, scale * si, name),
                    _ => assert_eq!(row[column], other[column]),
                }
            }
        }
    }
}

/// The angles of events along a curve are in the unit of the model's angles, and nothing else of the table changes.
#[test]
fn a_table_of_curves_has_the_angles_of_the_model() {
    let curves = |model: &str| {
        printed(model, "curve", &["--rpm", "600:760", "--parameter", "restitution=0.78:0.82", "--out", "-"])
    };
    let degrees = OSORIO_2008.replace("[follower]", "[units]\nangle = \"deg\"\n[follower]");
    let [one, other] = [curves(OSORIO_2008), curves(&degrees)];
    let rows = |table: &str| table.lines().map(|line| line.split(',').map(String::from).collect()).collect();
    let [one, other]: [Vec<Vec<String>>; 2] = [rows(&one), rows(&other)];
    let angle = one[0].iter().position(|name| name == "cam_angle_rad").unwrap();
    assert_eq!((other[0][angle].as_str(), one.len()), ("cam_angle_deg", other.len()));
    assert!(one.len() > 3, "{} rows", one.len());
    for (row, other) in one.iter().zip(&other).skip(1) {
        let [here, there] = [row, other].map(|row| row[angle].parse::<f64>().unwrap());
        close(there, here.to_degrees(), "cam_angle");
        assert_eq!((&row[..angle], &row[angle + 1..]), (&other[..angle], &other[angle + 1..]));
    }
}

/// A number of a document is converted by its name, a force from kg mm/s^2; an object keeps the name and the unit that its numbers are proved in, and what is no
/// plain name is left alone.
#[test]
fn a_document_is_converted_by_its_names() {
    let [_, millimetres] = both();
    let units = Model::parse("valve.toml", &millimetres).unwrap().units;
    let document = serde_json::json!({
        "a_rad": 1.0, "b_n": [1e6, [2e6], {"c_n": 3e6, "d": 4.0}], "c_m": 5.0, "d_rad": {"e": 6.0}, "f_m": {"g": 7.0},
        "h_n": null, "i \"_n": 8.0, "j_rad": "k", "l_n": 9_000_000, "m": 10,
    });
    let told: Value = serde_json::from_str(&json::render(&document, &units).unwrap()).unwrap();
    let expected = serde_json::json!({
        "a_deg": 1.0_f64.to_degrees(), "b_kn": [1.0, [2.0], {"c_kn": 3.0, "d": 4.0}], "c_mm": 5.0, "d_rad": {"e": 6.0},
        "f_mm": {"g": 7.0}, "h_kn": null, "i \"_n": 8.0, "j_deg": "k", "l_kn": 9.0, "m": 10,
    });
    assert_eq!(told, expected, "{told:#}");
}

fn compare(si: &Value, here: &Value, scale: f64, place: &str) {
    match (si, here) {
        (Value::Object(si), Value::Object(here)) => {
            assert_eq!(si.len(), here.len(), "{place}");
            for (name, value) in si {
                let (told, scale) = told(name);
                let other = here.get(&told).unwrap_or_else(|| panic!("{place}: no {told}"));
                compare(value, other, scale, name);
            }
        }
        (Value::Array(si), Value::Array(here)) => {
            si.iter().zip(here).for_each(|(si, here)| compare(si, here, scale, place))
        }
        (Value::Number(si), Value::Number(here)) => close(here.as_f64().unwrap(), scale * si.as_f64().unwrap(), place),
        _ => assert_eq!(si, here, "{place}"),
    }
}

#[test]
fn documents_are_the_same_in_any_units() {
    let [metres, millimetres] = both();
    for (command, rest) in
        [("cam", &["--json"][..]), ("simulate", &["--rpm", "4500", "--revolutions", "3", "--summary"])]
    {
        let [si, here] = [&metres, &millimetres].map(|model| {
            let mut document: Value = serde_json::from_str(&printed(model, command, rest)).unwrap();
            document.as_object_mut().unwrap().remove("wall_s");
            // A jump and slopes are of a length, which their names do not say; a list of rounding's size has no digits.
            for list in ["corners", "segments"] {
                document.as_object_mut().unwrap().remove(list);
            }
            document
        });
        compare(&si, &here, 1.0, command);
    }
}

#[test]
fn pages_tell_the_unit_of_length() {
    let [metres, millimetres] = both();
    let page = |model: &str| printed(model, "simulate", &["--rpm", "4500", "--revolutions", "3"]);
    assert!(page(&metres).contains(" m, v = ") && page(&metres).contains(" m/s"), "{}", page(&metres));
    assert!(page(&millimetres).contains(" mm, v = ") && page(&millimetres).contains(" mm/s"), "{}", page(&millimetres));
    let folder = tempfile::tempdir().unwrap();
    for (model, unit) in [(&metres, "(m)"), (&millimetres, "(mm)")] {
        let svg = folder.path().join("trace.svg");
        printed(model, "simulate", &["--rpm", "4500", "--trace", svg.to_str().unwrap()]);
        let drawn = std::fs::read_to_string(&svg).unwrap();
        assert!(drawn.contains(&format!("position {unit}")), "{unit}");
    }
    let page = |model: &str| printed(model, "cam", &[]);
    assert!(page(&metres).contains("to 0.01 m\n") && page(&millimetres).contains("to 10 mm\n"));
}

/// `k (c_min - rest) = preload`, in every unit.
#[test]
fn a_preload_says_where_the_spring_is_slack() {
    let [metres, millimetres] = both().map(|text| Model::parse("valve.toml", &text).unwrap());
    close(metres.follower.rest_position, -220.0 / 30_000.0, "metres");
    close(millimetres.follower.rest_position, -220.0 / 30.0, "millimetres");
    close(millimetres.follower.gravity, 9810.0, "gravity");
    close(millimetres.follower.mass, 0.11, "mass");
    // It stays when the stiffness is another, and goes with the lowest lift.
    let stiffer = metres.with_number("follower.stiffness", 60_000.0).unwrap();
    close(stiffer.follower.rest_position, -220.0 / 60_000.0, "stiffer");
    let higher = metres.with_number("cam.base", 0.5).unwrap();
    close(higher.follower.rest_position, 0.5 - 220.0 / 30_000.0, "higher");
    let pounds =
        "[units]\nlength = \"in\"\nmass = \"lb\"\nstiffness = \"lbf/in\"\nforce = \"lbf\"\ndamping = \"lbf s/in\"\n";
    let pounds = Model::parse("valve.toml", &valve(pounds, ["0.25", "170", "preload = 50", "0.4"])).unwrap();
    close(pounds.follower.rest_position, -50.0 / 170.0, "inches");
    // 1 lbf/in = 4.4482216152605 N / 0.0254 m
    close(pounds.follower.stiffness, 170.0 * 4.448_221_615_260_5 / 0.025_4, "lbf/in");
    close(pounds.follower.damping, 3.0 * 4.448_221_615_260_5 / 0.025_4, "lbf s/in");
    close(pounds.follower.gravity, 9.81 / 0.025_4, "in/s^2");
}

/// On every law, and where the lowest lift is inside a segment.
#[test]
fn the_lowest_lift_is_found() {
    for (file, lowest) in [
        ("models/osorio-2008.toml", 0.4),
        ("models/laws/rectified-sine.toml", f64::NAN),
        ("models/laws/harmonic.toml", f64::NAN),
        ("models/laws/polynomial.toml", f64::NAN),
        ("models/laws/table-quintic.toml", f64::NAN),
    ] {
        let cam = common::cam(&common::read(&Path::new(common::ROOT).join(file)));
        let found = cam.lowest();
        let seen = (0..200_000).map(|index| cam.lift(f64::from(index) * std::f64::consts::TAU / 200_000.0).value);
        let seen = seen.fold(f64::INFINITY, f64::min);
        assert!(found.value <= seen && seen - found.value < 1e-9, "{file}: {} {seen}", found.value);
        assert!(lowest.is_nan() || (found.value - lowest).abs() < 1e-15, "{file}: {}", found.value);
    }
}

/// An angle on the command line is in radians, or says that it is in degrees.
#[test]
fn angles_may_be_given_in_degrees() {
    let model = valve("", ["0.11", "30000", "preload = 220", "0.01"]);
    let after = |angle: &str| {
        let strobe = format!("--strobe={angle}");
        printed(&model, "simulate", &["--rpm", "4500", "--revolutions", "2", &strobe, "--strobe-out", "-"])
    };
    let quarter = std::f64::consts::FRAC_PI_2.to_string();
    assert_eq!(after("90deg"), after(&quarter));
    assert_ne!(after("90deg"), after("90"));
    let said = |angle: &str| text(corner_impact(["simulate", "--rpm", "673", "--start-angle", angle]).stderr);
    assert!(said("90").contains(
        "note: --start-angle: 90 rad is more than a turn and means 116.6202 deg; for degrees, write 90deg\n"
    ));
    assert!(!said("90deg").contains("--start-angle") && !said("6.28").contains("--start-angle"));
}

/// One note for each machine that nobody has, and none for those that somebody has.
#[test]
fn numbers_that_are_odd_are_asked_about() {
    let spoken = |numbers: [&str; 4], units: &str, rpm: &str| {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("valve.toml");
        std::fs::write(&file, valve(units, numbers)).unwrap();
        let output =
            program(["simulate", file.to_str().unwrap(), "--rpm", rpm, "--revolutions", "1"]).output().unwrap();
        text(output.stderr)
    };
    let soft = "note: stiffness 30 with mass 0.11: did you mean N/mm? [units] sets the units of the numbers\n";
    assert_eq!(spoken(["0.11", "30", "preload = 220", "0.01"], "", "3000"), soft);
    assert_eq!(spoken(["0.11", "30", "rest_position = -0.0073", "0.01"], "", "4000"), soft);
    assert_eq!(spoken(["0.11", "30", "rest_position = -0.0073", "0.01"], "", "200"), "");
    assert!(
        spoken(["0.11", "30000", "rest_position = -7.3", "25"], "", "3000").contains("rises by 25 m: did you mean mm?")
    );
    // A spring whose period is a twentieth of what the cam's is, in the units that it seems to be in.
    assert_eq!(spoken(["0.11", "30", "rest_position = -0.0073", "0.01"], "", "3000"), soft);
    assert!(spoken(["0.11", "30000", "preload = 5000", "0.01"], "", "3000").contains("4633 times the weight"));
    assert!(spoken(["0.11", "30000", "preload = 22000", "0.01"], "", "3000").contains("times the weight of mass 0.11"));
    assert_eq!(spoken(["0.11", "30000", "preload = 220", "0.01"], "", "3000"), "");
    assert_eq!(
        spoken(["0.11", "30", "preload = 220", "10"], "[units]\nlength = \"mm\"\nstiffness = \"N/mm\"\n", "3000"),
        ""
    );
    // What one unit says of the others: nothing.
    let spring = spoken(["0.11", "30", "preload = 220", "10"], "[units]\nlength = \"mm\"\n", "3000");
    assert_eq!(spring, soft);
    let mass = spoken(["110", "30", "preload = 22", "10"], "[units]\nlength = \"mm\"\nstiffness = \"N/mm\"\n", "3000");
    assert_eq!(mass, "");
    let heavy = ["0.11", "30", "preload = 22000", "10"];
    let mass = spoken(heavy, "[units]\nlength = \"mm\"\nstiffness = \"N/mm\"\nforce = \"N\"\n", "3000");
    assert!(mass.contains("22000 N, 20387 times the weight of mass 0.11: is it in kg?"), "{mass}");
    // Units that are said, and others meant.
    let spring =
        spoken(["0.11", "30", "preload = 220", "10"], "[units]\nlength = \"mm\"\nstiffness = \"N/m\"\n", "3000");
    assert!(
        spring.contains("by 7333.3333 mm, 733 times as far as the lift rises: is its stiffness in N/m?"),
        "{spring}"
    );
    let lift =
        spoken(["0.11", "30", "preload = 220", "10000"], "[units]\nlength = \"mm\"\nstiffness = \"N/mm\"\n", "3000");
    assert!(lift.contains("rises by 10000 mm: is it in the unit that is said?"), "{lift}");
    for file in common::model_files() {
        assert_eq!(common::read(&file).doubt(None).unwrap(), None, "{}", file.display());
    }
}

#[test]
fn units_that_make_no_sense_are_told() {
    let wrong = |units: &str, spring: &str| {
        let model = valve(units, ["0.11", "30000", spring, "0.01"]);
        Model::parse("valve.toml", &model).unwrap_err().to_string()
    };
    let preload = "preload = 220";
    for (units, spring, says) in [
        ("[units]\nlength = \"mmm\"\n", preload, "units.length = \"mmm\": must be one of: \"m\", \"cm\""),
        ("[units]\nstiffness = \"mm/N\"\n", preload, "must be a force over a length, such as N/mm"),
        ("[units]\ndamping = \"N/mm\"\n", preload, "must be a force times s over a length"),
        ("[units]\ngravity = \"mm/s\"\n", preload, "must be a length over s^2"),
        ("[units]\nmas = \"g\"\n", preload, "unknown field"),
        ("[units]\nmass = \"t\"\n", "preload = -1", "follower.preload = -1: must be a finite number, 0 or more"),
        ("", "preload = 1\nrest_position = 0", "must not be given together with follower.rest_position"),
        ("", "", "follower.rest_position is missing"),
        ("", "", "; or give follower.preload, the force of the spring where the lift is lowest"),
    ] {
        let told = wrong(units, spring);
        assert!(told.contains(says), "{told}");
    }
    // A rest position that is there is only wrong.
    let stiff = wrong("", "rest_position = \"stiff\"");
    assert!(stiff.contains("rest_position = \"stiff\"") && !stiff.contains("or give"), "{stiff}");
    let loose = valve("", ["0.11", "0", preload, "0.01"]);
    assert!(Model::parse("v.toml", &loose).unwrap_err().to_string().contains("follower.stiffness is 0"));
    let heavy = valve("[units]\nmass = \"t\"\n", ["1e308", "1", preload, "0.01"]);
    assert!(Model::parse("v.toml", &heavy).unwrap_err().to_string().contains("too large"));
    let output = corner_impact(["cam", "models/osorio-2008.toml", "--set", "preload=3"]);
    assert_eq!(output.status.code(), Some(2));
}

/// A length of the model that is typed in another unit of length is converted to the file's.
#[test]
fn lengths_are_converted_to_the_unit_of_the_file() {
    let of =
        |units: &str| Model::parse("valve.toml", &valve(units, ["0.11", "30000", "preload = 220", "0.01"])).unwrap();
    let [metres, inches] = ["", "[units]\nlength = \"in\"\n"].map(|units| of(units).units);
    for path in ["follower.rest_position", "cam.base_radius"] {
        assert_eq!(metres.in_own(path, 400.0, "mm"), Some(0.4), "{path}");
        assert_eq!(inches.in_own(path, 508.0, "mm"), Some(20.0), "{path}");
        assert_eq!(metres.in_own(path, 1.0, "kg"), None, "{path}");
    }
}
