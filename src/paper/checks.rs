//! One check for each statement of the ledger: its id, and what decides it.
//!
//! An equation's id names its proof, a number's id its quantity: only the others have a row here.

use super::context::{Context, Decision, Found, Residuals, decide};
use super::dynamics::*;
use super::jump_order::order_of_the_jump;
use super::statements::*;
use crate::known::Known::{self, Computed, Sampled};
use crate::published::Verdict;

/// Why some figures have nothing to decide.
const DRAWING: &str = "a drawing: it states nothing that a computation could contradict";

const DRAWN: &str = "the circles, by the coordinates that they are drawn with, miss touching by at most 0.005 of a base radius of \
    2; in panel (b) the nose arcs run 3.8 deg past P; and the drawing is of another cam (flank from 70 deg, radii 2, 3.53, 0.745) \
    than the one computed with";

const NO_APPENDIX: &str = "the paper ends with Appendix A; eq:gff is proved without it";

const WORDING: &str = "the formulas around it mean what is right";

/// What decides a statement.
#[derive(Clone, Copy)]
pub enum Check<'a> {
    /// A proof by computer algebra, by the equation's label.
    Equation(&'a str),
    /// A printed number, by its quantity.
    Number(&'a str),
    /// A computation on any model.
    Any(Known, fn(&Context<'_>) -> Decision),
    /// A computation on the paper's model.
    Paper(Known, fn(&Context<'_>) -> Decision),
    /// Somebody who read it: what was found, and why.
    Read(Verdict, &'a str),
}

/// The checks that the ids of their statements do not name.
pub static CHECKS: &[(&str, Check<'_>)] = &[
    ("equation: eq:fb1", Check::Any(Sampled, equation_of_motion)),
    ("equation: eq:i1", Check::Any(Sampled, restitution_law)),
    ("cam: acceleration jumps", Check::Paper(Computed, acceleration_jumps)),
    ("figure: camprofileeq", Check::Read(Verdict::Misprint, DRAWN)),
    ("appendix B", Check::Read(Verdict::Misprint, NO_APPENDIX)),
    ("detachment", Check::Paper(Sampled, detachment)),
    ("chattering at 183 rpm", Check::Paper(Computed, |context| chattering(context, 183.0))),
    ("chattering at 175 rpm", Check::Paper(Computed, |context| chattering(context, 175.0))),
    ("impact diagram 115 to 200 rpm", Check::Paper(Sampled, impact_diagram_of_slow_cams)),
    ("resonant peaks", Check::Paper(Sampled, resonant_peaks)),
    ("period adding", Check::Paper(Sampled, period_adding)),
    ("period one above 673.23 rpm", Check::Paper(Sampled, period_one_above)),
    ("chaos at 670 rpm", Check::Paper(Sampled, chaos_below)),
    ("transition at the corner", Check::Paper(Sampled, transition)),
    ("transitions at the corners", Check::Paper(Sampled, transitions_at_corners)),
    ("coexisting attractor", Check::Paper(Sampled, coexisting)),
    ("chaotic for good", Check::Paper(Computed, chaos_for_good)),
    ("figure: orbit at 700 rpm", Check::Paper(Computed, orbit_at_700)),
    ("x* at rest", Check::Paper(Computed, at_rest)),
    ("one impact", Check::Paper(Sampled, one_impact)),
    ("map is piecewise linear", Check::Paper(Computed, two_sides)),
    ("validation", Check::Any(Computed, validation)),
    ("five decimals", Check::Paper(Computed, five_decimals)),
    ("odd count", Check::Paper(Computed, odd_count)),
    ("nonsmooth fold", Check::Paper(Computed, nonsmooth_fold)),
    ("figure: local map", Check::Paper(Computed, figure_of_the_local_map)),
    ("fixed points above, none below", Check::Paper(Computed, fixed_points_above)),
    ("order of the jump", Check::Any(Sampled, order_of_the_jump)),
    ("conclusions", Check::Any(Computed, continuity)),
    ("equation: eq:lmaptheta_1", Check::Equation("eq:gff")),
    ("equation: eq:impactdynamics_1", Check::Equation("eq:lmapd")),
    ("equation: eq:impactdynamics_3", Check::Equation("eq:lmapd")),
    ("equation: eq:lmap_g", Check::Equation("eq:lmap")),
    ("figure: pushroadvalve", Check::Read(Verdict::Open, DRAWING)),
    ("figure: cam-shaft", Check::Read(Verdict::Open, DRAWING)),
    ("figure: globalmap_2b", Check::Equation("eq:lmap")),
    ("figure: ZDM5", Check::Equation("eq:H")),
    ("figure: bif_time (c)", Check::Paper(Sampled, impact_diagram)),
    ("figure: bif_time (d)", Check::Paper(Sampled, period_one_above)),
    ("equation: composition", Check::Equation("eq:lmap")),
    ("equation: implicit derivative in x", Check::Equation("Eq:dti_dxn")),
    ("equation: implicit derivative in T", Check::Equation("Eq:dti_dT")),
    ("equation: one-sided derivatives", Check::Equation("eq:linearmap")),
    ("equation: least squares", Check::Any(Computed, validation)),
    ("equation: shifted map, region", Check::Equation("eq:pwlf, region")),
    ("equation: O, T and the characteristic polynomial", Check::Equation("A bar")),
    ("equation: pieces of the lift", Check::Equation("appendix A, laws")),
    ("positive constants", Check::Paper(Computed, positive_constants)),
    ("caption: discontinuous profile", Check::Paper(Computed, profile_is_continuous)),
    ("wording: derivative of the acceleration", Check::Read(Verdict::Misprint, WORDING)),
    ("wording: mu", Check::Read(Verdict::Misprint, WORDING)),
];

/// The check of a statement: that of the table, or else the proof or the number that its id names.
pub fn find(id: &str) -> Option<Check<'_>> {
    let listed = CHECKS.iter().find(|(name, _)| *name == id).map(|(_, check)| *check);
    listed
        .or_else(|| id.strip_prefix("equation: ").map(Check::Equation))
        .or_else(|| id.strip_prefix("number: ").map(Check::Number))
}

impl Check<'_> {
    /// Whether another model than the paper's leaves it open.
    pub(crate) fn is_about_the_papers_model(self) -> bool {
        matches!(self, Self::Number(_) | Self::Paper(..))
    }

    /// Decides the statement. What no check comes to is known by reading alone.
    pub(crate) fn run(self, context: &Context<'_>) -> Found {
        let (known, decision) = match self {
            _ if self.is_about_the_papers_model() && !context.is_paper => {
                (Known::Read, Err("about the paper's follower and cam; this model has others".into()))
            }
            Self::Read(verdict, why) => (Known::Read, Ok((verdict, why.into()))),
            Self::Equation(label) => (Known::Proved, equation(context, label)),
            Self::Number(quantity) => (Computed, number(context, quantity)),
            Self::Any(known, check) | Self::Paper(known, check) => (known, check(context)),
        };
        match decision {
            Ok((verdict, evidence)) => Found { verdict, known, evidence },
            Err(why) => Found { verdict: Verdict::Open, known: Known::Read, evidence: why.to_string() },
        }
    }
}

/// By the residuals: all zero as printed holds; otherwise the repaired form must have none.
fn equation(context: &Context<'_>, label: &str) -> Decision {
    let equation = context.equations.get(label).ok_or("not among the derivations")?;
    let Residuals { residual_as_printed, residual_repaired, subsets } = &equation.evidence;
    // Whether a wrong equation is a slip or a wrong statement is a judgement; that it is wrong is not.
    let wrong = if equation.verdict == Verdict::Holds { Verdict::Refuted } else { equation.verdict };
    if is_zero(residual_as_printed) {
        return decide(true, wrong, "residual 0, by computer algebra".into());
    }
    let printed = shortened(residual_as_printed);
    if !is_zero(residual_repaired) {
        return Err(format!("residual {printed}; no repair is proved").into());
    }
    let parts = match subsets.len() {
        0 => String::new(),
        count => format!("; none of {count} smaller repairs suffices"),
    };
    decide(false, wrong, format!("as printed, residual {printed} at a rational point; repaired, residual 0{parts}"))
}

fn is_zero(residual: &serde_json::Value) -> bool {
    match residual {
        serde_json::Value::Array(entries) => !entries.is_empty() && entries.iter().all(is_zero),
        serde_json::Value::String(text) => text == "0",
        serde_json::Value::Number(number) => number.as_f64() == Some(0.0),
        _ => false,
    }
}

/// Residuals with five digits each.
fn shortened(residual: &serde_json::Value) -> String {
    match residual {
        serde_json::Value::Array(entries) => {
            format!("({})", entries.iter().map(shortened).collect::<Vec<_>>().join(", "))
        }
        serde_json::Value::String(text) => {
            text.parse::<f64>().map_or_else(|_| text.clone(), |value| format!("{value:.5}"))
        }
        other => other.to_string(),
    }
}

fn number(context: &Context<'_>, quantity: &str) -> Decision {
    let number = context.findings.published.iter().find(|number| number.agreement.quantity.to_string() == quantity);
    let number = number.ok_or("not compared")?;
    let (agrees, bound) = (number.agreement.agrees, number.agreement.bound.value);
    let relation = if agrees { "within" } else { "beyond" };
    let wrong = if number.verdict == Verdict::Holds { Verdict::Refuted } else { number.verdict };
    let computed: Vec<_> = number.computed.iter().map(|value| format!("{}", Shown(*value))).collect();
    let note = if number.note.is_empty() { String::new() } else { format!(": {}", number.note) };
    decide(agrees, wrong, format!("computed ({}), {relation} {bound:.1e} of the print{note}", computed.join(", ")))
}
