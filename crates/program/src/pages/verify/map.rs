//! Page section on the map: the results of every route side by side, errors of estimates, and agreement of the routes.

use super::uncertain;
use crate::show::block::{Block, Column, Span, Table, TextMark, Words, about, words};
use crate::show::digits::Digits;
use crate::show::sources::Sources;
use crate::show::words;
use corner_impact::agreement::{Agreement, Quantity, by_quantity, shared_decimals, worse};
use corner_impact::cam::Side;
use corner_impact::corner::map::{CornerMap, Route, Uncertainty};
use corner_impact::elementary;
use corner_impact::study::verify::{LeftOpen, Verification};

/// Map by every route, side by side, and the errors of estimates.
pub(crate) fn map(found: &Verification) -> Vec<Block> {
    let mut blocks = vec![
        Block::Heading("Its local map:  dx' = A dx + B dT".into()),
        Block::paragraph(words![
            "dx is the deviation of the state (position in ",
            Span::Unit("m"),
            ", velocity in ",
            Span::Unit("m/s"),
            ") from x*. dT is the deviation of the period from T* (s), and dx' is dx one revolution later. minus holds if the impact comes before the \
             corner, plus if it comes after it. The sides meet where C dx + D dT = 0, with C = h (A+ - A-), D = h (B+ - B-), h = [1 0].",
        ]),
        Block::Full(vec![Block::paragraph(
            "The columns are independent: no two share a formula for A and B. Finite difference and least squares run \
             the same simulator. Symbolic and scipy run no code of this program. Certificate is given the place of the orbit, \
             and proves the rest. Digits that differ from the closed form are underlined.",
        )]),
        Block::Gap,
    ];
    for side in [Side::Minus, Side::Plus] {
        blocks.push(Block::Brief(vec![Block::paragraph(format!("{side}: {}", words::side(side)))]));
        let [brief, full] = [false, true].map(|has_room| vec![Block::Table(entries(found, side, has_room))]);
        blocks.extend([Block::Brief(brief), Block::Full(full), Block::Gap]);
    }
    let (c, ten) = (found.map.c(), Digits::Significant(10));
    let line = about("C", words!["C = (", (c[0], ten), ", ", (c[1], ten), ")"]);
    let border = words![line, ",  ", about("D", words!["D = ", (found.map.d(), ten)])];
    blocks.push(Block::Entries(0, vec![("".into(), border)]));
    let (e, f) = found.border;
    let side = words!["minus where e dx + f dT < 0:  e = (", (e[0], ten), ", ", (e[1], ten), "),  f = ", (f, ten)];
    blocks.extend([Block::Entries(0, vec![("".into(), about("border", side))]), Block::Gap]);
    blocks.extend(uncertain(found).into_iter().flat_map(left_open));
    blocks.extend(found.routes_by_name().filter_map(known_to).flatten());
    blocks
}

/// A and B of one side by every route, their differences if there is room, and the paper's printed values.
fn entries(found: &Verification, side: Side, has_room: bool) -> Table {
    let rows = found.entries(side);
    let printed = usize::from(rows.iter().any(|row| row.printed.is_some()));
    let name = |route: &Route| match words::route(route.name) {
        name if has_room => name,
        // Two words, two lines.
        name => name.replacen(' ', "\n", 1),
    };
    let mut columns = vec![Column::left("", 4, 4)];
    columns.extend(found.routes_by_name().map(|route| Column::right(name(route), 14)));
    columns.extend(has_room.then(|| Column::right("differ by", 0)));
    columns.extend((printed > 0).then(|| Column::right("printed", 19)));
    let mut table = Table::new(words::side(side), columns);
    table.repeated = Some(printed);
    for (index, row) in rows.iter().enumerate() {
        let like = if index < 4 { &rows[..4] } else { &rows[4..] };
        let quantity = if index < 4 { Quantity::A(side) } else { Quantity::B(side) }.to_string();
        let mut cells = vec![Span::Formula(row.entry.into()).into()];
        cells.extend(row.values.iter().enumerate().map(|(route, value)| {
            let digits = match has_room {
                true => Digits::Aligned(11),
                false => digits(like.iter().map(|row| row.values[route])),
            };
            about(&quantity, Span::Against(*value, row.values[0], digits))
        }));
        cells.extend(has_room.then(|| about(&quantity, words![(row.spread, Digits::Size)])));
        cells.extend(row.printed.as_ref().map(Words::from));
        table.row(cells);
    }
    table
}

/// Digits for entries in one column of a terminal: ten digits of the largest, or six and a power of ten.
fn digits(entries: impl Iterator<Item = f64>) -> Digits {
    let largest = entries.fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
    match largest {
        0.0 => Digits::Fixed(9),
        _ if (0.001..1e9).contains(&largest) => Digits::Fixed((9.0 - elementary::log10(largest).floor()) as usize),
        _ => Digits::Power(6),
    }
}

/// Uncertainty of the entries, with the parts of the cam and of each number.
fn left_open((open, sources): (&LeftOpen, Sources<'_>)) -> Vec<Block> {
    let Some(error) = &open.error else { return vec![Block::paragraph(sources.note())] };
    let table = |text: String, map: &CornerMap| {
        [Block::paragraph(text), Block::Table(errors(map)).about("measured_error"), Block::Gap]
    };
    let title = match sources {
        Sources { cam: Some(cam), errors } if errors.are_none() => {
            format!("Uncertainty of each entry from the measured cam, {}:", words::accuracy(cam))
        }
        sources => format!("Uncertainty of each entry from {}, {}:", sources.name(), sources.why()),
    };
    let mut blocks: Vec<Block> = table(title, &error.total()).into();
    if !sources.errors.are_none() {
        let parts = error.parts();
        let of_one = |name: &&str| match *name {
            "cam" => sources.cam.is_some(),
            "numbers" => sources.cam.is_some() || parts.len() == 2,
            _ => true,
        };
        let names = parts.keys().copied().filter(of_one);
        blocks.extend(names.flat_map(|name| table(format!("Part from {}:", source(name)), &parts[name])));
    }
    blocks.extend([Block::paragraph(sources.note()), Block::Gap]);
    blocks
}

/// A source of uncertainty in words.
fn source(name: &str) -> String {
    format!("the {}", words::spoken(name))
}

/// Estimate of a route's error by the route itself.
fn known_to(route: &Route) -> Option<[Block; 2]> {
    let size = |value| words![(value, Digits::Size)];
    let name = words::route(route.name);
    let (words, table) = match route.uncertainty? {
        Uncertainty::Fit { standard, systematic, condition_number } => {
            let ((a, b), (bias_a, bias_b)) = (largest(&standard), largest(&systematic?));
            let told = Words::prose(
                "standard error up to {} in A, {} in B; bias up to {}, {};{}condition number {}",
                [
                    size(a),
                    size(b),
                    size(bias_a),
                    size(bias_b),
                    Span::Break.into(),
                    words![(condition_number, Digits::Fixed(1))],
                ],
            );
            (told, errors(&standard))
        }
        Uncertainty::Extrapolation(error) => {
            let (a, b) = largest(&error);
            (Words::prose("error estimate up to {} in A, {} in B", [size(a), size(b)]), errors(&error))
        }
    };
    let title = format!("Errors that {name} estimates for its entries");
    let entries = Block::Entries(name.len() + 2, vec![(format!("{name}:").into(), words)]);
    Some([entries, Block::Details(title.into(), vec![Block::Table(table)])].map(|block| block.about("uncertainty")))
}

/// Error of each entry.
fn errors(error: &CornerMap) -> Table {
    const NAMES: [&str; 6] = ["A11", "A12", "A21", "A22", "B1", "B2"];
    let mut columns = vec![Column::left("side", 2, 0)];
    columns.extend(NAMES.map(|name| Column::right(name, 10)));
    let mut table = Table::new("Errors of the entries", columns);
    for side in [Side::Minus, Side::Plus] {
        let sizes = error.of(side).entries().map(|value| words![(value, Digits::Size)]);
        table.row([vec![words::side(side).into()], sizes.to_vec()].concat());
    }
    table
}

/// Largest entries of A and of B.
fn largest(error: &CornerMap) -> (f64, f64) {
    let both = [error.minus, error.plus];
    let a = both.iter().flat_map(|side| side.a.iter()).copied().fold(0.0, worse);
    (a, both.iter().flat_map(|side| side.b.iter()).copied().fold(0.0, worse))
}

/// Pair of routes nearest to its bound for each quantity, and every pair that disagrees.
pub(crate) fn agreement(found: &Verification) -> Vec<Block> {
    let columns = [
        Column::left("quantity", 2, 19),
        Column::right("pairs", 7),
        Column::right("differ by", 11),
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
            let count = match (pairs.all.len(), pairs.following()) {
                (all, 0) => all.to_string(),
                (all, following) => format!("{} + {following}", all - following),
            };
            let head = (index == 0).then(|| (words::quantity(pairs.quantity), Words::from(count)));
            let (name, count) = head.unwrap_or_default();
            let [differ, allowed] = [(*max_abs_diff, "agreement"), (bound.value, "bound")]
                .map(|(value, what)| about(what, (value, Digits::Size)));
            let between = match agrees {
                true => between.into(),
                false => (TextMark::Bad, format!("{between}  DISAGREE").as_str()).into(),
            };
            let share = words::shared(shared_decimals(*max_abs_diff)).into();
            table.row_bad_where(!agrees, [name, count, differ, allowed, share, between]);
        }
    }
    let title = "Do the routes agree? For each quantity, the pair of routes closest to its bound";
    let follow = found.comparisons.iter().any(|pair| pair.follows).then(|| {
        let note = "After a + are the pairs whose agreement follows: one function computes the quantity from the A and B of both routes.";
        Block::Note(note.into())
    });
    let all = format!("All {} comparisons, with the reason of each bound", found.comparisons.len());
    let all = Block::Details(all.into(), vec![Block::Table(comparisons(found)).about("agreement")]);
    [Block::Heading(title.into()), Block::Table(table)].into_iter().chain(follow).chain([all]).collect()
}

fn comparisons(found: &Verification) -> Table {
    let mut columns = ["quantity", "between"].map(Column::words).to_vec();
    columns.extend(["differ by", "in parts", "allowed"].map(Column::number));
    columns.extend(["verdict", "reason of the bound"].map(Column::words));
    let mut table = Table::new("All comparisons", columns);
    for pair in &found.comparisons {
        let [differ, parts] = [pair.max_abs_diff, pair.max_rel_diff].map(|value| words![(value, Digits::Size)]);
        let allowed = about("bound", (pair.bound.value, Digits::Size));
        let verdict = Words::from(match (pair.agrees, pair.follows) {
            (true, false) => "agrees",
            (true, true) => "agrees, which follows",
            (false, _) => "disagrees",
        });
        let (name, between) = (words::quantity(pair.quantity), pair.routes.map(words::route).join(" - ").into());
        table.row_bad_where(!pair.agrees, [name, between, differ, parts, allowed, verdict, pair.bound.reason.into()]);
    }
    table
}
