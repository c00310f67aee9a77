//! Limit points, the reason why a path ends at one, and the end of its range, in the form of a result.

use super::case_input::CaseInput;
use super::load_history::{AfterLimitPoint, LoadHistory};
use crate::results::{FollowedTo, LimitPointEntry};
use voussoir_core::limit::Status;
use voussoir_core::model::Stage;
use voussoir_core::path::{
    LimitPointEnd, LoadStep, LoadStepEnd, PathAnswer, PathProblem, PathSettings, PathState, ProvenPeak,
};

/// Returns the factor of the first limit point of the load step at which the path ended. If the path reaches a mechanism
/// first, the mechanism is the first limit point. `None` if the path ended while gravity was applied: like `load_factor`, it is
/// a factor of loads.
pub(super) fn first_limit_point(problem: &PathProblem, solved: &PathAnswer) -> Option<f64> {
    if problem.load_steps[solved.load_step].gravity {
        return None;
    }
    let ends = matches!(solved.status, Status::Collapse | Status::LimitPoint);
    let first = solved.limit_points.iter().find(|peak| peak.load_step == solved.load_step);
    first.map(|peak| peak.factor).or(solved.factor.filter(|_| ends))
}

/// Adds the limit point at which a path ends, if the solver does not list it.
pub(super) fn add_last_limit_point(solved: &mut PathAnswer) {
    let is_listed = solved.limit_points.iter().any(|peak| peak.load_step == solved.load_step);
    if solved.status == Status::LimitPoint && !is_listed {
        let PathState { load_step, factor, displacement, .. } = solved.state;
        solved.limit_points.push(ProvenPeak { load_step, factor, displacement, lowest: factor });
    }
}

/// Returns all limit points of a path with the states after them.
pub(super) fn limit_points(
    stages: &[Stage],
    problem: &PathProblem,
    peaks: &[ProvenPeak],
    history: &LoadHistory,
) -> Vec<LimitPointEntry> {
    let entry = |(peak, after): (&ProvenPeak, AfterLimitPoint)| {
        let load_step = &problem.load_steps[peak.load_step];
        LimitPointEntry {
            stage: stages[load_step.stage].name.clone(),
            factor: peak.factor,
            gravity: load_step.gravity,
            displacement: peak.displacement,
            fall: (peak.factor - peak.lowest).abs(),
            released_energy: after.released_energy,
            next_state: after.next_state,
        }
    };
    peaks.iter().zip(history.after(peaks, problem)).map(entry).collect()
}

/// Returns the last state that the path has reached.
pub(super) fn followed_to(stages: &[Stage], problem: &PathProblem, history: &LoadHistory) -> Option<FollowedTo> {
    let last = history.last()?;
    let load_step = &problem.load_steps[last.load_step];
    Some(FollowedTo {
        stage: stages[load_step.stage].name.clone(),
        factor: last.factor,
        gravity: load_step.gravity,
        displacement: last.displacement,
    })
}

/// Returns the displacement of the load up to which a limit point is searched \[m\]: `stop.displacement`, otherwise one span,
/// or the height of a scene that is not an arch. `None` if the path has a limit point, or has a target factor.
pub(super) fn search_range(input: &CaseInput, problem: &PathProblem, solved: &PathAnswer) -> Option<f64> {
    let step = problem.load_steps.get(solved.load_step)?;
    let searches = matches!(step.end, LoadStepEnd::Collapse(_));
    if !searches || solved.limit_points.iter().any(|peak| peak.load_step == solved.load_step) {
        return None;
    }
    let [displacement, _] = input.settings.stop(step.stage);
    Some(displacement.unwrap_or_else(|| input.assembly.search_range()))
}

/// Returns the reason why a path ends at its limit point: the reason of the solver, otherwise the reason in the question.
pub(super) fn limit_point_end(
    settings: &PathSettings,
    problem: &PathProblem,
    solved: &PathAnswer,
) -> Option<LimitPointEnd> {
    let asked = || asked_end(settings, &problem.load_steps[solved.load_step]);
    let ended = solved.status == Status::LimitPoint;
    ended.then(|| solved.limit_point_end.or_else(asked)).flatten()
}

/// Returns the reason that the question gives for a path that ends at a limit point of this load step.
pub(crate) fn asked_end(settings: &PathSettings, step: &LoadStep) -> Option<LimitPointEnd> {
    let stops_at_peak = settings.strategy(step.stage).is_some_and(|strategy| !strategy.passes_limit_points());
    match step.end {
        LoadStepEnd::Factor(_) => Some(LimitPointEnd::Target),
        LoadStepEnd::Collapse(_) if settings.ends_at_first_limit_point(step.stage) => Some(LimitPointEnd::Requested),
        LoadStepEnd::Collapse(_) if settings.finite && stops_at_peak => Some(LimitPointEnd::LoadControl),
        LoadStepEnd::Collapse(_) => None,
    }
}
