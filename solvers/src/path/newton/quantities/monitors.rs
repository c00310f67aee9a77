//! The monitors of a strategy as weights of gaps and motions.

use crate::path::newton::model::control::MonitorWeights;
use crate::path::newton::model::system::StepSystem;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::path::{Contact, MOST_MONITORS, Monitor, PathProblem};

/// Returns the monitors of a strategy. The error is the name of the first monitor that the problem does not have.
pub fn resolve(problem: &PathProblem, monitors: &[Monitor]) -> Result<Vec<MonitorWeights>, String> {
    if monitors.len() > MOST_MONITORS {
        return Err(format!("a strategy has at most {MOST_MONITORS} monitors, not {}", monitors.len()));
    }
    let weights = |monitor: &Monitor| {
        let found = match *monitor {
            Monitor::Opening { joint, at } => opening(problem, joint, at),
            Monitor::Displacement { block, point, direction } => problem.body_of.get(block).map(|body| {
                MonitorWeights { point: Some((*body, point.into(), direction.into())), ..Default::default() }
            }),
        };
        found.ok_or_else(|| {
            let joints = problem.contacts.iter().map(|c| c.joint + 1).max().unwrap_or(0);
            format!(
                "there is no {monitor} to control: {} blocks, joints 0 to {} except those inside rigid bodies",
                problem.body_of.len(),
                joints.max(1) - 1
            )
        })
    };
    monitors.iter().map(weights).collect()
}

/// Returns weights of the normal gaps of a joint: by areas, or between the two points beside a share of its length.
fn opening(problem: &PathProblem, joint: usize, at: Option<f64>) -> Option<MonitorWeights> {
    let points: Vec<(usize, &Contact)> =
        problem.contacts.iter().enumerate().filter(|(_, c)| c.joint == joint).collect();
    let (first, last) = (points.first()?.1, points.last()?.1);
    let gaps = match at {
        None => {
            let whole: f64 = points.iter().map(|(_, c)| c.area).sum();
            points.iter().map(|(index, c)| (*index, c.area / whole)).collect()
        }
        Some(at) => {
            let along = last.position - first.position;
            let place = |c: &Contact| (c.position - first.position).dot(&along) / along.norm_squared().max(1e-300);
            let beyond = points.iter().position(|(_, c)| place(c) >= at).unwrap_or(points.len() - 1);
            let ((low, before), (high, after)) = (points[beyond.max(1) - 1], points[beyond]);
            let (from, to) = (place(before), place(after));
            let share = if to > from { ((at - from) / (to - from)).clamp(0.0, 1.0) } else { 1.0 };
            vec![(low, 1.0 - share), (high, share)]
        }
    };
    Some(MonitorWeights { gaps, point: None })
}

/// Returns increments of the monitors from those of normal gaps and of points of bodies, in the unit of displacement.
pub fn monitored(
    system: &StepSystem,
    gap: impl Fn(usize) -> f64,
    moved: impl Fn(usize, Vec2) -> Vec2,
) -> [f64; MOST_MONITORS] {
    let mut all = [0.0; MOST_MONITORS];
    for (value, monitor) in all.iter_mut().zip(&system.monitors) {
        *value = monitor.gaps.iter().map(|&(c, weight)| weight * gap(c)).sum();
        if let Some((body, point, direction)) = &monitor.point {
            *value += direction.dot(&moved(*body, *point));
        }
        *value /= system.units().displacement;
    }
    all
}
