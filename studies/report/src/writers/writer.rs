//! The interface of writers.

use crate::output::StudyOutput;
use serde_json::Value as Json;
use std::io::{self, Write};
use voussoir_core::plugin::{PluginKind, Registered, card};
use voussoir_study::config::default_table::default_table;
use voussoir_study::results::CaseResult;

/// A file with rows for every case. Cases are passed one after another in order of id and are not kept.
pub trait CaseTable {
    /// Its name, relative to the result folder.
    fn name(&self) -> String;

    /// Writes the beginning of the file.
    ///
    /// # Errors
    /// The errors of `out`.
    fn begin(&mut self, out: &mut dyn Write) -> io::Result<()>;

    /// Writes the rows of a case.
    ///
    /// # Errors
    /// The errors of `out`.
    fn add(&mut self, case: &CaseResult, out: &mut dyn Write) -> io::Result<()>;

    /// Writes the end of the file.
    ///
    /// # Errors
    /// The errors of `out`.
    fn end(&mut self, out: &mut dyn Write) -> io::Result<()> {
        let _ = out;
        Ok(())
    }
}

/// Converts results to the bytes of files. The parameters of its card are its options, in a table with the tag of the
/// writer under `[output.options]`. `options` has a value for every option, from the study or the default.
pub trait Writer: Send + Sync {
    /// Returns (file name relative to the result folder, bytes), in a fixed order. These files describe the cases that
    /// are shown to readers: all cases, unless there are very many.
    fn files(&self, study: &StudyOutput, options: &Json) -> Vec<(String, Vec<u8>)> {
        let _ = (study, options);
        Vec::new()
    }

    /// Returns true if `files` use forces and motions of all cases, also of cases that are not drawn. This counts if the study names the
    /// writer.
    fn uses_fields(&self) -> bool {
        false
    }

    /// Returns a table of all cases, if the writer has one.
    fn table<'a>(&self, study: &StudyOutput<'a>, options: &Json) -> Option<Box<dyn CaseTable + 'a>> {
        let _ = (study, options);
        None
    }
}

/// A writer with the tag of its card.
pub struct WriterEntry {
    /// The tag of its card.
    pub tag: &'static str,
    /// The writer.
    pub writer: &'static dyn Writer,
}

voussoir_core::inventory::collect!(WriterEntry);

voussoir_core::inventory::submit! {
    Registered { kind: PluginKind::Writer, names: |_| writers().into_iter().map(|entry| entry.tag).collect() }
}

/// Returns all writers, sorted by tag.
pub fn writers() -> Vec<&'static WriterEntry> {
    let mut all: Vec<_> = voussoir_core::inventory::iter::<WriterEntry>.into_iter().collect();
    all.sort_by_key(|entry| entry.tag);
    all
}

/// Returns true if one of these writers uses forces and motions of all cases.
pub fn use_fields(tags: &[String]) -> bool {
    writers().into_iter().any(|entry| entry.writer.uses_fields() && tags.iter().any(|tag| tag == entry.tag))
}

/// Returns the writers of the study's `[output]` with their options: all, or the listed ones.
fn chosen(study: &StudyOutput) -> impl Iterator<Item = (&'static dyn Writer, Json)> {
    let wanted = |tag: &str| study.output.writers.as_ref().is_none_or(|tags| tags.iter().any(|wanted| wanted == tag));
    let options = |tag: &str| match study.output.options.get(tag) {
        Some(options) => options.clone(),
        None => card(PluginKind::Writer, tag).map(default_table).unwrap_or_default(),
    };
    writers().into_iter().filter(move |entry| wanted(entry.tag)).map(move |entry| (entry.writer, options(entry.tag)))
}

/// Returns the files about the shown cases.
pub fn written(study: &StudyOutput) -> Vec<(String, Vec<u8>)> {
    chosen(study).flat_map(|(writer, options)| writer.files(study, &options)).collect()
}

/// Returns the tables of all cases.
pub fn tables<'a>(study: &StudyOutput<'a>) -> Vec<Box<dyn CaseTable + 'a>> {
    chosen(study).filter_map(|(writer, options)| writer.table(study, &options)).collect()
}
