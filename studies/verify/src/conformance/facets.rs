//! Facets: admissible tractions, flow, and agreement with the tractions from gaps.

use super::findings::Recorder;
use super::point::Point;
use super::random::random_step;
use super::subject::Subject;
use voussoir_core::law::{Facet, FacetMode, YieldPolygon};
use voussoir_core::plugin::{Card, Property};
use voussoir_core::random::Random;

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn length(a: [f64; 2]) -> f64 {
    a[0].hypot(a[1])
}

/// Checks the facets alone.
pub(super) fn check(recorder: &mut Recorder, card: &Card, facets: &[Facet]) {
    for facet in facets {
        one(recorder, card, facet);
    }
    let finite = facets.iter().all(|f| f.normal.iter().chain(&f.flow).chain([&f.bound]).all(|x| x.is_finite()));
    if facets.is_empty() || !finite {
        return recorder.hold("facets", finite, || "no facet admits any traction".into());
    }
    let polygon = YieldPolygon::of(facets);
    recorder.hold("normal", polygon.least_normal().is_finite(), || {
        "the facets admit tension without bound: t_n is positive in compression".into()
    });
    let scale = facets.iter().map(|f| f.bound.abs()).fold(1.0, f64::max);
    for Facet { normal: a, bound, flow: d, .. } in facets {
        let reached = polygon.vertices.iter().filter(|v| dot(*a, **v) >= bound - 1e-9 * scale * length(*a));
        let along = polygon.rays.iter().filter(|r| dot(*a, **r) >= -1e-9 * length(*a));
        let least = reached.map(|v| dot(*d, *v) / scale).chain(along.map(|r| dot(*d, *r))).fold(0.0, f64::min);
        recorder.hold("dissipation", least >= -1e-9 || !card.claims(Property::DISSIPATIVE), || {
            format!("flow {d:?} on the facet {a:?}·t ≤ {bound} creates energy")
        });
    }
}

fn one(recorder: &mut Recorder, card: &Card, facet: &Facet) {
    let Facet { mode, normal: a, bound, flow: d } = facet;
    let finite = a.iter().chain(d).chain([bound]).all(|x| x.is_finite());
    recorder.hold("facets", finite && length(*a) > 0.0 && length(*d) > 0.0, || {
        format!("{facet:?} is no half plane with flow")
    });
    recorder.hold("facets", *bound >= 0.0, || format!("{facet:?}: the stress-free joint is not admissible"));
    match mode {
        FacetMode::Opening => recorder.hold("normal", a[0] < 0.0, || {
            format!("{facet:?} is to bound tension, but t_n is positive in compression: its normal must point to negative t_n")
        }),
        FacetMode::Crushing => recorder.hold("normal", a[0] > 0.0, || {
            format!("{facet:?} is to bound compression, but t_n is positive there: its normal must point to positive t_n")
        }),
        FacetMode::Sliding => {
            recorder.hold("friction", a[0] <= 0.0, || {
                format!("{facet:?}: compression lowers the shear that it admits; friction is |t_t| − μ t_n ≤ c")
            });
            recorder.hold("facets", a[1] != 0.0, || format!("{facet:?} is called sliding, but bounds no shear"));
        }
    }
    recorder.hold("associated", a == d || !card.claims(Property::ASSOCIATED), || {
        format!("claims associated flow, but flows along {d:?} on a facet with normal {a:?}")
    });
}

/// Returns true if v = Σ γ r with γ ≥ 0 over at most two of the rays.
fn in_cone(v: [f64; 2], rays: &[[f64; 2]], tolerance: f64) -> bool {
    let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
    let alone = |r: &[f64; 2]| cross(v, *r).abs() <= tolerance * length(*r) && dot(v, *r) >= 0.0;
    let pair = |r: &[f64; 2], s: &[f64; 2]| {
        let d = cross(*r, *s);
        d != 0.0 && cross(v, *s) / d >= 0.0 && cross(*r, v) / d >= 0.0
    };
    length(v) <= tolerance || rays.iter().any(|r| alone(r) || rays.iter().any(|s| pair(r, s)))
}

/// If a law has both forms, they must agree: tractions lie within the facets, and the part of the gap that stiffness does
/// not explain grows along the flow of active facets. A facet without tensile strength opens and closes.
pub(super) fn against_response(recorder: &mut Recorder, subject: &Subject, facets: &[Facet], k: [f64; 2]) {
    let (Point::Joint(_), size) = (&subject.point, subject.sample.size) else { return };
    let (mut random, tolerance, mut flows) = (Random::new(17), 1e-9 * size, 0);
    for _ in 0..100 {
        let (mut old, mut new) = (subject.point.untouched(), vec![0.0; subject.point.state_size()]);
        let (mut gap, mut before, mut path) = ([0.0; 6], [0.0; 2], Vec::new());
        for _ in 0..25 {
            random_step(&mut random, &mut gap, 2, size);
            path.push(gap);
            let Ok(said) = subject.point.update(&gap, &old, &mut new) else { break };
            let t = [said.force[0], said.force[1]];
            let excess = |a: [f64; 2], b: f64| (dot(a, t) - b) / k[0].max(k[1]);
            recorder.hold_on(
                "facets_and_response",
                facets.iter().all(|f| excess(f.normal, f.bound) <= tolerance),
                &path,
                || format!("tractions {t:?} from gaps are outside the facets"),
            );
            let after = [gap[0] + t[0] / k[0], gap[1] + t[1] / k[1]];
            let mut rays = Vec::new();
            for facet in facets {
                let reversible = facet.mode == FacetMode::Opening && facet.bound == 0.0;
                rays.extend(reversible.then_some(facet.flow));
                let reached = reversible || excess(facet.normal, facet.bound) >= -tolerance;
                rays.extend(reached.then_some(facet.flow.map(|d| -d)));
            }
            let flow = [after[0] - before[0], after[1] - before[1]];
            recorder.hold_on("facets_and_response", in_cone(flow, &rays, tolerance), &path, || {
                format!("at {t:?} the gap grows by {flow:?}, which is no flow of the facets that are reached")
            });
            flows += usize::from(length(flow) > tolerance);
            before = after;
            old.copy_from_slice(&new);
        }
    }
    recorder.hold("facets_and_response", flows >= 200, || {
        format!("only {flows} steps flowed: give the sample another size")
    });
}
