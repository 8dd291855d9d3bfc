//! What cam and follower bear at speeds around the separation.

use crate::pages::design::speeds;
use crate::pages::report::html::HtmlError;
use crate::pages::report::html::plates::plate;
use crate::report::Report;
use crate::show::block::{Block, Section};

pub(crate) fn section(report: &Report) -> Result<Option<Section>, HtmlError> {
    let Some((found, picture)) = report.design.as_ref().zip(report.loads.as_ref()) else { return Ok(None) };
    // The page has the heading in other words.
    let table = Block::About("contact_force".into(), speeds(found).into_iter().skip(1).collect());
    let folded = Block::Details("The same in numbers".into(), vec![table]);
    let blocks = vec![plate(picture, report)?, folded];
    Ok(Some(Section { id: "loads", title: "How hard it presses and hits".into(), blocks }))
}
