//! Files that are invisible until they have their names.
//!
//! On Linux the file has no name: the system removes it with the process, however that ends, including by `kill -9` and a power cut. A
//! nameless file can only get a name that is free; then it is complete at once. If the name is taken, the file first gets a short hidden
//! name and then replaces the other file. Signals that can be caught wait during these two steps; `kill -9` in that instant leaves the old
//! file unchanged and the complete new one beside it, as `.XXXXXX.tmp`. File systems without nameless files (NFS, FAT), and other systems,
//! use `.XXXXXX.tmp` from the beginning; signals that can be caught remove that file, `kill -9` does not.

use std::fs;
#[cfg(target_os = "linux")]
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile, TempPath};

use super::registry::{self, HeldPath};

/// File that does not have its name yet.
pub enum Unfinished {
    /// File without a name, and its folder.
    #[cfg(target_os = "linux")]
    Nameless(File, PathBuf),
    /// File with a hidden name.
    Hidden(NamedTempFile, HeldPath),
}

/// Builder of hidden names, which are as short as possible: any valid file name is longer.
fn hidden<'a>() -> Builder<'a, 'a> {
    let mut builder = Builder::new();
    builder.prefix(".").suffix(".tmp");
    builder
}

impl Unfinished {
    /// Creates a file that will be in `folder`.
    pub(super) fn begin(folder: &Path) -> io::Result<Self> {
        #[cfg(target_os = "linux")]
        if let Ok(file) = linux::nameless(folder) {
            return Ok(Self::Nameless(file, folder.to_owned()));
        }
        Self::hidden(folder)
    }

    pub fn hidden(folder: &Path) -> io::Result<Self> {
        let builder = hidden();
        #[cfg(unix)]
        let builder = {
            use std::os::unix::fs::PermissionsExt;
            let mut builder = builder;
            // Permissions of any new file, reduced by the umask; a temporary file would otherwise be private to its owner.
            builder.permissions(std::fs::Permissions::from_mode(0o666));
            builder
        };
        let mut held = registry::held();
        let file = builder.tempfile_in(folder)?;
        held.insert(file.path().to_owned());
        let listed = HeldPath(file.path().to_owned());
        Ok(Self::Hidden(file, listed))
    }

    pub(super) fn file(&self) -> &std::fs::File {
        match self {
            #[cfg(target_os = "linux")]
            Self::Nameless(file, _) => file,
            Self::Hidden(file, _) => file.as_file(),
        }
    }

    /// Gives the file its name and replaces any file of that name.
    pub fn named(self, target: &Path) -> io::Result<()> {
        self.held(|file| file.put(target))
    }

    /// Gives the file its name, if the name is free.
    pub(super) fn named_new(self, target: &Path) -> io::Result<()> {
        self.held(|file| match file {
            #[cfg(target_os = "linux")]
            Self::Nameless(file, _) => (linux::link(&file, target), None),
            Self::Hidden(file, listed) => (file.persist_noclobber(target).map(drop).map_err(Into::into), Some(listed)),
        })
    }

    /// Names a file while signals are delayed.
    fn held(self, name: impl FnOnce(Self) -> (io::Result<()>, Option<HeldPath>)) -> io::Result<()> {
        let held = registry::held();
        let (named, listed) = name(self);
        drop(held);
        // Dropping the entry takes the same lock.
        drop(listed);
        named
    }

    /// Gives the file its name. The caller holds the registry's lock, and drops the entry afterwards.
    fn put(self, target: &Path) -> (io::Result<()>, Option<HeldPath>) {
        match self {
            #[cfg(target_os = "linux")]
            Self::Nameless(file, folder) => match linux::link(&file, target) {
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                    let there = hidden().make_in(folder, |name| linux::link(&file, name));
                    (there.and_then(|there| Ok(there.persist(target).map(drop)?)), None)
                }
                linked => (linked, None),
            },
            Self::Hidden(file, listed) => (file.persist(target).map(drop).map_err(Into::into), Some(listed)),
        }
    }
}

/// Gives files their names while signals are delayed. If one of them cannot get its name, each name is unchanged, and the error is that of
/// its file.
pub(super) fn named_all<E>(files: Vec<(Unfinished, PathBuf, impl Fn(io::Error) -> E)>) -> Result<(), E> {
    let mut listed = Vec::new();
    let held = registry::held();
    let is_alone = files.len() == 1;
    let mut before: Vec<(PathBuf, Option<TempPath>)> = Vec::new();
    let mut result = Ok(());
    for (file, target, error) in files {
        // Second name of the old file, from which it is restored.
        let kept = match fs::symlink_metadata(&target) {
            Ok(_) if !is_alone => {
                let link = hidden().make_in(super::folder(&target), |name| fs::hard_link(&target, name));
                link.map(|link| Some(link.into_temp_path()))
            }
            _ => Ok(None),
        };
        let named = kept.and_then(|kept| {
            let (named, entry) = file.put(&target);
            listed.push(entry);
            named.map(|()| before.push((target, kept)))
        });
        if let Err(why) = named {
            result = Err(error(why));
            break;
        }
    }
    if result.is_err() {
        for (target, kept) in before {
            // A file that cannot be restored needs no further action.
            let _ = match kept {
                Some(kept) => kept.persist(&target).map_err(Into::into),
                None => fs::remove_file(&target),
            };
        }
    }
    drop(held);
    drop(listed);
    result
}

impl Write for Unfinished {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file().flush()
    }
}

#[cfg(target_os = "linux")]
mod linux {
    use std::fs::File;
    use std::io;
    use std::os::fd::{AsRawFd, OwnedFd};
    use std::path::Path;

    use rustix::fs::{AtFlags, CWD, Mode, OFlags, linkat, open};

    /// Folder of this process's open files, where a nameless one is found.
    const OPEN: &str = "/proc/self/fd";

    /// Creates a file without a name, on the disk of `folder`.
    pub(super) fn nameless(folder: &Path) -> io::Result<File> {
        let flags = OFlags::TMPFILE | OFlags::RDWR | OFlags::CLOEXEC;
        let file: OwnedFd = open(folder, flags, Mode::from_raw_mode(0o666))?;
        let file = File::from(file);
        // Without /proc the file could never get a name.
        std::fs::symlink_metadata(entry(&file)).map(|_| file)
    }

    fn entry(file: &File) -> String {
        format!("{OPEN}/{}", file.as_raw_fd())
    }

    /// Gives a nameless file its name, if the name is free.
    pub(super) fn link(file: &File, name: &Path) -> io::Result<()> {
        Ok(linkat(CWD, entry(file), CWD, name, AtFlags::SYMLINK_FOLLOW)?)
    }
}
