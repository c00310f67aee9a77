//! The requests that are being solved, one for each page: their progress, and their end when a newer request arrives.

use serde_json::{Value as Json, json};
use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use voussoir_study::cases::{Observer, PathProgress};

/// A page that does not ask for the progress of its request for this time is closed; its request ends.
const UNSEEN: Duration = Duration::from_secs(10);

/// The reason to stop a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stop {
    /// The page has sent a newer request.
    Superseded,
    /// The reader has stopped it.
    ByReader,
    /// The page is closed.
    Unseen,
}

/// A request that is being solved.
#[derive(Debug)]
pub(super) struct Run {
    started: Instant,
    seen: Mutex<Instant>,
    superseded: AtomicBool,
    stopped: AtomicBool,
    path: Mutex<Option<PathPlace>>,
}

/// The current state of a path.
#[derive(Debug, Clone)]
struct PathPlace {
    stage: String,
    gravity: bool,
    factor: f64,
    states: u64,
}

/// Locks a value, also after a panic of another request.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Run {
    fn new() -> Self {
        let now = Instant::now();
        Run {
            started: now,
            seen: Mutex::new(now),
            superseded: AtomicBool::new(false),
            stopped: AtomicBool::new(false),
            path: Mutex::new(None),
        }
    }

    /// Returns the reason to stop, if there is one.
    pub fn stop(&self) -> Option<Stop> {
        match () {
            () if self.superseded.load(Ordering::Relaxed) => Some(Stop::Superseded),
            () if self.stopped.load(Ordering::Relaxed) => Some(Stop::ByReader),
            () if locked(&self.seen).elapsed() > UNSEEN => Some(Stop::Unseen),
            () => None,
        }
    }

    /// Returns the progress for the page.
    fn progress(&self) -> Json {
        let path = locked(&self.path).clone();
        let path = path
            .map(|at| json!({ "stage": at.stage, "gravity": at.gravity, "factor": at.factor, "states": at.states }));
        json!({ "seconds": self.started.elapsed().as_secs_f64(), "path": path })
    }
}

impl Observer for Run {
    fn on_path(&self, at: &PathProgress) {
        let (stage, gravity) = (at.stage.to_string(), at.gravity);
        *locked(&self.path) = Some(PathPlace { stage, gravity, factor: at.factor, states: at.states });
    }

    fn cancelled(&self) -> bool {
        self.stop().is_some()
    }
}

/// The requests of all pages.
#[derive(Debug, Default)]
pub(super) struct Runs {
    pages: Mutex<HashMap<String, Arc<Run>>>,
}

impl Runs {
    /// Starts a request of a page and ends its earlier request.
    pub fn start(&self, page: &str) -> Arc<Run> {
        let run = Arc::new(Run::new());
        if let Some(earlier) = locked(&self.pages).insert(page.into(), run.clone()) {
            earlier.superseded.store(true, Ordering::Relaxed);
        }
        run
    }

    /// Removes a request that has ended.
    pub fn end(&self, page: &str, run: &Arc<Run>) {
        let mut pages = locked(&self.pages);
        if pages.get(page).is_some_and(|current| Arc::ptr_eq(current, run)) {
            pages.remove(page);
        }
    }

    /// Returns the progress of the request of a page, or null. With `stop`, the request ends.
    pub fn progress(&self, page: &str, stop: bool) -> Json {
        let Some(run) = locked(&self.pages).get(page).cloned() else { return Json::Null };
        *locked(&run.seen) = Instant::now();
        if stop {
            run.stopped.store(true, Ordering::Relaxed);
        }
        run.progress()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_new_request_ends_the_earlier_one_of_its_page_only() {
        let runs = Runs::default();
        let (first, other) = (runs.start("a"), runs.start("b"));
        let second = runs.start("a");
        assert_eq!([first.stop(), other.stop(), second.stop()], [Some(Stop::Superseded), None, None]);
        // The end of the earlier request does not remove the newer one.
        runs.end("a", &first);
        assert!(!runs.progress("a", false).is_null());
        runs.progress("a", true);
        assert_eq!((second.stop(), other.stop()), (Some(Stop::ByReader), None));
        runs.end("a", &second);
        assert!(runs.progress("a", false).is_null());
    }
}
