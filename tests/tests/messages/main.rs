//! Messages about wrong input, word for word.

mod book;
mod mistakes;
mod warnings;
