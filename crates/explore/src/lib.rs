//! Live page of corner-impact: one pure function from question to answer, and the page that sends the questions.
//!
//! A question names a model with changed numbers, and a view of it; the answer has the library's results, in the model's units. The
//! function reads no file and no clock, so it gives the same answer on a server and in a browser. [`respond`] takes and returns JSON.
//!
//! ```text
//!  page (HTML, CSS, JavaScript)
//!    │  question, JSON
//!    ▼
//!  server of the program   or   WebAssembly inside the page
//!    ▼
//!  respond → answer        the model, then the study of the library for the view
//! ```

mod answer;
mod diagram;
mod machine;
mod model;
mod motion;
mod page;
mod question;
mod refusal;

pub use answer::{PageAnswer, answer};
pub use page::{PageModel, PageWords, SCRIPTS, STYLE, Transport, mounting, page, tour_models};
pub use question::{ChangedModel, PageQuestion};
pub use refusal::PageRefusal;

use corner_impact::json;
use corner_impact::model::Units;

/// Answers a question, both as JSON. A question that cannot be read gets an answer with the reason.
pub fn respond(question: &str) -> String {
    let (answer, units) = match serde_json::from_str::<PageQuestion>(question) {
        Ok(question) => answer(&question),
        Err(error) => (PageAnswer::refused("", PageRefusal::of_words(format!("question: {error}"))), Units::default()),
    };
    // Answers contain only values that JSON can represent.
    json::compact(&answer, &units).unwrap_or_default()
}
