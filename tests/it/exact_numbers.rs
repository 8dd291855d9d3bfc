//! Do proofs get the decimals that are written, with all their digits and in the units that they are in?

use corner_impact::model::{CamProfile, Model, Numeral, finite};
use serde_json::{Value, json};

const FOLLOWER: &str =
    "mass = 1.0\ndamping = 0.0\nstiffness = 100.0\ngravity = 9.81\nrest_position = 0.3\nrestitution = 0.5\n";
const CAM: &str = "law = \"harmonic\"\noffset = 0.1\namplitudes = [0.02]\nphases_deg = [0.0]\n";

fn exact(head: &str, follower: &str, cam: &str) -> Value {
    let text = format!("name = \"exact\"\n{head}[follower]\n{follower}[cam]\n{cam}");
    Model::parse("exact.toml", &text).unwrap().exact()
}

/// Numbers in lists and in tables of a list have more digits than a double has, and keep them.
#[test]
fn numbers_in_lists_keep_all_their_digits() {
    let (one, two, phase) =
        ("0.0200000000000000000000012345", "-0.00100000000000000000000678", "30.00000000000000000000009");
    let cam = format!(
        "law = \"harmonic\"\noffset = 0.1000000000000000000000321\namplitudes = [{one}, {two}]\nphases_deg = [{phase}, 0.0]\n"
    );
    let told = exact("", FOLLOWER, &cam);
    assert_eq!(told["cam"]["amplitudes"], json!([one, two]));
    assert_eq!(told["cam"]["phases_deg"], json!([phase, "0.0"]));
    assert_eq!(told["cam"]["offset"], "0.1000000000000000000000321");
    assert_eq!(told["cam"]["law"], "harmonic");
    let segment = |start: &str, coefficients: &str| {
        format!("[[cam.segment]]\nstart_deg = {start}\ncoefficients = [{coefficients}]\n")
    };
    let (first, second) = ("0.03000000000000000000000077", "1e-22");
    let segments = segment("0", first) + &segment("90.0000000000000000000000004", &format!("{first}, 0, {second}"));
    let told = exact("", FOLLOWER, &format!("law = \"polynomial\"\n{segments}"));
    assert_eq!(told["cam"]["segment"][0]["coefficients"], json!([first]));
    assert_eq!(told["cam"]["segment"][1]["coefficients"], json!([first, "0", second]));
    assert_eq!(told["cam"]["segment"][1]["start_deg"], "90.0000000000000000000000004");
}

/// TOML allows a sign and marks between digits, and whole numbers to other bases, which no decimal has.
#[test]
fn numbers_are_decimals_however_toml_has_them() {
    for (written, decimal) in [
        ("1_430.800_000_000_000_000_000_01", "1430.80000000000000000001"),
        ("+1430.8", "1430.8"),
        ("0x10", "16.0"),
        ("0b101", "5.0"),
        ("1.4308e3", "1.4308e3"),
        ("1431", "1431"),
    ] {
        let told = exact("", &FOLLOWER.replace("stiffness = 100.0", &format!("stiffness = {written}")), CAM);
        assert_eq!(told["follower"]["stiffness"], decimal);
    }
}

/// The quotient of whole numbers takes each number to kg, N/m and the file's unit of length: a pound is 0.45359237 kg, and 1 kN is 10^6 kg mm/s^2.
#[test]
fn numbers_in_other_units_are_decimals_times_a_quotient() {
    let units = "[units]\nlength = \"mm\"\nmass = \"lb\"\nstiffness = \"N/mm\"\nforce = \"kN\"\n";
    let follower = FOLLOWER.replace("rest_position = 0.3", "preload = 0.14308000000000000000001");
    let cam = CAM.replace("0.02", "20.00000000000000000000003");
    let told = exact(units, &follower.replace("mass = 1.0", "mass = 1.22100000000000000000000123"), &cam);
    let follower = &told["follower"];
    assert_eq!(follower["mass"], "1.22100000000000000000000123 * 45359237/100000000");
    assert_eq!(follower["restitution"], "0.5");
    assert_eq!(follower["rest_position"], Value::Null);
    for (name, decimal, quotient) in [("stiffness", "100.0", 1e3), ("preload", "0.14308000000000000000001", 1e6)] {
        let (number, by) = follower[name].as_str().unwrap().split_once(" * ").unwrap();
        let (above, below) = by.split_once('/').unwrap();
        assert_eq!(number, decimal);
        assert_eq!(above.parse::<f64>().unwrap() / below.parse::<f64>().unwrap(), quotient, "{name}");
    }
    // Lengths stay in the file's unit.
    assert_eq!(told["cam"]["amplitudes"], json!(["20.00000000000000000000003"]));
}

/// Beside a number that is another one its text says nothing.
#[test]
fn a_number_that_is_set_has_the_digits_that_it_is_set_with() {
    let model = Model::parse("exact.toml", &format!("name = \"exact\"\n[follower]\n{FOLLOWER}[cam]\n{CAM}")).unwrap();
    for (number, text, decimal) in [
        (1.221, "1.22100000000000000000000123", "1.22100000000000000000000123"),
        (2.5, "3.75", "2.5"),
        (2.5, "much", "2.5"),
        (2.5, " +2.50 ", "2.50"),
    ] {
        let changed = model.changed(&[("mass".to_owned(), Numeral { number, text: text.into() })]).unwrap();
        assert_eq!(changed.exact()["follower"]["mass"], decimal);
        assert_eq!(changed.exact()["cam"], model.exact()["cam"]);
    }
    let changed = model.changed(&[("mass".to_owned(), 0.1 + 0.2)]).unwrap();
    assert_eq!(changed.exact()["follower"]["mass"], "0.30000000000000004");
    // In digits as long as these can be counted.
    let text = |number: f64| Numeral::from(number).text;
    assert_eq!(
        [1e6, 0.25, 1e23, 1e24, 1e-30].map(text),
        ["1000000", "0.25", "100000000000000000000000", "1e24", "1e-30"]
    );
}

/// Rows of measured lifts, in the model's unit of length or in another one.
#[test]
fn rows_of_a_table_keep_their_digits() {
    let lifts = [
        "0.00000000000000000000000",
        "1.00000000000000000000002",
        "2.00000000000000000000003",
        "1.00000000000000000000005",
    ];
    let rows = |by: &str| {
        let rows =
            lifts.iter().enumerate().map(|(index, lift)| format!("[{}.000000000000000000007, {lift}]", 90 * index));
        format!("law = \"table\"\n{by}spline = \"cubic\"\nrows = [{}]\n", rows.collect::<Vec<_>>().join(", "))
    };
    let head = "[units]\nlength = \"mm\"\n";
    let told = exact(head, FOLLOWER, &rows(""));
    let angle = |index: usize| format!("{}.000000000000000000007", 90 * index);
    let expected: Vec<Value> =
        lifts.iter().enumerate().map(|(index, lift)| json!({ "angle_deg": angle(index), "lift": lift })).collect();
    assert_eq!(told["cam"]["rows"], json!(expected));
    // An inch is 25.4 mm.
    let told = exact(head, FOLLOWER, &rows("unit = \"in\"\n"));
    for (row, lift) in told["cam"]["rows"].as_array().unwrap().iter().zip(lifts) {
        let (number, by) = row["lift"].as_str().unwrap().split_once(" * ").unwrap();
        let (above, below) = by.split_once('/').unwrap();
        assert_eq!((number, above.parse::<f64>().unwrap() / below.parse::<f64>().unwrap()), (lift, 25.4));
    }
    assert_eq!(told["cam"]["rows"].as_array().unwrap().len(), 4);
    // Of angles in radians no row is written in degrees: the doubles are there as they are.
    let turned = "law = \"table\"\nangle_unit = \"rad\"\nspline = \"cubic\"\nrows = [[0.0, 0.25], [1.6, 1.0], [3.2, 2.0], [4.8, 1.0]]\n";
    let told = exact(head, FOLLOWER, turned);
    let numbers = |of: &str| -> Vec<f64> {
        let number = |row: &Value| row[of].as_f64().or_else(|| row[of].as_str()?.parse().ok()).unwrap();
        told["cam"]["rows"].as_array().unwrap().iter().map(number).collect()
    };
    assert_eq!(numbers("lift"), [0.25, 1.0, 2.0, 1.0]);
    assert_eq!(numbers("angle_deg"), [0.0, 1.6, 3.2, 4.8].map(f64::to_degrees));
}

/// A table in a file of its own keeps the decimals of its rows as well, whatever its columns are parted by and its decimals are written with.
#[test]
fn rows_of_a_file_keep_their_digits() {
    let folder = tempfile::tempdir().unwrap();
    let lifts = ["0.10000000000000000000001", "0.20000000000000000000003", "0.30000000000000000000007"];
    let angle = |index: usize| format!("{}.000000000000000000009", 120 * index);
    for (separator, point) in [(",", "."), (";", "."), (";", ",")] {
        let row = |(index, lift): (usize, &&str)| format!("{}{separator}{lift}\n", angle(index)).replace('.', point);
        let rows: String = lifts.iter().enumerate().map(row).collect();
        std::fs::write(folder.path().join("lift.csv"), format!("angle_deg{separator}lift\n{rows}")).unwrap();
        let file = folder.path().join("exact.toml");
        let cam = "law = \"table\"\nspline = \"cubic\"\nfile = \"lift.csv\"\n";
        std::fs::write(&file, format!("name = \"exact\"\n[follower]\n{FOLLOWER}[cam]\n{cam}")).unwrap();
        let told = Model::read(&file).unwrap().exact();
        let expected: Vec<Value> =
            lifts.iter().enumerate().map(|(index, lift)| json!({ "angle_deg": angle(index), "lift": lift })).collect();
        assert_eq!(told["cam"]["rows"], json!(expected), "{separator} {point}");
    }
}

/// Digits are kept of numbers that are written otherwise, and of parts of a unit.
#[test]
fn rows_in_parts_of_a_unit_keep_their_digits() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("exact.toml");
    let text = |cam: &str| {
        format!(
            "name = \"exact\"\n[units]\nlength = \"mm\"\n[follower]\n{FOLLOWER}[cam]\nlaw = \"table\"\nspline = \"cubic\"\n{cam}"
        )
    };
    let expected = json!([
        { "angle_deg": "0", "lift": "1083.00000000000000000000001e-2" },
        { "angle_deg": "120", "lift": "5e-3" },
        { "angle_deg": "240", "lift": "7.5e-3" },
    ]);
    let csv = "angle;lift [1/100 mm]\n0°;1'083.00000000000000000000001\n120 °;5D-1\n240°;7.5e-1\n";
    std::fs::write(folder.path().join("lift.csv"), csv).unwrap();
    std::fs::write(&file, text("file = \"lift.csv\"\n")).unwrap();
    let model = Model::read(&file).unwrap();
    assert_eq!(model.exact()["cam"]["rows"], expected);
    let rows = text("unit = \"0.01 mm\"\nrows = [[0, 1083.00000000000000000000001], [120, 5e-1], [240, 7.5e-1]]\n");
    let same = Model::parse("exact.toml", &rows).unwrap();
    assert_eq!(same.exact()["cam"]["rows"], expected);
    assert_eq!(same.table().unwrap().rows.iter().map(|row| row.lift).collect::<Vec<_>>(), [10.83, 0.005, 0.0075]);
}

/// A table of as many rows as proofs are of keeps its digits, with the first row told again at the end of the turn.
#[test]
fn a_thousand_rows_and_the_first_again_keep_their_digits() {
    let row = |index: u32| {
        let (angle, lift) = (36 * index, index.min(1000 - index));
        (format!("{}.{:02}", angle / 100, angle % 100), format!("0.1{lift:03}0000000000000000000001"))
    };
    let rows: Vec<String> = (0..=1000).map(row).map(|(angle, lift)| format!("[{angle}, {lift}]")).collect();
    let cam = format!("law = \"table\"\nspline = \"cubic\"\nrows = [{}]\n", rows.join(", "));
    let told = exact("", FOLLOWER, &cam);
    let expected: Vec<Value> =
        (0..1000).map(row).map(|(angle, lift)| json!({ "angle_deg": angle, "lift": lift })).collect();
    assert_eq!(told["cam"]["rows"], json!(expected));
}

/// A number that the program has changed since is the double that it is now, not what the file says.
#[test]
fn a_changed_number_is_its_double() {
    let text = format!("name = \"exact\"\n[follower]\n{FOLLOWER}[cam]\n{CAM}");
    let mut model = Model::parse("exact.toml", &text).unwrap();
    model.follower.mass = 0.1;
    let told = model.exact();
    assert_eq!((&told["follower"]["mass"], &told["follower"]["stiffness"]), (&json!("0.1"), &json!("100.0")));
}

/// A pure number has no unit, so that no unit is proposed where a word follows it.
#[test]
fn a_pure_number_stands_alone() {
    assert_eq!(finite(" 0.5 ", ""), Ok(0.5));
    assert_eq!(finite("0.5 kg", "kg"), Ok(0.5));
    let [pure, of_mass] = [("0.5 x", ""), ("0.5 x", "kg")].map(|(text, unit)| finite(text, unit).unwrap_err());
    assert_eq!(pure, "\"0.5 x\" is more than a number: write the number alone, in the unit of the model");
    assert_eq!(of_mass, "\"0.5 x\" is not in kg: write 0.5, or 0.5 kg, if that is meant");
}

/// However a table gives its rows, proofs get the rows of the cam: half a lobe with its mirror image, the open part with the base circle, angles
/// that fall, or a row that is written twice.
#[test]
fn rows_of_a_table_are_those_of_its_cam() {
    let lift = |degrees: i32| 4.1 * (1.0 - f64::from(degrees).to_radians().cos());
    let rows = |degrees: &[i32]| -> Vec<String> {
        degrees.iter().map(|degrees| format!("[{degrees}.0, {:.2}0]", lift(*degrees))).collect()
    };
    let (turn, half) =
        ((0..12).map(|row| 30 * row).collect::<Vec<_>>(), (0..=6).map(|row| 30 * row).collect::<Vec<_>>());
    let twice: Vec<i32> = [&turn[..6], &turn[5..]].concat();
    let falling: Vec<i32> = turn.iter().rev().copied().collect();
    let late: Vec<i32> = turn.iter().map(|degrees| degrees + 90).collect();
    let open = [
        "[90.0, 0.0]",
        "[120.0, 0.01]",
        "[150.0, 2.5]",
        "[180.0, 4.1]",
        "[210.0, 2.5]",
        "[240.0, 0.01]",
        "[270.0, 0.0]",
    ];
    for (rows, fields, is_written) in [
        (rows(&turn), "", true),
        (rows(&late), "", true),
        (rows(&half), "mirrored = true\n", false),
        (open.map(str::to_owned).to_vec(), "outside = \"base\"\n", false),
        (rows(&falling), "", false),
        (rows(&twice), "", false),
    ] {
        let cam = format!("law = \"table\"\nspline = \"cubic\"\nunit = \"mm\"\n{fields}rows = [{}]\n", rows.join(", "));
        let text = format!("name = \"exact\"\n[follower]\n{FOLLOWER}[cam]\n{cam}");
        let model = Model::parse("exact.toml", &text).unwrap();
        let CamProfile::Table(table) = &model.cam else { panic!("{:?}", model.cam) };
        let exact = model.exact();
        let exact = exact["cam"]["rows"].as_array().unwrap();
        let number = |row: &Value, name: &str| {
            let text = row[name].as_str().unwrap();
            let (number, by) = text.split_once(" * ").unwrap_or((text, "1/1"));
            let [number, above, below] = [number, by.split_once('/').unwrap().0, by.split_once('/').unwrap().1]
                .map(|text| text.parse::<f64>().unwrap());
            number * above / below
        };
        let mut told: Vec<[f64; 2]> =
            exact.iter().map(|row| [number(row, "angle_deg").rem_euclid(360.0), number(row, "lift")]).collect();
        told.sort_by(|one, two| one[0].total_cmp(&two[0]));
        let of_cam: Vec<[f64; 2]> = table.rows.iter().map(|row| [row.angle_deg, row.lift]).collect();
        assert_eq!(told.len(), of_cam.len(), "{fields}{rows:?}");
        for (told, of_cam) in told.iter().zip(&of_cam) {
            assert!(
                (0..2).all(|part| (told[part] - of_cam[part]).abs() <= 1e-15 * of_cam[part].abs()),
                "{told:?} {of_cam:?}"
            );
        }
        // As it is written, with the zero at its end.
        let is_as_written = exact.iter().any(|row| row["lift"].as_str().unwrap().starts_with("8.200"));
        assert_eq!(is_as_written, is_written, "{fields}{exact:?}");
    }
}
