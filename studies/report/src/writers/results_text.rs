//! The text of results.json: the head, the cases one by one, and the tail.
//!
//! The layout is that of `serde_json::to_string_pretty`. The texts of cases can be made in parallel and need not be
//! kept in memory.

use serde::Serialize;
use serde_json::Value as Json;
use serde_json::ser::{Formatter, Serializer};
use std::io::{self, Write};
use voussoir_study::results::{CaseResult, Comparison, KindEntries, Origin};

/// The entries before the cases.
#[derive(Debug, Clone)]
pub struct ResultsHead {
    /// Name of the study.
    pub study: String,
    /// Version of the program.
    pub version: String,
    /// The origin of the results.
    pub origin: Origin,
    /// The day of the run.
    pub date: Option<String>,
    /// Ids of the cases, if the run was limited to some cases.
    pub only_cases: Option<Vec<usize>>,
    /// Names of the files beside results.json and resolved.toml.
    pub files: Vec<String>,
}

/// Writes results.json step by step.
pub struct ResultsText<W: Write> {
    out: W,
    cases: usize,
}

/// Depth of the indentation of cases.
const CASE: usize = 2;

/// Returns the text of a case, with the indentation that it has in the file.
pub fn case_text(case: &CaseResult) -> io::Result<Vec<u8>> {
    // Large enough for an arch of a dozen voussoirs.
    let mut text = Vec::with_capacity(1 << 14);
    write_at(CASE, &mut text, case)?;
    Ok(text)
}

impl<W: Write> ResultsText<W> {
    /// Writes the head.
    pub fn begin(mut out: W, head: &ResultsHead) -> io::Result<Self> {
        out.write_all(b"{")?;
        entry(&mut out, b"\n", "study", &head.study)?;
        entry(&mut out, b",\n", "version", &head.version)?;
        if let Json::Object(origin) = serde_json::to_value(&head.origin)? {
            origin.iter().try_for_each(|(key, value)| entry(&mut out, b",\n", key, value))?;
        }
        if let Some(date) = &head.date {
            entry(&mut out, b",\n", "date", date)?;
        }
        if let Some(only) = &head.only_cases {
            entry(&mut out, b",\n", "only_cases", only)?;
        }
        entry(&mut out, b",\n", "files", &head.files)?;
        out.write_all(b",\n  \"cases\": [")?;
        Ok(ResultsText { out, cases: 0 })
    }

    /// Adds a case without holding its text in memory.
    pub fn write(&mut self, case: &CaseResult) -> io::Result<()> {
        self.begin_case()?;
        write_at(CASE, &mut self.out, case)
    }

    /// Adds a case, made by [`case_text`].
    pub fn add(&mut self, case: &[u8]) -> io::Result<()> {
        self.begin_case()?;
        self.out.write_all(case)
    }

    fn begin_case(&mut self) -> io::Result<()> {
        self.out.write_all(if self.cases == 0 { b"\n    " } else { b",\n    " })?;
        self.cases += 1;
        Ok(())
    }

    /// Writes the entries of the study kind after the cases, and returns the output.
    pub fn finish(mut self, comparison: Option<&Comparison>, own: &KindEntries) -> io::Result<W> {
        self.out.write_all(if self.cases == 0 { b"]" } else { b"\n  ]" })?;
        if let Some(comparison) = comparison {
            entry(&mut self.out, b",\n", "comparison", comparison)?;
        }
        if let Json::Object(own) = serde_json::to_value(own)? {
            own.iter().try_for_each(|(key, value)| entry(&mut self.out, b",\n", key, value))?;
        }
        self.out.write_all(b"\n}\n")?;
        Ok(self.out)
    }
}

/// Writes a key of the top level with its value.
fn entry(out: &mut impl Write, before: &[u8], key: &str, value: &impl Serialize) -> io::Result<()> {
    out.write_all(before)?;
    out.write_all(b"  ")?;
    serde_json::to_writer(&mut *out, key)?;
    out.write_all(b": ")?;
    write_at(1, out, value)
}

/// Writes a value that is indented by `depth` steps.
fn write_at(depth: usize, out: &mut impl Write, value: &impl Serialize) -> io::Result<()> {
    Ok(value.serialize(&mut Serializer::with_formatter(out, Indented { depth, filled: false }))?)
}

/// The end of a line and the indentation of the next one. Deeper indentation needs several pieces.
const LINE: &[u8] = b",\n                                                                ";

/// The layout of `serde_json::ser::PrettyFormatter`. Line end and indentation are written in one piece, which halves
/// the time.
struct Indented {
    depth: usize,
    filled: bool,
}

impl Indented {
    fn line(&self, out: &mut (impl ?Sized + Write), comma: bool) -> io::Result<()> {
        let blanks = 2 * self.depth;
        let (from, held) = (usize::from(!comma), blanks.min(LINE.len() - 2));
        out.write_all(&LINE[from..2 + held])?;
        (held..blanks).try_for_each(|_| out.write_all(b" "))
    }

    fn begin(&mut self, out: &mut (impl ?Sized + Write), bracket: &[u8]) -> io::Result<()> {
        (self.depth, self.filled) = (self.depth + 1, false);
        out.write_all(bracket)
    }

    fn end(&mut self, out: &mut (impl ?Sized + Write), bracket: &[u8]) -> io::Result<()> {
        self.depth -= 1;
        if self.filled {
            self.line(out, false)?;
        }
        out.write_all(bracket)
    }
}

impl Formatter for Indented {
    fn begin_array<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.begin(out, b"[")
    }

    fn end_array<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.end(out, b"]")
    }

    fn begin_array_value<W: ?Sized + Write>(&mut self, out: &mut W, first: bool) -> io::Result<()> {
        self.line(out, !first)
    }

    fn end_array_value<W: ?Sized + Write>(&mut self, _: &mut W) -> io::Result<()> {
        self.filled = true;
        Ok(())
    }

    fn begin_object<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.begin(out, b"{")
    }

    fn end_object<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.end(out, b"}")
    }

    fn begin_object_key<W: ?Sized + Write>(&mut self, out: &mut W, first: bool) -> io::Result<()> {
        self.line(out, !first)
    }

    fn begin_object_value<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        out.write_all(b": ")
    }

    fn end_object_value<W: ?Sized + Write>(&mut self, _: &mut W) -> io::Result<()> {
        self.filled = true;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::writers::results_json::add_cases;
    use serde_json::{Map, json};
    use voussoir_study::results::{StudyResults, this_program};
    use voussoir_study::side_by_side::side_by_side;

    /// The text equals that of serde_json byte by byte, with and without optional entries, at any depth.
    #[test]
    fn the_text_is_that_of_serde_json() {
        let deep = (0..40).fold(json!({ "a": [], "b": {} }), |inner, _| json!([inner, { "c": [1.5, "\"\n"] }]));
        let compared = json!({ "reference": "a", "voices": ["a"], "rows": [] });
        let case = |id: usize| {
            let mut case = CaseResult::stalled("a \"note\"");
            (case.label.id, case.load_factor) = (id, Some(0.1 + 0.2));
            case.label.parameters = Map::from_iter([("k".to_string(), json!({ "d": deep, "e": null }))]);
            case
        };
        for (cases, full) in [(0, false), (1, false), (0, true), (3, true)] {
            let results = StudyResults {
                study: "s {".into(),
                version: "1".into(),
                origin: if full { this_program().clone() } else { Origin::default() },
                date: full.then(|| "today".into()),
                files: if full { vec!["results.csv".into()] } else { Vec::new() },
                only_cases: full.then(|| vec![0, 2]),
                cases: (0..cases).map(case).collect(),
                comparison: full.then(|| serde_json::from_value(compared.clone()).expect("a comparison")),
                own: KindEntries {
                    other: if full { Map::from_iter([("o".to_string(), deep.clone())]) } else { Map::new() },
                    ..KindEntries::default()
                },
            };
            let StudyResults { study, version, origin, date, only_cases, files, .. } = results.clone();
            let head = ResultsHead { study, version, origin, date, only_cases, files };
            let mut text = ResultsText::begin(Vec::new(), &head).expect("written");
            results.cases.iter().try_for_each(|case| text.add(&case_text(case)?)).expect("written");
            let text = text.finish(results.comparison.as_ref(), &results.own).expect("written");
            let expected = serde_json::to_string_pretty(&results).expect("JSON") + "\n";
            assert_eq!(String::from_utf8(text).expect("text"), expected);
            for jobs in [1, 2] {
                let mut text = ResultsText::begin(Vec::new(), &head).expect("written");
                side_by_side(jobs, || add_cases(&mut text, &results.cases)).expect("written");
                let text = text.finish(results.comparison.as_ref(), &results.own).expect("written");
                assert_eq!(String::from_utf8(text).expect("text"), expected);
            }
        }
    }
}
