//! Opens files of a results folder only if they are regular files: reading a pipe or a device might never end.

use std::fs::File;
use std::io::{Error, ErrorKind, Result};
use std::path::Path;

/// Opens a regular file of at most `limit` bytes, or a symbolic link to one.
///
/// # Errors
///
/// The file cannot be opened, is not a regular file ([`ErrorKind::InvalidInput`]) or is longer
/// ([`ErrorKind::FileTooLarge`]).
pub fn open_regular(path: &Path, limit: u64) -> Result<File> {
    // Check before opening: opening a pipe that has no writer blocks.
    check(&std::fs::metadata(path)?, limit)?;
    let file = File::open(path)?;
    check(&file.metadata()?, limit)?;
    Ok(file)
}

fn check(found: &std::fs::Metadata, limit: u64) -> Result<()> {
    if !found.is_file() {
        return Err(Error::new(ErrorKind::InvalidInput, "it is not a regular file"));
    }
    if found.len() > limit {
        return Err(Error::new(ErrorKind::FileTooLarge, format!("it is longer than {} MiB", limit >> 20)));
    }
    Ok(())
}
