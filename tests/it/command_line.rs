//! Does the command line do what its help says: examples that work, pages that fit, colour where it belongs, everything from
//! any folder?

use std::path::Path;
use std::process::{Command, Output};

use crate::common::{PROGRAM, ROOT, copy_program, corner_impact, program, text};
use rayon::prelude::*;
use tempfile::TempDir;

pub const COMMANDS: [&str; 23] = [
    "verify",
    "explore",
    "report",
    "claims",
    "explain",
    "locate",
    "certify",
    "compare",
    "cam",
    "simulate",
    "speeds",
    "design",
    "diagram",
    "figure",
    "orbit",
    "continue",
    "curve",
    "basins",
    "chaos",
    "chart",
    "new",
    "completions",
    "man",
];

fn run(line: &str) -> Output {
    corner_impact(line.split_whitespace())
}

/// The lines under "Examples:", without the explanations beside them.
fn examples(help: &str) -> Vec<String> {
    let (_, after) = help.split_once("\nExamples:\n").unwrap_or_else(|| panic!("no examples in {help}"));
    let lines = after.lines().take_while(|line| line.starts_with("  "));
    lines.map(|line| line.trim().split("  ").next().unwrap().to_owned()).collect()
}

/// Every subcommand is listed, under a heading, and has examples that work as they are written.
#[test]
#[ignore = "slow"]
fn examples_work_as_written() {
    /// Examples that run elsewhere: `verify` and `report` by every landing, `claims` by another test here, and `speeds` within the report, where
    /// it takes longest of all. Those of `explore` serve until a page is closed, or need the module that not every build has.
    const LONG: [&str; 7] = [
        "corner-impact verify",
        "corner-impact report",
        "corner-impact speeds",
        "corner-impact claims",
        "corner-impact explore",
        "corner-impact explore models/sharp-nose.toml --no-open",
        "corner-impact explore models/sharp-nose.toml --out live.html",
    ];
    let folder = TempDir::new().unwrap();
    std::fs::create_dir(folder.path().join("models")).unwrap();
    for path in ["models", "models/laws"] {
        std::fs::create_dir_all(folder.path().join(path)).unwrap();
        for entry in std::fs::read_dir(Path::new(ROOT).join(path)).unwrap().map(Result::unwrap) {
            if entry.path().is_file() {
                std::fs::copy(entry.path(), folder.path().join(path).join(entry.file_name())).unwrap();
            }
        }
    }
    // Wide enough for an example to be one line.
    let help =
        |words: &[&str]| text(program(words).current_dir(folder.path()).env("COLUMNS", "120").output().unwrap().stdout);
    let first = help(&["--help"]);
    assert_eq!(examples(&first).len(), 3, "{first}");
    let mut lines = examples(&first);
    for command in COMMANDS {
        assert!(first.lines().any(|line| line.starts_with(&format!("  {command} "))), "{command} in {first}");
        let found = examples(&help(&[command, "--help"]));
        assert!(
            !found.is_empty() && found.iter().all(|line| line.starts_with("corner-impact ")),
            "{command}: {found:?}"
        );
        lines.extend(found.into_iter().filter(|line| !lines.contains(line)).collect::<Vec<_>>());
    }
    let listed = first
        .lines()
        .filter(|line| line.starts_with("  ") && !line.starts_with("   ") && !line.contains("corner-impact "));
    assert_eq!(
        listed.filter(|line| !line.trim().starts_with('-')).count(),
        COMMANDS.len(),
        "a command without a test: {first}"
    );
    let wrong = |line: &String| {
        // What stands between quotes is one word, with its blanks.
        let quoted = line.split('"').enumerate();
        let words =
            quoted.flat_map(
                |(place, part)| {
                    if place % 2 == 1 { vec![part] } else { part.split_whitespace().collect::<Vec<_>>() }
                },
            );
        let output = program(words.skip(1)).current_dir(folder.path()).output().unwrap();
        let (out, err) = (text(output.stdout), text(output.stderr));
        // Python need not be here.
        let without_python = output.status.code() == Some(1) && err.contains("did not run");
        let runs = output.status.code() == Some(0) || without_python;
        // Standard error is no terminal: no bar, no colour.
        let plain = !out.contains('\x1b') && !err.contains(['\x1b', '\r', '%']);
        (!runs || !plain).then(|| format!("{line}: {err}"))
    };
    assert!(LONG.iter().all(|long| lines.iter().any(|line| line == long)), "{lines:?}");
    lines.retain(|line| !LONG.contains(&line.as_str()));
    let complaints: Vec<String> = lines.par_iter().filter_map(wrong).collect();
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

#[test]
fn help_and_version_go_to_standard_output() {
    let lines = COMMANDS.map(|command| format!("{command} --help"));
    for line in ["--help", "--version"].into_iter().chain(lines.iter().map(String::as_str)) {
        let output = run(line);
        assert_eq!(output.status.code(), Some(0), "{line}");
        assert!(output.stderr.is_empty(), "{line}");
        let said = text(output.stdout);
        assert!(
            if line == "--version" {
                said.starts_with("corner-impact ")
            } else {
                said.contains("Usage: corner-impact ")
            },
            "{said}"
        );
        assert!(said.contains("Exit code: 0") || line.starts_with("--"), "{said}");
    }
    assert_eq!(run("").status.code(), Some(2));
    assert_eq!(run("conquer").status.code(), Some(2));
}

#[test]
#[ignore = "slow"]
fn pages_fit_the_width_that_is_asked_for() {
    // What takes long is run in the narrowest width alone.
    let (all, narrow): (&[&str], &[&str]) = (&["60", "80", "120"], &["60"]);
    for (line, widths) in [
        ("verify --no-external", narrow),
        ("cam", all),
        ("design --speeds 5", narrow),
        ("cam models/laws/program.toml", all),
        ("locate --rpm 660:760", all),
        ("certify --rpm 600:760", narrow),
        ("locate models/laws/rectified-sine.toml --rpm 600:760", narrow),
        ("orbit --rpm 680", all),
        ("orbit --rpm 183", all),
        ("speeds --rpm 600:760 --speeds 40", narrow),
        ("basins --rpm 678 --grid 6x6", narrow),
        ("chaos --rpm 670", narrow),
        ("simulate --rpm 183 --revolutions 5", all),
        ("--help", all),
        ("diagram --help", all),
    ] {
        let page = |columns: &str| text(program(line.split(' ')).env("COLUMNS", columns).output().unwrap().stdout);
        for columns in widths {
            let (page, width) = (page(columns), columns.parse().unwrap());
            assert!(!page.is_empty());
            for found in page.lines() {
                // A number or a word longer than the line cannot be cut.
                let is_one_word = found.split_whitespace().count() == 1;
                // clap keeps a usage in one line.
                let is_usage = found.starts_with("Usage:");
                assert!(found.chars().count() <= width || is_one_word || is_usage, "{line} at {width}: {found}");
            }
        }
        if widths.len() > 1 {
            let same = |text: &str| {
                text.lines()
                    .filter(|line| !line.contains(" s, ") && !line.ends_with(" s"))
                    .map(String::from)
                    .collect::<Vec<_>>()
            };
            assert_eq!(same(&text(run(line).stdout)), same(&page("100")), "{line}");
        }
    }
    // Nothing is lost on the way: the same words in the same order, but for the heads of tables.
    let words = |columns: &str| {
        let page = program(["orbit", "--rpm", "183"]).env("COLUMNS", columns).output().unwrap().stdout;
        let page = text(page);
        assert!(page.lines().all(|line| line.chars().count() <= columns.parse().unwrap()), "{page}");
        page.split_whitespace().map(String::from).collect::<Vec<_>>()
    };
    assert_eq!(words("60"), words("120"));
}

/// Without its escape codes.
fn stripped(text: &str) -> String {
    let mut parts = text.split('\x1b');
    let first = parts.next().unwrap().to_owned();
    first + &parts.map(|part| part.split_once('m').unwrap().1).collect::<String>()
}

#[test]
#[ignore = "slow"]
fn colour_is_where_it_belongs_and_says_nothing_by_itself() {
    let coloured = |line: &str, set: &[(&str, &str)]| {
        let output = program(line.split_whitespace()).envs(set.iter().copied()).output().unwrap();
        (text(output.stdout), text(output.stderr))
    };
    for line in ["verify --no-external", "cam", "orbit --rpm 680", "--help"] {
        let (plain, _) = coloured(line, &[]);
        assert!(!plain.contains('\x1b'), "{line}");
        for (set, flag) in [(&[][..], "--color always"), (&[("CLICOLOR_FORCE", "1")], "--color auto")] {
            let (page, _) = coloured(&format!("{flag} {line}"), set);
            assert!(page.contains('\x1b'), "{line} {flag} {set:?}");
            assert_eq!(stripped(&page), plain, "{line}");
        }
        let none = [
            (&[("CLICOLOR_FORCE", "1")][..], "--color never"),
            (&[("CLICOLOR_FORCE", "1"), ("NO_COLOR", "1")], "--color=auto"),
            (&[("CLICOLOR_FORCE", "0")], ""),
        ];
        for (set, flag) in none {
            assert_eq!(coloured(&format!("{flag} {line}"), set).0, plain, "{line} {flag} {set:?}");
        }
    }
    let (verdicts, _) = coloured("verify --no-external --color always", &[]);
    assert!(verdicts.contains("\x1b[32mAGREES\x1b[0m") && verdicts.contains("\x1b[33mmisprint\x1b[0m"));
    let (claims, _) = coloured("claims --color always", &[]);
    assert!(claims.contains("\x1b[1;31mREFUTED\x1b[0m") && claims.contains("\x1b[32mHOLDS\x1b[0m"));
    // Data is never coloured.
    for line in ["cam --json", "simulate --rpm 183 --revolutions 3 --events -", "completions bash", "man", "new"] {
        assert!(!coloured(&format!("--color always {line}"), &[]).0.contains('\x1b'), "{line}");
    }
    for line in ["cam none.toml", "conquer", "cam --no-such"] {
        let (_, plain) = coloured(line, &[]);
        let (_, shown) = coloured(&format!("{line} --color always"), &[]);
        assert!(plain.starts_with("error: ") && !plain.contains('\x1b'), "{line}: {plain}");
        assert!(shown.contains("\x1b[") && stripped(&shown).starts_with("error: "), "{line}: {shown}");
    }
}

#[test]
#[ignore = "slow"]
fn a_model_need_not_be_named() {
    let note = "note: no MODEL given: using the paper's, osorio-2008, which is built in\n";
    for line in [
        "verify --no-external --json",
        "cam --json",
        "locate --rpm 600:760 --json",
        "orbit --rpm 680 --json",
        "continue --from-rpm 700 --parameter rpm=690:710",
        "curve --rpm 660:690 --parameter restitution=0.79:0.81",
        "speeds --rpm 690:700 --speeds 3 --json",
        "diagram --rpm 690:700:3 --out -",
        "simulate --rpm 183 --revolutions 3 --events -",
    ] {
        let (unnamed, command) = (run(line), line.split(' ').next().unwrap());
        let named = run(&line.replacen(command, &format!("{command} models/osorio-2008.toml"), 1));
        assert_eq!(unnamed.status.code(), Some(0), "{line}");
        assert_eq!(unnamed.stdout, named.stdout, "{line}");
        assert_eq!(text(unnamed.stderr), note.to_owned() + &text(named.stderr), "{line}");
    }
}

#[test]
fn templates_load_as_they_stand() {
    let folder = TempDir::new().unwrap();
    let at = |words: &[&str]| program(words).current_dir(folder.path()).output().unwrap();
    for law in ["arcs", "harmonic", "rectified-sine", "program", "polynomial", "table", "contour"] {
        let file = format!("{law}.toml");
        let written = at(&["new", &file, "--law", law]);
        assert_eq!(written.status.code(), Some(0), "{}", text(written.stderr));
        let document: serde_json::Value = serde_json::from_slice(&at(&["cam", &file, "--json"]).stdout).unwrap();
        assert_eq!((&document["law"], &document["model"]), (&law.into(), &law.into()));
        let orders = document["corners"].as_array().unwrap().iter().map(|corner| corner["jump_order"].as_u64());
        let has_corner = orders.collect::<Vec<_>>().contains(&Some(2));
        assert_eq!(has_corner, ["arcs", "program", "polynomial"].contains(&law), "{law}");
        if has_corner {
            let verified = at(&["verify", "--no-external", &file]);
            assert_eq!(verified.status.code(), Some(0), "{law}: {}", text(verified.stderr));
        }
        // Every line with a field says what it is.
        let template = std::fs::read_to_string(folder.path().join(&file)).unwrap();
        let fields = template.lines().filter(|line| line.contains(" = ") && !line.starts_with('#'));
        let bare: Vec<&str> = fields.filter(|line| !line.contains('#')).collect();
        let said = ["name", "source", "motion", "span_deg", "rise", "start_deg", "coefficients"];
        assert!(bare.iter().all(|line| said.iter().any(|field| line.starts_with(field))), "{law}: {bare:?}");

        // What is there stays, unless it is said otherwise.
        std::fs::write(folder.path().join(&file), "mine").unwrap();
        let refused = at(&["new", &file, "--law", law]);
        assert_eq!(refused.status.code(), Some(2));
        assert!(text(refused.stderr).contains("--force"));
        assert_eq!(std::fs::read_to_string(folder.path().join(&file)).unwrap(), "mine");
        assert_eq!(at(&["new", &file, "--law", law, "--force"]).status.code(), Some(0));
        assert_eq!(std::fs::read_to_string(folder.path().join(&file)).unwrap(), template);
    }
    assert_eq!(at(&["new"]).stdout, at(&["new", "-"]).stdout);
    assert_eq!(
        text(at(&["new"]).stdout).replace("my-machine", "arcs"),
        std::fs::read_to_string(folder.path().join("arcs.toml")).unwrap()
    );
    // The table of another model is not written over.
    std::fs::remove_file(folder.path().join("table.toml")).unwrap();
    assert_eq!(at(&["new", "table.toml", "--law", "table"]).status.code(), Some(2));
    assert!(!folder.path().join("table.toml").exists());
}

#[test]
fn manual_and_completions_know_every_command() {
    let folder = TempDir::new().unwrap();
    let written = program(["man", "--out", "pages"]).current_dir(folder.path()).output().unwrap();
    assert_eq!(written.status.code(), Some(0), "{}", text(written.stderr));
    let page = |name: &str| std::fs::read_to_string(folder.path().join("pages").join(name)).unwrap();
    assert_eq!(std::fs::read_dir(folder.path().join("pages")).unwrap().count(), COMMANDS.len() + 1);
    let first = page("corner-impact.1");
    assert_eq!(first.as_bytes(), run("man").stdout);
    for command in COMMANDS {
        let page = page(&format!("corner-impact-{command}.1"));
        // A hyphen that is typed is written \- in a manual page.
        let example = format!("corner\\-impact {command}");
        assert!(
            page.contains(".SH EXAMPLES") && page.split(".SH EXAMPLES").nth(1).unwrap().contains(&example),
            "{page}"
        );
        assert!(first.contains(&format!("corner\\-impact\\-{command}(1)")), "{first}");
        assert!(page.contains("Exit code"), "{page}");
    }
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = text(run(&format!("completions {shell}")).stdout);
        assert!(COMMANDS.iter().all(|command| script.contains(command)) && script.contains("no-external"), "{shell}");
    }
}

/// A copy of the program in an empty folder, far from the project: all that needs no Python works, and what needs
/// Python says so where there is none, and how to set it up or do without.
#[test]
#[ignore = "slow"]
fn from_any_folder() {
    let (home, empty) = (TempDir::new().unwrap(), TempDir::new().unwrap());
    let copy = home.path().join("corner-impact");
    copy_program(&copy);
    let run = |line: &str| {
        let mut command = Command::new(&copy);
        command
            .current_dir(empty.path())
            .args(line.split_whitespace())
            .env("CORNER_IMPACT_PYTHON", "/nonexistent/python");
        let output = command.output().unwrap();
        (output.status.code(), text(output.stdout), text(output.stderr))
    };
    for line in [
        "verify --no-external",
        "claims",
        "cam",
        "locate --rpm 660:690",
        "orbit --rpm 680",
        "simulate --rpm 183",
        "diagram --rpm 660:750:5 --out d.svg",
        "new my.toml",
        "verify --no-external my.toml",
        "man",
    ] {
        let (code, out, err) = run(line);
        assert!(code == Some(0) && (line.starts_with("new") || !out.is_empty()), "{line}: {err}");
    }
    let (code, page, said) = run("verify");
    assert_eq!(code, Some(1));
    let page = crate::common::in_one_line(&page);
    for words in [&said, &page] {
        for part in ["symbolic", "scipy", "/nonexistent/python", "python3 -m pip install", "--no-external"] {
            assert!(words.contains(part), "{part} in {words}");
        }
    }
    assert!(page.contains("INCOMPLETE: symbolic, scipy and certificate did not run"), "{page}");
}

/// In front of a person work of more than a second has a bar, or a spinner; `script` makes a terminal.
#[test]
#[ignore = "slow"]
fn a_terminal_sees_how_far_it_is() {
    let typed = |line: &str| {
        let line = format!("{PROGRAM} {line}");
        let typed = Command::new("script").args(["-qec", &line, "/dev/null"]).env("TERM", "xterm").output();
        typed.map(|output| text(output.stdout))
    };
    let Ok(claims) = typed("claims") else {
        return println!("skipped: there is no `script` here to make a terminal");
    };
    assert!(claims.contains("\x1b[1;31mREFUTED\x1b[0m"), "a terminal is coloured: {claims}");
    // Three seconds or more on one core.
    let sweep = "diagram --rpm 660:670:2000 --transient 2000 --record 200 --threads 1 --summary";
    let shown = typed(sweep).unwrap();
    assert!(shown.contains(" %  "), "no bar in {shown:?}");
    assert_eq!(text(run("claims").stderr).lines().count(), 1, "no bar where there is no terminal");
}
