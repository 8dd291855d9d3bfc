//! The matrices by every route side by side, and the digits in print.

use maud::{Markup, html};

use crate::show::{html, words};

use crate::corner::CornerMap;
use crate::corner::map::Uncertainty;
use crate::pages::report::dossier::{Dossier, MapTable};
use crate::pages::report::html::numbers::{entry, number, signed, size};
use crate::pages::report::html::{Section, wide};
use crate::study::verify::Verification;

pub(crate) fn section(dossier: &Dossier) -> Option<Section> {
    let found = dossier.verification.as_ref()?;
    let body = html! {
        p {
            "One revolution from near the orbit: d" i { "x" } "′ = " i { "A" } " d" i { "x" } " + " i { "B" } " d" i { "T" }
            ", with " i { "A" } sup { "−" } ", " i { "B" } sup { "−" } " where the impact comes before the corner and "
            i { "A" } sup { "+" } ", " i { "B" } sup { "+" } " where it comes after it. Each column is computed on its own: "
            "no two share a formula for A and B. Finite difference and least squares run the same simulator; symbolic and scipy run no "
            "code of this program. Digits in which a column leaves the closed form are underlined."
        }
        @for table in &dossier.tables { (side(table)) }
        (jumps(found))
        (uncertainties(found))
        h3 { "How far they differ, and how far they may" }
        p { "Every pair of routes is compared in every quantity. Shown is the pair that is nearest to its bound." }
        (wide("Comparisons of the routes", &summary(dossier)))
        details {
            summary { "All " (found.comparisons.len()) " comparisons, with the reason of each bound" }
            (wide("All comparisons", &pairs(found)))
        }
    };
    Some(Section { id: "maps", title: "The local map by every route", body })
}

fn side(table: &MapTable) -> Markup {
    let printed = table.rows.iter().any(|row| row.printed.is_some());
    let caption = if table.side == "minus" { "Impact before the corner" } else { "Impact after the corner" };
    let first = |row: &crate::pages::report::dossier::MapRow| row.values.first().copied().unwrap_or(f64::NAN);
    wide(
        caption,
        &html! {
            table.maps {
                caption { (caption) }
                thead { tr {
                    th scope="col" { "entry" }
                    @for route in &table.routes { th.n scope="col" { (route) } }
                    th.n scope="col" { "differ by" }
                    @if printed { th.n scope="col" { "printed" } }
                } }
                tbody {
                    @for row in &table.rows {
                        tr {
                            th scope="row" { (entry(row.entry, table.side)) }
                            @for value in &row.values { td.n { (against(*value, first(row))) } }
                            td.n { (size(row.spread)) }
                            @if printed { td.n { @if let Some(digits) = &row.printed { (signed(digits)) } } }
                        }
                    }
                }
            }
        },
    )
}

/// A value in the digits of a table, those underlined that are not the reference's.
fn against(value: f64, reference: f64) -> Markup {
    let (text, other) = (shown(value), shown(reference));
    let same = text.chars().zip(other.chars()).take_while(|(one, two)| one == two).count();
    let same: usize = text.chars().take(same).map(char::len_utf8).sum();
    let (head, tail) = text.split_at(same);
    html! { data value=(value) { (signed(head)) @if !tail.is_empty() { u { (signed(tail)) } } } }
}

/// Eleven digits, trailing zeros among them.
fn shown(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let exponent = value.abs().log10().floor();
    if !(-4.0..9.0).contains(&exponent) {
        return format!("{value:.10e}");
    }
    format!("{value:.*}", (10.0 - exponent).max(0.0) as usize)
}

fn jumps(found: &Verification) -> Markup {
    let closed = found.map;
    let c = closed.c();
    let (one, two) = (c[0], c[1]);
    html! {
        p {
            "The sides meet where " i { "C" } " d" i { "x" } " + " i { "D" } " d" i { "T" } " = 0, with "
            i { "C" } " = (" (number(one, 11)) ", " (number(two, 11)) ") and " i { "D" } " = " (number(closed.d(), 11)) "."
        }
    }
}

fn uncertainties(found: &Verification) -> Markup {
    html! {
        @for route in found.routes_by_name() {
            @match &route.uncertainty {
                Some(Uncertainty::Fit { standard, condition_number, .. }) => details {
                    summary { "How well " (words::route(route.name)) " knows its entries" }
                    p { "Standard errors; the condition number of the fit is " (number(*condition_number, 3)) "." }
                    (errors(standard))
                },
                Some(Uncertainty::Extrapolation(error)) => details {
                    summary { "How well " (words::route(route.name)) " knows its entries" } p { "Error estimates." } (errors(error))
                },
                None => {}
            }
        }
    }
}

fn errors(sides: &CornerMap) -> Markup {
    wide(
        "Errors of the entries",
        &html! {
            table {
                thead { tr {
                    th scope="col" { "side" }
                    @for name in ["A11", "A12", "A21", "A22", "B1", "B2"] { th.n scope="col" { (entry(name, "")) } }
                } }
                tbody {
                    @for (name, side) in [("before", sides.minus), ("after", sides.plus)] {
                        tr { th scope="row" { (name) } @for value in side.entries() { td.n { (size(value)) } } }
                    }
                }
            }
        },
    )
}

fn summary(dossier: &Dossier) -> Markup {
    html! {
        table {
            thead { tr {
                th scope="col" { "quantity" } th.n scope="col" { "pairs that agree" } th.n scope="col" { "differ by" }
                th.n scope="col" { "allowed" } th scope="col" { "share" } th scope="col" { "between" }
            } }
            tbody {
                @for found in &dossier.quantities {
                    tr.disagrees[!found.closest.agrees] {
                        th scope="row" { (html::words(&words::quantity(found.quantity))) }
                        td.n { (found.agreeing) " of " (found.pairs) }
                        td.n { (size(found.closest.max_abs_diff)) }
                        td.n { (size(found.closest.bound.value)) }
                        td { (words::shared(found.shared_decimals)) }
                        td { (words::route(found.closest.routes[0])) ", " (words::route(found.closest.routes[1])) }
                    }
                }
            }
        }
    }
}

fn pairs(found: &Verification) -> Markup {
    html! {
        table {
            thead { tr {
                th scope="col" { "quantity" } th scope="col" { "between" } th.n scope="col" { "differ by" } th.n scope="col" { "in parts" }
                th.n scope="col" { "allowed" } th scope="col" { "verdict" } th scope="col" { "why so much is allowed" }
            } }
            tbody {
                @for pair in &found.comparisons {
                    tr.disagrees[!pair.agrees] {
                        th scope="row" { (html::words(&words::quantity(pair.quantity))) }
                        td { (words::route(pair.routes[0])) ", " (words::route(pair.routes[1])) }
                        td.n { (size(pair.max_abs_diff)) } td.n { (size(pair.max_rel_diff)) } td.n { (size(pair.bound.value)) }
                        td { @if pair.agrees { "agrees" } @else { "disagrees" } }
                        td.words { (pair.bound.reason) }
                    }
                }
            }
        }
    }
}

/// The paper's printed digits against those computed.
pub(crate) fn printed(dossier: &Dossier) -> Option<Section> {
    let found = dossier.verification.as_ref().filter(|found| !found.published.is_empty())?;
    let body = html! {
        p { "What the paper prints, digit by digit, and what comes out." }
        (wide("The paper's printed numbers", &html! {
            table {
                thead { tr {
                    th scope="col" { "quantity" } th scope="col" { "where" } th.n scope="col" { "printed" } th.n scope="col" { "computed" }
                    th.n scope="col" { "differ by" } th.n scope="col" { "allowed" } th scope="col" { "verdict" }
                } }
                @for item in &found.published {
                    @let rows = item.printed.len().max(1);
                    tbody.disagrees[!item.as_found] {
                        @for (index, digits) in item.printed.iter().enumerate() {
                            tr {
                                @if index == 0 {
                                    th scope="rowgroup" rowspan=(rows) { (html::words(&words::quantity(item.agreement.quantity))) }
                                    td rowspan=(rows) { (item.place) }
                                }
                                td.n { (signed(digits)) }
                                td.n { @if let Some(value) = item.computed.get(index) { (number(*value, 15)) } }
                                @if index == 0 {
                                    td.n rowspan=(rows) { (size(item.agreement.max_abs_diff)) }
                                    td.n rowspan=(rows) { (size(item.agreement.bound.value)) }
                                    td rowspan=(rows) { (crate::pages::report::html::ledger::badge(item.verdict)) @if !item.as_found { " otherwise than the ledger says" } }
                                }
                            }
                        }
                    }
                }
            }
        }))
        @let notes: Vec<_> = found.published.iter().filter(|item| !item.note.is_empty()).collect();
        @if !notes.is_empty() {
            h3 { "What is wrong with those that do not hold" }
            dl { @for item in notes { dt { (html::words(&words::quantity(item.agreement.quantity))) ", " (item.place) } dd { (item.note) } } }
        }
    };
    Some(Section { id: "printed", title: "The paper's digits", body })
}
