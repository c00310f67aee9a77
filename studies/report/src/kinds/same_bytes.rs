//! Compares a stream with a file without loading either into memory.

use std::io::{self, BufReader, ErrorKind, Read, Write};

/// A writer that accepts the bytes of a file and refuses others.
pub(super) struct SameBytes<R: Read> {
    stored: BufReader<R>,
    buffer: Vec<u8>,
}

impl<R: Read> SameBytes<R> {
    /// Compares with the bytes that `stored` returns from now on.
    pub fn new(stored: R) -> Self {
        SameBytes { stored: BufReader::with_capacity(1 << 16, stored), buffer: Vec::new() }
    }

    /// Returns true if the file has ended; false if it cannot be read.
    pub fn ended(mut self) -> bool {
        matches!(self.stored.read(&mut [0]), Ok(0))
    }
}

impl<R: Read> Write for SameBytes<R> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.buffer.resize(bytes.len(), 0);
        self.stored.read_exact(&mut self.buffer)?;
        if self.buffer == bytes { Ok(bytes.len()) } else { Err(ErrorKind::InvalidData.into()) }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_shorter_and_longer_files_are_told() {
        let same = |stored: &'static str, parts: &[&str]| {
            let mut same = SameBytes::new(stored.as_bytes());
            parts.iter().all(|part| same.write_all(part.as_bytes()).is_ok()) && same.ended()
        };
        assert!(same("abc", &["ab", "", "c"]) && same("", &[]));
        assert!(!same("abc", &["ab"]) && !same("abc", &["ab", "cd"]) && !same("abc", &["abd"]) && !same("", &["a"]));
    }
}
