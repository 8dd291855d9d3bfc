//! `corner-impact chaos [MODEL] --rpm R|LO:HI`.

use std::path::PathBuf;

use super::numbers::rpm_or_range;
use super::picture::{Canvas, PictureArguments, picture};
use super::{AnswerArguments, CommandError, Exit, ModelArgument, Session, progress::watched};
use crate::figures::chaos_figure;
use corner_impact::study::chaos::{chaos, portrait};

/// Proves that chaotic motions exist, at one speed or a range.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n\
    \x20 corner-impact chaos --rpm 670 --out chaos.svg\n\
    \x20 corner-impact chaos models/osorio-2008.toml --rpm 673:673.5 --json\n\
    \n\
    A proof is by enclosures that leave no case out; that other motions come to the set is not said.\n\
    Exit code: 0 done, also where nothing is proved, 2 bad model file, usage or file, or a run that cannot go on.")]
pub(super) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    /// Speed of the cam, or lowest and highest.
    #[arg(long, value_name = "R|LO:HI", value_parser = rpm_or_range, allow_hyphen_values = true)]
    rpm: [f64; 2],
    /// Look for regions that trap as well, at the lowest speed: impacts that are followed by impacts among them for ever.
    #[arg(long)]
    trapping: bool,
    #[command(flatten)]
    answer: AnswerArguments,
    /// A picture (.svg, .png, .pdf) of the h-set, its strips and where they are carried, at the lowest speed with a proof.
    #[arg(long, value_name = "FILE", value_parser = picture, group = "picture")]
    out: Option<PathBuf>,
    #[command(flatten)]
    picture: PictureArguments,
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let model = arguments.model.read_as_drawn(session)?;
    let canvas = arguments.out.as_ref().map(|path| Canvas::create(path, arguments.picture.request()?)).transpose()?;
    let found = watched("looking for h-sets", |watch| chaos(&model, arguments.rpm, arguments.trapping, watch))?;
    match (canvas, found.theorems.first()) {
        (Some(canvas), Some(theorem)) => {
            let rpm = theorem.set.rpm[0];
            let title = format!("{} at {rpm} rpm: strips of N, and where so many impacts carry them", model.name);
            let figure = chaos_figure(&title, &theorem.set, &portrait(&model, &theorem.set)?);
            canvas.write(figure, &model.units)?;
        }
        (Some(_), None) => session.note("nothing is proved, so nothing is drawn"),
        (None, _) => {}
    }
    session.answer(&found, &arguments.answer)
}
