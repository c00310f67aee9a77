//! Requests to `voussoir serve`: who is let in, how much is read, and what is said besides an answer. Only a page that
//! was opened with the token gets through; a foreign site cannot, also not by a name that it lets point here.

use std::io::Read;
use tiny_http::{Header, Request, Response, Server};

/// Longest body that is read \[bytes\].
const LONGEST: u64 = 64 * 1024;

/// What lets a request in.
pub struct Gate {
    /// The port that it must name.
    pub port: u16,
    /// The token that it must bring.
    pub token: String,
    /// The Content-Security-Policy of every answer.
    pub policy: String,
}

/// What is sent back.
pub struct Answer {
    /// Status code of HTTP.
    pub code: u16,
    /// Content type.
    pub kind: &'static str,
    /// The bytes.
    pub body: Vec<u8>,
}

impl Answer {
    /// Plain text.
    pub fn text(code: u16, words: impl Into<String>) -> Self {
        Answer { code, kind: "text/plain; charset=utf-8", body: words.into().into_bytes() }
    }
}

/// Headers of every answer beside its policy: nothing is stored or told to other sites.
const HEADERS: [(&str, &str); 4] = [
    ("Cache-Control", "no-store"),
    ("Referrer-Policy", "no-referrer"),
    ("X-Content-Type-Options", "nosniff"),
    ("Cross-Origin-Resource-Policy", "same-origin"),
];

fn header<'a>(request: &'a Request, name: &'static str) -> Vec<&'a str> {
    request.headers().iter().filter(|header| header.field.equiv(name)).map(|header| header.value.as_str()).collect()
}

/// Key and value pairs after the question mark; what is escaped stays so, since neither tokens nor ids are.
fn query_of(url: &str) -> Vec<(String, String)> {
    let pairs = url.split_once('?').map_or("", |(_, query)| query).split('&');
    pairs.filter_map(|pair| pair.split_once('=')).map(|(key, value)| (key.into(), value.into())).collect()
}

/// Whether two texts are equal, in a time that does not tell how far they are.
fn equal(a: &str, b: &str) -> bool {
    a.len() == b.len() && a.bytes().zip(b.bytes()).fold(0, |differs, (a, b)| differs | (a ^ b)) == 0
}

impl Gate {
    /// Why a request is not let in.
    fn refuses(&self, request: &Request, query: &[(String, String)]) -> Option<Answer> {
        let own = [format!("127.0.0.1:{}", self.port), format!("localhost:{}", self.port)];
        let [host] = header(request, "Host")[..] else { return Some(Answer::text(403, "one Host is needed")) };
        if !own.iter().any(|name| name == host) {
            return Some(Answer::text(403, "this Host is not served"));
        }
        let foreign = |origin: &&str| !own.iter().any(|name| **origin == format!("http://{name}"));
        if header(request, "Origin").iter().any(foreign) {
            return Some(Answer::text(403, "another site is not answered"));
        }
        let tokens: Vec<&str> = query.iter().filter(|(key, _)| key == "token").map(|(_, own)| own.as_str()).collect();
        match tokens[..] {
            [token] if equal(token, &self.token) => None,
            _ => Some(Answer::text(403, "the address is not whole: its token is missing or wrong")),
        }
    }
}

/// The body of a request; an answer where it is too long or breaks off.
fn body_of(request: &mut Request) -> Result<Vec<u8>, Answer> {
    let too_long = || Answer::text(413, format!("more than {LONGEST} bytes are not read"));
    if request.body_length().is_some_and(|length| length as u64 > LONGEST) {
        return Err(too_long());
    }
    let mut body = Vec::new();
    match request.as_reader().take(LONGEST + 1).read_to_end(&mut body) {
        Ok(_) if body.len() as u64 > LONGEST => Err(too_long()),
        Ok(_) => Ok(body),
        Err(error) => Err(Answer::text(400, error.to_string())),
    }
}

/// What answers: method, path, query and body.
pub type Route<'a> = &'a (dyn Fn(&str, &str, &[(String, String)], &[u8]) -> Answer + Sync);

/// Waits for a request and answers it; `false` when no more will come.
pub fn received(server: &Server, gate: &Gate, route: Route) -> bool {
    let Ok(mut request) = server.recv() else { return false };
    let url = request.url().to_string();
    let query = query_of(&url);
    let path = url.split('?').next().unwrap_or_default();
    let answer = match gate.refuses(&request, &query) {
        Some(refusal) => refusal,
        None => match body_of(&mut request) {
            Ok(body) => route(request.method().as_str(), path, &query, &body),
            Err(refusal) => refusal,
        },
    };
    let own = [("Content-Type", answer.kind), ("Content-Security-Policy", gate.policy.as_str())];
    let headers = HEADERS.iter().copied().chain(own);
    let mut response = Response::from_data(answer.body).with_status_code(answer.code);
    for header in headers.filter_map(|(name, value)| Header::from_bytes(name, value).ok()) {
        response.add_header(header);
    }
    // A reader that has gone away is no error.
    drop(request.respond(response));
    true
}
