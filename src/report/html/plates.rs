//! The figures, in the paper's order.

use maud::{Markup, PreEscaped, html};

use super::{HtmlError, Section};
use crate::report::dossier::Dossier;
use crate::report::figure::svg;
use crate::report::plates::Plate;

/// The figure that stands with the model.
pub(super) const CAM: &str = "cam";

pub(super) fn section(dossier: &Dossier) -> Result<Option<Section>, HtmlError> {
    if dossier.plates.is_empty() {
        return Ok(None);
    }
    let mut drawn = Vec::new();
    for plate in &dossier.plates {
        drawn.push(if plate.id == CAM { elsewhere(plate, dossier) } else { self::plate(plate, dossier)? });
    }
    let body = html! { @for plate in &drawn { (plate) } };
    Ok(Some(Section { id: "figures", title: "Figures", body }))
}

fn elsewhere(plate: &Plate, dossier: &Dossier) -> Markup {
    html! { p.note { (place(plate, dossier)) a href={ "#plate-" (plate.id) } { (plate.title) } " stands with the model." } }
}

/// The paper's figure, for the paper's model: those of another one are none of the paper's.
fn place(plate: &Plate, dossier: &Dossier) -> Markup {
    html! { @if dossier.is_paper && !plate.place.is_empty() { span.place { (plate.place) ". " } } }
}

/// A figure with its caption, the paper's figure that it redraws, and the command that makes it.
pub(super) fn plate(plate: &Plate, dossier: &Dossier) -> Result<Markup, HtmlError> {
    let drawing = plate.figure.as_ref().map(svg::render).transpose()?;
    Ok(html! {
        figure id={ "plate-" (plate.id) } {
            @if let Some(drawing) = &drawing {
                div.wide.drawing role="region" aria-label=(plate.title) tabindex="0" { (PreEscaped(drawing)) }
            }
            figcaption {
                (place(plate, dossier))
                @if drawing.is_none() { strong { (plate.title) } ". " }
                @if let Some(why) = &plate.absent { span.absent { "Not drawn: " (why) "." } } @else { (plate.caption) }
                @if drawing.is_some() { code.command { (plate.command) } }
            }
        }
    })
}
