//! The history of each joint on a path: when it became a hinge, slid, opened or crushed.
//!
//! Events of a path are those of contact points. A joint is a **hinge** if exactly one of its points is still closed and
//! this point is an end of the joint. A joint **slides** if all its closed points slide in the same direction. It **opens**
//! if no point is closed. Points that change at the same factor change together: a state without an increment of load is not
//! listed. A joint that moves in the collapse mechanism and had not changed before is listed last, at the collapse load.

use serde::Serialize;
use std::collections::BTreeMap;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::model::{Assembly, Bond};
use voussoir_core::path::ContactEvent;
use voussoir_study::results::{CaseResult, EventEntry, FieldEntry};

/// The state of a whole joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum JointState {
    /// More than one end is closed, and at least one closed point does not slide.
    Closed,
    /// Only this end (0 or 1) is closed.
    Hinge(usize),
    /// All closed points slide in the same direction.
    Slides,
    /// No point is closed.
    Open,
}

/// A change of the state of a whole joint.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JointEvent {
    /// Name of the stage.
    pub stage: String,
    /// Factor of the loads of the stage (of gravity, if `gravity` is set).
    pub factor: f64,
    /// True if the change happened while gravity was applied.
    pub gravity: bool,
    /// Index of the joint.
    pub joint: usize,
    /// Position of the change \[m\]: the closed end of a hinge, otherwise the middle of the joint.
    pub point: [f64; 2],
    /// The new state of the joint; `None` if a point began to crush.
    pub became: Option<JointState>,
    /// True if the closed end of a hinge slides.
    pub slides: bool,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Point {
    Open,
    Sticks,
    Slips(bool),
}

/// The contact points of a joint along it, from end 0 to end 1.
struct Points {
    places: Vec<[f64; 2]>,
    now: Vec<Point>,
    state: JointState,
    crushed: bool,
}

impl Points {
    fn state(&self) -> JointState {
        let closed: Vec<usize> = (0..self.now.len()).filter(|&i| self.now[i] != Point::Open).collect();
        let last = self.now.len() - 1;
        match closed[..] {
            [] => JointState::Open,
            [0] if last > 0 => JointState::Hinge(0),
            [only] if only == last && last > 0 => JointState::Hinge(1),
            _ => {
                let way = self.now[closed[0]];
                let together = way != Point::Sticks && closed.iter().all(|&i| self.now[i] == way);
                if together { JointState::Slides } else { JointState::Closed }
            }
        }
    }
}

fn joints(assembly: &Assembly, field: &[FieldEntry]) -> BTreeMap<usize, Points> {
    let mut joints: BTreeMap<usize, Points> = BTreeMap::new();
    for entry in field {
        let Some(joint) = assembly.joints.get(entry.joint).filter(|joint| joint.bond != Bond::Bonded) else { continue };
        let along = (Vec2::from(entry.point) - joint.ends[0]).norm();
        let points = joints.entry(entry.joint).or_insert_with(|| Points {
            places: Vec::new(),
            now: Vec::new(),
            state: JointState::Closed,
            crushed: false,
        });
        points.places.push(entry.point);
        points.now.push(if joint.gap.at(along) > 0.0 { Point::Open } else { Point::Sticks });
    }
    joints.values_mut().for_each(|points| points.state = points.state());
    joints
}

/// Returns the changes of joints in the order in which they happened. Empty for a case without a path.
pub fn joint_events(assembly: &Assembly, result: &CaseResult) -> Vec<JointEvent> {
    let mut joints = joints(assembly, result.proof.field.as_deref().unwrap_or_default());
    let mut changes = Vec::new();
    let together = |a: &EventEntry, b: &EventEntry| {
        a.stage == b.stage
            && a.gravity == b.gravity
            && (a.factor - b.factor).abs() <= 1e-9 * a.factor.abs().max(b.factor.abs())
    };
    for group in result.path.events.chunk_by(together) {
        let mut touched: Vec<usize> = Vec::new();
        for event in group {
            let Some(points) = joints.get_mut(&event.joint) else { continue };
            let Some(at) = points.places.iter().position(|place| *place == event.point) else { continue };
            let event_of = |became, point| JointEvent {
                stage: event.stage.clone(),
                factor: event.factor,
                gravity: event.gravity,
                joint: event.joint,
                point,
                became,
                slides: false,
            };
            match event.what {
                ContactEvent::Opens => points.now[at] = Point::Open,
                ContactEvent::Closes | ContactEvent::Sticks => points.now[at] = Point::Sticks,
                ContactEvent::SlipsForward => points.now[at] = Point::Slips(true),
                ContactEvent::SlipsBackward => points.now[at] = Point::Slips(false),
                ContactEvent::Crushes if !points.crushed => {
                    points.crushed = true;
                    changes.push(event_of(None, event.point));
                }
                ContactEvent::Crushes | ContactEvent::Unloads | ContactEvent::Softens => {}
            }
            if !touched.contains(&event.joint) {
                touched.push(event.joint);
            }
        }
        for joint in touched {
            let Some(points) = joints.get_mut(&joint) else { continue };
            let state = points.state();
            if std::mem::replace(&mut points.state, state) == state {
                continue;
            }
            let end = match state {
                JointState::Hinge(0) => Some(0),
                JointState::Hinge(_) => Some(points.now.len() - 1),
                _ => None,
            };
            let ends = assembly.joints[joint].ends;
            changes.push(JointEvent {
                stage: group[0].stage.clone(),
                factor: group[0].factor,
                gravity: group[0].gravity,
                joint,
                point: end.map_or(((ends[0] + ends[1]) / 2.0).into(), |end| points.places[end]),
                became: Some(state),
                slides: end.is_some_and(|end| points.now[end] != Point::Sticks),
            });
        }
    }
    changes.extend(at_the_end(assembly, result, &joints));
    changes
}

/// Returns the joints that move in the mechanism and had not changed before: their change ends the path.
fn at_the_end(assembly: &Assembly, result: &CaseResult, joints: &BTreeMap<usize, Points>) -> Vec<JointEvent> {
    let (Some(mechanism), Some(factor), Some(stage)) = (&result.mechanism, result.load_factor, result.stages.last())
    else {
        return Vec::new();
    };
    let event = |joint: usize, point: [f64; 2], became: JointState| JointEvent {
        stage: stage.name.clone(),
        factor,
        gravity: false,
        joint,
        point,
        became: Some(became),
        slides: mechanism.sliding.iter().any(|sliding| sliding.joint == joint),
    };
    let unchanged = |event: &JointEvent| joints.get(&event.joint).is_some_and(|p| Some(p.state) != event.became);
    let hinges = mechanism.hinges.iter().map(|hinge| {
        let ends = assembly.joints[hinge.joint].ends;
        let from = |end: usize| (Vec2::from(hinge.point) - ends[end]).norm();
        event(hinge.joint, hinge.point, JointState::Hinge(usize::from(from(1) < from(0))))
    });
    let rotates = |joint: usize| mechanism.hinges.iter().any(|hinge| hinge.joint == joint);
    let slides = mechanism.sliding.iter().filter(|sliding| !rotates(sliding.joint)).map(|sliding| {
        let ends = assembly.joints[sliding.joint].ends;
        event(sliding.joint, ((ends[0] + ends[1]) / 2.0).into(), JointState::Slides)
    });
    hinges.chain(slides).filter(unchanged).collect()
}
