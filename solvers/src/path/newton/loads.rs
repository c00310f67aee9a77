//! The loads in force: those that earlier stages left and the one that grows.

use voussoir_core::model::geometry::Vec2;
use voussoir_core::path::Loading;

/// The loads in force: each loading with its factor, the one that grows last.
pub(super) struct Loads<'a> {
    pub parts: Vec<(f64, &'a Loading)>,
}

impl Loads<'_> {
    pub fn acceleration(&self) -> Vec2 {
        self.parts.iter().map(|(factor, loading)| loading.acceleration * *factor).sum()
    }

    pub fn growing(&self) -> &Loading {
        self.parts[self.parts.len() - 1].1
    }

    /// Motion of all held bodies by settlement.
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

/// The present load step on top of what earlier ones left.
#[derive(Clone)]
pub(super) struct StagedLoads<'a> {
    pub earlier: Vec<(f64, &'a Loading)>,
    pub growing: &'a Loading,
    pub start: f64,
}

impl<'a> StagedLoads<'a> {
    pub fn at(&self, factor: f64) -> Loads<'a> {
        let mut parts = self.earlier.clone();
        parts.push((factor - self.start, self.growing));
        Loads { parts }
    }
}
