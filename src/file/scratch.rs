//! Private folder of files for another program to read.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::Path;

use tempfile::{Builder, TempDir};

use super::read;
use super::registry::{self, HeldPath};

/// Prefix of the folder's name, and the file in it that the program locks while it runs.
const NAME: &str = "corner-impact.";
const ALIVE: &str = ".alive";
const UNNAMED: &str = ".alive.new";
/// First line of that file. The second line is the name of the folder, so that a copy is not mistaken for the program's own folder.
const MARK: &str = "scripts of corner-impact, which it removes";

/// Folder that is removed when this value is dropped, or by a signal that ends the program. Otherwise the next program that makes such a
/// folder removes it.
pub(crate) struct Scratch {
    // Dropped before the registry entry of the folder.
    folder: TempDir,
    _listed: HeldPath,
    _alive: File,
}

impl Scratch {
    /// Creates a folder with these files, each given by its path in the folder and its text.
    pub(crate) fn of(files: &[(&str, &str)]) -> io::Result<Self> {
        sweep(files);
        // Signals are delayed until the last file is complete: a folder cannot be emptied while it is filled.
        let mut held = registry::held();
        let folder = Builder::new().prefix(NAME).tempdir()?;
        // Locked before it is renamed: otherwise another program could find it unlocked in between.
        let unnamed = folder.path().join(UNNAMED);
        let mut alive = File::create(&unnamed)?;
        alive.write_all(mark(folder.path()).as_bytes())?;
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

/// Contents of the locked file of a folder.
fn mark(folder: &Path) -> String {
    format!("{MARK}\n{}\n", folder.file_name().unwrap_or_default().display())
}

/// Removes folders that killed programs of this user left: these files, in folders that bear the mark of this program and are unlocked.
/// Leaves everything else unchanged, and never waits.
fn sweep(files: &[(&str, &str)]) {
    let Ok(entries) = fs::read_dir(std::env::temp_dir()) else { return };
    for folder in entries.flatten().filter(|entry| entry.file_name().to_string_lossy().starts_with(NAME)) {
        let folder = folder.path();
        let path = folder.join(ALIVE);
        if !is_own(&folder, fs::Metadata::is_dir) || !is_own(&path, fs::Metadata::is_file) {
            continue;
        }
        let mark = mark(&folder);
        let has_mark = read::bytes(&path, mark.len()).is_ok_and(|text| text == mark.as_bytes());
        let alive = read::regular(&path).ok().filter(|alive| has_mark && alive.try_lock().is_ok());
        if alive.is_some() {
            // Another program may remove it at the same time.
            let _ = emptied(&folder, files);
        }
    }
}

/// Whether a path itself, not the target of a link, is of a kind and belongs to this user.
fn is_own(path: &Path, kind: impl Fn(&fs::Metadata) -> bool) -> bool {
    fs::symlink_metadata(path).is_ok_and(|found| kind(&found) && is_of_this_user(&found))
}

#[cfg(unix)]
fn is_of_this_user(found: &fs::Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    found.uid() == rustix::process::geteuid().as_raw()
}

#[cfg(not(unix))]
fn is_of_this_user(_: &fs::Metadata) -> bool {
    true
}

/// Removes files of a folder, their subfolders, and the folder; stops at anything else.
fn emptied(folder: &Path, files: &[(&str, &str)]) -> io::Result<()> {
    let mut folders = BTreeSet::new();
    for (name, _) in files {
        let path = folder.join(name);
        let inside: Vec<&Path> = path.ancestors().skip(1).take_while(|inside| *inside != folder).collect();
        // Behind a link is another folder, whose empty subfolders must stay as well.
        if !inside.iter().all(|inside| is_own(inside, fs::Metadata::is_dir)) {
            continue;
        }
        if is_own(&path, fs::Metadata::is_file) {
            fs::remove_file(&path)?;
        }
        folders.extend(inside.into_iter().map(Path::to_owned));
    }
    // The innermost folder first. A folder that is not empty, or a link, stays.
    folders.iter().rev().try_for_each(|inside| match fs::remove_dir(inside) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        removed => removed,
    })?;
    // The mark is removed last, so that a later program examines a folder that stays.
    let only_mark = fs::read_dir(folder)?.flatten().all(|entry| entry.file_name() == ALIVE);
    if only_mark {
        fs::remove_file(folder.join(ALIVE))?;
        fs::remove_dir(folder)?;
    }
    Ok(())
}
