//! What the follower does at other speeds.

use maud::{Markup, html};

use crate::pages::report::dossier::Dossier;
use crate::pages::report::html::numbers::fixed;
use crate::pages::report::html::{Section, wide};
use crate::show::words;
use crate::study::speeds::{Regimes, Stretch};

pub(crate) fn section(dossier: &Dossier) -> Section {
    let body = match (&dossier.speeds, &dossier.no_speeds) {
        (Some(found), _) => regimes(found),
        (_, why) => html! { p { "Not known: " (why.as_deref().unwrap_or("nothing was run")) "." } },
    };
    Section { id: "speeds", title: "At other speeds", body }
}

fn regimes(found: &Regimes) -> Markup {
    let [low, high] = found.rpm;
    html! {
        p {
            "The speed is raised from " (fixed(low, 2)) " to " (fixed(high, 2)) " rpm, and in a second run lowered from there; at "
            "each speed the follower has time to settle. "
            @if let Some(rpm) = found.detachment_rpm { "It leaves the cam for the first time at " (fixed(rpm, 6)) " rpm. " }
            "Narrow ranges between two speeds that were run may be missing; " code { "corner-impact speeds" } " looks closer."
        }
        (wide("What the follower does at other speeds", &html! {
            table {
                tbody {
                    @for entry in &found.regimes {
                        tr { th scope="row" { (words::regime(entry.regime)) } td { (ranges(&entry.ranges)) } }
                    }
                    @if !found.hysteresis.is_empty() {
                        @let both = found.hysteresis_ranges();
                        tr { th scope="row" { "depends on where the speed comes from" } td { (ranges(&both)) } }
                    }
                }
            }
        }))
        details {
            summary { "Every range by rising speed, and why it begins" }
            (wide("Ranges by rising speed", &stretches(&found.rising)))
        }
    }
}

fn ranges(ranges: &[[f64; 2]]) -> Markup {
    html! {
        @for (index, [low, high]) in ranges.iter().enumerate() {
            @if index > 0 { ", " }
            span.number { (fixed(*low, 2)) "–" (fixed(*high, 2)) }
        }
        " rpm"
    }
}

fn stretches(entries: &[Stretch]) -> Markup {
    html! {
        table {
            thead { tr { th.n scope="col" { "from, rpm" } th.n scope="col" { "to, rpm" } th scope="col" { "motion" } th scope="col" { "why it begins" } } }
            tbody {
                @for entry in entries {
                    tr {
                        td.n { (fixed(entry.rpm[0], 4)) } td.n { (fixed(entry.rpm[1], 4)) } td { (words::motion(&entry.settled)) }
                        td { @if let Some(change) = &entry.begins { (change.cause.words()) } }
                    }
                }
            }
        }
    }
}
