//! The journal of finished cases, with which `--resume` goes on.

use std::fs::File;
use std::io::{Result, Write};
use std::time::{Duration, Instant};

/// For how long lines wait after others were written: a killed run loses no more of its work, and cases that take no time
/// to solve are not held up by writing each for itself.
const WAITING: Duration = Duration::from_millis(50);
/// Bytes of lines that do not wait.
const MUCH: usize = 1 << 16;

/// Finished cases, a line each.
#[derive(Debug)]
pub struct Journal<W = File> {
    file: W,
    waiting: Vec<u8>,
    written: Option<Instant>,
}

impl<W: Write> Journal<W> {
    /// Adds lines at the end of a file.
    pub fn new(file: W) -> Self {
        Journal { file, waiting: Vec::new(), written: None }
    }

    /// Adds lines, at once unless they are few and others were written shortly before.
    ///
    /// # Errors
    ///
    /// Where they cannot be written.
    pub fn add(&mut self, lines: &[u8]) -> Result<()> {
        if lines.len() >= MUCH {
            // Without a copy: a case of a million blocks has half a gigabyte.
            self.write()?;
            return self.file.write_all(lines);
        }
        self.waiting.extend_from_slice(lines);
        self.write_late()
    }

    /// Writes what has waited for long enough.
    ///
    /// # Errors
    ///
    /// Where it cannot be written.
    pub fn write_late(&mut self) -> Result<()> {
        let recent = |written: Instant| written.elapsed() < WAITING;
        if self.waiting.is_empty() || self.waiting.len() < MUCH && self.written.is_some_and(recent) {
            return Ok(());
        }
        self.write()
    }

    /// Writes all that waits.
    ///
    /// # Errors
    ///
    /// Where it cannot be written.
    pub fn write(&mut self) -> Result<()> {
        let written = self.file.write_all(&self.waiting);
        self.waiting.clear();
        self.written = Some(Instant::now());
        written
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_after_others_waits_and_no_longer_than_it_may() {
        let mut journal = Journal::new(Vec::new());
        let later = || Some(Instant::now() + Duration::from_secs(60));
        journal.add(b"a\n").expect("written");
        assert_eq!(journal.file, b"a\n");
        journal.written = later();
        journal.add(b"b\n").expect("kept");
        assert_eq!(journal.file, b"a\n");
        journal.written = Instant::now().checked_sub(WAITING);
        journal.write_late().expect("written");
        assert_eq!(journal.file, b"a\nb\n");
        journal.written = later();
        journal.add(b"c\n").expect("kept");
        journal.write().expect("written");
        assert_eq!(journal.file, b"a\nb\nc\n");
        journal.written = later();
        journal.add(&[b'd'; MUCH]).expect("written");
        assert_eq!(journal.file.len(), 6 + MUCH);
    }
}
