//! Limit analysis in space: published brackets and closed forms on scenes that the project generates, and forged results.

use serde_json::Value;
use voussoir::core::limit::Status;
use voussoir_tests::{answered, assert_close, written};

/// Returns a study of a scene that an acceleration of 1 × weight pushes, with this friction.
fn pushed(scene: &str, friction: f64, push: [f64; 3]) -> String {
    format!(
        "name = \"space\"\n[scene]\n{scene}\nmaterial = \"stone\"\njoint = \"dry\"\n[materials.stone]\nlaw = \"rigid\"\n\
         density = 1.0\n[joints.dry]\nlaw = \"coulomb_associated\"\nfriction = {friction:?}\n[[stages]]\nname = \"weight\"\n\
         gravity = 1.0\n[[stages]]\nname = \"push\"\nuntil = \"collapse\"\nloads = [{{ kind = \"body\", acceleration = {push:?} }}]\n"
    )
}

fn factor(scene: &str, friction: f64, push: [f64; 3]) -> f64 {
    let result = answered(&pushed(scene, friction, push));
    assert_eq!(result.status, Status::Collapse, "{:?} {:?}", result.notes, result.certificate);
    result.load_factor.expect("a factor")
}

const DOME: &str = "scene = \"dome\"\nradius = 1.0\nthickness = 0.1\nrings = 8\nmeridians = 16\noculus = 10.0";
const CORNER: &str =
    "scene = \"masonry_wall\"\nblock = [2.0, 1.0, 0.5]\ncourses = 8\nblocks = 4\ncorner = { blocks = 4 }";

/// A dome of 128 blocks has the factors that an independent program proved, for two directions and two frictions.
#[test]
fn a_dome_has_the_published_factors() {
    for (friction, azimuth, known) in
        [(0.7, 0.0, 0.504872781), (0.7, 11.25, 0.505477786), (0.5, 0.0, 0.382930476), (0.5, 11.25, 0.383297948)]
    {
        let found = factor(&format!("{DOME}\nazimuth = {azimuth:?}"), friction, [1.0, 0.0, 0.0]);
        assert_close(found, known, 2e-9);
    }
}

/// A toothed corner of two walls has the factors that an independent program proved, in four directions.
#[test]
fn a_corner_has_the_published_factors() {
    let half = 0.5f64.sqrt();
    for (friction, push, known) in [
        (0.7, [1.0, 0.0, 0.0], 0.56691654),
        (0.7, [-1.0, 0.0, 0.0], 0.530009476),
        (0.7, [half, half, 0.0], 0.577794393),
        (0.7, [-half, -half, 0.0], 0.639477975),
        (0.5, [1.0, 0.0, 0.0], 0.44101490),
        (0.5, [-1.0, 0.0, 0.0], 0.435121373),
        (0.5, [half, half, 0.0], 0.48315109),
        (0.5, [-half, -half, 0.0], 0.5),
    ] {
        assert_close(factor(CORNER, friction, push), known, 2e-8);
    }
}

/// Two small corners, in which many courses can slide at the same factor, have bounds that nearly meet. One slides at μ.
#[test]
fn small_corners_have_bounds_that_meet() {
    let corner = "scene = \"masonry_wall\"\nblock = [2.0, 1.0, 0.5]\ncourses = 4\nblocks = 3\n\
                  corner = { blocks = 3, joint = \"toothed\" }";
    for (friction, push, known) in [(0.4, [-1.0, 0.0, 0.0], 0.4), (0.7, [0.6, 0.7, 0.0], 0.744830726910 * 10.0 / 9.81)]
    {
        let result = answered(&pushed(corner, friction, push));
        assert_eq!(result.status, Status::Collapse, "{:?} {:?}", result.notes, result.certificate);
        let Some([Some(low), Some(high)]) = result.bounds else { panic!("{:?}", result.bounds) };
        assert!(high - low <= 1e-8 * high, "{low} {high}");
        assert_close(low, known, 1e-8);
    }
}

/// A corner with slip that does not open the joints collapses below the associated factor, in two directions.
#[test]
fn a_corner_collapses_earlier_with_its_own_flow() {
    let corner = "scene = \"masonry_wall\"\nblock = [2.0, 1.0, 0.5]\ncourses = 3\nblocks = 2\ncorner = { blocks = 2 }";
    let own = |push: [f64; 3]| {
        let text = pushed(corner, 0.5, push).replace("coulomb_associated", "coulomb");
        answered(&(text + "[solver]\nsolver = \"limit_sequential\"\n"))
    };
    let along = own([-1.0, 0.0, 0.0]);
    assert_eq!((along.status, along.flow_read_as.clone()), (Status::Collapse, None), "{:?}", along.notes);
    let associated = along.non_associated.associated_load_factor.expect("an associated factor");
    let least = along.load_factor.expect("a factor");
    assert!(least < associated, "{least} {associated}");
    // The walls alternate at the corner, so this push is not the mirror image of the first.
    let across = own([0.0, -1.0, 0.0]);
    assert_eq!((across.status, across.flow_read_as.clone()), (Status::Collapse, None), "{:?}", across.notes);
    let associated = across.non_associated.associated_load_factor.expect("an associated factor");
    assert!(across.load_factor.is_some_and(|factor| factor < associated), "{:?}", across.load_factor);
}

/// Mortar in space: with tension and without crushing a wall overturns at t/H (1 + f_t A/W), and the bounds meet; with crushing
/// they enclose the strip W/f_c that crushes, and `verify` proves them again.
#[test]
fn mortar_has_its_closed_forms() {
    let mortar = |strengths: &str| {
        let wall = "scene = \"masonry_wall\"\nblock = [2.0, 1.0, 4.0]\ncourses = 1\nblocks = 1";
        pushed(wall, 0.8, [0.0, 1.0, 0.0])
            .replace("coulomb_associated", "mohr_coulomb")
            .replace("friction = 0.8", &format!("friction = 0.8\n{strengths}"))
    };
    let tension = answered(&mortar("cohesion = 40.0\ntensile_strength = 2.0"));
    assert_eq!(tension.status, Status::Collapse, "{:?}", tension.notes);
    assert_close(tension.load_factor.expect("a factor"), 0.25 * (1.0 + 2.0 * 2.0 / 8.0), 1e-8);
    let crushing = answered(&mortar("compressive_strength = 40.0"));
    let [Some(low), Some(high)] = crushing.bounds.expect("bounds") else { panic!("{crushing:?}") };
    let exact = (1.0 - 8.0 / (40.0 * 2.0)) / 4.0;
    assert!(low < exact && exact < high && high - low < 0.1 * exact, "[{low}, {high}] {exact}");
    assert_eq!(crushing.status, Status::Open);
}

/// If courses slide on their bed, both flow rules give the friction coefficient. From zero stress no state is reached.
#[test]
fn a_corner_that_slides_has_one_load_with_both_flow_rules() {
    let corner = "scene = \"masonry_wall\"\nblock = [2.0, 1.0, 0.5]\ncourses = 2\nblocks = 2\ncorner = { blocks = 2, joint = \"toothed\" }";
    let text = pushed(corner, 0.5, [1.0, 0.0, 0.0]).replace("coulomb_associated", "coulomb");
    let result = answered(&(text + "[solver]\nsolver = \"limit_sequential\"\n"));
    assert_eq!((result.status, result.flow_read_as), (Status::Collapse, None), "{:?}", result.notes);
    let associated = result.non_associated.associated_load_factor.expect("an associated factor");
    assert_close(associated, 0.5, 1e-8);
    let own = result.load_factor.expect("a factor");
    assert_close(own, 0.5, 1e-8);
    // The associated factor is the upper end of its bounds, not the lower one.
    assert!(own <= associated * (1.0 + 1e-14), "{own} {associated}");
}

/// A step whose guess is its solution costs no iteration, and the next one is equal: the course ends all the same.
#[test]
fn a_course_that_repeats_its_steps_ends() {
    let result = answered(include_str!("stack_in_space.toml"));
    assert_eq!((result.status, result.flow_read_as), (Status::Collapse, None), "{:?}", result.notes);
    let associated = result.non_associated.associated_load_factor.expect("an associated factor");
    assert!(result.load_factor.is_some_and(|own| own <= associated * (1.0 + 1e-14)), "{:?}", result.load_factor);
}

/// A wall of any length that is pushed across its plane overturns at thickness over height.
#[test]
fn a_wall_across_its_plane_has_its_closed_form() {
    let wall = "scene = \"masonry_wall\"\nblock = [2.0, 1.0, 0.5]\ncourses = 8\nblocks = 5";
    assert_close(factor(wall, 0.7, [0.0, 1.0, 0.0]), 0.25, 1e-9);
}

/// A block of 2 × 1 × 3 m is overturned by a pressure on its side of 2 × 3 m: λ p A h / 2 = W b / 2. If the force is inclined
/// by 45° downwards, its vertical part acts at the far side and has the arm b.
#[test]
fn a_pressure_on_a_side_overturns_a_block() {
    let wall = "scene = \"masonry_wall\"\nblock = [2.0, 1.0, 3.0]\ncourses = 1\nblocks = 1";
    let body = pushed(wall, 0.7, [0.0, 1.0, 0.0]);
    let with = |load: &str| {
        let load = format!("loads = [{{ kind = \"pressure\", block = \"0.0\", value = 1.0, {load} }}]");
        let study = body.replace("loads = [{ kind = \"body\", acceleration = [0.0, 1.0, 0.0] }]", &load);
        let result = answered(&study);
        assert_eq!(result.status, Status::Collapse, "{:?} {:?}", result.notes, result.certificate);
        result.load_factor.expect("a factor")
    };
    let (weight, area, width, height) = (6.0, 6.0, 1.0, 3.0);
    assert_close(with("face = [0, -1, 0]"), weight * width / (area * height), 1e-9);
    assert_close(with("face = 2"), weight * width / (area * height), 1e-9);
    let inclined = 2f64.sqrt() * weight * width / (area * (height - 2.0 * width));
    assert_close(with("face = [0, -1, 0], direction = [0, 1, -1]"), inclined, 1e-9);
}

/// A straight barrel of one strip has the factors that an independent program proved, across and along its axis.
#[test]
fn a_barrel_has_the_published_factors() {
    // The mean radius is 1: the intrados has 0.925.
    let barrel = "scene = \"barrel_vault\"\nprofile = { shape = \"segmental\", span = 1.85, rise = 0.925 }\nthickness = 0.15\n\
                  voussoirs = 15\nlength = 2.0";
    let across = factor(barrel, 0.7, [1.0, 0.0, 0.0]);
    let along = factor(barrel, 0.7, [0.0, 1.0, 0.0]);
    let mut found = [across, along];
    found.sort_by(f64::total_cmp);
    assert_close(found[0], 0.150465309, 1e-8);
    assert_close(found[1], 0.607152508, 1e-8);
}

/// A stored result in space is confirmed, and each altered number or word is found.
#[test]
fn forged_results_in_space_are_found() {
    let (study, results) = written::results(&pushed(DOME, 0.7, [1.0, 0.0, 0.0]));
    assert_eq!(written::findings(&study, &results), Vec::<String>::new());
    let forge = |change: &dyn Fn(&mut Value)| {
        let mut forged = results.clone();
        change(&mut forged["cases"][0]);
        let found = written::findings(&study, &forged);
        assert!(!found.is_empty(), "a forged result passes");
    };
    forge(&|case| case["load_factor"] = 0.51.into());
    forge(&|case| case["bounds"] = serde_json::json!([0.5048, 0.5049]));
    forge(&|case| case["status"] = "stands".into());
    forge(&|case| case["field"][40]["force"][0] = 0.0.into());
    forge(&|case| case["field"][40]["point"][2] = 0.0.into());
    forge(&|case| case["motion"][60]["velocity"][2] = (-0.3).into());
    forge(&|case| case["motion"][60]["body"] = "another".into());
    forge(&|case| case["motion"] = Value::Null);
    forge(&|case| case["field"] = Value::Null);
    forge(&|case| case["flow_read_as"] = "associated".into());
    forge(&|case| case["field"][0]["force"] = serde_json::json!([1.0, 0.0]));
}

/// A web of a groin vault slides out along its axis at μ / sin θ, with the angle θ of the joints on its springers from the crown. With
/// associated flow it jams at a load that is half as large again.
#[test]
fn a_web_of_a_groin_vault_slides_out() {
    let vault = "scene = \"cross_vault\"\nspans = [6.0, 6.0]\nrise = 1.8\nthickness = 0.4\nvoussoirs = 9\nstrips = 2\n\
                 springers = 2";
    let text = pushed(vault, 0.5, [1.0, 0.0, 0.0]);
    let own = text.replace("coulomb_associated", "coulomb") + "[solver]\nsolver = \"limit_sequential\"\n";
    let result = answered(&own);
    let radius: f64 = (3.0f64.powi(2) + 1.8f64.powi(2)) / 3.6;
    let angle = (3.0 / radius).asin() * 5.0 / 9.0;
    assert_close(result.load_factor.expect("a factor"), 0.5 / angle.sin(), 1e-10);
    assert_close(result.non_associated.associated_load_factor.expect("a bound"), 1.348740350, 1e-7);
}

/// A search for the least load that ends at its limit has two proved ends. A stored end that is nearer is not confirmed.
#[test]
fn forged_least_loads_in_space_are_found() {
    let text = include_str!("../../../docs/data/space/slab_at_wall.toml");
    let text = text.replace("\"limit_least\"", "\"limit_least\"\nsearch_limit = 0.02");
    let (study, results) = written::results(&text);
    assert_eq!(written::findings(&study, &results), Vec::<String>::new());
    let case = &results["cases"][0];
    assert_eq!((case["status"].as_str(), case["greatest"].as_str()), (Some("collapse"), Some("bracketed")));
    let [lower, upper] = [0, 1].map(|end| case["bounds"][end].as_f64().expect("a bound"));
    assert_close(upper, 0.6 * (1.0 + 1.0 / 1.36), 1e-9);
    assert!(lower > 0.5 && lower < 0.99 * upper, "{lower}");
    let forge = |change: &dyn Fn(&mut Value)| {
        let mut forged = results.clone();
        change(&mut forged["cases"][0]);
        assert!(!written::findings(&study, &forged).is_empty(), "a forged result passes");
    };
    forge(&|case| case["bounds"][0] = (upper - 1e-6).into());
    forge(&|case| case["bounds"][0] = (lower + 0.01).into());
    forge(&|case| case["greatest"] = "proved_optimal".into());
    forge(&|case| case["load_factor"] = (upper - 0.01).into());
    forge(&|case| case["bounds"][1] = (upper - 0.01).into());
    forge(&|case| case["motion"][1]["velocity"][0] = 0.3.into());
}

/// A law without dilatancy is solved with associated flow, which the result states.
#[test]
fn friction_without_dilatancy_is_read_as_associated() {
    let result = answered(&pushed(DOME, 0.7, [1.0, 0.0, 0.0]).replace("coulomb_associated", "coulomb"));
    assert_eq!(result.flow_read_as.as_deref(), Some("associated"));
    assert_close(result.load_factor.expect("a factor"), 0.504872781, 2e-9);
}

/// A wall of two leaves overturns like one of their thickness, 2 t / H, if every course is of headers. With fewer headers
/// the load is not greater. Without headers it is less, but not below the load t / H of a single leaf.
#[test]
fn headers_make_two_leaves_one_wall() {
    let wall = |more: &str| {
        let wall = "scene = \"masonry_wall\"\nblock = [2.0, 0.5, 0.5]\ncourses = 8\nblocks = 2\nleaves = 2";
        factor(&format!("{wall}\n{more}"), 0.7, [0.0, 1.0, 0.0])
    };
    let [every, second, none] = ["header_every = 1", "header_every = 2", ""].map(wall);
    assert_close(every, 0.25, 1e-9);
    assert!(second <= every + 1e-9 && none < second - 1e-3 && none >= 0.125 - 1e-9, "{every} {second} {none}");
}

/// Stacks of prisms with cohesion, tension and crushing: the load of the plane scene, which another solver and another certificate
/// prove, is between the bounds of the same prisms in space. Without crushing the bounds meet.
#[test]
fn an_extruded_plane_scene_has_the_plane_load() {
    let strengths = [
        (3, "cohesion = 2.0\ntensile_strength = 0.7"),
        (2, "cohesion = 1.0\ntensile_strength = 9.0"),
        (4, ""),
        (3, "cohesion = 1.5\ntensile_strength = 0.4\ncompressive_strength = 40.0"),
        (2, "compressive_strength = 30.0"),
    ];
    for (index, (blocks, strength)) in strengths.into_iter().enumerate() {
        let shift = 0.03 * index as f64;
        let exact = answered(&stack(blocks, strength, shift, None)).load_factor.expect("the plane scene collapses");
        let space = answered(&stack(blocks, strength, shift, Some(0.8)));
        let [Some(low), Some(high)] = space.bounds.expect("bounds") else { panic!("{space:?}") };
        let rounding = 1e-8 * exact;
        assert!(low <= exact + rounding && exact <= high + rounding, "{strength}: [{low}, {high}] {exact}");
        let width = if strength.contains("compressive") { 0.2 } else { 1e-8 };
        assert!(high - low <= width * exact, "{strength}: [{low}, {high}] {exact}");
    }
}

/// Returns a study of a stack of prisms of width 0.8 with inclined joints on a fixed block, in the plane or with a depth along y.
fn stack(blocks: usize, strength: &str, shift: f64, depth: Option<f64>) -> String {
    let level = |k: usize| {
        let (middle, height, tilt) = (shift * k as f64, 0.7 * k as f64, 0.05 * f64::from(k.min(1) as u8));
        [[middle - 0.45, height - tilt], [middle + 0.4, height + tilt]]
    };
    let ground = vec![[-2.0, -1.0], [2.0, -1.0], [2.0, 0.0], [-2.0, 0.0]];
    let above = (0..blocks).map(|k| {
        let ([a, b], [d, c]) = (level(k), level(k + 1));
        vec![a, b, c, d]
    });
    let mut list = String::new();
    for (k, corners) in std::iter::once(ground).chain(above).enumerate() {
        let fixed = if k == 0 { "fixed = true\n" } else { "" };
        let shape = match depth {
            None => format!("vertices = {corners:?}"),
            Some(depth) => {
                let at = |y: f64| corners.iter().map(move |[x, z]| [*x, y, *z]);
                let vertices: Vec<_> = at(0.0).chain(at(depth)).collect();
                let faces = "[[0,1,2,3],[4,7,6,5],[0,4,5,1],[1,5,6,2],[2,6,7,3],[3,7,4,0]]";
                format!("vertices = {vertices:?}\nfaces = {faces}")
            }
        };
        list += &format!("[[scene.blocks]]\nname = \"{k}\"\n{fixed}{shape}\n");
    }
    let (scene, push) = match depth {
        None => ("scene = \"blocks\"\nwidth = 0.8", "[1.0, 0.1]"),
        Some(_) => ("scene = \"blocks_3d\"", "[1.0, 0.0, 0.1]"),
    };
    format!(
        "name = \"stack\"\n[scene]\n{scene}\nmaterial = \"stone\"\njoint = \"mortar\"\n{list}[materials.stone]\nlaw = \"rigid\"\n\
         density = 1.0\n[joints.mortar]\nlaw = \"mohr_coulomb\"\nfriction = 0.6\n{strength}\n[[stages]]\nname = \"weight\"\n\
         gravity = 1.0\n[[stages]]\nname = \"push\"\nuntil = \"collapse\"\nloads = [{{ kind = \"body\", acceleration = {push} }}]\n"
    )
}
