//! Labels describe the result: mechanisms of symmetric scenes, crushing, kinds, headlines, figures.

use voussoir::core::certificate::{CRUSHES, MechanismKind};
use voussoir::core::limit::{Greatest, Status};
use voussoir::figures::format::headline;
use voussoir::figures::hinge_list;
use voussoir::figures::{curve_svg, mechanism_svg, scene_svg};
use voussoir::results::CaseResult;
use voussoir::study::Case;
use voussoir_tests::{Arch, Wall, answered, elastic, first_case, friction};

/// A load at midspan has a symmetric mechanism with every solver: the hinges have the same distances from both
/// springings.
#[test]
fn symmetric_scenes_have_symmetric_mechanisms() {
    let mut tried = 0;
    for solver in ["limit_chain", "limit_conic", "event_path", "newton_path"] {
        for (rise, voussoirs) in [(3.89, 15), (2.99, 14), (2.99, 15)] {
            let path = solver.ends_with("path");
            let arch = Arch {
                rise,
                voussoirs,
                solver,
                span_fraction: 0.5,
                ends: "jointed",
                material: if path { elastic(5e9, 0.3) } else { Arch::default().material },
                mesh: if path { "elements = [1, 2]".into() } else { String::new() },
                ..Arch::default()
            };
            let result = answered(&arch.study());
            if result.status != Status::Collapse {
                continue;
            }
            let mechanism = result.mechanism.expect("a mechanism");
            let joints: Vec<usize> = mechanism.hinges.iter().map(|hinge| hinge.joint).collect();
            let mirrored: Vec<usize> = joints.iter().rev().map(|joint| voussoirs - joint).collect();
            assert_eq!(joints, mirrored, "{solver}, rise {rise}, {voussoirs} voussoirs");
            tried += 1;
        }
    }
    assert!(tried >= 10, "{tried} collapses");
}

/// If no law crushes, no crushing is reported, also where open joints close again.
#[test]
fn dry_friction_alone_crushes_nothing() {
    let text = "name = \"gothic\"\n[scene]\nscene = \"arch\"\nprofile = { shape = \"pointed\", span = 4.0, rise = 3.2 }\n\
                thickness = 0.6\nwidth = 0.5\nvoussoirs = 24\nmaterial = \"stone\"\njoint = \"dry\"\n[scene.mesh]\n\
                elements = [1, 2]\n[materials.stone]\nlaw = \"elastic\"\nyoung_modulus = 1e10\npoisson_ratio = 0.2\n\
                density = 2400.0\n[joints.dry]\nlaw = \"coulomb\"\nfriction = 0.7\n[[stages]]\nname = \"dead\"\n\
                gravity = 9.81\n[[stages]]\nname = \"spread\"\nsettlement = [{ support = \"right\", displacement = \
                [0.05, 0.0] }]\n[[stages]]\nname = \"load\"\nuntil = \"collapse\"\nloads = [{ kind = \"point\", \
                span_fraction = 0.3, force = [0.0, -1000.0] }]\n[solver]\nsolver = \"newton_path\"\nkinematics = \"finite\"\n";
    let case = first_case(text);
    let result = voussoir::solve_case(&case);
    let Some(mechanism) = &result.mechanism else { return };
    assert!(mechanism.crushing.is_empty(), "{mechanism:?}");
    let slides = !mechanism.sliding.is_empty();
    assert!(slides || mechanism.kind != MechanismKind::Mixed, "{mechanism:?}");
    assert!(mechanism.kind != MechanismKind::Crushing, "{mechanism:?}");
    assert_uncrushed(&case, &result);
}

/// Asserts that the drawing shows no crushing joint.
fn assert_uncrushed(case: &Case, result: &CaseResult) {
    let svg = mechanism_svg("gothic", &case.assembly, result).expect("a figure");
    assert!(svg.contains("<svg"), "no drawing");
    assert!(!svg.contains("crushes"), "a crushing joint in the legend");
}

/// A joint whose toe crushes over less than the stated share still counts as a hinge.
#[test]
fn a_crushed_toe_is_still_a_hinge() {
    let arch = Arch { joint: friction(0.6), ends: "jointed", voussoirs: 13, ..Arch::default() };
    let case = first_case(&arch.study());
    let mechanism = voussoir::solve_case(&case).mechanism.expect("a mechanism");
    assert_eq!(mechanism.kind, MechanismKind::FourHinge);
    let crushing = |share: f64| {
        let hinge = &mechanism.hinges[0];
        let toe = voussoir::core::certificate::Crushing { joint: hinge.joint, between: hinge.between.clone(), share };
        mechanism.clone().with_crushing(&case.assembly, vec![toe])
    };
    let toe = crushing(0.01);
    assert_eq!((toe.kind, toe.hinge_count, toe.crushing.len()), (MechanismKind::FourHinge, 4, 1));
    assert_eq!(crushing(CRUSHES + 0.01).kind, MechanismKind::Mixed);
    assert_eq!(crushing(CRUSHES + 0.01).hinge_count, 3);
}

/// Neighbours that count as one hinge are listed together: the number of groups is `hinge_count`.
#[test]
fn listed_hinges_are_as_many_as_the_kind_says() {
    for voussoirs in [13, 60, 200] {
        for solver in ["limit_chain", "limit_conic"] {
            let arch = Arch { voussoirs, solver, ends: "jointed", ..Arch::default() };
            let mechanism = answered(&arch.study()).mechanism.expect("a mechanism");
            assert_eq!(hinge_list(&mechanism).len(), mechanism.hinge_count, "{solver}: {mechanism:?}");
        }
    }
}

/// A least load without a proved lower end is an open result: the sentence gives the upper end and no other number.
#[test]
fn a_least_load_without_a_lower_end_is_open() {
    let rows: [&[f64]; 3] = [&[1.0, 1.0], &[0.5, 1.0, 0.5], &[1.0, 1.0]];
    let wall = Wall {
        brick: [0.4, 0.2],
        gravity: 10.0,
        push: [10.0, 0.0],
        joint: "law = \"coulomb\"\nfriction = 0.9".into(),
        solver: "solver = \"limit_least\"\nsearch_limit = 0.0\nproduct_rows = 0".into(),
        ..Wall::of_rows(&rows)
    };
    let case = first_case(&wall.study());
    let result = voussoir::solve_case(&case);
    assert_eq!((result.status, result.greatest), (Status::Open, Greatest::Open), "{:?}", result.notes);
    assert_eq!(result.bounds.expect("bounds"), [None, result.load_factor]);
    let line = headline(&result, &case.stages);
    assert!(line.starts_with("open: proved for the load factor: ≤"), "{line}");
}

/// Figures show settlements and loads of earlier stages; the ring is drawn at the load factor, not at the end of the
/// path.
#[test]
fn figures_show_all_stages_and_the_peak() {
    let arch = Arch {
        material: elastic(5e9, 0.3),
        mesh: "elements = [1, 2]".into(),
        ends: "jointed",
        voussoirs: 9,
        solver: "event_path",
        ..Arch::default()
    };
    let text = arch.study().replace(
        "[[stages]]\nname = \"live\"",
        "[[stages]]\nname = \"crowd\"\nloads = [{ kind = \"point\", span_fraction = 0.7, force = [0.0, -5000.0] }]\n\
         [[stages]]\nname = \"spread\"\nsettlement = [{ support = \"right\", displacement = [0.01, 0.0] }]\n\
         [[stages]]\nname = \"live\"",
    );
    let case = first_case(&text);
    let mut result = voussoir::solve_case(&case);
    let svg = scene_svg("arch", &case.assembly, &case.stages, &result);
    for words in ["load of an earlier stage", "support that moves", "10 mm", "5.000 kN"] {
        assert!(svg.contains(words), "{words}");
    }
    // A branch that falls after its peak.
    result.status = Status::Collapse;
    result.load_factor = Some(3.0);
    result.path.curve = Some(vec![[0.0, 0.0], [0.01, 3.0], [0.05, 0.5]]);
    result.path.events.clear();
    let fallen = curve_svg("arch", &case.assembly, &case.stages, &result).expect("a curve");
    result.path.curve = Some(vec![[0.0, 0.0], [0.01, 3.0]]);
    let stopped = curve_svg("arch", &case.assembly, &case.stages, &result).expect("a curve");
    let highest = |svg: &str| {
        let circles =
            svg.split("<circle").skip(1).filter_map(|rest| rest.split("cy=\"").nth(1)?.split('"').next()?.parse().ok());
        circles.fold(f64::INFINITY, f64::min)
    };
    assert!((highest(&fallen) - highest(&stopped)).abs() < 1.0, "{} {}", highest(&fallen), highest(&stopped));
}

/// If the factor is 0 and the bounds differ by rounding only, no bracket is reported: a tower with its weight over its
/// edge, far from the origin.
#[test]
fn rounding_of_a_zero_factor_is_no_bracket() {
    let at = |[x, y]: [f64; 2]| format!("[{:?}, {:?}]", x + 612.3, y + 347.1);
    let block = |points: [[f64; 2]; 4]| points.map(at).join(", ");
    let tower = format!(
        "name = \"tower\"\n[scene]\nscene = \"blocks\"\nwidth = 1.0\nmaterial = \"stone\"\njoint = \"dry\"\n\
         blocks = [{{ name = \"ground\", vertices = [{}], fixed = true }}, {{ name = \"tower\", vertices = [{}] }}]\n\
         [materials.stone]\nlaw = \"rigid\"\ndensity = 2000.0\n[joints.dry]\nlaw = \"coulomb_associated\"\n\
         friction = 0.7\n[[stages]]\nname = \"dead\"\ngravity = 9.81\n[[stages]]\nname = \"live\"\n\
         until = \"collapse\"\nloads = [{{ kind = \"body\", acceleration = [9.81, 0.0] }}]\n",
        block([[-5.0, -1.0], [5.0, -1.0], [5.0, 0.0], [-5.0, 0.0]]),
        block([[0.0, 0.0], [0.3, 0.0], [0.6, 1.7], [0.3, 1.7]]),
    );
    let case = first_case(&tower);
    let mut result = voussoir::solve_case(&case);
    assert!(result.certificate.passed && result.load_factor.is_some_and(|factor| factor.abs() < 1e-10), "{result:?}");
    // The values of another machine with other rounding.
    (result.load_factor, result.bounds) = (Some(0.0), Some([Some(-1.48e-11), Some(0.0)]));
    let line = headline(&result, &case.stages);
    assert!(line.starts_with("collapse, λ = 0"), "{line}");
}
