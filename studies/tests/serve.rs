//! `voussoir serve`: who is let in, and that it answers as `run` does. The page is used by `.ci/page`.

use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};

struct Served {
    program: Child,
    port: u16,
    token: String,
}

impl Drop for Served {
    fn drop(&mut self) {
        drop(self.program.kill());
        drop(self.program.wait());
    }
}

impl Served {
    fn start(study: &str) -> Served {
        let mut program = Command::new(env!("CARGO_BIN_EXE_voussoir"))
            .args(["serve", study])
            .stdout(Stdio::piped())
            .spawn()
            .expect("the program starts");
        let mut line = String::new();
        BufReader::new(program.stdout.as_mut().expect("its output")).read_line(&mut line).expect("its address");
        let (_, place) = line.trim().split_once("http://127.0.0.1:").unwrap_or_else(|| panic!("{line}"));
        let (port, token) = place.split_once("/?token=").expect("a token");
        assert_eq!(token.len(), 32);
        Served { port: port.parse().expect("a port"), token: token.into(), program }
    }

    /// Status and body of the answer to a request as it is written here.
    fn raw(&self, request: &str) -> (u16, String) {
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

    fn ask(&self, method: &str, path: &str, host: &str, body: &str) -> (u16, String) {
        let length = body.len();
        self.raw(&format!(
            "{method} {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\nContent-Length: {length}\r\n\r\n{body}"
        ))
    }

    fn own(&self) -> String {
        format!("127.0.0.1:{}", self.port)
    }

    fn answer(&self, asked: &Value) -> Value {
        let path = format!("/answer?token={}", self.token);
        let (code, body) = self.ask("POST", &path, &self.own(), &asked.to_string());
        assert_eq!(code, 200, "{body}");
        serde_json::from_str(&body).unwrap_or_else(|error| panic!("{error}: {body}"))
    }
}

const STUDY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/cases/strathmashie_rise.toml");

/// Nothing passes without its own host, the token, a known path and method, and a body of bounded size.
#[test]
fn only_the_page_itself_is_let_in() {
    let served = Served::start(STUDY);
    let (own, whole) = (served.own(), format!("/?token={}", served.token));
    let code = |method: &str, path: &str, host: &str, body: &str| served.ask(method, path, host, body).0;
    let (page, html) = served.ask("GET", &whole, &own, "");
    assert!(page == 200 && html.contains("data-key=\"scene.profile.rise\""), "{html}");
    assert!(
        html.contains("<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'sha256-")
    );
    assert_eq!(code("GET", &whole, &format!("localhost:{}", served.port), ""), 200);
    for host in ["example.org", "127.0.0.1", &format!("example.org:{}", served.port), ""] {
        assert_eq!(code("GET", &whole, host, ""), 403, "{host}");
    }
    let wrong = format!("/?token={}", "0".repeat(32));
    for path in ["/", "/?token=", &wrong, &format!("{whole}&token=1"), "/answer", "/favicon.ico"] {
        assert_eq!(code("GET", path, &own, ""), 403, "{path}");
    }
    let foreign =
        format!("GET {whole} HTTP/1.1\r\nHost: {own}\r\nOrigin: http://example.org\r\nConnection: close\r\n\r\n");
    assert_eq!(served.raw(&foreign).0, 403);
    for method in ["POST", "PUT", "DELETE", "OPTIONS"] {
        assert_eq!(code(method, &whole, &own, ""), 405, "{method}");
    }
    let answer = whole.replace("/?", "/answer?");
    assert_eq!(code("GET", &answer, &own, ""), 405);
    assert_eq!(code("GET", &whole.replace("/?", "/other?"), &own, ""), 404);
    assert_eq!(code("GET", &format!("{whole}&case=99999"), &own, ""), 404);
    assert_eq!(code("POST", &answer, &own, &" ".repeat(70_000)), 413);
    assert_eq!(code("POST", &answer, &own, "{\"case\": 0, \"run\": 1}"), 400);
}

/// The answer to sliders is that of `run --set`, and its study file gives the same; a mistake has the same words.
#[test]
fn a_served_answer_is_that_of_run() {
    let served = Served::start(STUDY);
    let asked = json!({ "case": 28, "set": [["scene.profile.span", 9.0], ["scene.thickness", "70 cm"], ["scene.voussoirs", 13]] });
    let answer = served.answer(&asked);
    let study = voussoir::study::load(answer["toml"].as_str().expect("a study file"), "seen.toml", &[]);
    let study = study.unwrap_or_else(|wrong| panic!("{wrong}"));
    assert_eq!(study.cases.len(), 1);
    let case = &study.run().cases[0];
    let text = std::fs::read_to_string(STUDY).expect("the study");
    let sets = [("scene.profile.span", "9.0"), ("scene.thickness", "70 cm"), ("scene.voussoirs", "13")];
    let sets = sets.map(|(key, value)| (key.to_string(), value.to_string()));
    let whole = voussoir::study::load(&text, STUDY, &sets).unwrap_or_else(|wrong| panic!("{wrong}"));
    let run = voussoir::solve_case(&whole.cases[28]);
    for factor in [answer["load_factor"].as_f64(), case.load_factor] {
        assert_eq!(factor, run.load_factor);
    }
    assert_eq!((answer["certified"].as_bool(), run.certificate.passed), (Some(true), true));

    let mistake = served.answer(&json!({ "case": 0, "set": [["joints.dry.frction", 0.5]] }));
    let told = voussoir::study::load(&text, STUDY, &[("joints.dry.frction".into(), "0.5".into())]);
    let words = told.expect_err("a mistake").to_string();
    assert!(words.starts_with(mistake["mistakes"].as_str().expect("a text")), "{mistake} {words}");
    // Nothing is read from files, whatever is set.
    let profile = json!({ "shape": "points", "file": "/etc/hostname" });
    let file = served.answer(&json!({ "case": 0, "set": [["scene.profile", profile]] }));
    assert!(file["mistakes"].as_str().is_some_and(|text| text.contains("file")), "{file}");
}
