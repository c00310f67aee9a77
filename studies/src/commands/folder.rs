//! A result folder: one run at a time, files whole or not at all, nothing through symbolic links.

use super::error::CliError;
use crate::regular_file::open_regular;
use crate::results::stored_path::PATH_PROOFS;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{BufWriter, ErrorKind, Read, Write};
use std::path::{Path, PathBuf};

/// Cases that are finished, a line of JSON each, while a run is under way.
pub const JOURNAL: &str = "unfinished.jsonl";
/// Held by the run that writes; the operating system lets go of it however that run ends.
const LOCK: &str = ".voussoir.lock";
/// Greatest length of a file that is read as a whole.
const MAX_HELD_BYTES: u64 = 4 << 30;
/// Folders that writers fill.
const FILLED: [&str; 2] = ["figures", "vtu"];

/// The folder that a run writes into; no other run can, while this one lives.
pub struct ResultFolder {
    path: PathBuf,
    lock: File,
}

/// Refuses a symbolic link, a pipe and a device. A path that does not exist passes.
fn no_link(path: &Path) -> Result<(), CliError> {
    match fs::symlink_metadata(path) {
        Ok(found) if !found.is_file() && !found.is_dir() && !found.file_type().is_symlink() => {
            Err(CliError::unwritten(path, "it is neither a regular file nor a folder"))
        }
        Ok(found) if found.file_type().is_symlink() => Err(CliError::unwritten(
            path,
            "it is a symbolic link, and nothing is written through one; give the place it leads to",
        )),
        _ => Ok(()),
    }
}

/// Names of the entries of a folder, in order; none where it cannot be read.
fn entries(path: &Path) -> Vec<String> {
    let listed = fs::read_dir(path).into_iter().flatten().flatten();
    let mut names: Vec<String> = listed.filter_map(|entry| entry.file_name().into_string().ok()).collect();
    names.sort();
    names
}

/// The lock on a folder: an error where another run has it.
fn locked(path: &Path) -> Result<File, CliError> {
    let place = path.join(LOCK);
    // A run that ends removes the file: a lock on what is no longer there is none.
    for _ in 0..100 {
        let file = OpenOptions::new()
            .create(true)
            .append(true)
            .open(&place)
            .map_err(|error| CliError::unwritten(&place, error))?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                return Err(CliError::unwritten(
                    path,
                    "another run is writing into it; wait for it, or give another --out",
                ));
            }
            // A file system without locks.
            Err(TryLockError::Error(error)) if error.kind() == ErrorKind::Unsupported => {}
            Err(TryLockError::Error(error)) => return Err(CliError::unwritten(&place, error)),
        }
        if is_same(&file, &place) {
            return Ok(file);
        }
    }
    Err(CliError::unwritten(path, "other runs go on writing into it"))
}

#[cfg(unix)]
fn is_same(file: &File, place: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let number = |found: fs::Metadata| (found.dev(), found.ino());
    file.metadata().ok().map(number) == fs::symlink_metadata(place).ok().map(number)
}

#[cfg(not(unix))]
fn is_same(_: &File, place: &Path) -> bool {
    place.exists()
}

impl ResultFolder {
    /// Opens a folder for a run, and makes it if need be.
    pub fn open(path: &Path) -> Result<Self, CliError> {
        no_link(path)?;
        fs::create_dir_all(path).map_err(|error| CliError::unwritten(path, error))?;
        for name in entries(path) {
            no_link(&path.join(&name))?;
        }
        for folder in FILLED {
            for name in entries(&path.join(folder)) {
                no_link(&path.join(folder).join(name))?;
            }
        }
        Ok(ResultFolder { path: path.into(), lock: locked(path)? })
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The text of a file in it; empty if the file does not exist or is not text.
    pub fn read(&self, name: &str) -> String {
        let mut text = String::new();
        let read =
            open_regular(&self.path.join(name), MAX_HELD_BYTES).and_then(|mut file| file.read_to_string(&mut text));
        if read.is_ok() { text } else { String::new() }
    }

    /// Makes a part that is not whole the journal of its run, unless there is one.
    pub fn part_becomes_journal(&self, part: &str) {
        let journal = self.path.join(JOURNAL);
        if !journal.exists() {
            drop(fs::rename(self.path.join(part), journal));
        }
    }

    /// Writes a file whole or not at all; folders on the way are made.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), CliError> {
        let mut file = self.aside(name)?;
        let written = file.write_all(bytes);
        file.done(written)
    }

    /// Begins a file that gets its name when it is done; folders on the way are made.
    pub fn aside(&self, name: &str) -> Result<Aside, CliError> {
        let place = self.path.join(name);
        let mut folder = self.path.clone();
        for part in Path::new(name).parent().into_iter().flat_map(Path::components) {
            folder.push(part);
            no_link(&folder)?;
            match fs::create_dir(&folder) {
                Err(error) if error.kind() != ErrorKind::AlreadyExists => {
                    return Err(CliError::unwritten(&folder, error));
                }
                _ => {}
            }
        }
        no_link(&place)?;
        let aside = self.path.join(format!("{name}.tmp"));
        // Left behind by a run that was killed; a link is removed, not followed.
        drop(fs::remove_file(&aside));
        match OpenOptions::new().write(true).create_new(true).open(&aside) {
            Ok(file) => Ok(Aside { file: BufWriter::with_capacity(1 << 16, file), aside, place }),
            Err(error) => Err(CliError::unwritten(&place, error)),
        }
    }

    /// Removes a file that a run before this one has left.
    pub fn remove(&self, name: &str) {
        drop(fs::remove_file(self.path.join(name)));
    }

    /// Opens the journal; what a run before it left stays if `keep`. `None` where it cannot be written: that costs
    /// only the chance to go on after an interruption.
    pub fn journal(&self, keep: bool) -> Option<File> {
        let place = self.path.join(JOURNAL);
        if !keep {
            drop(fs::remove_file(&place));
        }
        no_link(&place).ok()?;
        OpenOptions::new().create(true).append(true).open(&place).ok()
    }

    /// Removes what earlier runs have left: the journal, and files that writers name as they please but did not
    /// write this time.
    pub fn remove_left_over(&self, written: &[(String, Vec<u8>)]) {
        self.remove(JOURNAL);
        for name in named_by_writers(&self.path) {
            if written.iter().all(|(kept, _)| *kept != name) {
                drop(fs::remove_file(self.path.join(&name)));
            }
        }
        FILLED.iter().for_each(|folder| drop(fs::remove_dir(self.path.join(folder))));
    }
}

/// Files of a folder that have names which writers give, but for results.json.
pub fn named_by_writers(path: &Path) -> Vec<String> {
    let top = [
        "results.csv",
        "results.parquet",
        "curve.csv",
        "comparison.csv",
        "joints.csv",
        "sensitivities.csv",
        "report.html",
        PATH_PROOFS,
    ];
    let top = top.map(String::from);
    let filled = FILLED.into_iter().flat_map(|folder| {
        let names = entries(&path.join(folder)).into_iter().map(move |name| format!("{folder}/{name}"));
        names.collect::<Vec<_>>()
    });
    let there = |name: &String| path.join(name).exists();
    top.into_iter().filter(there).chain(filled.filter(|name| of_a_writer(name))).collect()
}

/// A file under another name until it is whole.
pub struct Aside {
    file: BufWriter<File>,
    aside: PathBuf,
    place: PathBuf,
}

impl Write for Aside {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.file.write(bytes)
    }

    // Text comes in pieces of a few bytes.
    #[inline]
    fn write_all(&mut self, bytes: &[u8]) -> std::io::Result<()> {
        self.file.write_all(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.file.flush()
    }
}

impl Aside {
    /// Gives the file its name if all was `written`, else removes it and says why.
    pub fn done(mut self, written: std::io::Result<()>) -> Result<(), CliError> {
        let attempt = written.and_then(|()| self.file.flush()).and_then(|()| {
            self.file.get_ref().sync_data()?;
            fs::rename(&self.aside, &self.place)
        });
        attempt.map_err(|error| {
            drop(fs::remove_file(&self.aside));
            CliError::unwritten(&self.place, error)
        })
    }
}

impl ResultFolder {
    /// Removes what earlier runs have drawn or tabulated, but for results.json and results.csv.
    pub fn remove_drawn(&self) {
        let csv = ("results.csv".to_string(), Vec::new());
        self.remove_left_over(&[csv]);
    }
}

impl Drop for ResultFolder {
    fn drop(&mut self) {
        drop(fs::remove_file(self.path.join(LOCK)));
        drop(self.lock.unlock());
    }
}

/// Whether a file in a folder that writers fill has a name of theirs; what a user has put there stays.
fn of_a_writer(name: &str) -> bool {
    let (folder, file) = name.split_once('/').unwrap_or_default();
    let stem = file.strip_suffix(".tmp").unwrap_or(file);
    match folder {
        "figures" => stem.strip_suffix(".svg").is_some_and(|stem| {
            let numbered = |start: &str| {
                stem.strip_prefix(start).and_then(|rest| rest.chars().next()).is_some_and(|c| c.is_ascii_digit())
            };
            ["sweep", "curve", "map", "comparison", "envelope", "moving-load", "path"].contains(&stem)
                || numbered("case-")
                || numbered("curve-")
                || stem.starts_with("chart-")
        }),
        _ => stem.starts_with("case-") && stem.ends_with(".vtu") || ["cases.pvd", "README.txt"].contains(&stem),
    }
}
