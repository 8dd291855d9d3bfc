//! Files that are there whole or not at all.
//!
//! An [`Output`] is written to like any other stream, in bounded memory. A file of that name appears, or changes, only with
//! [`Output::commit`]: until then everything goes to a temporary file beside it, which is removed when the output is
//! dropped and, where [`clear_on_signals`] is asked for, when the program is stopped by Ctrl-C or SIGTERM. `-` is standard output,
//! which has no such luxury.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::NamedTempFile;

/// Why a file was not written.
#[derive(Debug, thiserror::Error)]
#[error("{path}: {action}: {why}")]
pub struct FileError {
    path: String,
    standard: bool,
    action: &'static str,
    why: io::Error,
}

impl FileError {
    fn new(path: &Path, action: &'static str) -> impl Fn(io::Error) -> Self + use<> {
        let standard = path == Path::new("-");
        let path = if standard { "standard output".to_owned() } else { path.display().to_string() };
        move |why| Self { path: path.clone(), standard, action, why }
    }

    /// Whether it is standard output, and whoever read that has had enough.
    pub(crate) fn is_unread(&self) -> bool {
        self.standard && self.kind() == io::ErrorKind::BrokenPipe
    }

    /// What the system said.
    pub fn kind(&self) -> io::ErrorKind {
        self.why.kind()
    }
}

/// Temporary files that a signal has to remove; held while one comes, goes or becomes a file.
static TEMPORARIES: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn temporaries() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    // A set of paths is whole whatever happened to the thread that held it.
    TEMPORARIES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A temporary file's entry among them.
struct Listed(PathBuf);

impl Drop for Listed {
    fn drop(&mut self) {
        temporaries().remove(&self.0);
    }
}

/// A place for results: a file that appears when it is complete, or a stream.
pub struct Output<'a> {
    path: PathBuf,
    sink: Sink<'a>,
}

enum Sink<'a> {
    Whole {
        temporary: BufWriter<NamedTempFile>,
        target: PathBuf,
        listed: Listed,
    },
    /// A device or pipe: there is nothing to replace.
    Device(BufWriter<File>),
    Standard(BufWriter<Box<dyn Write + 'a>>),
}

impl std::fmt::Debug for Output<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Output({})", self.path.display())
    }
}

impl<'a> Output<'a> {
    /// Begins to write `path`; `-` stands for `standard`.
    pub fn create(path: &Path, standard: &'a mut dyn Write) -> Result<Self, FileError> {
        if path != Path::new("-") {
            return Self::file(path);
        }
        Ok(Self { path: path.to_owned(), sink: Sink::Standard(BufWriter::new(Box::new(standard))) })
    }

    /// Begins to write a file of that name, whatever it is.
    pub(crate) fn file(path: &Path) -> Result<Output<'static>, FileError> {
        Ok(Output { path: path.to_owned(), sink: begin(path)? })
    }

    /// Completes it: every byte is on the disk, and the file has its name, or there is an error and no file.
    pub fn commit(mut self) -> Result<(), FileError> {
        let (path, write) = (self.path.clone(), FileError::new(&self.path, "cannot be written"));
        match &mut self.sink {
            Sink::Standard(stream) => stream.flush().map_err(write),
            Sink::Device(device) => device.flush().map_err(write),
            Sink::Whole { temporary, .. } => {
                temporary.flush().map_err(&write)?;
                // A full disk or a lost network folder may only be noticed here.
                temporary.get_ref().as_file().sync_all().map_err(&write)?;
                self.rename().map_err(FileError::new(&path, "cannot be replaced"))
            }
        }
    }

    fn rename(self) -> io::Result<()> {
        let Sink::Whole { temporary, target, listed } = self.sink else { return Ok(()) };
        let temporary = temporary.into_inner().map_err(io::IntoInnerError::into_error)?;
        let renamed = {
            let _held = temporaries();
            temporary.persist(target)
        };
        drop(listed);
        renamed.map(drop).map_err(|refused| refused.error)
    }

    fn stream(&mut self) -> &mut dyn Write {
        match &mut self.sink {
            Sink::Whole { temporary, .. } => temporary,
            Sink::Device(device) => device,
            Sink::Standard(stream) => stream,
        }
    }
}

impl Write for Output<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.stream().write(bytes);
        written.map_err(|why| io::Error::new(why.kind(), FileError::new(&self.path, "cannot be written")(why)))
    }

    fn flush(&mut self) -> io::Result<()> {
        let flushed = self.stream().flush();
        flushed.map_err(|why| io::Error::new(why.kind(), FileError::new(&self.path, "cannot be written")(why)))
    }
}

/// Has temporary files removed when Ctrl-C or SIGTERM ends the program: for programs that are this library's from then on.
pub fn clear_on_signals() -> io::Result<()> {
    signals::watch()
}

fn begin<'a>(path: &Path) -> Result<Sink<'a>, FileError> {
    let refuse = FileError::new(path, "cannot be written");
    let (target, permissions) = match fs::metadata(path) {
        Ok(found) if found.is_dir() => return Err(refuse(io::ErrorKind::IsADirectory.into())),
        // Renaming over /dev/null or a pipe would destroy it.
        Ok(found) if !found.is_file() => {
            return File::options()
                .write(true)
                .open(path)
                .map(|device| Sink::Device(BufWriter::new(device)))
                .map_err(refuse);
        }
        // What a link points to is replaced, not the link.
        Ok(found) => (fs::canonicalize(path).map_err(&refuse)?, Some(found.permissions())),
        Err(error) if error.kind() == io::ErrorKind::NotFound => (path.to_owned(), None),
        Err(error) => return Err(refuse(error)),
    };
    let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !folder.is_dir() {
        let missing = format!("there is no folder {}", folder.display());
        return Err(refuse(io::Error::new(io::ErrorKind::NotFound, missing)));
    }
    let Some(name) = target.file_name() else {
        return Err(refuse(io::Error::new(io::ErrorKind::InvalidInput, "it names no file")));
    };
    let mut prefix = OsString::from(".");
    prefix.push(name);
    prefix.push(".");
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix).suffix(".tmp");
    if let Some(permissions) = permissions.or_else(ordinary) {
        builder.permissions(permissions);
    }
    let mut held = temporaries();
    let temporary = builder.tempfile_in(folder).map_err(&refuse)?;
    let listed = temporary.path().to_owned();
    held.insert(listed.clone());
    drop(held);
    Ok(Sink::Whole { temporary: BufWriter::new(temporary), target, listed: Listed(listed) })
}

/// Those that any new file has, less what the umask takes away; a temporary file is its owner's alone otherwise.
#[cfg(unix)]
fn ordinary() -> Option<fs::Permissions> {
    use std::os::unix::fs::PermissionsExt;
    Some(fs::Permissions::from_mode(0o666))
}

#[cfg(not(unix))]
fn ordinary() -> Option<fs::Permissions> {
    None
}

/// Destructors do not run when a signal ends the program. A thread of its own waits for Ctrl-C and SIGTERM, removes what
/// is unfinished and lets the signal do what it would have done: no loop has to poll a flag, and the shell sees the signal.
#[cfg(unix)]
mod signals {
    use std::io;
    use std::sync::Once;

    use signal_hook::consts::{SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;

    pub(super) fn watch() -> io::Result<()> {
        static WATCHED: Once = Once::new();
        let mut result = Ok(());
        WATCHED.call_once(|| {
            result = Signals::new([SIGINT, SIGTERM]).and_then(|mut signals| {
                std::thread::Builder::new().name("signals".into()).spawn(move || {
                    for signal in signals.forever() {
                        // Held to the end: no other thread may begin or finish a file now.
                        let held = super::temporaries();
                        for path in held.iter() {
                            let _ = std::fs::remove_file(path);
                        }
                        let _ = emulate_default_handler(signal);
                    }
                })?;
                Ok(())
            });
        });
        result
    }
}

#[cfg(not(unix))]
mod signals {
    pub(super) fn watch() -> std::io::Result<()> {
        Ok(())
    }
}
