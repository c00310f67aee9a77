//! A response and its bytes.

/// A response to a request.
pub struct Answer {
    /// HTTP status code.
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

    /// The bytes of the response. Its headers forbid storage by browsers and access by other sites.
    pub(super) fn bytes(&self, policy: &str) -> Vec<u8> {
        let head = format!(
            "HTTP/1.1 {} {}\r\nContent-Type: {}\r\nContent-Length: {}\r\nContent-Security-Policy: {policy}\r\n\
             Cache-Control: no-store\r\nReferrer-Policy: no-referrer\r\nX-Content-Type-Options: nosniff\r\n\
             Cross-Origin-Resource-Policy: same-origin\r\nConnection: close\r\n\r\n",
            self.code,
            reason(self.code),
            self.kind,
            self.body.len()
        );
        [head.as_bytes(), &self.body].concat()
    }
}

/// The reason phrase of a status code (RFC 9110).
fn reason(code: u16) -> &'static str {
    match code {
        200 => "OK",
        403 => "Forbidden",
        404 => "Not Found",
        405 => "Method Not Allowed",
        408 => "Request Timeout",
        411 => "Length Required",
        413 => "Content Too Large",
        417 => "Expectation Failed",
        431 => "Request Header Fields Too Large",
        500 => "Internal Server Error",
        503 => "Service Unavailable",
        505 => "HTTP Version Not Supported",
        _ => "Bad Request",
    }
}
