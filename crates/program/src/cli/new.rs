//! `corner-impact new [FILE]`.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::builder::PossibleValuesParser;

use super::{CommandError, Exit, Session};
use corner_impact::command::shell_word;
use corner_impact::file::{self, Output};
use corner_impact::model::{ModelTemplate, TEMPLATE_NAME, TEMPLATES};

/// Writes a commented model file to start from.
///
/// Every field has a comment with its unit and allowed values.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n\
    \x20 corner-impact new my-machine.toml\n\
    \x20 corner-impact new --law program\n\
    \n\
    Every file loads without changes. `verify` takes the laws arcs, program and polynomial.\n\
    Exit code: 0 done, 2 bad usage, or a file that exists already or cannot be written.")]
pub(super) struct Arguments {
    /// File to write; - is standard output.
    #[arg(value_name = "FILE", default_value = "-")]
    file: PathBuf,
    /// Law of the cam's lift.
    #[arg(long, default_value = "arcs", value_parser = PossibleValuesParser::new(TEMPLATES.iter().map(|template| template.law)))]
    law: String,
    /// Overwrite an existing file.
    #[arg(long)]
    force: bool,
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    // clap accepts no other name.
    let Some(law) = ModelTemplate::of(&arguments.law) else { return Ok(Exit::BadInput) };
    let path = &arguments.file;
    if path.as_os_str() == "-" {
        session.print(&law.text())?;
        if let Some((table, _)) = law.table {
            session.note(&format!("{table} is not written: give a FILE, and the table is written beside the model"));
        }
        return Ok(Exit::Agrees);
    }
    // A name that TOML accepts unchanged between quotes is used for the machine and its table.
    let is_plain = |stem: &&str| stem.chars().all(|letter| letter.is_alphanumeric() || "-_. ".contains(letter));
    let stem = path.file_stem().and_then(|stem| stem.to_str()).filter(is_plain);
    let mut text = law.text().replace(TEMPLATE_NAME, stem.unwrap_or(TEMPLATE_NAME));
    let mut beside = None;
    if let Some((name, rows)) = law.table {
        let table = stem.map_or(name.to_owned(), |stem| format!("{stem}.csv"));
        text = text.replace(name, &table);
        beside = Some((path.with_file_name(table), rows));
    }
    let mut files: Vec<(&Path, &str)> = vec![(path, &text)];
    files.extend(beside.iter().map(|(path, rows)| (&**path, *rows)));
    if let Some((there, _)) = files.iter().find(|(path, _)| path.is_file()).filter(|_| !arguments.force) {
        let words = format!("{}: the file exists already; --force overwrites it", there.display());
        return Err(CommandError::Words(words));
    }
    file::distinct(["the model", "its table"].into_iter().zip(files.iter().map(|(path, _)| *path)))?;
    let mut outputs = Vec::new();
    for (path, text) in &files {
        let mut output = Output::file(path)?;
        output.write_all(text.as_bytes())?;
        outputs.push(output);
    }
    Output::commit_all(outputs)?;
    session.named = format!(" {}", shell_word(&path.to_string_lossy()));
    for (path, _) in &files {
        session.note(&format!("wrote {}", path.display()));
    }
    Ok(Exit::Agrees)
}
