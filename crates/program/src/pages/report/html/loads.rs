//! Loads on cam and follower at speeds around the separation.

use crate::pages::design::speeds;
use crate::pages::report::html::plates::{DrawnFigures, plate};
use crate::report::Report;
use crate::show::block::{Block, PageSection, Span, about, words};
use crate::show::digits::Digits;
use corner_impact::study::speeds::SpeedSurvey;

/// Ratio of impact speeds above which a motion is mentioned as harder than those of the few starts; smaller ratios are within the usual
/// scatter.
const SHARED: f64 = 1.1;

pub(crate) fn section(report: &Report, figures: &DrawnFigures) -> Option<PageSection> {
    let (found, picture) = report.design.as_ref().zip(report.loads.as_ref())?;
    // The heading is skipped: the page has its own.
    let table = Block::About("contact_force".into(), speeds(found).into_iter().skip(1).collect());
    let folded = Block::Details("The same in numbers".into(), vec![table]);
    let mut blocks = vec![plate(picture, report, figures), folded];
    let most = found.loads.iter().map(|loads| loads.impact_speed).fold(0.0, f64::max);
    let hardest = report.speeds.as_ref().ok().and_then(SpeedSurvey::hardest);
    // More starts find more motions, and a rare one may hit hardest.
    if let Some([speed, rpm]) = hardest.filter(|[speed, _]| *speed > SHARED * most) {
        let harder = words![
            "Another motion, from another start or at a speed between these, hits harder: with ",
            (speed, Digits::Significant(3)),
            " ",
            Span::Unit("m/s"),
            " at ",
            (rpm, Digits::Significant(4)),
            " rpm."
        ];
        blocks.push(Block::Note(about("impact_speed", harder)));
    }
    Some(PageSection { id: "loads", title: "Contact force and impacts".into(), blocks })
}
