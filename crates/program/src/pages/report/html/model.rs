//! The model.

use maud::{Markup, html};

use crate::pages::cam;
use crate::pages::report::html::{HtmlError, plates};
use crate::report::Report;
use crate::show::block::{Block, Column, PageSection, Span, Table, Words, about, words};
use crate::show::digits::Digits;
use crate::show::words::symbol;

/// Most rows of a table that is not folded.
const LONG: usize = 24;

pub(crate) fn section(report: &Report) -> Result<PageSection, HtmlError> {
    let sheet = &report.model;
    let motion = "A follower of mass _m_ on a spring, slack at _q₀_, flies above a cam of lift _c_(_θ_), hits it with _v^−_ where the \
                  cam has the velocity _c′_, and leaves it with _v^+_:";
    let numbers = Block::Table(numbers(report));
    let source = Span::Quoted(sheet.source.clone());
    let mut blocks =
        vec![Block::paragraph(source), Block::paragraph(Words::prose(motion, [])), Block::Markup(formulas())];
    blocks.push(match sheet.quantities.len() {
        count if count > LONG => Block::Details(words![count, " numbers of the model"], vec![numbers]),
        _ => numbers,
    });
    let mut cam = vec![Block::paragraph(words!["The cam: ", cam::lift(&sheet.cam), "."])];
    cam.extend(sheet.cam.measured.iter().flat_map(cam::measured));
    cam.extend(cam::parts(&sheet.cam));
    blocks.push(Block::About("lift".into(), cam));
    if let Some(plate) = report.plates.iter().find(|plate| plate.id == plates::CAM) {
        blocks.push(plates::plate(plate, report)?);
    }
    Ok(PageSection { id: "model", title: "The model".into(), blocks })
}

/// The flight and the impact, typeset: `m q'' + b q' + k (q - q0) = -m g` and `v+ = (1 + r) c' - r v-`.
fn formulas() -> Markup {
    let above = |letter: &str, sign: &str| html! { msup { mi { (letter) } mo { (sign) } } };
    html! {
        math display="block" {
            mi { "m" } (above("q", "″")) mo { "+" } mi { "b" } (above("q", "′")) mo { "+" } mi { "k" }
            mo { "(" } mi { "q" } mo { "−" } msub { mi { "q" } mn { "0" } } mo { ")" } mo { "=" } mo { "−" } mi { "m" } mi { "g" }
        }
        math display="block" {
            (above("v", "+")) mo { "=" } mo { "(" } mn { "1" } mo { "+" } mi { "r" } mo { ")" } (above("c", "′"))
            mo { "−" } mi { "r" } (above("v", "−"))
        }
    }
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
            about(quantity.name(), (quantity.value, digits)),
            (&quantity.unit).into(),
            field,
        ]);
    }
    table
}
