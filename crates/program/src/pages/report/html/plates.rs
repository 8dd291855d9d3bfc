//! The figures, in the paper's order.

use maud::{Markup, PreEscaped, html};

use crate::figures::{Captioned, RenderedFigure};
use crate::pages::report::html::{HtmlError, packed};
use crate::report::Report;
use crate::show::block::{Block, PageSection};
use crate::show::csv;
use corner_impact_plot::{LegendPlace, Look, TitleChoice, svg};

/// Name of the figure beside the model.
pub(crate) const CAM: &str = "cam";

/// Section of the available figures; `None` if the only one is beside the model.
pub(crate) fn section(report: &Report) -> Result<Option<PageSection>, HtmlError> {
    let there: Vec<&RenderedFigure> = report.plates.iter().filter(|plate| plate.drawn.is_ok()).collect();
    if there.iter().all(|plate| plate.id == CAM) {
        return Ok(None);
    }
    let drawn = there.into_iter().map(|plate| match plate.id {
        CAM => Ok(Block::Markup(elsewhere(plate, report))),
        _ => self::plate(plate, report),
    });
    let blocks = drawn.collect::<Result<Vec<_>, _>>()?;
    Ok(Some(PageSection { id: "figures", title: "Figures".into(), blocks }))
}

fn elsewhere(plate: &RenderedFigure, report: &Report) -> Markup {
    html! { p.note { (place(plate, report)) a href={ "#plate-" (plate.id) } { (plate.title) } " stands with the model." } }
}

/// Look of a figure on a telephone: narrow, with letters as large as the surrounding text, and without room beside it.
fn narrow(look: &Look) -> Look {
    /// Width of a telephone's screen, points, on the scale on which a page has its width.
    const PHONE: f64 = 250.0;
    let legend = if look.legend == LegendPlace::Right { LegendPlace::Below } else { look.legend };
    Look { width: Some(PHONE), size: None, title: TitleChoice::Hidden, legend, ..look.clone() }
}

/// Number of the paper's figure, shown only for the paper's model.
fn place(plate: &RenderedFigure, report: &Report) -> Markup {
    html! { @if report.is_paper && !plate.place.is_empty() { span.place { (plate.place) ". " } } }
}

/// A figure with its caption, the number of the paper's figure, and the command that draws it.
pub(crate) fn plate(plate: &RenderedFigure, report: &Report) -> Result<Block, HtmlError> {
    let (drawing, caption) = match &plate.drawn {
        Ok(Captioned { figure, caption }) => {
            report.look.has_room(figure)?;
            let [broad, narrow] = [&report.look, &narrow(&report.look)].map(|look| svg::render(figure, look));
            let drawing = html! {
                div.drawing.broad { (PreEscaped(broad?)) }
                div.drawing.narrow data-packed=(packed(&narrow?)?) {}
                div.save data-packed=(packed(&csv::figure(figure, csv::OF_PAGE))?) {}
            };
            (drawing, html! { (caption) code.command { (plate.command) } })
        }
        Err(why) => (html! {}, html! { strong { (plate.title) } ". " span.absent { "Not drawn: " (why) "." } }),
    };
    let figure = html! {
        figure id={ "plate-" (plate.id) } { (drawing) figcaption { (place(plate, report)) (caption) } }
    };
    Ok(Block::Markup(figure).about("figure_data"))
}
