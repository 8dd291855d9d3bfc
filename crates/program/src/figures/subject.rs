//! Context of the figures: a model, its corner impact if it has one, and the speeds shown.

use std::sync::OnceLock;

use corner_impact::border_collision::feigin::{Scenario, Speeds};
use corner_impact::cam::Cam;
use corner_impact::corner::CornerImpact;
use corner_impact::elementary;
use corner_impact::model::{Model, ModelError};
use corner_impact::orbit::branch::Branch;
use corner_impact::simulate::{Machine, angular_velocity};
use corner_impact::study::design::contact::Contact;
use corner_impact::study::speeds::usual_range;
use corner_impact::study::verify::{External, Verification, verify};

/// Model and the results shown for it.
#[derive(Clone, Debug)]
pub struct FigureContext {
    /// The model.
    pub model: Model,
    /// Cam of the model.
    pub cam: Cam,
    /// Whether follower, cam and speeds are the paper's.
    pub is_paper: bool,
    /// Result of `verify`, or the reason for its failure.
    pub findings: Result<Verification, String>,
    /// Speeds in the figures.
    pub shown: ShownSpeeds,
    /// Range of speeds that the user chose, rpm.
    pub(crate) rpm: Option<[f64; 2]>,
    /// Effort of the sweep above detachment: `Effort::SLOW`.
    pub slow_effort: Effort,
    /// Effort of the sweeps around the corner impact: `Effort::FAST`.
    pub fast_effort: Effort,
    /// Branches over the fast speeds, cached because several figures show them.
    pub(crate) followed: OnceLock<Result<Vec<Branch>, String>>,
}

/// Resolution of a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Number of speeds, evenly spaced over the range.
    pub speeds: usize,
    /// Revolutions at each speed before recording.
    pub transient: u64,
    /// Recorded revolutions.
    pub record: u64,
}

impl Effort {
    /// Effort of a report above detachment: a chattering follower forgets its start when it comes to rest.
    pub(crate) const SLOW: Self = Self { speeds: 800, transient: 40, record: 5 };
    /// Effort of a report around the corner impact.
    pub(crate) const FAST: Self = Self { speeds: 480, transient: 300, record: 150 };
}

/// Speeds shown, rpm, or the reasons why there are none.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownSpeeds {
    /// Speeds with chattering.
    pub slow: Result<Slow, String>,
    /// Speeds around the corner impact.
    pub fast: Result<Fast, String>,
}

/// Speeds above detachment, the speed at which the follower first leaves the cam, rpm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slow {
    /// Speed of the trace, the gap and the phase plane.
    pub chattering: f64,
    /// Range of the impact diagram.
    pub range: [f64; 2],
    /// Speed of the trace with interrupted chattering.
    pub interrupted: f64,
}

/// Speeds around the corner impact's speed, rpm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fast {
    /// Range of the impact and the stroboscopic diagram.
    pub range: [f64; 2],
    /// Speed on the side of the corner impact where, at a fold, its orbit no longer exists.
    pub beyond: f64,
}

impl ShownSpeeds {
    /// Speeds of the paper.
    pub(crate) const PAPERS: (Slow, Fast) = (
        Slow { chattering: 183.0, range: [115.0, 200.0], interrupted: 175.0 },
        Fast { range: [660.0, 750.0], beyond: 670.0 },
    );
    /// Speeds at which the paper's follower leaves its cam and at which its corner impact occurs, rpm. For other models, the shown speeds
    /// are in the same proportion to the model's.
    const PAPERS_OWN: [f64; 2] = [114.978_9, 673.234_445];

    /// Speeds in proportion to the detachment speed.
    fn slow(detachment: f64) -> Slow {
        let (slow, _) = Self::PAPERS;
        let scale = detachment / Self::PAPERS_OWN[0];
        Slow {
            chattering: rounded(slow.chattering * scale),
            range: slow.range.map(|rpm| rounded(rpm * scale)),
            interrupted: rounded(slow.interrupted * scale),
        }
    }

    /// Speeds for a chosen range: the range itself, with traces in its middle and at its end.
    fn chosen([low, high]: [f64; 2]) -> Slow {
        Slow { chattering: rounded(0.5 * (low + high)), range: [low, high], interrupted: high }
    }

    /// Speeds in proportion to the corner-impact speed.
    fn fast(at: &CornerImpact, falls: bool) -> Fast {
        let (_, fast) = Self::PAPERS;
        let own = at.speed_rpm();
        // If the orbit ceases to exist at faster speeds, the periods, not the speeds, are in proportion.
        let placed = |rpm: f64| if falls { rpm / Self::PAPERS_OWN[1] } else { Self::PAPERS_OWN[1] / rpm } * own;
        let [one, other] = fast.range.map(placed);
        let range = if falls { [one, other] } else { [other, one] };
        Fast { range: range.map(rounded), beyond: rounded(placed(fast.beyond)) }
    }
}

/// Reason for the missing corner impact if the model has no `[study]`.
pub(crate) const NO_STUDY: &str =
    "the model file has no [study], the range of speeds in which to look for a corner impact";

/// Rounds to four digits, as a person would choose a speed.
fn rounded(rpm: f64) -> f64 {
    let scale = 10_f64.powi(3 - elementary::log10(rpm.abs()).floor() as i32);
    let round = (rpm * scale).round() / scale;
    if round.is_finite() { round } else { rpm }
}

impl FigureContext {
    /// Verifies a model without external programs and chooses the speeds: this range, rpm, or the model's own.
    pub fn new(model: &Model, rpm: Option<[f64; 2]>) -> Result<Self, ModelError> {
        let findings = verify(model, External::LeftOut).map_err(|error| error.to_string());
        Self::with(model, findings, rpm)
    }

    /// Builds the context from a model and the result of `verify`, or the reason for its failure.
    pub(crate) fn with(
        model: &Model,
        findings: Result<Verification, String>,
        rpm: Option<[f64; 2]>,
    ) -> Result<Self, ModelError> {
        let cam = Cam::new(model)?;
        let paper = model.is_the_papers()?;
        let [slowest, fastest] = usual_range(model)?;
        let slow = if let Some(chosen) = rpm {
            Ok(ShownSpeeds::chosen(chosen))
        } else if paper {
            Ok(ShownSpeeds::PAPERS.0)
        } else {
            let leaves = Contact::new(&cam, model.follower).separation().speed();
            (slowest < leaves && leaves <= fastest).then(|| ShownSpeeds::slow(leaves)).ok_or_else(|| {
                format!(
                    "from {slowest} to {fastest} rpm the follower does not begin to leave the cam: it leaves the cam at every speed, \
                     or at none"
                )
            })
        };
        let fast = match &findings {
            Ok(_) if paper => Ok(ShownSpeeds::PAPERS.1),
            Ok(found) => {
                let kind = found.classification.as_ref().ok();
                let rises = kind.is_some_and(|kind| {
                    kind.scenario == Scenario::NonsmoothFold && kind.plus.exists_for == Speeds::Slower
                });
                Ok(ShownSpeeds::fast(&found.at, !rises))
            }
            Err(_) if model.study.is_none() => Err(NO_STUDY.into()),
            Err(why) => Err(why.clone()),
        };
        // All figures of the corner impact give the same reason.
        let findings = match &fast {
            Ok(_) => findings,
            Err(why) => Err(why.clone()),
        };
        Ok(Self {
            model: model.clone(),
            cam,
            // The paper's statements about its speeds do not apply to other speeds.
            is_paper: paper && rpm.is_none(),
            findings,
            shown: ShownSpeeds { slow, fast },
            rpm,
            slow_effort: Effort::SLOW,
            fast_effort: Effort::FAST,
            followed: OnceLock::new(),
        })
    }

    /// Result of `verify`, or the reason for its failure.
    pub fn found(&self) -> Result<&Verification, String> {
        self.findings.as_ref().map_err(Clone::clone)
    }

    /// Scenario of the corner impact, if it is classified.
    pub(crate) fn scenario(&self) -> Option<Scenario> {
        Some(self.found().ok()?.classification.as_ref().ok()?.scenario)
    }

    /// Whether the orbits of the corner impact cease to exist beyond it.
    pub(crate) fn is_fold(&self) -> bool {
        self.scenario() == Some(Scenario::NonsmoothFold)
    }

    /// The machine at a speed, rpm.
    pub(crate) fn machine(&self, rpm: f64) -> Machine {
        Machine::new(self.cam.clone(), &self.model.follower, angular_velocity(rpm))
    }

    /// Title with speeds above detachment, or `without` if there are none.
    pub(crate) fn slow_title(&self, without: &str, with: impl Fn(&Slow) -> String) -> String {
        let words = self.shown.slow.as_ref().map_or_else(|_| without.into(), with);
        format!("{}: {words}", self.model.name)
    }

    /// Title with speeds around the corner impact, or `without` if there is none.
    pub(crate) fn fast_title(&self, without: &str, with: impl Fn(&Fast) -> String) -> String {
        let words = self.shown.fast.as_ref().map_or_else(|_| without.into(), with);
        format!("{}: {words}", self.model.name)
    }
}
