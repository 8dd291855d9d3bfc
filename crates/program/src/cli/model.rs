//! Argument of most subcommands: the model.

use std::path::{Path, PathBuf};

use clap::{Arg, ArgMatches, CommandFactory, FromArgMatches};

use super::picture::ends_in;
use super::{CommandError, progress::watched, session::Session};
use crate::show::notes;
use corner_impact::command::{changed, named, shell_word};
use corner_impact::model::{CONTACTS, Model, ModelError, ModelNumber, Numeral, Units, finite, nearest, parted};
use corner_impact::orbit::Parameter;
use corner_impact::untrusted;

/// Model that a command is about.
#[derive(clap::Args)]
pub(super) struct ModelArgument {
    /// Model file (TOML), or a table of lifts (.csv) [default: the paper's model, osorio-2008, which is built in].
    #[arg(value_name = "MODEL")]
    file: Option<PathBuf>,
    #[command(flatten)]
    changes: Changes,
}

/// Numbers of the model that replace those of its file.
#[derive(clap::Args, Clone, Default)]
pub(super) struct Changes {
    /// Set a number of the model to VALUE (repeatable). NAME is a number such as restitution, its full path such as follower.mass, or its error such as mass.error.
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = change)]
    numbers: Vec<Change>,
    #[command(flatten)]
    follower: FollowerNumbers,
}

/// Heading of these options in `--help`.
const FOLLOWER: &str = "Follower (a table needs mass, stiffness and preload)";

/// Number of the follower that has a separate option.
struct FollowerOption {
    name: &'static str,
    /// Unit of the number for a table of lifts.
    unit: &'static str,
    /// Default value for a table of lifts, in this unit.
    assumed: f64,
    /// Whether a motion cannot be computed with the assumed value.
    is_needed: bool,
}

/// All numbers of the follower that have an option, in the order of a model file.
const FOLLOWER_OPTIONS: [FollowerOption; 6] = [
    FollowerOption { name: "mass", unit: "kg", assumed: 0.1, is_needed: true },
    FollowerOption { name: "stiffness", unit: "N/mm", assumed: 30.0, is_needed: true },
    FollowerOption { name: "preload", unit: "N", assumed: 200.0, is_needed: true },
    FollowerOption { name: "damping", unit: "N s/m", assumed: 0.0, is_needed: false },
    FollowerOption { name: "gravity", unit: "m/s^2", assumed: 0.0, is_needed: false },
    FollowerOption { name: "restitution", unit: "", assumed: 0.3, is_needed: false },
];

impl FollowerOption {
    fn path(&self) -> String {
        format!("follower.{}", self.name)
    }
}

/// Units of the model that is assumed for a table of lifts.
const BESIDE_A_TABLE: &str = "[units]\nlength = \"mm\"\nstiffness = \"N/mm\"\n";

/// Given options of `FOLLOWER_OPTIONS`, each with its text.
#[derive(Clone, Default)]
struct FollowerNumbers(Vec<(&'static str, String)>);

impl clap::Args for FollowerNumbers {
    fn augment_args(command: clap::Command) -> clap::Command {
        FOLLOWER_OPTIONS.iter().fold(command, |command, option| {
            let meaning = ModelNumber::of(&option.path()).map_or("", |number| number.meaning);
            let help = match option.unit {
                "" => format!("Set the {meaning}"),
                unit => format!(
                    "Set the {meaning}. The unit is the model's, or {unit} for a table of lifts, unless you write one"
                ),
            };
            let arg = Arg::new(option.name).long(option.name).value_name("VALUE").help(help);
            command.arg(arg.help_heading(FOLLOWER).allow_hyphen_values(true))
        })
    }

    fn augment_args_for_update(command: clap::Command) -> clap::Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for FollowerNumbers {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let given = |option: &FollowerOption| Some((option.name, matches.get_one::<String>(option.name)?.clone()));
        Ok(Self(FOLLOWER_OPTIONS.iter().filter_map(given).collect()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        Self::from_arg_matches(matches).map(|given| *self = given)
    }
}

impl FollowerNumbers {
    /// Returns the options as typed, each after a blank.
    fn typed(&self) -> String {
        self.0.iter().map(|(name, text)| format!(" --{name} {}", shell_word(text))).collect()
    }

    /// Options that a table of lifts still needs.
    fn missing(&self) -> impl Iterator<Item = &'static FollowerOption> {
        let is_given = |option: &&FollowerOption| self.0.iter().any(|(name, _)| *name == option.name);
        FOLLOWER_OPTIONS.iter().filter(move |option| option.is_needed && !is_given(option))
    }
}

/// Number of the model, and its new value.
#[derive(Clone)]
struct Change {
    name: String,
    number: Numeral,
    /// Unit after the number; empty for none.
    unit: String,
}

impl Changes {
    /// Returns all given numbers, in either form.
    fn all(&self) -> Result<Vec<Change>, CommandError> {
        let named = |(name, text): &(&str, String)| {
            let change = number_of(&format!("follower.{name}"), text);
            change.map_err(|words| CommandError::Words(format!("--{name}: {words}")))
        };
        let own = self.follower.0.iter().map(named);
        self.numbers.iter().cloned().map(Ok).chain(own).collect()
    }

    /// Returns the model with the changed numbers, in its own units.
    pub(super) fn of(&self, model: &Model) -> Result<Model, CommandError> {
        let own = |change: Change| -> Result<(String, Numeral), CommandError> {
            // An error has the unit of its number.
            let name = error_of(&change.name).unwrap_or(&change.name);
            let path = if change.unit.is_empty() { "" } else { model.path_of(name, &[])? };
            Ok((change.name.clone(), change.inside(path, &model.units)?))
        };
        let numbers: Vec<_> = self.all()?.into_iter().map(own).collect::<Result<_, _>>()?;
        Ok(model.changed(&numbers)?)
    }
}

/// Name of the number whose error has this name; `None` for other names.
fn error_of(name: &str) -> Option<&str> {
    name.strip_suffix(".error")
}

/// Parses `NAME=VALUE`.
fn change(text: &str) -> Result<Change, String> {
    let (name, number) = text.split_once('=').ok_or("must be NAME=VALUE: a number of the model and its new value")?;
    number_of(name, number).map_err(|words| match name.trim().rsplit('.').next() {
        _ if number.contains(|letter: char| letter.is_ascii_digit()) => words,
        Some("contact") => {
            format!("{words}: NAME=VALUE changes only numbers; change contact in the file, under [cam]: {CONTACTS}")
        }
        _ => format!("{words}: NAME=VALUE changes only numbers; change words in the file"),
    })
}

/// Parses a number. Its unit is compared with the model's after the model is read.
fn number_of(name: &str, number: &str) -> Result<Change, String> {
    let (text, unit) = parted(number);
    let unit = if unit.starts_with(',') { "" } else { unit };
    let number = Numeral { number: finite(number, unit)?, text: text.into() };
    Ok(Change { name: name.trim().into(), number, unit: unit.into() })
}

impl Change {
    /// Converts the number to the unit of a model for this path.
    fn inside(self, path: &str, units: &Units) -> Result<Numeral, CommandError> {
        let Self { name, number, unit } = self;
        if unit.is_empty() {
            return Ok(number);
        }
        match units.in_own(path, number.number, &unit) {
            Some(value) if value == number.number => Ok(number),
            Some(value) => Ok(value.into()),
            None if unit == "%" && units.of_number(path).is_empty() => Ok((number.number / 100.0).into()),
            None if unit.starts_with(['±', '+']) => {
                let error = unit.trim_start_matches(['±', '+', '/', '-', ' ']);
                let words = "an error is a number of its own: set it with --set";
                Err(CommandError::Words(format!(
                    "{name} = {} {}: {words} {name}.error={}",
                    number.text,
                    untrusted::value(&unit),
                    untrusted::value(error)
                )))
            }
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

/// Returns the reason why no model can be read at a path, with the name of a similar file. A stream or a device is accepted.
fn missing(path: &Path) -> Result<(), CommandError> {
    let shown = path.display();
    if path.is_dir() {
        return Err(CommandError::Words(format!("{shown}: cannot be read: it is a folder, not a model file")));
    }
    if path.exists() {
        return Ok(());
    }
    let word = path.to_string_lossy();
    if super::Arguments::command().find_subcommand(&*word).is_some() || word == "help" {
        return Err(CommandError::Words(format!(
            "{shown} is not a model: the command comes first; `corner-impact COMMAND --help` explains a command"
        )));
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let files = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|file| file.path());
    let models = files.filter(|file| ends_in(file, &["toml"]) || ends_in(file, &TABLES));
    let names: Vec<String> =
        models.filter_map(|file| Some(file.file_name()?.to_string_lossy().into_owned())).take(MOST_FILES).collect();
    let wanted = path.file_name().unwrap_or_default().to_string_lossy();
    let meant = nearest(&wanted, names.iter().map(String::as_str));
    let meant = meant.map_or(String::new(), |meant| format!("; did you mean {}?", untrusted::value(meant)));
    Err(CommandError::Words(format!("{word}: cannot be read: there is no such file{meant}")))
}

/// Largest number of files of a folder with which a misspelt name is compared.
const MOST_FILES: usize = 1000;

/// Whether a word of a command line is meant as the name of a file.
pub(super) fn is_file_name(word: &str) -> bool {
    word.contains(['.', '/', '\\']) && !word.starts_with('-')
}

impl ModelArgument {
    /// Builds the argument for the model in a file, or the built-in model, with some numbers changed.
    pub(super) fn of(file: Option<&Path>, changes: &Changes) -> Self {
        Self { file: file.map(Path::to_path_buf), changes: changes.clone() }
    }

    /// Named file, if any.
    pub(super) fn file(&self) -> Option<&Path> {
        self.file.as_deref()
    }

    fn is_table(&self) -> bool {
        self.file.as_deref().is_some_and(|path| ends_in(path, &TABLES))
    }

    /// Options of the follower that a table of lifts still needs, each after a blank, with units as placeholders; empty for a model file.
    pub(super) fn still_needed(&self) -> String {
        let missing = self.changes.follower.missing().filter(|_| self.is_table());
        missing.map(|option| format!(" --{} {}", option.name, option.unit.to_uppercase())).collect()
    }

    /// Returns the number that an option varies; rejects a number that --set fixes. The options of a follower are the model's own numbers if
    /// the file is a table of lifts.
    pub(super) fn varied(&self, model: &Model, name: &str, option: &str) -> Result<Parameter, CommandError> {
        let parameter = Parameter::named(model, name)?;
        let changes = if self.is_table() { self.changes.numbers.clone() } else { self.changes.all()? };
        // The varied number is exact, whatever its error.
        let values = changes.iter().filter(|change| error_of(&change.name).is_none());
        let set = values.map(|change| Parameter::named(model, &change.name));
        if set.collect::<Result<Vec<_>, _>>()?.contains(&parameter) {
            let name = parameter.name();
            let words =
                format!("--set {name}: {option} varies this number, so no point would use the value; drop one of them");
            return Err(CommandError::Words(words));
        }
        Ok(parameter)
    }

    /// Reads the model; notes on standard error which model is used if none is named.
    pub(super) fn read(&self, session: &mut Session<'_>) -> Result<Model, CommandError> {
        self.read_with(session, true)
    }

    /// Reads the model for a command that needs no follower.
    pub(super) fn read_cam(&self, session: &mut Session<'_>) -> Result<Model, CommandError> {
        self.read_with(session, false)
    }

    fn read_with(&self, session: &mut Session<'_>, needs_follower: bool) -> Result<Model, CommandError> {
        let mut changes = self.changes.clone();
        if let Some(path) = self.file.as_deref().filter(|path| !path.is_file()) {
            missing(path)?;
        }
        let model = match &self.file {
            Some(path) if ends_in(path, &TABLES) => {
                let text = assumed(path, &mut changes, needs_follower)?;
                let file = path.with_extension("toml");
                session.note(&format!(
                    "there is no model file, so this one is assumed; save it as {} to change it\n{text}",
                    file.display()
                ));
                // The assumed model is not in a file of that name.
                let assumed = |error: ModelError| {
                    let names_field = error.to_string().contains("in [cam]");
                    let law = if error.to_string().contains("law = \"contour\"") { "contour" } else { "table" };
                    let words = format!(
                        "; there is no model file yet: `corner-impact new --law {law} my-machine.toml` writes one; name this table \
                         in it by file = \"{}\"",
                        path.file_name().unwrap_or_default().display()
                    );
                    let table = path.display().to_string();
                    let (file, line) = match *error.file == *table {
                        true => (table, error.line),
                        false => (table + " and what is assumed beside it", None),
                    };
                    let meant = error.pointer.meant.clone();
                    let error = ModelError { file: file.into(), line, ..error };
                    match meant.filter(|_| names_field) {
                        Some(meant) => error.meaning(Some(meant + &words)),
                        None if names_field => error.found(&words),
                        None => error,
                    }
                };
                watched("reading the table", |_| Model::parse(&file.to_string_lossy(), &text).map_err(assumed))?
            }
            Some(path) => {
                // A table of a million lifts takes some time to read.
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

    /// Reads the model for a command that describes the cam as drawn. Notes the accuracy of a measured cam.
    pub(super) fn read_as_drawn(&self, session: &mut Session<'_>) -> Result<Model, CommandError> {
        let model = self.read(session)?;
        if let Some(words) = notes::as_drawn(&model)? {
            session.note(&words);
        }
        Ok(model)
    }
}

/// Extensions of tables of lifts, which may replace a model file.
pub(super) const TABLES: [&str; 4] = ["csv", "tsv", "txt", "dat"];

/// Builds the model file that is assumed for a table of lifts and the numbers of a follower, which are removed from the changes.
fn assumed(table: &Path, changes: &mut Changes, needs_follower: bool) -> Result<String, CommandError> {
    let of_follower = |change: &Change| {
        let name = change.name.strip_prefix("follower.").unwrap_or(&change.name);
        FOLLOWER_OPTIONS.iter().find(|option| option.name == name)
    };
    let (given, others): (Vec<Change>, Vec<Change>) =
        changes.all()?.into_iter().partition(|change| of_follower(change).is_some());
    let units = units_beside_a_table()?;
    let (mut lines, mut missing) = (String::new(), Vec::new());
    for option in &FOLLOWER_OPTIONS {
        let (path, unit) = (option.path(), option.unit);
        let mut values = given.iter().filter(|change| of_follower(change).is_some_and(|of| of.name == option.name));
        let (value, remark) = match (values.next(), values.next()) {
            (Some(_), Some(_)) => return Err(CommandError::Words(format!("{path} is set twice"))),
            (Some(change), None) => (change.clone().inside(&path, &units)?.number, unit.to_owned()),
            (None, _) if needs_follower && option.is_needed => {
                missing.push(format!("--{} ({unit})", option.name));
                continue;
            }
            (None, _) if unit.is_empty() => (option.assumed, "assumed".into()),
            (None, _) => (option.assumed, format!("{unit}, assumed")),
        };
        let line = format!("{:<17} # {remark}", format!("{} = {value:?}", option.name));
        lines += &format!("{}\n", line.trim_end_matches(['#', ' ']));
    }
    if !missing.is_empty() {
        let words = format!("{}: a table of lifts has no follower: give {}", table.display(), missing.join(", "));
        return Err(CommandError::Words(words));
    }
    *changes = Changes { numbers: others, follower: FollowerNumbers::default() };
    // TOML escapes as JSON does.
    let [file, name] = [table.file_name(), table.file_stem()]
        .map(|name| serde_json::Value::from(name.unwrap_or_default().to_string_lossy()).to_string());
    let cam = format!("[cam]\nlaw = \"table\"\nfile = {file}\nspline = \"smoothing\"\n");
    Ok(format!("name = {name}\n\n{BESIDE_A_TABLE}\n[follower]\n{lines}\n{cam}"))
}

/// Units of the model that is assumed for a table of lifts, needed before the table is read.
fn units_beside_a_table() -> Result<Units, CommandError> {
    let follower =
        "[follower]\nmass = 1.0\nstiffness = 1.0\npreload = 1.0\ndamping = 0.0\ngravity = 0.0\nrestitution = 0.0\n";
    let cam = "[cam]\nlaw = \"harmonic\"\noffset = 0.0\namplitudes = [1.0]\nphases_deg = [0.0]\n";
    Ok(Model::parse("units", &format!("name = \"units\"\n{BESIDE_A_TABLE}{follower}{cam}"))?.units)
}
