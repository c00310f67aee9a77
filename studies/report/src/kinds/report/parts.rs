//! The parts of a report with their results.

use serde::Deserialize;
use serde_json::{Value as Json, json};
use std::collections::BTreeMap;
use voussoir_study::kind::{Part, Piece};
use voussoir_study::results::format::format_seconds;
use voussoir_study::results::{StoredEntry, StoredOutline};

/// The parts of a report with their results.
pub struct Parts<'a> {
    parts: &'a [Part],
    texts: &'a [String],
    json: Vec<Json>,
    outlines: Vec<StoredOutline>,
    /// True if figures are drawn.
    pub figures: bool,
}

impl<'a> Parts<'a> {
    /// Combines the parts with the texts of their results.json.
    pub fn new(parts: &'a [Part], texts: &'a [String], figures: bool) -> Self {
        let json: Vec<Json> = texts.iter().map(|text| serde_json::from_str(text).unwrap_or_default()).collect();
        let outlines = json.iter().map(|json| StoredOutline::deserialize(json).unwrap_or_default()).collect();
        Parts { parts, texts, json, outlines, figures }
    }

    /// Returns the parts in order.
    pub fn list(&self) -> &'a [Part] {
        self.parts
    }

    /// Returns the results of a study by its name.
    pub fn json(&self, study: &str) -> Option<&Json> {
        let place = self.parts.iter().position(|part| part.folder == study)?;
        self.json.get(place)
    }

    /// Returns the heads of the cases of a part.
    pub fn cases(&self, place: usize) -> &[StoredEntry] {
        self.outlines.get(place).map_or(&[], |outline| outline.cases.as_slice())
    }

    /// Returns the number of cases by status.
    pub fn statuses(&self, place: usize) -> BTreeMap<String, usize> {
        let mut counts = BTreeMap::new();
        for case in self.cases(place) {
            *counts.entry(case.status().to_string()).or_insert(0) += 1;
        }
        counts
    }

    /// Returns the number of cases without a passed certificate. Driven points have no certificate; they pass if they reach the
    /// end of their path.
    pub fn uncertified(&self, place: usize) -> usize {
        let failed = |case: &&StoredEntry| !case.certified() && case.status() != "reached";
        self.cases(place).iter().filter(failed).count()
    }

    /// Returns the time of all cases of a part \[s\].
    pub fn seconds(&self, place: usize) -> f64 {
        self.cases(place).iter().filter_map(|case| case.seconds).sum()
    }

    /// Returns `parts` for results.json. Times are omitted, because they are in the results of the parts.
    pub fn entries(&self) -> Json {
        let entry = |(place, part): (usize, &Part)| {
            json!({
                "study": part.folder,
                "cases": self.cases(place).len(),
                "statuses": self.statuses(place),
                "not_certified": self.uncertified(place),
            })
        };
        self.parts.iter().enumerate().map(entry).collect()
    }

    /// Returns a line for each part: cases, statuses, time.
    pub fn times(&self) -> String {
        let line = |(place, part): (usize, &Part)| {
            let statuses = self.statuses(place);
            let words: Vec<String> =
                statuses.iter().map(|(status, count)| format!("{count} {}", status.replace('_', " "))).collect();
            let seconds = format_seconds(self.seconds(place));
            format!("{:<32} {:>5} cases  {:>8}  {}\n", part.folder, self.cases(place).len(), seconds, words.join(", "))
        };
        self.parts.iter().enumerate().map(line).collect()
    }

    /// Returns a piece of a part.
    pub fn piece(&self, study: &str, piece: Piece) -> Option<String> {
        let place = self.parts.iter().position(|part| part.folder == study)?;
        self.parts[place].study.piece(self.texts.get(place)?, piece)
    }
}
