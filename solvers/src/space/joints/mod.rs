//! Collapse in space with the laws' own flow, found by rigid blocks on elastic joints.
//!
//! The dead load is applied at zero stress, then the power of the live load grows in steps (`course`). Each step is one implicit step
//! of joints with friction, solved by semismooth Newton iterations (`step`) on the response of single points (`point`). As steps grow, the
//! elastic deformation becomes a vanishing share of them; the forces become constant and the motion a mechanism. That end is a collapse
//! state with the laws' own flow. Other courses start at guesses from programs with fictitious cohesion (`rigid`). If a course or a guess is
//! only near a state, a state with the same parts of all points may exist (`refine`). A mechanism may have states at lower factors (`least`).
//! If a stage has an end, smaller steps from zero stress decide if joints carry the loads there (`loading`).

mod answer;
mod course;
mod descent;
mod least;
mod loading;
mod point;
mod refine;
mod rigid;
mod standard;
mod step;

pub use self::answer::answer;
