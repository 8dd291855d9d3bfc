//! The slider over speed: its frame, its data, and the same as a table.

use maud::{Markup, html};

use crate::pages::report::dossier::Dossier;
use crate::pages::report::html::numbers::{complex, fixed, number};
use crate::pages::report::html::{HtmlError, Section, json, wide};
use crate::pages::report::through::{OrbitFrame, ThroughEntry};

pub(crate) fn section(dossier: &Dossier) -> Result<Section, HtmlError> {
    let body = match (&dossier.through, &dossier.no_through) {
        (Some(through), _) => player(through, &serde_json::to_string(through)?),
        _ if dossier.verification.is_none() => html! { p { "There is no corner impact to lead a motion through." } },
        (_, why) => html! {
            p { "There is no motion to lead through the corner impact" @if let Some(why) = why { ": " (why) } "." }
        },
    };
    Ok(Section { id: "through", title: "Through the corner impact", body })
}

fn player(through: &ThroughEntry, data: &str) -> Markup {
    let last = through.frames.len().saturating_sub(1);
    let panel = |id: &str, title: &str, what: Markup| {
        html! {
            figure.panel {
                figcaption { strong { (title) } " " (what) }
                div.canvas id=(id) {}
            }
        }
    };
    html! {
        p {
            "Move the speed through that of the corner impact. Shown is every orbit with one impact a revolution, stable or not, and "
            "what a run does that came there from faster speeds."
        }
        noscript { p { "Moving the speed needs JavaScript. The table below has the same orbits, and the figures the same pictures." } }
        div.player id="player" hidden {
            div.controls {
                label for="speed" { "Speed " output id="speed-shown" for="speed" {} }
                input type="range" id="speed" min="0" max=(last) step="1" value=(through.at_corner);
                div.buttons {
                    button type="button" id="play" aria-pressed="false" { "Play" }
                    button type="button" id="to-corner" { "Corner impact" }
                }
            }
            div.panels {
                div.panel {
                    p.summary role="status" aria-live="polite" id="summary" {}
                    ul.key {
                        li.stable { "stable orbit" } li.unstable { "unstable orbit" } li.run { "run that came from faster speeds" } li.rising { "run that came from slower speeds" }
                    }
                }
                (panel("revolution", "One revolution.", html! { "Follower and cam against the cam angle; a ring is an impact." }))
                (panel("shape", "The cam", html! { "turned to the impact, with the follower on it." }))
                (panel("near", "The impact at the corner.", html! { "Acceleration of the cam; a line is where an orbit hits." }))
                (panel("plane", "Multipliers", html! { "in the complex plane, with the unit circle." }))
                (panel("diagram", "Impacts", html! { "against speed; touch it to go there." }))
            }
            (wide("Orbits at this speed", &html! {
                table id="readout" {
                    thead { tr {
                        th scope="col" { "orbit" } th scope="col" { "impact" } th.n scope="col" { "at, deg" } th.n scope="col" { "from the corner, deg" }
                        th.n scope="col" { "velocity before, m/s" } th.n scope="col" { "after, m/s" } th.n scope="col" { "multipliers" } th.n scope="col" { "larger modulus" }
                    } }
                    tbody {}
                }
            }))
        }
        details {
            summary { "The same as a table" }
            (wide("Orbits by speed", &table(through)))
        }
        script type="application/json" id="through-data" { (json(data)) }
    }
}

fn table(through: &ThroughEntry) -> Markup {
    html! {
        table {
            thead { tr {
                th.n scope="col" { "rpm" } th scope="col" { "orbit" } th scope="col" { "impact" } th.n scope="col" { "at, deg" }
                th.n scope="col" { "velocity before, m/s" } th scope="col" { "multipliers" }
            } }
            tbody {
                @for frame in &through.frames {
                    @for orbit in &frame.orbits {
                        tr { td.n { (fixed(frame.rpm, 4)) } (row(orbit)) }
                    }
                    @if frame.orbits.is_empty() {
                        tr { td.n { (fixed(frame.rpm, 4)) } td colspan="5" { "none; a run has " (frame.slowing.words) } }
                    }
                }
            }
        }
    }
}

fn row(orbit: &OrbitFrame) -> Markup {
    html! {
        td { @if orbit.stable { "stable" } @else { "unstable" } }
        td { (orbit.place) }
        td.n { (fixed(orbit.angle_deg, 4)) }
        td.n { (number(orbit.velocity_before_m_s, 7)) }
        td { (complex(orbit.multipliers[0], 7)) ", " (complex(orbit.multipliers[1], 7)) }
    }
}
