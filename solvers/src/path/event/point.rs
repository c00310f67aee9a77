//! A contact point between events: which facets have no slack, whether it is open, what it does.

use super::rate::{Piece, Verge, corner, dilatancy};
use super::system::{PointFacet, System};
use voussoir_core::law::FacetMode;

/// What is kept of a contact point between events.
#[derive(Debug, Clone)]
pub struct Point {
    /// Facets without slack.
    pub active: Vec<usize>,
    /// Opening: gap above the dilated surface; > 0 where open.
    pub opening: f64,
    /// What it does on the present piece of the path.
    pub piece: Piece,
    /// Whether it has just arrived at a facet.
    pub hit: bool,
    /// Whether anything has been noted as having happened to it.
    pub noted: bool,
    /// Bound at the apex: opening and both senses of slip end in one corner.
    pub apex: bool,
    /// Index of the opening facet.
    pub opening_facet: Option<usize>,
    /// Inverse of its normal flexibility.
    pub stiffness: f64,
}

impl Point {
    /// A contact point before any load.
    pub fn untouched(system: &System, c: usize) -> Self {
        let diagonal = |row: usize| system.flexibility.row(row).iter().find(|e| e.0 == row).map_or(0.0, |e| e.1);
        let flexibility = diagonal(2 * c);
        let stiffness = if flexibility > 0.0 { 1.0 / flexibility } else { 1.0 };
        let closed = Point {
            active: Vec::new(),
            opening: 0.0,
            piece: Piece::Stick,
            hit: false,
            noted: false,
            apex: false,
            opening_facet: None,
            stiffness,
        };
        let Some(facets) = &system.facets[c] else { return closed };
        let opening_facet = facets.iter().position(|f| f.mode == FacetMode::Opening);
        let bare = |f: &PointFacet| f.bound <= 0.0;
        let slides =
            |sense: f64| facets.iter().any(|f| f.mode == FacetMode::Sliding && f.normal[1] * sense > 0.0 && bare(f));
        let apex = opening_facet.is_some_and(|f| bare(&facets[f])) && slides(1.0) && slides(-1.0);
        let active: Vec<usize> = (0..facets.len()).filter(|f| bare(&facets[*f])).collect();
        let opening = system.gap[c].max(0.0);
        let piece = if opening > 0.0 && apex { Piece::Free } else { Piece::Stick };
        Point { active, opening, piece, hit: true, apex, opening_facet, ..closed }
    }

    /// Whether it is open.
    pub fn open(&self) -> bool {
        self.opening > 0.0
    }

    /// As the rate problem sees it, with its facets.
    pub fn verge<'s>(&self, facets: &'s [PointFacet]) -> Verge<'s> {
        Verge {
            facets,
            active: self.active.clone(),
            open: if self.open() { self.opening_facet } else { None },
            apex: self.apex && self.opening_facet.is_some_and(|f| self.active.contains(&f)),
            guess: self.piece,
            hit: self.hit,
            stiffness: self.stiffness,
        }
    }

    /// The piece of a point that has no choice; `None` at the verge of a change.
    pub fn settled(&self) -> Option<Piece> {
        match (self.open(), self.apex) {
            (true, true) => Some(Piece::Free),
            (true, false) if self.active.len() <= 1 => self.opening_facet.map(Piece::Facet),
            (false, _) if self.active.is_empty() => Some(Piece::Stick),
            _ => None,
        }
    }
}

/// o per unit of the gap of a point that flows or is free, where open points slip in a `sense`: −1 or 1.
pub fn opening(piece: Piece, facets: &[PointFacet], sense: f64) -> [f64; 2] {
    let by_corner = |i: usize, j: usize, which: usize| {
        [[1.0, 0.0], [0.0, 1.0]].map(|gap| corner(facets[i].flow, facets[j].flow, gap)[which])
    };
    match piece {
        Piece::Free => [1.0, -dilatancy(facets) * sense],
        Piece::Facet(f) if facets[f].mode == FacetMode::Opening => {
            let d = facets[f].flow;
            d.map(|x| -x / (d[0] * d[0] + d[1] * d[1]))
        }
        Piece::Corner(i, j) if facets[i].mode == FacetMode::Opening => by_corner(i, j, 0),
        Piece::Corner(i, j) if facets[j].mode == FacetMode::Opening => by_corner(i, j, 1),
        _ => [0.0; 2],
    }
}
