//! The book is complete: it has every page of `docs/` and every plug-in, and its links have targets.

use std::path::Path;
use voussoir::core::plugin::cards;
use voussoir_tests::book::{book, gallery, target};

/// The book has every page and every plug-in, and its links have targets; all faults are listed at once.
#[test]
fn the_book_has_every_page_and_every_plug_in_and_its_links_lead_somewhere() {
    let pages = book();
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs");
    let mut wrong = Vec::new();
    for name in pages.keys().filter(|name| *name != "SUMMARY.md") {
        if !pages["SUMMARY.md"].contains(&format!("({name})")) {
            wrong.push(format!("no chapter is {name}"));
        }
    }
    for (name, page) in &pages {
        for link in page.split("](").skip(1).filter_map(|after| after.split(')').next()) {
            let file = target(name, link);
            let drawn = gallery::runs().iter().any(|(_, _, picture)| *picture == file);
            let figure = file.ends_with(".svg") && docs.join(&file).exists();
            let known = link.starts_with('#') || link.contains(':') || pages.contains_key(&file) || drawn || figure;
            if !known {
                wrong.push(format!("{name}: the link {link} leads nowhere"));
            }
        }
    }
    for card in cards() {
        if !pages.values().any(|page| page.contains(&format!("### `{}`\n", card.tag))) {
            wrong.push(format!("{} is in no page", card.tag));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let rows = pages["reference/verification.md"].lines().filter(|line| line.starts_with("| `")).count();
    let keys = pages["reference/keys.md"].lines().filter(|line| line.starts_with("| `")).count();
    assert!(rows > 250 && keys > 60, "{rows} tests, {keys} keys");
}
