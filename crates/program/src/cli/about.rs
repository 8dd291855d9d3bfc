//! Command `corner-impact MODEL`: lists the commands for a model.

use std::ffi::OsString;
use std::path::Path;

use clap::CommandFactory;

use super::model::is_file_name;
use super::{CommandError, Exit, ModelArgument, Session};
use crate::show::block::{Block, words};
use crate::show::{Page, words};
use corner_impact::cam::Cam;
use corner_impact::study::speeds::usual_range;

/// Lists what you can do with a model, as `corner-impact MODEL` does.
#[derive(clap::Args)]
#[command(
    hide = true,
    override_usage = "corner-impact MODEL [COMMAND] [OPTIONS]",
    after_help = "Examples:\n\
    \x20 corner-impact models/osorio-2008.toml"
)]
pub(super) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
}

/// Inserts this command before a model that is given in place of a command.
pub(super) fn named(mut words: Vec<OsString>) -> Vec<OsString> {
    let is_command = |word: &OsString| super::Arguments::command().find_subcommand(word).is_some();
    let is_model =
        |word: &&OsString| !is_command(word) && (word.to_str().is_some_and(is_file_name) || Path::new(word).is_file());
    if words.get(1).filter(is_model).is_some() {
        match words.get(2).filter(|word| !word.to_string_lossy().starts_with('-')) {
            // A word that is no command is rejected as an unknown command.
            Some(_) => words.swap(1, 2),
            None => words.insert(1, "about".into()),
        }
    }
    words
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let model = arguments.model.read_cam(session)?;
    let cam = Cam::new(&model)?;
    let [low, high] = usual_range(&model)?;
    let of_acceleration = cam.corners().iter().filter(|corner| corner.jump_order == 2).count();
    let corners = words::many(of_acceleration as u64, "corner");
    let missing = arguments.model.still_needed();
    let of = if missing.is_empty() { "" } else { " for the assumed follower" };
    let lead = format!(
        "The cam has law \"{}\" and {corners} where the acceleration jumps. Without --rpm, `speeds` covers {low} to {high} rpm{of}.",
        model.cam.law()
    );
    let mut uses = vec![
        ("cam", String::new(), "shows the cam's lift, its corners and its accuracy"),
        ("design", String::new(), "finds the speed up to which the follower stays on the cam"),
        ("simulate", format!(" --rpm {low}"), "simulates one run: impacts, gap and force"),
        ("speeds", String::new(), "finds the motions that runs settle on over a range of speeds"),
        ("report", String::new(), "writes all results as one page for a browser"),
    ];
    // The paper's result needs a jump of the acceleration.
    if of_acceleration > 0 {
        uses.push(("locate", format!(" --rpm {low}:{high}"), "finds the speeds at which an orbit hits such a corner"));
    }
    if of_acceleration > 0 && model.study.is_some() {
        uses.push(("verify", String::new(), "computes the map at the corner impact by every route"));
    }
    let named = session.named.clone();
    let entry = |(name, rest, what): (&str, String, &'static str)| {
        // The cam needs no follower.
        let missing = if name == "cam" { "" } else { &missing };
        [
            Block::Command(format!("corner-impact {name}{named}{missing}{rest}")),
            Block::Line(words![format!("    {what}")]),
        ]
    };
    let mut blocks = vec![Block::Title(words![&model.name]), Block::paragraph(lead), Block::Gap];
    blocks.extend(uses.into_iter().flat_map(entry));
    let page = Page::of(session.width(), false, &blocks)?;
    let page = session.shown(&page);
    session.print(&page)?;
    Ok(Exit::Agrees)
}
