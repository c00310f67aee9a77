//! Laws of joints and materials: the traits that plug-ins implement, and what core derives from them.

mod facet_response;
mod interface;
mod material;
mod plane;
mod strength;
mod yield_polygon;

pub use self::facet_response::FacetResponse;
pub use self::interface::{
    Facet, FacetMode, FlowRule, Formulation, InterfaceLaw, InterfaceResponse, TractionPoint, UpdateBranch,
    is_associated,
};
pub use self::material::{
    BatchFailure, BulkMaterial, Deformability, Isotropic, Region, StressPoint, StressUpdate, UpdateFailure, Voigt,
    von_mises,
};
pub use self::plane::{PlanarPoint, PlanarUpdate, Plane};
pub use self::strength::{ForceRow, JointStrength, StressBlock, Tangential, integrate};
pub use self::yield_polygon::YieldPolygon;
