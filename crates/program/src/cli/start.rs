//! Arguments that more than one subcommand takes: speeds, and where a run starts.

use std::f64::consts::TAU;

use super::CommandError;
use super::session::Session;
use corner_impact::cam::within_a_turn;
use corner_impact::flight::State;
use corner_impact::orbit::long_run::Budget;
use corner_impact::study::survey::{Placed, Sample, Spacing, Start, Values, limits};
use corner_impact::untrusted;

/// Where the run starts, or the runs of a survey.
#[derive(clap::Args)]
pub(super) struct StartArguments {
    /// Cam angle at the start, rad or as 90deg.
    #[arg(long, value_name = "RAD", default_value_t = 0.0, value_parser = angle, allow_hyphen_values = true)]
    pub(super) start_angle: f64,
    /// Position and velocity at the start, in the model's units. A survey of many starts takes it repeatedly, in place of its sample.
    #[arg(long, value_name = "Q,V", value_parser = state, allow_hyphen_values = true, conflicts_with = "relative_velocity")]
    state: Vec<State>,
    /// Start on the cam and leave it at this velocity, m/s, 0 or more [default: 0].
    #[arg(long, value_name = "U", value_parser = not_negative, allow_hyphen_values = true)]
    relative_velocity: Option<f64>,
}

impl StartArguments {
    /// Asks about the angle, once.
    pub(super) fn doubt(&self, session: &mut Session<'_>) {
        cam_angle("--start-angle", self.start_angle, session);
    }

    /// The one start of a run.
    pub(super) fn start(&self) -> Result<Start, CommandError> {
        match self.given().as_deref() {
            None => Ok(self.on_cam(0.0)),
            Some([start]) => Ok(*start),
            Some(all) => {
                let words = format!("--state is given {} times, and one run has one start", all.len());
                Err(CommandError::Words(words))
            }
        }
    }

    /// The starts that are named, if any are.
    pub(super) fn given(&self) -> Option<Vec<Start>> {
        let at = |state: &State| Start { follower: Placed::At(*state), ..self.on_cam(0.0) };
        let states: Vec<Start> = self.state.iter().map(at).collect();
        self.relative_velocity
            .map(|velocity| vec![self.on_cam(velocity)])
            .or(Some(states).filter(|all| !all.is_empty()))
    }

    /// The given states, or a sample of `spread` starts.
    pub(super) fn sample(&self, spread: usize) -> Sample {
        self.given().map_or(Sample::Spread(spread), Sample::Given)
    }

    fn on_cam(&self, relative_velocity: f64) -> Start {
        Start { cam_angle: within_a_turn(self.start_angle), follower: Placed::OnCam(relative_velocity) }
    }
}

/// For how long runs are followed before it is said what they come to.
#[derive(clap::Args)]
pub(super) struct BudgetArguments {
    /// Revolutions within which a run is to settle [default: 200, in a chart or a diagram 300].
    #[arg(long, value_name = "N", value_parser = count, allow_hyphen_values = true)]
    transient: Option<u64>,
    /// Revolutions after that over which growth is taken of a run that has settled on no orbit; up to 8 times as many where they
    /// tell nothing [default: 1600, in design 200, in a chart or a diagram 100].
    #[arg(long, value_name = "N", value_parser = count, allow_hyphen_values = true)]
    record: Option<u64>,
    /// The longest period of an orbit, revolutions [default: 32].
    #[arg(long, value_name = "N", value_parser = count, allow_hyphen_values = true)]
    longest: Option<u64>,
    /// Revolutions for which runs that settle on nothing are followed before that is called chaos, all together: the longer, the rarer the
    /// rests that are seen [default: 100000, in design, a chart or a diagram 0].
    #[arg(long, value_name = "N", value_parser = count, allow_hyphen_values = true)]
    patience: Option<u64>,
}

impl BudgetArguments {
    /// The budget that is asked for; numbers that are not named are those of `usual`. A record of no revolutions is refused.
    pub(super) fn budget(&self, usual: Budget) -> Result<Budget, CommandError> {
        self.asked(usual).judging().map_err(|words| CommandError::Words(format!("--{words}")))
    }

    /// The revolutions that are asked for, of a diagram that judges no run.
    pub(super) fn lengths(&self, usual: Budget) -> Result<Budget, CommandError> {
        self.asked(usual).checked().map_err(|words| CommandError::Words(format!("--{words}")))
    }

    fn asked(&self, usual: Budget) -> Budget {
        Budget {
            transient: self.transient.unwrap_or(usual.transient),
            record: self.record.unwrap_or(usual.record),
            longest: self.longest.unwrap_or(usual.longest),
            patience: self.patience.unwrap_or(usual.patience),
        }
    }
}

/// An angle of the cam, in [0, 2 pi): one of more than a turn is asked about, since whoever forgets the unit means degrees.
pub(super) fn cam_angle(option: &str, angle: f64, session: &mut Session<'_>) -> f64 {
    let of_turn = within_a_turn(angle);
    if angle.abs() > TAU {
        let degrees = of_turn.to_degrees();
        session.note(&format!("{option}: {angle} rad is {degrees:.4} deg of a turn; {angle}deg is in degrees"));
    }
    of_turn
}

pub(super) fn finite(text: &str) -> Result<f64, String> {
    let number: f64 = text.trim().parse().map_err(|_| format!("\"{}\" is not a number", untrusted::value(text)))?;
    if number.is_finite() { Ok(number) } else { Err("must be a finite number".into()) }
}

/// An angle, rad: `1.57`, or `90deg`.
pub(super) fn angle(text: &str) -> Result<f64, String> {
    match text.trim().strip_suffix("deg") {
        Some(degrees) => finite(degrees).map(f64::to_radians),
        None => finite(text),
    }
}

pub(super) fn positive(text: &str) -> Result<f64, String> {
    let number = finite(text)?;
    if number > 0.0 { Ok(number) } else { Err("must be a finite number above 0".into()) }
}

pub(super) fn not_negative(text: &str) -> Result<f64, String> {
    let number = finite(text)?;
    if number >= 0.0 { Ok(number) } else { Err("must be a finite number, 0 or more".into()) }
}

/// How many of something.
pub(super) fn count(text: &str) -> Result<u64, String> {
    text.trim().parse().map_err(|_| format!("must be a whole number from 0 to {}, written in digits", u64::MAX))
}

/// A speed that a simulation can turn at.
pub(super) fn rpm(text: &str) -> Result<f64, String> {
    limits::speed(finite(text)?)
}

/// `LO:HI` of what `number` takes.
fn ends(text: &str, number: fn(&str) -> Result<f64, String>) -> Result<[f64; 2], String> {
    let (low, high) = text.split_once(':').ok_or("must be LO:HI: from where to where")?;
    limits::range([number(low)?, number(high)?])
}

/// `LO:HI`, any numbers.
pub(super) fn range(text: &str) -> Result<[f64; 2], String> {
    ends(text, finite)
}

/// `LO:HI`, speeds.
pub(super) fn rpm_range(text: &str) -> Result<[f64; 2], String> {
    ends(text, rpm)
}

/// `LO:HI`, speeds, or `R` for a range of one.
pub(super) fn rpm_or_range(text: &str) -> Result<[f64; 2], String> {
    if text.contains(':') { rpm_range(text) } else { rpm(text).map(|rpm| [rpm; 2]) }
}

/// `NAME=LO:HI`.
pub(super) fn parameter(text: &str) -> Result<(String, [f64; 2]), String> {
    let Some((name, ends)) = text.split_once('=').filter(|(_, ends)| ends.contains(':')) else {
        return Err("must be NAME=LO:HI: what changes, and from where to where".into());
    };
    Ok((name.trim().into(), range(ends)?))
}

/// `LO:HI:N` or `LO:HI:N:log`, speeds.
pub(super) fn speeds(text: &str) -> Result<Values, String> {
    spaced(text, rpm, "speed")
}

/// `NAME=LO:HI`, with how many values and the spacing, if these are named.
pub(super) type RangeAxis = (String, [f64; 2], Option<u32>, Spacing);

/// `NAME=LO:HI`, `NAME=LO:HI:N`, `NAME=LO:HI:log` or `NAME=LO:HI:N:log`.
pub(super) fn range_axis(text: &str) -> Result<RangeAxis, String> {
    let bare = text.trim_end();
    let (bare, spacing) =
        bare.strip_suffix(":log").map_or((bare, Spacing::Linear), |bare| (bare, Spacing::Logarithmic));
    if let Ok((name, [low, high])) = parameter(bare) {
        return Ok((name, [low, high], None, limits::spaced(low, spacing)?));
    }
    let (name, Values { low, high, count, spacing }) = axis(text)?;
    match u32::try_from(count).ok().filter(|count| (2..=100_000).contains(count)) {
        Some(count) if low < high => Ok((name, [low, high], Some(count), spacing)),
        Some(_) => Err(format!("{low} is not below {high}")),
        None => Err(format!("{count} values: there must be 2 to 100000")),
    }
}

/// One speed, or several of them.
#[derive(Clone, Copy, Debug)]
pub(super) enum Rpm {
    One(f64),
    Range(Values),
}

/// `R`, or `LO:HI:N`.
pub(super) fn rpm_or_speeds(text: &str) -> Result<Rpm, String> {
    if text.contains(':') { speeds(text).map(Rpm::Range) } else { rpm(text).map(Rpm::One) }
}

/// `NAME=LO:HI:N` or `NAME=LO:HI:N:log`.
pub(super) fn axis(text: &str) -> Result<(String, Values), String> {
    let Some((name, values)) = text.split_once('=') else {
        return Err("must be NAME=LO:HI:N: what changes, from where to where, and at how many values".into());
    };
    let name = name.trim();
    let values = if name == "rpm" { speeds(values) } else { spaced(values, finite, "value") };
    Ok((name.into(), values?))
}

/// `LO:HI:N` of what `number` takes, spaced evenly or, with `:log`, evenly in the logarithm.
fn spaced(text: &str, number: fn(&str) -> Result<f64, String>, what: &str) -> Result<Values, String> {
    let parts: Vec<&str> = text.split(':').collect();
    let (low, high, count, spacing) = match parts.as_slice() {
        [low, high, count] => (low, high, count, Spacing::Linear),
        [low, high, count, spacing] if spacing.trim() == "log" => (low, high, count, Spacing::Logarithmic),
        [_, _, _, other] => return Err(format!("\"{}\" is no spacing: it can only be log", untrusted::value(other))),
        _ => {
            return Err(format!(
                "must be LO:HI:N: lowest {what}, highest {what}, how many; and :log, if they are to be spaced by it"
            ));
        }
    };
    let (low, high) = (number(low)?, number(high)?);
    let count: usize =
        count.trim().parse().map_err(|_| format!("\"{}\" is not a number of {what}s", untrusted::value(count)))?;
    Values { low, high, count, spacing }.checked(what)
}

pub(super) fn state(text: &str) -> Result<State, String> {
    let Some((position, velocity)) = text.split_once(',') else {
        return Err("must be Q,V: a position and a velocity".into());
    };
    Ok(State { position: finite(position)?, velocity: finite(velocity)? })
}
