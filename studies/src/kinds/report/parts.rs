//! The parts of a report with their results.

use crate::figures::format::format_seconds;
use crate::kinds::kind::{Part, Piece};
use serde_json::{Value as Json, json};
use std::collections::BTreeMap;

/// The parts of a report with their results.
pub struct Parts<'a> {
    parts: &'a [Part],
    texts: &'a [String],
    json: Vec<Json>,
    /// True if figures are drawn.
    pub figures: bool,
}

impl<'a> Parts<'a> {
    /// Parts with the text of the results.json of each.
    pub fn new(parts: &'a [Part], texts: &'a [String], figures: bool) -> Self {
        let json = texts.iter().map(|text| serde_json::from_str(text).unwrap_or_default()).collect();
        Parts { parts, texts, json, figures }
    }

    /// The parts, in order.
    pub fn list(&self) -> &'a [Part] {
        self.parts
    }

    /// The results of a study by its name.
    pub fn json(&self, study: &str) -> Option<&Json> {
        let place = self.parts.iter().position(|part| part.folder == study)?;
        self.json.get(place)
    }

    /// The cases of a part.
    pub fn cases(&self, place: usize) -> &[Json] {
        self.json.get(place).and_then(|json| json["cases"].as_array()).map_or(&[], Vec::as_slice)
    }

    /// How many cases came to which status.
    pub fn statuses(&self, place: usize) -> BTreeMap<String, usize> {
        let mut counts = BTreeMap::new();
        for case in self.cases(place) {
            *counts.entry(case["status"].as_str().unwrap_or_default().to_string()).or_insert(0) += 1;
        }
        counts
    }

    /// Cases that passed no certificate; driven points have none and end by reaching their path's end.
    pub fn uncertified(&self, place: usize) -> usize {
        let failed = |case: &&Json| case["certificate"]["passed"] != true && case["status"] != "reached";
        self.cases(place).iter().filter(failed).count()
    }

    /// Time of all cases of a part \[s\].
    pub fn seconds(&self, place: usize) -> f64 {
        self.cases(place).iter().filter_map(|case| case["seconds"].as_f64()).sum()
    }

    /// `parts` of results.json; times are left out, because they stand in the parts' own results.
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

    /// A line for each part: cases, statuses, time.
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

    /// A piece of a part.
    pub fn piece(&self, study: &str, piece: Piece) -> Option<String> {
        let place = self.parts.iter().position(|part| part.folder == study)?;
        self.parts[place].study.piece(self.texts.get(place)?, piece)
    }
}
