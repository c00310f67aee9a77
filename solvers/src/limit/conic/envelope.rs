//! Joints with several sliding facets in one sense: a sequence of programs with more and more rows.
//!
//! The shear of such a joint is bounded by an envelope that is concave in N_0 and N_1
//! ([`voussoir_core::law::ShearEnvelope`]). Each program has finitely many of its rows, beginning with the facets over the
//! whole joint, so its answers hold as upper bounds. If its field exceeds the envelope, the deepest row is added
//! (Kelley 1960, *J. SIAM* 8: cutting planes). Both have the same forces without bound, so a program that has no bound
//! proves that the scene has none. The result is a field within all envelopes.

use super::engine::ConicEngine;
use crate::limit::settings::SETTINGS;
use voussoir_core::law::ShearEnvelope;
use voussoir_core::limit::{Counters, Engine, Equilibrium, Extreme, GreatestFactor, JointForce, LimitProblem};
use voussoir_core::model::Wrenches;

/// Greatest number of programs for one question.
const MAX_PROGRAMS: usize = 60;

/// The conic engine over a problem with rows instead of envelopes.
pub struct EnvelopeEngine {
    relaxed: LimitProblem,
    /// Number of rows of each joint before the first program.
    facets: Vec<usize>,
    /// Joint and envelope.
    envelopes: Vec<(usize, ShearEnvelope)>,
    work: Counters,
}

impl EnvelopeEngine {
    /// Creates the engine for a problem with envelopes.
    pub fn new(problem: &LimitProblem) -> Self {
        let mut relaxed = problem.clone();
        let mut envelopes = Vec::new();
        for (index, joint) in relaxed.joints.iter_mut().enumerate() {
            let own = std::mem::take(&mut joint.strength.envelopes);
            envelopes.extend(own.into_iter().map(|envelope| (index, envelope)));
        }
        let facets = relaxed.joints.iter().map(|joint| joint.strength.rows.len()).collect();
        EnvelopeEngine { relaxed, facets, envelopes, work: Counters::new() }
    }

    /// Adds a row to each envelope that a field exceeds. Returns true if rows were added.
    fn cut(&mut self, field: &[JointForce]) -> bool {
        let size = |force: &JointForce| force.normal[0].abs().max(force.normal[1].abs()).max(force.shear.abs());
        let unit = field.iter().map(size).fold(0.0, f64::max);
        let mut any = false;
        for (joint, envelope) in &self.envelopes {
            let JointForce { normal: [n_0, n_1], shear } = field[*joint];
            if let Some(row) = envelope.deepest_row([n_0, n_1, shear]) {
                let [a, b, c] = row.normal;
                let length = (a * a + b * b + c * c).sqrt();
                if a * n_0 + b * n_1 + c * shear - row.bound > SETTINGS.admissible * unit * length {
                    self.relaxed.joints[*joint].strength.rows.push(row);
                    any = true;
                }
            }
        }
        any
    }

    /// Returns the problem with the rows that touch the envelopes at a field, instead of all rows that led to it. Rows of
    /// neighbouring fields are nearly parallel, and then the multipliers of a program are poor.
    fn touching(&self, field: &[JointForce]) -> LimitProblem {
        let mut touching = self.relaxed.clone();
        for (joint, rows) in touching.joints.iter_mut().zip(&self.facets) {
            joint.strength.rows.truncate(*rows);
        }
        for (joint, envelope) in &self.envelopes {
            let price = envelope.greatest(field[*joint].normal).price;
            touching.joints[*joint].strength.rows.push(envelope.row(price));
        }
        touching
    }

    /// Asks the question until its field is within all envelopes. `field` returns the field of an answer, if it has one.
    fn until_within<A>(
        &mut self,
        ask: impl Fn(&mut ConicEngine<'_>) -> A,
        field: impl Fn(&A) -> Option<&[JointForce]>,
    ) -> Option<A> {
        for _ in 0..MAX_PROGRAMS {
            let mut engine = ConicEngine::new(&self.relaxed);
            let answer = ask(&mut engine);
            for (name, by) in engine.counters() {
                *self.work.entry(name).or_default() += by;
            }
            *self.work.entry("envelope_programs".into()).or_default() += 1;
            let beyond = field(&answer).is_some_and(|field| self.cut(field));
            if !beyond {
                return Some(answer);
            }
        }
        None
    }

    fn equilibrium(&mut self, ask: impl Fn(&mut ConicEngine<'_>) -> Equilibrium) -> Equilibrium {
        let found = self.until_within(ask, |answer| match answer {
            Equilibrium::Field(field) => Some(field.as_slice()),
            Equilibrium::Motion(_) | Equilibrium::Failed(_) => None,
        });
        found.unwrap_or_else(|| Equilibrium::Failed(UNSETTLED.into()))
    }
}

const UNSETTLED: &str = "the rows of the sliding envelopes did not settle";

impl Engine for EnvelopeEngine {
    fn admissible(&mut self, loads: &Wrenches) -> Equilibrium {
        self.equilibrium(|engine| engine.admissible(loads))
    }

    fn possible(&mut self, fixed: &Wrenches, varying: &Wrenches) -> Equilibrium {
        self.equilibrium(|engine| engine.possible(fixed, varying))
    }

    fn greatest(&mut self, fixed: &Wrenches, varying: &Wrenches, cap: f64) -> GreatestFactor {
        let ask = |engine: &mut ConicEngine<'_>| engine.greatest(fixed, varying, cap);
        let found = self.until_within(ask, |answer| match answer {
            GreatestFactor::Collapse { field, .. } | GreatestFactor::Capped(field) => Some(field.as_slice()),
            GreatestFactor::Unbounded(_) | GreatestFactor::Failed(_) => None,
        });
        match found {
            // The envelopes may have more mechanisms than the rows.
            Some(GreatestFactor::Collapse { factor, field, motion, .. }) => {
                let touching = self.touching(&field);
                let last = ConicEngine::new(&touching).greatest(fixed, varying, cap);
                let motion = match last {
                    GreatestFactor::Collapse { factor: other, motion, .. }
                        if (other - factor).abs() <= SETTINGS.active * factor.abs() =>
                    {
                        motion
                    }
                    _ => motion,
                };
                GreatestFactor::Collapse { factor, field, motion, unique: None }
            }
            Some(other) => other,
            None => GreatestFactor::Failed(UNSETTLED.into()),
        }
    }

    fn extreme(&mut self, loads: &Wrenches, joint: usize, form: [f64; 3]) -> Extreme {
        let ask = |engine: &mut ConicEngine<'_>| engine.extreme_field(loads, joint, form);
        let found = self.until_within(ask, |answer| match answer {
            Extreme::Finite(field) => Some(field.as_slice()),
            Extreme::Ray(_) | Extreme::Failed => None,
        });
        found.map_or(Extreme::Failed, |extreme| extreme.at(joint))
    }

    fn counters(&self) -> Counters {
        self.work.clone()
    }
}
