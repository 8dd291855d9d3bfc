//! A chart as a zarr store of version 3: a folder that xarray and similar tools read, block by block. Several processes may fill it at
//! once.
//!
//! Each variable is an array of little-endian numbers without compression. A block of it is one file, which exists completely or not at
//! all, and ends in a checksum. A block is done if all its files exist and are undamaged. So resuming, sharing the work and merging need no
//! further record.
//!
//! The folder belongs to the chart whose `zarr.json` is there first: that file appears whole, is never replaced, and describes the model, the
//! axes and the runs. Every process compares it with its own chart before it writes anything else, and again before it writes a block. A
//! folder with arrays and without that file is refused, because nothing says which chart its blocks are of.

mod checksum;
mod layout;
mod variables;

use std::io::Write;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::{Chart, Filled};
use crate::file::{self, Output};
use crate::flight::State;
use crate::progress::{Unwatched, Watch};
use crate::study::chart::Blocks;
use crate::study::survey::{Axis, Placed, Start};

use layout::{Layout, counted, described, has_checksums, none};
pub use layout::{StoreError, blocks_of, status, status_within};
pub use variables::{CLASSES, VARIABLES, Variable};

/// A store of a chart in a folder.
#[derive(Clone, Copy, Debug)]
pub struct Store<'a> {
    folder: &'a Path,
    chart: &'a Chart,
    layout: Layout,
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
    /// Opens the store of `chart` in a folder, with blocks of so many columns and rows. Creates it if there is none, completes it if a
    /// process was stopped while it created it, and refuses the store of another chart.
    pub fn open(folder: &'a Path, chart: &'a Chart, sides: [usize; 2]) -> Result<Self, StoreError> {
        let points = [&chart.x, &chart.y].map(|axis| axis.values.len());
        let mut store = Self { folder, chart, layout: Layout { points, sides, has_checksums: true }.checked()? };
        let there = match described(folder)? {
            None if store.begin()? => None,
            None => {
                let words =
                    "it has arrays but no zarr.json, which describes their chart; use another folder for a new chart";
                Some(described(folder)?.ok_or_else(|| none(folder, words.into()))?)
            }
            there => there,
        };
        if let Some(text) = there {
            let there: Value = serde_json::from_str(&text).map_err(|error| none(folder, error.to_string()))?;
            store.layout.has_checksums = has_checksums(&there);
            let other = difference(&there, &store.document(), chart).or_else(|| store.other_axis());
            other.map_or(Ok(()), |how| Err(store.another(how)))?;
        }
        store.complete()?;
        Ok(store)
    }

    /// Takes the folder for this chart. Returns false if it has arrays or a `zarr.json` already.
    fn begin(&self) -> Result<bool, StoreError> {
        let names = VARIABLES.iter().map(|variable| variable.name).chain(self.axes().map(|axis| axis.parameter.name()));
        if names.into_iter().any(|name| std::fs::symlink_metadata(self.folder.join(name)).is_ok()) {
            return Ok(false);
        }
        let is_new = !self.folder.exists();
        let document = self.output(Path::new("zarr.json"), pretty(&self.document()).as_bytes());
        let begun = document.and_then(|document| Ok(document.commit_new()?));
        if begun.is_err() && is_new {
            // The folder is empty, unless another process has begun a chart in it.
            let _ = std::fs::remove_dir(self.folder);
        }
        begun
    }

    /// Writes the axes, and the descriptions of the arrays, that are missing or damaged.
    fn complete(&self) -> Result<(), StoreError> {
        let whole = self.document();
        let arrays = whole["consolidated_metadata"]["metadata"].as_object().into_iter().flatten();
        let documents =
            arrays.map(|(name, document)| (Path::new(name).join("zarr.json"), pretty(document).into_bytes()));
        let axes = self.axes().map(|axis| (axis_file(axis), self.sealed(axis_bytes(axis))));
        for (file, bytes) in axes.into_iter().chain(documents) {
            if !self.holds(&file, &bytes) {
                self.output(&file, &bytes)?.commit()?;
            }
        }
        Ok(())
    }

    /// Whether a file of the store, and no link to one, has these bytes.
    fn holds(&self, file: &Path, bytes: &[u8]) -> bool {
        let path = self.folder.join(file);
        std::fs::symlink_metadata(&path).is_ok_and(|found| found.is_file())
            && file::bytes(&path, bytes.len()).is_ok_and(|there| there == bytes)
    }

    /// Returns the message about an axis with other values in an older store, which does not describe its axes in `zarr.json`.
    fn other_axis(&self) -> Option<String> {
        let is_other = |axis: &&Axis| !self.holds(&axis_file(axis), &axis_bytes(axis));
        let other = self.axes().into_iter().filter(|_| !self.layout.has_checksums).find(is_other);
        other.map(|axis| other_values(axis.parameter.name()))
    }

    fn axes(&self) -> [&'a Axis; 2] {
        [&self.chart.x, &self.chart.y]
    }

    fn another(&self, how: String) -> StoreError {
        StoreError::Another { folder: self.folder.display().to_string(), how }
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
        let blocks = Blocks { computed, ..counted(&blocks_of(self.folder)?) };
        Ok(Filled { chart: self.chart.clone(), points, blocks, times })
    }

    /// Computes one block, counted row by row from 0, if it is not done. Returns the number of points, and the times that they took.
    pub fn fill_block(&self, block: usize, threads: Option<usize>) -> Result<Option<(usize, [f64; 2])>, StoreError> {
        let (total, [across, _]) = (self.total(), self.blocks());
        if block >= total {
            return Err(StoreError::NoBlock { block, total });
        }
        if self.layout.is_done(self.folder, block, None) == Some(true) {
            return Ok(None);
        }
        let [wide, high] = self.layout.sides;
        let range = |index: usize, side: usize, axis: &Axis| index * side..axis.values.len().min((index + 1) * side);
        let (columns, rows) = (range(block % across, wide, &self.chart.x), range(block / across, high, &self.chart.y));
        let width = columns.len();
        let (found, times) = self.chart.part([columns, rows], threads, &Unwatched)?;
        let mut files = Vec::new();
        for variable in &VARIABLES {
            let value = |index: usize| {
                let (right, up) = (index % wide, index / wide);
                found.get(up * width + right).filter(|_| right < width).map_or(variable.fill().1, |it| variable.of(it))
            };
            let bytes = self.sealed(variable.bytes((0..wide * high).map(value)));
            files.push(self.output(&self.layout.file(variable.name, block), &bytes)?);
        }
        // Somebody may have removed the folder meanwhile, and begun another chart there.
        let there = described(self.folder)?.and_then(|text| serde_json::from_str::<Value>(&text).ok());
        if there != Some(self.document()) {
            return Err(self.another("its zarr.json was removed or replaced while this chart ran".into()));
        }
        Output::commit_all(files)?;
        Ok(Some((found.len(), times)))
    }

    fn total(&self) -> usize {
        self.blocks().iter().product()
    }

    /// Number of blocks across and up.
    pub fn blocks(&self) -> [usize; 2] {
        self.layout.blocks()
    }

    fn document(&self) -> Value {
        let chart = self.chart;
        let [x, y] = self.axes().map(|axis| (axis.parameter.name(), axis.values.len()));
        let [wide, high] = self.layout.sides;
        let mut arrays = serde_json::Map::new();
        for variable in &VARIABLES {
            let (fill, _) = variable.fill();
            let attributes = variable.attributes(&chart.model.units);
            let kind = variable.data_type();
            arrays
                .insert(variable.name.into(), array(&[y.1, x.1], &[high, wide], kind, &fill, &[y.0, x.0], &attributes));
        }
        for (name, count) in [x, y] {
            let units = if name == "rpm" { json!({ "units": "rpm" }) } else { json!({}) };
            arrays.insert(name.into(), array(&[count], &[count], "float64", &json!("NaN"), &[name], &units));
        }
        let mut attributes = attributes(chart);
        if self.layout.has_checksums {
            for codecs in arrays.values_mut().filter_map(|array| array["codecs"].as_array_mut()) {
                codecs.push(json!({ "name": "crc32c" }));
            }
        } else if let Some(attributes) = attributes.as_object_mut() {
            attributes.remove("axes");
        }
        json!({
            "zarr_format": 3,
            "node_type": "group",
            "attributes": attributes,
            "consolidated_metadata": { "kind": "inline", "must_understand": false, "metadata": arrays },
        })
    }

    fn sealed(&self, bytes: Vec<u8>) -> Vec<u8> {
        if self.layout.has_checksums { checksum::sealed(bytes) } else { bytes }
    }

    /// Begins a file of the store with these bytes. It will replace any link of its name; folders of the store are no links.
    fn output(&self, file: &Path, bytes: &[u8]) -> Result<Output<'static>, StoreError> {
        let mut folder = self.folder.to_owned();
        let make = |folder: &Path| {
            let refused = |error| StoreError::Folder { folder: folder.display().to_string(), error };
            std::fs::create_dir_all(folder).map_err(refused)
        };
        make(&folder)?;
        for part in file.parent().into_iter().flatten() {
            folder.push(part);
            if std::fs::symlink_metadata(&folder).is_ok_and(|found| found.is_symlink()) {
                let error = std::io::Error::other("a link has its name, and a store writes through none");
                return Err(StoreError::Folder { folder: folder.display().to_string(), error });
            }
            make(&folder)?;
        }
        let mut output = Output::in_place_of(&self.folder.join(file))?;
        output.write_all(bytes)?;
        Ok(output)
    }
}

fn pretty(document: &Value) -> String {
    format!("{document:#}")
}

/// File with the values of an axis, in the store.
fn axis_file(axis: &Axis) -> PathBuf {
    Path::new(axis.parameter.name()).join("c/0")
}

fn axis_bytes(axis: &Axis) -> Vec<u8> {
    axis.values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

fn other_values(axis: &str) -> String {
    format!("other values of {axis}")
}

/// Returns the attributes that describe a chart's origin, by the CF conventions and by names of its own.
pub fn attributes(chart: &Chart) -> Value {
    let axes = [&chart.x, &chart.y].map(described_axis);
    json!({
        "Conventions": "CF-1.10",
        "title": format!("{}: what a run comes to", chart.model.name),
        "model": chart.model.name,
        // Errors of its numbers move no point of a chart.
        "model_toml": chart.model.text_of_values(),
        "rpm": chart.speed(),
        "axes": axes,
        "start": start(&chart.start),
        "transient": chart.budget.transient,
        "record": chart.budget.record,
        "longest": chart.budget.longest,
        "patience": chart.budget.patience,
        "corner_impact_version": env!("CARGO_PKG_VERSION"),
    })
}

/// Describes the values of an axis well enough to distinguish them from others.
fn described_axis(axis: &Axis) -> Value {
    let [low, high] = axis.ends();
    json!({ "low": low, "high": high, "points": axis.values.len(), "crc32c": checksum::crc32c(&axis_bytes(axis)) })
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
fn difference(there: &Value, asked: &Value, chart: &Chart) -> Option<String> {
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
        true => "the description of its arrays differs".into(),
        false => "numbers of its model differ".into(),
    };
    let is_other = |index: &usize| there["attributes"]["axes"][*index] != asked["attributes"]["axes"][*index];
    let axis = |index: usize| other_values([&chart.x, &chart.y][index].parameter.name());
    let other = || [0, 1].iter().copied().find(is_other).map(axis);
    told.iter().find_map(differs).or_else(other).or_else(|| (there != asked).then(long))
}
