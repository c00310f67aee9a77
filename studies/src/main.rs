//! The program `voussoir`.

fn main() -> std::process::ExitCode {
    voussoir::cli::main()
}
