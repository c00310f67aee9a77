//! Local search for non-associated limit states.
//!
//! For static fields s and mechanisms γ, Σ s_i γ_i ≥ 0 is bilinear and zero exactly at a limit state. Alternating
//! linear programs lower it from many starts. At a state, a linear program in the field gives the least factor of its
//! mechanism; other mechanisms at that field lead to lower states.

use crate::limit::settings::SETTINGS;
use crate::optimise::dense_simplex::{Dictionary, Feasibility};

/// The two systems of the alternating search.
pub struct Descent<'a> {
    /// Statics, with the bound of θ.
    pub statics: &'a mut Dictionary,
    /// Kinematics.
    pub kinematics: &'a mut Dictionary,
    /// Number of pairs.
    pub pairs: usize,
    /// Index of θ in statics.
    pub theta: usize,
    /// Pairs that never move.
    pub excluded: &'a [bool],
}

/// A state: its factor and the pairs that move.
#[derive(Debug, Clone)]
pub struct State {
    /// θ.
    pub theta: f64,
    /// Pairs with γ_i > 0.
    pub moving: Vec<usize>,
}

impl Descent<'_> {
    fn weights(values: &[f64]) -> Vec<(usize, f64)> {
        values.iter().copied().enumerate().filter(|(_, v)| *v > 0.0).collect()
    }

    fn read(system: &Dictionary, pairs: usize) -> Vec<f64> {
        let values: Vec<f64> = (0..pairs).map(|i| system.value(i).max(0.0)).collect();
        let greatest = values.iter().fold(0.0f64, |m, v| m.max(*v));
        values.into_iter().map(|v| if v > SETTINGS.active * greatest { v } else { 0.0 }).collect()
    }

    /// Releases all pairs: every pair may move and yield.
    pub fn release(&mut self) {
        for i in 0..self.pairs {
            self.statics.fix(i, false);
            self.kinematics.fix(i, self.excluded[i]);
        }
    }

    /// Alternates from the given weights of mechanisms. Returns a state if the product vanishes.
    pub fn alternate(&mut self, start: &[f64]) -> Option<State> {
        self.release();
        if self.statics.feasible() != Feasibility::Point || self.kinematics.feasible() != Feasibility::Point {
            return None;
        }
        let mut gamma = start.to_vec();
        let mut last = f64::INFINITY;
        for _ in 0..60 {
            self.statics.minimise(&Self::weights(&gamma), 400)?;
            let slack = Self::read(self.statics, self.pairs);
            let (value, _) = self.kinematics.minimise(&Self::weights(&slack), 400)?;
            gamma = Self::read(self.kinematics, self.pairs);
            let scale = gamma.iter().fold(0.0f64, |m, g| m.max(*g)) * slack.iter().fold(0.0f64, |m, s| m.max(*s));
            if value <= SETTINGS.active * scale.max(1e-3) {
                let moving: Vec<usize> = (0..self.pairs).filter(|&i| gamma[i] > 0.0).collect();
                return self.least_with(&moving).map(|theta| State { theta, moving });
            }
            if value > last * (1.0 - SETTINGS.closed) {
                return None;
            }
            last = value;
        }
        None
    }

    /// Returns the least θ at which all these pairs yield.
    pub fn least_with(&mut self, moving: &[usize]) -> Option<f64> {
        (0..self.pairs).for_each(|i| self.statics.fix(i, false));
        moving.iter().for_each(|&i| self.statics.fix(i, true));
        let found = self.statics.feasible() == Feasibility::Point;
        let least = if found { self.statics.minimise(&[(self.theta, 1.0)], 2000) } else { None };
        least.map(|l| l.0)
    }

    /// Improves a state to lower factors: at its field it tries every mechanism without one of the moving pairs.
    pub fn improve(&mut self, mut state: State) -> State {
        'again: loop {
            let Some(theta) = self.least_with(&state.moving) else { return state };
            state.theta = state.theta.min(theta);
            let slack = Self::read(self.statics, self.pairs);
            let yields: Vec<bool> = slack.iter().map(|s| *s == 0.0).collect();
            for &without in &state.moving.clone() {
                for (i, yields) in yields.iter().enumerate() {
                    self.kinematics.fix(i, self.excluded[i] || !yields || i == without);
                }
                if self.kinematics.feasible() != Feasibility::Point {
                    continue;
                }
                let gamma = Self::read(self.kinematics, self.pairs);
                let moving: Vec<usize> = (0..self.pairs).filter(|&i| gamma[i] > 0.0).collect();
                if let Some(theta) = self.least_with(&moving)
                    && theta < state.theta - SETTINGS.active * state.theta.abs()
                {
                    state = State { theta, moving };
                    continue 'again;
                }
            }
            self.release();
            return state;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Weights are the positive values with their indices.
    #[test]
    fn weights_are_positive_values() {
        assert_eq!(Descent::weights(&[0.0, 2.0, -1.0, 0.5]), [(1, 2.0), (3, 0.5)]);
    }
}
