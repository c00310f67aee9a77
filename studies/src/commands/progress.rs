//! Progress on a terminal, and the journal of finished cases for `--resume`.

use crate::results::CaseResult;
use crate::solve::{Observer, PathProgress};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::Write;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

/// Shows progress on a terminal and keeps finished cases.
pub struct Progress {
    bar: ProgressBar,
    quiet: bool,
    name: String,
    started: Instant,
    /// When a path was last shown, in tenths of a second since the start.
    shown: AtomicU64,
    journal: Mutex<Option<std::fs::File>>,
}

/// Tenths of a second after which a path counts as long and is shown.
const LONG: u64 = 10;

impl Progress {
    /// Progress of the study called `name`; finished cases are added to the file `journal`.
    pub fn new(name: &str, quiet: bool, journal: Option<std::fs::File>) -> Self {
        Progress {
            bar: ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden()),
            quiet,
            name: name.into(),
            started: Instant::now(),
            shown: AtomicU64::new(0),
            journal: Mutex::new(journal),
        }
    }

    /// Takes the bar off the terminal.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Observer for Progress {
    fn begins(&self, cases: usize) {
        self.bar.set_length(cases as u64);
        if !self.quiet && cases > 0 {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        // One case is no share of anything: what shows is where its path has come to, once that is long.
        let template = if cases < 2 { "{msg}" } else { "{msg} {bar:30} {pos}/{len} {eta}" };
        self.bar.set_style(ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar()));
        if cases > 1 {
            self.bar.set_message(self.name.clone());
        }
    }

    fn answered(&self, case: &CaseResult) {
        self.bar.inc(1);
        let Ok(mut journal) = self.journal.lock() else { return };
        if let (Some(file), Ok(line)) = (journal.as_mut(), serde_json::to_string(case)) {
            // A line of its own even after one that was cut short, and in one piece.
            if let Err(error) = file.write_all(format!("\n{line}\n").as_bytes()) {
                // It costs only the chance to go on after an interruption.
                eprintln!("voussoir: the journal of finished cases cannot be written: {error}");
                *journal = None;
            }
        }
    }

    fn on_path(&self, at: &PathProgress) {
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
