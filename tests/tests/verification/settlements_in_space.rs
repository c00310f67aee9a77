//! Rigid blocks in space that follow moving supports: the arch of the plane, blocks between closing supports, forged results.

use serde_json::{Value, json};
use std::fmt::Write;
use voussoir::core::limit::Status;
use voussoir::results::CaseResult;
use voussoir_tests::{answered, written};

/// Returns a study in which the supports of a scene move under self-weight.
fn settled(scene: &str, friction: f64, settlement: &str) -> String {
    format!(
        "name = \"settled\"\n[scene]\n{scene}\nmaterial = \"stone\"\njoint = \"dry\"\n[materials.stone]\nlaw = \"rigid\"\n\
         density = 2200.0\n[joints.dry]\nlaw = \"coulomb_associated\"\nfriction = {friction:?}\n[[stages]]\nname = \"weight\"\n\
         gravity = 9.81\n[[stages]]\nname = \"settle\"\nsettlement = [{settlement}]\n"
    )
}

const PROFILE: &str = "profile = { shape = \"segmental\", span = 9.42, rise = 2.99 }\nthickness = 0.6\nvoussoirs = 15";

/// Returns displacements of all bodies in space, [u_x, u_y, u_z, θ_x, θ_y, θ_z].
fn displacements(result: &CaseResult) -> Vec<(String, [f64; 6])> {
    assert_eq!(result.status, Status::Stands, "{:?} {:?}", result.notes, result.certificate);
    let space = result.proof.space.as_ref().expect("a proof in space");
    space.motion.iter().flatten().map(|entry| (entry.body.clone(), entry.velocity)).collect()
}

/// A vault of one strip follows its supports as the arch of the plane does. In the plane z is up and θ turns x into z, so that it is
/// −θ_y. For the last movement several motions have the least energy, which is the same.
#[test]
fn a_vault_of_one_strip_settles_like_an_arch() {
    for [x, z, turn] in [[-0.01, 0.0, 0.0], [0.01, 0.0, 0.0], [0.0, -0.01, 0.0], [-0.004, -0.003, 0.002]] {
        let plane = format!("{{ support = \"left\", displacement = [{x:?}, {z:?}], rotation = {turn:?} }}");
        let arch = format!("scene = \"arch\"\n{PROFILE}\nwidth = 1.0\nends = \"jointed\"");
        let plane = answered(&settled(&arch, 0.6, &plane));
        let inside =
            format!("{{ support = \"left\", displacement = [{x:?}, 0.0, {z:?}], rotation = [0.0, {:?}, 0.0] }}", -turn);
        let vault = format!("scene = \"barrel_vault\"\n{PROFILE}\nlength = 1.0");
        let space = displacements(&answered(&settled(&vault, 0.6, &inside)));
        let (mut compared, mut sinks) = (0, [0.0; 2]);
        for entry in plane.path.displacements.expect("displacements").iter() {
            // The supports have other shapes and centroids than in the plane.
            let name = format!("{}.0", entry.body);
            let Some((_, own)) = space.iter().find(|(body, _)| *body == name) else { continue };
            compared += 1;
            let [u, v, theta] = entry.displacement;
            sinks = [sinks[0] + v, sinks[1] + own[2]];
            let apart: f64 =
                [own[0] - u, own[1], own[2] - v, own[3], own[4] + theta, own[5]].iter().map(|d| d.abs()).sum();
            assert!(apart < 1e-8 || turn != 0.0, "{name}: {own:?}, plane {:?}", entry.displacement);
        }
        // The voussoirs are equal, so the sum of their displacements is the energy.
        assert!((sinks[0] - sinks[1]).abs() < 1e-10, "{sinks:?}");
        assert_eq!(compared, 15);
    }
}

/// All supports together move a vault as one body.
#[test]
fn all_supports_together_move_a_vault_as_one_body() {
    let vault = format!("scene = \"barrel_vault\"\n{PROFILE}\nlength = 4.0\nstrips = 4\nbond = \"half\"");
    let both = |displacement: &str| {
        let one = |name: &str| format!("{{ support = \"{name}\", displacement = {displacement} }}");
        displacements(&answered(&settled(&vault, 0.6, &format!("{}, {}", one("left"), one("right")))))
    };
    for (name, own) in both("[0.01, -0.02, 0.03]") {
        let off = [own[0] - 0.01, own[1] + 0.02, own[2] - 0.03, own[3], own[4], own[5]];
        assert!(off.iter().all(|x| x.abs() < 1e-9), "{name}: {own:?}");
    }
}

fn cuboid(name: &str, low: [f64; 3], high: [f64; 3], fixed: bool) -> String {
    let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 1 { high[axis] } else { low[axis] });
    let faces = "[[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]";
    let corners: Vec<_> = (0..8).map(corner).collect();
    format!("[[scene.blocks]]\nname = \"{name}\"\nvertices = {corners:?}\nfaces = {faces}\nfixed = {fixed}\n")
}

/// Returns a study of blocks with their names, corners and whether they are held; one support moves.
fn blocks_settled(blocks: &[(&str, [f64; 3], [f64; 3], bool)], support: &str, moved: [f64; 3]) -> String {
    let mut scene = String::new();
    for (name, low, high, fixed) in blocks {
        let _ = write!(scene, "{}", cuboid(name, *low, *high, *fixed));
    }
    let settlement = format!("{{ support = \"{support}\", displacement = {moved:?} }}");
    let text = settled("scene = \"blocks_3d\"", 0.6, &settlement);
    let (head, tail) = text.split_once("[materials.stone]").expect("a study");
    format!("{head}{scene}[materials.stone]{tail}")
}

/// A beam on two pillars turns, if the right pillar sinks by δ, about the inner edge of the left pillar until it rests on the outer
/// edge of the right one, by δ over the distance of these edges. A plate on four columns stays on three of them.
#[test]
fn beams_and_plates_rest_on_the_edges_of_their_supports() {
    let beam = [
        ("beam", [0.0, 0.0, 0.0], [5.0, 1.0, 1.0], false),
        ("left", [0.0, 0.0, -1.0], [1.0, 1.0, 0.0], true),
        ("right", [4.0, 0.0, -1.0], [5.0, 1.0, 0.0], true),
    ];
    let found = displacements(&answered(&blocks_settled(&beam, "right", [0.0, 0.0, -0.01])));
    let (_, own) = found.iter().find(|(name, _)| name == "beam").expect("the beam");
    let turn = 0.01 / 4.0;
    let exact = [0.5 * turn, 0.0, -1.5 * turn, 0.0, turn, 0.0];
    assert!(own.iter().zip(exact).all(|(found, exact)| (found - exact).abs() < 1e-9), "{own:?}");
    let at = |name, x: f64, y: f64| (name, [x, y, -1.0], [x + 1.0, y + 1.0, 0.0], true);
    let plate = [
        ("plate", [0.0, 0.0, 0.0], [6.0, 6.0, 0.5], false),
        at("a", 0.0, 0.0),
        at("b", 5.0, 0.0),
        at("c", 0.0, 5.0),
        at("d", 5.0, 5.0),
    ];
    let found = displacements(&answered(&blocks_settled(&plate, "d", [0.0, 0.0, -0.01])));
    let (_, own) = found.iter().find(|(name, _)| name == "plate").expect("the plate");
    assert!(own.iter().all(|x| x.abs() < 1e-9), "{own:?}");
}

/// Returns a study of a cube on the ground between two walls. One of them moves.
fn between(moved: [f64; 3]) -> String {
    let blocks = [
        ("ground", [-3.0, -3.0, -1.0], [3.0, 3.0, 0.0], true),
        ("cube", [0.0, 0.0, 0.0], [1.0, 1.0, 1.0], false),
        ("near", [-0.5, 0.0, 0.0], [0.0, 1.0, 1.0], true),
        ("far", [1.0, 0.0, 0.0], [1.5, 1.0, 1.0], true),
    ];
    blocks_settled(&blocks, "far", moved)
}

/// No motion of a cube is compatible with a wall that closes on it: the forces that prove it pass, and forged ones do not. A wall
/// that opens leaves the cube in place.
#[test]
fn a_cube_cannot_follow_a_closing_wall() {
    let open = displacements(&answered(&between([0.02, 0.0, 0.0])));
    let (_, own) = open.iter().find(|(name, _)| name == "cube").expect("the cube");
    assert!(own.iter().all(|x| x.abs() < 1e-9), "{own:?}");
    let text = between([-0.02, 0.0, 0.0]);
    let result = answered(&text);
    assert_eq!(result.status, Status::NoEquilibrium, "{:?} {:?}", result.notes, result.certificate);
    assert!(result.supports_cannot_move());
    // Without its fields the result keeps the forces that prove it.
    let mut brief = result.clone();
    brief.leave_out_fields();
    assert!(brief.supports_cannot_move());
    let (study, results) = written::results(&text);
    assert_eq!(written::findings(&study, &results), Vec::<String>::new());
    let mut forged: Value = results.clone();
    for force in forged["cases"][0]["ray"].as_array_mut().expect("a ray") {
        force["force"][0] = json!(-force["force"][0].as_f64().expect("a number"));
    }
    assert!(!written::findings(&study, &forged).is_empty());
}

/// A changed displacement of a block or of a support, and a changed force, are found.
#[test]
fn forged_displacements_in_space_are_found() {
    let vault = format!("scene = \"barrel_vault\"\n{PROFILE}\nlength = 1.0");
    let text = settled(&vault, 0.6, "{ support = \"left\", displacement = [-0.01, 0.0, 0.0] }");
    let (study, results) = written::results(&text);
    assert_eq!(written::findings(&study, &results), Vec::<String>::new());
    for (list, place, key, change) in
        [("motion", 0, "velocity", 1e-5), ("motion", 9, "velocity", 1e-6), ("field", 4, "force", 1.0)]
    {
        let mut forged: Value = results.clone();
        let number = &mut forged["cases"][0][list][place][key][0];
        *number = json!(number.as_f64().expect("a number") + change);
        assert!(!written::findings(&study, &forged).is_empty(), "{list} {place}");
    }
}
