//! One check for each statement of the ledger: its id, and what decides it.

use super::context::{Context, Found, Residuals};
use super::dynamics::*;
use super::jump_order::order_of_the_jump;
use super::statements::*;
use crate::published::Verdict;

/// Why some figures have nothing to decide.
const DRAWING: &str = "a drawing: it states nothing that a computation could contradict";

/// What decides a statement.
#[derive(Clone, Copy)]
pub enum Check {
    /// A proof by computer algebra, by the equation's label.
    Equation(&'static str),
    /// A printed number, by its quantity.
    Number(&'static str),
    /// A computation on any model.
    Any(fn(&Context<'_>) -> Found),
    /// A computation on the paper's model.
    Paper(fn(&Context<'_>) -> Found),
    /// Nothing yet, and why.
    Open(&'static str),
}

/// Every check, by the id of its statement.
pub static CHECKS: &[(&str, Check)] = &[
    ("equation: eq:gff", Check::Equation("eq:gff")),
    ("equation: x_t", Check::Equation("x_t")),
    ("equation: y_t", Check::Equation("y_t")),
    ("equation: eq:H", Check::Equation("eq:H")),
    ("equation: eq:impactdynamics_2", Check::Equation("eq:impactdynamics_2")),
    ("equation: eq:lmapd", Check::Equation("eq:lmapd")),
    ("equation: eq:lmap", Check::Equation("eq:lmap")),
    ("equation: eq:fixedp", Check::Equation("eq:fixedp")),
    ("equation: eq:dPdx", Check::Equation("eq:dPdx")),
    ("equation: eq:dPdT", Check::Equation("eq:dPdT")),
    ("equation: Eq:dP_dxn", Check::Equation("Eq:dP_dxn")),
    ("equation: Eq:dP_dti", Check::Equation("Eq:dP_dti")),
    ("equation: Eq:dti_dxn", Check::Equation("Eq:dti_dxn")),
    ("equation: eq:ftaylormapcornerX", Check::Equation("eq:ftaylormapcornerX")),
    ("equation: dy_dT", Check::Equation("dy_dT")),
    ("equation: Eq:dP_dT", Check::Equation("Eq:dP_dT")),
    ("equation: Eq:dti_dT", Check::Equation("Eq:dti_dT")),
    ("equation: eq:ftaylormapcornerT", Check::Equation("eq:ftaylormapcornerT")),
    ("equation: eq:Px", Check::Equation("eq:Px")),
    ("equation: eq:PT", Check::Equation("eq:PT")),
    ("equation: eq:linearmap", Check::Equation("eq:linearmap")),
    ("equation: limits", Check::Equation("limits")),
    ("equation: eq:pwlf, region", Check::Equation("eq:pwlf, region")),
    ("equation: eq:pwlf, acceleration", Check::Equation("eq:pwlf, acceleration")),
    ("equation: eq:pwlf, continuity", Check::Equation("eq:pwlf, continuity")),
    ("equation: delta x", Check::Equation("delta x")),
    ("equation: B tilde", Check::Equation("B tilde")),
    ("equation: B tilde, sides", Check::Equation("B tilde, sides")),
    ("equation: coordinates", Check::Equation("coordinates")),
    ("equation: A bar", Check::Equation("A bar")),
    ("equation: A bar, determinant", Check::Equation("A bar, determinant")),
    ("equation: B bar", Check::Equation("B bar")),
    ("equation: appendix A, laws", Check::Equation("appendix A, laws")),
    ("equation: appendix A, tangency", Check::Equation("appendix A, tangency")),
    ("equation: eq:fb1", Check::Any(equation_of_motion)),
    ("equation: eq:i1", Check::Any(restitution_law)),
    ("number: T_star", Check::Number("T_star")),
    ("number: speed_rpm", Check::Number("speed_rpm")),
    ("number: x_star", Check::Number("x_star")),
    ("number: A_minus", Check::Number("A_minus")),
    ("number: B_minus", Check::Number("B_minus")),
    ("number: A_plus", Check::Number("A_plus")),
    ("number: B_plus", Check::Number("B_plus")),
    ("number: C", Check::Number("C")),
    ("number: D", Check::Number("D")),
    ("number: A_hat_minus", Check::Number("A_hat_minus")),
    ("number: B_hat_minus", Check::Number("B_hat_minus")),
    ("number: A_hat_plus", Check::Number("A_hat_plus")),
    ("number: B_hat_plus", Check::Number("B_hat_plus")),
    ("number: B_tilde", Check::Number("B_tilde")),
    ("number: A_bar_minus", Check::Number("A_bar_minus")),
    ("number: A_bar_plus", Check::Number("A_bar_plus")),
    ("number: B_bar", Check::Number("B_bar")),
    ("number: C_bar", Check::Number("C_bar")),
    ("number: eigenvalues_minus", Check::Number("eigenvalues_minus")),
    ("number: eigenvalues_plus", Check::Number("eigenvalues_plus")),
    ("cam: acceleration jumps", Check::Paper(acceleration_jumps)),
    ("figure: camprofileeq", Check::Any(drawn_circles)),
    ("appendix B", Check::Any(appendix_b)),
    ("detachment", Check::Paper(detachment)),
    ("chattering at 183 rpm", Check::Paper(chattering_at_183)),
    ("chattering at 175 rpm", Check::Paper(chattering_at_175)),
    ("impact diagram 115 to 200 rpm", Check::Paper(impact_diagram_of_slow_cams)),
    ("resonant peaks", Check::Paper(resonant_peaks)),
    ("period adding", Check::Paper(period_adding)),
    ("period one above 673.23 rpm", Check::Paper(period_one_above)),
    ("chaos at 670 rpm", Check::Paper(chaos_below)),
    ("transition at the corner", Check::Paper(transition)),
    ("transitions at the corners", Check::Paper(transitions_at_corners)),
    ("coexisting attractor", Check::Paper(coexisting)),
    ("chaotic for good", Check::Paper(chaos_for_good)),
    ("figure: orbit at 700 rpm", Check::Paper(orbit_at_700)),
    ("x* at rest", Check::Paper(at_rest)),
    ("one impact", Check::Paper(one_impact)),
    ("map is piecewise linear", Check::Paper(two_sides)),
    ("validation", Check::Any(validation)),
    ("five decimals", Check::Paper(five_decimals)),
    ("odd count", Check::Paper(odd_count)),
    ("nonsmooth fold", Check::Paper(nonsmooth_fold)),
    ("figure: local map", Check::Paper(figure_of_the_local_map)),
    ("fixed points above, none below", Check::Paper(fixed_points_above)),
    ("order of the jump", Check::Any(order_of_the_jump)),
    ("conclusions", Check::Any(continuity)),
    ("equation: eq:lmaptheta_1", Check::Equation("eq:gff")),
    ("equation: eq:impactdynamics_1", Check::Equation("eq:lmapd")),
    ("equation: eq:impactdynamics_3", Check::Equation("eq:lmapd")),
    ("equation: eq:lmap_g", Check::Equation("eq:lmap")),
    ("figure: pushroadvalve", Check::Open(DRAWING)),
    ("figure: cam-shaft", Check::Open(DRAWING)),
    ("figure: globalmap_2b", Check::Equation("eq:lmap")),
    ("figure: ZDM5", Check::Equation("eq:H")),
    ("figure: bif_time (c)", Check::Paper(impact_diagram)),
    ("figure: bif_time (d)", Check::Paper(period_one_above)),
    ("equation: composition", Check::Equation("eq:lmap")),
    ("equation: implicit derivative in x", Check::Equation("Eq:dti_dxn")),
    ("equation: implicit derivative in T", Check::Equation("Eq:dti_dT")),
    ("equation: one-sided derivatives", Check::Equation("eq:linearmap")),
    ("equation: least squares", Check::Any(validation)),
    ("equation: shifted map, region", Check::Equation("eq:pwlf, region")),
    ("equation: O, T and the characteristic polynomial", Check::Equation("A bar")),
    ("equation: pieces of the lift", Check::Equation("appendix A, laws")),
    ("positive constants", Check::Paper(positive_constants)),
    ("caption: discontinuous profile", Check::Paper(profile_is_continuous)),
    ("wording: derivative of the acceleration", Check::Any(wording)),
    ("wording: mu", Check::Any(wording)),
];

/// The check of a statement.
pub fn find(id: &str) -> Option<Check> {
    CHECKS.iter().find(|(name, _)| *name == id).map(|(_, check)| *check)
}

impl Check {
    /// Whether another model than the paper's leaves it open.
    pub fn is_about_the_papers_model(self) -> bool {
        matches!(self, Self::Number(_) | Self::Paper(_))
    }

    /// Decides the statement.
    pub fn run(self, context: &Context<'_>) -> Found {
        match self {
            Self::Open(why) => Found { verdict: Verdict::Open, evidence: why.into() },
            Self::Equation(label) => equation(context, label),
            Self::Any(check) => check(context),
            Self::Number(_) | Self::Paper(_) if !context.is_paper => Found {
                verdict: Verdict::Open,
                evidence: "about the paper's follower and cam; this model has others".into(),
            },
            Self::Number(quantity) => number(context, quantity),
            Self::Paper(check) => check(context),
        }
    }
}

/// By the residuals: all zero as printed holds; otherwise the repaired form must have none.
fn equation(context: &Context<'_>, label: &str) -> Found {
    let Some(equation) = context.equations.get(label) else {
        return Found { verdict: Verdict::Open, evidence: "not among the derivations".into() };
    };
    let Residuals { residual_as_printed, residual_repaired, subsets } = &equation.evidence;
    if is_zero(residual_as_printed) {
        return Found { verdict: Verdict::Holds, evidence: "residual 0, by computer algebra".into() };
    }
    let printed = shortened(residual_as_printed);
    if !is_zero(residual_repaired) {
        return Found { verdict: Verdict::Open, evidence: format!("residual {printed}; no repair is proved") };
    }
    let parts = match subsets.len() {
        0 => String::new(),
        count => format!("; none of {count} smaller repairs suffices"),
    };
    // Whether a wrong equation is a slip or a wrong statement is a judgement; that it is wrong is not.
    let verdict = if equation.verdict == Verdict::Holds { Verdict::Refuted } else { equation.verdict };
    Found {
        verdict,
        evidence: format!("as printed, residual {printed} at a rational point; repaired, residual 0{parts}"),
    }
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

fn number(context: &Context<'_>, quantity: &str) -> Found {
    match context.findings.published.iter().find(|number| number.agreement.quantity == quantity) {
        None => Found { verdict: Verdict::Open, evidence: "not compared".into() },
        Some(number) => {
            let bound = number.agreement.bound.value;
            let (verdict, relation) = if number.agreement.agrees {
                (Verdict::Holds, "within")
            } else if number.verdict == Verdict::Holds {
                (Verdict::Refuted, "beyond")
            } else {
                (number.verdict, "beyond")
            };
            let computed: Vec<_> = number.computed.iter().map(|value| format!("{}", Shown(*value))).collect();
            let note = if number.note.is_empty() { String::new() } else { format!(": {}", number.note) };
            Found {
                verdict,
                evidence: format!("computed ({}), {relation} {bound:.1e} of the print{note}", computed.join(", ")),
            }
        }
    }
}
