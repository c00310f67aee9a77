//! A contact point between events: facets without slack, opening, and mode.

use crate::contact::active_point::ActivePoint;
use crate::contact::mode::ContactMode;
use crate::path::system::System;
use crate::rate::arrival::ArrivalPoint;
use voussoir_core::law::{Facet, FacetMode};

/// State of a contact point between events.
#[derive(Debug, Clone)]
pub struct Point {
    /// Facets without slack.
    pub active: Vec<usize>,
    /// Opening: gap above the dilated surface; > 0 if the point is open.
    pub opening: f64,
    /// Its mode on the present piece of the path.
    pub mode: ContactMode,
    /// If it is a point of the present event: its mode on the piece before.
    pub arrived_from: Option<ContactMode>,
    /// True if an event of the point has been recorded.
    pub noted: bool,
    /// True if facets at the apex have bounds: opening and both senses of slip meet in one corner.
    pub apex: bool,
    /// Index of the opening facet.
    pub opening_facet: Option<usize>,
    /// Inverse of its normal flexibility.
    pub stiffness: f64,
}

impl Point {
    /// Returns a contact point before any load.
    pub fn untouched(system: &System, c: usize) -> Self {
        let diagonal = |row: usize| system.flexibility.row(row).iter().find(|e| e.0 == row).map_or(0.0, |e| e.1);
        let flexibility = diagonal(2 * c);
        let stiffness = if flexibility > 0.0 { 1.0 / flexibility } else { 1.0 };
        let closed = Point {
            active: Vec::new(),
            opening: 0.0,
            mode: ContactMode::Stick,
            arrived_from: None,
            noted: false,
            apex: false,
            opening_facet: None,
            stiffness,
        };
        let Some(facets) = &system.facets[c] else { return closed };
        let opening_facet = facets.iter().position(|f| f.mode == FacetMode::Opening);
        let active: Vec<usize> = (0..facets.len()).filter(|f| facets[*f].bound <= 0.0).collect();
        let apex = ActivePoint::is_apex(facets, &active);
        let opening = system.gap[c].max(0.0);
        let mode = if opening > 0.0 && apex { ContactMode::Open } else { ContactMode::Stick };
        Point { active, opening, mode, arrived_from: Some(mode), apex, opening_facet, ..closed }
    }

    /// Returns true if it is open.
    pub fn open(&self) -> bool {
        self.opening > 0.0
    }

    /// Returns the point of the rate problem, with its facets.
    pub fn as_active<'s>(&self, facets: &'s [Facet]) -> ActivePoint<'s> {
        ActivePoint {
            facets,
            active: self.active.clone(),
            open: if self.open() { self.opening_facet } else { None },
            apex: self.apex && self.opening_facet.is_some_and(|f| self.active.contains(&f)),
            guess: self.mode,
            stiffness: self.stiffness,
        }
    }

    /// Returns the point at the arrival at the present event.
    pub fn arrival(&self, force: [f64; 2]) -> ArrivalPoint {
        let present = || self.settled().unwrap_or(self.mode);
        let (mode, hit) = (self.arrived_from.unwrap_or_else(present), self.arrived_from.is_some());
        // Rates are constant on a piece: slip ends only at events of other points.
        ArrivalPoint { mode, hit, stops: false, force }
    }

    /// Returns the mode of a point without a choice; `None` in the active set.
    pub fn settled(&self) -> Option<ContactMode> {
        match (self.open(), self.apex) {
            (true, true) => Some(ContactMode::Open),
            (true, false) if self.active.len() <= 1 => self.opening_facet.map(|f| ContactMode::Facet(f as u8)),
            (false, _) if self.active.is_empty() => Some(ContactMode::Stick),
            _ => None,
        }
    }
}

/// Returns some points as points of the rate problem.
pub fn active_points<'s>(system: &'s System, points: &[Point], at: &[usize]) -> Vec<ActivePoint<'s>> {
    at.iter().map(|&c| points[c].as_active(system.facets[c].as_deref().unwrap_or_default())).collect()
}
