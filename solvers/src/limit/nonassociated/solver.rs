//! The solver `limit_least`: local search for the least state, then a proof that no lower state exists.

use super::bracket::{Proof, Work, at_once, dissipations, in_parts, state_at};
use super::curve::Curve;
use super::descent::{Descent, State};
use super::exchange::{Exchanges, exchanges};
use super::products::{Bound, lower_bound};
use super::splitting::split_bound;
use crate::limit::associated::{NO_ENVELOPES, associated, associated_bound, settled_by_association};
use crate::limit::sequential::{FlowState, Sequence, sequence};
use crate::limit::settings::SETTINGS;
use crate::limit::settlement::settle;
use crate::limit::systems::{LARGEST, Systems, greatest_shares};
use crate::optimise::dense_simplex::Feasibility;
use crate::space::{prove_least, settle_in_space, solve, solve_with_own_flow};
use voussoir_core::law::FlowRule;
use voussoir_core::limit::{
    BracketWork, LimitAnswer, LimitProblem, LimitQuestion, LimitSolver, LowerProof, LowerProofKind, NonAssociated,
    SettlementAnswer, Status, combined,
};
use voussoir_core::model::Wrenches;
use voussoir_core::plugin::{Capability, Card, Keys, PluginKind};
use voussoir_core::random::Random;
use voussoir_core::space::{SpaceAnswer, SpaceField, SpaceProblem, SpaceSettled};

/// Greatest number of rows of products that are solved only to make the result of the search checkable.
const MAX_CHECKED_ROWS: usize = 5_000;
/// Number of starts of the local search.
const STARTS: usize = 24;

/// The least load with the laws' own flow.
#[derive(Debug, Clone, Keys)]
pub struct LimitNonassociated {
    /// work that the proof of the lower bound may take, in 10⁹ matrix entries swept (about a second each)
    #[key(unit = "-", range = ">= 0", default = 4.0)]
    pub search_limit: f64,
    /// greatest number of rows of the linear program of products, which bounds the least load from below
    /// where the search does not; 0 for none (10 000: seconds, 40 000: minutes)
    #[key(range = "<= 1_000_000", default = 12000)]
    pub product_rows: usize,
    /// work that the program of all products may take where that of `product_rows` leaves the bracket open,
    /// in 10⁹ multiplications (about 0.1 s each); 0 for none
    #[key(unit = "-", range = ">= 0", default = 0.0)]
    pub product_limit: f64,
}

impl LimitNonassociated {
    /// Returns the greatest number of matrix entries that a search sweeps.
    fn entries(&self) -> u64 {
        (self.search_limit * 1e9).min(1e18) as u64
    }
}

impl Default for LimitNonassociated {
    fn default() -> Self {
        Self::defaults()
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::LimitSolver,
        tag: "limit_least",
        summary: "the least load factor with the flow rules of the laws, with a proved lower bound",
        provides: &[Capability::NON_ASSOCIATED, Capability::SPACE],
        requires: &[&[Capability::FACETS], &[Capability::RIGID_LIMIT]],
        cost: Some(10),
        sources: &[
            "Ferris & Tin-Loi 2001, Int. J. Mech. Sci. 43",
            "Marques-Silva & Sakallah 1999, IEEE Trans. Computers 48",
            "Sherali & Adams 1990, SIAM J. Discrete Math. 3",
            "Eckstein & Bertsekas 1992, Math. Programming 55",
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("limit_least.md"),
        ..Card::of::<LimitNonassociated>()
    }
}

/// Note if the loads before the stage are at a limit state.
const MOVES_ALREADY: &str = "the loads present before this stage are at a limit state of the laws' own flow, with a mechanism \
     on which they do work: blocks stand by wedging alone, and whether they do depends on how the joints were compressed";

/// Reason of an open bracket.
const AT_LIMIT: &str = "the search ended at its limit";
const GIVEN_UP: &str = "with a tenth of its work the search could not exclude even the lowest hundredth of what was open, and was given up";

/// Local search and proof over one problem.
struct Least<'a> {
    problem: &'a LimitProblem,
    systems: Systems,
    work: Work,
    /// The last exchanges.
    exchanges: Exchanges,
    local: LocalSearch,
}

/// The end of the local search.
#[derive(Debug, Clone, Copy, Default)]
struct LocalSearch {
    /// θ of its best state, if that is the best state so far.
    theta: Option<f64>,
    /// The start that led to this state, from 1.
    start: usize,
    /// Number of starts.
    starts: usize,
}

impl Least<'_> {
    /// Returns an error unless the dense systems can be built: a small scene and linear rows only.
    fn searchable(&self) -> Result<(), String> {
        let s = &self.systems;
        if self.problem.joints.iter().any(|joint| joint.strength.block.is_some()) {
            return Err("joints that crush are not linear: no lower bound is proved".into());
        }
        if s.pairs.iter().any(|p| p.non_associated() && (p.openings.len() != 2 || p.relief < 0.0)) {
            return Err("a joint whose flow is read by its law has no opening rows: no lower bound is proved".into());
        }
        let entries = s.entries();
        if entries > LARGEST {
            return Err(format!(
                "the scene is too large for the search ({entries} entries of {LARGEST}): no lower bound is proved"
            ));
        }
        Ok(())
    }

    /// Computes the state in which these pairs move, to rounding, at the least factor.
    fn state(&self, moving: &[usize]) -> Option<(f64, FlowState)> {
        let pairs = self.systems.pairs.len();
        let excluded: Vec<bool> = (0..pairs).map(|i| !moving.contains(&i)).collect();
        let open = vec![[0.0, f64::INFINITY]; pairs];
        let mut kinematics = self.systems.kinematics([f64::NEG_INFINITY, f64::INFINITY], &open, &excluded)?;
        if kinematics.feasible() != Feasibility::Point {
            return None;
        }
        let gamma: Vec<f64> = (0..pairs).map(|i| kinematics.value(i).max(0.0)).collect();
        let moving = greatest_shares(&gamma);
        let mut statics = self.systems.statics(None)?;
        moving.iter().for_each(|&i| statics.fix(i, true));
        if statics.feasible() != Feasibility::Point {
            return None;
        }
        statics.minimise(&[(self.systems.theta(), 1.0)], 5000)?;
        let at_vertex: Vec<usize> = (0..pairs).filter(|&i| statics.at_zero(i)).collect();
        let start = vec![0.0; self.systems.forces + 1];
        let fields = [at_vertex, moving.clone()];
        let (z, _) = fields.into_iter().filter_map(|yielding| self.systems.field(&yielding, start.clone())).find(
            |(z, violation)| {
                let idle = moving.iter().map(|&i| self.systems.slack(i, z).abs()).fold(0.0, f64::max);
                violation.max(idle) <= SETTINGS.negligible && z[self.systems.forces] >= -SETTINGS.negligible
            },
        )?;
        let moves: Vec<(usize, f64)> = moving.iter().map(|&i| (i, gamma[i])).collect();
        let (motion, wrong) = self.systems.motion(self.problem, &moves)?;
        if wrong > SETTINGS.negligible {
            return None;
        }
        let theta = z[self.systems.forces];
        // A factor within rounding of zero is zero.
        let theta = if theta.abs() < SETTINGS.zero { 0.0 } else { theta };
        let field = self.systems.joint_forces(&z);
        Some((theta, FlowState { factor: theta * self.systems.unit, field, motion }))
    }

    /// Finds the least state of many local searches below `most` (∞: no bound is known).
    fn local(&mut self, most: f64, first: Option<Vec<f64>>) -> Option<State> {
        let bound = most.is_finite().then_some(most);
        let mut statics = self.systems.statics(bound)?;
        if statics.feasible() != Feasibility::Point {
            return None;
        }
        let (bounds, excluded) = dissipations(&self.systems, &mut statics);
        let mut kinematics = self.systems.kinematics([0.0, most], &bounds, &excluded)?;
        let (pairs, theta) = (self.systems.pairs.len(), self.systems.theta());
        let mut best: Option<State> = None;
        let mut random = Random::new(1);
        let mut present = most;
        let starts = first.into_iter().map(Some).chain((0..STARTS).map(|_| None));
        for (index, start) in starts.enumerate() {
            let start = start.unwrap_or_else(|| (0..pairs).map(|_| random.unit().powi(4)).collect());
            let mut descent =
                Descent { statics: &mut statics, kinematics: &mut kinematics, pairs, theta, excluded: &excluded };
            let found = descent.alternate(&start).map(|state| descent.improve(state));
            descent.release();
            if let Some(state) = found
                && best.as_ref().is_none_or(|b| state.theta < b.theta)
            {
                let swept = (statics.work() + kinematics.work()) as f64 / 1e9;
                self.work.curve.found(BracketWork::Local, swept, state.theta);
                if present.is_finite() && state.theta < present {
                    let next = state.theta * (1.0 - SETTINGS.apart);
                    statics.shift(self.systems.upper_slack(), next - present);
                    kinematics.shift(self.systems.upper_slack(), next - present);
                    present = next;
                }
                best = Some(state);
                self.local.start = index + 1;
            }
            self.local.starts = index + 1;
        }
        self.work.pivots += statics.pivots + kinematics.pivots;
        best
    }
}

#[typetag::serde(name = "limit_least")]
impl LimitSolver for LimitNonassociated {
    fn solve(&self, problem: &LimitProblem, question: LimitQuestion) -> LimitAnswer {
        let mut answer = associated(problem, question);
        let mut own = associated_bound(&answer);
        let LimitQuestion::Collapse { start, max } = question else {
            answer.non_associated = Some(own);
            return answer;
        };
        if settled_by_association(problem, question, &answer) {
            own.proved_lower = own.associated_factor;
            own.lower_proof = own.proved_lower.map(|_| LowerProof::by(LowerProofKind::Associated));
            answer.non_associated = Some(own);
            return answer;
        }
        let base: Wrenches = combined(&problem.fixed, &problem.varying, start);
        let mut least = Least {
            problem,
            systems: Systems::new(problem, &base),
            work: Work::default(),
            exchanges: Exchanges::default(),
            local: LocalSearch::default(),
        };
        let unit = least.systems.unit;
        // The greatest θ of interest: the result of associated flow or of the search.
        let associated_theta = own.associated_factor.map(|factor| (factor - start) / unit);
        let most = associated_theta.unwrap_or((max - start) / unit);
        let mut best = least.first(&answer, start);
        let mut lower = Lower { theta: 0.0, products: None, searched: 0.0 };
        match least.searchable() {
            Err(why) => answer.notes.push(why),
            Ok(()) => {
                let most = best.as_ref().map_or(most, |b| b.0.min(most));
                if most > 0.0 {
                    let from = answer.motion.as_ref().map(|motion| least.systems.multipliers(problem, motion));
                    let found = least.local(most, from);
                    if least.take(found.map(|state| state.moving), &mut best) {
                        least.local.theta = best.as_ref().map(|b| b.0);
                    }
                    best.iter().for_each(|b| least.work.curve.known(b.0));
                }
                lower = least.prove(self, most, &mut best);
            }
        }
        // If a lower state is not excluded, the sequence of linear programs may find it.
        if best.as_ref().is_none_or(|b| lower.theta < b.0 * (1.0 - SETTINGS.closed)) {
            let from = answer.field.clone().unwrap_or_default();
            let Sequence { state, open } = sequence(problem, &base, &from, &mut answer.counters);
            if let Some(state) = state.filter(|state| best.as_ref().is_none_or(|b| state.factor < b.1.factor)) {
                least.work.curve.found(BracketWork::Sequence, 0.0, state.factor / unit);
                best = Some((state.factor / unit, state));
            }
            answer.notes.extend(open.map(|why| format!("sequential programs: {why}")));
        }
        if least.searchable().is_ok() && least.lowered_by_exchange(self.search_limit, &mut best, &lower) {
            // A search excludes loads below any state; products are proved again for the lower state.
            let searched = lower.searched;
            lower = least.prove(self, most, &mut best);
            lower.search(best.as_ref().map_or(searched, |b| b.0.min(searched)));
        }
        answer.notes.extend(best.as_ref().and_then(|b| least.local_minimum(b.0, lower.theta)));
        if best.is_none() && least.searchable().is_ok() && least.moves_already(&base, self.search_limit) {
            answer.notes.push(MOVES_ALREADY.into());
        }
        for (name, count) in [
            ("pivots", least.work.pivots),
            ("search_programs", least.work.programs),
            ("search_refusals", least.work.refusals),
            ("product_iterations", least.work.iterations),
        ] {
            *answer.counters.entry(name.into()).or_default() += count;
        }
        if self.product_limit > 0.0 {
            answer.counters.insert("product_multiplications".into(), least.work.multiplications);
        }
        own.lower_proof = Some(lower.proof(&least.systems, problem, start));
        let why = if least.work.given_up { GIVEN_UP } else { AT_LIMIT };
        finish(answer, (own, least.work.curve, why), best, lower.theta, (start, max, unit))
    }

    fn settle(&self, problem: &LimitProblem, loads: &Wrenches, openings: &[[f64; 3]]) -> SettlementAnswer {
        settle(problem, loads, openings, FlowRule::NonAssociated)
    }

    fn solve_space(&self, problem: &SpaceProblem, question: LimitQuestion) -> Option<SpaceAnswer> {
        let states = solve_with_own_flow(problem, question, solve);
        Some(prove_least(problem, question, states, self.entries()))
    }

    fn settle_space(&self, problem: &SpaceProblem, openings: &SpaceField) -> SpaceSettled {
        settle_in_space(problem, openings)
    }

    fn refuses(&self, problem: &LimitProblem) -> Option<String> {
        problem.has_envelopes().then(|| NO_ENVELOPES.into())
    }
}

impl Least<'_> {
    /// Returns the associated answer itself if its mechanism does not slide: then it satisfies any flow rule.
    fn first(&self, answer: &LimitAnswer, start: f64) -> Option<(f64, FlowState)> {
        let (factor, field, motion) = (answer.factor?, answer.field.clone()?, answer.motion.clone()?);
        let gamma = self.systems.multipliers(self.problem, &motion);
        let slides = greatest_shares(&gamma).into_iter().any(|i| self.systems.pairs[i].non_associated());
        let state = FlowState { factor: factor - start, field, motion };
        (!slides && answer.status == Status::Collapse).then_some(((factor - start) / self.systems.unit, state))
    }

    /// Returns true if the base loads alone are at a limit state with a mechanism on which they do work.
    fn moves_already(&mut self, base: &Wrenches, limit: f64) -> bool {
        let none: Wrenches = vec![[0.0; 3]; base.len()];
        if self.problem.magnitude(base) == 0.0 {
            return false;
        }
        let alone = LimitProblem { varying: base.clone(), fixed: none.clone(), ..self.problem.clone() };
        let entries = (limit * 1e9 / 10.0).min(1e18) as u64;
        state_at(&Systems::new(&alone, &none), 1.0, entries, &mut self.work)
    }

    /// Keeps a state if it is lower than the best one.
    fn take(&self, moving: Option<Vec<usize>>, best: &mut Option<(f64, FlowState)>) -> bool {
        let Some(found) = moving.and_then(|moving| self.state(&moving)) else { return false };
        let better = best.as_ref().is_none_or(|b| found.0 < b.0 - SETTINGS.below_state / 2.0 * b.0.abs());
        if better {
            *best = Some(found);
        }
        better
    }

    /// Exchanges one mode after the other while this lowers the best state, unless its bracket is closed. Returns true if it
    /// was lowered. At the end the state is a local minimum, if the work suffices.
    fn lowered_by_exchange(&mut self, limit: f64, best: &mut Option<(f64, FlowState)>, lower: &Lower) -> bool {
        let mut most = (limit * 1e9 / 10.0).min(1e18) as u64;
        let mut lowered = false;
        while let Some((theta, state)) =
            best.as_ref().filter(|b| b.0 > 0.0 && lower.theta < b.0 * (1.0 - SETTINGS.closed))
        {
            let moving = greatest_shares(&self.systems.multipliers(self.problem, &state.motion));
            let Some(found) = exchanges(&self.systems, &moving, *theta, most, &mut self.work) else { break };
            most = most.saturating_sub(found.entries);
            let moving = found.lower.clone();
            self.exchanges = found;
            if !self.take(moving, best) {
                break;
            }
            lowered = true;
            best.iter().for_each(|b| self.work.curve.known(b.0));
        }
        lowered
    }

    /// States how far the best state is known to be a local minimum, unless its bracket is closed.
    fn local_minimum(&self, theta: f64, lower: f64) -> Option<String> {
        let Exchanges { tried, complete, .. } = self.exchanges;
        // A lower state that rounding did not allow to compute says nothing about a minimum.
        let of_this_state = self.exchanges.theta == theta && self.exchanges.lower.is_none();
        if tried == 0 || !of_this_state || lower >= theta * (1.0 - SETTINGS.closed) {
            return None;
        }
        let what = if complete { "the load found is a local minimum: none" } else { "as far as it was tried, none" };
        let LocalSearch { start, starts, .. } = self.local;
        let from = if self.local.theta == Some(theta) {
            format!("; start {start} of {starts} of the local search led to it, and no later one to a lower load")
        } else {
            String::new()
        };
        Some(format!("{what} of {tried} exchanges of one mode lowers it{from}"))
    }

    /// Raises the lower bound as far as the limits of work allow, and keeps lower states found on the way.
    fn prove(&mut self, limits: &LimitNonassociated, most: f64, best: &mut Option<(f64, FlowState)>) -> Lower {
        let entries = limits.entries();
        let (mut lower, mut gap) = (Lower { theta: 0.0, products: None, searched: 0.0 }, SETTINGS.below_state);
        let mut whole = true;
        loop {
            let known = best.as_ref().map_or(most, |b| b.0);
            if !known.is_finite() || known <= 0.0 {
                return lower;
            }
            let top = known * (1.0 - gap);
            if lower.theta >= known * (1.0 - SETTINGS.closed) {
                return lower;
            }
            let left = entries.saturating_sub(self.work.entries);
            let proof = if whole {
                at_once(&self.systems, top, left, &mut self.work)
            } else {
                in_parts(&self.systems, [lower.theta, top], left, &mut self.work)
            };
            match proof {
                Proof::Below(proved) => {
                    lower.search(proved);
                    if lower.products.is_none() {
                        // A bound of the search can be checked only if products prove it too.
                        lower.product(self.products(known, limits.product_rows.min(MAX_CHECKED_ROWS), true));
                    }
                    return lower;
                }
                Proof::Open(proved) if !whole => {
                    lower.search(proved);
                    return lower;
                }
                Proof::Open(_) => {
                    whole = false;
                    lower.product(self.products(known, limits.product_rows, false));
                    if lower.theta < known * (1.0 - SETTINGS.closed) && limits.product_limit > 0.0 {
                        let multiplications = (limits.product_limit * 1e9).min(1e18) as u64;
                        let curve = &mut self.work.curve;
                        let (bound, work) = split_bound(&self.systems, known, multiplications, curve);
                        self.work.multiplications += work;
                        lower.product(bound.filter(|bound| bound.theta > lower.theta));
                    }
                }
                Proof::State(proved, moving) => {
                    lower.search(proved);
                    if self.take(Some(moving), best) {
                        let (swept, theta) = (self.work.swept(), best.as_ref().map_or(known, |b| b.0));
                        self.work.curve.found(BracketWork::Search, swept, theta);
                        continue;
                    }
                    // The proof ends this far below the known state because of rounding.
                    if gap < SETTINGS.closed {
                        gap *= 10.0;
                    } else if whole {
                        whole = false;
                    } else {
                        return lower;
                    }
                }
            }
        }
    }

    fn products(&mut self, known: f64, most: usize, widest_only: bool) -> Option<Bound> {
        let (bound, iterations) = lower_bound(&self.systems, self.problem, known, most, widest_only);
        self.work.iterations += iterations;
        if iterations > 0 {
            let proved = bound.as_ref().map_or(0.0, |bound| bound.theta);
            self.work.curve.proved(BracketWork::Products, self.work.iterations as f64, proved);
        }
        bound
    }
}

/// The proved lower end and its proof.
struct Lower {
    theta: f64,
    products: Option<Bound>,
    /// The bound by search.
    searched: f64,
}

impl Lower {
    fn search(&mut self, proved: f64) {
        self.searched = self.searched.max(proved);
        self.theta = self.theta.max(proved);
    }

    /// Adds a bound by products. If both bounds close the bracket, it replaces the search even if it is lower, because
    /// it can be checked.
    fn product(&mut self, bound: Option<Bound>) {
        let Some(bound) = bound else { return };
        if bound.theta >= self.searched * (1.0 - SETTINGS.closed / 2.0) {
            self.theta = bound.theta;
            self.searched = 0.0;
        }
        self.products = Some(bound);
    }

    fn proof(&self, systems: &Systems, problem: &LimitProblem, start: f64) -> LowerProof {
        match &self.products {
            _ if self.theta <= 0.0 => LowerProof::by(LowerProofKind::Start),
            Some(bound) if bound.theta >= self.theta => {
                let steps = bound.steps.iter().map(|step| step.stored(systems, problem, start)).collect();
                LowerProof { by: LowerProofKind::Products, steps }
            }
            _ => LowerProof::by(LowerProofKind::Search),
        }
    }
}

/// Builds the answer from the best state and the proved bound.
fn finish(
    mut answer: LimitAnswer,
    (mut own, curve, why): (NonAssociated, Curve, &str),
    best: Option<(f64, FlowState)>,
    lower: f64,
    (start, max, unit): (f64, f64, f64),
) -> LimitAnswer {
    let proved = start + lower * unit;
    match best {
        Some((_, state)) if start + state.factor <= max => {
            let factor = start + state.factor;
            own.proved_lower = Some(proved.min(factor));
            own.bracket = curve.factors(start, unit, [proved.min(factor), factor]);
            if lower <= 0.0 && state.factor > 0.0 {
                answer.notes.push(format!(
                    "the least load factor of the laws' own flow is at most {factor:.9} (found); no lower end is proved: {why}"
                ));
            } else if lower * unit < state.factor * (1.0 - 2.0 * SETTINGS.closed) {
                answer.notes.push(format!(
                    "the least load factor of the laws' own flow lies between {proved:.9} (proved) and {factor:.9} (found): {why}"
                ));
            }
            answer.status = Status::Collapse;
            answer.factor = Some(factor);
            answer.field_factor = factor;
            answer.field = Some(state.field);
            answer.motion = Some(state.motion);
            answer.unique = None;
            answer.ray = None;
            answer.non_associated = Some(own);
        }
        _ if answer.status == Status::Collapse => {
            // Only the associated answer is known: an upper bound, marked as such.
            answer.notes.push(format!(
                "no limit state with the laws' own flow was found; none lies below {proved:.9} (proved)"
            ));
        }
        _ => {
            own.proved_lower = Some(proved);
            answer.notes.push(format!(
                "no limit state with the laws' own flow was found; none lies below {proved:.9} (proved)"
            ));
            answer.non_associated = Some(own);
        }
    }
    answer
}
