//! The check of a stored case by itself, before it is copied into other results.

use crate::path_proofs::check_stored_path;
use std::fmt;
use voussoir_core::limit::{LowerProofKind, Status};
use voussoir_core::plugin::{PluginKind, card};
use voussoir_study::caught::caught;
use voussoir_study::checks::case::verify_case;
use voussoir_study::results::CaseResult;
use voussoir_study::study::{Case, Study};

/// The extent to which the stored fields prove a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Backing {
    /// Forces and motion, or a ray, prove every claim.
    Proved,
    /// The last state of a path, or one end of a bracket, is proved. The history of the path, or the search for the other end, is
    /// not checked.
    Partly,
    /// No field is stored, so nothing is proved.
    OnTrust,
    /// It claims nothing.
    Stalled,
}

/// Checks a stored case: it must belong to the current study, and its stored fields must prove it.
///
/// # Errors
///
/// The findings in words.
pub fn backing(study: &Study, result: &CaseResult) -> Result<Backing, Vec<String>> {
    let check = || match study.case_of(&result.label) {
        None => Err(vec!["the study has no case with this id, variant and these parameters".into()]),
        Some(case) if case.hash() != result.label.case_hash => {
            Err(vec!["case_hash differs from the hash of this case of the study".into()])
        }
        Some(case) => match verify_case(&case, result) {
            findings if findings.is_empty() => match &result.stored_path {
                Some(path) => {
                    let path = path.numbers().map_err(|why| vec![format!("its stored path cannot be read: {why}")])?;
                    check_stored_path(&case, result, &path).map(|_| Backing::Proved).map_err(|why| vec![why])
                }
                None => Ok(backing_of(&case, result)),
            },
            findings => Err(findings),
        },
    };
    caught(check).unwrap_or_else(|why| Err(vec![why]))
}

fn backing_of(case: &Case, result: &CaseResult) -> Backing {
    let searched = result.non_associated.lower_proof.as_ref().is_some_and(|proof| proof.by == LowerProofKind::Search);
    if result.status == Status::Stalled {
        Backing::Stalled
    } else if !case.output_fields && result.has_no_fields() {
        Backing::OnTrust
    } else if searched || card(PluginKind::PathSolver, &result.solver).is_some() {
        Backing::Partly
    } else {
        Backing::Proved
    }
}

/// The number of stored cases that are proved, partly proved, or unproved.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct BackingCount {
    proved: usize,
    partly: usize,
    on_trust: usize,
    stalled: usize,
}

impl BackingCount {
    /// Counts a case.
    pub fn add(&mut self, backing: Backing) {
        *match backing {
            Backing::Proved => &mut self.proved,
            Backing::Partly => &mut self.partly,
            Backing::OnTrust => &mut self.on_trust,
            Backing::Stalled => &mut self.stalled,
        } += 1;
    }
}

impl fmt::Display for BackingCount {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{} proved by their stored fields", self.proved)?;
        if self.partly > 0 {
            write!(f, ", {} in part (the history of a path or a search is taken on trust)", self.partly)?;
        }
        write!(f, ", {} taken on trust", self.on_trust)?;
        if self.on_trust > 0 {
            write!(f, " (no fields are stored)")?;
        }
        if self.stalled > 0 { write!(f, ", {} stalled", self.stalled) } else { Ok(()) }
    }
}

/// Returns lines about stored cases that are kept, and about stored cases that are refused.
pub fn resumed(kept: usize, count: BackingCount, refused: usize) -> Vec<String> {
    let kept = (kept > 0).then(|| format!("{kept} finished cases are kept: {count}"));
    let refused = (refused > 0).then(|| {
        format!("{refused} finished cases do not hold, or answer another version of the study; they are not kept")
    });
    kept.into_iter().chain(refused).collect()
}
