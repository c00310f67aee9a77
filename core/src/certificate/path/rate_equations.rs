//! The linear equations of rates at a state: equilibrium of free bodies and kinematics of contact points.
//!
//! ```text
//! E ṙ + K q̇ + λ̇ p = 0        ġ = C ṙ + G q̇ + λ̇ g_p
//! ```
//!
//! They are stored by columns, one for each rate of a force, of a motion and of λ. With small displacements E = Gᵀ, K =
//! 0.

use super::displaced_rates::{Moving, ResidualRates};
use crate::path::{Contact, LoadStepEnd, PathProblem, PathRate, PathState};

/// An entry of a column.
type Entry = (usize, f64);

/// One column: entries of E, K or p by index 3 × body + component, and of C, G or g_p by index 2 × contact point +
/// component.
#[derive(Debug, Clone, Default)]
pub(super) struct Column {
    pub equilibrium: Vec<Entry>,
    pub gap: Vec<Entry>,
}

/// The equations of rates.
#[derive(Debug)]
pub struct RateEquations {
    /// Columns of ṙ, by index 2 × contact point + component.
    pub(super) forces: Vec<Column>,
    /// Columns of q̇, by index 3 × body + component; empty for held bodies.
    pub(super) motions: Vec<Column>,
    /// The column of λ̇, with the motion of supports.
    pub(super) load: Column,
    /// 1 if the load step raises λ, else −1.
    pub sense: f64,
    /// True for bodies that move by settlement only.
    pub(super) held: Vec<bool>,
    /// Motion of held bodies per λ.
    pub(super) settlements: Vec<[f64; 3]>,
    /// Length scale \[m\].
    pub(super) length: f64,
}

impl RateEquations {
    /// Derives the equations at a state.
    pub fn new(problem: &PathProblem, state: &PathState, finite: bool) -> Self {
        let step = &problem.load_steps[state.load_step];
        let mut settlements = vec![[0.0; 3]; problem.bodies.len()];
        for (body, motion) in &step.loading.settlements {
            (0..3).for_each(|i| settlements[*body][i] += motion[i]);
        }
        let sense = match step.end {
            LoadStepEnd::Factor(end) if end < step.start => -1.0,
            _ => 1.0,
        };
        let held: Vec<bool> = problem.bodies.iter().map(|body| body.held).collect();
        let mut equations = RateEquations {
            forces: Vec::new(),
            motions: Vec::new(),
            load: Column::default(),
            sense,
            held,
            settlements,
            length: problem.length,
        };
        if finite {
            equations.derive_finite(problem, state)
        } else {
            equations.derive_small(problem, state)
        }
        equations
    }

    /// Derives the columns for small displacements.
    fn derive_small(&mut self, problem: &PathProblem, state: &PathState) {
        let mut on_body = vec![Vec::new(); problem.bodies.len()];
        for (index, contact) in problem.contacts.iter().enumerate() {
            for (side, sign) in [(contact.minus, -1.0), (contact.plus, 1.0)] {
                on_body[side.body].push((index, side.slot, sign));
            }
        }
        for (index, contact) in problem.contacts.iter().enumerate() {
            for component in 0..2 {
                self.forces.push(self.small_force(problem, &on_body, (index, contact), component));
            }
        }
        for (body, contacts) in on_body.iter().enumerate() {
            for k in 0..3 {
                let mut column = Column { equilibrium: Vec::new(), gap: Vec::with_capacity(2 * contacts.len()) };
                for &(contact, _, sign) in contacts.iter().filter(|_| !self.held[body]) {
                    let rows = problem.kinematics(&problem.contacts[contact], sign > 0.0);
                    column.gap.extend([0, 1].map(|i| (2 * contact + i, rows[i][k])));
                }
                self.motions.push(column);
            }
        }
        let loading = &problem.load_steps[state.load_step].loading;
        let wrenches = problem.wrenches(loading);
        let free = wrenches.as_flattened().iter().copied().enumerate().filter(|(i, _)| !self.held[i / 3]);
        self.load.equilibrium = free.filter(|(_, v)| *v != 0.0).collect();
        let gaps = problem.loading_gaps(loading);
        self.load.gap = gaps.as_flattened().iter().copied().enumerate().filter(|(_, v)| *v != 0.0).collect();
    }

    fn small_force(
        &self,
        problem: &PathProblem,
        on_body: &[Vec<(usize, Option<usize>, f64)>],
        (index, contact): (usize, &Contact),
        component: usize,
    ) -> Column {
        let mut column = Column { equilibrium: Vec::with_capacity(6), gap: Vec::new() };
        let along = [contact.normal, contact.tangent][component];
        for (side, sign) in [(contact.minus, -1.0), (contact.plus, 1.0)] {
            if !self.held[side.body] {
                let row = problem.kinematics(contact, sign > 0.0)[component];
                column.equilibrium.extend([0, 1, 2].map(|k| (3 * side.body + k, row[k])));
            }
            let (Some(slot), Some(matrix)) = (side.slot, &problem.bodies[side.body].flexibility) else { continue };
            column.gap.reserve(2 * on_body[side.body].len() + 1);
            for &(other, at, sense) in &on_body[side.body] {
                let Some(at) = at else { continue };
                let moved = [0, 1]
                    .map(|i| matrix[(2 * at + i, 2 * slot)] * along.x + matrix[(2 * at + i, 2 * slot + 1)] * along.y);
                let seen = &problem.contacts[other];
                for (i, e) in [seen.normal, seen.tangent].into_iter().enumerate() {
                    column.gap.push((2 * other + i, sign * sense * (e.x * moved[0] + e.y * moved[1])));
                }
            }
        }
        column.gap.push((2 * index + component, contact.compliance[component]));
        column
    }

    /// Derives the columns for finite displacements; each is a derivative with respect to one unknown.
    fn derive_finite(&mut self, problem: &PathProblem, state: &PathState) {
        let (contacts, bodies) = (problem.contacts.len(), problem.bodies.len());
        let held = &self.held;
        let column = |rates: ResidualRates| {
            let free = rates.unbalanced.iter().filter(|(body, _)| !held[*body]);
            let free = free.flat_map(|(body, wrench)| [0, 1, 2].map(|i| (3 * body + i, wrench[i].rate)));
            let gap = rates.gaps.iter().flat_map(|(contact, gap)| [0, 1].map(|i| (2 * contact + i, gap[i].rate)));
            let moves = |entry: &Entry| entry.1 != 0.0;
            Column { equilibrium: free.filter(moves).collect(), gap: gap.filter(moves).collect() }
        };
        let still =
            PathRate { factor: 0.0, force: vec![[0.0; 2]; contacts], gap: Vec::new(), motion: vec![[0.0; 3]; bodies] };
        let mut at_rest = Moving::new(problem, state, &still);
        self.forces = (0..2 * contacts).map(|index| column(at_rest.by_force(index / 2, index % 2))).collect();
        let of_motion = |index: usize| match held[index / 3] {
            true => Column::default(),
            false => column(at_rest.by_motion(index / 3, index % 3)),
        };
        self.motions = (0..3 * bodies).map(of_motion).collect();
        let loaded = PathRate { factor: 1.0, motion: self.settlements.clone(), ..still };
        self.load = column(Moving::new(problem, state, &loaded).rates());
    }

    /// Returns the sum of each row over all columns, and the sum of the sizes of its terms. Rows of equilibrium come
    /// first, 3 per body, then rows of gaps, 2 per contact point.
    pub(super) fn products(&self, rate: &PathRate) -> Vec<[f64; 2]> {
        let bodies = self.held.len();
        let mut rows = vec![[0.0; 2]; 3 * bodies + self.forces.len()];
        let mut add = |column: &Column, factor: f64| {
            let equilibrium = column.equilibrium.iter().copied();
            let gap = column.gap.iter().map(|(row, value)| (3 * bodies + row, *value));
            for (row, value) in equilibrium.chain(gap) {
                rows[row][0] += value * factor;
                rows[row][1] += (value * factor).abs();
            }
        };
        self.forces.iter().zip(rate.force.as_flattened()).for_each(|(column, factor)| add(column, *factor));
        self.motions.iter().zip(rate.motion.as_flattened()).for_each(|(column, factor)| add(column, *factor));
        add(&self.load, rate.factor);
        rows
    }
}
