//! Progress on a terminal, and the journal of finished cases for `--resume`.

use super::interrupt;
use super::journal::Journal;
use super::print::say_data;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::collections::BTreeSet;
use std::fs::File;
use std::io::{Error, Result};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Instant;
use voussoir_study::cases::{Observer, PathProgress};
use voussoir_study::results::CaseResult;
use voussoir_study::results::case_with_path::CaseWithPath;
use voussoir_study::results::sealed_line::sealed;

/// The progress display of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shown {
    /// Shows errors only.
    Nothing,
    /// A progress bar on a terminal.
    Bar,
    /// A progress bar, and each solved case as a line of JSON on standard output.
    Lines,
}

/// Shows progress on a terminal and stores finished cases.
pub struct Progress {
    bar: ProgressBar,
    shown_as: Shown,
    name: String,
    started: Instant,
    /// Time at which a path was last shown, in tenths of a second since the start.
    shown: AtomicU64,
    journal: Arc<Mutex<Option<Journal>>>,
    /// The reason why a finished case could not be stored.
    unwritten: Mutex<Option<Error>>,
    /// Ids of the cases whose lines were printed to standard output.
    said: Mutex<BTreeSet<usize>>,
}

/// Time after which the progress of a path is shown, in tenths of a second.
const LONG: u64 = 10;

impl Progress {
    /// Progress of the study called `name`.
    pub fn new(name: &str, shown_as: Shown) -> Self {
        Progress {
            bar: ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden()),
            shown_as,
            name: name.into(),
            started: Instant::now(),
            shown: AtomicU64::new(0),
            journal: Arc::default(),
            unwritten: Mutex::default(),
            said: Mutex::default(),
        }
    }

    /// Stores finished cases in this file from now on.
    pub fn writes(&self, file: File) {
        if let Ok(mut journal) = self.journal.lock() {
            *journal = Some(Journal::new(file));
        }
        interrupt::keeps(&self.journal);
    }

    /// Writes the finished cases that are still buffered.
    ///
    /// # Errors
    /// If a finished case could not be written.
    pub fn written(&self) -> Result<()> {
        self.keep(Journal::write);
        self.unwritten.lock().ok().and_then(|mut error| error.take()).map_or(Ok(()), Err)
    }

    /// Prints a case as a line, unless it was printed when it was solved.
    pub fn say_other(&self, case: &CaseResult) {
        let said = self.said.lock().is_ok_and(|said| said.contains(&case.label.id));
        if !said {
            say_data(&serde_json::to_string(case).unwrap_or_default());
        }
    }

    /// Removes the bar from the terminal.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Progress {
    /// Applies a function to the journal; its first error ends the run.
    fn keep(&self, what: impl FnOnce(&mut Journal) -> Result<()>) {
        let Ok(mut journal) = self.journal.lock() else { return };
        if let Some(Err(error)) = journal.as_mut().map(what)
            && let Ok(mut unwritten) = self.unwritten.lock()
        {
            unwritten.get_or_insert(error);
        }
    }
}

impl Observer for Progress {
    fn cancelled(&self) -> bool {
        self.unwritten.lock().is_ok_and(|error| error.is_some())
    }

    fn begins(&self, cases: usize) {
        self.bar.set_length(cases as u64);
        interrupt::begins(cases);
        if self.shown_as != Shown::Nothing && cases > 0 {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        // A single case has no percentage. The progress of its path is shown instead, if it takes long.
        let template = if cases < 2 { "{msg}" } else { "{msg}: solving {bar:30} {pos}/{len} cases, {eta} left" };
        self.bar.set_style(ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar()));
        if cases > 1 {
            self.bar.set_message(self.name.clone());
        }
    }

    fn answered(&self, case: &CaseResult) {
        self.bar.inc(1);
        let line = sealed(&CaseWithPath(case)).unwrap_or_default();
        self.keep(|journal| journal.add(&line));
        interrupt::finished();
        if self.shown_as == Shown::Lines {
            // The reader of standard output may be slow, so the journal is written first.
            self.keep(Journal::write);
            if let Ok(mut said) = self.said.lock() {
                said.insert(case.label.id);
            }
            say_data(&serde_json::to_string(case).unwrap_or_default());
        }
    }

    fn phase(&self, what: &str) {
        self.bar.set_style(ProgressStyle::with_template("{msg}").unwrap_or_else(|_| ProgressStyle::default_bar()));
        self.bar.set_message(format!("{}: {what}", self.name));
        self.bar.tick();
    }

    fn on_path(&self, at: &PathProgress) {
        self.keep(Journal::write_late);
        let now = self.started.elapsed().as_millis() as u64 / 100;
        if self.bar.is_hidden() || now < LONG || self.shown.swap(now, Ordering::Relaxed) == now {
            return;
        }
        let PathProgress { case, stage, gravity, factor, states, .. } = at;
        let what = if *gravity { " (gravity)" } else { "" };
        self.bar.set_message(format!("{}: case {case}, {stage}{what}, factor {factor:.6}, {states} states", self.name));
        self.bar.tick();
    }
}
