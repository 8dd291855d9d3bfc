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
    A proof encloses every case. It does not state that other motions converge to the set.\n\
    Exit code: 0 done, also if nothing is proved, 2 bad model file, usage or file, or a run that cannot go on.")]
pub(super) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    /// Speed of the cam, rpm; or the lowest and the highest speed.
    #[arg(long, value_name = "R|LO:HI", value_parser = rpm_or_range, allow_hyphen_values = true)]
    rpm: [f64; 2],
    /// Also look for trapping regions, at the lowest speed. After an impact in such a region, every later impact is in it.
    #[arg(long)]
    trapping: bool,
    #[command(flatten)]
    answer: AnswerArguments,
    /// Draw the h-set, its strips and their images (.svg, .png, .pdf), at the lowest speed with a proof.
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
            let title = format!("{} at {rpm} rpm: strips of N and their images", model.name);
            let figure = chaos_figure(&title, &theorem.set, &portrait(&model, &theorem.set)?);
            canvas.write(figure, &model.units)?;
        }
        (Some(_), None) => session.note("nothing is proved, so nothing is drawn"),
        (None, _) => {}
    }
    session.answer(&found, &arguments.answer)
}
