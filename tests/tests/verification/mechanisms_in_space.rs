//! Mechanisms of scenes in space: closed forms, images of one scene, and forged summaries.

use voussoir::core::certificate::{ClosedPart, ContactMode, Mechanism, MechanismKind};
use voussoir::core::limit::Status;
use voussoir::core::nalgebra::{Matrix3, Rotation3, Vector3};
use voussoir::results::CaseResult;
use voussoir::solve_case;
use voussoir::verify::case::verify_case;
use voussoir_tests::{answered, assert_close, first_case};

/// Returns a study of a scene with these loads of the last stage.
fn study(scene: &str, law: &str, friction: f64, loads: &str) -> String {
    let solver = if law == "coulomb" { "[solver]\nsolver = \"limit_sequential\"\n" } else { "" };
    format!(
        "name = \"space\"\n[scene]\n{scene}\n[materials.stone]\nlaw = \"rigid\"\ndensity = 1.0\n[joints.dry]\nlaw = \"{law}\"\n\
         friction = {friction:?}\n[[stages]]\nname = \"weight\"\ngravity = 1.0\n[[stages]]\nname = \"push\"\nuntil = \"collapse\"\n\
         loads = [{loads}]\n{solver}"
    )
}

/// Returns one block on the ground.
fn block([x, y, z]: [f64; 3]) -> String {
    format!(
        "scene = \"masonry_wall\"\nblock = [{x:?}, {y:?}, {z:?}]\ncourses = 1\nblocks = 1\nmaterial = \"stone\"\njoint = \"dry\""
    )
}

fn push([x, y, z]: [f64; 3]) -> String {
    format!("{{ kind = \"body\", acceleration = [{x:?}, {y:?}, {z:?}] }}")
}

const LAWS: [&str; 2] = ["coulomb_associated", "coulomb"];

/// Returns factor and mechanism of a study that collapses.
fn collapse(text: &str) -> (f64, Mechanism) {
    let result = answered(text);
    assert_eq!(result.status, Status::Collapse, "{:?} {:?}", result.notes, result.certificate);
    (result.load_factor.expect("a factor"), result.mechanism.expect("a mechanism"))
}

/// With both flow rules a slender block rocks about the far edge of its base, a flat one slides along the push, and a couple about
/// the vertical axis twists it at μ W a/√2.
#[test]
fn one_block_rocks_slides_or_twists() {
    for law in LAWS {
        let (factor, rocks) = collapse(&study(&block([2.0, 1.0, 3.0]), law, 0.7, &push([0.0, 1.0, 0.0])));
        assert_close(factor, 1.0 / 3.0, 1e-8);
        assert_eq!((rocks.kind, rocks.hinge_count, rocks.contacts.len()), (MechanismKind::Rocking, 1, 1), "{law}");
        let hinge = &rocks.contacts[0];
        assert_eq!((&hinge.modes, hinge.closed), (&vec![ContactMode::Hinge], ClosedPart::Edge));
        assert!(hinge.points.iter().all(|point| (point[1] - 1.0).abs() < 1e-12), "{:?}", hinge.points);
        // p·q̇ = 1: the weight of 6 moves by the rotation times the height of 1.5.
        assert_close(hinge.rotation[0], -1.0 / 9.0, 1e-8);
        assert_close(hinge.opening, 1.0 / 9.0, 1e-8);

        let (factor, slides) = collapse(&study(&block([1.0, 1.0, 0.5]), law, 0.4, &push([0.6, 0.8, 0.0])));
        assert_close(factor, 0.4, 1e-8);
        assert_eq!((slides.kind, slides.hinge_count), (MechanismKind::Sliding, 0), "{law}");
        let slip = slides.contacts[0].slip;
        assert_close(slip[0], 0.6 / 0.5, 1e-7);
        assert_close(slip[1], 0.8 / 0.5, 1e-7);

        let at = |x: f64, force: f64| {
            format!("{{ kind = \"point\", block = \"0.0\", point = [{x:?}, 0.5, 0.5], force = [0.0, {force:?}, 0.0] }}")
        };
        let couple = format!("{}, {}", at(1.0, 1.0), at(0.0, -1.0));
        let (factor, twists) = collapse(&study(&block([1.0, 1.0, 1.0]), law, 0.4, &couple));
        assert_close(factor, 0.4 / 2f64.sqrt(), 1e-8);
        assert_eq!((twists.kind, twists.hinge_count), (MechanismKind::Twisting, 0), "{law}");
        assert_close(twists.contacts[0].rotation[2], 1.0, 1e-8);
    }
}

/// Loads upwards lift a block off the ground: nothing else moves.
#[test]
fn a_lifted_block_separates() {
    let (factor, lifted) = collapse(&study(&block([1.0, 1.0, 1.0]), "coulomb_associated", 0.4, &push([0.0, 0.0, 1.0])));
    assert_close(factor, 1.0, 1e-8);
    assert_eq!((lifted.kind, lifted.contacts[0].closed), (MechanismKind::Separating, ClosedPart::Nothing));
}

/// A prism of length 6 in a groove at 45° that is pushed along it slides on both faces: associated flow lifts it as well.
#[test]
fn a_block_in_a_groove_slides_on_two_faces() {
    let prism = |name: &str, fixed: bool, section: [[f64; 2]; 3]| {
        let at = |x: f64| section.map(|[y, z]| format!("[{x:?}, {y:?}, {z:?}]")).join(", ");
        format!(
            "[[scene.blocks]]\nname = \"{name}\"\nfixed = {fixed}\nvertices = [{}, {}]\n\
             faces = [[0, 1, 2], [5, 4, 3], [0, 3, 4, 1], [1, 4, 5, 2], [2, 5, 3, 0]]\n",
            at(0.0),
            at(6.0)
        )
    };
    let groove = format!(
        "scene = \"blocks_3d\"\nmaterial = \"stone\"\njoint = \"dry\"\n{}{}{}",
        prism("right", true, [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]),
        prism("left", true, [[0.0, 0.0], [-1.0, 1.0], [-1.0, 0.0]]),
        prism("block", false, [[0.0, 0.0], [1.0, 1.0], [-1.0, 1.0]]),
    );
    for (law, known) in LAWS.into_iter().zip([2f64.sqrt() / 3f64.sqrt(), 0.5f64.sqrt()]) {
        let (factor, slides) = collapse(&study(&groove, law, 0.5, &push([1.0, 0.0, 0.0])));
        assert_close(factor, known, 1e-8);
        assert_eq!((slides.kind, slides.count_of(ContactMode::Sliding)), (MechanismKind::Sliding, 2), "{law}");
        for contact in &slides.contacts {
            let [x, y, z] = contact.slip;
            assert!(x > 0.0 && (y.abs() < 1e-8 * x) == (law == "coulomb") && z.abs() <= x, "{law}: {:?}", contact.slip);
        }
    }
}

/// A wall of five blocks in each of eight courses overturns about one axis.
#[test]
fn a_wall_overturns_about_one_axis() {
    let wall = block([2.0, 1.0, 0.5]).replace("courses = 1\nblocks = 1", "courses = 8\nblocks = 5");
    for along in [1.0, -1.0] {
        let (_, rocks) = collapse(&study(&wall, "coulomb_associated", 0.7, &push([0.0, along, 0.0])));
        assert_eq!((rocks.kind, rocks.hinge_count, rocks.contacts.len()), (MechanismKind::Rocking, 1, 5));
    }
}

/// x, y and z of a box.
type Extent = [[f64; 2]; 3];

/// A tower of boxes, each with another size and place, on the ground.
const TOWER: [Extent; 4] = [
    [[-2.0, 2.0], [-2.0, 2.0], [-0.5, 0.0]],
    [[-0.5, 0.6], [-0.4, 0.5], [0.0, 1.0]],
    [[-0.4, 0.7], [-0.6, 0.3], [1.0, 1.7]],
    [[-0.3, 0.4], [-0.3, 0.4], [1.7, 2.5]],
];

/// Two posts with a lintel on the ground.
const PORTAL: [Extent; 4] = [
    [[-2.0, 4.0], [-2.0, 2.0], [-0.5, 0.0]],
    [[0.0, 0.5], [-0.1, 0.6], [0.0, 2.0]],
    [[2.0, 2.6], [0.0, 0.5], [0.0, 2.0]],
    [[0.0, 2.6], [0.1, 0.5], [2.0, 2.4]],
];

/// Returns boxes under a map of space and in an order, of which the named ones are pushed.
fn boxes(
    boxes: &[Extent; 4],
    (map, order): (&Matrix3<f64>, [usize; 4]),
    friction: f64,
    (direction, pushed): ([f64; 3], &str),
) -> String {
    let text = |k: usize| {
        let [x, y, z] = boxes[k];
        let corners = [[0, 0], [1, 0], [1, 1], [0, 1]];
        let all = [0, 1].into_iter().flat_map(|up| corners.map(|[i, j]| map * Vector3::new(x[i], y[j], z[up])));
        let vertices: Vec<[f64; 3]> = all.map(Into::into).collect();
        format!(
            "[[scene.blocks]]\nname = \"{k}\"\nfixed = {}\nvertices = {vertices:?}\n\
             faces = [[3, 2, 1, 0], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]\n",
            k == 0
        )
    };
    let scene = "scene = \"blocks_3d\"\nmaterial = \"stone\"\njoint = \"dry\"\n";
    let along: [f64; 3] = (map * Vector3::from(direction)).into();
    let load = format!("{{ kind = \"body\", acceleration = {along:?}, blocks = {pushed} }}");
    study(&(scene.to_string() + &order.map(text).concat()), "coulomb_associated", friction, &load)
}

/// A rotation about the vertical, a mirror image and another order of the blocks keep kind, number of axes and modes, whether the
/// blocks rock, slide, or do both with torsion and hinges about vertices.
#[test]
fn images_of_blocks_have_the_same_mechanism() {
    const MODES: [ContactMode; 4] =
        [ContactMode::Hinge, ContactMode::Sliding, ContactMode::Twisting, ContactMode::Separating];
    let turn = *Rotation3::from_axis_angle(&Vector3::z_axis(), 0.7).matrix();
    let mirror = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, 1.0));
    let all = "[\"1\", \"2\", \"3\"]";
    let mut kinds = Vec::new();
    for (scene, friction, load) in [
        (&TOWER, 0.5, ([1.0, 0.0, 0.0], all)),
        (&TOWER, 0.2, ([0.3, 0.9, 0.1], all)),
        (&PORTAL, 0.6, ([0.0, 1.0, 0.0], "[\"1\"]")),
        (&PORTAL, 0.5, ([0.3, 1.0, 0.0], "[\"1\"]")),
        (&PORTAL, 0.4, ([0.6, -0.6, 0.0], "[\"1\"]")),
    ] {
        let summary = |map: &Matrix3<f64>, order: [usize; 4]| {
            let (factor, own) = collapse(&boxes(scene, (map, order), friction, load));
            (factor, (own.kind, own.hinge_count, MODES.map(|mode| own.count_of(mode))))
        };
        let (factor, own) = summary(&Matrix3::identity(), [0, 1, 2, 3]);
        for (map, order) in [
            (turn, [0, 1, 2, 3]),
            (mirror, [0, 1, 2, 3]),
            (Matrix3::identity(), [2, 0, 3, 1]),
            (turn * mirror, [3, 2, 1, 0]),
        ] {
            let (again, image) = summary(&map, order);
            assert_close(again, factor, 1e-8);
            assert_eq!(image, own, "{load:?} {map} {order:?}");
        }
        kinds.push(own);
    }
    use MechanismKind::{Mixed, Rocking, Sliding};
    assert_eq!(
        kinds,
        [
            (Rocking, 1, [1, 0, 0, 0]),
            (Sliding, 0, [0, 3, 0, 0]),
            (Mixed, 3, [3, 2, 0, 0]),
            (Mixed, 3, [3, 2, 1, 0]),
            (Mixed, 1, [1, 3, 0, 0]),
        ]
    );
}

/// `verify` finds every change of the mechanism from the stored velocities, without solving the case again.
#[test]
fn forged_mechanisms_are_found_without_solving() {
    let corner =
        block([2.0, 1.0, 0.5]).replace("courses = 1\nblocks = 1", "courses = 6\nblocks = 2\ncorner = { blocks = 2 }");
    let case = first_case(&study(&corner, "coulomb_associated", 0.7, &push([1.0, 0.0, 0.0])));
    let honest = solve_case(&case);
    assert_eq!(verify_case(&case, &honest), Vec::<String>::new());
    let forge = |change: &dyn Fn(&mut Mechanism)| {
        let mut forged = honest.clone();
        change(forged.mechanism.as_mut().expect("a mechanism"));
        assert!(!verify_case(&case, &forged).is_empty(), "{:?}", forged.mechanism);
    };
    let turning = |own: &Mechanism| own.contacts.iter().position(|c| c.has(ContactMode::Hinge)).expect("a hinge");
    forge(&|own| own.kind = MechanismKind::Separating);
    forge(&|own| own.hinge_count += 1);
    forge(&|own| drop(own.contacts.pop()));
    forge(&|own| own.contacts[0].joint = 100_000);
    forge(&|own| own.contacts.swap(0, 1));
    forge(&|own| own.contacts[0].between.swap(0, 1));
    forge(&|own| own.contacts[0].modes.clear());
    forge(&|own| own.contacts[0].opening = f64::NAN);
    forge(&|own| {
        let place = turning(own);
        own.contacts[place].points[0][2] += 1e-3;
    });
    forge(&|own| {
        let place = turning(own);
        own.contacts[place].rotation[1] += 1e-3 * Vector3::from(own.contacts[place].rotation).norm();
    });
    forge(&|own| own.contacts[0].closed = ClosedPart::Nothing);
    forge(&|own| own.contacts[0].share = 0.5);
    let without = CaseResult { mechanism: None, ..honest.clone() };
    assert!(!verify_case(&case, &without).is_empty());
}
