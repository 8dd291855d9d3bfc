//! What cam and follower bear at speeds around the separation.

use crate::pages::design::speeds;
use crate::pages::report::html::HtmlError;
use crate::pages::report::html::plates::plate;
use crate::report::Report;
use crate::show::block::{Block, Section, Span, about, words};
use crate::show::digits::Digits;
use crate::study::speeds::SpeedSurvey;

/// How much harder a motion has to hit than those of a few starts to be told apart, as one hit of many varies.
const SHARED: f64 = 1.1;

pub(crate) fn section(report: &Report) -> Result<Option<Section>, HtmlError> {
    let Some((found, picture)) = report.design.as_ref().zip(report.loads.as_ref()) else { return Ok(None) };
    // The page has the heading in other words.
    let table = Block::About("contact_force".into(), speeds(found).into_iter().skip(1).collect());
    let folded = Block::Details("The same in numbers".into(), vec![table]);
    let mut blocks = vec![plate(picture, report)?, folded];
    let most = found.loads.iter().map(|loads| loads.impact_speed).fold(0.0, f64::max);
    let hardest = report.speeds.as_ref().ok().and_then(SpeedSurvey::hardest);
    // More starts come to more motions, and a rare one may hit hardest.
    if let Some([speed, rpm]) = hardest.filter(|[speed, _]| *speed > SHARED * most) {
        let harder = words![
            "A motion that the four starts do not come to, or at a speed between theirs, hits harder: with ",
            (speed, Digits::Significant(3)),
            " ",
            Span::Unit("m/s"),
            " at ",
            (rpm, Digits::Significant(4)),
            " rpm."
        ];
        blocks.push(Block::Note(about("impact_speed", harder)));
    }
    Ok(Some(Section { id: "loads", title: "How hard it presses and hits".into(), blocks }))
}
