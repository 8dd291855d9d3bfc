//! Files that appear complete or not at all, files that are read up to a limit, and temporary folders that do not stay behind.
//!
//! An [`Output`] is written like any other stream, in bounded memory. A file of that name appears, or changes, only with
//! [`Output::commit`]. Until then it is unfinished: it has no name at all where the system supports that, so that nothing stays behind
//! however the program ends. The name `-` is standard output, which has no such protection: the last line of incomplete output says that it
//! is incomplete.

mod read;
mod registry;
mod scratch;
mod unfinished;

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

pub use read::{bytes, regular};
pub(crate) use read::{text, text_of_any_age};
pub(crate) use registry::Started;
pub use registry::{clear, held};
pub(crate) use scratch::Scratch;
pub use unfinished::Unfinished;

/// Reason why a file was not written.
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

    /// Whether the error is a closed pipe on standard output.
    pub fn is_unread(&self) -> bool {
        self.standard && self.kind() == io::ErrorKind::BrokenPipe
    }

    /// Kind of the system's error.
    pub fn kind(&self) -> io::ErrorKind {
        self.why.kind()
    }
}

/// Destination for results: a file that appears when it is complete, or a stream.
pub struct Output<'a> {
    path: PathBuf,
    sink: Sink<'a>,
    /// Whether any output has been written.
    begun: bool,
}

enum Sink<'a> {
    Whole {
        unfinished: BufWriter<Unfinished>,
        target: PathBuf,
    },
    /// Device or pipe, which cannot be replaced.
    Device(BufWriter<File>),
    Standard(BufWriter<Box<dyn Write + 'a>>),
    /// Output that is already committed.
    Done(io::Sink),
}

/// Last line of incomplete output on standard output or a pipe.
const UNFINISHED: &str = "# unfinished: standard error says why";

impl std::fmt::Debug for Output<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Output({})", self.path.display())
    }
}

impl<'a> Output<'a> {
    /// Begins to write `path`; `-` means `standard`.
    pub fn create(path: &Path, standard: &'a mut dyn Write) -> Result<Self, FileError> {
        if path != Path::new("-") {
            return Self::file(path);
        }
        Ok(Self { path: path.to_owned(), sink: Sink::Standard(BufWriter::new(Box::new(standard))), begun: false })
    }

    /// Begins to write a file of that name, even if the name is `-`.
    pub fn file(path: &Path) -> Result<Output<'static>, FileError> {
        Ok(Output { path: path.to_owned(), sink: begin(path)?, begun: false })
    }

    /// Begins to write a file that replaces any file of its name, without following a link.
    pub(crate) fn in_place_of(path: &Path) -> Result<Output<'static>, FileError> {
        let unfinished = Unfinished::begin(folder(path)).map_err(FileError::new(path, "cannot be written"))?;
        let sink = Sink::Whole { unfinished: BufWriter::new(unfinished), target: path.to_owned() };
        Ok(Output { path: path.to_owned(), sink, begun: false })
    }

    /// Completes the output: every byte is on the disk and the file has its name; or there is an error and no file.
    pub fn commit(self) -> Result<(), FileError> {
        Self::commit_all(vec![self])
    }

    /// Completes several outputs: all files have their names; or there is an error and each name is unchanged. A signal that can be caught
    /// is delayed until then.
    pub fn commit_all(outputs: Vec<Self>) -> Result<(), FileError> {
        let mut files = Vec::new();
        for mut output in outputs {
            if let Some((unfinished, target)) = output.written()? {
                files.push((unfinished, target, FileError::new(&output.path, "cannot be replaced")));
            }
        }
        unfinished::named_all(files)
    }

    /// Completes the output if its name is free. Returns false if it is not.
    pub(crate) fn commit_new(mut self) -> Result<bool, FileError> {
        let Some((unfinished, target)) = self.written()? else { return Ok(true) };
        match unfinished.named_new(&target) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => Ok(false),
            named => named.map(|()| true).map_err(FileError::new(&self.path, "cannot be written")),
        }
    }

    /// Writes the data that is still in memory. Returns the file that needs its name, if the output is not a stream.
    fn written(&mut self) -> Result<Option<(Unfinished, PathBuf)>, FileError> {
        let write = FileError::new(&self.path, "cannot be written");
        match std::mem::replace(&mut self.sink, Sink::Done(io::sink())) {
            Sink::Standard(mut stream) => stream.flush().map(|()| None).map_err(write),
            Sink::Device(mut device) => device.flush().map(|()| None).map_err(write),
            Sink::Whole { unfinished, target } => {
                let unfinished = unfinished.into_inner().map_err(io::IntoInnerError::into_error).map_err(&write)?;
                // A full disk or a lost network folder may show only here.
                unfinished.file().sync_all().map_err(&write)?;
                Ok(Some((unfinished, target)))
            }
            Sink::Done(_) => Ok(None),
        }
    }

    fn stream(&mut self) -> &mut dyn Write {
        match &mut self.sink {
            Sink::Whole { unfinished, .. } => unfinished,
            Sink::Device(device) => device,
            Sink::Standard(stream) => stream,
            Sink::Done(nowhere) => nowhere,
        }
    }
}

impl Drop for Output<'_> {
    fn drop(&mut self) {
        if let (Sink::Device(_) | Sink::Standard(_), true) = (&self.sink, self.begun) {
            // If nobody reads the output any more, ignore the error.
            let _ = writeln!(self.stream(), "{UNFINISHED}");
        }
    }
}

impl Write for Output<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.begun = true;
        let written = self.stream().write(bytes);
        written.map_err(|why| io::Error::new(why.kind(), FileError::new(&self.path, "cannot be written")(why)))
    }

    fn flush(&mut self) -> io::Result<()> {
        let flushed = self.stream().flush();
        flushed.map_err(|why| io::Error::new(why.kind(), FileError::new(&self.path, "cannot be written")(why)))
    }
}

/// Rejects results, each with its description, whose names lead to the same file by any path: the last would overwrite the others.
pub fn distinct<'a>(results: impl IntoIterator<Item = (&'a str, &'a Path)>) -> Result<(), FileError> {
    let mut places = BTreeMap::new();
    results.into_iter().try_for_each(|(what, path)| match places.insert(place(path), what) {
        Some(before) => {
            let words = format!("{before} and {what} have the same path; give each its own");
            Err(FileError::new(path, "cannot be written")(io::Error::new(io::ErrorKind::InvalidInput, words)))
        }
        None => Ok(()),
    })
}

/// Resolves the existing part of a name to a path.
fn place(path: &Path) -> PathBuf {
    let whole = || fs::canonicalize(path).ok();
    let of_the_folder = || Some(fs::canonicalize(folder(path)).ok()?.join(path.file_name()?));
    whole().or_else(of_the_folder).unwrap_or_else(|| path.to_owned())
}

fn folder(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

fn begin<'a>(path: &Path) -> Result<Sink<'a>, FileError> {
    let refuse = FileError::new(path, "cannot be written");
    let because = |kind: io::ErrorKind, words: &str| refuse(io::Error::new(kind, words));
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
        // Replacing a file ignores its permissions, so check them.
        Ok(found) if !may_be_written(path, &found) => {
            return Err(because(io::ErrorKind::PermissionDenied, "it exists and is read-only"));
        }
        // Replace the target of a link, not the link.
        Ok(found) => (fs::canonicalize(path).map_err(&refuse)?, Some(found.permissions())),
        Err(error) if error.kind() == io::ErrorKind::NotFound => (path.to_owned(), None),
        Err(error) => return Err(refuse(error)),
    };
    if permissions.is_none() && fs::symlink_metadata(path).is_ok() {
        return Err(because(io::ErrorKind::NotFound, "it is a link to a file that does not exist"));
    }
    let folder = folder(&target);
    if !folder.is_dir() {
        return Err(because(io::ErrorKind::NotFound, &format!("there is no folder {}", folder.display())));
    }
    if target.file_name().is_none() {
        return Err(because(io::ErrorKind::InvalidInput, "the path has no file name"));
    }
    let unfinished = Unfinished::begin(folder).map_err(&refuse)?;
    if let Some(permissions) = permissions {
        unfinished.file().set_permissions(permissions).map_err(&refuse)?;
    }
    Ok(Sink::Whole { unfinished: BufWriter::new(unfinished), target })
}

#[cfg(unix)]
fn may_be_written(path: &Path, found: &fs::Metadata) -> bool {
    // The system lets an administrator write to any file, so check the permission bits too.
    !found.permissions().readonly() && rustix::fs::access(path, rustix::fs::Access::WRITE_OK).is_ok()
}

#[cfg(not(unix))]
fn may_be_written(_: &Path, found: &fs::Metadata) -> bool {
    !found.permissions().readonly()
}
