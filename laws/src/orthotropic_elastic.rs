//! `orthotropic_elastic`: linear elasticity with three axes, for example of bedded stone.
#![doc = include_str!("orthotropic_elastic.md")]

use crate::shared::MaterialKeys;
use voussoir_core::law::{BulkMaterial, Elasticity};
use voussoir_core::plugin::{Capability, Card, Keys, KnownPath, PluginKind, Property, Sample};

/// A linear elastic material with axes.
#[derive(Debug, Clone, Keys)]
#[keys(check = OrthotropicElastic::validate)]
pub struct OrthotropicElastic {
    /// E_1, along the first axis
    #[key(unit = "Pa", range = "> 0")]
    pub young_modulus_1: f64,
    /// E_2, along the second axis in the plane
    #[key(unit = "Pa", range = "> 0")]
    pub young_modulus_2: f64,
    /// E_3, across the plane
    #[key(unit = "Pa", range = "> 0")]
    pub young_modulus_3: f64,
    /// G_12, in the plane
    #[key(unit = "Pa", range = "> 0")]
    pub shear_modulus_12: f64,
    /// ν_12: contraction along axis 2 per strain by stress along axis 1; ν_21 = ν_12 E_2 / E_1
    #[key(unit = "-")]
    pub poisson_ratio_12: f64,
    /// ν_13: contraction across the plane per strain by stress along axis 1
    #[key(unit = "-")]
    pub poisson_ratio_13: f64,
    /// ν_23: contraction across the plane per strain by stress along axis 2
    #[key(unit = "-")]
    pub poisson_ratio_23: f64,
    /// angle φ from a block's first edge (the intrados of a voussoir) to axis 1, anticlockwise
    #[key(unit = "deg", default = 0.0)]
    pub axis_angle: f64,
    /// ρ \[kg/m³\].
    #[key(like = MaterialKeys)]
    pub density: f64,
}

impl OrthotropicElastic {
    /// Returns S × E_1 along the axes of the material.
    fn compliance(&self) -> [[f64; 6]; 6] {
        let e = self.young_modulus_1;
        let (e_2, e_3, g) = (self.young_modulus_2 / e, self.young_modulus_3 / e, self.shear_modulus_12 / e);
        let (s_12, s_13, s_23) = (-self.poisson_ratio_12, -self.poisson_ratio_13, -self.poisson_ratio_23 / e_2);
        [
            [1.0, s_12, s_13, 0.0, 0.0, 0.0],
            [s_12, 1.0 / e_2, s_23, 0.0, 0.0, 0.0],
            [s_13, s_23, 1.0 / e_3, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 1.0 / g, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 1.0 / g, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0, 1.0 / g],
        ]
    }

    /// Returns the mistakes in the combination of parameters: the compliance must be positive definite.
    pub fn validate(&self) -> Vec<(String, String)> {
        let pairs = [
            ("poisson_ratio_12", self.poisson_ratio_12, self.young_modulus_1, self.young_modulus_2),
            ("poisson_ratio_13", self.poisson_ratio_13, self.young_modulus_1, self.young_modulus_3),
            ("poisson_ratio_23", self.poisson_ratio_23, self.young_modulus_2, self.young_modulus_3),
        ];
        let mut wrong = Vec::new();
        for (key, ratio, along, across) in pairs {
            let most = (along / across).sqrt();
            if ratio.abs() >= most {
                let message = format!(
                    "{ratio} would let a stress lower the energy: with these moduli it must lie between {:.6} and {most:.6}",
                    -most
                );
                wrong.push((key.to_string(), message));
            }
        }
        let [[a, b, c, ..], [_, d, e, ..], [_, _, f, ..], ..] = self.compliance();
        let determinant = a * (d * f - e * e) - b * (b * f - e * c) + c * (b * e - d * c);
        if wrong.is_empty() && determinant <= 0.0 {
            let message =
                "the three Poisson's ratios together would let a stress lower the energy: make one of them smaller";
            wrong.push((String::new(), message.into()));
        }
        wrong
    }
}

#[typetag::serde(name = "orthotropic_elastic")]
impl BulkMaterial for OrthotropicElastic {
    fn density(&self) -> f64 {
        self.density
    }

    fn elasticity(&self) -> Option<Elasticity> {
        let (sine, cosine) = self.axis_angle.to_radians().sin_cos();
        let axes = [[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]];
        Some(Elasticity::from_compliance(self.young_modulus_1, &self.compliance())?.turned(&axes))
    }
}

/// The strains of 10 MPa along axis 1 alone, of 10 MPa across the plane alone, and of shear in the plane.
const KNOWN_PATHS: &[KnownPath] = &[KnownPath {
    table: "young_modulus_1 = 2e10\nyoung_modulus_2 = 8e9\nyoung_modulus_3 = 1.2e10\nshear_modulus_12 = 5e9\npoisson_ratio_12 = 0.25\npoisson_ratio_13 = 0.2\npoisson_ratio_23 = 0.15\ndensity = 2200.0",
    source: "by hand: ε = S σ with S_11 = 1/E_1, S_12 = −ν_12/E_1, S_13 = −ν_13/E_1, S_23 = −ν_23/E_2, S_33 = 1/E_3",
    steps: &[
        (&[5e-4, -1.25e-4, -1e-4, 0.0, 0.0, 0.0], &[1e7, 0.0, 0.0, 0.0, 0.0, 0.0]),
        (&[-1e-4, -1.875e-4, 1e7 / 1.2e10, 0.0, 0.0, 0.0], &[0.0, 0.0, 1e7, 0.0, 0.0, 0.0]),
        (&[0.0, 0.0, 0.0, 1e-3, 0.0, 0.0], &[0.0, 0.0, 0.0, 5e6, 0.0, 0.0]),
    ],
    tolerance: 1e-12,
}];

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::BulkMaterial,
        tag: "orthotropic_elastic",
        summary: "linear elasticity with three axes, one of them across the plane",
        provides: &[Capability::RIGID_LIMIT, Capability::LINEAR, Capability::STRESS_UPDATE],
        claims: &[Property::DISSIPATIVE, Property::SYMMETRIC_TANGENT],
        samples: &[
            Sample::new("young_modulus_1 = 2e10\nyoung_modulus_2 = 8e9\nyoung_modulus_3 = 1.2e10\nshear_modulus_12 = 5e9\npoisson_ratio_12 = 0.25\npoisson_ratio_13 = 0.2\npoisson_ratio_23 = 0.15\naxis_angle = 25.0\ndensity = 2200.0", 1e-3, &["elastic"]),
        ],
        known_paths: KNOWN_PATHS,
        sources: &["Lekhnitskii 1963, Theory of Elasticity of an Anisotropic Elastic Body", "Jones 1999, Mechanics of Composite Materials, sections 2.4 and 2.8"],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("orthotropic_elastic.md"),
        ..Card::of::<OrthotropicElastic>()
    }
}
