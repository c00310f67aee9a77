//! One line that registers a writer: its card and its entry in the registry.

/// The card of a writer and its entry in the registry.
macro_rules! register {
    ($tag:literal, $writer:expr, $summary:literal, $page:literal) => {
        register!($tag, $writer, $summary, &[], $page);
    };
    ($tag:literal, $writer:expr, $summary:literal, $options:expr, $page:literal) => {
        voussoir_core::inventory::submit! {
            voussoir_core::plugin::Card {
                kind: voussoir_core::plugin::PluginKind::Writer,
                tag: $tag,
                summary: $summary,
                parameters: $options,
                file: file!(),
                package: voussoir_core::package!(),
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
