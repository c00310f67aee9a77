//! Finished cases as lines of JSON in files: found by id, none of them held.

use crate::results::CaseResult;
use serde::Deserialize;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::Path;
use voussoir_core::limit::Status;

/// What tells one line from another.
#[derive(Debug, Deserialize)]
pub struct LineHead {
    /// Of the case.
    pub id: usize,
    /// Which resolved case it answers.
    pub case_hash: String,
    /// How the case ends.
    pub status: Status,
    /// Whether it is proven.
    pub certificate: Certified,
}

/// Of a certificate what exit codes ask for.
#[derive(Debug, Deserialize)]
pub struct Certified {
    /// Whether every residual is within its tolerance.
    pub passed: bool,
}

/// Where the line of a case stands.
#[derive(Debug, Clone, Copy)]
struct Place {
    id: usize,
    file: u32,
    length: u32,
    from: u64,
}

/// Lines of several files.
#[derive(Debug, Default)]
pub struct CaseLines {
    files: Vec<File>,
    places: Vec<Place>,
}

impl CaseLines {
    /// Adds the lines of a file, from a byte on, that are cases and that `take` wants. A line that was cut short is no
    /// case.
    pub fn add(&mut self, path: &Path, from: u64, take: &mut dyn FnMut(&LineHead) -> bool) -> io::Result<()> {
        let file = self.files.len() as u32;
        self.files.push(File::open(path)?);
        let mut reader = BufReader::with_capacity(1 << 16, File::open(path)?);
        reader.seek(SeekFrom::Start(from))?;
        let (mut from, mut line) = (from, Vec::new());
        loop {
            line.clear();
            let length = reader.read_until(b'\n', &mut line)?;
            if length == 0 {
                return Ok(());
            }
            if let Ok(head) = serde_json::from_slice::<LineHead>(&line)
                && take(&head)
            {
                self.places.push(Place { id: head.id, file, length: length as u32, from });
            }
            from += length as u64;
        }
    }

    /// Puts the lines in order of id; of several lines of a case the last counts. Ids that stood there more than once.
    pub fn sort(&mut self) -> Vec<usize> {
        self.places.sort_by_key(|place| place.id);
        self.places.reverse();
        let mut doubles = Vec::new();
        self.places.dedup_by(|earlier, kept| {
            let same = earlier.id == kept.id;
            doubles.extend(same.then_some(kept.id));
            same
        });
        self.places.reverse();
        doubles.reverse();
        doubles.dedup();
        doubles
    }

    /// Ids in order.
    pub fn ids(&self) -> impl Iterator<Item = usize> {
        self.places.iter().map(|place| place.id)
    }

    /// The text of a line, by its place in the order.
    pub fn line(&self, index: usize) -> io::Result<Vec<u8>> {
        let place = self.places.get(index).ok_or(io::ErrorKind::NotFound)?;
        let mut file = &self.files[place.file as usize];
        file.seek(SeekFrom::Start(place.from))?;
        let mut line = vec![0; place.length as usize];
        file.read_exact(&mut line)?;
        line.truncate(line.trim_ascii_end().len());
        Ok(line)
    }

    /// The case of a line.
    pub fn case(&self, index: usize) -> io::Result<CaseResult> {
        Ok(serde_json::from_slice(&self.line(index)?)?)
    }

    /// The cases in order, each read when it is asked for.
    pub fn cases(&self) -> impl Iterator<Item = io::Result<CaseResult>> {
        (0..self.places.len()).map(|index| self.case(index))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_whole_line_of_a_case_counts() {
        let folder = std::env::temp_dir().join(format!("voussoir-lines-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let path = folder.join("lines");
        let line = |id: usize, status: &str| {
            format!("{{\"id\":{id},\"case_hash\":\"x\",\"status\":\"{status}\",\"certificate\":{{\"passed\":true}}}}\n")
        };
        let text =
            [line(3, "stalled"), line(1, "collapse"), "\n".into(), line(3, "collapse"), line(2, "collapse")].concat();
        std::fs::write(&path, &text[..text.len() - 4]).expect("written");
        let mut lines = CaseLines::default();
        lines.add(&path, 0, &mut |_| true).expect("read");
        assert_eq!(lines.sort(), [3]);
        assert_eq!(lines.ids().collect::<Vec<_>>(), [1, 3]);
        assert_eq!(lines.line(1).expect("a line"), line(3, "collapse").trim_end().as_bytes());
        std::fs::remove_dir_all(&folder).expect("removed");
    }
}
