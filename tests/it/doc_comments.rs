//! Do doc comments say what each item is, in sentences that are read at first sight?

use std::path::Path;

use crate::common::ROOT;
use crate::help_prose::prose::{LONGEST, of_text, words};
use crate::layering::rust_files;

/// Beginnings that point elsewhere before they say what the item is.
const RIDDLES: [&str; 12] =
    ["As", "From", "How", "It", "None", "Nothing", "Of", "The same", "Those", "To", "What", "With"];

/// Folders whose code is documented.
const FOLDERS: [&str; 5] = ["src", "crates/plot/src", "crates/explore/src", "crates/program/src", "python/src"];

/// The paragraphs of each doc comment of a text, with the line that the comment begins in. Tables, headings, code and formulas that are set
/// off are left out.
fn comments(text: &str) -> Vec<(usize, Vec<String>)> {
    let mut found: Vec<(usize, Vec<String>)> = Vec::new();
    let (mut last, mut is_block, mut goes_on) = (0, false, false);
    for (index, line) in text.lines().enumerate() {
        let number = index + 1;
        let line = line.trim_start();
        let Some(line) = line.strip_prefix("///").or_else(|| line.strip_prefix("//!")) else { continue };
        if found.is_empty() || number != last + 1 {
            found.push((number, Vec::new()));
            (is_block, goes_on) = (false, false);
        }
        last = number;
        let line = line.trim();
        is_block ^= line.starts_with("```") || line == "$$";
        let Some((_, paragraphs)) = found.last_mut().filter(|_| !is_block) else { continue };
        if line.is_empty() || line.starts_with(['|', '#', '`', '[']) && line.ends_with(['|', '`', ')']) {
            goes_on = false;
        } else if let Some(item) = line.strip_prefix("- ").or_else(|| line.strip_prefix("* ")) {
            paragraphs.push(item.to_owned());
            goes_on = true;
        } else {
            match paragraphs.last_mut().filter(|_| goes_on) {
                Some(paragraph) => *paragraph = format!("{paragraph} {line}"),
                None => paragraphs.push(line.to_owned()),
            }
            goes_on = true;
        }
    }
    found
}

/// Complaints about the doc comments of a text: a beginning that is a riddle, a sentence that is too long.
fn complaints(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (line, paragraphs) in comments(text) {
        let first = paragraphs.first().map_or("", String::as_str);
        if let Some(riddle) =
            RIDDLES.iter().find(|riddle| first.strip_prefix(**riddle).is_some_and(|rest| rest.starts_with(' ')))
        {
            found.push(format!("{line}: begins with \"{riddle}\": {first}"));
        }
        for sentence in paragraphs.iter().flat_map(|paragraph| of_text(paragraph)) {
            if words(&sentence) > LONGEST {
                found.push(format!("{line}: {} words: {sentence}", words(&sentence)));
            }
        }
    }
    found
}

#[test]
fn doc_comments_say_what_the_item_is() {
    let root = Path::new(ROOT);
    let mut found = Vec::new();
    for path in FOLDERS.iter().flat_map(|folder| rust_files(&root.join(folder))) {
        let text = std::fs::read_to_string(&path).unwrap();
        let name = path.strip_prefix(root).unwrap().display().to_string();
        found.extend(complaints(&text).into_iter().map(|complaint| format!("{name}:{complaint}")));
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn a_riddle_and_a_long_sentence_are_complained_about() {
    let long = "word ".repeat(36);
    let text = format!(
        "/// Of the other.\nfn one() {{}}\n\n/// Speed, rpm.\n///\n/// {long}.\n///\n/// ```\n/// {long}\n/// ```\nfn two() {{}}\n"
    );
    let found = complaints(&text);
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(found[0].starts_with("1: begins with \"Of\"") && found[1].starts_with("4: 36 words"), "{found:?}");
}
