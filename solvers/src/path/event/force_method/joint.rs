//! One section between events: its tangent, and the states of its points, brought up to date when asked.
//!
//! As long as no point changes its mode, everything in a section follows from its resultant:
//!
//! ```text
//! h = H ξ̇         ṙ = −S h         ġ = C ṙ + h
//! Ṙ = Hᵀ ṙ = −K ξ̇         K = Σ Hᵀ S H
//! stick S = C⁻¹   free S = 0   facet S = t (d⊥)ᵀ / (d⊥·C t), t ⟂ a
//! ```

use super::progress::Progress;
use super::section::{Place, Section};
use crate::contact::facet::across;
use crate::contact::mode::ContactMode;
use crate::path::event::point::Point;
use nalgebra::{Matrix2, Matrix3, Matrix3xX, Vector2, Vector3};
use voussoir_core::law::{Facet, FacetMode};

/// Condition of K, relative to all points stuck, above which its twist is an unknown of its own.
const WEAK: f64 = 1e5;
/// d⊥·C t below this share of its factors: the point has no rate of its own.
const PARALLEL: f64 = 1e-9;

/// In which neighbourhood of a rate, and until when, nothing happens in a section.
#[derive(Default)]
pub struct Quiet {
    /// ξ̇ when it was last examined.
    pub twist: Vector3<f64>,
    /// How far ξ̇ may leave it.
    pub allowed: f64,
    /// The arc until which nothing happens then.
    pub deadline: f64,
    /// Sense of the slip of open points that dilate, where it is the same for all of them: a section is examined
    /// when it turns.
    pub slips: Option<f64>,
}

/// A section's state.
pub struct Joint {
    /// S of each point.
    tangents: Vec<Matrix2<f64>>,
    /// K.
    pub stiffness: Matrix3<f64>,
    /// K⁻¹, where it serves.
    pub flexibility: Option<Matrix3<f64>>,
    /// R about the centre from (X, s).
    pub statics: Matrix3xX<f64>,
    /// Relative twist since the beginning.
    pub twist: Vector3<f64>,
    /// R and ∫ R dRᵀ when its points were last up to date.
    stamp: (Vector3<f64>, Matrix3<f64>),
    /// Sense of the slip of open points, which dilatancy follows.
    senses: Vec<f64>,
    /// What holds of it while nothing happens.
    pub quiet: Quiet,
    /// Whether a point has changed its mode since the tangent was found.
    pub stale: bool,
    /// Whether points stand at facets that they may leave at any time.
    pub may_leave: bool,
    /// ṙ of each point when it was last examined.
    pub rates: Vec<[f64; 2]>,
}

/// How a point changes with what a section does.
pub struct Change {
    /// Its force.
    pub force: Vector2<f64>,
    /// Its opening, where it flows or is free.
    pub opening: f64,
    /// Energy that it dissipates.
    pub dissipated: f64,
}

/// S of a mode. `None` where the flow of a facet has no rate.
fn tangent(place: &Place, facets: Option<&[Facet]>, mode: ContactMode) -> Option<Matrix2<f64>> {
    Some(match mode {
        ContactMode::Stick => place.stiffness,
        ContactMode::Open | ContactMode::Corner(..) => Matrix2::zeros(),
        ContactMode::Facet(f) => {
            let facet = facets?.get(f as usize)?;
            let (t, n) = (Vector2::new(-facet.normal[1], facet.normal[0]), Vector2::from(across(facet.flow)));
            let along = place.compliance * t;
            let rate = n.dot(&along);
            if rate.abs() <= PARALLEL * along.norm() {
                return None;
            }
            t * n.transpose() / rate
        }
    })
}

impl Joint {
    /// At the beginning.
    pub fn new(section: &Section, load: &Vector3<f64>) -> Self {
        let n = section.places.len();
        Joint {
            tangents: vec![Matrix2::zeros(); n],
            stiffness: Matrix3::zeros(),
            flexibility: None,
            statics: section.statics(load),
            twist: Vector3::zeros(),
            stamp: (Vector3::zeros(), Matrix3::zeros()),
            senses: vec![0.0; n],
            quiet: Quiet::default(),
            stale: true,
            may_leave: true,
            rates: vec![[0.0; 2]; n],
        }
    }

    /// Finds the tangent of the points' modes. `None` where a point has no rate of its own.
    pub fn refresh(&mut self, section: &Section, facets: &[Option<Vec<Facet>>], points: &[Point]) -> Option<()> {
        let (mut stuck, mut stiffness) = (Matrix3::zeros(), Matrix3::zeros());
        for (k, place) in section.places.iter().enumerate() {
            let point = &points[place.contact];
            let s = tangent(place, facets[place.contact].as_deref(), point.mode)?;
            self.tangents[k] = s;
            stiffness += place.rows.transpose() * s * place.rows;
            stuck += place.rows.transpose() * place.stiffness * place.rows;
        }
        self.stiffness = stiffness;
        self.count(section, points);
        // Relative to the section with all points stuck, so that levers do not matter.
        let unit = stuck.diagonal().map(|v| 1.0 / v.sqrt());
        let scaled = Matrix3::from_fn(|i, j| stiffness[(i, j)] * unit[i] * unit[j]);
        // Of a matrix of rank 1 everything in the formula for the inverse is rounding: it must be one.
        let serves = |inverse: &Matrix3<f64>| {
            inverse.amax() < WEAK && (scaled * inverse - Matrix3::identity()).amax() < WEAK * f64::EPSILON
        };
        self.flexibility = scaled
            .try_inverse()
            .filter(serves)
            .map(|inverse| Matrix3::from_fn(|i, j| inverse[(i, j)] * unit[i] * unit[j]));
        self.stale = false;
        Some(())
    }

    /// Sees whether a mode is no longer the one of its tangent.
    pub fn count(&mut self, section: &Section, points: &[Point]) {
        self.may_leave = false;
        for place in &section.places {
            let point = &points[place.contact];
            self.stale |= point.settled().is_some_and(|mode| mode != point.mode);
            self.may_leave |= match point.mode {
                ContactMode::Stick => !point.active.is_empty(),
                ContactMode::Open => !point.open(),
                ContactMode::Facet(_) => !point.open() && point.active.len() > 1,
                ContactMode::Corner(..) => point.active.len() > 2,
            };
        }
    }

    /// ξ̇ for Ẋ, where the tangent can be inverted.
    pub fn twist_rate(&self, redundants: &[f64]) -> Option<Vector3<f64>> {
        let flexibility = self.flexibility.as_ref()?;
        let last = self.statics.ncols() - 1;
        let mut rate: Vector3<f64> = self.statics.fixed_view::<3, 1>(0, last).into_owned();
        for (j, x) in redundants.iter().enumerate() {
            rate += self.statics.fixed_view::<3, 1>(0, j) * *x;
        }
        Some(-(flexibility * rate))
    }

    /// Brings its points up to date: with z = (X, s) and ∫ z dzᵀ, or, where the tangent cannot be
    /// inverted, by a `step` of the arc with a given ξ̇. Returns what each point gains.
    pub fn update(
        &mut self,
        section: &Section,
        (facets, points): (&[Option<Vec<Facet>>], &[Point]),
        progress: &Progress,
        step: Option<(Vector3<f64>, f64)>,
        forces: &[f64],
    ) -> Vec<Change> {
        let resultant = &self.statics * &progress.place;
        let whole = &self.statics * &progress.area * self.statics.transpose();
        let (moved, area) = match (&self.flexibility, step) {
            (Some(flexibility), _) => {
                let gained = resultant - self.stamp.0;
                let area = whole - self.stamp.1 - self.stamp.0 * gained.transpose();
                (-(flexibility * gained), flexibility * area * flexibility.transpose())
            }
            (None, Some((rate, step))) => {
                let moved = rate * step;
                (moved, 0.5 * moved * moved.transpose())
            }
            (None, None) => (Vector3::zeros(), Matrix3::zeros()),
        };
        self.stamp = (resultant, whole);
        if moved == Vector3::zeros() {
            return Vec::new();
        }
        self.twist += moved;
        let change = |(k, place): (usize, &Place)| {
            let c = place.contact;
            let own = facets[c].as_deref().unwrap_or_default();
            let force = Vector2::new(forces[2 * c], forces[2 * c + 1]);
            self.change(k, place, (own, points[c].mode), force, &moved, &area)
        };
        section.places.iter().enumerate().map(change).collect()
    }

    fn change(
        &self,
        k: usize,
        place: &Place,
        (facets, mode): (&[Facet], ContactMode),
        force: Vector2<f64>,
        moved: &Vector3<f64>,
        area: &Matrix3<f64>,
    ) -> Change {
        let h = &place.rows;
        let by_force = -(self.tangents[k] * h);
        let mut change = Change { force: by_force * moved, opening: 0.0, dissipated: 0.0 };
        if mode == ContactMode::Stick {
            return change;
        }
        let by_gap = place.compliance * by_force + h;
        let opens = Vector2::from(mode.opening(facets, self.senses[k]));
        change.opening = opens.dot(&(by_gap * moved));
        if mode == ContactMode::Open {
            return change;
        }
        // Opening is reversible: what is left of the gap dissipates, −∫ r·dg_p.
        let is_opening = |f: u8| facets[f as usize].mode == FacetMode::Opening;
        let flow = match mode {
            ContactMode::Facet(f) if is_opening(f) => facets[f as usize].flow,
            ContactMode::Corner(i, _) if is_opening(i) => facets[i as usize].flow,
            ContactMode::Corner(_, j) if is_opening(j) => facets[j as usize].flow,
            _ => [0.0; 2],
        };
        let by_slip = by_gap + Vector2::from(flow) * (opens.transpose() * by_gap);
        let constant = force.dot(&(by_slip * moved));
        let growing: f64 = (0..2).map(|i| (by_force.row(i) * area * by_slip.row(i).transpose())[(0, 0)]).sum();
        change.dissipated = -(constant + growing);
        change
    }

    /// h, ṙ and ġ of a point for ξ̇.
    pub fn rates_of(&self, k: usize, place: &Place, mode: ContactMode, twist: &Vector3<f64>) -> [Vector2<f64>; 2] {
        let h = place.rows * twist;
        let force = -(self.tangents[k] * h);
        let gap = if mode == ContactMode::Stick { Vector2::zeros() } else { place.compliance * force + h };
        [force, gap]
    }

    /// By how much ṙ and ġ of a point change at most with a change of h of 1.
    pub fn sensitivity(&self, k: usize, place: &Place, mode: ContactMode) -> [f64; 2] {
        let s = self.tangents[k];
        let gap = if mode == ContactMode::Stick { 0.0 } else { (Matrix2::identity() - place.compliance * s).norm() };
        [s.norm(), gap]
    }

    /// By how much o changes at most with a change of ġ of 1.
    pub fn opening_sensitivity(&self, k: usize, facets: &[Facet], mode: ContactMode) -> f64 {
        Vector2::from(mode.opening(facets, self.senses[k])).norm()
    }

    /// Notes the sense of slip of an open point.
    pub fn turn(&mut self, k: usize, slip: f64) {
        self.senses[k] = if slip < 0.0 { -1.0 } else { 1.0 };
    }
}
