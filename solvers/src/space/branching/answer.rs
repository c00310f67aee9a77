//! The answer with a proved lower end.

use super::search::{Bracket, lower_bound, misfit};
use crate::space::settings::BRANCHING;
use voussoir_core::limit::{LimitQuestion, Status};
use voussoir_core::space::{SpaceAnswer, SpaceProblem};

/// Adds a proved lower end of the least load to the answer of a search of collapse states. The proof sweeps at most `most` matrix entries.
pub fn prove(problem: &SpaceProblem, question: LimitQuestion, mut answer: SpaceAnswer, most: u64) -> SpaceAnswer {
    let LimitQuestion::Collapse { start, .. } = question else { return answer };
    let Some(own) = answer.non_associated.as_mut().filter(|_| answer.status != Status::Stands) else { return answer };
    own.searched = Some(start);
    // No state is above the associated load.
    let Some(known) = answer.factor.or(own.associated_factor).filter(|known| *known > start) else {
        return answer;
    };
    if let Some(why) = misfit(problem) {
        answer.notes.push(format!("{why}: no lower end is proved"));
        return answer;
    }
    let Bracket { lower, parts, work } = lower_bound(problem, start, known, most);
    answer.counters.insert("search_parts".into(), parts);
    own.searched = Some(lower);
    let why = if work >= most { "the search ended at its limit" } else { "rounding ended the search" };
    let proved = lower > start;
    let note = match answer.factor {
        Some(_) if known - lower <= 2.0 * BRANCHING.gap * known.abs() => return answer,
        Some(_) if proved => format!(
            "the least load factor of the laws' own flow lies between {lower:.9} (proved) and {known:.9} (found): {why}"
        ),
        Some(_) => format!(
            "the least load factor of the laws' own flow is at most {known:.9} (found); no lower end is proved: {why}"
        ),
        None if proved => format!("no collapse state with the laws' own flow is below {lower:.9} (proved)"),
        None => format!("no lower end of the least load is proved: {why}"),
    };
    answer.notes.push(note);
    answer
}
