//! `corner-impact completions SHELL`.

use clap_complete::Shell;

use super::{CommandError, Exit, Session, help};

/// Prints the script by which a shell completes commands and options.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n\
    \x20 corner-impact completions bash\n\
    \x20 corner-impact completions zsh\n\
    \n\
    To load the script in every shell, save it.\n\
    bash: ~/.local/share/bash-completion/completions/corner-impact\n\
    zsh: a file _corner-impact in a folder of $fpath\n\
    fish: ~/.config/fish/completions/corner-impact.fish\n\
    Exit code: 0 done, 2 bad usage.")]
pub(super) struct Arguments {
    /// Shell that is to complete.
    shell: Shell,
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut help::plain(), "corner-impact", &mut script);
    session.print(&String::from_utf8_lossy(&script))?;
    Ok(Exit::Agrees)
}
