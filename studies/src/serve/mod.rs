//! A study with sliders in the browser: sliders from the schema, results as data for the script of the page, and the page.
//! These are pure functions; `voussoir serve` connects them to a browser.

mod answer;
mod controls;
mod handles;
mod page;
mod session;

pub use session::{Asked, Session};
