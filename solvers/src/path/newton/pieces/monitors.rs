//! Monitor functions of a piece: they stay positive as long as the modes of all contact points hold.
//!
//! ```text
//! stick     slack of every facet              b A − a·r ≥ 0
//! facet i   slack of the other facets, and    γ̇_i ≥ 0   (γ_i ≥ 0 for a facet that opens, which is reversible)
//! corner    γ̇ ≥ 0, or γ ≥ 0, of both facets
//! open      opening above the dilated surface ≥ 0
//! ```
//!
//! A point with a law of tractions stays in the branch that the law names. Its monitor is the length along the rate up
//! to the end of the branch, computed with the law itself: the start of softening has no other known function.

use crate::contact::facet::{dot, norm, slack};
use crate::contact::mode::ContactMode;
use crate::path::newton::model::control::Control;
use crate::path::newton::model::state::{State, Tangent};
use crate::path::newton::model::system::StepSystem;
use crate::path::newton::quantities::ahead::length_ahead;
use crate::path::newton::quantities::measure::fastest;
use crate::path::newton::solve::tangent::gap_rounding;
use crate::settings::SETTINGS;
use voussoir_core::law::{FacetMode, UpdateBranch};

/// Greatest number of doublings of a length in the search for the end of a branch.
const MAX_DOUBLINGS: usize = 40;
/// Number of bisections between two of them.
pub(super) const MAX_BISECTIONS: usize = 50;

/// The quantity of a monitor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum What {
    /// Slack of a facet \[N\].
    Slack(u8),
    /// Opening \[m\].
    Opening,
    /// Remaining slip until the point leaves its face, against or along t \[m\].
    Face { forward: bool },
    /// Rate of a multiplier, by its index among the unknowns of the mode \[m\].
    Flow(u8),
    /// Length along the rate up to which a law of tractions stays in this branch.
    Branch(UpdateBranch),
}

/// A monitor of a contact point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Monitor {
    pub contact: usize,
    pub what: What,
}

/// The reading of a monitor at a state.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reading {
    pub value: f64,
    /// Rate along the tangent. `None` if the value is itself a rate.
    pub rate: Option<f64>,
    /// Value up to which it counts as zero.
    pub tolerance: f64,
    /// Rate up to which it counts as zero.
    pub rate_tolerance: f64,
    /// Set for the length up to which a law of tractions stays in its branch.
    pub of_branch: bool,
}

impl Reading {
    /// The reading of a mode that does not end.
    pub const NEVER: Reading = Reading::of(1.0, None, [0.0; 2]);

    /// Creates the reading of a value and its rate, with the tolerances of both.
    const fn of(value: f64, rate: Option<f64>, [tolerance, rate_tolerance]: [f64; 2]) -> Self {
        Reading { value, rate, tolerance, rate_tolerance, of_branch: false }
    }

    /// Returns true if the mode has ended.
    pub fn is_violated(&self) -> bool {
        self.value < -self.tolerance
    }

    /// Returns true if the mode is at its end: symmetric points end theirs within the rounding of a mesh.
    pub fn is_active(&self) -> bool {
        let share = if self.rate.is_some() { SETTINGS.together } else { 1.0 };
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

/// Sizes to which readings are relative.
struct Sizes {
    force: f64,
    gap: f64,
    force_rate: f64,
    gap_rate: f64,
}

impl Monitors {
    /// Creates the monitors of the modes of all contact points and of the branches of laws of tractions.
    pub fn of(system: &StepSystem, state: &State) -> Monitors {
        let mut all = Vec::new();
        for (contact, mode) in state.mode.iter().enumerate() {
            let mut add = |what| all.push(Monitor { contact, what });
            if system.laws.responses.is(contact) {
                add(What::Branch(state.updates.points[contact].branch));
            }
            let Some(law) = system.law(contact) else { continue };
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

    /// Reads all monitors at a state along a tangent, in a step from `start`.
    pub fn read(&self, system: &StepSystem, start: &State, state: &State, tangent: &Tangent) -> Vec<Reading> {
        let greatest = |v: &[[f64; 2]]| v.iter().flatten().fold(0.0, |a: f64, x| a.max(x.abs()));
        let u = system.units();
        let force = greatest(&state.force).max(1e-12 * u.force);
        let rigidity = (0..state.gap.len()).map(|c| system.stiffness(c)).fold(0.0, |a: f64, k| a.max(k[0].max(k[1])));
        let rounding = gap_rounding(system, state);
        // Accuracy of positions in Newton's method on yielding blocks, relative to the displacements.
        let of_blocks = system.limits.position * fastest(system, &state.motion);
        // If a structure moves as a whole, the rates of gaps and forces are rounding errors of its motion.
        let gap_rate = greatest(&tangent.gap);
        let gap_rounding = SETTINGS.rounding * fastest(system, &tangent.motion);
        let sizes = Sizes {
            force: (rounding * rigidity).clamp(SETTINGS.inequality() * force, SETTINGS.mode * force),
            gap: rounding.max(SETTINGS.inequality() * force / rigidity.max(1e-300)).max(of_blocks),
            force_rate: (SETTINGS.active * greatest(&tangent.force).max(1e-6 * gap_rate * u.force / u.displacement))
                .max(gap_rounding * rigidity),
            gap_rate: (SETTINGS.active * gap_rate).max(gap_rounding),
        };
        self.0.iter().map(|monitor| monitor.read(system, (start, state), tangent, &sizes)).collect()
    }
}

impl Monitor {
    /// Returns the control of a state at which the monitor is zero, in a step from `start`. `None` if its value is a rate
    /// or the length up to the end of a branch.
    pub fn control(&self, system: &StepSystem, start: &State, tangent: &Tangent) -> Option<Control> {
        let (contact, u) = (self.contact, system.units());
        let area = system.problem.contacts[contact].area;
        match self.what {
            What::Slack(f) => {
                let facet = &system.law(contact)?.facets[f as usize];
                let unit = norm(facet.normal) * u.force;
                let by_force = facet.normal.map(|a| -a / unit);
                Some(Control::Zero { contact, offset: slack(facet, [0.0; 2], area) / unit, by_force, by_gap: [0.0; 2] })
            }
            What::Opening => {
                let by = self.opening(system, start, tangent).map(|by| by / u.displacement);
                Some(Control::Zero { contact, offset: -dot(by, start.slip[contact]), by_force: [0.0; 2], by_gap: by })
            }
            What::Face { .. } | What::Flow(_) | What::Branch(_) => None,
        }
    }

    /// Returns the opening of a point per unit of its gap. A point whose slip is rounding slips in the sense of the tangent.
    fn opening(&self, system: &StepSystem, state: &State, tangent: &Tangent) -> [f64; 2] {
        let gap = system.step_gap(state, state, self.contact);
        let has_slipped = gap[1].abs() > SETTINGS.together * gap_rounding(system, state);
        let sense = if has_slipped { gap[1] } else { tangent.gap[self.contact][1] }.signum();
        let facets = system.law(self.contact).map_or(&[][..], |law| &law.facets);
        state.mode[self.contact].opening(facets, sense)
    }

    /// Returns the length along a rate up to which the law of a point stays in a branch; negative if it has left it.
    fn read_branch(
        &self,
        system: &StepSystem,
        (start, state): (&State, &State),
        rate: [f64; 2],
        branch: UpdateBranch,
        sizes: &Sizes,
    ) -> Reading {
        let (gap, speed) = (state.gap[self.contact], rate[0].hypot(rate[1]));
        if speed <= sizes.gap_rate {
            return Reading::NEVER;
        }
        let ahead = length_ahead(system, start);
        // In a shorter step the branch that a law names is rounding of its history and of the state.
        let tolerance =
            (sizes.gap.max(SETTINGS.inequality() * gap[0].hypot(gap[1])) / speed).max(SETTINGS.small * ahead);
        let is_in = |length: f64| {
            let there = [0, 1].map(|k| gap[k] + length * rate[k]);
            let said = system.laws.responses.at(self.contact, there, &start.updates.memory, &system.instant(start));
            said.is_none_or(|point| point.branch == branch)
        };
        // Nearer than the place of the tangents the branch may be rounding, or a point may not have entered it yet.
        let mut far = ahead.max(tolerance);
        let at_start = std::ptr::eq(start, state);
        let inside = at_start || state.updates.points[self.contact].branch == branch || is_in(far);
        let sense = if inside { 1.0 } else { -1.0 };
        let mut near = 0.0;
        let changed = (0..MAX_DOUBLINGS).any(|_| {
            let changes = is_in(sense * far) != inside;
            if !changes {
                (near, far) = (far, 2.0 * far);
            }
            changes
        });
        for _ in 0..if changed { MAX_BISECTIONS } else { 0 } {
            let middle = 0.5 * (near + far);
            if is_in(sense * middle) == inside {
                near = middle
            } else {
                far = middle
            }
            if far - near <= (1e-3 * tolerance).max(SETTINGS.small * near) {
                break;
            }
        }
        let value = sense * near;
        Reading { of_branch: true, ..Reading::of(value, Some(-1.0), [tolerance, 0.0]) }
    }

    fn read(&self, system: &StepSystem, (start, state): (&State, &State), tangent: &Tangent, sizes: &Sizes) -> Reading {
        let (c, mode) = (self.contact, state.mode[self.contact]);
        let facets = system.law(c).map_or(&[][..], |law| &law.facets);
        let rate = tangent.gap[c];
        match self.what {
            What::Slack(f) => {
                let facet = &facets[f as usize];
                let unit = norm(facet.normal);
                let value = slack(facet, state.force[c], system.problem.contacts[c].area) / unit;
                let rate = -dot(facet.normal, tangent.force[c]) / unit;
                Reading::of(value, Some(rate), [sizes.force, sizes.force_rate])
            }
            What::Opening => {
                let gap = system.step_gap(state, state, c);
                let by = self.opening(system, state, tangent);
                Reading::of(dot(by, gap), Some(dot(by, rate)), [sizes.gap, sizes.gap_rate])
            }
            What::Face { forward } => {
                let [low, high] = system.problem.contacts[c].sliding.slip;
                let slip = state.gap[c][1];
                let (value, rate) = if forward { (high - slip, -rate[1]) } else { (slip - low, rate[1]) };
                Reading::of(value, Some(rate), [sizes.gap, sizes.gap_rate])
            }
            What::Flow(k) => Reading::of(mode.unknowns(facets, rate)[k as usize], None, [sizes.gap_rate; 2]),
            What::Branch(branch) => self.read_branch(system, (start, state), rate, branch, sizes),
        }
    }
}
