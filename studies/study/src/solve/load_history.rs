//! Load and displacement of all states of a path, and data of each limit point: the energy that a dead load would release
//! there, and the next state at the same load.

use crate::results::NextState;
use voussoir_core::path::{LoadStep, LoadStepEnd, PathProblem, PathState, ProvenPeak};

/// Relative difference up to which two factors, or two displacements, count as equal.
const SAME: f64 = 1e-9;

/// A state of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    /// Index of the load step.
    pub load_step: usize,
    /// Load factor λ.
    pub factor: f64,
    /// Work-conjugate displacement of the load \[m\].
    pub displacement: f64,
    /// Stability under the loads, if it was examined.
    pub stable_under_load: Option<bool>,
}

/// The states of a path in order.
#[derive(Debug, Default)]
pub(super) struct LoadHistory {
    places: Vec<Place>,
}

/// Data of a limit point from the states of its path.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct AfterLimitPoint {
    /// ∫ (λ_limit − λ) p·dq from the limit point until the load has returned, or to the end of the path \[J\]. `None` if the path
    /// ends there or the stage moves supports.
    pub released_energy: Option<f64>,
    /// The next state at the same load that is not known to be unstable under it.
    pub next_state: Option<NextState>,
}

impl LoadHistory {
    /// Adds the next state.
    pub fn add(&mut self, state: &PathState) {
        let PathState { load_step, factor, displacement, stable_under_load, .. } = *state;
        self.places.push(Place { load_step, factor, displacement, stable_under_load });
    }

    /// Returns the last state.
    pub fn last(&self) -> Option<&Place> {
        self.places.last()
    }

    /// Returns the greatest displacement of the load in a load step \[m\].
    pub fn moved(&self, load_step: usize) -> f64 {
        let own = || self.places.iter().filter(|at| at.load_step == load_step).map(|at| at.displacement);
        let start = own().next().unwrap_or(0.0);
        own().fold(0.0, |most, displacement| (displacement - start).abs().max(most))
    }

    /// Returns the data after each of these limit points, which are in the order of the path.
    pub fn after(&self, limit_points: &[ProvenPeak], problem: &PathProblem) -> Vec<AfterLimitPoint> {
        let (mut load_step, mut from) = (None, 0);
        let one = |peak: &ProvenPeak| {
            if load_step.replace(peak.load_step) != Some(peak.load_step) {
                from = 0;
            }
            let step = &problem.load_steps[peak.load_step];
            let places: Vec<Place> = self.places.iter().filter(|at| at.load_step == peak.load_step).copied().collect();
            let curve = Curve { places: &places, sense: sense(step) };
            let Some(at) = curve.beyond(peak, from) else { return AfterLimitPoint::default() };
            from = at;
            let released = curve.released(peak, at) * problem.load_size(&step.loading);
            AfterLimitPoint {
                released_energy: step.loading.settlements.is_empty().then_some(released),
                next_state: curve.next_state(peak, at),
            }
        };
        limit_points.iter().map(one).collect()
    }
}

/// Returns 1 if the factor of a load step grows, −1 if it decreases.
fn sense(step: &LoadStep) -> f64 {
    match step.end {
        LoadStepEnd::Factor(end) if end < step.start => -1.0,
        _ => 1.0,
    }
}

/// The states of one load step.
struct Curve<'a> {
    places: &'a [Place],
    sense: f64,
}

impl Curve<'_> {
    /// Returns the difference between a limit point and a lower state.
    fn below(&self, peak: &ProvenPeak, at: &Place) -> f64 {
        (peak.factor - at.factor) * self.sense
    }

    /// Returns the index of the first state below a limit point and beyond it, searched from an index on. The limit point is
    /// between two states that are not above it, and one of them is a maximum of the states.
    fn beyond(&self, peak: &ProvenPeak, from: usize) -> Option<usize> {
        let slack = SAME * peak.factor.abs();
        let heights: Vec<f64> = self.places.iter().map(|at| -self.below(peak, at)).collect();
        let highest = |at: usize| {
            let near = [at.checked_sub(1), Some(at + 1)];
            near.into_iter().flatten().filter_map(|near| heights.get(near)).all(|height| *height <= heights[at] + slack)
        };
        let holds = |at: usize| {
            let [before, after] = [at - 1, at].map(|at| self.places[at].displacement);
            let room = 0.5 * (after - before).abs() + SAME * before.abs().max(after.abs());
            let between = (before.min(after) - room..=before.max(after) + room).contains(&peak.displacement);
            let below = heights[at] <= slack && heights[at - 1] <= slack;
            below && between && (highest(at - 1) || highest(at))
        };
        let top = (from.max(1)..self.places.len()).find(|at| holds(*at))?;
        (top..self.places.len()).find(|at| heights[*at] < -slack)
    }

    /// Returns ∫ (λ_limit − λ) dδ from a limit point until the load has returned, by the trapezoidal rule.
    fn released(&self, peak: &ProvenPeak, at: usize) -> f64 {
        let (mut height, mut place, mut area) = (0.0, peak.displacement, 0.0);
        for next in &self.places[at..] {
            let below = self.below(peak, next);
            let share = if below < 0.0 { height / (height - below) } else { 1.0 };
            let reached = place + share * (next.displacement - place);
            area += 0.5 * (height + below.max(0.0)) * (reached - place);
            if below <= 0.0 {
                break;
            }
            (height, place) = (below, next.displacement);
        }
        area * self.sense
    }

    /// Returns the first state that returns to the load of a limit point and is not known to be unstable.
    fn next_state(&self, peak: &ProvenPeak, at: usize) -> Option<NextState> {
        self.places[at..].windows(2).find_map(|pair| {
            let [before, after] = [self.below(peak, &pair[0]), self.below(peak, &pair[1])];
            let stable_under_load = pair[1].stable_under_load;
            let returns = before > 0.0 && after <= 0.0 && stable_under_load != Some(false);
            let share = before / (before - after);
            let displacement = pair[0].displacement + share * (pair[1].displacement - pair[0].displacement);
            returns.then_some(NextState { displacement, stable_under_load })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use voussoir_core::limit::Counters;
    use voussoir_core::model::geometry::Vec2;
    use voussoir_core::path::{Loading, Period};

    /// One load step of 10 N towards a factor.
    fn problem(end: LoadStepEnd, settlements: Vec<(usize, [f64; 3])>) -> PathProblem {
        let forces = vec![(0, None, Vec2::zeros(), Vec2::new(10.0, 0.0))];
        let loading = Loading { forces, settlements, ..Loading::default() };
        PathProblem {
            bodies: Vec::new(),
            body_of: Vec::new(),
            contacts: Vec::new(),
            load_steps: vec![LoadStep {
                stage: 0,
                gravity: false,
                loading,
                start: 0.0,
                end,
                period: Period::default(),
            }],
            length: 1.0,
            span: 1.0,
            counters: Counters::new(),
            width: 1.0,
        }
    }

    /// States of a path: displacement, factor.
    fn history(states: &[[f64; 2]]) -> LoadHistory {
        let place =
            |&[displacement, factor]: &[f64; 2]| Place { load_step: 0, factor, displacement, stable_under_load: None };
        LoadHistory { places: states.iter().map(place).collect() }
    }

    fn peak(displacement: f64, factor: f64) -> ProvenPeak {
        ProvenPeak { load_step: 0, factor, displacement, lowest: factor }
    }

    const SEARCH: LoadStepEnd = LoadStepEnd::Collapse(f64::INFINITY);
    /// Rises to 4, falls to 2 and rises to 6.
    const SNAPS: [[f64; 2]; 5] = [[0.0, 0.0], [1.0, 4.0], [2.0, 2.0], [3.0, 3.0], [5.0, 7.0]];

    #[test]
    fn a_dead_load_releases_the_area_between_its_factor_and_the_path() {
        let after = history(&SNAPS).after(&[peak(1.0, 4.0)], &problem(SEARCH, Vec::new()));
        // Two triangles and a trapezium: 1 + 1.5 + 0.25, times 10 N.
        assert!((after[0].released_energy.expect("an energy") - 27.5).abs() < 1e-12);
        assert_eq!(after[0].next_state, Some(NextState { displacement: 3.5, stable_under_load: None }));
    }

    #[test]
    fn a_limit_point_between_two_states_counts_from_its_own_place() {
        let after = history(&[[0.0, 0.0], [1.0, 3.5], [3.0, 3.0], [4.0, 5.0]]);
        let after = after.after(&[peak(2.0, 4.0)], &problem(SEARCH, Vec::new()));
        assert!((after[0].released_energy.expect("an energy") - 7.5).abs() < 1e-12);
        assert_eq!(after[0].next_state.map(|next| next.displacement), Some(3.5));
    }

    #[test]
    fn a_load_that_does_not_come_back_releases_energy_up_to_the_end_of_the_path() {
        let after = history(&SNAPS[..3]).after(&[peak(1.0, 4.0)], &problem(SEARCH, Vec::new()));
        assert_eq!(after[0], AfterLimitPoint { released_energy: Some(10.0), next_state: None });
    }

    #[test]
    fn a_path_that_ends_at_its_limit_point_says_nothing_of_what_follows() {
        let after = history(&SNAPS[..2]).after(&[peak(1.0, 4.0)], &problem(SEARCH, Vec::new()));
        assert_eq!(after[0], AfterLimitPoint::default());
    }

    #[test]
    fn the_next_state_is_not_one_that_is_proved_unstable() {
        let mut unstable = history(&SNAPS);
        unstable.places[4].stable_under_load = Some(false);
        assert_eq!(unstable.after(&[peak(1.0, 4.0)], &problem(SEARCH, Vec::new()))[0].next_state, None);
        // The load falls and returns again, to a stable state.
        for (place, stable) in [([6.0, 3.0], None), ([7.0, 5.0], Some(true))] {
            let [displacement, factor] = place;
            unstable.places.push(Place { load_step: 0, factor, displacement, stable_under_load: stable });
        }
        let next = unstable.after(&[peak(1.0, 4.0)], &problem(SEARCH, Vec::new()))[0].next_state;
        assert_eq!(next, Some(NextState { displacement: 6.5, stable_under_load: Some(true) }));
    }

    #[test]
    fn a_factor_that_goes_down_snaps_alike() {
        let mirrored: Vec<[f64; 2]> = SNAPS.iter().map(|[displacement, factor]| [-displacement, -factor]).collect();
        let end = LoadStepEnd::Factor(-10.0);
        let after = history(&mirrored).after(&[peak(-1.0, -4.0)], &problem(end, Vec::new()));
        assert!((after[0].released_energy.expect("an energy") - 27.5).abs() < 1e-12);
        assert_eq!(after[0].next_state.map(|next| next.displacement), Some(-3.5));
    }

    #[test]
    fn supports_that_move_release_no_energy_of_a_load() {
        let moves = vec![(0, [0.1, 0.0, 0.0])];
        let after = history(&SNAPS).after(&[peak(1.0, 4.0)], &problem(SEARCH, moves));
        assert_eq!(after[0].released_energy, None);
    }

    #[test]
    fn each_limit_point_has_its_own_fall() {
        let states = [[0.0, 0.0], [1.0, 4.0], [2.0, 2.0], [3.0, 4.0], [4.0, 1.0], [6.0, 5.0]];
        let after = history(&states).after(&[peak(1.0, 4.0), peak(3.0, 4.0)], &problem(SEARCH, Vec::new()));
        let next: Vec<f64> = after.iter().filter_map(|after| Some(after.next_state?.displacement)).collect();
        assert_eq!(next, [3.0, 5.5]);
    }

    #[test]
    fn the_load_moves_as_far_as_its_farthest_state() {
        assert_eq!(history(&[[1.0, 0.0], [4.0, 1.0], [2.0, 2.0]]).moved(0), 3.0);
    }
}
