//! A process without the token cannot end `voussoir serve`, block it, slow it down, or use up its memory.

mod served;

use served::{STUDY, Served};
use std::io::{ErrorKind, Read, Write};
use std::net::{Shutdown, TcpStream};
use std::process::Command;
use std::time::{Duration, Instant};

/// Longest time until the page answers under attack; the machines that run tests are busy.
const SOON: Duration = Duration::from_secs(4);
/// Greatest growth of memory under an attack \[KiB\].
const MAX_GROWTH: u64 = 48 * 1024;

/// Starts a server with a small limit of open files, which an attack could reach.
fn start() -> Served {
    let program = env!("CARGO_BIN_EXE_voussoir");
    if cfg!(unix) {
        let script = format!("ulimit -n 128; exec '{program}' serve '{STUDY}'");
        Served::of(Command::new("sh").args(["-c", &script]))
    } else {
        Served::start(STUDY)
    }
}

fn connect(served: &Served) -> TcpStream {
    let stream = TcpStream::connect(("127.0.0.1", served.port)).expect("a connection");
    stream.set_read_timeout(Some(Duration::from_secs(12))).expect("a timeout");
    stream
}

/// Opens a connection and sends bytes. The server may close it before all bytes are sent.
fn sent(served: &Served, bytes: &[u8]) -> TcpStream {
    let mut stream = connect(served);
    drop(stream.write_all(bytes));
    stream
}

/// Reads all bytes until the end; a reset counts as the end.
fn received(mut stream: TcpStream) -> String {
    let (mut all, mut chunk) = (Vec::new(), [0; 4096]);
    loop {
        match stream.read(&mut chunk) {
            Ok(0) => break,
            Ok(count) => all.extend_from_slice(&chunk[..count]),
            Err(error) if error.kind() == ErrorKind::WouldBlock => panic!("the connection stays open"),
            Err(_) => break,
        }
    }
    String::from_utf8_lossy(&all).into_owned()
}

/// Status codes of all responses on a connection.
fn codes(answer: &str) -> Vec<u16> {
    let code = |rest: &str| rest.split(' ').next().and_then(|code| code.parse().ok());
    answer.split("HTTP/1.1 ").skip(1).filter_map(code).collect()
}

/// Greatest memory that the server has used \[KiB\]; `None` if the system does not report it.
fn memory(served: &Served) -> Option<u64> {
    let status = std::fs::read_to_string(format!("/proc/{}/status", served.program.id())).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.split_whitespace().next()?.parse().ok()
}

/// Checks that the page answers in time, and returns the memory used so far.
fn assert_answers(served: &mut Served, after: &str) -> Option<u64> {
    let start = Instant::now();
    let mut code = 0;
    // The server may close a connection for a newer one; a browser would try again.
    while code != 200 && start.elapsed() < SOON {
        let page = format!("GET /?token={} HTTP/1.1\r\nHost: {}\r\n\r\n", served.token, served.own());
        code = codes(&received(sent(served, page.as_bytes()))).first().copied().unwrap_or(0);
    }
    assert!(code == 200 && start.elapsed() < SOON, "{after}: {code} after {:?}", start.elapsed());
    assert!(served.program.try_wait().expect("a state").is_none(), "{after}: the server has ended");
    memory(served)
}

/// A request is refused as soon as its head arrives, whatever the announced length of its body. A body that does not
/// arrive uses no memory.
#[test]
fn announced_bodies_cost_nothing() {
    let mut served = start();
    let before = assert_answers(&mut served, "at the start");
    let own = served.own();
    let mut open = Vec::new();
    for length in ["100000000000", "9223372036854775807", "18446744073709551615", "18446744073709551616", "60000", "-1"]
    {
        for host in ["x", &own] {
            let head = format!("POST / HTTP/1.1\r\nHost: {host}\r\nContent-Length: {length}\r\n\r\nabc");
            open.push(sent(&served, head.as_bytes()));
            assert_answers(&mut served, length);
        }
    }
    for stream in open {
        assert_eq!(codes(&received(stream)), [403]);
    }
    // With the token, only the length decides.
    let post = format!("POST /answer?token={} HTTP/1.1\r\nHost: {own}\r\n", served.token);
    for (headers, code) in [
        ("Content-Length: 65537\r\n", 413),
        ("Content-Length: 18446744073709551616\r\n", 413),
        ("Content-Length: -1\r\n", 400),
        ("Content-Length: 2\r\nContent-Length: 2\r\n", 400),
        ("Content-Length: 2\r\nContent-Length: 70000\r\n", 400),
        ("Transfer-Encoding: chunked\r\n", 411),
        ("Transfer-Encoding: chunked\r\nContent-Length: 2\r\n", 411),
        ("Expect: something\r\nContent-Length: 2\r\n", 417),
    ] {
        let stream = sent(&served, format!("{post}{headers}\r\n5\r\n{{}}{{}}\r\n0\r\n\r\n").as_bytes());
        assert_eq!(codes(&received(stream)), [code], "{headers}");
    }
    let after = assert_answers(&mut served, "at the end");
    assert!(before.zip(after).is_none_or(|(before, after)| after < before + MAX_GROWTH), "{before:?} {after:?}");
}

/// There are more idle connections than the server may open files: the page answers immediately, and idle connections
/// are closed within seconds.
#[test]
fn idle_connections_make_room() {
    let mut served = start();
    let before = assert_answers(&mut served, "at the start");
    let half = format!("GET /?token={} HTTP/1.1\r\nHost: {}\r\n", served.token, served.own());
    let mut idle: Vec<TcpStream> = Vec::new();
    for round in 0..4 {
        for index in 0..100 {
            idle.push(if index % 2 == 0 { connect(&served) } else { sent(&served, half.as_bytes()) });
        }
        assert_answers(&mut served, &format!("{} idle connections", 100 * (round + 1)));
    }
    let start = Instant::now();
    for stream in idle {
        received(stream);
    }
    assert!(start.elapsed() < Duration::from_secs(10), "closed after {:?}", start.elapsed());
    // Clients that never read the responses.
    let whole = format!("{half}\r\n");
    let _unread: Vec<TcpStream> = (0..80).map(|_| sent(&served, whole.as_bytes())).collect();
    let after = assert_answers(&mut served, "80 answers without a reader");
    assert!(before.zip(after).is_none_or(|(before, after)| after < before + MAX_GROWTH), "{before:?} {after:?}");
}

/// The limit of five seconds holds for the whole head and the whole body, not for one read.
#[test]
fn slow_drips_are_cut_off() {
    let mut served = start();
    let post = format!("POST /answer?token={} HTTP/1.1\r\nHost: {}\r\n", served.token, served.own());
    let start = Instant::now();
    let mut slow = [
        sent(&served, b"GET / HTTP/1.1\r\nX: "),
        sent(&served, format!("{post}Content-Length: 60000\r\n\r\n").as_bytes()),
        sent(&served, b""),
    ];
    while start.elapsed() < Duration::from_secs(8) {
        slow.iter_mut().for_each(|stream| drop(stream.write_all(b"a")));
        std::thread::sleep(Duration::from_millis(200));
        assert_answers(&mut served, "while others drip");
    }
    for stream in &mut slow {
        let mut answer = String::new();
        drop(stream.set_read_timeout(Some(Duration::from_millis(100))));
        drop(stream.read_to_string(&mut answer));
        // A reset may have dropped the response.
        assert!(answer.is_empty() || answer.starts_with("HTTP/1.1 408 "), "{answer}");
        drop(stream.set_read_timeout(Some(Duration::from_millis(100))));
        let end = stream.read(&mut [0; 16]);
        assert!(
            end.as_ref().map_or_else(|error| error.kind() != ErrorKind::WouldBlock, |count| *count == 0),
            "{end:?}"
        );
    }
}

/// A head without end is refused after 16 KiB, whatever follows.
#[test]
fn heads_have_a_greatest_size() {
    let mut served = start();
    let before = assert_answers(&mut served, "at the start");
    let whole = format!("/?token={}", served.token);
    for first in ["GET / HTTP/1.1\r\nX: ", "GET /", ""] {
        let mut stream = sent(&served, first.as_bytes());
        // At most 64 MB, or until the server closes the connection.
        let refused = (0..64).any(|_| stream.write_all(&[b'a'; 1_000_000]).is_err());
        assert!(refused, "64 MB were taken");
        assert_answers(&mut served, "a head without end");
    }
    let long =
        |count: usize| format!("GET {whole} HTTP/1.1\r\nHost: {}\r\nX: {}\r\n\r\n", served.own(), "a".repeat(count));
    assert_eq!(codes(&received(sent(&served, long(15_000).as_bytes()))), [200]);
    assert_eq!(codes(&received(sent(&served, long(16_384).as_bytes()))), [431]);
    let many = format!("GET {whole} HTTP/1.1\r\nHost: {}\r\n{}\r\n", served.own(), "A: b\r\n".repeat(4000));
    assert_eq!(codes(&received(sent(&served, many.as_bytes()))), [431]);
    let path = format!("GET {whole}&{} HTTP/1.1\r\nHost: {}\r\n\r\n", "a".repeat(20_000), served.own());
    assert_eq!(codes(&received(sent(&served, path.as_bytes()))), [431]);
    let after = assert_answers(&mut served, "at the end");
    assert!(before.zip(after).is_none_or(|(before, after)| after < before + MAX_GROWTH), "{before:?} {after:?}");
}

/// Unusual requests get one response each, and the next client gets the page.
#[test]
fn odd_requests_are_refused() {
    let mut served = start();
    let (own, whole) = (served.own(), format!("/?token={}", served.token));
    let page = format!("GET {whole} HTTP/1.1\r\nHost: {own}\r\n\r\n");
    let odd: Vec<(Vec<u8>, &[u16])> = vec![
        (b"\r\n\r\n".to_vec(), &[400]),
        (b"\0\0\0\0\r\n\r\n".to_vec(), &[400]),
        (b"\x16\x03\x01\x02\x00\x01\x00\r\n\r\n".to_vec(), &[400]),
        (b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n".to_vec(), &[505]),
        (b"GET / HTTP/1.1\r\n\r\n".to_vec(), &[403]),
        (b"GET /\xff\xfe HTTP/1.1\r\nHost: x\r\n\r\n".to_vec(), &[400]),
        (
            format!("GET {whole} HTTP/1.1\r\nHost: {own}\r\nX: \u{fffd}")
                .into_bytes()
                .into_iter()
                .chain(*b"\xff\r\n\r\n")
                .collect(),
            &[400],
        ),
        (format!("GET {whole} HTTP/1.1\r\nHost: {own}\r\n folded\r\n\r\n").into_bytes(), &[400]),
        (format!("GET {whole} HTTP/1.1\r\nHost: {own}\r\nHost: {own}\r\n\r\n").into_bytes(), &[403]),
        (format!("GET http://{own}{whole} HTTP/1.1\r\nHost: {own}\r\n\r\n").into_bytes(), &[400]),
        (format!("GET {whole} HTTP/3.0\r\nHost: {own}\r\n\r\n").into_bytes(), &[505]),
        // The second request on a connection is never read.
        (format!("{page}{page}").into_bytes(), &[200]),
        (format!("GET / HTTP/1.1\r\nHost: x\r\nContent-Length: 9\r\n\r\n{page}").into_bytes(), &[403]),
        (
            format!(
                "POST {} HTTP/1.1\r\nHost: {own}\r\nContent-Length: 11\r\nExpect: 100-continue\r\n\r\n{{\"case\": 0}}",
                whole.replace("/?", "/answer?")
            )
            .into_bytes(),
            &[100, 200],
        ),
    ];
    for (bytes, expected) in odd {
        let said = String::from_utf8_lossy(&bytes).into_owned();
        assert_eq!(codes(&received(sent(&served, &bytes))), expected, "{said}");
        assert_answers(&mut served, &said);
    }
    // Connections that the client closes for writing after any byte of a request.
    for end in 0..=page.len() {
        let stream = sent(&served, &page.as_bytes()[..end]);
        stream.shutdown(Shutdown::Write).expect("half closed");
        let expected: &[u16] = match end {
            0 => &[],
            end if end < page.len() => &[400],
            _ => &[200],
        };
        assert_eq!(codes(&received(stream)), expected, "{end}");
    }
    assert_answers(&mut served, "half closed sockets");
}
