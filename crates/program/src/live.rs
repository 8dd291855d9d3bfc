//! Live page inside one file: the page of `corner_impact_explore` with the module that computes its answers.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use corner_impact::model::Model;
use corner_impact_explore::{PageModel, PageWords, Transport};

use crate::report::VERSION;

/// WebAssembly module, compressed by gzip; empty if the program was built without it.
static MODULE: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/explore.wasm.gz"));

/// Reason why a page in a file cannot be live.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "this program was built without the module that answers a page in a file: run `make explore` in its source folder, and build it again"
)]
pub struct NoModule;

/// Returns the module in base64.
pub(crate) fn module() -> Result<String, NoModule> {
    if MODULE.is_empty() { Err(NoModule) } else { Ok(STANDARD.encode(MODULE)) }
}

/// Builds the page's initial model as self-contained text, so that it needs no table beside it.
pub(crate) fn page_model(model: &Model) -> PageModel {
    let file = model.path().map(|path| path.display().to_string());
    // Without a file it is the paper's model, which the module contains.
    let is_given = file.is_some() || !model.changes().is_empty();
    PageModel { file, text: is_given.then(|| model.text()) }
}

/// Sentence of the page that is shown without JavaScript.
const STILL: &str = "<p>This page computes its pictures in the browser, which needs JavaScript. <code>corner-impact report</code> writes a page with \
                     still pictures.</p>";

/// Builds the live page of a model as one HTML file, which needs no server.
pub fn page(model: &Model) -> Result<String, NoModule> {
    Ok(page_by(Transport::Module(&module()?), model))
}

/// Builds the live page of a model, with this connection to its answers.
pub(crate) fn page_by(transport: Transport<'_>, model: &Model) -> String {
    let words = PageWords { title: &model.name, version: VERSION, still: STILL, footer: "" };
    corner_impact_explore::page(transport, &page_model(model), words)
}
