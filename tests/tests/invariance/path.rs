//! Changes that must not change a path with non-associated friction: reflection, order of the blocks, units. Events are
//! compared one by one.

use voussoir::core::model::geometry::Vec2;
use voussoir::core::path::ContactEvent;
use voussoir::results::CaseResult;
use voussoir_tests::{Arch, answered, as_blocks, assert_close, changed, elastic};

const VOUSSOIRS: usize = 11;

fn arch() -> Arch {
    Arch {
        voussoirs: VOUSSOIRS,
        ends: "jointed",
        material: elastic(5e9, 0.3),
        mesh: "elements = [3, 3]\norder = 2".into(),
        joint: "law = \"coulomb\"\nfriction = 0.35".into(),
        solver: "event_path",
        ..Arch::default()
    }
}

fn path(study: &str) -> CaseResult {
    let result = answered(study);
    assert!(result.certificate.passed && result.solver == "event_path", "{:?}", result.notes);
    result
}

/// Returns (point, event, factor) of all events in a canonical order.
fn events(
    result: &CaseResult,
    place: impl Fn([f64; 2]) -> [f64; 2],
    what: impl Fn(ContactEvent) -> ContactEvent,
) -> Vec<([f64; 2], String, bool, f64)> {
    let round = |x: f64| (x * 1e6).round() / 1e6 + 0.0;
    let one = |e: &voussoir::results::EventEntry| {
        (place(e.point).map(round), format!("{:?}", what(e.what)), e.gravity, e.factor)
    };
    let mut all: Vec<_> = result.path.events.iter().map(one).collect();
    all.sort_by(|a, b| {
        let order = a.0[0].total_cmp(&b.0[0]).then(a.0[1].total_cmp(&b.0[1]));
        order.then(a.2.cmp(&b.2)).then(a.3.total_cmp(&b.3)).then(a.1.cmp(&b.1))
    });
    all
}

fn same_events(found: Vec<([f64; 2], String, bool, f64)>, expected: Vec<([f64; 2], String, bool, f64)>, unit: f64) {
    assert_eq!(found.len(), expected.len());
    for (a, b) in found.iter().zip(&expected) {
        assert_eq!((a.0, &a.1, a.2), (b.0, &b.1, b.2));
        assert!((a.3 - b.3).abs() <= 1e-8 * unit, "{a:?} {b:?}");
    }
}

fn same(found: &CaseResult, expected: &CaseResult) {
    assert_eq!(found.status, expected.status, "{:?}", found.notes);
    assert_close(found.load_factor.unwrap(), expected.load_factor.unwrap(), 1e-9);
    let kind = |r: &CaseResult| r.mechanism.as_ref().map(|m| (m.kind, m.hinge_count, m.sliding.len()));
    assert_eq!(kind(found), kind(expected));
    let slips =
        |e: &&voussoir::results::EventEntry| matches!(e.what, ContactEvent::SlipsForward | ContactEvent::SlipsBackward);
    assert!(expected.path.events.iter().filter(slips).count() > 0, "it slides");
}

#[test]
fn mirror_order_and_units_do_not_matter() {
    let order: Vec<usize> = (0..VOUSSOIRS).collect();
    let plain = path(&as_blocks(&arch(), |p| p, |v| v, &order));
    let unit = plain.load_factor.unwrap();
    let keep = |what| what;
    let expected = events(&plain, |p| p, keep);
    assert!(expected.len() > 50);

    // Reflection changes the sign of x, and with it the sense of the tangent.
    let flip = |v: Vec2| Vec2::new(-v.x, v.y);
    let mirrored = path(&as_blocks(&arch(), flip, flip, &order));
    same(&mirrored, &plain);
    let other = |what| match what {
        ContactEvent::SlipsForward => ContactEvent::SlipsBackward,
        ContactEvent::SlipsBackward => ContactEvent::SlipsForward,
        kept => kept,
    };
    same_events(events(&mirrored, |[x, y]| [-x, y], other), expected.clone(), unit);

    // Another order of blocks exchanges minus and plus of joints: normal and tangent are reversed.
    let shuffled: Vec<usize> = (0..VOUSSOIRS).map(|k| (4 * k + 3) % VOUSSOIRS).collect();
    let renumbered = path(&as_blocks(&arch(), |p| p, |v| v, &shuffled));
    same(&renumbered, &plain);
    same_events(events(&renumbered, |p| p, keep), expected.clone(), unit);

    // Millimetres, tonnes and seconds: N and N/mm².
    let base = arch();
    let metric = Arch {
        span: base.span * 1e3,
        rise: base.rise * 1e3,
        thickness: base.thickness * 1e3,
        width: base.width * 1e3,
        density: base.density * 1e-12,
        material: elastic(5e3, 0.3),
        ..base
    };
    let text = as_blocks(&metric, |p| p, |v| v, &order);
    let scaled = path(&changed(&text, "gravity = [0.0, -9.81]", "gravity = [0.0, -9810.0]"));
    same(&scaled, &plain);
    same_events(events(&scaled, |p| p.map(|x| x * 1e-3), keep), expected, unit);
}
