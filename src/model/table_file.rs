//! Measured lifts in a model file: the rows, given directly or in another file.

use std::borrow::Cow;
use std::path::Path;

use super::ModelError;
use super::above::Chosen;
use super::fields::{Fields, Pair};
use super::lines::{Holds, Table};
use super::rows::{MOST_ROWS, TableRow};
use super::table::TableProfile;
use super::table_fields::SPLINES;
use super::table_units::AngleUnit;
use super::turn::FEWEST_ROWS;
use crate::file;

/// Reads the fields of `law = "table"`, and the file that they name unless they contain its rows.
pub(super) fn read(fields: &mut Fields) -> Result<TableProfile, ModelError> {
    read_rows(fields, Holds::Lifts, false)
}

/// Reads the table of `law = "contour"`: radii over polar angles, or points.
pub(super) fn read_contour(fields: &mut Fields) -> Result<TableProfile, ModelError> {
    let path = "cam.coordinates";
    fields.may_hold(path);
    let mut chosen = |holds: Holds| {
        let paths = holds.choices().map(|column| format!("cam.{column}"));
        paths.iter().for_each(|path| fields.may_hold(path));
        paths.into_iter().find(|path| fields.has(path))
    };
    let [polar, xy] = [Holds::Radii, Holds::Points].map(&mut chosen);
    let holds = match (&polar, &xy) {
        _ if fields.has(path) => fields.choice(path, &[("polar", Holds::Radii), ("xy", Holds::Points)])?,
        (None, Some(_)) => Holds::Points,
        _ => Holds::Radii,
    };
    let is_open = !fields.has(path) && polar.is_none() && xy.is_none();
    let other = if holds == Holds::Points { polar } else { xy };
    if let Some(other) = other {
        let words =
            "belongs to other coordinates: give either angle_column and radius_column, or x_column and y_column";
        return Err(fields.reject(&other, words));
    }
    read_rows(fields, holds, is_open)
}

fn read_rows(fields: &mut Fields, holds: Holds, may_be_points: bool) -> Result<TableProfile, ModelError> {
    fields.may_hold("cam.rows");
    if fields.has("cam.rows") {
        let spline = fields.choice("cam.spline", &SPLINES)?;
        let pairs = fields.rows("cam.rows", [FEWEST_ROWS, MOST_ROWS])?;
        fields.may_hold("cam.file");
        if fields.has("cam.file") {
            return Err(fields.reject("cam.file", "must not be given together with cam.rows: give one of them"));
        }
        let has_lines = pairs.iter().all(|(_, line)| line.is_some());
        let text = fields.source().to_owned();
        let table = Table {
            holds,
            may_be_points: false,
            file: fields.file().into(),
            text: &text,
            has_lines,
            angles: AngleUnit::DEGREES,
            says_angles: false,
        };
        let row = |(index, ([angle_deg, lift], line)): (usize, Pair)| {
            let line = line.unwrap_or(index + 1);
            if angle_deg.is_finite() && lift.is_finite() {
                return Ok(TableRow { angle_deg, lift, line });
            }
            let [one, two] = holds.named();
            let words = match holds {
                Holds::Points => format!("must have a finite {one} and a finite {two}"),
                _ => format!("must be a finite angle and a finite {}", holds.value()),
            };
            Err(table.reject(line, "cam.rows", &format!("[{angle_deg}, {lift}]"), words))
        };
        let rows: Vec<TableRow> = pairs.into_iter().enumerate().map(row).collect::<Result<_, _>>()?;
        let swapped =
            table.seems_swapped(&rows).then_some("the angle comes first in each row: are the two numbers swapped?");
        let meant =
            |error: ModelError| if swapped.is_some() { error.meaning(swapped.map(str::to_owned)) } else { error };
        return table.profile(fields, (None, spline), rows, None).map_err(meant);
    }
    let file = fields.text("cam.file")?;
    let spline = fields.choice("cam.spline", &SPLINES)?;
    let path = Path::new(fields.file()).parent().unwrap_or(Path::new("")).join(&file);
    let shown = path.display().to_string();
    let text = file::text_of_any_age(&path)
        .map_err(|error| fields.reject("cam.file", format!("cannot be read at {shown}: {error}")))?;
    // Spreadsheets begin UTF-8 with a byte order mark; old ones end lines with a carriage return alone, and old systems end a text with
    // Ctrl-Z.
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text).trim_end_matches(['\u{1a}', '\r', '\n']);
    let text = if text.contains('\r') {
        Cow::Owned(text.replace("\r\n", "\n").replace('\r', "\n"))
    } else {
        Cow::Borrowed(text)
    };
    let angles = AngleUnit::DEGREES;
    let mut table =
        Table { holds, may_be_points, file: shown, text: &text, has_lines: true, angles, says_angles: false };
    let [one, two] = holds.choices().map(|column| format!("cam.{column}"));
    let chosen = [Chosen::read(fields, &one)?, Chosen::read(fields, &two)?];
    let (rows, layout) = table.rows(&chosen).map_err(|complaint| table.discreet(complaint, &chosen))?;
    if layout.are_points {
        table.holds = Holds::Points;
    }
    let is_unsaid = may_be_points && layout.header.is_none();
    let swapped = table.seems_swapped(&rows).then(|| {
        let ([one, two], [angle, value]) = (holds.choices(), layout.columns);
        format!("the columns seem to be swapped: set {one} = {value} and {two} = {angle} in [cam]")
    });
    table.profile(fields, (Some(file), spline), rows, Some(layout)).map_err(|error| {
        let meant = "are the columns x and y? then set coordinates = \"xy\" in [cam]";
        match swapped {
            Some(swapped) => error.meaning(Some(swapped)),
            None if is_unsaid && error.pointer.meant.is_none() => error.meaning(Some(meant.into())),
            None => error,
        }
    })
}
