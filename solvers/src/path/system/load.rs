//! A loading in scaled units.

use super::scaled::System;
use voussoir_core::path::{Loading, PathProblem};

/// A loading in scaled units.
#[derive(Debug, Clone)]
pub struct Load {
    /// Generalised force on each free body, per unit of λ.
    pub wrench: Vec<[f64; 3]>,
    /// Gap that it opens at each contact point, per unit of λ.
    pub gap: Vec<[f64; 2]>,
    /// True if it opens any gap.
    pub opens: bool,
    /// True if it moves supports: then statically determinate parts move at constant forces while λ changes.
    pub settles: bool,
    /// Greatest of all these entries: the size of the forces that it causes, in scaled units.
    pub size: f64,
}

impl Load {
    /// Scales a loading of a problem.
    pub fn new(system: &System, problem: &PathProblem, loading: &Loading) -> Self {
        let units = system.units;
        let mut wrench = vec![[0.0; 3]; system.bodies];
        for (w, free) in problem.wrenches(loading).into_iter().zip(&system.free) {
            if let Some(free) = free {
                let [x, y, moment] = w;
                wrench[*free] = [x / units.force, y / units.force, moment / (units.force * units.length)];
            }
        }
        let gap: Vec<[f64; 2]> =
            problem.loading_gaps(loading).into_iter().map(|g| g.map(|g| g / units.displacement)).collect();
        let opens = gap.iter().flatten().any(|g| *g != 0.0);
        let all = wrench.iter().flatten().chain(gap.iter().flatten());
        let size = all.fold(0.0, |a: f64, v| a.max(v.abs()));
        let settles = loading.settlements.iter().any(|(_, motion)| *motion != [0.0; 3]);
        Load { wrench, gap, opens, settles, size }
    }

    /// Returns the same loading, or the opposite one.
    pub fn reversed_if(mut self, reversed: bool) -> Self {
        if reversed {
            self.wrench.iter_mut().flatten().for_each(|v| *v = -*v);
            self.gap.iter_mut().flatten().for_each(|v| *v = -*v);
        }
        self
    }
}
