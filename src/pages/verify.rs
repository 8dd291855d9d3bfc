//! The page of `verify`, section by section: where the corner impact is, its map by every route, what happens there.

use crate::agreement::{Agreement, by_quantity, fewest_shared_decimals, shared_decimals, worse};
use crate::border_collision::feigin::{Scenario, SideCounts};
use crate::border_collision::{Classification, NormalForm, Refusal};
use crate::cam::Side;
use crate::corner::map::{CornerMap, Route, Uncertainty};
use crate::pages::local_map;
use crate::show::Paged;
use crate::show::block::{Block, Column, Mark, Span, Table, Words, words};
use crate::show::digits::Digits;
use crate::show::words;
use crate::study::verify::Verification;

impl Paged for Verification {
    fn blocks(&self) -> Vec<Block> {
        let title = Block::Title(format!("Corner impact of {}", self.model.name).into());
        let mut page = vec![title, Block::paragraph(&self.model.source)];
        for section in
            [orbit(self), map(self), agreement(self), bifurcation(self), local_map::blocks(self), published(self)]
        {
            page.extend(section);
        }
        page.extend(verdict(self));
        page
    }
}

/// Where the corner impact is.
pub(crate) fn orbit(found: &Verification) -> Vec<Block> {
    let at = &found.at;
    let (state, [before, after]) = (at.x_star(), at.cam_acceleration());
    let significant = |value, digits| (value, Digits::Significant(digits));
    let fixed = |value, places| (value, Digits::Fixed(places));
    let degrees = |angle: f64| fixed(angle.to_degrees(), 6);
    let period = words!["T* = ", significant(at.period, 14), " s   (", fixed(at.speed_rpm(), 9), " rpm)"];
    let x_star = words![
        "x* = (",
        significant(state[0], 13),
        ", ",
        significant(state[1], 13),
        ")",
        Span::Break,
        "half a revolution from the impact; position is measured from q = ",
        significant(at.origin, 9),
        " m",
    ];
    let impact = words![
        "at cam angle ",
        degrees(at.corner.angle),
        " deg, where c'' jumps from ",
        fixed(before, 4),
        " to ",
        fixed(after, 4),
        " m/s^2",
        Span::Break,
        "q = ",
        fixed(at.corner.plus.value, 9),
        " m, v = ",
        fixed(at.velocity_before, 6),
        " before and ",
        fixed(at.velocity_after, 6),
        " after, c' = ",
        fixed(at.cam_velocity, 6),
        " m/s",
    ];
    let mut entries: Vec<(Words, Words)> =
        vec![("period".into(), period), ("state".into(), x_star), ("impact".into(), impact)];
    entries.extend(found.others.iter().map(|other| {
        let (speed, angle) = (fixed(other.speed_rpm(), 6), degrees(other.corner.angle));
        ("also".into(), words![speed, " rpm at ", angle, " deg: narrow [study] to verify that one"])
    }));
    vec![Block::Heading("The orbit, solved for from the model".into()), Block::Entries(9, entries)]
}

/// The map by every route, side by side, and how well estimates know it.
pub(crate) fn map(found: &Verification) -> Vec<Block> {
    let mut blocks = vec![
        Block::Heading("Its local map:  dx' = A dx + B dT".into()),
        Block::paragraph(
            "dx is the deviation of the state (position in m, velocity in m/s) from x*, dT that of the period from T* (s), dx' \
             the deviation one revolution later. minus holds where the impact comes before the corner, plus where it comes \
             after it. C = h (A+ - A-), D = h (B+ - B-), h = [1 0]: the sides meet where C dx + D dT = 0.",
        ),
        Block::Gap,
    ];
    for side in [Side::Minus, Side::Plus] {
        blocks.push(Block::paragraph(format!("{side}: {}", words::side(side))));
        blocks.extend([Block::Table(entries(found, side)), Block::Gap]);
    }
    let (c, ten) = (found.map.c(), Digits::Significant(10));
    let border = words!["C = (", (c[0], ten), ", ", (c[1], ten), "),  D = ", (found.map.d(), ten)];
    blocks.extend([Block::Entries(0, vec![("".into(), border)]), Block::Gap]);
    blocks.extend(found.routes_by_name().filter_map(known_to));
    blocks
}

/// A and B of one side by every route, and as the paper prints them.
fn entries(found: &Verification, side: Side) -> Table {
    const NAMES: [&str; 6] = ["A11", "A12", "A21", "A22", "B1", "B2"];
    let routes: Vec<&Route> = found.routes_by_name().collect();
    let printed: Vec<&str> = ["A", "B"]
        .iter()
        .filter_map(|letter| {
            let is_it = |name: String| name == format!("{letter}_{side}");
            found.published.iter().find(|number| is_it(number.agreement.quantity.to_string()))
        })
        .flat_map(|number| number.printed.iter().map(String::as_str))
        .collect();
    let mut columns = vec![Column::left("", 4, 4)];
    // Two words, two lines.
    columns.extend(routes.iter().map(|route| Column::right(words::route(route.name).replacen(' ', "\n", 1), 14)));
    columns.extend((!printed.is_empty()).then(|| Column::right("printed", 19)));
    let mut table = Table::new(words::side(side), columns);
    table.repeated = Some(usize::from(!printed.is_empty()));
    for (index, name) in NAMES.into_iter().enumerate() {
        let value = |route: &&Route| {
            let all = route.map.of(side).entries();
            Words::from((all[index], digits(if index < 4 { &all[..4] } else { &all[4..] })))
        };
        let cells = [name.into()].into_iter().chain(routes.iter().map(value));
        table.row(cells.chain(printed.get(index).map(|digits| Words::from(*digits))).collect::<Vec<_>>());
    }
    table
}

/// Ten digits of the largest of some entries, which are read against one another, in a column of a terminal.
fn digits(entries: &[f64]) -> Digits {
    let largest = entries.iter().fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
    match largest {
        0.0 => Digits::Fixed(9),
        _ if (1e-3..1e9).contains(&largest) => Digits::Fixed((9.0 - largest.log10().floor()) as usize),
        _ => Digits::Power(6),
    }
}

/// How well a route says that it knows the entries.
fn known_to(route: &Route) -> Option<Block> {
    let size = |value| (value, Digits::Size);
    let (name, words) = (
        words::route(route.name),
        match route.uncertainty? {
            Uncertainty::Fit { standard, systematic, condition_number } => {
                let ((a, b), (bias_a, bias_b)) = (largest(&standard), largest(&systematic?));
                words![
                    "standard error up to ",
                    size(a),
                    " in A, ",
                    size(b),
                    " in B; bias up to ",
                    size(bias_a),
                    ", ",
                    size(bias_b),
                    ";",
                    Span::Break,
                    "condition number ",
                    (condition_number, Digits::Fixed(1)),
                ]
            }
            Uncertainty::Extrapolation(error) => {
                let (a, b) = largest(&error);
                words!["error estimate up to ", size(a), " in A, ", size(b), " in B"]
            }
        },
    );
    Some(Block::Entries(name.len() + 2, vec![(format!("{name}:").into(), words)]))
}

/// The largest entries of A and of B.
fn largest(error: &CornerMap) -> (f64, f64) {
    let both = [error.minus, error.plus];
    let a = both.iter().flat_map(|side| side.a.iter()).copied().fold(0.0, worse);
    (a, both.iter().flat_map(|side| side.b.iter()).copied().fold(0.0, worse))
}

/// Of each quantity the pair of routes that is nearest to its bound, and every pair that disagrees.
pub(crate) fn agreement(found: &Verification) -> Vec<Block> {
    let columns = [
        Column::left("quantity", 2, 19),
        Column::right("pairs", 5),
        Column::right("differ by", 12),
        Column::right("allowed", 10),
        Column::left("share", 2, 14),
        Column::left("between", 0, 0),
    ];
    let mut table = Table::new("Comparisons", columns);
    for pairs in by_quantity(&found.comparisons) {
        let disagreeing = pairs.all.iter().copied().filter(|entry| !entry.agrees);
        let shown = [pairs.closest].into_iter().filter(|entry| entry.agrees).chain(disagreeing);
        for (index, Agreement { routes, max_abs_diff, bound, agrees, .. }) in shown.enumerate() {
            let between = routes.map(words::route).join(" - ");
            let head = (index == 0).then(|| (words::quantity(pairs.quantity), Words::from(pairs.all.len())));
            let (name, count) = head.unwrap_or_default();
            let [differ, allowed] = [*max_abs_diff, bound.value].map(|value| Words::from((value, Digits::Size)));
            let between = match agrees {
                true => between.into(),
                false => (Mark::Bad, format!("{between}  DISAGREE").as_str()).into(),
            };
            let share = words::shared(shared_decimals(*max_abs_diff)).into();
            table.row_bad_where(!agrees, [name, count, differ, allowed, share, between]);
        }
    }
    let title = "Do the routes agree? Every pair, in every quantity; shown is the pair closest to its bound";
    vec![Block::Heading(title.into()), Block::Table(table)]
}

/// Eigenvalues, normal form and verdict, and what that rests on.
pub(crate) fn bifurcation(found: &Verification) -> Vec<Block> {
    let eigenvalues = |side| {
        let [one, two] =
            found.map.of(side).eigenvalues().map(|value| Span::Complex([value.re, value.im], Digits::Fixed(9)));
        words![one, ",  ", two]
    };
    let mut entries: Vec<(Words, Words)> = vec![
        ("eigenvalues of A-".into(), eigenvalues(Side::Minus)),
        ("eigenvalues of A+".into(), eigenvalues(Side::Plus)),
    ];
    entries.extend(found.normal_form.as_ref().ok().map(|form| ("normal form".into(), normal_form(form))));
    match &found.classification {
        Ok(kind) => entries.extend(classification(kind)),
        Err(refusal) => entries.push(("verdict".into(), none(refusal))),
    }
    entries.extend(local_map::conditions(found));
    vec![Block::Heading("What happens there".into()), Block::Entries(20, entries)]
}

fn normal_form(form: &NormalForm) -> Words {
    let nine = Digits::UpTo(9);
    let rows = |m: &nalgebra::Matrix2<f64>| {
        Span::Matrix(m.row_iter().map(|row| row.iter().copied().collect()).collect(), nine)
    };
    let pair = |one, two| words!["(", (one, nine), ", ", (two, nine), ")"];
    words![
        "A-bar ",
        rows(&form.a_bar_minus),
        Span::Break,
        "A+bar ",
        rows(&form.a_bar_plus),
        Span::Break,
        "B bar ",
        pair(form.b_bar[0], form.b_bar[1]),
        ",  C bar ",
        pair(form.c_bar[0], form.c_bar[1]),
    ]
}

fn classification(kind: &Classification) -> Vec<(Words, Words)> {
    let Classification { scenario, minus, plus, .. } = kind;
    let counts = format!(
        "{} + {} real eigenvalues above 1, {} + {} below -1",
        minus.above_one, plus.above_one, minus.below_minus_one, plus.below_minus_one
    );
    let born = kind.period_two_orbit && *scenario != Scenario::NonsmoothFlip;
    let born = if born { ", and an orbit of period two" } else { "" };
    let verdict = words![scenario.to_string(), born, Span::Break, words::meaning(*scenario)];
    let fate = |side: &SideCounts| {
        let stability = if side.stable { "a stable" } else { "an unstable" };
        format!("{stability} one at speeds {}", words::speeds(Some(side.exists_for)))
    };
    let fixed = words!["minus: ", fate(minus), Span::Break, "plus:  ", fate(plus)];
    [("Feigin's counts", counts.into()), ("verdict", verdict), ("fixed points", fixed)]
        .map(|(name, words)| (name.into(), words))
        .into()
}

fn none(refusal: &Refusal) -> Words {
    words!["none", Span::Break, refusal.to_string()]
}

/// The paper's printed numbers, each in a line, and what is wrong with those that do not hold.
fn published(found: &Verification) -> Vec<Block> {
    if found.published.is_empty() {
        return Vec::new();
    }
    let widths = [(2, 20), (0, 20), (0, 18), (0, 22), (0, 0)];
    let mut table = Table::new("The paper's printed numbers", widths.map(|(gap, least)| Column::left("", gap, least)));
    let mut notes = Vec::new();
    for number in &found.published {
        let Agreement { quantity, max_abs_diff, .. } = number.agreement;
        let mut verdict = words::verdict(number.verdict);
        if !number.as_found {
            verdict.push(words!["   ", (Mark::Bad, "UNEXPECTED")]);
        }
        table.row([
            words::quantity(quantity),
            number.place.as_str().into(),
            format!("differs by {:>7}", Digits::Size.text(max_abs_diff)).into(),
            format!(", shares {}", words::shared(shared_decimals(max_abs_diff))).into(),
            verdict,
        ]);
        if !number.note.is_empty() {
            let computed: Vec<_> =
                number.computed.iter().map(|value| Words::from((*value, Digits::Significant(10)))).collect();
            let printed = format!(", printed ({}), computed (", number.printed.join(", "));
            let note = words![words::quantity(quantity), printed, Words::joined(computed, ", "), "): ", number.note];
            notes.extend([Block::Gap, Block::paragraph(note)]);
        }
    }
    let heading = Block::Heading("The paper's printed numbers".into());
    [heading, Block::Table(table)].into_iter().chain(notes).collect()
}

/// What did not run, and whether everything agrees.
pub(crate) fn verdict(found: &Verification) -> Vec<Block> {
    let mut blocks = Vec::new();
    if !found.skipped.is_empty() {
        let line = |skipped: &crate::study::compared::Skipped| format!("{}: {}", skipped.route, skipped.why).into();
        blocks.extend([Block::Heading("NOT RUN".into()), Block::List(found.skipped.iter().map(line).collect())]);
    }
    blocks.push(Block::Heading("Verdict".into()));
    let (pairs, numbers) = (&found.comparisons, &found.published);
    let agreeing = pairs.iter().filter(|entry| entry.agrees).count();
    let fewest = fewest_shared_decimals(pairs);
    let more = if fewest.is_some() { " or more" } else { "" };
    blocks.push(Block::paragraph(format!(
        "{agreeing} of {} comparisons agree; every entry of A and B shares {}{more}.",
        pairs.len(),
        words::shared(fewest)
    )));
    if !numbers.is_empty() {
        let unexpected = numbers.iter().filter(|number| !number.as_found).count();
        let wrong = numbers.iter().filter(|number| number.as_found && !number.agreement.agrees).count();
        blocks.push(Block::paragraph(format!(
            "Of the paper's {} printed numbers {} hold, {wrong} are wrong as listed, {unexpected} came out otherwise than found.",
            numbers.len(),
            numbers.len() - wrong - unexpected
        )));
    }
    let missing: Vec<&str> =
        found.skipped.iter().filter(|skipped| skipped.failed).map(|skipped| skipped.route.as_str()).collect();
    let all_agree = agreeing == pairs.len() && numbers.iter().all(|number| number.as_found);
    let (mark, word, reason) = match missing.as_slice() {
        _ if found.agrees => (Mark::Good, "AGREES", String::new()),
        [] => (Mark::Bad, "DISAGREES", ": a comparison above".to_owned()),
        [most @ .., last] => {
            let names = if most.is_empty() { (*last).to_owned() } else { format!("{} and {last}", most.join(", ")) };
            // What ran may agree: then nothing disagrees, and not everything was checked.
            let word = if all_agree { "INCOMPLETE" } else { "DISAGREES" };
            (Mark::Bad, word, format!(": {names} did not run"))
        }
    };
    blocks.push(Block::paragraph(words![(mark, word), reason]));
    blocks
}
