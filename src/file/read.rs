//! Files that are read whole: model files, tables of lifts.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// The longest file that is read, and the longest line of one, bytes: a thousand times what a person writes, and nothing that fills
/// the memory of a machine.
const LONGEST: usize = 16 << 20;
const LONGEST_LINE: usize = 1 << 20;

/// The text of a file; no more than the limit is read, whatever it is.
pub(crate) fn text(path: &Path) -> io::Result<String> {
    let text = String::from_utf8(bytes(path)?);
    limited(text.map_err(|_| io::Error::new(io::ErrorKind::InvalidData, "it is no text in UTF-8"))?)
}

/// The same of a file that an older program may have written: what is no UTF-8 is Latin-1, in which a degree sign is one byte.
pub(crate) fn text_of_any_age(path: &Path) -> io::Result<String> {
    let text = String::from_utf8(bytes(path)?);
    limited(text.unwrap_or_else(|error| error.into_bytes().into_iter().map(char::from).collect()))
}

fn bytes(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?.take(LONGEST as u64 + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn limited(text: String) -> io::Result<String> {
    let refused = |words: String| Err(io::Error::new(io::ErrorKind::FileTooLarge, words));
    if text.len() > LONGEST {
        return refused(format!("it is longer than {} MiB, the most that is read", LONGEST >> 20));
    }
    match text.split('\n').position(|line| line.len() > LONGEST_LINE) {
        Some(index) => {
            refused(format!("line {} is longer than {} MiB, the most that is read", index + 1, LONGEST_LINE >> 20))
        }
        None => Ok(text),
    }
}
