//! The argument that most subcommands take: which model.

use std::path::{Path, PathBuf};

use super::{CommandError, progress::watched, session::Session, start::finite};
use crate::show::notes;
use corner_impact::model::{Model, Numeral};
use corner_impact::orbit::Parameter;

/// Which model a command is about.
#[derive(clap::Args)]
pub(super) struct ModelArgument {
    /// Model file (TOML) [default: the paper's model, osorio-2008, which is built in].
    #[arg(value_name = "MODEL")]
    file: Option<PathBuf>,
    #[command(flatten)]
    changes: Changes,
}

/// Which numbers of the model are others than in its file.
#[derive(clap::Args, Clone, Default)]
pub(super) struct Changes {
    /// Take VALUE for a number of the model: restitution=0.7, or a whole path, follower.mass=2 (may be repeated).
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = change)]
    pub(super) numbers: Vec<(String, Numeral)>,
}

/// `NAME=VALUE`.
fn change(text: &str) -> Result<(String, Numeral), String> {
    let (name, number) =
        text.split_once('=').ok_or("must be NAME=VALUE: a number of the model, and what it is to be")?;
    Ok((name.trim().into(), Numeral { number: finite(number)?, text: number.trim().into() }))
}

impl ModelArgument {
    /// The model in a file, or the one that is built in, with some numbers changed.
    pub(super) fn of(file: Option<&Path>, changes: &Changes) -> Self {
        Self { file: file.map(Path::to_path_buf), changes: changes.clone() }
    }

    /// A number that an option goes through the values of; refused where --set gives it one.
    pub(super) fn varied(&self, model: &Model, name: &str, option: &str) -> Result<Parameter, CommandError> {
        let parameter = Parameter::named(model, name)?;
        let set = self.changes.numbers.iter().map(|(name, _)| Parameter::named(model, name));
        if set.collect::<Result<Vec<_>, _>>()?.contains(&parameter) {
            let name = parameter.name();
            let words = format!("--set {name}: no point would have that value, as {option} goes through others");
            return Err(CommandError::Words(words));
        }
        Ok(parameter)
    }

    /// Reads the model; says on standard error which one it is where none is named.
    pub(super) fn read(&self, session: &mut Session<'_>) -> Result<Model, CommandError> {
        let model = match &self.file {
            Some(path) => {
                // A table of a million lifts takes its time.
                watched("reading the model", |_| Model::read(path))?
            }
            None => {
                let model = Model::built_in()?;
                session.note(&format!("no MODEL given: using the paper's, {}, which is built in", model.name));
                model
            }
        };
        let model = model.changed(&self.changes.numbers)?;
        session.units = model.units.clone();
        session.model = model.name.clone();
        for words in notes::notes(&model, session.rpm)? {
            session.note(&words);
        }
        Ok(model)
    }

    /// Reads the model for a command that answers for the cam as drawn. Notes how accurately a measured cam is known.
    pub(super) fn read_as_drawn(&self, session: &mut Session<'_>) -> Result<Model, CommandError> {
        let model = self.read(session)?;
        if let Some(words) = notes::as_drawn(&model)? {
            session.note(&words);
        }
        Ok(model)
    }
}
