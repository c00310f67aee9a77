//! Cases with their stored paths, in journals and parts.

use super::case_result::CaseResult;
use super::stored_path::StoredPath;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A case with its stored path, as journals and parts have it.
#[derive(Serialize)]
pub struct CaseWithPath<'a> {
    #[serde(flatten)]
    case: &'a CaseResult,
    #[serde(skip_serializing_if = "Option::is_none")]
    stored_path: Option<&'a StoredPath>,
}

impl<'a> CaseWithPath<'a> {
    /// A case with the path that it holds.
    pub fn of(case: &'a CaseResult) -> Self {
        CaseWithPath { case, stored_path: case.stored_path.as_deref() }
    }
}

/// The path of such a text.
#[derive(Deserialize)]
struct PathOf {
    stored_path: Option<StoredPath>,
}

/// Reads a case with its stored path.
///
/// # Errors
/// If the text is no case. A path that cannot be read is left out.
pub fn read_case(text: &[u8]) -> serde_json::Result<CaseResult> {
    const KEY: &[u8] = b"\"stored_path\":";
    let mut case: CaseResult = serde_json::from_slice(text)?;
    if text.windows(KEY.len()).any(|own| own == KEY) {
        let path = serde_json::from_slice::<PathOf>(text).ok();
        case.stored_path = path.and_then(|own| own.stored_path).map(Arc::new);
    }
    Ok(case)
}
