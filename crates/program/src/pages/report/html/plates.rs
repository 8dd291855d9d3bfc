//! Figures, in the paper's order, and their parts on a page.

use std::collections::BTreeMap;

use maud::{Markup, PreEscaped, html};
use rayon::prelude::*;

use crate::figures::{Captioned, RenderedFigure, around_corner};
use crate::pages::report::html::values::FigureValues;
use crate::pages::report::html::{HtmlError, packed};
use crate::report::Report;
use crate::show::block::{Block, PageSection};
use corner_impact_plot::{Figure, LegendPlace, Look, TitleChoice, svg};

/// Name of the figure beside the model.
pub(crate) const CAM: &str = "cam";

/// Drawings and values of all figures of a page.
pub(crate) struct DrawnFigures {
    by_id: BTreeMap<&'static str, DrawnFigure>,
    /// Style of the drawings.
    pub(crate) style: String,
}

/// Parts of a figure on the page.
struct DrawnFigure {
    /// SVG for a screen and for paper.
    broad: String,
    /// SVG for a telephone, packed.
    narrow: String,
    /// Values, packed.
    values: String,
}

impl DrawnFigures {
    /// Draws every figure of a report.
    pub(crate) fn of(report: &Report) -> Result<Self, HtmlError> {
        let beside = [&report.overview, &report.loads, &report.attractors].into_iter().flatten();
        let all: Vec<&RenderedFigure> = beside.chain(&report.plates).collect();
        let narrow = narrow(&report.look);
        let insets = |figure: &Figure| -> Result<[String; 2], HtmlError> {
            report.look.has_room(figure)?;
            Ok([svg::inset(figure, &report.look)?, svg::inset(figure, &narrow)?])
        };
        let drawn = all.par_iter().filter_map(|picture| Some((picture.id, &picture.drawn.as_ref().ok()?.figure)));
        let drawn = drawn.map(|(id, figure)| Ok((id, insets(figure)?, FigureValues::new(figure, &report.look))));
        let drawn: Vec<(&'static str, [String; 2], FigureValues<'_>)> = drawn.collect::<Result<_, HtmlError>>()?;
        let texts = drawn.iter().flat_map(|(_, insets, _)| insets).map(String::as_str);
        let style = svg::page_style(&report.look, texts)?;
        let packed = drawn.into_par_iter().map(|(id, [broad, narrow], values)| {
            let narrow = packed(&with_images_of(&narrow, &broad))?;
            Ok((id, DrawnFigure { narrow, values: packed(&serde_json::to_string(&values)?)?, broad }))
        });
        Ok(Self { by_id: packed.collect::<Result<_, HtmlError>>()?, style })
    }
}

/// Replaces an image in a drawing that equals one in another drawing by its number, which a script resolves.
fn with_images_of(drawing: &str, other: &str) -> String {
    const BEGIN: &str = " href=\"";
    let images: Vec<&str> = other.split(BEGIN).skip(1).filter_map(|rest| rest.split('"').next()).collect();
    let mut parts = drawing.split(BEGIN);
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (image, rest) = part.split_once('"').unwrap_or((part, ""));
        match images.iter().position(|known| *known == image) {
            Some(number) => text.push_str(&format!(" data-image=\"{number}\"{rest}")),
            None => text.push_str(&format!("{BEGIN}{image}\"{rest}")),
        }
    }
    text
}

/// Picture shown in place of the live page at first: impacts and orbits around the corner impact, else the attractors at each speed.
pub(crate) fn still(report: &Report) -> Option<&RenderedFigure> {
    let corner = report.plates.iter().find(|plate| plate.id == around_corner() && plate.drawn.is_ok());
    corner.or(report.attractors.as_ref())
}

/// Section of the available figures; `None` if the only one is beside the model.
pub(crate) fn section(report: &Report, figures: &DrawnFigures) -> Option<PageSection> {
    let there: Vec<&RenderedFigure> = report.plates.iter().filter(|plate| plate.drawn.is_ok()).collect();
    if there.iter().all(|plate| plate.id == CAM) {
        return None;
    }
    let still = still(report).map(|picture| picture.id);
    let drawn = there.into_iter().map(|plate| match plate.id {
        CAM => Block::Markup(elsewhere(plate, report, " is shown with the model.")),
        id if Some(id) == still => Block::Markup(elsewhere(plate, report, " is shown above.")),
        _ => self::plate(plate, report, figures),
    });
    Some(PageSection { id: "figures", title: "Figures".into(), blocks: drawn.collect() })
}

/// Note that a figure is shown elsewhere.
pub(crate) fn elsewhere(plate: &RenderedFigure, report: &Report, at: &str) -> Markup {
    html! { p.note { (place(plate, report)) a href={ "#plate-" (plate.id) } { (plate.title) } (at) } }
}

/// Look of a figure on a telephone: narrow, with letters as large as the surrounding text, and without a margin.
fn narrow(look: &Look) -> Look {
    /// Width of a telephone's screen, points, on the scale of the page's width.
    const PHONE: f64 = 250.0;
    let legend = if look.legend == LegendPlace::Right { LegendPlace::Below } else { look.legend };
    Look { width: Some(PHONE), size: None, title: TitleChoice::Hidden, legend, ..look.clone() }
}

/// Number of the paper's figure, shown only for the paper's model.
fn place(plate: &RenderedFigure, report: &Report) -> Markup {
    html! { @if report.is_paper && !plate.place.is_empty() { span.place { (plate.place) ". " } } }
}

/// Figure with its caption, the number of the paper's figure, and the command that draws it.
pub(crate) fn plate(plate: &RenderedFigure, report: &Report, figures: &DrawnFigures) -> Block {
    let caption = match &plate.drawn {
        Ok(Captioned { caption, .. }) => html! { (caption) code.command { (plate.command) } },
        Err(why) => html! { strong { (plate.title) } ". " span.absent { "Not drawn: " (why) "." } },
    };
    let figure = html! {
        figure id={ "plate-" (plate.id) } {
            @if let Some(drawn) = figures.by_id.get(plate.id) {
                div.drawing.broad { (PreEscaped(&drawn.broad)) }
                div.drawing.narrow data-packed=(drawn.narrow) {}
                div.save data-packed=(drawn.values) {}
            }
            figcaption { (place(plate, report)) (caption) }
        }
    };
    Block::Markup(figure).about("figure_data")
}
