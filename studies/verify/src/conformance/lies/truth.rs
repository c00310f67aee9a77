//! The known truth of a scene, and the claims of a result that contradict it.

use std::fmt::Display;
use voussoir_core::limit::Status;
use voussoir_core::path::ContactEvent;
use voussoir_study::results::CaseResult;

/// Greatest distance of a point from the known curve, as a share of the range of the curve.
const CURVE_TOLERANCE: f64 = 3e-2;

/// The known truth of a scene: computed by hand, or by a program that shares no code with this one.
#[derive(Debug, Clone, Copy)]
pub struct Truth {
    /// Statuses that are true.
    pub endings: &'static [Status],
    /// The least and the greatest factor of the last stage at which the structure collapses. They are equal unless
    /// flow is not associated. Infinite if every load is carried.
    pub collapse: [f64; 2],
    /// The associated load factor.
    pub associated: f64,
    /// All factors with an admissible field, if they leave out zero.
    pub feasible: Option<[f64; 2]>,
    /// Kinds of mechanism that are true; empty if any kind is.
    pub mechanisms: &'static [&'static str],
    /// False if the mechanism is not unique.
    pub unique: Option<bool>,
    /// Factors of all limit points; no list if they are not known.
    pub limit_points: Option<&'static [f64]>,
    /// Relative tolerance of factors.
    pub tolerance: f64,
}

impl Truth {
    /// Returns the truth of a collapse at one factor.
    pub const fn collapse(factor: f64) -> Self {
        Truth {
            endings: &[Status::Collapse],
            collapse: [factor, factor],
            associated: factor,
            feasible: None,
            mechanisms: &[],
            unique: None,
            limit_points: None,
            tolerance: 1e-7,
        }
    }

    /// Returns the false claims of a result. A stalled result claims nothing. `reference` is the result of another solver, with
    /// its curve.
    pub fn contradictions(&self, result: &CaseResult, reference: Option<&CaseResult>) -> Vec<String> {
        let mut wrong = Vec::new();
        if result.status == Status::Stalled && !result.certificate.passed {
            return wrong;
        }
        if result.certificate.passed {
            self.statement(result, &mut wrong);
        }
        self.numbers(result, &mut wrong);
        self.limit_points(result, &mut wrong);
        not_finite(result, &mut wrong);
        if let Some(reference) = reference.filter(|_| result.certificate.passed) {
            curve(result, reference, self.collapse[1], &mut wrong);
            events(result, reference, &mut wrong);
            stability(result, reference, &mut wrong);
        }
        wrong
    }

    /// Returns the false statement in a solver's own answer: a status that is not true, or a factor at which nothing ends.
    pub fn contradicts(&self, status: Status, factor: Option<f64>) -> Option<String> {
        if !status.is_answer() {
            return None;
        }
        if !self.endings.contains(&status) {
            return Some(format!("the solver answers {status:?}, true are {:?}", self.endings));
        }
        let ends = matches!(status, Status::Collapse | Status::LimitPoint);
        let factor = factor.filter(|_| ends)?;
        let fits = self.below(self.collapse[0], factor) && self.below(factor, self.collapse[1]);
        (!fits).then(|| format!("the solver answers the load factor {factor}, true {:?}", self.collapse))
    }

    fn same(&self, a: f64, b: f64) -> bool {
        a == b || (a - b).abs() <= self.tolerance * b.abs().max(1e-3)
    }

    fn below(&self, a: f64, b: f64) -> bool {
        a <= b || self.same(a, b)
    }

    /// Checks status, load factor and mechanism of a certified result.
    fn statement(&self, result: &CaseResult, wrong: &mut Vec<String>) {
        let ends = matches!(result.status, Status::Collapse | Status::LimitPoint);
        if !self.endings.contains(&result.status) {
            wrong.push(format!("status {:?}, true are {:?}", result.status, self.endings));
        }
        if let Some(factor) = result.load_factor.filter(|_| ends)
            && !(self.below(self.collapse[0], factor) && self.below(factor, self.collapse[1]))
        {
            wrong.push(format!("load factor {factor}, true {:?}", self.collapse));
        }
        if ends && result.load_factor.is_none() {
            wrong.push(format!("{:?} without a load factor", result.status));
        }
        if let Some(mechanism) = &result.mechanism {
            let kind = serde_json::to_value(mechanism.kind).unwrap_or_default();
            let kind = kind.as_str().unwrap_or_default();
            if !self.mechanisms.is_empty() && ends && !self.mechanisms.contains(&kind) {
                wrong.push(format!("mechanism {kind}, true {:?}", self.mechanisms));
            }
            if mechanism.unique == Some(true) && self.unique == Some(false) {
                wrong.push("the mechanism is called unique".into());
            }
        }
    }

    /// Checks bounds and factors, which an open result also claims.
    fn numbers(&self, result: &CaseResult, wrong: &mut Vec<String>) {
        let [least, greatest] = self.collapse;
        let mut check = |what: &str, value: f64, holds: bool, truth: &dyn Display| {
            if !holds || value.is_nan() {
                wrong.push(format!("{what} {value}, true {truth}"));
            }
        };
        let [lower, upper] = result.bounds.unwrap_or_default();
        if let Some(lower) = lower {
            // With a proof the factor is a bound of the least factor, otherwise it is a factor that is carried.
            let most = if result.non_associated.lower_proof.is_some() { least } else { greatest };
            check("lower bound", lower, self.below(lower, most), &most);
        }
        if let Some(upper) = upper {
            check("upper bound", upper, self.below(least, upper), &least);
        }
        if let Some(factor) = result.load_factor {
            check("load factor", factor, self.below(factor, greatest), &greatest);
        }
        if let Some(factor) = result.proof.field_factor {
            check("factor of the field", factor, self.below(factor, greatest.max(self.associated)), &greatest);
        }
        if let Some(factor) = result.non_associated.associated_load_factor {
            check("associated load factor", factor, self.same(factor, self.associated), &self.associated);
        }
        for stage in result.stages.iter().filter(|_| result.certificate.passed) {
            let last = result.stages.last().is_some_and(|last| last.name == stage.name);
            let factor = stage.factor.filter(|_| last && result.stages.len() > 1).unwrap_or(0.0);
            check(&format!("factor of stage {}", stage.name), factor, self.below(factor, greatest), &greatest);
        }
        let ends =
            result.feasible_interval.map(|[low, high]| [low.unwrap_or(-f64::INFINITY), high.unwrap_or(f64::INFINITY)]);
        if let Some([low, high]) = ends {
            let truth = self.feasible.unwrap_or([f64::NAN; 2]);
            check("feasible from", low, self.same(low, truth[0]), &truth[0]);
            check("feasible up to", high, self.same(high, truth[1]), &truth[1]);
        }
    }

    fn limit_points(&self, result: &CaseResult, wrong: &mut Vec<String>) {
        let Some(known) = self.limit_points else { return };
        let is_known = |factor: f64| known.iter().any(|known| self.same(factor, *known));
        let path = &result.path;
        for factor in path.limit_points.iter().map(|point| point.factor).chain(path.first_limit_point) {
            if !is_known(factor) {
                wrong.push(format!("limit point at {factor}, true {known:?}"));
            }
        }
        if path.limit_points.len() > known.len() {
            wrong.push(format!("{} limit points, true {}", path.limit_points.len(), known.len()));
        }
    }
}

/// Checks that every point of a curve lies on the known curve.
fn curve(result: &CaseResult, reference: &CaseResult, greatest: f64, wrong: &mut Vec<String>) {
    let (Some(curve), Some(known)) = (&result.path.curve, &reference.path.curve) else { return };
    let range = |axis: usize| {
        let values = known.iter().map(|point| point[axis]);
        let (low, high) = values.fold((f64::INFINITY, -f64::INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        (high - low).max(f64::MIN_POSITIVE)
    };
    let scale = [range(0), range(1)];
    let off = |point: &[f64; 2]| {
        let nearest = known.windows(2).map(|pair| distance(point, pair, scale)).fold(f64::INFINITY, f64::min);
        // A path may start before the known one and continue beyond its end.
        let farthest = known.iter().map(|known| known[0]).fold(0.0, f64::max);
        let within = known[0][0] <= point[0] && point[0] <= farthest;
        within && nearest > CURVE_TOLERANCE
    };
    if let Some(point) = curve.iter().find(|point| known.len() > 1 && off(point)) {
        wrong.push(format!("the curve passes through {point:?}"));
    }
    let above = greatest + CURVE_TOLERANCE * scale[1];
    if let Some(point) = curve.iter().find(|point| point[1].is_nan() || point[1] > above) {
        wrong.push(format!("the curve passes through {point:?}, above the greatest factor"));
    }
}

/// Returns the distance of a point from a segment, in shares of the ranges of the curve.
fn distance(point: &[f64; 2], pair: &[[f64; 2]], scale: [f64; 2]) -> f64 {
    let share = |a: [f64; 2], b: [f64; 2]| [(a[0] - b[0]) / scale[0], (a[1] - b[1]) / scale[1]];
    let (along, to) = (share(pair[1], pair[0]), share(*point, pair[0]));
    let length = along[0] * along[0] + along[1] * along[1];
    let at = if length > 0.0 { ((along[0] * to[0] + along[1] * to[1]) / length).clamp(0.0, 1.0) } else { 0.0 };
    (to[0] - at * along[0]).hypot(to[1] - at * along[1])
}

/// Checks that every number of the proof is finite, and that every joint has its forces.
fn not_finite(result: &CaseResult, wrong: &mut Vec<String>) {
    let mut check = |what: &str, finite: bool| {
        if !finite {
            wrong.push(format!("{what}: a number is not finite"));
        }
    };
    for (what, field) in [("field", &result.proof.field), ("ray", &result.proof.ray)] {
        check(what, field.iter().flatten().all(|entry| entry.force.iter().chain(&entry.point).all(|v| v.is_finite())));
    }
    let motion = result.proof.motion.iter().flatten();
    check("motion", motion.flat_map(|entry| entry.velocity).all(f64::is_finite));
    check("residuals", result.certificate.residuals.values().all(|value| value.is_finite()));
    check("curve", result.path.curve.iter().flatten().flatten().all(|value| value.is_finite()));
}

/// Checks that every event also happens on the known path at the same joint. A path by steps may report that a point sticks
/// although it slides again within the step.
fn events(result: &CaseResult, reference: &CaseResult, wrong: &mut Vec<String>) {
    let known = &reference.path.events;
    if known.is_empty() {
        return;
    }
    let happens = |event: &&voussoir_study::results::EventEntry| {
        event.what == ContactEvent::Sticks
            || known
                .iter()
                .any(|known| (known.joint, known.what, &known.stage) == (event.joint, event.what, &event.stage))
    };
    if let Some(event) = result.path.events.iter().find(|event| !happens(event)) {
        wrong.push(format!("joint {} {:?} at {}", event.joint, event.what, event.factor));
    }
    // Steps report an event twice if the point opens and closes within one step of the known path.
    if result.path.events.len() > 2 * known.len() {
        wrong.push(format!("{} events, true {}", result.path.events.len(), known.len()));
    }
}

/// Checks that no unstable stage is reported as stable.
fn stability(result: &CaseResult, reference: &CaseResult, wrong: &mut Vec<String>) {
    for (stage, known) in result.stages.iter().zip(&reference.stages) {
        let pairs = [
            (stage.stability.stable_under_load, known.stability.stable_under_load, "load"),
            (stage.stability.stable_under_control, known.stability.stable_under_control, "control"),
        ];
        for (claimed, known, under) in pairs {
            if claimed.is_some() && known.is_some() && claimed != known {
                wrong.push(format!("stage {}: stable under {under}: {claimed:?}", stage.name));
            }
        }
    }
}
