//! The connection of `isolate = true` on systems without socket pairs: a port of this machine, and a word that only the two
//! processes know. Errors are those of the system.

use std::collections::hash_map::RandomState;
use std::hash::BuildHasher;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::time::{Duration, Instant};

/// Longest line that a process reads from a stranger \[bytes\].
const MAX_LINE: u64 = 64;

/// A port that one process may connect to.
pub struct Door {
    listener: TcpListener,
    secret: String,
}

impl Door {
    /// Opens a port of this machine.
    pub fn open() -> io::Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0))?;
        listener.set_nonblocking(true)?;
        // Randomness of the system, as far as the standard library offers it.
        let random = || RandomState::new().hash_one("secret");
        let secret = format!("{:016x}{:016x}", random(), random());
        Ok(Door { listener, secret })
    }

    /// Returns the line for the other process: port and secret.
    pub fn invitation(&self) -> io::Result<String> {
        Ok(format!("{} {}\n", self.listener.local_addr()?.port(), self.secret))
    }

    /// Returns the connection of the process that knows the secret. An error if it does not connect within `patience`.
    pub fn accept(self, patience: Duration) -> io::Result<TcpStream> {
        let end = Instant::now() + patience;
        while Instant::now() < end {
            match self.listener.accept() {
                Ok((stream, _)) => {
                    stream.set_nonblocking(false)?;
                    stream.set_read_timeout(Some(Duration::from_secs(1)))?;
                    let mut line = String::new();
                    let read = BufReader::with_capacity(1, stream.try_clone()?).take(MAX_LINE).read_line(&mut line);
                    // A process without the secret is refused.
                    if read.is_ok() && line.trim_end() == self.secret {
                        stream.set_nodelay(true)?;
                        return Ok(stream);
                    }
                }
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => std::thread::sleep(Duration::from_millis(1)),
                Err(error) => return Err(error),
            }
        }
        Err(io::Error::new(io::ErrorKind::TimedOut, "the other process did not connect"))
    }
}

/// Connects to a door, from the line that [`Door::invitation`] gave.
pub fn enter(invitation: &str) -> io::Result<TcpStream> {
    let unreadable = || io::Error::new(io::ErrorKind::InvalidInput, "no port and secret");
    let (port, secret) = invitation.trim_end().split_once(' ').ok_or_else(unreadable)?;
    let port: u16 = port.parse().map_err(|_| unreadable())?;
    let mut stream = TcpStream::connect((Ipv4Addr::LOCALHOST, port))?;
    stream.set_nodelay(true)?;
    stream.write_all(format!("{secret}\n").as_bytes())?;
    Ok(stream)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The process with the secret is connected and all its later data arrive; a process with another secret is
    /// refused.
    #[test]
    fn only_the_invited_process_enters() {
        let door = Door::open().expect("a port");
        let invitation = door.invitation().expect("a line");
        let port = invitation.split(' ').next().expect("a port").to_string();
        let other = std::thread::spawn(move || {
            let stranger = enter(&format!("{port} 0123")).expect("a connection");
            let mut own = enter(&invitation).expect("a connection");
            own.write_all(b"hello").expect("written");
            drop(stranger);
        });
        let mut stream = door.accept(Duration::from_secs(10)).expect("a connection");
        let mut text = String::new();
        stream.read_to_string(&mut text).expect("read");
        assert_eq!(text, "hello");
        other.join().expect("no panic");
        assert!(enter("no port").is_err());
        let closed = Door::open().expect("a port").accept(Duration::from_millis(5));
        assert_eq!(closed.expect_err("nobody came").kind(), io::ErrorKind::TimedOut);
    }
}
