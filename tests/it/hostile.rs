//! Does what somebody else wrote, or what becomes of the streams, get the better of the program? docs/reliability.md has the figures.

use std::fs;
use std::process::{Output, Stdio};

use crate::common::{osorio_text, program, text};
use corner_impact::untrusted;
use tempfile::TempDir;

const MODEL: &str = "models/osorio-2008.toml";

fn run(words: &[&str]) -> Output {
    program(words).output().unwrap()
}

/// What is said where a command is refused.
#[track_caller]
fn refused(output: Output) -> String {
    let said = text(output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(output.stdout.is_empty() && said.starts_with("error: "), "{said}");
    said
}

/// The model with a text in the place of one of its lines, as a file in a folder of its own.
fn file(field: &str, value: &str) -> (TempDir, String) {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("model.toml");
    fs::write(&path, osorio_text(&[(field, value)])).unwrap();
    (folder, path.to_str().unwrap().to_owned())
}

/// Unicode's properties Default_Ignorable_Code_Point and Bidi_Control, of which the second is a part of the first: ends of ranges.
const UNSEEN: [[u32; 2]; 17] = [
    [0xad; 2],
    [0x34f; 2],
    [0x61c; 2],
    [0x115f, 0x1160],
    [0x17b4, 0x17b5],
    [0x180b, 0x180f],
    [0x200b, 0x200f],
    [0x202a, 0x202e],
    [0x2060, 0x206f],
    [0x3164; 2],
    [0xfe00, 0xfe0f],
    [0xfeff; 2],
    [0xffa0; 2],
    [0xfff0, 0xfff8],
    [0x1bca0, 0x1bca3],
    [0x1d173, 0x1d17a],
    [0xe0000, 0xe0fff],
];

fn is_unseen(letter: char) -> bool {
    UNSEEN.iter().any(|[first, last]| (*first..=*last).contains(&u32::from(letter)))
}

#[track_caller]
fn steers_nothing(shown: &str, what: &str) {
    let odd = shown.chars().find(|letter| letter.is_control() && *letter != '\n' || is_unseen(*letter));
    assert_eq!(odd, None, "{what}: {shown}");
    assert!(what.is_empty() || shown.contains(what), "no {what} in: {shown}");
}

#[test]
fn nothing_steers_a_terminal_or_a_page() {
    let odd = "\u{1b}[31m\u{9b}1m\u{202e}\u{7}";
    let shown = "\\u{1b}[31m\\u{9b}1m\\u{202e}\\u{7}";
    let named = |field: &str| file(field, "\"a\\u001b[31m\\u009b1m\\u202e\\u0007\"");
    let (_kept, path) = named("name");
    steers_nothing(&text(run(&["cam", &path]).stdout), shown);
    let page = run(&["simulate", &path, "--rpm", "183", "--color", "always"]).stdout;
    assert!(text(page).contains(shown));
    let (_also, path) = named("law");
    steers_nothing(&refused(run(&["cam", &path])), "cam.law = \"a\\u001b[31m");
    steers_nothing(&refused(run(&["cam", &format!("none{odd}.toml")])), shown);
    steers_nothing(&refused(run(&["orbit", MODEL, "--rpm", &format!("6{odd}")])), shown);
    steers_nothing(&refused(run(&["orbit", MODEL, &format!("--rpn{odd}")])), shown);
    steers_nothing(&refused(run(&["orbit", MODEL, "--rpm", "680", "--set", &format!("x{odd}=1")])), shown);
    steers_nothing(&refused(run(&["figure", MODEL, &format!("x{odd}")])), shown);
    let out = format!("/nowhere{odd}/x.csv");
    steers_nothing(&refused(run(&["simulate", MODEL, "--rpm", "183", "--events", &out])), shown);
    // A line that is drawn, raw in a file that is none.
    let folder = TempDir::new().unwrap();
    let raw = folder.path().join("raw.toml");
    fs::write(&raw, format!("name = \"a\" # {odd}\nmass = 1\n")).unwrap();
    let drawn = refused(run(&["cam", raw.to_str().unwrap()]));
    steers_nothing(&drawn, "?[31m\u{b7}1m");
}

/// All of Unicode, letter by letter: written out where it is shown, kept where a program reads it.
#[test]
#[ignore = "slow"]
fn every_letter_that_nobody_sees_is_written_out() {
    for letter in (0..=0x10_ffff).filter_map(char::from_u32) {
        let text = letter.to_string();
        let is_odd = letter.is_control() || is_unseen(letter) || matches!(letter, '\u{2028}' | '\u{2029}');
        let shown = untrusted::value(&text).into_owned();
        assert_eq!(shown, if is_odd { letter.escape_default().to_string() } else { text.clone() });
        let in_place = untrusted::in_place(&text);
        assert_eq!((in_place == text, in_place.len()), (!is_odd || matches!(letter, '\n' | '\t'), text.len()));
        let json = untrusted::json(format!("\"{text}\""));
        assert_eq!(json.contains(letter), !is_odd || letter == '\n');
        if is_odd && !letter.is_ascii_control() {
            assert_eq!(serde_json::from_str::<String>(&json).unwrap(), text);
        }
    }
}

#[test]
fn no_letter_that_nobody_sees_gets_out() {
    let folder = TempDir::new().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let odd: String = UNSEEN.as_flattened().iter().filter_map(|letter| char::from_u32(*letter)).collect();
    fs::write(at("model.toml"), osorio_text(&[("name", &format!("\"a{odd}b\""))])).unwrap();
    steers_nothing(&text(run(&["cam", &at("model.toml")]).stdout), "a\\u{ad}\\u{ad}\\u{34f}");
    let json = text(run(&["cam", &at("model.toml"), "--json"]).stdout);
    steers_nothing(&json, "\\udb43\\udfff");
    let document: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(document["model"], format!("a{odd}b"));
    assert_eq!(run(&["cam", &at("model.toml"), "--out", &at("cam.svg")]).status.code(), Some(0));
    steers_nothing(&fs::read_to_string(at("cam.svg")).unwrap(), "a\\u{ad}\\u{ad}");
    steers_nothing(&refused(run(&["cam", &format!("none{odd}.toml")])), "\\u{61c}");
    // Raw in a file that is none, where the line is drawn.
    fs::write(at("raw.toml"), format!("name = a # {odd}\n")).unwrap();
    steers_nothing(&refused(run(&["cam", &at("raw.toml")])), "\u{fffd}\u{fffd}");
}

/// A model may name any file of whoever runs it.
#[test]
fn no_line_of_a_file_that_is_no_table_is_shown() {
    let folder = TempDir::new().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let table = |name: &str| include_str!("../../models/laws/table-cubic.toml").replace("osorio-2008.csv", name);
    let says = |name: &str, contents: &str| {
        fs::write(at(name), contents).unwrap();
        fs::write(at("model.toml"), table(name)).unwrap();
        refused(run(&["cam", &at("model.toml")]))
    };
    for secret in [
        "127.0.0.1 secret\n127.0.0.2 hidden\n",
        "root:secret:0:0:root:/root:/bin/bash\n",
        "name = secret\nlicense.workspace = true\n",
        "eval \"$(secret init -)\"\n-1 secret\n",
        "-----BEGIN SECRET KEY-----\nb3BlbnNzaC1rZXktdjEAAAAABG5vbmU\n",
        "angle secret lift\n",
        &format!("{}1 2\nangle,lift\n0,secret\n", "secret\n".repeat(20)),
    ] {
        let said = says("hosts", secret).replace("SECRET", "secret");
        assert!(!said.contains("secret") && !said.contains("hidden") && !said.contains("127."), "{said}");
    }
    // Of what begins like a table the line is shown.
    for line in ["angle_deg,lift\n0,slip\n", "0,1\n1,slip\n2,3\n", "title\n\n# note\nangle_deg,lift\n0,slip\n"] {
        let said = says("hosts", line);
        assert!(said.contains("slip") && said.contains("-[") && said.contains("hosts:"), "{said}");
    }
    let title = format!("{}0,1\n1,slip\n2,3\n", "title\n".repeat(19));
    assert!(says("hosts", &title).contains("slip"));
}

/// Pipes that nobody writes to, in the place of whatever is read.
#[cfg(unix)]
#[test]
fn nothing_waits_for_a_pipe() {
    let folder = TempDir::new().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    assert!(std::process::Command::new("mkfifo").arg(at("pipe")).status().unwrap().success());
    fs::write(at("model.toml"), include_str!("../../models/laws/table-cubic.toml").replace("osorio-2008.csv", "pipe"))
        .unwrap();
    let no_file = "it is a device, a pipe or a socket, not a file";
    for words in [
        vec!["cam".to_owned(), at("pipe")],
        vec!["cam".to_owned(), at("model.toml")],
        vec!["cam".to_owned(), MODEL.to_owned(), "--out".to_owned(), at("a.svg"), "--font".to_owned(), at("pipe")],
    ] {
        let said = refused(program(&words).output().unwrap());
        assert!(said.contains(no_file), "{said}");
    }
}

/// Every command, with the same sentence, before it writes anything.
#[test]
#[ignore = "slow"]
fn a_corner_that_cannot_be_is_refused_by_every_command() {
    let folder = TempDir::new().unwrap();
    let rows: Vec<String> = (0..36)
        .map(|row| {
            let lift = if (6..=30).contains(&row) {
                0.04 + 0.005 * (1.0 - f64::from(row * 15 - 90).to_radians().cos())
            } else {
                0.04
            };
            format!("[{}, {lift}]", 10 * row)
        })
        .collect();
    let model = |corners: &str| {
        format!(
            "[follower]\nmass = 1.0\ndamping = 1.0\nstiffness = 16000.0\ngravity = 9.81\nrest_position = 0.02\nrestitution = 0.5\n\
             [cam]\nlaw = \"table\"\nspline = \"smoothing\"\nrows = [{}]\n{corners}\n[study]\nrpm_min = 100.0\nrpm_max = 200.0\n",
            rows.join(", ")
        )
    };
    for (corners, says) in [
        ("corners_deg = [60.0, 60.0]", "has 60 twice"),
        ("corners_deg = [-60, 300]", "has 300 twice"),
        ("corners_deg = [0, 60, 360]", "has 0 twice"),
        ("corners_deg = [0.0]", "has 0, which is inside a dwell"),
        ("corners_deg = [355]", "has 355, which is inside a dwell"),
        ("corners_deg = [20.0]\ndwells_deg = [[10, 40]]", "has 20, which is inside a dwell"),
    ] {
        fs::write(folder.path().join("model.toml"), model(corners)).unwrap();
        let mut sentences = std::collections::BTreeSet::new();
        for line in [
            "cam --out o.pdf",
            "design --out o.svg",
            "simulate --rpm 200 --events o.csv",
            "speeds --rpm 100:200 --speeds 2 --out o.csv",
            "diagram --rpm 100:200:2 --out o.csv",
            "chart --over rpm=100:200:2 --over mass=1:2:2 --out o.csv",
            "chart --over rpm=100:200:2 --over mass=1:2:2 --out o.zarr",
            "basins --rpm 200 --grid 2x2 --out o.csv",
            "orbit --rpm 200",
            "continue --rpm 200 --over rpm=100:200 --out o.csv",
            "curve --rpm 100:200 --over mass=1:2 --out o.csv",
            "chaos --rpm 200 --out o.svg",
            "locate --rpm 100:200",
            "certify --rpm 100:200",
            "verify --no-external",
            "figure cam --out o.svg",
            "report --no-external --out o.html",
            "compare --set mass=2",
        ] {
            let mut words: Vec<&str> = line.split(' ').collect();
            words.insert(1, "model.toml");
            let output = program(&words).current_dir(&folder).output().unwrap();
            let said = text(output.stderr);
            assert_eq!(output.status.code(), Some(2), "{line}: {said}");
            assert_eq!(fs::read_dir(&folder).unwrap().count(), 1, "{line}");
            let said = said.lines().find(|line| line.starts_with("error: ")).unwrap_or_default();
            assert!(said.contains(says), "{line}: {said}");
            sentences.insert(said.to_owned());
        }
        assert_eq!(sentences.len(), 1, "{sentences:?}");
    }
}

#[test]
fn a_message_is_no_longer_than_a_page() {
    let long = "9".repeat(100_000);
    let quoted = format!("\"{long}\"");
    let cut = format!("{0}...{0}", "9".repeat(20));
    let says = |output: Output| {
        let said = refused(output);
        assert!(said.trim_end().chars().count() <= 2000, "{} letters: {}", said.len(), &said[..2000]);
        assert!(said.contains(&cut), "{said}");
    };
    for (field, value) in [
        ("mass", quoted.as_str()),
        ("law", &quoted),
        ("name", &quoted),
        ("source", &format!("3\n{long} = 1")),
        ("source", &long),
    ] {
        let (_kept, path) = file(field, value);
        let said = refused(run(&["cam", &path]));
        assert!(said.len() < 1000, "{field}: {} bytes", said.len());
    }
    says(run(&["cam", &file("mass", &quoted).1.replace("model.toml", &format!("{long}.toml"))]));
    says(run(&["orbit", MODEL, "--rpm", &format!("x{long}")]));
    says(run(&["orbit", MODEL, "--rpm", "680", "--set", &format!("{long}=1")]));
    says(run(&["orbit", MODEL, &format!("--{long}")]));
    says(run(&["figure", MODEL, &long]));
    says(run(&[&long]));
}

/// A file without an end is as good as one of 50 MB; so is a line.
#[test]
#[ignore = "slow"]
fn files_and_lines_have_a_limit() {
    let folder = TempDir::new().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let model = osorio_text(&[]);
    fs::write(at("long.toml"), format!("{model}\n{}", "# more\n".repeat(3_000_000))).unwrap();
    fs::write(at("line.toml"), format!("# {}\n{model}", "x".repeat(2 << 20))).unwrap();
    fs::write(at("fits.toml"), format!("{model}\n{}", "# more\n".repeat(100_000))).unwrap();
    let whole = "it is longer than 16 MiB, the largest allowed";
    assert!(refused(run(&["cam", &at("long.toml")])).contains(whole));
    assert!(refused(run(&["cam", &at("line.toml")])).contains("line 1 is longer than 1 MiB"));
    assert_eq!(run(&["cam", &at("fits.toml")]).status.code(), Some(0));
    let huge = fs::File::create(at("huge.ttf")).unwrap();
    huge.set_len((64 << 20) + 1).unwrap();
    let font = |name: &str| ["cam", MODEL, "--out", &at("cam.svg"), "--font", name].map(str::to_owned);
    let drawn = |name: &str| run(&font(name).each_ref().map(String::as_str));
    assert!(refused(drawn(&at("huge.ttf"))).contains("cannot be read as a font: it is longer than 64 MiB"));
    huge.set_len(64 << 20).unwrap();
    assert!(refused(drawn(&at("huge.ttf"))).ends_with("huge.ttf: cannot be read as a font\n"));
    let whole = "it is a device, a pipe or a socket, not a file";
    if fs::metadata("/dev/zero").is_ok() {
        assert!(refused(run(&["cam", "/dev/zero"])).contains(whole));
        assert!(refused(drawn("/dev/zero")).contains(whole));
        assert!(!fs::exists(at("cam.svg")).unwrap());
        let table = include_str!("../../models/laws/table-cubic.toml").replace("osorio-2008.csv", "/dev/zero");
        fs::write(at("table.toml"), table).unwrap();
        let said = refused(run(&["cam", &at("table.toml")]));
        assert!(said.contains("cam.file") && said.contains(whole), "{said}");
        // A store of a chart, asked for and gone on with, is neither read further nor begun anew.
        fs::create_dir(at("a.zarr")).unwrap();
        std::os::unix::fs::symlink("/dev/zero", at("a.zarr/zarr.json")).unwrap();
        assert!(refused(run(&["chart", "--status", &at("a.zarr")])).contains(whole));
        let chart = ["chart", MODEL, "--x", "rpm=660:760:2", "--y", "restitution=0.4:0.6:2", "--out", &at("a.zarr")];
        assert!(refused(run(&chart)).contains(whole));
    }
}

#[test]
fn numbers_that_overflow_are_refused_by_name() {
    for (field, number, says) in [
        ("mass", "1e-154", "follower.mass = 1e-154: makes mass 1e-154, below 1e-75"),
        ("stiffness", "1e300", "follower.stiffness = 1e300: makes stiffness / mass 8.19"),
        ("damping", "1e200", "follower.damping = 1e200: makes damping / mass 8.19"),
        ("gravity", "-1e100", "follower.gravity = -1e100: makes gravity -1e100, above 1e75 in size"),
        ("rest_position", "1e154", "follower.rest_position = 1e154: makes rest_position 1e154"),
        ("rest_position", "1e74", "makes stiffness * rest_position / mass 1.17"),
    ] {
        let (_kept, path) = file(field, number);
        let said = refused(run(&["cam", &path]));
        assert!(said.contains(says), "{says}: {said}");
    }
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("harmonic.toml");
    for (from, to) in [("offset = 0.1", "offset = 1e154"), ("[0.02, 0.001]", "[1.7e308, 0.0]")] {
        let model = include_str!("../../models/laws/harmonic.toml");
        assert!(model.contains(from));
        fs::write(&path, model.replace(from, to)).unwrap();
        let said = refused(run(&["cam", path.to_str().unwrap()]));
        assert!(said.contains("gives lifts or derivatives too large, above 1e75"), "{to}: {said}");
    }
}

#[test]
fn a_name_in_quotes_is_one_name() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("model.toml");
    for (line, says) in [
        ("\"follower.mass\" = 2.0", "\"follower.mass\" must not be in quotes"),
        ("\"segment[0]\" = 2.0", "\"segment[0]\" must not be in quotes"),
        ("'a.b' = { c = 1 }", "'a.b' must not be in quotes"),
    ] {
        fs::write(&path, format!("{line}\n{}", osorio_text(&[]))).unwrap();
        let said = refused(run(&["cam", path.to_str().unwrap()]));
        assert!(said.contains("model.toml:1: ") && said.contains(says) && said.contains("without quotes"), "{said}");
    }
    // Dots that part names stay what they are.
    let model = osorio_text(&[]);
    let (rest, _) = model.split_once("[study]").unwrap();
    fs::write(&path, format!("study.rpm_min = 600.0\nstudy.rpm_max = 760.0\n{rest}")).unwrap();
    assert_eq!(run(&["cam", path.to_str().unwrap()]).status.code(), Some(0));
}

/// However few its rows are, a table that leaves half a turn out is none of a cam.
#[test]
fn half_a_turn_is_no_cam() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("model.toml");
    let model = include_str!("../../models/laws/table-cubic.toml");
    fs::write(&path, model.replace("osorio-2008.csv", "rows.csv")).unwrap();
    let table = |angles: &[f64]| {
        let rows: String = angles.iter().zip(0..).map(|(angle, lift)| format!("{angle},0.{lift}\n")).collect();
        fs::write(folder.path().join("rows.csv"), format!("angle_deg,lift\n{rows}")).unwrap();
        run(&["cam", path.to_str().unwrap()])
    };
    for angles in [&[0.0, 90.0, 180.0][..], &[0.0, 60.0, 120.0, 180.0], &[0.0, 30.0, 100.0], &[180.0, 250.0, 360.0]] {
        let said = refused(table(angles));
        assert!(said.contains("and a whole turn is needed"), "{said}");
    }
    for angles in [&[0.0, 120.0, 240.0][..], &[0.0, 90.0, 185.0], &[0.0, 10.0, 20.0, 190.0]] {
        assert_eq!(table(angles).status.code(), Some(0), "{angles:?}");
    }
}

#[test]
fn two_results_do_not_go_to_one_file() {
    let folder = TempDir::new().unwrap();
    fs::create_dir(folder.path().join("sub")).unwrap();
    fs::write(folder.path().join("b.csv"), "mine").unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink("b.csv", folder.path().join("link.csv")).unwrap();
    let absolute = folder.path().join("a.csv");
    for (one, two) in
        [("a.csv", "sub/../a.csv"), ("./a.csv", "a.csv"), ("a.csv", absolute.to_str().unwrap()), ("b.csv", "link.csv")]
    {
        let words = ["simulate", "--rpm", "183", "--events", one, "--strobe", "1", "--strobe-out", two];
        let output = program(words).current_dir(&folder).output().unwrap();
        let said = text(output.stderr);
        assert!(output.status.code() == Some(2) && said.contains("have the same path"), "{one} {two}: {said}");
    }
    let table = program(["new", "x.csv", "--law", "table"]).current_dir(&folder).output().unwrap();
    assert!(refused(table).contains("have the same path"));
    assert!(!absolute.exists() && fs::read_to_string(folder.path().join("b.csv")).unwrap() == "mine");
    // Apart they are two.
    let words = ["simulate", MODEL, "--rpm", "183", "--events", "a.csv", "--strobe", "1", "--strobe-out", "sub/a.csv"];
    let model = std::path::Path::new(crate::common::ROOT).join(MODEL);
    let words = words.map(|word| if word == MODEL { model.to_str().unwrap() } else { word });
    assert_eq!(program(words).current_dir(&folder).output().unwrap().status.code(), Some(0));
}

#[test]
fn threads_are_counted_by_one_rule() {
    let said = |words: &[&str], threads: &str| {
        let mut words = program(words.iter().copied());
        words.env("RAYON_NUM_THREADS", threads).output().unwrap()
    };
    let rule = "must be a whole number of threads from 1 to 256";
    for command in
        [&["locate", MODEL, "--rpm", "670:680"][..], &["speeds"], &["basins", "--rpm", "678", "--grid", "2x2"]]
    {
        for threads in ["100000", "1025", "-1", "two"] {
            let said = refused(said(command, threads));
            assert!(said.contains(&format!("RAYON_NUM_THREADS = {threads}: {rule}")), "{said}");
        }
    }
    let basins = ["basins", MODEL, "--rpm", "678", "--grid", "2x2", "--out", "-"];
    let one = said(&basins, "1").stdout;
    for threads in ["", "0", "64"] {
        assert_eq!(said(&basins, threads).stdout, one, "{threads}");
    }
    for command in
        [&["diagram", "--rpm", "670:680:2"][..], &basins, &["chart", "--x", "rpm=670:680:2", "--y", "mass=1:2:2"]]
    {
        for threads in ["0", "1025", "two"] {
            assert!(refused(run(&[command, &["--threads", threads]].concat())).contains(rule));
        }
    }
}

/// A run that fails after rows are on standard output.
#[test]
fn rows_before_a_failure_say_that_they_are_not_all() {
    let words = ["simulate", MODEL, "--rpm", "680", "--state", "0.5,1e200", "--events", "-"];
    let output = run(&words);
    assert_eq!(output.status.code(), Some(2));
    let (rows, said) = (text(output.stdout), text(output.stderr));
    assert!(said.contains("a state that is not finite"), "{said}");
    assert_eq!(rows.lines().last(), Some("# unfinished: standard error says why"), "{rows}");
    assert!(rows.starts_with("revolution,"), "{rows}");
    let whole = run(&["simulate", MODEL, "--rpm", "680", "--events", "-"]);
    assert!(!text(whole.stdout).contains('#'));
}

/// Where nobody reads what a command prints, or where there is no room, it ends; files are written all the same.
#[cfg(target_os = "linux")]
#[test]
fn what_nobody_reads_is_not_computed() {
    // A million revolutions at each of ten million speeds.
    let endless = ["diagram", MODEL, "--rpm", "670:680:10000000", "--transient", "1000000"];
    for words in [&endless[..], &["--help"], &["--version"], &["man"]] {
        let full = fs::File::options().write(true).open("/dev/full").unwrap();
        let output = program(words).stdout(full).stderr(Stdio::piped()).output().unwrap();
        let said = text(output.stderr);
        assert!(output.status.code() == Some(2) && said.starts_with("error: standard output: No space"), "{said}");
    }
    let mut child = program(endless).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
    std::thread::sleep(std::time::Duration::from_millis(100));
    drop(child.stdout.take());
    assert_eq!(child.wait().unwrap().code(), Some(2));
    let mut endless = program(["speeds", MODEL, "--rpm", "600:700", "--starts", "1000000"]);
    let mut child = endless.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
    drop(child.stdout.take());
    assert_eq!(child.wait().unwrap().code(), Some(2));

    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out.csv");
    let words = ["diagram", MODEL, "--rpm", "670:680:3", "--out", out.to_str().unwrap()];
    let mut child = program(words).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
    drop(child.stdout.take());
    child.wait().unwrap();
    assert!(out.exists(), "a file is not for whoever reads standard output");
}
