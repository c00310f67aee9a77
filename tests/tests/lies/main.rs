//! Dishonest solvers and strategies: no certificate accepts a false statement.

mod conform;
mod endless;
mod files;
mod plug_ins;
mod run;
mod space;
