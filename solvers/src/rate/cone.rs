//! The recession cone of a contact point's active facets: what its rates may be, with the normal fan of that cone.

use crate::contact::active_point::ActivePoint;
use crate::contact::facet::dot;
use crate::contact::mode::ContactMode;
use crate::contact::normal_fan::{Cell, NormalFan};
use crate::contact::yield_polygon::YieldPolygon;
use voussoir_core::law::Facet;

/// The cone of a point.
pub struct Cone {
    /// Its active facets without bounds.
    pub polygon: YieldPolygon,
    /// Its cells; an opening facet that is open has no sign.
    pub fan: NormalFan,
    /// Facets of the polygon in the point's own numbering.
    active: Vec<usize>,
    /// The opening facet in the polygon's numbering, where the point is open.
    open: Option<usize>,
    apex: bool,
}

impl Cone {
    /// Of a point.
    pub fn new(point: &ActivePoint<'_>) -> Cone {
        let facets: Vec<Facet> = point.active.iter().map(|f| Facet { bound: 0.0, ..point.facets[*f] }).collect();
        let polygon = YieldPolygon::new(&facets);
        let open = point.open.and_then(|o| point.active.iter().position(|f| *f == o));
        let mut fan = polygon.fan.clone();
        if let Some(o) = open {
            fan.free_multiplier(o);
        }
        Cone { polygon, fan, active: point.active.clone(), open, apex: point.apex }
    }

    /// The mode of a cell.
    pub fn mode(&self, cell: usize) -> ContactMode {
        let own = |i: usize| self.active[i] as u8;
        match self.fan.cells[cell].0 {
            Cell::Inside => ContactMode::Stick,
            Cell::Facet(i) => ContactMode::Facet(own(i)),
            Cell::Pair(..) if self.apex => ContactMode::Open,
            Cell::Pair(_, [i, j]) if self.open == Some(j) => ContactMode::Corner(own(j), own(i)),
            Cell::Pair(_, [i, j]) => ContactMode::Corner(own(i), own(j)),
        }
    }

    /// The place of z = ṙ − ρ ġ with ρ = 1: cell, force and gap. An open point with strength has some place on its opening facet.
    pub fn place(&self, z: [f64; 2]) -> (usize, [f64; 2], [f64; 2]) {
        let Some(open) = self.open else {
            let (cell, r) = self.polygon.return_map(z, [1.0; 2], 1.0);
            return (cell, r, [r[0] - z[0], r[1] - z[1]]);
        };
        // On the opening facet, its multiplier of any sign.
        let f = &self.polygon.facets[open];
        let along = [f.normal[1] * z[0], -f.normal[0] * z[0]];
        let others = || self.polygon.facets.iter().enumerate().filter(|(k, _)| *k != open);
        let inside = |r: &[f64; 2]| others().all(|(_, g)| dot(g.normal, *r) < 0.0);
        let r = [along, along.map(|a| -a)].into_iter().find(inside).unwrap_or_default();
        (1 + open, r, f.flow.map(|d| -d * z[1]))
    }
}
