//! Study kinds: what is done with the cases of a study.

pub mod compare;
pub mod map;
pub mod point;
pub mod run;

use crate::results::{CaseResult, Comparison};
use crate::study::{Outline, Study};
use voussoir_core::plugin::Diagnostic;

/// Where the path of a case has come to.
#[derive(Debug, Clone, Copy)]
pub struct OnPath<'a> {
    /// Id of the case.
    pub case: usize,
    /// Name of the stage.
    pub stage: &'a str,
    /// Whether the stage's change of gravity grows, not its loads.
    pub gravity: bool,
    /// Factor of what grows.
    pub factor: f64,
    /// States in equilibrium so far: events of an exact path, steps of others.
    pub states: u64,
}

/// Follows a study while it is worked on; libraries never print.
pub trait Observer: Sync {
    /// A case is answered.
    fn answered(&self, case: &CaseResult);

    /// A path has reached its next state; called often. Changes nothing.
    fn on_path(&self, at: &OnPath) {
        let _ = at;
    }
}

/// A kind of study, chosen by `kind = …`. Instances register with
/// `inventory::submit! { KindEntry { … } }` beside their card.
pub trait StudyKind: Sync {
    /// Answers the cases of a study whose ids are in `wanted`, in order of id. `jobs` cases side by
    /// side; the results do not depend on it.
    fn answer(&self, study: &Study, wanted: &[usize], jobs: usize, observer: &dyn Observer) -> Vec<CaseResult>;

    /// Mistakes in a study's axes and in the table of this kind, beyond those of single keys.
    fn check(&self, outline: &Outline) -> Vec<Diagnostic> {
        let _ = outline;
        Vec::new()
    }

    /// The cases beside each other, where this kind compares them; a pure function of its arguments,
    /// so that `verify` can repeat it.
    fn compare(&self, study: &Study, cases: &[CaseResult]) -> Option<Comparison> {
        let _ = (study, cases);
        None
    }
}

/// Connects a tag with a study kind.
pub struct KindEntry {
    /// The tag of its card.
    pub tag: &'static str,
    /// What answers.
    pub kind: &'static dyn StudyKind,
}

voussoir_core::inventory::collect!(KindEntry);

/// The study kind with this tag.
pub fn kind(tag: &str) -> Option<&'static dyn StudyKind> {
    voussoir_core::inventory::iter::<KindEntry>.into_iter().find(|entry| entry.tag == tag).map(|entry| entry.kind)
}
