//! Tests of placed loads.

use super::{LoadKind, LoadSite, LoadTables, Placed};
use crate::scenes::test_catalogue::catalogue;
use serde_json::{Value, json};
use voussoir_core::model::geometry::Vec2;
use voussoir_core::model::{Assembly, Scene};
use voussoir_core::plugin::Diagnostic;

fn arch(span: f64, rise: f64, voussoirs: usize, ends: &str, material: &str) -> Assembly {
    let scene = json!({
        "scene": "arch", "profile": { "shape": "segmental", "span": span, "rise": rise }, "thickness": 0.6,
        "width": 5.81, "voussoirs": voussoirs, "ends": ends, "material": material, "joint": "dry",
    });
    serde_json::from_value::<Box<dyn Scene>>(scene).unwrap().build(&catalogue()).unwrap()
}

fn placed(value: Value, assembly: &Assembly) -> Result<Placed, Vec<Diagnostic>> {
    let load: Box<dyn LoadKind> = serde_json::from_value(value).unwrap();
    load.place(&LoadSite::new(assembly, &LoadTables::default(), "stages.1.loads.0"))
}

fn path(value: Value, assembly: &Assembly) -> String {
    placed(value, assembly).unwrap_err()[0].path.clone()
}

#[test]
fn the_quarter_span_load_of_strathmashie_lies_on_the_chord_of_its_voussoir() {
    let arch = arch(9.42, 2.99, 15, "bonded", "stone");
    let load = json!({ "kind": "point", "span_fraction": 0.25, "force": [0.0, -1000.0] });
    let Placed { forces, .. } = placed(load, &arch).unwrap();
    let [force] = forces[..] else { panic!("one force") };
    assert_eq!(force.point.x, -4.71 + 0.25 * 9.42);
    assert_eq!(force.force, Vec2::new(0.0, -1000.0));
    let vertices = &arch.bodies[force.body].vertices;
    let (left, right) = (vertices[3], vertices[2]);
    assert!(left.x < force.point.x && force.point.x < right.x);
    assert!(voussoir_core::model::geometry::cross(right - left, force.point - left).abs() < 1e-15);
}

#[test]
fn mirrored_loads_load_mirrored_voussoirs_on_boundaries_too() {
    for voussoirs in [9, 10] {
        let arch = arch(4.0, 1.0, voussoirs, "jointed", "stone");
        for joint in &arch.joints[1..voussoirs] {
            let at = |x: f64| {
                let load = json!({ "kind": "axles", "at": 0.5, "positions": [x], "forces": [1.0] });
                placed(load, &arch).unwrap().forces
            };
            let (here, there) = (at(joint.ends[1].x), at(-joint.ends[1].x));
            assert_eq!(here.len(), if joint.ends[1].x == 0.0 { 2 } else { 1 });
            for (a, b) in here.iter().zip(there.iter().rev()) {
                assert_eq!(a.body + b.body, voussoirs + 1);
                assert_eq!((a.point.x, a.point.y, a.force.y), (-b.point.x, b.point.y, b.force.y));
            }
        }
    }
}

#[test]
fn the_resultant_of_a_strip_is_pressure_times_length_times_width_at_its_middle() {
    for (rise, voussoirs, from, to) in [(1.0, 15, 0.1, 0.37), (2.0, 8, 0.0, 1.0), (3.5, 23, 0.02, 0.7)] {
        let arch = arch(4.0, rise, voussoirs, "jointed", "stone");
        let Placed { forces, .. } =
            placed(json!({ "kind": "strip", "from": from, "to": to, "pressure": 3e3 }), &arch).unwrap();
        let total: f64 = forces.iter().map(|f| f.force.y).sum();
        let moment: f64 = forces.iter().map(|f| f.force.y * f.point.x).sum();
        let exact = -3e3 * (to - from) * 4.0 * 5.81;
        assert!((total - exact).abs() < 1e-12 * exact.abs());
        assert!((moment - exact * (2.0 * (from + to) - 2.0)).abs() < 1e-11 * exact.abs());
        assert!(forces.iter().all(|f| f.force.x == 0.0));
        // A strip acts on the upper chords only: no force below the widest point of a tall ring.
        assert!(forces.iter().all(|f| f.point.y > arch.bodies[f.body].vertices[0].y.min(rise / 2.0) - 1e-12));
        let mut bodies: Vec<_> = forces.iter().map(|f| f.body).collect();
        bodies.dedup();
        assert_eq!(bodies.len(), forces.len());
    }
}

#[test]
fn where_a_vertical_meets_two_chords_the_upper_one_is_loaded() {
    let arch = arch(2.0, 3.0, 21, "jointed", "stone");
    let load = json!({ "kind": "point", "span_fraction": -0.2, "force": [0.0, -1.0] });
    let Placed { forces, .. } = placed(load, &arch).unwrap();
    assert!(forces[0].point.y > 5.0 / 3.0 - 0.3, "{:?}", forces[0].point);
}

#[test]
fn pressure_on_all_edges_of_a_block_is_in_equilibrium_and_pushes_inwards() {
    let arch = arch(4.0, 1.0, 5, "jointed", "stone");
    let mut wrench = [0.0; 3];
    for edge in 0..4 {
        let Placed { forces, .. } =
            placed(json!({ "kind": "pressure", "block": 2, "edge": edge, "value": 10.0 }), &arch).unwrap();
        voussoir_core::model::add_force(&mut wrench, forces[0].point, forces[0].force, 1.0);
        if edge == 2 {
            assert!(forces[0].force.y < 0.0);
        }
    }
    assert!(wrench.iter().all(|w| w.abs() < 1e-12));
}

#[test]
fn accelerations_and_forces_on_named_blocks_are_passed_on() {
    let arch = arch(4.0, 1.0, 5, "jointed", "stone");
    let Placed { forces, accelerations, .. } =
        placed(json!({ "kind": "body", "acceleration": [1.0, 0.0] }), &arch).unwrap();
    assert!(forces.is_empty() && accelerations == [Vec2::new(1.0, 0.0)]);
    let vertex = arch.bodies[3].vertices[2];
    for block in [json!(2), json!("2")] {
        let load = json!({ "kind": "point", "block": block, "point": [vertex.x, vertex.y], "force": [1.0, 0.0] });
        assert_eq!(placed(load, &arch).unwrap().forces[0].body, 3);
    }
}

#[test]
fn every_impossible_load_is_refused_at_its_key() {
    let arch = arch(4.0, 1.0, 5, "jointed", "stone");
    let force = [0.0, -1.0];
    let cases = [
        (json!({ "kind": "point", "force": force }), ""),
        (json!({ "kind": "point", "span_fraction": 0.5, "block": 1, "force": force }), ".block"),
        (json!({ "kind": "point", "block": 1, "force": force }), ".point"),
        (json!({ "kind": "point", "point": [0.0, 1.0], "force": force }), ".block"),
        (json!({ "kind": "point", "block": 9, "point": [0.0, 1.0], "force": force }), ".block"),
        (json!({ "kind": "point", "block": "left", "point": [0.0, 1.0], "force": force }), ".block"),
        (json!({ "kind": "point", "block": 1, "point": [9.0, 1.0], "force": force }), ".point"),
        (json!({ "kind": "point", "span_fraction": 1.5, "force": force }), ".span_fraction"),
        (json!({ "kind": "strip", "from": 0.5, "to": 0.5, "pressure": 1.0 }), ".to"),
        (json!({ "kind": "strip", "from": 0.5, "to": 1.5, "pressure": 1.0 }), ".to"),
        (json!({ "kind": "axles", "at": 0.5, "positions": [0.0, 1.0], "forces": [1.0] }), ".forces"),
        (json!({ "kind": "pressure", "block": 1, "edge": 4, "value": 1.0 }), ".edge"),
    ];
    for (load, key) in cases {
        assert_eq!(path(load.clone(), &arch), format!("stages.1.loads.0{key}"), "{load}");
    }
}

/// An axle off the arch is ignored, and a note reports it.
#[test]
fn an_axle_off_the_arch_counts_nothing() {
    let load = json!({ "kind": "axles", "at": 0.5, "positions": [0.0, 9.0], "forces": [1.0, 1.0] });
    let Placed { forces, notes, .. } = placed(load, &arch(4.0, 1.0, 5, "jointed", "stone")).unwrap();
    assert_eq!((forces.len(), notes.len()), (1, 1));
    assert!(notes[0].contains("axle 1") && notes[0].contains("counts nothing"), "{}", notes[0]);
}

#[test]
fn a_load_on_a_rigid_voussoir_bonded_to_the_ground_is_refused_but_not_on_an_elastic_one() {
    let load = json!({ "kind": "point", "span_fraction": 0.01, "force": [0.0, -1.0] });
    assert!(placed(load.clone(), &arch(4.0, 1.0, 5, "bonded", "stone")).is_err());
    assert!(placed(load.clone(), &arch(4.0, 1.0, 5, "bonded", "elastic")).is_ok());
    assert!(placed(load, &arch(4.0, 1.0, 5, "jointed", "stone")).is_ok());
}

#[test]
fn unknown_keys_of_a_load_are_refused() {
    let load = json!({ "kind": "strip", "from": 0.0, "to": 1.0, "pressure": 1.0, "angle": 3.0 });
    assert!(serde_json::from_value::<Box<dyn LoadKind>>(load).is_err());
}

#[test]
fn without_dispersion_loads_stand_as_they_always_did() {
    let arch = arch(4.0, 1.0, 15, "jointed", "stone");
    for load in [
        json!({ "kind": "point", "span_fraction": 0.3, "force": [100.0, -1000.0] }),
        json!({ "kind": "strip", "from": 0.1, "to": 0.37, "pressure": 3e3 }),
    ] {
        let mut named = load.clone();
        named["dispersion"] = json!({ "law": "none" });
        assert_eq!(placed(load, &arch).unwrap(), placed(named, &arch).unwrap());
    }
}

/// A point load that spreads by 45° through 0.5 m is a strip of 1 m with the same force. A strip grows by 0.5 m on both
/// sides and keeps its force and its middle. A load that would reach beyond the extrados is refused.
#[test]
fn a_uniform_spread_keeps_the_resultant() {
    let arch = arch(4.0, 1.0, 15, "jointed", "stone");
    let spread = json!({ "law": "uniform", "angle": 45.0, "depth": 0.5 });
    let sums = |load: Value| {
        let Placed { forces, .. } = placed(load, &arch).unwrap();
        let (first, last) = (&forces[0].point, &forces[forces.len() - 1].point);
        let total: f64 = forces.iter().map(|f| f.force.y).sum();
        let moment: f64 = forces.iter().map(|f| f.force.y * f.point.x).sum();
        (total, moment / total, last.x - first.x)
    };
    let point = json!({ "kind": "point", "span_fraction": 0.3, "force": [0.0, -1000.0], "dispersion": spread });
    let (total, middle, _) = sums(point);
    assert!((total + 1000.0).abs() < 1e-9 && (middle - (-2.0 + 0.3 * 4.0)).abs() < 1e-12, "{total} {middle}");
    let plain = json!({ "kind": "strip", "from": 0.4, "to": 0.5, "pressure": 1e3 });
    let mut wide = plain.clone();
    wide["dispersion"] = spread.clone();
    let (plain, wide) = (sums(plain), sums(wide));
    assert!(
        (plain.0 - wide.0).abs() < 1e-9 * plain.0.abs() && (plain.1 - wide.1).abs() < 1e-12 && wide.2 > plain.2 + 0.5
    );
    let beyond = json!({ "kind": "point", "span_fraction": 0.0, "force": [0.0, -1.0], "dispersion": spread });
    assert_eq!(path(beyond, &arch), "stages.1.loads.0.span_fraction");
    let block = json!({ "kind": "point", "block": 3, "point": [0.0, 1.1], "force": [0.0, -1.0], "dispersion": spread });
    assert_eq!(path(block, &arch), "stages.1.loads.0.dispersion");
}
