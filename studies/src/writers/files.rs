//! The place where the files of results go: a folder, memory, or a comparison with files that are there.

use std::cell::RefCell;
use std::io::{self, Write};

/// A file that becomes whole when it is done, and otherwise leaves nothing.
pub trait OutputFile: Write {
    /// Gives the file its name.
    ///
    /// # Errors
    /// If it cannot be written to its end.
    fn done(self: Box<Self>) -> io::Result<()>;
}

/// The place where files go.
pub trait Files {
    /// Begins a file by its name relative to the folder; `None` if nothing is done with its content.
    ///
    /// # Errors
    /// If it cannot be written.
    fn begin(&self, name: &str) -> io::Result<Option<Box<dyn OutputFile + '_>>>;

    /// Writes a file whose content is held.
    ///
    /// # Errors
    /// If it cannot be written.
    fn write(&self, name: &str, bytes: &[u8]) -> io::Result<()> {
        let Some(mut file) = self.begin(name)? else { return Ok(()) };
        file.write_all(bytes)?;
        file.done()
    }
}

/// Files in memory.
#[derive(Debug, Default)]
pub struct HeldFiles(RefCell<Vec<(String, Vec<u8>)>>);

impl HeldFiles {
    /// Names and contents in the order in which they were done.
    pub fn into_files(self) -> Vec<(String, Vec<u8>)> {
        self.0.into_inner()
    }
}

/// A file in memory.
struct HeldFile<'a> {
    files: &'a HeldFiles,
    name: String,
    bytes: Vec<u8>,
}

impl Write for HeldFile<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.bytes.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl OutputFile for HeldFile<'_> {
    fn done(self: Box<Self>) -> io::Result<()> {
        self.files.0.borrow_mut().push((self.name, self.bytes));
        Ok(())
    }
}

impl Files for HeldFiles {
    fn begin(&self, name: &str) -> io::Result<Option<Box<dyn OutputFile + '_>>> {
        Ok(Some(Box::new(HeldFile { files: self, name: name.into(), bytes: Vec::new() })))
    }
}
