//! The matrices by every route side by side, and the digits in print.

use crate::corner::CornerMap;
use crate::corner::map::Uncertainty;
use crate::pages::report::dossier::{Dossier, MapTable};
use crate::pages::report::html::{left, number, numeric};
use crate::show::block::{Block, Section, Span, Table, Words, words};
use crate::show::digits::Digits;
use crate::show::words::{entry, quantity, route, shared, verdict};
use crate::study::verify::Verification;

pub(crate) fn section(dossier: &Dossier) -> Option<Section> {
    let found = dossier.verification.as_ref()?;
    let about = Words::prose(
        "One revolution from near the orbit: d_x_′ = _A_ d_x_ + _B_ d_T_, with _A^−_, _B^−_ where the impact comes before the \
         corner and _A^+_, _B^+_ where it comes after it. Each column is computed on its own: no two share a formula for A \
         and B. Finite difference and least squares run the same simulator; symbolic and scipy run no code of this program. \
         Digits in which a column leaves the closed form are underlined.",
        [],
    );
    let map = found.map;
    let border = Words::prose(
        "The sides meet where _C_ d_x_ + _D_ d_T_ = 0, with _C_ = ({}, {}) and _D_ = {}.",
        [map.c()[0], map.c()[1], map.d()].map(|entry| number(entry, 11)),
    );
    let mut blocks = vec![Block::paragraph(about)];
    blocks.extend(dossier.tables.iter().map(side));
    blocks.push(Block::paragraph(border));
    blocks.extend(uncertainties(found));
    let all = format!("All {} comparisons, with the reason of each bound", found.comparisons.len());
    blocks.extend([
        Block::Heading("How far they differ, and how far they may".into()),
        Block::paragraph(
            "Every pair of routes is compared in every quantity. Shown is the pair that is nearest to its bound.",
        ),
        Block::Table(summary(dossier)),
        Block::Details(all.into(), vec![Block::Table(pairs(found))]),
    ]);
    Some(Section { id: "maps", title: "The local map by every route".into(), blocks })
}

fn size(value: f64) -> Words {
    words![(value, Digits::Size)]
}

fn side(table: &MapTable) -> Block {
    let printed = table.rows.iter().any(|row| row.printed.is_some());
    let label = if table.side == "minus" { "Impact before the corner" } else { "Impact after the corner" };
    let mut columns = vec![left("entry")];
    columns.extend(table.routes.iter().map(|route| numeric(route)));
    columns.push(numeric("differ by"));
    columns.extend(printed.then(|| numeric("printed")));
    let mut shown = Table::new(label, columns);
    for row in &table.rows {
        let first = row.values.first().copied().unwrap_or(f64::NAN);
        let mut cells = vec![entry(row.entry, table.side).into()];
        cells.extend(row.values.iter().map(|value| Span::Against(*value, first, Digits::Aligned(11)).into()));
        cells.push(size(row.spread));
        cells.extend(printed.then(|| row.printed.as_deref().unwrap_or_default().replace('-', "−").into()));
        shown.row(cells);
    }
    Block::Table(shown)
}

fn uncertainties(found: &Verification) -> Vec<Block> {
    let told = found.routes_by_name().filter_map(|by| {
        let (about, errors) = match by.uncertainty.as_ref()? {
            Uncertainty::Fit { standard, condition_number, .. } => {
                let condition = number(*condition_number, 3);
                (words!["Standard errors; the condition number of the fit is ", condition, "."], standard)
            }
            Uncertainty::Extrapolation(error) => ("Error estimates.".into(), error),
        };
        let title = format!("How well {} knows its entries", route(by.name));
        Some(Block::Details(title.into(), vec![Block::paragraph(about), Block::Table(self::errors(errors))]))
    });
    told.collect()
}

fn errors(sides: &CornerMap) -> Table {
    let entries = ["A11", "A12", "A21", "A22", "B1", "B2"].map(|name| numeric(entry(name, "")));
    let mut table = Table::new("Errors of the entries", [vec![left("side")], entries.to_vec()].concat());
    for (name, side) in [("before", sides.minus), ("after", sides.plus)] {
        table.row([vec![name.into()], side.entries().map(size).to_vec()].concat());
    }
    table
}

fn summary(dossier: &Dossier) -> Table {
    let columns = [
        left("quantity"),
        numeric("pairs that agree"),
        numeric("differ by"),
        numeric("allowed"),
        left("share"),
        left("between"),
    ];
    let mut table = Table::new("Comparisons of the routes", columns);
    for found in &dossier.quantities {
        let closest = &found.closest;
        let cells = [
            quantity(found.quantity),
            format!("{} of {}", found.agreeing, found.pairs).into(),
            size(closest.max_abs_diff),
            size(closest.bound.value),
            shared(found.shared_decimals).into(),
            closest.routes.map(route).join(", ").into(),
        ];
        table.row_bad_where(!closest.agrees, cells);
    }
    table
}

fn pairs(found: &Verification) -> Table {
    let columns = [
        left("quantity"),
        left("between"),
        numeric("differ by"),
        numeric("in parts"),
        numeric("allowed"),
        left("verdict"),
        left("why so much is allowed"),
    ];
    let mut table = Table::new("All comparisons", columns);
    for pair in &found.comparisons {
        let cells = [
            quantity(pair.quantity),
            pair.routes.map(route).join(", ").into(),
            size(pair.max_abs_diff),
            size(pair.max_rel_diff),
            size(pair.bound.value),
            if pair.agrees { "agrees" } else { "disagrees" }.into(),
            pair.bound.reason.into(),
        ];
        table.row_bad_where(!pair.agrees, cells);
    }
    table
}

/// The paper's printed digits against those computed.
pub(crate) fn printed(dossier: &Dossier) -> Option<Section> {
    let found = dossier.verification.as_ref().filter(|found| !found.published.is_empty())?;
    let columns = [
        left("quantity"),
        left("where"),
        numeric("printed"),
        numeric("computed"),
        numeric("differ by"),
        numeric("allowed"),
        left("verdict"),
    ];
    let mut table = Table::new("The paper's printed numbers", columns);
    let mut notes = Vec::new();
    for item in &found.published {
        let name = quantity(item.agreement.quantity);
        for (index, digits) in item.printed.iter().enumerate() {
            let digits = digits.replace('-', "−").into();
            let computed = item.computed.get(index).map(|value| number(*value, 15)).unwrap_or_default();
            let mut cells = vec![Words::default(), Words::default(), digits, computed];
            if index == 0 {
                cells[..2].clone_from_slice(&[name.clone(), (&item.place).into()]);
                let otherwise = if item.as_found { "" } else { " otherwise than the ledger says" };
                let judged = words![verdict(item.verdict), otherwise];
                cells.extend([size(item.agreement.max_abs_diff), size(item.agreement.bound.value), judged]);
            }
            table.row_bad_where(!item.as_found, cells);
        }
        if !item.note.is_empty() {
            notes.push((words![name, ", ", &item.place], item.note.into()));
        }
    }
    let about = Block::paragraph("What the paper prints, digit by digit, and what comes out.");
    let mut blocks = vec![about, Block::Table(table)];
    if !notes.is_empty() {
        let title = Block::Heading("What is wrong with those that do not hold".into());
        blocks.extend([title, Block::Entries(0, notes)]);
    }
    Some(Section { id: "printed", title: "The paper's digits".into(), blocks })
}
