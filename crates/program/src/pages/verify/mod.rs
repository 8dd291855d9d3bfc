//! Page of `verify`, section by section: the corner impact, its map by every route, and its scenario.

mod map;

use crate::pages::local_map;
use crate::pages::source;
use crate::show::Paged;
use crate::show::block::{Block, Column, Span, Table, TextMark, Words, about, words};
use crate::show::digits::Digits;
use crate::show::sources::Sources;
use crate::show::words;
use corner_impact::agreement::{Agreement, Quantity, shared_decimals};
use corner_impact::border_collision::feigin::SideCounts;
use corner_impact::border_collision::{Classification, Danger, NormalForm, Refusal};
use corner_impact::cam::Side;
use corner_impact::study::routes::Skipped;
use corner_impact::study::verify::{ComparisonTally, LeftOpen, Verification};
pub(crate) use map::{agreement, map};

impl Paged for Verification {
    fn blocks(&self) -> Vec<Block> {
        let title = Block::Title(format!("Corner impact of {}", self.model.name).into());
        let mut page = vec![title];
        page.extend(source(&self.model.source));
        for section in
            [orbit(self), map(self), agreement(self), bifurcation(self), local_map::blocks(self), published(self)]
        {
            page.extend(section);
        }
        page.extend(verdict(self));
        page
    }
}

/// Position of the corner impact.
pub(crate) fn orbit(found: &Verification) -> Vec<Block> {
    let at = &found.at;
    let (state, acceleration) = (at.x_star(), at.cam_acceleration());
    let significant = |value, digits| words![(value, Digits::Significant(digits))];
    let fixed = |value, places| words![(value, Digits::Fixed(places))];
    let degrees = |angle: f64| fixed(angle.to_degrees(), 6);
    let period = Words::prose(
        "$T*$ = {} s   ({} rpm)",
        [about("T_star", significant(at.period, 14)), about("speed_rpm", fixed(at.speed_rpm(), 9))],
    );
    let x_star = Words::prose(
        "$x*$ = ({}, {}){}half a revolution from the impact; position is measured from $q$ = {} {}",
        [
            about("x_star", significant(state[0], 13)),
            about("x_star", significant(state[1], 13)),
            Span::Break.into(),
            about("state_origin", significant(at.origin, 9)),
            Span::Unit("m").into(),
        ],
    );
    let impact = Words::prose(
        "at cam angle {} deg, where c'' jumps from {} to {} {}{}$q$ = {} {}, $v$ = {} before and {} after, c' = {} {}",
        [
            about("corner", degrees(at.corner.angle)),
            about("cam_acceleration", fixed(acceleration.minus, 4)),
            about("cam_acceleration", fixed(acceleration.plus, 4)),
            Span::Unit("m/s^2").into(),
            Span::Break.into(),
            about("position", fixed(at.corner.plus.value, 9)),
            Span::Unit("m").into(),
            about("velocity_before", fixed(at.velocity_before, 6)),
            about("velocity_after", fixed(at.velocity_after, 6)),
            about("cam_velocity", fixed(at.cam_velocity, 6)),
            Span::Unit("m/s").into(),
        ],
    );
    let mut entries: Vec<(Words, Words)> =
        vec![("period".into(), period), ("state".into(), x_star), ("impact".into(), impact)];
    entries.extend(found.others.iter().map(|other| {
        let (speed, angle) = (fixed(other.speed_rpm(), 6), degrees(other.corner.angle));
        let place = about("other_corner_impacts", words![speed, " rpm at ", angle, " deg"]);
        ("also".into(), words![place, ": narrow [study] to verify that one"])
    }));
    if let Some((open, sources)) = uncertain(found) {
        let speed = sources.speed(at.speed_rpm(), Digits::Fixed(9), open.error.as_ref().map(|error| error.speed));
        let name = if sources.errors.are_none() { "cam" } else { "machine" };
        entries.push((name.into(), about("measured_error", speed)));
    }
    if let Some(certificate) = &found.certificate {
        let words = format!(
            "this orbit exists; its speed, state, A and B are proved to {} digits, which `certify` prints",
            certificate.digits()
        );
        entries.push(("proved".into(), words.into()));
    }
    let taken = found.certificate.as_ref().and_then(|certificate| words::hypotheses(&certificate.hypotheses()));
    let close = Words::prose(
        "_T^∗_ lies between {} and {} s. One simulated revolution ends within {} of its start, in parts of the orbit's size.",
        [
            about("period_bracket", significant(at.bracket[0], 16)),
            about("period_bracket", significant(at.bracket[1], 16)),
            about("closure", words![(at.closure, Digits::Size)]),
        ],
    );
    let title = Block::Heading("The orbit, computed from the model".into());
    let mut page = vec![title, Block::Entries(9, entries)];
    page.extend(taken.map(Block::paragraph));
    page.push(Block::Full(vec![Block::Note(close)]));
    page
}

/// Eigenvalues, normal form and verdict, and the conditions of the verdict.
pub(crate) fn bifurcation(found: &Verification) -> Vec<Block> {
    let eigenvalues = |side| {
        let [one, two] =
            found.map.of(side).eigenvalues().map(|value| Span::Complex([value.re, value.im], Digits::Fixed(9)));
        about(Quantity::Eigenvalues(side).to_string(), words![one, ",  ", two])
    };
    let mut entries: Vec<(Words, Words)> = vec![
        (Words::prose("eigenvalues of $A-$", []), eigenvalues(Side::Minus)),
        (Words::prose("eigenvalues of $A+$", []), eigenvalues(Side::Plus)),
    ];
    entries.extend(found.normal_form.as_ref().ok().map(|form| ("normal form".into(), normal_form(form))));
    match &found.classification {
        Ok(kind) => entries.extend(classification(kind, found.danger.as_ref())),
        Err(refusal) => entries.push(("verdict".into(), none(refusal))),
    }
    entries.extend(uncertain(found).and_then(|(open, sources)| left_open(found, open, sources)));
    entries.extend(local_map::conditions(found));
    let mut full: Vec<Block> = found.classification.iter().flat_map(fixed_points).collect();
    full.extend(
        (!found.conditions.is_empty()).then(|| Block::Table(local_map::every_condition(found)).about("conditions")),
    );
    full.extend(found.normal_form.iter().map(|form| {
        let column = |at: nalgebra::Vector2<f64>| Span::Matrix(vec![vec![at[0]], vec![at[1]]], Digits::UpTo(9));
        let shift = (Words::prose("$B_tilde$", []), about("B_tilde", column(form.b_tilde)));
        Block::Entries(20, vec![(Words::prose("$W$", []), about("normal_form", rows(&form.w))), shift])
    }));
    vec![Block::Heading("What happens there".into()), Block::Entries(20, entries), Block::Full(full)]
}

/// Uncertainty of the corner impact and its sources, if anything is uncertain.
fn uncertain(found: &Verification) -> Option<(&LeftOpen, Sources<'_>)> {
    let open = found.uncertainty.as_ref()?;
    Some((open, Sources::of(&open.cam, open.errors).if_any()?))
}

/// Verdict on equally likely machines, which shows whether the verdict is certain.
fn left_open(found: &Verification, open: &LeftOpen, sources: Sources<'_>) -> Option<(Words, Words)> {
    let own = found.classification.as_ref().ok().map(|kind| kind.scenario);
    let all: usize = open.verdicts.iter().map(|told| told.cams).sum();
    let others: Vec<String> = open
        .verdicts
        .iter()
        .filter(|told| told.scenario != own)
        .map(|told| format!("{} say {}", told.cams, told.scenario.map_or("none".into(), |kind| kind.to_string())))
        .collect();
    let (why, machines) = (sources.why(), sources.machines());
    let said = match others.is_empty() {
        true => format!("the same verdict for {all} equally likely {machines} ({why})").into(),
        false => words![
            (TextMark::Doubtful, "not known"),
            format!(": of {all} equally likely {machines} ({why}), {}", others.join(", "))
        ],
    };
    (all > 0).then(|| (format!("on likely {machines}").into(), said))
}

fn normal_form(form: &NormalForm) -> Words {
    let entry = |value| words![(value, Digits::UpTo(9))];
    Words::prose(
        "A-bar {}{}A+bar {}{}B bar ({}, {}),  C bar ({}, {})",
        [
            about("A_bar_minus", rows(&form.a_bar_minus)),
            Span::Break.into(),
            about("A_bar_plus", rows(&form.a_bar_plus)),
            Span::Break.into(),
            about("B_bar", entry(form.b_bar[0])),
            about("B_bar", entry(form.b_bar[1])),
            about("C_bar", entry(form.c_bar[0])),
            about("C_bar", entry(form.c_bar[1])),
        ],
    )
}

fn rows(matrix: &nalgebra::Matrix2<f64>) -> Span {
    Span::Matrix(matrix.row_iter().map(|row| row.iter().copied().collect()).collect(), Digits::UpTo(9))
}

fn classification(kind: &Classification, danger: Option<&Danger>) -> Vec<(Words, Words)> {
    let Classification { minus, plus, .. } = kind;
    let counts = format!(
        "{} + {} real eigenvalues above 1, {} + {} below -1",
        minus.above_one, plus.above_one, minus.below_minus_one, plus.below_minus_one
    );
    let verdict = words![
        words::border_collision(kind, danger),
        Span::Break,
        words::meaning(kind.scenario, kind.minus.stable || kind.plus.stable, danger)
    ];
    let fate = |side: &SideCounts| {
        format!("exists {}, {}", words::speeds(Some(side.exists_for)), words::stability(side.stability))
    };
    let fixed = words!["minus: ", fate(minus), Span::Break, "plus:  ", fate(plus)];
    let mut entries: Vec<(Words, Words)> =
        [("Feigin's counts", counts.into()), ("verdict", verdict), ("fixed points", fixed)]
            .map(|(name, words)| (name.into(), about("feigin", words)))
            .into();
    if let Some(danger) = danger {
        let mut lines = vec![words::danger(danger)];
        lines.extend(words::returns(danger));
        let names = std::iter::once("danger").chain(std::iter::repeat(""));
        entries.extend(names.zip(lines).map(|(name, words)| (name.into(), about("danger", words))));
    }
    entries
}

/// Fixed point of each side, and the rule that counts the fixed points.
fn fixed_points(kind: &Classification) -> [Block; 2] {
    let head = words!["fixed point for dT = 1 s, in ", Span::Unit("m"), " and ", Span::Unit("m/s")];
    let columns = ["".into(), "det(I - A)".into(), head].map(Column::words);
    let mut table = Table::new("The fixed point of each side", columns);
    for (side, SideCounts { determinant, fixed_point, .. }) in [(Side::Minus, &kind.minus), (Side::Plus, &kind.plus)] {
        let [determinant, position, velocity] =
            [*determinant, fixed_point[0], fixed_point[1]].map(|value| words![(value, Digits::Significant(8))]);
        table.row([words::side(side).into(), determinant, Words::prose("({}, {})", [position, velocity])]);
    }
    let odd = "An odd number of eigenvalues above 1 on both sides together means a fold; an odd number below -1 means a flip.";
    [Block::Table(table).about("fixed_point"), Block::Note(odd.into())]
}

fn none(refusal: &Refusal) -> Words {
    words!["none", Span::Break, refusal.to_string()]
}

/// Printed numbers of the paper, each in a line, or digit by digit if there is room; and the errors in the wrong ones.
pub(crate) fn published(found: &Verification) -> Vec<Block> {
    if found.published.is_empty() {
        return Vec::new();
    }
    let label = "The paper's printed numbers";
    let widths = [(2, 20), (0, 20), (0, 14), (0, 16), (0, 0)];
    let mut brief = Table::new(label, widths.map(|(gap, least)| Column::left("", gap, least)));
    let mut columns = ["quantity", "where"].map(Column::words).to_vec();
    columns.extend(["printed", "computed", "differ by", "allowed"].map(Column::number));
    columns.push(Column::words("verdict"));
    let mut full = Table::new(label, columns);
    let mut notes = Vec::new();
    for number in &found.published {
        let Agreement { quantity, max_abs_diff, bound, .. } = &number.agreement;
        let (name, place) = (words::quantity(*quantity), Words::from(number.place.as_str()));
        let mut verdict = words::verdict(number.verdict);
        if !number.as_found {
            verdict.push(words!["   ", (TextMark::Bad, "UNEXPECTED")]);
        }
        brief.row([
            name.clone(),
            place.clone(),
            format!("off by {:>7}", Digits::Size.text(*max_abs_diff)).into(),
            format!(", {}", words::shared(shared_decimals(*max_abs_diff))).into(),
            verdict.clone(),
        ]);
        for (index, digits) in number.printed.iter().enumerate() {
            let computed = number.computed.get(index).map(|value| words![(*value, Digits::Significant(15))]);
            let computed = computed.map(|words| about(quantity.to_string(), words));
            let mut cells = vec![Words::default(), Words::default(), digits.into(), computed.unwrap_or_default()];
            if index == 0 {
                cells[..2].clone_from_slice(&[name.clone(), place.clone()]);
                cells.extend([*max_abs_diff, bound.value].map(|value| words![(value, Digits::Size)]));
                cells.push(verdict.clone());
            }
            full.row_bad_where(!number.as_found, cells);
        }
        if !number.note.is_empty() {
            let computed = number.computed.iter().map(|value| words![(*value, Digits::Significant(10))]);
            let computed = about(quantity.to_string(), Words::joined(computed, ", "));
            let parts = [name, number.printed.join(", ").into(), computed, number.note.into()];
            notes.extend([Block::Gap, Block::paragraph(Words::prose("{}, printed ({}), computed ({}): {}", parts))]);
        }
    }
    let tables = [Block::Brief(vec![Block::Table(brief)]), Block::Full(vec![Block::Table(full).about("published")])];
    [Block::Heading(label.into())].into_iter().chain(tables).chain(notes).collect()
}

/// Routes that did not run, and whether all results agree.
pub(crate) fn verdict(found: &Verification) -> Vec<Block> {
    let mut blocks = Vec::new();
    let (failed, left_out): (Vec<&Skipped>, Vec<_>) = found.skipped.iter().partition(|skipped| skipped.failed);
    for (heading, skipped) in [("NOT RUN", failed), ("Left out", left_out)] {
        let line = |skipped: &&Skipped| format!("{}: {}", skipped.route, skipped.why).into();
        if !skipped.is_empty() {
            blocks.extend([Block::Heading(heading.into()), Block::List(skipped.iter().map(line).collect())]);
        }
    }
    blocks.push(Block::Heading("Verdict".into()));
    blocks.extend(tally(found).into_iter().map(Block::paragraph));
    let missing: Vec<&str> =
        found.skipped.iter().filter(|skipped| skipped.failed).map(|skipped| skipped.route.as_str()).collect();
    let all_agree = found.comparisons.iter().all(|pair| pair.agrees) && found.tally().printed_otherwise == 0;
    let (mark, word, reason) = match missing.as_slice() {
        _ if found.agrees => (TextMark::Good, "AGREES", String::new()),
        [] => (TextMark::Bad, "DISAGREES", ": a comparison above".to_owned()),
        [most @ .., last] => {
            let names = if most.is_empty() { (*last).to_owned() } else { format!("{} and {last}", most.join(", ")) };
            // If the routes that ran agree, nothing disagrees, but not everything was checked.
            let word = if all_agree { "INCOMPLETE" } else { "DISAGREES" };
            (TextMark::Bad, word, format!(": {names} did not run"))
        }
    };
    blocks.push(Block::paragraph(words![(mark, word), reason]));
    blocks
}

/// Number of comparisons that agree, and number of printed numbers that are right.
pub(crate) fn tally(found: &Verification) -> Vec<Words> {
    let tally = found.tally();
    let ComparisonTally { comparisons, agreeing, following, following_agreeing, shared_decimals, .. } = tally;
    let ComparisonTally { printed, printed_right, printed_wrong, printed_otherwise, .. } = tally;
    let more = if shared_decimals.is_some() { " or more" } else { "" };
    let shares = words::shared(shared_decimals);
    let follow = match following {
        0 => String::new(),
        _ => format!(", and so do {following_agreeing} of {following} that follow from them"),
    };
    let compared =
        format!("{agreeing} of {comparisons} comparisons agree{follow}. Every entry of A and B shares {shares}{more}.");
    let numbers = format!(
        "Of the {printed} numbers printed in the paper's source on arXiv, {printed_right} hold, {printed_wrong} are wrong as \
         listed, and {printed_otherwise} differ from the recorded verdict."
    );
    [Some(compared), (printed > 0).then_some(numbers)].into_iter().flatten().map(Words::from).collect()
}
