//! Answer of the report: one picture, and a sentence each on separation, impact speed, coexisting motions, and proofs.

use crate::figures::chaotic_set;
use crate::pages::design::leaves;
use crate::pages::report::html::plates::{DrawnFigures, plate};
use crate::pages::speeds::together;
use crate::report::Report;
use crate::show::block::{Block, PageSection, Span, TextMark, Words, about, words};
use crate::show::digits::Digits;
use crate::show::sources::Sources;
use crate::show::words::hypotheses;
use corner_impact::study::design::contact::Separation;

pub(crate) fn section(report: &Report, figures: &DrawnFigures) -> PageSection {
    let picture = report.overview.as_ref().map(|picture| plate(picture, report, figures));
    let said = [Some(separates(report)), margin(report), impacts(report), coexistence(report), Some(proved(report))];
    let blocks = picture.into_iter().chain([Block::List(said.into_iter().flatten().collect())]).collect();
    PageSection { id: "answer", title: "In brief".into(), blocks }
}

/// Sources of the uncertainty of the machine.
fn sources(report: &Report) -> Sources<'_> {
    Sources::of(&report.measured, report.parsed.errors)
}

fn headed(head: &str, what: &str, sentence: Words) -> Words {
    words![(TextMark::Strong, head), " ", about(what, sentence)]
}

fn separates(report: &Report) -> Words {
    let sentence = match (&report.separation, &report.margin) {
        (Separation::At { .. }, _) => {
            leaves(report.separation, &report.separation_places, sources(report).if_any(), report.separation_error)
        }
        (Separation::Never, _) => {
            "The follower stays on the cam at every speed: the cam nowhere falls away from it.".into()
        }
        (Separation::Kink { .. }, _) => {
            "The follower leaves the cam at every speed, however low: the cam's velocity jumps.".into()
        }
        _ => "The follower leaves the cam at every speed, however low: the spring does not press it onto the cam everywhere."
            .into(),
    };
    headed("Separation.", "separation", sentence)
}

fn margin(report: &Report) -> Option<Words> {
    let margin = report.margin.as_ref()?;
    let [there, still] = margin.least_force.map(|force| words![(force, Digits::Significant(4))]);
    let sentence = words![
        "At four fifths of that speed, ",
        (margin.speed_rpm, Digits::Fixed(1)),
        " rpm, the least contact force is still ",
        there,
        format!(" {}, at ", margin.force_unit),
        (margin.cam_angle_deg, Digits::Fixed(1)),
        "°. At standstill it is ",
        still,
        format!(" {}.", margin.force_unit)
    ];
    Some(headed("Margin.", "contact_force", sentence))
}

fn impacts(report: &Report) -> Option<Words> {
    let found = report.speeds.as_ref().ok()?;
    let [low, high] = found.range;
    let open = match sources(report).if_any() {
        Some(sources) => {
            let loads = if report.loads.is_some() { ". The loads below have their ±" } else { "" };
            let drawn = if sources.cam.is_some() { "cam as it is drawn" } else { "machine as it is given" };
            format!(" It is for the {drawn} ({}){loads}.", sources.why())
        }
        None => String::new(),
    };
    let sentence = match found.hardest() {
        Some([speed, rpm]) => words![
            "The hardest impact seen from ",
            format!("{low} to {high} rpm is "),
            (speed, Digits::Significant(3)),
            " ",
            Span::Unit("m/s"),
            " between follower and cam, at ",
            (rpm, Digits::Significant(4)),
            " rpm.",
            open
        ],
        None => format!("None was seen from {low} to {high} rpm.").into(),
    };
    Some(headed("Impacts.", "impact_speed", sentence))
}

fn coexistence(report: &Report) -> Option<Words> {
    let found = report.speeds.as_ref().ok()?;
    let sentence = match together(found) {
        ranges if ranges.is_empty() => "No speed was found at which runs settle on two motions.".into(),
        ranges => words!["Runs settle on one of several motions, depending on their start, at ", several(ranges), "."],
    };
    Some(headed("Coexistence.", "attractors", sentence))
}

/// First few of some ranges, and the number of all.
fn several(ranges: Vec<Words>) -> Words {
    const SHOWN: usize = 3;
    let more = ranges.len().saturating_sub(SHOWN);
    let mut said = Words::joined(ranges.into_iter().take(SHOWN), ", ");
    said.push(" rpm");
    if more > 0 {
        said.push(format!(", and elsewhere, {} ranges in all", SHOWN + more));
    }
    said
}

fn proved(report: &Report) -> Words {
    let certified = report.verification.as_ref().ok().filter(|found| found.certificate.is_some());
    let certificate = certified.and_then(|found| found.certificate.as_ref());
    let taken = certificate.and_then(|certificate| hypotheses(&certificate.hypotheses()));
    let corner = certified.map(|found| {
        words!["that the corner impact at ", (found.at.speed_rpm(), Digits::Fixed(6)), " rpm exists, and its local map"]
    });
    let chaos = report.plates.iter().any(|plate| plate.id == chaotic_set() && plate.drawn.is_ok());
    let chaos = chaos.then(|| "that a set of chaotic motions exists beyond the corner impact".into());
    let all: Vec<Words> = corner.into_iter().chain(chaos).collect();
    let sentence = match all.is_empty() {
        true => {
            "Nothing on this page: its results over the speeds come from runs at some speeds, from some starts.".into()
        }
        false => words![
            "It is proved ",
            Words::joined(all, ", and "),
            ". The results at other speeds come from runs at some of them. ",
            taken.as_deref().unwrap_or_default()
        ],
    };
    headed("What is proved.", "speed_rpm", sentence)
}
