//! Runs one behaviour for another process; the tests of this crate start it. The command line is also such a program.

fn main() -> std::io::Result<()> {
    voussoir_external::serve()
}
