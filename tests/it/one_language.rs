//! Do all commands take the same words, and do pages fit a terminal of 80 columns?

use std::collections::BTreeSet;

use corner_impact_cli::cli::{Exit, Terminal, run_at};
use tempfile::TempDir;

use crate::command_line::COMMANDS;
use crate::common::{corner_impact, in_one_line, program, text};

/// A command line in the project's folder: words parted by blanks.
fn run(line: &str) -> (i32, String, String) {
    let output = corner_impact(line.split_whitespace());
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

/// What a command prints, but for how long it took.
fn printed(line: &str) -> String {
    let (exit, out, err) = run(line);
    assert_eq!(exit, 0, "{line}: {err}");
    let is_time = |line: &&str| {
        line.contains("wall_s") || line.contains("cpu_s") || line.contains(" s of processor") || line.contains(" ns a ")
    };
    out.lines().filter(|line| !is_time(line)).map(|line| format!("{line}\n")).collect()
}

#[test]
#[ignore = "slow"]
fn older_spellings_do_the_same() {
    for (old, new) in [
        ("simulate --rpm 183 --revolutions 3 --summary", "simulate --rpm 183 --revolutions 3 --json"),
        ("simulate --rpm 183 --revolutions 3 --trace -", "simulate --rpm 183 --revolutions 3 --out -"),
        ("diagram --rpm 660:670:3 --summary", "diagram --rpm 660:670:3 --json"),
        ("basins --rpm 678 --grid 2x2 --summary", "basins --rpm 678 --grid 2x2 --json"),
        (
            "chart --x rpm=660:670:2 --y mass=1:2:2 --transient 20 --record 10 --summary",
            "chart --over rpm=660:670:2 --over mass=1:2:2 --transient 20 --record 10 --json",
        ),
        (
            "chart --y mass=1:2:2 --x rpm=660:670:2 --transient 20 --record 10 --out -",
            "chart --over rpm=660:670:2 --over mass=1:2:2 --transient 20 --record 10 --out -",
        ),
        ("continue --from-rpm 700 --parameter rpm=699:701", "continue --rpm 700 --over rpm=699:701"),
        (
            "curve --rpm 670:680 --parameter restitution=0.79:0.81 --event corner",
            "curve --rpm 670:680 --over restitution=0.79:0.81 --event corner",
        ),
    ] {
        let [was, is] = [old, new].map(printed);
        assert!(was == is && !is.is_empty(), "{old}\n{was}\n{new}\n{is}");
    }
    let need = ["design", "models/laws/program.toml", "--speeds", "2", "--need", "no separation to 600 rpm"];
    let [was, is] = ["--against", "--over"].map(|name| {
        let output = corner_impact(need.into_iter().chain([name, "stiffness=20000:40000:2"]));
        assert_eq!(output.status.code(), Some(0), "{}", text(output.stderr));
        text(output.stdout)
    });
    assert!(was == is && is.contains("for each stiffness"), "{is}");
    // The ends of a picture's axes.
    let folder = TempDir::new().unwrap();
    let [was, is] = [["--x", "--y"], ["--x-range", "--y-range"]].map(|[x, y]| {
        let path = folder.path().join("cam.svg");
        let output = corner_impact(["cam", "--out", path.to_str().unwrap(), x, "90:180", y, "0.4:0.55"]);
        assert_eq!(output.status.code(), Some(0), "{}", text(output.stderr));
        std::fs::read(path).unwrap()
    });
    assert!(was == is);
}

#[test]
fn speeds_and_axes_have_one_form() {
    let refused = |line: &str| {
        let (exit, out, err) = run(line);
        assert_eq!((exit, out.as_str()), (2, ""), "{line}");
        in_one_line(&err)
    };
    for command in ["simulate", "orbit", "continue --over mass=1:2", "chart --over mass=1:2:2 --over damping=0:1:2"] {
        let why = refused(&format!("{command} --rpm 600:700"));
        assert!(why.contains("takes one speed: R"), "{command}: {why}");
    }
    for command in ["locate", "curve --over mass=1:2", "report", "figure"] {
        let why = refused(&format!("{command} --rpm 700"));
        assert!(why.contains("takes a range: LO:HI"), "{command}: {why}");
        let why = refused(&format!("{command} --rpm 600:700:3"));
        assert!(why.contains("takes only a range: LO:HI"), "{command}: {why}");
    }
    // A number of values may be left out, and one of --rpm is taken wherever it is of use.
    let rows = |line: &str| printed(line).lines().count();
    assert_eq!(
        rows("basins --over restitution=0.7:0.8 --rpm 700 --grid 1x1 --transient 5 --record 5 --patience 0 --out -"),
        10
    );
    let speeds: serde_json::Value = serde_json::from_str(&printed("design --rpm 60:70:3 --json")).unwrap();
    assert_eq!(speeds["contact_force"].as_array().unwrap().len(), 3);
    let found: serde_json::Value = serde_json::from_str(&printed("speeds --rpm 700:702:3 --starts 1 --json")).unwrap();
    assert!(found["attractors"][0]["shares"].as_array().unwrap().len() < 10, "{found}");
}

/// A document of branches or curves has what their table has.
#[test]
fn branches_and_curves_are_documents_too() {
    for (line, lists, value) in [
        ("continue --rpm 700 --over rpm=699:701", "branches", "value"),
        ("curve --rpm 670:680 --over restitution=0.79:0.81 --event corner", "curves", "speed_rpm"),
    ] {
        let table = printed(&format!("{line} --quiet"));
        let document: serde_json::Value = serde_json::from_str(&printed(&format!("{line} --json"))).unwrap();
        let points = document[lists].as_array().unwrap().iter().flat_map(|list| list["points"].as_array().unwrap());
        let of_document: Vec<f64> = points.map(|point| point[value].as_f64().unwrap()).collect();
        let first_cell = |row: &str| row.split(',').next().unwrap().parse::<f64>().unwrap();
        let of_table: Vec<f64> = table.lines().skip(1).map(first_cell).collect();
        assert!(of_table == of_document && of_table.len() > 60, "{line}");
        // What each passes is a note.
        assert!(run(line).2.contains(" 1: ") && run(&format!("{line} --quiet")).2.is_empty(), "{line}");
    }
}

/// The loads that `simulate` prints, against the events and the trace of the same run.
#[test]
fn loads_of_a_run_are_those_of_its_events() {
    let line = "simulate --rpm 183 --revolutions 3";
    let found: serde_json::Value = serde_json::from_str(&printed(&format!("{line} --json"))).unwrap();
    let rows = |table: &str| -> Vec<Vec<String>> {
        let rows = table.lines().skip(1).map(|row| row.split(',').map(str::to_owned).collect());
        rows.collect()
    };
    let number = |cell: &str| cell.parse::<f64>().unwrap();
    let (mut hardest, mut off, mut left) = (0.0_f64, 0.0, None);
    // Columns: revolution, time, cam angle, event, position, velocity before and after, velocity of the cam.
    for row in rows(&printed(&format!("{line} --events -"))) {
        match row[3].as_str() {
            "release" => left = Some(number(&row[1])),
            "stick" => off += number(&row[1]) - left.take().expect("it flies"),
            _ => hardest = hardest.max((number(&row[5]) - number(&row[7])).abs()),
        }
    }
    assert!(left.is_none(), "it ends on the cam");
    let gaps = rows(&printed(&format!("{line} --out -"))).into_iter().map(|row| number(&row[4]));
    let gap = gaps.fold(0.0, f64::max);
    let of = |name: &str| found[name].as_f64().unwrap();
    assert!(hardest > 3.0 && (of("hardest_impact_m_s") - hardest).abs() < 1e-9 * hardest, "{hardest}: {found}");
    assert!((of("off_cam_share") - off / (3.0 * 60.0 / 183.0)).abs() < 1e-9, "{off}: {found}");
    // The trace has a row a degree.
    assert!((0.0..1e-3 * gap).contains(&(of("largest_gap_m") - gap)), "{gap}: {found}");
    // Of a motion that does not repeat, in the last hundred revolutions.
    // Whether the run is one piece, or a piece a revolution.
    let folder = TempDir::new().unwrap();
    let strobed = format!(" --strobe 1.5 --strobe-out {}", folder.path().join("states.csv").display());
    for (length, pieces) in
        [("--revolutions 2", ""), ("--revolutions 250", ""), ("--revolutions 250", &*strobed), ("--impacts 400", "")]
    {
        let line = format!("simulate --rpm 670 {length}");
        let found: serde_json::Value = serde_json::from_str(&printed(&format!("{line}{pieces} --json"))).unwrap();
        let recorded = rows(&printed(&format!("{line} --events -")));
        let turns = |row: &Vec<String>| number(&row[1]) * 670.0 / 60.0;
        let last = recorded.iter().filter(|row| turns(row) >= found["revolutions"].as_f64().unwrap() - 100.0);
        let speeds = last.map(|row| (number(&row[5]) - number(&row[7])).abs());
        let (hardest, told) = (speeds.fold(0.0, f64::max), found["hardest_impact_m_s"].as_f64().unwrap());
        assert!(hardest > 1.0 && (told - hardest).abs() < 1e-9 * hardest, "{length}: {hardest} {found}");
    }
    // An orbit of more impacts than its page lists has the hardest of all.
    let page = printed("orbit --rpm 183");
    assert!(page.contains(&format!("deg: {hardest:.6} m/s relative to the cam")), "{hardest}: {page}");
    let long: serde_json::Value =
        serde_json::from_str(&printed("simulate --rpm 183 --revolutions 120 --json")).unwrap();
    assert_eq!((of("loads_over_revolutions"), long["loads_over_revolutions"].as_f64()), (3.0, Some(100.0)));
}

#[test]
fn numbers_are_taken_as_people_type_them() {
    assert_eq!(
        printed("simulate --rpm 183rpm --revolutions 2 --start-angle 90deg --events -"),
        printed("simulate --rpm 183 --revolutions 2 --start-angle 1.5707963267948966rad --events -")
    );
    let set = |value: &str| {
        let output = corner_impact(["cam", "models/laws/program.toml", "--set", value]);
        (output.status.code(), text(output.stderr))
    };
    let [kilograms, grams] = ["2 kg", "2000g"].map(|mass| {
        let words =
            ["simulate", "models/laws/program.toml", "--rpm", "300", "--set", &format!("mass={mass}"), "--events", "-"];
        let output = corner_impact(words);
        assert_eq!(output.status.code(), Some(0), "{}", text(output.stderr));
        text(output.stdout)
    });
    // A command that comes after a number is no unit.
    assert!(printed("--threads 2 cam models/laws/program.toml").contains("Cam of program"));
    let as_in_the_file = printed("simulate models/laws/program.toml --rpm 300 --events -");
    assert!(kilograms == grams && kilograms != as_in_the_file);
    for (value, says) in [
        ("mass=900N", "mass is in kg in this model"),
        ("mass=0.15 ±0.01", "set it with --set mass.error=0.01"),
        ("mass=0.15 +/- 0.01", "set it with --set mass.error=0.01"),
        ("preload=3kg", "is not a number of this model"),
        ("restitution=0.5kg", "restitution is a number without a unit"),
        ("mass=1,5", "\"1,5\" may be 1.5 or 15: write a decimal point"),
        ("mass=heavy", "\"heavy\" is not a number"),
    ] {
        let (exit, why) = set(value);
        assert!(exit == Some(2) && why.contains(says), "{value}: {why}");
    }
    for (line, says) in [
        ("simulate --rpm 1904,8", "may be 1904.8 or 19048"),
        ("simulate --rpm 30Hz", "\"30Hz\" is not in rpm: 1800 rpm, if that is the speed of the cam"),
        ("speeds --rpm 3000-5000", "a range has a colon: 3000:5000"),
        ("simulate --rmp 700", "a similar argument exists: '--rpm'"),
        ("simulate --spring 700", "Usage: corner-impact simulate [OPTIONS]"),
        ("diagram --over rpm=600:700:3 --over mass=1:2:3", "note: `chart` varies two numbers"),
        ("basins --rpm 700", "example: corner-impact basins --rpm 678"),
        ("figure slow-trce", "did you mean slow-trace? there are: cam-shape,"),
        ("c0.cvs", "c0.cvs: cannot be read: there is no such file"),
        ("cam models/osorio-2009.toml", "did you mean osorio-2008.toml?"),
        ("cam models", "it is a folder"),
        ("design help", "the command comes first"),
        ("analyse lifts.csv", "note: `corner-impact MODEL` lists what you can do"),
        ("models/osorio-2008.toml desing", "a similar subcommand exists: 'design'"),
        ("--rpm 700 simulate", "note: options of a command come after it"),
        ("design --svg a.svg", "a similar argument exists: '--out'"),
        ("explain models/osorio-2008.toml preload", "explain preload models/osorio-2008.toml"),
        ("speeds --starts four", "must be a whole number"),
        ("models/osorio-2008.toml --rpm 700", "Usage: corner-impact MODEL [COMMAND]"),
        ("verify models/laws/program.toml", "`locate --rpm LO:HI` and `certify --rpm LO:HI`"),
        ("simulate --rpm 100 --start-angle 90grad", "write 90deg, or 90rad"),
        ("design --rpm 3000..6000", "a range has a colon: 3000:6000"),
        ("locate --rpm 600:760,5", "may be 760.5 or 7605"),
        ("verify --jsn", "a similar argument exists: '--json'"),
        (
            "orbit --rpm 700 --over mass=1:2",
            "note: --over is an option of design, speeds, diagram, chart, basins, continue, curve\n",
        ),
        ("verify --rpm 700:710", "note: --rpm is an option of"),
        ("speeds --trace run.svg", "a similar argument exists: '--out'"),
        ("diagram --parameter restitution=0.6:0.9:4", "a similar argument exists: '--over'"),
        ("claims --verdict wrong", "must be one of"),
        ("certify --rpm 673", "corner impacts are certified over a range, --rpm LO:HI"),
        ("figure fast-impacts --rpm 660:700", "fast-impacts has fixed speeds: --rpm is for slow-trace"),
    ] {
        let (exit, _, why) = run(line);
        assert!(exit == 2 && why.contains(says) && !why.contains("-- --"), "{line}: {why}");
    }
    assert!(printed("design --speeds 3 --limit force=0.9kN").contains("force of 900 N"));
}

/// The short page of the program and of each command, and the order in which commands are listed.
#[test]
#[ignore = "slow"]
fn short_help_is_a_page() {
    let help = |words: &[&str]| text(program(words).env("COLUMNS", "80").output().unwrap().stdout);
    for command in COMMANDS {
        let (short, long) = (help(&[command, "-h"]), help(&[command, "--help"]));
        assert!(short.lines().count() <= 30, "{command}\n{short}");
        assert!(
            long.contains("--threads") && long.contains("--quiet") && long.lines().count() >= short.lines().count()
        );
        assert!(short.lines().chain(long.lines()).all(|line| line.chars().count() <= 80 || line.starts_with("Usage:")));
    }
    let (short, long) = (help(&["-h"]), help(&["--help"]));
    assert!(short.lines().count() <= 30, "{short}");
    for page in [short, long] {
        let place = |name: &str| page.find(&format!("  {name} ")).unwrap_or_else(|| panic!("{name} in {page}"));
        let first = ["new", "cam", "design", "simulate", "speeds"].map(place);
        assert!(first.is_sorted() && COMMANDS.iter().all(|name| page.contains(name)), "{page}");
        assert!(page.find("The paper's result").unwrap() > first[4], "{page}");
    }
}

/// The command that usually follows, for a person at a terminal alone; and no notes where none are wanted.
#[test]
fn a_result_ends_with_what_comes_next() {
    let told = |line: &str, out: bool| {
        let (mut printed, mut noted) = (Vec::new(), Vec::new());
        let words = ["corner-impact"].into_iter().chain(line.split(' ')).map(Into::into);
        let exit = run_at(Terminal { out, ..Terminal::default() }, words, &mut printed, &mut noted);
        assert_eq!(exit, Exit::Agrees, "{line}: {}", text(noted));
        (text(printed), text(noted))
    };
    let model = concat!(env!("PROJECT"), "/models/laws/program.toml");
    let next = |line: &str| told(line, true).0.lines().rfind(|line| line.starts_with("next: ")).map(str::to_owned);
    let of_cam = format!("cam {model} --set mass=2");
    assert_eq!(next(&of_cam).unwrap(), format!("next: corner-impact design {model} --set follower.mass=2"));
    assert!(told(&of_cam, true).0.ends_with("mass=2\n"), "the last line");
    assert_eq!(next("orbit --rpm 700").unwrap(), "next: corner-impact continue --rpm 700 --over rpm=665:735");
    assert_eq!(
        next("chart --over rpm=660:700:2 --over restitution=0.7:0.8:2 --transient 5 --record 5").unwrap(),
        "next: corner-impact curve --rpm 660:700 --over restitution=0.7:0.8"
    );
    for quiet in [format!("{of_cam} --quiet"), format!("{of_cam} --json")] {
        assert_eq!(next(&quiet), None, "{quiet}");
    }
    assert!(!told(&of_cam, false).0.contains("next:"), "not into a pipe");
    assert!(told("cam", false).1.starts_with("note: no MODEL given") && told("cam -q", false).1.is_empty());
}

#[test]
fn a_model_alone_says_what_can_be_done_with_it() {
    let program = printed("models/laws/program.toml");
    for command in ["cam", "design", "simulate", "speeds", "report", "locate"] {
        let line = program.lines().find(|line| line.trim_start().starts_with(&format!("corner-impact {command} ")));
        let line = line.unwrap_or_else(|| panic!("{command} in {program}"));
        assert!(line.contains("models/laws/program.toml"), "{line}");
    }
    // Where the acceleration jumps nowhere, the paper's commands have nothing to find.
    let smooth = printed("models/laws/harmonic.toml");
    assert!(!smooth.contains("corner-impact verify") && !smooth.contains("corner-impact locate"), "{smooth}");
    let (exit, out, err) = run("verify models/laws/harmonic.toml --no-external");
    assert!(exit == 2 && out.is_empty(), "{out}");
    assert!(err.starts_with("error: models/laws/harmonic.toml: the acceleration of this cam jumps nowhere"), "{err}");
    // The model may come before the command.
    assert_eq!(printed("models/laws/program.toml cam --order 2"), printed("cam models/laws/program.toml --order 2"));
    assert_eq!(run("models/nothing.toml").0, 2);
    assert!(run("nothing").2.contains("unrecognized subcommand"));
}

/// A table of lifts in place of a model file: what is assumed is printed as a file that does the same.
#[test]
#[ignore = "slow"]
fn a_table_of_lifts_is_enough() {
    let folder = TempDir::new().unwrap();
    let run = |words: &[&str]| {
        let output = program(words).current_dir(folder.path()).output().unwrap();
        (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
    };
    assert_eq!(run(&["new", "valve.toml", "--law", "table"]).0, 0);
    let (exit, page, noted) = run(&["cam", "valve.csv"]);
    assert!(exit == 0 && page.contains("180 rows") && noted.contains("file = \"valve.csv\""), "{page} {noted}");
    let numbers = ["--mass", "0.11 kg", "--stiffness", "30", "--preload", "220N", "--restitution", "0.4"];
    let (exit, of_table, noted) = run(&[&["design", "valve.csv", "--speeds", "2", "--json"][..], &numbers].concat());
    assert_eq!(exit, 0, "{noted}");
    let model = noted.split_once("to change it\n").unwrap().1;
    assert!(
        model.contains("mass = 0.11       # kg\n")
            && model.contains("damping = 0.0     # N s/m, assumed\n")
            && model.contains("restitution = 0.4\n"),
        "{model}"
    );
    std::fs::write(folder.path().join("valve.toml"), model).unwrap();
    assert_eq!(run(&["design", "valve.toml", "--speeds", "2", "--json"]).1, of_table);
    // The same numbers change those of a model file.
    let [as_set, named] = [["--set", "mass=0.2"], ["--mass", "0.2"]]
        .map(|change| run(&[&["design", "valve.toml", "--speeds", "2", "--json"][..], &change].concat()).1);
    assert!(as_set == named && named != of_table && !named.is_empty());
    let twice = ["design", "valve.csv", "--mass", "1", "--set", "mass=2", "--stiffness", "3", "--preload", "2"];
    let (exit, _, why) = run(&twice);
    assert!(exit == 2 && why.contains("follower.mass is set twice"), "{why}");
    let (exit, page, _) = run(&["valve.csv", "--mass", "0.11 kg"]);
    let typed = "corner-impact design valve.csv --mass '0.11 kg' --stiffness N/MM --preload N\n";
    assert!(
        exit == 0 && page.contains(typed) && page.contains("corner-impact cam valve.csv --mass '0.11 kg'\n"),
        "{page}"
    );
    let (exit, _, why) = run(&["design", "valve.csv", "--mass", "1"]);
    assert!(exit == 2 && why.contains("give --stiffness (N/mm), --preload (N)"), "{why}");
    let (exit, _, why) = run(&["cam", "valve.csv", "--mass", "3 N"]);
    assert!(exit == 2 && why.contains("mass is in kg in this model"), "{why}");
    // In other units, and by --set.
    let numbers = [
        "--set",
        "mass=110g",
        "--stiffness",
        "30000",
        "N/m",
        "--preload",
        "0.22kN",
        "--set",
        "follower.restitution=40%",
    ];
    assert_eq!(run(&[&["design", "valve.csv", "--speeds", "2", "--json"][..], &numbers].concat()).1, of_table);
}

/// `--open` hands the file to the program of the desktop, once it is written.
#[test]
#[cfg(target_os = "linux")]
fn a_picture_is_opened_where_that_is_asked_for() {
    use std::os::unix::fs::PermissionsExt;
    let folder = TempDir::new().unwrap();
    let (opener, seen, picture) =
        (folder.path().join("xdg-open"), folder.path().join("seen"), folder.path().join("cam.svg"));
    std::fs::write(&opener, format!("#!/bin/sh\nhead -c 4 \"$1\" > {0}.part && mv {0}.part {0}\n", seen.display()))
        .unwrap();
    std::fs::set_permissions(&opener, std::fs::Permissions::from_mode(0o755)).unwrap();
    let path = format!("{}:{}", folder.path().display(), std::env::var("PATH").unwrap());
    let drawn = |words: &[&str]| {
        program(["cam", "--out", picture.to_str().unwrap()].iter().chain(words)).env("PATH", &path).output().unwrap()
    };
    assert_eq!(drawn(&[]).status.code(), Some(0));
    assert!(!seen.exists());
    let output = drawn(&["--open"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(output.stderr));
    let begun = std::time::Instant::now();
    while !seen.exists() && begun.elapsed() < crate::common::PATIENCE {
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    assert_eq!(std::fs::read_to_string(&seen).unwrap(), "<svg");
}

/// The words of a page that have a digit in them.
fn numbers(page: &str) -> BTreeSet<String> {
    page.split_whitespace()
        .filter(|word| word.contains(|letter: char| letter.is_ascii_digit()))
        .map(str::to_owned)
        .collect()
}

/// Pages at 80, 100 and 140 columns: no line is wider, no number is broken, and none is much longer than the widest; `--all` leaves nothing out.
#[test]
#[ignore = "slow"]
fn pages_are_for_eighty_columns() {
    let folder = TempDir::new().unwrap();
    let valve = folder.path().join("valve.toml").display().to_string();
    assert_eq!(corner_impact(["new", &valve, "--law", "table"]).status.code(), Some(0));
    for (line, has_all) in [
        ("VALVE", false),
        ("cam", true),
        ("cam models/laws/program.toml", true),
        ("cam VALVE", true),
        ("design VALVE", true),
        ("design --speeds 3", true),
        ("design --rpm 200 --over mass=1:2:3", true),
        ("simulate --rpm 183 --revolutions 5", false),
        ("simulate --rpm 670 --lyapunov", false),
        ("speeds --rpm 600:760 --speeds 5 --starts 4", true),
        ("diagram --rpm 660:670:3", false),
        ("chart --over rpm=600:760:3 --over restitution=0.5:0.9:3", false),
        ("basins --rpm 678 --grid 4x4", false),
        ("basins --rpm 700 --over restitution=0.6:0.8:3 --grid 3x3", false),
        ("orbit --rpm 680", true),
        ("orbit --rpm 183", true),
        ("chaos --rpm 670", true),
        ("verify --no-external", true),
        ("locate --rpm 600:760", true),
        ("certify", true),
        ("certify --orbits --rpm 700", false),
        ("claims", false),
        ("compare --set restitution=0.7 --no-external", true),
        ("explain B_minus --no-external", true),
        ("explain --list", false),
        ("figure", false),
        ("figure cam", false),
    ] {
        let words: Vec<String> = line.split(' ').map(|word| word.replace("VALVE", &valve)).collect();
        let page = |columns: usize, more: &[&str]| {
            let words = words.iter().map(String::as_str).chain(more.iter().copied());
            let output = program(words).env("COLUMNS", columns.to_string()).output().unwrap();
            assert_eq!(output.status.code(), Some(0), "{line}: {}", text(output.stderr));
            let page = text(output.stdout);
            for found in page.lines() {
                // A path or a command that is longer than the line cannot be cut.
                let is_one_word = found.split_whitespace().count() == 1;
                assert!(found.chars().count() <= columns || is_one_word, "{line} at {columns}: {found}");
            }
            page
        };
        // What takes seconds is run in two widths.
        let is_slow = !crate::common::is_whole() && words[0] != "design";
        let [narrow, wide] = [80, 140].map(|columns| page(columns, &[]));
        let usual = if is_slow { narrow.clone() } else { page(100, &[]) };
        // These tell how long they took.
        if !["simulate", "diagram", "chart", "basins"].contains(&words[0].as_str()) {
            let broken: Vec<_> = numbers(&narrow).difference(&numbers(&wide)).cloned().collect();
            assert!(broken.is_empty(), "{line}: {broken:?}");
            if has_all {
                let missing: Vec<_> = numbers(&wide).difference(&numbers(&page(80, &["--all"]))).cloned().collect();
                assert!(missing.is_empty(), "{line}: {missing:?}");
            }
        }
        let [narrow, usual, wide] = [narrow, usual, wide].map(|page| page.lines().count());
        // A page of a few lines is not held to a fifth of them.
        assert!(
            narrow.max(usual) as f64 <= (1.2 * wide as f64).max(wide as f64 + 3.0),
            "{line}: {narrow}, {usual}, {wide} lines"
        );
        if line == "design VALVE" {
            assert!(narrow <= 45 && usual <= 45, "{narrow}, {usual} lines");
        }
    }
}
