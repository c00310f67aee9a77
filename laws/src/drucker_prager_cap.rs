//! `drucker_prager_cap`: stone that fails in shear and crushes at a cap.
#![doc = include_str!("drucker_prager_cap.md")]

pub mod surface;
mod update;

use crate::shared::MaterialKeys;
use std::sync::Arc;
use surface::Surface;
use update::{CapUpdate, Strength};
use voussoir_core::law::{BulkMaterial, Elasticity, Isotropic, StressUpdate};
use voussoir_core::plugin::{Capability, Card, Keys, KnownPath, PluginKind, Property, Sample};

/// The modified Drucker–Prager model with a cap.
#[derive(Debug, Clone, Keys)]
#[keys(check = DruckerPragerCap::validate)]
pub struct DruckerPragerCap {
    /// E \[Pa\].
    #[key(like = MaterialKeys)]
    pub young_modulus: f64,
    /// ν.
    #[key(like = MaterialKeys)]
    pub poisson_ratio: f64,
    /// ρ \[kg/m³\].
    #[key(like = MaterialKeys)]
    pub density: f64,
    /// slope β of the shear surface in the plane of pressure p and von Mises stress q
    #[key(unit = "deg", range = ">= 0, < 90")]
    pub cap_friction_angle: f64,
    /// d, the von Mises stress of the shear surface at p = 0
    #[key(unit = "Pa", range = ">= 0")]
    pub cap_cohesion: f64,
    /// R, the cap's half axis along p over that along q
    #[key(unit = "-", range = "> 0")]
    pub cap_eccentricity: f64,
    /// α, size of the rounded transition between shear surface and cap
    #[key(unit = "-", range = ">= 0", default = 0.0)]
    pub transition: f64,
    /// pairs \[compaction, p_b\]: pressure of yield in hydrostatic compression over volumetric plastic
    /// strain, constant beyond the ends
    #[key(names = ["plastic volume strain", "pressure"], unit = ["-", "Pa"], range = ["", "> 0"], len = ">= 1, <= 1000", optional = "uniaxial_strength is given")]
    pub hardening: Option<Vec<[f64; 2]>>,
    /// strength in uniaxial compression, which sets a constant p_b
    #[key(unit = "Pa", range = "> 0", optional = "hardening is given")]
    pub uniaxial_strength: Option<f64>,
    /// compaction of the undeformed material, where the table is entered
    #[key(unit = "-", default = 0.0)]
    pub initial_compaction: f64,
    /// G_c: p_b falls as the material crushes, and a band that crushes under hydrostatic pressure takes
    /// this energy per area
    #[key(unit = "J/m2", range = "> 0", optional = "crushing does not soften")]
    pub crushing_fracture_energy: Option<f64>,
    /// p_b of crushed over p_b of intact material, with crushing_fracture_energy
    #[key(unit = "-", range = "> 0, < 1", default = 0.1)]
    pub residual_ratio: f64,
}

impl DruckerPragerCap {
    /// Returns the stone of Drosopoulos, Stavroulakis & Massalas (2008), E = 5 GPa, ν = 0.2, with a constant p_b \[Pa\].
    pub fn drosopoulos_2008(hydrostatic_strength: f64) -> Self {
        DruckerPragerCap {
            young_modulus: 5e9,
            poisson_ratio: 0.2,
            density: 2200.0,
            cap_friction_angle: 70.0,
            cap_cohesion: 1e9,
            cap_eccentricity: 0.005,
            transition: 0.03,
            hardening: Some(vec![[0.0, hydrostatic_strength]]),
            uniaxial_strength: None,
            initial_compaction: 0.0,
            crushing_fracture_energy: None,
            residual_ratio: Self::default_of("residual_ratio"),
        }
    }

    /// Returns p_b over compaction: the table, or the constant p_b that gives the uniaxial strength. Empty if neither is possible.
    pub fn hardening(&self) -> Vec<[f64; 2]> {
        match (&self.hardening, self.uniaxial_strength) {
            (Some(table), _) => table.clone(),
            (None, Some(strength)) => self.hydrostatic_strength(strength).map_or(Vec::new(), |p| vec![[0.0, p]]),
            (None, None) => Vec::new(),
        }
    }

    /// Returns the p_b \[Pa\] at which uniaxial compression (p = f/3, q = f) meets the cap at f: with D_0 = d + f tan β / 3 and
    /// x = f/3 − p_a, the root x ≥ 0 of x² + (R f / k)² = R² (D_0 − x tan β)². `None` if f > k D_0: it fails in shear first.
    pub fn hydrostatic_strength(&self, uniaxial: f64) -> Option<f64> {
        let surface = self.surface();
        let Surface { friction, eccentricity: r, roundness: k, .. } = surface;
        let size = self.cap_cohesion + uniaxial * friction / 3.0;
        if uniaxial > k * size {
            return None;
        }
        let a = 1.0 - (r * friction) * (r * friction);
        let b = r * r * size * friction;
        let c = r * r * (uniaxial / k - size) * (uniaxial / k + size);
        let x = -c / (b + (b * b - a * c).max(0.0).sqrt());
        let x = if c == 0.0 { 0.0 } else { x };
        Some(uniaxial / 3.0 - x + r * (size - x * friction))
    }

    /// Returns yield surface and flow.
    pub fn surface(&self) -> Surface {
        Surface::new(
            Isotropic::new(self.young_modulus, self.poisson_ratio),
            self.cap_friction_angle,
            self.cap_cohesion,
            self.cap_eccentricity,
            self.transition,
        )
    }

    /// Returns the drop of p_b by crushing \[Pa\], and the crushing w_c \[m\] over which it happens: the triangle between them is
    /// G_c. `None` if crushing does not soften.
    pub fn softening(&self) -> Option<[f64; 2]> {
        let energy = self.crushing_fracture_energy?;
        let drop = (1.0 - self.residual_ratio) * self.hardening().last()?[1];
        Some([drop, 2.0 * energy / drop])
    }

    /// Returns the steepest fall −dp_b/dε_v \[Pa\] by crushing that a point can follow (derived on the law's page).
    pub fn steepest_softening(&self) -> f64 {
        let surface = self.surface();
        let Surface { friction, roundness: k, eccentricity: r, .. } = surface;
        let Isotropic { bulk, shear } = surface.elastic;
        let full = 1.0 + r * friction;
        // Greatest h with h tan β < min over s of A s + B (1 − s²)/s, A = (K − h)/R, B = min(A, 3 G R/k²).
        let follows = |h: f64| {
            let a = (bulk - h) / r;
            let b = a.min(3.0 * shear * r / (k * k));
            h * friction < if b < 0.5 * a { 2.0 * (b * (a - b)).sqrt() } else { a }
        };
        let (mut low, mut high) = (0.0, bulk);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if follows(middle) { low = middle } else { high = middle }
        }
        let mut steepest = low * full;
        // Uniaxial compression: df/dp_b per axial plastic strain must not exceed E.
        let Some(&[_, intact]) = self.hardening().last() else { return steepest };
        for share in 0..=16 {
            let strength = intact * (self.residual_ratio + (1.0 - self.residual_ratio) * f64::from(share) / 16.0);
            let centre = surface.centre_of(strength);
            let size = self.cap_cohesion + centre * friction;
            // (x/R)² + (f/k)² = D², x = f/3 − p_a ≥ 0.
            let (a, b) = (1.0 / (9.0 * r * r) + 1.0 / (k * k), centre / (3.0 * r * r));
            let c = (centre / r).powi(2) - size * size;
            let uniaxial = (b + (b * b - a * c).max(0.0).sqrt()) / a;
            let x = uniaxial / 3.0 - centre;
            if x <= 0.0 {
                continue;
            }
            let (along, across) = (x / (r * r), uniaxial / (k * k));
            let by_strength = (along + size * friction) / (along / 3.0 + across) / full;
            let axial = 1.0 / 3.0 + across / along;
            steepest = steepest.min(self.young_modulus * axial / by_strength);
        }
        steepest
    }

    /// Returns the mistakes in the combination of parameters.
    pub fn validate(&self) -> Vec<(String, String)> {
        let mut wrong = Vec::new();
        let mut say = |key: &str, message: String| wrong.push((key.to_string(), message));
        let (sine, cosine) = self.cap_friction_angle.to_radians().sin_cos();
        if self.transition * sine * sine >= cosine {
            say(
                "transition",
                format!(
                    "{} is too large for this friction angle: the transition would swallow the shear surface; it must be \
                     less than cos β / sin² β = {:.6}",
                    self.transition,
                    cosine / (sine * sine)
                ),
            );
        }
        match (&self.hardening, self.uniaxial_strength) {
            (None, None) => say("", "needs hardening or uniaxial_strength".into()),
            (Some(_), Some(_)) => say("uniaxial_strength", "given besides hardening; give one of the two".into()),
            (None, Some(strength)) => match self.hydrostatic_strength(strength) {
                None => say(
                    "uniaxial_strength",
                    format!(
                        "{strength} Pa is never reached: with this cohesion and friction angle uniaxial compression fails \
                         in shear before it meets the cap"
                    ),
                ),
                Some(p) if p <= 0.0 => {
                    say("uniaxial_strength", format!("{strength} Pa would need p_b = {p} Pa, which is not positive"));
                }
                Some(_) => {}
            },
            (Some(table), None) => {
                if table.windows(2).any(|pair| pair[1][0] <= pair[0][0]) {
                    say("hardening", "the compactions must grow from entry to entry".into());
                } else if table.windows(2).any(|pair| pair[1][1] < pair[0][1]) {
                    say("hardening", "p_b must not fall as compaction grows".into());
                } else if table.iter().any(|entry| entry[1] <= 0.0) {
                    say("hardening", "p_b must be greater than 0".into());
                } else if cosine > 0.0 && self.transition * sine * sine < cosine {
                    let steepest =
                        table.windows(2).map(|p| (p[1][1] - p[0][1]) / (p[1][0] - p[0][0])).fold(0.0, f64::max);
                    let most = self.steepest_hardening();
                    if steepest >= most {
                        say(
                            "hardening",
                            format!(
                                "rises by {steepest:.4e} Pa per unit of compaction; above {most:.4e} Pa dilatancy may \
                                 weaken the material faster than stress can follow, and the answer is not unique"
                            ),
                        );
                    }
                }
            }
        }
        if self.crushing_fracture_energy.is_some() {
            if self.hardening().len() > 1 {
                say(
                    "crushing_fracture_energy",
                    "needs a constant strength: one entry of hardening, or uniaxial_strength".into(),
                );
            }
            if self.initial_compaction != 0.0 {
                say("initial_compaction", "has no meaning where crushing softens".into());
            }
        }
        if self.cap_cohesion == 0.0 && self.cap_friction_angle == 0.0 {
            say("cap_cohesion", "0 Pa without friction leaves no strength at all".into());
        }
        wrong
    }

    /// Returns the steepest dp_b/dε_v \[Pa\] for which every return is unique (derived on the law's page).
    pub fn steepest_hardening(&self) -> f64 {
        let surface = self.surface();
        let Surface { friction, roundness, eccentricity, transition, tangency, .. } = surface;
        let Isotropic { bulk, shear } = surface.elastic;
        let sine = self.cap_friction_angle.to_radians().sin();
        let share = (3.0 * shear / (roundness * roundness * friction * friction * bulk)).min(1.0);
        (1.0 + eccentricity * friction) * tangency[1] * bulk * share / (roundness * friction * transition * sine)
    }
}

#[typetag::serde(name = "drucker_prager_cap")]
impl BulkMaterial for DruckerPragerCap {
    fn density(&self) -> f64 {
        self.density
    }

    fn elasticity(&self) -> Option<Elasticity> {
        Some(Elasticity::isotropic(self.young_modulus, self.poisson_ratio))
    }

    fn inelastic(&self) -> Option<Arc<dyn StressUpdate>> {
        let surface = self.surface();
        let pieces = surface.pieces(&self.hardening());
        let strength = match self.softening() {
            None => Strength::Hardening { pieces, initial_compaction: self.initial_compaction },
            Some([drop, crushing]) => Strength::Softening {
                intact: pieces[0].centre,
                drop: drop / (1.0 + surface.eccentricity * surface.friction),
                crushing,
                largest_length: crushing * self.steepest_softening() / drop,
            },
        };
        Some(Arc::new(CapUpdate { surface, strength }))
    }
}

/// Hydrostatic compression beyond a constant p_b, then unloading with K.
const KNOWN_PATHS: &[KnownPath] = &[KnownPath {
    table: "young_modulus = 5e9\npoisson_ratio = 0.2\ndensity = 2200.0\ncap_friction_angle = 40.0\ncap_cohesion = 1e7\ncap_eccentricity = 0.3\ntransition = 0.05\nhardening = [[0.0, 1e7]]",
    source: "by hand: p = min(K ε_v, p_b), unloading with K = E / (3 (1 − 2ν))",
    steps: &[
        (&[-1e-3, -1e-3, -1e-3, 0.0, 0.0, 0.0], &[-2.5e7 / 3.0, -2.5e7 / 3.0, -2.5e7 / 3.0, 0.0, 0.0, 0.0]),
        (&[-2e-3, -2e-3, -2e-3, 0.0, 0.0, 0.0], &[-1e7, -1e7, -1e7, 0.0, 0.0, 0.0]),
        (&[-1.5e-3, -1.5e-3, -1.5e-3, 0.0, 0.0, 0.0], &[-1.75e7 / 3.0, -1.75e7 / 3.0, -1.75e7 / 3.0, 0.0, 0.0, 0.0]),
    ],
    tolerance: 1e-9,
}];

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::BulkMaterial,
        tag: "drucker_prager_cap",
        summary: "modified Drucker-Prager with a cap: fails in shear, crushes under pressure",
        provides: &[Capability::STRESS_UPDATE, Capability::RIGID_LIMIT],
        claims: &[Property::DISSIPATIVE, Property::ISOTROPIC],
        samples: &[
            Sample::new("young_modulus = 5e9\npoisson_ratio = 0.2\ndensity = 2200.0\ncap_friction_angle = 40.0\ncap_cohesion = 1e7\ncap_eccentricity = 0.3\ntransition = 0.05\nhardening = [[0.0, 1e7], [0.005, 2e7], [0.02, 3e7]]\ninitial_compaction = 0.001", 4e-3, &["elastic", "cap", "shear"]),
            Sample::new("young_modulus = 5e9\npoisson_ratio = 0.2\ndensity = 2200.0\ncap_friction_angle = 40.0\ncap_cohesion = 1e7\ncap_eccentricity = 0.3\ntransition = 0.05\nuniaxial_strength = 8e6\ncrushing_fracture_energy = 5000.0", 4e-3, &["elastic", "cap", "shear"]),
        ],
        known_paths: KNOWN_PATHS,
        sources: &[
            "Drucker & Prager 1952, Q. Appl. Math. 10",
            "Abaqus Theory Guide, Drucker-Prager/Cap model for geological materials (K = 1)",
            "Bažant & Oh 1983, Mater. Struct. 16 (fracture energy over the width of the band)",
            "Moré & Sorensen 1983, SIAM J. Sci. Stat. Comput. 4 (rational form of the scalar equation)",
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("drucker_prager_cap.md"),
        ..Card::of::<DruckerPragerCap>()
    }
}
