//! Starts of runs, and the number of revolutions for which they are followed.

use std::f64::consts::TAU;

use super::CommandError;
use super::numbers::{angle, count, finite, not_negative};
use super::session::Session;
use corner_impact::cam::within_a_turn;
use corner_impact::flight::State;
use corner_impact::orbit::long_run::Budget;
use corner_impact::study::survey::{Placed, Sample, Start};

/// Start of a run, or of the runs of a survey.
#[derive(clap::Args)]
pub(super) struct StartArguments {
    /// Cam angle at the start, in rad or as 90deg.
    #[arg(long, value_name = "RAD", default_value_t = 0.0, value_parser = angle, allow_hyphen_values = true)]
    pub(super) start_angle: f64,
    /// Position and velocity at the start, in the model's units. Commands that run many starts take it repeatedly, in place of their sample.
    #[arg(long, value_name = "Q,V", value_parser = state, allow_hyphen_values = true, conflicts_with = "relative_velocity")]
    state: Vec<State>,
    /// Start on the cam with this velocity relative to it, in the model's units, 0 or more [default: 0].
    #[arg(long, value_name = "U", value_parser = not_negative, allow_hyphen_values = true)]
    relative_velocity: Option<f64>,
}

impl StartArguments {
    /// Asks once about a doubtful angle.
    pub(super) fn doubt(&self, session: &mut Session<'_>) {
        cam_angle("--start-angle", self.start_angle, session);
    }

    /// Returns the start of a single run.
    pub(super) fn start(&self) -> Result<Start, CommandError> {
        match self.given().as_deref() {
            None => Ok(self.on_cam(0.0)),
            Some([start]) => Ok(*start),
            Some(all) => {
                let words = format!("--state is given {} times, but one run has one start", all.len());
                Err(CommandError::Words(words))
            }
        }
    }

    /// Returns the given starts, if any.
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

/// Lengths of runs, after which their motions are classified.
#[derive(clap::Args)]
pub(super) struct BudgetArguments {
    /// Revolutions within which a run should settle [default: 200; 300 in chart and diagram].
    #[arg(long, value_name = "N", value_parser = count, allow_hyphen_values = true)]
    transient: Option<u64>,
    /// Revolutions after that, over which the growth rate of a run without a period is measured. Up to 8 times as many follow while the result is undecided
    /// [default: 1600; 200 in design, 100 in chart and diagram].
    #[arg(long, value_name = "N", value_parser = count, allow_hyphen_values = true)]
    record: Option<u64>,
    /// Longest period of an orbit, in revolutions [default: 32].
    #[arg(long, value_name = "N", value_parser = count, allow_hyphen_values = true)]
    longest: Option<u64>,
    /// Revolutions for which runs that do not settle are followed before they are called chaotic, in total. A larger number finds rarer rests [default: 100000;
    /// 0 in design, chart and diagram].
    #[arg(long, value_name = "N", value_parser = count, allow_hyphen_values = true)]
    patience: Option<u64>,
}

impl BudgetArguments {
    /// Returns the requested budget; missing numbers are those of `usual`. A record of no revolutions is rejected.
    pub(super) fn budget(&self, usual: Budget) -> Result<Budget, CommandError> {
        self.asked(usual).judging().map_err(|words| CommandError::Words(format!("--{words}")))
    }

    /// Returns the requested numbers of revolutions, for a diagram that judges no run.
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

/// Angle of the cam, in [0, 2 pi). An angle of more than a turn is questioned, since without a unit degrees are usually meant.
pub(super) fn cam_angle(option: &str, angle: f64, session: &mut Session<'_>) -> f64 {
    let of_turn = within_a_turn(angle);
    if angle.abs() > TAU {
        let degrees = of_turn.to_degrees();
        session.note(&format!(
            "{option}: {angle} rad is more than a turn and means {degrees:.4} deg; for degrees, write {angle}deg"
        ));
    }
    of_turn
}

pub(super) fn state(text: &str) -> Result<State, String> {
    let Some((position, velocity)) = text.split_once(',') else {
        return Err("must be Q,V: a position and a velocity".into());
    };
    Ok(State { position: finite(position)?, velocity: finite(velocity)? })
}
