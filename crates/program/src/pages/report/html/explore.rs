//! Where a number is changed and the motion is watched: a still picture, in whose place a live page may come.

use maud::html;

use crate::figures::around_corner;
use crate::pages::report::html::plates::{DrawnFigures, plate, still};
use crate::report::Report;
use crate::show::block::{Block, PageSection};
use crate::show::html::blocks;

/// Section of the live page; `None` if nothing can be shown. Without a script the empty element is hidden. A script that makes the page live
/// shows itself there and hides the element after it.
pub(crate) fn section(report: &Report, figures: &DrawnFigures) -> Option<PageSection> {
    let picture = still(report)?;
    let title = if picture.id == around_corner() { "Through the corner impact" } else { "Over the speed" };
    let markup = html! {
        div.explore id="explore-live" hidden {}
        div id="explore-still" { (blocks(&[plate(picture, report, figures)])) }
    };
    Some(PageSection { id: "explore", title: title.into(), blocks: vec![Block::Markup(markup)] })
}
