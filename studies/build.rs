//! Compiles the origin of results into the program: target, commit, and a hash of its sources. Results store it, see
//! `results::Origin`.

#[path = "templates/fnv.rs"]
#[allow(dead_code, reason = "checksums of results have 128 bits too")]
mod fnv;

use fnv::Fnv64;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// Folders and files of the workspace with the sources of the program.
const SOURCES: [&str; 9] = [
    "Cargo.lock",
    "core",
    "laws",
    "solvers",
    "studies/plot/src",
    "studies/study/src",
    "studies/verify/src",
    "studies/report/src",
    "studies/src",
];

fn main() {
    let folder = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    println!("cargo::rerun-if-changed=build.rs");
    set("TARGET", &env::var("TARGET").unwrap_or_else(|_| "unknown".into()));
    set("COMMIT", &commit(&folder).or_else(|| packed(&folder)).unwrap_or_else(|| "unknown".into()));
    set("SOURCES", &folder.parent().and_then(sources).unwrap_or_else(|| "unknown".into()));
}

fn set(name: &str, value: &str) {
    println!("cargo::rustc-env=VOUSSOIR_{name}={value}");
}

/// The output of a git command in a folder.
fn git(folder: &Path, arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").arg("-C").arg(folder).args(arguments).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_string())
}

/// The commit of the repository that this file belongs to; `None` without git, or in another repository.
fn commit(folder: &Path) -> Option<String> {
    git(folder, &["ls-files", "--error-unmatch", "build.rs"])?;
    // The log of HEAD changes with each commit and each change of the branch.
    for name in ["HEAD", "logs/HEAD"] {
        let file = folder.join(git(folder, &["rev-parse", "--git-path", name])?);
        if file.exists() {
            println!("cargo::rerun-if-changed={}", file.display());
        }
    }
    git(folder, &["rev-parse", "HEAD"])
}

/// The commit that Cargo wrote into a package: `{"git": {"sha1": "…"}}`.
fn packed(folder: &Path) -> Option<String> {
    let text = fs::read_to_string(folder.join(".cargo_vcs_info.json")).ok()?;
    let after = text.split("\"sha1\"").nth(1)?;
    after.split('"').nth(1).filter(|commit| commit.len() == 40).map(Into::into)
}

/// A hash of all sources; `None` if the crates of the workspace are not in one folder.
fn sources(workspace: &Path) -> Option<String> {
    let mut files = Vec::new();
    for name in SOURCES {
        let path = workspace.join(name);
        println!("cargo::rerun-if-changed={}", path.display());
        collect(&path, &mut files)?;
    }
    files.sort();
    let mut hash = Fnv64::new();
    for file in files {
        hash.add(file.strip_prefix(workspace).ok()?.to_str()?.as_bytes());
        hash.add(&fs::read(&file).ok()?);
    }
    Some(hash.text())
}

/// The file, or all files below the folder. Licences are links, which some systems do not check out as links.
fn collect(path: &Path, files: &mut Vec<PathBuf>) -> Option<()> {
    if path.file_name()?.to_string_lossy().starts_with("LICENSE") {
        return Some(());
    }
    if path.is_file() {
        files.push(path.into());
        return Some(());
    }
    for entry in fs::read_dir(path).ok()? {
        collect(&entry.ok()?.path(), files)?;
    }
    Some(())
}
