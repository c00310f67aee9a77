//! Solvers of limit analysis (`limit`: chains, conic programs, sequences of them, non-associated flow), of paths
//! (`path`: from event to event, and steps by Newton's method), of limit analysis in space (`space`) and of one point of a law
//! (`point`).
//!
//! They use four folders that do not depend on assemblies: `optimise` (dense simplex, complementarity problems, cutting
//! planes), `linear` (sparse rows, factorisations that follow changes of few rows), `contact` (modes and yield polygon of
//! one contact point) and `rate` (the rate problem over the active set, for both path solvers). Solvers do not depend on
//! laws: limit analysis reads strengths of a joint ([`voussoir_core::law::JointStrength`]); paths read facets, or
//! tractions as functions of gaps.
#![forbid(unsafe_code)]

mod contact;
pub mod limit;
mod linear;
pub mod optimise;
pub mod path;
pub mod point;
mod rate;
mod settings;
pub mod space;

/// Tags of the solvers and continuation strategies of this crate. Two plug-ins with one tag are refused at start-up, so a
/// tag in this list cannot belong to anyone else.
pub const TAGS: &[&str] = &[
    "arc_length",
    "crack_opening",
    "displacement_control",
    "dissipation",
    "event_path",
    "limit_chain",
    "limit_cones",
    "limit_conic",
    "limit_least",
    "limit_sequential",
    "load_control",
    "newton_path",
];

#[cfg(test)]
mod tests {
    use super::TAGS;
    use voussoir_core::plugin::cards;

    #[test]
    fn the_list_of_tags_is_that_of_the_cards_of_this_crate() {
        let mut tags: Vec<&str> = cards().iter().map(|card| card.tag).collect();
        tags.sort_unstable();
        assert_eq!(tags, TAGS);
    }
}
