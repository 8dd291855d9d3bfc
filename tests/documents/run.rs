//! Runs the commands of a page in a folder of the page's own and holds what they print against what the page shows.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use snapbox::{Assert, IntoData};

use super::page::{Block, Page};

/// What holds a command that is not run here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Held {
    /// `.ci/run` runs it, so that nothing lands without it.
    Landing,
    /// `make -n` knows the target.
    Target,
}

/// Commands that are too long or too wide for this test: why, and what holds them instead.
pub const ELSEWHERE: &[(&str, &str, Held)] = &[
    ("cargo install --path crates/program --locked", "compiles the program once more", Held::Landing),
    ("make properties", "takes an hour", Held::Target),
    (
        "make fuzz",
        "looks at new cases for ten minutes; tests/it/fuzz.rs looks at the same ones each time",
        Held::Target,
    ),
    ("make mutants-sample", "compiles everything once more", Held::Landing),
    ("make soak", "takes minutes", Held::Target),
    ("make check", "compiles everything once more", Held::Landing),
    ("make review", "asks a person about each snapshot; tests/it/snapshots.rs holds them", Held::Target),
    ("make quick", "runs a part of what `make test` does", Held::Target),
    ("make test", "is what runs this test", Held::Landing),
    ("make python", "builds, installs and tests the package", Held::Landing),
    ("make derive-check", "takes a minute of computer algebra", Held::Landing),
    ("make verify", "needs Python's packages; tests/it/routes.rs runs the same", Held::Landing),
    ("make report", "needs Python's packages; tests/it/browser.rs opens the page", Held::Landing),
    ("make claims", "writes docs/claims.md; tests/it/ledger.rs holds it fresh", Held::Target),
    ("make pictures", "writes docs/*.svg; tests/documents/main.rs draws them again", Held::Target),
];

/// A command and what it prints.
pub struct Step {
    /// Line in the page, from 1.
    pub line: usize,
    pub command: String,
    /// As shown, `? 1` first where it ends with another exit code than 0.
    pub shown: String,
}

/// The commands of a block of language `console`: `$ ` before each, `\` where it goes on.
pub fn steps(block: &Block) -> Vec<Step> {
    let mut steps: Vec<Step> = Vec::new();
    let mut goes_on = false;
    for (index, line) in block.text.lines().enumerate() {
        match (line.strip_prefix("$ "), steps.last_mut()) {
            (None, Some(step)) if goes_on => {
                step.command.push('\n');
                step.command.push_str(line);
                goes_on = line.ends_with('\\');
            }
            (Some(command), _) => {
                steps.push(Step { line: block.line + 1 + index, command: command.into(), shown: String::new() });
                goes_on = command.ends_with('\\');
            }
            (None, Some(step)) => {
                step.shown.push_str(line);
                step.shown.push('\n');
            }
            (None, None) => panic!("line {}: a console block begins with a command", block.line),
        }
    }
    steps
}

/// A command without its comment and with single spaces.
pub fn plain(command: &str) -> String {
    let bare = command.split(" # ").next().unwrap_or(command);
    bare.split_whitespace().filter(|word| *word != "\\").collect::<Vec<_>>().join(" ")
}

/// A folder with what a reader has in the project's: the models and an empty docs/.
pub fn folder(root: &Path) -> tempfile::TempDir {
    let folder = tempfile::Builder::new().prefix("documents").tempdir_in(env!("CARGO_TARGET_TMPDIR")).unwrap();
    copy(&root.join("models"), &folder.path().join("models"));
    std::fs::create_dir(folder.path().join("docs")).unwrap();
    folder
}

fn copy(from: &Path, to: &Path) {
    std::fs::create_dir(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap().map(Result::unwrap) {
        let to = to.join(entry.file_name());
        match entry.path().is_dir() {
            true => copy(&entry.path(), &to),
            false => assert!(std::fs::copy(entry.path(), to).is_ok()),
        }
    }
}

/// Runs a command line as a shell does, the program of this build found first; what it prints, in the page's form.
pub fn run(root: &Path, folder: &Path, command: &str) -> String {
    // Under the name that pages call it by, in a folder that goes when this has run.
    let named = tempfile::tempdir_in(env!("CARGO_TARGET_TMPDIR")).unwrap();
    std::fs::hard_link(env!("CARGO_BIN_EXE_corner-impact-tested"), named.path().join("corner-impact")).unwrap();
    let path = std::env::var_os("PATH").unwrap_or_default();
    let path = [named.path().to_path_buf()].into_iter().chain(std::env::split_paths(&path));
    // Examples are the project's, wherever the folder is.
    let manifest = format!("cargo run --quiet --locked --manifest-path {}/Cargo.toml ", root.display());
    let output = Command::new("sh")
        .args(["-c", &format!("{{ {}\n}} 2>&1", command.replace("cargo run ", &manifest))])
        .current_dir(folder)
        .env("PATH", std::env::join_paths(path).unwrap())
        .env("COLUMNS", "100")
        .env("NO_COLOR", "1")
        .output()
        .unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    // Trailing blanks do not show on a page.
    let lines: String = text.lines().flat_map(|line| [line.trim_end(), "\n"]).collect();
    match output.status.code() {
        Some(0) => lines,
        code => format!("? {}\n{lines}", code.map_or("signal".into(), |code| code.to_string())),
    }
}

/// Runs a page; the complaints, and the page with every output as it is now.
pub fn run_page(root: &Path, page: &Page) -> (Vec<String>, String) {
    let folder = folder(root);
    let (mut complaints, mut fresh) = (Vec::new(), page.text.clone());
    for block in &page.blocks {
        if let Some(file) = &block.file {
            std::fs::write(folder.path().join(file), &block.text).unwrap();
        }
        if block.language != "console" {
            continue;
        }
        let mut text = String::new();
        for step in steps(block) {
            let _ = writeln!(text, "$ {}", step.command);
            let elsewhere = ELSEWHERE.iter().any(|(command, _, _)| *command == plain(&step.command));
            let place = format!("{}:{}", page.path.display(), step.line);
            if elsewhere {
                if !step.shown.is_empty() {
                    complaints
                        .push(format!("{place}: $ {}\nis not run, and has an output that nothing holds", step.command));
                }
                continue;
            }
            let printed = run(root, folder.path(), &step.command);
            // An empty space under a command that prints is as wrong as another text.
            let (actual, expected) = (printed.clone().into_data(), step.shown.clone().into_data());
            let assert = Assert::new().action_env("CORNER_IMPACT_NO_SUCH_ACTION");
            let (normal, _) = assert.normalize(actual.clone(), expected.clone());
            text.push_str(&normal.to_string());
            if let Err(error) = assert.try_eq(Some(&place), actual, expected) {
                complaints.push(format!("{place}: $ {}\n{error}", step.command));
            }
        }
        fresh = fresh.replacen(&format!("```console\n{}```", block.text), &format!("```console\n{text}```"), 1);
    }
    // What a page's command writes where the project has a picture is that picture.
    for entry in std::fs::read_dir(folder.path().join("docs")).unwrap().map(Result::unwrap) {
        let kept = root.join("docs").join(entry.file_name());
        if let Err(difference) = super::picture::same(&entry.path(), &kept) {
            complaints.push(format!("{}: {}: {difference}; make pictures", page.path.display(), kept.display()));
        }
    }
    (complaints, fresh)
}
