//! `corner-impact new [FILE]`.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::ValueEnum;

use super::{CommandError, Exit, Session};
use corner_impact::command::shell_word;
use corner_impact::file::{self, Output};

/// Writes a commented model file to start from.
///
/// Every field has its unit and what it may be.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n\
    \x20 corner-impact new my-machine.toml\n\
    \x20 corner-impact new --law program\n\
    \n\
    Every file that it writes loads as it stands; `verify` takes those of arcs, program and polynomial.\n\
    Exit code: 0 done, 2 bad usage, or a file that is there already or cannot be written.")]
pub(super) struct Arguments {
    /// The file to write; - is standard output.
    #[arg(value_name = "FILE", default_value = "-")]
    file: PathBuf,
    /// How the cam's lift is written down.
    #[arg(long, value_enum, default_value = "arcs")]
    law: Law,
    /// Write over a file that is there.
    #[arg(long)]
    force: bool,
}

/// The lift laws, each with a template.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Law {
    Arcs,
    Harmonic,
    RectifiedSine,
    Program,
    Polynomial,
    Table,
    Contour,
}

const FOLLOWER: &str = include_str!("templates/follower.toml");
const STUDY: &str = include_str!("templates/study.toml");
/// Name of the machine in the templates.
const NAME: &str = "my-machine";

impl Law {
    fn cam(self) -> &'static str {
        match self {
            Self::Arcs => include_str!("templates/arcs.toml"),
            Self::Harmonic => include_str!("templates/harmonic.toml"),
            Self::RectifiedSine => include_str!("templates/rectified-sine.toml"),
            Self::Program => include_str!("templates/program.toml"),
            Self::Polynomial => include_str!("templates/polynomial.toml"),
            Self::Table => include_str!("templates/table.toml"),
            Self::Contour => include_str!("templates/contour.toml"),
        }
    }

    /// The name and the text of the table that the template names.
    fn table(self) -> Option<(&'static str, &'static str)> {
        match self {
            Self::Table => Some(("lifts.csv", include_str!("templates/lifts.csv"))),
            Self::Contour => Some(("contour.csv", include_str!("templates/contour.csv"))),
            _ => None,
        }
    }

    /// The model file; `verify` has something to look for where the cam has corners of order 2.
    fn template(self) -> String {
        // A measured cam comes with a follower of its size.
        let follower = if self.table().is_some() { "" } else { FOLLOWER };
        let study = if matches!(self, Self::Arcs | Self::Program | Self::Polynomial) { STUDY } else { "" };
        let text = [follower, self.cam(), study].concat();
        text.trim_end().to_owned() + "\n"
    }
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let (path, law) = (&arguments.file, arguments.law);
    if path.as_os_str() == "-" {
        session.print(&law.template())?;
        if let Some((table, _)) = law.table() {
            session.note(&format!("{table} is not written: give a FILE to have it beside the model"));
        }
        return Ok(Exit::Agrees);
    }
    // A name that TOML takes between quotes as it is names the machine and its table.
    let is_plain = |stem: &&str| stem.chars().all(|letter| letter.is_alphanumeric() || "-_. ".contains(letter));
    let stem = path.file_stem().and_then(|stem| stem.to_str()).filter(is_plain);
    let mut text = law.template().replace(NAME, stem.unwrap_or(NAME));
    let mut beside = None;
    if let Some((name, rows)) = law.table() {
        let table = stem.map_or(name.to_owned(), |stem| format!("{stem}.csv"));
        text = text.replace(name, &table);
        beside = Some((path.with_file_name(table), rows));
    }
    let mut files: Vec<(&Path, &str)> = vec![(path, &text)];
    files.extend(beside.iter().map(|(path, rows)| (&**path, *rows)));
    if let Some((there, _)) = files.iter().find(|(path, _)| path.is_file()).filter(|_| !arguments.force) {
        let words = format!("{}: is there already; --force writes over it", there.display());
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
