//! `creeping_mortar`: a joint without tensile strength that creeps in compression and shear, with friction.
#![doc = include_str!("creeping_mortar.md")]

use crate::shared::*;
use std::sync::Arc;
use voussoir_core::law::{
    Effect, InterfaceLaw, InterfaceResponse, PointContext, TractionPoint, UpdateBranch, UpdateFailure,
};
use voussoir_core::plugin::{Capability, Card, Keys, KnownPath, Output, PluginKind, Property, Sample};

/// A mortar joint that creeps.
#[derive(Debug, Clone, Keys)]
#[keys(check = CreepingMortar::validate)]
pub struct CreepingMortar {
    /// μ.
    #[key(like = JointKeys)]
    pub friction: Option<f64>,
    /// atan μ \[deg\].
    #[key(like = JointKeys)]
    pub friction_angle: Option<f64>,
    /// k_n \[Pa/m\] of a load that acts at once.
    #[key(like = JointKeys)]
    pub normal_stiffness: f64,
    /// k_t \[Pa/m\] of a load that acts at once.
    #[key(like = JointKeys)]
    pub shear_stiffness: f64,
    /// creep gap after infinite time under a constant load, relative to the elastic gap
    #[key(unit = "-", range = "> 0")]
    pub creep_coefficient: f64,
    /// retardation time: under a constant load, creep reaches 63 % of its final value in it
    #[key(unit = "s", range = "> 0")]
    pub retardation_time: f64,
}

impl CreepingMortar {
    fn validate(&self) -> Vec<(String, String)> {
        validate_friction(self.friction, self.friction_angle, None)
    }
}

#[typetag::serde(name = "creeping_mortar")]
impl InterfaceLaw for CreepingMortar {
    fn response(&self) -> Option<Arc<dyn InterfaceResponse>> {
        let unit =
            |stiffness| KelvinChain { stiffness, creep: self.creep_coefficient, retardation: self.retardation_time };
        Some(Arc::new(CreepingResponse {
            friction: friction(self.friction, self.friction_angle),
            normal: unit(self.normal_stiffness),
            shear: unit(self.shear_stiffness),
        }))
    }

    fn stiffness(&self) -> Option<[f64; 2]> {
        stiffness(Some(self.normal_stiffness), Some(self.shear_stiffness))
    }
}

/// The joint slides while it may creep.
const SLIDING: UpdateBranch = UpdateBranch::new("sliding", Effect::Sliding);

/// A spring k in series with a Kelvin unit of stiffness k/φ and retardation time τ.
#[derive(Debug, Clone, Copy)]
struct KelvinChain {
    stiffness: f64,
    creep: f64,
    retardation: f64,
}

/// The creep of a chain in a step in which its gap is linear in time: c = `fixed` + `by_gap` g.
#[derive(Debug, Clone, Copy)]
struct CreepStep {
    fixed: f64,
    by_gap: f64,
}

impl KelvinChain {
    /// Returns the creep in a step from a gap and a creep gap.
    fn step(&self, gap: f64, creep: f64, time_step: f64) -> CreepStep {
        let rate = (1.0 + self.creep) / self.retardation * time_step;
        // A step without duration: nothing creeps.
        if rate == 0.0 {
            return CreepStep { fixed: creep, by_gap: 0.0 };
        }
        let passed = -(-rate).exp_m1();
        let weight = weight(rate);
        let final_share = self.creep / (1.0 + self.creep);
        CreepStep {
            fixed: (1.0 - passed) * creep + final_share * (passed - weight) * gap,
            by_gap: final_share * weight,
        }
    }

    /// Returns the energy stored at a gap and a creep gap \[J/m²\].
    fn stored(&self, gap: f64, creep: f64) -> f64 {
        0.5 * self.stiffness * ((gap - creep).powi(2) + creep * creep / self.creep)
    }

    /// Returns the energy that the damper dissipates in a step between two gaps, linear in time \[J/m²\]: with
    /// ċ = a + b e^(−λ t), it is τ k/φ ∫ ċ² dt.
    fn dissipated(&self, [before, after]: [f64; 2], creep: f64, time_step: f64) -> f64 {
        if time_step == 0.0 {
            return 0.0;
        }
        let decay = (1.0 + self.creep) / self.retardation;
        let steady = self.creep / (1.0 + self.creep) * (after - before) / time_step;
        let first = (self.creep * before - (1.0 + self.creep) * creep) / self.retardation - steady;
        let once = -(-decay * time_step).exp_m1() / decay;
        let twice = -(-2.0 * decay * time_step).exp_m1() / (2.0 * decay);
        let square = steady * steady * time_step + 2.0 * steady * first * once + first * first * twice;
        self.retardation * self.stiffness / self.creep * square.max(0.0)
    }

    /// Returns the creep gap of an unloaded chain after a time.
    fn recovered(&self, creep: f64, time_step: f64) -> f64 {
        creep * (-time_step / self.retardation).exp()
    }
}

/// Returns 1 − (1 − e^(−r))/r.
fn weight(rate: f64) -> f64 {
    // For small r the difference cancels; the series is more exact.
    if rate < 1e-4 { rate * (0.5 - rate * (1.0 / 6.0 - rate / 24.0)) } else { 1.0 + (-rate).exp_m1() / rate }
}

/// The law at a point. State: creep gaps c_n and c_t, and slip s.
#[derive(Debug, Clone)]
pub struct CreepingResponse {
    friction: f64,
    normal: KelvinChain,
    shear: KelvinChain,
}

impl InterfaceResponse for CreepingResponse {
    fn state_size(&self) -> usize {
        3
    }

    fn initial_state(&self, state: &mut [f64]) {
        state.fill(0.0);
    }

    fn state_names(&self) -> &'static [&'static str] {
        &["creep_normal [m]", "creep_shear [m]", "slip [m]"]
    }

    #[inline]
    fn respond_point(
        &self,
        gap: [f64; 2],
        context: &PointContext,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<TractionPoint, UpdateFailure> {
        let PointContext { previous_gap: before, time_step, .. } = *context;
        if !gap.iter().chain(&before).chain(old).chain([&time_step]).all(|x| x.is_finite()) {
            return Err(UpdateFailure::NotFinite);
        }
        let (k_n, k_t) = (self.normal.stiffness, self.shear.stiffness);
        let (creep_n, creep_t, slip) = (old[0], old[1], old[2]);
        let normal = self.normal.step(before[0], creep_n, time_step);
        let pressure = -k_n * ((1.0 - normal.by_gap) * gap[0] - normal.fixed);
        if pressure < 0.0 {
            // Open: both chains are unloaded and recover. If the joint closes again, shear starts from zero.
            new[0] = self.normal.recovered(creep_n, time_step);
            new[1] = self.shear.recovered(creep_t, time_step);
            new[2] = gap[1] - new[1];
            let stored = self.normal.stored(new[0], new[0]) + self.shear.stored(new[1], new[1]);
            let lost = |chain: &KelvinChain, old: f64, new: f64| chain.stored(old, old) - chain.stored(new, new);
            let dissipated = lost(&self.normal, creep_n, new[0]) + lost(&self.shear, creep_t, new[1]);
            return Ok(TractionPoint { branch: UpdateBranch::OPEN, stored, dissipated, ..TractionPoint::ZERO });
        }
        let shear = self.shear.step(before[1] - slip, creep_t, time_step);
        let trial = -k_t * ((1.0 - shear.by_gap) * (gap[1] - slip) - shear.fixed);
        let limit = self.friction * pressure;
        let stiffness = [k_n * (1.0 - normal.by_gap), k_t * (1.0 - shear.by_gap)];
        let slides = trial.abs() > limit;
        let (mut traction, mut tangent) = ([pressure, trial], [[-stiffness[0], 0.0], [0.0, -stiffness[1]]]);
        let mut slipped = 0.0;
        if slides {
            let sense = trial.signum();
            // t_t = −k_t ((1 − w) (g_t − s) − c_0) at the limit.
            slipped = -sense * (trial.abs() - limit) / stiffness[1];
            traction[1] = sense * limit;
            tangent[1] = [-sense * self.friction * stiffness[0], 0.0];
        }
        new[2] = slip + slipped;
        new[0] = normal.fixed + normal.by_gap * gap[0];
        new[1] = shear.fixed + shear.by_gap * (gap[1] - new[2]);
        let stored = self.normal.stored(gap[0], new[0]) + self.shear.stored(gap[1] - new[2], new[1]);
        let dissipated = self.normal.dissipated([before[0], gap[0]], creep_n, time_step)
            + self.shear.dissipated([before[1] - slip, gap[1] - new[2]], creep_t, time_step)
            + limit * slipped.abs();
        let branch = if slides { SLIDING } else { UpdateBranch::ELASTIC };
        Ok(TractionPoint { traction, tangent, branch, stored, dissipated, supplied: 0.0 })
    }

    fn outputs(&self, _: [f64; 2], _: &PointContext, state: &[f64], _: &TractionPoint, values: &mut [f64]) {
        values[0] = -state[0];
        values[1] = state[1];
    }
}

const OUTPUTS: &[Output] = &[
    Output::point("creep_closing", "m", "part of the closing of the joint that is creep"),
    Output::point("creep_slip", "m", "part of the tangential gap that is creep"),
    Output::joint("mean_creep_closing", "m", "mean over the length of the joint").mean("creep_closing"),
    Output::joint("mean_creep_slip", "m", "mean over the length of the joint").mean("creep_slip"),
    Output::case("greatest_creep_closing", "m", "greatest closing of all joints by creep").greatest("creep_closing"),
];

/// Without duration the joint is elastic with dry friction.
const KNOWN_PATHS: &[KnownPath] = &[KnownPath {
    table: "friction = 0.5\nnormal_stiffness = 1e10\nshear_stiffness = 5e9\ncreep_coefficient = 2.0\nretardation_time = 1e6",
    source: "by hand: without duration it is dry friction, slip at μ t_n",
    steps: DRY_FRICTION,
    tolerance: 1e-12,
}];

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::InterfaceLaw,
        tag: "creeping_mortar",
        summary: "no tension, friction, and creep in compression and shear during stages with a duration",
        provides: &[Capability::RESPONSE],
        claims: &[Property::DISSIPATIVE],
        samples: &[
            Sample::new("friction = 0.6\nnormal_stiffness = 1e10\nshear_stiffness = 5e9\ncreep_coefficient = 2.0\nretardation_time = 1e6", 1e-4, &["elastic", "sliding"]),
        ],
        known_paths: KNOWN_PATHS,
        outputs: OUTPUTS,
        sources: &[
            "Taylor, Pister & Goudreau 1970, Int. J. Numer. Meth. Engng 2 (exact update of linear viscoelasticity)",
            "Bazant & Wittmann 1982, Creep and Shrinkage in Concrete Structures, Wiley (creep coefficient)",
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("creeping_mortar.md"),
        ..Card::of::<CreepingMortar>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CHAIN: KelvinChain = KelvinChain { stiffness: 1e10, creep: 2.0, retardation: 1e6 };

    fn response() -> CreepingResponse {
        CreepingResponse { friction: 0.5, normal: CHAIN, shear: KelvinChain { stiffness: 4e9, ..CHAIN } }
    }

    /// Relaxation is exact for any step: one step and a hundred steps give the closed form.
    #[test]
    fn relaxation_is_exact_in_one_step_and_in_many() {
        for steps in [1, 100] {
            let (gap, time) = ([-1e-4, 0.0], 7e5);
            let (mut old, mut new, mut last) = ([0.0; 3], [0.0; 3], 0.0);
            for _ in 0..steps {
                let mut context = PointContext::default();
                (context.previous_gap, context.time_step) = (gap, time / f64::from(steps));
                last = response().respond_point(gap, &context, &old, &mut new).unwrap().traction[0];
                old = new;
            }
            let exact = 1e6 / 3.0 * (1.0 + 2.0 * (-3.0_f64 * 0.7).exp());
            assert!((last - exact).abs() < 1e-12 * exact, "{steps} steps: {last} instead of {exact}");
        }
    }

    /// With a gap that is linear in time, work = change of stored energy + dissipation.
    #[test]
    fn the_energy_of_a_linear_gap_is_exact() {
        let (from, to, creep, time) = (-1e-4, -3e-4, -0.5e-4, 4e5);
        let parts = 20_000;
        let (mut work, mut last) = (0.0, creep);
        let at = |part: i32| from + (to - from) * f64::from(part) / f64::from(parts);
        for part in 0..parts {
            let step = CHAIN.step(at(part), last, time / f64::from(parts));
            let next = step.fixed + step.by_gap * at(part + 1);
            work += 0.5 * CHAIN.stiffness * (at(part) - last + at(part + 1) - next) * (at(part + 1) - at(part));
            last = next;
        }
        let step = CHAIN.step(from, creep, time);
        let end = step.fixed + step.by_gap * to;
        let gained = CHAIN.stored(to, end) - CHAIN.stored(from, creep);
        let dissipated = CHAIN.dissipated([from, to], creep, time);
        assert!((end - last).abs() < 1e-12 * end.abs(), "{end} {last}");
        assert!((work - gained - dissipated).abs() < 1e-8 * work, "{work} {gained} {dissipated}");
        assert!(dissipated > 0.0);
    }

    /// The tangent is the derivative of the traction by the gap, in each branch and for steps with a duration.
    #[test]
    fn the_tangent_is_consistent() {
        let mut context = PointContext::default();
        context.previous_gap = [-1e-4, 1e-5];
        for time in [0.0, 1e-2, 1e5, 1e9] {
            context.time_step = time;
            for gap in [[-2e-4, 2e-5], [-2e-4, 1e-3], [-2e-4, -1e-3], [2e-4, 0.0]] {
                let state = [-2e-5, 1e-6, 2e-6];
                let at = |gap| response().respond_point(gap, &context, &state, &mut [0.0; 3]).unwrap();
                for j in 0..2 {
                    let mut ends = [gap, gap];
                    let change = 1e-9;
                    (ends[0][j], ends[1][j]) = (gap[j] - change, gap[j] + change);
                    for i in 0..2 {
                        let slope = (at(ends[1]).traction[i] - at(ends[0]).traction[i]) / (2.0 * change);
                        let off = (slope - at(gap).tangent[i][j]).abs();
                        assert!(off < 1e-5 * 1e10, "{time} {gap:?}: {slope}, not {}", at(gap).tangent[i][j]);
                    }
                }
            }
        }
    }
}
