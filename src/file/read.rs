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
    let mut text = String::new();
    File::open(path)?.take(LONGEST as u64 + 1).read_to_string(&mut text)?;
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
