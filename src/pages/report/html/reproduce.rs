//! How to do it again.

use maud::html;

use crate::pages::report::dossier::Dossier;
use crate::pages::report::html::Section;

pub(crate) fn section(dossier: &Dossier) -> Section {
    let body = html! {
        p {
            "This page was written by corner-impact " (dossier.version) " from " code { (dossier.model.file) } ". "
            "Its numbers are one document, which the first command prints with " code { "--json" } "; the page only lays them out."
        }
        table.commands {
            tbody { @for (command, what) in &dossier.commands { tr { th scope="row" { code { (command) } } td { (what) } } } }
        }
        p {
            "With the sources, " code { "make test" } " runs every check and " code { "make derive-check" }
            " redoes the proofs by computer algebra."
        }
    };
    Section { id: "reproduce", title: "How to do it again", body }
}
