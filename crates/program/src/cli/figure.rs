//! `corner-impact figure [MODEL] [ID]`.

use std::path::{Path, PathBuf};

use super::model::{Changes, is_file_name};
use super::numbers::rpm_range;
use super::progress::{Progress, watched};
use super::{CommandError, Exit, ModelArgument, Session, picture};
use crate::figures::{Entry, FIGURES, FigureContext, FigureList, Listed, OneFigure, RenderedFigure};
use crate::show::Page;
use crate::show::block::{Block, Column, Table, Words};
use crate::show::page::WIDTH;
use corner_impact::json;
use corner_impact::model::{Model, nearest};
use corner_impact::untrusted;

/// Lists the figures of the report, or draws one.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n\
    \x20 corner-impact figure\n\
    \x20 corner-impact figure fast-impacts --out fast-impacts.svg\n\
    \x20 corner-impact figure models/damped-heavy.toml composition --out composition.png\n\
    \n\
    Exit code: 0 done, 2 bad model file, usage or file, or a figure that this model does not have.")]
pub(super) struct Arguments {
    /// Model file (TOML) [default: the paper's model], then the name of the figure to draw. A word with a dot or a slash is a file.
    #[arg(value_name = "MODEL] [ID", num_args = 0..=2)]
    words: Vec<String>,
    #[command(flatten)]
    changes: Changes,
    /// Range of speeds of the figures that need no corner impact [default: chosen for the machine].
    #[arg(long, value_name = "LO:HI", value_parser = rpm_range, allow_hyphen_values = true)]
    rpm: Option<[f64; 2]>,
    /// Write the picture (.svg, .png or .pdf).
    #[arg(long, value_name = "FILE", value_parser = picture::picture, group = "picture")]
    out: Option<PathBuf>,
    #[command(flatten)]
    picture: picture::PictureArguments,
    /// Print one JSON document: the list, or the figure with every number that it shows.
    #[arg(long)]
    json: bool,
}

/// Splits one or two words into a model file and a figure's name.
fn named(words: &[String]) -> Result<(Option<&str>, Option<&str>), CommandError> {
    match words {
        [] => Ok((None, None)),
        [word] if is_file_name(word) => Ok((Some(word), None)),
        [word] => Ok((None, Some(word))),
        [model, id] => Ok((Some(model), Some(id))),
        _ => Err(CommandError::Words("too many words: give a model file and a figure at most".into())),
    }
}

/// The figure of this name.
fn entry(id: &str) -> Result<&'static Entry, CommandError> {
    let ids = || FIGURES.iter().map(|entry| entry.id);
    FIGURES.iter().find(|entry| entry.id == id).ok_or_else(|| {
        let meant = nearest(id, ids()).map_or(String::new(), |meant| format!("did you mean {meant}? "));
        let there = ids().collect::<Vec<_>>().join(", ");
        CommandError::Words(format!("no figure called \"{}\"; {meant}there are: {there}", untrusted::value(id)))
    })
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let (file, id) = named(&arguments.words)?;
    let model = ModelArgument::of(file.map(Path::new), &arguments.changes).read_as_drawn(session)?;
    if id.is_none() && arguments.out.is_some() {
        return Err(CommandError::Words(
            "--out writes one figure: add its name; `corner-impact figure` lists the names".into(),
        ));
    }
    let entry = id.map(entry).transpose()?;
    if let (Some(Entry { id, takes_rpm: false, .. }), Some([low, high])) = (entry, arguments.rpm) {
        let others: Vec<&str> = FIGURES.iter().filter(|entry| entry.takes_rpm).map(|entry| entry.id).collect();
        return Err(CommandError::Words(format!(
            "{id} has fixed speeds: --rpm is for {}; `diagram --rpm {low}:{high} --out FILE.svg` draws impacts at other speeds",
            others.join(", ")
        )));
    }
    let subject = watched("verifying the model", |_| FigureContext::new(&model, arguments.rpm))?;
    let page = match entry {
        None => list(&model, &subject, arguments.json, session)?,
        Some(entry) => {
            // Opened before the work, so that an impossible name is reported at once.
            let canvas = arguments
                .out
                .as_deref()
                .map(|path| picture::Canvas::create(path, arguments.picture.request()?))
                .transpose()?;
            let progress = Progress::spinner("computing the figure");
            let plate = entry.plate(&subject);
            drop(progress);
            match (&plate.drawn, canvas) {
                (Ok(drawn), Some(canvas)) => canvas.write(drawn.figure.clone(), &model.units)?,
                // A document contains the reason for a missing figure; a file cannot.
                (Err(_), None) if arguments.json => {}
                (Err(why), _) => {
                    return Err(CommandError::Words(format!("{}: no figure {}: {why}", model.file(), entry.id)));
                }
                (Ok(_), None) => {}
            }
            one(&subject, plate, arguments, session)?
        }
    };
    session.print(&page)?;
    Ok(Exit::Agrees)
}

fn list(model: &Model, subject: &FigureContext, as_json: bool, session: &Session<'_>) -> Result<String, CommandError> {
    let found = FigureList::new(subject);
    if as_json {
        return Ok(json::render(&found, &model.units)?);
    }
    // Titles fit into one line beside their names, or beside names and places.
    let has_places = session.width() >= WIDTH;
    let heads = ["figure", "in the paper", "shows"].into_iter().filter(|head| has_places || *head != "in the paper");
    let mut table = Table::new("Figures", heads.map(Column::words).collect::<Vec<_>>());
    let name = format!("{}: ", model.name);
    for Listed { id, place, title } in found.figures {
        let title = title.strip_prefix(&name).unwrap_or(&title);
        let cells = [id, place, title].into_iter().filter(|cell| has_places || *cell != place);
        table.row(cells.map(Words::from).collect::<Vec<_>>());
    }
    let title = Block::Title(format!("Figures of {}", model.name).into());
    Ok(session.shown(&Page::of(session.width(), false, &[title, Block::Table(table)])?))
}

fn one(
    subject: &FigureContext,
    plate: RenderedFigure,
    arguments: &Arguments,
    session: &Session<'_>,
) -> Result<String, CommandError> {
    if arguments.json {
        return Ok(json::render(&OneFigure::new(subject, plate), &subject.model.units)?);
    }
    let of = match (plate.place, subject.is_paper) {
        ("", _) => String::new(),
        (place, true) => format!(" ({place} of the paper)"),
        (place, false) => format!(" (as {place} of the paper)"),
    };
    let caption = plate.drawn.map(|drawn| drawn.caption).unwrap_or_default();
    let mut blocks = vec![Block::Line(format!("{}{of}", plate.title).into()), Block::paragraph(caption)];
    if arguments.out.is_none() {
        blocks.extend([Block::paragraph("To draw it:"), Block::Command(plate.command)]);
    }
    Ok(session.shown(&Page::of(session.width(), false, &blocks)?))
}
