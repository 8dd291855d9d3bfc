//! A chart as a zarr store of version 3: a folder that xarray and its like read, block by block, and that several
//! processes may fill at once.
//!
//! Each variable is an array of little-endian numbers without compression; a block of it is one file, which is there whole
//! or not at all. A block whose files are all there is done: to go on, to share the work and to put it together is the same.

use std::io::Write;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::CommandError;
use crate::cli::file::Output;
use crate::diagram::{Placed, Start};
use crate::flight::State;
use crate::orbit::ending::Kind;
use crate::progress::{Unwatched, Watch};
use crate::study::chart::{Axis, Blocks, Chart, Filled, Point, class};

/// A store of a chart, in a folder.
pub(super) struct Store<'a> {
    folder: &'a Path,
    chart: &'a Chart,
}

/// The part of the blocks that a process sees to: those whose number, counted from 1, leaves `index` if divided by `of`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shard {
    index: usize,
    of: usize,
}

impl Shard {
    pub(super) const ALL: Self = Self { index: 1, of: 1 };
}

/// `I/N`.
pub(super) fn shard(text: &str) -> Result<Shard, String> {
    let number = |text: &str| text.trim().parse::<usize>().ok();
    let parts = text.split_once('/').and_then(|(index, of)| Some((number(index)?, number(of)?)));
    match parts {
        Some((index, of)) if (1..=of).contains(&index) => Ok(Shard { index, of }),
        _ => Err("must be I/N: the part I, from 1 to N, of N".into()),
    }
}

/// Values along each side of a block.
const SIDE: usize = 100;

/// An array of the store: its name, its type, its unit, what it is, and its value at a point.
struct Variable {
    name: &'static str,
    whole: Option<usize>,
    units: &'static str,
    long_name: &'static str,
    value: fn(&Point) -> f64,
}

/// Those of each point, where it is none not a number, or -1; the class comes last, as a block without it is not done.
const VARIABLES: [Variable; 7] = [
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
        name: "class",
        whole: Some(1),
        units: "1",
        long_name: "kind of motion",
        value: |it| code(Some(it.kind)),
    },
];

/// Classes in the order of their codes; none is for points that failed.
const CLASSES: [Option<Kind>; 6] =
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

    /// What stands where nothing was computed: no point has it.
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

    fn attributes(&self) -> Value {
        let mut attributes = json!({ "units": self.units, "long_name": self.long_name });
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
    /// The store of `chart` in a folder, begun where there is none; another chart's is refused.
    pub(super) fn open(folder: &'a Path, chart: &'a Chart) -> Result<Self, CommandError> {
        let store = Self { folder, chart };
        let (group, whole) = (folder.join("zarr.json"), store.document());
        match std::fs::read_to_string(&group) {
            Ok(text) => match serde_json::from_str::<Value>(&text) {
                Ok(there) if there == whole => Ok(store),
                _ => Err(CommandError::Words(format!(
                    "{}: holds another chart: other axes, another model or version, or other lengths",
                    folder.display()
                ))),
            },
            Err(_) => {
                for axis in [&chart.x, &chart.y] {
                    let values = (0..axis.values.count).flat_map(|index| axis.values.value(index).to_le_bytes());
                    store.write(&Path::new(axis.parameter.name()).join("c/0"), &values.collect::<Vec<_>>())?;
                }
                let arrays = whole["consolidated_metadata"]["metadata"].as_object();
                for (name, document) in arrays.into_iter().flatten() {
                    store.write_document(&Path::new(name).join("zarr.json"), document)?;
                }
                // The last: who finds it finds the others.
                store.write_document(Path::new("zarr.json"), &whole)?;
                Ok(store)
            }
        }
    }

    /// Computes those blocks of a part that are not done, on `threads` threads.
    pub(super) fn fill(&self, part: Shard, threads: Option<usize>, watch: &dyn Watch) -> Result<Filled, CommandError> {
        let (all, mut times) = (self.blocks(), [0.0; 2]);
        let (mut computed, mut points) = (0, 0);
        let mine = (0..all[0] * all[1]).filter(|block| block % part.of == part.index - 1);
        for block in mine {
            let [column, row] = [block % all[0], block / all[0]];
            if self.is_done([column, row]) {
                continue;
            }
            let range = |index: usize, axis: &Axis| index * SIDE..axis.values.count.min((index + 1) * SIDE);
            let (columns, rows) = (range(column, &self.chart.x), range(row, &self.chart.y));
            watch.at("blocks", block as u64, (all[0] * all[1]) as u64);
            let width = columns.len();
            let (found, [cpu_s, wall_s]) = self.chart.part(columns, rows, threads, &Unwatched)?;
            times = [times[0] + cpu_s, times[1] + wall_s];
            for variable in &VARIABLES {
                let (_, fill) = variable.fill();
                let value = |index: usize| {
                    let (right, up) = (index % SIDE, index / SIDE);
                    match found.get(up * width + right).filter(|_| right < width) {
                        None => fill,
                        Some(Ok(point)) => (variable.value)(point),
                        Some(Err(_)) if variable.name == "class" => code(None),
                        Some(Err(_)) => fill,
                    }
                };
                let file = Path::new(variable.name).join(format!("c/{row}/{column}"));
                self.write(&file, &variable.bytes((0..SIDE * SIDE).map(value)))?;
            }
            (computed, points) = (computed + 1, points + found.len());
        }
        let blocks = Blocks { computed, ..status(self.folder)? };
        Ok(Filled { chart: self.chart.clone(), points, blocks, times })
    }

    /// Blocks across and up.
    fn blocks(&self) -> [usize; 2] {
        [&self.chart.x, &self.chart.y].map(|axis| axis.values.count.div_ceil(SIDE))
    }

    fn is_done(&self, block: [usize; 2]) -> bool {
        is_done(self.folder, block)
    }

    fn document(&self) -> Value {
        let chart = self.chart;
        let [x, y] = [&chart.x, &chart.y].map(|axis| (axis.parameter.name(), axis.values.count));
        let mut arrays = serde_json::Map::new();
        for variable in &VARIABLES {
            let (fill, _) = variable.fill();
            let shape = [y.1, x.1];
            let document =
                array(&shape, &[SIDE, SIDE], variable.data_type(), &fill, &[y.0, x.0], &variable.attributes());
            arrays.insert(variable.name.into(), document);
        }
        for (name, count) in [x, y] {
            let units = if name == "rpm" { json!({ "units": "rpm" }) } else { json!({}) };
            arrays.insert(name.into(), array(&[count], &[count], "float64", &json!("NaN"), &[name], &units));
        }
        json!({
            "zarr_format": 3,
            "node_type": "group",
            "attributes": {
                "Conventions": "CF-1.10",
                "title": format!("{}: what a run comes to", chart.model.name),
                "model": chart.model.name,
                "follower": chart.model.follower,
                "cam": chart.model.cam,
                "rpm": chart.speed(),
                "start": start(&chart.start),
                "transient": chart.lengths.transient,
                "record": chart.lengths.record,
                "corner_impact_version": env!("CARGO_PKG_VERSION"),
            },
            "consolidated_metadata": { "kind": "inline", "must_understand": false, "metadata": arrays },
        })
    }

    fn write_document(&self, file: &Path, document: &Value) -> Result<(), CommandError> {
        self.write(file, serde_json::to_string_pretty(document)?.as_bytes())
    }

    fn write(&self, file: &Path, bytes: &[u8]) -> Result<(), CommandError> {
        let path: PathBuf = self.folder.join(file);
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)
                .map_err(|error| CommandError::Words(format!("{}: cannot be made: {error}", folder.display())))?;
        }
        let mut output = Output::file(&path)?;
        output.write_all(bytes)?;
        super::commit(vec![output])
    }
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

/// Whether every file of a block is there, with its length.
fn is_done(folder: &Path, [column, row]: [usize; 2]) -> bool {
    VARIABLES.iter().all(|variable| {
        let file = folder.join(variable.name).join(format!("c/{row}/{column}"));
        let length = SIDE * SIDE * variable.whole.unwrap_or(8);
        std::fs::metadata(file).is_ok_and(|file| file.len() == length as u64)
    })
}

/// How much of the store in a folder is done.
pub(super) fn status(folder: &Path) -> Result<Blocks, CommandError> {
    let none = |why: String| CommandError::Words(format!("{}: no store of a chart: {why}", folder.display()));
    let text = std::fs::read_to_string(folder.join("zarr.json")).map_err(|error| none(error.to_string()))?;
    let group: Value = serde_json::from_str(&text).map_err(|error| none(error.to_string()))?;
    let shape = &group["consolidated_metadata"]["metadata"]["class"]["shape"];
    let side = |axis: usize| shape[axis].as_u64().filter(|count| *count > 0).map(|count| count.div_ceil(SIDE as u64));
    let (rows, columns) = side(0).zip(side(1)).ok_or_else(|| none("it has no classes".into()))?;
    let all = (0..rows as usize).flat_map(|row| (0..columns as usize).map(move |column| [column, row]));
    let done = all.filter(|block| is_done(folder, *block)).count();
    Ok(Blocks { computed: 0, done, total: (rows * columns) as usize })
}
