//! Page with its script and style, as one HTML file or as a part of another page.

use std::collections::BTreeMap;

use corner_impact::model::{ModelTemplate, TEMPLATE_NAME};
use serde::Serialize;

/// Connection from the page's questions to the answers.
#[derive(Clone, Copy, Debug)]
pub enum Transport<'a> {
    /// Server from which the page came.
    Server {
        /// Base of the address for questions.
        base: &'a str,
        /// Nonce of the server's `Content-Security-Policy` for the scripts and styles of this page.
        nonce: &'a str,
    },
    /// WebAssembly module inside the page: compressed by gzip, in base64.
    Module(&'a str),
    /// WebAssembly module in the text of the element with this identifier, in the same form.
    Element(&'a str),
}

/// Initial model of the page; the paper's if it has no text.
#[derive(Clone, Debug, Default, Serialize)]
pub struct PageModel {
    /// Name of the file in commands.
    pub file: Option<String>,
    /// Text of a self-contained model file.
    pub text: Option<String>,
}

/// Texts of the whole page around the live part.
#[derive(Clone, Copy, Debug)]
pub struct PageWords<'a> {
    /// Name of the model.
    pub title: &'a str,
    /// Version of the program.
    pub version: &'a str,
    /// HTML that is shown without JavaScript.
    pub still: &'a str,
    /// HTML below the page.
    pub footer: &'a str,
}

const PAGE: &str = include_str!("page/index.html");

/// Style of the live part; all of it applies below the class `explore`.
pub const STYLE: &str = concat!(include_str!("page/page.css"), include_str!("page/views-more.css"));

/// Scripts, in the order of their dependencies.
pub const SCRIPTS: &str = concat!(
    include_str!("page/draw.js"),
    include_str!("page/plot.js"),
    include_str!("page/pointing.js"),
    include_str!("page/state.js"),
    include_str!("page/ask.js"),
    include_str!("page/views.js"),
    include_str!("page/controls.js"),
    include_str!("page/save.js"),
    include_str!("page/machine.js"),
    include_str!("page/diagram.js"),
    include_str!("page/plane.js"),
    include_str!("page/basins.js"),
    include_str!("page/local.js"),
    include_str!("page/verdict.js"),
    include_str!("page/loads.js"),
    include_str!("page/stories.js"),
    include_str!("page/explore.js"),
);

/// Script that inserts the live part into the element with an identifier.
pub fn mounting(element: &str, transport: Transport<'_>, model: &PageModel) -> String {
    let transport = match transport {
        Transport::Server { base, .. } => format!("Explore.server(\"{base}\")"),
        Transport::Module(module) => format!("Explore.module(\"{module}\")"),
        Transport::Element(id) => format!("Explore.module(document.getElementById(\"{id}\").textContent)"),
    };
    format!(
        "\"use strict\";\nExplore.models = {};\nExplore.app = Explore.mount(document.getElementById(\"{element}\"), {{ transport: {transport}, model: {} }});",
        in_script(&tour_models()),
        in_script(model)
    )
}

/// Writes a value for a script. The text of a model must not end the script.
fn in_script(value: &impl Serialize) -> String {
    serde_json::to_string(value).unwrap_or_default().replace('<', "\\u003c")
}

/// Texts of the models in the guided tours, besides the paper's, by file name.
pub fn tour_models() -> BTreeMap<&'static str, String> {
    let valve = ModelTemplate::of("table").map(|template| template.whole().replace(TEMPLATE_NAME, "valve"));
    BTreeMap::from([
        ("valve.toml", valve.unwrap_or_default()),
        ("dangerous.toml", include_str!("page/dangerous.toml").to_owned()),
    ])
}

/// Builds the whole page.
pub fn page(transport: Transport<'_>, model: &PageModel, words: PageWords<'_>) -> String {
    let title = words.title.replace('&', "&amp;").replace('<', "&lt;");
    let nonce = match transport {
        Transport::Server { nonce, .. } => format!(" nonce=\"{nonce}\""),
        Transport::Module(_) | Transport::Element(_) => String::new(),
    };
    let parts = [
        ("title", title.as_str()),
        ("nonce", &nonce),
        ("version", words.version),
        ("still", words.still),
        ("footer", words.footer),
        ("style", STYLE),
        ("scripts", SCRIPTS),
        ("mount", &mounting("explore", transport, model)),
    ];
    filled(PAGE, &parts)
}

/// Replaces each `{{name}}` in a text once; inserted text is not searched again.
fn filled(text: &str, parts: &[(&str, &str)]) -> String {
    let mut pieces = text.split("{{");
    let mut page = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        let (name, rest) = piece.split_once("}}").unwrap_or((piece, ""));
        page.push_str(parts.iter().find(|(part, _)| *part == name).map_or("", |(_, text)| text));
        page.push_str(rest);
    }
    page
}
