//! Are the sentences of `--help` short enough to be read at first sight?

#[path = "../documents/prose.rs"]
#[allow(dead_code, reason = "the documents need more of it than help texts and comments do")]
pub mod prose;

use crate::command_line::COMMANDS;
use crate::common::{program, text};
use crate::model_file::page;
use prose::{LONGEST, MEAN, of_text, words};

/// Indent of an option's text, in columns.
const INDENT: usize = 10;

/// The paragraphs of a help text: what it says in sentences, without usage, names of options, values, headings and examples.
fn paragraphs(help: &str) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    let mut goes_on = false;
    for line in help.lines() {
        let (indent, text) = (line.len() - line.trim_start().len(), line.trim());
        let is_heading = indent == 0 && text.ends_with(':') || text.starts_with("Usage:");
        let is_value = text.starts_with("[default:") || text.starts_with("[possible values:");
        if text.is_empty() || is_heading || is_value {
            goes_on = false;
        } else if indent == 0 || indent >= INDENT {
            match found.last_mut().filter(|_| goes_on) {
                Some(paragraph) => *paragraph = format!("{paragraph} {text}"),
                None => found.push(text.to_owned()),
            }
            goes_on = true;
        } else {
            // The text may stand beside its option.
            let beside = text.split_once("  ").map(|(_, text)| text.trim().to_owned());
            goes_on = beside.is_some();
            found.extend(beside);
        }
    }
    found
}

#[test]
fn sentences_of_help_are_short() {
    let mut complaints = Vec::new();
    for command in [""].into_iter().chain(COMMANDS) {
        let arguments = [command, "--help"].into_iter().filter(|word| !word.is_empty());
        let help = text(program(arguments).env("COLUMNS", "120").output().unwrap().stdout);
        let sentences: Vec<String> =
            paragraphs(&help).iter().flat_map(|paragraph| of_text(&paragraph.replace('$', ""))).collect();
        assert!(sentences.len() > 5, "{command}: {sentences:?}");
        let counts: Vec<usize> = sentences.iter().map(|sentence| words(sentence)).collect();
        let mean = counts.iter().sum::<usize>() as f64 / counts.len() as f64;
        if mean > MEAN {
            complaints.push(format!("{command}: {mean:.1} words a sentence on the average"));
        }
        let long = sentences.iter().zip(counts).filter(|(_, count)| *count > LONGEST);
        complaints.extend(long.map(|(sentence, count)| format!("{command}: {count} words: {sentence}")));
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

#[test]
fn text_of_options_is_told_from_what_is_around_it() {
    let help = "Does it.\n\nUsage: it [OPTIONS]\n\nOptions:\n      --one <N>\n          First line\n          and second. Next\n          \n          \
                [default: 1]\n  -t, --two  Beside\n             it\n\nExamples:\n  it --one 2\n\nExit code: 0 done.\n";
    assert_eq!(paragraphs(help), ["Does it.", "First line and second. Next", "Beside it", "Exit code: 0 done."]);
    assert_eq!(of_text("First line and second. Next"), ["First line and second.", "Next"]);
}
