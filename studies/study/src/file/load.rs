//! From the text of a study file to a [`Study`]. The error contains all mistakes of the file.

use super::study_file::StudyFile;
use crate::study::{Study, StudyError, StudySource};

/// Reads a study. `file` is its name in messages, `sets` the `--set KEY=VALUE` of the command line; a value that is not
/// valid TOML is a text.
pub fn load(text: &str, file: &str, sets: &[(String, String)]) -> Result<Study, StudyError> {
    Study::from_source(StudySource::parse(text, file, sets)?)
}

impl Study {
    /// Returns the study of a source.
    pub fn from_source(source: StudySource) -> Result<Study, StudyError> {
        StudyFile::read(source)?.study()
    }

    /// Like [`Study::from_source`], but keeps no cases of a study with more than [`super::HELD`] cases.
    pub fn from_source_in_turn(source: StudySource) -> Result<Study, StudyError> {
        StudyFile::read(source)?.study_in_turn()
    }
}
