//! `voussoir list`, `explain` and `schema`.

use super::codes::{FINE, NO_ACCESS, WRONG_INPUT, complain, say, say_data};
use super::{files, topics};
use crate::kinds::json_schema::json_schema;
use std::path::Path;
use voussoir_core::plugin::{Card, PluginKind, cards, cards_of, describe, nearest};

/// Lists plug-ins, of one kind or all.
pub fn list(kind: Option<&str>) -> u8 {
    let kinds: Vec<PluginKind> = match kind {
        None => PluginKind::ALL.to_vec(),
        Some(word) => match PluginKind::ALL.iter().find(|kind| kind.plural() == word) {
            Some(kind) => vec![*kind],
            None => {
                let words = PluginKind::ALL.map(PluginKind::plural);
                complain(format_args!("there are no \"{word}\" to list; list one of: {}", words.join(", ")));
                return WRONG_INPUT;
            }
        },
    };
    for kind in kinds {
        say(format!("{} ({} = …)", kind.plural(), kind.tag_key()));
        for card in cards_of(kind) {
            say(format!("  {:<20} {}", card.tag, card.summary));
        }
    }
    FINE
}

/// Prints the JSON Schema of study files.
pub fn schema() -> u8 {
    say(format!("{:#}", json_schema()));
    FINE
}

/// Forms in which a study can be written.
pub const EXPORTS: [&str; 1] = ["blocks"];

/// Prints the first case of a study in another form.
pub fn export(path: &Path) -> u8 {
    match files::study(path, &[]).map(|study| study.as_blocks()) {
        Ok(Ok(text)) => {
            say_data(&text);
            FINE
        }
        Ok(Err(why)) => {
            complain(format_args!("{}: cannot be written as blocks: {why}", path.display()));
            WRONG_INPUT
        }
        Err(code) => code,
    }
}

/// Explains a plug-in by its tag, or a study file by the plan of its solution.
pub fn explain(what: &str) -> u8 {
    if what.ends_with(".toml") || Path::new(what).is_file() {
        return match files::study(Path::new(what), &[]) {
            Ok(study) => {
                say(study.explain());
                FINE
            }
            Err(code) => code,
        };
    }
    let found: Vec<&Card> = cards().iter().copied().filter(|card| card.tag == what).collect();
    let known = topics::explain(what);
    if found.is_empty() && known.is_empty() {
        let tags = cards().iter().map(|card| card.tag.to_string());
        let words: Vec<String> = tags.chain(topics::words()).collect();
        let near = nearest(what, words.iter().map(String::as_str));
        let advice = near.map_or("see `voussoir list`".into(), |tag| format!("did you mean \"{tag}\"?"));
        complain(format_args!("no plug-in, key or word is called \"{what}\"; {advice}"));
        return if what.contains('/') { NO_ACCESS } else { WRONG_INPUT };
    }
    found.iter().for_each(|card| print_card(card));
    if !known.is_empty() {
        say(known.trim_end());
    }
    FINE
}

fn print_card(card: &Card) {
    say(format!("{} — {}: {}\n", card.tag, card.kind.describe(), card.summary));
    if !card.parameters.is_empty() {
        say("keys:");
    }
    for parameter in card.parameters {
        say(format!("  {}", topics::describe(parameter)));
    }
    for (heading, all) in [
        ("offers", card.provides.iter().map(|capability| capability.words.to_string()).collect::<Vec<_>>()),
        ("asks of laws", card.requires.iter().map(|need| describe(need)).collect()),
        ("claims", card.claims.iter().map(|property| property.0.replace('_', " ")).collect()),
    ] {
        if !all.is_empty() {
            say(format!("{heading}: {}", all.join(", ")));
        }
    }
    if let Some(sample) = card.samples.first() {
        let table = if card.kind == PluginKind::InterfaceLaw { "joints" } else { "materials" };
        say(format!(
            "\nan example, [{table}.NAME] of a study:\n\n[{table}.NAME]\nlaw = \"{}\"\n{}\n",
            card.tag, sample.table
        ));
    }
    card.sources.iter().for_each(|source| say(format!("source: {source}")));
    say(format!("file: {}\n\n{}", card.file, card.page));
}
