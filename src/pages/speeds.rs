//! The page of `speeds`: the short answer first, then every range with rising and with falling speed.

use crate::show::Paged;
use crate::show::block::{Block, Column, Mark, Table, words};
use crate::show::digits::Digits;
use crate::show::words;
use crate::study::speeds::{Regime, Regimes, Stretch};

impl Paged for Regimes {
    fn blocks(&self) -> Vec<Block> {
        let [low, high] = self.rpm;
        let first = self.rising.first().map(|stretch| stretch.settled.regime);
        let leaves = match (self.detachment_rpm, first) {
            (Some(rpm), _) => format!("{rpm:.6} rpm"),
            (None, Some(Regime::OnCam)) => "no speed in between".into(),
            (None, Some(Regime::Free)) => "no speed: it is never on it".into(),
            (None, _) => format!("{low} rpm already, or below"),
        };
        let line = |what: &str, answer: String| Block::Line(format!("  {what:<24}  {answer}").into());
        let heading = |text: &str| Block::Line((Mark::Heading, text).into());
        let mut page = vec![heading(&format!("{}, {low} to {high} rpm", self.model)), Block::Gap];
        page.push(line("leaves the cam first at", leaves));
        page.extend(self.regimes.iter().map(|seen| line(words::regime(seen.regime), listed(&seen.ranges))));
        let hysteresis = self.hysteresis_ranges();
        page.push(line("hysteresis", if hysteresis.is_empty() { "none".into() } else { listed(&hysteresis) }));
        for (title, stretches) in [("rising speed", &self.rising), ("falling speed", &self.falling)] {
            page.extend([Block::Gap, heading(title), Block::Table(table(title, stretches))]);
        }
        page
    }
}

/// The ranges of speeds with one kind of motion.
pub(crate) fn table(title: &str, stretches: &[Stretch]) -> Table {
    let columns = [
        Column { gap: 2, ..Column::right("from (rpm)", 10) },
        Column { gap: 1, ..Column::right("to (rpm)", 11) },
        Column::left("motion", 2, 36),
        Column::left("at the lower end", 1, 0),
    ];
    let mut table = Table::new(title, columns);
    for Stretch { rpm: [from, to], settled, begins } in stretches {
        let why = begins.as_ref().map_or(String::new(), |change| change.cause.words());
        let [from, to] = [from, to].map(|rpm| words![(*rpm, Digits::Fixed(4))]);
        table.row([from, to, words::motion(settled).into(), why.into()]);
    }
    table
}

/// Ranges, the longest where there are many.
fn listed(ranges: &[[f64; 2]]) -> String {
    /// Ranges that fit a line.
    const SHOWN: usize = 5;
    let mut longest: Vec<[f64; 2]> = ranges.to_vec();
    longest.sort_by(|one, two| (two[1] - two[0]).total_cmp(&(one[1] - one[0])));
    longest.truncate(SHOWN);
    longest.sort_by(|one, two| one[0].total_cmp(&two[0]));
    let words: Vec<String> = longest.iter().map(|[low, high]| format!("{low:.2}-{high:.2}")).collect();
    let more = ranges.len().saturating_sub(SHOWN);
    let rest = if more > 0 { format!(" rpm, and {more} shorter") } else { " rpm".into() };
    words.join(", ") + &rest
}
