//! The page of `compare`: the verdict, the fields that differ, then what moved, the most first.

use serde_json::Value;

use crate::show::Paged;
use crate::show::block::{Block, Column, Mark, Span, Table, Words, words};
use crate::show::digits::Digits;
use crate::study::compare::{Change, Comparison};

/// The longest list of names that a page has.
const LONGEST: usize = 40;

impl Paged for Comparison {
    fn blocks(&self) -> Vec<Block> {
        let [a, b] = [&self.verdict.a, &self.verdict.b].map(ToString::to_string);
        let is_word = |change: &&Change| change.difference.is_none() && change.a.is_some() && change.b.is_some();
        let others = self.changes.iter().filter(is_word).count();
        let verdict = match self.verdict_changed() {
            false if others > 0 => words!["the same: ", a, format!("; but {others} findings are of another kind")],
            false => words!["the same: ", (Mark::Good, a.as_str())],
            true => {
                words![(Mark::Bad, "changed"), Span::Break, "A: ", a, Span::Break, "B: ", b]
            }
        };
        let entries = [("verdict", verdict), ("A", (&self.models.a.name).into()), ("B", (&self.models.b.name).into())];
        let entries = entries.into_iter().map(|(name, words)| (name.into(), words)).collect();
        let mut page = vec![Block::Title("What moved from A to B".into()), Block::Entries(9, entries)];
        page.extend(fields(self));
        let (alone, both): (Vec<&Change>, Vec<_>) =
            self.changes.iter().partition(|change| change.a.is_none() || change.b.is_none());
        let (numbers, words): (Vec<&Change>, Vec<_>) = both.into_iter().partition(|change| change.difference.is_some());
        page.extend(kinds(&words));
        let (known, unknown): (Vec<&Change>, Vec<_>) = numbers.into_iter().partition(|change| change.error.is_some());
        page.extend(moved("Numbers that moved, speeds and then the most first", &known));
        page.extend(moved("Numbers whose error is not known, speeds and then the most first", &unknown));
        if known.is_empty() && unknown.is_empty() {
            page.extend([Block::Gap, Block::paragraph("No number that both have moved by more than its error.")]);
        } else {
            let note = "moved: what of B less A is more than its error, over the larger of both. times error: the difference \
                        over its error, which is how far routes differ, or an estimate's own, and what a measured cam leaves open, \
                        of both models. All computed.";
            page.push(Block::Note(note.into()));
        }
        page.extend(named("A alone has", alone.iter().copied().filter(|change| change.b.is_none())));
        page.extend(named("B alone has", alone.iter().copied().filter(|change| change.a.is_none())));
        let (same, within): (Vec<&Change>, Vec<_>) =
            self.unchanged.iter().partition(|change| change.difference.is_none_or(|difference| difference == 0.0));
        page.extend(named("Different, but by no more than their errors", within.into_iter()));
        let same = format!("Numbers and words alike in all digits: {}; --json lists them.", same.len());
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

fn fields(found: &Comparison) -> Vec<Block> {
    if found.fields.is_empty() {
        return vec![Block::Gap, Block::paragraph("The fields of both models are the same.")];
    }
    let columns = [Column::words("field"), Column::words("A"), Column::words("B")];
    let mut table = Table::new("Fields that differ", columns);
    for field in &found.fields {
        table.row([field.field.as_str().into(), told(field.a.as_ref()), told(field.b.as_ref())]);
    }
    vec![Block::Heading("What differs in the files".into()), Block::Table(table)]
}

/// What is told by words, and is another.
fn kinds(changes: &[&Change]) -> Vec<Block> {
    if changes.is_empty() {
        return Vec::new();
    }
    let mut table = Table::new("Words", [Column::words("quantity"), Column::words("A"), Column::words("B")]);
    for change in changes {
        table.row([change.quantity.as_str().into(), told(change.a.as_ref()), told(change.b.as_ref())]);
    }
    vec![Block::Heading("What is of another kind".into()), Block::Table(table)]
}

fn moved(title: &str, changes: &[&Change]) -> Vec<Block> {
    if changes.is_empty() {
        return Vec::new();
    }
    let number = |head: &str| Column { gap: 2, ..Column::number(head) };
    let mut columns = vec![Column::words("quantity"), number("A"), number("B"), number("moved %")];
    let has_errors = changes.iter().any(|change| change.times_error.is_some());
    columns.extend(has_errors.then(|| number("times error")));
    let mut table = Table::new(title, columns);
    for change in changes {
        let sign = change.difference.map_or(1.0, f64::signum);
        let percent = change.relative.map_or("".into(), |part| words![(sign * 100.0 * part, Digits::Significant(3))]);
        let mut cells =
            vec![change.quantity.as_str().into(), told(change.a.as_ref()), told(change.b.as_ref()), percent];
        cells.extend(has_errors.then(|| change.times_error.map_or("".into(), |times| words![(times, Digits::Size)])));
        table.row(cells);
    }
    vec![Block::Heading(format!("{title} ({})", changes.len()).into()), Block::Table(table)]
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
