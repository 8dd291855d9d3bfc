//! What the model is.

use maud::{Markup, html};

use crate::pages::report::dossier::Dossier;
use crate::pages::report::html::numbers::{given, number};
use crate::pages::report::html::{HtmlError, Section, plates, wide};

/// Rows of a table that is not folded away.
const LONG: usize = 24;

pub(crate) fn section(dossier: &Dossier) -> Result<Section, HtmlError> {
    let sheet = &dossier.model;
    let cam = dossier
        .plates
        .iter()
        .find(|plate| plate.id == plates::CAM)
        .map(|plate| plates::plate(plate, dossier))
        .transpose()?;
    let body = html! {
        @if !sheet.source.is_empty() { p { (sheet.source) } }
        p {
            "A follower of mass " i { "m" } " on a spring falls on a cam of lift " i { "c" } "(" i { "θ" } ") and leaves it with "
            i { "v" } sup { "+" } " = (1 + " i { "r" } ") " i { "c" } "′ − " i { "r v" } sup { "−" } "; between impacts "
            i { "m q" } "″ + " i { "b q" } "′ + " i { "k" } " (" i { "q" } " − slack) = −" i { "m g" } "."
        }
        @if sheet.quantities.len() > LONG {
            details { summary { (sheet.quantities.len()) " numbers of the model" } (quantities(dossier)) }
        } @else { (quantities(dossier)) }
        h3 { "Corners of the cam" }
        (corners(dossier))
        @if let Some(cam) = cam { (cam) }
    };
    Ok(Section { id: "model", title: "The model", body })
}

fn quantities(dossier: &Dossier) -> Markup {
    wide(
        "Numbers of the model",
        &html! {
            table {
                thead { tr { th scope="col" { "quantity" } th scope="col" { "" } th.n scope="col" { "value" } th scope="col" { "unit" } th scope="col" { "in the file" } } }
                tbody {
                    @for quantity in &dossier.model.quantities {
                        tr {
                            th scope="row" { (quantity.meaning) }
                            td { i { (quantity.symbol) } }
                            td.n { (given(quantity.value, 12)) }
                            td { (quantity.unit) }
                            td { @if quantity.field.is_empty() { "follows" } @else { code { (quantity.field) } } }
                        }
                    }
                }
            }
        },
    )
}

fn corners(dossier: &Dossier) -> Markup {
    let cam = &dossier.model.cam;
    let table = html! {
        table {
            thead { tr {
                th.n scope="col" { "angle, deg" } th.n scope="col" { "derivative that jumps" } th.n scope="col" { "by, m/rad" sup { "order" } }
                th.n scope="col" { "lift, m" } th.n scope="col" { "slope, m/rad" }
            } }
            tbody {
                @for corner in &cam.corners {
                    tr {
                        td.n { (number(corner.angle_deg, 9)) } td.n { (corner.jump_order) } td.n { (number(corner.jump, 7)) }
                        td.n { (number(corner.lift_m, 9)) } td.n { (number(corner.slope_after, 7)) }
                    }
                }
            }
        }
    };
    html! {
        p {
            "The lift goes from " (number(cam.lift_m[0], 9)) " to " (number(cam.lift_m[1], 9)) " m. "
            @if cam.corners.is_empty() { "No derivative of it up to order " (cam.highest_order) " jumps." }
            @else { "A corner is where a derivative of it jumps: the velocity is the first, the acceleration the second." }
        }
        @if cam.corners.len() > LONG {
            details { summary { (cam.corners.len()) " corners" } (wide("Corners of the cam", &table)) }
        } @else if !cam.corners.is_empty() { (wide("Corners of the cam", &table)) }
    }
}
