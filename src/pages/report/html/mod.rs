//! The report as one HTML page that needs nothing beside it: no network, no font, no other file.
//!
//! Sections stand in a referee's order of reading. Whatever is shown comes from the [`Dossier`]; chosen here are words,
//! order and digits. A number that was computed stands in a `data` element whose value has all the digits that the document has;
//! numbers in captions and sentences are the document's words.

mod bifurcation;
mod ledger;
mod maps;
mod model;
mod numbers;
mod orbit;
mod plates;
mod reproduce;
mod slider;
mod speeds;
mod verdict;

use std::fmt;

use maud::{DOCTYPE, Markup, PreEscaped, html};

use crate::pages::report::dossier::Dossier;

const STYLE: &str = include_str!("page.css");
const SCRIPTS: [&str; 2] = [include_str!("ledger.js"), include_str!("slider.js")];

/// A section of the page.
struct Section {
    id: &'static str,
    title: &'static str,
    body: Markup,
}

/// Why there is no page.
#[derive(Debug, thiserror::Error)]
pub enum HtmlError {
    /// A figure could not be written.
    #[error("figure: {0}")]
    Figure(#[from] fmt::Error),
    /// The slider's data could not be written.
    #[error("data: {0}")]
    Data(#[from] serde_json::Error),
}

/// The page.
pub fn render(dossier: &Dossier) -> Result<String, HtmlError> {
    let sections: Vec<Section> = [
        Some(verdict::section(dossier)),
        Some(model::section(dossier)?),
        Some(orbit::section(dossier)),
        maps::section(dossier),
        maps::printed(dossier),
        bifurcation::section(dossier),
        Some(slider::section(dossier)?),
        bifurcation::local_map(dossier),
        ledger::section(dossier),
        Some(speeds::section(dossier)),
        plates::section(dossier)?,
        Some(reproduce::section(dossier)),
    ]
    .into_iter()
    .flatten()
    .collect();
    let what = if dossier.verification.is_some() { "Corner impact" } else { "Cam and follower" };
    let title = format!("{what} of {}", dossier.model.name);
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                meta name="generator" content={ "corner-impact " (dossier.version) };
                title { (title) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                a.skip href="#main" { "Skip to the findings" }
                header {
                    p.kind { "Report of corner-impact " (dossier.version) }
                    h1 { (title) }
                }
                nav aria-label="Sections" {
                    ol {
                        @for section in &sections { li { a href={ "#" (section.id) } { (section.title) } } }
                    }
                }
                main id="main" {
                    @for section in &sections {
                        section id=(section.id) aria-labelledby={ (section.id) "-title" } {
                            h2 id={ (section.id) "-title" } { (section.title) }
                            (section.body)
                        }
                    }
                }
                @for script in SCRIPTS { script { (PreEscaped(script)) } }
            }
        }
    };
    Ok(page.into_string())
}

/// A block that may be wider than the page, in a box that scrolls by itself.
fn wide(label: &str, body: &Markup) -> Markup {
    html! { div.wide role="region" aria-label=(label) tabindex="0" { (body) } }
}

/// Text that ends a `script` element neither by a tag nor by a comment.
fn json(text: &str) -> PreEscaped<String> {
    PreEscaped(text.replace('<', "\\u003c").replace('>', "\\u003e").replace('&', "\\u0026"))
}
