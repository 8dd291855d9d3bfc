//! `corner-impact certify [MODEL]`.

use super::numbers::rpm_or_range;
use super::{AnswerArguments, CommandError, Exit, ModelArgument, Session, progress::watched};
use corner_impact::model::Study;
use corner_impact::orbit::Search;
use corner_impact::study::certify::{BITS, CertifyError, certify, proved_counts, proved_orbits, proved_resting};

/// Proves that corner impacts exist, in ball arithmetic.
///
/// Proves their maps and verdicts as well.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n\
    \x20 corner-impact certify\n\
    \x20 corner-impact certify models/osorio-2008.toml --rpm 600:760 --bits 400 --json\n\
    \x20 corner-impact certify --orbits --rpm 700\n\
    \x20 corner-impact certify --orbits --rpm 600:760\n\
    \x20 corner-impact certify --resting --rpm 450\n\
    \n\
    Needs Python with mpmath, python-flint, scipy and sympy; `make verify` sets them up in a clone.\n\
    Exit code: 0 every border collision that `locate` finds is proved, 1 one of them is not, 2 bad model file or usage, or no Python.")]
pub(super) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    /// Range of speeds, rpm [default: the model's [study]]. --orbits also takes one speed. --resting takes only one speed.
    #[arg(long, value_name = "LO:HI|R", value_parser = rpm_or_range)]
    rpm: Option<[f64; 2]>,
    /// Revolutions of the cam after which the orbits first repeat.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..=Search::MOST_REVOLUTIONS))]
    revolutions: u64,
    /// Precision of the balls, in bits.
    #[arg(long, value_name = "N", default_value_t = BITS, value_parser = clap::value_parser!(u32).range(16..=16384))]
    bits: u32,
    /// Prove periodic orbits instead of corner impacts. At one speed: all orbits of one and of two impacts in one revolution. Over a range: the number of one-impact orbits at every speed.
    #[arg(long, requires = "rpm", conflicts_with = "revolutions")]
    orbits: bool,
    /// Prove the motion that follows a rest on the cam, at the speed of --rpm. The precision is doubled where it does not suffice.
    #[arg(long, requires = "rpm", conflicts_with_all = ["revolutions", "orbits"])]
    resting: bool,
    #[command(flatten)]
    answer: AnswerArguments,
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let model = arguments.model.read_as_drawn(session)?;
    if let (true, Some([low, high])) = (arguments.orbits, arguments.rpm) {
        if low < high {
            let found = watched("proving orbits", |_| proved_counts(&model, [low, high], arguments.bits))?;
            session.answer(&found, &arguments.answer)?;
        } else {
            let found = watched("proving orbits", |_| proved_orbits(&model, low, arguments.bits))?;
            session.answer(&found, &arguments.answer)?;
        }
        return Ok(Exit::Agrees);
    }
    if let (true, Some([low, high])) = (arguments.resting, arguments.rpm) {
        if low < high {
            return Err(CommandError::Words("--resting takes one speed: --rpm R".into()));
        }
        let found = watched("proving motions that rest", |_| proved_resting(&model, low, arguments.bits))?;
        session.answer(&found, &arguments.answer)?;
        return Ok(Exit::Agrees);
    }
    let range = match arguments.rpm {
        Some([low, high]) if low == high => {
            let words = format!(
                "--rpm {low} is one speed: corner impacts are certified over a range, --rpm LO:HI; --orbits and --resting take one speed"
            );
            return Err(CommandError::Words(words));
        }
        Some([rpm_min, rpm_max]) => Study { rpm_min, rpm_max },
        None => model.study()?,
    };
    let found = watched("proving corner impacts", |watch| {
        certify(&model, range, arguments.revolutions, arguments.bits, watch).map_err(|error| match error {
            CertifyError::Range(error) => CommandError::Words(format!("{}: {error}", model.file())),
            error => error.into(),
        })
    })?;
    session.answer(&found, &arguments.answer)?;
    Ok(if found.agrees() { Exit::Agrees } else { Exit::Disagrees })
}
