//! Section on the model.

use crate::pages::cam;
use crate::pages::report::html::plates::{self, DrawnFigures};
use crate::report::Report;
use crate::show::block::{Block, Column, PageSection, Span, Table, about, words};
use crate::show::digits::Digits;

pub(crate) fn section(report: &Report, figures: &DrawnFigures) -> PageSection {
    let sheet = &report.model;
    let motion = "A follower of mass $m$ on a spring, slack at $q0$, flies above a cam of lift $c$($theta$). It hits the cam with the \
                  velocity $v-$, where the cam has the velocity $c'$, and leaves it with $v+$:";
    let source = Span::Quoted(sheet.source.clone());
    let laws = ["m q'' + b q' + k (q - q0) = -m g", "v+ = (1 + r) c' - r v-"];
    let mut blocks = vec![Block::paragraph(source), Block::paragraph(motion)];
    blocks.extend(laws.map(|law| Block::paragraph(Span::Formula(law.into()))));
    blocks.push(Block::Table(numbers(report)));
    let mut cam = vec![Block::paragraph(words!["The cam: ", cam::lift(&sheet.cam), "."])];
    cam.extend(sheet.cam.measured.iter().flat_map(cam::measured));
    cam.extend(cam::parts(&sheet.cam));
    blocks.push(Block::About("lift".into(), cam));
    if let Some(plate) = report.plates.iter().find(|plate| plate.id == plates::CAM) {
        blocks.push(plates::plate(plate, report, figures));
    }
    PageSection { id: "model", title: "The model".into(), blocks }
}

fn numbers(report: &Report) -> Table {
    let [quantity, letter, unit, field] = ["quantity", "", "unit", "in the file"].map(Column::words);
    let columns = [quantity, letter, Column::number("value"), unit, field];
    let mut table = Table::new("Numbers of the model", columns);
    for quantity in &report.model.quantities {
        let (digits, field) = match quantity.field.as_str() {
            "" => (Digits::Significant(12), "derived".into()),
            field => (Digits::All, Span::Code(field.into()).into()),
        };
        let mut value = words![(quantity.value, digits)];
        if let Some(error) = quantity.error {
            value.push(words![" ± ", (error, digits)]);
        }
        table.row([
            (&quantity.meaning).into(),
            Span::Formula(quantity.symbol.into()).into(),
            about(quantity.name(), value),
            (&quantity.unit).into(),
            field,
        ]);
    }
    table
}
