//! Conformance checks of the law `keyed`.

use my_law as _;
use voussoir::conformance::{Options, conform};
use voussoir::core::plugin::{PluginKind, card};

#[test]
fn keyed_conforms() {
    let report = conform(card(PluginKind::InterfaceLaw, "keyed").expect("its card"), &Options::default());
    assert!(report.passed(), "{report}");
}
