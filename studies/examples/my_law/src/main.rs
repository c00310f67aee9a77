//! `voussoir` with the laws of this crate.

use my_law as _; // A crate that no source names registers nothing.

fn main() -> std::process::ExitCode {
    voussoir::cli::main()
}
