//! A file on its way, which nobody sees until it has its name.
//!
//! On Linux it has none: the system forgets it with the process, however that ends, `kill -9` and a power cut included. A nameless
//! file can only be given a name that is free, and then it is whole at once; where the name is taken, it gets a short hidden one first
//! and takes the other's place from there. Signals that can be held up are between the two; `kill -9` in that instant leaves the old file
//! as it was and the new one beside it, whole, as `.XXXXXX.tmp`. File systems that have no nameless files (NFS, FAT), and other systems, keep it as
//! `.XXXXXX.tmp` from the beginning; [`signals`](super::signals) remove that, `kill -9` leaves it.

#[cfg(target_os = "linux")]
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile};

use super::signals::{self, Listed};

/// A file without its name.
pub(super) enum Unfinished {
    /// Without any.
    #[cfg(target_os = "linux")]
    Nameless(File, PathBuf),
    /// Hidden under another.
    Hidden(NamedTempFile, Listed),
}

/// A hidden name that is as short as can be: any name that a file may have is longer.
fn hidden<'a>() -> Builder<'a, 'a> {
    let mut builder = Builder::new();
    builder.prefix(".").suffix(".tmp");
    builder
}

impl Unfinished {
    /// A new file that will be in `folder`.
    pub(super) fn begin(folder: &Path) -> io::Result<Self> {
        #[cfg(target_os = "linux")]
        if let Ok(file) = linux::nameless(folder) {
            return Ok(Self::Nameless(file, folder.to_owned()));
        }
        Self::hidden(folder)
    }

    fn hidden(folder: &Path) -> io::Result<Self> {
        let mut builder = hidden();
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // Those that any new file has, less what the umask takes away; a temporary file is its owner's alone otherwise.
            builder.permissions(std::fs::Permissions::from_mode(0o666));
        }
        let mut held = signals::held();
        let file = builder.tempfile_in(folder)?;
        held.insert(file.path().to_owned());
        let listed = Listed(file.path().to_owned());
        Ok(Self::Hidden(file, listed))
    }

    pub(super) fn file(&self) -> &std::fs::File {
        match self {
            #[cfg(target_os = "linux")]
            Self::Nameless(file, _) => file,
            Self::Hidden(file, _) => file.as_file(),
        }
    }

    /// Gives it its name, in the place of what may have it.
    pub(super) fn named(self, target: &Path) -> io::Result<()> {
        // No signal ends the program while this is held.
        let held = signals::held();
        match self {
            #[cfg(target_os = "linux")]
            Self::Nameless(file, folder) => match linux::link(&file, target) {
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                    let there = hidden().make_in(folder, |name| linux::link(&file, name))?;
                    there.persist(target).map(drop).map_err(|refused| refused.error)
                }
                linked => linked,
            },
            Self::Hidden(file, listed) => {
                let renamed = file.persist(target).map(drop).map_err(|refused| refused.error);
                drop(held);
                drop(listed);
                renamed
            }
        }
    }
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

    /// The files that this process has open, by which a nameless one is found.
    const OPEN: &str = "/proc/self/fd";

    /// A file without a name, on the disk that `folder` is on.
    pub(super) fn nameless(folder: &Path) -> io::Result<File> {
        let flags = OFlags::TMPFILE | OFlags::RDWR | OFlags::CLOEXEC;
        let file: OwnedFd = open(folder, flags, Mode::from_raw_mode(0o666))?;
        let file = File::from(file);
        // Without /proc it could never have a name.
        std::fs::symlink_metadata(entry(&file)).map(|_| file)
    }

    fn entry(file: &File) -> String {
        format!("{OPEN}/{}", file.as_raw_fd())
    }

    /// Names a nameless file, where the name is free.
    pub(super) fn link(file: &File, name: &Path) -> io::Result<()> {
        Ok(linkat(CWD, entry(file), CWD, name, AtFlags::SYMLINK_FOLLOW)?)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    /// What a file system without nameless files is left with: a hidden file, which is gone or has its name in the end.
    #[test]
    fn a_hidden_file_takes_its_name_or_goes() {
        let folder = tempfile::TempDir::new().unwrap();
        let names =
            || std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect::<Vec<_>>();
        let target = folder.path().join("n".repeat(255));
        for words in ["new", "in its place"] {
            let mut file = Unfinished::hidden(folder.path()).unwrap();
            file.write_all(words.as_bytes()).unwrap();
            let listed = signals::held().iter().any(|path| path.parent() == Some(folder.path()));
            assert!(listed, "a signal has to know it");
            file.named(&target).unwrap();
            assert_eq!((names().len(), std::fs::read_to_string(&target).unwrap().as_str()), (1, words));
        }
        drop(Unfinished::hidden(folder.path()).unwrap());
        assert_eq!(names().len(), 1);
        assert!(signals::held().iter().all(|path| path.parent() != Some(folder.path())));
    }
}
