//! The command line of Voussoir.

fn main() -> std::process::ExitCode {
    voussoir::cli::main()
}
