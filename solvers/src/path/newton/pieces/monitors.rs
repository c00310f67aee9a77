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
use crate::path::newton::model::tractions::at;
use crate::path::newton::quantities::ahead::length_ahead;
use crate::path::newton::quantities::measure::fastest;
use crate::path::newton::solve::tangent::gap_rounding;
use crate::settings::SETTINGS;
use voussoir_core::law::{FacetMode, UpdateBranch};

/// Growth of a length in the search for the end of a branch, and its greatest number of repetitions.
const GROWTH: f64 = 16.0;
const MAX_GROWTHS: usize = 10;
/// Greatest number of bisections between two lengths.
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
    /// Rounding of gaps.
    rounding: f64,
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
            rounding,
            gap: rounding.max(SETTINGS.inequality() * force / rigidity.max(1e-300)).max(of_blocks),
            force_rate: (SETTINGS.active * greatest(&tangent.force).max(1e-6 * gap_rate * u.force / u.displacement))
                .max(gap_rounding * rigidity),
            gap_rate: (SETTINGS.active * gap_rate).max(gap_rounding),
        };
        let mut readings: Vec<Reading> =
            self.0.iter().map(|monitor| monitor.read(system, state, tangent, &sizes)).collect();
        self.read_branches(system, (start, state), tangent, &sizes, &mut readings);
        readings
    }

    /// Reads the branches of laws: the lengths along the rate up to which the laws stay in them, negative where a law has left its
    /// branch (see [`Search`]). The searches of all points go on together, so that each law is asked for all of them at once.
    fn read_branches(
        &self,
        system: &StepSystem,
        (start, state): (&State, &State),
        tangent: &Tangent,
        sizes: &Sizes,
        readings: &mut [Reading],
    ) {
        let (ahead, step) = (length_ahead(system, start), system.instant(start));
        let search = |(monitor, reading)| Search::of(monitor, reading, (state, tangent), sizes, ahead);
        let mut searches: Vec<Search> = self.0.iter().zip(readings).filter_map(search).collect();
        let ask = |searches: &mut [&mut Search], length: fn(&Search) -> f64, then: fn(&mut Search, bool)| {
            let asked: Vec<(usize, [f64; 2])> = searches.iter().map(|s| (s.contact, s.at(length(s)))).collect();
            let points = at(&system.laws.responses, &asked, &start.updates.memory, &step);
            for (search, point) in searches.iter_mut().zip(points) {
                let is_in = point.is_none_or(|point| point.branch == search.branch);
                then(search, is_in);
            }
        };
        // Nearer than the place of the tangents the branch may be rounding, or a point may not have entered it yet.
        let is_new =
            |s: &&mut Search| !std::ptr::eq(start, state) && state.updates.points[s.contact].branch != s.branch;
        let mut new: Vec<&mut Search> = searches.iter_mut().filter(is_new).collect();
        ask(&mut new, |s| s.between[1], |s, is_in| s.sense = if is_in { 1.0 } else { -1.0 });
        // Only the nearest end is needed, and ends next to the state. The others lie beyond the length that was reached.
        let (mut open, mut between): (Vec<&mut Search>, Vec<&mut Search>) = (searches.iter_mut().collect(), Vec::new());
        let mut nearest = f64::INFINITY;
        for _ in 0..MAX_GROWTHS {
            ask(&mut open, |s| s.sense * s.between[1], |s, is_in| s.grow(is_in));
            let (changed, rest): (Vec<&mut Search>, Vec<&mut Search>) = open.into_iter().partition(|s| s.changes);
            between.extend(changed);
            nearest = between.iter().filter(|s| s.sense > 0.0).map(|s| s.between[1]).fold(nearest, f64::min);
            open = rest.into_iter().filter(|s| s.may_be_first(nearest)).collect();
        }
        between.retain(|s| s.may_be_first(nearest));
        for _ in 0..MAX_BISECTIONS {
            ask(&mut between, |s| s.sense * s.middle(), |s, is_in| s.halve(is_in));
            between.retain(|s| !s.is_narrow());
        }
        for search in searches {
            let tolerances = [search.tolerance, 0.0];
            *search.reading =
                Reading { of_branch: true, ..Reading::of(search.sense * search.between[0], Some(-1.0), tolerances) };
        }
    }
}

/// The search for the length along a rate at which the law of a point changes its branch.
struct Search<'a> {
    contact: usize,
    /// The gap and its rate.
    ray: [[f64; 2]; 2],
    branch: UpdateBranch,
    tolerance: f64,
    /// 1 ahead within the branch, −1 behind it.
    sense: f64,
    /// A length up to which nothing changes, and a longer one.
    between: [f64; 2],
    /// Set if the branch changes up to the longer length.
    changes: bool,
    reading: &'a mut Reading,
}

impl<'a> Search<'a> {
    /// Creates the search of a monitor. `None` if the monitor is of another kind or the point rests.
    fn of(
        monitor: &Monitor,
        reading: &'a mut Reading,
        (state, tangent): (&State, &Tangent),
        sizes: &Sizes,
        ahead: f64,
    ) -> Option<Self> {
        let Monitor { contact, what: What::Branch(branch) } = *monitor else { return None };
        let (gap, rate) = (state.gap[contact], tangent.gap[contact]);
        let speed = rate[0].hypot(rate[1]);
        if speed <= sizes.gap_rate {
            return None;
        }
        // In a shorter step the branch that a law names is rounding of its history and of the state.
        let tolerance =
            (sizes.gap.max(SETTINGS.inequality() * gap[0].hypot(gap[1])) / speed).max(SETTINGS.small * ahead);
        let between = [0.0, ahead.max(tolerance)];
        Some(Search { contact, ray: [gap, rate], branch, tolerance, sense: 1.0, between, changes: false, reading })
    }

    fn at(&self, length: f64) -> [f64; 2] {
        let [gap, rate] = self.ray;
        [0, 1].map(|k| gap[k] + length * rate[k])
    }

    fn middle(&self) -> f64 {
        0.5 * (self.between[0] + self.between[1])
    }

    /// Returns true if the end may lie before a length, next to the state, or behind it.
    fn may_be_first(&self, nearest: f64) -> bool {
        self.sense < 0.0 || self.between[0] < nearest.max(SETTINGS.together * self.tolerance)
    }

    fn is_narrow(&self) -> bool {
        let [near, far] = self.between;
        far - near <= (1e-3 * self.tolerance).max(SETTINGS.small * near)
    }

    fn grow(&mut self, is_in: bool) {
        self.changes = is_in != (self.sense > 0.0);
        if !self.changes {
            self.between = [self.between[1], GROWTH * self.between[1]];
        }
    }

    fn halve(&mut self, is_in: bool) {
        let inside = is_in == (self.sense > 0.0);
        self.between[usize::from(!inside)] = self.middle();
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
                let by =
                    self.opening(system, start, tangent, gap_rounding(system, start)).map(|by| by / u.displacement);
                Some(Control::Zero { contact, offset: -dot(by, start.slip[contact]), by_force: [0.0; 2], by_gap: by })
            }
            What::Face { .. } | What::Flow(_) | What::Branch(_) => None,
        }
    }

    /// Returns the opening of a point per unit of its gap. A point whose slip is rounding slips in the sense of the tangent.
    fn opening(&self, system: &StepSystem, state: &State, tangent: &Tangent, rounding: f64) -> [f64; 2] {
        let gap = system.step_gap(state, state, self.contact);
        let has_slipped = gap[1].abs() > SETTINGS.together * rounding;
        let sense = if has_slipped { gap[1] } else { tangent.gap[self.contact][1] }.signum();
        let facets = system.law(self.contact).map_or(&[][..], |law| &law.facets);
        state.mode[self.contact].opening(facets, sense)
    }

    fn read(&self, system: &StepSystem, state: &State, tangent: &Tangent, sizes: &Sizes) -> Reading {
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
                let by = self.opening(system, state, tangent, sizes.rounding);
                Reading::of(dot(by, gap), Some(dot(by, rate)), [sizes.gap, sizes.gap_rate])
            }
            What::Face { forward } => {
                let [low, high] = system.problem.contacts[c].sliding.slip;
                let slip = state.gap[c][1];
                let (value, rate) = if forward { (high - slip, -rate[1]) } else { (slip - low, rate[1]) };
                Reading::of(value, Some(rate), [sizes.gap, sizes.gap_rate])
            }
            What::Flow(k) => Reading::of(mode.unknowns(facets, rate)[k as usize], None, [sizes.gap_rate; 2]),
            // Branches of all points are read together.
            What::Branch(_) => Reading::NEVER,
        }
    }
}
