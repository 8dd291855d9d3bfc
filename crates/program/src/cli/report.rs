//! `corner-impact report [MODEL]`.

use std::io::Write;
use std::path::{Path, PathBuf};

use super::external::ExternalArguments;
use super::numbers::rpm_range;
use super::picture::{LookArguments, ends_in};
use super::progress::watched;
use super::{CommandError, Exit, ModelArgument, Session};
use crate::live;
use crate::pages::report::html;
use crate::report::Report;
use corner_impact::file::Output;
use corner_impact::json;
use corner_impact::model::{Model, ModelError};

/// Writes all results for a model as one HTML page.
///
/// A browser opens the page from disk.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n\
    \x20 corner-impact report\n\
    \x20 corner-impact report models/sharp-nose.toml --rpm 200:300 --out page.html\n\
    \n\
    The page needs no network and no other file. The program prints its name.\n\
    It begins with the answer: where the follower separates from the cam, how hard it hits, where motions coexist, what is proved.\n\
    Below each figure is the command that writes it alone. `corner-impact figure`, `speeds` and `design` take --height and --script.\n\
    Exit code: 0 everything checked agrees, 1 something disagrees, 2 bad model file, usage or file.")]
pub(super) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    /// File of the page; - is standard output [default: the model file's name with -report.html, in this folder].
    #[arg(long, value_name = "FILE", value_parser = page, group = "picture")]
    out: Option<PathBuf>,
    #[command(flatten)]
    look: LookArguments,
    /// Print one JSON document. The page is then written only if --out names it.
    #[arg(long)]
    json: bool,
    /// Open the page after writing it.
    #[arg(long, conflicts_with = "json")]
    open: bool,
    /// Lowest and highest speed of the answer [default: from below the speed at which the follower first leaves the cam to the end of the model's [study].
    /// Without a [study] it ends at twice that speed, or at twice the spring's own speed if the follower never leaves].
    #[arg(long, value_name = "LO:HI", value_parser = rpm_range, allow_hyphen_values = true)]
    rpm: Option<[f64; 2]>,
    #[command(flatten)]
    external: ExternalArguments,
}

/// Parses the file name of a page, for clap.
pub(super) fn page(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let is_page = path.extension().is_none() || ends_in(&path, &["html", "htm"]);
    if is_page { Ok(path) } else { Err("must end in .html, or be -".into()) }
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    if arguments.json && arguments.out.as_deref() == Some(Path::new("-")) {
        return Err(CommandError::Words("--json and --out - both print to standard output".into()));
    }
    let model = arguments.model.read(session)?;
    let path = match (&arguments.out, arguments.json) {
        (Some(path), _) => Some(path.clone()),
        (None, true) => None,
        (None, false) => Some(default_name(&model)?),
    };
    session.wishes.file = path.clone();
    let look = arguments.look.look()?;
    if let (Some(_), Err(why)) = (&path, live::module()) {
        session.note(&format!("the pictures of the page will not be live: {why}"));
    }
    // The file is begun before the work, so that an impossible name is reported at once.
    let file = match &path {
        Some(path) => Some(Output::create(path, &mut *session.out)?),
        None => None,
    };
    let mut report = watched("looking for the corner impact", |watch| {
        Report::of(&model, arguments.external.routes(), arguments.rpm, watch)
    })?;
    let document = arguments.json.then(|| json::render(&report, &model.units)).transpose()?;
    report.look = look.unwrap_or_default();
    let write = |mut file: Output<'_>| {
        let page = html::render(&report)?;
        file.write_all(page.as_bytes())?;
        Ok::<(), CommandError>(file.commit()?)
    };
    file.map(write).transpose()?;
    for route in report.failed() {
        session.complain(&format!("{route} did not run; the page says why"));
    }
    match (document, &path) {
        (Some(document), _) => session.print(&document)?,
        (None, Some(path)) if path.as_path() != Path::new("-") => session.print(&format!("{}\n", path.display()))?,
        _ => {}
    }
    Ok(if report.agrees { Exit::Agrees } else { Exit::Disagrees })
}

/// Default name of the page, from the model file and the changed numbers, in the current folder.
fn default_name(model: &Model) -> Result<PathBuf, ModelError> {
    let mut name = match model.path().and_then(Path::file_stem) {
        Some(stem) => stem.to_string_lossy().into_owned(),
        None => Model::built_in()?.name,
    };
    for (path, number) in model.changes() {
        name = format!("{name}-{path}-{number}");
    }
    Ok(PathBuf::from(format!("{name}-report.html")))
}
