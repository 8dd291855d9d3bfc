//! Files that are read completely, up to a limit: model files, tables of lifts, fonts, and the files of a store.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Read};
use std::path::Path;

/// Largest file and longest line that are read, bytes: a thousand times the size of any handwritten file, and too small to fill the memory
/// of a machine.
const LONGEST: usize = 16 << 20;
const LONGEST_LINE: usize = 1 << 20;

/// Encodings of a text file that an older program may have written.
const ANY_CODE: &str = "UTF-8, UTF-16 with its mark or Latin-1";

/// Reads the text of a file; never reads more than the limit.
pub(crate) fn text(path: &Path) -> io::Result<String> {
    lines(String::from_utf8(bytes(path, LONGEST)?).map_err(|_| no_text("UTF-8"))?)
}

/// Reads a file that an older program may have written: UTF-16 with a byte order mark, and text that is not UTF-8 as Latin-1, in which a
/// degree sign is one byte.
pub(crate) fn text_of_any_age(path: &Path) -> io::Result<String> {
    let bytes = bytes(path, LONGEST)?;
    let text = match bytes[..] {
        [0xff, 0xfe, ..] => wide(&bytes[2..], u16::from_le_bytes)?,
        [0xfe, 0xff, ..] => wide(&bytes[2..], u16::from_be_bytes)?,
        _ => String::from_utf8(bytes).unwrap_or_else(|error| error.into_bytes().into_iter().map(char::from).collect()),
    };
    // Binary files contain zero bytes, and so does UTF-16 without its mark.
    if text.contains('\0') { Err(no_text(ANY_CODE)) } else { lines(text) }
}

/// Decodes text in UTF-16.
fn wide(bytes: &[u8], number: fn([u8; 2]) -> u16) -> io::Result<String> {
    let (pairs, rest) = bytes.as_chunks();
    let text = String::from_utf16(&pairs.iter().map(|pair| number(*pair)).collect::<Vec<u16>>());
    text.ok().filter(|_| rest.is_empty()).ok_or_else(|| no_text(ANY_CODE))
}

fn no_text(code: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, format!("it is not text in {code}"))
}

fn too_long(what: &str, most: usize) -> io::Error {
    let words = format!("{what} is longer than {} MiB, the largest allowed", most >> 20);
    io::Error::new(io::ErrorKind::FileTooLarge, words)
}

/// Opens a regular file for reading. Rejects devices, pipes, sockets and folders without opening them, and never waits for a pipe.
pub fn regular(path: &Path) -> io::Result<File> {
    is_regular(&fs::metadata(path)?)?;
    let mut options = OpenOptions::new();
    options.read(true);
    #[cfg(unix)]
    {
        use std::os::unix::fs::OpenOptionsExt;
        // A pipe may take the file's place between the two calls.
        options.custom_flags(rustix::fs::OFlags::NONBLOCK.bits() as i32);
    }
    let file = options.open(path)?;
    is_regular(&file.metadata()?)?;
    Ok(file)
}

fn is_regular(found: &fs::Metadata) -> io::Result<()> {
    match (found.is_file(), found.is_dir()) {
        (true, _) => Ok(()),
        (_, true) => Err(io::ErrorKind::IsADirectory.into()),
        _ => Err(io::Error::new(io::ErrorKind::InvalidInput, "it is a device, a pipe or a socket, not a file")),
    }
}

/// Reads a regular file completely, up to `most` bytes.
pub fn bytes(path: &Path, most: usize) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    regular(path)?.take(most as u64 + 1).read_to_end(&mut bytes)?;
    if bytes.len() > most { Err(too_long("it", most)) } else { Ok(bytes) }
}

fn lines(text: String) -> io::Result<String> {
    match text.split('\n').position(|line| line.len() > LONGEST_LINE) {
        Some(index) => Err(too_long(&format!("line {}", index + 1), LONGEST_LINE)),
        None => Ok(text),
    }
}
