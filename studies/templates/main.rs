//! `voussoir` with the laws of this crate.

use my_law as _; // Without this line the crate is not linked, and its laws are not registered.

fn main() -> std::process::ExitCode {
    voussoir::cli::main()
}
