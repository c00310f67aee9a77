//! Counts of work: a performance regression fails here without a clock.

use voussoir::results::CaseResult;
use voussoir_tests::known::peers_ring;
use voussoir_tests::{Arch, answered, compliant, elastic, friction};

fn pivots(voussoirs: usize) -> u64 {
    answered(&Arch { voussoirs, ends: "jointed", solver: "limit_chain", ..Arch::default() }.study()).counters["pivots"]
}

/// The chain solver needs two programs and no sparse factorisation for the 14-joint arch.
#[test]
fn the_chain_solver_factorises_nothing() {
    let result = answered(&Arch { voussoirs: 13, ends: "jointed", ..Arch::default() }.study());
    assert_eq!(result.solver, "limit_chain");
    assert_eq!(result.counters["programs"], 2);
    assert_eq!(result.counters["factorisations"], 0);
    assert!(result.counters["pivots"] <= 16, "{:?}", result.counters);
}

/// The number of pivots hardly grows with the number of joints; the cost of one pivot is linear.
#[test]
fn pivots_do_not_grow_with_the_ring() {
    let counts = [13, 130, 1300, 10_000].map(pivots);
    assert!(counts.iter().all(|&count| count <= 30), "{counts:?}");
}

/// Dead load that the next stage checks is not solved twice: two stages need two programs.
#[test]
fn a_stage_that_the_next_one_covers_costs_nothing() {
    let result = answered(&Arch::default().study());
    assert_eq!((result.stages.len(), result.counters["programs"]), (2, 2));
}

/// A ring of 10,000 voussoirs is solved and certified within rounding.
#[test]
fn ten_thousand_voussoirs() {
    let result = answered(&Arch { voussoirs: 10_000, ends: "jointed", ..Arch::default() }.study());
    assert!(result.certificate.passed, "{:?}", result.certificate);
    let [low, high] = result.both_bounds().expect("bounds");
    assert!((high - low) / high < 1e-12);
}

/// Returns the result of the benches' ring of rigid voussoirs on compliant joints, followed to its collapse.
fn traced(voussoirs: usize, solver: &'static str) -> CaseResult {
    let joint = compliant(&friction(0.6), 1e10, 4e9);
    let result = answered(&Arch { joint, solver, ..peers_ring(voussoirs) }.study());
    assert!(result.certificate.passed, "{voussoirs}, {solver}: {:?}", result.certificate);
    result
}

/// An event of elastic voussoirs costs little: the whole system is solved at the beginning and at the end only, and the
/// chain is factorised again at most once in a hundred events.
#[test]
fn an_event_of_elastic_voussoirs_costs_little() {
    for voussoirs in [13, 40] {
        let mesh = "elements = [1, 4]\norder = 2".into();
        let ring = Arch { material: elastic(5e9, 0.3), mesh, solver: "event_path", ..peers_ring(voussoirs) };
        let counters = answered(&ring.study()).counters;
        let directions = counters["rate_problems"];
        assert!(counters["rate_problems_by_redundants"] + 5 >= directions, "{voussoirs}: {counters:?}");
        assert!(
            counters["factorisations"] <= 8 + directions / 100 && 3 * counters["solves"] <= directions,
            "{voussoirs}: {counters:?}"
        );
        assert!(5 * counters["rate_trials"] <= 6 * directions + 50, "{voussoirs}: {counters:?}");
    }
}

/// An event of rigid voussoirs on compliant joints costs little.
#[test]
fn an_event_of_rigid_voussoirs_costs_little() {
    for voussoirs in [13, 40, 130] {
        let counters = traced(voussoirs, "event_path").counters;
        let events = counters["rate_problems"];
        assert!(counters["rate_problems_by_redundants"] + 5 >= events, "{voussoirs}: {counters:?}");
        assert!(
            counters["factorisations"] <= 8 + events / 100 && 3 * counters["solves"] <= events,
            "{voussoirs}: {counters:?}"
        );
    }
}

/// With finite displacements an event costs one state: its equations are assembled and factorised once.
#[test]
fn an_event_with_finite_displacements_costs_one_state() {
    for joint in [friction(0.6), "law = \"coulomb\"\nfriction = 0.6".into()] {
        let (mesh, solver) = ("elements = [1, 4]\norder = 2".into(), "newton_path\"\nkinematics = \"finite");
        let ring = Arch { material: elastic(5e9, 0.3), mesh, joint, solver, ..peers_ring(13) };
        let counters = answered(&ring.study()).counters;
        let [events, states] = ["events", "states"].map(|what| counters[what]);
        assert!(events > 100 && 4 * counters["assemblies"] <= 5 * states, "{counters:?}");
        assert!(
            4 * counters["factorisations"] <= 5 * states && counters["newton_iterations"] <= 2 * states,
            "{counters:?}"
        );
    }
}

/// Three spans on two piers with fill, 60 blocks on compliant joints. The first rate of all 1048 contact points comes from
/// the path with strength, in which facets with slack do not take part. The load is that of limit analysis.
#[test]
fn a_bridge_of_sixty_blocks_costs_little() {
    let text = |stiffness: &str, solver: &str| {
        format!(
            r#"name = "bridge"
[scene]
scene = "bridge"
width = 3.0
material = "stone"
joint = "dry"
ring_joint = "dry"
spans = [
  {{ profile = {{ shape = "segmental", span = 3.3, rise = 0.7 }}, thickness = 0.37, voussoirs = 14, rings = 2, ends = "jointed" }},
  {{ profile = {{ shape = "segmental", span = 2.6, rise = 1.0 }}, thickness = 0.21, voussoirs = 15, rings = 1, ends = "jointed" }},
  {{ profile = {{ shape = "segmental", span = 8.1, rise = 1.6 }}, thickness = 0.89, voussoirs = 7, rings = 1, ends = "jointed" }},
]
piers = [
  {{ height = 5.7, width = 0.86, base_width = 0.86, courses = 4 }},
  {{ height = 3.5, width = 1.64, base_width = 1.64, courses = 4 }},
]
[scene.fill]
cover = 0.53
density = 2200.0
friction_angle = 42.0
resistance = {{ law = "fill_pressure", passive_factor = 0.33, cohesion_factor = 0.0 }}
[materials.stone]
law = "rigid"
density = 2570.0
[joints.dry]
law = "coulomb_associated"
friction = 0.8
{stiffness}
[vehicles.axle]
axles = [{{ at = 0.0, force = 1e5, length = 0.4 }}]
[solver]
solver = "{solver}"
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "live"
until = "collapse"
loads = [{{ kind = "vehicle", vehicle = "axle", at = 8.0 }}]
"#
        )
    };
    let limit = answered(&text("", "auto"));
    let path = answered(&text("normal_stiffness = 1e10\nshear_stiffness = 4e9", "event_path"));
    let [limit, load] = [&limit, &path].map(|result| result.load_factor.expect("a load"));
    assert!((load - limit).abs() <= 1e-9 * limit, "{load}, limit analysis {limit}");
    assert!(path.counters["factorisations"] <= 200 && path.counters["solves"] <= 8000, "{:?}", path.counters);
}
