//! The journal of finished cases. `--resume` continues from it.

use std::fs::File;
use std::io::{Result, Write};
use std::time::{Duration, Instant};

/// Longest time between a line and its writing. A killed run loses at most this much work, and fast cases are not
/// slowed down by one write each.
const WAITING: Duration = Duration::from_millis(50);
/// Number of buffered bytes above which lines are written immediately.
const MUCH: usize = 1 << 16;

/// Finished cases, one line each.
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

    /// Adds lines. They are written immediately, except if they are few and the last write was a short time ago.
    ///
    /// # Errors
    ///
    /// If they cannot be written.
    pub fn add(&mut self, lines: &[u8]) -> Result<()> {
        if lines.len() >= MUCH {
            // The lines are not copied: a case of a million blocks has half a gigabyte.
            self.write()?;
            return self.file.write_all(lines);
        }
        self.waiting.extend_from_slice(lines);
        self.write_late()
    }

    /// Writes the buffered lines if the last write is long enough ago.
    ///
    /// # Errors
    ///
    /// If they cannot be written.
    pub fn write_late(&mut self) -> Result<()> {
        let recent = |written: Instant| written.elapsed() < WAITING;
        if self.waiting.is_empty() || self.waiting.len() < MUCH && self.written.is_some_and(recent) {
            return Ok(());
        }
        self.write()
    }

    /// Writes all buffered lines.
    ///
    /// # Errors
    ///
    /// If they cannot be written.
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
