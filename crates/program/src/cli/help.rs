//! The command line as `--help`, the manual and the shells see it: grouped, with examples.

use std::fmt::Write;

use clap::builder::StyledStr;
use clap::builder::styling::{AnsiColor, Styles};
use clap::{Command, CommandFactory};

use super::{Arguments, GROUPS};
use crate::show::page::options;

/// Headings and names stand out; what is to be filled in does not shout.
const STYLES: Styles = Styles::styled()
    .header(AnsiColor::Green.on_default().bold())
    .usage(AnsiColor::Green.on_default().bold())
    .literal(AnsiColor::Cyan.on_default().bold())
    .placeholder(AnsiColor::Cyan.on_default());

/// Commands for a first try, at the end of the help.
const EXAMPLES: &str = "Examples:
  corner-impact verify --no-external       check the paper's model, which is built in
  corner-impact new my-machine.toml        begin a model file of your own

`corner-impact COMMAND --help` has examples for each; where they name models/, they are run from the project's folder.";

/// The command line as it is, in letters alone.
pub(super) fn plain() -> Command {
    Arguments::command().after_help(EXAMPLES)
}

/// The command line, laid out for so many columns.
pub(super) fn command(width: usize) -> Command {
    let mut command = Arguments::command().styles(STYLES).term_width(width).max_term_width(width);
    let template = template(&command, width);
    let names: Vec<String> = command.get_subcommands().map(|sub| sub.get_name().to_owned()).collect();
    for name in names {
        command = command.mut_subcommand(name, |sub| match sub.get_after_help().map(ToString::to_string) {
            Some(text) => sub.after_help(with_heading(&text)),
            None => sub,
        });
    }
    command.help_template(template).after_help(with_heading(EXAMPLES))
}

/// "Examples:" in the look of a heading.
fn with_heading(text: &str) -> StyledStr {
    let header = STYLES.get_header();
    text.replacen("Examples:", &format!("{header}Examples:{header:#}"), 1).into()
}

/// The first page: the subcommands under their headings, in the order of a first visit.
fn template(command: &Command, width: usize) -> StyledStr {
    let (header, literal) = (STYLES.get_header(), STYLES.get_literal());
    let longest = command.get_subcommands().map(|sub| sub.get_name().len()).max().unwrap_or(0);
    let indent = " ".repeat(longest + 4);
    let mut text = "{about-with-newline}\n{usage-heading} {usage}\n".to_owned();
    for (heading, names) in GROUPS {
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
