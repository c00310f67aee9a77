//! Paths as pieces between located events.
//!
//! Within a piece the modes of all contact points are fixed, and the state follows smooth equations F(x, λ) = 0
//! ([`corrector`]). [`Monitors`](monitors::Monitors) detect the end of a mode, and [`advance`] locates it. There the
//! rate problem gives the modes of the next piece ([`switch`]), and [`loading_set`] the yielding blocks and bonds.
//! [`driver`] joins pieces up to their [`end`].

mod advance;
mod begin;
mod bifurcation;
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
