//! Cases with their stored paths, in journals and parts.

use super::case_result::CaseResult;
use super::stored_path::StoredPath;
use serde::{Deserialize, Serialize, Serializer};
use std::sync::Arc;

/// Serialises a case with its stored path, for journals and parts.
pub struct CaseWithPath<'a>(pub &'a CaseResult);

impl Serialize for CaseWithPath<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Both<'a> {
            #[serde(flatten)]
            case: &'a CaseResult,
            stored_path: &'a StoredPath,
        }
        match self.0.stored_path.as_deref() {
            None => self.0.serialize(serializer),
            Some(stored_path) => Both { case: self.0, stored_path }.serialize(serializer),
        }
    }
}

/// Reads only the path of a case.
#[derive(Deserialize)]
struct PathOf {
    stored_path: Option<StoredPath>,
}

/// Reads a case with its stored path.
///
/// # Errors
/// If the text is not a case. An unreadable path is left out.
pub fn read_case(text: &[u8]) -> serde_json::Result<CaseResult> {
    const KEY: &[u8] = b"\"stored_path\":";
    let mut case: CaseResult = serde_json::from_slice(text)?;
    if text.windows(KEY.len()).any(|own| own == KEY) {
        let path = serde_json::from_slice::<PathOf>(text).ok();
        case.stored_path = path.and_then(|own| own.stored_path).map(Arc::new);
    }
    Ok(case)
}
