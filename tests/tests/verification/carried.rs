//! A load that is carried: forces and stresses of joints, reserve, permissible limit state, zone of thrust.

use serde_json::json;
use voussoir::core::limit::Status;
use voussoir::results::CaseResult;
use voussoir::results::carried::{JointEntry, ReserveFlow};
use voussoir_tests::{Arch, answered, changed, crushing, friction};

/// Returns a study whose last stage ends at a factor instead of collapse.
fn to_factor(text: &str, factor: f64) -> String {
    changed(text, "until = \"collapse\"", &format!("factor = {factor:?}"))
}

/// Returns a column of two blocks under its weight and a horizontal push. Each is 1 m wide, high and thick, of 1000 kg/m³.
fn column(joint: &str, push: f64) -> String {
    format!(
        "name = \"column\"\n[scene]\nscene = \"blocks\"\nwidth = 1.0\nmaterial = \"stone\"\njoint = \"dry\"\nblocks = [\n\
         {{ name = \"ground\", vertices = [[-1.0, -1.0], [2.0, -1.0], [2.0, 0.0], [-1.0, 0.0]], fixed = true }},\n\
         {{ name = \"left\", vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] }},\n\
         {{ name = \"top\", vertices = [[0.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]] }},\n]\n\
         [materials.stone]\nlaw = \"rigid\"\ndensity = 1000.0\n[joints.dry]\n{joint}\n\
         [[stages]]\nname = \"dead\"\ngravity = 10.0\n\
         [[stages]]\nname = \"push\"\nfactor = 1.0\nloads = [{{ kind = \"point\", block = \"top\", point = [0.0, 1.5], force = [{push:?}, 0.0] }}]\n"
    )
}

fn entry<'a>(result: &'a CaseResult, blocks: [&str; 2]) -> &'a JointEntry {
    let own = |entry: &&JointEntry| blocks.iter().all(|name| entry.between.iter().any(|own| own == name));
    result.carried.joints.iter().find(own).expect("a joint between these blocks")
}

fn close(found: f64, known: f64) {
    assert!((found - known).abs() <= 1e-9 * known.abs().max(1e-3), "{found} instead of {known}");
}

/// The field of a column is unique: N is the weight above, V the push and M its moment. Stresses, sliding and rocking are
/// calculated by hand.
#[test]
fn a_column_by_hand() {
    let result = answered(&column(&friction(0.9), 1000.0));
    assert_eq!(result.status, Status::Stands);
    // Between the blocks: N 10 kN, V 1 kN, M 0.5 kN m, e 0.05 m < h/6. Below: N 20 kN, M 1.5 kN m, e 0.075 m.
    for (blocks, normal, e) in [(["left", "top"], 1e4, 0.05), (["ground", "left"], 2e4, 0.075)] {
        let own = entry(&result, blocks);
        close(own.normal, normal);
        close(own.shear.abs(), 1000.0);
        close(own.moment.abs(), normal * e);
        close(own.eccentricity.expect("it presses").abs(), e);
        close(own.contact_length, 1.0);
        close(own.greatest_stress.expect("a stress"), normal * (1.0 + 6.0 * e));
        close(own.sliding_reserve.expect("it may slide"), 0.9 * normal / 1000.0);
        let [least, greatest] = own.zone.expect("a zone");
        close(least.abs(), e);
        close(greatest, least);
    }
    // It rocks about its toe at 20 kN × 0.5 m / 1.5 m.
    let reserve = result.carried.reserve.expect("a reserve");
    close(reserve.factor.expect("a factor"), 20.0 / 3.0);
    assert_eq!((reserve.status, reserve.flow), (Status::Collapse, ReserveFlow::Associated));
    assert!(result.carried.permissible.is_none(), "the rule is one of arches");
}

/// Teeth are climbed with friction 1 up to 10 kPa and sheared off with 0.6 above. The pressure at the pressed end is concentrated,
/// so the joint carries less than its facets over the whole joint: T = 0.4 Δn θ + 0.6 N with Δn θ² = N − 2 M/h, by hand.
#[test]
fn the_sliding_reserve_of_teeth_falls_with_the_moment() {
    let push = 16e3 / 3.0;
    let teeth = "law = \"strength_envelope\"\ncorners = [[0.0, 0.0], [1e4, 1e4]]\nresidual_friction = 0.6";
    let result = answered(&column(teeth, push));
    assert_eq!(result.status, Status::Stands);
    for (blocks, normal, moment) in [(["left", "top"], 1e4, 0.5 * push), (["ground", "left"], 2e4, 1.5 * push)] {
        let share = ((normal - 2.0 * moment) / 1e4).sqrt();
        let own = entry(&result, blocks).sliding_reserve.expect("it may slide");
        close(own, (0.4 * 1e4 * share + 0.6 * normal) / push);
        assert!(own * push < 0.95 * (0.6 * normal + 4e3), "{own}");
    }
}

/// A greater push opens the lowest joint: e = 0.3 m, contact over 3 (0.5 − 0.3) m. A joint that crushes also has a stress block.
#[test]
fn an_open_joint_and_its_stress_block() {
    let result = answered(&column(&crushing(0.6, 1e6), 4000.0));
    let own = entry(&result, ["ground", "left"]);
    close(own.eccentricity.expect("it presses").abs(), 0.3);
    close(own.contact_length, 0.6);
    close(own.greatest_stress.expect("a stress"), 2.0 * 2e4 / 0.6);
    let block = own.block.expect("a block");
    close(block.length, 0.4);
    close(block.stress, 2e4 / 0.4);
    close(block.strength, 1e6);
}

/// The reserve is the load of the study that ends at collapse, and the permissible limit state changes at half of it.
#[test]
fn the_reserve_is_the_collapse_load() {
    let arch = Arch { voussoirs: 9, ends: "jointed", ..Arch::default() }.study();
    let collapse = answered(&arch).load_factor.expect("a collapse load");
    for (share, holds) in [(0.49, true), (0.51, false)] {
        let result = answered(&to_factor(&arch, share * collapse));
        let reserve = result.carried.reserve.as_ref().expect("a reserve");
        close(reserve.factor.expect("a factor"), collapse);
        let check = result.carried.permissible.as_ref().expect("a check");
        close(check.used, share);
        assert_eq!(check.holds, Some(holds), "{share}");
    }
}

/// For friction without dilatancy the reserve is calculated with associated flow, which proves that the rule is violated but not
/// that it holds.
#[test]
fn other_flow_proves_no_reserve() {
    let arch =
        Arch { voussoirs: 9, ends: "jointed", joint: "law = \"coulomb\"\nfriction = 0.6".into(), ..Arch::default() };
    let collapse = answered(&Arch { joint: friction(0.6), ..arch.clone() }.study()).load_factor.expect("a load");
    for (share, holds) in [(0.3, None), (0.6, Some(false))] {
        let result = answered(&to_factor(&arch.study(), share * collapse));
        assert_eq!(result.carried.reserve.as_ref().map(|reserve| reserve.flow), Some(ReserveFlow::ReadAsAssociated));
        assert_eq!(result.carried.permissible.and_then(|check| check.holds), holds);
    }
}

/// The zone of an arch holds the thrust of its field, of its elastic path and of its mirror image.
#[test]
fn the_zone_holds_every_field() {
    let rigid = Arch { voussoirs: 9, ends: "jointed", ..Arch::default() };
    let load = 0.6 * answered(&rigid.study()).load_factor.expect("a collapse load");
    let result = answered(&to_factor(&rigid.study(), load));
    let zones: Vec<[f64; 2]> = result.carried.joints.iter().map(|joint| joint.zone.expect("a zone")).collect();
    assert!(zones.iter().all(|[least, greatest]| greatest - least > 1e-3));
    let elastic =
        Arch { material: "law = \"elastic\"\nyoung_modulus = 1e10\npoisson_ratio = 0.2".into(), ..rigid.clone() };
    let path = changed(&elastic.study(), "solver = \"auto\"", "solver = \"event_path\"");
    let path = answered(&to_factor(&path, load));
    assert_eq!(path.solver, "event_path");
    for (entry, [least, greatest]) in path.carried.joints.iter().zip(&zones) {
        let e = entry.eccentricity.expect("it presses");
        assert!(*least <= e + 1e-9 && e <= greatest + 1e-9, "{least} {e} {greatest}");
        let zone = entry.zone.expect("a zone");
        assert!((zone[0] - least).abs() < 1e-9 && (zone[1] - greatest).abs() < 1e-9);
    }
    let mirrored = Arch { span_fraction: 0.75, ..rigid }.study();
    let mirrored = answered(&to_factor(&mirrored, load));
    for (entry, zone) in mirrored.carried.joints.iter().rev().zip(&zones) {
        let own = entry.zone.expect("a zone");
        assert!((own[0] - zone[0]).abs() < 1e-8 && (own[1] - zone[1]).abs() < 1e-8, "{own:?} {zone:?}");
    }
}

/// Keys of `[output]` omit the zone, or all results of a carried load.
#[test]
fn nothing_is_added_that_is_not_asked_for() {
    let column = column(&friction(0.6), 1000.0);
    let without = answered(&format!("{column}[output]\nthrust_zone = false\n"));
    assert!(without.carried.joints.iter().all(|joint| joint.zone.is_none()) && without.carried.reserve.is_some());
    let nothing = serde_json::to_value(answered(&format!("{column}[output]\njoints = false\n"))).expect("a value");
    for key in ["joints", "reserve", "permissible"] {
        assert_eq!(nothing.get(key), None, "{key}");
    }
    let collapse = serde_json::to_value(answered(&Arch::default().study())).expect("a value");
    assert_eq!(collapse.get("joints").unwrap_or(&json!(null)), &json!(null));
}
