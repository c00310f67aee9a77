//! Compares the files of a results folder with the files made from the results.

use super::same_bytes::SameBytes;
use crate::writers::files::{Files, OutputFile};
use std::cell::RefCell;
use std::io::{self, Read, Write};
use voussoir_study::checks::Agreement;
use voussoir_study::kind::{RESULTS, StoredResults};

/// Returns findings about the files beside results.json: each existing file must be equal to the file made from results.json.
pub fn altered<'a>(
    stored: &StoredResults,
    made: impl Iterator<Item = (&'a str, &'a [u8])>,
    agreement: Agreement,
) -> Vec<String> {
    let files = Comparison::new(stored, agreement, None);
    for (name, bytes) in made {
        files.write(name, bytes).expect("a comparison has no errors");
    }
    files.altered()
}

/// Returns the message for a file that differs from the file made from results.json.
pub(super) fn not_made(name: &str) -> String {
    format!("{name} is not what {RESULTS} gives")
}

/// Compares the files in a folder with the files made from its results.
pub(super) struct Comparison<'a> {
    stored: &'a StoredResults<'a>,
    agreement: Agreement,
    /// A file that is checked separately.
    apart: Option<&'static str>,
    altered: RefCell<Vec<String>>,
}

impl<'a> Comparison<'a> {
    /// Starts a comparison without findings.
    pub fn new(stored: &'a StoredResults<'a>, agreement: Agreement, apart: Option<&'static str>) -> Self {
        Comparison { stored, agreement, apart, altered: RefCell::default() }
    }

    /// Returns the findings.
    pub fn altered(self) -> Vec<String> {
        self.altered.into_inner()
    }

    /// Returns true if a file of another processor differs by rounding only.
    fn same_claims(&self, name: &str, bytes: &[u8]) -> bool {
        // A file that is much longer than the expected one is different: it is not read to its end.
        let limit = 2 * bytes.len() as u64 + 1024;
        let read = |file: Box<dyn Read>| {
            let mut stored = Vec::new();
            file.take(limit).read_to_end(&mut stored).is_ok() && self.agreement.same_file(&stored, bytes)
        };
        (self.stored.file)(name).is_some_and(read)
    }
}

/// The expected content of a file and the stored file.
struct ComparedFile<'a> {
    files: &'a Comparison<'a>,
    name: String,
    against: Against,
}

enum Against {
    /// Byte by byte.
    Bits(SameBytes<Box<dyn Read>>),
    /// Numbers may differ by rounding: the whole file is in memory.
    Rounding(Vec<u8>),
    /// The file is known to differ.
    Differs,
}

impl Write for ComparedFile<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let differs = match &mut self.against {
            Against::Bits(same) => same.write_all(bytes).is_err(),
            Against::Differs => true,
            Against::Rounding(held) => {
                held.extend_from_slice(bytes);
                false
            }
        };
        if differs {
            self.against = Against::Differs;
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl OutputFile for ComparedFile<'_> {
    fn done(self: Box<Self>) -> io::Result<()> {
        let same = match self.against {
            Against::Bits(same) => same.ended(),
            Against::Rounding(held) => self.files.same_claims(&self.name, &held),
            Against::Differs => false,
        };
        self.files.altered.borrow_mut().extend((!same).then(|| not_made(&self.name)));
        Ok(())
    }
}

impl Files for Comparison<'_> {
    fn begin(&self, name: &str) -> io::Result<Option<Box<dyn OutputFile + '_>>> {
        // Tables of another program are not compared.
        if name == RESULTS || self.apart == Some(name) || self.agreement == Agreement::Program {
            return Ok(None);
        }
        let Some(file) = (self.stored.file)(name) else { return Ok(None) };
        let against = match self.agreement {
            Agreement::Processor => Against::Rounding(Vec::new()),
            _ => Against::Bits(SameBytes::new(file)),
        };
        Ok(Some(Box::new(ComparedFile { files: self, name: name.into(), against })))
    }
}
