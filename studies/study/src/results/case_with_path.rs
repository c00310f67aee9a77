//! Cases with their stored paths, in journals and parts.

use super::case_result::CaseResult;
use super::stored_path::PathEntry;
use serde::{Serialize, Serializer};
use std::sync::Arc;

/// The text between a case and its stored path, which is its last value. In a JSON string its quotes would be escaped.
const PATH_KEY: &[u8] = b",\"stored_path\":";

/// Serialises a case with its stored path, for journals and parts.
pub struct CaseWithPath<'a>(pub &'a CaseResult);

impl Serialize for CaseWithPath<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Both<'a> {
            #[serde(flatten)]
            case: &'a CaseResult,
            stored_path: &'a PathEntry,
        }
        match &self.0.stored_path {
            None => self.0.serialize(serializer),
            Some(stored_path) => Both { case: self.0, stored_path }.serialize(serializer),
        }
    }
}

/// Reads a case with the text of its stored path, which is not examined.
///
/// # Errors
/// If the text is not a case.
pub fn read_case(text: &[u8]) -> serde_json::Result<CaseResult> {
    let key = text.windows(PATH_KEY.len()).position(|own| own == PATH_KEY);
    let Some(key) = key.filter(|_| text.ends_with(b"}")) else { return serde_json::from_slice(text) };
    let path = &text[key + PATH_KEY.len()..text.len() - 1];
    let mut case: CaseResult = serde_json::from_slice(&[&text[..key], b"}"].concat())?;
    case.stored_path = str::from_utf8(path).ok().map(|path| PathEntry::Text(Arc::from(path)));
    Ok(case)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::stored_path::StoredPath;
    use voussoir_core::limit::Status;

    /// A case is read as it was written, with its path, also if a text in it looks like the key of the path.
    #[test]
    fn a_case_keeps_its_path() {
        let path = StoredPath {
            status: Status::Collapse,
            end: 0,
            motion: None,
            ray: None,
            states: Vec::new(),
            witnesses: Vec::new(),
        };
        let mut case = CaseResult::stalled(r#"a note,"stored_path":{}"#);
        case.label.id = 7;
        for stored in [None, Some(PathEntry::Numbers(Arc::new(path.clone())))] {
            case.stored_path = stored.clone();
            let text = serde_json::to_vec(&CaseWithPath(&case)).expect("text");
            let read = read_case(&text).expect("a case");
            assert_eq!((read.label.id, &read.notes), (7, &case.notes));
            let numbers = read.stored_path.as_ref().map(|own| own.numbers().expect("a path"));
            assert_eq!(numbers.is_some(), stored.is_some());
            assert!(numbers.is_none_or(|own| *own == path));
            assert_eq!(serde_json::to_vec(&CaseWithPath(&read)).expect("text"), text);
        }
    }
}
