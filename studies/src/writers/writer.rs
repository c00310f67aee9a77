//! What a writer is.

use super::path_proofs::path_proofs;
use super::study_output::StudyOutput;
use crate::config::default_table::default_table;
use serde_json::Value as Json;
use voussoir_core::plugin::{PluginKind, card};

/// Turns results into the bytes of files. Its card's parameters are its options, under `[output.options]` in a
/// table that is called like the writer.
pub trait Writer: Send + Sync {
    /// (file name relative to the result folder, bytes), in a fixed order. `options` has every option of the card,
    /// from the study or by default.
    fn files(&self, study: &StudyOutput, options: &Json) -> Vec<(String, Vec<u8>)>;
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

/// Writes the files of the study's `[output]` beside results.json: by all writers, or by the listed ones.
pub fn written(study: &StudyOutput) -> Vec<(String, Vec<u8>)> {
    let wanted = |tag: &str| match (tag, &study.output.writers) {
        // It names the other files, so it comes last.
        ("results_json", _) => false,
        (_, Some(tags)) => tags.iter().any(|wanted| wanted == tag),
        (_, None) => true,
    };
    let options = |tag: &str| match study.output.options.get(tag) {
        Some(options) => options.clone(),
        None => card(PluginKind::Writer, tag).map(default_table).unwrap_or_default(),
    };
    let chosen = writers().into_iter().filter(|entry| wanted(entry.tag));
    let files = chosen.flat_map(|entry| entry.writer.files(study, &options(entry.tag)));
    files.chain(path_proofs(study.results)).collect()
}
