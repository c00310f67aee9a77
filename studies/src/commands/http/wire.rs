//! Reads and writes the bytes of a connection, with limits for size and total time.

use super::answer::Answer;
use std::io::{Error, ErrorKind, Read, Result as IoResult, Write};
use std::net::{Shutdown, TcpStream};
use std::time::{Duration, Instant};

/// Number of bytes per read.
const CHUNK: usize = 4096;
/// Time in which the rest of a request is read and dropped. Without this, a reset of the connection could lose the
/// response.
const LINGER: Duration = Duration::from_secs(1);
/// Greatest number of such reads.
const MAX_DROPPED: usize = 256;

/// Greatest sizes \[bytes\], and the time for each part.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    pub head: usize,
    pub body: usize,
    pub time: Duration,
}

/// One connection.
pub(super) struct Wire<'a> {
    stream: &'a TcpStream,
    limits: Limits,
    /// Bytes after the head.
    rest: Vec<u8>,
}

/// Returns the remaining time as a timeout of the system; an error if the deadline is past.
fn left(deadline: Instant) -> IoResult<Option<Duration>> {
    let left = deadline.saturating_duration_since(Instant::now());
    if left.is_zero() { Err(ErrorKind::TimedOut.into()) } else { Ok(Some(left)) }
}

impl<'a> Wire<'a> {
    /// Wraps an accepted connection.
    pub fn new(stream: &'a TcpStream, limits: Limits) -> Self {
        Wire { stream, limits, rest: Vec::new() }
    }

    /// Reads the next bytes before a deadline, which slow senders cannot extend; 0 at the end.
    fn read(&self, chunk: &mut [u8], deadline: Instant) -> IoResult<usize> {
        loop {
            self.stream.set_read_timeout(left(deadline)?)?;
            match { self.stream }.read(chunk) {
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                other => return other,
            }
        }
    }

    fn refusal(&self, error: &Error) -> Answer {
        match error.kind() {
            ErrorKind::TimedOut | ErrorKind::WouldBlock => {
                Answer::text(408, format!("the request took longer than {} s", self.limits.time.as_secs()))
            }
            _ => Answer::text(400, error.to_string()),
        }
    }

    /// Returns the head of a request without the empty line after it; `None` if the connection ends before the first
    /// byte.
    pub fn head(&mut self) -> Result<Option<Vec<u8>>, Answer> {
        let deadline = Instant::now() + self.limits.time;
        let (mut head, mut chunk) = (Vec::new(), [0; CHUNK]);
        loop {
            let count = self.read(&mut chunk, deadline).map_err(|error| self.refusal(&error))?;
            if count == 0 {
                return if head.is_empty() { Ok(None) } else { Err(Answer::text(400, "the request breaks off")) };
            }
            // The end mark may begin in the previous chunk.
            let from = head.len().saturating_sub(3);
            head.extend_from_slice(&chunk[..count]);
            let end = head[from..].windows(4).position(|four| four == b"\r\n\r\n").map(|at| from + at);
            if end.unwrap_or(head.len()) > self.limits.head {
                return Err(Answer::text(
                    431,
                    format!("more than {} bytes before the body are not read", self.limits.head),
                ));
            }
            if let Some(end) = end {
                self.rest = head.split_off(end + 4);
                head.truncate(end);
                return Ok(Some(head));
            }
        }
    }

    /// Returns the body of a request; `length` is within the limit. Bytes after the body are ignored, because the
    /// connection is then closed.
    pub fn body(&mut self, length: usize) -> Result<Vec<u8>, Answer> {
        let deadline = Instant::now() + self.limits.time;
        let (mut body, mut chunk) = (std::mem::take(&mut self.rest), [0; CHUNK]);
        while body.len() < length {
            let count = self.read(&mut chunk, deadline).map_err(|error| self.refusal(&error))?;
            if count == 0 {
                return Err(Answer::text(400, "the body breaks off"));
            }
            body.extend_from_slice(&chunk[..count]);
        }
        body.truncate(length);
        Ok(body)
    }

    /// Sends bytes until a deadline.
    pub fn send(&self, mut bytes: &[u8]) -> IoResult<()> {
        let deadline = Instant::now() + self.limits.time;
        while !bytes.is_empty() {
            self.stream.set_write_timeout(left(deadline)?)?;
            match { self.stream }.write(bytes) {
                Ok(0) => return Err(ErrorKind::WriteZero.into()),
                Ok(count) => bytes = &bytes[count..],
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    /// Ends the connection: sends nothing more, and reads and drops the remaining input for a short time.
    pub fn finish(self) {
        let deadline = Instant::now() + LINGER;
        let mut chunk = [0; CHUNK];
        if self.stream.shutdown(Shutdown::Write).is_ok() {
            let more = |_: &usize| self.read(&mut chunk, deadline).is_ok_and(|count| count > 0);
            (0..MAX_DROPPED).take_while(more).for_each(drop);
        }
    }
}
