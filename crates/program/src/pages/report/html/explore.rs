//! Section of the live page: a still picture, which the live page replaces if the program has its module.

use corner_impact_explore::{SCRIPTS, STYLE, Transport, mounting};
use maud::{Markup, PreEscaped, html};

use crate::figures::around_corner;
use crate::live;
use crate::pages::report::html::plates::{DrawnFigures, plate, still};
use crate::pages::report::html::{HtmlError, packed};
use crate::report::Report;
use crate::show::block::{Block, PageSection};
use crate::show::html::blocks;

/// Section of the live page; `None` if nothing can be shown. Without a script the empty element is hidden. A script that makes the page
/// live appears there and hides the element after it.
pub(crate) fn section(report: &Report, figures: &DrawnFigures) -> Option<PageSection> {
    let picture = still(report)?;
    let title = if picture.id == around_corner() { "Through the corner impact" } else { "Over the speed" };
    let markup = html! {
        div.explore id="explore-live" hidden {}
        div id="explore-still" { (blocks(&[plate(picture, report, figures)])) }
    };
    Some(PageSection { id: "explore", title: title.into(), blocks: vec![Block::Markup(markup)] })
}

/// Style, scripts and module of the live page, compressed, which `live.js` decompresses; empty if the program has no module.
pub(crate) fn parts(report: &Report) -> Result<Markup, HtmlError> {
    let Ok(module) = live::module() else { return Ok(html! {}) };
    let mount = mounting("explore-live", Transport::Element("explore-module"), &live::page_model(&report.parsed));
    let script = packed(&format!("{SCRIPTS}\n{mount}"))?;
    Ok(html! {
        style { (PreEscaped(STYLE)) }
        script type="text/plain" id="explore-module" { (module) }
        script type="text/plain" id="explore-script" { (script) }
        script { (PreEscaped(include_str!("live.js"))) }
    })
}
