//! The part of the page on the local map: how generic it is, what it predicts by itself, how far it holds.

use std::fmt;

use crate::border_collision::validity::Compared;
use crate::show::block::Block;
use crate::show::page::Page;
use crate::show::words;
use crate::study::verify::border_collision::{EndEntry, OutcomeEntry, RangeEntry};
use crate::study::verify::document::Verification;

/// Where the second column begins.
const COLUMN: usize = 20;

/// A line with a name in the first column and words, broken into lines, in the second.
fn entry(out: &mut Page, name: &str, words: &str) -> fmt::Result {
    out.blocks(&[Block::Entries(COLUMN, vec![(name.into(), words.into())])])
}

/// The condition nearest to failing, and those that fail.
pub(crate) fn conditions(out: &mut Page, document: &Verification) -> fmt::Result {
    let (holding, count) =
        (document.conditions.iter().filter(|condition| condition.holds).count(), document.conditions.len());
    if let Some(nearest) = document.conditions.iter().min_by(|a, b| a.distance.total_cmp(&b.distance)) {
        let words =
            format!("{holding} of {count} hold; nearest to failing, by {:.1e}: {}", nearest.distance, nearest.name);
        entry(out, "conditions", &words)?;
    }
    for failing in document.conditions.iter().filter(|condition| !condition.holds) {
        let rests = words::decides(failing.decides);
        let words = format!("{} = {:.1e}: {}; the {rests} rests on it", failing.name, failing.value, failing.meaning);
        entry(out, "fails", &words)?;
    }
    Ok(())
}

/// The local map's own motions and how far it holds.
pub(crate) fn local_map(out: &mut Page, document: &Verification) -> fmt::Result {
    if document.local_map.is_empty() {
        return Ok(());
    }
    out.heading("What the local map does by itself, next to the corner impact")?;
    for outcome in &document.local_map {
        motions(out, outcome)?;
    }
    if document.linear_range.is_empty() {
        return Ok(());
    }
    out.heading("How far it holds: within 10 % of the simulated machine")?;
    for compared in [Compared::OneRevolution, Compared::FixedPointMinus, Compared::FixedPointPlus] {
        let ranges = document.linear_range.iter().filter(|range| range.compared == compared);
        for (index, range) in ranges.enumerate() {
            let name = if index > 0 { "" } else { words::compared(compared) };
            entry(out, name, &range_words(range))?;
        }
    }
    Ok(())
}

fn motions(out: &mut Page, outcome: &OutcomeEntry) -> fmt::Result {
    let name = match outcome.speeds {
        "at" => "at omega*".to_owned(),
        speeds => format!("{speeds} than omega*"),
    };
    let ends: Vec<_> = outcome.ends.iter().map(|end| format!("{} {}", end.starts, end_words(end))).collect();
    entry(out, &name, &format!("{} motions: {}", outcome.starts, ends.join("; ")))?;
    if outcome.speeds == "at" {
        return Ok(());
    }
    let stable: Vec<_> =
        outcome.periodic_orbits.iter().filter(|orbit| orbit.stable).map(|orbit| orbit.word.as_str()).collect();
    let unstable: Vec<_> =
        outcome.periodic_orbits.iter().filter(|orbit| !orbit.stable).map(|orbit| orbit.word.as_str()).collect();
    const SHOWN: usize = 6;
    let listed = |words: &[&str]| match words {
        [] => "none".to_owned(),
        words if words.len() > SHOWN => {
            format!("{} and {} more", words[..SHOWN].join(", "), words.len() - SHOWN)
        }
        words => words.join(", "),
    };
    entry(out, "", &format!("periodic orbits: stable {}; unstable {}", listed(&stable), listed(&unstable)))
}

fn end_words(end: &EndEntry) -> String {
    match (end.end, &end.word, end.exponent, end.standard_error) {
        ("fixed-point", Some(word), ..) => format!("on the fixed point {word}"),
        ("periodic", Some(word), ..) => format!("on the orbit {word}"),
        ("chaotic", _, Some(exponent), Some(error)) => {
            format!("chaotic, Lyapunov exponent {exponent:.4} +- {error:.4} a turn")
        }
        ("undecided", _, Some(exponent), Some(error)) => {
            format!("bounded and undecided, Lyapunov exponent {exponent:.4} +- {error:.4} a turn")
        }
        ("corner", ..) => "to the corner impact".into(),
        _ => format!("without bound ({})", end.basis),
    }
}

fn range_words(range: &RangeEntry) -> String {
    if range.difference.is_none() {
        return format!("{}: nowhere", range.speeds);
    }
    let to = words::ends(range.ends);
    format!("{}: to {:.6} rpm, dT = {:.3e} s{to}", range.speeds, range.speed_rpm, range.period_change_s)
}
