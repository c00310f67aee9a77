//! Rates of gaps and of unbalanced forces along a direction, with finite displacements: the equations of
//! [`Displaced`](super::Displaced) with derivatives.

use super::dual::{Dual, Dual2};
use crate::path::{Attachment, Contact, PathProblem, PathRate, PathState};

/// Wrenches by body, in ascending order.
type Wrenches = Vec<(usize, [Dual; 3])>;

/// Displacement of a point by the rigid motion and by the deformation of its body.
type Parts = [Dual2; 2];

/// Rates (n, t) of gaps by contact point, and rates of the unbalanced wrench by body, both in ascending order.
pub(super) struct ResidualRates {
    pub gaps: Vec<(usize, [Dual; 2])>,
    pub unbalanced: Vec<(usize, [Dual; 3])>,
}

/// A state that moves along rates of forces, motions and the factor. Bodies must not yield, and no law may be a response.
pub(super) struct Moving<'a> {
    problem: &'a PathProblem,
    /// Motions of all bodies.
    motion: Vec<[Dual; 3]>,
    force: Vec<[Dual; 2]>,
    /// The applied share of each load step.
    applied: Vec<Dual>,
    /// Deformation of the points of all bodies in axes that rotate with them.
    deformation: Vec<Vec<Dual2>>,
    /// Contact points of every body.
    points_of: Vec<Vec<usize>>,
}

impl<'a> Moving<'a> {
    /// Creates a state that moves along a direction; its gap rates are not used.
    pub fn new(problem: &'a PathProblem, state: &PathState, along: &PathRate) -> Self {
        let pair = |i: usize, (value, rate): (&[f64; 2], &[f64; 2])| Dual::new(value[i], rate[i]);
        let motion = state.motion.iter().zip(&along.motion);
        let motion = motion.map(|(u, v)| [0, 1, 2].map(|i| Dual::new(u[i], v[i]))).collect();
        let force = state.force.iter().zip(&along.force).map(|own| [0, 1].map(|i| pair(i, own))).collect();
        let applied = problem.applied(state.load_step, state.factor).into_iter().enumerate();
        let applied = applied.map(|(step, a)| Dual::new(a, if step == state.load_step { along.factor } else { 0.0 }));
        let mut points_of = vec![Vec::new(); problem.bodies.len()];
        for (index, contact) in problem.contacts.iter().enumerate() {
            points_of[contact.minus.body].push(index);
            points_of[contact.plus.body].push(index);
        }
        let applied = applied.collect();
        let mut moving = Moving { problem, motion, force, applied, deformation: Vec::new(), points_of };
        moving.deformation = (0..problem.bodies.len()).map(|body| moving.deformation_of(body)).collect();
        moving
    }
}

fn add_wrench(wrenches: &mut Wrenches, body: usize, own: [Dual; 3]) {
    if let Ok(place) = wrenches.binary_search_by_key(&body, |wrench| wrench.0) {
        let sum = &mut wrenches[place].1;
        (0..3).for_each(|i| sum[i] = sum[i] + own[i]);
    }
}

/// Returns indices in ascending order, each once.
fn each_once(indices: impl IntoIterator<Item = usize>) -> Vec<usize> {
    let mut all: Vec<usize> = indices.into_iter().collect();
    all.sort_unstable();
    all.dedup();
    all
}

impl Moving<'_> {
    /// Returns the rates of all residuals.
    pub fn rates(&self) -> ResidualRates {
        self.rates_around(&(0..self.problem.bodies.len()).collect::<Vec<_>>())
    }

    /// Returns the rates of residuals if only one component of one contact force moves, in a state at rest. All others
    /// are zero.
    pub fn by_force(&mut self, contact: usize, component: usize) -> ResidualRates {
        let sides = &self.problem.contacts[contact];
        let bodies = each_once([sides.minus.body, sides.plus.body]);
        self.force[contact][component].rate = 1.0;
        let found = self.deformed_rates(&bodies);
        self.force[contact][component].rate = 0.0;
        found
    }

    /// Returns the rates of residuals if only one component of the motion of one body moves, in a state at rest. All
    /// others are zero: the forces on a neighbour turn with the axes between both.
    pub fn by_motion(&mut self, body: usize, component: usize) -> ResidualRates {
        let contacts = self.points_of[body].iter().map(|contact| &self.problem.contacts[*contact]);
        let bodies = each_once(contacts.flat_map(|own| [own.minus.body, own.plus.body]).chain([body]));
        self.motion[body][component].rate = 1.0;
        let found = self.deformed_rates(&bodies);
        self.motion[body][component].rate = 0.0;
        found
    }

    /// Returns the rates of residuals if only these bodies move or deform.
    fn deformed_rates(&mut self, bodies: &[usize]) -> ResidualRates {
        let at_rest: Vec<Vec<Dual2>> = bodies.iter().map(|b| std::mem::take(&mut self.deformation[*b])).collect();
        bodies.iter().for_each(|b| self.deformation[*b] = self.deformation_of(*b));
        let found = self.rates_around(bodies);
        bodies.iter().zip(at_rest).for_each(|(b, own)| self.deformation[*b] = own);
        found
    }

    /// Returns the rates of residuals that depend on some bodies, in ascending order.
    fn rates_around(&self, bodies: &[usize]) -> ResidualRates {
        let contacts = each_once(bodies.iter().flat_map(|body| self.points_of[*body].iter().copied()));
        let gaps = contacts.iter().map(|contact| (*contact, self.gap(*contact))).collect();
        ResidualRates { gaps, unbalanced: self.unbalanced(bodies, &contacts) }
    }

    fn angle(&self, body: usize) -> Dual {
        self.motion[body][2]
    }

    fn shift(&self, body: usize) -> Dual2 {
        Dual2 { x: self.motion[body][0], y: self.motion[body][1] }
    }

    /// Returns the axes (n, t), rotated with a share of the relative rotation of both bodies.
    fn axes(&self, contact: &Contact, share: Dual) -> [Dual2; 2] {
        let [low, high] = [contact.minus, contact.plus].map(|side| self.angle(side.body));
        [contact.normal, contact.tangent].map(|e| Dual2::fixed(e).rotated(low + share * (high - low)))
    }

    /// Returns the forces on the points of a body in axes that rotate with it.
    fn forces_on_points(&self, body: usize) -> Vec<Dual2> {
        let mut forces = vec![Dual2::default(); self.problem.bodies[body].points.len()];
        for (contact, r) in
            self.points_of[body].iter().map(|index| (&self.problem.contacts[*index], &self.force[*index]))
        {
            let push = Dual2::fixed(contact.normal) * r[0] + Dual2::fixed(contact.tangent) * r[1];
            let mean = (self.angle(contact.minus.body) + self.angle(contact.plus.body)) * 0.5;
            for (side, sign) in [(contact.minus, -1.0), (contact.plus, 1.0)] {
                if let Some(slot) = side.slot.filter(|_| side.body == body) {
                    forces[slot] = forces[slot] + push.rotated(mean - self.angle(body)) * sign;
                }
            }
        }
        for (step, factor) in self.problem.load_steps.iter().zip(&self.applied) {
            for (_, slot, _, force) in step.loading.forces.iter().filter(|load| load.0 == body) {
                if let Some(slot) = *slot {
                    forces[slot] = forces[slot] + Dual2::fixed(*force).rotated(-self.angle(body)) * *factor;
                }
            }
        }
        forces
    }

    fn deformation_of(&self, body: usize) -> Vec<Dual2> {
        let Some(flexibility) = &self.problem.bodies[body].flexibility else { return Vec::new() };
        let forces = self.forces_on_points(body);
        let row = |i: usize| {
            let mut sum = Dual::default();
            for (k, f) in forces.iter().enumerate() {
                sum = sum + f.x * flexibility[(i, 2 * k)] + f.y * flexibility[(i, 2 * k + 1)];
            }
            sum
        };
        (0..forces.len()).map(|k| Dual2 { x: row(2 * k), y: row(2 * k + 1) }).collect()
    }

    fn parts(&self, side: Attachment, point: crate::model::geometry::Vec2) -> Parts {
        let arm = Dual2::fixed(point - self.problem.bodies[side.body].pole);
        let angle = self.angle(side.body);
        let deformed = side.slot.and_then(|slot| self.deformation[side.body].get(slot)).copied().unwrap_or_default();
        [self.shift(side.body) + arm.rotated(angle) - arm, deformed.rotated(angle)]
    }

    fn sides(&self, contact: &Contact) -> [Parts; 2] {
        [contact.plus, contact.minus].map(|side| self.parts(side, contact.position))
    }

    /// Returns β and its derivative with respect to slip.
    fn share(&self, contact: &Contact, [plus, minus]: &[Parts; 2]) -> [Dual; 2] {
        let slip = (plus[0] - minus[0]).dot(self.axes(contact, Dual::fixed(0.5))[1]);
        let [share, first, second] = contact.sliding.share_at(slip.value);
        [Dual::new(share, first * slip.rate), Dual::new(first, second * slip.rate)]
    }

    fn gap(&self, index: usize) -> [Dual; 2] {
        let (contact, force) = (&self.problem.contacts[index], &self.force[index]);
        let sides = self.sides(contact);
        let [share, _] = self.share(contact, &sides);
        let [plus, minus] = sides;
        let (of_motion, mean) = (self.axes(contact, share), self.axes(contact, Dual::fixed(0.5)));
        let initial = [contact.gap, 0.0];
        [0, 1].map(|k| {
            let apart = (plus[0] - minus[0]).dot(of_motion[k]) + (plus[1] - minus[1]).dot(mean[k]);
            apart + Dual::fixed(initial[k]) + force[k] * contact.compliance[k]
        })
    }

    /// Adds a force at a point of a body that has moved by `displacement`.
    fn add(&self, wrench: &mut Wrenches, body: usize, (point, displacement): (Dual2, Dual2), force: Dual2) {
        let arm = point + displacement - self.shift(body) - Dual2::fixed(self.problem.bodies[body].pole);
        let own = [force.x, force.y, arm.cross(force)];
        add_wrench(wrench, body, own);
    }

    /// Returns the wrenches of the loads on some bodies and of some contact points, on every body that has one.
    fn unbalanced(&self, bodies: &[usize], contacts: &[usize]) -> Vec<(usize, [Dual; 3])> {
        let problem = self.problem;
        let sides = contacts.iter().map(|index| &problem.contacts[*index]);
        let pushed = each_once(sides.flat_map(|own| [own.minus.body, own.plus.body]).chain(bodies.iter().copied()));
        let mut wrench: Wrenches = pushed.into_iter().map(|body| (body, [Dual::default(); 3])).collect();
        for (step, factor) in problem.load_steps.iter().zip(&self.applied) {
            for &(body, slot, point, force) in &step.loading.forces {
                if bodies.binary_search(&body).is_ok() {
                    let [rigid, deformed] = self.parts(Attachment { body, slot }, point);
                    let at = (Dual2::fixed(point), rigid + deformed);
                    self.add(&mut wrench, body, at, Dual2::fixed(force) * *factor);
                }
            }
            for (index, body) in bodies.iter().map(|body| (*body, &problem.bodies[*body])) {
                let weight = Dual2::fixed(step.loading.acceleration * body.mass) * *factor;
                self.add(&mut wrench, index, (Dual2::fixed(body.pole), self.shift(index)), weight);
            }
        }
        contacts.iter().for_each(|index| self.add_contact(&mut wrench, *index));
        wrench
    }

    fn add_contact(&self, wrench: &mut Wrenches, index: usize) {
        let (contact, r) = (&self.problem.contacts[index], &self.force[index]);
        let (low, high) = (contact.minus.body, contact.plus.body);
        let sides = self.sides(contact);
        let [share, by_slip] = self.share(contact, &sides);
        let [plus, minus] = sides;
        let ([n, t], mean) = (self.axes(contact, share), self.axes(contact, Dual::fixed(0.5)));
        let push = n * r[0] + t * r[1];
        let point = Dual2::fixed(contact.position);
        let mut both = |displacement: Dual2, push: Dual2| {
            self.add(wrench, high, (point, displacement), push);
            self.add(wrench, low, (point, displacement), push * -1.0);
        };
        both(plus[0] * (Dual::fixed(1.0) - share) + minus[0] * share, push);
        let passing = push.cross(plus[0] - minus[0]) * (self.angle(high) - self.angle(low)) * by_slip;
        both((plus[0] + minus[0]) * 0.5, mean[1] * passing);
        let moment = ((plus[1] + minus[1]) * 0.5).cross(mean[0] * r[0] + mean[1] * r[1]);
        add_wrench(wrench, high, [Dual::default(), Dual::default(), moment]);
        add_wrench(wrench, low, [Dual::default(), Dual::default(), -moment]);
    }
}
