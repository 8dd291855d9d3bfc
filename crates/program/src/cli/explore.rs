//! `corner-impact explore [MODEL]`.

use std::io::Write;
use std::path::PathBuf;

use super::report::page;
use super::{CommandError, Exit, ModelArgument, Session};
use crate::explore::{End, Server, Timeouts};
use crate::live;
use corner_impact::file::Output;
use corner_impact_explore::Transport;

/// Opens a live page of a model: change a number, and every picture follows.
///
/// Only browsers on this machine can open the page. It is served until it has been closed for a minute, or until Ctrl-C.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n\
    \x20 corner-impact explore\n\
    \x20 corner-impact explore models/sharp-nose.toml --no-open\n\
    \x20 corner-impact explore models/sharp-nose.toml --out live.html\n\
    \n\
    The program prints the address of the page. The address contains a secret: whoever has it can make the program compute.\n\
    With --out, the page is one file, which needs neither this program nor a network.\n\
    Exit code: 0 the page was closed, or never opened, or is written; 2 bad model file, usage, port or file.")]
pub(super) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    /// Write the page to a file that computes by itself, instead of serving it; - is standard output.
    #[arg(long, value_name = "FILE", value_parser = page)]
    out: Option<PathBuf>,
    /// Open the page after writing it. A served page is opened without this option.
    #[arg(long)]
    open: bool,
    /// Serve the page without opening a browser.
    #[arg(long, conflicts_with_all = ["open", "out"])]
    no_open: bool,
    /// Port of the page [default: a free port].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..), conflicts_with = "out")]
    port: Option<u16>,
    /// Divide every waiting time of the server: tests cannot wait for a minute.
    #[arg(long, value_name = "N", default_value_t = 1, hide = true)]
    hurried: u32,
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let model = arguments.model.read(session)?;
    if let Some(path) = &arguments.out {
        let page = live::page(&model)?;
        let mut file = Output::create(path, &mut *session.out)?;
        file.write_all(page.as_bytes())?;
        file.commit()?;
        return Ok(Exit::Agrees);
    }
    let page = move |base: &str, nonce: &str| live::page_by(Transport::Server { base, nonce }, &model);
    let server = Server::listen(arguments.port, session.threads, Timeouts::hurried(arguments.hurried), Box::new(page));
    let server = server.map_err(|error| {
        let port = arguments.port.map_or(String::new(), |port| format!("--port {port}: "));
        CommandError::Words(format!("{port}no page can be served: {error}"))
    })?;
    session.print(&format!("{}\n", server.address()))?;
    session.note("the server stops when the page has been closed for a minute; Ctrl-C stops it at once");
    if !arguments.no_open && open::that_detached(server.first_visit()).is_err() {
        session.note("no browser was found: open the address above in a browser");
    }
    let end = server.serve().map_err(|error| CommandError::Words(format!("no page can be served: {error}")))?;
    session.note(match end {
        End::Closed => "the server stops: the page has been closed for a minute",
        End::Unopened => "the server stops: nobody opened the page within ten minutes",
    });
    Ok(Exit::Agrees)
}
