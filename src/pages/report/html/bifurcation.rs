//! What happens at the corner impact: eigenvalues, normal form, classification; and what the local map does by itself.

use maud::html;

use crate::border_collision::feigin::{Scenario, Speeds, speeds_at};
use crate::border_collision::{Classification, LocalOutcome, NormalForm};
use crate::corner::map::rows;
use crate::pages::report::dossier::Dossier;
use crate::pages::report::html::{left, number, numeric, unheaded};
use crate::show::block::{Block, Section, Span, Table, Words, words};
use crate::show::digits::Digits;
use crate::show::words::{self, symbol};
use crate::study::verify::Verification;

pub(crate) fn section(dossier: &Dossier) -> Option<Section> {
    let found = dossier.verification.as_ref()?;
    let mut blocks = vec![eigenvalues(found)];
    match &found.classification {
        Ok(kind) => blocks.extend(classification(kind)),
        Err(why) => blocks.push(Block::paragraph(format!("There is no classification: {why}."))),
    }
    blocks.extend(conditions(found));
    blocks.extend(found.normal_form.iter().flat_map(normal_form));
    Some(Section { id: "bifurcation", title: "What happens there".into(), blocks })
}

fn eigenvalues(found: &Verification) -> Block {
    let map = &found.map;
    let mut table = unheaded("Eigenvalues", 3);
    for (side, above, map) in [("A-", "−", map.minus), ("A+", "+", map.plus)] {
        let [one, other] =
            map.eigenvalues().map(|value| Span::Complex([value.re, value.im], Digits::Significant(10)).into());
        table.row([symbol(side, "A", "", above).into(), one, other]);
    }
    Block::Table(table)
}

fn classification(kind: &Classification) -> [Block; 4] {
    let (minus, plus) = (&kind.minus, &kind.plus);
    let mut table = Table::new(
        "Feigin's counts, and the fixed point of each side",
        ["", "impact before the corner", "impact after the corner"].map(left),
    );
    let point = |at: nalgebra::Vector2<f64>| words!["(", number(at[0], 8), ", ", number(at[1], 8), ")"];
    let speeds = |speeds: Speeds| words::speeds(Some(speeds));
    let rows: [(&str, Words, Words); 6] = [
        ("real eigenvalues above 1", minus.above_one.into(), plus.above_one.into()),
        ("real eigenvalues below −1", minus.below_minus_one.into(), plus.below_minus_one.into()),
        ("det(I − A)", number(minus.determinant, 8), number(plus.determinant, 8)),
        ("fixed point exists at speeds", speeds(minus.exists_for).into(), speeds(plus.exists_for).into()),
        ("it is", words::stability(minus.stable).into(), words::stability(plus.stable).into()),
        ("its place for dT = 1 s, in m and m/s", point(minus.fixed_point), point(plus.fixed_point)),
    ];
    for (name, minus, plus) in rows {
        table.row([name.into(), minus, plus]);
    }
    let born = if kind.period_two_orbit && kind.scenario != Scenario::NonsmoothFlip {
        ". An orbit of period two is born too."
    } else {
        "."
    };
    let odd =
        "An odd number of eigenvalues above 1 on both sides together is a fold; an odd number below −1 is a flip.";
    [
        Block::Markup(html! { p.verdict { "A " (words::spoken(&kind.scenario.to_string())) "." } }),
        Block::paragraph(words![words::meaning(kind.scenario), born]),
        Block::Table(table),
        Block::Note(odd.into()),
    ]
}

fn conditions(found: &Verification) -> Vec<Block> {
    if found.conditions.is_empty() {
        return Vec::new();
    }
    let columns = [
        left("looked at"),
        numeric("value"),
        numeric("distance from failing"),
        left("holds"),
        left("decides"),
        left("or else"),
    ];
    let mut table = Table::new("Conditions of the classification", columns);
    for condition in &found.conditions {
        let holds = condition.holds();
        let cells: [Words; 6] = [
            condition.name.into(),
            number(condition.value, 6),
            words![(condition.distance, Digits::Size)],
            if holds { "yes" } else { "no" }.into(),
            words::decides(condition.decides).into(),
            condition.meaning.into(),
        ];
        table.row_bad_where(!holds, cells);
    }
    vec![Block::Heading("What this rests on".into()), Block::Table(table)]
}

fn normal_form(form: &NormalForm) -> [Block; 2] {
    let matrix = |entries: [[f64; 2]; 2]| entries.map(|row| row.to_vec()).to_vec();
    let column = |at: nalgebra::Vector2<f64>| vec![vec![at[0]], vec![at[1]]];
    let row = |at: nalgebra::RowVector2<f64>| vec![vec![at[0], at[1]]];
    let mut table = unheaded("Normal form", 2);
    for (plain, letter, side, entries) in [
        ("A-bar", "A\u{304}", "−", matrix(rows(&form.a_bar_minus))),
        ("A+bar", "A\u{304}", "+", matrix(rows(&form.a_bar_plus))),
        ("W", "W", "", matrix(rows(&form.w))),
        ("B bar", "B\u{304}", "", column(form.b_bar)),
        ("B tilde", "B\u{303}", "", column(form.b_tilde)),
        ("C bar", "C\u{304}", "", row(form.c_bar)),
    ] {
        table.row([symbol(plain, letter, "", side).into(), Span::Matrix(entries, Digits::Significant(10)).into()]);
    }
    [Block::Heading("Normal form".into()), Block::Table(table)]
}

/// What the local map does by itself, and how far it holds.
pub(crate) fn local_map(dossier: &Dossier) -> Option<Section> {
    let found = dossier.verification.as_ref().filter(|found| !found.outcomes.is_empty())?;
    let about = "The piecewise-linear map run by itself from many starts, on either side of the speed of the corner impact and at it.";
    let mut blocks = vec![Block::paragraph(about)];
    blocks.extend(found.outcomes.iter().flat_map(motions));
    if !found.ranges.is_empty() {
        let columns = [left("predicted"), left("speeds"), numeric("to, rpm"), numeric("dT, s"), left("ended by")];
        let mut table = Table::new("How far the local map holds", columns);
        for range in &found.ranges {
            let ends = if range.difference.is_none() { "holds nowhere" } else { words::ends(range.ends) };
            table.row([
                words::compared(range.compared).into(),
                speeds_at(range.sign).into(),
                words![(range.speed_rpm, Digits::Fixed(6))],
                words![(range.period_change, Digits::Size)],
                Words::from(ends.trim_start_matches(", ")),
            ]);
        }
        let about = "Up to these speeds what the map predicts is within a tenth of the simulated machine.";
        blocks.extend([Block::Heading("How far it holds".into()), Block::paragraph(about), Block::Table(table)]);
    }
    Some(Section { id: "local-map", title: "What the local map does by itself".into(), blocks })
}

fn motions(outcome: &LocalOutcome) -> Vec<Block> {
    let speeds = Speeds::of(outcome.mu);
    let title = match speeds {
        Some(speeds) => format!("At speeds {}", words::speeds(Some(speeds))),
        None => "At the corner impact".to_owned(),
    };
    let ends = outcome
        .fates
        .iter()
        .map(|end| words![format!("{} of {} motions ", end.starts, outcome.starts()), words::end(&end.end)]);
    let mut blocks = vec![Block::Heading(title.into()), Block::List(ends.collect())];
    if speeds.is_some() && !outcome.orbits.is_empty() {
        let orbit = |orbit: &crate::border_collision::local_map::PeriodicOrbit| {
            words![Span::Code(orbit.word.to_string()), " ", words::stability(orbit.stable())]
        };
        let told = "Periodic orbits, as the sides they visit (L before the corner, R after it): {}.";
        let orbits = Words::joined(outcome.orbits.iter().map(orbit), ", ");
        blocks.push(Block::paragraph(Words::prose(told, [orbits])));
    }
    blocks
}
