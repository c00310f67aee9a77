//! Greatest sizes of an input, so that no file and no argument exhausts the stack or the memory.

/// Deepest nesting of tables and lists, and the greatest number of segments of a dotted key.
pub const MAX_DEPTH: usize = 64;
/// Greatest size of a file that is read as a whole \[bytes\].
pub const MAX_FILE_BYTES: u64 = 256 << 20;
/// Greatest number of mistakes that are printed for one file.
pub const MAX_MISTAKES_PRINTED: usize = 100;
/// Greatest length of a message or a key in a message \[characters\]; longer ones are shortened in the middle.
pub const MAX_MESSAGE: usize = 1000;
