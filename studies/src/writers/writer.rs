//! What a writer is.

use super::study_output::StudyOutput;

/// Turns results into the bytes of files.
pub trait Writer: Send + Sync {
    /// (file name relative to the result folder, bytes), in a fixed order.
    fn files(&self, study: &StudyOutput) -> Vec<(String, Vec<u8>)>;
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
