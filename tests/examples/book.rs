//! Writes the sources of the book: `cargo run --release -p voussoir-tests --example book -- target/book`, then
//! `mdbook build target/book`.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use voussoir_tests::book::{book, gallery};

fn main() -> std::io::Result<()> {
    let to = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "target/book".into()));
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let sources = to.join("src");
    fs::create_dir_all(&sources)?;
    fs::copy(root.join("docs/book.toml"), to.join("book.toml"))?;
    for (name, page) in book() {
        write(&sources.join(name), page.as_bytes())?;
    }
    copy_figures(&root.join("docs"), &sources)?;
    draw_gallery(&root, &to)
}

fn write(path: &Path, content: &[u8]) -> std::io::Result<()> {
    fs::create_dir_all(path.parent().unwrap_or(path))?;
    fs::write(path, content)
}

/// Copies all SVG files below a folder.
fn copy_figures(from: &Path, to: &Path) -> std::io::Result<()> {
    for entry in fs::read_dir(from)? {
        let path = entry?.path();
        let target = to.join(path.file_name().unwrap_or_default());
        if path.is_dir() {
            copy_figures(&path, &target)?;
        } else if path.extension().is_some_and(|ending| ending == "svg") {
            write(&target, &fs::read(path)?)?;
        }
    }
    Ok(())
}

/// Runs the studies of the gallery that have no stored figure.
fn draw_gallery(root: &Path, to: &Path) -> std::io::Result<()> {
    for (study, figure, picture) in gallery::runs() {
        let folder = to.join("results").join(study);
        let mut arguments: Vec<OsString> = ["run", "--quiet", "--out"].map(OsString::from).to_vec();
        arguments.push(folder.clone().into());
        arguments.push(root.join("studies/cases").join(study).with_extension("toml").into());
        voussoir::cli::main_from(arguments).map_err(std::io::Error::other)?;
        write(&to.join("src").join(picture), &fs::read(folder.join("figures").join(figure))?)?;
    }
    Ok(())
}
