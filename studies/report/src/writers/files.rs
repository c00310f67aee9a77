//! Destinations of result files: a folder, memory, or a comparison with existing files.

use std::cell::RefCell;
use std::io::{self, Write};

/// A file that appears under its name only when it is complete.
pub trait OutputFile: Write {
    /// Completes the file and gives it its name.
    ///
    /// # Errors
    /// If the file cannot be written completely.
    fn done(self: Box<Self>) -> io::Result<()>;
}

/// A destination of files.
pub trait Files {
    /// Begins a file; the name is relative to the folder. Returns `None` if its content is not needed.
    ///
    /// # Errors
    /// If it cannot be written.
    fn begin(&self, name: &str) -> io::Result<Option<Box<dyn OutputFile + '_>>>;

    /// Writes a file whose content is in memory.
    ///
    /// # Errors
    /// If it cannot be written.
    fn write(&self, name: &str, bytes: &[u8]) -> io::Result<()> {
        let Some(mut file) = self.begin(name)? else { return Ok(()) };
        file.write_all(bytes)?;
        file.done()
    }
}

/// Stores files in memory.
#[derive(Debug, Default)]
pub struct HeldFiles(RefCell<Vec<(String, Vec<u8>)>>);

impl HeldFiles {
    /// Names and contents in the order in which the files were completed.
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
