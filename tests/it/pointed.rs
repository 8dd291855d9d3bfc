//! Does a complaint point into the file, and ask whether a near name was meant?

use std::path::PathBuf;

use crate::common;
use corner_impact::model::{Model, nearest};

fn folder() -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("pointed");
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// What `verify` says about a file, from the file's folder.
fn complaint(name: &str, text: &str) -> String {
    std::fs::write(folder().join(name), text).unwrap();
    let output = common::program(["verify", "--no-external", name]).current_dir(folder()).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{name}");
    assert!(output.stdout.is_empty());
    String::from_utf8(output.stderr).unwrap()
}

/// The words under which the line above is underlined, and that line.
fn underlined(message: &str) -> (String, String) {
    let lines: Vec<&str> = message.lines().collect();
    let at = lines.iter().position(|line| line.contains('^')).unwrap_or_else(|| panic!("{message}"));
    let column = |line: &str, what: char| line.chars().position(|letter| letter == what).unwrap();
    let (from, to) = (column(lines[at], '^'), lines[at].chars().count());
    let shown: String = lines[at - 1].chars().skip(from).take(to - from).collect();
    (shown, lines[at - 1].split_once('|').unwrap().1.trim().to_owned())
}

#[test]
fn the_value_is_underlined_in_its_line() {
    let paper = common::osorio_text(&[("mass", "-1.0")]);
    let cases: [(&str, String, &str, &str); 6] = [
        ("mass.toml", paper, "error: mass.toml:7: follower.mass = -1.0: must be a finite number above 0", "-1.0"),
        (
            "umlaut.toml",
            common::osorio_text(&[("name", "\"h\u{e4}\""), ("mass", "0.00 # \u{e4}")]),
            "error: umlaut.toml:7: follower.mass = 0.00: must be a finite number above 0",
            "0.00",
        ),
        (
            "circles.toml",
            common::osorio_text(&[("flank_radius", "0.4")]),
            "error: circles.toml:17: cam.flank_radius = 0.4: must be above cam.base_radius",
            "0.4",
        ),
        (
            "range.toml",
            common::osorio_text(&[("rpm_min", "700.0")]),
            "error: range.toml:23: study.rpm_min = 700.0: no corner impact",
            "700.0",
        ),
        (
            "unknown.toml",
            common::osorio_text(&[]).replace("damping = 0.0", "damping = 0.0\nfriction = 0.1"),
            "error: unknown.toml:9: follower.friction = 0.1: unknown field",
            "friction",
        ),
        (
            "without.toml",
            common::osorio_text(&[]).replace("mass =", "# mass ="),
            "error: without.toml:6: follower.mass is missing",
            "follower",
        ),
    ];
    for (name, text, first, value) in cases {
        let message = complaint(name, &text);
        assert!(message.lines().next().unwrap().starts_with(first), "{message}");
        let (shown, line) = underlined(&message);
        assert_eq!(shown, value, "{message}");
        assert!(text.lines().any(|written| written.trim() == line), "{line}");
    }
}

#[test]
fn broken_tables_and_toml_are_shown() {
    let message = complaint("syntax.toml", "name = \"x\"\n[follower\nmass = 1\n");
    assert!(
        message.starts_with("error: syntax.toml:2: not valid TOML: ") && message.contains("2 | [follower\n"),
        "{message}"
    );
    let comma = common::osorio_text(&[]).replacen("mass = ", "mass = 0,1", 1);
    assert!(complaint("comma.toml", &comma).contains("help: did you mean a decimal point?"));
    for other in ["mass = 12kg #", "mass = \"1\", #", "mass = 12] #"] {
        let other = common::osorio_text(&[]).replacen("mass = ", other, 1);
        let message = complaint("other.toml", &other);
        assert!(message.contains("not valid TOML") && !message.contains("decimal point"), "{message}");
    }
    let cam = "law = \"table\"\nfile = \"broken.csv\"\nspline = \"cubic\"\n";
    let model = common::osorio_text(&[]).split("[cam]").next().unwrap().to_owned() + "[cam]\n" + cam;
    for (row, value, says) in [
        ("90,high", "high", "error: broken.csv:3: lift = high: must be a finite number"),
        (
            "400,0.1",
            "400",
            "error: broken.csv:3: angle_deg = 400: must be within a turn of the first row, from 0 to 360",
        ),
        ("90", "90", "error: broken.csv:3: row = 90: must be two numbers"),
    ] {
        std::fs::write(folder().join("broken.csv"), format!("\u{feff}angle_deg,lift\r\n0,0.4\r\n{row}\r\n180,0.5\r\n"))
            .unwrap();
        let message = complaint("table.toml", &model);
        assert!(message.starts_with(says), "{message}");
        assert_eq!(underlined(&message), (value.into(), row.into()), "{message}");
    }
    // In radians they are told as they are written, and not as the degrees that they are turned into.
    let text = "angle_rad,lift\n0,0.4\n0.7,0.42\n0.3,0.5\n3,0.5\n";
    std::fs::write(folder().join("radians.csv"), text).unwrap();
    let message = complaint("table.toml", &model.replace("broken.csv", "radians.csv"));
    let says = "error: radians.csv:4: angle_rad = 0.3: angles must rise: must be above 0.7, line 3";
    assert!(message.starts_with(says), "{message}");
    assert_eq!(underlined(&message), ("0.3".into(), "0.3,0.5".into()), "{message}");
}

#[test]
fn near_names_are_asked_for() {
    let paper = common::osorio_text(&[]);
    let parse = |text: &str| Model::parse("m.toml", text).unwrap_err();
    let program = "[cam]\nlaw = \"program\"\nbase = 0.4\n[[cam.segment]]\nmotion = \"dwel\"\nspan_deg = 360.0\n";
    let follower = paper.split("[cam]").next().unwrap().to_owned();
    for (text, meant) in [
        (
            paper.replace("restitution =", "restitutoin ="),
            Some("did you mean restitution where line 12 says restitutoin?"),
        ),
        (paper.replace("[follower]", "[folower]"), Some("did you mean [follower] where line 6 says [folower]?")),
        (paper.replace("[cam]", "[cams]"), Some("did you mean [cam] where line 14 says [cams]?")),
        (paper.replace("[study]", "[Study]"), Some("did you mean [study]?")),
        (paper.replace("\"arcs\"", "\"arc\""), Some("did you mean \"arcs\"?")),
        (paper.replace("damping = 0.0", "damping = 0.0\ndampingg = 0.0"), Some("did you mean damping?")),
        (follower.clone() + program, Some("did you mean \"dwell\"?")),
        (
            follower.clone() + &program.replace("dwel\"", "dwell\"").replace("cam.segment", "cam.segmnt"),
            Some("did you mean segment where line 17 says segmnt?"),
        ),
        (
            follower.clone() + "[cam]\nlaw = \"table\"\nfile = \"x.csv\"\nspline = \"qubic\"\n",
            Some("did you mean \"cubic\"?"),
        ),
        // Two slips in a long name.
        (
            paper.replace("flank_start_deg =", "flank_strat_dg ="),
            Some("did you mean flank_start_deg where line 19 says flank_strat_dg?"),
        ),
        // What is a name of its own, or like no other, is no slip.
        (paper.replace("rpm_min = 600.0", ""), None),
        (paper.replace("\"arcs\"", "\"helix\""), None),
        (paper.replace("damping = 0.0", "damping = 0.0\nfriction = 0.0"), None),
    ] {
        let error = parse(&text);
        assert_eq!(error.pointer.meant.as_deref(), meant, "{error}");
        assert_eq!(error.to_string().lines().count(), 1);
        assert!(meant.is_none_or(|meant| error.to_string().ends_with(meant)), "{error}");
    }
}

#[test]
fn near_parameters_are_asked_for() {
    for (line, meant) in [
        ("continue --from-rpm 700 --parameter restituton=0.5:0.9", "did you mean restitution?"),
        ("continue --from-rpm 700 --parameter rmp=600:700", "did you mean rpm?"),
        ("curve --rpm 600:700 --parameter cam.flank_radus=0.5:0.9", "did you mean cam.flank_radius?"),
    ] {
        let output = common::corner_impact(line.split(' '));
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2));
        assert!(
            message.contains("allowed are: rpm, cam.base_radius") && message.trim_end().ends_with(meant),
            "{message}"
        );
    }
}

/// That both are in one table says nothing about how near they are.
#[test]
fn names_of_one_table_are_near_by_themselves_alone() {
    let names = ["follower.mass", "cam.base_radius"];
    assert_eq!(nearest("follower.mas", names), Some("follower.mass"));
    assert_eq!(nearest("folower.mass", names), Some("follower.mass"));
    assert_eq!(nearest("follower.bogus", names), None);
    // Nor is a name near that is another table's.
    assert_eq!(nearest("study.mass", names), None);
    assert_eq!(nearest("FOLLOWER.Mass", names), Some("follower.mass"));
    // A third of a long name may be wrong, of a short one a letter.
    assert_eq!(nearest("bsae_raduis", ["base_radius"]), Some("base_radius"));
    assert_eq!(nearest("msas", ["mass"]), Some("mass"));
    assert_eq!(nearest("mxyz", ["mass"]), None);
    assert_eq!(nearest("mas-_s", ["mass"]), None);
}
