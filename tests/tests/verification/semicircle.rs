//! Semicircular arches under self-weight: Milankovitch's thickness and the least friction.
//! Sources: Milankovitch (1907) by Makris & Alexakis; Cocchetti & Rizzi (2020), Frattura ed Integrità
//! Strutturale 51, doi 10.3221/IGF-ESIS.51.26.

use voussoir::core::limit::Status;
use voussoir_tests::{Arch, answered, elastic, friction};

/// Returns a semicircular ring of centreline radius 1 m with thickness `eta` m and radial joints.
fn ring(voussoirs: usize, eta: f64, joint: &str) -> String {
    let inner = 1.0 - eta / 2.0;
    Arch {
        span: 2.0 * inner,
        rise: inner,
        thickness: eta,
        width: 1.0,
        voussoirs,
        ends: "jointed",
        joint: joint.into(),
        ..Arch::default()
    }
    .dead_study()
}

fn stands(study: &str) -> bool {
    let result = answered(study);
    assert!(result.certificate.passed, "{:?} {:?}\n{study}", result.certificate, result.notes);
    match result.status {
        Status::Stands => true,
        Status::NoEquilibrium => false,
        other => panic!("{other:?}"),
    }
}

/// Returns the threshold of `stands` by bisection; it is false at `low` and true at `high`.
fn threshold(mut low: f64, mut high: f64, stands: impl Fn(f64) -> bool) -> f64 {
    assert!(!stands(low) && stands(high));
    while high - low > 1e-10 {
        let middle = (low + high) / 2.0;
        if stands(middle) { high = middle } else { low = middle }
    }
    high
}

fn least_thickness(voussoirs: usize) -> f64 {
    let stuck = "law = \"unilateral\"\ntangential = \"stuck\"";
    threshold(0.09, 0.12, |eta| stands(&ring(voussoirs, eta, stuck)))
}

/// 10 and 20 straight-sided voussoirs need 0.10701 and 0.10735 (independent program); the limit of many voussoirs is
/// Milankovitch's 0.107478038107 for exact wedge centroids.
#[test]
fn least_thickness_tends_to_milankovitch() {
    assert!((least_thickness(10) - 0.10701).abs() < 5e-6);
    assert!((least_thickness(20) - 0.10735).abs() < 5e-6);
    let limit = 0.107_478_038_107;
    for n in [40, 160, 640] {
        // Chords and the possible positions of hinges each contribute a multiple of 1/n².
        let error = (least_thickness(n) - limit).abs();
        assert!(error < 1.0 / (n * n) as f64, "{n} voussoirs: {error:e}");
    }
    assert!((least_thickness(640) - limit).abs() < 1e-6);
}

/// Elastic voussoirs with finite displacements: below Milankovitch's thickness no path begins; above it the path ends
/// in equilibrium.
#[test]
fn thin_elastic_rings_have_no_path_under_their_weight() {
    let text = |eta: f64| {
        let study = ring(10, eta, &friction(0.6)).replace("law = \"rigid\"", &elastic(5e9, 0.2));
        let mesh = "[scene.mesh]\nelements = [1, 2]\norder = 1\n[materials.stone]";
        study
            .replace("[materials.stone]", mesh)
            .replace("solver = \"auto\"", "solver = \"newton_path\"\nkinematics = \"finite\"")
    };
    let thin = answered(&text(0.106));
    assert!(thin.certificate.passed && thin.notes[0].contains("No load path was computed"), "{:?}", thin.notes);
    assert_eq!((thin.status, thin.stages[0].status), (Status::NoEquilibrium, Status::NoEquilibrium));
    let thick = answered(&text(0.109));
    assert_eq!((thick.status, thick.solver.as_str()), (Status::Stands, "newton_path"), "{:?}", thick.notes);
}

/// Below μ = 0.309215444330 no semicircular arch stands; the threshold of a thick ring tends to this value.
#[test]
fn least_friction() {
    let least = |voussoirs: usize| threshold(0.2, 0.5, |mu| stands(&ring(voussoirs, 0.22, &friction(mu))));
    let limit = 0.309_215_444_330;
    let errors: Vec<f64> = [40, 640].map(|n| (least(n) - limit).abs()).into();
    assert!(errors[0] > 10.0 * errors[1], "{errors:?}");
    assert!(errors[1] < 1e-5, "{errors:?}");
}
