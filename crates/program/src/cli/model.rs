//! The argument that most subcommands take: which model.

use std::path::{Path, PathBuf};

use super::picture::ends_in;
use super::{CommandError, progress::watched, session::Session};
use crate::show::{command::named, notes};
use corner_impact::model::{Model, Numeral, finite, parted};
use corner_impact::orbit::Parameter;
use corner_impact::untrusted;

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
    numbers: Vec<Change>,
    #[command(flatten)]
    follower: FollowerNumbers,
}

const FOLLOWER: &str = "The follower, as by --set; a table of lifts needs the first three";

/// Numbers of the follower: each the same as `--set`, and what a table of lifts has to have beside it.
#[derive(clap::Args, Clone, Default)]
struct FollowerNumbers {
    /// Mass that moves, and a third of the spring.
    #[arg(long, value_name = "VALUE", help_heading = FOLLOWER, allow_hyphen_values = true)]
    mass: Option<String>,
    /// Stiffness of the spring.
    #[arg(long, value_name = "VALUE", help_heading = FOLLOWER, allow_hyphen_values = true)]
    stiffness: Option<String>,
    /// Force of the spring on the base circle.
    #[arg(long, value_name = "VALUE", help_heading = FOLLOWER, allow_hyphen_values = true)]
    preload: Option<String>,
    /// Damping.
    #[arg(long, value_name = "VALUE", help_heading = FOLLOWER, allow_hyphen_values = true)]
    damping: Option<String>,
    /// Velocity after an impact over that before, 0 to 1.
    #[arg(long, value_name = "VALUE", help_heading = FOLLOWER, allow_hyphen_values = true)]
    restitution: Option<String>,
    /// Gravity along the follower.
    #[arg(long, value_name = "VALUE", help_heading = FOLLOWER, allow_hyphen_values = true)]
    gravity: Option<String>,
}

impl FollowerNumbers {
    fn all(&self) -> [(&'static str, Option<&String>); 6] {
        let Self { mass, stiffness, preload, damping, restitution, gravity } = self;
        let all = [
            ("mass", mass),
            ("stiffness", stiffness),
            ("preload", preload),
            ("damping", damping),
            ("restitution", restitution),
            ("gravity", gravity),
        ];
        all.map(|(name, number)| (name, number.as_ref()))
    }
}

/// A number of the model, and what it is to be.
#[derive(Clone)]
struct Change {
    name: String,
    number: Numeral,
    /// The unit that was typed after it; empty for none.
    unit: String,
}

impl Changes {
    /// All numbers that are given, in either way.
    fn all(&self) -> Result<Vec<Change>, CommandError> {
        let named = |(name, text): (&str, Option<&String>)| {
            let change = number_of(&format!("follower.{name}"), text?);
            Some(change.map_err(|words| CommandError::Words(format!("--{name}: {words}"))))
        };
        let own = self.follower.all().into_iter().filter_map(named);
        self.numbers.iter().cloned().map(Ok).chain(own).collect()
    }

    /// The model with the numbers changed. A unit that was typed must be the model's.
    pub(super) fn of(&self, model: &Model) -> Result<Model, CommandError> {
        let changes = self.all()?;
        for Change { name, number, unit } in changes.iter().filter(|change| !change.unit.is_empty()) {
            let own = model.units.of_number(model.path_of(name, &[])?);
            let is_same = unit.replace(' ', "") == own.replace(' ', "");
            if !is_same {
                let own = if own.is_empty() {
                    "is a number without a unit".to_owned()
                } else {
                    format!("is in {own} in this model")
                };
                let words = format!("--set {name}={} {}: {name} {own}", number.text, untrusted::value(unit));
                return Err(CommandError::Words(words));
            }
        }
        let numbers: Vec<_> = changes.into_iter().map(|Change { name, number, .. }| (name, number)).collect();
        Ok(model.changed(&numbers)?)
    }
}

/// `NAME=VALUE`.
fn change(text: &str) -> Result<Change, String> {
    let (name, number) =
        text.split_once('=').ok_or("must be NAME=VALUE: a number of the model, and what it is to be")?;
    number_of(name, number)
}

fn number_of(name: &str, number: &str) -> Result<Change, String> {
    let (text, unit) = parted(number);
    // A unit is compared with the model's once that is read.
    let unit = if unit.starts_with(',') { "" } else { unit };
    Ok(Change {
        name: name.trim().into(),
        number: Numeral { number: finite(number, unit)?, text: text.into() },
        unit: unit.into(),
    })
}

impl ModelArgument {
    /// The model in a file, or the one that is built in, with some numbers changed.
    pub(super) fn of(file: Option<&Path>, changes: &Changes) -> Self {
        Self { file: file.map(Path::to_path_buf), changes: changes.clone() }
    }

    /// A number that an option goes through the values of; refused where --set gives it one.
    pub(super) fn varied(&self, model: &Model, name: &str, option: &str) -> Result<Parameter, CommandError> {
        let parameter = Parameter::named(model, name)?;
        let changes = self.changes.all()?;
        let set = changes.iter().map(|change| Parameter::named(model, &change.name));
        if set.collect::<Result<Vec<_>, _>>()?.contains(&parameter) {
            let name = parameter.name();
            let words = format!("--set {name}: no point would have that value, as {option} goes through others");
            return Err(CommandError::Words(words));
        }
        Ok(parameter)
    }

    /// Reads the model; says on standard error which one it is where none is named.
    pub(super) fn read(&self, session: &mut Session<'_>) -> Result<Model, CommandError> {
        self.read_with(session, true)
    }

    /// Reads the model for a command that needs no follower.
    pub(super) fn read_cam(&self, session: &mut Session<'_>) -> Result<Model, CommandError> {
        self.read_with(session, false)
    }

    fn read_with(&self, session: &mut Session<'_>, needs_follower: bool) -> Result<Model, CommandError> {
        let mut changes = self.changes.clone();
        let model = match &self.file {
            Some(path) if ends_in(path, &["csv"]) => {
                let text = assumed(path, &changes.follower, needs_follower)?;
                // The follower is in the text.
                changes.follower = FollowerNumbers::default();
                let file = path.with_extension("toml");
                session.note(&format!(
                    "no model file: this one is assumed; saved as {}, it can be changed\n{text}",
                    file.display()
                ));
                watched("reading the table", |_| Model::parse(&file.to_string_lossy(), &text))?
            }
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
        let model = changes.of(&model)?;
        session.units = model.units.clone();
        session.model = model.name.clone();
        session.named = named(&model);
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

/// The model file that is assumed for a table of lifts and the numbers of a follower.
fn assumed(table: &Path, follower: &FollowerNumbers, needs_follower: bool) -> Result<String, CommandError> {
    const MODEL: &str = include_str!("templates/assumed.toml");
    /// What cannot be assumed, and what is where nothing is said.
    const NEEDED: [&str; 3] = ["mass", "stiffness", "preload"];
    let given = follower.all();
    let missing: Vec<&str> =
        given.iter().filter(|(name, text)| NEEDED.contains(name) && text.is_none()).map(|(name, _)| *name).collect();
    if needs_follower && !missing.is_empty() {
        let options: Vec<String> = missing.iter().map(|name| format!("--{name}")).collect();
        let words = format!(
            "{}: a table of lifts has no follower: give {} (kg, N/mm and N), or a model file, which `corner-impact new --law table` writes",
            table.display(),
            options.join(", ")
        );
        return Err(CommandError::Words(words));
    }
    let (file, stem) = (table.file_name(), table.file_stem());
    let [file, stem] =
        [file, stem].map(|name| serde_json::Value::from(name.unwrap_or_default().to_string_lossy()).to_string());
    let mut text = MODEL.replace("\"lifts.csv\"", &file).replace("\"my-machine\"", &stem);
    for (name, number) in given {
        let Some(number) = number else { continue };
        let change = number_of(name, number).map_err(|words| CommandError::Words(format!("--{name}: {words}")))?;
        // [units] has a stiffness, too, before that of the follower.
        let line = text.lines().rfind(|line| line.starts_with(&format!("{name} = "))).map(str::to_owned);
        let unit = line.as_deref().and_then(|line| line.split_once("# ")).map_or("", |(_, unit)| unit.trim());
        if !change.unit.is_empty() && change.unit != unit {
            return Err(CommandError::Words(format!("--{name} {number}: {name} is in {unit} here")));
        }
        if let Some(line) = &line {
            let told = format!("{name} = {:?}", change.number.number);
            text = text.replace(line, format!("{told:<18}# {unit}").trim_end_matches(['#', ' ']));
        }
    }
    Ok(text)
}
