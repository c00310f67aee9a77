//! Open connections. Their number is limited: connections that have not passed the gate are closed for newer ones.

use std::net::{Shutdown, TcpStream};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Longest time until the place of a closed connection is free for a new one.
const MAX_WAIT: Duration = Duration::from_secs(1);

/// All open connections, oldest first.
pub(super) struct Connections {
    most: usize,
    open: Mutex<Vec<Place>>,
    left: Condvar,
}

struct Place {
    stream: Arc<TcpStream>,
    /// True if it may be closed for a newer one: its request has not passed the access check, or its response is sent.
    closable: bool,
}

/// One open connection. Dropping it frees its place.
pub(super) struct Connection<'a> {
    all: &'a Connections,
    stream: Arc<TcpStream>,
}

impl Connections {
    /// Creates places for `most` connections.
    pub fn new(most: usize) -> Self {
        Connections { most, open: Mutex::new(Vec::new()), left: Condvar::new() }
    }

    fn open(&self) -> MutexGuard<'_, Vec<Place>> {
        self.open.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A place for a connection. If all are taken, the oldest closable one is closed. Returns `None` if no connection is closable.
    pub fn enter(&self, stream: &Arc<TcpStream>) -> Option<Connection<'_>> {
        let mut open = self.open();
        if open.len() >= self.most {
            let oldest = open.iter_mut().find(|place| place.closable)?;
            oldest.closable = false;
            // Its thread wakes up and ends.
            drop(oldest.stream.shutdown(Shutdown::Both));
            let full = |open: &mut Vec<Place>| open.len() >= self.most;
            open = self.left.wait_timeout_while(open, MAX_WAIT, full).unwrap_or_else(PoisonError::into_inner).0;
            if open.len() >= self.most {
                return None;
            }
        }
        open.push(Place { stream: stream.clone(), closable: true });
        Some(Connection { all: self, stream: stream.clone() })
    }
}

impl Connection<'_> {
    /// The stream of the connection.
    pub fn stream(&self) -> &TcpStream {
        &self.stream
    }

    /// Sets if the connection may be closed for a newer one.
    pub fn may_be_closed(&self, closable: bool) {
        let mut open = self.all.open();
        if let Some(place) = open.iter_mut().find(|place| Arc::ptr_eq(&place.stream, &self.stream)) {
            place.closable = closable;
        }
    }
}

impl Drop for Connection<'_> {
    fn drop(&mut self) {
        self.all.open().retain(|place| !Arc::ptr_eq(&place.stream, &self.stream));
        self.all.left.notify_one();
    }
}
