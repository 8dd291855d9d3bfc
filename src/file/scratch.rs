//! A private folder of files for another program to read.

use std::fs;
use std::io;
use std::path::Path;

use tempfile::{Builder, TempDir};

use super::signals::{self, Listed};

/// It goes with this value, or with a signal that ends the program.
pub(crate) struct Scratch {
    // Goes before it is forgotten by the signals.
    folder: TempDir,
    _listed: Listed,
}

impl Scratch {
    /// A folder with these files, each by its path in it, and its text.
    pub(crate) fn of(files: &[(&str, &str)]) -> io::Result<Self> {
        // Signals wait until the last file is there: what is being filled cannot be emptied.
        let mut held = signals::held();
        let folder = Builder::new().prefix("corner-impact.").tempdir()?;
        for (name, text) in files {
            let path = folder.path().join(name);
            path.parent().map_or(Ok(()), fs::create_dir_all)?;
            fs::write(path, text)?;
        }
        held.insert(folder.path().to_owned());
        Ok(Self { _listed: Listed(folder.path().to_owned()), folder })
    }

    pub(crate) fn path(&self) -> &Path {
        self.folder.path()
    }
}
