//! From results.json and path_proofs.jsonl back to a journal, so that `--resume` of a finished run finds its cases finished.

use super::error::CliError;
use super::folder::{JOURNAL, ResultFolder};
use crate::regular_file::open_regular;
use crate::results::CaseResult;
use crate::results::case_with_path::CaseWithPath;
use crate::results::sealed_line::sealed_text;
use crate::results::stored_path::PATH_PROOFS;
use crate::verify::path_proofs::PathProofLines;
use serde::de::IgnoredAny;
use std::io::{self, BufRead, BufReader, Read, Write};

/// Greatest length of a results.json.
const MAX_RESULTS_BYTES: u64 = 1 << 40;
/// Greatest length of the text of a case.
const MAX_CASE_BYTES: u64 = 1 << 30;

/// Writes the cases of results.json as lines of a journal, where there is no journal yet. Read as it is written: a case stands
/// between two lines of four blanks and a brace. Of a file that somebody has laid out otherwise nothing is taken.
pub fn refill(folder: &ResultFolder) -> Result<(), CliError> {
    let (results, journal) = (folder.path().join("results.json"), folder.path().join(JOURNAL));
    if journal.exists() || !results.exists() {
        return Ok(());
    }
    let file = open_regular(&results, MAX_RESULTS_BYTES).map_err(|error| CliError::of_file(&results, error))?;
    let proofs = open_regular(&folder.path().join(PATH_PROOFS), MAX_RESULTS_BYTES).ok();
    let mut proofs = proofs.map(|file| PathProofLines::new(Some(Box::new(file))));
    let mut aside = folder.aside(JOURNAL)?;
    let copied = lines_of_cases(&mut BufReader::with_capacity(1 << 16, file), proofs.as_mut(), &mut aside);
    aside.done(copied)
}

/// The text of a case, with its stored path if there is one.
fn with_path(case: &str, proofs: Option<&mut PathProofLines>) -> serde_json::Result<Vec<u8>> {
    match proofs {
        None => serde_json::from_str::<IgnoredAny>(case).map(|_| case.as_bytes().to_vec()),
        Some(proofs) => {
            let case = proofs.attached_to(serde_json::from_str::<CaseResult>(case)?);
            serde_json::to_vec(&CaseWithPath(&case))
        }
    }
}

fn lines_of_cases(
    from: &mut dyn BufRead,
    mut proofs: Option<&mut PathProofLines>,
    to: &mut dyn Write,
) -> io::Result<()> {
    let (mut bytes, mut case) = (Vec::new(), String::new());
    let mut within = false;
    while Read::take(&mut *from, MAX_CASE_BYTES).read_until(b'\n', &mut bytes)? > 0 {
        let line = std::str::from_utf8(&bytes).unwrap_or_default();
        within &= case.len() as u64 <= MAX_CASE_BYTES && !line.is_empty();
        match line.trim_end() {
            "    {" => {
                within = true;
                case.clear();
                case.push('{');
            }
            "    }" | "    }," if within => {
                within = false;
                case.push('}');
                // Texts hold no line ends, so that a case is one line without its indentation.
                if let Ok(case) = with_path(&case, proofs.as_deref_mut()) {
                    to.write_all(&sealed_text(&case))?;
                }
            }
            own if within => case.push_str(own.trim_start()),
            _ => {}
        }
        bytes.clear();
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    /// What is written in results.json comes back case by case, number by number; other layouts give nothing.
    #[test]
    fn cases_come_back_from_results() {
        let cases = [
            json!({ "id": 0, "load_factor": 0.1 + 0.2, "notes": ["a \" {", "    {\n    }"], "hinges": [{ "joint": 1 }, {}] }),
            json!({ "id": 1, "load_factor": null, "notes": [] }),
        ];
        let whole = json!({ "study": "s", "only_cases": [{ "id": 7 }], "cases": cases });
        let journal = |text: String| {
            let mut out = Vec::new();
            lines_of_cases(&mut text.as_bytes(), None, &mut out).expect("written");
            String::from_utf8(out).expect("text")
        };
        let lines = journal(serde_json::to_string_pretty(&json!({ "study": "s", "cases": cases })).expect("JSON"));
        let back: Vec<serde_json::Value> =
            lines.lines().map(|line| serde_json::from_str(line).expect("a line")).collect();
        let back: Vec<serde_json::Value> = back.into_iter().map(|mut line| line["case"].take()).collect();
        assert_eq!(back, cases);
        assert_eq!(journal(serde_json::to_string(&whole).expect("JSON")), "");
    }
}
