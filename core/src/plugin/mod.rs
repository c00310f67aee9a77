//! Registry and configuration of plug-ins: cards, the schema of their keys, units, diagnostics. It contains no mechanics.

mod card;
mod diagnostic;
pub mod keys;
mod output;
mod registered;
mod schema;
mod units;

pub use self::card::{
    Capability, Card, KnownPath, Package, Property, Requirement, Sample, audit, candidate, candidates, card, cards,
    cards_of, check_as, describe, nearest,
};
pub use self::diagnostic::Diagnostic;
pub use self::keys::{KeyValue, Keys};
pub use self::output::{FIXED_COLUMNS, Output, OutputOf, OutputRule, unit_powers};
pub use self::registered::{Registered, WithoutCard};
pub use self::schema::{Need, Parameter, PluginKind, Range, Shape, Variant};
pub use self::units::{Quantity, STANDARD_GRAVITY};
pub use voussoir_keys_derive::Keys;

/// The [`Package`] of the crate in which it is written.
#[macro_export]
macro_rules! package {
    () => {
        $crate::plugin::Package { name: env!("CARGO_PKG_NAME"), version: env!("CARGO_PKG_VERSION") }
    };
}
