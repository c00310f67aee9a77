//! Laws of joints and materials: the traits that plug-ins implement, and the quantities that the core derives from
//! them.

mod branch;
mod cone;
mod context;
mod elasticity;
mod facet;
mod facet_response;
mod fill_resistance;
mod force_row;
mod interface;
mod isotropic;
mod material;
mod plane;
mod response;
mod shear_envelope;
mod strength;
mod stress;
mod update;
mod yield_polygon;

pub use self::branch::{Effect, UpdateBranch};
pub use self::cone::FrictionCone;
pub use self::context::{Fields, PointContext};
pub use self::elasticity::{Elasticity, LinearUpdate};
pub use self::facet::{Facet, FacetMode, FlowRule, is_associated};
pub use self::facet_response::FacetResponse;
pub use self::fill_resistance::{FillResistance, FillState};
pub use self::force_row::ForceRow;
pub use self::interface::InterfaceLaw;
pub use self::isotropic::{Isotropic, von_mises};
pub use self::material::BulkMaterial;
pub use self::plane::{PlanarPoint, PlanarUpdate, Plane, PlaneElasticity};
pub use self::response::{InterfaceResponse, TractionPoint};
pub use self::shear_envelope::{ShearDistribution, ShearEnvelope, ShearPiece};
pub use self::strength::{JointStrength, StressBlock, Tangential, UnitStrength};
pub use self::stress::{StressPoint, StressUpdate, Voigt};
pub use self::update::{BatchFailure, UpdateContext, UpdateFailure};
pub use self::yield_polygon::YieldPolygon;
