//! Limits of the numbers that a user asks with, for the command line and Python alike. A message does not name the number: the caller adds
//! the name that it has there.

use super::axis::{Spacing, Values};
use crate::orbit::Search;
use crate::orbit::long_run::Budget;

/// Most threads on a machine with fewer cores. Idle threads search all others for work, so the loss grows with the square of their number.
/// With this number it is a tenth of a second of one core, with four times as many more than a second.
const MOST_THREADS: usize = 256;

/// Checks a number of threads: at most `MOST_THREADS`, or one for each core if there are more cores.
pub fn thread_count(count: u64) -> Result<usize, String> {
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let most = MOST_THREADS.max(cores);
    let count = usize::try_from(count).ok().filter(|count| (1..=most).contains(count));
    count.ok_or_else(|| format!("must be a whole number of threads from 1 to {most}"))
}

/// Checks a speed of the cam, rpm.
pub fn speed(rpm: f64) -> Result<f64, String> {
    match rpm {
        rpm if !(rpm > 0.0 && rpm.is_finite()) => Err("must be a finite number above 0".into()),
        rpm if rpm <= Values::FASTEST => Ok(rpm),
        _ => Err(format!("must be {:e} or less", Values::FASTEST)),
    }
}

/// Checks that two numbers are the ends of a range.
pub fn range([low, high]: [f64; 2]) -> Result<[f64; 2], String> {
    if low < high && (high - low).is_finite() { Ok([low, high]) } else { Err(format!("{low} is not below {high}")) }
}

/// Checks that an axis of this spacing may begin at a value.
pub fn spaced(low: f64, spacing: Spacing) -> Result<Spacing, String> {
    match spacing {
        Spacing::Logarithmic if low <= 0.0 => Err(format!("a logarithmic axis begins above 0, and {low} does not")),
        spacing => Ok(spacing),
    }
}

impl Values {
    /// Checks the values of an axis; `what` is the word for one of them.
    pub fn checked(self, what: &str) -> Result<Self, String> {
        let Self { low, high, count, spacing } = self;
        if !(high >= low && (high - low).is_finite()) {
            return Err(format!("the highest {what}, {high}, is below the lowest, {low}"));
        }
        spaced(low, spacing)?;
        match count {
            0 => Err(format!("must be 1 {what} or more")),
            1 if high > low => Err(format!("1 {what} needs the lowest and the highest to be the same")),
            1..=Self::MOST => Ok(self),
            _ => Err(format!("must be {} {what}s or fewer", Self::MOST)),
        }
    }
}

impl Budget {
    /// Checks a budget by which motions are judged.
    pub fn judging(self) -> Result<Self, String> {
        match self.record {
            0 => Err("record 0: in no revolution nothing grows".into()),
            _ => self.checked(),
        }
    }

    /// Checks a budget by which runs are only recorded.
    pub fn checked(self) -> Result<Self, String> {
        for (name, value, [low, high]) in
            [("longest", self.longest, [1, Search::MOST_REVOLUTIONS]), ("patience", self.patience, [0, Self::MOST])]
        {
            if !(low..=high).contains(&value) {
                return Err(format!("{name} {value}: must be from {low} to {high}"));
            }
        }
        Ok(self)
    }
}
