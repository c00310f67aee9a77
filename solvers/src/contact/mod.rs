//! One contact point: the facets of its law, its mode, its yield polygon with return map, the normal fan of the polygon
//! and piecewise linear paths through its cells.

pub(crate) mod active_point;
pub(crate) mod facet;
pub(crate) mod mode;
pub(crate) mod yield_polygon;
