//! Parser of formulas in plain text, `phi_{T/2} x*` or `A_hat_minus`, for browsers and figures. A terminal shows them unchanged.
//!
//! `_` and `^` lower and raise a letter, a number or a group in braces. Greek letters are spelled. A side, an asterisk or a prime follows
//! its letter. A word with such a sign, or with a Greek letter, is always a formula; any other formula is written between dollars, `$T$`.

use std::borrow::Cow;

/// Names of Greek letters, and the letters.
const GREEK: [(&str, &str); 14] = [
    ("alpha", "α"),
    ("delta", "δ"),
    ("omega", "ω"),
    ("Omega", "Ω"),
    ("kappa", "κ"),
    ("lambda", "λ"),
    ("theta", "θ"),
    ("zeta", "ζ"),
    ("phi", "φ"),
    ("Phi", "Φ"),
    ("Pi", "Π"),
    ("rho", "ρ"),
    ("tau", "τ"),
    ("mu", "μ"),
];
/// Signs typed with more than one key.
const SIGNS: [(&str, &str); 4] = [("+-", "±"), ("->", "→"), ("<=", "≤"), (">=", "≥")];
/// Spelled accents, which are set over the letter, and spelled sides, which are raised.
const ACCENTS: [(&str, &str); 3] = [("_hat", "\u{302}"), ("_tilde", "\u{303}"), ("_bar", "\u{304}")];
const SIDES: [(&str, &str); 3] = [("_minus", "−"), ("_plus", "+"), ("_star", "*")];

/// Part of a sentence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Part {
    /// Words, numbers and signs.
    Plain(String),
    /// Letter of a formula, or a name in its place.
    Letter(String),
    /// Index.
    Below(String),
    /// Power, side or asterisk.
    Above(String),
}

fn plain(text: &str) -> Part {
    Part::Plain(text.to_owned())
}

/// Text of a sentence for a terminal: without the dollars around a formula.
pub fn typed(text: &str) -> Cow<'_, str> {
    if text.contains('$') { marked(text).map(|(_, text)| text).collect() } else { Cow::Borrowed(text) }
}

/// Splits a sentence into parts. Words that are not formulas stay unchanged: numbers, units, names with a colon or an underscore.
pub fn sentence(text: &str) -> Vec<Part> {
    marked(text).flat_map(|(is_formula, text)| if is_formula { formula(text) } else { recognized(text) }).collect()
}

/// Splits a text at its dollars, and marks each part that is between two dollars. A dollar without a partner stays.
fn marked(mut text: &str) -> impl Iterator<Item = (bool, &str)> {
    std::iter::from_fn(move || {
        if text.is_empty() {
            return None;
        }
        let closed = text.strip_prefix('$').and_then(|rest| rest.split_once('$'));
        if let Some((inside, rest)) = closed.filter(|(inside, _)| !inside.is_empty() && inside.trim() == *inside) {
            text = rest;
            return Some((true, inside));
        }
        let end = text.char_indices().skip(1).find(|(_, letter)| *letter == '$').map_or(text.len(), |(at, _)| at);
        let (stretch, rest) = text.split_at(end);
        text = rest;
        Some((false, stretch))
    })
}

/// Splits a text whose formulas are not marked.
fn recognized(text: &str) -> Vec<Part> {
    // A space in braces does not separate words.
    let mut open = 0;
    let is_gap = |letter: char| {
        open += i32::from(letter == '{') - i32::from(letter == '}');
        letter == ' ' && open <= 0
    };
    let words = text.split_inclusive(is_gap).flat_map(|word| {
        let bare = word.trim_end();
        match SIGNS.iter().find(|(typed, _)| *typed == bare) {
            Some((_, sign)) => vec![Part::Plain(format!("{sign}{}", &word[bare.len()..]))],
            None if is_formula(bare) => formula(word),
            None => vec![plain(word)],
        }
    });
    words.collect()
}

fn letter(name: &str) -> Option<&'static str> {
    GREEK.iter().find(|(typed, _)| *typed == name).map(|(_, letter)| *letter)
}

/// Names in a word: runs of letters.
fn names(word: &str) -> impl Iterator<Item = &str> {
    word.split(|letter: char| !letter.is_ascii_alphabetic()).filter(|name| !name.is_empty())
}

/// Whether a word is a formula. All its names must have one or two letters or be Greek. In addition, it must have a mathematical sign or a
/// Greek letter, or be a derivative, `dP/dx`.
fn is_formula(word: &str) -> bool {
    let short = |name: &str| name.len() <= 2 || letter(name).is_some();
    let is_named = word.trim_end_matches(':').contains(':') || word.contains(".toml") || word.starts_with('"');
    let has_sign = word.contains(['_', '^', '*', '\'', '~'])
        || word.trim_end_matches(['.', ',', ';', ')', ']']).ends_with(['+', '-']);
    let greek = names(word).any(|name| letter(name).is_some());
    let is_derivative = word.contains('/') && word.split('/').all(|side| side.starts_with('d'));
    let is_unit = word.contains('/') && !word.contains(['_', '*', '\'']);
    let is_told = if is_unit { greek || is_derivative } else { has_sign || greek };
    !is_named && names(word).next().is_some() && names(word).all(short) && is_told
}

/// Splits a formula without dollars into parts.
pub fn formula(word: &str) -> Vec<Part> {
    let mut parts = Vec::new();
    let mut rest = word;
    while let Some(first) = rest.chars().next() {
        let taken = |from: &str, is: fn(char) -> bool| from.find(|letter| !is(letter)).unwrap_or(from.len());
        if first.is_alphabetic() {
            let (name, behind) = rest.split_at(taken(rest, char::is_alphabetic));
            parts.push(Part::Letter(letter(name).unwrap_or(name).to_owned()));
            let digits = taken(behind, |letter| letter.is_ascii_digit());
            if digits > 0 {
                parts.push(Part::Below(behind[..digits].to_owned()));
            }
            rest = &behind[digits..];
            for (spelled, part) in [(&ACCENTS, Part::Plain as fn(String) -> Part), (&SIDES, Part::Above)] {
                if let Some((word, sign)) = spelled.iter().find(|(word, _)| rest.starts_with(word)) {
                    parts.push(part((*sign).to_owned()));
                    rest = &rest[word.len()..];
                }
            }
            let primes = taken(rest, |letter| letter == '\'');
            if primes > 0 {
                parts.push(Part::Plain("′".repeat(primes)));
                rest = &rest[primes..];
            }
            // A side or an asterisk ends the name. Before a letter or a number it is an operator.
            let next = rest.chars().nth(1);
            let ends = next.is_none_or(|next| !next.is_alphanumeric() && next != '(');
            if let Some(sign) = rest.chars().next().filter(|sign| "*+-~".contains(*sign) && ends) {
                parts.push(match sign {
                    '~' => Part::Plain("\u{303}".into()),
                    '-' => Part::Above("−".into()),
                    sign => Part::Above(sign.into()),
                });
                rest = &rest[1..];
            }
            continue;
        }
        if matches!(first, '_' | '^') && rest.len() > 1 {
            let behind = &rest[1..];
            let (inside, after) = match behind.strip_prefix('{').and_then(|inside| inside.split_once('}')) {
                Some(found) => found,
                None => {
                    let sign = usize::from(behind.starts_with('-'));
                    let run =
                        taken(&behind[sign..], |letter| letter.is_ascii_alphanumeric()).max(usize::from(sign == 0));
                    behind.split_at_checked(sign + run).unwrap_or((behind, ""))
                }
            };
            let inside: String =
                inside.split_inclusive(|letter: char| !letter.is_ascii_alphabetic()).map(set).collect();
            parts.push(if first == '_' { Part::Below(inside) } else { Part::Above(inside) });
            rest = after;
            continue;
        }
        let mut end = first.len_utf8();
        end += taken(&rest[end..], |letter| !letter.is_alphabetic() && letter != '_' && letter != '^');
        parts.push(Part::Plain(rest[..end].replace('-', "−")));
        rest = &rest[end..];
    }
    parts
}

/// Typesets a name as its letter and the characters after it.
fn set(part: &str) -> String {
    let end = part.find(|letter: char| !letter.is_ascii_alphabetic()).unwrap_or(part.len());
    let (name, rest) = part.split_at(end);
    format!("{}{}", letter(name).unwrap_or(name), rest.replace('-', "−"))
}
