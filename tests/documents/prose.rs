//! The sentences of a page, and how many words they have.

use super::page::Page;

/// The most words that the sentences of a page have on the average.
pub const MEAN: f64 = 20.0;
/// The most words of any sentence.
pub const LONGEST: usize = 35;

/// The sentences of a page's paragraphs and lists, each with the line that its paragraph begins in. Tables, headings and blocks
/// are left out; a piece of code, a formula and the text of a link are words.
pub fn sentences(page: &Page) -> Vec<(usize, String)> {
    let mut paragraphs: Vec<(usize, String)> = Vec::new();
    let mut goes_on = false;
    let mut last = 0;
    for (number, line) in &page.prose {
        let text = line.trim();
        let is_text = !text.is_empty() && !text.starts_with(['|', '#', '<']);
        goes_on &= *number == last + 1;
        last = *number;
        match (is_text, is_item(text), goes_on) {
            (false, _, _) => goes_on = false,
            (true, false, true) => {
                if let Some((_, paragraph)) = paragraphs.last_mut() {
                    paragraph.push(' ');
                    paragraph.push_str(text);
                }
            }
            (true, _, _) => {
                paragraphs.push((*number, text.trim_start_matches(['-', '*', '>', ' ']).to_owned()));
                goes_on = true;
            }
        }
    }
    let of_paragraph =
        |(number, text): (usize, String)| of_text(&text).into_iter().map(move |sentence| (number, sentence));
    paragraphs.into_iter().flat_map(of_paragraph).collect()
}

/// The sentences of one paragraph.
pub fn of_text(text: &str) -> Vec<String> {
    split(&bare(text))
}

fn is_item(text: &str) -> bool {
    let numbered = text
        .split_once(". ")
        .is_some_and(|(number, _)| !number.is_empty() && number.chars().all(|c| c.is_ascii_digit()));
    numbered || ["- ", "* ", "> "].iter().any(|mark| text.starts_with(mark))
}

/// A paragraph without marks: code and formulas are one word each, a link is its text.
fn bare(text: &str) -> String {
    let mut plain = String::new();
    for (mark, other) in [('`', "code"), ('$', "formula")] {
        let source = if plain.is_empty() { text.to_owned() } else { std::mem::take(&mut plain) };
        for (index, piece) in source.split(mark).enumerate() {
            plain.push_str(if index % 2 == 1 { other } else { piece });
        }
    }
    let mut rest = plain.as_str();
    let mut out = String::new();
    while let Some((before, after)) = rest.split_once("](") {
        out.push_str(before);
        rest = after.split_once(')').map_or("", |(_, rest)| rest);
    }
    out.push_str(rest);
    out.replace(['*', '[', ']', '!'], "")
}

/// A sentence ends with a full stop or a question mark before a blank and what can begin another.
fn split(text: &str) -> Vec<String> {
    let mut found = vec![String::new()];
    let mut words = text.split_whitespace().peekable();
    while let Some(word) = words.next() {
        let ends = word.trim_end_matches([')', '"', '_']).ends_with(['.', '?'])
            && !["e.g.", "i.e.", "vs.", "al.", "M."].contains(&word);
        let begins =
            words.peek().is_none_or(|next| !next.starts_with(|c: char| c.is_lowercase()) || next.starts_with("code"));
        if let Some(sentence) = found.last_mut() {
            sentence.push_str(word);
            sentence.push(' ');
        }
        if ends && begins {
            found.push(String::new());
        }
    }
    found.into_iter().map(|sentence| sentence.trim().to_owned()).filter(|sentence| !sentence.is_empty()).collect()
}

/// Words of a sentence: what has a letter or a digit in it.
pub fn words(sentence: &str) -> usize {
    sentence.split_whitespace().filter(|word| word.chars().any(char::is_alphanumeric)).count()
}
