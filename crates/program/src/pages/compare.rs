//! Page of `compare`: the verdict, the fields that differ, then the numbers that changed, the largest change first.

use serde_json::Value;

use crate::show::Paged;
use crate::show::block::{Block, Column, Span, Table, TextMark, Words, words};
use crate::show::digits::{Digits, with_error};
use crate::show::sources::Sources;
use crate::show::words;
use corner_impact::study::compare::{Change, ModelComparison};

/// Ratio of a difference to its error above which only a bound is shown.
const MANY: f64 = 1e6;
/// Largest number of names in a list.
const LONGEST: usize = 40;

impl Paged for ModelComparison {
    fn blocks(&self) -> Vec<Block> {
        let [a, b] = [&self.verdict.a, &self.verdict.b].map(ToString::to_string);
        let is_word = |change: &&Change| change.difference.is_none() && change.a.is_some() && change.b.is_some();
        let others = self.changes.iter().filter(is_word).count();
        let verdict = match self.verdict_changed() {
            false if others > 0 => {
                words!["the same: ", a, format!("; but {} changed in kind", words::many(others as u64, "finding"))]
            }
            false => words!["the same: ", (TextMark::Good, a.as_str())],
            true => {
                words![(TextMark::Bad, "changed"), Span::Break, "first:  ", a, Span::Break, "second: ", b]
            }
        };
        let entries =
            [("verdict", verdict), ("first", (&self.models.a.name).into()), ("second", (&self.models.b.name).into())];
        let entries = entries.into_iter().map(|(name, words)| (name.into(), words)).collect();
        let mut page =
            vec![Block::Title("What changed from the first model to the second".into()), Block::Entries(9, entries)];
        page.extend(fields(self));
        let (alone, both): (Vec<&Change>, Vec<_>) =
            self.changes.iter().partition(|change| change.a.is_none() || change.b.is_none());
        let (numbers, words): (Vec<&Change>, Vec<_>) = both.into_iter().partition(|change| change.difference.is_some());
        page.extend(kinds(&words));
        let (known, unknown): (Vec<&Change>, Vec<_>) = numbers.into_iter().partition(|change| change.error.is_some());
        page.extend(moved("Numbers that changed", &known));
        page.extend(moved("Numbers that changed, with an unknown error", &unknown));
        if known.is_empty() && unknown.is_empty() {
            page.extend([
                Block::Gap,
                Block::paragraph("No number that both models have changed by more than its error."),
            ]);
        } else {
            // The column appears only if it has informative values.
            let is_told = known.iter().filter_map(|change| change.times_error).any(|times| times <= MANY);
            let times = if is_told { "times error: the difference over its error. " } else { "" };
            page.extend(speeds(self));
            let sources = Sources::of(&self.measured, self.errors).if_any();
            let open = sources.map_or("a measured cam", Sources::name);
            let note = format!(
                "The speeds of the corner impact and of separation come first, then the numbers that changed most. moved: the difference \
                 over the size of the first number. {times}The error has two parts, of both models: the difference between routes or the \
                 error of an estimate, and the uncertainty from {open}. Quantities with the same digits in both models share a line. All \
                 numbers are computed. Unless a unit is named, positions are in "
            );
            page.push(Block::Note(words![
                note,
                Span::Unit("m"),
                ", velocities in ",
                Span::Unit("m/s"),
                ", times in s and speeds of linear ranges in rpm."
            ]));
            let note = sources.filter(|sources| !sources.errors.are_none()).map(|sources| {
                format!(
                    "{} The error of a number with the same value and error in both models acts on both alike.",
                    sources.note()
                )
            });
            page.extend(note.map(|note| Block::Note(note.into())));
        }
        page.extend(named("Only in the first", alone.iter().copied().filter(|change| change.b.is_none())));
        page.extend(named("Only in the second", alone.iter().copied().filter(|change| change.a.is_none())));
        let (same, within): (Vec<&Change>, Vec<_>) =
            self.unchanged.iter().partition(|change| change.difference.is_none_or(|difference| difference == 0.0));
        page.extend(named("Different, but by no more than their errors", within.into_iter()));
        let same = format!("Numbers and words that are the same in all digits: {}; --json lists them.", same.len());
        page.extend([Block::Gap, Block::paragraph(same)]);
        page
    }
}

fn told(value: Option<&Value>) -> Words {
    match value {
        None => "none".into(),
        Some(Value::String(word)) => word.into(),
        Some(Value::Bool(is)) => (if *is { "yes" } else { "no" }).into(),
        Some(value) => {
            value.as_f64().map_or_else(|| value.to_string().into(), |number| words![(number, Digits::Short)])
        }
    }
}

fn fields(found: &ModelComparison) -> Vec<Block> {
    if found.fields.is_empty() {
        return vec![Block::Gap, Block::paragraph("Both models have the same fields.")];
    }
    let columns = [Column::words("field"), Column::words("first"), Column::words("second")];
    let mut table = Table::new("Fields that differ", columns);
    for field in &found.fields {
        table.row([field.field.as_str().into(), told(field.a.as_ref()), told(field.b.as_ref())]);
    }
    vec![Block::Heading("Fields that differ in the files".into()), Block::Table(table)]
}

/// Fields with changed words.
fn kinds(changes: &[&Change]) -> Vec<Block> {
    if changes.is_empty() {
        return Vec::new();
    }
    let mut table = Table::new("Words", [Column::words("quantity"), Column::words("first"), Column::words("second")]);
    for change in changes {
        table.row([change.quantity.as_str().into(), told(change.a.as_ref()), told(change.b.as_ref())]);
    }
    vec![Block::Heading("Findings that changed in kind".into()), Block::Table(table)]
}

/// Groups changes whose two numbers look alike in the displayed digits, ordered by the first change of each group.
fn alike<'a>(changes: &[&'a Change]) -> Vec<Vec<&'a Change>> {
    let short = |value: &Option<Value>| value.as_ref().and_then(Value::as_f64).map(|number| Digits::Short.text(number));
    let digits = |change: &Change| [&change.a, &change.b].map(short);
    let mut all: Vec<([Option<String>; 2], Vec<&Change>)> = Vec::new();
    for change in changes {
        let digits = digits(change);
        match all.iter_mut().find(|(known, _)| *known == digits) {
            Some((_, alike)) => alike.push(change),
            None => all.push((digits, vec![change])),
        }
    }
    all.into_iter().map(|(_, alike)| alike).collect()
}

/// Ratio of a difference to its error, or a bound if it is very large.
fn times(error: f64) -> Words {
    if error > MANY { "> 1e6".into() } else { words![(error, Digits::Size)] }
}

/// Uncertainty of the difference of each main speed, by its sources, where numbers have errors.
fn speeds(found: &ModelComparison) -> Option<Block> {
    let sources = Sources::of(&found.measured, found.errors).if_any().filter(|it| !it.errors.are_none())?;
    let of_speed = |change: &Change| {
        let open = change.open.filter(|_| change.is_speed())?;
        let (digits, total) = with_error(open.total());
        let difference = change.difference?;
        let words = words![format!("{}: moved by ", change.quantity), (difference, digits), " ± ", (total, digits)];
        Some(words![words, format!(" rpm, {}", sources.parts(&open))])
    };
    let all: Vec<Words> = found.changes.iter().chain(&found.unchanged).filter_map(of_speed).collect();
    (!all.is_empty()).then_some(Block::List(all))
}

fn moved(title: &str, changes: &[&Change]) -> Vec<Block> {
    if changes.is_empty() {
        return Vec::new();
    }
    let number = |head: &str| Column { gap: 2, ..Column::number(head) };
    let mut columns = vec![number("first"), number("second"), number("moved %")];
    // If every change is many times its error, the column has no information.
    let errors = || changes.iter().filter_map(|change| change.times_error);
    let has_errors = errors().any(|times| times <= MANY);
    let many =
        if errors().next().is_some() && !has_errors { ", each by more than a million times its error" } else { "" };
    columns.extend(has_errors.then(|| number("times error")));
    columns.push(Column { gap: 2, ..Column::words("quantity") });
    let mut table = Table::new(title, columns);
    for alike in alike(changes) {
        let change = alike[0];
        let percent = change.relative.map_or("".into(), |part| {
            // With fewer digits than the column has places, the value would be shown as 0.
            let digits = if part.abs() < 0.001 { Digits::Size } else { Digits::Significant(3) };
            words![(100.0 * part, digits)]
        });
        let mut cells = vec![told(change.a.as_ref()), told(change.b.as_ref()), percent];
        cells.extend(has_errors.then(|| change.times_error.map_or("".into(), times)));
        let names: Vec<&str> = alike.iter().map(|change| change.quantity.as_str()).collect();
        cells.push(names.join(", ").into());
        table.row(cells);
    }
    vec![Block::Heading(format!("{title}{many} ({})", changes.len()).into()), Block::Table(table)]
}

fn named<'a>(title: &str, changes: impl Iterator<Item = &'a Change>) -> Vec<Block> {
    let names: Vec<&str> = changes.map(|change| change.quantity.as_str()).collect();
    if names.is_empty() {
        return Vec::new();
    }
    let title = format!("{title} ({})", names.len());
    let shown = if names.len() > LONGEST { "--json lists them".to_owned() } else { names.join(", ") };
    vec![Block::Heading(title.into()), Block::paragraph(shown)]
}
