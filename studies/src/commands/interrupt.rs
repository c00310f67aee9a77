//! Ctrl-C: what is finished stays, and how to go on is said.

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

/// Catches Ctrl-C from now on; `arguments` are those after the program's name that go on with what is interrupted.
pub fn catch(arguments: &[String]) {
    let command = arguments.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" ");
    if let Ok(mut own) = COMMAND.lock() {
        *own = Some(command);
    }
    // Where signals cannot be caught the journal still keeps what is finished.
    drop(ctrlc::set_handler(|| {
        let journal = JOURNAL.lock().map(|own| own.upgrade()).unwrap_or_default();
        // Held until the end: what is finished from now on is not counted.
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

/// Where finished cases are kept.
pub fn keeps(journal: &Arc<Mutex<Option<Journal>>>) {
    if let Ok(mut own) = JOURNAL.lock() {
        *own = Arc::downgrade(journal);
    }
}

/// So many cases are going to be solved.
pub fn begins(cases: usize) {
    ALL.store(cases, Ordering::Relaxed);
    FINISHED.store(0, Ordering::Relaxed);
}

/// One more case is finished.
pub fn finished() {
    FINISHED.fetch_add(1, Ordering::Relaxed);
}

/// A word as a shell takes it.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=:,+@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) { word.into() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}
