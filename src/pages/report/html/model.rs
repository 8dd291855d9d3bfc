//! What the model is.

use crate::pages::cam;
use crate::pages::report::html::{HtmlError, plates};
use crate::report::Report;
use crate::show::block::{Block, Column, Section, Span, Table, Words, words};
use crate::show::digits::Digits;
use crate::show::words::symbol;

/// Rows of a table that is not folded away.
const LONG: usize = 24;

pub(crate) fn section(report: &Report) -> Result<Section, HtmlError> {
    let sheet = &report.model;
    let motion = "A follower of mass _m_ on a spring falls on a cam of lift _c_(_θ_) and leaves it with _v^+_ = (1 + _r_) _c_′ − \
                  _r_ _v^−_; between impacts _m q_″ + _b q_′ + _k_ (_q_ − slack) = −_m g_.";
    let numbers = Block::Table(numbers(report));
    let mut blocks = vec![Block::paragraph(&sheet.source), Block::paragraph(Words::prose(motion, []))];
    blocks.push(match sheet.quantities.len() {
        count if count > LONG => Block::Details(words![count, " numbers of the model"], vec![numbers]),
        _ => numbers,
    });
    blocks.push(Block::paragraph(words!["The cam: ", cam::lift(&sheet.cam), "."]));
    blocks.extend(cam::parts(&sheet.cam));
    if let Some(plate) = report.plates.iter().find(|plate| plate.id == plates::CAM) {
        blocks.push(Block::Markup(plates::plate(plate, report)?));
    }
    Ok(Section { id: "model", title: "The model".into(), blocks })
}

fn numbers(report: &Report) -> Table {
    let [quantity, letter, unit, field] = ["quantity", "", "unit", "in the file"].map(Column::words);
    let columns = [quantity, letter, Column::number("value"), unit, field];
    let mut table = Table::new("Numbers of the model", columns);
    for quantity in &report.model.quantities {
        let (digits, field) = match quantity.field.as_str() {
            "" => (Digits::Significant(12), "follows".into()),
            field => (Digits::All, Span::Code(field.into()).into()),
        };
        let letter = words![symbol(quantity.symbol, quantity.symbol, "", "")];
        table.row([
            (&quantity.meaning).into(),
            letter,
            words![(quantity.value, digits)],
            (&quantity.unit).into(),
            field,
        ]);
    }
    table
}
