//! Every page allows its own scripts and its style sheet, and nothing else.

use crate::serve::{Asked, Session};
use voussoir_report::kinds::read_source_beside;
use voussoir_report::writers::page::sha256::source;
use voussoir_study::cases::Unobserved;
use voussoir_study::kind::RunRequest;
use voussoir_study::study::{Study, StudySource};

const ARCH: &str = r#"
name = "arch"
[scene]
scene = "arch"
profile = { shape = "segmental", span = 4.0, rise = 1.0 }
thickness = 0.3
width = 1.0
voussoirs = 7
ends = "jointed"
material = "<b onclick='alert(1)'>"
joint = "dry"
[materials."<b onclick='alert(1)'>"]
law = "rigid"
density = 2200.0
[joints.dry]
law = "coulomb_associated"
friction = 0.6
[[stages]]
name = "</script><script>alert(1)</script>"
gravity = 9.81
[[stages]]
name = "live"
until = "collapse"
loads = [{ kind = "point", span_fraction = 0.3, force = [0.0, -1000.0] }]
"#;

const REPORT: &str = r#"
name = "report"
kind = "report"
[report]
title = "</title><script>alert(1)</script>"
studies = ["arch.toml"]
text = ["[a](javascript:alert(1)) <script>alert(1)</script> [b](https://example.org) ![c](mechanism:loads@0)\n\n| a |\n|--:|\n| b |"]
[report.series]
loads = { study = "arch" }
"#;

fn source_of(text: &str) -> StudySource {
    StudySource::parse(text, "study.toml", &[]).unwrap_or_else(|wrong| panic!("{wrong}"))
}

/// Returns the pages that `run` writes for a study.
fn written(text: &str) -> Vec<String> {
    let read = |_: &str| Ok(ARCH.to_string());
    let study = read_source_beside(source_of(text), &read).unwrap_or_else(|wrong| panic!("{wrong}"));
    let request = |count: usize| RunRequest { wanted: (0..count).collect(), jobs: 1, ..RunRequest::default() };
    let of_part = |part: &voussoir_study::kind::Part| {
        let output = part.study.run(&request(part.study.count()), &Unobserved);
        let (_, bytes) = output.files.into_iter().find(|(name, _)| name == "results.json").expect("results");
        String::from_utf8(bytes).expect("text")
    };
    let parts = study.parts().iter().map(of_part).collect();
    let output = study.run(&RunRequest { parts, ..request(study.count()) }, &Unobserved);
    let pages = output.files.into_iter().filter(|(name, _)| name.ends_with(".html"));
    pages.map(|(_, bytes)| String::from_utf8(bytes).expect("text")).collect()
}

/// Returns the texts of all elements with this name and no attributes.
fn elements<'a>(page: &'a str, name: &str) -> Vec<&'a str> {
    let end = format!("</{name}>");
    page.split(&format!("<{name}>")).skip(1).map(|rest| rest.split(&end).next().unwrap_or_default()).collect()
}

/// One directive of a policy.
fn directive<'a>(policy: &'a str, name: &str) -> &'a str {
    policy.split("; ").find_map(|own| own.strip_prefix(name)).unwrap_or_else(|| panic!("no {name} in {policy}")).trim()
}

/// Checks a page and returns its policy.
fn assert_safe(page: &str) -> String {
    let (_, rest) = page.split_once("<meta http-equiv=\"Content-Security-Policy\" content=\"").expect("a policy");
    let policy = rest.split('"').next().expect("an end").to_string();
    let head = page.find("http-equiv").expect("a policy");
    assert!(!page[..head].contains("<script") && !page[..head].contains("<style"), "the policy comes first");
    assert!(!policy.contains("unsafe") && policy.starts_with("default-src 'none'"), "{policy}");
    assert_eq!(directive(&policy, "base-uri"), "'none'");
    let [script] = elements(page, "script")[..] else { panic!("a page has one script") };
    assert!(directive(&policy, "script-src").split(' ').any(|own| own == source(script)), "{policy}");
    let styles = elements(page, "style");
    let hashes: Vec<String> = styles.iter().map(|style| source(style)).collect();
    assert_eq!(directive(&policy, "style-src"), hashes.join(" "));
    // The other script element contains data, which browsers do not run.
    assert_eq!(page.matches("<script").count(), 2);
    assert_eq!(page.matches("<script type=\"application/json\" id=\"cases\">").count(), 1);
    let body = styles.iter().fold(page.replace(script, ""), |body, style| body.replace(style, ""));
    for tag in body.split('<').skip(1).map(|rest| rest.split('>').next().unwrap_or_default()) {
        // The tag without the quoted values of its attributes.
        let bare: String = tag.split('"').step_by(2).collect();
        assert!(!bare.contains(" on") && !bare.contains(" style="), "{tag}");
        let address = tag.split_once(" href=\"").map_or("", |(_, rest)| rest.split('"').next().unwrap_or_default());
        assert!(!address.contains(':') || address == "data:," || address == "https://example.org", "{tag}");
    }
    policy
}

#[test]
fn scripts_of_every_page_match_its_policy() {
    let session = Session::read(source_of(ARCH)).unwrap_or_else(|wrong| panic!("{wrong}"));
    let opened = session.report(&Asked::default(), &Unobserved).expect("a report");
    let served = session.page(0).expect("a page");
    let pages = [written(ARCH), written(REPORT), vec![opened.clone(), served.clone()]].concat();
    assert_eq!(pages.len(), 4);
    pages.iter().for_each(|page| drop(assert_safe(page)));
    // Both policies apply to a report that is opened from a served page.
    let policy = assert_safe(&served);
    assert_eq!(policy, voussoir_report::writers::page::served_policy());
    for script in elements(&opened, "script") {
        assert!(directive(&policy, "script-src").contains(&source(script)), "{policy}");
    }
}

/// `[record]` gives a report its head, with the names as text; it belongs to no case, so a new checker changes no case.
#[test]
fn a_record_is_the_head_of_the_report_and_of_no_case() {
    let signed = |checker: &str| {
        ARCH.replacen("[scene]", &format!("[record]\nauthor = \"<i>A</i>\"\nchecker = \"{checker}\"\n[scene]"), 1)
    };
    let head = "<table class=\"title-block\">";
    let page = &written(&signed("C. Wright"))[0];
    for part in [head, "&lt;i&gt;A&lt;/i&gt;", "C. Wright", "Signed", "SHA-256 of the study"] {
        assert!(page.contains(part), "{part}");
    }
    assert!(!written(ARCH)[0].contains(head));
    let hash = |text: &str| Study::from_toml(text).unwrap_or_else(|wrong| panic!("{wrong}")).cases[0].hash();
    assert_eq!(hash(&signed("C. Wright")), hash(ARCH));
    let swept = signed("C. Wright") + "[sweep]\n\"record.author\" = { list = [\"a\", \"b\"] }\n";
    assert!(Study::from_toml(&swept).expect_err("a mistake").to_string().contains("is the same for all cases"));
}
