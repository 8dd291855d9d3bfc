//! Page of `chaos`: the theorem first, then its basis, then the places where nothing is proved.

use crate::show::block::{Block, Column, Span, Table, TextMark, Words, words};
use crate::show::digits::{Digits, at_least};
use crate::show::{Paged, words};
use corner_impact::covering::prove::Refused;
use corner_impact::covering::region::{OpenRegion, Region};
use corner_impact::elementary;
use corner_impact::study::chaos::{Chaos, Open, Theorem};
use corner_impact::study::trapping::Trapped;

impl Paged for Chaos {
    fn blocks(&self) -> Vec<Block> {
        let [low, high] = self.rpm;
        let speeds = if low < high { format!("{low} to {high} rpm") } else { format!("{low} rpm") };
        let mut page =
            vec![Block::Line((TextMark::Heading, format!("{} at {speeds}", self.model).as_str()).into()), Block::Gap];
        page.push(Block::paragraph(statement(self)));
        match self.theorems.as_slice() {
            [] => page.push(Block::Gap),
            all if low == high => {
                page.extend(all.iter().map(|theorem| Block::Table(strips(theorem))));
                page.push(Block::Note(words![
                    "x and y are coordinates without a unit in a parallelogram of impacts. Its axes are the cam angle in deg and the velocity \
                     after the impact relative to the cam in ",
                    Span::Unit("m/s"),
                    ". --json has its centre and its sides."
                ]));
            }
            _ => page.push(Block::Table(ranges(self))),
        }
        let is_region_proved = self.trapping.as_ref().is_some_and(|trapping| !trapping.regions.is_empty());
        if !self.theorems.is_empty() || is_region_proved {
            page.extend(words::hypotheses(&self.hypotheses).map(Block::paragraph));
        }
        page.extend(
            self.theorems.iter().flat_map(|theorem| &theorem.refused).map(|why| Block::paragraph(refused(why))),
        );
        page.extend(self.open.iter().map(open));
        if let Some(trapping) = &self.trapping {
            let told = trapping.regions.iter().map(|trapped| self::trapped(trapped, low));
            let open = (!trapping.escapes.is_empty()).then(|| escaped(&trapping.escapes, low));
            page.extend(told.chain(open).flat_map(|told| [Block::Gap, Block::paragraph(told)]));
        }
        page
    }
}

/// Theorem in a sentence or two.
pub(crate) fn statement(found: &Chaos) -> String {
    let is_one = found.rpm[0] == found.rpm[1];
    // At one speed, the first theorem is the one with cones, if any; another one may have more strips but no cones.
    let (told, more) = match found.theorems.as_slice() {
        [first, more @ ..] if is_one => (std::slice::from_ref(first), more),
        all => (all, &[][..]),
    };
    let Some(least) = told.iter().min_by(|one, two| one.set.entropy().total_cmp(&two.set.entropy())) else {
        return "No set of chaotic motions is proved to exist.".into();
    };
    let where_at = match (found.rpm[0] < found.rpm[1], found.open.is_empty()) {
        (false, _) => "",
        (true, true) => " at every speed of this range",
        (true, false) => " at every speed of this range, except those listed below",
    };
    let symbols = |theorem: &Theorem| -> Vec<u64> { theorem.set.strips.iter().map(|strip| strip.impacts).collect() };
    let entropy = |theorem: &Theorem| at_least(theorem.set.entropy(), 5);
    let cones = match told.iter().all(|theorem| theorem.set.cone_slope.is_some()) {
        true => "exactly one motion",
        false => "a motion",
    };
    let shift = match told {
        [_] => format!(
            "For every sequence of the numbers {}, endless in both directions, there is {cones} that passes through the strips of these numbers \
             in this order. From each strip it reaches the next after as many impacts as the strip's number.",
            words::listed(&symbols(least))
        ),
        _ => format!(
            "For every sequence of {} or more symbols, endless in both directions, there is {cones} that follows it.",
            told.iter().map(|theorem| theorem.set.strips.len()).min().unwrap_or(0)
        ),
    };
    let more = more.iter().map(|theorem| {
        format!(
            " For every sequence of {} there is also a motion, perhaps more than one, with an entropy of at least {}.",
            words::listed(&symbols(theorem)),
            entropy(theorem)
        )
    });
    format!(
        "Proved: a set of chaotic motions exists{where_at}. {shift} The topological entropy per revolution is at least {}.{} The proof \
         does not state that other motions converge to this set.",
        entropy(least),
        more.collect::<String>()
    )
}

/// States the proof about a region.
fn trapped(found: &Trapped, rpm: f64) -> Words {
    let Region { cells, velocities_m_s, part, angles_deg, .. } = found.region;
    let chaos = match found.holds_chaos {
        true => " All strips lie in it, and so does the set of chaotic motions.",
        false => "",
    };
    let parted = found.parted.map_or_else(String::new, |growth| {
        format!(
            " For every motion in it, some deviations grow at each impact by a factor of at least {}. So no periodic orbit in it is stable, and \
             every motion has a largest Lyapunov exponent of at least {} per impact.",
            at_least(growth, 4),
            // The logarithm has an error below one ulp.
            at_least(elementary::ln(growth).next_down().next_down(), 4)
        )
    });
    let percent = 100.0 * part;
    words![
        format!(
            "Proved: a region traps motions at {rpm} rpm. After an impact in one of its {}, all later impacts are in them: the follower flies and \
             hits for ever, and never rests on the cam. The cells lie at {} deg and {} ",
            words::many(cells as u64, "cell"),
            words::range(outwards(angles_deg), Digits::UpTo(4)),
            words::range(outwards(velocities_m_s), Digits::UpTo(4)),
        ),
        Span::Unit("m/s"),
        format!(
            " relative to the cam, and are {} % of all angles and velocities up to there.{chaos}{parted}",
            if percent < 0.01 { Digits::Size } else { Digits::Significant(2) }.text(percent),
        ),
    ]
}

/// Ends of a range to four places, rounded outwards.
fn outwards([low, high]: [f64; 2]) -> [f64; 2] {
    [(1e4 * low).floor() / 1e4, (1e4 * high).ceil() / 1e4]
}

/// Explains why no trapping region was proved, and after how many cells.
fn escaped(escapes: &[OpenRegion], rpm: f64) -> Words {
    let each = escapes.iter().map(|escape| {
        let [angle, velocity] = escape.at;
        let why = match escape.flight {
            Some(flight) => words![
                format!("from an impact at {angle:.3} deg that leaves with {velocity:.4} "),
                Span::Unit("m/s"),
                format!(" {}", words::unproved(flight))
            ],
            None if escape.cells == 0 => "no impact was found to begin with".into(),
            None => "the cells were too many".into(),
        };
        let size = words::many(escape.squares_per_degree.into(), "square");
        words![format!("with {size} a degree, after {}, ", words::many(escape.cells as u64, "cell")), why]
    });
    words![format!("No trapping region is proved at {rpm} rpm: "), Words::joined(each, "; "), "."]
}

/// Table of the strips, with what is proved about each.
pub(crate) fn strips(theorem: &Theorem) -> Table {
    let head = ["impacts", "revolutions", "strip, x", "image, y", "growth", "boxes"];
    let least = [7, 11, 18, 18, 7, 6];
    let columns: Vec<Column> =
        head.iter().zip(least).map(|(head, least)| Column { gap: 2, ..Column::right(*head, least) }).collect();
    let mut table = Table::new("Strips that cover the h-set", columns);
    for (strip, covered) in theorem.set.strips.iter().zip(&theorem.strips) {
        table.row([
            strip.impacts.to_string().into(),
            strip.revolutions.to_string().into(),
            words::range(strip.x, Digits::Fixed(4)).into(),
            words::range(covered.image_y, Digits::Fixed(4)).into(),
            covered.growth.map_or_else(|| "".into(), |growth| at_least(growth, 1).into()),
            covered.boxes.to_string().into(),
        ]);
    }
    table
}

/// Table of ranges of speeds with the same symbols, in order.
fn ranges(found: &Chaos) -> Table {
    let right = |head: &str, least: usize| Column { gap: 2, ..Column::right(head, least) };
    let columns = [right("from (rpm)", 10), right("to (rpm)", 10), right("h-sets", 6), Column::left("impacts", 2, 0)];
    let mut table = Table::new("Sets of chaotic motions by speed", columns);
    let symbols = |theorem: &Theorem| {
        let symbols: Vec<u64> = theorem.set.strips.iter().map(|strip| strip.impacts).collect();
        words::listed(&symbols)
    };
    let meets = |one: &Theorem, two: &Theorem| one.set.rpm[1] == two.set.rpm[0] && symbols(one) == symbols(two);
    for run in found.theorems.chunk_by(meets) {
        let [Some(first), Some(last)] = [run.first(), run.last()] else { continue };
        table.row([
            words![(first.set.rpm[0], Digits::UpTo(6))],
            words![(last.set.rpm[1], Digits::UpTo(6))],
            run.len().to_string().into(),
            symbols(first).into(),
        ]);
    }
    table
}

/// Reason why a strip was refused.
fn refused(why: &Refused) -> String {
    let how = if why.is_refuted { "does not hold" } else { "could not be decided" };
    let flight = why.flight.map_or_else(String::new, |flight| format!(" ({})", words::unproved(flight)));
    let [x, y] = why.at;
    format!(
        "The strip of {} was given up: {} {how}{flight}, at x = {x:.5}, y = {y:.5}.",
        words::many(why.impacts, "impact"),
        words::relation(why.relation)
    )
}

fn open(open: &Open) -> Block {
    let [low, high] = open.rpm;
    let speeds = if low < high { format!("{low} to {high} rpm") } else { format!("{low} rpm") };
    let short = &open.short;
    let tried = match (short.saddles, short.strips) {
        (0, _) => "no saddle of few impacts was found to begin with".to_owned(),
        (saddles, 0) => format!(
            "no two strips return across the h-set, around {} of saddles",
            words::many(saddles as u64, "impact")
        ),
        (_, strips) => format!("by sampling, {} returned across the h-set", words::many(strips as u64, "strip")),
    };
    let refused: Vec<String> = short.refused.iter().map(refused).collect();
    Block::paragraph(format!("Not proved at {speeds}: {tried}. {}", refused.join(" ")))
}
