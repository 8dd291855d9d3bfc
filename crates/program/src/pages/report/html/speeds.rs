//! Motions of the follower at other speeds.

use crate::pages::report::html::plates::{DrawnFigures, elsewhere, plate, still};
use crate::pages::speeds::{dangers, detachment, how, remarks, table, together, uncertainty};
use crate::report::Report;
use crate::show::block::{self, Block, PageSection, Words, words};
use corner_impact::study::speeds::SpeedSurvey;

pub(crate) fn section(report: &Report, figures: &DrawnFigures) -> PageSection {
    let mut blocks = match &report.speeds {
        Ok(found) => attractors(found),
        Err(why) => vec![Block::paragraph(format!("Not known: {why}."))],
    };
    if let Some(picture) = &report.attractors {
        let is_still = still(report).is_some_and(|still| still.id == picture.id);
        blocks.push(if is_still {
            Block::Markup(elsewhere(picture, report, " is shown above."))
        } else {
            plate(picture, report, figures)
        });
    }
    PageSection { id: "speeds", title: "At each speed".into(), blocks }
}

fn attractors(found: &SpeedSurvey) -> Vec<Block> {
    let together = match found.coexistence.is_empty() {
        true => Words::from("No two attractors were found at one speed."),
        false => {
            words![
                "Several attractors coexist at ",
                Words::joined(together(found), ", "),
                " rpm; the start of a run decides between them."
            ]
        }
    };
    let separation = block::about("separation", detachment(found));
    let about = words!["The follower first leaves the cam at ", separation, ". ", together];
    let mut blocks = vec![Block::paragraph(about), Block::Table(table(found))];
    blocks.extend(remarks(found));
    blocks.extend(dangers(found));
    blocks.push(Block::paragraph(how(found)));
    blocks.extend(uncertainty(found));
    vec![Block::About("attractors".into(), blocks)]
}
