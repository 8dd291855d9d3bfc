//! The figures, in the paper's order.

use maud::{Markup, PreEscaped, html};

use crate::draw::{Look, svg};
use crate::figures::{Drawn, Plate};
use crate::pages::report::html::HtmlError;
use crate::report::Report;
use crate::show::block::{Block, Section};

/// The figure that stands with the model.
pub(crate) const CAM: &str = "cam";

pub(crate) fn section(report: &Report) -> Result<Option<Section>, HtmlError> {
    if report.plates.is_empty() {
        return Ok(None);
    }
    let (mut drawn, mut before) = (Vec::new(), None);
    for plate in &report.plates {
        let absent = plate.drawn.as_ref().err();
        let again = absent.is_some() && absent == before;
        drawn.push(match plate.id {
            CAM => elsewhere(plate, report),
            _ if again => self::absent(plate, report),
            _ => self::plate(plate, report)?,
        });
        before = absent;
    }
    let body = html! { @for plate in &drawn { (plate) } };
    Ok(Some(Section { id: "figures", title: "Figures".into(), blocks: vec![Block::Markup(body)] }))
}

fn elsewhere(plate: &Plate, report: &Report) -> Markup {
    html! { p.note { (place(plate, report)) a href={ "#plate-" (plate.id) } { (plate.title) } " stands with the model." } }
}

/// A figure that is missing for the reason of the one before it.
fn absent(plate: &Plate, report: &Report) -> Markup {
    html! {
        figure id={ "plate-" (plate.id) } {
            figcaption { (place(plate, report)) strong { (plate.title) } ". " span.absent { "Not drawn, for the same reason." } }
        }
    }
}

/// The paper's figure, for the paper's model: those of another one are none of the paper's.
fn place(plate: &Plate, report: &Report) -> Markup {
    html! { @if report.is_paper && !plate.place.is_empty() { span.place { (plate.place) ". " } } }
}

/// A figure with its caption, the paper's figure that it redraws, and the command that makes it.
pub(crate) fn plate(plate: &Plate, report: &Report) -> Result<Markup, HtmlError> {
    let (drawing, caption) = match &plate.drawn {
        Ok(Drawn { figure, caption }) => {
            let drawing = PreEscaped(svg::render(figure, &Look::default())?);
            let region = html! { div.wide.drawing role="region" aria-label=(plate.title) tabindex="0" { (drawing) } };
            (region, html! { (caption) code.command { (plate.command) } })
        }
        Err(why) => (html! {}, html! { strong { (plate.title) } ". " span.absent { "Not drawn: " (why) "." } }),
    };
    Ok(html! {
        figure id={ "plate-" (plate.id) } { (drawing) figcaption { (place(plate, report)) (caption) } }
    })
}
