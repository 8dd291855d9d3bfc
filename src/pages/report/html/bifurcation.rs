//! What happens at the corner impact: eigenvalues, normal form, classification; and what the local map does by itself.

use maud::{Markup, html};

use crate::border_collision::feigin::{Scenario, Speeds, speeds_at};
use crate::border_collision::long_run::{End, Exponent};
use crate::border_collision::outcome::Fate;
use crate::border_collision::validity::Range;
use crate::border_collision::{Classification, LocalOutcome, NormalForm};
use crate::corner::map::rows;
use crate::show::words;

use crate::pages::report::dossier::Dossier;
use crate::pages::report::html::numbers::{complex, fixed, matrix, number, size, symbol};
use crate::pages::report::html::{Section, wide};
use crate::study::verify::Verification;

pub(crate) fn section(dossier: &Dossier) -> Option<Section> {
    let found = dossier.verification.as_ref()?;
    let body = html! {
        (eigenvalues(found))
        @if let Ok(kind) = &found.classification { (classification(kind)) }
        @if let Err(why) = &found.classification { p { "There is no classification: " (why) "." } }
        (conditions(found))
        @if let Ok(form) = &found.normal_form { (normal_form(form)) }
    };
    Some(Section { id: "bifurcation", title: "What happens there", body })
}

fn eigenvalues(found: &Verification) -> Markup {
    let map = &found.map;
    wide(
        "Eigenvalues",
        &html! {
            table {
                caption { "Eigenvalues" }
                tbody {
                    @for (side, pair) in [("−", map.minus.eigenvalues()), ("+", map.plus.eigenvalues())] {
                        tr { th scope="row" { (symbol("A", "", side)) } @for value in pair { td { (complex(value, 10)) } } }
                    }
                }
            }
        },
    )
}

fn classification(kind: &Classification) -> Markup {
    let meaning = words::meaning(kind.scenario);
    let row = |name: &'static str, minus: Markup, plus: Markup| {
        html! { tr { th scope="row" { (name) } td { (minus) } td { (plus) } } }
    };
    let (minus, plus) = (&kind.minus, &kind.plus);
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
                    (row("real eigenvalues above 1", html! { (minus.above_one) }, html! { (plus.above_one) }))
                    (row("real eigenvalues below −1", html! { (minus.below_minus_one) }, html! { (plus.below_minus_one) }))
                    (row("det(I − A)", number(minus.determinant, 8), number(plus.determinant, 8)))
                    (row("fixed point exists at speeds", speeds(minus.exists_for), speeds(plus.exists_for)))
                    (row("it is", stable(minus.stable), stable(plus.stable)))
                    @let point = |at: nalgebra::Vector2<f64>| html! { "(" (number(at[0], 8)) ", " (number(at[1], 8)) ")" };
                    (row("its place for dT = 1 s, in m and m/s", point(minus.fixed_point), point(plus.fixed_point)))
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
                        tr.disagrees[!condition.holds()] {
                            th scope="row" { (condition.name) } td.n { (number(condition.value, 6)) } td.n { (size(condition.distance)) }
                            td { @if condition.holds() { "yes" } @else { "no" } } td.words { (condition.meaning) }
                            td { (words::decides(condition.decides)) }
                        }
                    }
                }
            }
        }))
    }
}

fn normal_form(form: &NormalForm) -> Markup {
    let column = |at: nalgebra::Vector2<f64>| [[at[0]], [at[1]]];
    html! {
        h3 { "Normal form" }
        div.matrices {
            @for (letter, side, rows) in [("A\u{304}", "−", rows(&form.a_bar_minus)), ("A\u{304}", "+", rows(&form.a_bar_plus)), ("W", "", rows(&form.w))] {
                div { (symbol(letter, "", side)) " = " (matrix(&rows, 10)) }
            }
            div { (symbol("B\u{304}", "", "")) " = " (matrix(&column(form.b_bar), 10)) }
            div { (symbol("B\u{303}", "", "")) " = " (matrix(&column(form.b_tilde), 10)) }
            div { (symbol("C\u{304}", "", "")) " = (" (number(form.c_bar[0], 10)) ", " (number(form.c_bar[1], 10)) ")" }
        }
    }
}

/// What the local map does by itself, and how far it holds.
pub(crate) fn local_map(dossier: &Dossier) -> Option<Section> {
    let found = dossier.verification.as_ref().filter(|found| !found.outcomes.is_empty())?;
    let body = html! {
        p { "The piecewise-linear map run by itself from many starts, on either side of the speed of the corner impact and at it." }
        @for outcome in &found.outcomes { (motions(outcome)) }
        @if !found.ranges.is_empty() {
            h3 { "How far it holds" }
            p { "Up to these speeds what the map predicts is within a tenth of the simulated machine." }
            (wide("How far the local map holds", &html! {
                table {
                    thead { tr {
                        th scope="col" { "predicted" } th scope="col" { "speeds" } th.n scope="col" { "to, rpm" } th.n scope="col" { "dT, s" } th scope="col" { "ended by" }
                    } }
                    tbody { @for range in &found.ranges { (range_row(range)) } }
                }
            }))
        }
    };
    Some(Section { id: "local-map", title: "What the local map does by itself", body })
}

fn motions(outcome: &LocalOutcome) -> Markup {
    let speeds = Speeds::of(outcome.mu);
    let title = speeds.map_or("At the corner impact".to_owned(), |speeds| format!("At {speeds} speeds"));
    html! {
        h3 { (title) }
        ul { @for end in &outcome.fates { li { (end.starts) " of " (outcome.starts()) " starts " (end_words(end)) } } }
        @if speeds.is_some() && !outcome.orbits.is_empty() {
            p {
                "Periodic orbits, as the sides they visit (L before the corner, R after it): "
                @for (index, orbit) in outcome.orbits.iter().enumerate() {
                    @if index > 0 { ", " }
                    code { (orbit.word.to_string()) } @if orbit.stable() { " stable" } @else { " unstable" }
                }
                "."
            }
        }
    }
}

fn end_words(fate: &Fate) -> Markup {
    let growth = |exponent: &Exponent| {
        html! { ", with a Lyapunov exponent of " (fixed(exponent.value, 4)) " ± " (fixed(exponent.error, 4)) " a turn" }
    };
    match &fate.end {
        end @ End::Periodic(orbit) => html! {
            @if end.fixed_on().is_some() { "end on the fixed point " } @else { "end on the orbit " } code { (orbit.word.to_string()) }
        },
        End::Chaotic(exponent) => html! { "end in chaos" (growth(exponent)) },
        End::Undecided(exponent) => html! { "stay bounded without a verdict" (growth(exponent)) },
        End::Corner => html! { "end on the corner impact" },
        end @ End::Escapes(_) => html! { "grow without bound (" (end.basis()) ")" },
    }
}

fn range_row(range: &Range) -> Markup {
    let what = words::compared(range.compared);
    let ends = if range.difference.is_none() { "holds nowhere" } else { words::ends(range.ends) };
    html! {
        tr {
            th scope="row" { (what) } td { (speeds_at(range.sign)) } td.n { (fixed(range.speed_rpm, 6)) } td.n { (size(range.period_change)) }
            td { (ends) }
        }
    }
}
