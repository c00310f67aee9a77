//! The least load of a mechanism: a program on cones.
//!
//! A mechanism fixes which points open, slip, and stick. Open points carry nothing, a slipping point carries n (1, −μ d)
//! against its slip d, and a sticking point any force of its cone. All admissible forces of this kind are collapse states with the same mechanism, and
//! they are a convex set. Its least factor is found by the solver of associated flow, which treats each slipping point as a contact
//! without friction along (1, −μ d), and reduces the load of a known state.

use crate::space::settings::JOINTS;
use voussoir_core::law::FrictionCone;
use voussoir_core::limit::{Counters, LimitQuestion, Status};
use voussoir_core::space::{PointSet, SpaceAnswer, SpaceContact, SpaceField, SpaceProblem, SpaceVelocity};

/// Solves a problem with associated flow.
pub type Associated = fn(&SpaceProblem, LimitQuestion) -> SpaceAnswer;

/// The part of a point in a mechanism.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Role {
    Open,
    /// Against this slip.
    Slips([f64; 2]),
    Sticks,
}

/// Returns the role of each point of each contact for its jumps (n, s, t).
fn roles(problem: &SpaceProblem, jumps: &[[f64; 3]]) -> Vec<Vec<Role>> {
    let largest = jumps.iter().map(|v| v[0].hypot(v[1]).hypot(v[2])).fold(0.0, f64::max);
    let least = JOINTS.at_rest * largest;
    let mut jumps = jumps.iter();
    let mut role = |contact: &SpaceContact| {
        let [n, s, t] = jumps.next().copied().unwrap_or_default();
        let slip = s.hypot(t);
        if n - contact.law.dilatancy * slip > least {
            Role::Open
        } else if slip > least {
            Role::Slips([s / slip, t / slip])
        } else {
            Role::Sticks
        }
    };
    problem.contacts.iter().map(|contact| contact.inner.points.iter().map(|_| role(contact)).collect()).collect()
}

/// The points of a contact that replaces others: contact and place of each.
type Places = Vec<(usize, usize)>;

/// Returns the points of a contact with a role, without areas.
fn points(contact: &SpaceContact, keep: impl Fn(usize) -> bool) -> PointSet {
    let points: Vec<_> = contact.inner.points.iter().enumerate().filter(|(k, _)| keep(*k)).map(|(_, x)| *x).collect();
    PointSet { areas: vec![0.0; points.len()], points }
}

/// Returns the contacts that the roles leave, each with its points.
fn replaced(problem: &SpaceProblem, roles: &[Vec<Role>]) -> Vec<(SpaceContact, Places)> {
    let mut contacts = Vec::new();
    for (index, (contact, roles)) in problem.contacts.iter().zip(roles).enumerate() {
        let with =
            |set: PointSet, frame, law| SpaceContact { inner: set.clone(), outer: set, frame, law, ..contact.clone() };
        let friction = contact.law.friction;
        for (k, role) in roles.iter().enumerate() {
            let Role::Slips([s, t]) = role else { continue };
            let [normal, first, second] = contact.frame;
            let along = (normal - (first * *s + second * *t) * friction).normalize();
            let across = (first * *t - second * *s).normalize();
            let frame = [along, across, along.cross(&across)];
            contacts
                .push((with(points(contact, |own| own == k), frame, FrictionCone::dry(0.0, 0.0)), vec![(index, k)]));
        }
        let sticking: Vec<usize> = (0..roles.len()).filter(|k| roles[*k] == Role::Sticks).collect();
        if !sticking.is_empty() {
            let set = points(contact, |own| sticking.contains(&own));
            let law = FrictionCone::dry(friction, friction);
            contacts.push((with(set, contact.frame, law), sticking.into_iter().map(|k| (index, k)).collect()));
        }
    }
    contacts
}

/// The least state of a mechanism.
pub struct Least {
    /// Factor and forces, if the factor is below the known one.
    pub state: Option<(f64, SpaceField)>,
    /// The dual motion: it shows how the factor depends on the directions of slip.
    pub dual: Option<Vec<SpaceVelocity>>,
}

/// Returns the problem of the forces that fit a mechanism, with loads that fall from a factor; the roles of all points; and the points
/// of each contact.
fn reduced(problem: &SpaceProblem, factor: f64, jumps: &[[f64; 3]]) -> (SpaceProblem, Vec<Vec<Role>>, Vec<Places>) {
    let roles = roles(problem, jumps);
    let (contacts, places): (Vec<_>, Vec<_>) = replaced(problem, &roles).into_iter().unzip();
    let wrenches = problem.fixed.iter().zip(&problem.varying);
    let fixed = wrenches.map(|(w, p)| std::array::from_fn(|i| w[i] + factor * p[i])).collect();
    let varying = problem.varying.iter().map(|p| p.map(|x| -x)).collect();
    (SpaceProblem { contacts, fixed, varying, ..problem.clone() }, roles, places)
}

/// Returns forces of a mechanism with these jumps that carry a factor.
pub fn forces(
    problem: &SpaceProblem,
    solve: Associated,
    factor: f64,
    jumps: &[[f64; 3]],
    counters: &mut Counters,
) -> Option<SpaceField> {
    let (reduced, roles, places) = reduced(problem, factor, jumps);
    let answer = solve(&reduced, LimitQuestion::Admissible(0.0));
    count(counters, &answer);
    let field = answer.field.filter(|_| answer.status == Status::Stands)?;
    Some(own_forces(problem, &roles, &places, &field))
}

fn count(counters: &mut Counters, answer: &SpaceAnswer) {
    answer.counters.iter().for_each(|(name, count)| *counters.entry(name.clone()).or_default() += count);
}

/// Returns the least state at or above `start` of a mechanism with these jumps, from a state at a factor.
pub fn least(
    problem: &SpaceProblem,
    solve: Associated,
    (start, factor): (f64, f64),
    jumps: &[[f64; 3]],
    counters: &mut Counters,
) -> Least {
    let (reduced, roles, places) = reduced(problem, factor, jumps);
    let answer = solve(&reduced, LimitQuestion::Collapse { start: 0.0, max: factor - start });
    count(counters, &answer);
    let known = answer.field.filter(|_| answer.field_factor > 0.0);
    let state = known.map(|forces| (factor - answer.field_factor, own_forces(problem, &roles, &places, &forces)));
    Least { state, dual: answer.motion }
}

/// Returns the forces of all points from the forces of the contacts that replace them.
fn own_forces(problem: &SpaceProblem, roles: &[Vec<Role>], places: &[Places], forces: &SpaceField) -> SpaceField {
    let mut field: SpaceField = roles.iter().map(|roles| vec![[0.0; 3]; roles.len()]).collect();
    for (places, forces) in places.iter().zip(forces) {
        for ((contact, point), force) in places.iter().zip(forces) {
            let friction = problem.contacts[*contact].law.friction;
            field[*contact][*point] = match roles[*contact][*point] {
                Role::Slips([s, t]) => {
                    let n = force[0] / 1.0f64.hypot(friction);
                    [n, -friction * n * s, -friction * n * t]
                }
                _ => *force,
            };
        }
    }
    field
}
