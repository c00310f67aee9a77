//! `barton_bandis`: a rough rock joint with hyperbolic closure and friction that decreases with pressure.
#![doc = include_str!("barton_bandis.md")]

use std::sync::Arc;
use voussoir_core::law::{
    Effect, InterfaceLaw, InterfaceResponse, PointContext, TractionPoint, UpdateBranch, UpdateFailure,
};
use voussoir_core::plugin::{Capability, Card, Keys, KnownPath, PluginKind, Property, Sample};

/// A rock joint described by its index numbers.
#[derive(Debug, Clone, Keys)]
pub struct BartonBandis {
    /// joint roughness coefficient JRC
    #[key(unit = "-", range = ">= 0, <= 20")]
    pub roughness: f64,
    /// joint wall compressive strength JCS
    #[key(unit = "Pa", range = "> 0")]
    pub wall_strength: f64,
    /// residual angle of friction φ_r
    #[key(unit = "deg", range = ">= 10, <= 60")]
    pub residual_angle: f64,
    /// k_ni, against the first closing
    #[key(unit = "Pa/m", range = "> 0")]
    pub normal_stiffness: f64,
    /// V_m, at which the hyperbola would be infinitely stiff
    #[key(unit = "m", range = "> 0")]
    pub greatest_closure: f64,
    /// k_t, up to the peak
    #[key(unit = "Pa/m", range = "> 0")]
    pub shear_stiffness: f64,
}

/// Greatest angle of friction \[deg\] at low pressure (Barton & Choubey 1977).
const STEEPEST: f64 = 70.0;
/// Share of V_m beyond which the hyperbola continues along its tangent: a closed joint is stiff, but not infinitely.
const CLOSED: f64 = 0.99;

#[typetag::serde(name = "barton_bandis")]
impl InterfaceLaw for BartonBandis {
    fn response(&self) -> Option<Arc<dyn InterfaceResponse>> {
        Some(Arc::new(BartonBandisResponse { joint: self.clone() }))
    }

    fn stiffness(&self) -> Option<[f64; 2]> {
        Some([self.normal_stiffness, self.shear_stiffness])
    }
}

/// The joint slides.
const SLIDING: UpdateBranch = UpdateBranch::new("sliding", Effect::Sliding);

/// The law at a point. State: plastic slip.
#[derive(Debug, Clone)]
pub struct BartonBandisResponse {
    joint: BartonBandis,
}

impl BartonBandisResponse {
    /// Returns pressure, its slope and the stored energy at a closure ≥ 0.
    fn closure(&self, closure: f64) -> [f64; 3] {
        let BartonBandis { normal_stiffness: k, greatest_closure: most, .. } = self.joint;
        let x = (closure / most).min(CLOSED);
        let (pressure, slope) = (k * most * x / (1.0 - x), k / ((1.0 - x) * (1.0 - x)));
        let stored = -k * most * most * (x + (-x).ln_1p());
        let beyond = closure - most * x;
        [pressure + slope * beyond, slope, stored + (pressure + 0.5 * slope * beyond) * beyond]
    }

    /// Returns τ_p at a pressure ≥ 0, and its slope.
    fn strength(&self, pressure: f64) -> [f64; 2] {
        let BartonBandis { roughness, wall_strength, residual_angle, .. } = self.joint;
        if pressure == 0.0 {
            return [0.0, STEEPEST.to_radians().tan()];
        }
        let angle = residual_angle + roughness * (wall_strength / pressure).log10();
        let kept = angle.clamp(residual_angle, STEEPEST.max(residual_angle));
        let tangent = kept.to_radians().tan();
        let falls = if kept == angle { (roughness / std::f64::consts::LN_10).to_radians() } else { 0.0 };
        [pressure * tangent, tangent - (1.0 + tangent * tangent) * falls]
    }
}

impl InterfaceResponse for BartonBandisResponse {
    fn state_size(&self) -> usize {
        1
    }

    fn initial_state(&self, state: &mut [f64]) {
        state.fill(0.0);
    }

    fn state_names(&self) -> &'static [&'static str] {
        &["slip [m]"]
    }

    #[inline]
    fn respond_point(
        &self,
        gap: [f64; 2],
        _: &PointContext,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<TractionPoint, UpdateFailure> {
        if !gap.iter().chain(old).all(|x| x.is_finite()) {
            return Err(UpdateFailure::NotFinite);
        }
        let k_t = self.joint.shear_stiffness;
        new[0] = old[0];
        if gap[0] > 0.0 {
            // Open: no traction. If the joint closes again, shear starts from zero at the new position.
            new[0] = gap[1];
            return Ok(TractionPoint { branch: UpdateBranch::OPEN, ..TractionPoint::ZERO });
        }
        let [pressure, slope, closed] = self.closure(-gap[0]);
        let trial = -k_t * (gap[1] - old[0]);
        let [strength, by_pressure] = self.strength(pressure);
        if trial.abs() <= strength {
            let (traction, tangent) = ([pressure, trial], [[-slope, 0.0], [0.0, -k_t]]);
            let stored = closed + 0.5 * trial * trial / k_t;
            return Ok(TractionPoint {
                traction,
                tangent,
                branch: UpdateBranch::ELASTIC,
                stored,
                dissipated: 0.0,
                supplied: 0.0,
            });
        }
        let sense = trial.signum();
        let slip = (trial.abs() - strength) / k_t;
        new[0] = old[0] - sense * slip;
        Ok(TractionPoint {
            traction: [pressure, sense * strength],
            tangent: [[-slope, 0.0], [-sense * by_pressure * slope, 0.0]],
            branch: SLIDING,
            stored: closed + 0.5 * strength * strength / k_t,
            dissipated: strength * slip,
            supplied: 0.0,
        })
    }
}

/// JRC 10, JCS 100 MPa, φ_r 25°: at 1 MPa the angle is 25° + 10 log10 100 = 45°, so τ_p = 1 MPa. k_ni = 10 GPa/m and V_m = 0.2 mm carry
/// 1 MPa at a closure of 1 / (10 GPa/m / 1 MPa + 1 / 0.2 mm) = 1/15000 m.
const KNOWN_PATHS: &[KnownPath] = &[KnownPath {
    table: "roughness = 10.0\nwall_strength = 1e8\nresidual_angle = 25.0\nnormal_stiffness = 1e10\ngreatest_closure = 2e-4\nshear_stiffness = 5e9",
    source: "by hand: p = k_ni δ / (1 − δ/V_m); τ_p = p tan(φ_r + JRC log10(JCS/p))",
    steps: &[
        (&[-1.0 / 15_000.0, 0.0], &[1e6, 0.0]),
        (&[-1.0 / 15_000.0, 4e-4], &[1e6, -1e6]),
        (&[-1.0 / 15_000.0, 3e-4], &[1e6, -5e5]),
        (&[-1e-4, 3e-4], &[2e6, -5e5]),
        (&[1e-5, 3e-4], &[0.0, 0.0]),
    ],
    tolerance: 1e-12,
}];

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::InterfaceLaw,
        tag: "barton_bandis",
        summary: "a rough rock joint: hyperbolic closure, friction by roughness and wall strength that falls with pressure",
        provides: &[Capability::RESPONSE],
        claims: &[Property::DISSIPATIVE],
        samples: &[
            Sample::new("roughness = 8.0\nwall_strength = 6e7\nresidual_angle = 28.0\nnormal_stiffness = 1e10\ngreatest_closure = 1e-3\nshear_stiffness = 5e9", 3e-5, &["elastic", "sliding"]),
        ],
        known_paths: KNOWN_PATHS,
        sources: &[
            "Barton & Choubey 1977, Rock Mech. 10 (shear strength by JRC and JCS)",
            "Bandis, Lumsden & Barton 1983, Int. J. Rock Mech. Min. Sci. 20 (hyperbolic closure)",
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("barton_bandis.md"),
        ..Card::of::<BartonBandis>()
    }
}
