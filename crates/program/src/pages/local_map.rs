//! Page section on the local map: its distance from degenerate cases, its predictions, and its range of validity.

use corner_impact::border_collision::feigin::{Speeds, speeds_at};
use corner_impact::border_collision::local_map::MapOrbit;
use corner_impact::border_collision::validity::{ComparedMotion, Range};
use nalgebra::Vector2;

use crate::show::block::{Block, Column, Span, Table, Words, about, words};
use crate::show::digits::Digits;
use crate::show::words;
use corner_impact::border_collision::{LocalOutcome, RobustChaos, RoundedCorner};
use corner_impact::cam::Side;
use corner_impact::orbit::Stability;
use corner_impact::study::verify::Verification;
use corner_impact::tolerance;

/// Start of the second column.
const COLUMN: usize = 20;

/// Largest number of orbits of a kind in a line.
const SHOWN: usize = 6;

/// Condition nearest to failing, and the failing conditions.
pub(crate) fn conditions(found: &Verification) -> Vec<(Words, Words)> {
    let (holding, count) =
        (found.conditions.iter().filter(|condition| condition.holds()).count(), found.conditions.len());
    let nearest = found.conditions.iter().min_by(|a, b| a.distance.total_cmp(&b.distance)).map(|nearest| {
        let words = format!("{holding} of {count} hold; closest to failing, by ");
        ("conditions".into(), about("conditions", words![words, (nearest.distance, Digits::Size), ": ", nearest.name]))
    });
    let failing = found.conditions.iter().filter(|condition| !condition.holds()).map(|failing| {
        let rests = format!(": {}; the {} depends on it", failing.meaning, words::decides(failing.decides));
        ("fails".into(), about("conditions", words![failing.name, " = ", (failing.value, Digits::Size), rests]))
    });
    nearest.into_iter().chain(failing).collect()
}

pub(crate) fn every_condition(found: &Verification) -> Table {
    let mut columns = vec![Column::words("condition on")];
    columns.extend(["value", "distance from failing"].map(Column::number));
    columns.extend(["holds", "decides", "if it fails"].map(Column::words));
    let mut table = Table::new("Conditions of the classification", columns);
    for condition in &found.conditions {
        let [value, distance] = [(condition.value, Digits::Significant(6)), (condition.distance, Digits::Size)];
        let words =
            [if condition.holds() { "yes" } else { "no" }, words::decides(condition.decides), condition.meaning];
        let mut cells = vec![condition.name.into(), words![value], words![distance]];
        cells.extend(words.map(Words::from));
        table.row_bad_where(!condition.holds(), cells);
    }
    table
}

/// Motions of the local map, and its range of validity.
pub(crate) fn blocks(found: &Verification) -> Vec<Block> {
    if found.outcomes.is_empty() {
        return Vec::new();
    }
    let mut blocks = vec![
        Block::Heading("Motions of the local map, next to the corner impact".into()),
        Block::Entries(COLUMN, found.outcomes.iter().flat_map(motions).collect()).about("local_map"),
    ];
    for outcome in found.outcomes.iter().filter(|outcome| outcome.mu != 0.0 && outcome.orbits.len() > SHOWN) {
        let orbits = outcome
            .orbits
            .iter()
            .map(|orbit| words![Span::Code(orbit.word.to_string()), " ", words::stability(orbit.stability())]);
        let title = format!("Every periodic orbit {}", words::speeds(Speeds::of(outcome.mu)));
        blocks.push(Block::Details(title.into(), vec![Block::paragraph(Words::joined(orbits, ", "))]));
    }
    if !found.ranges.is_empty() {
        blocks.push(Block::Heading("Range of the local map: within 10 % of the simulated machine".into()));
        blocks.push(Block::Entries(COLUMN, held(found, |range| range.order == 1).collect()).about("linear_range"));
    }
    if let Some(curved) = &found.second_order {
        blocks.push(Block::Heading("With the terms of second order".into()));
        let sides = [Side::Minus, Side::Plus].into_iter();
        let branches = sides.filter_map(|side| Some(branch(side, curved.of(side).fixed_point()?)));
        blocks.push(Block::Entries(COLUMN, branches.collect()).about("second_order"));
        for (within, title) in [(tolerance::LINEAR_WITHIN, "within 10 %:"), (tolerance::CURVED_WITHIN, "within 1e-4:")]
        {
            let held = held(found, move |range| range.order == 2 && range.within == within.value);
            let held = Block::Entries(COLUMN, held.collect()).about("linear_range");
            blocks.extend([Block::paragraph(title), held]);
        }
    }
    if let Some(RoundedCorner { rpm_per_degree, degrees }) = found.rounded_corner {
        let [moved, degrees, within] =
            [rpm_per_degree, degrees, tolerance::ROUNDED_AWAY.value].map(|value| words![(value, Digits::Power(2))]);
        blocks.push(Block::Heading("If the corner is rounded".into()));
        let told = "the fold is smooth and lies {} rpm from omega* per degree of rounding, at most {} rpm up to {} deg";
        let told = vec![("by a polynomial".into(), Words::prose(told, [moved, within, degrees]))];
        blocks.push(Block::Entries(COLUMN, told).about("rounded_corner"));
    }
    blocks
}

fn motions(outcome: &LocalOutcome) -> Vec<(Words, Words)> {
    let speeds = Speeds::of(outcome.mu);
    let ends = outcome.fates.iter().map(|fate| words![fate.starts, " ", words::end(&fate.end)]);
    let ends = words![outcome.starts(), " motions: ", Words::joined(ends, "; ")];
    let mut lines = vec![(words::speeds(speeds).into(), ends)];
    if speeds.is_some() {
        let of = |stability: Stability| {
            let orbits: Vec<_> = outcome.orbits.iter().filter(|orbit| orbit.stability() == stability).collect();
            let is_told = stability != Stability::Neutral || !orbits.is_empty();
            is_told.then(|| format!("{} {}", words::stability(stability), listed(&orbits)))
        };
        let each = [Stability::Stable, Stability::Unstable, Stability::Neutral].into_iter().filter_map(of);
        lines.push(("".into(), format!("periodic orbits: {}", each.collect::<Vec<_>>().join("; ")).into()));
    }
    lines.extend(outcome.robust_chaos.iter().map(|chaos| ("".into(), theorem(chaos))));
    lines
}

/// Statement of the theorem of robust chaos, and its conditions.
fn theorem(chaos: &RobustChaos) -> Words {
    let rests = chaos
        .hypotheses
        .iter()
        .map(|hypothesis| words![hypothesis.name, " = ", (hypothesis.value, Digits::of(hypothesis.value, 3))]);
    let rests = words![" (", Words::joined(rests, ", "), "; ", chaos.known.to_string(), ")"];
    if !chaos.holds() {
        return words!["no robust chaos: phi must be positive", rests];
    }
    words![
        "theorem: the local map has robust chaos: an attractor, no stable orbit of any period, and each exponent at least ",
        // Rounded down, as a lower bound must be.
        ((1e4 * chaos.least_exponent).floor() / 1e4, Digits::Fixed(4)),
        " per turn",
        rests,
        "; by a cited theorem the follower has it too, near enough to omega*, but over how many rpm is not known"
    ]
}

/// Symbol sequences of some orbits.
fn listed(orbits: &[&MapOrbit]) -> String {
    let some = orbits.iter().take(SHOWN).map(|orbit| orbit.word.to_string()).collect::<Vec<_>>().join(", ");
    match orbits.len() {
        0 => "none".into(),
        count if count > SHOWN => format!("{some} and {} more", count - SHOWN),
        _ => some,
    }
}

/// Selected ranges of validity, by the compared prediction.
fn held(found: &Verification, asked: impl Fn(&Range) -> bool + Copy) -> impl Iterator<Item = (Words, Words)> {
    let all =
        [ComparedMotion::OneRevolution, ComparedMotion::FixedPointMinus, ComparedMotion::FixedPointPlus].into_iter();
    all.flat_map(move |compared| {
        let ranges = found.ranges.iter().filter(move |range| asked(range) && range.compared == compared);
        ranges.enumerate().map(move |(index, range)| {
            (Words::from(if index > 0 { "" } else { words::compared(compared) }), range_words(range))
        })
    })
}

/// Position of the fixed point of a side.
fn branch(side: Side, [first, second]: [Vector2<f64>; 2]) -> (Words, Words) {
    let pair = |of: Vector2<f64>| Words::prose("({}, {})", [0, 1].map(|row| words![(of[row], Digits::Significant(8))]));
    (
        format!("fixed point {side}").into(),
        words!["dx = ", pair(first), " dT + ", pair(second), " dT^2, ", Span::Unit("m"), " and ", Span::Unit("m/s")],
    )
}

fn range_words(range: &Range) -> Words {
    let speeds = speeds_at(range.sign);
    if range.difference.is_none() {
        return format!("{speeds}: nowhere").into();
    }
    let (to, change) = ((range.speed_rpm, Digits::Fixed(6)), (range.period_change, Digits::Power(4)));
    words![speeds, ": to ", to, " rpm, dT = ", change, " s", words::ends(range.ends)]
}
