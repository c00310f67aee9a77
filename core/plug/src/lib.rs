//! Traits, cards and keys for plug-ins of Voussoir, with the crates whose types appear in them. A crate with laws depends on
//! this crate only.
//!
//! A joint law with friction in one file:
//!
//! ```
//! use voussoir_plug::prelude::*;
//!
//! /// Friction without tension.
//! #[derive(Debug, Clone, Keys)]
//! pub struct Rough {
//!     /// coefficient of friction μ
//!     #[key(unit = "-", range = ">= 0")]
//!     pub friction: f64,
//! }
//!
//! #[typetag::serde(name = "rough")]
//! impl InterfaceLaw for Rough {
//!     fn facets(&self) -> Option<Vec<Facet>> {
//!         let [left, right] = Facet::friction(self.friction, 0.0, 0.0);
//!         Some(vec![Facet::opening(0.0), left, right])
//!     }
//!
//!     fn stiffness(&self) -> Option<[f64; 2]> {
//!         None
//!     }
//! }
//!
//! inventory::submit! {
//!     Card {
//!         kind: PluginKind::InterfaceLaw,
//!         tag: "rough",
//!         summary: "friction without tension",
//!         provides: &[Capability::FACETS],
//!         samples: &[Sample::new("friction = 0.5", 1e-4, &[])],
//!         sources: &["Coulomb 1773"],
//!         file: file!(),
//!         package: voussoir_plug::package!(),
//!         page: "# `rough`\n\nPurpose, equations, regimes, state, validity.\n",
//!         ..Card::of::<Rough>()
//!     }
//! }
//!
//! assert_eq!(card(PluginKind::InterfaceLaw, "rough").unwrap().parameters[0].name, "friction");
//! ```
//!
//! # Macros and names of crates
//! `inventory::submit!` and `package!` find their crates by themselves. `#[typetag::serde]` writes code that uses the name
//! `typetag`, so this name must be in scope: `use voussoir_plug::typetag;`, or the [`prelude`]. [`plugin::Keys`](macro@plugin::Keys) uses the name
//! `voussoir_plug`, so do not rename the dependency. `#[derive(Keys)]` also writes serde's traits. A type with serde's own
//! derives needs the line that gives serde's path:
//!
//! ```
//! #[derive(voussoir_plug::serde::Serialize, voussoir_plug::serde::Deserialize)]
//! #[serde(crate = "voussoir_plug::serde")]
//! pub struct Plain {
//!     pub friction: f64,
//! }
//! ```
//!
//! # Stability
//! The page `docs/stability.md` lists the frozen parts and the parts that may change. [`limit`], [`model`] and [`path`] are the modules of
//! `voussoir-core` as they are: they may change in every version.
#![forbid(unsafe_code)]

pub use voussoir_core::{inventory, nalgebra, package, serde, typetag};

/// The traits of laws and materials, and the types in them.
pub mod law {
    pub use voussoir_core::law::{
        BatchFailure, BulkMaterial, Effect, Elasticity, Facet, FacetMode, FacetResponse, Fields, FillResistance,
        FillState, FlowRule, ForceRow, InterfaceLaw, InterfaceResponse, Isotropic, JointStrength, LinearUpdate,
        PointContext, ShearEnvelope, StressPoint, StressUpdate, TractionPoint, UpdateBranch, UpdateContext,
        UpdateFailure, Voigt, is_associated, von_mises,
    };
}

/// Cards, keys and the registry.
pub mod plugin {
    pub use voussoir_core::plugin::keys;
    pub use voussoir_core::plugin::keys::{KeyValue, Keys};
    pub use voussoir_core::plugin::{
        Capability, Card, Diagnostic, KnownPath, Need, Output, OutputOf, OutputRule, Package, Parameter, PluginKind,
        Property, Quantity, Range, Requirement, STANDARD_GRAVITY, Sample, Shape, Variant, audit, card, cards, cards_of,
        check_as, nearest,
    };
    /// Declares the keys of a table; the trait [`Keys`](trait@Keys) describes the attributes.
    pub use voussoir_keys_derive::PlugKeys as Keys;
}

pub use voussoir_core::{limit, model, path};

/// The names that most laws need: `use voussoir_plug::prelude::*;`.
pub mod prelude {
    pub use crate::law::*;
    pub use crate::plugin::{
        Capability, Card, Diagnostic, Keys, KnownPath, Output, PluginKind, Property, Quantity, Range, Sample, card,
    };
    pub use crate::{inventory, typetag};
}
