//! `none`: a load reaches the extrados unchanged.

use crate::scenes::dispersion::law::{Dispersion, Patch, Through};
use voussoir_core::plugin::{Card, Keys, PluginKind};

/// A load reaches the extrados unchanged.
#[derive(Debug, Keys)]
pub struct Undispersed {}

#[typetag::serde(name = "none")]
impl Dispersion for Undispersed {
    fn spread(&self, patch: Patch, _: &[Through]) -> Vec<Patch> {
        vec![patch]
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::Dispersion,
        tag: "none",
        summary: "loads reach the extrados without dispersion",
        file: file!(),
        package: voussoir_core::package!(),
        page: "# `none`\n\nThe load acts on the extrados without spreading. This is also the behaviour if \
               `dispersion` is not given.\n",
        ..Card::of::<Undispersed>()
    }
}
