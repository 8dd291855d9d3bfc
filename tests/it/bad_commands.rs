//! Do `simulate`, `diagram` and `cam` refuse what cannot be, say what would be, and leave no file behind?

use std::path::Path;
use std::process::Output;

use crate::common;
use tempfile::TempDir;

const MODEL: &str = concat!(env!("PROJECT"), "/models/osorio-2008.toml");

/// A folder in which commands run: nothing in it may change but where a test says so.
struct Place(TempDir);

impl Place {
    fn new() -> Self {
        Self(TempDir::new().unwrap())
    }

    /// Every file below, with what is in it.
    fn holds(&self) -> Vec<(String, Option<Vec<u8>>)> {
        let mut found: Vec<_> = std::fs::read_dir(self.0.path())
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .map(|path| (path.file_name().unwrap().to_str().unwrap().to_owned(), std::fs::read(&path).ok()))
            .collect();
        found.sort();
        found
    }

    fn run(&self, line: &str) -> Output {
        let arguments = line.split_whitespace().map(|word| word.replace("MODEL", MODEL));
        common::program(arguments).current_dir(&self.0).output().unwrap()
    }

    /// Exit 2, nothing on standard output, one message with these parts, and every file as it was.
    #[track_caller]
    fn refuses(&self, line: &str, says: &[&str]) {
        let before = self.holds();
        let output = self.run(line);
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{line}: {message}");
        assert!(output.stdout.is_empty(), "{line}: prints {}", String::from_utf8_lossy(&output.stdout));
        assert!(message.starts_with("error: ") && message.matches("error:").count() == 1, "{line}: {message}");
        for part in says {
            assert!(message.contains(part), "{line}: no \"{part}\" in: {message}");
        }
        assert_eq!(self.holds(), before, "{line}");
    }
}

#[test]
#[ignore = "slow"]
fn numbers_that_cannot_be() {
    let place = Place::new();
    let simulate = |rest: &str| format!("simulate MODEL --events out.csv {rest}");
    let diagram = |rest: &str| format!("diagram MODEL --out out.csv {rest}");
    for rpm in ["0", "-0", "-1", "nan", "NaN", "inf", "-inf", "1e999", "fast", ""] {
        place.refuses(&simulate(&format!("--rpm={rpm}")), &["--rpm <R>"]);
        place.refuses(&diagram(&format!("--rpm={rpm}:700:3")), &["--rpm <LO:HI[:N]|R>"]);
        place.refuses(&diagram(&format!("--rpm=600:{rpm}:3")), &["--rpm <LO:HI[:N]|R>"]);
    }
    place.refuses(&simulate("--rpm 0"), &["above 0"]);
    place.refuses(&simulate("--rpm -5"), &["'-5'", "above 0"]);
    place.refuses(&simulate("--rpm nan"), &["finite"]);
    place.refuses(&simulate("--rpm 1.1e9"), &["1e9 or less"]);
    place.refuses(&simulate(""), &["--rpm <R>", "not provided"]);
    for (range, says) in [
        ("600:700:3:4", "can only be log"),
        ("700:600:3", "the highest speed, 600, is below the lowest, 700"),
        ("600:700:0", "1 speed or more"),
        ("600:700:1", "the lowest and the highest to be the same"),
        ("600:700:-3", "not a number of speeds"),
        ("600:700:2.5", "not a number of speeds"),
        ("600:700:20000000", "10000000 speeds or fewer"),
        ("600:700:99999999999999999999999", "not a number of speeds"),
    ] {
        place.refuses(&diagram(&format!("--rpm {range}")), &["--rpm <LO:HI[:N]|R>", range, says]);
    }
    for count in ["-1", "1.5", "nan", "many", "99999999999999999999999"] {
        for name in ["--revolutions", "--impacts", "--drawn"] {
            place.refuses(&simulate(&format!("--rpm 700 {name}={count}")), &[name, count]);
        }
        for name in ["--transient", "--record", "--threads"] {
            place.refuses(&diagram(&format!("--rpm 600:700:3 {name}={count}")), &[name, count]);
        }
    }
    for count in ["-1", "1e6", "1_000"] {
        for name in ["--revolutions", "--impacts"] {
            place.refuses(&simulate(&format!("--rpm 700 {name} {count}")), &[name, count, "whole number", "digits"]);
        }
        for name in ["--transient", "--record"] {
            place.refuses(
                &diagram(&format!("--rpm 600:700:3 {name} {count}")),
                &[name, count, "whole number", "digits"],
            );
        }
    }
    place.refuses(&simulate("--rpm 700 --drawn 0"), &["--drawn <N>", "1..=1000"]);
    place.refuses(&diagram("--rpm 600:700:3 --threads 0"), &["--threads <N>", "1 to 256"]);
    place.refuses(&diagram("--rpm 600:700:3 --threads 4000"), &["--threads <N>", "1 to 256"]);
    for number in ["nan", "inf", "-inf", "up"] {
        place.refuses(&simulate(&format!("--rpm 700 --start-angle={number}")), &["--start-angle <RAD>", number]);
        place.refuses(&simulate(&format!("--rpm 700 --start-angle={number}deg")), &["--start-angle <RAD>", number]);
        place.refuses(&simulate(&format!("--rpm 700 --strobe={number} --strobe-out s.csv")), &["--strobe <RAD>"]);
        let strobe = format!("--rpm 600:700:3 --section strobe --strobe={number}");
        place.refuses(&diagram(&strobe), &["--strobe <RAD>", number]);
        place.refuses(&simulate(&format!("--rpm 700 --relative-velocity={number}")), &["--relative-velocity <U>"]);
        for state in [format!("{number},0"), format!("0.5,{number}")] {
            place.refuses(&simulate(&format!("--rpm 700 --state={state}")), &["--state <Q,V>"]);
            place.refuses(&diagram(&format!("--rpm 600:700:3 --state={state}")), &["--state <Q,V>"]);
        }
    }
    place.refuses(&simulate("--rpm 700 --state 0.5"), &["--state <Q,V>", "a position and a velocity"]);
    place.refuses(&simulate("--rpm 700 --relative-velocity -0.1"), &["--relative-velocity <U>", "0 or more"]);
    for word in ["poincare", ""] {
        place.refuses(
            &diagram(&format!("--rpm 600:700:3 --section={word}")),
            &["--section <SECTION>", "impact, strobe"],
        );
        place
            .refuses(&diagram(&format!("--rpm 600:700:3 --start={word}")), &["--start <FOLLOWING>", "fixed, up, down"]);
    }
    for order in ["-1", "two", "nan"] {
        place.refuses(&format!("cam MODEL --order={order}"), &["--order <N>", order]);
    }
}

#[test]
fn arguments_that_exclude_or_need_each_other() {
    let place = Place::new();
    for (line, says) in [
        ("--impacts 5 --revolutions 5", ["--revolutions <N>", "--impacts <N>"]),
        ("--impacts 5 --trace x.svg", ["--out <FILE>", "--impacts <N>"]),
        ("--impacts 5 --phase-plane x.svg", ["--phase-plane <FILE>", "--impacts <N>"]),
        ("--state 1,0 --relative-velocity 1", ["--state <Q,V>", "--relative-velocity <U>"]),
        ("--strobe 1", ["--strobe-out <FILE>", "not provided"]),
        ("--strobe-out x.csv", ["--strobe <RAD>", "not provided"]),
        ("--events - --summary", ["standard output", "files"]),
        ("--strobe 1 --strobe-out - --events -", ["standard output", "files"]),
        ("--strobe 1 --strobe-out - --summary", ["standard output", "files"]),
        ("--trace x.eps", ["--out <FILE>", ".svg, .png or .pdf"]),
        ("--phase-plane x", ["--phase-plane <FILE>", ".svg, .png or .pdf"]),
        ("--phase-plane -", ["--phase-plane <FILE>", ".svg, .png or .pdf"]),
        ("--phase-plane x.csv", ["--phase-plane <FILE>", ".svg, .png or .pdf"]),
        ("--drawn 5", ["--drawn", "--out or --phase-plane"]),
    ] {
        place.refuses(&format!("simulate MODEL --rpm 700 {line}"), &says);
    }
    place.refuses("diagram MODEL --rpm 600:700:3 --out - --summary", &["--out -", "--json", "standard output"]);
    for (line, says) in [
        ("--strobe 1 --out out.csv", ["--strobe", "--section strobe"]),
        ("--lyapunov", ["--out <FILE>", "not provided"]),
        ("--lyapunov --summary", ["--out <FILE>", "not provided"]),
    ] {
        place.refuses(&format!("diagram MODEL --rpm 600:700:3 {line}"), &says);
    }
    // A table is not to be taken for a picture.
    for name in ["out.eps", "out.jpg", "out.svg.gz", "out.csv.png.tiff"] {
        let line = format!("diagram MODEL --rpm 600:700:3 --out {name}");
        place.refuses(&line, &["--out <FILE>", name, ".csv, .svg, .png or .pdf"]);
    }
    // Of two files of one name the second alone would be left.
    for [(one, first), (other, second)] in [
        [("--events", "out.csv"), ("--strobe 1 --strobe-out", "out.csv")],
        [("--out", "out.svg"), ("--phase-plane", "./out.svg")],
        [("--events", "out.svg"), ("--out", "out.svg")],
        [("--strobe 1 --strobe-out", "./out.png"), ("--phase-plane", "out.png")],
    ] {
        let says = [one, other].map(|option| option.trim_start_matches("--strobe 1 "));
        let name = second.trim_start_matches("./");
        place.refuses(&format!("simulate MODEL --rpm 700 {one} {first} {other} {second}"), &[says[0], says[1], name]);
    }
}

/// Widths, letters and ranges that make no figure; and where there is none to have them.
#[test]
fn looks_that_cannot_be() {
    let place = Place::new();
    for (look, says) in [
        ("--width 85", ["--width <WIDTH>", "85mm"]),
        ("--width 0mm", ["--width <WIDTH>", "above 0"]),
        ("--width nanmm", ["--width <WIDTH>", "finite"]),
        ("--width=-85mm", ["--width <WIDTH>", "above 0"]),
        ("--width 1mm", ["cannot be made", "10.6 to 847 mm"]),
        ("--width 85mm --size 40pt", ["letters of 40.00 pt", "do not fit"]),
        ("--size 8", ["--size <SIZE>", "unit"]),
        ("--font nosuch.ttf", ["nosuch.ttf", "cannot be read as a font"]),
        ("--font NoSuchLetters", ["NoSuchLetters", "is installed"]),
        ("--height 5pt", ["1.8 mm high", "10.6 mm"]),
        ("--height 40mm", ["cannot be 40.0 mm high", "it needs"]),
        ("--legend left", ["--legend <PLACE>", "none, above, below or right"]),
        ("--title --no-title", ["--title", "cannot be used with"]),
        ("--script out.txt", ["--script <FILE>", "must end in .py"]),
        ("--script out.py --events out.csv", ["--events", "the data of --script"]),
        ("--script out.py --phase-plane plane.svg", ["--script draws one picture", "are two"]),
        ("--theme dark", ["--theme <THEME>", "screen, print"]),
        ("--x 2:1", ["--x-range <LO:HI>", "not below"]),
        ("--x 1:inf", ["--x-range <LO:HI>", "finite"]),
        ("--x 5:6", ["--x-range from 5 to 6", "shows nothing"]),
        ("--y 7:8", ["--y-range from 7 to 8", "shows nothing"]),
        ("--y 0.4:0.4001", ["--y-range from 0.4", "less than a hundredth"]),
    ] {
        place.refuses(&format!("simulate MODEL --rpm 183 --revolutions 3 --trace out.svg {look}"), &says);
    }
    for look in [
        "--width 85mm",
        "--height 85mm",
        "--size 8pt",
        "--title",
        "--no-title",
        "--legend below",
        "--theme print",
        "--x 0:1",
        "--y 0:1",
        "--script out.py",
    ] {
        place.refuses(&format!("cam MODEL {look}"), &["--out <FILE>", "not provided"]);
        place.refuses(
            &format!("diagram MODEL --rpm 600:700:3 --out out.csv {look}"),
            &["pictures", ".svg, .png or .pdf"],
        );
    }
}

#[test]
fn models_and_starts_that_cannot_be() {
    let place = Place::new();
    std::fs::write(place.0.path().join("broken.toml"), "[follower]\nmass = -1.0\n").unwrap();
    for command in ["simulate", "diagram", "cam"] {
        let rest = match command {
            "simulate" => "--rpm 700 --events out.csv --trace out.svg",
            "diagram" => "--rpm 600:700:3 --out out.csv",
            _ => "",
        };
        place.refuses(&format!("{command} none.toml {rest}"), &["none.toml", "cannot be read"]);
        place.refuses(&format!("{command} . {rest}"), &["cannot be read"]);
        place.refuses(&format!("{command} broken.toml {rest}"), &["broken.toml:2: follower.mass = -1.0", "above 0"]);
        place.refuses(&format!("{command} MODEL MODEL {rest}"), &["unexpected argument"]);
        place.refuses(&format!("{command} MODEL {rest} --no-such"), &["--no-such"]);
    }
    let below = "--state 0.3999,0 --start-angle 0.5";
    let says = ["below the cam by 1.000e-4 in the model's unit of length", "28.6479 deg", "revolution 0"];
    place.refuses(&format!("simulate MODEL --rpm 700 {below} --events out.csv --trace out.svg"), &says);
    for start in ["fixed", "up", "down"] {
        let line = format!("diagram MODEL --rpm 600:700:3 {below} --start {start} --out out.csv");
        // The first speed of the sweep.
        let rpm = if start == "down" { "at 700 rpm" } else { "at 600 rpm" };
        place.refuses(&line, &[rpm, says[0], says[1]]);
        place.refuses(&line.replace("csv", "svg"), &[rpm, says[0], says[1]]);
    }
    // Finite, but not what a run can hold.
    place.refuses("simulate MODEL --rpm 700 --state 1e308,1e308 --events out.csv", &["not finite"]);
    // An angle from any turn is one of the first.
    let page = |angle: &str| {
        let line = format!("simulate MODEL --rpm 700 --revolutions 3 --start-angle {angle} --events -");
        let output = place.run(&line);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        output.stdout
    };
    assert_eq!(page("-6.283185307179586"), page("0"));
    assert_eq!(page("-1e-300"), page("0"));
}

/// In a folder that is missing, not a folder, or not to be written to; onto a folder, a full disk, an empty name.
#[test]
fn files_that_cannot_be_written() {
    let place = Place::new();
    std::fs::write(place.0.path().join("kept.csv"), "before").unwrap();
    std::fs::create_dir(place.0.path().join("folder")).unwrap();
    let simulate = "simulate MODEL --rpm 700";
    let targets = |name: &str| {
        let (csv, svg) = (format!("{name}.csv"), format!("{name}.svg"));
        [
            format!("{simulate} --events {csv}"),
            format!("{simulate} --strobe 1 --strobe-out {csv}"),
            format!("{simulate} --trace {svg}"),
            format!("{simulate} --phase-plane {svg}"),
            format!("diagram MODEL --rpm 600:700:3 --out {csv}"),
            format!("diagram MODEL --rpm 600:700:3 --out {svg}"),
            // The first would be written, the second not.
            format!("{simulate} --events new.csv --strobe 1 --strobe-out {csv}"),
            format!("{simulate} --events new.csv --trace {svg}"),
            format!("{simulate} --events kept.csv --phase-plane {svg}"),
            format!("{simulate} --trace new.svg --phase-plane {svg}"),
        ]
    };
    for (name, says) in [("missing/out", "there is no folder missing"), ("kept.csv/out", "kept.csv/out")] {
        for line in targets(name) {
            place.refuses(&line, &[name, "cannot be written", says]);
        }
    }
    place.refuses(&format!("{simulate} --events folder"), &["folder", "cannot be written", "directory"]);
    place.refuses("diagram MODEL --rpm 600:700:3 --out folder", &["folder", "cannot be written", "directory"]);
    if Path::new("/dev/full").exists() {
        for rest in ["--events /dev/full", "--strobe 1 --strobe-out /dev/full"] {
            place.refuses(&format!("{simulate} {rest}"), &["/dev/full: cannot be written", "No space left"]);
            // Many rows, which do not wait in a buffer.
            let long = format!("simulate MODEL --rpm 183 --revolutions 2000 {rest}");
            place.refuses(&long, &["/dev/full: cannot be written", "No space left"]);
        }
        let full = "diagram MODEL --rpm 600:700:300 --out /dev/full";
        place.refuses(full, &["/dev/full: cannot be written", "No space left"]);
        let full = format!("{simulate} --events new.csv --strobe 1 --strobe-out /dev/full");
        place.refuses(&full, &["/dev/full: cannot be written", "No space left"]);
    }
}

/// Standard output on a full disk is a file like any other.
#[test]
fn standard_output_that_is_full() {
    if !Path::new("/dev/full").exists() {
        return;
    }
    for line in [
        "simulate MODEL --rpm 183 --events -",
        "simulate MODEL --rpm 183 --strobe 1 --strobe-out -",
        "simulate MODEL --rpm 183 --summary",
        "simulate MODEL --rpm 183",
        "diagram MODEL --rpm 600:700:3 --out -",
        "diagram MODEL --rpm 600:700:3 --summary",
        "cam MODEL",
        "cam MODEL --json",
    ] {
        let full = std::fs::File::options().write(true).open("/dev/full").unwrap();
        let arguments = line.split_whitespace().map(|word| word.replace("MODEL", MODEL));
        let output = common::program(arguments).stdout(full).output().unwrap();
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{line}: {message}");
        assert!(message.contains("standard output") && message.contains("No space left"), "{line}: {message}");
    }
}

/// Only a user who may not write everywhere can try this one.
#[cfg(unix)]
#[test]
fn folders_that_are_not_to_be_written_to() {
    use std::os::unix::fs::PermissionsExt;
    let place = Place::new();
    let shut = place.0.path().join("shut");
    std::fs::create_dir(&shut).unwrap();
    std::fs::set_permissions(&shut, std::fs::Permissions::from_mode(0o555)).unwrap();
    // Root writes all the same; the system's own folders are shut to it as well.
    let folder = if std::fs::write(shut.join("probe"), "").is_ok() { "/proc" } else { "shut" };
    if Path::new(folder).exists() || folder == "shut" {
        place
            .refuses(&format!("simulate MODEL --rpm 700 --events {folder}/out.csv"), &["out.csv", "cannot be written"]);
        place.refuses(&format!("simulate MODEL --rpm 700 --trace {folder}/out.svg"), &["out.svg", "cannot be written"]);
        place.refuses(
            &format!("diagram MODEL --rpm 600:700:3 --out {folder}/out.png"),
            &["out.png", "cannot be written"],
        );
    }
    std::fs::set_permissions(&shut, std::fs::Permissions::from_mode(0o755)).unwrap();
}

/// Nothing at all is asked for, and that is what there is.
#[test]
#[ignore = "slow"]
fn runs_of_no_length() {
    let place = Place::new();
    for line in [
        "simulate MODEL --rpm 700 --revolutions 0",
        "simulate MODEL --rpm 700 --impacts 0",
        "diagram MODEL --rpm 600:700:3 --transient 0 --record 0",
    ] {
        let output = place.run(line);
        let page = String::from_utf8(output.stdout).unwrap();
        assert_eq!(output.status.code(), Some(0), "{line}");
        assert!(!page.contains("NaN") && !page.contains("inf"), "{line}: {page}");
    }
    for extension in ["svg", "png"] {
        let line =
            format!("simulate MODEL --rpm 700 --revolutions 0 --trace t.{extension} --phase-plane p.{extension}");
        let output = place.run(&line);
        assert_eq!(output.status.code(), Some(0), "{line}: {}", String::from_utf8_lossy(&output.stderr));
        let output = place.run(&format!("diagram MODEL --rpm 600:700:3 --record 0 --out d.{extension}"));
        assert_eq!(output.status.code(), Some(0), "{line}: {}", String::from_utf8_lossy(&output.stderr));
    }
    assert_eq!(place.holds().len(), 6);
}

/// A follower that flies off is not waited for.
#[test]
fn an_impact_that_never_comes() {
    let place = Place::new();
    let model = std::fs::read_to_string(MODEL).unwrap();
    let model = model.replace("stiffness = 1430.8", "stiffness = 0.0").replace("gravity = 0.0", "gravity = -1.0");
    std::fs::write(place.0.path().join("away.toml"), model).unwrap();
    let line = "simulate away.toml --rpm 70 --impacts 10 --events out.csv";
    place.refuses(line, &["no impact in 100000 revolutions", "deg of revolution"]);
    let output = place.run("simulate away.toml --rpm 700 --revolutions 100000000 --summary");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}
