//! `corner-impact chart [MODEL] --x NAME=LO:HI:N --y NAME=LO:HI:N`.

use std::io::Write;
use std::path::PathBuf;

use clap::ValueEnum;

use super::start::{StartArguments, axis, count, rpm};
use super::{CommandError, Exit, ModelArgument, Session, picture, picture::Target, progress::watched};
use crate::diagram::Speeds;
use crate::figures::{Coloured, chart_figure};
use crate::model::Model;
use crate::orbit::Parameter;
use crate::show::csv;
use crate::study::chart::{Axis, Chart, Lengths};

/// Charts over two numbers what a run comes to: its period, its growth, how hard it hits.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n\
    \x20 corner-impact chart --x rpm=600:760:80 --y restitution=0.5:0.95:60 --out periods.svg\n\
    \x20 corner-impact chart --x mass=1:2:30 --y stiffness=1000:2000:30 --rpm 700 --show impact-speed --out speeds.png\n\
    \x20 corner-impact chart models/damped-light.toml --x rpm=600:760:40 --y damping=0:20:20 --out chart.csv\n\
    \n\
    Exit code: 0 done, 2 bad model file, usage or file.")]
pub(super) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    /// What varies across: rpm, or a number of the model; from where to where, and at how many values.
    #[arg(long, value_name = "NAME=LO:HI:N", value_parser = axis)]
    x: (String, Speeds),
    /// What varies upwards, alike.
    #[arg(long, value_name = "NAME=LO:HI:N", value_parser = axis)]
    y: (String, Speeds),
    /// Speed of the cam, rpm, where neither --x nor --y is it.
    #[arg(long, value_name = "RPM", value_parser = rpm, allow_hyphen_values = true)]
    rpm: Option<f64>,
    /// Revolutions within which a run is to settle.
    #[arg(long, value_name = "N", default_value_t = Lengths::default().transient, value_parser = count, allow_hyphen_values = true)]
    transient: u64,
    /// Revolutions after that over which growth is taken of a run that has settled on no orbit; up to 8 times as many where they
    /// tell nothing.
    #[arg(long, value_name = "N", default_value_t = Lengths::default().record, value_parser = count, allow_hyphen_values = true)]
    record: u64,
    #[command(flatten)]
    start: StartArguments,
    /// What the colours of a picture tell.
    #[arg(long, value_enum, default_value = "period")]
    show: ShowName,
    /// Threads [default: one for each core].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// A table (.csv, or - for standard output) or a picture (.svg, .png).
    #[arg(long, value_name = "FILE", value_parser = picture::picture_or_table)]
    out: Option<PathBuf>,
    /// Print a summary as one JSON document.
    #[arg(long)]
    summary: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum ShowName {
    Period,
    Growth,
    Regime,
    Impacts,
    ImpactSpeed,
}

impl ShowName {
    fn coloured(self) -> Coloured {
        match self {
            Self::Period => Coloured::Period,
            Self::Growth => Coloured::Growth,
            Self::Regime => Coloured::Regime,
            Self::Impacts => Coloured::Impacts,
            Self::ImpactSpeed => Coloured::ImpactSpeed,
        }
    }
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let to_standard = picture::out_is_standard(arguments.out.as_ref(), arguments.summary)?;
    let model = arguments.model.read(session)?;
    let named = |(name, values): &(String, Speeds), model: &Model| -> Result<Axis, CommandError> {
        Ok(Axis { parameter: Parameter::named(model, name)?, values: *values })
    };
    let axes = [named(&arguments.x, &model)?, named(&arguments.y, &model)?];
    let lengths = Lengths { transient: arguments.transient, record: arguments.record };
    let chart = Chart::new(&model, arguments.rpm, axes, arguments.start.start(), lengths)?;
    let run = || watched("", |watch| chart.run(arguments.threads.map(usize::from), watch));
    let found = match &arguments.out {
        None => run()?,
        Some(path) => {
            // Begun before the work: a name that cannot be is told at once.
            let target = Target::create(path, &mut *session.out)?;
            let found = run()?;
            let table = |table: &mut dyn Write| Ok(table.write_all(csv::chart(&found).as_bytes())?);
            target.fill(table, || Ok(chart_figure(&found, arguments.show.coloured())))?;
            found
        }
    };
    if !to_standard {
        session.answer(&found, arguments.summary)?;
    }
    Ok(Exit::Agrees)
}
