//! `corner-impact man`.

use std::io::Write;
use std::path::PathBuf;

use clap_mangen::Man;
use clap_mangen::roff::{Roff, roman};

use super::{CommandError, Exit, Session, help};
use corner_impact::file::Output;

/// Prints the manual page, or writes one for each command.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n\
    \x20 corner-impact man\n\
    \x20 corner-impact man --out man1\n\
    \n\
    `man -l man1/corner-impact.1` shows a page. In ~/.local/share/man/man1, `man` finds pages by name.\n\
    Exit code: 0 done, 2 bad usage or a file that cannot be written.")]
pub(super) struct Arguments {
    /// Folder for the pages; it is created if it does not exist [default: print the program's page].
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let mut program = help::plain().disable_help_subcommand(true);
    program.build();
    let Some(folder) = &arguments.out else {
        session.print(&String::from_utf8_lossy(&page(program)?))?;
        return Ok(Exit::Agrees);
    };
    let refused = |error: std::io::Error| CommandError::Words(format!("{}: {error}", folder.display()));
    std::fs::create_dir_all(folder).map_err(refused)?;
    let commands: Vec<clap::Command> =
        program.get_subcommands().filter(|sub| !sub.is_hide_set()).cloned().chain([program.clone()]).collect();
    let mut files = Vec::new();
    for command in commands {
        let mut file = Output::file(&folder.join(Man::new(command.clone()).get_filename()))?;
        file.write_all(&page(command)?)?;
        files.push(file);
    }
    let count = files.len();
    Output::commit_all(files)?;
    session.note(&format!("wrote {count} pages to {}", folder.display()));
    Ok(Exit::Agrees)
}

/// Builds the page of one command: clap's description, its examples, and the rest of its text.
fn page(command: clap::Command) -> Result<Vec<u8>, CommandError> {
    let (has_commands, has_version) = (command.has_subcommands(), command.get_version().is_some());
    let after = command.get_after_help().map(ToString::to_string).unwrap_or_default();
    let man = Man::new(command);
    let mut text = Vec::new();
    let mut render = || -> std::io::Result<()> {
        man.render_title(&mut text)?;
        man.render_name_section(&mut text)?;
        man.render_synopsis_section(&mut text)?;
        man.render_description_section(&mut text)?;
        man.render_options_section(&mut text)?;
        if has_commands {
            man.render_subcommands_section(&mut text)?;
        }
        examples(&after).to_writer(&mut text)?;
        if has_version { man.render_version_section(&mut text) } else { Ok(()) }
    };
    render()?;
    Ok(text)
}

/// Formats examples as typed text, and the rest as paragraphs.
fn examples(after: &str) -> Roff {
    let mut roff = Roff::default();
    let (examples, rest) = after.split_once("\n\n").unwrap_or((after, ""));
    roff.control("SH", ["EXAMPLES"]);
    roff.control("nf", []);
    for line in examples.lines().filter(|line| line.starts_with(' ')) {
        roff.text([roman(line.trim())]);
    }
    roff.control("fi", []);
    for line in rest.lines().filter(|line| !line.is_empty()) {
        roff.control("PP", []);
        roff.text([roman(line)]);
    }
    roff
}
