//! `voussoir serve`: shows a study in a browser on this machine and updates it when sliders move.

use super::error::{CliError, Outcome, Verdict};
use super::files;
use super::http::{self, Answer, Gate};
use super::open::open;
use super::print::say;
use crate::serve::{Asked, Session};
use serde_json::Value as Json;
use std::collections::hash_map::RandomState;
use std::hash::{BuildHasher, Hasher};
use std::io;
use std::net::TcpListener;
use std::path::Path;
use std::time::{Duration, Instant};
use voussoir_report::writers::page::served_policy;
use voussoir_study::cases::Observer;

/// A report whose path takes longer is cancelled.
const PATIENCE: Duration = Duration::from_secs(60);

/// Cancels a path that takes too long for a report.
struct Patience(Instant);

impl Observer for Patience {
    fn cancelled(&self) -> bool {
        self.0.elapsed() > PATIENCE
    }
}

/// Returns 128 bits that no other user of the machine can guess: two outputs of hashes that use random keys of the
/// operating system.
fn token() -> String {
    let half = || RandomState::new().build_hasher().finish();
    format!("{:016x}{:016x}", half(), half())
}

/// Opens the port, or a free one for 0. Returns the listener and its port.
fn bind(port: u16) -> Result<(TcpListener, u16), CliError> {
    let bound = TcpListener::bind(("127.0.0.1", port)).and_then(|listener| {
        let port = listener.local_addr()?.port();
        Ok((listener, port))
    });
    bound.map_err(|error| {
        let why = match error.kind() {
            io::ErrorKind::AddrInUse => {
                format!("port {port} is used by another program; choose another, or --port 0 for a free one")
            }
            io::ErrorKind::PermissionDenied => format!("port {port} needs more rights; choose one above 1023"),
            _ => error.to_string(),
        };
        CliError::no_access(format_args!("voussoir: cannot serve on 127.0.0.1: {why}"))
    })
}

/// Serves a study until Ctrl-C.
pub fn serve(path: &Path, sets: &[String], in_browser: bool, port: u16) -> Outcome {
    let session = files::session(path, &files::overrides(sets)?)?;
    let (listener, port) = bind(port)?;
    // If signals cannot be caught, the default action of the system ends the process.
    drop(ctrlc::set_handler(|| {
        eprintln!("\nvoussoir: serving has ended");
        std::process::exit(0);
    }));
    let token = token();
    let place = format!("http://127.0.0.1:{port}/?token={token}");
    say(format!("{}: serving at {place}", session.name()));
    say("Ctrl-C ends it; only this machine can reach it, and only with the whole address");
    if in_browser {
        open(&place);
    }
    // Frames can be forbidden only by a header.
    let gate = Gate { port, token, policy: format!("{}; frame-ancestors 'none'", served_policy()) };
    http::serve(&listener, &gate, &|method, path, query, body| route(&session, method, path, query, body));
    Ok(Verdict::Proved)
}

/// Returns the response to a request that has passed the access check.
fn route(session: &Session, method: &str, path: &str, query: &[(String, String)], body: &[u8]) -> Answer {
    let patience = Patience(Instant::now());
    let asked = || serde_json::from_slice::<Asked>(body).map_err(|error| Answer::text(400, error.to_string()));
    match (method, path) {
        ("GET", "/") => {
            let case = query.iter().find(|(key, _)| key == "case").map_or(Ok(0), |(_, id)| id.parse());
            match case.map_err(|_| "case must be a whole number".to_string()).and_then(|id| session.page(id)) {
                Ok(page) => Answer::page(page),
                Err(why) => Answer::text(404, why),
            }
        }
        ("POST", "/answer") => asked().map_or_else(|wrong| wrong, |asked| Answer::json(&session.answer(&asked))),
        ("POST", "/progress" | "/stop") => {
            asked().map_or_else(|wrong| wrong, |asked| Answer::json(&session.progress(&asked.page, path == "/stop")))
        }
        ("POST", "/report") => asked().map_or_else(
            |wrong| wrong,
            |asked| session.report(&asked, &patience).map_or_else(|why| Answer::text(200, why), Answer::page),
        ),
        (_, "/" | "/answer" | "/report" | "/progress" | "/stop") => {
            Answer::text(405, "use GET for the page, POST for answers".to_string())
        }
        _ => Answer::text(404, "there is nothing here".to_string()),
    }
}

impl Answer {
    fn json(value: &Json) -> Self {
        Answer { code: 200, kind: "application/json", body: value.to_string().into_bytes() }
    }

    fn page(html: String) -> Self {
        Answer { code: 200, kind: "text/html; charset=utf-8", body: html.into_bytes() }
    }
}
