//! A study that is looked at while its numbers change: sliders from the schema, answers as data for the page's
//! script, and the page. Pure functions; `voussoir serve` brings them to a browser.

mod answer;
mod controls;
mod handles;
mod page;
mod session;

pub use session::{Asked, Session};
