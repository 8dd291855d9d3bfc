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
        drawn.push(if plate.id == CAM { elsewhere(plate) } else { self::plate(plate)? });
    }
    let body = html! { @for plate in &drawn { (plate) } };
    Ok(Some(Section { id: "figures", title: "Figures", body }))
}

fn elsewhere(plate: &Plate) -> Markup {
    html! { p.note { (place(plate)) a href={ "#plate-" (plate.id) } { (plate.title) } " stands with the model." } }
}

fn place(plate: &Plate) -> Markup {
    html! { @if !plate.place.is_empty() { span.place { (plate.place) ". " } } }
}

/// A figure with its caption, the paper's figure that it redraws, and the command that makes it.
pub(super) fn plate(plate: &Plate) -> Result<Markup, HtmlError> {
    let drawing = plate.figure.as_ref().map(svg::render).transpose()?;
    Ok(html! {
        figure id={ "plate-" (plate.id) } {
            @if let Some(drawing) = &drawing {
                div.wide.drawing role="region" aria-label=(plate.title) tabindex="0" { (PreEscaped(drawing)) }
            }
            figcaption {
                (place(plate))
                @if drawing.is_none() { strong { (plate.title) } ". " }
                @if let Some(why) = &plate.absent { span.absent { "Not drawn: " (why) "." } } @else { (plate.caption) }
                @if drawing.is_some() { code.command { (plate.command) } }
            }
        }
    })
}
