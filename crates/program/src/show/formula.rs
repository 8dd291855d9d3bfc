//! Formulas within sentences, from plain text to markup: `phi_{T/2} x*` with Greek letters, subscripts and superscripts.

use maud::{Markup, html};

/// Names of Greek letters, and the letters.
const GREEK: [(&str, &str); 12] = [
    ("alpha", "α"),
    ("delta", "δ"),
    ("omega", "ω"),
    ("Omega", "Ω"),
    ("kappa", "κ"),
    ("theta", "θ"),
    ("zeta", "ζ"),
    ("phi", "φ"),
    ("Phi", "Φ"),
    ("rho", "ρ"),
    ("tau", "τ"),
    ("mu", "μ"),
];
/// Signs typed with more than one key.
const SIGNS: [(&str, &str); 4] = [("+-", "±"), ("->", "→"), ("<=", "≤"), (">=", "≥")];

/// A part of a formula.
enum Part {
    Plain(String),
    Letter(String),
    Below(String),
    Above(String),
}

/// Typesets the formulas in a sentence. Other parts stay unchanged: words, numbers, names with a colon or an underscore in words.
pub(crate) fn sentence(text: &str) -> Markup {
    // A space in braces does not separate words.
    let mut open = 0;
    let is_gap = |letter: char| {
        open += i32::from(letter == '{') - i32::from(letter == '}');
        letter == ' ' && open <= 0
    };
    let words = text.split_inclusive(is_gap).flat_map(|word| {
        let bare = word.trim_end();
        let sign = SIGNS.iter().find(|(typed, _)| *typed == bare);
        match sign {
            Some((_, sign)) => vec![Part::Plain(format!("{sign}{}", &word[bare.len()..]))],
            None if is_formula(bare) => parts(word),
            None => vec![Part::Plain(word.to_owned())],
        }
    });
    html! {
        @for part in words {
            @match part {
                Part::Plain(text) => (text),
                Part::Letter(text) => i { (text) },
                Part::Below(text) => sub { (text) },
                Part::Above(text) => sup { (text) },
            }
        }
    }
}

fn letter(name: &str) -> Option<&'static str> {
    GREEK.iter().find(|(typed, _)| *typed == name).map(|(_, letter)| *letter)
}

/// Names in a word: runs of letters.
fn names(word: &str) -> impl Iterator<Item = &str> {
    word.split(|letter: char| !letter.is_ascii_alphabetic()).filter(|name| !name.is_empty())
}

/// Whether a word is a formula. All its names must have one or two letters or be Greek. Besides, it must have a mathematical sign or a
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

/// Splits a formula into parts. `_` and `^` apply to a letter, a number or a group in braces; an asterisk, a prime or a side follows a
/// name.
fn parts(word: &str) -> Vec<Part> {
    let mut parts = Vec::new();
    let mut rest = word;
    while let Some(first) = rest.chars().next() {
        let taken = |from: &str, is: fn(char) -> bool| from.find(|letter| !is(letter)).unwrap_or(from.len());
        if first.is_ascii_alphabetic() {
            let (name, behind) = rest.split_at(taken(rest, |letter| letter.is_ascii_alphabetic()));
            parts.push(Part::Letter(letter(name).unwrap_or(name).to_owned()));
            let digits = taken(behind, |letter| letter.is_ascii_digit());
            if digits > 0 {
                parts.push(Part::Below(behind[..digits].to_owned()));
            }
            rest = &behind[digits..];
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
        end += taken(&rest[end..], |letter| !letter.is_ascii_alphabetic() && letter != '_' && letter != '^');
        parts.push(Part::Plain(rest[..end].replace('-', "−")));
        rest = &rest[end..];
    }
    parts
}

/// Typesets a name, as its letter, and the characters after it.
fn set(part: &str) -> String {
    let end = part.find(|letter: char| !letter.is_ascii_alphabetic()).unwrap_or(part.len());
    let (name, rest) = part.split_at(end);
    format!("{}{}", letter(name).unwrap_or(name), rest.replace('-', "−"))
}

#[cfg(test)]
mod tests {
    #[test]
    fn formulas_are_set_and_words_are_left() {
        for (text, set) in [
            (
                "dP/dx at fixed t_i is phi_{T/2} x*.",
                "<i>dP</i>/<i>dx</i> at fixed <i>t</i><sub>i</sub> is <i>φ</i><sub>T/2</sub> <i>x</i><sup>*</sup>.",
            ),
            ("A- and B- hold", "<i>A</i><sup>−</sup> and <i>B</i><sup>−</sup> hold"),
            ("det [e; e A-]", "det [e; e <i>A</i><sup>−</sup>]"),
            ("omega0^2 -> 0", "<i>ω</i><sub>0</sub><sup>2</sup> → 0"),
            ("c'' is 5.1e-9 m/s^2", "<i>c</i>′′ is 5.1e-9 m/s^2"),
            (
                "dP/dt_i: x + g/omega0^2,",
                "<i>dP</i>/<i>dt</i><sub>i</sub>: x + <i>g</i>/<i>ω</i><sub>0</sub><sup>2</sup>,",
            ),
            ("1/s, d/s, N/mm and m/s^2", "1/s, d/s, N/mm and m/s^2"),
            ("as printed, eq:PT in one-impact words", "as printed, eq:PT in one-impact words"),
            ("phi_t = e^{-zeta t} x*", "<i>φ</i><sub>t</sub> = <i>e</i><sup>−ζ t</sup> <i>x</i><sup>*</sup>"),
            ("W^{-1} x~", "<i>W</i><sup>−1</sup> <i>x</i>\u{303}"),
            ("a < b & \"_", "a &lt; b &amp; &quot;_"),
        ] {
            assert_eq!(super::sentence(text).into_string(), set, "{text}");
        }
    }
}
