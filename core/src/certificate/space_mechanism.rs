//! The mechanism of a motion in space: the contacts that move, the way in which each moves, and the kind of collapse.
//!
//! A point of a contact is closed if its gap grows by no more than its slip opens it: v_n − ψ |v_t| = 0, with the dilatancy ψ
//! of the flow. The closed points decide: no point means separation, an edge or a vertex means a hinge. Slips of closed
//! points that have all directions turn about a point of the contact; other slips slide.

use super::mechanism::{CRUSHES, Mechanism, MechanismKind};
use super::moving_contact::{ClosedPart, ContactMode, MovingContact};
use super::space::jump;
use crate::law::FlowRule;
use crate::limit::{SpaceContact, SpaceProblem, SpaceVelocity};
use crate::model::space::Vec3;
use std::f64::consts::{PI, TAU};

/// Greatest rate that is ignored, relative to the greatest: ten times the distance that the bounds of a collapse may have.
const STILL: f64 = 1e-7;

/// Greatest difference of the axes of hinges that count as one: of directions, and of places relative to the scene.
const SAME_AXIS: f64 = 1e-4;

/// Greatest sine of the angle between points on one edge, and excess over π \[rad\] of directions on one side.
const STRAIGHT: f64 = 1e-6;

/// Identifies the mechanism of velocities of the free bodies in which contacts have the flow `flow`. `names` gives the names of the
/// bodies \[minus, plus\] of a contact of the assembly. `None` if no contact moves.
pub fn space_mechanism(
    problem: &SpaceProblem,
    names: &dyn Fn(usize) -> [String; 2],
    motion: &[SpaceVelocity],
    unique: Option<bool>,
    flow: FlowRule,
) -> Option<Mechanism> {
    let of_contact = |contact: &SpaceContact| -> Vec<Vec3> {
        contact.outer.points.iter().map(|point| Vec3::from(jump(contact, point, motion))).collect()
    };
    let rates: Vec<Vec<Vec3>> = problem.contacts.iter().map(of_contact).collect();
    let still = STILL * rates.iter().flatten().map(Vec3::norm).fold(0.0, f64::max);
    if still == 0.0 {
        return None;
    }
    let (mut contacts, mut axes) = (Vec::new(), Vec::new());
    for (contact, rates) in problem.contacts.iter().zip(&rates) {
        let state = State::new(contact, rates, motion, flow, still);
        let modes = state.modes();
        if modes.is_empty() {
            continue;
        }
        if modes.contains(&ContactMode::Hinge) {
            axes.push(state.axis(problem.length));
        }
        contacts.push(MovingContact {
            joint: contact.contact,
            between: names(contact.contact),
            modes,
            closed: state.part,
            points: state.ends.iter().map(|point| (point + problem.pole).into()).collect(),
            rotation: state.rotation.into(),
            slip: state.slip().into(),
            opening: rates.iter().map(|rate| rate.x).fold(0.0, f64::max),
            share: state.share,
        });
    }
    let kind = kind(&contacts);
    let (hinges, sliding, crushing) = (Vec::new(), Vec::new(), Vec::new());
    Some(Mechanism { kind, hinge_count: distinct(axes), unique, hinges, sliding, crushing, contacts, at: None })
}

/// Returns the kind of a mechanism in space.
fn kind(contacts: &[MovingContact]) -> MechanismKind {
    let any = |mode| contacts.iter().any(|contact| contact.has(mode));
    let found = [ContactMode::Hinge, ContactMode::Sliding, ContactMode::Twisting, ContactMode::Crushing].map(any);
    match found {
        [true, false, false, false] => MechanismKind::Rocking,
        [false, true, false, false] => MechanismKind::Sliding,
        [false, false, true, false] => MechanismKind::Twisting,
        [false, false, false, true] => MechanismKind::Crushing,
        [false, false, false, false] => MechanismKind::Separating,
        _ => MechanismKind::Mixed,
    }
}

/// The rates of a contact with its closed points.
struct State<'a> {
    contact: &'a SpaceContact,
    rates: &'a [Vec3],
    /// Rates up to this size are rounding.
    still: f64,
    /// Indices of the closed points.
    closed: Vec<usize>,
    part: ClosedPart,
    /// The ends of a closed edge, or the closed vertex, relative to the pole.
    ends: Vec<Vec3>,
    /// Velocity of plus relative to minus at the pole.
    velocity: Vec3,
    /// Rotation of plus relative to minus.
    rotation: Vec3,
    /// Crushed share of the area.
    share: f64,
}

impl<'a> State<'a> {
    fn new(contact: &'a SpaceContact, rates: &'a [Vec3], motion: &[SpaceVelocity], flow: FlowRule, still: f64) -> Self {
        let dilatancy = match flow {
            FlowRule::Associated => contact.law.friction,
            FlowRule::NonAssociated => contact.law.dilatancy,
        };
        let clear: Vec<f64> = rates.iter().map(|rate| rate.x - dilatancy * rate.y.hypot(rate.z)).collect();
        let crushable = contact.law.compressive_strength.is_finite();
        let areas = clear.iter().zip(&contact.outer.areas);
        let crushed = areas.filter(|(clear, _)| crushable && **clear < -still).fold(0.0, |sum, (_, area)| sum + area);
        let whole: f64 = contact.outer.areas.iter().sum();
        let closed: Vec<usize> = (0..clear.len()).filter(|k| clear[*k] <= still).collect();
        let points: Vec<Vec3> = closed.iter().map(|k| contact.outer.points[*k]).collect();
        let (part, ends) = extent(&points);
        let part_of = |body: Option<usize>, from: usize| {
            body.map_or(Vec3::zeros(), |body| Vec3::from_column_slice(&motion[body][from..from + 3]))
        };
        let [velocity, rotation] = [0, 3].map(|from| part_of(contact.plus, from) - part_of(contact.minus, from));
        let share = if whole > 0.0 { crushed / whole } else { 0.0 };
        State { contact, rates, still, closed, part, ends, velocity, rotation, share }
    }

    /// Returns the ways in which the contact moves.
    fn modes(&self) -> Vec<ContactMode> {
        let mut modes = Vec::new();
        if self.closed.is_empty() {
            modes.push(ContactMode::Separating);
            return modes;
        }
        if self.share > CRUSHES {
            modes.push(ContactMode::Crushing);
        } else if (self.part != ClosedPart::Face || self.share > 0.0) && self.tilts() {
            modes.push(ContactMode::Hinge);
        }
        let slips = || self.closed.iter().map(|k| (self.rates[*k].y, self.rates[*k].z));
        if slips().any(|(s, t)| s.hypot(t) > self.still) {
            let rests = slips().any(|(s, t)| s.hypot(t) <= self.still);
            let turns = self.closed.len() > 1 && (rests || !on_one_side(slips()));
            modes.push(if turns { ContactMode::Twisting } else { ContactMode::Sliding });
        }
        modes
    }

    /// Returns true if the rotation across the normal opens the contact unequally.
    fn tilts(&self) -> bool {
        let openings = || self.rates.iter().map(|rate| rate.x);
        let [low, high] = [openings().fold(f64::INFINITY, f64::min), openings().fold(f64::NEG_INFINITY, f64::max)];
        high - low > self.still
    }

    /// Returns the slip at the mean of the closed points.
    fn slip(&self) -> Vec3 {
        let sum: Vec3 = self.closed.iter().map(|k| self.rates[*k]).sum();
        let [_, s, t] = &self.contact.frame;
        (s * sum.y + t * sum.z) / self.closed.len().max(1) as f64
    }

    /// Returns numbers that two lines share if they are equal, for the axis of the relative rotation: d dᵀ of its direction d, and its
    /// point nearest the pole relative to a length.
    fn axis(&self, length: f64) -> [f64; 9] {
        let d = self.rotation.normalize();
        let near = self.rotation.cross(&self.velocity) / self.rotation.norm_squared() / length;
        [d.x * d.x, d.y * d.y, d.z * d.z, d.x * d.y, d.y * d.z, d.z * d.x, near.x, near.y, near.z]
    }
}

/// Returns the part of a contact that these closed points are, with the ends of an edge or the vertex.
fn extent(points: &[Vec3]) -> (ClosedPart, Vec<Vec3>) {
    let Some(first) = points.first() else { return (ClosedPart::Nothing, Vec::new()) };
    let farthest = |from: &Vec3| {
        let apart = |point: &Vec3| (point - from).norm_squared();
        points.iter().copied().reduce(|best, point| if apart(&point) > apart(&best) { point } else { best })
    };
    let a = farthest(first).unwrap_or(*first);
    let b = farthest(&a).unwrap_or(*first);
    let along = b - a;
    if along.norm_squared() == 0.0 {
        return (ClosedPart::Vertex, vec![a]);
    }
    let beside = |point: &Vec3| (point - a).cross(&along).norm() / along.norm_squared();
    if points.iter().all(|point| beside(point) <= STRAIGHT) {
        (ClosedPart::Edge, vec![a, b])
    } else {
        (ClosedPart::Face, Vec::new())
    }
}

/// Returns true if all directions are on one side of a line through the origin.
fn on_one_side(directions: impl Iterator<Item = (f64, f64)>) -> bool {
    let mut angles: Vec<f64> = directions.map(|(s, t)| t.atan2(s)).collect();
    angles.sort_by(f64::total_cmp);
    let (Some(first), Some(last)) = (angles.first(), angles.last()) else { return true };
    let between = angles.windows(2).map(|pair| pair[1] - pair[0]);
    between.fold(first + TAU - last, f64::max) > PI + STRAIGHT
}

/// Returns the number of distinct axes: those that a chain of equal axes joins are one.
fn distinct(mut axes: Vec<[f64; 9]>) -> usize {
    // Any fixed weights without a pattern keep few distinct axes near each other in the order.
    const WEIGHTS: [f64; 9] = [0.31, 0.73, 0.19, 0.57, 0.41, 0.89, 0.67, 0.23, 0.97];
    let key = |axis: &[f64; 9]| -> f64 { axis.iter().zip(WEIGHTS).map(|(x, weight)| x * weight).sum() };
    let window = SAME_AXIS * WEIGHTS.iter().sum::<f64>();
    axes.sort_by(|a, b| key(a).total_cmp(&key(b)));
    let mut group: Vec<usize> = (0..axes.len()).collect();
    let mut count = axes.len();
    for i in 0..axes.len() {
        for j in (0..i).rev().take_while(|j| key(&axes[i]) - key(&axes[*j]) <= window) {
            let same = axes[i].iter().zip(&axes[j]).all(|(a, b)| (a - b).abs() <= SAME_AXIS);
            let (one, other) = (root(&mut group, i), root(&mut group, j));
            if same && one != other {
                group[one] = other;
                count -= 1;
            }
        }
    }
    count
}

/// Returns the representative of a group, and shortens the way to it.
fn root(group: &mut [usize], mut of: usize) -> usize {
    while group[of] != of {
        group[of] = group[group[of]];
        of = group[of];
    }
    of
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::FrictionCone;
    use crate::nalgebra::{Matrix3, Rotation3};

    const DRY: FrictionCone = FrictionCone {
        friction: 0.5,
        dilatancy: 0.0,
        cohesion: 0.0,
        tensile_strength: 0.0,
        compressive_strength: f64::INFINITY,
    };

    /// A horizontal rectangle of free body `plus` on another body or the ground, seen from below.
    fn face(index: usize, bodies: [Option<usize>; 2], x: [f64; 2], y: [f64; 2], law: FrictionCone) -> SpaceContact {
        let corners = [[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]];
        let vertices = corners.map(|[x, y]| Vec3::new(x, y, 0.0));
        SpaceContact::new(index, bodies, &vertices, [Vec3::z(), Vec3::x(), Vec3::y()], (law, 8))
    }

    fn problem(bodies: usize, contacts: Vec<SpaceContact>) -> SpaceProblem {
        let none = vec![[0.0; 6]; bodies];
        let free = (0..bodies).map(Some).collect();
        SpaceProblem { free, bodies, contacts, fixed: none.clone(), varying: none, pole: Vec3::zeros(), length: 2.0 }
    }

    /// A unit square from the origin on the ground.
    fn square(law: FrictionCone) -> SpaceProblem {
        problem(1, vec![face(0, [None, Some(0)], [0.0, 1.0], [0.0, 1.0], law)])
    }

    fn found(problem: &SpaceProblem, motion: &[SpaceVelocity], flow: FlowRule) -> Mechanism {
        let names = |_: usize| ["a".to_string(), "b".to_string()];
        space_mechanism(problem, &names, motion, None, flow).expect("a mechanism")
    }

    /// The motion of a body that turns about an axis through a point and moves along a direction.
    fn turning(axis: [f64; 3], through: [f64; 3], along: [f64; 3]) -> SpaceVelocity {
        let v = Vec3::from(along) - Vec3::from(axis).cross(&Vec3::from(through));
        [v.x, v.y, v.z, axis[0], axis[1], axis[2]]
    }

    /// Each motion of a block on the ground has the mode, the closed part and the kind that the drawing shows.
    #[test]
    fn motions_of_one_block_are_named() {
        use ClosedPart::{Edge, Face, Nothing, Vertex};
        use ContactMode::{Hinge, Separating, Sliding, Twisting};
        let none = [0.0; 3];
        let diagonal = [1.0, -1.0, 0.0];
        for (motion, modes, closed, kind) in [
            (turning(none, none, [1.0, 0.5, 0.0]), vec![Sliding], Face, MechanismKind::Sliding),
            (turning([0.0, 1.0, 0.0], [1.0, 0.0, 0.0], none), vec![Hinge], Edge, MechanismKind::Rocking),
            (turning([-1.0, 1.0, 0.3], [1.0, 1.0, 0.0], none), vec![Hinge], Vertex, MechanismKind::Rocking),
            (turning([0.0, 0.0, 2.0], [0.4, 0.7, 0.0], none), vec![Twisting], Face, MechanismKind::Twisting),
            (turning([0.0, 0.0, 2.0], [1.0, 1.0, 0.0], none), vec![Twisting], Face, MechanismKind::Twisting),
            (turning([0.0, 0.0, 2.0], [1.2, 0.5, 0.0], none), vec![Sliding], Face, MechanismKind::Sliding),
            (turning(none, none, [0.2, 0.0, 1.0]), vec![Separating], Nothing, MechanismKind::Separating),
            (turning(diagonal, none, [0.0, 0.0, 2.0]), vec![Separating], Nothing, MechanismKind::Separating),
            (
                turning([0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.1, 0.0, 0.0]),
                vec![Hinge, Sliding],
                Edge,
                MechanismKind::Mixed,
            ),
            (turning([0.0, 1.0, 0.2], [1.0, 0.5, 0.0], none), vec![Hinge, Twisting], Edge, MechanismKind::Mixed),
        ] {
            let own = found(&square(DRY), &[motion], FlowRule::NonAssociated);
            let [contact] = own.contacts.as_slice() else { panic!("{own:?}") };
            assert_eq!((&contact.modes, contact.closed, own.kind), (&modes, closed, kind), "{motion:?}");
            assert_eq!(own.hinge_count, usize::from(modes.contains(&Hinge)), "{motion:?}");
        }
        let names = |_: usize| Default::default();
        assert!(space_mechanism(&square(DRY), &names, &[[0.0; 6]], None, FlowRule::Associated).is_none());
    }

    /// A hinge has the ends of its edge, and the rotation and opening of its block.
    #[test]
    fn a_hinge_has_its_edge() {
        let motion = turning([0.0, 0.5, 0.0], [1.0, 0.0, 0.0], [0.0; 3]);
        let own = found(&square(DRY), &[motion], FlowRule::NonAssociated);
        let mut points = own.contacts[0].points.clone();
        points.sort_by(|a, b| a[1].total_cmp(&b[1]));
        assert_eq!(points, [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0]]);
        assert_eq!((own.contacts[0].rotation, own.contacts[0].opening), ([0.0, 0.5, 0.0], 0.5));
        assert_eq!(own.contacts[0].slip, [0.0; 3]);
    }

    /// With associated flow slip opens the contact by μ times the slip, and the contact still slides or twists.
    #[test]
    fn associated_slip_keeps_contacts_closed() {
        let law = FrictionCone { dilatancy: 0.5, ..DRY };
        let slides = found(&square(law), &[[3.0, 4.0, 2.5, 0.0, 0.0, 0.0]], FlowRule::Associated);
        assert_eq!((slides.kind, slides.contacts[0].closed), (MechanismKind::Sliding, ClosedPart::Face));
        assert_eq!(slides.contacts[0].slip, [3.0, 4.0, 0.0]);
        let lift = 0.5 * 0.5f64.sqrt();
        let twists =
            found(&square(law), &[turning([0.0, 0.0, 1.0], [0.5, 0.5, 0.0], [0.0, 0.0, lift])], FlowRule::Associated);
        assert_eq!((twists.kind, twists.contacts[0].closed), (MechanismKind::Twisting, ClosedPart::Face));
        assert!(twists.contacts[0].slip.iter().all(|x| x.abs() < 1e-15));
        // The same motion with a flow that does not open leaves the contact.
        let apart = found(&square(DRY), &[[3.0, 4.0, 2.5, 0.0, 0.0, 0.0]], FlowRule::NonAssociated);
        assert_eq!(apart.kind, MechanismKind::Separating);
    }

    /// Hinges on one line count once, parallel ones do not, whatever the order of minus and plus.
    #[test]
    fn hinges_on_one_line_count_once() {
        let turn = |x: f64| turning([0.0, 1.0, 0.0], [x, 0.0, 0.0], [0.0; 3]);
        let on = |body: usize, x: [f64; 2], y: [f64; 2]| face(body, [None, Some(body)], x, y, DRY);
        let row = |second: [f64; 2]| vec![on(0, [0.0, 1.0], [0.0, 1.0]), on(1, second, [1.5, 2.0])];
        let count = |contacts, ends: [f64; 2]| {
            found(&problem(2, contacts), &ends.map(turn), FlowRule::NonAssociated).hinge_count
        };
        assert_eq!(count(row([0.2, 1.0]), [1.0, 1.0]), 1);
        assert_eq!(count(row([0.2, 1.1]), [1.0, 1.1]), 2);
        let mut reversed = row([0.2, 1.0]);
        (reversed[1].minus, reversed[1].plus) = (Some(1), None);
        reversed[1].frame[0] *= -1.0;
        reversed[1].frame.swap(1, 2);
        assert_eq!(count(reversed, [1.0, 1.0]), 1);
    }

    /// Contacts along a stepped fold turn about the one line of the fold, though each is closed along another edge.
    #[test]
    fn a_stepped_fold_has_one_axis() {
        let upright = |index: usize, y: f64, z: f64| {
            let corners = [[0.0, z], [1.0, z], [1.0, z + 1.0], [0.0, z + 1.0]];
            let vertices = corners.map(|[x, z]| Vec3::new(x, y, z));
            let frame = [Vec3::y(), Vec3::z(), Vec3::x()];
            SpaceContact::new(index, [None, Some(0)], &vertices, frame, (DRY, 1))
        };
        let bed = face(0, [None, Some(0)], [0.0, 1.0], [0.0, 1.0], DRY);
        let fold = problem(1, vec![bed, upright(1, 0.0, 0.0), upright(2, -1.0, 1.0)]);
        let motion = turning([0.0, -1.0, 1.0], [0.0, 0.0, 0.0], [0.0; 3]);
        let own = found(&fold, &[motion], FlowRule::NonAssociated);
        assert_eq!((own.hinge_count, own.count_of(ContactMode::Hinge)), (1, 3), "{own:?}");
        assert!(own.contacts.iter().all(|contact| contact.closed == ClosedPart::Edge));
    }

    /// A contact that crushes over less than half of its area is a hinge, over more it crushes.
    #[test]
    fn crushing_is_a_mode() {
        let law = FrictionCone { compressive_strength: 10.0, ..DRY };
        let kind = |x: f64| {
            let motion = turning([0.0, 1.0, 0.0], [x, 0.0, 0.0], [0.0; 3]);
            // The motion turns the block down beyond x.
            let own = found(&square(law), &[motion], FlowRule::NonAssociated);
            (own.kind, own.hinge_count, own.contacts[0].share)
        };
        let (rocks, axes, share) = kind(0.8);
        assert_eq!((rocks, axes), (MechanismKind::Rocking, 1));
        assert!(share > 0.1 && share < 0.25, "{share}");
        assert_eq!(kind(0.2).0, MechanismKind::Crushing);
        assert_eq!(
            found(&square(law), &[[0.0, 0.0, -1.0, 0.0, 0.0, 0.0]], FlowRule::Associated).contacts[0].share,
            1.0
        );
    }

    /// A rotation, a mirror image and another numbering keep kind, counts and sizes.
    #[test]
    fn images_have_the_same_mechanism() {
        let contacts = vec![
            face(0, [None, Some(0)], [0.0, 1.0], [0.0, 1.0], DRY),
            face(1, [None, Some(1)], [1.0, 2.0], [0.0, 1.0], DRY),
            face(2, [None, Some(2)], [2.0, 3.0], [0.0, 1.0], DRY),
            face(3, [Some(2), Some(0)], [0.3, 0.9], [0.2, 0.6], DRY),
        ];
        let own = problem(3, contacts);
        let motion = [
            turning([0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0; 3]),
            turning([0.0, 0.0, 1.0], [1.5, 0.5, 0.0], [0.0; 3]),
            turning([0.0; 3], [0.0; 3], [0.2, 0.1, 0.0]),
        ];
        let summary = |mechanism: &Mechanism| {
            let modes = [ContactMode::Hinge, ContactMode::Sliding, ContactMode::Twisting, ContactMode::Separating];
            (mechanism.kind, mechanism.hinge_count, modes.map(|mode| mechanism.count_of(mode)))
        };
        let expected = found(&own, &motion, FlowRule::NonAssociated);
        assert_eq!(summary(&expected), (MechanismKind::Mixed, 1, [1, 1, 1, 1]));
        let turn = *Rotation3::from_euler_angles(0.4, -1.1, 2.3).matrix();
        let mirror = Matrix3::from_diagonal(&Vec3::new(1.0, -1.0, 1.0));
        for map in [turn, mirror, turn * mirror] {
            let sign = map.determinant();
            let mut image = own.clone();
            for contact in &mut image.contacts {
                contact.outer.points.iter_mut().for_each(|point| *point = map * *point);
                contact.frame = contact.frame.map(|axis| map * axis);
            }
            let moved = motion.map(|[x, y, z, a, b, c]| {
                let (v, turn) = (map * Vec3::new(x, y, z), map * Vec3::new(a, b, c) * sign);
                [v.x, v.y, v.z, turn.x, turn.y, turn.z]
            });
            let found = found(&image, &moved, FlowRule::NonAssociated);
            assert_eq!(summary(&found), summary(&expected));
            for (a, b) in found.contacts.iter().zip(&expected.contacts) {
                assert_eq!((&a.modes, a.closed, a.points.len()), (&b.modes, b.closed, b.points.len()));
                assert!((a.opening - b.opening).abs() < 1e-14);
                assert!((Vec3::from(a.rotation) - map * Vec3::from(b.rotation) * sign).norm() < 1e-14);
                assert!((Vec3::from(a.slip) - map * Vec3::from(b.slip)).norm() < 1e-14);
            }
        }
        let mut renumbered = own.clone();
        renumbered.contacts.reverse();
        let number = |body: Option<usize>| body.map(|body| [2, 0, 1][body]);
        for contact in &mut renumbered.contacts {
            (contact.minus, contact.plus) = (number(contact.minus), number(contact.plus));
        }
        let again = found(&renumbered, &[motion[1], motion[2], motion[0]], FlowRule::NonAssociated);
        assert_eq!(summary(&again), summary(&expected));
    }
}
