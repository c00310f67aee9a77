//! Finished cases as lines of files. Lines are found by id; they are not held in memory.

use serde::Deserialize;
use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::Path;
use std::sync::OnceLock;
use voussoir_core::limit::Status;
use voussoir_study::regular_file::open_regular;
use voussoir_study::results::case_with_path::read_case;
use voussoir_study::results::sealed_line::case_in;
use voussoir_study::results::{CaseResult, FinishedCases, TakeCases};
use voussoir_study::side_by_side::{in_order, threads};

/// Greatest length of a line; a case of a million blocks has half a gigabyte.
const MAX_LINE_BYTES: u64 = 2 << 30;
/// Greatest length of a file with lines.
const MAX_FILE_BYTES: u64 = 1 << 40;

/// Number of cases that each thread reads at once.
const AT_ONCE: usize = 64;
/// Size of a batch of long cases in bytes.
const BYTES_AT_ONCE: usize = 4 << 20;

/// The keys of a line that are needed to sort it.
#[derive(Debug, Deserialize)]
pub struct LineHead {
    /// Id of the case.
    pub id: usize,
    /// Status of the case.
    pub status: Status,
    /// The certificate.
    pub certificate: Certified,
}

/// The part of a certificate that decides the exit code.
#[derive(Debug, Deserialize)]
pub struct Certified {
    /// True if every residual is within its tolerance.
    pub passed: bool,
}

/// The place of the text of a case.
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
    /// All cases after the first reading, if they fit in one batch.
    read: OnceLock<Vec<CaseResult>>,
}

impl CaseLines {
    /// Adds the lines of a file, from a byte on, that are cases and that `take` accepts. Returns the number of damaged
    /// lines: lines that were cut short, have a wrong checksum or do not contain a case. Blank lines and the first and
    /// last line of a part are not counted.
    pub fn add(&mut self, path: &Path, from: u64, take: &mut dyn FnMut(&LineHead) -> bool) -> io::Result<usize> {
        self.read.take();
        let file = self.files.len() as u32;
        self.files.push(open_regular(path, MAX_FILE_BYTES)?);
        let mut reader = BufReader::with_capacity(1 << 16, open_regular(path, MAX_FILE_BYTES)?);
        reader.seek(SeekFrom::Start(from))?;
        let (mut from, mut line, mut damaged) = (from, Vec::new(), 0);
        loop {
            line.clear();
            let length = reader.by_ref().take(MAX_LINE_BYTES).read_until(b'\n', &mut line)?;
            if length == 0 {
                return Ok(damaged);
            }
            if length as u64 == MAX_LINE_BYTES {
                return Err(io::Error::new(io::ErrorKind::FileTooLarge, "a line is longer than 2 GiB"));
            }
            let case = case_in(&line);
            let head = case.clone().and_then(|case| serde_json::from_slice::<LineHead>(&line[case]).ok());
            match (case, head) {
                (Some(case), Some(head)) if take(&head) => {
                    let (length, from) = (case.len() as u32, from + case.start as u64);
                    self.places.push(Place { id: head.id, file, length, from });
                }
                (Some(_), Some(_)) => {}
                _ => damaged += usize::from(!line.trim_ascii().is_empty() && !frames_a_part(&line)),
            }
            from += length as u64;
        }
    }

    /// Keeps the lines for which `keep` is true, by their position in the order.
    pub fn retain(&mut self, keep: &[bool]) {
        self.read.take();
        let mut keep = keep.iter();
        self.places.retain(|_| keep.next().copied().unwrap_or(false));
    }

    /// Sorts the lines by id. If a case has several lines, the last one is kept. Returns the ids that had more than one
    /// line.
    pub fn sort(&mut self) -> Vec<usize> {
        self.read.take();
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

    /// Returns the text of a case, by its position in the order.
    pub fn line(&self, index: usize) -> io::Result<Vec<u8>> {
        let place = self.places.get(index).ok_or(io::ErrorKind::NotFound)?;
        let mut file = &self.files[place.file as usize];
        file.seek(SeekFrom::Start(place.from))?;
        let mut line = vec![0; place.length as usize];
        file.read_exact(&mut line)?;
        Ok(line)
    }

    /// Returns all cases if they fit in one batch, which is read only once; otherwise `None`.
    fn one_batch(&self) -> io::Result<Option<&[CaseResult]>> {
        let bytes: usize = self.places.iter().map(|place| place.length as usize).sum();
        if bytes >= BYTES_AT_ONCE || self.places.len() > AT_ONCE {
            return Ok(None);
        }
        if self.read.get().is_none() {
            let mut all = Vec::with_capacity(self.places.len());
            self.hand_over(0..self.places.len(), &mut |cases| {
                all.extend_from_slice(cases);
                Ok(())
            })?;
            self.read.set(all).ok();
        }
        Ok(self.read.get().map(Vec::as_slice))
    }

    /// Passes the cases at these positions to `take`, in batches.
    fn hand_over(&self, places: impl Iterator<Item = usize>, take: TakeCases) -> io::Result<()> {
        let (mut texts, mut bytes) = (Vec::new(), 0);
        let mut read = |texts: &mut Vec<Vec<u8>>| {
            let cases = in_order(texts, |text| read_case(text)).into_iter().collect::<Result<Vec<_>, _>>()?;
            texts.clear();
            take(&cases)
        };
        for place in places {
            let text = self.line(place)?;
            bytes += text.len();
            texts.push(text);
            // Long cases: a batch has at most one case per thread.
            if texts.len() >= threads() && (bytes >= BYTES_AT_ONCE || texts.len() >= AT_ONCE * threads()) {
                read(&mut texts)?;
                bytes = 0;
            }
        }
        if texts.is_empty() { Ok(()) } else { read(&mut texts) }
    }
}

impl FinishedCases for CaseLines {
    fn each(&self, take: TakeCases) -> io::Result<()> {
        match self.one_batch()? {
            Some(all) => all.each(take),
            None => self.hand_over(0..self.places.len(), take),
        }
    }

    fn each_of(&self, ids: &BTreeSet<usize>, take: TakeCases) -> io::Result<()> {
        if let Some(all) = self.one_batch()? {
            return all.each_of(ids, take);
        }
        let place = |id: &usize| self.places.binary_search_by_key(id, |place| place.id).ok();
        self.hand_over(ids.iter().filter_map(place), take)
    }
}

/// Returns true for the first and the last line of a part.
fn frames_a_part(line: &[u8]) -> bool {
    line.starts_with(b"{\"study\":") || line.starts_with(b"{\"cases_in_part\":")
}

#[cfg(test)]
mod tests {
    use super::*;
    use voussoir_study::results::sealed_line::sealed_text;

    #[test]
    fn the_last_whole_line_of_a_case_counts() {
        let folder = std::env::temp_dir().join(format!("voussoir-lines-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let path = folder.join("lines");
        let line = |id: usize, status: &str| {
            format!("{{\"id\":{id},\"case_hash\":\"x\",\"status\":\"{status}\",\"certificate\":{{\"passed\":true}}}}")
        };
        let seal = |line: String| String::from_utf8(sealed_text(line.as_bytes())).expect("text");
        let text = [line(3, "stalled"), line(1, "collapse"), "".into(), line(3, "collapse"), line(2, "collapse")]
            .map(|line| if line.is_empty() { "\n".into() } else { seal(line) })
            .concat();
        std::fs::write(&path, &text[..text.len() - 4]).expect("written");
        let mut lines = CaseLines::default();
        assert_eq!(lines.add(&path, 0, &mut |_| true).expect("read"), 1);
        assert_eq!(lines.sort(), [3]);
        assert_eq!(lines.ids().collect::<Vec<_>>(), [1, 3]);
        assert_eq!(lines.line(1).expect("a line"), line(3, "collapse").as_bytes());
        std::fs::remove_dir_all(&folder).expect("removed");
    }
}
