//! A proved lower end of the loads at which a few blocks can collapse with the laws' own flow: branching over modes.
//!
//! In a state each point is open and carries nothing, or it sticks, or it slips in some direction d and carries n (1, −μ d). If modes and
//! directions are given, the conditions of forces and of motions are independent of each other. A *part* of the search gives some
//! points a mode, and slipping points a sector of directions. It has no state below a factor if no forces or no motions fit:
//!
//! - forces: a slipping point carries a force between the ends of the arc against its sector and tangents of the arc; other points
//!   that carry have tangents of the circle as their friction (`statics`). All these sets contain the true ones, so the least factor of
//!   this linear program is a lower bound.
//! - motions: closed points do not open, slips are within their sectors, the live load has positive power, and the dissipation is not
//!   negative (`motions`). Two linear programs for each point narrow its sector to the directions of these motions.
//!
//! The part with the least bound is divided (`search`): first by contacts, which rest or move with a vertex, an edge, all points or no
//! point closed, then at the point whose force and slip fit least. The search ends if all parts have bounds above the known state, except
//! for the gap that is accepted, or if the work is used up. The least bound is proved in both cases. Only joints without dilatancy are
//! searched.

mod answer;
mod motions;
mod points;
mod search;
mod statics;

pub use self::answer::prove;
#[cfg(test)]
pub use self::search::lower_bound;
