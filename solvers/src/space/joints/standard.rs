//! The standard position of a scene.
//!
//! Rounding can decide which state a course reaches. So that scenes that are turned, mirrored, numbered in another way, or given in other
//! units have the same states, courses run in a standard position. Its axes follow the loads; lengths and forces are relative to those
//! of the scene; places decide about the order of bodies, contacts and points; and all numbers are multiples of 2⁻³³, so that rounding of
//! the given ones vanishes. The ends of the courses are moved to the given scene, and Newton steps (`refine`) lead to a state there.
//!
//! The first axis is opposite to the sum of the fixed loads: usually it points upwards. The second one is the part of the sum of the varying
//! loads across it. If a sum vanishes, the places of the loads or the third moments of the contact points replace it. Such vectors
//! decide about the sense of the third axis, too. A scene that has none of them keeps its axes; a scene that is its own
//! mirror image needs no sense.

use super::rigid::Guess;
use crate::space::settings::JOINTS;
use voussoir_core::space::{PointSet, SpaceContact, SpaceField, SpaceProblem, Vec3, Wrench};

/// A contact in standard position.
struct Place {
    /// Its index in the given problem.
    contact: usize,
    /// The given index of each of its points.
    points: Vec<usize>,
    /// True if plus and minus are exchanged.
    exchanged: bool,
}

/// A problem in standard position, and its relation to the given one.
pub struct Standard {
    /// The problem. Its pole is the centre of the contact points, and its length is 1.
    pub problem: SpaceProblem,
    position: Position,
    /// Given index of each body.
    bodies: Vec<usize>,
    contacts: Vec<Place>,
}

impl Standard {
    /// Moves a problem. Returns `None` if it has no contacts or no loads.
    pub fn new(problem: &SpaceProblem) -> Option<Self> {
        let position = Position::new(problem)?;
        let [fixed, varying] =
            [&problem.fixed, &problem.varying].map(|all| all.iter().map(|own| position.wrench(own)).collect());
        let bodies = order(problem, &position, [&fixed, &varying]);
        let mut numbers = vec![0; problem.bodies];
        bodies.iter().enumerate().for_each(|(number, body)| numbers[*body] = number);
        let contacts = problem.contacts.iter().enumerate();
        let moved = contacts.map(|(index, own)| contact(&position, (index, own), &numbers));
        let mut moved: Vec<(SpaceContact, Place)> = moved.collect();
        moved.sort_by_cached_key(|(own, _)| (own.plus, own.minus, sum(&own.inner.points), key(&own.frame[0])));
        let (contacts, places) = moved.into_iter().unzip();
        let of = |wrenches: &Vec<Wrench>| bodies.iter().map(|body| wrenches[*body]).collect();
        let problem = SpaceProblem {
            free: (0..problem.bodies).map(Some).collect(),
            bodies: problem.bodies,
            contacts,
            fixed: of(&fixed),
            varying: of(&varying),
            pole: Vec3::zeros(),
            length: 1.0,
        };
        Some(Standard { problem, position, bodies, contacts: places })
    }

    /// Returns forces and motion in standard position for the given problem.
    pub fn given(&self, problem: &SpaceProblem, guess: &Guess) -> Guess {
        let Position { hand, centre, length, force, .. } = self.position;
        let mut motion = vec![[0.0; 6]; problem.bodies];
        for (body, v) in self.bodies.iter().zip(&guess.motion) {
            let rotation = self.position.back(&Vec3::new(v[3], v[4], v[5])) * hand / length;
            let velocity = self.position.back(&Vec3::new(v[0], v[1], v[2])) - rotation.cross(&centre);
            motion[*body] = [velocity.x, velocity.y, velocity.z, rotation.x, rotation.y, rotation.z];
        }
        let field = problem.contacts.iter().map(|contact| vec![[0.0; 3]; contact.inner.points.len()]);
        let mut field: SpaceField = field.collect();
        for ((contact, place), forces) in self.problem.contacts.iter().zip(&self.contacts).zip(&guess.field) {
            let turned = self.tangents(problem, contact, place);
            for (point, [n, s, t]) in place.points.iter().zip(forces) {
                let [first, second] = turned.map(|own| own[0] * s + own[1] * t);
                field[place.contact][*point] = [n * force, first * force, second * force];
            }
        }
        Guess { factor: guess.factor, field, motion }
    }

    /// Returns forces of the given problem in standard position.
    pub fn field(&self, problem: &SpaceProblem, field: &SpaceField) -> SpaceField {
        let of = |(contact, place): (&SpaceContact, &Place)| {
            let turned = self.tangents(problem, contact, place);
            let moved = |point: &usize| {
                let [n, s, t] = field[place.contact][*point].map(|f| f / self.position.force);
                [n, turned[0][0] * s + turned[1][0] * t, turned[0][1] * s + turned[1][1] * t]
            };
            place.points.iter().map(moved).collect()
        };
        self.problem.contacts.iter().zip(&self.contacts).map(of).collect()
    }

    /// Returns the components of both tangents in standard position along the given tangents, for forces on the given plus body.
    fn tangents(&self, problem: &SpaceProblem, contact: &SpaceContact, place: &Place) -> [[f64; 2]; 2] {
        let sign = if place.exchanged { -1.0 } else { 1.0 };
        let own = [1, 2].map(|k| self.position.back(&contact.frame[k]) * sign);
        [1, 2].map(|k| own.map(|axis| problem.contacts[place.contact].frame[k].dot(&axis)))
    }
}

/// Returns the bodies in the order of their places and loads.
fn order(problem: &SpaceProblem, position: &Position, [fixed, varying]: [&Vec<Wrench>; 2]) -> Vec<usize> {
    let mut sums = vec![[0; 3]; problem.bodies];
    for contact in &problem.contacts {
        let points: Vec<Vec3> = contact.inner.points.iter().map(|x| position.place(x)).collect();
        for body in [contact.plus, contact.minus].into_iter().flatten() {
            let own = sum(&points);
            (0..3).for_each(|k| sums[body][k] += own[k]);
        }
    }
    let mut bodies: Vec<usize> = (0..problem.bodies).collect();
    bodies.sort_by_key(|body| (sums[*body], [fixed, varying].map(|loads| loads[*body].map(whole))));
    bodies
}

/// Moves a contact with its index. Plus is the body with the lower number, and the ground is minus.
fn contact(position: &Position, (index, given): (usize, &SpaceContact), numbers: &[usize]) -> (SpaceContact, Place) {
    let [plus, minus] = [given.plus, given.minus].map(|body| body.map(|body| numbers[body]));
    let exchanged = plus.is_none() || minus.is_some_and(|minus| plus > Some(minus));
    let (plus, minus, sign) = if exchanged { (minus, plus, -1.0) } else { (plus, minus, 1.0) };
    let normal = rounded(&(position.turned(&given.frame[0]) * sign)).normalize();
    let axis = if normal.x.abs() < 0.6 { Vec3::x() } else { Vec3::y() };
    let first = (axis - normal * normal.dot(&axis)).normalize();
    let places: Vec<Vec3> = given.inner.points.iter().map(|x| position.place(x)).collect();
    let mut points: Vec<usize> = (0..places.len()).collect();
    points.sort_by_key(|point| key(&places[*point]));
    let area = |point: &usize| near(given.inner.areas[*point] / position.length.powi(2));
    let set = PointSet {
        areas: points.iter().map(area).collect(),
        points: points.iter().map(|point| places[*point]).collect(),
    };
    let frame = [normal, first, normal.cross(&first)];
    let moved = SpaceContact { plus, minus, frame, inner: set.clone(), outer: set, ..given.clone() };
    (moved, Place { contact: index, points, exchanged })
}

/// Place, axes and units of the standard position.
struct Position {
    axes: [Vec3; 3],
    /// 1, or −1 for a mirror image.
    hand: f64,
    /// Centre of the contact points.
    centre: Vec3,
    length: f64,
    force: f64,
}

impl Position {
    /// Returns `None` without contacts or loads.
    fn new(problem: &SpaceProblem) -> Option<Self> {
        let points = || problem.contacts.iter().flat_map(|contact| &contact.inner.points);
        let count = points().count() as f64;
        let centre = points().sum::<Vec3>() / count;
        let length = (points().map(|x| (x - centre).norm_squared()).sum::<f64>() / count).sqrt();
        let force = [&problem.fixed, &problem.varying].map(|loads| size(loads)).iter().sum::<f64>();
        let known = [length, force].iter().all(|unit| *unit > 0.0 && unit.is_finite());
        let axes = if known { axes(problem, &centre, length) } else { return None };
        let hand = axes[0].cross(&axes[1]).dot(&axes[2]).signum();
        Some(Position { axes, hand, centre, length, force })
    }

    fn turned(&self, x: &Vec3) -> Vec3 {
        Vec3::from(self.axes.map(|axis| axis.dot(x)))
    }

    fn back(&self, x: &Vec3) -> Vec3 {
        self.axes[0] * x.x + self.axes[1] * x.y + self.axes[2] * x.z
    }

    fn place(&self, x: &Vec3) -> Vec3 {
        rounded(&(self.turned(&(x - self.centre)) / self.length))
    }

    fn wrench(&self, given: &Wrench) -> Wrench {
        let moment = Vec3::new(given[3], given[4], given[5]) - self.centre.cross(&force(given));
        let f = rounded(&(self.turned(&force(given)) / self.force));
        let m = rounded(&(self.turned(&moment) * (self.hand / (self.force * self.length))));
        [f.x, f.y, f.z, m.x, m.y, m.z]
    }
}

fn force(wrench: &Wrench) -> Vec3 {
    Vec3::new(wrench[0], wrench[1], wrench[2])
}

/// Returns the sum of the sizes of forces.
fn size(wrenches: &[Wrench]) -> f64 {
    wrenches.iter().map(|wrench| force(wrench).norm()).sum()
}

/// Returns the number of distances of the grid.
fn whole(x: f64) -> i64 {
    (x / JOINTS.grid).round() as i64
}

/// Returns the nearest number of the grid; zero has no sign.
fn near(x: f64) -> f64 {
    (x / JOINTS.grid).round() * JOINTS.grid + 0.0
}

fn rounded(x: &Vec3) -> Vec3 {
    x.map(near)
}

fn key(x: &Vec3) -> [i64; 3] {
    [x.x, x.y, x.z].map(whole)
}

/// Returns the sum of points as whole numbers, which does not depend on their order.
fn sum(points: &[Vec3]) -> [i64; 3] {
    let all = || points.iter().map(key);
    std::array::from_fn(|k| all().map(|x| x[k]).sum())
}

/// Returns three axes that turn with the scene and are mirrored with it.
fn axes(problem: &SpaceProblem, centre: &Vec3, length: f64) -> [Vec3; 3] {
    let of =
        |contact: &SpaceContact| -> Vec<Vec3> { contact.inner.points.iter().map(|x| (x - centre) / length).collect() };
    let points: Vec<Vec<Vec3>> = problem.contacts.iter().map(of).collect();
    // The place of the loads of a body is the centre of its contact points.
    let mut middles = vec![(Vec3::zeros(), 0.0f64); problem.bodies];
    for (contact, points) in problem.contacts.iter().zip(&points) {
        for body in [contact.plus, contact.minus].into_iter().flatten() {
            middles[body].0 += points.iter().sum::<Vec3>();
            middles[body].1 += points.len() as f64;
        }
    }
    let part = |sum: Vec3, wrenches: &[Wrench]| sum / size(wrenches).max(f64::MIN_POSITIVE);
    let total = |wrenches: &[Wrench]| part(wrenches.iter().map(force).sum(), wrenches);
    let middle = |wrenches: &[Wrench]| {
        let places = middles.iter().map(|(sum, count)| sum / count.max(1.0));
        part(wrenches.iter().zip(places).map(|(wrench, x)| x * force(wrench).norm()).sum(), wrenches)
    };
    let mean = |weight: &dyn Fn(&Vec3) -> f64| {
        let all = || points.iter().flatten();
        all().map(|x| x * weight(x)).sum::<Vec3>() / all().count() as f64
    };
    let (fixed, varying) = (&problem.fixed, &problem.varying);
    let own = [-total(fixed), total(varying), middle(varying), middle(fixed), mean(&Vec3::norm_squared)];
    let given = [Vec3::z(), Vec3::x(), Vec3::y()];
    let vectors = || own.iter().chain(&given);
    let first = vectors().find(|x| x.norm() > JOINTS.none).map_or(given[0], Vec3::normalize);
    let mut others = vectors().map(|x| x - first * first.dot(x));
    let second = others.find(|x| x.norm() > JOINTS.none).map_or(given[1], |x| x.normalize());
    let third = first.cross(&second);
    let [up, along] = [first, second].map(|axis| move |x: &Vec3| x.dot(&axis));
    let moments = [mean(&along), mean(&up), mean(&|x| up(x) * along(x))];
    let mut senses = own.iter().chain(&moments).map(|x| x.dot(&third));
    let sense = senses.find(|x| x.abs() > JOINTS.none).map_or(1.0, f64::signum);
    [first, second, third * sense]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::tests::invariance::{direction, in_units, mapped, renumbered, scene};
    use voussoir_core::nalgebra::Rotation3;

    /// Images of a scene have the same numbers in standard position, to the last bit.
    #[test]
    fn images_have_one_standard_position() {
        let problem = scene(3, 4).problem(&direction());
        let own = Standard::new(&problem).unwrap().problem;
        let turn = Rotation3::from_euler_angles(0.4, -1.1, 2.3);
        let mirror = |x: &Vec3| Vec3::new(x.x, -x.y, x.z);
        let shift = Vec3::new(0.3, -0.7, 0.5);
        for image in [
            mapped(&problem, |x| turn * x, |x| turn * x, false),
            mapped(&problem, |x| x + shift, |x| *x, false),
            mapped(&problem, mirror, mirror, true),
            in_units(&problem, [1e3, 1e-2]),
            renumbered(&problem),
        ] {
            let other = Standard::new(&image).unwrap().problem;
            assert_eq!((&own.fixed, &own.varying), (&other.fixed, &other.varying));
            for (own, other) in own.contacts.iter().zip(&other.contacts) {
                assert_eq!((own.plus, own.minus, own.frame), (other.plus, other.minus, other.frame));
                assert_eq!(own.inner, other.inner);
            }
        }
    }

    /// Forces that are moved to the standard position and back are the same, and a motion that is moved back does the same work.
    #[test]
    fn forces_and_motions_move_back() {
        let problem = renumbered(&scene(3, 4).problem(&direction()));
        let standard = Standard::new(&problem).unwrap();
        let given: SpaceField = problem
            .contacts
            .iter()
            .enumerate()
            .map(|(k, contact)| {
                let count = contact.inner.points.len();
                (0..count).map(|point| [1.0 + k as f64, 0.1 * point as f64, -0.3]).collect()
            })
            .collect();
        let motion = (0..problem.bodies).map(|k| [0.1, 0.2, k as f64, 0.3, -0.4, 0.5 * k as f64]).collect();
        let guess = Guess { factor: 0.5, field: standard.field(&problem, &given), motion };
        let back = standard.given(&problem, &guess);
        let apart =
            back.field.iter().flatten().flatten().zip(given.iter().flatten().flatten()).map(|(a, b)| (a - b).abs());
        assert!(apart.fold(0.0, f64::max) < 1e-8);
        let work = |problem: &SpaceProblem, motion: &[_]| voussoir_core::space::power(&problem.varying, motion);
        let unit = standard.position.force;
        let (own, moved) = (work(&standard.problem, &guess.motion) * unit, work(&problem, &back.motion));
        assert!((own - moved).abs() < 1e-8 * own.abs(), "{own} {moved}");
    }
}
