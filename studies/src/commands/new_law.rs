//! `voussoir new law`: writes the files of a law, made from an example that is compiled and tested.

use super::error::{CliError, Outcome, Verdict};
use super::print::say;
use std::path::Path;
use voussoir_core::plugin::{PluginKind, card};

/// The law of `studies/examples/my_law`, its page, and its test. These files are copies, because Cargo leaves nested
/// crates out of a package. A test of the architecture compares them.
const LAW: &str = include_str!("../../templates/keyed.rs");
const PAGE: &str = include_str!("../../templates/keyed.md");
const TEST: &str = include_str!("../../templates/test.rs");

/// Returns the reason why a word cannot be the tag of a new law.
fn unfit(tag: &str) -> Option<String> {
    let word = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    if !tag.starts_with(|c: char| c.is_ascii_lowercase()) || !tag.chars().all(word) {
        return Some("a tag is the name of a file: small letters, digits and _, a letter first".into());
    }
    let taken = card(PluginKind::InterfaceLaw, tag)?;
    Some(format!("there is such a law already: {}", taken.file))
}

/// Converts `shear_keys` to `ShearKeys`.
fn type_name(tag: &str) -> String {
    let capital =
        |word: &str| word.chars().take(1).flat_map(char::to_uppercase).chain(word.chars().skip(1)).collect::<String>();
    tag.split('_').map(capital).collect()
}

/// Writes a joint law, its page and its test into a crate; never overwrites a file.
pub fn law(tag: &str, into: &Path) -> Outcome {
    if let Some(why) = unfit(tag) {
        return Err(CliError::wrong_input(format_args!("voussoir new law {tag}: {why}")));
    }
    let manifest = into.join("Cargo.toml");
    let text = std::fs::read_to_string(&manifest)
        .map_err(|error| CliError::of_file(&manifest, format_args!("{error}; --out names the folder of a crate")))?;
    let table: Option<toml::Table> = text.parse().ok();
    let Some(name) = table.as_ref().and_then(|table| table.get("package")?.get("name")?.as_str()) else {
        return Err(CliError::wrong_input(format_args!("{}: names no package", manifest.display())));
    };
    let own = |text: &str| {
        text.replace("Keyed", &type_name(tag)).replace("keyed", tag).replace("my_law", &name.replace('-', "_"))
    };
    let mut files = vec![(format!("src/{tag}.rs"), own(LAW)), (format!("src/{tag}.md"), own(PAGE))];
    // In this workspace, the conformance tests find every law.
    if name != "voussoir-laws" {
        files.push((format!("tests/{tag}.rs"), own(TEST)));
    }
    if let Some((there, _)) = files.iter().find(|(file, _)| into.join(file).exists()) {
        let place = into.join(there);
        let why = format_args!("voussoir: {} is there already; nothing was written", place.display());
        return Err(CliError::wrong_input(why));
    }
    for (file, text) in &files {
        let place = into.join(file);
        let written =
            std::fs::create_dir_all(place.parent().unwrap_or(into)).and_then(|()| std::fs::write(&place, text));
        written.map_err(|error| CliError::unwritten(&place, error))?;
        say(format!("{}", place.display()));
    }
    say(format!(
        "add `pub mod {tag};` to {}, change the equations, and say `voussoir conform {tag}`",
        into.join("src/lib.rs").display()
    ));
    Ok(Verdict::Proved)
}
