//! A study with sliders in the browser: controls from the schema and the cards, results as data for the script of the page, and
//! the page. `voussoir serve` connects them to a browser.

mod answer;
mod controls;
mod critical;
mod handles;
mod page;
mod runs;
#[cfg(test)]
mod safe_pages;
mod session;
mod swap;

pub use session::{Asked, Session};
