//! The server of `voussoir serve`: access check, limits and response headers.
//!
//! It uses `std::net` directly. `tiny_http` is unmaintained and reserves memory for a body of any announced length.
//! `hyper` would need an asynchronous runtime (about thirty crates) for a page with one local reader. One connection
//! carries one request, bodies have a length, and everything has a limit:
//!
//! | part | limit |
//! |---|---|
//! | head of a request | 16 KiB, 5 s in total |
//! | body | 64 KiB, 5 s in total |
//! | sending the answer | 5 s in total |
//! | connections | 32; a new one closes the oldest that has not passed the gate |
//!
//! A page that was opened with the token passes the access check. A page of another site is refused, even if its host
//! name resolves to this machine.

mod answer;
mod connections;
mod request;
mod wire;

pub use answer::Answer;
use connections::{Connection, Connections};
use request::Request;
use std::net::{TcpListener, TcpStream};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::time::Duration;
use wire::{Limits, Wire};

/// Limits of a request.
const LIMITS: Limits = Limits { head: 16 * 1024, body: 64 * 1024, time: Duration::from_secs(5) };
/// Greatest number of open connections.
const MAX_CONNECTIONS: usize = 32;
/// Pause after a connection could not be accepted, for example because too many files are open.
const ACCEPT_PAUSE: Duration = Duration::from_millis(20);

/// The access check: a request must meet these conditions.
pub struct Gate {
    /// The port that the request must name.
    pub port: u16,
    /// The token that the request must contain.
    pub token: String,
    /// The Content-Security-Policy of every response.
    pub policy: String,
}

/// Compares two texts in a time that depends only on their lengths.
fn equal(a: &str, b: &str) -> bool {
    a.len() == b.len() && a.bytes().zip(b.bytes()).fold(0, |differs, (a, b)| differs | (a ^ b)) == 0
}

impl Gate {
    /// Returns the reason to refuse a request.
    fn refuses(&self, request: &Request) -> Option<Answer> {
        let own = [format!("127.0.0.1:{}", self.port), format!("localhost:{}", self.port)];
        let [host] = request.header("Host")[..] else { return Some(Answer::text(403, "one Host is needed")) };
        if !own.iter().any(|name| name == host) {
            return Some(Answer::text(403, "this Host is not served"));
        }
        let foreign = |origin: &&str| !own.iter().any(|name| **origin == format!("http://{name}"));
        if request.header("Origin").iter().any(foreign) {
            return Some(Answer::text(403, "another site is not answered"));
        }
        let tokens: Vec<&str> =
            request.query.iter().filter(|(key, _)| key == "token").map(|(_, own)| own.as_str()).collect();
        match tokens[..] {
            [token] if equal(token, &self.token) => None,
            _ => Some(Answer::text(403, "the address is not whole: its token is missing or wrong")),
        }
    }
}

/// Handles requests: computes a response from method, path, query and body.
pub type Route<'a> = &'a (dyn Fn(&str, &str, &[(String, String)], &[u8]) -> Answer + Sync);

/// Answers requests until the process ends.
pub fn serve(listener: &TcpListener, gate: &Gate, route: Route) {
    let connections = Connections::new(MAX_CONNECTIONS);
    std::thread::scope(|scope| {
        loop {
            let Ok((stream, _)) = listener.accept() else {
                std::thread::sleep(ACCEPT_PAUSE);
                continue;
            };
            let stream = Arc::new(stream);
            let Some(connection) = connections.enter(&stream) else {
                refuse(&stream, gate);
                continue;
            };
            // If no thread can be started, the connection is closed.
            drop(std::thread::Builder::new().spawn_scoped(scope, move || {
                let wire = Wire::new(connection.stream(), LIMITS);
                converse(wire, &connection, gate, route);
            }));
        }
    });
}

/// Refuses a connection immediately.
fn refuse(stream: &TcpStream, gate: &Gate) {
    let answer = Answer::text(503, "all connections are busy");
    if stream.set_nonblocking(true).is_ok() {
        drop(std::io::Write::write(&mut &*stream, &answer.bytes(&gate.policy)));
    }
}

/// Reads one request and sends the response. A closed connection is not an error.
fn converse(mut wire: Wire, connection: &Connection, gate: &Gate, route: Route) {
    let answer = match request(&mut wire, connection, gate) {
        Ok(Some((request, body))) => {
            let work = || route(&request.method, &request.path, &request.query, &body);
            catch_unwind(AssertUnwindSafe(work))
                .unwrap_or_else(|_| Answer::text(500, "the work on this request failed"))
        }
        Ok(None) => return,
        Err(refusal) => refusal,
    };
    if wire.send(&answer.bytes(&gate.policy)).is_ok() {
        connection.may_be_closed(true);
        wire.finish();
    }
}

/// Reads a request that passes the access check, with its body; `None` if no request arrives.
fn request(wire: &mut Wire, connection: &Connection, gate: &Gate) -> Result<Option<(Request, Vec<u8>)>, Answer> {
    let Some(head) = wire.head()? else { return Ok(None) };
    let request = Request::parse(&head)?;
    if let Some(refusal) = gate.refuses(&request) {
        return Err(refusal);
    }
    connection.may_be_closed(false);
    let length = request.body_length(LIMITS.body)?;
    if request.waits_for_permission()? && length > 0 {
        // If this cannot be sent, the client sends no body, and the error is detected below.
        drop(wire.send(b"HTTP/1.1 100 Continue\r\n\r\n"));
    }
    Ok(Some((request, wire.body(length)?)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{Read, Write};

    /// If the work for one request panics, its client gets an error and the server continues.
    #[test]
    fn a_panic_does_not_end_the_server() {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
        let port = listener.local_addr().expect("an address").port();
        // The thread ends with the test process.
        std::thread::spawn(move || {
            let gate = Gate { port, token: "t".into(), policy: "default-src 'none'".into() };
            serve(&listener, &gate, &|_, path, _, _| match path {
                "/panic" => panic!("this panic belongs to a test"),
                _ => Answer::text(200, "well"),
            });
        });
        let ask = |path: &str| {
            let mut stream = TcpStream::connect(("127.0.0.1", port)).expect("a connection");
            write!(stream, "GET {path}?token=t HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n").expect("sent");
            let mut answer = String::new();
            stream.read_to_string(&mut answer).expect("an answer");
            answer
        };
        for _ in 0..2 * MAX_CONNECTIONS {
            assert!(ask("/panic").starts_with("HTTP/1.1 500 "));
        }
        assert!(ask("/").starts_with("HTTP/1.1 200 OK\r\n") && ask("/").ends_with("\r\n\r\nwell"));
    }
}
