//! Bridges: numbers of two independent formulations, closed forms of the fill, and monotonic dependence on parameters
//! (docs/theory/bridges.md).

use serde_json::Value;
use voussoir::core::limit::Status;
use voussoir::core::model::{Assembly, Bond, Bridge, Gap, Joint, PointForce, find_joints};
use voussoir::results::{CaseResult, LoadOrigin};
use voussoir_tests::written::{findings, results};
use voussoir_tests::{answered, assert_close, changed, collapse_factor, first_case, study};

/// The bridge with Prestwood's dimensions: 60 voussoirs, crushing at 4.5 MPa, a patch of 0.3 m at the quarter of the
/// span.
const PRESTWOOD: &str = r#"
name = "prestwood"
[scene]
scene = "bridge"
width = 3.8
material = "stone"
joint = "dry"
spans = [{ profile = { shape = "segmental", span = 6.55, rise = 1.428 }, thickness = 0.22, voussoirs = 60 }]
[scene.fill]
cover = 0.165
density = 2000.0
extent = "extrados"
dispersion = { law = "uniform", angle = 30.0 }
[materials.stone]
law = "rigid"
density = 2000.0
[joints.dry]
law = "mohr_coulomb"
friction = 0.6
compressive_strength = "4.5 MPa"
[vehicles.patch]
axles = [{ at = 0.0, force = "1 kN", length = 0.3 }]
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "live"
until = "collapse"
loads = [{ kind = "vehicle", vehicle = "patch", at = 1.6375 }]
"#;

/// A ring whose fill resists.
const RESISTING: &str = r#"
name = "resisting"
[scene]
scene = "bridge"
width = 3.0
material = "stone"
joint = "dry"
spans = [{ profile = { shape = "segmental", span = 3.0, rise = 0.75 }, thickness = 0.25, voussoirs = 20 }]
[scene.fill]
cover = 0.3
density = 1800.0
friction_angle = 30.0
cohesion = 0.0
dispersion = { law = "none" }
resistance = { law = "fill_pressure", passive_factor = 0.33, cohesion_factor = 0.05, lower = "zero" }
[materials.stone]
law = "rigid"
density = 2200.0
[joints.dry]
law = "coulomb_associated"
friction = 0.6
[vehicles.patch]
axles = [{ at = 0.0, force = "1 kN", length = 0.3 }]
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "live"
until = "collapse"
loads = [{ kind = "vehicle", vehicle = "patch", at = 0.75 }]
"#;

/// Two rings with a load on the tenth block of the outer one.
const RINGS: &str = r#"
name = "rings"
[scene]
scene = "bridge"
width = 2.88
material = "stone"
joint = "dry"
ring_joint = "ring"
spans = [{ profile = { shape = "segmental", span = 3.0, rise = 0.75 }, thickness = 0.215, voussoirs = 40, rings = 2 }]
[materials.stone]
law = "rigid"
density = 2200.0
[joints.dry]
law = "coulomb_associated"
friction = 0.6
[joints.ring]
law = "coulomb_associated"
friction = 0.3
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "live"
until = "collapse"
loads = [{ kind = "point", block = "s0r1v10", point = [0.609146335438797, 0.765008638200229], force = [0.0, -1000.0] }]
"#;

/// Two spans on a pier.
const SPANS: &str = r#"
name = "spans"
[scene]
scene = "bridge"
width = 2.88
material = "stone"
joint = "dry"
spans = [
  { profile = { shape = "segmental", span = 3.0, rise = 0.75 }, thickness = 0.22, voussoirs = 21 },
  { profile = { shape = "segmental", span = 3.0, rise = 0.75 }, thickness = 0.22, voussoirs = 21 },
]
piers = [{ height = 0.5, width = 0.452, courses = 1 }]
[materials.stone]
law = "rigid"
density = 2200.0
[joints.dry]
law = "coulomb_associated"
friction = 0.6
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "live"
until = "collapse"
loads = [{ kind = "point", block = "s0r0v5", point = [0.605556381899997, 0.767205937066243], force = [0.0, -1000.0] }]
"#;

fn bridge(assembly: &Assembly) -> &Bridge {
    assembly.bridge.as_ref().expect("a bridge")
}

/// A patch on a ring with crushing carries the load of two independent formulations, with two solvers: uniform spread
/// of 0°, 30° and 45°, under fill on the whole extrados and under fill that ends above the intrados springings.
#[test]
fn a_patch_on_a_ring_that_crushes_under_fill() {
    let known =
        [("extrados", [93.637742, 107.198974, 119.564952]), ("springings", [92.104404, 105.428065, 117.579248])];
    for (extent, factors) in known {
        for (angle, factor) in [0.0, 30.0, 45.0].into_iter().zip(factors) {
            let text = changed(PRESTWOOD, "angle = 30.0", &format!("angle = {angle:?}"));
            let text = changed(&text, "\"extrados\"", &format!("\"{extent}\""));
            assert_close(collapse_factor(&text), factor, 1e-8);
        }
    }
}

/// Passive pressure raises the load; a factor of 0 removes it.
#[test]
fn fill_that_resists() {
    assert_close(collapse_factor(RESISTING), 272.620144, 1e-8);
    let off = changed(RESISTING, "passive_factor = 0.33", "passive_factor = 0.0");
    let case = first_case(&off);
    assert!(bridge(&case.assembly).reactions.is_empty());
    assert_close(collapse_factor(&off), 224.656040, 1e-8);
}

/// Rings and spans carry the same load as the same blocks in the scene `blocks`.
#[test]
fn rings_and_spans() {
    for (mu, factor) in [(0.0, 16.56281), (0.3, 18.72820), (0.6, 21.06285), (100.0, 47.18771)] {
        assert_close(collapse_factor(&changed(RINGS, "friction = 0.3", &format!("friction = {mu:?}"))), factor, 3e-7);
    }
    for (height, factor) in [("0.5", 53.86058), ("6.0", 44.02413)] {
        assert_close(collapse_factor(&changed(SPANS, "height = 0.5", &format!("height = {height}"))), factor, 3e-7);
    }
}

/// Returns the resultant and moment about the origin of vertical forces.
fn sums<'a>(forces: impl IntoIterator<Item = &'a PointForce>) -> [f64; 2] {
    forces.into_iter().fold([0.0; 2], |[force, moment], f| [force - f.force.y, moment - f.force.y * f.point.x])
}

/// Columns of fill have the weight of the integral between the polygon of the extrados and the road, layer by layer.
#[test]
fn columns_weigh_what_the_fill_above_weighs() {
    let layered = changed(
        PRESTWOOD,
        "cover = 0.165",
        "road = [[-1.0, 1.9], [2.0, 2.0], [5.5, 2.3]]\nhaunching = { level = 0.6, density = 2300.0 }\n\
         layers = [{ to_level = 1.7, density = 1500.0 }]",
    );
    for text in [PRESTWOOD, layered.as_str()] {
        let case = first_case(text);
        let bridge = bridge(&case.assembly);
        // Midpoints of a fine division of the polygon.
        let (mut mass, mut moment) = (0.0, 0.0);
        for chord in &bridge.extrados {
            let [a, b] = chord.ends;
            for i in 0..2000 {
                let p = a + (b - a) * ((f64::from(i) + 0.5) / 2000.0);
                let road = bridge.road_at(p.x).expect("a road");
                let depth = |low: f64, high: f64| (road.min(high) - p.y.max(low)).max(0.0);
                let column = if text == PRESTWOOD {
                    2000.0 * depth(f64::NEG_INFINITY, f64::INFINITY)
                } else {
                    2300.0 * depth(f64::NEG_INFINITY, 0.6)
                        + 1500.0 * depth(0.6, 1.7)
                        + 2000.0 * depth(1.7, f64::INFINITY)
                };
                let part = column * (b.x - a.x) / 2000.0 * 3.8;
                (mass, moment) = (mass + part, moment + part * p.x);
            }
        }
        assert_close(bridge.masses.iter().map(|fill| fill.mass).sum(), mass, 1e-6);
        assert_close(bridge.masses.iter().map(|fill| fill.mass * fill.point.x).sum(), moment, 1e-6);
    }
}

/// Fill on deformable blocks has the same weight and moment, distributed over many points.
#[test]
fn fill_on_deformable_blocks_has_the_same_resultant() {
    let elastic = changed(PRESTWOOD, "law = \"rigid\"", "law = \"elastic\"\nyoung_modulus = 5e9\npoisson_ratio = 0.2");
    let [rigid, elastic] = [PRESTWOOD, &elastic].map(|text| {
        let case = first_case(text);
        let masses = &bridge(&case.assembly).masses;
        [masses.iter().map(|f| f.mass).sum(), masses.iter().map(|f| f.mass * f.point.x).sum::<f64>()]
    });
    (0..2).for_each(|i| assert_close(elastic[i], rigid[i], 1e-13));
}

/// A spread conserves force and moment while it stays on the bridge; the part beyond it acts on the ground.
#[test]
fn a_spread_conserves_force_and_moment() {
    for angle in [0.0, 30.0, 60.0] {
        let text = changed(PRESTWOOD, "angle = 30.0", &format!("angle = {angle:?}"));
        let case = first_case(&text);
        let [force, moment] = sums(&case.stages[1].forces);
        assert_close(force, 1000.0, 1e-12);
        assert_close(moment, 1000.0 * 1.6375, 1e-12);
    }
    let at_the_end = changed(PRESTWOOD, "at = 1.6375", "at = 0.0");
    let [force, _] = sums(&first_case(&at_the_end).stages[1].forces);
    assert!(force > 500.0 && force < 1000.0, "{force}");
    let off = answered(&changed(PRESTWOOD, "at = 1.6375", "at = -2.0"));
    assert_eq!(off.status, Status::Unbounded);
    assert!(off.notes.iter().any(|note| note.contains("off the bridge")), "{:?}", off.notes);
}

/// A uniform load along the road equals a patch of the same length and weight; the part beyond the bridge has no
/// effect.
#[test]
fn a_lane_is_a_long_patch() {
    let patch = changed(RESISTING, "length = 0.3", "length = 1.2");
    let vehicle = "{ kind = \"vehicle\", vehicle = \"patch\", at = 0.75 }";
    let lane = |from: f64, pressure: f64| {
        let lane = format!("{{ kind = \"lane\", from = {from:?}, to = 1.35, pressure = {pressure:?} }}");
        changed(RESISTING, vehicle, &lane)
    };
    assert_close(collapse_factor(&lane(0.15, 1000.0 / (1.2 * 3.0))), collapse_factor(&patch), 1e-10);
    assert_close(collapse_factor(&lane(-50.0, 1000.0)), collapse_factor(&lane(-1.0, 1000.0)), 1e-10);
}

/// The width of the spread follows from the depth under its centre, and the pressure is uniform.
#[test]
fn the_spread_is_as_wide_as_the_depth_under_its_centre_says() {
    let case = first_case(PRESTWOOD);
    let chord =
        bridge(&case.assembly).extrados.iter().find(|c| c.left() <= 1.6375 && 1.6375 < c.right()).expect("a chord");
    let depth = 1.428 + 0.22 + 0.165 - chord.at(1.6375).y;
    let width = 0.3 + 2.0 * depth * 30f64.to_radians().tan();
    for force in &case.stages[1].forces {
        let under = bridge(&case.assembly).extrados.iter().find(|chord| chord.body == force.body).expect("a chord");
        let part = under.right().min(1.6375 + width / 2.0) - under.left().max(1.6375 - width / 2.0);
        assert_close(-force.force.y, 1000.0 * part / width, 1e-9);
    }
}

/// Returns the factor of the resisting ring with other numbers.
fn resisting(changes: &[(&str, &str)]) -> f64 {
    collapse_factor(&changes.iter().fold(RESISTING.to_string(), |text, (from, to)| changed(&text, from, to)))
}

/// With associated flow the load does not decrease with the resistance: with m_p, m_c, c and φ (least pressure zero).
/// No load is above that of unlimited resistance.
#[test]
fn the_load_grows_with_the_resistance() {
    let grows = |name: &str, factors: Vec<f64>| {
        assert!(factors.windows(2).all(|pair| pair[1] >= pair[0] * (1.0 - 1e-9)), "{name}: {factors:?}");
        factors[factors.len() - 1]
    };
    let passive = ["0.0", "0.1", "0.33", "1.0", "1e6"];
    let most = grows(
        "m_p",
        passive.map(|m| resisting(&[("passive_factor = 0.33", &format!("passive_factor = {m}"))])).to_vec(),
    );
    let cohesion = ["0.0", "1e3", "2e4"];
    let with = |c: &str, m: &str| {
        let (c, m) = (format!("cohesion = {c}"), format!("cohesion_factor = {m}"));
        resisting(&[("cohesion = 0.0", &c), ("cohesion_factor = 0.05", &m)])
    };
    let last = grows("c", cohesion.map(|c| with(c, "0.05")).to_vec());
    assert!(last <= most * (1.0 + 1e-9), "{last} {most}");
    grows("m_c", ["0.0", "0.05", "0.5"].map(|m| with("5e3", m)).to_vec());
    let angle = |degrees: &str| resisting(&[("friction_angle = 30.0", &format!("friction_angle = {degrees}"))]);
    grows("φ", ["0.0", "20.0", "30.0", "45.0"].map(angle).to_vec());
}

/// A least pressure never raises the load, because it narrows the range of the fill's force.
#[test]
fn a_least_pressure_never_raises_the_load() {
    let zero = resisting(&[]);
    for lower in ["active", "at_rest"] {
        let factor = resisting(&[("lower = \"zero\"", &format!("lower = \"{lower}\""))]);
        assert!(factor <= zero * (1.0 + 1e-9), "{lower}: {factor} {zero}");
    }
}

/// A block that is pushed into fill moves at Coulomb's wedge: the passive force of the fill is a closed form.
#[test]
fn a_block_pushed_into_fill_moves_at_coulombs_wedge() {
    let case = first_case(RESISTING);
    let reaction = &bridge(&case.assembly).reactions[0];
    // One chord with one material: σ_v is linear along it.
    let chord = bridge(&case.assembly).extrados[0];
    let depth = |y: f64| 0.75 + 0.25 + 0.3 - y;
    let [low, high] = [chord.ends[0].y, chord.ends[1].y];
    let mean = 1800.0 * 9.81 * (depth(low) + depth(high)) / 2.0;
    assert_close(reaction.bounds(9.81)[1], 0.33 * 3.0 * mean * (high - low) * 3.0, 1e-12);
    let centroid = (low * (2.0 * depth(low) + depth(high)) + high * (depth(low) + 2.0 * depth(high)))
        / (3.0 * (depth(low) + depth(high)));
    assert_close(reaction.point.y, centroid, 1e-12);
    assert_eq!([reaction.direction.x, reaction.direction.y], [1.0, 0.0]);
    assert_eq!(bridge(&case.assembly).reactions[19].direction.x, -1.0);
}

/// A mirrored bridge carries the same load of the mirrored vehicle, also backwards.
#[test]
fn mirrored_vehicles_carry_alike() {
    let axles =
        "axles = [{ at = 0.0, force = \"1 kN\", length = 0.3 }, { at = 0.9, force = \"0.4 kN\", length = 0.2 }]";
    let text = changed(PRESTWOOD, "axles = [{ at = 0.0, force = \"1 kN\", length = 0.3 }]", axles);
    let forward = collapse_factor(&text);
    let mirrored = changed(&text, "at = 1.6375 }", "at = 4.9125, direction = \"backward\" }");
    assert_close(collapse_factor(&mirrored), forward, 1e-9);
}

/// A narrow effective width concentrates the load.
#[test]
fn effective_width_raises_the_force_of_a_wheel() {
    let text = changed(PRESTWOOD, "length = 0.3 }", "length = 0.3, wheel_width = 1.0 }");
    let narrow = changed(&text, "at = 1.6375 }", "at = 1.6375, across = \"effective\" }");
    let [force, _] = sums(&first_case(&narrow).stages[1].forces);
    let [full, _] = sums(&first_case(&text).stages[1].forces);
    assert_close(full, 1000.0, 1e-12);
    let case = first_case(&text);
    let chord =
        bridge(&case.assembly).extrados.iter().find(|c| c.left() <= 1.6375 && 1.6375 < c.right()).expect("a chord");
    let reach = (1.428 + 0.22 + 0.165 - chord.at(1.6375).y) * 30f64.to_radians().tan();
    assert_close(force, 1000.0 * 3.8 / (1.0 + 2.0 * reach), 1e-9);
}

/// Rings with offset joints, or with different numbers of voussoirs, touch along whole edges and have the same weight.
#[test]
fn rings_with_offset_joints_touch_along_whole_edges() {
    for change in ["radial_joints = \"aligned\"", "radial_joints = \"offset\"", "voussoirs = [40, 43]"] {
        let rings = match change.starts_with("voussoirs") {
            true => changed(RINGS, "voussoirs = 40", change),
            false => changed(RINGS, "rings = 2", &format!("rings = 2, {change}")),
        };
        let case = first_case(&changed(
            &rings,
            "block = \"s0r1v10\", point = [0.609146335438797, 0.765008638200229]",
            "span_fraction = 0.2",
        ));
        let assembly = &case.assembly;
        let mass: f64 = (0..assembly.bodies.len()).map(|body| assembly.inertia(body).mass).sum();
        assert_close(mass, 2200.0 * 2.88 * ring_area(40), 1e-3);
        // The faces between the rings, computed again from the polygons, have the same total length.
        let law = |_: usize, _: usize| (Bond::Bonded, Gap::default());
        let (found, overlaps) = find_joints(&assembly.bodies, assembly.size(), law);
        assert!(overlaps.is_empty());
        let free = |joint: &&Joint| !assembly.bodies[joint.minus].fixed && !assembly.bodies[joint.plus].fixed;
        let built: f64 = assembly.joints.iter().filter(free).map(Joint::height).sum();
        assert_close(found.iter().map(Joint::height).sum(), built, 1e-9);
        let result = voussoir::solve_case(&case);
        assert!(result.certificate.passed, "{change}: {:?}", result.certificate);
    }
}

/// Returns the area of the ring's polygon with n chords \[m²\].
fn ring_area(n: usize) -> f64 {
    let (span, rise, thickness) = (3.0f64, 0.75f64, 0.215f64);
    let radius = (span * span / 4.0 + rise * rise) / (2.0 * rise);
    let angle = 4.0 * (2.0 * rise / span).atan() / n as f64;
    n as f64 * angle.sin() * ((radius + thickness).powi(2) - radius * radius) / 2.0
}

/// Weights, fill and loads of the results sum up to the total load on the bridge.
#[test]
fn the_list_of_loads_adds_up() {
    let result = answered(RESISTING);
    let sum = |what: LoadOrigin| -> f64 {
        result.loads.iter().filter(|entry| entry.what == what).map(|entry| -entry.resultant[1]).sum()
    };
    let case = first_case(RESISTING);
    let mass: f64 = (0..case.assembly.bodies.len()).map(|body| case.assembly.inertia(body).mass).sum();
    assert_close(sum(LoadOrigin::Weight), 9.81 * mass, 1e-12);
    let fill: f64 = bridge(&case.assembly).masses.iter().map(|fill| fill.mass).sum();
    assert_close(sum(LoadOrigin::Fill), 9.81 * fill, 1e-12);
    assert_close(sum(LoadOrigin::Load), 1000.0, 1e-12);
}

/// `verify` confirms a result with fill and finds every change of a force of the fill or of a load.
#[test]
fn tampering_with_fill_and_loads_is_found() {
    let (study, honest) = results(RESISTING);
    assert_eq!(findings(&study, &honest), Vec::<String>::new());
    let change = |path: &[&str], value: Value| {
        let mut forged = honest.clone();
        let mut place = &mut forged["cases"][0];
        for key in path {
            place = match key.parse::<usize>() {
                Ok(index) => &mut place[index],
                Err(_) => &mut place[*key],
            };
        }
        assert_ne!(*place, value, "{path:?} is no change");
        *place = value;
        assert!(!findings(&study, &forged).is_empty(), "{path:?}");
    };
    let pressed = (0..20).max_by(|a, b| {
        let force = |i: &usize| honest["cases"][0]["fill"][*i]["force"].as_f64().expect("a force");
        force(a).total_cmp(&force(b))
    });
    let pressed = pressed.expect("a force").to_string();
    let force =
        honest["cases"][0]["fill"][pressed.parse::<usize>().expect("an index")]["force"].as_f64().expect("a force");
    change(&["fill", &pressed, "force"], (force * (1.0 + 1e-6)).into());
    change(&["fill", &pressed, "force"], 0.0.into());
    change(&["fill", &pressed, "bounds", "1"], 1e9.into());
    change(&["fill", &pressed, "direction", "0"], 0.5.into());
    change(&["fill", &pressed, "block"], "0".into());
    change(&["loads", "3", "resultant", "1"], (-1.0).into());
    change(&["loads", "3", "block"], "nobody".into());
    change(&["loads", "25", "point", "0"], 0.0.into());
    change(&["load_factor"], 272.63.into());
}

/// Limit analysis with the laws' own flow supports fill.
#[test]
fn friction_that_does_not_dilate_takes_fill_too() {
    let own = changed(RESISTING, "law = \"coulomb_associated\"", "law = \"coulomb\"");
    let result: CaseResult = answered(&own);
    assert_eq!(result.status, Status::Collapse, "{:?}", result.notes);
    assert!(result.certificate.passed, "{:?}", result.certificate);
    assert!(result.load_factor.expect("a factor") <= 272.620144 * (1.0 + 1e-8));
}

/// Paths with elastic–plastic and with rigid–plastic fill end at the load of limit analysis, with elastic blocks and
/// with compliant joints, for any least pressure.
#[test]
fn paths_with_fill_end_at_the_limit_load() {
    let elastic = changed(RESISTING, "law = \"rigid\"", "law = \"elastic\"\nyoung_modulus = 5e9\npoisson_ratio = 0.2");
    let elastic = changed(&elastic, "[scene.fill]", "mesh = { elements = [2, 2] }\n[scene.fill]");
    let springs = "friction = 0.6\nnormal_stiffness = 1e10\nshear_stiffness = 5e9";
    let compliant = changed(RESISTING, "friction = 0.6", springs);
    for lower in ["zero", "active", "at_rest"] {
        let own = |text: &str| changed(text, "lower = \"zero\"", &format!("lower = \"{lower}\""));
        let limit = collapse_factor(&own(RESISTING));
        for text in [&elastic, &compliant] {
            for stiffness in [None, Some(1e8)] {
                let law = stiffness.map_or("law = \"fill_pressure\"".to_string(), |k: f64| {
                    format!("law = \"fill_pressure\", stiffness = {k:?}")
                });
                let text = changed(&own(text), "law = \"fill_pressure\"", &law);
                for solver in ["event_path", "newton_path"] {
                    let text = format!("{text}[solver]\nsolver = \"{solver}\"\n");
                    assert_close(collapse_factor(&text), limit, 1e-8);
                }
            }
        }
    }
}

/// Paths refuse a study whose gravity changes, because the strength of its fill changes too.
#[test]
fn paths_refuse_fill_whose_strength_changes() {
    let text = changed(RESISTING, "friction = 0.6", "friction = 0.6\nnormal_stiffness = 1e10\nshear_stiffness = 5e9");
    let twice = "[[stages]]\nname = \"more\"\ngravity = 12.0\n[[stages]]\nname = \"live\"";
    let result = answered(&changed(&text, "[[stages]]\nname = \"live\"", twice));
    assert_eq!(result.status, Status::Stalled);
    assert!(result.notes.iter().any(|note| note.contains("gravity changes")), "{:?}", result.notes);
}

/// Returns two rings with a damaged joint or voussoir.
fn two_rings(damage: &str) -> String {
    changed(RINGS, "[materials.stone]", &format!("damage = [{damage}]\n[materials.stone]"))
}

/// A joint with a part repointed with its own law has the same load; repointed without slip it is not weaker, and with
/// that part lost it is not stronger.
#[test]
fn repointed_and_lost_mortar() {
    let whole = first_case(RINGS);
    let sound = collapse_factor(RINGS);
    for side in ["intrados", "extrados"] {
        let own = two_rings(&format!(
            "{{ kind = \"repointed\", ring = 1, side = \"{side}\", depth = 0.03, joint = \"dry\" }}"
        ));
        assert_eq!(first_case(&own).assembly.joints.len(), whole.assembly.joints.len() + 41);
        assert_close(collapse_factor(&own), sound, 1e-8);
        let lost = collapse_factor(&two_rings(&format!(
            "{{ kind = \"lost_mortar\", ring = 1, side = \"{side}\", depth = 0.03 }}"
        )));
        assert!(lost < sound * 0.999, "{side}: {lost} {sound}");
    }
}

/// Joints that lost mortar are shorter: mortar is lost from both faces, and the deepest entry of a face counts.
#[test]
fn joints_that_lost_mortar_are_shorter() {
    let text = two_rings(
        "{ kind = \"lost_mortar\", joints = [3], depth = 0.02 }, { kind = \"lost_mortar\", joints = [3], depth = 0.01 }, \
         { kind = \"lost_mortar\", joints = [3], side = \"extrados\", depth = 0.03 }",
    );
    let (case, sound) = (first_case(&text), first_case(RINGS));
    let [joint, whole] = [&case, &sound].map(|case| case.assembly.joints[3].clone());
    assert_close((joint.ends[0] - whole.ends[0]).norm(), 0.02, 1e-12);
    assert_close((joint.ends[1] - whole.ends[1]).norm(), 0.03, 1e-12);
    assert_close(joint.height(), 0.1075 - 0.05, 1e-12);
}

/// A lost voussoir of the inner ring is removed with its weight and its four joints; a voussoir of the outer ring may
/// be lost only if a ring below remains.
#[test]
fn a_lost_voussoir() {
    let (case, sound) = (first_case(&two_rings("{ kind = \"lost_voussoir\", voussoirs = [12] }")), first_case(RINGS));
    assert!(case.assembly.body("s0r0v12").is_none() && case.assembly.body("s0r0v13").is_some());
    assert_eq!(case.assembly.joints.len() + 3, sound.assembly.joints.len());
    for joint in &case.assembly.joints {
        assert!(joint.minus < case.assembly.bodies.len() && joint.plus < case.assembly.bodies.len());
    }
    let outer = "{ kind = \"lost_voussoir\", ring = 1, voussoirs = [12] }";
    let rough = |text: &str| changed(text, "friction = 0.3", "friction = 100.0");
    let lost = collapse_factor(&rough(&two_rings(outer)));
    assert!(lost < collapse_factor(&rough(RINGS)), "{lost}");
    let faces = first_case(&two_rings(outer)).assembly.extrados();
    let below = faces.iter().filter(|face| face.from_middle == 15).count();
    assert_eq!((faces.len(), below), (41, 2), "the ring below and the side of one neighbour");
    let both = two_rings(&format!("{outer}, {{ kind = \"lost_voussoir\", voussoirs = [12] }}"));
    let wrong = voussoir::study::load(&both, "a.toml", &[]).unwrap_err();
    assert!(wrong.to_string().contains("nothing is left under it"), "{wrong}");
}

/// Bed joints of a pier are numbered from under its cap and lose mortar on a side that must be named.
#[test]
fn a_pier_that_lost_mortar() {
    let with = |damage: &str| changed(SPANS, "[materials.stone]", &format!("damage = [{damage}]\n[materials.stone]"));
    let lost =
        |side: &str| format!("{{ kind = \"lost_mortar\", pier = 0, joints = [1], side = \"{side}\", depth = 0.1 }}");
    let sound = first_case(SPANS);
    let foot = sound.assembly.joints.len() - 1;
    for (side, end) in [("right", 0), ("left", 1)] {
        let joint = first_case(&with(&lost(side))).assembly.joints[foot].clone();
        let whole = &sound.assembly.joints[foot];
        assert_close((joint.ends[end] - whole.ends[end]).norm(), 0.1, 1e-12);
        assert_eq!(joint.ends[1 - end], whole.ends[1 - end]);
    }
    assert!(collapse_factor(&with(&lost("left"))) <= collapse_factor(SPANS));
    for (wrong, said) in [
        (lost("intrados"), "\"left\" or \"right\""),
        (lost("left").replace("pier = 0", "pier = 0, ring = 0"), "besides pier"),
        (lost("left").replace("pier = 0", "pier = 1"), "they are 0 to 0"),
        (lost("left").replace("pier = 0, ", ""), "\"intrados\" or \"extrados\""),
    ] {
        let found = voussoir::study::load(&with(&wrong), "a.toml", &[]).unwrap_err();
        assert!(found.to_string().contains(said), "{found}");
    }
}

/// Partial factors: weights and loads scale the load of a ring without crushing, and each strength is divided.
#[test]
fn partial_factors_are_those_of_the_design_values() {
    let with = |factors: &str| collapse_factor(&format!("{RESISTING}[factors]\n{factors}"));
    let plain = collapse_factor(RESISTING);
    assert_close(with("masonry_weight = 1.2\nfill_weight = 1.2"), 1.2 * plain, 1e-9);
    assert_close(with("loads = 1.6"), plain / 1.6, 1e-9);
    assert_close(with("loads = { live = 1.6 }"), plain / 1.6, 1e-9);
    assert_close(
        with("friction = 1.5"),
        collapse_factor(&changed(RESISTING, "friction = 0.6", "friction = 0.4")),
        1e-9,
    );
    let angle = (30f64.to_radians().tan() / 1.25).atan().to_degrees();
    let by_hand = resisting(&[("friction_angle = 30.0", &format!("friction_angle = {angle:?}"))]);
    assert_close(with("fill_friction = 1.25"), by_hand, 1e-9);
    let crushing = collapse_factor(&changed(PRESTWOOD, "4.5 MPa", "3 MPa"));
    assert_close(collapse_factor(&format!("{PRESTWOOD}[factors]\ncompressive_strength = 1.5")), crushing, 1e-9);
    let result = answered(&format!("{RESISTING}[factors]\ncohesion = 2.0\nloads = 1.5"));
    assert!(
        result.notes.iter().any(|note| note.contains("factors.cohesion = 2 changes nothing")),
        "{:?}",
        result.notes
    );
    assert_eq!(result.partial_factors, Some(serde_json::json!({ "cohesion": 2.0, "loads": 1.5 })));
}

/// An axle on a track acts on three sleepers: 25, 50 and 25 % at their spacing, each on its width and the spread of the
/// ballast.
#[test]
fn an_axle_on_a_track() {
    let track = "at = 1.6375, track = { sleeper_spacing = 0.6, sleeper_width = 0.26, ballast_depth = 0.2 } }";
    let text =
        changed(&changed(PRESTWOOD, "at = 1.6375 }", track), "law = \"uniform\", angle = 30.0", "law = \"none\"");
    let forces = &first_case(&text).stages[1].forces;
    let [force, moment] = sums(forces);
    assert_close(force, 1000.0, 1e-12);
    assert_close(moment, 1637.5, 1e-12);
    // By hand: three patches of 0.26 + 2 × 0.2/4 = 0.36 m that do not touch.
    let near = |x: f64| forces.iter().filter(|f| (f.point.x - x).abs() < 0.18).map(|f| -f.force.y).sum::<f64>();
    for (x, share) in [(1.0375, 250.0), (1.6375, 500.0), (2.2375, 250.0)] {
        assert_close(near(x), share, 1e-12);
    }
}

/// Boussinesq's stress conserves force and moment, reaches to the cut-off, and has a higher pressure under the load
/// than the uniform spread of the same width.
#[test]
fn boussinesqs_stress_under_an_axle() {
    let text = changed(PRESTWOOD, "law = \"uniform\", angle = 30.0", "law = \"boussinesq\", angle = 45.0");
    let even = changed(PRESTWOOD, "angle = 30.0", "angle = 45.0");
    let (case, even_case) = (first_case(&text), first_case(&even));
    let [force, moment] = sums(&case.stages[1].forces);
    assert_close(force, 1000.0, 1e-12);
    assert_close(moment, 1637.5, 1e-12);
    let most = |forces: &[PointForce]| forces.iter().map(|f| -f.force.y).fold(0.0, f64::max);
    assert_eq!(case.stages[1].forces.len(), even_case.stages[1].forces.len());
    assert!(most(&case.stages[1].forces) > 1.1 * most(&even_case.stages[1].forces));
    let factors = [&text, &even, &changed(PRESTWOOD, "angle = 30.0", "angle = 0.0")].map(|text| collapse_factor(text));
    assert!(factors[2] < factors[0] && factors[0] < factors[1], "{factors:?}");
}

/// A vehicle of a published rule needs no entry; an entry of the study with its name has priority.
#[test]
fn documented_vehicles_need_no_entry() {
    let text = changed(PRESTWOOD, "vehicle = \"patch\"", "vehicle = \"cs454_single\"");
    assert_close(sums(&first_case(&text).stages[1].forces)[0], 11500.0 * 9.81, 1e-12);
    let own = changed(&text, "[vehicles.patch]", "[vehicles.cs454_single]");
    assert_close(sums(&first_case(&own).stages[1].forces)[0], 1000.0, 1e-12);
    let read = study(&text);
    assert!(read.resolved.to_string().contains("cs454_single"), "{}", read.resolved);
}

/// A ring whose thickness increases to the springings has joints of the given heights; with equal thicknesses it is the
/// uniform ring.
#[test]
fn a_ring_that_grows_to_the_springings() {
    let text = changed(PRESTWOOD, "thickness = 0.22", "thickness = { crown = 0.22, springing = 0.33 }");
    let joints = first_case(&text).assembly.joints;
    assert_close(joints[30].height(), 0.22, 1e-12);
    assert_close(joints[0].height(), 0.33, 1e-12);
    assert_close(joints[15].height(), 0.275, 1e-12);
    let same = changed(PRESTWOOD, "thickness = 0.22", "thickness = { crown = 0.22, springing = 0.22 }");
    assert_close(collapse_factor(&same), 107.198974, 1e-8);
    let wrong = changed(&text, "voussoirs = 60", "voussoirs = 60, springing = 20.0");
    assert!(voussoir::study::load(&wrong, "a.toml", &[]).is_err());
}
