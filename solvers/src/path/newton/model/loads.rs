//! The present loads: the loads left by earlier stages and the growing load.

use voussoir_core::model::geometry::Vec2;
use voussoir_core::path::Loading;

/// The present loads: each loading with its factor; the growing one is last.
pub struct Loads<'a> {
    pub parts: Vec<(f64, &'a Loading)>,
}

impl Loads<'_> {
    pub fn acceleration(&self) -> Vec2 {
        self.parts.iter().map(|(factor, loading)| loading.acceleration * *factor).sum()
    }

    pub fn growing(&self) -> &Loading {
        self.parts[self.parts.len() - 1].1
    }

    /// Returns the motion of all held bodies by settlement.
    pub fn settled(&self, bodies: usize) -> Vec<[f64; 3]> {
        let mut motion = vec![[0.0; 3]; bodies];
        for (factor, loading) in &self.parts {
            for (body, settlement) in &loading.settlements {
                (0..3).for_each(|k| motion[*body][k] += factor * settlement[k]);
            }
        }
        motion
    }
}

/// The present load step, added to the loads of earlier ones.
#[derive(Clone)]
pub struct StagedLoads<'a> {
    pub earlier: Vec<(f64, &'a Loading)>,
    pub growing: &'a Loading,
    pub start: f64,
    /// Viscous wrenches of a descent to a stable equilibrium.
    pub damping: Option<Damping>,
}

/// Viscous wrenches on the free bodies: rate × the motion since the start, both in units.
#[derive(Debug, Clone)]
pub struct Damping {
    pub rate: f64,
    /// Motions at the start.
    pub from: Vec<[f64; 3]>,
}

impl<'a> StagedLoads<'a> {
    /// Creates loads without damping.
    pub fn new(earlier: Vec<(f64, &'a Loading)>, growing: &'a Loading, start: f64) -> Self {
        StagedLoads { earlier, growing, start, damping: None }
    }

    pub fn at(&self, factor: f64) -> Loads<'a> {
        let mut parts = self.earlier.clone();
        parts.push((factor - self.start, self.growing));
        Loads { parts }
    }
}
