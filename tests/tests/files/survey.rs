//! Profiles from a file beside the study: the points of the file are the points of the resolved study.

use voussoir::kinds::read_source;
use voussoir::study::{StudySource, load};
use voussoir_tests::{assert_close, changed, collapse_factor};

const STUDY: &str = r#"
name = "surveyed"
[scene]
scene = "arch"
width = 1.0
material = "stone"
joint = "dry"
profile = { shape = "points", file = "survey.csv" }
[materials.stone]
law = "rigid"
density = 2000.0
[joints.dry]
law = "coulomb_associated"
friction = 0.6
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "live"
until = "collapse"
loads = [{ kind = "point", span_fraction = 0.3, force = [0.0, -1000.0] }]
"#;

/// Five voussoirs, joint by joint, in millimetres.
const SURVEY: &str = "intrados_x [mm],intrados_y [mm],extrados_x [mm],extrados_y [mm]\n\
    -2000,0,-2300,250\n-1300,700,-1480,1070\n-450,980,-500,1370\n450,980,500,1370\n1300,700,1480,1070\n2000,0,2300,250\n";

const POINTS: &str = "intrados = [[-2.0, 0.0], [-1.3, 0.7], [-0.45, 0.98], [0.45, 0.98], [1.3, 0.7], [2.0, 0.0]], \
    extrados = [[-2.3, 0.25], [-1.48, 1.07], [-0.5, 1.37], [0.5, 1.37], [1.48, 1.07], [2.3, 0.25]]";

#[test]
fn a_survey_is_its_points() {
    let read = |file: &str| if file == "survey.csv" { Ok(SURVEY.to_string()) } else { Err("not there".into()) };
    let source = StudySource::parse_with(STUDY, "a.toml", &[], &read).expect("a study");
    let resolved = toml::to_string(&source.root.to_toml()).expect("TOML");
    assert!(!resolved.contains("survey.csv"), "{resolved}");
    // Read again without any file, as `verify` does.
    assert!(load(&resolved, "resolved.toml", &[]).is_ok());
    let by_hand = changed(STUDY, "file = \"survey.csv\"", POINTS);
    assert_close(collapse_factor(&resolved), collapse_factor(&by_hand), 1e-12);
}

/// Mistakes in the file are reported at its line, mistakes in its name in the study.
#[test]
fn mistakes_of_a_survey() {
    let said = |text: &str, survey: Option<&str>| {
        let read = |_: &str| survey.map(str::to_string).ok_or("there is none".to_string());
        StudySource::parse_with(text, "a.toml", &[], &read).and_then(read_source).err().expect("a mistake").mistakes()
            [0]
        .to_string()
    };
    let broken = changed(SURVEY, "-450,980,-500,1370", "-450,980,-500,1e");
    assert_eq!(said(STUDY, Some(&broken)), "survey.csv:4:15: \"1e\" is not a number");
    assert_eq!(said(STUDY, None), "a.toml:8:38: profile.file: \"survey.csv\" cannot be read: there is none");
    let twice = changed(STUDY, ", file = ", ", intrados = [[0.0, 0.0], [1.0, 0.0]], file = ");
    assert!(said(&twice, Some(SURVEY)).contains("is given besides intrados"));
    assert!(load(STUDY, "a.toml", &[]).is_err());
}
