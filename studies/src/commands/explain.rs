//! `voussoir list`, `explain` and `schema`.

use super::error::{CliError, Outcome, Verdict};
use super::print::{print, say, say_data};
use super::{files, topics};
use std::path::Path;
use voussoir_core::plugin::{Card, Output, OutputOf, PluginKind, cards, cards_of, describe};
use voussoir_report::kinds::json_schema::json_schema;
use voussoir_study::config::synonyms::nearest_name;
use voussoir_study::results::RESULTS_SCHEMA;

/// Lists plug-ins, of one kind or all.
pub fn list(kind: Option<&str>) -> Outcome {
    let kinds: Vec<PluginKind> = match kind {
        None => PluginKind::ALL.to_vec(),
        Some(word) => match PluginKind::ALL.iter().find(|kind| kind.plural() == word) {
            Some(kind) => vec![*kind],
            None => {
                let words = PluginKind::ALL.map(PluginKind::plural);
                let near = nearest_name(word, words).map_or(String::new(), |near| format!(" did you mean \"{near}\"?"));
                let why = format_args!("there is no list \"{word}\";{near} lists: {}", words.join(", "));
                return Err(CliError::wrong_input(why));
            }
        },
    };
    for kind in kinds {
        say(format!("{} ({} = …)", kind.plural(), kind.tag_key()));
        for card in cards_of(kind) {
            say(format!("  {:<20} {}", card.tag, card.summary));
        }
    }
    Ok(Verdict::Proved)
}

/// Files that have a JSON Schema; without a choice the first ones.
pub const SCHEMAS: [&str; 2] = ["studies", "results"];

/// Prints the JSON Schema of study files, or of results.json.
pub fn schema(files: &str) -> Outcome {
    match files {
        "results" => print(RESULTS_SCHEMA.as_bytes()),
        _ => say(format!("{:#}", json_schema())),
    }
    Ok(Verdict::Proved)
}

/// Formats for the export of a study.
pub const EXPORTS: [&str; 1] = ["blocks"];

/// Prints the first case of a study in another format.
pub fn export(path: &Path) -> Outcome {
    let text = files::study(path, &[])?
        .as_blocks()
        .map_err(|why| CliError::wrong_input(format_args!("{}: cannot be written as blocks: {why}", path.display())))?;
    say_data(&text);
    Ok(Verdict::Proved)
}

/// Explains a plug-in by its tag, or shows how a study file will be solved.
pub fn explain(what: &str) -> Outcome {
    if what.ends_with(".toml") || Path::new(what).is_file() {
        say(files::study(Path::new(what), &[])?.explain());
        return Ok(Verdict::Proved);
    }
    let found: Vec<&Card> = cards().iter().copied().filter(|card| card.tag == what).collect();
    let known = topics::explain(what);
    if found.is_empty() && known.is_empty() {
        let tags = cards().iter().map(|card| card.tag.to_string());
        let words: Vec<String> = tags.chain(topics::words()).collect();
        let near = nearest_name(what, words.iter().map(String::as_str));
        let advice = near.map_or("see `voussoir list`".into(), |tag| format!("did you mean \"{tag}\"?"));
        let why = format!("no plug-in, key or word is called \"{what}\"; {advice}");
        // A word with a dot or a slash is meant as a file.
        let file = what.contains(['/', '.']) && near.is_none();
        let why = if file {
            format!("there is no file {what}{}", files::did_you_mean(Path::new(what), &|own| own.is_file()))
        } else {
            why
        };
        return Err(if what.contains('/') { CliError::no_access(why) } else { CliError::wrong_input(why) });
    }
    found.iter().for_each(|card| print_card(card));
    if !known.is_empty() {
        say(known.trim_end());
    }
    Ok(Verdict::Proved)
}

/// Returns the place of a sample in a study file, and the lines before it.
fn place_of_sample(card: &Card) -> (&'static str, String) {
    let tag = card.tag;
    match card.kind {
        PluginKind::InterfaceLaw => ("[joints.NAME]", format!("[joints.NAME]\nlaw = \"{tag}\"")),
        PluginKind::BulkMaterial => ("[materials.NAME]", format!("[materials.NAME]\nlaw = \"{tag}\"")),
        PluginKind::Scene => ("[scene]", format!("[scene]\nscene = \"{tag}\"")),
        PluginKind::LoadKind => ("a load in the last of the [[stages]]", format!("[[stages.loads]]\nkind = \"{tag}\"")),
        _ => ("tables", format!("{} = \"{tag}\"\n", card.kind.tag_key())),
    }
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
    if !card.outputs.is_empty() {
        say("outputs:");
    }
    for output in card.outputs {
        let Output { name, unit, doc, of, .. } = output;
        let each = if *of == OutputOf::Case { "the" } else { "each" };
        say(format!("  {name} [{unit}], of {each} {}: {doc}", of.word()));
    }
    if let Some(sample) = card.samples.first() {
        let (place, head) = place_of_sample(card);
        say(format!("\nan example, {place} of a study:\n\n{head}\n{}\n", sample.table));
    }
    card.sources.iter().for_each(|source| say(format!("source: {source}")));
    say(format!("file: {}\n\n{}", card.file, card.page));
}
