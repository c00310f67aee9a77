//! `lourenco_rots`: a mortar joint that cracks, slides and crushes, each with softening.
#![doc = include_str!("lourenco_rots.md")]

mod return_map;
mod surface;

use crate::shared::*;
use return_map::{Return, Returned};
use std::sync::Arc;
use surface::{Cap, Surface};
use voussoir_core::law::{
    Effect, InterfaceLaw, InterfaceResponse, PointContext, TractionPoint, UpdateBranch, UpdateFailure,
};
use voussoir_core::plugin::{Capability, Card, Keys, KnownPath, PluginKind, Property, Sample};

/// The composite joint: tension cut-off, Coulomb friction and elliptical cap.
#[derive(Debug, Clone, Keys)]
#[keys(check = LourencoRots::validate)]
pub struct LourencoRots {
    /// μ_0.
    #[key(like = JointKeys)]
    pub friction: Option<f64>,
    /// atan μ_0 \[deg\].
    #[key(like = JointKeys)]
    pub friction_angle: Option<f64>,
    /// coefficient of friction where the bond is gone
    #[key(unit = "-", range = ">= 0", optional = "friction does not soften")]
    pub residual_friction: Option<f64>,
    /// ψ \[deg\].
    #[key(like = JointKeys, default = 0.0)]
    pub dilatancy_angle: f64,
    /// tension cut-off f_t, at most cohesion / friction
    #[key(unit = "Pa", range = "> 0")]
    pub tensile_strength: f64,
    /// shear strength without pressure
    #[key(unit = "Pa", range = "> 0")]
    pub cohesion: f64,
    /// k_n \[Pa/m\].
    #[key(like = JointKeys)]
    pub normal_stiffness: f64,
    /// k_t \[Pa/m\].
    #[key(like = JointKeys)]
    pub shear_stiffness: f64,
    /// energy that opening takes per area, G_I
    #[key(unit = "J/m2", range = "> 0")]
    pub tensile_fracture_energy: f64,
    /// energy that the bond takes per area in shear without pressure, G_II
    #[key(unit = "J/m2", range = "> 0")]
    pub shear_fracture_energy: f64,
    /// strength f_m of the masonry across the joint
    #[key(unit = "Pa", range = "> 0")]
    pub compressive_strength: f64,
    /// energy per area beyond the peak and above the residual strength, G_fc
    #[key(unit = "J/m2", range = "> 0")]
    pub compressive_fracture_energy: f64,
    /// plastic closing κ_p at the peak
    #[key(unit = "m", range = "> 0")]
    pub peak_closing: f64,
    /// weight C_ss of shear in the cap
    #[key(unit = "-", range = "> 0", default = 9.0)]
    pub cap_shear_factor: f64,
}

impl LourencoRots {
    fn surface(&self) -> Surface {
        let fresh = friction(self.friction, self.friction_angle);
        Surface {
            stiffness: [self.normal_stiffness, self.shear_stiffness],
            tension: self.tensile_strength,
            cohesion: self.cohesion,
            friction: [fresh, self.residual_friction.unwrap_or(fresh)],
            dilatancy: tangent(self.dilatancy_angle),
            loss: [self.tensile_strength / self.tensile_fracture_energy, self.cohesion / self.shear_fracture_energy],
            cap_shear: self.cap_shear_factor,
            cap: Cap::new(self.compressive_strength, self.peak_closing, self.compressive_fracture_energy),
        }
    }

    /// Returns the mistakes in the combination of parameters.
    pub fn validate(&self) -> Vec<(String, String)> {
        let mut wrong = validate_friction(self.friction, self.friction_angle, Some(self.dilatancy_angle));
        let surface = self.surface();
        let [fresh, residual] = surface.friction;
        if residual > fresh {
            let message = format!("{residual} is more than the friction of the fresh joint, {fresh:.6}");
            wrong.push(("residual_friction".into(), message));
        } else if surface.dilatancy > residual * (1.0 + 1e-12) {
            let message = format!(
                "{} deg is more than the residual angle of friction, {:.6} deg: slip would create energy",
                self.dilatancy_angle,
                residual.atan().to_degrees()
            );
            wrong.push(("dilatancy_angle".into(), message));
        }
        if self.tensile_strength * fresh > self.cohesion {
            let message = format!(
                "{} Pa is more than cohesion / friction, {:.4e} Pa: Coulomb's line ends before the tension cut-off",
                self.tensile_strength,
                self.cohesion / fresh
            );
            wrong.push(("tensile_strength".into(), message));
        }
        let falls = [
            ("tensile_fracture_energy", surface.tension * surface.loss[0], self.normal_stiffness, "tension"),
            ("shear_fracture_energy", surface.steepest_shear(), self.shear_stiffness, "shear"),
            (
                "compressive_fracture_energy",
                surface.cap.steepest(),
                surface.least_stiffness_at_the_cap(),
                "compression",
            ),
        ];
        for (key, fall, stiffness, mode) in falls {
            if fall >= stiffness {
                let message = format!(
                    "in {mode} the strength falls by {fall:.4e} Pa/m, which is not less than the stiffness it falls \
                     against, {stiffness:.4e} Pa/m: the joint would snap back; raise the energy or the stiffness"
                );
                wrong.push((key.into(), message));
            }
        }
        wrong
    }
}

#[typetag::serde(name = "lourenco_rots")]
impl InterfaceLaw for LourencoRots {
    fn response(&self) -> Option<Arc<dyn InterfaceResponse>> {
        Some(Arc::new(CompositeResponse { surface: self.surface() }))
    }

    fn stiffness(&self) -> Option<[f64; 2]> {
        stiffness(Some(self.normal_stiffness), Some(self.shear_stiffness))
    }
}

/// The bond fails in tension.
const CRACKING: UpdateBranch = UpdateBranch::new("cracking", Effect::Softening);
/// The bond fails in shear.
const SHEARING: UpdateBranch = UpdateBranch::new("shearing", Effect::Softening);
/// Cracking and shearing at the corner of tension cut-off and Coulomb's line.
const CRACKING_SHEARING: UpdateBranch = UpdateBranch::new("cracking_shearing", Effect::Softening);
/// The bond is nearly lost, and the joint slides.
const SLIDING: UpdateBranch = UpdateBranch::new("sliding", Effect::Sliding);
/// The joint crushes.
const CRUSHING: UpdateBranch = UpdateBranch::new("crushing", Effect::Yielding);
/// The joint crushes and slides.
const CRUSHING_SHEARING: UpdateBranch = UpdateBranch::new("crushing_shearing", Effect::Yielding);

/// Share of the bond below which the joint counts as sliding.
const NO_BOND: f64 = 0.01;

/// The law at a point. State: plastic opening and slip, loss of bond κ, crushing κ_3.
#[derive(Debug, Clone)]
pub struct CompositeResponse {
    surface: Surface,
}

impl CompositeResponse {
    /// Returns the energy that the return dissipates \[J/m²\]. Strengths are averaged over the growth of their variables, so that
    /// the energy is exact for opening, for slip at constant pressure, and for closing.
    fn dissipated(&self, old: &[f64], back: &Returned) -> f64 {
        let Surface { tension, cohesion, dilatancy, cap_shear, .. } = self.surface;
        let ([sigma, tau], [opened, slipped, crushed]) = (back.stress, back.multipliers);
        let bond = (-old[2]).exp() * if back.loss > 0.0 { -(-back.loss).exp_m1() / back.loss } else { 1.0 };
        let slip = (cohesion * bond + sigma * (dilatancy - self.surface.friction_at(bond))) * slipped;
        let cap = self.surface.cap;
        let closing = if crushed > 0.0 {
            let strength = sigma.hypot(cap_shear.sqrt() * tau);
            (cap.energy(old[3] + back.crushing) - cap.energy(old[3])) * strength / sigma.hypot(cap_shear * tau)
        } else {
            0.0
        };
        (tension * bond * opened + slip + closing).max(0.0)
    }

    fn branch(&self, old: &[f64], back: &Returned) -> UpdateBranch {
        let [opened, slipped, crushed] = back.multipliers.map(|multiplier| multiplier > 0.0);
        let gone = (-old[2] - back.loss).exp() < NO_BOND;
        match (crushed, opened, slipped) {
            (true, _, true) => CRUSHING_SHEARING,
            (true, _, false) => CRUSHING,
            (false, true, true) => CRACKING_SHEARING,
            (false, true, false) => CRACKING,
            (false, false, _) if gone => SLIDING,
            (false, false, _) => SHEARING,
        }
    }
}

impl InterfaceResponse for CompositeResponse {
    fn state_size(&self) -> usize {
        4
    }

    fn initial_state(&self, state: &mut [f64]) {
        state.fill(0.0);
    }

    fn state_names(&self) -> &'static [&'static str] {
        &["plastic_opening [m]", "slip [m]", "bond_loss [-]", "crushing [m]"]
    }

    fn tensile_softening(&self) -> Option<[f64; 2]> {
        Some([self.surface.tension, self.surface.tension / self.surface.loss[0]])
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
        let [k_n, k_t] = self.surface.stiffness;
        new.copy_from_slice(old);
        let trial = [k_n * (gap[0] - old[0]), k_t * (gap[1] - old[1])];
        let stored = |t: [f64; 2]| 0.5 * (t[0] * t[0] / k_n + t[1] * t[1] / k_t);
        let sense = if trial[1] < 0.0 { -1.0 } else { 1.0 };
        // Rounding error of the differences above.
        let rounding = 4.0 * f64::EPSILON * (k_n * (gap[0].abs() + old[0].abs()) + k_t * (gap[1].abs() + old[1].abs()));
        let from = Return {
            surface: &self.surface,
            trial: [trial[0], trial[1].abs()],
            bond: (-old[2]).exp(),
            crushing: old[3],
        };
        let Some(back) = from.solve(rounding)? else {
            return Ok(TractionPoint {
                traction: [-trial[0], -trial[1]],
                tangent: [[-k_n, 0.0], [0.0, -k_t]],
                branch: UpdateBranch::ELASTIC,
                stored: stored(trial),
                dissipated: 0.0,
                supplied: 0.0,
            });
        };
        let [sigma, tau] = [back.stress[0], sense * back.stress[1]];
        (new[0], new[1]) = (gap[0] - sigma / k_n, gap[1] - tau / k_t);
        (new[2], new[3]) = (old[2] + back.loss, old[3] + back.crushing);
        let by = back.by_trial;
        Ok(TractionPoint {
            traction: [-sigma, -tau],
            tangent: [[-by[0][0] * k_n, -sense * by[0][1] * k_t], [-sense * by[1][0] * k_n, -by[1][1] * k_t]],
            branch: self.branch(old, &back),
            stored: stored([sigma, tau]),
            dissipated: self.dissipated(old, &back),
            supplied: 0.0,
        })
    }
}

/// Joints of the shear walls of Raijmakers & Vermeltfoort (1992) with the model and the friction of Lourenço (1996), and with
/// the bond of the shear tests of van der Pluijm (1993), c = 0.8 MPa, μ 1 → 0.75, G_II = 50 J/m².
const WALL: &str = "friction = 0.75\ntensile_strength = 2.5e5\ncohesion = 3.5e5\nnormal_stiffness = 8.2e10\nshear_stiffness = 3.6e10\ntensile_fracture_energy = 18.0\nshear_fracture_energy = 125.0\ncompressive_strength = 1.05e7\ncompressive_fracture_energy = 5000.0\npeak_closing = 9e-5";
const SHEARED: &str = "friction = 1.0\nresidual_friction = 0.75\ntensile_strength = 2.5e5\ncohesion = 8e5\nnormal_stiffness = 8.2e10\nshear_stiffness = 3.6e10\ntensile_fracture_energy = 18.0\nshear_fracture_energy = 50.0\ncompressive_strength = 1.05e7\ncompressive_fracture_energy = 5000.0\npeak_closing = 9e-5";
const DILATANT: &str = "friction = 0.8\nresidual_friction = 0.7\ndilatancy_angle = 5.0\ntensile_strength = 2e5\ncohesion = 3e5\nnormal_stiffness = 2e10\nshear_stiffness = 1.2e10\ntensile_fracture_energy = 15.0\nshear_fracture_energy = 90.0\ncompressive_strength = 4e6\ncompressive_fracture_energy = 4000.0\npeak_closing = 2e-4\ncap_shear_factor = 3.0";

const KNOWN_PATHS: &[KnownPath] = &[
    KnownPath {
        table: WALL,
        source: "by hand backwards from κ = 1: opening G_I / f_t carries f_t / e; half of it unloaded along k_n",
        steps: &[
            (&[7.312158366210806e-05, 0.0], &[-91969.86029286058, 0.0]),
            (&[7.256079183105404e-05, 0.0], &[-45984.93014643029, 0.0]),
        ],
        tolerance: 1e-10,
    },
    KnownPath {
        table: SHEARED,
        source: "by hand backwards from κ = 1 under 0.5 MPa: slip G_II / c, τ = c / e + p (μ_r + (μ_0 − μ_r) / e); then 20 µm back along k_t",
        steps: &[
            (&[-6.0975609756097564e-06, 8.236912453009955e-05], &[5e5, -715288.4830835841]),
            (&[-6.0975609756097564e-06, 6.236912453009956e-05], &[5e5, 4711.516916416003]),
        ],
        tolerance: 1e-10,
    },
    KnownPath {
        table: WALL,
        source: "by hand: f_m at the plastic closing κ_p, f_m / 2 at κ_m = κ_p + G_fc / (0.818027 f_m), then unloaded along k_n",
        steps: &[
            (&[-0.0002180487804878049, 0.0], &[1.05e7, 0.0]),
            (&[-0.0007361449723644845, 0.0], &[5.25e6, 0.0]),
            (&[-0.0006721205821205821, 0.0], &[0.0, 0.0]),
        ],
        tolerance: 1e-10,
    },
];

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::InterfaceLaw,
        tag: "lourenco_rots",
        summary: "a mortar joint that cracks, slides and crushes: tension cut-off, Coulomb friction and elliptical cap, all softening",
        provides: &[Capability::RESPONSE],
        claims: &[Property::DISSIPATIVE],
        samples: &[
            Sample::new(WALL, 1e-4, &["elastic", "cracking", "shearing", "cracking_shearing", "sliding", "crushing", "crushing_shearing"]),
            Sample::new(SHEARED, 1e-4, &["elastic", "cracking", "shearing", "cracking_shearing"]),
            Sample::new(DILATANT, 1e-4, &["elastic", "cracking", "shearing", "cracking_shearing", "crushing_shearing"]),
        ],
        known_paths: KNOWN_PATHS,
        sources: &[
            "Lourenço & Rots 1997, J. Eng. Mech. 123(7) (the composite joint)",
            "Lourenço 1996, Computational strategies for masonry structures, Delft (parameters of shear walls)",
            "Chandrupatla 1997, Adv. Eng. Softw. 28(3) (bracketed roots)",
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("lourenco_rots.md"),
        ..Card::of::<LourencoRots>()
    }
}
