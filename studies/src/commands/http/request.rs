//! The head of a request (RFC 9112). The parser is strict: it refuses anything unusual.

use super::answer::Answer;

/// A request without its body.
#[derive(Debug, PartialEq)]
pub(super) struct Request {
    /// Method, in capitals.
    pub method: String,
    /// Path before the question mark.
    pub path: String,
    /// Key and value pairs after the question mark. Escapes are not decoded, because tokens and ids contain none.
    pub query: Vec<(String, String)>,
    headers: Vec<(String, String)>,
}

fn is_token(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|b| b.is_ascii_alphanumeric() || b"!#$%&'*+-.^_`|~".contains(&b))
}

fn malformed(what: &str) -> Answer {
    Answer::text(400, format!("the request is malformed: {what}"))
}

impl Request {
    /// Reads a head without the empty line at its end.
    pub fn parse(head: &[u8]) -> Result<Self, Answer> {
        let text = std::str::from_utf8(head).map_err(|_| malformed("it is not UTF-8"))?;
        let mut lines = text.split("\r\n");
        let first = lines.next().unwrap_or_default();
        let [method, target, version] = first.split(' ').collect::<Vec<_>>()[..] else {
            return Err(malformed("its first line has not three words"));
        };
        if !version.starts_with("HTTP/") {
            return Err(malformed("it names no version"));
        }
        if version != "HTTP/1.1" && version != "HTTP/1.0" {
            return Err(Answer::text(505, "only HTTP/1.1 is spoken here"));
        }
        if !is_token(method) || !target.starts_with('/') || first.chars().any(char::is_control) {
            return Err(malformed("its first line is not METHOD /PATH HTTP/1.1"));
        }
        let header = |line: &str| {
            let (name, value) = line.split_once(':')?;
            let value = value.trim_matches([' ', '\t']);
            let plain = value.chars().all(|c| c == '\t' || !c.is_control());
            (is_token(name) && plain).then(|| (name.to_string(), value.to_string()))
        };
        let headers: Option<Vec<_>> = lines.map(header).collect();
        let (path, query) = target.split_once('?').unwrap_or((target, ""));
        let pairs = query.split('&').filter_map(|pair| pair.split_once('='));
        Ok(Request {
            method: method.into(),
            path: path.into(),
            query: pairs.map(|(key, value)| (key.into(), value.into())).collect(),
            headers: headers.ok_or_else(|| malformed("a header is not NAME: VALUE"))?,
        })
    }

    /// All values of a header.
    pub fn header(&self, name: &str) -> Vec<&str> {
        let own = self.headers.iter().filter(|(own, _)| own.eq_ignore_ascii_case(name));
        own.map(|(_, value)| value.as_str()).collect()
    }

    /// Length of the body in bytes; refuses more than `most`.
    pub fn body_length(&self, most: usize) -> Result<usize, Answer> {
        if !self.header("Transfer-Encoding").is_empty() {
            return Err(Answer::text(411, "a body needs a Content-Length"));
        }
        match self.header("Content-Length")[..] {
            [] => Ok(0),
            [length] if !length.is_empty() && length.bytes().all(|b| b.is_ascii_digit()) => {
                let length = length.parse().ok().filter(|length| *length <= most);
                length.ok_or_else(|| Answer::text(413, format!("more than {most} bytes are not read")))
            }
            _ => Err(malformed("its Content-Length is not one whole number")),
        }
    }

    /// Returns true if the client sends the body only after an interim response.
    pub fn waits_for_permission(&self) -> Result<bool, Answer> {
        match self.header("Expect")[..] {
            [] => Ok(false),
            [only] if only.eq_ignore_ascii_case("100-continue") => Ok(true),
            _ => Err(Answer::text(417, "nothing but 100-continue can be expected")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn code(head: &[u8]) -> u16 {
        Request::parse(head).map_or_else(|refusal| refusal.code, |_| 200)
    }

    #[test]
    fn a_head_is_read() {
        let request =
            Request::parse(b"POST /a?token=1&b=c=d&e HTTP/1.1\r\nhost: x\r\nHOST:\ty \r\nContent-Length: 7").ok();
        let request = request.expect("a request");
        assert_eq!((request.method.as_str(), request.path.as_str()), ("POST", "/a"));
        assert_eq!(request.query, [("token", "1"), ("b", "c=d")].map(|(a, b)| (a.to_string(), b.to_string())));
        assert_eq!(request.header("Host"), ["x", "y"]);
        assert_eq!(request.body_length(7).ok(), Some(7));
        assert_eq!(request.body_length(6).err().map(|refusal| refusal.code), Some(413));
    }

    #[test]
    fn anything_unusual_is_refused() {
        let malformed: [&[u8]; 21] = [
            b"",
            b"GET",
            b"GET /",
            b"GET  / HTTP/1.1",
            b"GET / HTTP/1.1 ",
            b" GET / HTTP/1.1",
            b"GET\t/ HTTP/1.1",
            b"G(T / HTTP/1.1",
            b"GET http://127.0.0.1/ HTTP/1.1",
            b"GET * HTTP/1.1",
            b"GET /\0 HTTP/1.1",
            b"GET /\n HTTP/1.1",
            b"GET / HTTP/1.1\r\n",
            b"GET / HTTP/1.1\r\nHost",
            b"GET / HTTP/1.1\r\nHost : x",
            b"GET / HTTP/1.1\r\n: x",
            b"GET / HTTP/1.1\r\nA: b\r\n c",
            b"GET / HTTP/1.1\r\nA: b\nHost: x",
            b"GET / HTTP/1.1\r\nA: b\rc",
            b"GET /\xff HTTP/1.1",
            b"GET / HTTP/1.1\r\nA: \xc3\x28",
        ];
        for head in malformed {
            assert_eq!(code(head), 400, "{}", String::from_utf8_lossy(head));
        }
        assert_eq!(code(b"GET / HTTP/2.0"), 505);
        assert_eq!(code("GET /?a=\u{e9} HTTP/1.0\r\nA: \u{e9}".as_bytes()), 200);
    }

    #[test]
    fn only_one_whole_length_is_a_length() {
        let length = |headers: &str| {
            let request =
                Request::parse(format!("POST / HTTP/1.1\r\nHost: x{headers}").as_bytes()).ok().expect("a request");
            request.body_length(64).map_err(|refusal| refusal.code)
        };
        assert_eq!((length(""), length("\r\nContent-Length: 064")), (Ok(0), Ok(64)));
        for value in ["-1", "+1", "1.0", "1e3", "0x10", "", "1, 1", "1 1", "a", "\u{661}"] {
            assert_eq!(length(&format!("\r\nContent-Length: {value}")), Err(400), "{value}");
        }
        for value in ["65", "100000000000", "18446744073709551615", "18446744073709551616", &"9".repeat(400)] {
            assert_eq!(length(&format!("\r\nContent-Length: {value}")), Err(413), "{value}");
        }
        assert_eq!(length("\r\nContent-Length: 1\r\ncontent-length: 1"), Err(400));
        for coding in ["chunked", "identity", "gzip, chunked", ""] {
            assert_eq!(length(&format!("\r\nContent-Length: 1\r\nTransfer-Encoding: {coding}")), Err(411), "{coding}");
        }
    }
}
