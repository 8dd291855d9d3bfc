//! The slider over speed: its frame, its data, and the data as a table.

use maud::{Markup, html};

use crate::pages::report::html::{HtmlError, packed};
use crate::report::Report;
use crate::report::through::ThroughCorner;
use crate::show::block::{Block, Column, PageSection, Span, Table, Words, words};
use crate::show::digits::Digits;
use crate::show::html::wide;
use crate::show::words;

/// Section of the slider; `None` if there is no motion through a corner impact.
pub(crate) fn section(report: &Report) -> Result<Option<PageSection>, HtmlError> {
    let Ok(through) = &report.through else { return Ok(None) };
    let blocks = vec![
        Block::Markup(player(through, &report.units.spelled("m/s"))).about("through"),
        Block::Details("The same as a table".into(), vec![Block::Table(table(through)).about("through")]),
        Block::Markup(data(through)?),
    ];
    Ok(Some(PageSection { id: "through", title: "Through the corner impact".into(), blocks }))
}

/// Data for the script.
fn data(through: &ThroughCorner) -> Result<Markup, HtmlError> {
    let data = serde_json::to_string(through)?;
    Ok(html! { script type="text/plain" id="through-data" { (packed(&data)?) } })
}

fn player(through: &ThroughCorner, velocity: &str) -> Markup {
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
            "what the runs do that came there from faster and from slower speeds."
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
                        li.stable { "stable orbit" } li.unstable { "unstable orbit" } li.neutral { "neutral orbit" } li.run { "run that came from faster speeds" } li.rising { "run that came from slower speeds" }
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
                        th.n scope="col" { "velocity before, " (velocity) } th.n scope="col" { "after, " (velocity) } th.n scope="col" { "multipliers" } th.n scope="col" { "larger modulus" }
                    } }
                    tbody {}
                }
            }))
        }
    }
}

fn table(through: &ThroughCorner) -> Table {
    let [orbit, impact, multipliers] = ["orbit", "impact", "multipliers"].map(Column::words);
    let velocity = words!["velocity before, ", Span::Unit("m/s")];
    let [rpm, angle, velocity] = ["rpm".into(), "at, deg".into(), velocity].map(Column::number);
    let columns = [rpm, orbit, impact, angle, velocity, multipliers];
    let mut table = Table::new("Orbits by speed", columns);
    let seven = Digits::Significant(7);
    for frame in &through.frames {
        let rpm = words![(frame.rpm, Digits::Fixed(4))];
        for orbit in &frame.orbits {
            let multipliers = orbit.multipliers.map(|value| Span::Complex([value.re, value.im], seven).into());
            table.row([
                rpm.clone(),
                words::stability(orbit.stability).into(),
                orbit.place.to_string().into(),
                words![(orbit.angle_deg, Digits::Fixed(4))],
                words![(orbit.velocity_before_m_s, seven)],
                Words::joined(multipliers, ", "),
            ]);
        }
        if frame.orbits.is_empty() {
            let run = format!("a run has {}", frame.slowing.words);
            table.row([rpm, "none".into(), Words::default(), Words::default(), Words::default(), run.into()]);
        }
    }
    table
}
