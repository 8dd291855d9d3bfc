//! The part of the page on the local map: how generic it is, what it predicts by itself, how far it holds.

use std::fmt;

use crate::border_collision::LocalOutcome;
use crate::border_collision::feigin::{Speeds, speeds_at};
use crate::border_collision::validity::{Compared, Range};
use crate::show::block::Block;
use crate::show::page::{Page, text};
use crate::show::words;
use crate::study::verify::Verification;

/// Where the second column begins.
const COLUMN: usize = 20;

/// A line with a name in the first column and words, broken into lines, in the second.
fn entry(out: &mut Page, name: &str, words: &str) -> fmt::Result {
    out.blocks(&[Block::Entries(COLUMN, vec![(name.into(), words.into())])])
}

/// The condition nearest to failing, and those that fail.
pub(crate) fn conditions(out: &mut Page, document: &Verification) -> fmt::Result {
    let (holding, count) =
        (document.conditions.iter().filter(|condition| condition.holds()).count(), document.conditions.len());
    if let Some(nearest) = document.conditions.iter().min_by(|a, b| a.distance.total_cmp(&b.distance)) {
        let words =
            format!("{holding} of {count} hold; nearest to failing, by {:.1e}: {}", nearest.distance, nearest.name);
        entry(out, "conditions", &words)?;
    }
    for failing in document.conditions.iter().filter(|condition| !condition.holds()) {
        let rests = words::decides(failing.decides);
        let words = format!("{} = {:.1e}: {}; the {rests} rests on it", failing.name, failing.value, failing.meaning);
        entry(out, "fails", &words)?;
    }
    Ok(())
}

/// The local map's own motions and how far it holds.
pub(crate) fn local_map(out: &mut Page, document: &Verification) -> fmt::Result {
    if document.outcomes.is_empty() {
        return Ok(());
    }
    out.heading("What the local map does by itself, next to the corner impact")?;
    for outcome in &document.outcomes {
        motions(out, outcome)?;
    }
    if document.ranges.is_empty() {
        return Ok(());
    }
    out.heading("How far it holds: within 10 % of the simulated machine")?;
    for compared in [Compared::OneRevolution, Compared::FixedPointMinus, Compared::FixedPointPlus] {
        let ranges = document.ranges.iter().filter(|range| range.compared == compared);
        for (index, range) in ranges.enumerate() {
            let name = if index > 0 { "" } else { words::compared(compared) };
            entry(out, name, &range_words(range))?;
        }
    }
    Ok(())
}

fn motions(out: &mut Page, outcome: &LocalOutcome) -> fmt::Result {
    let speeds = Speeds::of(outcome.mu);
    let ends: Vec<_> =
        outcome.fates.iter().map(|fate| format!("{} {}", fate.starts, text(&words::end(&fate.end)))).collect();
    entry(out, words::speeds(speeds), &format!("{} motions: {}", outcome.starts(), ends.join("; ")))?;
    if speeds.is_none() {
        return Ok(());
    }
    let stable: Vec<_> =
        outcome.orbits.iter().filter(|orbit| orbit.stable()).map(|orbit| orbit.word.to_string()).collect();
    let unstable: Vec<_> =
        outcome.orbits.iter().filter(|orbit| !orbit.stable()).map(|orbit| orbit.word.to_string()).collect();
    const SHOWN: usize = 6;
    let listed = |words: &[String]| match words {
        [] => "none".to_owned(),
        words if words.len() > SHOWN => {
            format!("{} and {} more", words[..SHOWN].join(", "), words.len() - SHOWN)
        }
        words => words.join(", "),
    };
    entry(out, "", &format!("periodic orbits: stable {}; unstable {}", listed(&stable), listed(&unstable)))
}

fn range_words(range: &Range) -> String {
    let speeds = speeds_at(range.sign);
    if range.difference.is_none() {
        return format!("{speeds}: nowhere");
    }
    let to = words::ends(range.ends);
    format!("{speeds}: to {:.6} rpm, dT = {:.3e} s{to}", range.speed_rpm, range.period_change)
}
