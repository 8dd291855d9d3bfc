//! The argument that most subcommands take: which model.

use std::path::{Path, PathBuf};

use super::picture::ends_in;
use super::{CommandError, progress::watched, session::Session};
use crate::show::command::{changed, named, shell_word};
use crate::show::notes;
use corner_impact::model::{Model, Numeral, Units, finite, parted};
use corner_impact::orbit::Parameter;
use corner_impact::untrusted;

/// Which model a command is about.
#[derive(clap::Args)]
pub(super) struct ModelArgument {
    /// Model file (TOML), or a table of lifts (.csv) [default: the paper's model, osorio-2008, which is built in].
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

/// What is not assumed of a follower, with what it is in beside a table of lifts.
const NEEDED: [(&str, &str); 3] = [("mass", "kg"), ("stiffness", "N/mm"), ("preload", "N")];

/// The heading of these options in `--help`.
const FOLLOWER: &str = "The follower (a table of lifts needs the first three)";

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
    /// The options as they are typed, each after a blank; those that a table needs with what they are in, where they are missing.
    fn typed(&self) -> String {
        let needed =
            |name: &str| NEEDED.iter().find(|(needed, _)| *needed == name).map(|(_, unit)| unit.to_uppercase());
        let option = |(name, number): (&str, Option<&String>)| {
            let value = number.map(|number| shell_word(number)).or_else(|| needed(name))?;
            Some(format!(" --{name} {value}"))
        };
        self.all().into_iter().filter_map(option).collect()
    }

    /// Each name, with what is typed for it.
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

    /// The model with the numbers changed, in its own units.
    pub(super) fn of(&self, model: &Model) -> Result<Model, CommandError> {
        let own = |change: Change| -> Result<(String, Numeral), CommandError> {
            let path = if change.unit.is_empty() { "" } else { model.path_of(&change.name, &[])? };
            Ok((change.name.clone(), change.inside(path, &model.units)?))
        };
        let numbers: Vec<_> = self.all()?.into_iter().map(own).collect::<Result<_, _>>()?;
        Ok(model.changed(&numbers)?)
    }
}

/// `NAME=VALUE`.
fn change(text: &str) -> Result<Change, String> {
    let (name, number) =
        text.split_once('=').ok_or("must be NAME=VALUE: a number of the model, and what it is to be")?;
    number_of(name, number)
}

/// A number as it is typed. A unit is held against the model's once that is read.
fn number_of(name: &str, number: &str) -> Result<Change, String> {
    let (text, unit) = parted(number);
    let unit = if unit.starts_with(',') { "" } else { unit };
    let number = Numeral { number: finite(number, unit)?, text: text.into() };
    Ok(Change { name: name.trim().into(), number, unit: unit.into() })
}

impl Change {
    /// The number in the unit that a model has for this path.
    fn inside(self, path: &str, units: &Units) -> Result<Numeral, CommandError> {
        let Self { name, number, unit } = self;
        if unit.is_empty() {
            return Ok(number);
        }
        match units.in_own(path, number.number, &unit) {
            Some(value) if value == number.number => Ok(number),
            Some(value) => Ok(value.into()),
            None => {
                let own = units.of_number(path);
                let own = if own.is_empty() {
                    "is a number without a unit".into()
                } else {
                    format!("is in {own} in this model")
                };
                Err(CommandError::Words(format!("{name} = {} {}: {name} {own}", number.text, untrusted::value(&unit))))
            }
        }
    }
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
            Some(path) if ends_in(path, &TABLES) => {
                let text = assumed(path, &mut changes, needs_follower)?;
                let file = path.with_extension("toml");
                session.note(&format!(
                    "no model file: this one is assumed; save it as {} to change it\n{text}",
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
        session.named = match self.file.as_deref().filter(|path| ends_in(path, &TABLES)) {
            Some(table) => {
                let file = format!(" {}", shell_word(&table.to_string_lossy()));
                file + &self.changes.follower.typed() + &changed(&model)
            }
            None => named(&model),
        };
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

/// Extensions of tables of lifts, which stand in place of a model file.
pub(super) const TABLES: [&str; 4] = ["csv", "tsv", "txt", "dat"];

/// The model file that is assumed for a table of lifts and the numbers of a follower, which are taken out of the changes.
fn assumed(table: &Path, changes: &mut Changes, needs_follower: bool) -> Result<String, CommandError> {
    const MODEL: &str = include_str!("templates/assumed.toml");
    let is_of_follower = |change: &Change| {
        let name = change.name.strip_prefix("follower.").unwrap_or(&change.name);
        FollowerNumbers::default().all().iter().any(|(known, _)| *known == name)
    };
    let (given, others): (Vec<Change>, Vec<Change>) = changes.all()?.into_iter().partition(is_of_follower);
    let of = |name: &str| given.iter().rfind(|change| change.name.trim_start_matches("follower.") == name);
    let missing: Vec<String> =
        NEEDED.iter().filter(|(name, _)| of(name).is_none()).map(|(name, unit)| format!("--{name} ({unit})")).collect();
    if needs_follower && !missing.is_empty() {
        let words = format!("{}: a table of lifts has no follower: give {}", table.display(), missing.join(", "));
        return Err(CommandError::Words(words));
    }
    *changes = Changes { numbers: others, follower: FollowerNumbers::default() };
    let (file, stem) = (table.file_name(), table.file_stem());
    // TOML escapes as JSON does.
    let [file, stem] =
        [file, stem].map(|name| serde_json::Value::from(name.unwrap_or_default().to_string_lossy()).to_string());
    // Units do not hang on the cam.
    let (head, _) = MODEL.split_once("[cam]").unwrap_or((MODEL, ""));
    let cam = "[cam]\nlaw = \"harmonic\"\noffset = 0.0\namplitudes = [1.0]\nphases_deg = [0.0]\n";
    let units = Model::parse("units", &format!("{head}{cam}"))?.units;
    let line = |line: &str| -> Result<String, CommandError> {
        let Some((name, rest)) = line.split_once(" = ") else { return Ok(line.to_owned()) };
        let Some(change) = of(name).filter(|_| rest.ends_with("assumed")) else { return Ok(line.to_owned()) };
        let number = change.clone().inside(&format!("follower.{name}"), &units)?;
        let unit =
            rest.split_once("# ").map_or("", |(_, unit)| unit.trim_end_matches("assumed").trim_end_matches(", "));
        let told = format!("{name} = {:?}", number.number);
        Ok(format!("{told:<18}# {unit}").trim_end_matches(['#', ' ']).to_owned())
    };
    let text = MODEL.replace("\"lifts.csv\"", &file).replace("\"my-machine\"", &stem);
    let lines: Vec<String> = text.lines().map(line).collect::<Result<_, _>>()?;
    Ok(lines.join("\n") + "\n")
}
