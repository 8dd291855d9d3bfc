//! Command line for `--help`, the manual and the shells: grouped, with examples.

use std::ffi::OsString;
use std::fmt::Write;

use clap::builder::styling::{AnsiColor, Styles};
use clap::builder::{Str, StyledStr};
use clap::{Arg, Command, CommandFactory};

use super::{Arguments, GROUPS};
use crate::show::page::options;

/// Headings and names are emphasized; placeholders are not.
const STYLES: Styles = Styles::styled()
    .header(AnsiColor::Green.on_default().bold())
    .usage(AnsiColor::Green.on_default().bold())
    .literal(AnsiColor::Cyan.on_default().bold())
    .placeholder(AnsiColor::Cyan.on_default());

/// Commands for a first try, at the end of the help.
const EXAMPLES: &str = "Examples:
  corner-impact new my-machine.toml        write a model file to start from
  corner-impact models/osorio-2008.toml    list what you can do with a model
  corner-impact verify --no-external       check the paper's model, which is built in

`corner-impact COMMAND --help` has examples of each command. Examples that name models/ run in the project's folder.";

/// Returns the command line without styles.
pub(super) fn plain() -> Command {
    whole().after_help(EXAMPLES)
}

/// Builds the command line, with the full stop after texts of several sentences that clap removes. It takes half a megabyte, so it is used
/// for printing only.
fn whole() -> Command {
    let stopped = |argument: Arg| {
        let help = argument.get_help().map(ToString::to_string).unwrap_or_default();
        if help.contains(". ") && !help.ends_with('.') { argument.help(format!("{help}.")) } else { argument }
    };
    let command = Arguments::command();
    let names: Vec<String> = command.get_subcommands().map(|sub| sub.get_name().to_owned()).collect();
    names.into_iter().fold(command, |command, name| command.mut_subcommand(name, |sub| sub.mut_args(stopped)))
}

/// Options listed by `-h`, by their fields; `--help` lists all options.
const ESSENTIAL: &[&str] = &[
    "file",
    "words",
    "first",
    "second",
    "what",
    "rpm",
    "over",
    "out",
    "json",
    "numbers",
    "grid",
    "section",
    "following",
    "attractors",
    "events",
    "revolutions",
    "need",
    "limit",
    "orbits",
    "resting",
    "trapping",
    "verdict",
    "known",
    "list",
    "no_external",
    "law",
    "force",
    "shell",
    "show",
    "with_curves",
    "help",
];

/// Builds the command line, laid out for this number of columns: completely, or as for `-h`.
pub(super) fn command(width: usize, words: &[OsString]) -> Command {
    let is_short = is_short(words);
    let command = if prints_help(words) { whole() } else { Arguments::command() };
    let mut command = command.styles(STYLES).term_width(width).max_term_width(width);
    let template = if is_short { brief(&command, width) } else { template(&command, width) };
    if is_short {
        command = ["color", "threads"]
            .into_iter()
            .fold(command, |command, name| command.mut_arg(name, |it| it.hide_short_help(true)));
    }
    let names: Vec<String> = command.get_subcommands().map(|sub| sub.get_name().to_owned()).collect();
    for name in names {
        command = command.mut_subcommand(&name, |mut sub| {
            // A chart has two axes with these names.
            if name != "chart" && sub.get_arguments().any(|argument| argument.get_id() == "x_range") {
                sub = sub.mut_arg("x_range", |ends| ends.alias("x")).mut_arg("y_range", |ends| ends.alias("y"));
            }
            let after = sub.get_after_help().map(ToString::to_string).unwrap_or_default();
            if is_short { shortened(sub, &name, &after) } else { sub.after_help(with_heading(&after)) }
        });
    }
    let after = if is_short { StyledStr::from(MORE) } else { with_heading(EXAMPLES) };
    command.help_template(template).after_help(after)
}

/// Whether the short page is requested.
fn is_short(words: &[OsString]) -> bool {
    before_dashes(words).any(|word| word == "-h")
}

/// Whether any page of help is requested.
fn prints_help(words: &[OsString]) -> bool {
    words.len() < 2 || before_dashes(words).any(|word| ["-h", "--help", "help"].iter().any(|help| word == help))
}

/// Words that can be options or commands.
fn before_dashes(words: &[OsString]) -> impl Iterator<Item = &OsString> {
    words.iter().skip(1).take_while(|word| *word != "--")
}

const MORE: &str = "`corner-impact MODEL` lists what you can do with a model. `corner-impact COMMAND --help` has all options and more examples.";

/// Shortens a command for `-h`: the most important options, each in a few words, and two examples.
fn shortened(sub: Command, name: &str, after: &str) -> Command {
    let short = |argument: Arg| {
        let help = argument.get_help().map(ToString::to_string).unwrap_or_default();
        let end = ["; ", ": ", " [", ". "].iter().filter_map(|stop| help.find(stop)).min().unwrap_or(help.len());
        let is_essential = ESSENTIAL.contains(&argument.get_id().as_str());
        let brief = help[..end].trim_end_matches('.').to_owned();
        let short = |name: &Str| name.split('[').next().unwrap_or_default().to_owned();
        let names: Option<Vec<String>> = argument.get_value_names().map(|names| names.iter().map(short).collect());
        // A positional argument keeps its help.
        let argument = match names.filter(|_| !argument.is_positional()) {
            Some(names) => argument.value_names(names),
            None => argument,
        };
        argument.help(brief).hide_short_help(!is_essential).hide_default_value(true).hide_possible_values(true)
    };
    let examples: Vec<&str> = after.lines().filter(|line| line.starts_with("  ")).take(2).collect();
    let after = format!("Examples:\n{}\n\n`corner-impact {name} --help` has all options.", examples.join("\n"));
    sub.mut_args(short).after_help(with_heading(&after))
}

/// Formats "Examples:" as a heading.
fn with_heading(text: &str) -> StyledStr {
    let header = STYLES.get_header();
    text.replacen("Examples:", &format!("{header}Examples:{header:#}"), 1).into()
}

/// Page of `-h`: the commands for a first visit, and the names of the others.
fn brief(command: &Command, width: usize) -> StyledStr {
    let (header, literal) = (STYLES.get_header(), STYLES.get_literal());
    let mut text = "{about-with-newline}\n{usage-heading} {usage}\n".to_owned();
    for (place, (heading, names)) in GROUPS.iter().filter(|(heading, _)| !heading.is_empty()).enumerate() {
        let _ = writeln!(text, "\n{header}{heading}:{header:#}");
        let subs = names.iter().filter_map(|name| command.find_subcommand(name.to_lowercase()));
        if place == 0 {
            for sub in subs {
                let about = sub.get_about().map(ToString::to_string).unwrap_or_default();
                let _ = writeln!(text, "  {literal}{:9}{literal:#} {about}", sub.get_name());
            }
            continue;
        }
        let names: Vec<&str> = subs.map(Command::get_name).collect();
        for line in textwrap::wrap(&names.join("  "), options(width.saturating_sub(2))) {
            let _ = writeln!(text, "  {literal}{line}{literal:#}");
        }
    }
    text.push_str("\n{options}{after-help}");
    text.into()
}

/// First page: the subcommands under their headings, in the order of a first visit.
fn template(command: &Command, width: usize) -> StyledStr {
    let (header, literal) = (STYLES.get_header(), STYLES.get_literal());
    let longest = command.get_subcommands().map(|sub| sub.get_name().len()).max().unwrap_or(0);
    let indent = " ".repeat(longest + 4);
    let mut text = "{about-with-newline}\n{usage-heading} {usage}\n".to_owned();
    for (heading, names) in GROUPS.iter().filter(|(heading, _)| !heading.is_empty()) {
        let _ = writeln!(text, "\n{header}{heading}:{header:#}");
        let find = |name: &str| command.get_subcommands().find(|sub| sub.get_name() == name);
        for sub in names.iter().filter_map(|name| find(&name.to_lowercase())) {
            let about = sub.get_about().map(ToString::to_string).unwrap_or_default();
            let name = sub.get_name();
            let about = textwrap::fill(about.trim(), options(width).initial_indent(&indent).subsequent_indent(&indent));
            let gap = longest - name.len() + 2;
            let _ = writeln!(text, "  {literal}{name}{literal:#}{:gap$}{}", "", about.trim_start());
        }
    }
    text.push_str("\n{options}{after-help}");
    text.into()
}
