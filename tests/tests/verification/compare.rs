//! Comparisons of flow rules: relations between the variants of every scene, published walls, and the axes of `compare`
//! and `map`.

use std::sync::OnceLock;
use voussoir::core::limit::Status;
use voussoir::kinds::kind;
use voussoir::results::{CaseResult, Comparison, ComparisonCell, StudyResults};
use voussoir::solve::Observer;
use voussoir::study::{Study, load};
use voussoir::verify::verify;
use voussoir_tests::known::published_wall;
use voussoir_tests::{assert_close, study};

struct Silent;

impl Observer for Silent {
    fn answered(&self, _: &CaseResult) {}
}

fn results(study: &Study) -> StudyResults {
    let kind = kind(&study.kind).expect("a registered kind");
    let wanted: Vec<usize> = (0..study.cases.len()).collect();
    let cases = kind.solve(study, &wanted, 2, &Silent);
    study.results("test", cases)
}

/// Returns the ten scenes of docs/theory/flow_rule.md with their results, solved once for all tests.
fn ten_scenes() -> &'static (Study, StudyResults) {
    static ANSWERED: OnceLock<(Study, StudyResults)> = OnceLock::new();
    ANSWERED.get_or_init(|| {
        let study = study(include_str!("../../../studies/cases/flow_rule_ten_scenes.toml"));
        let results = results(&study);
        (study, results)
    })
}

fn comparison() -> &'static Comparison {
    ten_scenes().1.comparison.as_ref().expect("a comparison")
}

fn variant<'a>(cells: &'a [ComparisonCell], name: &str) -> &'a ComparisonCell {
    &cells[comparison().variants.iter().position(|variant| variant == name).expect("a variant")]
}

/// Variants have the proved order on every scene: no path load is above the associated load; least ≤ sequential ≤
/// associated; a path that ends in a mechanism is at or above the proved lower bound of the least load, and at or
/// above the least load found if the bracket is closed.
#[test]
fn variants_stand_in_the_order_of_the_theory() {
    let (mut sequences, mut paths) = (0, 0);
    for row in &comparison().rows {
        let name = row.scene.as_deref().expect("a scene");
        let associated = variant(&row.cells, "associated").load_factor.expect(name);
        let least = variant(&row.cells, "least");
        let ([lower, found], status) = (least.bounds.expect(name), least.status);
        // Without a proved lower end the least load is open.
        assert_eq!(status, Some(if lower.is_some() { Status::Collapse } else { Status::Open }), "{name}");
        let ([lower, found], least) = ([lower.unwrap_or(0.0), found.expect(name)], least.load_factor.expect(name));
        assert!(lower <= found * (1.0 + 1e-9) && (found - least).abs() <= 1e-9 * found, "{name}: {lower} … {found}");
        assert!(least <= associated * (1.0 + 1e-9), "{name}: least {least}, associated {associated}");
        if let Some(sequential) = variant(&row.cells, "sequential").load_factor {
            sequences += 1;
            assert!(least <= sequential * (1.0 + 1e-6), "{name}: least {least}, sequential {sequential}");
            assert!(sequential <= associated * (1.0 + 1e-9), "{name}: sequential {sequential}, {associated}");
        }
        let path = variant(&row.cells, "elastic path");
        if let Some(factor) = path.load_factor {
            paths += 1;
            assert!(factor <= associated * (1.0 + 1e-9), "{name}: path {factor}, associated {associated}");
            assert!(path.status != Some(Status::Collapse) || factor >= lower * (1.0 - 1e-9), "{name}: {factor}");
            assert!(lower < found * (1.0 - 1e-9) || factor >= least * (1.0 - 1e-9), "{name}: {factor}, {least}");
        }
    }
    assert!(comparison().rows.len() == 10 && sequences >= 8 && paths >= 8, "{sequences} sequences, {paths} paths");
}

/// Ferris and Tin-Loi (2001): associated .64285900, .40369410, .33194840; least .63898183, .35581738, 24/91. The
/// elastic paths of walls 3 and 4 end at the least load.
#[test]
fn published_walls() {
    let walls = [1, 3, 4].map(published_wall).map(|known| (known.associated, known.least));
    for (row, (associated, least)) in comparison().rows.iter().zip(walls) {
        assert_close(variant(&row.cells, "associated").load_factor.expect("a factor"), associated, 3e-8);
        assert_close(variant(&row.cells, "least").load_factor.expect("a factor"), least, 3e-8);
    }
}

/// The load of a single ring does not depend on the flow rule: with four yielding joints equilibrium and yield
/// determine the thrust line, with any flow.
#[test]
fn a_single_ring_does_not_feel_the_flow_rule() {
    let row = comparison().rows.last().expect("rows");
    assert_eq!(row.scene.as_deref(), Some("segmental arch"));
    for cell in &row.cells {
        assert!((cell.ratio.expect("a ratio") - 1.0).abs() <= 1e-9, "{cell:?}");
    }
}

/// Four yielding joints determine a single ring, also with low friction: the associated mechanism moves four joints, so
/// equilibrium and yield there determine three redundants and the factor. Every other variant moves only joints among
/// these four and has the same load.
#[test]
fn four_yielding_joints_determine_a_single_ring() {
    let (_, results) = ten_scenes();
    let moving = |case: &CaseResult| -> Vec<usize> {
        let mechanism = case.mechanism.as_ref().expect("a mechanism");
        let (hinges, sliding) = (mechanism.hinges.iter().map(|h| h.joint), mechanism.sliding.iter().map(|s| s.joint));
        let joints: std::collections::BTreeSet<usize> = hinges.chain(sliding).collect();
        joints.into_iter().collect()
    };
    for row in comparison().rows.iter().skip(6) {
        let yielding = moving(&results.cases[variant(&row.cells, "associated").case]);
        assert_eq!(yielding.len(), 4, "{:?}: {yielding:?}", row.scene);
        for cell in &row.cells {
            let joints = moving(&results.cases[cell.case]);
            assert!(joints.iter().all(|joint| yielding.contains(joint)), "{:?}: {joints:?}, {yielding:?}", row.scene);
            assert!((cell.ratio.expect("a ratio") - 1.0).abs() <= 1e-8, "{:?}: {cell:?}", row.scene);
        }
    }
}

/// `verify` confirms the results of two of the ten scenes, the portal and the last one; a changed ratio is found.
#[test]
fn verify_repeats_the_comparison() {
    let text = include_str!("../../../studies/cases/flow_rule_ten_scenes.toml");
    let mark = "[[compare.scenes]]";
    let parts: Vec<&str> = text.split(mark).collect();
    assert!(parts.len() == 11 && parts[5].contains("portal"), "{}", parts[5]);
    let study = study(&[parts[0], parts[5], parts[10]].join(mark));
    let results = results(&study);
    assert_eq!(verify(&study, &results), vec![]);
    let mut changed = results;
    changed.comparison.as_mut().expect("a comparison").rows[1].cells[2].ratio = Some(0.9);
    let wrong = verify(&study, &changed);
    assert!(wrong.iter().any(|(_, why)| why.contains("comparison")), "{wrong:?}");
}

/// Blocks pushed sideways on the ground: with friction μ < base/height they slide at λ = μ in every variant.
const BLOCK: &str = r#"
[scene]
scene = "wall"
width = 1.0
brick = [0.4, 0.2]
courses = 1
bricks = 1
material = "stone"
joint = "dry"
[materials.stone]
law = "rigid"
density = 2000.0
[joints.dry]
law = "coulomb"
friction = 0.5
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "push"
until = "collapse"
loads = [{ kind = "body", acceleration = [9.81, 0.0] }]
"#;

/// Variants are the outermost axis, then scenes, then the sweep. A variant is set on top of a scene; the ratio is to
/// the reference.
#[test]
fn scenes_are_an_axis() {
    let text = format!(
        r#"name = "axes"
kind = "compare"
{BLOCK}
[compare]
reference = "rough"
[[compare.scenes]]
name = "as it is"
[[compare.scenes]]
name = "pulled"
set = {{ "stages.push.loads.0.acceleration" = [-9.81, 0.0], "joints.dry.friction" = 0.1 }}
[[variants]]
name = "smooth"
[[variants]]
name = "rough"
set = {{ "joints.dry" = {{ law = "coulomb_associated", friction = 0.6 }} }}
[sweep]
"scene.brick.0" = {{ list = [0.3, 0.4] }}
"#
    );
    let study = study(&text);
    let order: Vec<_> = study.cases.iter().map(|c| (c.variant.clone().unwrap(), c.scene.clone().unwrap())).collect();
    let expected = [("smooth", "as it is"), ("smooth", "pulled"), ("rough", "as it is"), ("rough", "pulled")];
    for (id, (variant, scene)) in order.iter().enumerate() {
        assert_eq!((variant.as_str(), scene.as_str()), expected[id / 2], "case {id}");
    }
    let results = results(&study);
    let comparison = results.comparison.as_ref().expect("a comparison");
    assert_eq!((comparison.reference.as_str(), comparison.rows.len()), ("rough", 4));
    for (row, ratio) in comparison.rows.iter().zip([0.5 / 0.6, 0.5 / 0.6, 0.1 / 0.6, 0.1 / 0.6]) {
        assert_close(row.cells[0].ratio.expect("a ratio"), ratio, 1e-9);
        assert_eq!(row.cells[1].ratio, Some(1.0));
    }
    assert_eq!(verify(&study, &results), vec![]);
}

/// The axes of a map are those of the sweep; the first one is along x and changes slowest.
#[test]
fn a_map_has_the_axes_of_the_sweep() {
    let text = format!(
        r#"name = "axes"
kind = "map"
{BLOCK}
[map]
x_label = "friction [-]"
[sweep]
"joints.dry.friction" = {{ list = [0.2, 0.4, 0.6] }}
"scene.brick.1" = {{ list = [0.1, 0.2] }}
[[variants]]
name = "own"
[[variants]]
name = "associated"
set = {{ "joints.dry.law" = "coulomb_associated" }}
"#
    );
    let results = results(&study(&text));
    let comparison = results.comparison.expect("a comparison");
    let map = comparison.map.as_ref().expect("a map");
    assert_eq!((map.x_values.as_slice(), map.y_values.as_slice()), (&[0.2, 0.4, 0.6][..], &[0.1, 0.2][..]));
    assert_eq!(
        (map.x_label.as_str(), map.contours.as_str(), map.regions.as_str()),
        ("friction [-]", "associated", "own")
    );
    assert_eq!(map.y_label, "length and height of a brick, height [m]");
    for (place, row) in comparison.rows.iter().enumerate() {
        assert_eq!(row.parameters["joints.dry.friction"].as_f64(), Some(map.x_values[place / 2]));
        assert_close(row.cells[0].load_factor.expect("a factor"), map.x_values[place / 2], 1e-9);
    }
    let svg = voussoir::figures::map_svg("axes", &comparison).expect("a figure");
    assert!(svg.contains("friction [-]") && svg.contains("sliding (6)"), "{svg}");
}

/// A comparison without variants and a map with one axis are refused.
#[test]
fn what_cannot_be_compared_is_refused() {
    for (kind, words) in [("compare", "sets variants beside each other"), ("map", "needs two axes")] {
        let wrong = load(&format!("name = \"x\"\nkind = \"{kind}\"\n{BLOCK}"), "x.toml", &[]).expect_err("no variants");
        assert!(wrong.mistakes().iter().any(|mistake| mistake.message.contains(words)), "{wrong:?}");
    }
}
