//! What the figures are of: a model, its corner impact where it has one, and the speeds that are shown.

use std::sync::OnceLock;

use crate::border_collision::feigin::{Scenario, Speeds};
use crate::cam::Cam;
use crate::corner::CornerImpact;
use crate::elementary;
use crate::model::{Model, ModelError};
use crate::orbit::branch::Branch;
use crate::simulate::{Machine, angular_velocity};
use crate::study::design::contact::Contact;
use crate::study::speeds::usual_range;
use crate::study::verify::{External, Verification, verify};

/// A model and what is shown of it.
#[derive(Clone, Debug)]
pub struct Subject {
    /// The model.
    pub model: Model,
    /// Its cam.
    pub cam: Cam,
    /// Whether follower, cam and speeds are the paper's.
    pub is_paper: bool,
    /// What `verify` found for it, or why it found nothing.
    pub findings: Result<Verification, String>,
    /// The speeds that are shown.
    pub shown: Shown,
    /// Those that were chosen, rpm.
    pub(crate) rpm: Option<[f64; 2]>,
    /// How fine the sweep above detachment is: `Effort::SLOW`.
    pub slow_effort: Effort,
    /// How fine the sweeps around the corner impact are: `Effort::FAST`.
    pub fast_effort: Effort,
    /// The branches over the fast ones, once they have been followed: more than one figure shows them.
    pub(crate) followed: OnceLock<Result<Vec<Branch>, String>>,
}

/// How fine a sweep is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Speeds, evenly over the range.
    pub speeds: usize,
    /// Revolutions at each before anything is recorded.
    pub transient: u64,
    /// Revolutions that are recorded.
    pub record: u64,
}

impl Effort {
    /// Of a report above detachment: a follower that chatters has forgotten its start once it has come to rest.
    pub(crate) const SLOW: Self = Self { speeds: 800, transient: 40, record: 5 };
    /// Of a report around the corner impact.
    pub(crate) const FAST: Self = Self { speeds: 480, transient: 300, record: 150 };
}

/// The speeds that are shown, rpm, or why there are none.
#[derive(Clone, Debug, PartialEq)]
pub struct Shown {
    /// Where chattering is looked at.
    pub slow: Result<Slow, String>,
    /// Where the corner impact is.
    pub fast: Result<Fast, String>,
}

/// Speeds above that at which the follower first leaves the cam, rpm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slow {
    /// Of the trace, the gap and the phase plane.
    pub chattering: f64,
    /// Of the impact diagram.
    pub range: [f64; 2],
    /// Of the trace with interrupted chattering.
    pub interrupted: f64,
}

/// Speeds around that of the corner impact, rpm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fast {
    /// Of the impact and the stroboscopic diagram.
    pub range: [f64; 2],
    /// On the side of the corner impact where, at a fold, its orbit is gone.
    pub beyond: f64,
}

impl Shown {
    /// The paper's speeds.
    pub(crate) const PAPERS: (Slow, Fast) = (
        Slow { chattering: 183.0, range: [115.0, 200.0], interrupted: 175.0 },
        Fast { range: [660.0, 750.0], beyond: 670.0 },
    );
    /// Where the paper's follower leaves its cam and where its corner impact is, rpm: other models are shown at speeds in
    /// the same proportion to theirs.
    const PAPERS_OWN: [f64; 2] = [114.978_9, 673.234_445];

    /// The speeds in proportion to where the follower leaves the cam.
    fn slow(detachment: f64) -> Slow {
        let (slow, _) = Self::PAPERS;
        let scale = detachment / Self::PAPERS_OWN[0];
        Slow {
            chattering: rounded(slow.chattering * scale),
            range: slow.range.map(|rpm| rounded(rpm * scale)),
            interrupted: rounded(slow.interrupted * scale),
        }
    }

    /// Speeds that were chosen: from the lowest to the highest, with traces in the middle and at the end.
    fn chosen([low, high]: [f64; 2]) -> Slow {
        Slow { chattering: rounded(0.5 * (low + high)), range: [low, high], interrupted: high }
    }

    /// The speeds in proportion to that of the corner impact.
    fn fast(at: &CornerImpact, falls: bool) -> Fast {
        let (_, fast) = Self::PAPERS;
        let own = at.speed_rpm();
        // Where the orbit is gone at faster speeds, a proportion is that of the periods.
        let placed = |rpm: f64| if falls { rpm / Self::PAPERS_OWN[1] } else { Self::PAPERS_OWN[1] / rpm } * own;
        let [one, other] = fast.range.map(placed);
        let range = if falls { [one, other] } else { [other, one] };
        Fast { range: range.map(rounded), beyond: rounded(placed(fast.beyond)) }
    }
}

/// Why there is no corner impact where none is looked for.
pub(crate) const NO_STUDY: &str =
    "the model file has no [study], which says at which speeds to look for a corner impact";

/// Four digits, as a person would choose a speed.
fn rounded(rpm: f64) -> f64 {
    let scale = 10_f64.powi(3 - elementary::log10(rpm.abs()).floor() as i32);
    let round = (rpm * scale).round() / scale;
    if round.is_finite() { round } else { rpm }
}

impl Subject {
    /// A model as it is, verified without programs outside, at speeds of this range, rpm, or of its own.
    pub fn new(model: &Model, rpm: Option<[f64; 2]>) -> Result<Self, ModelError> {
        let findings = verify(model, External::LeftOut).map_err(|error| error.to_string());
        Self::with(model, findings, rpm)
    }

    /// A model with what `verify` found for it, or why that found nothing.
    pub(crate) fn with(
        model: &Model,
        findings: Result<Verification, String>,
        rpm: Option<[f64; 2]>,
    ) -> Result<Self, ModelError> {
        let cam = Cam::new(model)?;
        let paper = model.is_the_papers()?;
        let [slowest, fastest] = usual_range(model)?;
        let slow = if let Some(chosen) = rpm {
            Ok(Shown::chosen(chosen))
        } else if paper {
            Ok(Shown::PAPERS.0)
        } else {
            let leaves = Contact::new(&cam, model.follower).separation().speed();
            (slowest < leaves && leaves <= fastest).then(|| Shown::slow(leaves)).ok_or_else(|| {
                format!(
                    "from {slowest} to {fastest} rpm there is no speed at which the follower begins to leave the cam: it leaves it at \
                     each, or at none"
                )
            })
        };
        let fast = match &findings {
            Ok(_) if paper => Ok(Shown::PAPERS.1),
            Ok(found) => {
                let kind = found.classification.as_ref().ok();
                let rises = kind.is_some_and(|kind| {
                    kind.scenario == Scenario::NonsmoothFold && kind.plus.exists_for == Speeds::Slower
                });
                Ok(Shown::fast(&found.at, !rises))
            }
            Err(_) if model.study.is_none() => Err(NO_STUDY.into()),
            Err(why) => Err(why.clone()),
        };
        // One reason for every figure of the corner impact.
        let findings = match &fast {
            Ok(_) => findings,
            Err(why) => Err(why.clone()),
        };
        Ok(Self {
            model: model.clone(),
            cam,
            // What the paper says of its speeds is not said of others.
            is_paper: paper && rpm.is_none(),
            findings,
            shown: Shown { slow, fast },
            rpm,
            slow_effort: Effort::SLOW,
            fast_effort: Effort::FAST,
            followed: OnceLock::new(),
        })
    }

    /// What `verify` found, or why it found nothing.
    pub fn found(&self) -> Result<&Verification, String> {
        self.findings.as_ref().map_err(Clone::clone)
    }

    /// What happens at the corner impact, where that is classified.
    pub(crate) fn scenario(&self) -> Option<Scenario> {
        Some(self.found().ok()?.classification.as_ref().ok()?.scenario)
    }

    /// Whether the orbits of the corner impact are gone beyond it.
    pub(crate) fn is_fold(&self) -> bool {
        self.scenario() == Some(Scenario::NonsmoothFold)
    }

    /// The machine at a speed, rpm.
    pub(crate) fn machine(&self, rpm: f64) -> Machine {
        Machine::new(self.cam.clone(), &self.model.follower, angular_velocity(rpm))
    }

    /// A title with speeds above detachment, or without where there are none.
    pub(crate) fn slow_title(&self, without: &str, with: impl Fn(&Slow) -> String) -> String {
        let words = self.shown.slow.as_ref().map_or_else(|_| without.into(), with);
        format!("{}: {words}", self.model.name)
    }

    /// A title with speeds around the corner impact, or without where there is none.
    pub(crate) fn fast_title(&self, without: &str, with: impl Fn(&Fast) -> String) -> String {
        let words = self.shown.fast.as_ref().map_or_else(|_| without.into(), with);
        format!("{}: {words}", self.model.name)
    }
}
