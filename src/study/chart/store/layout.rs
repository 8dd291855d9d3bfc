//! Layout of a store, as its `zarr.json` describes it, and which of its blocks are done.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde_json::Value;

use super::checksum;
use super::variables::VARIABLES;
use crate::file::{self, FileError};
use crate::study::chart::Blocks;
use crate::study::survey::SweepError;

/// Reason why there is no store, or not one of its blocks.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "the message says what each is")]
pub enum StoreError {
    /// The store belongs to another chart.
    #[error("{folder}: holds another chart: {how}")]
    Another { folder: String, how: String },
    /// The folder holds no store.
    #[error("{folder}: holds no store of a chart: {why}")]
    None { folder: String, why: String },
    /// The sides of a block are not allowed.
    #[error("blocks of {columns} x {rows} points: they must have 1 or more on each side, and {most} or fewer in all")]
    Sides { columns: usize, rows: usize, most: usize },
    /// The chart has too many blocks.
    #[error("{blocks} blocks: a store can have {most} or fewer; use larger blocks or fewer points")]
    TooMany { blocks: usize, most: usize },
    /// The store has more blocks than can be checked in time.
    #[error(
        "{folder}: too large to be looked through within a second: {done} of its first {looked} blocks are done, and it has {total}"
    )]
    Slow { folder: String, done: usize, looked: usize, total: usize },
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

/// Largest number of points in a block.
const MOST_POINTS: usize = 1 << 24;
/// Largest number of blocks of a store: with the default sides, 10^10 points.
const MOST_BLOCKS: usize = 1 << 20;
/// Time after which no further block of a store is checked.
const PATIENCE: Duration = Duration::from_millis(500);

/// Numbers of points and blocks, each across and up.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout {
    /// Numbers of points of the chart.
    pub(super) points: [usize; 2],
    /// Numbers of points of a block.
    pub(super) sides: [usize; 2],
    /// Whether blocks end in a checksum; those of older stores do not.
    pub(super) has_checksums: bool,
}

impl Layout {
    /// Checks the numbers of a chart and its blocks.
    pub(super) fn checked(self) -> Result<Self, StoreError> {
        let [columns, rows] = self.sides;
        if !(1..=MOST_POINTS).contains(&columns.saturating_mul(rows)) {
            return Err(StoreError::Sides { columns, rows, most: MOST_POINTS });
        }
        let [across, up] = self.blocks();
        let blocks = across.saturating_mul(up);
        if blocks > MOST_BLOCKS { Err(StoreError::TooMany { blocks, most: MOST_BLOCKS }) } else { Ok(self) }
    }

    /// Reads the layout of the store in a folder.
    fn read(folder: &Path) -> Result<Self, StoreError> {
        let text = described(folder)?.ok_or_else(|| none(folder, ErrorKind::NotFound.to_string()))?;
        let group: Value = serde_json::from_str(&text).map_err(|error| none(folder, error.to_string()))?;
        let classes = &group["consolidated_metadata"]["metadata"]["class"];
        let numbers = |sides: &Value| {
            let side = |axis: usize| sides[axis].as_u64().filter(|count| *count > 0).map(|count| count as usize);
            Some([side(1)?, side(0)?])
        };
        let both = numbers(&classes["shape"]).zip(numbers(&classes["chunk_grid"]["configuration"]["chunk_shape"]));
        let (points, sides) = both.ok_or_else(|| none(folder, "it has no classes".into()))?;
        Self { points, sides, has_checksums: has_checksums(&group) }
            .checked()
            .map_err(|error| none(folder, error.to_string()))
    }

    /// Numbers of blocks.
    pub(super) fn blocks(&self) -> [usize; 2] {
        [0, 1].map(|axis| self.points[axis].div_ceil(self.sides[axis]))
    }

    /// Whether every file of a block, counted row by row from 0, is there and undamaged; `None` if the time runs out before.
    pub(super) fn is_done(&self, folder: &Path, block: usize, until: Option<Instant>) -> Option<bool> {
        for variable in &VARIABLES {
            if until.is_some_and(|until| Instant::now() > until) {
                return None;
            }
            let length = self.sides[0] * self.sides[1] * variable.size() + self.seal();
            let path = folder.join(self.file(variable.name, block));
            // A link is no block: its target may be anywhere.
            let is_there =
                std::fs::symlink_metadata(&path).is_ok_and(|found| found.is_file() && found.len() == length as u64);
            if !is_there
                || self.has_checksums && !file::bytes(&path, length).is_ok_and(|bytes| checksum::is_sealed(&bytes))
            {
                return Some(false);
            }
        }
        Some(true)
    }

    /// Number of bytes of a block's checksum.
    fn seal(&self) -> usize {
        if self.has_checksums { checksum::LENGTH } else { 0 }
    }

    /// File of a block of an array.
    pub(super) fn file(&self, array: &str, block: usize) -> PathBuf {
        let across = self.blocks()[0];
        Path::new(array).join(format!("c/{}/{}", block / across, block % across))
    }
}

/// Whether the blocks of a store end in checksums. Stores without them do not describe their axes either.
pub(super) fn has_checksums(group: &Value) -> bool {
    group["attributes"]["axes"].is_array()
}

/// Returns the text of the `zarr.json` of a folder, if there is one.
pub(super) fn described(folder: &Path) -> Result<Option<String>, StoreError> {
    match file::text(&folder.join("zarr.json")) {
        // If a file is in the way, making the folder reports it.
        Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => Ok(None),
        read => read.map(Some).map_err(|error| none(folder, error.to_string())),
    }
}

pub(super) fn none(folder: &Path, why: String) -> StoreError {
    StoreError::None { folder: folder.display().to_string(), why }
}

/// Counts the blocks of the store in a folder, and those that are done, within a second.
pub fn status(folder: &Path) -> Result<Blocks, StoreError> {
    status_within(folder, PATIENCE)
}

/// Counts the blocks of the store in a folder, and those that are done; fails if that takes longer than some time.
pub fn status_within(folder: &Path, time: Duration) -> Result<Blocks, StoreError> {
    Ok(counted(&looked_through(folder, Some(time))?))
}

/// Whether each block of the store in a folder is done, row by row.
pub fn blocks_of(folder: &Path) -> Result<Vec<bool>, StoreError> {
    looked_through(folder, None)
}

/// Counts blocks, and those that are done.
pub(super) fn counted(blocks: &[bool]) -> Blocks {
    Blocks { computed: 0, done: blocks.iter().filter(|done| **done).count(), total: blocks.len() }
}

fn looked_through(folder: &Path, time: Option<Duration>) -> Result<Vec<bool>, StoreError> {
    let until = time.map(|time| Instant::now() + time);
    let layout = Layout::read(folder)?;
    let total = layout.blocks().iter().product();
    let mut blocks = Vec::new();
    for block in 0..total {
        match layout.is_done(folder, block, until) {
            Some(is_done) => blocks.push(is_done),
            None => {
                let Blocks { done, total: looked, .. } = counted(&blocks);
                return Err(StoreError::Slow { folder: folder.display().to_string(), done, looked, total });
            }
        }
    }
    Ok(blocks)
}
