//! The report as one self-contained HTML page: no network, no font, no other file.
//!
//! The page begins with the answer. Its sections follow in a referee's order of reading, if the machine has their subject. All contents
//! come from the [`Report`]; only words, order and digits are chosen here. A computed number is in a `data` element whose value has all the
//! digits of the document, or in a cell with these digits as `data-value`. Numbers in captions and sentences are part of the document's
//! words.

mod answer;
mod explore;
mod ledger;
mod loads;
mod model;
mod numbers;
mod plates;
mod reproduce;
mod speeds;
mod values;
mod verdict;

use std::io::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use maud::{DOCTYPE, PreEscaped, html};

use crate::explain::ExplainError;
use crate::pages::report::html::plates::DrawnFigures;
use crate::pages::{local_map, verify};
use crate::report::{Report, VERSION};
use crate::show::block::{Block, PageSection, in_units};
use crate::show::html::{blocks, words};
use corner_impact::study::verify::Verification;
use corner_impact::untrusted;
use corner_impact_plot::look::LookError;
use corner_impact_plot::svg::SvgError;

const STYLE: &str = include_str!("page.css");
const SCRIPTS: [&str; 5] = [
    include_str!("unpack.js"),
    include_str!("ledger.js"),
    include_str!("values.js"),
    include_str!("figures.js"),
    include_str!("explain.js"),
];

/// Reason why there is no page.
#[derive(Debug, thiserror::Error)]
pub enum HtmlError {
    /// Figure that could not be written.
    #[error("figure: {0}")]
    Figure(#[from] SvgError),
    /// Figure without room in the requested look.
    #[error(transparent)]
    Look(#[from] LookError),
    /// Data of a figure that could not be compressed.
    #[error("data of a figure: {0}")]
    Packed(#[from] std::io::Error),
    /// Name of a number that is not in the table of links, or an invalid table.
    #[error(transparent)]
    Explanation(#[from] ExplainError),
    /// Values of a figure that could not be written.
    #[error("values of a figure: {0}")]
    Data(#[from] serde_json::Error),
}

/// Renders the page.
pub fn render(report: &Report) -> Result<String, HtmlError> {
    let found = report.verification.as_ref().ok();
    let figures = DrawnFigures::of(report)?;
    // Drops the heading of the blocks: the page has its own.
    let titled = |id, title: &str, of: fn(&Verification) -> Vec<Block>| {
        let blocks = found.map(of).filter(|blocks| !blocks.is_empty())?;
        Some(PageSection { id, title: title.into(), blocks: blocks.into_iter().skip(1).collect() })
    };
    let mut sections: Vec<PageSection> = [
        Some(answer::section(report, &figures)),
        explore::section(report, &figures),
        loads::section(report, &figures),
        verdict::section(report),
        Some(model::section(report, &figures)),
        titled("corner-impact", "The orbit of the corner impact", verify::orbit),
        titled("maps", "The local map by every route", |found| [verify::map(found), verify::agreement(found)].concat()),
        titled("printed", "The paper's printed numbers", verify::published),
        titled("bifurcation", "What happens there", verify::bifurcation),
        titled("local-map", "Motions of the local map", local_map::blocks),
        ledger::section(report)?,
        Some(speeds::section(report, &figures)),
        plates::section(report, &figures),
        Some(reproduce::section(report)),
    ]
    .into_iter()
    .flatten()
    .collect();
    sections.push(numbers::section(report, &sections)?);
    let live = sections.iter().any(|section| section.id == "explore").then(|| explore::parts(report)).transpose()?;
    let what = if report.verification.is_ok() { "Corner impact" } else { "Cam and follower" };
    let title = format!("{what} of {}", report.model.name);
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                meta name="generator" content={ "corner-impact " (VERSION) };
                title { (title) }
                style { (PreEscaped(STYLE)) }
                style id="figure-style" { (PreEscaped(&figures.style)) }
            }
            body {
                a.skip href="#main" { "Skip to the answer" }
                header {
                    p.kind { "Report of corner-impact " (VERSION) }
                    h1 { (title) }
                }
                nav aria-label="Sections" {
                    ol {
                        @for section in &sections { li { a href={ "#" (section.id) } { (words(&section.title)) } } }
                    }
                }
                main id="main" {
                    @for section in &sections {
                        section id=(section.id) aria-labelledby={ (section.id) "-title" } {
                            h2 id={ (section.id) "-title" } { (words(&section.title)) }
                            (blocks(&in_units(section.blocks.clone(), &report.units)))
                        }
                    }
                }
                @for script in SCRIPTS { script { (PreEscaped(script)) } }
                @if let Some(live) = live { (live) }
            }
        }
    };
    Ok(untrusted::visible(&page.into_string()).into_owned())
}

/// Compresses text in a form that a browser decompresses.
fn packed(text: &str) -> Result<String, std::io::Error> {
    let mut packer = ZlibEncoder::new(Vec::new(), Compression::best());
    packer.write_all(text.as_bytes())?;
    Ok(STANDARD.encode(packer.finish()?))
}
