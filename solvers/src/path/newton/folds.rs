//! Where a path of finite displacements leads from a state at which no step converges.
//!
//! There some contact points are at the verge of a change. The regimes that the last rate asks for are one
//! candidate; it is a solution of the rate problem only if it asks for the same regimes itself (a point
//! that slides goes on sliding in its sense, one that opens opens). Where it is not, the linear
//! complementarity problem of the rates ([`rising`](super::rising)) is searched to its end for a rate on
//! which λ goes on in its sense. If there is none the path folds: what is left is to unload, which friction
//! always allows. Other points may then slide, and the path goes on at another place; if it comes back to
//! the same fold it ends there.

use super::model::Rate;
use super::rising::Rising;
use super::trace::Tracer;
use crate::contact::mode::ContactMode as Regime;

/// Whether the motions of two rates make an acute angle.
fn forwards(rate: &Rate, other: &Rate) -> bool {
    let pairs = rate.motion.iter().flatten().zip(other.motion.iter().flatten());
    pairs.map(|(a, b)| a * b).sum::<f64>() > 0.0
}

impl Tracer<'_, '_> {
    /// The rate that leads on where `rate` does not, with its regimes, if one was found; an error says why
    /// none does.
    pub(super) fn onward(&mut self, rate: &Rate, share: f64) -> Result<Option<(Rate, Vec<Regime>)>, String> {
        let own = self.yielding(rate, share);
        if !self.model.finite() || !self.model.piecewise_linear() {
            return Ok(own);
        }
        if let Some((other, regimes)) = &own
            && self.agrees(other, regimes, share)
        {
            return Ok(own);
        }
        let state = self.state.clone();
        match self.model.rising(&state, rate.factor.signum()) {
            // Where the load falls anyway, unloading is a rate of the same sense: one of several, and none that is wanted.
            Rising::Rate(other, regimes)
                if regimes != state.regime && forwards(rate, &other) && self.agrees(&other, &regimes, share) =>
            {
                self.model.count("branches", 1);
                Ok(Some((other, regimes)))
            }
            Rising::Rate(..) | Rising::Unknown(_) => Ok(own),
            Rising::None if !self.wandering.folds_again([self.recorded.displacement, state.factor]) => Ok(own),
            Rising::None => {
                let sense = if rate.factor > 0.0 { "growing" } else { "falling" };
                Err(format!(
                    "at factor {} no rate of equilibrium goes on with a {sense} factor: all regimes of the contact points at the verge of a change are excluded; unloading from there has come back to this place",
                    state.factor
                ))
            }
        }
    }

    /// Whether a rate asks for the regimes that it was computed with.
    fn agrees(&mut self, rate: &Rate, regimes: &[Regime], share: f64) -> bool {
        let state = self.state.clone();
        let size = self.model.motion_size(rate).max(1e-300);
        let mut ahead = self.moved(rate, 1e-3 * share / size);
        ahead.regime = regimes.to_vec();
        self.model.regimes_ahead(&state, &ahead) == regimes
    }
}
