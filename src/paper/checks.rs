//! The check of each statement of the ledger: the method that decides it, by its id.
//!
//! The id of an equation names its proof, and the id of a number its quantity. Only the other statements have a row in the table.

use super::context::{CheckResult, Context, Decision, Residuals, decide};
use super::drawings::*;
use super::dynamics::*;
use super::jump_order::order_of_the_jump;
use super::statements::*;
use crate::agreement::Quantity;
use crate::known::Evidence::{self, Computed, Sampled};
use crate::published::Verdict;

const MODEL: &str = "the statement defines the model of the computations; the tests check that flights and impacts of this program \
    obey it";

const LIMITS: &str = "both are typeset as t -> 0-, so two limits that should differ would be one";

const LABELLED: &str = "in the drawing's coordinates the impact is at t = -0.5, left of the section at 0, and is labelled t_i. By eq:H \
    it is at -t_i";

const LITERATURE: &str = "the statement is about other papers; none of them was read for this check";

/// Hypotheses of the piecewise-linear map, for any cam.
const HYPOTHESES: &str = "for one follower with a linear spring, of any damping and stiffness, any cam whose c and c' are continuous and \
    whose c'' jumps, and an orbit of one impact a revolution; given r > 0, v < c' at the impact and phi12(T/2) != 0";

const NO_APPENDIX: &str = "the paper ends with Appendix A; eq:gff is proved here without Appendix B";

const WORDING: &str = "the formulas around it have the correct quantity";

/// Method that decides a statement.
#[derive(Clone, Copy)]
pub enum Check<'a> {
    /// A proof by computer algebra, by the equation's label.
    Equation(&'a str),
    /// Statements proved by computer algebra, with the verdict that follows from them, and the hypotheses.
    Proofs(Verdict, &'static [&'static str], &'a str),
    /// A printed number, by its quantity.
    Number(&'a str),
    /// A computation on any model.
    Any(Evidence, fn(&Context<'_>) -> Decision),
    /// A computation on the paper's model.
    Paper(Evidence, fn(&Context<'_>) -> Decision),
    /// A person who read the text: the verdict, and the reason.
    Read(Verdict, &'a str),
}

/// Proved statements that give the map its two sides.
const RANK_ONE: [&str; 2] = ["A+ - A- = kappa F e2 (h F), of rank one", "B+ - B- = kappa F e2 v/2"];

/// Checks of the statements whose ids name neither a proof nor a number.
pub static CHECKS: &[(&str, Check<'_>)] = &[
    ("equation: eq:fb1", Check::Read(Verdict::Definition, MODEL)),
    ("equation: eq:i1", Check::Read(Verdict::Definition, MODEL)),
    ("equation: eq:H", Check::Paper(Computed, side_of_the_impact)),
    ("equation: limits", Check::Read(Verdict::Misprint, LIMITS)),
    ("equation: delta x", Check::Paper(Computed, sign_of_the_deviation)),
    (
        "equation: delta x tilde",
        Check::Proofs(Verdict::Holds, &["C x~ = C x + D mu"], "with mu for dT, the border is at C dx~ = 0 for any dT"),
    ),
    ("equation: theta_i", Check::Any(Computed, angles_defined)),
    ("equation: kappa_i and rho_i", Check::Any(Computed, lengths_defined)),
    ("x* obtained analytically", Check::Paper(Computed, fixed_point_as_printed)),
    ("restitution from 0 to 1", Check::Paper(Computed, plastic_impact)),
    (
        "generic for a wide class",
        Check::Proofs(
            Verdict::InPart,
            &[RANK_ONE[0], RANK_ONE[1], "the map is continuous where the impact is on the corner"],
            HYPOTHESES,
        ),
    ),
    (
        "map with a gap",
        Check::Proofs(
            Verdict::Holds,
            &[
                "j = 1: over a revolution the sides differ by a gap (1+r) J F e2, by nothing below",
                "j = 1, -u- < J <= r u-: one impact on either side, a gap (1+r) J",
            ],
            "for a jump J of the first derivative that the follower hits on both sides, with u- = c' - v before it",
        ),
    ),
    ("cases in the literature", Check::Read(Verdict::Open, LITERATURE)),
    ("cam: acceleration jumps", Check::Paper(Computed, acceleration_jumps)),
    ("figure: camprofileeq", Check::Any(Computed, drawn_construction)),
    ("figure: camprofile (a)", Check::Paper(Computed, drawn_profile)),
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
    ("chaotic for good", Check::Paper(Sampled, chaos_for_good)),
    ("figure: orbit at 700 rpm", Check::Paper(Computed, orbit_at_700)),
    ("x* at rest", Check::Paper(Computed, at_rest)),
    ("one impact", Check::Paper(Sampled, one_impact)),
    (
        "map is piecewise linear",
        Check::Proofs(
            Verdict::Holds,
            &RANK_ONE,
            "with kappa = -(1+r)(c''+ - c''-)/(v - c') and the invertible F = phi_{T/2}. A jumps wherever c'' does, and B does if \
             also v != 0. This holds for r > 0 and v < c' at the impact",
        ),
    ),
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
    ("figure: pushroadvalve", Check::Any(Computed, drawn_valve_train)),
    ("figure: cam-shaft", Check::Paper(Computed, label_of_the_lift)),
    ("figure: globalmap_2b", Check::Equation("eq:lmap")),
    ("figure: ZDM5", Check::Read(Verdict::Misprint, LABELLED)),
    ("figure: bif_time (c)", Check::Paper(Sampled, impact_diagram)),
    ("figure: bif_time (d)", Check::Paper(Sampled, period_one_above)),
    ("equation: composition", Check::Equation("eq:lmap")),
    ("equation: implicit derivative in x", Check::Equation("Eq:dti_dxn")),
    ("equation: implicit derivative in T", Check::Equation("Eq:dti_dT")),
    ("equation: one-sided derivatives", Check::Equation("eq:linearmap")),
    ("equation: least squares", Check::Any(Computed, validation)),
    ("equation: shifted map, region", Check::Equation("eq:pwlf, region")),
    ("equation: O, T and the characteristic polynomial", Check::Equation("A bar")),
    ("equation: pieces of the lift", Check::Paper(Sampled, pieces_of_the_lift)),
    ("positive constants", Check::Paper(Computed, positive_constants)),
    ("caption: discontinuous profile", Check::Paper(Computed, profile_is_continuous)),
    ("wording: derivative of the acceleration", Check::Read(Verdict::Misprint, WORDING)),
    ("wording: mu", Check::Read(Verdict::Misprint, WORDING)),
];

/// Returns the check of a statement: from the table, or else by the proof or the number that its id names.
pub fn find(id: &str) -> Option<Check<'_>> {
    let listed = CHECKS.iter().find(|(name, _)| *name == id).map(|(_, check)| *check);
    listed
        .or_else(|| id.strip_prefix("equation: ").map(Check::Equation))
        .or_else(|| id.strip_prefix("number: ").map(Check::Number))
}

impl Check<'_> {
    /// Whether the statement stays open for a model other than the paper's.
    pub(crate) fn is_about_the_papers_model(self) -> bool {
        matches!(self, Self::Number(_) | Self::Paper(..))
    }

    /// Decides the statement. If the check ends with an error, the statement stays open, with reading as the only evidence.
    pub fn run(self, context: &Context<'_>) -> CheckResult {
        let (known, decision) = match self {
            _ if self.is_about_the_papers_model() && !context.is_paper => (
                Evidence::Read,
                Err("the statement is about the paper's follower and cam, and this model has others".into()),
            ),
            Self::Read(verdict, why) => (Evidence::Read, Ok((verdict, why.into()))),
            Self::Equation(label) => (Evidence::Proved, equation(context, label)),
            Self::Proofs(verdict, statements, so) => (Evidence::Proved, proofs(context, verdict, statements, so)),
            Self::Number(quantity) => (Computed, number(context, quantity)),
            Self::Any(known, check) | Self::Paper(known, check) => (known, check(context)),
        };
        match decision {
            Ok((verdict, evidence)) => CheckResult { verdict, known, evidence },
            Err(why) => CheckResult { verdict: Verdict::Open, known: Evidence::Read, evidence: why.to_string() },
        }
    }
}

/// Decides by statements of the derivations, each of which must be proved there.
fn proofs(context: &Context<'_>, verdict: Verdict, statements: &[&str], so: &str) -> Decision {
    context.proves(statements)?;
    Ok((verdict, format!("residual 0, by computer algebra: {}; {so}", statements.join("; "))))
}

/// Decides by the residuals. The equation holds if they are 0 as printed; otherwise those of the repaired form must be 0.
fn equation(context: &Context<'_>, label: &str) -> Decision {
    let equation = context.equations.get(label).ok_or("the derivations do not contain this equation")?;
    let Residuals { residual_as_printed, residual_repaired, subsets } = &equation.evidence;
    // That an equation is wrong is computed. Whether it is then a misprint or refuted is a judgement, taken from the derivations.
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
    decide(
        false,
        wrong,
        format!("residual as printed: {printed} at a rational point; residual when repaired: 0{parts}"),
    )
}

fn is_zero(residual: &serde_json::Value) -> bool {
    match residual {
        serde_json::Value::Array(entries) => !entries.is_empty() && entries.iter().all(is_zero),
        serde_json::Value::String(text) => text == "0",
        serde_json::Value::Number(number) => number.as_f64() == Some(0.0),
        _ => false,
    }
}

/// Formats residuals with five digits each.
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
    let number = context.printed(quantity)?;
    let (agrees, bound) = (number.agreement.agrees, number.agreement.bound.value);
    let relation = if agrees { "within" } else { "beyond" };
    let wrong = if number.verdict == Verdict::Holds { Verdict::Refuted } else { number.verdict };
    let computed: Vec<_> = number.computed.iter().map(|value| format!("{}", Shown(*value))).collect();
    let is_estimate = matches!(number.agreement.quantity, Quantity::AHat(_) | Quantity::BHat(_));
    let part = if is_estimate {
        format!(", by up to {:.1e} of an entry", number.agreement.max_rel_diff)
    } else {
        String::new()
    };
    let note = if number.note.is_empty() { String::new() } else { format!(": {}", number.note) };
    decide(
        agrees,
        wrong,
        format!("computed: ({}), {relation} {bound:.1e} of the print{part}{note}", computed.join(", ")),
    )
}
