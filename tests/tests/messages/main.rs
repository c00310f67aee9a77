//! What is said about wrong input, word for word.

mod mistakes;
mod warnings;
