//! `keyed`: a dry joint with shear keys.
#![doc = include_str!("keyed.md")]

use voussoir_plug::law::{Facet, InterfaceLaw};
use voussoir_plug::plugin::{Capability, Card, Keys, KnownPath, PluginKind, Property, Sample};
use voussoir_plug::{inventory, typetag};

/// Friction and keys; no tension.
#[derive(Debug, Clone, Keys)]
pub struct Keyed {
    /// coefficient of friction μ
    #[key(unit = "-", range = ">= 0")]
    pub friction: f64,
    /// shear strength c of the keys, over the whole joint
    #[key(unit = "Pa", range = ">= 0")]
    pub key_strength: f64,
    /// stiffness of the joint itself against closing
    #[key(unit = "Pa/m", range = "> 0", optional = "the joint itself is stiff")]
    pub normal_stiffness: Option<f64>,
    /// stiffness of the joint itself against slip
    #[key(unit = "Pa/m", range = "> 0", optional = "the joint itself is stiff")]
    pub shear_stiffness: Option<f64>,
}

#[typetag::serde(name = "keyed")]
impl InterfaceLaw for Keyed {
    fn facets(&self) -> Option<Vec<Facet>> {
        let [left, right] = Facet::friction(self.friction, self.key_strength, 0.0);
        Some(vec![Facet::opening(0.0), left, right])
    }

    fn stiffness(&self) -> Option<[f64; 2]> {
        Some([self.normal_stiffness?, self.shear_stiffness?])
    }
}

/// Pressed to 1 MPa, slipped at c + μ t_n, back within stick.
const KNOWN_PATHS: &[KnownPath] = &[KnownPath {
    table: "friction = 0.5\nkey_strength = 2e5\nnormal_stiffness = 1e10\nshear_stiffness = 5e9",
    source: "by hand: stick with k_t, slip at c + μ t_n at constant volume",
    steps: &[(&[-1e-4, 0.0], &[1e6, 0.0]), (&[-1e-4, 4e-4], &[1e6, -7e5]), (&[-1e-4, 3e-4], &[1e6, -2e5])],
    tolerance: 1e-12,
}];

inventory::submit! {
    Card {
        kind: PluginKind::InterfaceLaw,
        tag: "keyed",
        summary: "no tension, friction and shear keys",
        provides: &[Capability::FACETS, Capability::RESPONSE],
        claims: &[Property::DISSIPATIVE],
        samples: &[Sample::new("friction = 0.5\nkey_strength = 2e5\nnormal_stiffness = 1e10\nshear_stiffness = 5e9", 2e-4, &["elastic", "sliding"])],
        known_paths: KNOWN_PATHS,
        sources: &["where the equations come from: author, year, equation"],
        file: file!(),
        package: voussoir_plug::package!(),
        page: include_str!("keyed.md"),
        ..Card::of::<Keyed>()
    }
}
