//! A running `voussoir serve` for tests.

// Each test uses only some of these functions.
#![allow(dead_code)]

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};

/// The study that is served.
pub const STUDY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/cases/strathmashie_rise.toml");

/// A bridge with a survey, fill and a vehicle.
pub const BRIDGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/served/bridge.toml");

/// A study whose path takes long.
pub const SLOW: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/served/slow.toml");

/// A server that is stopped at the end of its test.
pub struct Served {
    pub program: Child,
    pub port: u16,
    pub token: String,
}

impl Drop for Served {
    fn drop(&mut self) {
        drop(self.program.kill());
        drop(self.program.wait());
    }
}

impl Served {
    pub fn start(study: &str) -> Served {
        Served::of(Command::new(env!("CARGO_BIN_EXE_voussoir")).args(["serve", study]))
    }

    /// Starts the server with a command.
    pub fn of(command: &mut Command) -> Served {
        let mut program = command.stdout(Stdio::piped()).spawn().expect("the program starts");
        let mut line = String::new();
        BufReader::new(program.stdout.as_mut().expect("its output")).read_line(&mut line).expect("its address");
        let (_, place) = line.trim().split_once("http://127.0.0.1:").unwrap_or_else(|| panic!("{line}"));
        let (port, token) = place.split_once("/?token=").expect("a token");
        assert_eq!(token.len(), 32);
        Served { port: port.parse().expect("a port"), token: token.into(), program }
    }

    /// Sends a request unchanged. Returns status and body of the response.
    pub fn raw(&self, request: &str) -> (u16, String) {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).expect("a connection");
        stream.write_all(request.as_bytes()).expect("sent");
        let mut answer = String::new();
        stream.read_to_string(&mut answer).expect("an answer");
        let policy = answer.lines().find_map(|line| line.strip_prefix("Content-Security-Policy: ")).expect("a policy");
        assert!(policy.contains("script-src 'sha256-") && !policy.contains("unsafe"), "{policy}");
        assert!(policy.ends_with("; frame-ancestors 'none'"), "{policy}");
        let code = answer.split(' ').nth(1).and_then(|code| code.parse().ok()).unwrap_or_else(|| panic!("{answer}"));
        (code, answer.split_once("\r\n\r\n").map_or(String::new(), |(_, body)| body.to_string()))
    }

    pub fn ask(&self, method: &str, path: &str, host: &str, body: &str) -> (u16, String) {
        let length = body.len();
        self.raw(&format!(
            "{method} {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\nContent-Length: {length}\r\n\r\n{body}"
        ))
    }

    pub fn own(&self) -> String {
        format!("127.0.0.1:{}", self.port)
    }
}
