//! One line that registers a writer: its card and its entry in the registry.

/// The card of a writer and its entry in the registry.
macro_rules! register {
    ($tag:literal, $writer:expr, $summary:literal, $page:literal) => {
        voussoir_core::inventory::submit! {
            voussoir_core::plugin::Card {
                kind: voussoir_core::plugin::PluginKind::Writer,
                tag: $tag,
                summary: $summary,
                parameters: &[],
                provides: &[],
                requires: &[],
                sources: &[],
                file: file!(),
                page: $page,
                check: voussoir_core::plugin::no_further_check,
            }
        }
        voussoir_core::inventory::submit! {
            $crate::writers::WriterEntry { tag: $tag, writer: &$writer }
        }
    };
}
pub(crate) use register;
