//! Have readings of tables moved, and what is said of those and of models that are refused? In snapshots; that a sentence helps is for
//! other files.

use std::fmt::Write;

use corner_impact::cam::Cam;
use corner_impact::model::{CamProfile, Model};

use crate::common;
use crate::orbit_numbers::is_as_it_was;

const FOLLOWER: &str =
    "[follower]\nmass = 1\ndamping = 0\nstiffness = 1\ngravity = 0\nrest_position = 0\nrestitution = 1\n";

/// What is understood of a model beside a table, or what is said of the two.
fn told(model: &str, table: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("model.toml");
    std::fs::write(folder.path().join("lift.csv"), table).unwrap();
    std::fs::write(&file, model).unwrap();
    let place = format!("{}/", folder.path().display());
    let model = match Model::read(&file) {
        Ok(model) => model,
        Err(error) => return error.to_string().replace(&place, ""),
    };
    let mut text = match &model.cam {
        CamProfile::Table(table) => {
            let reading = serde_json::to_string(&*table.reading).unwrap();
            let rows: Vec<_> = table.rows.iter().map(|row| format!("{:.6}:{:.6e}", row.angle_deg, row.lift)).collect();
            let [one, two, .., last] = rows.as_slice() else { panic!("{rows:?}") };
            format!("{reading} {one} {two} .. {last} {:?}", table.spline)
        }
        _ => model.numbers().map(|(name, value)| format!("{name} = {value}; ")).collect(),
    };
    if let Err(error) = Cam::new(&model) {
        write!(text, "\n  {error}").unwrap();
    }
    text.replace(&place, "")
}

/// A table of twelve rows, each angle and lift written in the unit's own way.
fn rows(angle: impl Fn(f64) -> String, lift: impl Fn(f64) -> String, between: &str) -> String {
    let row = |index: u32| {
        let degrees = 30.0 * f64::from(index);
        let height = (100.0 * (1.0 - degrees.to_radians().cos())).round() / 100.0;
        format!("{}{between}{}\n", angle(degrees), lift(height))
    };
    (0..12).map(row).collect()
}

fn plain(number: f64) -> String {
    number.to_string()
}

fn comma(number: f64) -> String {
    number.to_string().replace('.', ",")
}

#[test]
fn tables_are_read_as_they_were() {
    let even = rows(plain, plain, ",");
    let closed = format!("{even}360,0\n");
    let cases: Vec<String> = [
        ("angle_deg,lift\n", even.clone()),
        ("angle,lift [mm]\n", closed.clone()),
        ("θ [deg],s (µm)\n", even.clone()),
        ("angle,lift um\n", even.clone()),
        ("angle,m\n", even.clone()),
        ("crank;lift mm\n", rows(plain, comma, ";")),
        ("crank;lift mm;\n", rows(plain, |lift| comma(lift) + ";", ";")),
        ("", rows(plain, plain, "\t")),
        ("", rows(plain, comma, "\t")),
        ("", rows(plain, plain, "  ")),
        ("", rows(plain, comma, " ")),
        ("", rows(plain, |lift| format!(" {lift}"), ",")),
        ("angle_rad,lift\n", rows(|angle| angle.to_radians().to_string(), plain, ",")),
        ("alpha (rad) lift (cm)\n", rows(|angle| angle.to_radians().to_string(), plain, " ")),
        ("# of a drawing\nangle,lift % mm\n", even.clone()),
        ("", rows(|angle| plain(angle - 180.0), plain, ",")),
        ("", rows(|angle| plain((angle + 200.0) % 360.0), plain, ",")),
        ("", rows(plain, |lift| format!("{}", 0.25 + lift), ",")),
        ("", rows(plain, |lift| format!("{}", 50.0 * lift), ",")),
        ("", rows(plain, |lift| format!("{}e20", 0.1 + lift), ",")),
        ("", rows(plain, |lift| format!("{}", (1.0 + lift) / 3.0), ",")),
        ("", rows(plain, |_| "0".into(), ",")),
        ("", rows(plain, |_| "0.007".into(), ",")),
        ("", rows(plain, |lift| plain(1000.0 * lift), ",")),
        ("", rows(plain, |lift| plain(5000.0 * lift), ",")),
        ("", rows(plain, |_| "0".into(), ",") + "360,0\n"),
        // A turn is as long as its digits say: so near to it, the last row is the first one again.
        ("", format!("{even}360.1,0\n")),
        // The next turn, up to the first row.
        ("", format!("{even}-20,0.01\n")),
        // Refused.
        ("", rows(|angle| angle.to_radians().to_string(), plain, ",")),
        ("", rows(|angle| plain(angle / 2.0), plain, ",")),
        ("", rows(|angle| plain(angle / 3.0), plain, ",")),
        ("", (0..=54).map(|row| format!("{},1\n", 5 * row)).collect()),
        ("", "0,1\n10,2\n20,1\n".into()),
        ("", "0,1\n90,2\n180,3\n".into()),
        ("", "0,1\n180,2\n200,1\n".into()),
        ("", format!("{even}360,0.01\n")),
        ("", format!("{even}361,0.01\n")),
        ("", format!("{even}20,0.01\n")),
        ("", format!("{even}329,0.01\n")),
        ("", format!("{even}330,0.01\n")),
        ("", "300,1\n90,2\n180,3\n100,1\n".into()),
        ("", "300.1,1\n0.1,2\n180.3,3\n180.2,1\n".into()),
        ("", "300,1\n-70,2\n100,1\n".into()),
        ("angle\n", "0\n".into()),
        ("angle,angle\n", even.clone()),
        ("speed,lift\n", even.clone()),
        ("deg,\n", even.clone()),
        ("angle [grad],lift [furlong]\n", even.clone()),
        ("angle [h],lift\n", even.clone()),
        ("", "1;2,5\n2;3.5\n3;4\n".into()),
        ("", "1;2.5\n2;3,5\n3;4\n".into()),
        ("", "1,5 2,\n2 3\n".into()),
        ("", "1 2 3\n2 3 4\n".into()),
        ("", "-1,+2\n.5,3\n".into()),
    ]
    .map(|(header, rows)| format!("{header}{rows}"))
    .into();
    let cam = "[cam]\nlaw = \"table\"\nfile = \"lift.csv\"\nspline = \"cubic\"\n";
    let mut text = String::new();
    for table in cases {
        let lines: Vec<&str> = table.lines().collect();
        let label = [lines[0], lines[1.min(lines.len() - 1)], "..", lines[lines.len() - 1]];
        writeln!(text, "{}\n  {}", label.join(" / "), told(&format!("{FOLLOWER}{cam}"), &table)).unwrap();
    }
    is_as_it_was("told-of-tables", &text);
}

#[test]
fn fields_beside_a_table_are_read_as_they_were() {
    let even = rows(plain, plain, ",");
    let mut text = String::new();
    for fields in [
        "spline = \"quintic\"\nunit = \"mm\"",
        "spline = \"cubic\"\nangle_unit = \"rad\"",
        "spline = \"smoothing\"\ntolerance = 0.005",
        "spline = \"smoothing\"\ntolerance = 0.0049",
        "spline = \"smoothing\"\ntolerance = \"auto\"\ncorners_deg = []\ndwells_deg = []",
        "spline = \"smoothing\"\ntolerance = \"none\"",
        "spline = \"smoothing\"\ncorners_deg = [-30, 270, 330, 90]",
        "spline = \"smoothing\"\ndwells_deg = [[100, 200], [340, 20]]",
        "spline = \"smoothing\"\ndwells_deg = [[340, 20], [100, 200]]\ncorners_deg = [100, 20, 60]",
        "spline = \"smoothing\"\ndwells_deg = [[340, 20]]\ncorners_deg = [0]",
        "spline = \"smoothing\"\ndwells_deg = [[100, 200], [200, 220]]",
        "spline = \"smoothing\"\ndwells_deg = [[100, 200], [180, 220]]",
        "spline = \"smoothing\"\ndwells_deg = [[300, 20], [10, 40]]",
        "spline = \"smoothing\"\ndwells_deg = [[300, 300]]",
        "spline = \"smoothing\"\ndwells_deg = [[0, inf]]",
        "spline = \"smoothing\"\ndwells_deg = [[nan, 3]]",
        "spline = \"linear\"",
        "unit = \"mm\"",
        "spline = \"cubic\"\nrows = [[0, 1], [120, 2], [240, 1]]",
    ] {
        let model = format!("{FOLLOWER}[cam]\nlaw = \"table\"\nfile = \"lift.csv\"\n{fields}\n");
        writeln!(text, "{}\n  {}", fields.replace('\n', "; "), told(&model, &even)).unwrap();
    }
    // Five degrees of a turn, in either unit: only of degrees may radians be meant.
    for unit in ["deg", "rad"] {
        let model = format!(
            "{FOLLOWER}[cam]\nlaw = \"table\"\nfile = \"lift.csv\"\nspline = \"cubic\"\nangle_unit = \"{unit}\"\n"
        );
        let narrow = format!("angle_{unit},lift\n0,1\n0.02,2\n0.04,2\n0.06,1\n0.08,1\n");
        writeln!(text, "five rows in {unit}\n  {}", told(&model, &narrow)).unwrap();
    }
    for rows in [
        "[[0, 1], [120, 2], [240, 1]]",
        "[[0, 1], [120, 2], [240, 1], [360, 1]]",
        "[[0, 1], [120, nan], [240, 1]]",
        "[[0, 1], [inf, 2], [240, 1]]",
        "[[0, 1], [120, 2], [110, 1]]",
        "[[0, 1], [120, 2]]",
        "[[0, 1], [120, 2], [240]]",
        "[]",
        "3",
        "[1, 2, 3]",
    ] {
        let model = format!("{FOLLOWER}[cam]\nlaw = \"table\"\nspline = \"cubic\"\nrows = {rows}\n");
        writeln!(text, "rows = {rows}\n  {}", told(&model, "")).unwrap();
        let model = format!("{FOLLOWER}[cam]\nlaw = \"table\"\nspline = \"smoothing\"\nrows = {rows}\n");
        writeln!(text, "  smoothing: {}", told(&model, "")).unwrap();
    }
    is_as_it_was("told-of-fields-beside-tables", &text);
}

#[test]
fn what_is_said_of_models_is_what_it_was() {
    let long = |count: usize| "n".repeat(count);
    let osorio = common::osorio_text(&[]);
    let polynomial = "[cam]\nlaw = \"polynomial\"\n[[cam.segment]]\nstart_deg = 0\ncoefficients = ";
    let mut text = String::new();
    for (what, model) in [
        ("a name of a thousand", format!("name = \"{}\"\n{FOLLOWER}[cam]\nlaw = \"harmonic\"\n", long(1000))),
        ("a name of a thousand and one", format!("name = \"{}\"\n{FOLLOWER}", long(1001))),
        ("a name that is a number", format!("name = 3\n{FOLLOWER}")),
        ("no table", "mass = 1\n".into()),
        ("a table mistyped", osorio.replace("[follower]", "[folower]")),
        ("two tables mistyped", osorio.replace("[follower]", "[folower]").replace("[cam]", "[camm]")),
        ("a field mistyped", osorio.replace("restitution =", "restitutoin =")),
        ("a field of another table", osorio.replace("mass =", "amplitude =")),
        ("a field in quotes", osorio.replace("mass =", "\"follower.mass\" =")),
        ("a field twice", osorio.replace("mass =", "mass = 2\nmass =")),
        ("a field too many", osorio.replace("mass =", "colour = 3\nmass =")),
        ("a table too many", format!("{osorio}\n[motor]\npower = 3\n")),
        ("a table for a number", osorio.replace("mass =", "mass = {}\nmasses =")),
        ("a list for a number", osorio.replace("mass =", "mass = [1, 2]\nmasses =")),
        ("a text for a number", osorio.replace("mass =", "mass = \"1\"\nmasses =")),
        ("a number too large", osorio.replace("mass =", "mass = 1e999\nmasses =")),
        ("a law mistyped", osorio.replace("law = \"", "law = \"x")),
        ("no law", format!("{FOLLOWER}[cam]\nbase = 1\n")),
        ("no coefficients", format!("{FOLLOWER}{polynomial}[]\n")),
        ("a coefficient that is text", format!("{FOLLOWER}{polynomial}[1, \"2\"]\n")),
        ("no list", format!("{FOLLOWER}{polynomial}1\n")),
        ("a segment that is none", format!("{FOLLOWER}[cam]\nlaw = \"polynomial\"\nsegment = [1, 2]\n")),
        ("a segment that is no list", format!("{FOLLOWER}[cam]\nlaw = \"polynomial\"\nsegment = 1\n")),
        ("a segment with a field too many", format!("{FOLLOWER}{polynomial}[1]\nspan = 3\n")),
        ("a segment mistyped", format!("{FOLLOWER}{}[1]\n", polynomial.replace("cam.segment", "cam.segmemt"))),
        (
            "amplitudes of another number",
            format!("{FOLLOWER}[cam]\nlaw = \"harmonic\"\noffset = 1\namplitudes = [1]\nphases_deg = [1, 2]\n"),
        ),
        ("a unit that is none", format!("{osorio}\n[units]\nlength = \"inch\"\nmas = \"kg\"\n")),
        ("units that is no table", format!("units = 3\n{osorio}")),
    ] {
        writeln!(text, "{what}\n  {}", told(&model, "")).unwrap();
    }
    is_as_it_was("told-of-models", &text);
}

/// Numbers that are changed after others take their place, and leave the others; a name tells each once.
#[test]
fn a_number_that_is_changed_twice_has_its_last_value() {
    let set = |name: &str, value: f64| vec![(name.to_owned(), value)];
    let once = common::osorio().changed(&set("damping", 0.5)).unwrap().changed(&set("mass", 2.0)).unwrap();
    let twice = once.changed(&set("follower.mass", 3.0)).unwrap();
    assert_eq!(twice.changes(), [("follower.damping".to_owned(), 0.5), ("follower.mass".to_owned(), 3.0)]);
    assert_eq!((twice.follower.mass, twice.follower.damping), (3.0, 0.5));
}

/// A speed is no number of the follower or the cam.
#[test]
fn a_number_of_another_table_has_no_path() {
    let model = common::osorio();
    assert_eq!(model.path_of("mass", &[]).unwrap(), "follower.mass");
    for name in ["rpm_min", "study.rpm_min"] {
        let refused = model.path_of(name, &[]).unwrap_err().to_string();
        assert!(refused.contains("is not a number of this model"), "{refused}");
    }
    assert!(model.numbers().all(|(path, _)| path.starts_with("follower.") || path.starts_with("cam.")));
}

/// `foll.er` is two letters from `follower`, but a field, and not a table with a slip in its name.
#[test]
fn a_field_is_not_taken_for_a_table_that_is_missing() {
    let said = told("[foll]\ner = 1\n", "");
    assert!(said.contains("follower.mass is missing") && !said.contains("did you mean"), "{said}");
}
