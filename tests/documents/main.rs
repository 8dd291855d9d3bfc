//! Do the documents say what the program does? Every command and every output in them, and every name that they drop.
//!
//! `UPDATE_DOCS=1 cargo test --release --test documents` writes the outputs as they are now, elisions kept: `[..]` stands
//! for any text in a line, `...` on a line of its own for any lines.
#![allow(clippy::unwrap_used, clippy::panic)]

#[path = "../it/common/mod.rs"]
mod common;
mod page;
mod picture;
mod prose;
mod run;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use page::{Page, decimals, is_rounded, pages};
use prose::{LONGEST, MEAN, sentences, words};
use rayon::prelude::*;
use run::{ELSEWHERE, Held, plain, run, run_page, steps};

fn root() -> &'static Path {
    Path::new(env!("PROJECT"))
}

/// Commands in blocks of language `console`, over all pages.
fn commands(pages: &[Page]) -> Vec<String> {
    let blocks = pages.iter().flat_map(|page| &page.blocks).filter(|block| block.language == "console");
    blocks.flat_map(steps).map(|step| plain(&step.command)).collect()
}

#[test]
fn every_command_prints_what_its_page_shows() {
    let pages = pages(root());
    let ran: Vec<(Vec<String>, String)> = pages.par_iter().map(|page| run_page(root(), page)).collect();
    if std::env::var_os("UPDATE_DOCS").is_some() {
        for (page, (_, fresh)) in pages.iter().zip(&ran) {
            std::fs::write(root().join(&page.path), fresh).unwrap();
        }
        return;
    }
    let complaints: Vec<String> = ran.into_iter().flat_map(|(complaints, _)| complaints).collect();
    assert!(complaints.is_empty(), "UPDATE_DOCS=1 writes what is new:\n{}", complaints.join("\n"));
    assert!(commands(&pages).len() > 30, "{:?}", commands(&pages));
}

/// A block that looks like a command and is not run would be the way round the test above.
#[test]
fn blocks_are_of_a_kind_that_is_checked() {
    for page in pages(root()) {
        for block in &page.blocks {
            let place = format!("{}:{}", page.path.display(), block.line);
            let allowed = match block.language.as_str() {
                // An output of elisions alone would hold nothing.
                "console" => block.file.is_none() && steps(block).iter().all(|step| !is_elided(&step.shown)),
                // Held by tests/it/model_file.rs where it is no file of its own.
                "toml" => {
                    block.file.is_some() || page.path.ends_with("model-file.md") || page.path.ends_with("extending.md")
                }
                "csv" => block.file.is_some(),
                // A doctest, by python/tests/test_documents.py.
                "python" => page.path.ends_with("python.md"),
                // A doctest.
                "rust" => page.path.ends_with("theory.md"),
                // Formulas, drawings and templates.
                "" | "text" | "math" => !block.text.contains("corner-impact ") && !block.text.contains("cargo "),
                _ => false,
            };
            assert!(allowed, "{place}: a block of \"{}\" is not checked", block.language);
        }
    }
}

/// Whether there is an output, and no line of it says anything.
fn is_elided(shown: &str) -> bool {
    let says = |line: &str| line.replace("[..]", "").chars().any(char::is_alphanumeric);
    !shown.is_empty() && !shown.lines().any(says)
}

/// What the test does not run is a short list, each of it shown somewhere and held by something else.
#[test]
fn what_is_not_run_is_held_elsewhere() {
    let shown: BTreeSet<String> = commands(&pages(root())).into_iter().collect();
    let landing = std::fs::read_to_string(root().join(".ci/run")).unwrap();
    for (command, reason, held) in ELSEWHERE {
        assert!(shown.contains(*command), "{command} is in no page any more: {reason}");
        match held {
            Held::Landing => {
                let runs = |line: &str| line.trim() == *command || line.trim().starts_with(&format!("{command} "));
                assert!(landing.lines().any(runs), "{command}: {reason}; .ci/run does not run it");
            }
            Held::Target => assert!(has_target(command), "{command}: no such target"),
        }
    }
}

/// What the front page says to run is what must pass for a change to land.
#[test]
fn a_landing_runs_what_the_front_page_names() {
    let page =
        pages(root()).into_iter().find(|page| page.path.ends_with("README.md") && page.path.components().count() == 1);
    let named: BTreeSet<String> =
        commands(&[page.unwrap()]).into_iter().filter(|line| line.starts_with("make ")).collect();
    let landing = std::fs::read_to_string(root().join(".ci/run")).unwrap();
    let missing: Vec<&String> =
        named.iter().filter(|line| !landing.lines().any(|runs| runs == line.as_str())).collect();
    assert!(named.contains("make verify") && named.contains("make test"), "{named:?}");
    assert!(missing.is_empty(), ".ci/run does not run {missing:?}");
}

/// `make pictures` is the commands of the pages, which are run and whose pictures are compared with those kept.
#[test]
fn make_draws_the_pictures_by_the_commands_of_the_pages() {
    let output = Command::new("make").args(["-n", "pictures"]).current_dir(root()).output().unwrap();
    let recipe = String::from_utf8(output.stdout).unwrap().replace("\\\n", " ");
    let shown: BTreeSet<String> = commands(&pages(root())).into_iter().collect();
    let drawn: Vec<String> =
        recipe.lines().filter_map(|line| Some(plain(line.strip_prefix("target/release/")?))).collect();
    for command in &drawn {
        assert!(shown.contains(command), "{command} is in no page");
    }
    let kept = std::fs::read_dir(root().join("docs")).unwrap().map(|entry| entry.unwrap().file_name());
    let kept = kept.map(|name| name.to_string_lossy().into_owned());
    let kept = kept.filter(|name| [".svg", ".png"].iter().any(|end| name.ends_with(end)));
    for name in kept {
        assert!(
            drawn.iter().any(|command| command.ends_with(&format!("docs/{name}"))),
            "make pictures draws no {name}"
        );
    }
    assert!(!drawn.is_empty(), "{recipe}");
}

/// Whether make would run this command line.
fn has_target(command: &str) -> bool {
    let words = command.split_whitespace().skip(1);
    Command::new("make").arg("-n").args(words).current_dir(root()).output().unwrap().status.success()
}

/// The commands that the program's help lists, each with what it does beside it.
fn subcommands() -> Vec<String> {
    let help = run(root(), root(), "corner-impact --help");
    let of_line = |line: &str| {
        let (name, rest) = line.strip_prefix("  ")?.split_once("  ")?;
        let is_name = !name.is_empty() && name.chars().all(|c| c.is_ascii_lowercase());
        (is_name && rest.trim().starts_with(char::is_uppercase)).then(|| name.to_owned())
    };
    let found: Vec<String> = help.lines().filter_map(of_line).filter(|name| name != "help").collect();
    assert!(found.len() >= 11, "{found:?} in:\n{help}");
    found
}

/// The text of the pages, and of the comments in the program, with the place of each piece of inline code.
fn inline_code() -> Vec<(String, String)> {
    let mut found = Vec::new();
    for page in pages(root()) {
        let place = |line: usize| format!("{}:{line}", page.path.display());
        found.extend(page.inline_code().map(|(line, code)| (place(line), code.to_owned())));
    }
    for file in ["src", "crates"].iter().flat_map(|folder| files_of(&root().join(folder), "rs")) {
        let text = std::fs::read_to_string(&file).unwrap();
        for (index, line) in text.lines().enumerate().filter(|(_, line)| line.trim_start().starts_with("//")) {
            let odd = line.split('`').skip(1).step_by(2).map(String::from);
            found.extend(odd.map(|code| (format!("{}:{}", file.display(), index + 1), code)));
        }
    }
    found
}

fn files_of(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let of_entry = |path: PathBuf| match path.is_dir() {
        true => files_of(&path, extension),
        false => Some(path).into_iter().filter(|path| path.extension().is_some_and(|end| end == extension)).collect(),
    };
    entries.flat_map(of_entry).collect()
}

#[test]
fn commands_and_options_that_are_named_exist() {
    let known = subcommands();
    let mut seen = 0;
    for (place, code) in inline_code() {
        let mut words = code.split_whitespace();
        match words.next() {
            Some("corner-impact") => {
                let Some(subcommand) = words.next().filter(|word| !word.starts_with('-')) else { continue };
                // A name in capitals stands for any.
                if subcommand == "help" || subcommand.chars().all(|c| c.is_ascii_uppercase()) {
                    continue;
                }
                assert!(known.iter().any(|name| name == subcommand), "{place}: `{code}`");
                let help = run(root(), root(), &format!("corner-impact {subcommand} --help"));
                for option in words.filter(|word| word.starts_with("--")) {
                    let option = option.split('=').next().unwrap();
                    assert!(help.contains(option), "{place}: `{code}`: {subcommand} has no {option}");
                }
                seen += 1;
            }
            Some("make") => {
                assert!(has_target(&code), "{place}: `{code}`");
                seen += 1;
            }
            Some("cargo") => {
                let example = code.split_once("--example ").and_then(|(_, rest)| rest.split(' ').next());
                let test = code.split_once("--test ").and_then(|(_, rest)| rest.split(' ').next());
                let places = |name: &str| {
                    ["examples", "crates/program/examples"].map(|folder| root().join(format!("{folder}/{name}.rs")))
                };
                let examples = example.map(|name| {
                    let [own, programs] = places(name);
                    if programs.is_file() { programs } else { own }
                });
                let tests = test.map(|name| root().join(format!("tests/{name}.rs")));
                for file in examples.into_iter().chain(tests) {
                    assert!(file.is_file(), "{place}: `{code}`: no {}", file.display());
                    seen += 1;
                }
            }
            _ => {}
        }
    }
    assert!(seen > 20, "{seen} commands named");
}

/// Folders of the project whose files are named by their path.
const FOLDERS: [&str; 10] =
    ["src/", "crates/", "tests/", "docs/", "models/", "derivations/", "examples/", "golden/", "benches/", "python/"];

#[test]
fn files_that_are_named_exist() {
    let mut seen = 0;
    for (place, code) in inline_code() {
        let path = code.split("::").next().unwrap();
        let is_path = FOLDERS.iter().any(|folder| path.starts_with(folder))
            && !path.contains(['<', '*', ' '])
            && !path.contains("NAME");
        if is_path {
            assert!(root().join(path).exists(), "{place}: there is no {path}");
            seen += 1;
        }
    }
    assert!(seen > 30, "{seen} files named");
}

#[test]
fn links_lead_somewhere() {
    let pages = pages(root());
    for page in &pages {
        for (line, target) in page.links().filter(|(_, target)| !target.starts_with("http")) {
            let place = format!("{}:{line}", page.path.display());
            let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
            let path = root().join(&page.path).parent().unwrap().join(file);
            let path = if file.is_empty() { root().join(&page.path) } else { path };
            assert!(path.exists(), "{place}: {target} is not there");
            if !anchor.is_empty() {
                let other = Page::read(root(), path.canonicalize().unwrap().strip_prefix(root()).unwrap());
                assert!(other.anchors().iter().any(|name| name == anchor), "{place}: no heading for {target}");
            }
        }
    }
    // The table of contents has every page once, so that each has a way in and a place in the book.
    let contents = pages.iter().find(|page| page.path.ends_with("docs/SUMMARY.md")).unwrap();
    let mut listed: Vec<&str> = contents.links().map(|(_, target)| target).collect();
    let docs = pages.iter().filter_map(|page| page.path.strip_prefix("docs").ok());
    let mut there: Vec<&str> = docs.filter_map(Path::to_str).filter(|name| *name != "SUMMARY.md").collect();
    listed.sort_unstable();
    there.sort_unstable();
    assert_eq!(listed, there, "docs/SUMMARY.md on the left, what is in docs/ on the right");
}

/// Every number with a decimal point in the prose of these pages is the rounding of one that the ledger computes, that the
/// page's own commands print, or that the paper prints.
#[test]
fn numbers_in_the_prose_are_computed_ones() {
    let pages = pages(root());
    let ledger = decimals(&std::fs::read_to_string(root().join("docs/claims.md")).unwrap());
    let mut seen = 0;
    let named = ["README.md", "docs/theory.md", "docs/tutorial.md", "docs/commands.md"];
    let held =
        |page: &&Page| named.iter().any(|name| page.path == Path::new(name)) || page.path.starts_with("docs/commands");
    for page in pages.iter().filter(held) {
        let name = page.path.display();
        let own: Vec<String> = page.blocks.iter().flat_map(|block| decimals(&block.text)).collect();
        for (line, written) in page.decimals() {
            let known = ledger.iter().chain(&own).any(|value| is_rounded(&written, value));
            assert!(known, "{name}:{line}: {written} is computed nowhere");
            seen += 1;
        }
    }
    assert!(seen > 15, "{seen} numbers");
}

/// Pages that are still to be rewritten. One that has become short enough must leave this list.
const LONG_WINDED: &[&str] = &[];

/// A page is read at first sight: short sentences on the average, and none that must be read twice for its length.
#[test]
fn sentences_are_short() {
    let mut complaints = Vec::new();
    for page in pages(root()) {
        let name = page.path.display().to_string();
        let found = sentences(&page);
        let total: usize = found.iter().map(|(_, sentence)| words(sentence)).sum();
        let mean = total as f64 / found.len().max(1) as f64;
        let mut own = Vec::new();
        if mean > MEAN {
            own.push(format!("{name}: {mean:.1} words a sentence on the average"));
        }
        let long = found.iter().filter(|(_, sentence)| words(sentence) > LONGEST);
        own.extend(long.map(|(line, sentence)| format!("{name}:{line}: {} words: {sentence}", words(sentence))));
        match LONG_WINDED.contains(&name.as_str()) {
            true => assert!(!own.is_empty(), "{name} is short enough: take it off the list LONG_WINDED"),
            false => complaints.extend(own),
        }
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

/// What is said about the package beside Cargo.toml is what Cargo.toml says.
#[test]
fn citation_licences_and_changelog_are_those_of_the_package() {
    let text = |file: &str| std::fs::read_to_string(root().join(file)).unwrap();
    let (citation, changelog) = (text("CITATION.cff"), text("CHANGELOG.md"));
    let version = env!("CARGO_PKG_VERSION");
    assert!(citation.lines().any(|line| line == format!("version: {version}")), "CITATION.cff is not of {version}");
    assert!(changelog.contains(version), "CHANGELOG.md does not know {version}");
    let licences: Vec<&str> = env!("CARGO_PKG_LICENSE").split(" OR ").collect();
    for licence in &licences {
        assert!(citation.contains(&format!("  - {licence}\n")), "CITATION.cff does not say {licence}");
    }
    assert_eq!(licences, ["MIT", "Apache-2.0"]);
    assert!(text("LICENSE-MIT").contains("The corner-impact authors"));
    assert!(text("LICENSE-APACHE").trim().starts_with("Apache License\n                           Version 2.0"));
    for subcommand in subcommands() {
        assert!(changelog.contains(&format!("`{subcommand}`")), "CHANGELOG.md does not name {subcommand}");
    }
}
