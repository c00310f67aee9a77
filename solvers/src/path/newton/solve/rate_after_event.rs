//! The limit point test: finds out if a rate with growing λ starts at a converged state (small displacements).
//!
//! Points with slack in all facets stay stuck; open points without strength stay open. The other points are the active
//! set. With these points stuck, equilibrium and elasticity are one factorisation, which gives the rate problem
//! ṙ = S ġ + s λ̇ over them ([`rate::problem`](crate::rate::problem)). Branching finds a rate with λ̇ = 1 or proves that none
//! exists.

use super::tangent::tangent_from;
use crate::contact::active_point::{ActivePoint, complete_corners};
use crate::contact::facet::slack;
use crate::contact::mode::ContactMode;
use crate::linear::{inner, largest};
use crate::path::newton::model::equations::Equations;
use crate::path::newton::model::state::{State, Tangent};
use crate::path::newton::model::system::StepSystem;
use crate::path::newton::quantities::response::traction_row;
use crate::path::twins::favoured;
use crate::rate::answer::{Budget, Continuation, answer};
use crate::rate::arrival::{Arrival, ArrivalPoint};
use crate::rate::counts::RateCounts;
use crate::rate::problem::{Rate, RateProblem};
use crate::rate::tree::{Searched, search_some};
use crate::settings::SETTINGS;
use nalgebra::{DMatrix, DVector};
use voussoir_core::law::FacetMode;
use voussoir_core::linear::{Entries, SparseLu};

/// Greatest number of leaves of a search.
const MAX_LEAVES: usize = 20_000;

/// The active set of a state.
pub struct ActiveSet {
    /// Contact points.
    pub contacts: Vec<usize>,
    /// Facets of each point without slack, and the opening facet if it is open with a strength.
    pub facets: Vec<(Vec<usize>, Option<usize>)>,
    /// Modes of all points; points of the active set are stuck.
    modes: Vec<ContactMode>,
}

/// The result of the test.
pub enum LimitPointTest {
    /// No rate with growing λ exists.
    None,
    /// A rate with growing λ, with its modes.
    Tangent(Tangent, Vec<ContactMode>),
    /// Undecided, with the reason.
    Unknown(String),
}

/// Searches for a rate with λ growing in the sense `direction` at a converged state, or proves that none exists.
pub fn limit_point_test(system: &mut StepSystem, state: &State, direction: f64) -> LimitPointTest {
    let active = active_set(system, state, &[]);
    let count: usize = active.facets.iter().map(|(facets, _)| facets.len()).sum();
    system.count("factorisations", 1);
    let equations = system.equations(state);
    let Some(responses) = responses_of(system, state, &active, &equations, direction) else {
        return LimitPointTest::Unknown(format!("the stiffness of {count} facets of the active set was not found"));
    };
    let mut programs = 0;
    let Searched { rates, open, .. } =
        search_some(&rate_problem(system, &active, &responses), 1.0, (MAX_LEAVES, 0), &mut programs);
    system.count("rate_programs", programs);
    match (rates.into_iter().next(), open) {
        (Some(rate), _) => {
            let x = unknowns_of(&responses, &rate.gaps, 1.0, direction);
            let modes = modes_of(system, &active, rate.modes);
            LimitPointTest::Tangent(tangent_from(system, &x, state, &equations), modes)
        }
        (None, Some(why)) => {
            LimitPointTest::Unknown(format!("{count} facets of the active set may let the load grow: {why}"))
        }
        (None, None) => LimitPointTest::None,
    }
}

/// The continuation of a path after an event.
pub enum AfterEvent {
    /// A rate with its modes.
    Goes {
        rate: Tangent,
        modes: Vec<ContactMode>,
        /// Number of other rates that the rule does not distinguish from it.
        twins: usize,
        /// Set if it is proved that no rate has a growing factor.
        none_rises: bool,
    },
    /// It is proved that no rate continues the path, so `none_rises` holds.
    Nothing,
    /// Undecided, with the reason; true if it is proved that no rate has a growing factor.
    Unknown(String, bool),
}

/// The contact points of an event.
#[derive(Debug, Default)]
pub struct EventPoints {
    /// All points.
    pub all: Vec<usize>,
    /// Points whose slip ends.
    pub stopping: Vec<usize>,
    /// Points that close.
    pub closing: Vec<usize>,
}

/// Finds the rate that continues a path after an event. `direction`: the sense in which the factor should grow;
/// `sense`: 1 if it has grown up to the event, 0 if it was constant, −1 if it fell.
pub fn rate_after_event(
    system: &mut StepSystem,
    state: &State,
    event: &EventPoints,
    (direction, sense): (f64, f64),
) -> AfterEvent {
    let active = active_set(system, state, &event.closing);
    system.count("factorisations", 1);
    let equations = system.equations(state);
    let Some(responses) = responses_of(system, state, &active, &equations, direction) else {
        return AfterEvent::Unknown("the stiffness of the active set was not found".into(), false);
    };
    let mut problem = rate_problem(system, &active, &responses);
    let load = responses[2 * active.contacts.len()].iter().zip(&equations.factor);
    problem.load_flexibility = load.map(|(x, p)| x * p * direction).sum();
    problem.settles = system.settles();
    problem.metric = Some(metric(system, &responses));
    let point = |c: &usize| ArrivalPoint {
        mode: state.mode[*c],
        hit: event.all.contains(c),
        stops: event.stopping.contains(c),
        force: state.force[*c],
    };
    let arrival = Arrival::new(sense, active.contacts.iter().map(point), largest_force(state));
    let mut counts = RateCounts::default();
    let found = answer(&problem, &arrival, &Budget::default(), &mut counts);
    drop(problem);
    system.count("rate_combinations", counts.trials);
    let none_rises = found.none_rises.is_some();
    match found.continuation {
        Continuation::Goes { rate, twins } => {
            let others = twins.len();
            let tangent = |rate: &Rate| {
                let x = unknowns_of(&responses, &rate.gaps, rate.factor, direction);
                tangent_from(system, &x, state, &equations)
            };
            let mut rates: Vec<Rate> = std::iter::once(rate).chain(twins).collect();
            let mut tangents: Vec<Tangent> = rates.iter().map(tangent).collect();
            let motions: Vec<&[[f64; 3]]> = tangents.iter().map(|tangent| &tangent.motion[..]).collect();
            let chosen = favoured(system.problem, system.loads.earlier.len(), &motions);
            let (rate, modes) = (tangents.swap_remove(chosen), rates.swap_remove(chosen).modes);
            let modes = modes_of(system, &active, modes);
            AfterEvent::Goes { rate, modes, twins: others, none_rises }
        }
        Continuation::NoneContinues(_) => AfterEvent::Nothing,
        Continuation::Open(why) => AfterEvent::Unknown(why, none_rises),
    }
}

/// Returns the products of the motions for unit gap rates and, last, of motions and factor for λ̇ = 1.
fn metric(system: &StepSystem, responses: &[Vec<f64>]) -> DMatrix<f64> {
    let first = 2 * system.scaled.contacts;
    let n = responses.len();
    let own = |i: usize, j: usize| if i == n - 1 && j == n - 1 { 1.0 } else { 0.0 };
    DMatrix::from_fn(n, n, |i, j| inner(&responses[i][first..], &responses[j][first..]) + own(i, j))
}

/// Returns the unknowns of a rate from its gap rates over the active set and λ̇ in the sense `direction`.
fn unknowns_of(responses: &[Vec<f64>], gaps: &[[f64; 2]], factor: f64, direction: f64) -> Vec<f64> {
    let mut x = without_factor(responses, gaps, factor);
    x.push(factor * direction);
    x
}

/// Returns the same unknowns without λ; λ̇ = 0 means a held load.
pub fn without_factor(responses: &[Vec<f64>], gaps: &[[f64; 2]], factor: f64) -> Vec<f64> {
    let mut x: Vec<f64> = responses[2 * gaps.len()].iter().map(|x| factor * x).collect();
    for (by, gap) in responses.iter().zip(gaps.as_flattened()) {
        x.iter_mut().zip(by).for_each(|(x, by)| *x += gap * by);
    }
    x
}

/// Returns the modes of all points from those of the active set.
fn modes_of(system: &StepSystem, active: &ActiveSet, modes: Vec<ContactMode>) -> Vec<ContactMode> {
    let mut all = active.modes.clone();
    active.contacts.iter().zip(modes).for_each(|(c, mode)| all[*c] = normalised(system, *c, mode));
    all
}

/// Returns the mode of a corner, which is the same for all pairs of its facets.
pub fn normalised(system: &StepSystem, contact: usize, mode: ContactMode) -> ContactMode {
    match mode {
        ContactMode::Corner(i, j) => {
            system.law(contact).and_then(|law| law.mode_of_pair(i as usize, j as usize)).unwrap_or(mode)
        }
        other => other,
    }
}

/// Returns the points that may change their modes: without slack, at the tip of opening, or closing.
pub fn active_set(system: &StepSystem, state: &State, closing: &[usize]) -> ActiveSet {
    let mut active = ActiveSet { contacts: Vec::new(), facets: Vec::new(), modes: state.mode.clone() };
    let largest = largest_force(state);
    for c in 0..active.modes.len() {
        let Some((facets, open)) = active_facets(system, state, c, (largest, closing.contains(&c))) else { continue };
        active.modes[c] = ContactMode::Stick;
        if !facets.is_empty() || open.is_some() {
            active.contacts.push(c);
            active.facets.push((facets, open));
        }
    }
    active
}

pub fn largest_force(state: &State) -> f64 {
    state.force.iter().flatten().fold(0.0, |a: f64, r| a.max(r.abs()))
}

/// Returns the facets of a contact point without slack, and its opening facet if it is open and may carry a force.
/// `None` if it stays open without a force, or has no facets.
pub fn active_facets(
    system: &StepSystem,
    state: &State,
    contact: usize,
    (largest, closes): (f64, bool),
) -> Option<(Vec<usize>, Option<usize>)> {
    let law = system.law(contact)?;
    let (area, r) = (system.problem.contacts[contact].area, state.force[contact]);
    let (_, opening) = law.irreversible(state.mode[contact], system.step_gap(state, state, contact));
    let is_open =
        !closes && law.opens(state.mode[contact]) && opening > SETTINGS.admissible * system.units().displacement;
    if is_open && state.mode[contact] == ContactMode::Open {
        return None;
    }
    let open = (0..law.facets.len()).find(|i| is_open && law.facets[*i].mode == FacetMode::Opening);
    let tight = |i: &usize| slack(&law.facets[*i], r, area) <= SETTINGS.active * largest;
    let mut active = (0..law.facets.len()).filter(tight).collect();
    complete_corners(&law.facets, &mut active);
    Some((active, open))
}

/// Returns the rates of all unknowns except λ for a unit gap rate in each of the two directions of every point of the
/// active set and, last, for λ̇ in the sense `direction`. `None` if linear algebra fails. The factors of steps do not
/// serve: their added terms are greater, so that the combinations of modes of a softening block are decided by rounding.
pub fn responses_of(
    system: &StepSystem,
    state: &State,
    active: &ActiveSet,
    equations: &Equations,
    direction: f64,
) -> Option<Vec<Vec<f64>>> {
    let size = system.size() - 1;
    let forces = equations.gaps.len();
    // −∂/∂λ of gaps and balance.
    let driven = |row: &[(usize, f64)]| -> f64 { row.iter().filter(|e| e.0 == size).map(|e| -direction * e.1).sum() };
    let (mut entries, mut shift): (Entries, Entries) = (Vec::new(), Vec::new());
    let mut right = vec![0.0; size];
    let add = |i: usize, row: &[(usize, f64)], by: f64, entries: &mut Entries| {
        entries.extend(row.iter().filter(|e| e.0 < size).map(|&(j, v)| (i, j, by * v)));
    };
    for (c, mode) in active.modes.iter().enumerate() {
        let gap: [Vec<(usize, f64)>; 2] = [0, 1].map(|k| equations.gaps.row(2 * c + k).collect());
        let law = system.law(c).map_or(&[][..], |law| &law.facets);
        let rows = if system.laws.responses.is(c) { traction_rows(system, state, c) } else { mode.rows(law)? };
        for (k, own) in rows.into_iter().enumerate() {
            let i = 2 * c + k;
            entries.extend((0..2).filter(|t| own[*t] != 0.0).map(|t| (i, 2 * c + t, own[t])));
            for t in (0..2).filter(|t| own[2 + t] != 0.0) {
                add(i, &gap[t], own[2 + t], &mut entries);
                right[i] += own[2 + t] * driven(&gap[t]);
            }
            if *mode == ContactMode::Stick && !system.laws.responses.is(c) {
                shift.push((i, i, SETTINGS.shift()));
            }
        }
    }
    for row in 0..equations.bodies.len() {
        let (i, own) = (forces + row, equations.bodies.row(row));
        add(i, own, 1.0, &mut entries);
        right[i] = driven(own);
        shift.push((i, i, -SETTINGS.shift()));
    }
    let unit = |i: usize| (0..size).map(|j| f64::from(u8::from(i == j))).collect();
    let mut all: Vec<Vec<f64>> = active.contacts.iter().flat_map(|c| [2 * c, 2 * c + 1]).map(unit).collect();
    all.push(right);
    let x = SparseLu::shifted(size, &entries, &shift)?.solve(&all, 3)?;
    for (x, right) in x.iter().zip(&all) {
        let (mut rest, mut parts) = (right.clone(), 0.0f64);
        for &(i, j, v) in &entries {
            rest[i] -= v * x[j];
            parts = parts.max((v * x[j]).abs());
        }
        if rest.iter().any(|r| r.is_nan() || r.abs() > SETTINGS.admissible * parts) {
            return None;
        }
    }
    Some(x)
}

/// Returns the rows [by force, by gap] of a contact point with a law of tractions from gaps: dr + K dg = 0, scaled.
fn traction_rows(system: &StepSystem, state: &State, contact: usize) -> [[f64; 4]; 2] {
    let (own, stiffness) = traction_row(system, state, contact);
    [[own[0], 0.0, stiffness[0][0], stiffness[0][1]], [0.0, own[1], stiffness[1][0], stiffness[1][1]]]
}

pub fn rate_problem<'s>(system: &'s StepSystem, active: &ActiveSet, responses: &[Vec<f64>]) -> RateProblem<'s> {
    let n = 2 * active.contacts.len();
    let force = |i: usize, x: &[f64]| x[2 * active.contacts[i / 2] + i % 2];
    let point = |(c, (facets, open)): (&usize, &(Vec<usize>, Option<usize>))| {
        let law = system.law(*c).map_or(&[][..], |law| &law.facets);
        ActivePoint {
            facets: law,
            active: facets.clone(),
            open: *open,
            apex: open.is_none() && ActivePoint::is_apex(law, facets),
            guess: ContactMode::Stick,
            stiffness: 1.0,
        }
    };
    RateProblem {
        points: active.contacts.iter().zip(&active.facets).map(point).collect(),
        s: DMatrix::from_fn(n, n, |i, j| force(i, &responses[j])),
        load_rate: DVector::from_fn(n, |i, _| force(i, &responses[n])),
        load_force: largest(&responses[n][..2 * system.scaled.contacts]),
        load_flexibility: 0.0,
        metric: None,
        settles: false,
    }
}
