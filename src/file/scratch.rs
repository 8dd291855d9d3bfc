//! A private folder of files for another program to read.

use std::fs::{self, File};
use std::io;
use std::path::Path;

use tempfile::{Builder, TempDir};

use super::registry::{self, HeldPath};

/// Prefix of the folder's name, and the file in it that the program keeps locked while it runs.
const NAME: &str = "corner-impact.";
const ALIVE: &str = ".alive";
const UNNAMED: &str = ".alive.new";

/// Folder that is removed with this value, or by a signal that ends the program. If neither happens, the next program that makes one
/// removes it.
pub(crate) struct Scratch {
    // Dropped before the signals forget the folder.
    folder: TempDir,
    _listed: HeldPath,
    _alive: File,
}

impl Scratch {
    /// Creates a folder with these files, each given by its path in the folder and its text.
    pub(crate) fn of(files: &[(&str, &str)]) -> io::Result<Self> {
        sweep();
        // Signals wait until the last file is complete: a folder cannot be emptied while it is filled.
        let mut held = registry::held();
        let folder = Builder::new().prefix(NAME).tempdir()?;
        // Locked before it is renamed: otherwise another program could find it unlocked in between.
        let unnamed = folder.path().join(UNNAMED);
        let alive = File::create(&unnamed)?;
        // Without locks the folder works too, but stays if the program is killed.
        if alive.try_lock().is_ok() {
            fs::rename(unnamed, folder.path().join(ALIVE))?;
        }
        for (name, text) in files {
            let path = folder.path().join(name);
            path.parent().map_or(Ok(()), fs::create_dir_all)?;
            fs::write(path, text)?;
        }
        held.insert(folder.path().to_owned());
        Ok(Self { _listed: HeldPath(folder.path().to_owned()), folder, _alive: alive })
    }

    pub(crate) fn path(&self) -> &Path {
        self.folder.path()
    }
}

/// Removes folders of killed programs: those whose lock is free.
fn sweep() {
    let Ok(entries) = fs::read_dir(std::env::temp_dir()) else { return };
    for folder in entries.flatten().filter(|entry| entry.file_name().to_string_lossy().starts_with(NAME)) {
        let alive = File::open(folder.path().join(ALIVE));
        if alive.is_ok_and(|alive| alive.try_lock().is_ok()) {
            // Another program may remove it at the same time.
            let _ = fs::remove_dir_all(folder.path());
        }
    }
}
