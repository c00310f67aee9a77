//! Drawings (DXF files) as profiles and as blocks.

use voussoir::kinds::read_source;
use voussoir::solve_case;
use voussoir::study::{StudyError, StudySource, load};

/// A polyline as DXF; a closed polyline does not repeat its first corner.
fn polyline(handle: &str, layer: &str, closed: bool, points: &[[f64; 2]]) -> String {
    let corners: String = points.iter().map(|[x, y]| format!("10\n{x:?}\n20\n{y:?}\n")).collect();
    format!(
        "0\nLWPOLYLINE\n5\n{handle}\n100\nAcDbEntity\n8\n{layer}\n100\nAcDbPolyline\n90\n{}\n70\n{}\n{corners}",
        points.len(),
        u8::from(closed)
    )
}

/// A drawing in millimetres.
fn drawing(entities: &[String]) -> String {
    format!(
        "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1021\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n{}0\n\
         ENDSEC\n0\nEOF\n",
        entities.concat()
    )
}

const HEAD: &str = "name = \"drawn\"\n[materials.stone]\nlaw = \"rigid\"\ndensity = 2000.0\n[joints.dry]\n\
    law = \"coulomb_associated\"\nfriction = 0.6\n[[stages]]\nname = \"dead\"\ngravity = 9.81\n[[stages]]\nname = \"live\"\n\
    until = \"collapse\"\n";

/// Returns the load factor of a study. It must be the same if the resolved text is read again. Returns the message if
/// the study is refused.
fn answered(text: &str, file: &str) -> Result<f64, String> {
    let read = |name: &str| if name == "survey.dxf" { Ok(file.to_string()) } else { Err("not there".into()) };
    let said = |wrong: StudyError| wrong.to_string();
    let source = StudySource::parse_with(text, "a.toml", &[], &read).map_err(said)?;
    let resolved = toml::to_string(&source.root.to_toml()).expect("TOML");
    assert!(!resolved.contains("survey.dxf"), "{resolved}");
    read_source(source).map_err(said)?;
    let study = load(&resolved, "resolved.toml", &[]).map_err(said)?;
    let result = solve_case(&study.cases[0]);
    assert!(result.certificate.passed, "{:?}", result.certificate);
    Ok(result.load_factor.expect("a collapse"))
}

const PUSH: &str = "loads = [{ kind = \"point\", block = \"stone 2\", point = [0.0, 0.9], force = [1000.0, 0.0] }]\n";

fn blocks(extra: &str) -> String {
    format!(
        "{HEAD}{PUSH}[scene]\nscene = \"blocks\"\nwidth = 1.0\nmaterial = \"stone\"\njoint = \"dry\"\nfile = \"survey.dxf\"\n{extra}"
    )
}

fn rectangle([x0, y0]: [f64; 2], [x1, y1]: [f64; 2]) -> [[f64; 2]; 4] {
    [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]
}

/// Two stones on the ground are pushed at the top: the upper one tips at W b/(2 h), the tower at 2 W b/(2 · 0.9).
#[test]
fn closed_polylines_are_blocks() {
    let file = drawing(&[
        polyline("2A", "ground", true, &rectangle([-500.0, -300.0], [1000.0, 0.0])),
        polyline("2B", "stone", true, &rectangle([0.0, 0.0], [400.0, 500.0])),
        polyline("2C", "stone", true, &rectangle([0.0, 500.0], [400.0, 1000.0])),
    ]);
    let weight = 2000.0 * 9.81 * 0.4 * 0.5;
    let upper: f64 = weight * 0.2 / 0.4 / 1000.0;
    let tower: f64 = 2.0 * weight * 0.2 / 0.9 / 1000.0;
    let factor = answered(&blocks(""), &file).expect("an answer");
    assert!((factor - upper.min(tower)).abs() < 1e-9 * factor, "{factor} {upper} {tower}");
    // With a unit other than that in the drawing, the tower is ten times as large, and the load does not act on it.
    assert!(answered(&blocks("unit = \"cm\"\n"), &file).is_err());
}

/// Messages name entity, line and layer.
#[test]
fn mistakes_name_the_entity() {
    let ground = polyline("2A", "ground", true, &rectangle([-500.0, -300.0], [1000.0, 0.0]));
    let open = polyline("2B", "stone", false, &rectangle([0.0, 0.0], [400.0, 500.0]));
    let said = answered(&blocks(""), &drawing(&[ground.clone(), open])).expect_err("a mistake");
    assert!(said.contains("scene.file: \"survey.dxf\": LWPOLYLINE 2B (line"), "{said}");
    assert!(said.contains("on layer \"stone\" is not closed"), "{said}");
    let other = polyline("2C", "stome", true, &rectangle([0.0, 0.0], [400.0, 500.0]));
    let said = answered(&blocks(""), &drawing(&[ground, other])).expect_err("a mistake");
    assert!(said.contains("layer \"stome\"") && said.contains("did you mean \"stone\"?"), "{said}");
    assert!(answered(&blocks(""), "no drawing at all").is_err());
    let twice = blocks("blocks = []\n");
    assert!(answered(&twice, &drawing(&[])).expect_err("a mistake").contains("is given besides blocks"));
}

/// Two open polylines, one drawn from right to left, give the same profile as their points.
#[test]
fn polylines_are_a_profile() {
    let inner = [[-2.0, 0.0], [-1.3, 0.7], [-0.45, 0.98], [0.45, 0.98], [1.3, 0.7], [2.0, 0.0]];
    let outer = [[-2.3, 0.25], [-1.48, 1.07], [-0.5, 1.37], [0.5, 1.37], [1.48, 1.07], [2.3, 0.25]];
    let scaled = |points: &[[f64; 2]]| points.iter().map(|p| p.map(|x| (1000.0 * x).round())).collect::<Vec<_>>();
    let mut turned = scaled(&outer);
    turned.reverse();
    let file = drawing(&[
        polyline("2A", "Intrados", false, &scaled(&inner)),
        polyline("2B", "EXTRADOS", false, &turned),
        polyline("2C", "0", true, &rectangle([0.0, 0.0], [1.0, 1.0])),
    ]);
    let scene = |profile: &str| {
        format!(
            "{HEAD}loads = [{{ kind = \"point\", span_fraction = 0.3, force = [0.0, -1000.0] }}]\n[scene]\nscene = \"arch\"\n\
             width = 1.0\nmaterial = \"stone\"\njoint = \"dry\"\nprofile = {{ shape = \"points\", {profile} }}\n"
        )
    };
    let by_hand = scene(&format!("intrados = {inner:?}, extrados = {outer:?}"));
    let drawn = answered(&scene("file = \"survey.dxf\""), &file).expect("an answer");
    let given = answered(&by_hand, &file).expect("an answer");
    assert!((drawn - given).abs() < 1e-12 * given, "{drawn} {given}");
    let said =
        answered(&scene("file = \"survey.dxf\""), &drawing(&[polyline("2A", "intrados", false, &scaled(&inner))]));
    assert!(said.expect_err("a mistake").contains("there is no polyline on layer \"extrados\""));
}
