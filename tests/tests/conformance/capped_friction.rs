//! `capped_friction`: associated friction with a crushing strength.

use voussoir_core::law::{Facet, InterfaceLaw};
use voussoir_core::plugin::{Capability, Card, Keys, KnownPath, PluginKind, Property, Sample};

/// Associated friction with a crushing strength.
#[derive(Debug, Clone, Keys)]
pub struct CappedFriction {
    /// coefficient of friction μ
    #[key(unit = "-", range = ">= 0")]
    pub friction: f64,
    /// crushing strength f_c
    #[key(unit = "Pa", range = "> 0")]
    pub compressive_strength: f64,
    /// stiffness k of the joint itself
    #[key(unit = "Pa/m", range = "> 0", optional = "the joint itself is stiff")]
    pub stiffness: Option<f64>,
}

#[typetag::serde(name = "capped_friction")]
impl InterfaceLaw for CappedFriction {
    fn facets(&self) -> Option<Vec<Facet>> {
        let [left, right] = Facet::friction(self.friction, 0.0, self.friction);
        Some(vec![Facet::opening(0.0), left, right, Facet::crushing(self.compressive_strength)])
    }

    fn stiffness(&self) -> Option<[f64; 2]> {
        self.stiffness.map(|k| [k, k])
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::InterfaceLaw,
        tag: "capped_friction",
        summary: "associated friction that crushes",
        provides: &[Capability::FACETS, Capability::RESPONSE],
        claims: &[Property::ASSOCIATED, Property::DISSIPATIVE],
        samples: &[Sample::new("friction = 0.6\ncompressive_strength = 5e6\nstiffness = 1e10", 1e-3, &["elastic", "sliding"])],
        known_paths: &[KnownPath {
            table: "friction = 0.6\ncompressive_strength = 5e6\nstiffness = 1e10",
            source: "by hand: crushed at f_c, then back with k",
            steps: &[(&[-1e-3, 0.0], &[5e6, 0.0]), (&[-8e-4, 0.0], &[3e6, 0.0])],
            tolerance: 1e-12,
        }],
        sources: &["where the equations come from"],
        file: file!(),
        package: voussoir_core::package!(),
        page: "# `capped_friction`\n\nPurpose, equations, regimes, state, validity, sources.\n",
        ..Card::of::<CappedFriction>()
    }
}
