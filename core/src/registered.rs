//! The readers of the plug-ins whose traits are in this crate, for the [`audit`](crate::plugin::audit).

use crate::law::{BulkMaterial, FillResistance, InterfaceLaw};
use crate::limit::LimitSolver;
use crate::model::Scene;
use crate::path::{Continuation, PathSolver};
use crate::plugin::{PluginKind, Registered};

inventory::submit! { Registered::of::<dyn InterfaceLaw>(PluginKind::InterfaceLaw) }
inventory::submit! { Registered::of::<dyn BulkMaterial>(PluginKind::BulkMaterial) }
inventory::submit! { Registered::of::<dyn FillResistance>(PluginKind::FillResistance) }
inventory::submit! { Registered::of::<dyn Scene>(PluginKind::Scene) }
inventory::submit! { Registered::of::<dyn LimitSolver>(PluginKind::LimitSolver) }
inventory::submit! { Registered::of::<dyn PathSolver>(PluginKind::PathSolver) }
inventory::submit! { Registered::of::<dyn Continuation>(PluginKind::Continuation) }
