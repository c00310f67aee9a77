//! `coulomb_wearing`: dilatant friction whose dilatancy decreases with slip.
#![doc = include_str!("coulomb_wearing.md")]

use crate::shared::*;
use std::sync::Arc;
use voussoir_core::law::{
    Effect, InterfaceLaw, InterfaceResponse, PointContext, TractionPoint, UpdateBranch, UpdateFailure,
};
use voussoir_core::plugin::{Capability, Card, Keys, KnownPath, PluginKind, Property, Sample};

/// A rough joint that becomes smooth.
#[derive(Debug, Clone, Keys)]
#[keys(check = CoulombWearing::validate)]
pub struct CoulombWearing {
    /// μ of the worn joint.
    #[key(like = JointKeys)]
    pub friction: Option<f64>,
    /// atan μ \[deg\].
    #[key(like = JointKeys)]
    pub friction_angle: Option<f64>,
    /// angle ψ_0 by which slip opens the fresh joint; its tangent adds to the friction
    #[key(unit = "deg", range = ">= 0, < 90")]
    pub dilatancy_angle: f64,
    /// slip z_0 over which the dilatancy falls to 1/e
    #[key(unit = "m", range = "> 0")]
    pub wear_slip: f64,
    /// k_n \[Pa/m\].
    #[key(like = JointKeys)]
    pub normal_stiffness: f64,
    /// k_t \[Pa/m\].
    #[key(like = JointKeys)]
    pub shear_stiffness: f64,
}

impl CoulombWearing {
    fn validate(&self) -> Vec<(String, String)> {
        validate_friction(self.friction, self.friction_angle, None)
    }
}

#[typetag::serde(name = "coulomb_wearing")]
impl InterfaceLaw for CoulombWearing {
    fn response(&self) -> Option<Arc<dyn InterfaceResponse>> {
        Some(Arc::new(WearingResponse {
            friction: friction(self.friction, self.friction_angle),
            dilatancy: tangent(self.dilatancy_angle),
            wear_slip: self.wear_slip,
            stiffness: [self.normal_stiffness, self.shear_stiffness],
        }))
    }

    fn stiffness(&self) -> Option<[f64; 2]> {
        stiffness(Some(self.normal_stiffness), Some(self.shear_stiffness))
    }
}

/// The joint slides and opens on its remaining roughness.
const SLIDING: UpdateBranch = UpdateBranch::new("sliding", Effect::Sliding);

/// The strength of the joint falls faster than its stiffness allows shear to fall.
const SNAPS: UpdateFailure =
    UpdateFailure::Law("the joint wears faster than its shear can fall: raise wear_slip or shear_stiffness");

/// Iterations of a slip; bisection alone needs about sixty.
const ITERATIONS: usize = 100;

/// The law at a point. State: plastic slip s and its total z.
#[derive(Debug, Clone)]
pub struct WearingResponse {
    friction: f64,
    /// tan ψ_0.
    dilatancy: f64,
    wear_slip: f64,
    stiffness: [f64; 2],
}

impl WearingResponse {
    /// Returns d(z) = tan ψ_0 e^(−z/z_0).
    fn slope(&self, total: f64) -> f64 {
        self.dilatancy * (-total / self.wear_slip).exp()
    }

    /// Returns D(z) = z_0 tan ψ_0 (1 − e^(−z/z_0)), the opening by slip \[m\].
    fn opened(&self, total: f64) -> f64 {
        -self.wear_slip * self.dilatancy * (-total / self.wear_slip).exp_m1()
    }

    /// Returns the slip Δ ≥ 0 at which f(Δ) = |t̂_t| − k_t Δ − (μ + d) (t̂_n + k_n ΔD) = 0, with −df/dΔ there.
    fn slip(&self, trial: [f64; 2], total: f64) -> Result<(f64, f64), UpdateFailure> {
        let [k_n, k_t] = self.stiffness;
        let shear = trial[1].abs();
        let evaluate = |slip: f64| {
            let d = self.slope(total + slip);
            let normal = trial[0] + k_n * (self.opened(total + slip) - self.opened(total));
            let strength = (self.friction + d) * normal;
            (shear - k_t * slip - strength, k_t - d / self.wear_slip * normal + (self.friction + d) * k_n * d)
        };
        // f(0) > 0 and f(|t̂_t| / k_t) ≤ 0. If f decreases at both ends of the bracket, there is one root.
        let (mut low, mut high) = (0.0, shear / k_t);
        if evaluate(0.0).1 <= 0.0 {
            return Err(SNAPS);
        }
        let mut slip = (evaluate(0.0).0 / evaluate(0.0).1).min(high);
        for _ in 0..ITERATIONS {
            let (excess, fall) = evaluate(slip);
            if fall <= 0.0 {
                return Err(SNAPS);
            }
            if excess > 0.0 {
                low = slip
            } else {
                high = slip
            }
            let newton = slip + excess / fall;
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            if excess.abs() <= 1e-15 * shear || (next - slip).abs() <= 1e-16 * slip || next == low || next == high {
                return Ok((slip, fall));
            }
            slip = next;
        }
        Err(UpdateFailure::NoConvergence)
    }
}

impl InterfaceResponse for WearingResponse {
    fn state_size(&self) -> usize {
        2
    }

    fn initial_state(&self, state: &mut [f64]) {
        state.fill(0.0);
    }

    fn state_names(&self) -> &'static [&'static str] {
        &["slip [m]", "total_slip [m]"]
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
        let [k_n, k_t] = self.stiffness;
        let (slipped, total) = (old[0], old[1]);
        new.copy_from_slice(old);
        let trial = [-k_n * (gap[0] - self.opened(total)), -k_t * (gap[1] - slipped)];
        let stored = |t: [f64; 2]| 0.5 * (t[0] * t[0] / k_n + t[1] * t[1] / k_t);
        if trial[0] < 0.0 {
            // Open: no traction. If the joint closes again, shear starts from zero at the new position.
            new[0] = gap[1];
            return Ok(TractionPoint { branch: UpdateBranch::OPEN, ..TractionPoint::ZERO });
        }
        let strength = (self.friction + self.slope(total)) * trial[0];
        if trial[1].abs() <= strength {
            let tangent = [[-k_n, 0.0], [0.0, -k_t]];
            let branch = UpdateBranch::ELASTIC;
            return Ok(TractionPoint {
                traction: trial,
                tangent,
                branch,
                stored: stored(trial),
                dissipated: 0.0,
                supplied: 0.0,
            });
        }
        let (slip, fall) = self.slip(trial, total)?;
        let sense = trial[1].signum();
        (new[0], new[1]) = (slipped - sense * slip, total + slip);
        let d = self.slope(new[1]);
        let traction = [trial[0] + k_n * (self.opened(new[1]) - self.opened(total)), trial[1] - sense * k_t * slip];
        // dΔ = (sense dt̂_t − (μ + d) dt̂_n) / fall, dt̂ = −K dg.
        let by_gap = [(self.friction + d) * k_n / fall, -sense * k_t / fall];
        let tangent = [
            [-k_n + k_n * d * by_gap[0], k_n * d * by_gap[1]],
            [-sense * k_t * by_gap[0], -k_t - sense * k_t * by_gap[1]],
        ];
        let dissipated = self.friction * traction[0] * slip;
        Ok(TractionPoint { traction, tangent, branch: SLIDING, stored: stored(traction), dissipated, supplied: 0.0 })
    }
}

/// Slip \[m\] and tractions \[Pa\] of the second path.
const WEAR_T: f64 = 0.005336626033649185;
const WEAR_P: f64 = 9833747.742548015;
const WEAR_S: f64 = 6683130.168245922;

/// Without dilatancy: dry friction. With dilatancy: a given slip, from which gaps and tractions are computed backwards.
const KNOWN_PATHS: &[KnownPath] = &[
    KnownPath {
        table: "friction = 0.5\ndilatancy_angle = 0.0\nwear_slip = 0.01\nnormal_stiffness = 1e10\nshear_stiffness = 5e9",
        source: "by hand: without dilatancy it is dry friction, slip at μ t_n",
        steps: &[
            (&[-1e-4, 4e-4], &[1e6, -5e5]),
            (&[-1e-4, 3.5e-4], &[1e6, -2.5e5]),
            (&[1e-5, 3.5e-4], &[0.0, 0.0]),
            (&[-1e-4, 3.5e-4], &[1e6, 0.0]),
        ],
        tolerance: 1e-12,
    },
    KnownPath {
        table: "friction = 0.5\ndilatancy_angle = 15.0\nwear_slip = 0.01\nnormal_stiffness = 1e10\nshear_stiffness = 5e9",
        source: "by hand backwards from z = 4 mm: d = tan 15° e^(−0.4), D = z_0 tan 15° (1 − e^(−0.4)); t_n = k_n (D + 0.1 mm), t_t = −(μ + d) t_n, g_t = z − t_t / k_t; then 20 µm back",
        steps: &[(&[-1e-4, WEAR_T], &[WEAR_P, -WEAR_S]), (&[-1e-4, WEAR_T - 2e-5], &[WEAR_P, -WEAR_S + 1e5])],
        tolerance: 1e-9,
    },
];

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::InterfaceLaw,
        tag: "coulomb_wearing",
        summary: "no tension, friction with dilatancy that wears out with slip",
        provides: &[Capability::RESPONSE],
        claims: &[Property::DISSIPATIVE],
        samples: &[
            Sample::new("friction = 0.6\ndilatancy_angle = 10.0\nwear_slip = 0.02\nnormal_stiffness = 1e10\nshear_stiffness = 5e9", 1e-4, &["elastic", "sliding"]),
        ],
        known_paths: KNOWN_PATHS,
        sources: &[
            "Taylor 1948, Fundamentals of Soil Mechanics (work of friction and of dilatancy)",
            "Plesha 1987, Int. J. Numer. Anal. Meth. Geomech. 11 (asperities that degrade exponentially)",
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("coulomb_wearing.md"),
        ..Card::of::<CoulombWearing>()
    }
}
