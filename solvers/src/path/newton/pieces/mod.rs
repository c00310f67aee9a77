//! Paths as pieces between located events.
//!
//! Within a piece the modes of all contact points are fixed, and the state follows smooth equations F(x, λ) = 0
//! ([`corrector`]). [`Monitors`](monitors::Monitors) find where a mode ends ([`advance`]). There the rate problem
//! gives the modes of the next piece ([`switch`]), and [`loading_set`] the blocks and bonds that yield in it. [`driver`] puts
//! pieces together until their [`end`].

mod advance;
mod begin;
mod corner;
mod corrector;
pub(super) mod driver;
mod end;
mod loading_set;
mod monitors;
mod other_branches;
mod piece;
mod plateau;
mod ray;
mod switch;

#[cfg(test)]
mod tests;
