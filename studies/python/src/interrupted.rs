//! Runs work without the interpreter's lock. The work reports progress, and Ctrl-C stops it.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::Duration;
use voussoir::results::CaseResult;
use voussoir::solve::{Observer, PathProgress};

/// Longest delay until Ctrl-C is noticed.
const PATIENCE: Duration = Duration::from_millis(50);

/// A progress report.
enum Event {
    Begins(usize),
    Phase(String),
    Answered { id: usize, status: String, load_factor: Option<f64> },
    Path { case: usize, stage: String, factor: f64, states: u64 },
}

/// Observes the work and sends progress reports.
pub struct Told {
    events: Option<Sender<Event>>,
    cancelled: AtomicBool,
}

impl Told {
    fn tell(&self, event: Event) {
        // The receiver is gone if the caller has stopped.
        if let Some(events) = &self.events {
            drop(events.send(event));
        }
    }
}

impl Observer for Told {
    fn begins(&self, cases: usize) {
        self.tell(Event::Begins(cases));
    }

    fn phase(&self, what: &str) {
        self.tell(Event::Phase(what.into()));
    }

    fn answered(&self, case: &CaseResult) {
        let status = serde_json::to_value(case.status).ok().and_then(|status| Some(status.as_str()?.to_string()));
        let (id, load_factor) = (case.label.id, case.load_factor);
        self.tell(Event::Answered { id, status: status.unwrap_or_default(), load_factor });
    }

    fn on_path(&self, at: &PathProgress) {
        self.tell(Event::Path { case: at.case, stage: at.stage.into(), factor: at.factor, states: at.states });
    }

    fn cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}

/// Runs some work on another thread, while this thread calls `progress` with its reports and checks for signals. An
/// exception (Ctrl-C, or raised by `progress`) cancels the work and is raised when the work has ended. If `progress`
/// returns `False`, the work is cancelled too, and its results so far are returned.
pub fn interruptible<T: Send>(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    work: impl FnOnce(&Told) -> T + Send,
) -> PyResult<T> {
    let (send, events) = channel();
    let told = Told { events: progress.is_some().then(|| send.clone()), cancelled: AtomicBool::new(false) };
    // Dropped when the work has ended, so that the other thread stops waiting.
    let alive = send;
    let told = &told;
    std::thread::scope(|scope| {
        let worker = std::thread::Builder::new().stack_size(16 << 20).spawn_scoped(scope, move || {
            let result = work(told);
            drop(alive);
            result
        })?;
        let watched = watch(py, events, progress.as_ref(), told, &|| worker.is_finished());
        if watched.is_err() {
            told.cancelled.store(true, Ordering::Relaxed);
        }
        let result = py.detach(|| worker.join());
        watched?;
        result.map_err(|_| pyo3::exceptions::PyRuntimeError::new_err("a panic ended the work"))
    })
}

/// Passes reports on until the work has ended.
fn watch(
    py: Python<'_>,
    events: Receiver<Event>,
    progress: Option<&Py<PyAny>>,
    told: &Told,
    ended: &dyn Fn() -> bool,
) -> PyResult<()> {
    // A receiver cannot be shared between threads, so a mutex protects it while the lock of the interpreter is
    // released.
    let events = std::sync::Mutex::new(events);
    loop {
        let event = py.detach(|| match events.lock() {
            Ok(events) => events.recv_timeout(PATIENCE),
            Err(_) => Err(RecvTimeoutError::Disconnected),
        });
        py.check_signals()?;
        match event {
            Ok(event) => {
                if let Some(progress) = progress
                    && !call(py, progress, event)?
                {
                    told.cancelled.store(true, Ordering::Relaxed);
                }
            }
            Err(RecvTimeoutError::Timeout) if !ended() => {}
            Err(_) => return Ok(()),
        }
    }
}

/// Calls `progress` with a dictionary. Returns false if the work must stop.
fn call(py: Python<'_>, progress: &Py<PyAny>, event: Event) -> PyResult<bool> {
    let dict = PyDict::new(py);
    match event {
        Event::Begins(cases) => {
            dict.set_item("event", "begins")?;
            dict.set_item("cases", cases)?;
        }
        Event::Phase(what) => {
            dict.set_item("event", "phase")?;
            dict.set_item("phase", what)?;
        }
        Event::Answered { id, status, load_factor } => {
            dict.set_item("event", "answered")?;
            dict.set_item("case", id)?;
            dict.set_item("status", status)?;
            dict.set_item("load_factor", load_factor)?;
        }
        Event::Path { case, stage, factor, states } => {
            dict.set_item("event", "path")?;
            dict.set_item("case", case)?;
            dict.set_item("stage", stage)?;
            dict.set_item("factor", factor)?;
            dict.set_item("states", states)?;
        }
    }
    let answer = progress.call1(py, (dict,))?;
    Ok(answer.is_none(py) || answer.is_truthy(py)?)
}
