//! `voussoir serve`: access checks, and the same results as `run`. `.ci/page` tests the page itself.

mod served;

use serde_json::{Value, json};
use served::{BRIDGE, SLOW, STUDY, Served};
use std::process::Command;
use std::time::{Duration, Instant};

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
    posted(served, "answer", asked)
}

fn posted(served: &Served, name: &str, asked: &Value) -> Value {
    let path = format!("/{name}?token={}", served.token);
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

/// A law is replaced as `--set` would replace it. Keys that the new law does not have are dropped, and missing ones have example
/// values that are listed.
#[test]
fn laws_and_solvers_are_replaced() {
    let served = Served::start(STUDY);
    let factor = |asked: &Value| answered(&served, asked)["load_factor"].as_f64();
    let own = factor(&json!({ "case": 9 }));
    for (table, tag, key) in [
        ("joints.dry", "coulomb", "joints.dry.law"),
        ("solver", "limit_conic", "solver.solver"),
        ("solver", "auto", "solver.solver"),
    ] {
        let expected = factor(&json!({ "case": 9, "set": [[key, tag]] }));
        assert!(expected.is_some(), "{table} {tag}");
        let swapped = answered(&served, &json!({ "case": 9, "swap": [[table, tag]] }));
        assert!(swapped["sampled"].is_null(), "{table} {tag}: {}", swapped["sampled"]);
        assert_eq!(swapped["load_factor"].as_f64(), expected, "{table} {tag}");
    }
    // The friction that the page has changed belongs to the law before.
    let set = json!([["joints.dry.friction", 0.3]]);
    let stuck =
        answered(&served, &json!({ "case": 9, "set": set, "swap": [["joints.dry", "unilateral"]], "controls": true }));
    assert!(stuck["load_factor"].as_f64() >= own && stuck["sampled"].is_null(), "{stuck}");
    let controls = stuck["controls"].as_str().expect("controls");
    assert!(controls.contains("data-table=\"joints.dry\"") && !controls.contains("joints.dry.friction"), "{controls}");
    let cohesive = answered(&served, &json!({ "case": 9, "swap": [["joints.dry", "cohesive"]] }));
    assert!(
        cohesive["sampled"].as_str().is_some_and(|words| words.contains("joints.dry.tensile_strength")),
        "{cohesive}"
    );
    assert!(!cohesive["sampled"].as_str().is_some_and(|words| words.contains("friction,")), "{cohesive}");
    for (table, tag) in [("joints.dry", "no_law"), ("scene", "wall"), ("stages.0", "x"), ("", "x")] {
        let wrong = answered(&served, &json!({ "case": 9, "swap": [[table, tag]], "controls": true }));
        assert!(wrong["mistakes"].is_string() && wrong["controls"].is_string(), "{table} {tag}: {wrong}");
    }
}

/// The most onerous position is not less onerous than any other, and the load there gives the same answer.
#[test]
fn the_most_onerous_position_is_followed() {
    let served = Served::start(BRIDGE);
    let page = served.ask("GET", &format!("/?token={}", served.token), &served.own(), "").1;
    assert!(
        page.contains("data-follow=\"stages.1.loads.0.at\"") && page.contains("<summary>Coordinates (40)</summary>")
    );
    let factor = |asked: &Value| answered(&served, asked)["load_factor"].as_f64().unwrap_or(f64::INFINITY);
    let set = json!([["materials.brick.density", 2400.0]]);
    let found = answered(&served, &json!({ "case": 0, "set": set, "follow": "stages.1.loads.0.at" }));
    let least = found["load_factor"].as_f64().expect("a factor");
    let mut at = vec![json!(["materials.brick.density", 2400.0])];
    for place in [0.5, 1.5, 2.5, 3.5, 4.5, 5.5] {
        let moved = json!([["materials.brick.density", 2400.0], ["stages.1.loads.0.at", place]]);
        assert!(factor(&json!({ "case": 0, "set": moved })) >= least * (1.0 - 1e-9), "{place}");
    }
    at.extend(found["position"].as_array().expect("a position").iter().cloned());
    assert_eq!(factor(&json!({ "case": 0, "set": at })), least);
    assert!(found["handles"][0]["axles"].as_array().is_some_and(|axles| !axles.is_empty()), "{}", found["handles"]);
    let wrong = answered(&served, &json!({ "case": 0, "follow": "scene.width.x" }));
    assert!(wrong["mistakes"].is_string(), "{}", wrong["headline"]);
}

/// A path that takes long has progress. A newer request of its page ends it, one of another page does not; so does `stop`.
#[test]
fn a_slow_path_is_replaced_or_stopped() {
    let served = Served::start(SLOW);
    let (slow, mine, other) =
        (json!({ "case": 0, "page": "a" }), json!({ "case": 0, "page": "a" }), json!({ "case": 0, "page": "b" }));
    let begun = || {
        let start = Instant::now();
        while posted(&served, "progress", &mine)["path"].is_null() {
            assert!(start.elapsed() < Duration::from_secs(60), "no progress");
            std::thread::sleep(Duration::from_millis(50));
        }
    };
    let chain = json!([["solver", "limit_chain"]]);
    std::thread::scope(|scope| {
        let first = scope.spawn(|| answered(&served, &slow));
        begun();
        assert!(posted(&served, "progress", &other).is_null());
        let quick = answered(&served, &json!({ "case": 0, "page": "b", "swap": chain }));
        assert_eq!(quick["status"], "collapse");
        assert!(!first.is_finished());
        answered(&served, &json!({ "case": 0, "page": "a", "swap": chain }));
        let first = first.join().expect("an answer");
        assert_eq!(first["stopped"], "replaced by a newer request", "{first}");
        let second = scope.spawn(|| answered(&served, &slow));
        begun();
        posted(&served, "stop", &mine);
        let second = second.join().expect("an answer");
        assert!(second["stopped"].as_str().is_some_and(|words| words.starts_with("stopped;")), "{second}");
        assert!(posted(&served, "progress", &mine).is_null());
    });
}

/// `--port` chooses the port; a port in use is a message.
#[test]
fn the_port_can_be_chosen() {
    let taken = std::net::TcpListener::bind("127.0.0.1:0").expect("a port");
    let port = taken.local_addr().expect("an address").port().to_string();
    let serve = || {
        let mut command = Command::new(env!("CARGO_BIN_EXE_voussoir"));
        command.args(["serve", STUDY, "--port", &port]);
        command
    };
    let refused = serve().output().expect("it ends");
    let words = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(!refused.status.success() && refused.stdout.is_empty(), "{words}");
    assert!(words.contains(&format!("port {port} is used by another program")), "{words}");
    drop(taken);
    assert_eq!(Served::of(&mut serve()).port.to_string(), port);
}
