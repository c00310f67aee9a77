//! Work without the interpreter's lock that Ctrl-C ends, and that says how far it has come.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::Duration;
use voussoir::results::CaseResult;
use voussoir::solve::{Observer, PathProgress};

/// How long Ctrl-C may go unseen.
const PATIENCE: Duration = Duration::from_millis(50);

/// What the work says.
enum Event {
    Begins(usize),
    Phase(String),
    Answered { id: usize, status: String, load_factor: Option<f64> },
    Path { case: usize, stage: String, factor: f64, states: u64 },
}

/// Looks on and passes on what it sees.
pub struct Told {
    events: Option<Sender<Event>>,
    cancelled: AtomicBool,
}

impl Told {
    fn tell(&self, event: Event) {
        // Nobody listens when the caller has given up.
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

/// Does some work on a thread of its own, while this one calls `progress` with what it says and looks for signals. An
/// exception, of Ctrl-C or of `progress`, cancels the work and is raised when it has ended; `False` from `progress`
/// cancels it too, and what it has come to is returned.
pub fn interruptible<T: Send>(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    work: impl FnOnce(&Told) -> T + Send,
) -> PyResult<T> {
    let (send, events) = channel();
    let told = Told { events: progress.is_some().then(|| send.clone()), cancelled: AtomicBool::new(false) };
    // Dropped when the work has ended: then there is nothing more to wait for.
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

/// Passes events on until the work has ended.
fn watch(
    py: Python<'_>,
    events: Receiver<Event>,
    progress: Option<&Py<PyAny>>,
    told: &Told,
    ended: &dyn Fn() -> bool,
) -> PyResult<()> {
    // A receiver is not shared between threads: it is lent while the lock is released.
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

/// Calls `progress` with a dictionary; whether to go on.
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
