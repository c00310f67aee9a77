//! The unknowns of a step and their units.
//!
//! Unknowns (r of all contact points, q of the free bodies, λ), each in its unit: force F, the size
//! of the loads; displacement U = F × mean compliance; rotation U / length; factor Λ.

/// Units of the unknowns.
#[derive(Debug, Clone, Copy)]
pub(super) struct Units {
    pub force: f64,
    pub displacement: f64,
    pub length: f64,
    pub factor: f64,
}

impl Units {
    /// Units of a body's motion (x, y, θ).
    pub fn motion(&self) -> [f64; 3] {
        [self.displacement, self.displacement, self.displacement / self.length]
    }

    /// Unit of energy.
    pub fn energy(&self) -> f64 {
        self.force * self.displacement
    }
}

/// Where each unknown stands among all.
#[derive(Debug, Clone)]
pub(super) struct Unknowns {
    pub units: Units,
    /// Number of contact points.
    pub contacts: usize,
    /// Index among the free bodies.
    pub free: Vec<Option<usize>>,
    /// Number of free bodies.
    pub bodies: usize,
}

impl Unknowns {
    /// Number of unknowns.
    pub fn size(&self) -> usize {
        2 * self.contacts + 3 * self.bodies + 1
    }

    /// Column of an index over all bodies, and its unit; `None` for held bodies.
    pub fn column(&self, index: usize) -> Option<(usize, f64)> {
        let base = 2 * self.contacts;
        if index < base {
            return Some((index, self.units.force));
        }
        let (body, k) = ((index - base) / 3, (index - base) % 3);
        self.free[body].map(|free| (base + 3 * free + k, self.units.motion()[k]))
    }
}
