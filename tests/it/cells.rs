//! Are empty and hidden cells, blanks between thousands, swapped columns and rows that are missing named with their lines?

use tempfile::TempDir;

use crate::reading::{is_the_lobe, lift, model, plain, rows, table};

fn refused(csv: &str, fields: &str) -> String {
    model(&TempDir::new().unwrap(), csv, fields).map(|_| "it is read").unwrap_err()
}

/// A row without its lift, or without its angle, is no title, wherever it stands and whatever parts the columns.
#[test]
fn a_row_with_an_empty_cell_is_no_title() {
    for by in [",", ";", "\t", "|"] {
        let of = |head: &str, first: &str| {
            let rest = rows(2..360, |angle, lift| format!("{angle}{by}{lift:.4}"));
            format!("{head}{first}{rest}").replace(',', by)
        };
        for (head, first, says) in [
            ("angle [deg],lift [mm]\n", "0,\n1,\n", ":2: row = 0,: has an empty cell: lift is missing"),
            ("angle [deg],lift [mm]\n", "0,\n1,0\n", ":2: row = 0,: has an empty cell: lift is missing"),
            ("", "0,\n1,\n", ":1: row = 0,: has an empty cell: lift is missing"),
            (
                "measured today\nangle [deg],lift [mm]\n",
                ",0\n1,0\n",
                ":3: row = ,0: has an empty cell: angle_deg is missing",
            ),
        ] {
            let words = refused(&of(head, first), "").replace(by, ",");
            // A bar or a tab at the edge of a line parts no columns.
            let edge = if first.starts_with(',') { ":3: row = " } else { "must be two numbers" };
            let is_edge = ["|", "\t"].contains(&by) && words.contains(edge);
            assert!(words.contains(says) || is_edge, "{by:?}: no \"{says}\" in: {words}");
        }
    }
    let blanks = |head: &str| format!("{head}{}", rows(1..360, |angle, lift| format!("{angle} {lift:.4}")));
    assert!(refused(&blanks("angle [deg] lift [mm]\n0\n"), "").contains(":2: row = 0: must be two numbers"));
    let wide = rows(1..360, |angle, lift| format!("{angle},{lift:.4},"));
    assert!(refused(&format!("angle,lift,\n0,,\n{wide}"), "").contains(":2: row = 0,,: has an empty cell"));
    // A number above a table without a header counts its rows, or so.
    is_the_lobe(&format!("360\n{}", rows(0..360, plain)), "", 1.0);
    is_the_lobe(&format!("24\nangle,lift\n{}", rows(0..360, plain)), "", 1.0);
}

/// The signs that a spreadsheet prints for a number wider than its column are named as such; at the start of a line they begin a comment.
#[test]
fn a_number_that_a_spreadsheet_hides_is_named() {
    let hidden = "is what a spreadsheet prints for a number that is wider than its column";
    for by in [",", ";", "\t", "|", " "] {
        let of = |head: &str, at: f64, row: &str| {
            let row = |angle: f64, lift: f64| if angle == at { row.to_owned() } else { format!("{angle},{lift:.4}") };
            format!("{head}{}", rows(0..360, row)).replace(',', by)
        };
        for (at, row) in [(0.0, "####,0.0000"), (0.0, "0,####"), (180.0, "180,##"), (180.0, "########,8.0000")] {
            for head in ["angle,lift\n", ""] {
                let words = refused(&of(head, at, row), "");
                let line = at as usize + 1 + head.lines().count();
                assert!(
                    words.contains(hidden) && words.contains(&format!("lift.csv:{line}: ")),
                    "{by:?} {row}: {words}"
                );
            }
        }
        let named = |row: &str| of("angle,lift\n", -1.0, "") + row;
        for comment in ["####\n", "## end ##\n", "#360,0\n", "## 360,0,0\n", "# ## #\n"] {
            is_the_lobe(&named(comment), "", 1.0);
        }
    }
    let of = |row: &str| {
        let each =
            |angle: f64, lift: f64| if angle == 180.0 { row.to_owned() } else { format!("{angle},1,{lift:.4},2") };
        format!("angle,v,lift,a\n{}", rows(0..360, each))
    };
    for row in ["180,####,8.0000,2", "180,1,####,2"] {
        assert!(refused(&of(row), "").contains(hidden), "{row}");
    }
    // Nothing that is read stands behind it.
    is_the_lobe(&of("180,1,8.0000,####"), "", 1.0);
}

/// Blanks part thousands where they do not part the columns.
#[test]
fn blanks_between_thousands_are_read_where_they_part_no_columns() {
    let of = |separator: &str, by: &str, head: &str| {
        let row = |angle: f64, lift: f64| {
            let microns = (1000.0 * lift).round() as u32;
            let lift = if microns < 1000 {
                microns.to_string()
            } else {
                format!("{}{by}{:03}", microns / 1000, microns % 1000)
            };
            format!("{angle}{separator}{lift}")
        };
        format!("{head}{}", rows(0..360, row))
    };
    let is_read = |csv: &str| {
        let model = model(&TempDir::new().unwrap(), csv, "unit = \"um\"").unwrap();
        let rows = &table(&model).rows;
        assert!(rows.iter().all(|row| (row.lift - lift(row.angle_deg)).abs() < 6e-4), "{}", &csv[..40]);
    };
    for by in [" ", "\u{a0}", "\u{2009}", "\u{202f}"] {
        for separator in [";", ",", "\t", "|"] {
            is_read(&of(separator, by, &format!("angle [deg]{separator}lift [um]\n")));
            is_read(&of(separator, by, ""));
        }
    }
    for by in ["\u{a0}", "\u{2009}", "\u{202f}"] {
        is_read(&of(" ", by, "angle lift\n"));
        // Alone they part the columns.
        is_the_lobe(&rows(0..360, |angle, lift| format!("{angle}{by}{lift:.4}")), "", 1.0);
    }
    let says =
        "; if blanks also separate thousands, separate the columns by semicolons, or write nothing between thousands";
    assert!(refused(&of(" ", " ", "angle lift\n"), "").contains(says));
    assert!(refused(&of(" ", " ", ""), "").contains(says));
    let three = "angle lift\n0 1.5 2.5\n1 2.5 3.5\n";
    assert!(!refused(three, "").contains("thousands"));
    for lift in ["1234 000", "1 07", "1 0711", "1  071", "x 071", "1 071 mm"] {
        let words = refused(&of(";", " ", "angle;lift\n").replacen("\n7;0\n", &format!("\n7;{lift}\n"), 1), "");
        assert!(words.contains("must be a finite number"), "{lift}: {words}");
    }
}

/// Columns that seem to be swapped are named with the fields that read them, and no others.
#[test]
fn swapped_columns_are_named() {
    let says = "the columns seem to be swapped: set angle_column = 2 and lift_column = 1 in [cam]";
    let swapped =
        |angles: std::ops::Range<i32>, by: f64| rows(angles, |angle, lift| format!("{lift:.4},{}", by * angle));
    for (csv, fields) in [
        (swapped(0..360, 1.0), ""),
        (swapped(0..360, -1.0), ""),
        (swapped(200..360, 1.0) + &swapped(0..200, 1.0), ""),
        (swapped(0..360, 2.0), "turn_deg = 720"),
        (format!("angle,lift\n{}", swapped(0..360, 1.0)), ""),
        (swapped(120..181, 1.0), "mirrored = true\noutside = \"base\""),
        (
            rows(100..181, |angle, lift| format!("{:.4},{angle}", lift + 1e-4 * angle)),
            "mirrored = true\noutside = \"base\"",
        ),
    ] {
        let words = refused(&csv, fields);
        assert!(words.contains(says), "{fields}: {words}");
        let model = model(&TempDir::new().unwrap(), &csv, &format!("{fields}\nangle_column = 2\nlift_column = 1"));
        assert!(model.is_ok(), "{fields}: {model:?}");
    }
    let pairs: Vec<[f64; 2]> = (0..360).map(|angle| [lift(f64::from(angle)), f64::from(angle)]).collect();
    let text = crate::common::osorio_text(&[]);
    let cam = text.find("[cam]").unwrap();
    let own = format!("{}[cam]\nlaw = \"table\"\nspline = \"cubic\"\nrows = {pairs:?}\n", &text[..cam]);
    let words = corner_impact::model::Model::parse("own.toml", &own).unwrap_err().to_string();
    assert!(words.contains("the angle comes first in each row: are the two numbers swapped?"), "{words}");
    // A slip of an angle, or lifts over a part of the turn, are no swapped columns.
    for csv in [
        rows(0..360, plain).replacen("\n200,", "\n100,", 1),
        rows(100..180, |angle, lift| format!("{angle},{:.4}", lift + angle)),
        rows(0..360, |angle, _| format!("{},{}", if angle == 9.0 { 5.0 } else { angle }, 100.0 * angle)),
    ] {
        assert!(!refused(&csv, "").contains("swapped"), "{csv}");
    }
}

/// Rows are coarse by how many of them a lobe has, and not by how far apart they are.
#[test]
fn rows_are_coarse_by_how_many_a_lobe_has() {
    let doubts = |csv: &str| table(&model(&TempDir::new().unwrap(), csv, "").unwrap()).doubts();
    let every = |step: usize, of: &dyn Fn(f64) -> f64| {
        doubts(&rows((0..360).step_by(step), |angle, _| format!("{angle},{:.4}", of(angle))))
    };
    let wave = |lobes: f64| move |angle: f64| 5.0 - 5.0 * (lobes * angle).to_radians().cos();
    for (step, few) in [(5, None), (6, None), (8, Some(12)), (10, Some(11)), (15, Some(7))] {
        let told = every(step, &lift);
        let says = few.map(|few| format!("{few} rows on a lobe are too few for its accelerations"));
        assert_eq!(told.len(), usize::from(few.is_some()), "{step}: {told:?}");
        assert!(says.is_none_or(|says| told[0].contains(&says)), "{step}: {told:?}");
        // A hollow in a circle is as coarse as a lobe.
        let told = every(step, &|angle| 8.0 - lift(angle));
        assert_eq!(told.len(), usize::from(few.is_some()), "{step}: {told:?}");
        assert!(few.is_none_or(|few| told[0].contains(&format!("{few} rows on a hollow"))), "{step}: {told:?}");
    }
    assert_eq!([15, 20].map(|step| every(step, &wave(1.0)).len()), [0, 1], "one wave in a turn");
    assert_eq!([4, 6, 8].map(|step| every(step, &wave(4.0)).len()), [0, 1, 1], "four waves in a turn");
    // Noise about the foot of a lobe makes no lobes.
    let noisy = |angle: f64| lift(angle) + 0.8 * f64::from(u8::from(angle as i32 % 2 == 0));
    assert_eq!(doubts(&rows(0..360, |angle, _| format!("{angle},{:.4}", noisy(angle)))).len(), 0);
}

/// Rows that are missing over the nose are noted as those in a rise are, and those on a dwell are not.
#[test]
fn rows_that_are_missing_over_the_nose_are_noted() {
    let doubts = |csv: &str| table(&model(&TempDir::new().unwrap(), csv, "").unwrap()).doubts();
    let without = |step: usize, from: i32, to: i32| {
        rows((0..360).step_by(step).filter(|angle| !(from..to).contains(angle)), plain)
    };
    for (csv, from, to) in [
        (without(1, 178, 183), 177, 183),
        (without(1, 179, 182), 178, 182),
        (without(2, 178, 183), 176, 184),
        (without(5, 175, 186), 170, 190),
    ] {
        let told = doubts(&csv);
        let says = format!("no row between {from} and {to} deg, where the lift has a turning point: are rows missing?");
        assert!(told.len() == 1 && told[0].contains(&says), "{from}: {told:?}");
    }
    assert!(doubts(&without(1, 150, 154))[0].contains("no row between 149 and 154 deg, where the lift changes by"));
    assert_eq!(doubts(&without(1, 20, 28)), [""; 0]);
    // The rest at the top of a lobe by its ends alone.
    let rest = |angle: f64, _: f64| {
        let x = (angle - 180.0).abs();
        let lift = if x < 25.0 { 8.0 } else { 4.0 * (1.0 + ((x - 25.0) * 3.0).to_radians().cos()) };
        format!("{angle},{:.4}", if x < 85.0 { lift } else { 0.0 })
    };
    assert_eq!(doubts(&rows((0..360).step_by(5).filter(|angle| !(160..205).contains(angle)), rest)), [""; 0]);
}

/// A table of lifts at given angles.
fn of_rows(rows: &[(i32, f64)]) -> String {
    rows.iter().map(|(angle, lift)| format!("{angle},{lift:.4}\n")).collect()
}

/// Two rows that are missing anywhere in a wave are noted with the rows around them, across angle 0 as well. One alone is not.
#[test]
fn rows_that_are_missing_anywhere_in_a_wave_are_noted() {
    let doubts = |csv: &str| table(&model(&TempDir::new().unwrap(), csv, "").unwrap()).doubts();
    let wave = |angle: i32| ((5.0 - 5.0 * f64::from(angle).to_radians().cos()) * 1e4).round() / 1e4;
    let all: Vec<(i32, f64)> = (0..90).map(|row| 4 * row).map(|angle| (angle, wave(angle))).collect();
    let without = |gone: &[usize]| -> Vec<(i32, f64)> {
        all.iter().enumerate().filter(|(index, _)| !gone.contains(index)).map(|(_, row)| *row).collect()
    };
    for first in 0..90 {
        let (before, after) = ((first + 89) % 90, (first + 2) % 90);
        let rows = without(&[first, (first + 1) % 90]);
        let [told] = &doubts(&of_rows(&rows))[..] else { panic!("{first}") };
        let line = 1 + rows.iter().position(|row| *row == all[before]).unwrap();
        let size = (all[after].1 - all[before].1).abs();
        let what = match size > 0.1 {
            true => format!("the lift changes by {} mm", (size * 1e6).round() / 1e6),
            false => "the lift has a turning point".to_owned(),
        };
        let says = format!("line {line}: no row between {} and {} deg, where {what}:", all[before].0, all[after].0);
        assert!(told.contains(&says), "no \"{says}\" in: {told}");
        assert_eq!(doubts(&of_rows(&without(&[first]))), [""; 0], "{first}");
    }
    // Two and a half times as far apart as the farther of the rows beside them.
    for (angles, is_told) in [([96, 100, 110, 114], true), ([96, 100, 110, 115], false), ([95, 100, 110, 114], false)] {
        let beside = (0..360).step_by(4).filter(|angle| !(96..=114).contains(angle));
        let mut rows: Vec<(i32, f64)> = beside.chain(angles).map(|angle| (angle, wave(angle))).collect();
        rows.sort_by_key(|row| row.0);
        let told = doubts(&of_rows(&rows));
        assert_eq!(told.iter().any(|told| told.contains("no row between 100 and 110 deg")), is_told, "{told:?}");
    }
}

/// A step between two level stretches of five rows or more is a slip, from twenty rows on, up to a fifth of the rise.
#[test]
fn a_slip_is_a_step_between_level_stretches() {
    let doubts = |csv: &str| table(&model(&TempDir::new().unwrap(), csv, "").unwrap()).doubts();
    let slips = |rows: &[(i32, f64)]| -> Vec<String> {
        doubts(&of_rows(rows)).into_iter().filter(|told| told.contains("has the gauge slipped?")).collect()
    };
    let lobe = [2.0013, 5.0021, 8.0034, 10.0, 9.0011, 7.0042, 5.0023, 3.0051, 2.0017, 1.0012];
    let of = |low: usize, high: usize, step: f64| -> Vec<(i32, f64)> {
        let lifts = [vec![0.0; low], vec![step; high], lobe.to_vec()].concat();
        let gap = 360 / lifts.len() as i32;
        lifts.into_iter().enumerate().map(|(row, lift)| (gap * row as i32, lift)).collect()
    };
    for (low, high) in [(5, 5), (6, 5), (5, 9), (12, 8)] {
        let rows = of(low, high, 0.5004);
        let [told] = &slips(&rows)[..] else { panic!("{low} {high}: {:?}", doubts(&of_rows(&rows))) };
        let says = format!("line {}: the lift steps by 0.5004 mm at {} deg", low + 1, rows[low].0);
        assert!(told.contains(&says), "no \"{says}\" in: {told}");
    }
    for rows in [of(4, 6, 0.5004), of(6, 4, 0.5004), of(8, 8, 2.0006), of(8, 8, 3.0006)] {
        assert_eq!(slips(&rows), [""; 0], "{rows:?}");
    }
    // Nineteen rows are too few.
    let mut few = of(5, 5, 0.5004);
    few.pop();
    assert_eq!(slips(&few), [""; 0]);
}
