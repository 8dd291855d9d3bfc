//! `corner-impact explain WHAT [MODEL]`.

use super::external::ExternalArguments;
use super::model::is_file_name;
use super::{AnswerArguments, CommandError, Exit, ModelArgument, Session, progress::watched};
use crate::explain::{Findings, Links};
use crate::show::Page;
use crate::show::block::{Block, words};
use corner_impact::command::shell_word;
use corner_impact::study::verify::{External, verify_watched};

/// Explains a name, with its formula and evidence.
///
/// The page has the inputs of the formula, its value by every route and the kind of evidence. It names the code, the proof and the tests.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n\
    \x20 corner-impact explain B_minus\n\
    \x20 corner-impact explain eq:PT models/damped-light.toml --no-external\n\
    \x20 corner-impact explain CAM_JUMP --json\n\
    \x20 corner-impact explain --list\n\
    \n\
    WHAT is a number as `verify` names it, a label or a claim of the paper, a tolerance, a field of the model, or a column of \
    a file.\n\
    Exit code: 0 done, 2 bad model file or unknown name.")]
pub(super) struct Arguments {
    /// Name to explain, such as B_minus, eq:PT, feigin, CAM_JUMP, growth_rate or follower.mass.
    #[arg(required_unless_present = "list")]
    what: Option<String>,
    #[command(flatten)]
    model: ModelArgument,
    /// List every name with its meaning.
    #[arg(long, conflicts_with_all = ["what", "json"])]
    list: bool,
    #[command(flatten)]
    answer: AnswerArguments,
    #[command(flatten)]
    external: ExternalArguments,
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let links = Links::read()?;
    let Some(what) = arguments.what.as_ref().filter(|_| !arguments.list) else {
        let entry = |(name, sentence)| (words![format!("{name}: ")], words![sentence]);
        let entries = links.names().into_iter().map(entry).collect();
        let page = session.shown(&Page::of(session.width(), false, &[Block::Entries(0, entries)])?);
        session.print(&page)?;
        return Ok(Exit::Agrees);
    };
    let swapped = arguments.model.file().filter(|file| is_file_name(what) && !file.exists());
    if let Some(file) = swapped {
        let (file, model) = (file.display(), shell_word(what));
        return Err(CommandError::Words(format!("the name comes first: corner-impact explain {file} {model}")));
    }
    let model = arguments.model.read_as_drawn(session)?;
    let needed = links.needs(what, &model)?;
    let verified = needed
        .map(|external| if external == External::Run { arguments.external.routes() } else { external })
        .map(|external| watched("verifying the model", |watch| verify_watched(&model, external, watch)))
        .transpose()
        .map_err(|error| session.note(&format!("no values: {error}")));
    let found = verified.ok().flatten();
    let explanation = links.explain(what, &Findings::new(&model, found.as_ref())?)?;
    session.answer(&explanation, &arguments.answer)
}
