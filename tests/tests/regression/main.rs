//! Our last answers: counts of work, and difficult scenes.

mod corners;
mod counters;
