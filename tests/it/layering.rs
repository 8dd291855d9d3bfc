//! Does data move one way? No stage may use a stage that `lib.rs` of its package lists below it.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::path::{Path, PathBuf};

/// The packages: the library, the plotting engine, and the command.
const PACKAGES: [&str; 3] = ["src", "crates/plot/src", "crates/program/src"];

/// The source folder of each package.
pub fn packages() -> impl Iterator<Item = PathBuf> {
    PACKAGES.iter().map(|package| Path::new(crate::common::ROOT).join(package))
}

pub fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    files
}

fn stages(root: &Path) -> Vec<String> {
    let lib = std::fs::read_to_string(root.join("lib.rs")).unwrap();
    lib.lines().filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';')).map(String::from).collect()
}

/// The stages named after `crate::` in a file, with the line.
fn uses(text: &str) -> Vec<(usize, String)> {
    let word = |rest: &str| rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
    let of_line = |(line, text): (usize, &str)| {
        text.match_indices("crate::").map(|(at, found)| (line + 1, word(&text[at + found.len()..]))).collect::<Vec<_>>()
    };
    let code = text.lines().enumerate().filter(|(_, line)| !line.trim_start().starts_with("//"));
    code.flat_map(of_line).collect()
}

#[test]
fn no_stage_uses_one_below_it() {
    let mut checked = 0;
    // Stages of the plotting engine are private, and files of its root belong together.
    for root in [PACKAGES[0], PACKAGES[2]].map(|package| Path::new(crate::common::ROOT).join(package)) {
        let stages = stages(&root);
        assert!(stages.len() > 5, "{stages:?}");
        for file in rust_files(&root) {
            let inside = file.strip_prefix(&root).unwrap().with_extension("");
            let stage = inside.components().next().unwrap().as_os_str().to_string_lossy().into_owned();
            let Some(here) = stages.iter().position(|name| *name == stage) else { continue };
            for (line, used) in uses(&std::fs::read_to_string(&file).unwrap()) {
                let there = stages.iter().position(|name| *name == used);
                let there =
                    there.unwrap_or_else(|| panic!("{}:{line}: crate::{used} is no stage of lib.rs", file.display()));
                assert!(there <= here, "{}:{line}: {stage} uses {used}, which comes after it", file.display());
                checked += 1;
            }
        }
    }
    assert!(checked > 40, "{checked} uses seen");
}

/// The plotting engine knows no mechanics, and the library nothing of what people look at.
#[test]
fn no_package_asks_for_one_above_it() {
    let manifest = |path: &str| {
        let text = std::fs::read_to_string(Path::new(crate::common::ROOT).join(path)).unwrap();
        let manifest: toml::Table = toml::from_str(&text).unwrap();
        manifest["dependencies"].as_table().unwrap().keys().cloned().collect::<Vec<_>>()
    };
    let own = |path: &str| manifest(path).into_iter().filter(|name| name.starts_with("corner-impact")).count();
    assert_eq!(own("Cargo.toml"), 0);
    assert_eq!(own("crates/plot/Cargo.toml"), 0);
    assert_eq!(own("crates/program/Cargo.toml"), 3);
    for terminal in ["clap", "indicatif", "maud", "miette", "resvg", "signal-hook", "terminal_size"] {
        assert!(!manifest("Cargo.toml").iter().any(|name| name == terminal), "the library asks for {terminal}");
    }
}

/// The modules of a package by their paths from its root, each with the paths that its code names.
struct House {
    modules: BTreeMap<Vec<String>, Vec<Named>>,
}

/// A path as it is written, cut at `::`, and the name by which a file knows what it leads to.
type Named = (Vec<String>, String);

impl House {
    fn read(root: &Path) -> Self {
        let module = |file: PathBuf| {
            let inside = file.strip_prefix(root).unwrap().with_extension("");
            let mut path: Vec<String> = inside.iter().map(|part| part.to_string_lossy().into_owned()).collect();
            if path.last().is_some_and(|last| last == "mod" || last == "lib") {
                path.pop();
            }
            let text = std::fs::read_to_string(&file).unwrap();
            let code = text.split("#[cfg(test)]").next().unwrap();
            let code: Vec<&str> = code.lines().map(|line| line.split("//").next().unwrap()).collect();
            (path, Self::paths(&code.join("\n")))
        };
        let is_library = |file: &PathBuf| !file.ends_with("main.rs");
        Self { modules: rust_files(root).into_iter().filter(is_library).map(module).collect() }
    }

    /// The paths that a module's code names: those of its `use` declarations, braces multiplied out, and those in between.
    fn paths(code: &str) -> Vec<Named> {
        let is_name = |c: char| c.is_alphanumeric() || c == '_';
        let mut found = Vec::new();
        let mut lines = code.lines();
        while let Some(line) = lines.next() {
            let begins = ["use ", "pub use ", "pub(crate) use ", "pub(super) use "];
            match begins.iter().find_map(|begin| line.trim_start().strip_prefix(begin)) {
                Some(declaration) => {
                    let mut declaration = declaration.to_owned();
                    while !declaration.contains(';') {
                        declaration += lines.next().unwrap().trim();
                    }
                    found.extend(multiplied_out(declaration.trim_end_matches(';')));
                }
                None => found.extend(line.split(|c: char| !is_name(c) && c != ':').map(str::to_owned)),
            }
        }
        let named = |path: String| {
            let (path, alias) =
                path.split_once(" as ").map_or((path.as_str(), None), |(path, name)| (path, Some(name)));
            let mut parts: Vec<String> = path.split("::").map(str::to_owned).filter(|part| !part.is_empty()).collect();
            if parts.len() > 1 && parts.last().is_some_and(|last| last == "self") {
                parts.pop();
            }
            let name = alias.map(str::to_owned).or_else(|| parts.last().cloned()).unwrap_or_default();
            (parts, name)
        };
        found.into_iter().map(named).filter(|(parts, _)| parts.len() > 1).collect()
    }

    /// The module that defines what a path leads to, seen from the module `here`; what is handed on is looked for where it
    /// comes from. `None` for what is not of this crate.
    fn definer(&self, here: &[String], path: &[String]) -> Option<Vec<String>> {
        let mut at = here.to_vec();
        let mut parts = path.iter().peekable();
        match path.first().map(String::as_str) {
            Some("crate") => at.clear(),
            Some("self" | "super") => {}
            Some(child) if self.modules.contains_key(&[here, &[child.to_owned()]].concat()) => {}
            _ => return None,
        }
        while let Some(part) = parts.peek() {
            match part.as_str() {
                "crate" | "self" => {}
                "super" => {
                    at.pop();
                }
                part => {
                    let child = [&at[..], &[part.to_owned()]].concat();
                    if !self.modules.contains_key(&child) {
                        break;
                    }
                    at = child;
                }
            }
            parts.next();
        }
        let Some(item) = parts.next() else { return Some(at) };
        let handed_on = self.modules.get(&at)?.iter().find(|(path, name)| {
            name == item && path.len() > 1 && self.definer(&at, &path[..path.len() - 1]).is_some_and(|from| from != at)
        });
        handed_on.and_then(|(path, _)| self.definer(&at, path)).or(Some(at))
    }

    /// Which files use which others, but for what a file takes from the `mod.rs` of a folder that it is in.
    fn uses(&self) -> BTreeMap<&Vec<String>, BTreeSet<Vec<String>>> {
        let of_module = |(here, paths): (&Vec<String>, &Vec<Named>)| {
            let used = paths.iter().filter_map(|(path, _)| self.definer(here, path));
            used.filter(|there| !here.starts_with(there)).collect()
        };
        self.modules.iter().map(|(here, module)| (here, of_module((here, module)))).collect()
    }
}

/// `a::{b, c::{d, e}}` as `a::b`, `a::c::d`, `a::c::e`.
fn multiplied_out(tree: &str) -> Vec<String> {
    let Some((head, rest)) = tree.split_once('{') else { return vec![tree.trim().to_owned()] };
    let inside = rest.rsplit_once('}').unwrap().0;
    let (mut depth, mut branches) = (0, vec![String::new()]);
    for c in inside.chars() {
        depth += i32::from(c == '{') - i32::from(c == '}');
        match c {
            ',' if depth == 0 => branches.push(String::new()),
            c => branches.last_mut().unwrap().push(c),
        }
    }
    let branches = branches.iter().map(|branch| branch.trim()).filter(|branch| !branch.is_empty());
    branches.flat_map(multiplied_out).map(|branch| format!("{}{branch}", head.trim())).collect()
}

/// Files of one stage, too, use one another one way only. A `mod.rs` is a file as any other, with one exception: what it
/// defines itself belongs to every file of its folder, since a folder is one thing and its `mod.rs` says what. What a
/// `mod.rs` only hands on belongs to the file that it comes from.
#[test]
fn no_two_files_use_each_other() {
    let houses: Vec<House> = packages().map(|package| House::read(&package)).collect();
    let mut seen = 0;
    for house in &houses {
        let uses = house.uses();
        seen += uses.values().map(BTreeSet::len).sum::<usize>();
        let circles = circles(&uses);
        assert!(circles.is_empty(), "circles:\n{}", circles.join("\n"));
    }
    assert!(seen > 500, "too few uses seen");
}

/// The shortest way from each file back to itself, once for the files on it.
fn circles(uses: &BTreeMap<&Vec<String>, BTreeSet<Vec<String>>>) -> Vec<String> {
    let mut circles = BTreeMap::new();
    for start in uses.keys() {
        let (mut ways, mut seen) = (VecDeque::from([vec![*start]]), BTreeSet::new());
        while let Some(way) = ways.pop_front() {
            for next in uses.get(way[way.len() - 1]).into_iter().flatten() {
                if next == *start {
                    let words = way.iter().map(|file| file.join("/")).collect::<Vec<_>>().join(" uses ");
                    circles.entry(way.iter().copied().collect::<BTreeSet<_>>()).or_insert(words + " uses the first");
                    ways.clear();
                    break;
                }
                if seen.insert(next) {
                    ways.push_back([&way[..], &[next]].concat());
                }
            }
        }
    }
    circles.into_values().collect()
}

/// Routes to the map share the model, the cam and the place, and nothing else with one another.
#[test]
fn routes_do_not_use_each_other() {
    let corner = Path::new(crate::common::ROOT).join("src/corner");
    let text = |file: &str| std::fs::read_to_string(corner.join(file)).unwrap();
    for forbidden in ["flight", "simulate", "section", "impact", "one_sided", "finite_difference", "least_squares"] {
        for (line, used) in uses(&text("closed_form.rs").replace("super::", "crate::")) {
            assert_ne!(used, forbidden, "closed_form.rs:{line}");
        }
    }
    for file in ["finite_difference.rs", "least_squares.rs", "one_sided.rs", "simulated_orbit.rs"] {
        assert!(!text(file).contains("closed_form") && !text(file).contains("variational"), "{file}");
    }
    // The product around the orbit knows the laws and the orbit, and neither runs it nor looks at another route.
    for file in ["variational.rs", "varied.rs"] {
        for forbidden in ["closed_form", "finite_difference", "least_squares", "one_sided", "advance(", ".turn("] {
            assert!(!text(file).contains(forbidden), "{file}: {forbidden}");
        }
    }
}

/// What a jump of any order makes of the map is predicted without a run, and measured without a formula of it.
#[test]
fn prediction_and_measurement_share_nothing() {
    let folder = Path::new(crate::common::ROOT).join("src/corner/jump_order");
    let code = |file: &str| {
        let text = std::fs::read_to_string(folder.join(file)).unwrap();
        text.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n")
    };
    for forbidden in ["simulate", "section", "flight::", "measured", "extrapolation", "least_squares", "one_sided"] {
        assert!(!code("predicted.rs").contains(forbidden), "predicted.rs: {forbidden}");
    }
    for forbidden in ["predicted", "closed_form", "jump_order.", ".jump,", "corner.jump", "curvature", "third", "slope"]
    {
        assert!(!code("measured.rs").contains(forbidden), "measured.rs: {forbidden}");
    }
}

/// One event loop, one tolerance table: small numbers that decide something stand in the table.
#[test]
fn thresholds_stand_in_the_table() {
    // What a plot can show apart is no threshold of the mathematics.
    let roots = [PACKAGES[0], PACKAGES[2]].map(|package| Path::new(crate::common::ROOT).join(package));
    for file in roots.iter().flat_map(|root| rust_files(root)) {
        if file.ends_with("tolerance.rs") {
            continue;
        }
        let text = std::fs::read_to_string(&file).unwrap();
        let code = text.split("#[cfg(test)]").next().unwrap();
        // 1e-9, but not stroke-width.
        let small =
            |line: &str| line.match_indices("e-").any(|(at, _)| line[..at].ends_with(|c: char| c.is_ascii_digit()));
        let lines = || code.lines().enumerate().filter(|(_, line)| !line.trim_start().starts_with("//"));
        // A small number under a name of its own decides no less where the name is compared.
        let named = lines().filter(|(_, line)| line.contains("const ") && small(line));
        let names: Vec<&str> = named.filter_map(|(_, line)| line.split("const ").nth(1)?.split(':').next()).collect();
        let word =
            |line: &str, name: &str| line.split(|c: char| !(c.is_alphanumeric() || c == '_')).any(|word| word == name);
        for (number, line) in lines() {
            let compares = line.replace("=>", "").replace("->", "").contains(['<', '>']);
            let is_named = names.iter().any(|name| word(line, name) && !line.contains("const "));
            let decides = compares && (small(line) || is_named) || line.contains("EPSILON");
            assert!(!decides, "{}:{}: {line}", file.display(), number + 1);
        }
    }
}

/// `make mutants` looks into stages that are there, and asks tests that are there.
#[test]
fn mutants_are_looked_for_where_there_is_something() {
    let root = Path::new(crate::common::ROOT);
    let text = |path: &str| std::fs::read_to_string(root.join(path)).unwrap();
    let script = text("tests/mutants/mutants.py");
    let (_, after) = script.split_once("STAGES = [").unwrap();
    let named: Vec<&str> = after.split_once(']').unwrap().0.split('"').skip(1).step_by(2).collect();
    let stages = stages(&root.join("src"));
    assert!(named.len() > 10 && named.iter().all(|name| stages.iter().any(|stage| stage == name)), "{named:?}");
    let failing: toml::Table = toml::from_str(&text("tests/mutants/failing.toml")).unwrap();
    for (file, tests) in failing["of"].as_table().unwrap() {
        assert!(root.join(file).is_file(), "{file}");
        for test in tests.as_array().unwrap().iter().map(|test| test.as_str().unwrap()) {
            let words: Vec<&str> = test.split("::").collect();
            let [module, .., function] = words.as_slice() else { panic!("{file}: {test}") };
            let is_there = text(&format!("tests/it/{module}.rs")).contains(&format!("fn {function}("));
            assert!(is_there, "{file}: {test}");
        }
    }
}

/// Two public types with one name are two ideas with one word.
#[test]
fn no_public_type_name_occurs_twice() {
    let mut seen = BTreeMap::new();
    for file in packages().flat_map(|package| rust_files(&package)) {
        for line in std::fs::read_to_string(&file).unwrap().lines() {
            let words: Vec<&str> = line.trim_start().split(' ').take(3).collect();
            let ["pub", "struct" | "enum" | "type" | "trait" | "union", name] = words[..] else { continue };
            let name: String = name.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
            if let Some(other) = seen.insert(name.clone(), file.clone()) {
                panic!("{name} in {} and in {}", other.display(), file.display());
            }
        }
    }
    assert!(seen.len() > 300, "{} types seen", seen.len());
}
