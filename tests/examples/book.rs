//! Writes the sources of the book: `cargo run --release -p voussoir-tests --example book -- target/book`, then
//! `mdbook build target/book`.

use std::fs;
use std::path::Path;

fn main() -> std::io::Result<()> {
    let to = std::env::args().nth(1).unwrap_or_else(|| "target/book".into());
    let (to, docs) = (Path::new(&to), Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs"));
    fs::create_dir_all(to.join("src"))?;
    fs::copy(docs.join("book.toml"), to.join("book.toml"))?;
    for (name, page) in voussoir_tests::book::book() {
        fs::write(to.join("src").join(name), page)?;
    }
    for entry in fs::read_dir(docs)? {
        let path = entry?.path();
        if path.extension().is_some_and(|ending| ending == "svg") {
            fs::copy(&path, to.join("src").join(path.file_name().unwrap_or_default()))?;
        }
    }
    Ok(())
}
