//! Monitor functions of a piece: what must stay positive for the modes of all contact points to hold.
//!
//! ```text
//! stick     slack of every facet              b A − a·r ≥ 0
//! facet i   slack of the other facets, and    γ̇_i ≥ 0   (γ_i ≥ 0 for a facet that opens, which is reversible)
//! corner    γ̇ ≥ 0, or γ ≥ 0, of both facets
//! open      opening above the dilated surface ≥ 0
//! ```

use super::super::measure::fastest;
use super::super::state::{State, Tangent};
use super::super::system::StepSystem;
use super::super::tangent::{ALLOWED, gap_rounding};
use crate::contact::facet::{dot, norm, slack};
use crate::contact::mode::ContactMode;
use voussoir_core::law::FacetMode;

/// Value of a force monitor, relative to the greatest force, up to which it counts as zero.
const FORCE: f64 = 1e-10;
/// The same of a rate, relative to the greatest rate of its kind.
const RATE: f64 = 1e-8;

/// Rate of a gap, relative to the greatest motion, that is rounding.
const ROUNDING: f64 = 1e-13;

/// Value, relative to the tolerance, up to which a monitor takes part in an event.
const ACTIVE: f64 = 100.0;

/// What a monitor reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum What {
    /// Slack of a facet \[N\].
    Slack(u8),
    /// Opening \[m\].
    Opening,
    /// Slip that is left until the point leaves its face, against or along t \[m\].
    Face { forward: bool },
    /// Rate of a multiplier, by its number among the unknowns of the mode \[m\].
    Flow(u8),
}

/// A monitor of a contact point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Monitor {
    pub contact: usize,
    pub what: What,
}

/// What a monitor reads at a state.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reading {
    pub value: f64,
    /// Rate along the tangent. `None` if the value is itself a rate.
    pub rate: Option<f64>,
    /// Value up to which it counts as zero.
    pub tolerance: f64,
    /// Rate up to which it counts as zero.
    pub rate_tolerance: f64,
}

impl Reading {
    /// Returns true if the mode has ended.
    pub fn is_violated(&self) -> bool {
        self.value < -self.tolerance
    }

    /// Returns true if the mode is at its end: points of a symmetric scene end theirs within the rounding of its mesh.
    pub fn is_active(&self) -> bool {
        let share = if self.rate.is_some() { ACTIVE } else { 1.0 };
        self.value <= share * self.tolerance
    }

    /// Returns true if a rate that starts here leaves the mode at once.
    pub fn leaves(&self) -> bool {
        match self.rate {
            None => self.is_violated(),
            Some(rate) => self.is_active() && rate < -self.rate_tolerance,
        }
    }
}

/// The monitors of some modes.
#[derive(Debug, Clone, Default)]
pub(super) struct Monitors(pub Vec<Monitor>);

/// Sizes that readings are compared with.
struct Sizes {
    force: f64,
    gap: f64,
    force_rate: f64,
    gap_rate: f64,
}

impl Monitors {
    /// Of the modes of all contact points.
    pub fn of(system: &StepSystem, modes: &[ContactMode]) -> Monitors {
        let mut all = Vec::new();
        for (contact, mode) in modes.iter().enumerate() {
            let Some(law) = system.law(contact) else { continue };
            let mut add = |what| all.push(Monitor { contact, what });
            let opens = |f: u8| law.facets[f as usize].mode == FacetMode::Opening;
            let own = |f: u8, k: u8| if opens(f) { What::Opening } else { What::Flow(k) };
            let facets = 0..law.facets.len() as u8;
            let [low, high] = system.problem.contacts[contact].sliding.slip;
            let faces = |add: &mut dyn FnMut(What)| {
                let bounds = [(low, false), (high, true)].into_iter().filter(|(bound, _)| bound.is_finite());
                bounds.for_each(|(_, forward)| add(What::Face { forward }));
            };
            match *mode {
                ContactMode::Stick => facets.for_each(|f| add(What::Slack(f))),
                ContactMode::Facet(i) => {
                    if !opens(i) {
                        faces(&mut add);
                    }
                    add(own(i, 0));
                    facets.filter(|f| *f != i).for_each(|f| add(What::Slack(f)));
                }
                ContactMode::Corner(i, j) => {
                    if !(opens(i) && opens(j)) {
                        faces(&mut add);
                    }
                    add(own(i, 0));
                    add(own(j, 1));
                }
                ContactMode::Open => add(What::Opening),
            }
        }
        Monitors(all)
    }

    /// What all of them read at a state along a tangent.
    pub fn read(&self, system: &StepSystem, state: &State, tangent: &Tangent) -> Vec<Reading> {
        let greatest = |v: &[[f64; 2]]| v.iter().flatten().fold(0.0, |a: f64, x| a.max(x.abs()));
        let u = system.units();
        let force = greatest(&state.force).max(1e-12 * u.force);
        let rigidity = (0..state.gap.len()).map(|c| system.stiffness(c)).fold(0.0, |a: f64, k| a.max(k[0].max(k[1])));
        let rounding = gap_rounding(system, state);
        // A structure that moves as a whole has gaps and forces whose rates are the rounding of its motion.
        let gap_rate = greatest(&tangent.gap);
        let gap_rounding = ROUNDING * fastest(system, &tangent.motion);
        let sizes = Sizes {
            force: (rounding * rigidity).clamp(FORCE * force, ALLOWED * force),
            gap: rounding.max(FORCE * force / rigidity.max(1e-300)),
            force_rate: (RATE * greatest(&tangent.force).max(1e-6 * gap_rate * u.force / u.displacement))
                .max(gap_rounding * rigidity),
            gap_rate: (RATE * gap_rate).max(gap_rounding),
        };
        self.0.iter().map(|monitor| monitor.read(system, state, tangent, &sizes)).collect()
    }
}

impl Monitor {
    fn read(&self, system: &StepSystem, state: &State, tangent: &Tangent, sizes: &Sizes) -> Reading {
        let (c, mode) = (self.contact, state.mode[self.contact]);
        let facets = system.law(c).map_or(&[][..], |law| &law.facets);
        let rate = tangent.gap[c];
        match self.what {
            What::Slack(f) => {
                let facet = &facets[f as usize];
                let unit = norm(facet.normal);
                Reading {
                    value: slack(facet, state.force[c], system.problem.contacts[c].area) / unit,
                    rate: Some(-dot(facet.normal, tangent.force[c]) / unit),
                    tolerance: sizes.force,
                    rate_tolerance: sizes.force_rate,
                }
            }
            What::Opening => {
                let gap = system.step_gap(state, state, c);
                let sense = if gap[1] == 0.0 { rate[1] } else { gap[1] }.signum();
                let by = mode.opening(facets, sense);
                Reading {
                    value: dot(by, gap),
                    rate: Some(dot(by, rate)),
                    tolerance: sizes.gap,
                    rate_tolerance: sizes.gap_rate,
                }
            }
            What::Face { forward } => {
                let [low, high] = system.problem.contacts[c].sliding.slip;
                let slip = state.gap[c][1];
                let (value, rate) = if forward { (high - slip, -rate[1]) } else { (slip - low, rate[1]) };
                Reading { value, rate: Some(rate), tolerance: sizes.gap, rate_tolerance: sizes.gap_rate }
            }
            What::Flow(k) => Reading {
                value: mode.unknowns(facets, rate)[k as usize],
                rate: None,
                tolerance: sizes.gap_rate,
                rate_tolerance: sizes.gap_rate,
            },
        }
    }
}
