//! The files of a results folder, as `verify` gets them.

use std::io::Read;

/// The file from which all other files of a results folder are made.
pub const RESULTS: &str = "results.json";

/// The input of `verify`.
pub struct StoredResults<'a> {
    /// Number of cases in parallel.
    pub jobs: usize,
    /// Opens a file of the results folder, results.json or another; `None` if it does not exist.
    pub file: &'a dyn Fn(&str) -> Option<Box<dyn Read>>,
}

impl StoredResults<'_> {
    /// Opens results.json.
    pub fn results(&self) -> Result<Box<dyn Read>, String> {
        (self.file)(RESULTS).ok_or(format!("there is no {RESULTS}"))
    }

    /// Returns the text of a file.
    pub fn text(&self, name: &str) -> Result<String, String> {
        let mut text = String::new();
        let mut file = (self.file)(name).ok_or(format!("there is no {name}"))?;
        file.read_to_string(&mut text).map_err(|error| error.to_string())?;
        Ok(text)
    }
}
