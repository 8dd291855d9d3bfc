//! A chart as a zarr store of version 3: a folder that xarray and similar tools read, block by block. Several processes may fill it at
//! once.
//!
//! Each variable is an array of little-endian numbers without compression. A block of it is one file, which exists completely or not at
//! all. A block is done if all its files exist. So resuming, sharing the work and merging need no further record.

use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::{Blocks, Chart, Filled, class};
use crate::file::{self, FileError, Output};
use crate::flight::State;
use crate::model::Units;
use crate::orbit::long_run::Kind;
use crate::progress::{Unwatched, Watch};
use crate::study::survey::{Axis, Placed, Point, Start, SweepError};

/// A store of a chart in a folder.
#[derive(Clone, Copy, Debug)]
pub struct Store<'a> {
    folder: &'a Path,
    chart: &'a Chart,
    /// Number of columns and rows of a block.
    sides: [usize; 2],
}

/// Reason why there is no store, or not one of its blocks.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "the message says what each is")]
pub enum StoreError {
    /// The store belongs to another chart.
    #[error("{folder}: holds another chart: {how}")]
    Another { folder: String, how: String },
    /// The folder holds no store.
    #[error("{folder}: no store of a chart: {why}")]
    None { folder: String, why: String },
    /// The sides of a block are not allowed.
    #[error("blocks of {columns} x {rows} points: they have 1 or more on each side, and {most} or fewer in all")]
    Sides { columns: usize, rows: usize, most: usize },
    /// The store has no such block.
    #[error("no block {block}: the store has {total}, counted from 0")]
    NoBlock { block: usize, total: usize },
    /// A folder of the store cannot be made.
    #[error("{folder}: cannot be made: {error}")]
    Folder { folder: String, error: std::io::Error },
    /// A file of the store cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// The contents of a file cannot be written to the disk.
    #[error(transparent)]
    Write(#[from] std::io::Error),
    /// The chart cannot be run.
    #[error(transparent)]
    Chart(#[from] SweepError),
}

/// The share of the blocks that one process fills: those whose number, counted from 1, is `index` modulo `of`.
#[derive(Clone, Copy, Debug)]
pub struct Shard {
    /// Number of the share, from 1 to `of`.
    pub index: usize,
    /// Number of shares.
    pub of: usize,
}

impl Shard {
    /// All blocks.
    pub const ALL: Self = Self { index: 1, of: 1 };
}

/// Default number of columns and rows of a block.
pub const SIDES: [usize; 2] = [100, 100];
/// Largest number of points in a block.
const MOST: usize = 1 << 24;

/// An array of the store.
#[derive(Clone, Copy, Debug)]
pub struct Variable {
    /// Name of the array.
    pub name: &'static str,
    /// Number of bytes of an integer; none for a double.
    pub whole: Option<usize>,
    /// Unit of the values.
    pub units: &'static str,
    /// Description of the values.
    pub long_name: &'static str,
    value: fn(&Point) -> f64,
}

/// Variables of each point; NaN, or -1 for an integer, where a point failed. The class comes last: a block without it is not done.
pub const VARIABLES: [Variable; 8] = [
    Variable {
        name: "revolutions",
        whole: Some(4),
        units: "1",
        long_name: "revolutions of one period, 0 where there is none",
        value: |it| it.revolutions as f64,
    },
    Variable {
        name: "impacts",
        whole: Some(4),
        units: "1",
        long_name: "impacts of one period, 0 where there is none",
        value: |it| it.impacts as f64,
    },
    Variable {
        name: "impacts_per_revolution",
        whole: None,
        units: "1",
        long_name: "impacts a revolution",
        value: |it| it.impact_rate,
    },
    Variable {
        name: "growth_rate",
        whole: None,
        units: "1",
        long_name: "growth of a small deviation a revolution, a natural logarithm",
        value: |it| it.growth.value,
    },
    Variable {
        name: "growth_error",
        whole: None,
        units: "1",
        long_name: "its standard error",
        value: |it| it.growth.error,
    },
    Variable {
        name: "impact_speed",
        whole: None,
        units: "m s-1",
        long_name: "speed of the fastest impact, of follower and cam against each other",
        value: |it| it.impact_speed,
    },
    Variable {
        name: "followed",
        whole: Some(4),
        units: "1",
        long_name: "revolutions that the run was followed for",
        value: |it| it.followed as f64,
    },
    Variable {
        name: "class",
        whole: Some(1),
        units: "1",
        long_name: "kind of motion",
        value: |it| code(Some(it.kind)),
    },
];

/// Classes in the order of their codes; none for points that failed.
pub const CLASSES: [Option<Kind>; 6] =
    [Some(Kind::Stays), Some(Kind::Periodic), Some(Kind::Resting), Some(Kind::Chaotic), Some(Kind::Undecided), None];

fn code(kind: Option<Kind>) -> f64 {
    CLASSES.iter().position(|class| *class == kind).unwrap_or(CLASSES.len()) as f64
}

impl Variable {
    fn data_type(&self) -> &'static str {
        match self.whole {
            Some(1) => "int8",
            Some(_) => "int32",
            None => "float64",
        }
    }

    /// Returns the variable's value at a point, as a double even for an integer.
    pub fn of(&self, point: &Result<Point, String>) -> f64 {
        match point {
            Ok(point) => (self.value)(point),
            Err(_) if self.name == "class" => code(None),
            Err(_) => self.fill().1,
        }
    }

    /// Fill value, as JSON and as a double, where nothing was computed or a point failed.
    fn fill(&self) -> (Value, f64) {
        if self.whole.is_some() { (json!(-1), -1.0) } else { (json!("NaN"), f64::NAN) }
    }

    fn bytes(&self, values: impl Iterator<Item = f64>) -> Vec<u8> {
        match self.whole {
            Some(1) => values.flat_map(|value| (value as i8).to_le_bytes()).collect(),
            Some(_) => values.flat_map(|value| (value as i32).to_le_bytes()).collect(),
            None => values.flat_map(f64::to_le_bytes).collect(),
        }
    }

    /// Returns the name, type and attributes of the variable, with those of the CF conventions.
    pub fn document(&self, units: &Units) -> Value {
        json!({ "name": self.name, "dtype": self.data_type(), "attributes": self.attributes(units) })
    }

    fn attributes(&self, units: &Units) -> Value {
        let mut attributes = json!({ "units": units.spelled(self.units), "long_name": self.long_name });
        if self.name == "class" {
            attributes["flag_values"] = json!((0..CLASSES.len()).collect::<Vec<_>>());
            attributes["flag_meanings"] = json!(CLASSES.map(class).join(" "));
        }
        attributes
    }
}

fn array(shape: &[usize], chunk: &[usize], data_type: &str, fill: &Value, names: &[&str], attributes: &Value) -> Value {
    json!({
        "zarr_format": 3,
        "node_type": "array",
        "shape": shape,
        "data_type": data_type,
        "chunk_grid": { "name": "regular", "configuration": { "chunk_shape": chunk } },
        "chunk_key_encoding": { "name": "default", "configuration": { "separator": "/" } },
        "fill_value": fill,
        "codecs": [{ "name": "bytes", "configuration": { "endian": "little" } }],
        "dimension_names": names,
        "attributes": attributes,
    })
}

impl<'a> Store<'a> {
    /// Opens the store of `chart` in a folder, with blocks of so many columns and rows. Creates it if there is none, and refuses the
    /// store of another chart.
    pub fn open(folder: &'a Path, chart: &'a Chart, sides: [usize; 2]) -> Result<Self, StoreError> {
        let [columns, rows] = sides;
        if !(1..=MOST).contains(&columns.saturating_mul(rows)) {
            return Err(StoreError::Sides { columns, rows, most: MOST });
        }
        let store = Self { folder, chart, sides };
        let whole = store.document();
        let grid = [&chart.x, &chart.y].map(|axis| {
            let bytes: Vec<u8> = axis.values.iter().flat_map(|value| value.to_le_bytes()).collect();
            (Path::new(axis.parameter.name()).join("c/0"), bytes)
        });
        let there = match file::text(&folder.join("zarr.json")) {
            // If a file is in the way, making the folder reports it.
            Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => None,
            read => Some(read.map_err(|error| none(folder, error.to_string()))?),
        };
        if let Some(text) = there {
            let there = serde_json::from_str(&text).map_err(|error| none(folder, error.to_string()))?;
            let is_other = |(file, bytes): &&(PathBuf, Vec<u8>)| {
                let file = folder.join(file);
                // A file of another length differs and need not be read.
                !std::fs::metadata(&file).is_ok_and(|there| there.len() == bytes.len() as u64)
                    || !std::fs::read(file).is_ok_and(|there| there == *bytes)
            };
            let other = grid.iter().zip([&chart.x, &chart.y]).find(|(file, _)| is_other(file));
            let how = difference(&there, &whole)
                .or_else(|| other.map(|(_, axis)| format!("other values of {}", axis.parameter.name())));
            return match how {
                None => Ok(store),
                Some(how) => Err(StoreError::Another { folder: folder.display().to_string(), how }),
            };
        }
        for (file, bytes) in &grid {
            store.write(file, bytes)?;
        }
        let arrays = whole["consolidated_metadata"]["metadata"].as_object();
        for (name, document) in arrays.into_iter().flatten() {
            store.write_document(&Path::new(name).join("zarr.json"), document)?;
        }
        // This file is written last: whoever finds it finds the others.
        store.write_document(Path::new("zarr.json"), &whole)?;
        Ok(store)
    }

    /// Computes the blocks of a share that are not done, on `threads` threads.
    pub fn fill(&self, part: Shard, threads: Option<usize>, watch: &dyn Watch) -> Result<Filled, StoreError> {
        let (total, mut times) = (self.total(), [0.0; 2]);
        let (mut computed, mut points) = (0, 0);
        for block in (0..total).filter(|block| block % part.of == part.index - 1) {
            watch.at("blocks", block as u64, total as u64);
            if let Some((found, [cpu_s, wall_s])) = self.fill_block(block, threads)? {
                times = [times[0] + cpu_s, times[1] + wall_s];
                (computed, points) = (computed + 1, points + found);
            }
        }
        let blocks = Blocks { computed, ..status(self.folder)? };
        Ok(Filled { chart: self.chart.clone(), points, blocks, times })
    }

    /// Computes one block, counted row by row from 0, if it is not done. Returns the number of points, and the times that they took.
    pub fn fill_block(&self, block: usize, threads: Option<usize>) -> Result<Option<(usize, [f64; 2])>, StoreError> {
        let (total, [across, _]) = (self.total(), self.blocks());
        if block >= total {
            return Err(StoreError::NoBlock { block, total });
        }
        let (column, row) = (block % across, block / across);
        if is_done(self.folder, [column, row], self.sides) {
            return Ok(None);
        }
        let [wide, high] = self.sides;
        let range = |index: usize, side: usize, axis: &Axis| index * side..axis.values.len().min((index + 1) * side);
        let (columns, rows) = (range(column, wide, &self.chart.x), range(row, high, &self.chart.y));
        let width = columns.len();
        let (found, times) = self.chart.part([columns, rows], threads, &Unwatched)?;
        for variable in &VARIABLES {
            let value = |index: usize| {
                let (right, up) = (index % wide, index / wide);
                found.get(up * width + right).filter(|_| right < width).map_or(variable.fill().1, |it| variable.of(it))
            };
            let file = Path::new(variable.name).join(format!("c/{row}/{column}"));
            self.write(&file, &variable.bytes((0..wide * high).map(value)))?;
        }
        Ok(Some((found.len(), times)))
    }

    fn total(&self) -> usize {
        self.blocks().iter().product()
    }

    /// Number of blocks across and up.
    pub fn blocks(&self) -> [usize; 2] {
        let [x, y] = [&self.chart.x, &self.chart.y].map(|axis| axis.values.len());
        [x.div_ceil(self.sides[0]), y.div_ceil(self.sides[1])]
    }

    fn document(&self) -> Value {
        let chart = self.chart;
        let [x, y] = [&chart.x, &chart.y].map(|axis| (axis.parameter.name(), axis.values.len()));
        let mut arrays = serde_json::Map::new();
        for variable in &VARIABLES {
            let (fill, _) = variable.fill();
            let shape = [y.1, x.1];
            let document = array(
                &shape,
                &[self.sides[1], self.sides[0]],
                variable.data_type(),
                &fill,
                &[y.0, x.0],
                &variable.attributes(&chart.model.units),
            );
            arrays.insert(variable.name.into(), document);
        }
        for (name, count) in [x, y] {
            let units = if name == "rpm" { json!({ "units": "rpm" }) } else { json!({}) };
            arrays.insert(name.into(), array(&[count], &[count], "float64", &json!("NaN"), &[name], &units));
        }
        json!({
            "zarr_format": 3,
            "node_type": "group",
            "attributes": attributes(chart),
            "consolidated_metadata": { "kind": "inline", "must_understand": false, "metadata": arrays },
        })
    }

    fn write_document(&self, file: &Path, document: &Value) -> Result<(), StoreError> {
        self.write(file, format!("{document:#}").as_bytes())
    }

    fn write(&self, file: &Path, bytes: &[u8]) -> Result<(), StoreError> {
        let path: PathBuf = self.folder.join(file);
        if let Some(folder) = path.parent() {
            let refused = |error| StoreError::Folder { folder: folder.display().to_string(), error };
            std::fs::create_dir_all(folder).map_err(refused)?;
        }
        let mut output = Output::file(&path)?;
        output.write_all(bytes)?;
        Ok(output.commit()?)
    }
}

/// Returns the attributes that describe a chart's origin, by the CF conventions and by names of its own.
pub fn attributes(chart: &Chart) -> Value {
    json!({
        "Conventions": "CF-1.10",
        "title": format!("{}: what a run comes to", chart.model.name),
        "model": chart.model.name,
        "model_toml": chart.model.text(),
        "rpm": chart.speed(),
        "start": start(&chart.start),
        "transient": chart.budget.transient,
        "record": chart.budget.record,
        "longest": chart.budget.longest,
        "patience": chart.budget.patience,
        "corner_impact_version": env!("CARGO_PKG_VERSION"),
    })
}

fn start(start: &Start) -> Value {
    let angle = start.cam_angle;
    match start.follower {
        Placed::At(State { position, velocity }) => {
            json!({ "cam_angle_rad": angle, "position_m": position, "velocity_m_s": velocity })
        }
        Placed::OnCam(velocity) => json!({ "cam_angle_rad": angle, "relative_velocity_m_s": velocity }),
    }
}

/// Returns the first difference between the chart of a store and the requested one, by their documents.
fn difference(there: &Value, asked: &Value) -> Option<String> {
    const CLASSES: &str = "/consolidated_metadata/metadata/class";
    let told = [
        ("version", "/attributes/corner_impact_version"),
        ("model", "/attributes/model"),
        ("speed, rpm,", "/attributes/rpm"),
        ("start", "/attributes/start"),
        ("transient", "/attributes/transient"),
        ("record", "/attributes/record"),
        ("pair of axes, upwards and across,", &format!("{CLASSES}/dimension_names")),
        ("number of rows and columns", &format!("{CLASSES}/shape")),
        ("number of rows and columns of a block", &format!("{CLASSES}/chunk_grid/configuration/chunk_shape")),
    ];
    let differs = |(name, pointer): &(&str, &str)| {
        let [there, asked] = [there, asked].map(|document| document.pointer(pointer).unwrap_or(&Value::Null));
        (there != asked).then(|| format!("its {name} is {there}, and not {asked}"))
    };
    // A model's text and the attributes of arrays are too long to be shown.
    let long = || match there["attributes"]["model_toml"] == asked["attributes"]["model_toml"] {
        true => "what is said of its arrays is something else".into(),
        false => "numbers of its model are others".into(),
    };
    told.iter().find_map(differs).or_else(|| (there != asked).then(long))
}

/// Whether every file of a block exists with its full length.
fn is_done(folder: &Path, [column, row]: [usize; 2], sides: [usize; 2]) -> bool {
    VARIABLES.iter().all(|variable| {
        let file = folder.join(variable.name).join(format!("c/{row}/{column}"));
        let length = sides[0] * sides[1] * variable.whole.unwrap_or(8);
        std::fs::metadata(file).is_ok_and(|file| file.len() == length as u64)
    })
}

/// Counts the blocks of the store in a folder, and those that are done.
pub fn status(folder: &Path) -> Result<Blocks, StoreError> {
    let blocks = blocks_of(folder)?;
    Ok(Blocks { computed: 0, done: blocks.iter().filter(|done| **done).count(), total: blocks.len() })
}

fn none(folder: &Path, why: String) -> StoreError {
    StoreError::None { folder: folder.display().to_string(), why }
}

/// Whether each block of the store in a folder is done, row by row.
pub fn blocks_of(folder: &Path) -> Result<Vec<bool>, StoreError> {
    let none = |why: String| none(folder, why);
    let text = file::text(&folder.join("zarr.json")).map_err(|error| none(error.to_string()))?;
    let group: Value = serde_json::from_str(&text).map_err(|error| none(error.to_string()))?;
    let classes = &group["consolidated_metadata"]["metadata"]["class"];
    let side = |axis: usize| {
        let length = |sides: &Value| sides[axis].as_u64().filter(|count| *count > 0).map(|count| count as usize);
        length(&classes["shape"]).zip(length(&classes["chunk_grid"]["configuration"]["chunk_shape"]))
    };
    let (rows, columns) = side(0).zip(side(1)).ok_or_else(|| none("it has no classes".into()))?;
    let (high, wide) = (rows.0.div_ceil(rows.1), columns.0.div_ceil(columns.1));
    let all = (0..high).flat_map(|row| (0..wide).map(move |column| [column, row]));
    Ok(all.map(|block| is_done(folder, block, [columns.1, rows.1])).collect())
}
