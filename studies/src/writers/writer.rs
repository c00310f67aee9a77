//! What a writer is.

use super::study_output::StudyOutput;
use crate::config::default_table::default_table;
use crate::results::CaseResult;
use serde_json::Value as Json;
use std::io::{self, Write};
use voussoir_core::plugin::{PluginKind, card};

/// A file with rows of every case, which come one after another in order of id and are not held.
pub trait CaseTable {
    /// Its name, relative to the result folder.
    fn name(&self) -> String;

    /// Writes its beginning.
    ///
    /// # Errors
    /// Those of `out`.
    fn begin(&mut self, out: &mut dyn Write) -> io::Result<()>;

    /// Writes the rows of a case.
    ///
    /// # Errors
    /// Those of `out`.
    fn add(&mut self, case: &CaseResult, out: &mut dyn Write) -> io::Result<()>;

    /// Writes its end.
    ///
    /// # Errors
    /// Those of `out`.
    fn end(&mut self, out: &mut dyn Write) -> io::Result<()> {
        let _ = out;
        Ok(())
    }
}

/// Turns results into the bytes of files. Its card's parameters are its options, under `[output.options]` in a
/// table that is called like the writer: `options` has every option, from the study or by default.
pub trait Writer: Send + Sync {
    /// (file name relative to the result folder, bytes), in a fixed order: files about the cases that are shown to readers,
    /// which are all of them unless there are very many.
    fn files(&self, study: &StudyOutput, options: &Json) -> Vec<(String, Vec<u8>)> {
        let _ = (study, options);
        Vec::new()
    }

    /// A table of all cases.
    fn table<'a>(&self, study: &StudyOutput<'a>, options: &Json) -> Option<Box<dyn CaseTable + 'a>> {
        let _ = (study, options);
        None
    }
}

/// A writer with the tag of its card.
pub struct WriterEntry {
    /// Tag of its card.
    pub tag: &'static str,
    /// The writer.
    pub writer: &'static dyn Writer,
}

voussoir_core::inventory::collect!(WriterEntry);

/// All writers, sorted by tag.
pub fn writers() -> Vec<&'static WriterEntry> {
    let mut all: Vec<_> = voussoir_core::inventory::iter::<WriterEntry>.into_iter().collect();
    all.sort_by_key(|entry| entry.tag);
    all
}

/// The writers of the study's `[output]` with their options: all, or the listed ones.
fn chosen(study: &StudyOutput) -> impl Iterator<Item = (&'static dyn Writer, Json)> {
    let wanted = |tag: &str| study.output.writers.as_ref().is_none_or(|tags| tags.iter().any(|wanted| wanted == tag));
    let options = |tag: &str| match study.output.options.get(tag) {
        Some(options) => options.clone(),
        None => card(PluginKind::Writer, tag).map(default_table).unwrap_or_default(),
    };
    writers().into_iter().filter(move |entry| wanted(entry.tag)).map(move |entry| (entry.writer, options(entry.tag)))
}

/// The files about shown cases.
pub fn written(study: &StudyOutput) -> Vec<(String, Vec<u8>)> {
    chosen(study).flat_map(|(writer, options)| writer.files(study, &options)).collect()
}

/// The tables of all cases.
pub fn tables<'a>(study: &StudyOutput<'a>) -> Vec<Box<dyn CaseTable + 'a>> {
    chosen(study).filter_map(|(writer, options)| writer.table(study, &options)).collect()
}
