//! A Markdown page as fenced blocks, inline code, links and prose.

use std::path::{Path, PathBuf};

/// A fenced block.
pub struct Block {
    /// Line of the fence, from 1.
    pub line: usize,
    /// First word after the fence.
    pub language: String,
    /// Second word after it: the file that the block is.
    pub file: Option<String>,
    /// What is inside.
    pub text: String,
}

/// A page, split once.
pub struct Page {
    /// From the project's folder.
    pub path: PathBuf,
    pub text: String,
    pub blocks: Vec<Block>,
    /// Everything else, with the number of its line.
    pub prose: Vec<(usize, String)>,
}

impl Page {
    pub fn read(root: &Path, path: &Path) -> Self {
        let text = std::fs::read_to_string(root.join(path)).unwrap();
        let (mut blocks, mut prose) = (Vec::<Block>::new(), Vec::new());
        let mut inside = false;
        for (index, line) in text.lines().enumerate() {
            match (line.trim_start().strip_prefix("```"), inside) {
                (Some(info), false) => {
                    let mut words = info.split_whitespace().map(String::from);
                    let (language, file) = (words.next().unwrap_or_default(), words.next());
                    blocks.push(Block { line: index + 1, language, file, text: String::new() });
                    inside = true;
                }
                (Some(_), true) => inside = false,
                (None, true) => {
                    let block = blocks.last_mut().unwrap();
                    block.text.push_str(line);
                    block.text.push('\n');
                }
                (None, false) => prose.push((index + 1, line.to_owned())),
            }
        }
        assert!(!inside, "{}: a fence stays open", path.display());
        Self { path: path.into(), text, blocks, prose }
    }

    /// Inline code, with its line; a piece of code stays on one line.
    pub fn inline_code(&self) -> impl Iterator<Item = (usize, &str)> {
        self.prose.iter().flat_map(|(number, line)| {
            let odd = |(index, piece)| (index % 2 == 1).then_some((*number, piece));
            line.split('`').enumerate().filter_map(odd)
        })
    }

    /// Targets of links and pictures, with their line.
    pub fn links(&self) -> impl Iterator<Item = (usize, &str)> {
        self.prose.iter().flat_map(|(number, line)| {
            line.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(target, _)| (*number, target))
        })
    }

    /// The names that headings can be linked by.
    pub fn anchors(&self) -> Vec<String> {
        let headings = self.prose.iter().filter_map(|(_, line)| Some(line.strip_prefix('#')?.trim_start_matches('#')));
        let kept = |c: &char| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_');
        headings
            .map(|text| text.trim().to_lowercase().chars().filter(kept).collect::<String>().replace(' ', "-"))
            .collect()
    }

    /// Numbers with a decimal point in the prose, inline code and where links lead left out, each as written.
    pub fn decimals(&self) -> Vec<(usize, String)> {
        let mut found = Vec::new();
        for (number, line) in &self.prose {
            let mut prose: String = line.split('`').step_by(2).collect::<Vec<_>>().join(" ");
            for (_, target) in self.links().filter(|(of, _)| of == number) {
                prose = prose.replace(target, "");
            }
            found.extend(decimals(&prose).into_iter().map(|decimal| (*number, decimal)));
        }
        found
    }
}

/// Numbers with digits on both sides of a point, without sign or exponent.
pub fn decimals(text: &str) -> Vec<String> {
    let pieces = text.split(|c: char| !(c.is_ascii_digit() || c == '.'));
    let is_decimal = |piece: &&str| {
        let mut parts = piece.split('.');
        let digits = |part: Option<&str>| part.is_some_and(|part| !part.is_empty());
        digits(parts.next()) && digits(parts.next()) && parts.next().is_none()
    };
    pieces.map(|piece| piece.trim_matches('.')).filter(is_decimal).map(String::from).collect()
}

/// Whether a number as written is `value` rounded to as many decimals.
pub fn is_rounded(written: &str, value: &str) -> bool {
    let places = written.split_once('.').map_or(0, |(_, fraction)| fraction.len());
    let known = value.split_once('.').map_or(0, |(_, fraction)| fraction.len());
    let (written, value): (f64, f64) = (written.parse().unwrap(), value.parse().unwrap());
    // Half a unit, and what the decimals cost as doubles.
    known >= places && (written - value).abs() <= 0.5 * 10f64.powi(-(places as i32)) * (1.0 + 1e-6)
}

/// Every page: the README and all of docs/, whose list for the book is a page as well.
pub fn pages(root: &Path) -> Vec<Page> {
    let mut paths = markdown(&root.join("docs"));
    paths.sort();
    let paths = paths.into_iter().map(|path| path.strip_prefix(root).unwrap().to_path_buf());
    [PathBuf::from("README.md")].into_iter().chain(paths).map(|path| Page::read(root, &path)).collect()
}

fn markdown(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let of_entry = |path: PathBuf| match path.is_dir() {
        true => markdown(&path),
        false => Some(path).into_iter().filter(|path| path.extension().is_some_and(|end| end == "md")).collect(),
    };
    entries.flat_map(of_entry).collect()
}
