//! Result files: each writer turns a study's results into named texts. None touches a file.
//!
//! A writer is one file here: a type with [`Writer`], its card, and a [`WriterEntry`] submitted
//! to the registry.

pub mod comparison;
pub mod csv;
pub mod curve_csv;
pub mod figures;
mod page;
pub mod report;
pub mod results_json;
pub mod table;
pub mod vtu;

use crate::results::StudyResults;
use crate::study::Kinematics;
use voussoir_core::model::{Assembly, Stage};

/// What writers are given: the results and what they were computed from.
#[derive(Debug, Clone, Copy)]
pub struct StudyOutput<'a> {
    /// Name of the study.
    pub name: &'a str,
    /// Results, one per case.
    pub results: &'a StudyResults,
    /// One per case.
    pub assemblies: &'a [&'a Assembly],
    /// Stages in order, one list per case.
    pub stages: &'a [&'a [Stage]],
    /// Swept keys, outermost first.
    pub sweep_keys: &'a [String],
    /// Whether figures are wanted.
    pub figures: bool,
    /// Small or finite displacements, one per case, where files for ParaView are wanted.
    pub vtu: Option<&'a [Kinematics]>,
}

impl StudyOutput<'_> {
    /// Assembly and stages of the case at this place in the list; `None` where they are missing.
    pub fn scene(&self, place: usize) -> Option<(&Assembly, &[Stage])> {
        Some((self.assemblies.get(place)?, self.stages.get(place)?))
    }
}

/// Turns results into the texts of files.
pub trait Writer: Send + Sync {
    /// (file name relative to the result folder, text), in a fixed order.
    fn files(&self, study: &StudyOutput) -> Vec<(String, String)>;
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

/// The card of a writer and its entry in the registry.
macro_rules! register {
    ($tag:literal, $writer:expr, $summary:literal, $page:literal) => {
        voussoir_core::inventory::submit! {
            voussoir_core::plugin::Card {
                kind: voussoir_core::plugin::PluginKind::Writer,
                tag: $tag,
                summary: $summary,
                parameters: &[],
                file: file!(),
                page: $page,
                ..voussoir_core::plugin::Card::BLANK
            }
        }
        voussoir_core::inventory::submit! {
            $crate::writers::WriterEntry { tag: $tag, writer: &$writer }
        }
    };
}
pub(crate) use register;
