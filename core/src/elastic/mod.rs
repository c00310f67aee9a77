//! Linear elastic bodies: their finite-element meshes and the static condensation of a mesh onto the points at which
//! forces act.
//!
//! **Material.** Any [`Elasticity`](crate::law::Elasticity) in the axes of the body, x along edge 0;
//! [`PlaneElasticity`](crate::law::PlaneElasticity) is the operator of the plane problem.
//!
//! **Elements.** Straight-sided quadrilaterals with the bilinear map and nodes at the tensor product of Gauss–Lobatto
//! points. Order 1 is the five-parameter hybrid-stress element of Pian and Sumihara (1984, Int. J. Numer. Methods Eng.
//! 20, 1685–1695). It does not lock in bending, and it does not lock for ν → 0.5. Order 2 has nine nodes, order 3
//! sixteen: the full tensor product, because serendipity elements lose an order on quadrilaterals that are not
//! parallelograms (Arnold, Boffi & Falk 2002, Math. Comp. 71, 909–922).
//!
//! **Meshes.** A strictly convex quadrilateral is meshed by its bilinear map: edges 0 and 2 (edge i starts at vertex i)
//! are divided into `elements[0]` parts, edges 1 and 3 into `elements[1]`. The voussoirs of the scene `arch` have the
//! intrados as edge 0 and joints as edges 1 and 3, so their `elements` count along the ring and across it. Any other
//! polygon is cut into triangles and each triangle into three quadrilaterals with k × k elements, k = ⌈max(elements) /
//! 2⌉, so that every edge has 2 k parts. With a grading g > 1 the parts of an edge grow geometrically from its ends to
//! its middle; the greatest is g times the least. Use grading in both directions: at the end of a joint the stress
//! varies as fast into the body as along the joint. Each direction has its own g, because the numbers of parts usually
//! differ.
//!
//! **Points.** Points of a body need not be nodes: the displacement of a point follows from the shape functions N of
//! its element, and a force at the point acts by Nᵀ. All resultants are exact, because the shape functions reproduce
//! the coordinates.
//!
//! **Rigid motion.** Displacements are elastic displacements relative to the mean motion of the body (Tisserand's mean
//! axes): ∫ u dA = 0 and ∫ X × u dA = 0, X from the centroid. With R the rigid motions of the nodes, M the mass matrix,
//! P = I − R (Rᵀ M R)⁻¹ Rᵀ M and K⁺ any generalised inverse of the stiffness,
//!
//! u = C f,  C = N P K⁺ Pᵀ Nᵀ,
//!
//! which is symmetric and positive semi-definite for all f. Forces that are not in equilibrium are balanced by the
//! inertia of a rigid motion, Pᵀ. The body force of a uniform acceleration is itself such an inertia force, Pᵀ M R = 0,
//! so it adds nothing: if contact forces carry the weight, their inertia relief is the weight, and C f is exact.
//!
//! **Contact points.** [`joint_points`] uses a Gauss–Lobatto rule of order + 1 points on each segment between the
//! element boundaries of both sides. It integrates a uniform traction times the shape functions of either side exactly,
//! so meshes that do not match pass the patch test. On matching meshes its points are the nodes and its weights the
//! consistent nodal forces.

mod condensation;
mod element;
mod inelastic;
mod joint;
mod linearisation;
mod mesh;
mod polygon;
mod quadrature;
mod shape;
mod shared;
mod stress;

pub use self::condensation::{Condensed, Condenser};
pub use self::inelastic::{GaussOutputs, InelasticBody, InelasticState, PassedStep, fine_enough};
pub use self::joint::{breaks_on_joint, joint_points, union_breaks};
pub use self::linearisation::Linearisation;
pub use self::mesh::{Mesh, edge_breaks, edge_points};
pub use self::shared::SharedFlexibilities;
pub use self::stress::Recovered;
pub use crate::model::MeshDensity;
