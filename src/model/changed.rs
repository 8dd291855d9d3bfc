//! Changes of a model's numbers by the names that a user gives them.

use std::collections::BTreeMap;

use super::fields::{Field, Fields, Value};
use super::quantity::ModelNumber;
use super::{Model, ModelError, Numeral, Smoothing, SmoothingTolerance, Spline, TableProfile, nearest};

impl Model {
    /// Dotted path of the number of follower or cam called `name`: the full path, or an end of a path that no other path has. `beside` are
    /// further allowed names, which error messages list too.
    pub fn path_of(&self, name: &str, beside: &[&str]) -> Result<&str, ModelError> {
        self.path_in(&["follower", "cam"], name, beside)
    }

    fn path_in(&self, tables: &[&str], name: &str, beside: &[&str]) -> Result<&str, ModelError> {
        let ends = |path: &str| path == name || path.strip_suffix(name).is_some_and(|head| head.ends_with('.'));
        let paths: Vec<&str> = self.fields.numbers_in(tables).map(|(path, _)| path).collect();
        match paths.iter().copied().filter(|path| ends(path)).collect::<Vec<_>>().as_slice() {
            [path] => Ok(path),
            [] => {
                // Compares whole paths if the name has a dot, else their last parts.
                let ends = paths.iter().map(|path| path.rsplit('.').next().unwrap_or(path));
                let names: Vec<&str> = if name.contains('.') { paths.clone() } else { ends.collect() };
                let meant = nearest(name, names.into_iter().chain(beside.iter().copied()));
                let there: Vec<&str> = beside.iter().chain(&paths).copied().collect();
                let words = format!("is not a number of this model; allowed are: {}", there.join(", "));
                Err(self.reject(name, words).meaning(meant.map(|meant| format!("did you mean {meant}?"))))
            }
            several => Err(self.reject(name, format!("may be any of {}: write the whole path", several.join(", ")))),
        }
    }

    /// Returns a copy of the model with another number in `field`, a dotted path. It is checked as the file is, except for checks that need
    /// the cam. The number becomes exact, because a study varies it. A spline near other lifts keeps its weight.
    pub(crate) fn rewritten(&self, field: &str, number: f64) -> Result<Self, ModelError> {
        let mut fields = self.fields.with_number(field, number.into())?;
        fields.drop_error(field);
        let mut model = Self::from_fields(fields)?;
        let own = self.table().and_then(|table| table.spline.smoothing());
        if let Some(Smoothing { tolerance: SmoothingTolerance::Weighted(weight), are_near, .. }) = own {
            model.weigh(*weight, *are_near);
        }
        Ok(model)
    }

    /// Returns a copy of the model with other numbers, including those of `[study]`, each named as for [`Self::path_of`]. An error of a
    /// number has `.error` after the number's name. All are checked together as the file is, except for checks that need the cam. The
    /// model's name lists the changes.
    pub(crate) fn renamed(&self, numbers: &[(String, Numeral)]) -> Result<Self, ModelError> {
        let (mut fields, mut new) = (self.fields.clone(), Vec::new());
        for (name, number) in numbers {
            let path = match Fields::number_of(name) {
                Some(number) => {
                    let path = self.path_in(&["follower"], number, &[]);
                    let is_exact = path.is_err() && self.path_in(&["cam", "study"], number, &[]).is_ok();
                    if is_exact {
                        return Err(self.reject(number, ModelNumber::without_error()));
                    }
                    path?.to_owned() + &name[number.len()..]
                }
                None => self.path_in(&["follower", "cam", "study"], name, &[])?.to_owned(),
            };
            if new.iter().any(|(changed, _)| *changed == path) {
                return Err(ModelError::file(self.file(), format!("{path} is set twice")));
            }
            fields = fields.with_number(&path, number.clone())?;
            new.push((path, number.number));
        }
        let mut changes = self.changes.clone();
        changes.retain(|(path, _)| new.iter().all(|(changed, _)| changed != path));
        changes.extend(new);
        let mut model = Self::from_fields(fields)?;
        if !numbers.is_empty() {
            let words: Vec<String> = changes.iter().map(|(path, number)| format!("{path} = {number}")).collect();
            model.name = format!("{} with {}", model.name, words.join(", "));
        }
        Ok(Self { changes, ..model })
    }

    /// Returns a copy of the model with a smoothing spline near other lifts, m, at the angles of its table. The caller gives the logarithm
    /// of the weight, the corners (exactly or nearly at these angles) and the dwells, degrees. Checks that need the cam are not made here.
    pub(crate) fn relifted(
        &self,
        lifts: &[f64],
        corners: (&[f64], bool),
        dwells: &[[f64; 2]],
        weight: f64,
    ) -> Result<Self, ModelError> {
        let table = self.table().ok_or_else(|| self.reject("cam.law", "is not a table"))?;
        let (corners, are_near) = corners;
        let mut fields = self.fields.without_text();
        fields.put_lifts(table, lifts.iter().copied());
        fields.put("cam.spline", Value::Text("smoothing".into()));
        fields.put("cam.corners_deg", Value::Array(corners.len()));
        for (index, corner) in corners.iter().enumerate() {
            fields.put(&format!("cam.corners_deg[{index}]"), Value::Number(*corner));
        }
        let rows = dwells.iter().map(|dwell| (*dwell, None)).collect();
        fields.put("cam.dwells_deg", if dwells.is_empty() { Value::Array(0) } else { Value::Rows(rows) });
        let mut model = Self { changes: self.changes.clone(), ..Self::from_fields(fields)? };
        model.weigh(weight, are_near);
        Ok(model)
    }

    /// Sets the weight of a smoothing spline, by its logarithm, and whether its corners are only near their given angles.
    fn weigh(&mut self, weight: f64, are_near: bool) {
        if let Some(TableProfile { spline: Spline::Smoothing(smoothing), .. }) = self.cam.table_mut() {
            (smoothing.tolerance, smoothing.are_near) = (SmoothingTolerance::Weighted(weight), are_near);
        }
    }

    /// Numeric and text fields of follower, cam, study and units by dotted path, as in JSON documents.
    pub(crate) fn values(&self) -> BTreeMap<&str, serde_json::Value> {
        let of = |(path, field): (&'_ std::sync::Arc<str>, &Field)| match &field.value {
            _ if !path.contains('.') => None,
            Value::Number(number) => Some((*number).into()),
            Value::Text(text) => Some(text.as_str().into()),
            _ => None,
        };
        self.fields.fields.iter().filter_map(|entry| Some((&**entry.0, of(entry)?))).collect()
    }

    /// Numbers that differ from the file, by dotted path.
    pub fn changes(&self) -> &[(String, f64)] {
        &self.changes
    }
}
