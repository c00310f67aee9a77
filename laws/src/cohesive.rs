//! `cohesive`: a bond that softens in tension and shear and leaves dry friction.
#![doc = include_str!("cohesive.md")]

use crate::shared::*;
use std::sync::Arc;
use voussoir_core::law::{
    Effect, InterfaceLaw, InterfaceResponse, PointContext, TractionPoint, UpdateBranch, UpdateFailure,
};
use voussoir_core::plugin::{Capability, Card, Keys, KnownPath, PluginKind, Property, Sample};

/// A mortared joint with fracture energies.
#[derive(Debug, Clone, Keys)]
#[keys(check = Cohesive::validate)]
pub struct Cohesive {
    /// μ.
    #[key(like = JointKeys)]
    pub friction: Option<f64>,
    /// atan μ \[deg\].
    #[key(like = JointKeys)]
    pub friction_angle: Option<f64>,
    /// greatest tension of the bond
    #[key(unit = "Pa", range = "> 0")]
    pub tensile_strength: f64,
    /// greatest shear of the bond without compression
    #[key(unit = "Pa", range = "> 0")]
    pub cohesion: f64,
    /// k_n \[Pa/m\].
    #[key(like = JointKeys)]
    pub normal_stiffness: f64,
    /// k_t \[Pa/m\].
    #[key(like = JointKeys)]
    pub shear_stiffness: f64,
    /// energy that opening takes per area, mode I
    #[key(unit = "J/m2", range = "> 0")]
    pub tensile_fracture_energy: f64,
    /// energy that shearing the bond takes per area without friction, mode II
    #[key(unit = "J/m2", range = "> 0")]
    pub shear_fracture_energy: f64,
}

/// One mode of the bond.
#[derive(Debug, Clone, Copy)]
struct Mode {
    /// k \[Pa/m\].
    stiffness: f64,
    /// Gap at which softening begins \[m\].
    onset: f64,
    /// η = 1 − onset / gap at which the bond is gone.
    brittleness: f64,
}

impl Mode {
    fn new(stiffness: f64, strength: f64, energy: f64) -> Self {
        let onset = strength / stiffness;
        Mode { stiffness, onset, brittleness: 1.0 - strength * onset / (2.0 * energy) }
    }
}

impl Cohesive {
    /// Returns the mistakes in the combination of parameters.
    pub fn validate(&self) -> Vec<(String, String)> {
        let mut wrong = validate_friction(self.friction, self.friction_angle, None);
        let modes = [
            ("tensile_fracture_energy", self.tensile_strength, self.normal_stiffness, self.tensile_fracture_energy),
            ("shear_fracture_energy", self.cohesion, self.shear_stiffness, self.shear_fracture_energy),
        ];
        for (key, strength, stiffness, energy) in modes {
            let stored = strength * strength / (2.0 * stiffness);
            if energy <= stored {
                let message = format!(
                    "{energy} J/m2 is not more than the energy stored at the strength, {stored:.4e} J/m2: the joint would \
                     snap back; raise it or the stiffness"
                );
                wrong.push((key.into(), message));
            }
        }
        wrong
    }
}

#[typetag::serde(name = "cohesive")]
impl InterfaceLaw for Cohesive {
    fn response(&self) -> Option<Arc<dyn InterfaceResponse>> {
        Some(Arc::new(CohesiveResponse {
            friction: friction(self.friction, self.friction_angle),
            normal: Mode::new(self.normal_stiffness, self.tensile_strength, self.tensile_fracture_energy),
            shear: Mode::new(self.shear_stiffness, self.cohesion, self.shear_fracture_energy),
        }))
    }

    fn stiffness(&self) -> Option<[f64; 2]> {
        stiffness(Some(self.normal_stiffness), Some(self.shear_stiffness))
    }
}

/// The bond softens.
const SOFTENING: UpdateBranch = UpdateBranch::new("softening", Effect::Softening);
/// The joint is open and the bond is lost.
const PARTED: UpdateBranch = UpdateBranch::new("parted", Effect::Softening);
/// The broken share slides.
const SLIDING: UpdateBranch = UpdateBranch::new("sliding", Effect::Sliding);
/// The bond softens while its broken share slides.
const SOFTENING_SLIDING: UpdateBranch = UpdateBranch::new("softening_sliding", Effect::Softening);

/// The law at a point. State: damage D and slip z.
#[derive(Debug, Clone)]
pub struct CohesiveResponse {
    friction: f64,
    normal: Mode,
    shear: Mode,
}

/// Damage with its derivatives by the gap, and the equivalent gap r.
struct Damage {
    value: f64,
    by_gap: [f64; 2],
    reach: f64,
    brittleness: f64,
}

impl CohesiveResponse {
    /// D(g) = min(1, (1 − 1/r) / η), 0 for r ≤ 1.
    fn damage(&self, gap: [f64; 2]) -> Damage {
        let a = gap[0].max(0.0) / self.normal.onset;
        let b = gap[1] / self.shear.onset;
        let r = a.hypot(b);
        if r <= 1.0 {
            return Damage { value: 0.0, by_gap: [0.0; 2], reach: r, brittleness: 1.0 };
        }
        let (share_n, share_t) = ((a / r) * (a / r), (b / r) * (b / r));
        let (eta_n, eta_t) = (self.normal.brittleness, self.shear.brittleness);
        let eta = eta_n * share_n + eta_t * share_t;
        let value = (1.0 - 1.0 / r) / eta;
        if value >= 1.0 {
            return Damage { value: 1.0, by_gap: [0.0; 2], reach: r, brittleness: eta };
        }
        // ∂r = (a/r, b/r), ∂η = 2 (η_n − η_t) (a/r)(b/r) (b, −a) / r².
        let turn = 2.0 * (eta_n - eta_t) * (a / r) * (b / r) / r;
        let by_a = (a / r) / (r * r * eta) - value / eta * turn * (b / r);
        let by_b = (b / r) / (r * r * eta) + value / eta * turn * (a / r);
        Damage { value, by_gap: [by_a / self.normal.onset, by_b / self.shear.onset], reach: r, brittleness: eta }
    }
}

impl InterfaceResponse for CohesiveResponse {
    fn state_size(&self) -> usize {
        2
    }

    fn initial_state(&self, state: &mut [f64]) {
        state.fill(0.0);
    }

    fn state_names(&self) -> &'static [&'static str] {
        &["damage [-]", "slip [m]"]
    }

    fn tensile_softening(&self) -> Option<[f64; 2]> {
        // 1 − η = f_t g_0 / (2 G_I), with f_t = k_n g_0.
        let strength = self.normal.stiffness * self.normal.onset;
        Some([strength, strength * self.normal.onset / (2.0 * (1.0 - self.normal.brittleness))])
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
        let (k_n, k_t) = (self.normal.stiffness, self.shear.stiffness);
        let [g_n, g_t] = gap;
        let (damage_old, slip_old) = (old[0], old[1]);
        let trial = self.damage(gap);
        let grows = trial.value > damage_old;
        let (damage, damage_by) = if grows { (trial.value, trial.by_gap) } else { (damage_old, [0.0; 2]) };
        let opening = g_n.max(0.0);
        let pressure = k_n * (-g_n).max(0.0);
        let pressure_by_n = if g_n < 0.0 { -k_n } else { 0.0 };
        // Force of the broken share, k_t (D g_t − z), within D μ p.
        let (mut slip, mut slip_by) = (slip_old, [0.0; 2]);
        let mut shear = k_t * (g_t - slip_old);
        let carried = k_t * (damage * g_t - slip_old);
        let limit = damage * self.friction * pressure;
        let slides = damage > 0.0 && carried.abs() > limit;
        if slides {
            let sense = carried.signum();
            let per_damage = g_t - sense * self.friction * pressure / k_t;
            slip = damage * per_damage;
            // Equal to k_t (g_t − z), without cancellation.
            shear = (1.0 - damage) * k_t * g_t + sense * limit;
            slip_by = [
                damage_by[0] * per_damage - damage * sense * self.friction * pressure_by_n / k_t,
                damage_by[1] * per_damage + damage,
            ];
        }
        (new[0], new[1]) = (damage, slip);
        let traction = [-(if g_n > 0.0 { 1.0 - damage } else { 1.0 }) * k_n * g_n, -shear];
        let tangent = [
            [
                -(if g_n > 0.0 { 1.0 - damage } else { 1.0 }) * k_n + k_n * opening * damage_by[0],
                k_n * opening * damage_by[1],
            ],
            [k_t * slip_by[0], -k_t * (1.0 - slip_by[1])],
        ];
        let per_damage = if damage > 0.0 { slip / damage } else { 0.0 };
        let broken = g_t - per_damage;
        let stored = 0.5 * (1.0 - damage) * (k_n * opening * opening + k_t * g_t * g_t)
            + 0.5 * (k_n * (-g_n).max(0.0).powi(2) + damage * k_t * broken * broken);
        // Energy released per damage, averaged over the growth: with r(D) = 1/(1 − η D) its mean over
        // (D_old, D) is that at r² → r(D_old) r(D), exact on proportional paths.
        let mut dissipated =
            if slides { (carried.signum() * (slip - slip_old)).max(0.0) * limit / damage } else { 0.0 };
        if grows {
            let at = |d: f64| 1.0 / (1.0 - trial.brittleness * d);
            let mean = at(damage_old) * at(damage) / (trial.reach * trial.reach);
            let released = 0.5 * (k_n * opening * opening + k_t * per_damage * per_damage);
            dissipated += released * mean.min(1.0) * (damage - damage_old);
        }
        let branch = match (grows, slides && slip != slip_old && self.friction * pressure > 0.0) {
            _ if damage >= 1.0 && g_n > 0.0 => PARTED,
            (false, false) if damage > 0.0 && g_n > 0.0 => UpdateBranch::OPEN,
            (false, false) => UpdateBranch::ELASTIC,
            (true, false) => SOFTENING,
            (false, true) => SLIDING,
            (true, true) => SOFTENING_SLIDING,
        };
        Ok(TractionPoint { traction, tangent, branch, stored, dissipated, supplied: 0.0 })
    }
}

/// Opened on the bilinear law, f_t (g_u − g) / (g_u − g_0) with g_u = 2 G_I / f_t, back on the secant, and closed.
const KNOWN_PATHS: &[KnownPath] = &[KnownPath {
    table: "friction = 0.6\ntensile_strength = 3e5\ncohesion = 5e5\nnormal_stiffness = 1e10\nshear_stiffness = 5e9\ntensile_fracture_energy = 20.0\nshear_fracture_energy = 150.0",
    source: "by hand: bilinear softening in mode I, secant unloading",
    steps: &[
        (&[3e-5, 0.0], &[-3e5, 0.0]),
        (&[8e-5, 0.0], &[-154_838.709_677_419_36, 0.0]),
        (&[4e-5, 0.0], &[-77_419.354_838_709_68, 0.0]),
        (&[-1e-5, 0.0], &[1e5, 0.0]),
        (&[2e-4, 0.0], &[0.0, 0.0]),
    ],
    tolerance: 1e-12,
}];

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::InterfaceLaw,
        tag: "cohesive",
        summary: "a bond that softens in tension and shear, with fracture energies, down to dry friction",
        provides: &[Capability::RESPONSE],
        claims: &[Property::DISSIPATIVE],
        samples: &[
            Sample::new("friction = 0.6\ntensile_strength = 3e5\ncohesion = 5e5\nnormal_stiffness = 1e10\nshear_stiffness = 5e9\ntensile_fracture_energy = 20.0\nshear_fracture_energy = 150.0", 1.5e-4, &["elastic", "softening", "sliding", "softening_sliding"]),
        ],
        known_paths: KNOWN_PATHS,
        sources: &[
            "Alfano & Crisfield 2001, Int. J. Numer. Meth. Engng 50 (bilinear mixed-mode damage)",
            "Alfano & Sacco 2006, Int. J. Numer. Meth. Engng 68 (friction on the damaged share)",
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("cohesive.md"),
        ..Card::of::<Cohesive>()
    }
}
