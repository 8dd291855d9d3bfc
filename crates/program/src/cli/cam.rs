//! `corner-impact cam [MODEL]`.

use std::path::PathBuf;

use super::{AnswerArguments, CommandError, Exit, ModelArgument, Session, picture, progress::Progress};
use crate::figures::{cam_figure, shape_figure};
use corner_impact::cam::{Cam, Jet};
use corner_impact::study::cam::CamSheet;

/// Lists a cam's segments and the corners where they meet.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n\
    \x20 corner-impact cam\n\
    \x20 corner-impact cam models/laws/program.toml --out cam.svg\n\
    \n\
    Exit code: 0 done, 2 bad model file, usage or file.")]
pub(super) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    #[command(flatten)]
    answer: AnswerArguments,
    /// Leave out corners where only derivatives above order N jump.
    #[arg(long, value_name = "N", default_value_t = Jet::HIGHEST_JUMP)]
    order: usize,
    /// Draw lift, velocity and acceleration against the cam angle (.svg, .png or .pdf). If the lift is computed from the contour, the cam's shape is drawn
    /// below them.
    #[arg(long, value_name = "FILE", value_parser = picture::picture, group = "picture")]
    out: Option<PathBuf>,
    /// Draw only the cam's shape, for any law, with the end of the follower on it: contour, path of the roller's centre, roller or face.
    #[arg(long, requires = "picture")]
    shape: bool,
    #[command(flatten)]
    picture: picture::PictureArguments,
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let model = arguments.model.read_cam(session)?;
    let progress = Progress::spinner("laying out the cam");
    let cam = Cam::new(&model)?;
    let sheet = CamSheet::new(&model, &cam, arguments.order)?;
    if let Some(path) = &arguments.out {
        let canvas = picture::Canvas::create(path, arguments.picture.request()?)?;
        let figure = match arguments.shape {
            true => shape_figure(&model, &cam, &model.name),
            false => cam_figure(&model, &cam, &model.name),
        };
        canvas.write(figure, &model.units)?;
    }
    drop(progress);
    session.answer(&sheet, &arguments.answer)
}
