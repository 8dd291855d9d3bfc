//! The document of a verification as one page of text for a terminal.

use std::fmt::{self, Write};

use crate::agreement::{Agreement, shared_decimals, worse};
use crate::border_collision::feigin::Scenario;
use crate::cam::Side;
use crate::corner::map::Uncertainty;
use crate::corner::{CornerMap, SideMap};
use crate::orbit::Eigenvalue;
use crate::pages::local_map;
use crate::pages::report::dossier::spoken;
use crate::published::PrintedNumber;
use crate::show::block::{Column, Mark, Table, Words};
use crate::show::digits::Digits;
use crate::show::page::{Page, WIDTH};
use crate::show::words::{self, mark};
use crate::study::verify::Verification;

impl Verification {
    /// The page, as wide as where nothing says how wide, without marks.
    pub fn text(&self) -> Result<String, fmt::Error> {
        Ok(self.page(WIDTH)?.plain().to_owned())
    }

    /// The page, in `width` columns.
    pub fn page(&self, width: usize) -> Result<Page, fmt::Error> {
        let mut page = Page::new(width);
        let out = &mut page;
        orbit(out, self)?;
        map(out, self)?;
        agreement(out, self)?;
        bifurcation(out, self)?;
        local_map::local_map(out, self)?;
        published(out, self)?;
        verdict(out, self)?;
        Ok(page)
    }
}

fn orbit(out: &mut Page, document: &Verification) -> fmt::Result {
    let at = &document.at;
    let state = at.x_star();
    let [before, after] = at.cam_acceleration();
    let title = format!("Corner impact of {}", document.model.name);
    out.title(&title)?;
    out.paragraph_at(2, &document.model.source)?;
    out.heading("The orbit, solved for from the model")?;
    writeln!(out, "  period   T* = {} s   ({:.9} rpm)", Digits::Significant(14).text(at.period), at.speed_rpm())?;
    writeln!(
        out,
        "  state    x* = ({}, {})",
        Digits::Significant(13).text(state[0]),
        Digits::Significant(13).text(state[1])
    )?;
    let origin = Digits::Significant(9).text(at.origin);
    writeln!(out, "           half a revolution from the impact; position is measured from q = {origin} m")?;
    let degrees = at.corner.angle.to_degrees();
    writeln!(
        out,
        "  impact   at cam angle {degrees:.6} deg, where c'' jumps from {:.4} to {:.4} m/s^2",
        before, after
    )?;
    writeln!(
        out,
        "           q = {:.9} m, v = {:.6} before and {:.6} after, c' = {:.6} m/s",
        at.corner.plus.value, at.velocity_before, at.velocity_after, at.cam_velocity
    )?;
    for other in &document.others {
        writeln!(
            out,
            "  also     {:.6} rpm at {:.6} deg: narrow [study] to verify that one",
            other.speed_rpm(),
            other.corner.angle.to_degrees()
        )?;
    }
    Ok(())
}

fn map(out: &mut Page, document: &Verification) -> fmt::Result {
    out.heading("Its local map:  dx' = A dx + B dT")?;
    out.paragraph_at(2, "dx is the deviation of the state (position in m, velocity in m/s) from x*, dT that of the period from T* (s), dx' \
         the deviation one revolution later. minus holds where the impact comes before the corner, plus where it comes \
         after it. C = h (A+ - A-), D = h (B+ - B-), h = [1 0]: the sides meet where C dx + D dT = 0.",
    )?;
    writeln!(out)?;
    side(out, document, Side::Minus)?;
    side(out, document, Side::Plus)?;
    {
        let closed = document.closed_form().map;
        let c = closed.c();
        writeln!(
            out,
            "  C = ({}, {}),  D = {}\n",
            Digits::Significant(10).text(c[0]),
            Digits::Significant(10).text(c[1]),
            Digits::Significant(10).text(closed.d())
        )?;
    }
    for route in document.routes_by_name() {
        let name = route.name;
        if let Some(Uncertainty::Fit { standard, systematic: Some(systematic), condition_number: condition }) =
            &route.uncertainty
        {
            let ((a, b), (bias_a, bias_b)) = (largest(standard), largest(systematic));
            writeln!(
                out,
                "  {}: standard error up to {a:.1e} in A, {b:.1e} in B; bias up to {bias_a:.1e}, {bias_b:.1e};",
                spoken(name)
            )?;
            writeln!(out, "  {:width$}  condition number {condition:.1}", "", width = name.len())?;
        }
        if let Some(Uncertainty::Extrapolation(correction)) = &route.uncertainty {
            let (a, b) = largest(correction);
            writeln!(out, "  {}: error estimate up to {a:.1e} in A, {b:.1e} in B", spoken(name))?;
        }
    }
    Ok(())
}

fn side(out: &mut Page, document: &Verification, side: Side) -> fmt::Result {
    let name = if side == Side::Minus { "minus" } else { "plus" };
    writeln!(out, "  {name}: {}", words::side(side))?;
    let routes: Vec<_> = document.routes_by_name().map(|route| (spoken(route.name), *route.map.of(side))).collect();
    let printed = |quantity: &str| {
        document.published.iter().find(|entry| entry.agreement.quantity == format!("{quantity}_{name}"))
    };
    let room = out.width().saturating_sub(LABELS + if printed("A").is_some() { PRINTED } else { 0 }).max(COLUMN);
    // As few blocks as hold all columns, and as even.
    let blocks = routes.len().div_ceil(room / COLUMN).max(1);
    for routes in routes.chunks(routes.len().div_ceil(blocks).max(1)) {
        columns(out, routes, printed)?;
    }
    Ok(())
}

/// Widths of a table of maps: its labels, a route, the digits in print.
const LABELS: usize = 8;
const COLUMN: usize = 14;
const PRINTED: usize = 19;

/// One block of a side's table: some routes, and what the paper prints.
fn columns<'a>(
    out: &mut Page,
    routes: &[(String, SideMap)],
    printed: impl Fn(&str) -> Option<&'a PrintedNumber>,
) -> fmt::Result {
    // Two words, two lines.
    let heads: Vec<_> = routes.iter().map(|(route, _)| route.split_once(' ').unwrap_or(("", route))).collect();
    let mut lines = [String::new(), String::new()];
    for (first, second) in &heads {
        write!(lines[0], "{first:>COLUMN$}")?;
        write!(lines[1], "{second:>COLUMN$}")?;
    }
    if printed("A").is_some() {
        write!(lines[1], "{:>PRINTED$}", "printed")?;
    }
    writeln!(out, "{:LABELS$}{}", "", lines[0].trim_end())?;
    writeln!(out, "{:LABELS$}{}", "", lines[1])?;
    for (index, label) in ["A11", "A12", "A21", "A22", "B1", "B2"].into_iter().enumerate() {
        write!(out, "    {label:<4}")?;
        let (quantity, entry) = if index < 4 { ("A", index) } else { ("B", index - 4) };
        for (_, side) in routes {
            let values = side.entries();
            let block = if index < 4 { &values[..4] } else { &values[4..] };
            write!(out, "{:>COLUMN$}", cell(values[index], block))?;
        }
        if let Some(digits) = printed(quantity).and_then(|number| number.printed.get(entry)) {
            write!(out, "{digits:>PRINTED$}")?;
        }
        writeln!(out)?;
    }
    writeln!(out)
}

/// An entry with ten digits of its block's largest, in at most 13 columns.
fn cell(value: f64, block: &[f64]) -> String {
    let largest = block.iter().fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
    if (1e-3..1e9).contains(&largest) || largest == 0.0 {
        format!("{value:.*}", places(block))
    } else {
        format!("{value:.5e}")
    }
}

/// Decimals that show ten digits of the largest entry.
fn places(entries: &[f64]) -> usize {
    let largest = entries.iter().fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
    if largest > 0.0 && largest.is_finite() { (9.0 - largest.log10().floor()).clamp(0.0, 15.0) as usize } else { 9 }
}

fn largest(sides: &CornerMap) -> (f64, f64) {
    let both = [sides.minus, sides.plus];
    let a = both.iter().flat_map(|side| side.a.iter()).copied().fold(0.0, worse);
    let b = both.iter().flat_map(|side| side.b.iter()).copied().fold(0.0, worse);
    (a, b)
}

fn agreement(out: &mut Page, document: &Verification) -> fmt::Result {
    out.heading("Do the routes agree? Every pair, in every quantity; shown is the pair closest to its bound")?;
    let columns = [
        Column::left("quantity", 2, 19),
        Column::right("pairs", 5),
        Column::right("differ by", 12),
        Column::right("allowed", 10),
        Column::left("share", 2, 14),
        Column::left("between", 0, 0),
    ];
    let mut table = Table::new("Comparisons", columns);
    let mut quantities: Vec<&str> = Vec::new();
    for entry in &document.comparisons {
        if !quantities.contains(&entry.quantity.as_str()) {
            quantities.push(&entry.quantity);
        }
    }
    for quantity in quantities {
        let pairs: Vec<_> = document.comparisons.iter().filter(|entry| entry.quantity == quantity).collect();
        let use_of_bound = |entry: &&&Agreement| entry.max_abs_diff / entry.bound.value;
        let closest = pairs.iter().max_by(|a, b| use_of_bound(a).total_cmp(&use_of_bound(b)));
        let disagreeing = pairs.iter().filter(|entry| !entry.agrees);
        for (index, entry) in closest.into_iter().filter(|entry| entry.agrees).chain(disagreeing).enumerate() {
            let Agreement { routes: [left, right], max_abs_diff, bound, agrees, .. } = entry;
            let pair = format!("{} - {}", spoken(left), spoken(right));
            let shared = share(*max_abs_diff);
            let pair = match agrees {
                true => Words::from(pair),
                false => (Mark::Bad, format!("{pair}  DISAGREE").as_str()).into(),
            };
            let (name, count) = if index == 0 { (quantity, pairs.len().to_string()) } else { ("", String::new()) };
            let [name, difference, allowed] =
                [name.to_owned(), format!("{max_abs_diff:.1e}"), format!("{:.1e}", bound.value)].map(Words::from);
            table.row([name, Words::from(count), difference, allowed, Words::from(shared), pair]);
        }
    }
    out.table(&table)
}

fn share(diff: f64) -> String {
    shared_decimals(diff).map_or("all digits".to_owned(), |decimals| format!("{decimals} decimals"))
}

fn bifurcation(out: &mut Page, document: &Verification) -> fmt::Result {
    out.heading("What happens there")?;
    let eigenvalues = |pair: &[Eigenvalue; 2]| {
        let one = |re: f64, im: f64| {
            if im == 0.0 {
                format!("{re:.9}")
            } else {
                format!("{re:.9} {} {:.9}i", if im < 0.0 { '-' } else { '+' }, im.abs())
            }
        };
        format!("{},  {}", one(pair[0].re, pair[0].im), one(pair[1].re, pair[1].im))
    };
    writeln!(out, "  eigenvalues of A-   {}", eigenvalues(&document.closed_form().map.minus.eigenvalues()))?;
    writeln!(out, "  eigenvalues of A+   {}", eigenvalues(&document.closed_form().map.plus.eigenvalues()))?;
    if let Ok(form) = &document.normal_form {
        let matrix = |m: &nalgebra::Matrix2<f64>| {
            let [a, b, c, d] = [m[(0, 0)], m[(0, 1)], m[(1, 0)], m[(1, 1)]].map(entry);
            format!("[[{a}, {b}], [{c}, {d}]]")
        };
        writeln!(out, "  normal form         A-bar {}", matrix(&form.a_bar_minus))?;
        writeln!(out, "                      A+bar {}", matrix(&form.a_bar_plus))?;
        writeln!(
            out,
            "                      B bar ({}, {}),  C bar ({}, {})",
            entry(form.b_bar[0]),
            entry(form.b_bar[1]),
            entry(form.c_bar[0]),
            entry(form.c_bar[1])
        )?;
    }
    if let Ok(verdict) = &document.classification {
        writeln!(
            out,
            "  Feigin's counts     {} + {} real eigenvalues above 1, {} + {} below -1",
            verdict.minus.above_one,
            verdict.plus.above_one,
            verdict.minus.below_minus_one,
            verdict.plus.below_minus_one
        )?;
        let born = if verdict.period_two_orbit && verdict.scenario != Scenario::NonsmoothFlip {
            ", and an orbit of period two"
        } else {
            ""
        };
        writeln!(out, "  verdict             {}{born}", verdict.scenario)?;
        let meaning = words::meaning(verdict.scenario);
        out.paragraph_at(22, meaning)?;
        let fate = |stable: bool, speeds: crate::border_collision::feigin::Speeds| {
            format!("{} one at speeds {speeds} than omega*", if stable { "a stable" } else { "an unstable" })
        };
        writeln!(out, "  fixed points        minus: {}", fate(verdict.minus.stable, verdict.minus.exists_for))?;
        writeln!(out, "                      plus:  {}", fate(verdict.plus.stable, verdict.plus.exists_for))?;
    }
    if let Err(refusal) = &document.classification {
        writeln!(out, "  verdict             none")?;
        out.paragraph_at(22, &refusal.to_string())?;
    }
    local_map::conditions(out, document)
}

fn published(out: &mut Page, document: &Verification) -> fmt::Result {
    if document.published.is_empty() {
        return Ok(());
    }
    out.heading("The paper's printed numbers")?;
    for entry in &document.published {
        let PrintedNumber { place, agreement: Agreement { quantity, max_abs_diff, .. }, verdict, as_found, .. } = entry;
        let shared = share(*max_abs_diff);
        write!(out, "  {quantity:<20}{place:<20}differs by {max_abs_diff:>7.1e}, shares {shared:<13}")?;
        out.marked(mark(*verdict), &verdict.to_string());
        if !*as_found {
            write!(out, "   ")?;
            out.marked(Mark::Bad, "UNEXPECTED");
        }
        writeln!(out)?;
    }
    for entry in document.published.iter().filter(|entry| !entry.note.is_empty()) {
        let computed: Vec<_> = entry.computed.iter().map(|value| Digits::Significant(10).text(*value)).collect();
        let words = format!(
            "{}, printed ({}), computed ({}): {}",
            entry.agreement.quantity,
            entry.printed.join(", "),
            computed.join(", "),
            entry.note
        );
        writeln!(out)?;
        out.paragraph_at(2, &words)?;
    }
    Ok(())
}

fn verdict(out: &mut Page, document: &Verification) -> fmt::Result {
    if !document.skipped.is_empty() {
        out.heading("NOT RUN")?;
        for skipped in &document.skipped {
            out.paragraph_at(2, &format!("{}: {}", skipped.route, skipped.why))?;
        }
    }
    out.heading("Verdict")?;
    let failed = document.comparisons.iter().filter(|entry| !entry.agrees).count();
    let unexpected = document.published.iter().filter(|entry| !entry.as_found).count();
    let wrong = document.published.iter().filter(|entry| entry.as_found && !entry.agreement.agrees).count();
    let maps = document
        .comparisons
        .iter()
        .filter(|entry| ["A_minus", "A_plus", "B_minus", "B_plus"].contains(&entry.quantity.as_str()));
    let fewest = maps.filter_map(|entry| shared_decimals(entry.max_abs_diff)).min();
    let shared = fewest.map_or("all digits".to_owned(), |decimals| format!("{decimals} decimals or more"));
    writeln!(
        out,
        "  {} of {} comparisons agree; every entry of A and B shares {shared}.",
        document.comparisons.len() - failed,
        document.comparisons.len()
    )?;
    if !document.published.is_empty() {
        let right = document.published.len() - wrong - unexpected;
        writeln!(
            out,
            "  Of the paper's {} printed numbers {right} hold, {wrong} are wrong as listed, {unexpected} came out otherwise than found.",
            document.published.len()
        )?;
    }
    let missing: Vec<&str> =
        document.skipped.iter().filter(|skipped| skipped.failed).map(|skipped| skipped.route.as_str()).collect();
    let all_agree = document.comparisons.iter().all(|entry| entry.agrees)
        && document.published.iter().all(|number| number.as_found);
    let (mark, word, reason) = match missing.as_slice() {
        _ if document.agrees => (Mark::Good, "AGREES", String::new()),
        [] => (Mark::Bad, "DISAGREES", ": a comparison above".to_owned()),
        [most @ .., last] => {
            let names = if most.is_empty() { (*last).to_owned() } else { format!("{} and {last}", most.join(", ")) };
            // What ran may agree: then nothing disagrees, and not everything was checked.
            let word = if all_agree { "INCOMPLETE" } else { "DISAGREES" };
            (Mark::Bad, word, format!(": {names} did not run"))
        }
    };
    write!(out, "  ")?;
    out.marked(mark, word);
    writeln!(out, "{reason}")
}

/// Nine decimals, without trailing zeros.
fn entry(value: f64) -> String {
    let text = format!("{value:.9}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}
