//! The registry, and the required content of cards.

use std::path::Path;
use voussoir::core::plugin::{Need, Parameter, PluginKind, audit, cards};

/// Every kind of plug-in is registered, no tag is used twice, every card is complete, and each file has the name of its
/// tag.
#[test]
fn every_card_is_complete() {
    // The laws with faults have types without cards. Nothing else is wrong.
    let (mutants, wrong): (Vec<String>, Vec<String>) = audit().into_iter().partition(|why| why.contains("\"mutant_"));
    assert_eq!(wrong, Vec::<String>::new());
    assert_eq!(mutants.len(), 5, "{mutants:#?}");
    assert!(mutants.iter().all(|why| why.contains("no card has this tag")), "{mutants:#?}");
    for card in cards().iter().filter(|card| !card.file.contains("mutants")) {
        assert!(!card.summary.is_empty() && !card.page.is_empty(), "{}", card.tag);
        let stem = Path::new(card.file).file_stem().expect("a file").to_string_lossy().into_owned();
        let folder = Path::new(card.file)
            .parent()
            .expect("a folder")
            .file_name()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        let named = [stem.clone(), format!("limit_{folder}"), format!("{folder}_path"), format!("results_{stem}")];
        // The tag used in study files is older than the name of the folder, which is the term of the field.
        let kept = card.tag == "limit_least" && folder == "nonassociated";
        assert!(kept || named.contains(&card.tag.to_string()), "{} stands in {}", card.tag, card.file);
        for parameter in card.parameters {
            documented(card.tag, parameter);
        }
        let law = matches!(card.kind, PluginKind::InterfaceLaw | PluginKind::BulkMaterial);
        let sampled = law || matches!(card.kind, PluginKind::Scene | PluginKind::LoadKind | PluginKind::StudyKind);
        let strategy = card.kind == PluginKind::Continuation;
        assert!(strategy || sampled != card.samples.is_empty(), "{}: samples", card.tag);
        if law || card.kind == PluginKind::LimitSolver {
            assert!(!card.sources.is_empty(), "{} names no source", card.tag);
        }
    }
}

/// Every command reports a registry with mistakes, and ends with exit code 3. The laws with faults of this program have no cards.
#[test]
fn commands_report_a_type_without_a_card() {
    for command in ["conform", "list"] {
        let outcome = voussoir::cli::outcome_of([command.into()]).expect("a command");
        assert_eq!(outcome.err().map(|error| error.exit_code()), Some(3), "{command}");
    }
}

fn documented(tag: &str, parameter: &Parameter) {
    assert!(!parameter.doc.is_empty(), "{tag}.{} is not explained", parameter.name);
    if let Need::Default(value) = parameter.need {
        let line = format!("x = {value}");
        assert!(line.parse::<toml::Table>().is_ok(), "{tag}.{}: default {value} is no TOML", parameter.name);
    }
}
