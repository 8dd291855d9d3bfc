//! A private folder of files for another program to read.

use std::fs::{self, File};
use std::io;
use std::path::Path;

use tempfile::{Builder, TempDir};

use super::signals::{self, Listed};

/// What its name begins with, and the file that its program holds locked for as long as it lives.
const NAME: &str = "corner-impact.";
const ALIVE: &str = ".alive";
const UNNAMED: &str = ".alive.new";

/// It goes with this value, or with a signal that ends the program; where that could not be caught, with the next program that makes one.
pub(crate) struct Scratch {
    // Goes before it is forgotten by the signals.
    folder: TempDir,
    _listed: Listed,
    _alive: File,
}

impl Scratch {
    /// A folder with these files, each by its path in it, and its text.
    pub(crate) fn of(files: &[(&str, &str)]) -> io::Result<Self> {
        sweep();
        // Signals wait until the last file is there: what is being filled cannot be emptied.
        let mut held = signals::held();
        let folder = Builder::new().prefix(NAME).tempdir()?;
        // Locked before it has the name that is looked for: in between another program would find nobody there.
        let unnamed = folder.path().join(UNNAMED);
        let alive = File::create(&unnamed)?;
        // Without locks the folder is as good, and stays where it is killed.
        if alive.try_lock().is_ok() {
            fs::rename(unnamed, folder.path().join(ALIVE))?;
        }
        for (name, text) in files {
            let path = folder.path().join(name);
            path.parent().map_or(Ok(()), fs::create_dir_all)?;
            fs::write(path, text)?;
        }
        held.insert(folder.path().to_owned());
        Ok(Self { _listed: Listed(folder.path().to_owned()), folder, _alive: alive })
    }

    pub(crate) fn path(&self) -> &Path {
        self.folder.path()
    }
}

/// Removes what programs have left that were killed: nobody holds its lock.
fn sweep() {
    let Ok(entries) = fs::read_dir(std::env::temp_dir()) else { return };
    for folder in entries.flatten().filter(|entry| entry.file_name().to_string_lossy().starts_with(NAME)) {
        let alive = File::open(folder.path().join(ALIVE));
        if alive.is_ok_and(|alive| alive.try_lock().is_ok()) {
            // Another may do the same.
            let _ = fs::remove_dir_all(folder.path());
        }
    }
}
