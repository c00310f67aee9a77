//! A macro that registers a writer: its card and its entry in the registry.

use voussoir_core::plugin::Keys;

/// The keys of a writer without options.
#[derive(Debug, Keys)]
pub struct NoOptions {}

/// Creates the card of a writer and its entry in the registry.
macro_rules! register {
    ($tag:literal, $writer:expr, $summary:literal, $page:literal) => {
        register!($tag, $writer, $summary, $crate::writers::register::NoOptions, $page);
    };
    ($tag:literal, $writer:expr, $summary:literal, $options:ty, $page:literal) => {
        voussoir_core::inventory::submit! {
            voussoir_core::plugin::Card {
                kind: voussoir_core::plugin::PluginKind::Writer,
                tag: $tag,
                summary: $summary,
                file: file!(),
                package: voussoir_core::package!(),
                page: $page,
                ..voussoir_core::plugin::Card::of::<$options>()
            }
        }
        voussoir_core::inventory::submit! {
            $crate::writers::WriterEntry { tag: $tag, writer: &$writer }
        }
    };
}
pub(crate) use register;
