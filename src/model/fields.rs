//! Fields of a model file as a flat list with their lines, so that every error can point into the file.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::Arc;

use super::numeral::Numeral;
use super::quantity::{Allowed, MODEL_NUMBERS, ModelNumber};
use super::{ModelError, nearest};
use crate::untrusted;

/// Pair of numbers, and its line.
pub(super) type Pair = ([f64; 2], Option<usize>);

#[derive(Clone, Debug)]
pub(super) enum Value {
    Table,
    /// Length of an array whose elements are separate fields: `path[0]`, `path[1]`, ...
    Array(usize),
    /// Array of pairs of numbers; it may have a million rows.
    Rows(Vec<Pair>),
    Text(String),
    Number(f64),
    Other,
}

#[derive(Clone, Debug)]
pub(super) struct Field {
    /// Line in the file; `None` for a default, a replaced value, or a field without a file.
    pub(super) line: Option<usize>,
    /// Whether the field was given; false for a default.
    pub(super) is_there: bool,
    /// Range of the name in the text; for an element of an array, range of its value.
    pub(super) key: Range<usize>,
    /// Range of the value in the text.
    pub(super) span: Range<usize>,
    pub(super) written: Arc<str>,
    pub(super) value: Value,
}

impl Field {
    pub(super) fn without_line(written: String, value: Value) -> Self {
        Self { line: None, is_there: true, key: 0..0, span: 0..0, written: written.into(), value }
    }

    /// Returns the value as written; `None` for a list of tables.
    fn shown(&self) -> Option<String> {
        match self.value {
            Value::Table => None,
            Value::Array(_) | Value::Rows(_) if self.written.starts_with("[[") || self.written.is_empty() => None,
            _ => Some(self.written.to_string()),
        }
    }
}

/// Fields of a model file by dotted path, and the set of fields of the format.
#[derive(Clone, Debug)]
pub(super) struct Fields {
    file: String,
    /// Text of the file; `None` once a field is changed.
    text: Option<Arc<str>>,
    pub(super) fields: BTreeMap<Arc<str>, Field>,
    known: Arc<BTreeSet<String>>,
    /// Whether the format has all fields; a changed number does not alter that.
    is_checked: bool,
}

impl Fields {
    /// Separators of the names in a path.
    pub(super) const PARTS: [char; 2] = ['.', '['];

    /// Returns an empty list of fields for a file with a text, or for a source that is not a file.
    pub(super) fn none(file: &str, text: Option<&str>) -> Self {
        let (text, known) = (text.map(Arc::from), Arc::default());
        Self { file: file.into(), text, fields: BTreeMap::new(), known, is_checked: false }
    }

    /// Inserts a field, or replaces it.
    pub(super) fn put(&mut self, path: &str, value: Value) {
        self.fields.insert(path.into(), Field::without_line(String::new(), value));
    }

    /// Text of the file; empty once a field is changed.
    pub(super) fn source(&self) -> &str {
        self.text.as_deref().unwrap_or_default()
    }

    pub(super) fn file(&self) -> &str {
        &self.file
    }

    /// Path and value of every number in `tables`.
    pub(super) fn numbers_in<'a>(&'a self, tables: &[&str]) -> impl Iterator<Item = (&'a str, f64)> {
        /// Numbers that control how a table is read, and are not numbers of the machine.
        const OF_READING: [&str; 6] = [
            "cam.angle_column",
            "cam.lift_column",
            "cam.radius_column",
            "cam.x_column",
            "cam.y_column",
            "cam.turn_deg",
        ];
        let inside = |path: &str| {
            path.split_once('.').is_some_and(|(table, _)| tables.contains(&table)) && !OF_READING.contains(&path)
        };
        self.fields.iter().filter_map(move |(path, field)| match field.value {
            Value::Number(number) if inside(path) && !Self::is_error(path) => Some((&**path, number)),
            _ => None,
        })
    }

    /// Returns a copy of the fields with another number at `path`; fails if there is no number. An exact number may get an error.
    pub(super) fn with_number(&self, path: &str, number: Numeral) -> Result<Self, ModelError> {
        let mut fields = self.clone();
        let is_exact = !self.has(path) && Self::number_of(path).is_some_and(|of| self.has(of));
        if is_exact {
            fields.put(path, Value::Number(0.0));
        }
        match fields.fields.get_mut(path) {
            Some(field @ Field { value: Value::Number(_), .. }) => {
                field.value = Value::Number(number.number);
                field.written = number.text.into();
                field.line = None;
                fields.text = None;
                Ok(fields)
            }
            _ => Err(self.reject(path, "is not a number of this model")),
        }
    }

    /// Returns a copy of the fields without the text of a file.
    pub(super) fn without_text(&self) -> Self {
        Self { text: None, known: Arc::default(), is_checked: false, ..self.clone() }
    }

    pub(super) fn has(&self, path: &str) -> bool {
        self.fields.contains_key(path)
    }

    /// Reads the number at a path, within its allowed range. A missing number has its default, and can still be changed.
    pub(super) fn number(&mut self, path: &str) -> Result<f64, ModelError> {
        let row = ModelNumber::of(path);
        if let Some(default) = row.and_then(|number| number.default).filter(|_| !self.has(path)) {
            let table = path.rsplit_once('.').and_then(|(table, _)| self.fields.get(table));
            let key = table.map_or(0..0, |table| table.key.clone());
            let (span, written, value) = (key.clone(), default.to_string().into(), Value::Number(default));
            self.fields.insert(path.into(), Field { line: None, is_there: false, key, span, written, value });
        }
        self.number_within(path, row.map_or(Allowed::FINITE, |number| number.allowed))
    }

    /// Reads the number at a path, within a range.
    pub(super) fn number_within(&mut self, path: &str, allowed: Allowed) -> Result<f64, ModelError> {
        if let Value::Number(number) = *self.take(path)?
            && allowed.contains(number)
        {
            return Ok(number);
        }
        let has_error = self.is_table(path) && self.has(&Self::error_of(path));
        Err(self.reject(path, if has_error { ModelNumber::without_error() } else { allowed.to_string() }))
    }

    /// Returns an error if there is no field at a path.
    pub(super) fn present(&mut self, path: &str) -> Result<(), ModelError> {
        self.take(path).map(|_| ())
    }

    /// Reads the length of an array, at least one and at most `most`.
    pub(super) fn length(&mut self, path: &str, what: &str, most: usize) -> Result<usize, ModelError> {
        match *self.take(path)? {
            Value::Array(length) if (1..=most).contains(&length) => Ok(length),
            Value::Array(length) => Err(self.reject(path, format!("has {length} {what}; 1 to {most} are allowed"))),
            _ => Err(self.reject(path, format!("must be a list of {what}"))),
        }
    }

    /// Reads an array of finite numbers, one to `most` of them.
    pub(super) fn numbers(&mut self, path: &str, most: usize) -> Result<Vec<f64>, ModelError> {
        let length = self.length(path, "numbers", most)?;
        (0..length).map(|index| self.number(&format!("{path}[{index}]"))).collect()
    }

    /// Reads pairs of numbers, each with its line, `fewest` to `most` of them.
    pub(super) fn rows(&mut self, path: &str, [fewest, most]: [usize; 2]) -> Result<Vec<Pair>, ModelError> {
        match self.take(path)?.clone() {
            Value::Rows(rows) if (fewest..=most).contains(&rows.len()) => Ok(rows),
            Value::Rows(rows) => {
                Err(self.reject(path, format!("has {} rows; {fewest} to {most} are allowed", rows.len())))
            }
            Value::Array(0) => Err(self.reject(path, format!("has 0 rows; {fewest} to {most} are allowed"))),
            _ => Err(self.reject(path, "must be a list of rows, each of two finite numbers")),
        }
    }

    /// Whether there is a table at a path.
    pub(super) fn is_table(&self, path: &str) -> bool {
        matches!(self.fields.get(path), Some(Field { value: Value::Table, .. }))
    }

    /// Whether a list is empty.
    pub(super) fn is_empty_list(&self, path: &str) -> bool {
        matches!(self.fields.get(path), Some(Field { value: Value::Array(0), .. }))
    }

    /// Counts the tables `[[path]]`, at least one and at most `most`.
    pub(super) fn tables(&mut self, path: &str, most: usize) -> Result<usize, ModelError> {
        let length = self.length(path, "tables", most)?;
        for item in (0..length).map(|index| format!("{path}[{index}]")) {
            if !self.is_table(&item) {
                return Err(self.reject(&item, format!("must be a table under [[{path}]]")));
            }
        }
        Ok(length)
    }

    pub(super) fn text(&mut self, path: &str) -> Result<String, ModelError> {
        /// Largest number of characters: every page and figure shows the text.
        const LONGEST: usize = 1000;
        match self.take(path)?.clone() {
            Value::Text(text) if text.chars().count() <= LONGEST => Ok(text),
            Value::Text(_) => Err(self.reject(path, format!("must have {LONGEST} characters or fewer"))),
            _ => Err(self.reject(path, "must be text in quotes")),
        }
    }

    /// Reads `true` or `false`.
    pub(super) fn flag(&mut self, path: &str) -> Result<bool, ModelError> {
        self.take(path)?;
        match self.fields.get(path).map(|field| &*field.written) {
            Some("true") => Ok(true),
            Some("false") => Ok(false),
            _ => Err(self.reject(path, "must be true or false")),
        }
    }

    pub(super) fn text_or(&mut self, path: &str, default: &str) -> Result<String, ModelError> {
        self.may_hold(path);
        if self.has(path) { self.text(path) } else { Ok(default.into()) }
    }

    /// Reads the text at a path, or the default if the field is missing; `None` for any value that is not text.
    pub(super) fn word<'a>(&'a mut self, path: &str, default: &'a str) -> Option<&'a str> {
        self.may_hold(path);
        match self.fields.get(path).map(|field| &field.value) {
            None => Some(default),
            Some(Value::Text(text)) => Some(text),
            Some(_) => None,
        }
    }

    fn take(&mut self, path: &str) -> Result<&Value, ModelError> {
        self.may_hold(path);
        self.fields.get(path).map(|field| &field.value).ok_or_else(|| {
            // A mistyped field is missing under its own name, so the message lists the fields of its table.
            let table = path.rsplit_once('.').map_or("", |(table, _)| table);
            let inside = |(name, field): &(&Arc<str>, &Field)| {
                let is_there = field.is_there && !name.ends_with(']');
                is_there && name.rsplit_once('.').map_or("", |(table, _)| table) == table
            };
            let fields = self.fields.iter().filter(inside);
            let present: Vec<_> =
                fields.map(|(name, _)| untrusted::value(name.rsplit('.').next().unwrap_or(name))).collect();
            let found =
                if present.is_empty() { String::new() } else { format!("; found there: {}", present.join(", ")) };
            self.mistyped(path).unwrap_or_else(|| self.reject(path, "is missing")).found(&found)
        })
    }

    /// Error about a missing field, if a similar name in its place may be a misspelling of the field or of its table.
    fn mistyped(&self, path: &str) -> Option<ModelError> {
        let (table, name) = path.rsplit_once('.').unwrap_or(("", path));
        let in_table = |at: &str, name: &str| if at.is_empty() { name.to_owned() } else { format!("{at}.{name}") };
        let (at, meant, shown) = if table.is_empty() || self.has(table) {
            (table, name, name.to_owned())
        } else {
            let (at, meant) = table.rsplit_once('.').unwrap_or(("", table));
            (at, meant, format!("[{meant}]"))
        };
        // A number of the format is not a misspelling of another; the format's other names are dissimilar.
        let is_name = |word: &str| MODEL_NUMBERS.iter().any(|number| number.name() == word);
        let inside = |path: &str| path.strip_prefix(at).map(|rest| rest.trim_start_matches('.').to_owned());
        let stray: Vec<String> = self.fields.keys().filter_map(|path| inside(path)).collect();
        let stray = stray.iter().map(String::as_str).filter(|name| !name.contains(['.', '[']) && !is_name(name));
        let written = stray.filter(|word| nearest(word, [meant]).is_some()).min()?;
        let field = self.fields.get(&*in_table(at, written))?;
        let (is_table, written) = (shown.starts_with('['), untrusted::value(written));
        let written = if is_table { format!("[{written}]") } else { written.into_owned() };
        let place = field.line.map_or_else(|| "it".into(), |line| format!("line {line}"));
        Some(ModelError {
            line: field.line,
            ..self
                .reject(path, "is missing")
                .meaning(Some(format!("did you mean {shown} where {place} says {written}?")))
                .at(self.text.clone(), Some(field.key.clone()))
        })
    }

    /// Registers `path` as a field of the format, whether or not it is present.
    pub(super) fn may_hold(&mut self, path: &str) {
        if !self.is_checked {
            Arc::make_mut(&mut self.known).insert(path.into());
        }
    }

    /// Builds an error about a field, present or not.
    pub(super) fn reject(&self, path: &str, allowed: impl Into<String>) -> ModelError {
        let field = self.fields.get(path);
        let table = path.rsplit_once('.').and_then(|(table, _)| self.fields.get(table));
        ModelError {
            line: field.or(table).and_then(|field| field.line),
            field: Some(path.into()),
            value: field.and_then(Field::shown),
            ..ModelError::file(&self.file, allowed.into())
                .at(self.text.clone(), field.map(|field| field.span.clone()).or(table.map(|table| table.key.clone())))
        }
    }

    /// Returns the entry of `choices` that a text field names.
    pub(super) fn choice<T: Copy>(&mut self, path: &str, choices: &[(&str, T)]) -> Result<T, ModelError> {
        let text = self.text(path)?;
        if let Some((_, entry)) = choices.iter().find(|(name, _)| *name == text) {
            return Ok(*entry);
        }
        let known: Vec<_> = choices.iter().map(|(name, _)| format!("\"{name}\"")).collect();
        let meant = nearest(&text, choices.iter().map(|(name, _)| *name));
        let meant = meant.map(|name| format!("did you mean \"{name}\"?"));
        Err(self.reject(path, format!("must be one of: {}", known.join(", "))).meaning(meant))
    }

    /// Returns an error about the first field in the file that the format does not have.
    pub(super) fn finish(&mut self) -> Result<(), ModelError> {
        if self.is_checked {
            return Ok(());
        }
        let table_of = |path: &str| path.rsplit_once('.').map_or("", |(table, _)| table).to_owned();
        let tables: BTreeSet<String> = self.known.iter().map(|path| table_of(path)).collect();
        let unknown = self.fields.iter().filter(|(path, field)| {
            let expected_table = matches!(field.value, Value::Table) && tables.contains(&***path);
            !expected_table && !self.known.contains(&***path)
        });
        let Some((path, field)) = unknown.min_by_key(|(_, field)| field.line) else {
            self.is_checked = true;
            return Ok(());
        };
        if tables.contains(&**path) {
            return Err(self.reject(path, format!("must be a table, [{path}]")));
        }
        let table = table_of(path);
        // An array is listed once, without its elements.
        let listed = |known: &&String| !known.ends_with(']') && table_of(known) == table;
        let siblings = self.known.iter().filter(listed);
        // A number with an error is a table as well.
        let is_number = |known: &String| self.known.contains(known);
        let tables = tables.iter().filter(|known| !known.is_empty() && listed(known) && !is_number(known));
        let allowed: Vec<&str> =
            siblings.chain(tables).map(|known| known.rsplit('.').next().unwrap_or(known)).collect();
        let place = if table.is_empty() { "at the top of the file".to_owned() } else { format!("in [{table}]") };
        let is_table = matches!(field.value, Value::Table);
        // A table has no value between its name and these words.
        let is = if is_table { "is an " } else { "" };
        let words = format!("{is}unknown field; allowed {place}: {}", allowed.join(", "));
        let name = path.rsplit('.').next().unwrap_or(path);
        let shown = |name: &str| if is_table { format!("[{name}]") } else { name.to_owned() };
        let meant = nearest(name, allowed.iter().copied()).map(|name| format!("did you mean {}?", shown(name)));
        Err(self.reject(path, words).meaning(meant).at(self.text.clone(), Some(field.key.clone())))
    }
}
