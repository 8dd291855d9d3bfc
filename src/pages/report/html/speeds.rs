//! What the follower does at other speeds.

use crate::pages::report::html::unheaded;
use crate::pages::speeds::table;
use crate::report::Report;
use crate::show::block::{Block, Section, Words, words};
use crate::show::digits::Digits;
use crate::show::words::regime;
use crate::study::speeds::Regimes;

pub(crate) fn section(report: &Report) -> Section {
    let blocks = match &report.speeds {
        Ok(found) => regimes(found),
        Err(why) => vec![Block::paragraph(format!("Not known: {why}."))],
    };
    Section { id: "speeds", title: "At other speeds".into(), blocks }
}

fn regimes(found: &Regimes) -> Vec<Block> {
    let [low, high] = found.rpm.map(|rpm| words![(rpm, Digits::Fixed(2))]);
    let leaves = |rpm| words!["It leaves the cam for the first time at ", (rpm, Digits::Fixed(6)), " rpm. "];
    let about = Words::prose(
        "The speed is raised from {} to {} rpm, and in a second run lowered from there; at each speed the follower has time to \
         settle. {}Narrow ranges between two speeds that were run may be missing; `corner-impact speeds` looks closer.",
        [low, high, found.detachment_rpm.map(leaves).unwrap_or_default()],
    );
    let mut summary = unheaded("What the follower does at other speeds", 2);
    for seen in &found.regimes {
        summary.row([regime(seen.regime).into(), ranges(&seen.ranges)]);
    }
    if !found.hysteresis.is_empty() {
        summary.row(["depends on where the speed comes from".into(), ranges(&found.hysteresis_ranges())]);
    }
    let rising = Block::Table(table("Ranges by rising speed", &found.rising));
    let all = "Every range by rising speed, and why it begins";
    vec![Block::paragraph(about), Block::Table(summary), Block::Details(all.into(), vec![rising])]
}

fn ranges(ranges: &[[f64; 2]]) -> Words {
    let range = |[low, high]: &[f64; 2]| words![(*low, Digits::Fixed(2)), "–", (*high, Digits::Fixed(2))];
    words![Words::joined(ranges.iter().map(range), ", "), " rpm"]
}
