//! `voussoir serve`: access checks, and the same results as `run`. `.ci/page` tests the page itself.

mod served;

use serde_json::{Value, json};
use served::{STUDY, Served};

/// A request is accepted only with the right host, the token, a known path and method, and a body of limited size.
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

fn answered(served: &Served, asked: &Value) -> Value {
    let path = format!("/answer?token={}", served.token);
    let (code, body) = served.ask("POST", &path, &served.own(), &asked.to_string());
    assert_eq!(code, 200, "{body}");
    serde_json::from_str(&body).unwrap_or_else(|error| panic!("{error}: {body}"))
}

/// The result for slider values equals that of `run --set`, and the downloaded study file gives the same result.
/// Mistakes have the same messages.
#[test]
fn a_served_answer_is_that_of_run() {
    let served = Served::start(STUDY);
    let asked = json!({ "case": 28, "set": [["scene.profile.span", 9.0], ["scene.thickness", "70 cm"], ["scene.voussoirs", 13]] });
    let answer = answered(&served, &asked);
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

    let mistake = answered(&served, &json!({ "case": 0, "set": [["joints.dry.frction", 0.5]] }));
    let told = voussoir::study::load(&text, STUDY, &[("joints.dry.frction".into(), "0.5".into())]);
    let words = told.expect_err("a mistake").to_string();
    assert!(words.starts_with(mistake["mistakes"].as_str().expect("a text")), "{mistake} {words}");
    // No setting makes the server read files.
    let profile = json!({ "shape": "points", "file": "/etc/hostname" });
    let file = answered(&served, &json!({ "case": 0, "set": [["scene.profile", profile]] }));
    assert!(file["mistakes"].as_str().is_some_and(|text| text.contains("file")), "{file}");
}
