//! What one run ends on.

use std::ops::ControlFlow;

use crate::diagram::growth;
use crate::orbit::PeriodicOrbit;
use crate::orbit::cycle::lift_size;
use crate::orbit::search::settled;
use crate::simulate::{Event, Machine, Motion, SimulateError};
use crate::tolerance;

/// How long a run is waited for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Patience {
    /// Revolutions within which it must have settled on an orbit, or else is none.
    pub revolutions: u64,
    /// The longest period looked for, revolutions.
    pub longest: u64,
}

impl Default for Patience {
    fn default() -> Self {
        Self { revolutions: 1600, longest: 8 }
    }
}

/// What a run ends on.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// A stable periodic orbit.
    Orbit(PeriodicOrbit),
    /// No orbit as short as was looked for, and small deviations grow.
    Chaotic,
    /// No orbit as short as was looked for, but the follower comes to rest on the cam: what follows can only repeat.
    Resting,
    /// None of these.
    Undecided,
}

impl Ending {
    /// The name of an ending in tables.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Orbit(_) => "orbit",
            Self::Chaotic => "chaotic",
            Self::Resting => "resting",
            Self::Undecided => "undecided",
        }
    }

    /// Whether two runs end alike: on the same orbit, or on none of the same kind.
    pub fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Orbit(one), Self::Orbit(two)) => one.is_same(two),
            _ => std::mem::discriminant(self) == std::mem::discriminant(other),
        }
    }

    /// Whether this is an orbit.
    pub fn is_orbit(&self) -> bool {
        matches!(self, Self::Orbit(_))
    }
}

/// What the run from `motion` ends on.
///
/// An orbit counts where the run repeats nearly, Newton's method leads from there to a stable one, and the run has come to
/// that: a chaotic run now and then passes by a stable orbit outside of its basin.
pub fn ending(machine: &Machine, mut motion: Motion, patience: Patience) -> Result<Ending, SimulateError> {
    /// Revolutions before the first look: what most starts near a stable orbit need.
    const FIRST: u64 = 50;
    /// Revolutions over which growth is averaged.
    const RECORD: u64 = 400;
    let (mut run, mut stretch) = (0, FIRST.min(patience.revolutions));
    while stretch > 0 {
        let goal = motion.after(stretch);
        let _ = machine.advance(&mut motion, goal, &mut |_: &Event| ControlFlow::Continue(()))?;
        run += stretch;
        if let Some(orbit) = settled(machine, motion, 0, patience.longest)?.filter(PeriodicOrbit::is_stable)
            && arrived(machine, motion, &orbit)?
        {
            return Ok(Ending::Orbit(orbit));
        }
        stretch = run.min(patience.revolutions - run);
    }
    let exponent = growth(machine, motion, RECORD)?;
    Ok(if exponent > tolerance::CHAOTIC_GROWTH.value {
        Ending::Chaotic
    } else if exponent == f64::NEG_INFINITY {
        Ending::Resting
    } else {
        Ending::Undecided
    })
}

/// Whether `motion` is on `orbit` to within what is left of a start that comes to it: for one period, each time that the cam
/// passes angle 0, it is held against the orbit's state there.
fn arrived(machine: &Machine, mut motion: Motion, orbit: &PeriodicOrbit) -> Result<bool, SimulateError> {
    let size = lift_size(machine);
    for _ in 0..orbit.revolutions {
        let goal = motion.next(0.0);
        let _ = machine.advance(&mut motion, goal, &mut |_: &Event| ControlFlow::Continue(()))?;
        let apart = super::manifold::apart(motion.state, orbit.state, machine.angular_velocity());
        if apart <= tolerance::ARRIVED.value * size {
            return Ok(true);
        }
    }
    Ok(false)
}
