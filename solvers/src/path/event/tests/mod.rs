//! Tests of event_path on scenes of two or three blocks.

mod continuations;
mod ends;
mod energy;
mod friction;
mod invariance;
mod settlement;
mod stack;
mod strength;
mod tipping;
mod wedge;
