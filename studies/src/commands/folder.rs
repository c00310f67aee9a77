//! A result folder. Only one run at a time can write to it. Each file is written completely or not at all, and symbolic
//! links are never followed. The list of files in results.json names the files of a run; all other files are left
//! unchanged.

use super::error::CliError;
use serde_json::Value as Json;
use std::collections::BTreeSet;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, BufWriter, ErrorKind, Read, Write};
use std::path::{Component, Path, PathBuf};
use voussoir_report::kinds::read_head;
use voussoir_report::writers::files::{Files, OutputFile};
use voussoir_study::regular_file::open_regular;

/// Finished cases during a run, one line of JSON each.
pub const JOURNAL: &str = "unfinished.jsonl";
/// Lock file of the run that writes. The operating system releases the lock when the process ends for any reason.
const LOCK: &str = ".voussoir.lock";
/// Files that every run writes; they are not in the list of files.
const OWN: [&str; 2] = ["results.json", "resolved.toml"];
/// Greatest length of a file that is read into memory.
const MAX_HELD_BYTES: u64 = 4 << 30;
/// Greatest length of a file that is read in one pass.
const MAX_BYTES: u64 = 1 << 40;

/// The folder that a run writes into. While this value exists, no other run can write there.
pub struct ResultFolder {
    path: PathBuf,
    lock: File,
    /// Files of the run before this one; `None` if its study is there but its results.json is missing.
    earlier: Option<BTreeSet<String>>,
}

/// Refuses symbolic links, pipes and devices. Accepts a path that does not exist.
fn no_link(path: &Path) -> io::Result<()> {
    let refused = |why: &str| Err(io::Error::other(format!("cannot write {}: {why}", path.display())));
    match fs::symlink_metadata(path) {
        Ok(found) if found.file_type().is_symlink() => {
            refused("it is a symbolic link, and nothing is written through one; give the place it leads to")
        }
        Ok(found) if !found.is_file() && !found.is_dir() => refused("it is neither a regular file nor a folder"),
        _ => Ok(()),
    }
}

/// Adds the name of the file to an error.
fn about(path: &Path) -> impl Fn(io::Error) -> io::Error {
    move |error| io::Error::new(error.kind(), format!("cannot write {}: {error}", path.display()))
}

/// Names of the entries of a folder, in order; empty if the folder cannot be read.
fn entries(path: &Path) -> Vec<String> {
    let listed = fs::read_dir(path).into_iter().flatten().flatten();
    let mut names: Vec<String> = listed.filter_map(|entry| entry.file_name().into_string().ok()).collect();
    names.sort();
    names
}

/// Locks a folder. Returns an error if another run has the lock.
fn locked(path: &Path) -> Result<File, CliError> {
    let place = path.join(LOCK);
    // A run removes the lock file when it ends: a lock on a removed file is not valid.
    for _ in 0..100 {
        let open = OpenOptions::new().create(true).append(true).open(&place);
        let file = open.map_err(|error| CliError::unwritten(&place, error))?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                let why = "another run is writing into it; wait for it, or give another --out";
                return Err(CliError::unwritten(path, why));
            }
            // The file system does not support locks.
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

/// The files that the results.json of a folder names: relative paths below the folder, without the files of every run.
/// `None` if the folder has a resolved study but no results.json.
fn listed(path: &Path) -> Option<BTreeSet<String>> {
    let head = open_regular(&path.join("results.json"), MAX_BYTES).map(read_head).unwrap_or_default();
    if !head.contains_key("files") && path.join("resolved.toml").exists() {
        return None;
    }
    let names = head.get("files").and_then(Json::as_array).into_iter().flatten().filter_map(Json::as_str);
    let below = |name: &&str| {
        let inside = Path::new(name).components().all(|part| matches!(part, Component::Normal(_)));
        inside && !name.is_empty() && !OWN.contains(name) && ![JOURNAL, LOCK].contains(name)
    };
    Some(names.filter(below).map(String::from).collect())
}

impl ResultFolder {
    /// Opens a folder for a run and creates it if necessary.
    pub fn open(path: &Path) -> Result<Self, CliError> {
        no_link(path).map_err(CliError::of_io)?;
        fs::create_dir_all(path).map_err(|error| CliError::unwritten(path, error))?;
        entries(path).iter().try_for_each(|name| no_link(&path.join(name))).map_err(CliError::of_io)?;
        let lock = locked(path)?;
        let folder = ResultFolder { path: path.into(), lock, earlier: listed(path) };
        // Checked now, so that the error is reported before hours of solving.
        folder.earlier.iter().flatten().try_for_each(|name| folder.no_link_to(name)).map_err(CliError::of_io)?;
        Ok(folder)
    }

    /// The path of the folder.
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

    /// A file in it; `None` if it cannot be opened.
    pub fn opened(&self, name: &str) -> Option<File> {
        open_regular(&self.path.join(name), MAX_BYTES).ok()
    }

    /// Renames an incomplete part to the journal of its run, unless there is a journal.
    pub fn part_becomes_journal(&self, part: &str) {
        let journal = self.path.join(JOURNAL);
        if !journal.exists() {
            drop(fs::rename(self.path.join(part), journal));
        }
    }

    /// Refuses a symbolic link in any part of the path of a file.
    fn no_link_to(&self, name: &str) -> io::Result<()> {
        let mut place = self.path.clone();
        Path::new(name).components().try_for_each(|part| {
            place.push(part);
            no_link(&place)
        })
    }

    /// Writes a file completely or not at all; creates missing folders.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), CliError> {
        Files::write(self, name, bytes).map_err(CliError::of_io)
    }

    /// Begins a file under a temporary name; it is renamed when it is complete. Creates missing folders.
    pub fn aside(&self, name: &str) -> io::Result<Aside> {
        let place = self.path.join(name);
        self.no_link_to(name)?;
        if let Some(folder) = place.parent() {
            fs::create_dir_all(folder).map_err(about(folder))?;
        }
        let aside = self.path.join(format!("{name}.tmp"));
        // A killed run may have left the temporary file. A link is removed, not followed.
        drop(fs::remove_file(&aside));
        let file = OpenOptions::new().write(true).create_new(true).open(&aside).map_err(about(&place))?;
        Ok(Aside { file: BufWriter::with_capacity(1 << 16, file), aside, place })
    }

    /// Removes a file of the previous run.
    pub fn remove(&self, name: &str) {
        drop(fs::remove_file(self.path.join(name)));
    }

    /// Opens the journal; keeps the lines of the previous run if `keep` is true.
    pub fn journal(&self, keep: bool) -> io::Result<File> {
        let place = self.path.join(JOURNAL);
        if !keep {
            drop(fs::remove_file(&place));
        }
        no_link(&place)?;
        OpenOptions::new().create(true).append(true).open(&place)
    }

    /// Prepares the folder for the files of a run: removes the files that the previous run wrote and this run does not
    /// write.
    /// A file that results.json does not name belongs to the user. Without results.json the two cannot be distinguished,
    /// and nothing is removed.
    ///
    /// # Errors
    /// If a file of this run would overwrite such a file.
    pub fn make_room(&self, names: &[String]) -> io::Result<()> {
        let Some(earlier) = &self.earlier else { return Ok(()) };
        let foreign = |name: &&String| !earlier.contains(*name) && self.path.join(name).exists();
        if let Some(name) = names.iter().find(foreign) {
            return Err(io::Error::other(format!(
                "cannot write {}: no run has written the file that is there; move it away or give another --out (with \
                 --resume, finished cases are not solved again)",
                self.path.join(name).display()
            )));
        }
        for name in earlier.iter().filter(|name| !names.contains(name)) {
            self.remove(name);
            let folders = Path::new(name).ancestors().skip(1).filter(|folder| *folder != Path::new(""));
            // Folders that are not empty are kept.
            folders.for_each(|folder| drop(fs::remove_dir(self.path.join(folder))));
        }
        // Temporary files of a run that was killed while writing.
        earlier.iter().for_each(|name| self.remove(&format!("{name}.tmp")));
        Ok(())
    }
}

impl Files for ResultFolder {
    fn begin(&self, name: &str) -> io::Result<Option<Box<dyn OutputFile + '_>>> {
        Ok(Some(Box::new(self.aside(name)?)))
    }
}

/// A file under a temporary name until it is complete.
pub struct Aside {
    file: BufWriter<File>,
    aside: PathBuf,
    place: PathBuf,
}

impl Write for Aside {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes).map_err(about(&self.place))
    }

    // Text arrives in pieces of a few bytes.
    #[inline]
    fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.file.write_all(bytes).map_err(about(&self.place))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush().map_err(about(&self.place))
    }
}

impl OutputFile for Aside {
    fn done(mut self: Box<Self>) -> io::Result<()> {
        self.flush()?;
        let named = self.file.get_ref().sync_data().and_then(|()| fs::rename(&self.aside, &self.place));
        named.map_err(about(&self.place))
    }
}

impl Drop for Aside {
    /// Removes an incomplete file.
    fn drop(&mut self) {
        drop(fs::remove_file(&self.aside));
    }
}

impl Drop for ResultFolder {
    fn drop(&mut self) {
        drop(fs::remove_file(self.path.join(LOCK)));
        drop(self.lock.unlock());
    }
}
