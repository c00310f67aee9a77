//! The law at a point: the current strength of the surface, and the state after the update.

use super::surface::{Piece, Surface, Table};
use crate::meridian::{Trial, state_names};
use voussoir_core::law::{StressPoint, StressUpdate, UpdateContext, UpdateFailure, Voigt};

/// Index of ε_v in the state.
const COMPACTION: usize = 6;

/// Index of the crushing in the state of a law that softens.
const CRUSHING: usize = 7;

static STATE: [&str; 8] = state_names(&["compaction [-]", "crushing [-]"]);

/// The change of p_a by flow.
#[derive(Debug, Clone)]
pub(super) enum Strength {
    /// By a table over the compaction ε_v, which starts at `initial_compaction`.
    Hardening { pieces: Vec<Piece>, initial_compaction: f64 },
    /// Linear in the crushing: the compaction by flow on the cap, which never decreases.
    Softening {
        /// p_a of intact material, and its decrease by crushing \[Pa\].
        intact: f64,
        drop: f64,
        /// w_c \[m\].
        crushing: f64,
        /// Greatest characteristic length \[m\].
        largest_length: f64,
    },
}

/// The law at a point. State: plastic strain (engineering shears), compaction ε_v and, if the law softens, crushing.
#[derive(Debug, Clone)]
pub(super) struct CapUpdate {
    pub surface: Surface,
    pub strength: Strength,
}

impl CapUpdate {
    /// Returns the update by a table over one entry of the state.
    fn by_table(
        &self,
        table: Table,
        strain: &Voigt,
        old: &[f64],
        new: &mut [f64],
        at: usize,
    ) -> Result<StressPoint, UpdateFailure> {
        let elastic = &self.surface.elastic;
        let trial = Trial::new(elastic, strain, old)?;
        new.copy_from_slice(old);
        let Some(back) = self.surface.project(table, [trial.pressure, trial.mises], old[at])? else {
            return Ok(trial.elastic(elastic));
        };
        new[COMPACTION] += back.compaction;
        if at == CRUSHING {
            new[CRUSHING] += back.compaction.max(0.0);
        }
        Ok(trial.returned(elastic, &back, new))
    }
}

impl StressUpdate for CapUpdate {
    fn state_size(&self) -> usize {
        match self.strength {
            Strength::Hardening { .. } => 7,
            Strength::Softening { .. } => 8,
        }
    }

    fn initial_state(&self, state: &mut [f64]) {
        state.fill(0.0);
        if let Strength::Hardening { initial_compaction, .. } = self.strength {
            state[COMPACTION] = initial_compaction;
        }
    }

    fn state_names(&self) -> &'static [&'static str] {
        &STATE[..self.state_size()]
    }

    fn largest_length(&self) -> f64 {
        match self.strength {
            Strength::Hardening { .. } => f64::INFINITY,
            Strength::Softening { largest_length, .. } => largest_length,
        }
    }

    fn update_point(
        &self,
        strain: &Voigt,
        context: &UpdateContext,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<StressPoint, UpdateFailure> {
        match &self.strength {
            Strength::Hardening { pieces, .. } => {
                self.by_table(Table { pieces, reversible: true }, strain, old, new, COMPACTION)
            }
            Strength::Softening { intact, drop, crushing, largest_length } => {
                let length = context.length;
                // Also refuses a length that is NaN.
                if !(length > 0.0 && length <= *largest_length) {
                    return Err(UpdateFailure::LengthTooLarge);
                }
                let end = crushing / length;
                let pieces = [
                    Piece { strain: f64::NEG_INFINITY, centre: *intact, slope: 0.0 },
                    Piece { strain: 0.0, centre: *intact, slope: -drop / end },
                    Piece { strain: end, centre: intact - drop, slope: 0.0 },
                ];
                self.by_table(Table { pieces: &pieces, reversible: false }, strain, old, new, CRUSHING)
            }
        }
    }
}
