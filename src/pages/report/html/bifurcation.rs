//! What happens at the corner impact: eigenvalues, normal form, classification; and what the local map does by itself.

use maud::{Markup, html};

use crate::border_collision::feigin::{Scenario, Speeds};
use crate::show::words;

use crate::pages::report::dossier::Dossier;
use crate::pages::report::html::numbers::{complex, fixed, matrix, number, size, symbol};
use crate::pages::report::html::{Section, wide};
use crate::study::verify::border_collision::{
    ClassificationEntry, EndEntry, NormalFormEntry, OutcomeEntry, RangeEntry,
};
use crate::study::verify::document::Verification;

pub(crate) fn section(dossier: &Dossier) -> Option<Section> {
    let found = dossier.verification.as_ref()?;
    let body = html! {
        (eigenvalues(found))
        @if let Some(kind) = &found.classification { (classification(kind)) }
        @if let Some(why) = &found.refusal { p { "There is no classification: " (why) "." } }
        (conditions(found))
        @if let Some(form) = &found.normal_form { (normal_form(form)) }
    };
    Some(Section { id: "bifurcation", title: "What happens there", body })
}

fn eigenvalues(found: &Verification) -> Markup {
    wide(
        "Eigenvalues",
        &html! {
            table {
                caption { "Eigenvalues" }
                tbody {
                    @for (side, pair) in [("−", &found.eigenvalues.minus), ("+", &found.eigenvalues.plus)] {
                        tr { th scope="row" { (symbol("A", "", side)) } @for value in pair { td { (complex(*value, 10)) } } }
                    }
                }
            }
        },
    )
}

fn classification(kind: &ClassificationEntry) -> Markup {
    let meaning = words::meaning(kind.scenario);
    let row = |name: &'static str, minus: Markup, plus: Markup| {
        html! { tr { th scope="row" { (name) } td { (minus) } td { (plus) } } }
    };
    let above = &kind.real_eigenvalues_above_one;
    let below = &kind.real_eigenvalues_below_minus_one;
    let stable = |stable: bool| html! { @if stable { "stable" } @else { "unstable" } };
    let speeds = |speeds: Speeds| html! { (speeds) " than at the corner impact" };
    html! {
        p.verdict { "A " (words::spoken(&kind.scenario.to_string())) "." }
        p { (meaning) @if kind.period_two_orbit && kind.scenario != Scenario::NonsmoothFlip { " An orbit of period two is born too." } }
        (wide("Feigin's classification", &html! {
            table {
                caption { "Feigin's counts, and the fixed point of each side" }
                thead { tr { th { "" } th scope="col" { "impact before the corner" } th scope="col" { "impact after it" } } }
                tbody {
                    (row("real eigenvalues above 1", html! { (above.minus) }, html! { (above.plus) }))
                    (row("real eigenvalues below −1", html! { (below.minus) }, html! { (below.plus) }))
                    (row("det(I − A)", number(kind.determinant_of_identity_minus_a.minus, 8), number(kind.determinant_of_identity_minus_a.plus, 8)))
                    (row("fixed point exists at speeds", speeds(kind.fixed_points_exist_for.minus), speeds(kind.fixed_points_exist_for.plus)))
                    (row("it is", stable(kind.stable.minus), stable(kind.stable.plus)))
                    @let point = |[x, v]: [f64; 2]| html! { "(" (number(x, 8)) ", " (number(v, 8)) ")" };
                    (row("its place for dT = 1 s, in m and m/s", point(kind.fixed_point_per_unit_period.minus), point(kind.fixed_point_per_unit_period.plus)))
                }
            }
        }))
        p.note { "An odd number of eigenvalues above 1 on both sides together is a fold; an odd number below −1 is a flip." }
    }
}

fn conditions(found: &Verification) -> Markup {
    if found.conditions.is_empty() {
        return html! {};
    }
    html! {
        h3 { "What this rests on" }
        (wide("Conditions of the classification", &html! {
            table {
                thead { tr {
                    th scope="col" { "looked at" } th.n scope="col" { "value" } th.n scope="col" { "distance from failing" }
                    th scope="col" { "holds" } th scope="col" { "or else" } th scope="col" { "decides" }
                } }
                tbody {
                    @for condition in &found.conditions {
                        tr.disagrees[!condition.holds] {
                            th scope="row" { (condition.name) } td.n { (number(condition.value, 6)) } td.n { (size(condition.distance)) }
                            td { @if condition.holds { "yes" } @else { "no" } } td.words { (condition.meaning) }
                            td { (words::decides(condition.decides)) }
                        }
                    }
                }
            }
        }))
    }
}

fn normal_form(form: &NormalFormEntry) -> Markup {
    let column = |[one, two]: [f64; 2]| [[one], [two]];
    html! {
        h3 { "Normal form" }
        div.matrices {
            @for (letter, side, rows) in [("A\u{304}", "−", &form.a_bar_minus), ("A\u{304}", "+", &form.a_bar_plus), ("W", "", &form.w)] {
                div { (symbol(letter, "", side)) " = " (matrix(rows, 10)) }
            }
            div { (symbol("B\u{304}", "", "")) " = " (matrix(&column(form.b_bar), 10)) }
            div { (symbol("B\u{303}", "", "")) " = " (matrix(&column(form.b_tilde), 10)) }
            div { (symbol("C\u{304}", "", "")) " = (" (number(form.c_bar[0], 10)) ", " (number(form.c_bar[1], 10)) ")" }
        }
    }
}

/// What the local map does by itself, and how far it holds.
pub(crate) fn local_map(dossier: &Dossier) -> Option<Section> {
    let found = dossier.verification.as_ref().filter(|found| !found.local_map.is_empty())?;
    let body = html! {
        p { "The piecewise-linear map run by itself from many starts, on either side of the speed of the corner impact and at it." }
        @for outcome in &found.local_map { (motions(outcome)) }
        @if !found.linear_range.is_empty() {
            h3 { "How far it holds" }
            p { "Up to these speeds what the map predicts is within a tenth of the simulated machine." }
            (wide("How far the local map holds", &html! {
                table {
                    thead { tr {
                        th scope="col" { "predicted" } th scope="col" { "speeds" } th.n scope="col" { "to, rpm" } th.n scope="col" { "dT, s" } th scope="col" { "ended by" }
                    } }
                    tbody { @for range in &found.linear_range { (range_row(range)) } }
                }
            }))
        }
    };
    Some(Section { id: "local-map", title: "What the local map does by itself", body })
}

fn motions(outcome: &OutcomeEntry) -> Markup {
    let title = match outcome.speeds {
        "at" => "At the corner impact".to_owned(),
        speeds => format!("At {speeds} speeds"),
    };
    html! {
        h3 { (title) }
        ul { @for end in &outcome.ends { li { (end.starts) " of " (outcome.starts) " starts " (end_words(end)) } } }
        @if outcome.speeds != "at" && !outcome.periodic_orbits.is_empty() {
            p {
                "Periodic orbits, as the sides they visit (L before the corner, R after it): "
                @for (index, orbit) in outcome.periodic_orbits.iter().enumerate() {
                    @if index > 0 { ", " }
                    code { (orbit.word) } @if orbit.stable { " stable" } @else { " unstable" }
                }
                "."
            }
        }
    }
}

fn end_words(end: &EndEntry) -> Markup {
    let growth = html! {
        @if let (Some(exponent), Some(error)) = (end.exponent, end.standard_error) {
            ", with a Lyapunov exponent of " (fixed(exponent, 4)) " ± " (fixed(error, 4)) " a turn"
        }
    };
    match (end.end, &end.word) {
        ("fixed-point", Some(word)) => html! { "end on the fixed point " code { (word) } },
        ("periodic", Some(word)) => html! { "end on the orbit " code { (word) } },
        ("chaotic", _) => html! { "end in chaos" (growth) },
        ("undecided", _) => html! { "stay bounded without a verdict" (growth) },
        ("corner", _) => html! { "end on the corner impact" },
        _ => html! { "grow without bound (" (end.basis) ")" },
    }
}

fn range_row(range: &RangeEntry) -> Markup {
    let what = words::compared(range.compared);
    let ends = if range.difference.is_none() { "holds nowhere" } else { words::ends(range.ends) };
    html! {
        tr {
            th scope="row" { (what) } td { (range.speeds) } td.n { (fixed(range.speed_rpm, 6)) } td.n { (size(range.period_change_s)) }
            td { (ends) }
        }
    }
}
