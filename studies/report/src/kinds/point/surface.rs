//! The yield surface of a law in the plane of pressure p and deviatoric stress q. The law is evaluated along rays of triaxial
//! compression to find the greatest stress at which it is still elastic.

use voussoir_solvers::point::{Control, DrivenPoint, PointLaw};

/// Number of rays towards each of the two far edges of the figure.
const RAYS: usize = 40;
/// Number of bisections of the interval in which the law yields.
const HALVINGS: usize = 40;

/// Returns true if the untouched law stays elastic under σ_xx = −p − 2q/3, σ_yy = σ_zz = −p + q/3.
fn is_elastic(law: &PointLaw, p: f64, q: f64) -> bool {
    let Ok(mut point) = DrivenPoint::new(law.clone()) else { return false };
    let across = -p + q / 3.0;
    let stress = [-p - 2.0 * q / 3.0, across, across, 0.0, 0.0, 0.0];
    let controls = stress.map(Control::Stress);
    point.step(&controls[..law.components()]).is_ok() && point.response.region == "elastic"
}

/// Returns points (p, q) of the surface within p ≤ `far[0]`, q ≤ `far[1]` \[Pa\], in order from the axis of p. Empty if the
/// law does not yield in this range, or has no stresses in space.
pub(super) fn yield_surface(law: &PointLaw, far: [f64; 2]) -> Vec<(f64, f64)> {
    if !matches!(law, PointLaw::Space(..)) || !is_elastic(law, 1e-6 * far[0], 0.0) {
        return Vec::new();
    }
    let share = |i: usize| i as f64 / RAYS as f64;
    let side = (0..=RAYS).map(|i| [far[0], far[1] * share(i)]);
    let top = (0..RAYS).rev().map(|i| [far[0] * share(i), far[1]]);
    let on_ray = |[p, q]: [f64; 2]| {
        let (mut low, mut high) = (0.0, 1.0);
        if is_elastic(law, p, q) {
            return None;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            *(if is_elastic(law, middle * p, middle * q) { &mut low } else { &mut high }) = middle;
        }
        Some((low * p, low * q))
    };
    side.chain(top).filter_map(on_ray).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use voussoir_core::law::BulkMaterial;

    /// Compares the cap with the equation of the paper: (p − p_a)² + (R q / k)² = (R (d + p_a tan β))², k = 1 + α − α/cos β.
    #[test]
    fn the_surface_of_a_cap_is_its_equation() {
        let table = serde_json::json!({
            "law": "drucker_prager_cap", "young_modulus": 5e9, "poisson_ratio": 0.2, "density": 2200.0, "cap_friction_angle": 70.0,
            "cap_cohesion": 1e9, "cap_eccentricity": 0.005, "transition": 0.03, "hardening": [[0.0, 1e7]],
        });
        let material: Box<dyn BulkMaterial> = serde_json::from_value(table).expect("a material");
        let law = PointLaw::Space(material.stress_update().expect("stresses"), 1.0);
        let surface = yield_surface(&law, [1.2e7, 4e7]);
        assert!(surface.len() > RAYS, "{}", surface.len());
        let (r, alpha, beta, d, p_b) = (0.005, 0.03, 70f64.to_radians(), 1e9, 1e7);
        let p_a = (p_b - r * d) / (1.0 + r * beta.tan());
        let (k, edge) = (1.0 + alpha - alpha / beta.cos(), r * (d + p_a * beta.tan()));
        for (p, q) in surface {
            let found = ((p - p_a).powi(2) + (r * q / k).powi(2)).sqrt();
            assert!((found / edge - 1.0).abs() < 1e-6, "p = {p}, q = {q}: {found} of {edge}");
        }
    }
}
