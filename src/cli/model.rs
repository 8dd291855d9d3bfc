//! The argument that most subcommands take: which model.

use std::path::{Path, PathBuf};

use super::{CommandError, progress::watched, session::Session};
use crate::model::Model;

/// Which model a command is about.
#[derive(clap::Args)]
pub(super) struct ModelArgument {
    /// Model file (TOML) [default: the paper's model, osorio-2008, which is built in].
    #[arg(value_name = "MODEL")]
    file: Option<PathBuf>,
}

impl ModelArgument {
    /// The model in a file, or the one that is built in.
    pub(super) fn of(file: Option<&Path>) -> Self {
        Self { file: file.map(Path::to_path_buf) }
    }

    /// Reads the model; says on standard error which one it is where none is named.
    pub(super) fn read(&self, session: &mut Session<'_>) -> Result<Model, CommandError> {
        match &self.file {
            Some(path) => {
                // A table of a million lifts takes its time.
                Ok(watched("reading the model", |_| Model::read(path))?)
            }
            None => {
                let model = Model::built_in()?;
                session.note(&format!("no MODEL given: using the paper's, {}, which is built in", model.name));
                Ok(model)
            }
        }
    }
}
