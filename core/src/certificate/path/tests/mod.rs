//! Checks of rates, mechanisms and increments on structures with one or two blocks that can be solved by hand.

mod chain;
mod derivatives;
mod ends;
mod point_modes;
mod scenes;
mod softening;
mod wedge;
