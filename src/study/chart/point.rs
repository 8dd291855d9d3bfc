//! What one run comes to: a point of a chart, and a row of a diagram.

use crate::diagram::{Record, growth_and_error};
use crate::estimate::{ErrorIs, Estimate};
use crate::orbit::PeriodicOrbit;
use crate::orbit::ending::{Ending, Kind, Resting};
use crate::orbit::fate::{Fate, Run, Settling};
use crate::simulate::{Machine, Met, Motion, SimulateError};
use crate::study::attractors::Patience;

/// For how long a run is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lengths {
    /// Revolutions within which it is to settle.
    pub transient: u64,
    /// Revolutions after that over which the growth of a deviation is taken, where it has settled on no orbit; up to
    /// [`RECORDS`] times as many where that tells nothing yet.
    pub record: u64,
}

impl Default for Lengths {
    fn default() -> Self {
        Self { transient: 300, record: 100 }
    }
}

/// Records of a run of which nothing can be told, before it is undecided.
pub const RECORDS: u32 = 8;

/// What a run comes to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// The kind of motion.
    pub kind: Kind,
    /// Turns of the cam of one period; 0 where it does not repeat, or where doubles cannot tell after how long.
    pub revolutions: u64,
    /// Impacts of one period; 0 where there is none.
    pub impacts: u64,
    /// Impacts a revolution: of the period, or of what was recorded.
    pub impact_rate: f64,
    /// The growth of a small deviation a revolution, a natural logarithm: of an orbit by its multipliers, without error; minus
    /// infinity where the follower rests; else the mean over the record.
    pub growth: Estimate,
    /// The speed of the fastest impact, of follower and cam against each other, m/s.
    pub impact_speed: f64,
}

impl Point {
    /// What `motion` comes to, by the rules that `study::attractors` goes by for many.
    pub fn of(machine: &Machine, mut motion: Motion, lengths: Lengths) -> Result<Self, SimulateError> {
        /// Parts of a record that its growth is the mean of, and revolutions of one at most.
        const PARTS: u64 = 8;
        const BLOCK: u64 = 25;
        /// Revolutions from one record to the next, with a look for an orbit.
        const LOOK: u64 = 8;
        let waiting = |rest| Settling::unaided(machine, Patience::default().longest, rest);
        let fresh = || Record::over((lengths.record / PARTS).clamp(1, BLOCK));
        let (mut settling, mut record) = (waiting(lengths.transient), fresh());
        let mut run = settling.run(&mut motion, lengths.transient)?;
        for _ in 0..RECORDS {
            match run {
                Run::Arrives(orbit) => return Ok(Self::on(&orbit)),
                Run::Stays => return Ok(Self::at_rest(Kind::Stays, (1, 0), Met::default())),
                Run::Released(cam_angle) => match settling.fate(cam_angle)? {
                    Fate::Recurs(resting) => return Ok(Self::resting(&resting)),
                    Fate::Arrives(orbit, _) => return Ok(Self::on(&orbit)),
                    Fate::Wanders { end, .. } => motion = end,
                },
                Run::Wanders => {}
            }
            if record.rests() {
                record = fresh();
            }
            record.take(machine, &mut motion, lengths.record)?;
            if record.rests() {
                // The cam may have let go of it already; and from one rest to the next it takes longer than the transient.
                let rest = lengths.transient.saturating_add(lengths.record);
                settling = waiting(rest);
                run = settling.run(&mut motion, rest)?;
            } else if record.met.impacts > 0 && Ending::by_growth(record.growth()).kind() == Kind::Chaotic {
                // A deviation of a flight without end grows as well, if ever more slowly.
                return Ok(Self::wandering(Kind::Chaotic, &record));
            } else {
                run = settling.run(&mut motion, LOOK)?;
            }
        }
        Ok(Self::wandering(Kind::Undecided, &record))
    }

    fn on(orbit: &PeriodicOrbit) -> Self {
        let mut met = Met::default();
        orbit.impacts().for_each(|impact| met.take(impact));
        Self { growth: of_orbit(orbit), ..Self::at_rest(Kind::Periodic, (orbit.revolutions, met.impacts), met) }
    }

    fn resting(of: &Resting) -> Self {
        let Resting { revolutions, impacts, impact_speed, .. } = *of;
        let period = if of.is_long() { (0, 0) } else { (revolutions, impacts) };
        let found = Self::at_rest(Kind::Resting, period, Met { impacts, impact_speed });
        Self { impact_rate: impacts as f64 / revolutions as f64, ..found }
    }

    /// A motion that forgets what it was.
    fn at_rest(kind: Kind, (revolutions, impacts): (u64, u64), met: Met) -> Self {
        let impact_rate = met.impacts as f64 / revolutions as f64;
        let growth = exactly(f64::NEG_INFINITY);
        Self { kind, revolutions, impacts, impact_rate, growth, impact_speed: met.impact_speed }
    }

    fn wandering(kind: Kind, record: &Record) -> Self {
        let (revolutions, met) = (record.revolutions as f64, record.met);
        let impact_rate = met.impacts as f64 / revolutions;
        let (growth, impact_speed) = (record.growth(), met.impact_speed);
        Self { kind, revolutions: 0, impacts: 0, impact_rate, growth, impact_speed }
    }
}

/// The growth of a small deviation of `motion` a revolution: of a motion that repeats by the multipliers of its orbit, else the
/// mean over `revolutions`, with its error; minus infinity where the follower comes to stick to the cam in them.
pub fn growth(machine: &Machine, motion: Motion, revolutions: u64) -> Result<Estimate, SimulateError> {
    /// Blocks of revolutions whose exponents tell the error of their mean.
    const BLOCKS: u32 = 20;
    let longest = Patience::default().longest;
    let mut probe = motion;
    if let Run::Arrives(orbit) = Settling::unaided(machine, longest, 0).run(&mut probe, longest.min(revolutions))? {
        return Ok(of_orbit(&orbit));
    }
    let (value, error) = growth_and_error(machine, motion, revolutions, BLOCKS)?;
    Ok(Estimate { value, error: error.unwrap_or(f64::NAN), error_is: ErrorIs::Standard })
}

fn of_orbit(orbit: &PeriodicOrbit) -> Estimate {
    let modulus = orbit.multipliers().iter().fold(0.0_f64, |largest, one| largest.max(one.modulus()));
    exactly(modulus.ln() / orbit.revolutions as f64)
}

fn exactly(value: f64) -> Estimate {
    Estimate { value, error: 0.0, error_is: ErrorIs::Correction }
}
