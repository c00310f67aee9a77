//! Ctrl-C: finished cases are kept, and a message shows the command that continues.

use super::journal::Journal;
use super::print::complain;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, Weak};

/// The exit code of a program that was interrupted.
const INTERRUPTED: i32 = 130;

static COMMAND: Mutex<Option<String>> = Mutex::new(None);
static JOURNAL: Mutex<Weak<Mutex<Option<Journal>>>> = Mutex::new(Weak::new());
static FINISHED: AtomicUsize = AtomicUsize::new(0);
static ALL: AtomicUsize = AtomicUsize::new(0);

/// Handles Ctrl-C from now on. `arguments` are the arguments after the program's name that continue the interrupted
/// run.
pub fn catch(arguments: &[String]) {
    let command = arguments.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" ");
    if let Ok(mut own) = COMMAND.lock() {
        *own = Some(command);
    }
    // If signals cannot be caught, the journal still keeps the finished cases.
    drop(ctrlc::set_handler(|| {
        let journal = JOURNAL.lock().map(|own| own.upgrade()).unwrap_or_default();
        // The lock is held until the process ends: cases that finish from now on are not counted.
        let mut journal = journal.as_ref().and_then(|own| own.lock().ok());
        if let Some(Err(error)) = journal.as_mut().and_then(|own| own.as_mut()).map(Journal::write) {
            complain(format_args!("voussoir: the journal of finished cases cannot be written: {error}"));
        }
        let (finished, all) = (FINISHED.load(Ordering::Relaxed), ALL.load(Ordering::Relaxed));
        let command = COMMAND.lock().ok().and_then(|own| own.clone()).unwrap_or_default();
        complain(format_args!(
            "\nvoussoir: interrupted; {finished} of {all} cases are finished and kept. Go on with\n  voussoir {command}"
        ));
        std::process::exit(INTERRUPTED);
    }));
}

/// Sets the journal that stores finished cases.
pub fn keeps(journal: &Arc<Mutex<Option<Journal>>>) {
    if let Ok(mut own) = JOURNAL.lock() {
        *own = Arc::downgrade(journal);
    }
}

/// Sets the number of cases to solve.
pub fn begins(cases: usize) {
    ALL.store(cases, Ordering::Relaxed);
    FINISHED.store(0, Ordering::Relaxed);
}

/// Counts one more finished case.
pub fn finished() {
    FINISHED.fetch_add(1, Ordering::Relaxed);
}

/// Quotes a word for a shell.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=:,+@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) { word.into() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}
