//! One contact point: the facets of its law, its mode, its yield polygon with return map.

pub(crate) mod active_point;
pub(crate) mod facet;
pub(crate) mod mode;
pub(crate) mod yield_polygon;
