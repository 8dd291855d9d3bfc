//! Periodic orbits, stable or not: their impacts, their multipliers, and the branches that they form when a number of the
//! model changes.
//!
//! | module | contents |
//! |---|---|
//! | `cycle` | an orbit as its impacts, the equations that close it, Newton's method |
//! | `chain` | linear equations that link each impact with the next, in one pass |
//! | [`stability`] | whether small deviations from an orbit die out |
//! | `departure` | whether a cycle is an orbit of the actual cam, by simulation |
//! | `complete` | all orbits of one impact, or of two in one revolution, by enclosures |
//! | [`mod@search`] | orbits of one machine: those of `complete`, and others from many starts |
//! | [`near`] | the orbit near a guess or near a run |
//! | [`long_run`] | the long-run motion of a run: an orbit, recurring rests or chaos; and how long the run is followed |
//! | [`runs`] | the runs of one machine: where they settle, and what follows when the cam releases the follower |
//! | [`symmetry`] | where an orbit over equal lobes loses its symmetry |
//! | `family` | machines that differ in a speed or a number of the model |
//! | `curve` | pseudo-arclength steps along the solutions of one equation fewer than unknowns |
//! | [`branch`] | branches of orbits through corners, folds, flips and grazes, with those points located |

pub mod branch;
pub(crate) mod chain;
pub(crate) mod complete;
pub(crate) mod curve;
pub(crate) mod cycle;
pub(crate) mod departure;
pub(crate) mod family;
pub mod long_run;
mod multipliers;
mod naming;
#[doc(hidden)]
pub mod near;
#[doc(hidden)]
pub mod runs;
pub mod search;
pub mod stability;
pub(crate) mod sticking;
#[doc(hidden)]
pub mod symmetry;

use nalgebra::Matrix2;

use crate::cam::apart;
use crate::elementary;
use crate::flight::State;
use crate::known::Evidence;
use crate::simulate::{Event, EventKind, Machine, Motion, SimulateError};
use crate::tolerance;
pub use complete::Undecided;
pub use cycle::{Cycle, Impact, NotClosed};
pub(crate) use departure::Departure;
pub(crate) use family::Family;
#[doc(hidden)]
pub use family::FamilyError;
pub use family::Parameter;
pub use multipliers::{Eigenvalue, eigenvalues};
pub use search::{Search, Searched, search, search_all};
pub use stability::{Judgement, Stability};

/// A motion that repeats after a number of revolutions.
#[derive(Clone, Debug, PartialEq)]
pub struct PeriodicOrbit {
    /// Turns of the cam in one period, the smallest number.
    pub revolutions: u64,
    /// Impacts, sticks and releases of one period, from cam angle 0 on.
    pub events: Vec<Event>,
    /// The follower when the cam is at angle 0.
    pub state: State,
    /// Matrix that carries a small deviation of that state over one period, 2x2. It is 0 where the follower sticks on the way. It is NaN
    /// where the follower rests on the cam with restitution 1, since no bounce then ends in a rest.
    pub matrix: Matrix2<f64>,
    /// Whether small deviations die out, and the error of the multipliers.
    pub judgement: Judgement,
    /// Closing error of the orbit, over its size.
    pub residual: f64,
    /// Kind of motion.
    pub course: Course,
    /// Whether the existence of the orbit is proved, or computed.
    pub known: Evidence,
}

// The document lists impacts separately from sticks and releases, and the multipliers instead of the matrix.
document!(PeriodicOrbit as orbit {
    known: orbit.known,
    revolutions: orbit.revolutions,
    impacts: orbit.impacts().map(Met).collect::<Vec<_>>(),
    contact: orbit.rests().map(Rest).collect::<Vec<_>>(),
    state: [orbit.state.position, orbit.state.velocity],
    multipliers: orbit.multipliers(),
    multipliers_known: Evidence::Computed,
    multipliers_error: orbit.judgement.error,
    stability: orbit.judgement.stability,
    stability_known: orbit.judgement.known,
    stable: orbit.is_stable(),
    course: orbit.course.name(),
    residual: orbit.residual,
});

/// An event as an impact of an orbit.
struct Met<'a>(&'a Event);

document!(Met<'_> as it {
    revolution: it.0.revolution,
    cam_angle_rad: it.0.cam_angle,
    velocity_before_m_s: it.0.velocity_before,
    velocity_after_m_s: it.0.velocity_after,
});

/// An event as the start or the end of sticking.
struct Rest<'a>(&'a Event);

document!(Rest<'_> as it { event: it.0.kind, revolution: it.0.revolution, cam_angle_rad: it.0.cam_angle });

/// The kinds of periodic motion.
#[derive(Clone, Debug, PartialEq)]
#[doc(hidden)]
pub enum Course {
    /// Impacts, and flights from one to the next.
    Impacts(Cycle),
    /// Sticking: the follower sticks to the cam at this cam angle, rad. The angle alone determines the motion after it.
    Sticking(f64),
    /// Flight without impacts: the follower never meets the cam.
    Free,
}

impl Course {
    fn name(&self) -> &'static str {
        match self {
            Self::Impacts(_) => "impacts",
            Self::Sticking(_) => "sticking",
            Self::Free => "free",
        }
    }
}

impl PeriodicOrbit {
    /// The orbit of a cycle that closes up to `residual`.
    pub fn of_cycle(machine: &Machine, cycle: Cycle, residual: f64) -> Self {
        let cycle = cycle.in_order();
        let (state, matrix) = cycle.at_section(machine, 0.0);
        let events = cycle.events(machine);
        let judgement = Judgement::of_cycle(machine, &cycle, residual, &matrix);
        let (revolutions, course) = (cycle.revolutions, Course::Impacts(cycle));
        Self { revolutions, events, state, matrix, judgement, residual, course, known: Evidence::Computed }
    }

    /// The impacts of one period.
    pub fn impacts(&self) -> impl Iterator<Item = &Event> {
        self.events.iter().filter(|event| event.kind == EventKind::Impact)
    }

    /// Events at which the follower begins to stick or is released.
    pub fn rests(&self) -> impl Iterator<Item = &Event> {
        self.events.iter().filter(|event| event.kind != EventKind::Impact)
    }

    /// The multipliers: eigenvalues of the matrix.
    pub fn multipliers(&self) -> [Eigenvalue; 2] {
        eigenvalues(&self.matrix)
    }

    /// Whether small deviations die out. They do not for an unstable or a neutral orbit.
    pub fn is_stable(&self) -> bool {
        self.judgement.stability == Stability::Stable
    }

    /// Starts a motion of `machine` on the orbit, where the cam passes angle 0. The run starts from the last impact, since rounding may put
    /// the follower below the cam at angle 0.
    pub fn motion(&self, machine: &Machine) -> Result<Motion, SimulateError> {
        let Some(impact) = self.impacts().last() else { return machine.start(0.0, self.state) };
        let mut motion = machine.start_on_cam(impact.cam_angle, impact.velocity_after - impact.cam_velocity)?;
        machine.turn_to(&mut motion, 0.0)?;
        motion.revolution = 0;
        Ok(motion)
    }

    /// Growth of a small deviation per revolution, a natural logarithm, from the largest multiplier.
    pub fn growth(&self) -> f64 {
        let modulus = self.multipliers().iter().fold(0.0_f64, |largest, one| largest.max(one.modulus()));
        elementary::ln(modulus) / self.revolutions as f64
    }

    /// Whether two orbits are the same motion.
    pub fn is_same(&self, other: &Self) -> bool {
        match (&self.course, &other.course) {
            (Course::Impacts(one), Course::Impacts(other)) => one.is_same(other),
            (Course::Sticking(_), Course::Sticking(_)) => {
                // At most one motion passes through a state in contact, so equal rests are equal motions.
                let [one, two] =
                    [self, other].map(|orbit| orbit.rests().map(|event| event.cam_angle).collect::<Vec<_>>());
                let is_known =
                    |angle: &f64| two.iter().any(|other| apart(*angle, *other) <= tolerance::SAME_ORBIT.value);
                self.revolutions == other.revolutions && one.len() == two.len() && one.iter().all(is_known)
            }
            (Course::Free, Course::Free) => true,
            _ => false,
        }
    }
}

/// Reason why an orbit could not be found or followed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OrbitError {
    /// A run could not go on.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
    /// The machine with these numbers is impossible.
    #[error(transparent)]
    Family(#[from] FamilyError),
    /// Newton's method did not converge.
    #[error(transparent)]
    NotClosed(#[from] NotClosed),
}
