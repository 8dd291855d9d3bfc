//! Are the tables that gauges and other programs write read as they are meant, or refused with the line of the model that makes them read?

use std::fs;

use corner_impact::model::{CamProfile, Model, TableProfile};
use tempfile::TempDir;

use crate::common::{corner_impact, in_one_line, text};

/// Lift of an open duration from 120 to 240 degrees with its nose at 180, mm to four decimals.
pub(crate) fn lift(angle: f64) -> f64 {
    let from_nose = (angle.rem_euclid(360.0) - 180.0).abs();
    let lift = if from_nose < 60.0 { 4.0 * (1.0 + (3.0 * from_nose).to_radians().cos()) } else { 0.0 };
    (lift * 1e4).round() / 1e4
}

/// A row for each of these angles.
pub(crate) fn rows(angles: impl IntoIterator<Item = i32>, row: impl Fn(f64, f64) -> String) -> String {
    angles.into_iter().map(f64::from).map(|angle| row(angle, lift(angle)) + "\n").collect()
}

pub(crate) fn plain(angle: f64, lift: f64) -> String {
    format!("{angle},{lift:.4}")
}

/// A follower in millimetres on the cam of a table, with these fields beside it.
pub(crate) fn model(folder: &TempDir, table: &str, fields: &str) -> Result<Model, String> {
    model_of("table", folder, table, fields)
}

/// A follower on the cam of a table by this law: `table` or `contour`.
pub(crate) fn model_of(law: &str, folder: &TempDir, table: &str, fields: &str) -> Result<Model, String> {
    fs::write(folder.path().join("lift.csv"), table).unwrap();
    let text = format!(
        "name = \"read\"\n[units]\nlength = \"mm\"\nstiffness = \"N/mm\"\n[follower]\nmass = 0.1\ndamping = 0\nstiffness = 30\npreload = 220\n\
         gravity = 0\nrestitution = 0.5\n[cam]\nlaw = \"{law}\"\nfile = \"lift.csv\"\nspline = \"cubic\"\n{fields}\n"
    );
    let file = folder.path().join("read.toml");
    fs::write(&file, text).unwrap();
    Model::read(&file).map_err(|error| error.to_string())
}

pub(crate) fn table(model: &Model) -> &TableProfile {
    let CamProfile::Table(table) = &model.cam else { panic!("{:?}", model.cam) };
    table
}

/// Demands that a table with these fields is read as the lobe, `size` times as high in millimetres.
#[track_caller]
pub(crate) fn is_the_lobe(csv: &str, fields: &str, size: f64) -> Model {
    let folder = TempDir::new().unwrap();
    let model = model(&folder, csv, fields).unwrap_or_else(|words| panic!("{:?}: {words}", &csv[..60]));
    let rows = &table(&model).rows;
    assert!((170..=360).contains(&rows.len()), "{} rows", rows.len());
    for row in rows.iter() {
        let expected = size * lift(row.angle_deg);
        assert!((row.lift - expected).abs() <= 1e-4 * size.max(1.0), "{row:?}, not {expected}");
    }
    // What is written in its place is read alike.
    let again = Model::parse("again.toml", &model.text()).unwrap();
    assert_eq!(table(&again).rows.len(), rows.len());
    assert!(
        table(&again)
            .rows
            .iter()
            .zip(rows.iter())
            .all(|(one, two)| (one.angle_deg, one.lift) == (two.angle_deg, two.lift))
    );
    model
}

pub(crate) fn reading(csv: &str, fields: &str) -> serde_json::Value {
    let folder = TempDir::new().unwrap();
    serde_json::to_value(&*table(&model(&folder, csv, fields).unwrap()).reading).unwrap()
}

#[test]
fn text_is_read_however_it_is_written() {
    let all = || 0..360;
    let head = "angle [deg],lift [mm]\n";
    for csv in [
        head.to_owned() + &rows(all(), plain),
        "\"angle [deg]\",\"lift [mm]\"\n".to_owned() + &rows(all(), |angle, lift| format!("\"{angle}\",\"{lift:.4}\"")),
        "angle [deg];lift [mm]\n".to_owned()
            + &rows(all(), |angle, lift| format!("{angle};{lift:.4}").replace('.', ",")),
        "\"angle [deg]\",\"lift [mm]\"\n".to_owned()
            + &rows(all(), |angle, lift| format!("\"{angle}\",\"{}\"", format!("{lift:.4}").replace('.', ","))),
        "sep=;\nangle [deg];lift [mm]\n".to_owned() + &rows(all(), |angle, lift| format!("{angle};{lift:.4}")),
        "angle [deg],lift [mm],,\n".to_owned() + &rows(all(), |angle, lift| format!("{angle},{lift:.4},,")),
        "| angle [deg] | lift [mm] |\n|---|---:|\n".to_owned()
            + &rows(all(), |angle, lift| format!("| {angle} | {lift:.4} |")),
        (head.to_owned() + &rows(all(), plain)).replace('\n', "\r"),
        (head.to_owned() + &rows(all(), plain)).replace('\n', "\r\n"),
        rows(all(), |angle, lift| format!("  {angle:.1}   {lift:.4}")),
        rows(all(), |angle, lift| format!("{angle:.1}D0 {:.7}D+01", lift / 10.0)),
        format!(
            "* a gauge\n% of 2013\n// cam 3\n# lifts\n{head}{}",
            rows(all(), |angle, lift| plain(angle, lift) + "   % read twice")
        ),
        format!("Camshaft intake, cyl 1\nmeasured 2013-08-06\n\n{head}{}", rows(all(), plain)),
        "angle\tlift\ndeg\tmm\n".to_owned() + &rows(all(), |angle, lift| format!("{angle}\t{lift:.4}")),
    ] {
        is_the_lobe(&csv, "", 1.0);
    }
}

#[test]
fn columns_are_chosen_by_name_or_number_and_the_others_are_told() {
    let all = || 0..360;
    let wide = |head: &str| {
        format!("{head}\n{}", rows(all(), |angle, lift| format!("{},{angle},{lift:.4},0.5,7e-3", angle + 1.0)))
    };
    let named = wide("no,angle [deg],lift [mm],velocity [mm/deg],acceleration [mm/deg^2]");
    is_the_lobe(&named, "", 1.0);
    let told = reading(&named, "");
    assert_eq!(
        (&told["columns"], &told["left_out"]),
        (&[2, 3].into(), &["no", "velocity [mm/deg]", "acceleration [mm/deg^2]"].into())
    );
    is_the_lobe(&wide("n,cam,s1,s2,s3"), "angle_column = \"cam\"\nlift_column = \"S1\"", 1.0);
    is_the_lobe(&wide("n,cam,lift intake [mm],lift exhaust [mm],s3"), "lift_column = \"lift intake\"", 1.0);
    is_the_lobe(wide("").trim_start(), "angle_column = 2\nlift_column = 3", 1.0);
    // The lift comes before the angle.
    let turned = format!(
        "lift_mm,crank angle,cam angle\n{}",
        rows(all(), |angle, lift| format!("{lift:.4},{},{angle}", 2.0 * angle))
    );
    is_the_lobe(&turned, "", 1.0);
    let folder = TempDir::new().unwrap();
    model(&folder, &named, "").unwrap();
    let file = folder.path().join("read.toml").display().to_string();
    let page = in_one_line(&text(corner_impact(["cam", &file]).stdout));
    for says in [
        "table: 360 rows; columns separated by commas",
        "angles: column 2, in deg",
        "lifts: column 3, in mm; columns left out: no, velocity [mm/deg], acceleration [mm/deg^2]",
    ] {
        assert!(page.contains(says), "no \"{says}\" in {page}");
    }
}

#[test]
fn angles_go_round_however_they_are_counted() {
    let head = "angle [deg],lift [mm]\n";
    for (angles, fields) in [
        ((0..360).rev().collect::<Vec<i32>>(), ""),
        ((-180..=180).collect(), ""),
        ((0..=109).chain(109..=250).chain(250..360).collect(), ""),
        ((116..=244).collect(), "outside = \"base\""),
        ((0..=180).collect(), "mirrored = true"),
        ((180..=360).collect(), "mirrored = true"),
        ((180..=245).collect(), "mirrored = true\noutside = \"base\""),
        ((110..=180).rev().collect(), "mirrored = true\noutside = \"base\""),
    ] {
        is_the_lobe(&(head.to_owned() + &rows(angles, plain)), fields, 1.0);
    }
    // A duration with the nose at 0: it is the lobe half a turn on.
    let folder = TempDir::new().unwrap();
    let about_0 = head.to_owned() + &rows(-64..=64, |angle, _| plain(angle, lift(angle + 180.0)));
    let about_0 = model(&folder, &about_0, "outside = \"base\"").unwrap();
    assert!(table(&about_0).rows.iter().all(|row| row.lift == lift(row.angle_deg + 180.0)));
    assert_eq!((table(&about_0).rows.len(), table(&about_0).reading.filled), (360, 231));
    let crank = format!("crank angle [deg],lift [mm]\n{}", rows(0..360, |angle, lift| plain(2.0 * angle, lift)));
    is_the_lobe(&crank, "turn_deg = 720", 1.0);
    for (name, of) in [("rad", std::f64::consts::TAU), ("turn", 1.0)] {
        let other = |head: &str| format!("{head}\n{}", rows(0..360, |angle, lift| plain(angle / 360.0 * of, lift)));
        is_the_lobe(&other(&format!("angle [{name}],lift [mm]")), "", 1.0);
        is_the_lobe(&other("angle,lift"), &format!("angle_unit = \"{name}\""), 1.0);
    }
}

#[test]
fn units_are_known_in_words() {
    let table = |head: &str| format!("{head}\n{}", rows(0..360, plain));
    for (lift, size) in [
        ("lift mm", 1.0),
        ("lift [cm]", 10.0),
        ("lift in mm", 1.0),
        ("lift / mm", 1.0),
        ("Lift inches", 25.4),
        ("lift (in)", 25.4),
        ("lift_inch", 25.4),
        ("Hub in Zoll", 25.4),
        ("lift_thou", 0.0254),
        ("lift mils", 0.0254),
        ("lift_micron", 1e-3),
        ("lift [µm]", 1e-3),
        ("lift [μm]", 1e-3),
        ("lift metres", 1000.0),
    ] {
        is_the_lobe(&table(&format!("Cam Degrees,{lift}")), "", size);
    }
    is_the_lobe(&table("angle,lift"), "unit = \"thou\"", 0.0254);
}

/// Numbers as they are typed in other countries and by other programs.
#[test]
fn numbers_are_read_however_they_are_typed() {
    let all = || (0..360).step_by(2);
    let thousands = |by: &str| {
        rows(all(), |angle, lift| {
            let microns = format!("{:.1}", 1000.0 * lift);
            let parted = match microns.len() {
                6.. => format!("{}{by}{}", &microns[..1], &microns[1..]),
                _ => microns,
            };
            format!("{angle};{parted}")
        })
    };
    for by in ["'", "’", "\u{a0}", "\u{202f}"] {
        is_the_lobe(&format!("angle;lift [um]\n{}", thousands(by)), "", 1.0);
    }
    let minus = |sign: &str| rows(all(), |angle, lift| format!("{sign}{};{lift}", 360.0 - angle));
    for sign in ["-", "\u{2212}", "–"] {
        is_the_lobe(&format!("angle;lift\n{}", minus(sign)), "", 1.0);
    }
    let degrees = rows(all(), |angle, lift| format!("{angle} °;{lift}"));
    is_the_lobe(&format!("angle;lift\n{degrees}"), "", 1.0);
    is_the_lobe(&format!("angle [deg];lift\n{degrees}"), "", 1.0);
    is_the_lobe(&degrees, "", 1.0);
    for (csv, says) in [
        (format!("angle [rad];lift\n{degrees}"), "name both rad and deg"),
        ("angle;lift [um]\n0;1'08\n1;2\n".to_owned(), "lift = 1'08: must be a finite number"),
        ("angle;lift [um]\n0;1'0a8\n1;2\n".to_owned(), "lift = 1'0a8: must be a finite number"),
        ("angle;lift\n0;1°\n1;2\n".to_owned(), "lift = 1°: must be a finite number"),
        (
            rows(all(), |angle, lift| format!("{:.1},{lift:.2}", angle + 0.5).replace('.', ",")),
            "semicolons, or write decimal points",
        ),
        ("angle,lift\n0,5,0,25\n".to_owned(), "and the header has 2; if commas are also decimal signs"),
    ] {
        let words = model(&TempDir::new().unwrap(), &csv, "").map(|_| "it is read").unwrap_err();
        assert!(words.contains(says), "no \"{says}\" in: {words}");
    }
    let plain = "angle,lift,v\n0,0.5,0.25,1\n".to_owned();
    assert!(!model(&TempDir::new().unwrap(), &plain, "").unwrap_err().contains("semicolons"));
}

/// Texts in other codes, and with the sign that ends one on old systems.
#[test]
fn texts_in_utf_16_are_read() {
    let folder = TempDir::new().unwrap();
    let text = format!(
        "\u{feff}Winkel [°];Hub [mm]\r\n{}",
        rows((0..360).step_by(2), |angle, lift| format!("{angle};{lift}"))
    );
    let of_bytes = |bytes: &[u8]| {
        model(&folder, "", "").unwrap_err();
        fs::write(folder.path().join("lift.csv"), bytes).unwrap();
        Model::read(&folder.path().join("read.toml")).map_err(|error| error.to_string())
    };
    let wide = |code: fn(u16) -> [u8; 2]| text.encode_utf16().flat_map(code).collect::<Vec<u8>>();
    for bytes in [wide(u16::to_le_bytes), wide(u16::to_be_bytes), format!("{text}\u{1a}\r\n").into_bytes()] {
        let read = of_bytes(&bytes).unwrap();
        assert_eq!((table(&read).rows.len(), table(&read).reading.unit.as_str()), (180, "mm"));
    }
    let (mut odd, mut broken) = (wide(u16::to_le_bytes), wide(u16::to_le_bytes));
    odd.pop();
    broken.extend(0xd800_u16.to_le_bytes());
    for bytes in [odd, broken, wide(u16::to_le_bytes)[2..].to_vec(), [0xff, 0xfe, 0, 0].to_vec()] {
        assert!(of_bytes(&bytes).unwrap_err().contains("it is not text in UTF-8, UTF-16 with its mark or Latin-1"));
    }
}

/// Half a lobe is mirrored about its nose, though no row may be there.
#[test]
fn halves_are_mirrored_about_the_nose() {
    let of = |angles: &[f64], turn: f64| -> String {
        angles.iter().map(|angle| format!("{angle},{:.4}\n", lift(angle + turn))).collect()
    };
    let from = |first: f64, step: f64, count: u32| -> Vec<f64> {
        (0..count).map(|row| first + step * f64::from(row)).collect()
    };
    // First angle and step of the rows, turned by half a turn or not; the nose, and how many rows there are then.
    for (first, step, count, turn, nose, all) in [
        (0.5, 1.0, 180, 180.0, 0.0, 360),
        (0.5, 1.0, 180, 0.0, 180.0, 360),
        (180.5, 1.0, 180, 0.0, 180.0, 360),
        (0.25, 0.5, 360, 180.0, 0.0, 720),
        (0.3, 1.0, 180, 180.0, 0.3, 359),
        (1.0, 1.0, 180, 180.0, 1.0, 359),
        (0.0, 1.0, 181, 180.0, 0.0, 360),
        (0.0, 1.0, 181, 0.0, 180.0, 360),
    ] {
        let folder = TempDir::new().unwrap();
        let model = model(&folder, &of(&from(first, step, count), turn), "mirrored = true").unwrap();
        let told = serde_json::to_value(&*table(&model).reading).unwrap();
        assert_eq!((&told["nose_deg"], &told["rows"]), (&nose.into(), &all.into()), "{first} {step}");
        let at = |angle: f64| {
            table(&model)
                .rows
                .iter()
                .find(|row| (row.angle_deg - angle.rem_euclid(360.0)).abs() < 1e-9)
                .map(|row| row.lift)
        };
        let sides = from(first, step, count).iter().filter(|angle| at(**angle) != at(2.0 * nose - **angle)).count();
        assert_eq!(sides, 0, "{first} {step}");
    }
    // Two rows or more at the top are one nose.
    for turn in [0.0, 180.0] {
        let folder = TempDir::new().unwrap();
        let flat = |angle: f64| lift(angle + turn).min(lift(177.0));
        let csv: String = (0..=180).map(f64::from).map(|angle| format!("{angle},{:.4}\n", flat(angle))).collect();
        let model = model(&folder, &csv, "mirrored = true").unwrap();
        assert!(table(&model).rows.iter().all(|row| row.lift == flat(row.angle_deg)));
        assert_eq!(table(&model).rows.len(), 360);
    }
}

/// A number with three digits behind every comma has two readings, and both are told.
#[test]
fn commas_that_may_part_thousands_are_told() {
    let of = |digits: usize| {
        let row = |angle: f64, lift: f64| format!("{angle};{}", format!("{:.digits$}", 40.0 + lift).replace('.', ","));
        reading(&format!("angle [deg];lift [mm]\n{}", rows(0..360, row)), "")["thousands"].clone()
    };
    assert_eq!((of(3), of(4)), ("40,000".into(), serde_json::Value::Null));
    // Behind points, where numbers below a thousand have none.
    let microns = |below: fn(u32) -> String| {
        let row = |angle: f64, lift: f64| {
            let whole = (1000.0 * lift).round() as u32;
            let lift = if whole < 1000 { below(whole) } else { format!("{}.{:03}", whole / 1000, whole % 1000) };
            format!("{angle};{lift}")
        };
        reading(&format!("angle [deg];lift [um]\n{}", rows(0..360, row)), "")["thousands"].clone()
    };
    let whole = microns(|lift| lift.to_string());
    assert_eq!((whole, microns(|lift| format!("0.{lift:03}"))), ("1.027".into(), serde_json::Value::Null));
    assert_eq!(microns(|_| "0".into()), serde_json::Value::Null);
    assert_eq!(microns(|_| "7.5".into()), serde_json::Value::Null);
}

#[test]
fn what_is_not_read_is_refused_with_what_makes_it_read() {
    let all = |head: &str| format!("{head}\n{}", rows(0..360, plain));
    let of = |angles: std::ops::RangeInclusive<i32>| format!("angle [deg],lift [mm]\n{}", rows(angles, plain));
    let slip = |at: &str, by: &str| all("angle [deg],lift [mm]").replacen(at, by, 1);
    let wide = |head: &str| format!("{head}\n{}", rows(0..360, |angle, lift| format!("{angle},{lift:.4},{lift:.4}")));
    for (csv, fields, says) in [
        (all("angle [deg],radius [mm]"), "", "names a radius of the cam, which is not the follower's lift"),
        (all("angle [deg],lift [furlong]"), "", "the unit of the lift must be one of: m, cm, mm, um, in, ft, thou;"),
        (all("angle [deg],lift in furlongs"), "", "set it in [cam], such as unit"),
        (all("angle [deg],lift yards"), "", "the unit of the lift must be one of"),
        (all("angle [hours],lift [mm]"), "", "the unit of the angle must be one of: deg, rad, turn, gon;"),
        (all("lifts in inches of cam 3\nangle,lift"), "", "set the unit of the lifts in [cam], such as unit"),
        (wide("angle,lift intake,lift exhaust"), "", "set lift_column in [cam]"),
        (wide("angle,left,right"), "", "set lift_column in [cam]"),
        (
            wide(""),
            "",
            "has 3 columns without names: set the columns of the angle and the lift in [cam], such as angle_column = 1 and lift_column = 2",
        ),
        (wide("angle,lift,s"), "lift_column = \"height\"", "its columns are angle, lift, s"),
        (
            wide("angle,lift,s"),
            "lift_column = 4",
            "lift.csv: has 3 columns: angle, lift, s; lift_column = 4 in [cam] names none of them",
        ),
        (
            wide(""),
            "angle_column = 1\nlift_column = 4",
            "lift.csv: has 3 columns; lift_column = 4 in [cam] names none of them",
        ),
        (slip("7,0.0000", "7,"), "", "row = 7,: has an empty cell: lift is missing"),
        (slip("7,0.0000", "7,NaN"), "", "lift = NaN: must be a finite number: this marks a missing number"),
        (
            slip("7,0.0000", "7 deg,0.0000"),
            "",
            "angle_deg = 7 deg: must be a finite number: the cell has more than a number",
        ),
        (
            all("angle,lift") + "\n" + &all("angle,lift"),
            "",
            "is the header of a second table in this file: keep one of them",
        ),
        (all("angle,lift") + &rows(0..360, plain), "", "does a second table begin on line 362? then keep one of them"),
        (of(0..=399).replace(" [deg]", ""), "", "are these gon, 400 to a turn? then set angle_unit = \"gon\" in [cam]"),
        (wide("angle,lift,s"), "lift_column = 1.5", "must be the name of a column in quotes, or its number from 1"),
        (all("one,two"), "", "must name the angle, then the lift"),
        (slip("7,0.0000", "7,x"), "", "lift = x: must be a finite number"),
        (slip("0,0.0000", "0,x"), "", "lift = x: must be a finite number"),
        (slip("7,0.0000", "7"), "", "row = 7: must be two numbers"),
        (slip("7,0.0000", "6,0.5"), "", "repeats the angle of the row before with another lift"),
        (slip("7,0.0000", "\"7,0.0000"), "", "must be two numbers"),
        (of(116..=244), "", "outside = \"base\""),
        (of(0..=180), "", "mirrored = true"),
        (of(0..=170), "mirrored = true", "no row from 340 to 360"),
        (
            of(100..=200),
            "mirrored = true",
            "needs the nose, the greatest lift, at one end of the rows: it is on line 82",
        ),
        (of(0..=300), "mirrored = true", "half a lobe has 180 at most"),
        (of(150..=210), "outside = \"base\"", "do not begin and end on the base circle: the lift on line"),
        (of(116..=244), "outside = \"air\"", "must be one of: \"base\""),
        (of(0..=359), "mirrored = 1", "must be true or false"),
        (format!("angle,lift\n{}", rows((0..720).step_by(2), plain)), "", "turn_deg = 720"),
        (all("angle [deg],lift [mm]"), "turn_deg = -720", "must be a finite number above 0"),
        (all("angle [deg],lift [mm]"), "turn_deg = nan", "must be a finite number"),
        ("root:x:0\nnobody:x:1\n".into(), "", "is not a table of lifts"),
        // The line is named that makes it read.
        (
            format!(
                "no,angle,lift\n{}",
                rows((0..360).step_by(2), |angle, lift| format!("{},{angle},{lift}", angle / 2.0))
            ),
            "angle_column = \"no\"",
            "does column 1 count the rows? then choose another one by angle_column in [cam]",
        ),
        (
            format!("angle,lift\n{}", rows(0..720, plain)),
            "",
            "repeat those of the turn before: keep one turn of them; or are these degrees",
        ),
        (
            format!(
                "angle,lift\n{}",
                rows(0..720, |angle, lift_| plain(angle, if angle > 700.0 { 1.0 } else { lift_ }))
            ),
            "",
            "from 0 to 360; are these degrees of a crank? then set turn_deg = 720",
        ),
        (
            format!(
                "angle,lift\n{}",
                rows(0..360, |angle, lift| format!("{:.4},{lift}", angle.to_radians())) + "6.2833,0\n"
            ),
            "",
            "did you mean angle_unit = \"rad\" in [cam]?",
        ),
        (
            format!("angle [deg],lift\n{}", rows(0..360, |angle, lift| format!("{:.4},{lift}", angle.to_radians()))),
            "",
            "the header says deg: is it rad? then correct it there",
        ),
        (
            format!("angle [deg],lift\n{}", rows(0..360, |angle, lift| format!("{:.5},{lift}", angle / 360.0))),
            "",
            "the header says deg: is it turn? then correct it there",
        ),
        (slip("180,8.0000", "angle [deg],lift [mm]\n180,8.0000"), "", "this is the header again; leave the line out"),
        (
            all("angle [deg],lift [mm]") + "Max lift,8.0\n",
            "",
            "must be a finite number; if this line is no row, leave it out or begin it with #",
        ),
        (
            all("angle [deg],lift [mm]") + "-- end of data\n",
            "",
            "must be two numbers: angle_deg,lift; if this line is no row",
        ),
        (of(130..=240), "outside = \"base\"", "is 0.5359 above the lowest"),
        (
            format!("angle [deg],lift [mm]\n129,0\n{}250,0\n", rows(130..=240, plain)),
            "outside = \"base\"",
            "on line 2 is the lowest, but the next one already differs by 0.5359: the flank is cut off",
        ),
        (of(116..=180), "mirrored = true", "outside = \"base\" in [cam], which fills the base circle"),
    ] {
        let folder = TempDir::new().unwrap();
        let said = model(&folder, &csv, fields).expect_err(says);
        assert!(said.contains(says), "no \"{says}\" in: {said}");
        assert!(!said.contains("nobody"), "{said}");
        // What the model says is not advised.
        assert!(fields.is_empty() || !said.split("; of ").skip(1).any(|advice| advice.contains(fields)), "{said}");
    }
}

/// A table in place of a model has no [cam] yet: what is refused says how to have one.
#[test]
fn a_refused_table_without_a_model_says_how_to_have_one() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("lifts.csv");
    let page = |csv: &str| {
        fs::write(&file, csv).unwrap();
        let output = corner_impact(["cam", &file.display().to_string()]);
        (output.status.code(), in_one_line(&text(output.stderr)))
    };
    let of = |head: &str, angles: std::ops::Range<i32>| format!("{head}\n{}", rows(angles, plain));
    let new = "there is no model file yet: `corner-impact new --law table my-machine.toml` writes one; name this table in it by file = \"lifts.csv\"";
    for csv in [of("angle,lift [furlong]", 0..360), of("angle,lift", 100..250)] {
        let (code, said) = page(&csv);
        assert!(code == Some(2) && said.contains(new), "{said}");
    }
    assert!(!page("angle,lift\n0,x\n").1.contains("no model file yet"));
}

/// Readings that may not be meant are noted.
#[test]
fn doubts_about_a_table_are_noted() {
    let doubts = |csv: &str, fields: &str| table(&model(&TempDir::new().unwrap(), csv, fields).unwrap()).doubts();
    let of = |head: &str, sign: f64| format!("{head}\n{}", rows(0..360, |angle, lift| plain(angle, sign * lift)));
    for head in ["crank angle,lift", "Kurbelwinkel,lift", "Winkel [°KW],lift", "angle (CAD),lift"] {
        let told = doubts(&of(head, 1.0), "");
        assert!(told.len() == 1 && told[0].contains("set turn_deg = 720 in [cam]"), "{head}: {told:?}");
    }
    let twice = format!("crank angle,lift\n{}", rows(0..360, |angle, lift| plain(2.0 * angle, lift)));
    assert!(doubts(&twice, "turn_deg = 720").is_empty() && doubts(&of("cam angle,lift", 1.0), "").is_empty());
    let told = doubts(&of("angle,lift", -1.0), "");
    assert!(told.len() == 1 && told[0].starts_with("cam.file: the lowest lift is -8 mm"), "{told:?}");
    // Less than a hundredth of the rise is a gauge's.
    let low = |lowest: &str| of("angle,lift", 1.0).replacen("\n7,0.0000", &format!("\n7,{lowest}"), 1);
    assert_eq!([low("-0.0807"), low("-0.0809")].map(|csv| doubts(&csv, "").len()), [0, 1]);
}

/// Angles in units without a name in a model are read, or refused with the fields that make them read.
#[test]
fn angles_in_any_unit_are_read() {
    let of = |head: &str, turn: f64| {
        let row = |angle: f64, lift: f64| format!("{},{lift}", angle / 360.0 * turn);
        format!("{head}\n{}", rows((0..360).step_by(2), row))
    };
    is_the_lobe(&of("angle [gon],lift [mm]", 400.0), "", 1.0);
    is_the_lobe(&of("angle,lift [mm]", 400.0), "angle_unit = \"gon\"", 1.0);
    is_the_lobe(&of("angle [grad],lift [mm]", 400.0), "angle_unit = \"gon\"", 1.0);
    is_the_lobe(&of("Winkel [Grad],Hub [mm]", 360.0), "", 1.0);
    for (head, turn, fields) in [
        ("angle [0.1 deg],lift [mm]", 3600.0, ["angle_unit = \"deg\"", "turn_deg = 3600"]),
        ("angle [mrad],lift [mm]", 2000.0 * std::f64::consts::PI, ["angle_unit = \"rad\"", "turn_deg = 360000"]),
        ("angle [arcmin],lift [mm]", 21600.0, ["angle_unit = \"deg\"", "turn_deg = 21600"]),
    ] {
        let csv = of(head, turn);
        let said = model(&TempDir::new().unwrap(), &csv, "").unwrap_err();
        assert!(said.contains(&format!("set {} in [cam]", fields.join(" and "))), "{said}");
        is_the_lobe(&csv, &fields.join("\n"), 1.0);
    }
}

/// A unit times a power of ten is a part of it.
#[test]
fn a_unit_times_a_power_of_ten_is_a_part_of_it() {
    let of = |head: &str| format!("{head}\n{}", rows(0..360, |angle, lift| format!("{angle},{:.2}", 100.0 * lift)));
    for unit in ["mm·10⁻²", "mm*10^-2", "10⁻² mm", "mm × 0.01"] {
        is_the_lobe(&of(&format!("angle [deg],lift [{unit}]")), "", 1.0);
    }
}

/// Lifts in whole micrometres with a point between thousands are read so, and it is told.
#[test]
fn thousands_that_the_lifts_beside_them_show_are_read() {
    let row = |angle: f64, lift: f64| {
        let whole = (1000.0 * lift).round() as u32;
        let lift = if whole < 1000 { whole.to_string() } else { format!("{}.{:03}", whole / 1000, whole % 1000) };
        format!("{angle};{lift}")
    };
    let model = model(&TempDir::new().unwrap(), &format!("angle [deg];lift [um]\n{}", rows(0..360, row)), "").unwrap();
    assert!(table(&model).rows.iter().all(|row| (row.lift - lift(row.angle_deg)).abs() < 6e-4));
    let told = serde_json::to_value(&*table(&model).reading).unwrap();
    assert_eq!((&told["thousands"], &told["parts_thousands"]), (&"1.027".into(), &true.into()));
}

/// Rows that are too far apart, a gauge that slipped and rows that are missing in a rise are noted, once each, and nothing else is.
#[test]
fn rows_that_leave_the_cam_open_are_noted() {
    let doubts = |csv: String| table(&model(&TempDir::new().unwrap(), &csv, "").unwrap()).doubts();
    let of = |angles: Vec<i32>, slip: f64| {
        let row = |angle: f64, lift: f64| format!("{angle},{:.4}", if angle >= 300.0 { lift + slip } else { lift });
        format!("angle [deg],lift [mm]\n{}", rows(angles, row))
    };
    let every = |step: usize| (0..360).step_by(step).collect::<Vec<i32>>();
    assert_eq!(doubts(of(every(1), 0.0)), [""; 0]);
    assert_eq!(doubts(of(every(5), 0.0)), [""; 0]);
    let missing =
        |from: i32| every(2).into_iter().filter(|angle| !(from..from + 6).contains(angle)).collect::<Vec<i32>>();
    // On the base circle nothing is lost.
    assert_eq!(doubts(of(missing(20), 0.0)), [""; 0]);
    for (csv, says) in [
        (
            rows(every(30), |angle, _| format!("{angle},{:.4}", 5.0 - 5.0 * angle.to_radians().cos())),
            "11 rows on a lobe are too few for its accelerations",
        ),
        (
            of(every(1), 0.05),
            "the lift steps by 0.05 mm at 300 deg between two level stretches: has the gauge slipped?",
        ),
        (of(missing(140), 0.0), "no row between 138 and 146 deg, where the lift changes by"),
    ] {
        let told = doubts(csv);
        assert!(told.len() == 1 && told[0].contains(says), "{told:?}");
    }
}
