//! A study that reproduces a finding: it drives the law along the path that led to it.

use voussoir_core::plugin::{Card, PluginKind};

/// Returns the study file of `kind = "point"` that drives a law with these keys through gaps or strains.
pub(super) fn reproduce(card: &Card, check: &str, table: &str, path: &[[f64; 6]]) -> String {
    let joint = card.kind == PluginKind::InterfaceLaw;
    let (tables, word, quantity) = if joint { ("joints", "joint", "gap") } else { ("materials", "material", "strain") };
    let names: &[&str] = if joint { &["n", "t"] } else { &["xx", "yy", "zz", "xy", "yz", "zx"] };
    let mut text = format!(
        "# What `voussoir conform {tag}` found: {check}.\nname = \"{tag} {check}\"\nkind = \"point\"\n\n[{tables}.law]\nlaw = \"{tag}\"\n{table}\n\n[point]\n{word} = \"law\"\n",
        tag = card.tag,
    );
    for at in path {
        let targets: Vec<String> = names.iter().zip(at).map(|(name, x)| format!("{name} = {x:?}")).collect();
        text += &format!("\n[[point.path]]\nsteps = 1\n{quantity} = {{ {} }}\n", targets.join(", "));
    }
    text
}
