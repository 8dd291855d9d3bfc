//! What the model is.

use maud::html;

use crate::pages::cam;
use crate::pages::report::dossier::Dossier;
use crate::pages::report::html::{HtmlError, Section, plates};
use crate::show::block::{Block, Column, Span, Table, words};
use crate::show::digits::Digits;
use crate::show::html::blocks;
use crate::show::words::symbol;

/// Rows of a table that is not folded away.
const LONG: usize = 24;

pub(crate) fn section(dossier: &Dossier) -> Result<Section, HtmlError> {
    let sheet = &dossier.model;
    let motion = html! {
        p {
            "A follower of mass " i { "m" } " on a spring falls on a cam of lift " i { "c" } "(" i { "θ" } ") and leaves it with "
            i { "v" } sup { "+" } " = (1 + " i { "r" } ") " i { "c" } "′ − " i { "r v" } sup { "−" } "; between impacts "
            i { "m q" } "″ + " i { "b q" } "′ + " i { "k" } " (" i { "q" } " − slack) = −" i { "m g" } "."
        }
    };
    let numbers = Block::Table(numbers(dossier));
    let mut body = vec![Block::paragraph(&sheet.source), Block::Markup(motion)];
    body.push(match sheet.quantities.len() {
        count if count > LONG => Block::Details(words![count, " numbers of the model"], vec![numbers]),
        _ => numbers,
    });
    body.push(Block::paragraph(words!["The cam: ", cam::lift(&sheet.cam), "."]));
    body.extend(cam::parts(&sheet.cam));
    if let Some(plate) = dossier.plates.iter().find(|plate| plate.id == plates::CAM) {
        body.push(Block::Markup(plates::plate(plate, dossier)?));
    }
    Ok(Section { id: "model", title: "The model", body: blocks(&body) })
}

fn numbers(dossier: &Dossier) -> Table {
    let left = |head| Column::left(head, 2, 0);
    let columns = [left("quantity"), left(""), Column::right("value", 0), left("unit"), left("in the file")];
    let mut table = Table::new("Numbers of the model", columns);
    for quantity in &dossier.model.quantities {
        let (digits, field) = match quantity.field.as_str() {
            "" => (Digits::Significant(12), "follows".into()),
            field => (Digits::All, Span::Code(field.into()).into()),
        };
        let letter = words![symbol(quantity.symbol, quantity.symbol, "", "")];
        table.row([(&quantity.meaning).into(), letter, words![(quantity.value, digits)], quantity.unit.into(), field]);
    }
    table
}
