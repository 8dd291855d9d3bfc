//! Are the sentences of `--help` short enough to be read at first sight?

#[path = "../documents/page.rs"]
#[allow(dead_code, reason = "the documents need more of it than a help text does")]
mod page;
#[path = "../documents/prose.rs"]
#[allow(dead_code, reason = "the documents need more of it than a help text does")]
mod prose;

use crate::command_line::COMMANDS;
use crate::common::{program, text};
use prose::{LONGEST, MEAN, of_text, words};

/// Indent of an option's text, in columns.
const INDENT: usize = 10;

/// The paragraphs of a help text: what it says in sentences, without usage, options, values, headings and examples.
fn paragraphs(help: &str) -> Vec<String> {
    let is_prose = |line: &str| {
        let indent = line.len() - line.trim_start().len();
        let is_heading = line.ends_with(':') || line.starts_with("Usage:");
        let is_value = line.trim_start().starts_with("[default:") || line.trim_start().starts_with("[possible values:");
        (indent == 0 || indent >= INDENT) && !line.trim().is_empty() && !is_heading && !is_value
    };
    let lines: Vec<&str> = help.lines().collect();
    let chunks = lines.chunk_by(|one, other| is_prose(one) && is_prose(other));
    let prose = chunks.filter(|chunk| is_prose(chunk[0]));
    prose.map(|chunk| chunk.iter().map(|line| line.trim()).collect::<Vec<_>>().join(" ")).collect()
}

#[test]
fn sentences_of_help_are_short() {
    let mut complaints = Vec::new();
    for command in [""].into_iter().chain(COMMANDS) {
        let arguments = [command, "--help"].into_iter().filter(|word| !word.is_empty());
        let help = text(program(arguments).env("COLUMNS", "120").output().unwrap().stdout);
        let sentences: Vec<String> = paragraphs(&help).iter().flat_map(|paragraph| of_text(paragraph)).collect();
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
                [default: 1]\n\nExamples:\n  it --one 2\n\nExit code: 0 done.\n";
    assert_eq!(paragraphs(help), ["Does it.", "First line and second. Next", "Exit code: 0 done."]);
    assert_eq!(of_text("First line and second. Next"), ["First line and second.", "Next"]);
}
