//! `corner-impact claims [MODEL]`.

use super::{AnswerArguments, CommandError, Exit, ModelArgument, Session, progress::Progress};
use crate::pages;
use crate::show::{Page, markdown};
use corner_impact::cam::Cam;
use corner_impact::json;
use corner_impact::known::Evidence;
use corner_impact::paper::{Claims, Context};
use corner_impact::published::Verdict;
use corner_impact::study::verify::{External, verify_watched};

/// Prints the paper's statements, each with a verdict.
///
/// The statements are those of the paper's source on arXiv. Each verdict has its evidence.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n\
    \x20 corner-impact claims\n\
    \x20 corner-impact claims models/damped-light.toml --json\n\
    \x20 corner-impact claims --verdict refuted --known computed\n\
    \n\
    With a model other than the paper's, statements about the paper's own numbers are open.\n\
    Exit code: 0 every check confirms the ledger's verdict, 1 a check contradicts it, 2 bad model file.")]
pub(super) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    #[command(flatten)]
    answer: AnswerArguments,
    /// Print only statements with this verdict: holds, in-part, misprint, refuted, open, definition.
    #[arg(long, value_parser = named::<Verdict>, conflicts_with = "markdown")]
    verdict: Option<Verdict>,
    /// Print only statements with this kind of evidence: proved, computed, sampled, read.
    #[arg(long, value_parser = named::<Evidence>, conflicts_with = "markdown")]
    known: Option<Evidence>,
    /// Print the page of docs/claims.md.
    #[arg(long)]
    markdown: bool,
}

/// Parses a value by its name in documents.
fn named<T: serde::de::DeserializeOwned>(name: &str) -> Result<T, String> {
    serde_json::from_value(name.into()).map_err(|error| match error.to_string().split_once("expected one of ") {
        Some((_, names)) => format!("must be one of {}", names.replace('`', "")),
        None => "this name is unknown".into(),
    })
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let model = arguments.model.read(session)?;
    let progress = Progress::spinner("verifying the model");
    let findings = verify_watched(&model, External::LeftOut, &progress)?;
    let cam = Cam::new(&model)?;
    let context = Context::new(&model, &cam, &findings)?;
    let mut claims = Claims::hold(&context, &progress)?;
    drop(progress);
    claims.claims.retain(|claim| {
        arguments.verdict.is_none_or(|verdict| claim.verdict == verdict)
            && arguments.known.is_none_or(|known| claim.known == known)
    });
    let page = match (arguments.answer.json, arguments.markdown) {
        (true, _) => json::render(&claims, &model.units)?,
        (_, true) => {
            let (lead, sections) = pages::claims::document(&claims)?;
            markdown::page(&lead, &sections)?
        }
        _ => session.shown(&Page::of(session.width(), arguments.answer.all, &pages::claims::terminal(&claims))?),
    };
    session.print(&page)?;
    Ok(if claims.agrees { Exit::Agrees } else { Exit::Disagrees })
}
