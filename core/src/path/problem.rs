//! Building the path problem: groups of bodies, contact points, flexibilities, load steps.

use super::point_law::PointLaw;
use super::sliding::{Sliding, face, sliding};
use super::state::PathState;
use crate::elastic::{Condenser, InelasticBody, breaks_on_joint, joint_points, union_breaks};
use crate::law::{InterfaceResponse, PlanarUpdate};
use crate::limit::Counters;
use crate::model::geometry::{Vec2, cross, turned};
use crate::model::{Assembly, Bond, Stage, Target, root};
use nalgebra::DMatrix;
use std::collections::{BTreeSet, HashMap};
use std::sync::Arc;

/// A body of the path problem: one block, or several rigid ones bonded together.
#[derive(Debug, Clone)]
pub struct PathBody {
    /// Blocks of the assembly.
    pub members: Vec<usize>,
    /// Its centroid; the origin where it has no shape; the point about which a support settles \[m\].
    pub pole: Vec2,
    /// Held by the ground: moves by settlement only.
    pub held: bool,
    /// \[kg\].
    pub mass: f64,
    /// Points that something acts on, with a flexibility: contact points first, then loads.
    pub points: Vec<Vec2>,
    /// Displacements (x, y per point) by forces (x, y per point) relative to the mean rigid motion
    /// \[m/N\]; `None` for rigid bodies.
    pub flexibility: Option<Arc<DMatrix<f64>>>,
    /// Where the material yields: the body with its mesh. `flexibility` is then that of the body
    /// before anything has yielded.
    pub inelastic: Option<Arc<InelasticBody>>,
}

/// One side of a contact point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Attachment {
    /// Index of the body.
    pub body: usize,
    /// Index of the point among the body's, where the body has a flexibility.
    pub slot: Option<usize>,
}

/// A contact point.
#[derive(Debug, Clone)]
pub struct Contact {
    /// Index of the joint in the assembly.
    pub joint: usize,
    /// Where it is \[m\].
    pub position: Vec2,
    /// Unit normal from minus to plus.
    pub normal: Vec2,
    /// Unit tangent.
    pub tangent: Vec2,
    /// On the minus body.
    pub minus: Attachment,
    /// On the plus body.
    pub plus: Attachment,
    /// Tributary area \[m²\].
    pub area: f64,
    /// Initial gap \[m\].
    pub gap: f64,
    /// Its law. Where that gives tractions from gaps, the gap holds the compliance of the joint too: it
    /// is part of the law.
    pub law: PointLaw,
    /// Compliance of the joint at this point, normal and tangential \[m/N\].
    pub compliance: [f64; 2],
    /// How it slides with finite displacements.
    pub sliding: Sliding,
}

/// Loads that grow together.
#[derive(Debug, Clone, Default)]
pub struct Loading {
    /// (body, slot of the point in the body where it is elastic, point, force \[N\]).
    pub forces: Vec<(usize, Option<usize>, Vec2, Vec2)>,
    /// Acceleration of all bodies \[m/s²\].
    pub acceleration: Vec2,
    /// (held body, displacement about its pole \[u_x, u_y, θ\]).
    pub settlements: Vec<(usize, [f64; 3])>,
}

/// How far a load step goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LoadStepEnd {
    /// To this factor.
    Factor(f64),
    /// Until no more can be carried, up to this factor (may be ∞).
    Collapse(f64),
}

/// One load history in the sequence: `λ × loading` on top of all earlier ones.
#[derive(Debug, Clone)]
pub struct LoadStep {
    /// Index of the stage.
    pub stage: usize,
    /// Whether it is the stage's change of gravity (factor from 0 to 1) or its loads.
    pub gravity: bool,
    /// What grows.
    pub loading: Loading,
    /// λ at its start.
    pub start: f64,
    /// Where it ends.
    pub end: LoadStepEnd,
}

/// Everything a path solver needs.
#[derive(Debug, Clone)]
pub struct PathProblem {
    /// Bodies.
    pub bodies: Vec<PathBody>,
    /// For each block of the assembly its body.
    pub body_of: Vec<usize>,
    /// Contact points, those of a joint next to each other and in order along it.
    pub contacts: Vec<Contact>,
    /// Load histories in order.
    pub load_steps: Vec<LoadStep>,
    /// Length scale \[m\].
    pub length: f64,
    /// Work done to build it.
    pub counters: Counters,
}

/// Stiffness of the springs between meshes that do not match, relative to that of a block as high as
/// the joint.
const REGULARISATION: f64 = 1e5;

/// The modulus of a deformable block.
fn modulus(assembly: &Assembly, block: usize) -> Option<f64> {
    let body = &assembly.bodies[block];
    Some(assembly.catalogue.materials[body.material].1.elasticity().filter(|_| !body.fixed)?.modulus)
}

impl PathProblem {
    /// Builds the problem. An error says what cannot be followed.
    pub fn new(assembly: &Assembly, stages: &[Stage]) -> Result<Self, String> {
        let count = assembly.bodies.len();
        let elastic = |block: usize| !assembly.bodies[block].fixed && !assembly.is_rigid(block);
        let mut parent: Vec<usize> = (0..count).collect();
        for joint in assembly.joints.iter().filter(|joint| joint.bond == Bond::Bonded) {
            if !elastic(joint.minus) && !elastic(joint.plus) {
                let (a, b) = (root(&mut parent, joint.minus), root(&mut parent, joint.plus));
                parent[a.max(b)] = a.min(b);
            }
        }
        let mut body_of = vec![usize::MAX; count];
        let mut bodies: Vec<PathBody> = Vec::new();
        for block in 0..count {
            let r = root(&mut parent, block);
            if body_of[r] == usize::MAX {
                body_of[r] = bodies.len();
                bodies.push(PathBody {
                    members: Vec::new(),
                    pole: Vec2::zeros(),
                    held: false,
                    mass: 0.0,
                    points: Vec::new(),
                    flexibility: None,
                    inelastic: None,
                });
            }
            body_of[block] = body_of[r];
            let body = &mut bodies[body_of[block]];
            body.members.push(block);
            body.held |= assembly.bodies[block].fixed;
        }
        for body in &mut bodies {
            let inertia: Vec<_> = body.members.iter().map(|&block| assembly.inertia(block)).collect();
            body.mass = inertia.iter().map(|i| i.mass).sum();
            if body.mass > 0.0 {
                body.pole = inertia.iter().map(|i| i.centroid * i.mass).sum::<Vec2>() / body.mass;
            }
        }
        let mut problem = PathProblem {
            contacts: Vec::new(),
            load_steps: Vec::new(),
            length: assembly.size(),
            counters: Counters::new(),
            bodies,
            body_of,
        };
        problem.contact_points(assembly, &elastic)?;
        problem.load_steps(stages, &elastic)?;
        problem.condense(assembly, &elastic)?;
        Ok(problem)
    }

    fn contact_points(&mut self, assembly: &Assembly, elastic: &dyn Fn(usize) -> bool) -> Result<(), String> {
        let laws: Vec<Option<PointLaw>> = assembly.catalogue.laws.iter().map(|(_, law)| PointLaw::of(&**law)).collect();
        let mut nonmatching = BTreeSet::new();
        for (index, joint) in assembly.joints.iter().enumerate() {
            let sides = [joint.minus, joint.plus];
            if self.body_of[joint.minus] == self.body_of[joint.plus] {
                continue;
            }
            let stiffness = assembly.law(joint).and_then(|law| law.stiffness());
            let mut breaks = vec![0.0, 1.0];
            let mut meshes: Vec<Vec<f64>> = Vec::new();
            for &side in sides.iter().filter(|side| elastic(**side)) {
                let vertices = &assembly.bodies[side].vertices;
                let own = breaks_on_joint(vertices, &assembly.mesh, joint.ends)?;
                breaks = union_breaks(&breaks, &own);
                meshes.push(own);
            }
            let any_elastic = sides.iter().any(|side| elastic(*side));
            if !any_elastic && stiffness.is_some() {
                let across = assembly.mesh.elements[1];
                breaks = (0..=across).map(|i| i as f64 / across as f64).collect();
            }
            // A rigid joint without compliance: its two ends span every resultant.
            let order = match (any_elastic, stiffness) {
                (true, _) => assembly.mesh.order,
                (false, Some(_)) => assembly.mesh.order.max(2),
                (false, None) => 1,
            };
            let (positions, weights) = joint_points(&breaks, order);
            let (normal, tangent) = joint.frame();
            let height = joint.height();
            let matching = meshes.windows(2).all(|pair| pair[0].len() == breaks.len() && pair[1].len() == breaks.len());
            if !matching {
                nonmatching.insert(index);
            }
            let face = |side: usize| face(&assembly.bodies[side].vertices, joint.ends, 1e-9 * self.length);
            let faces = (!any_elastic).then(|| sides.map(face));
            for (position, weight) in positions.into_iter().zip(weights) {
                let point = joint.ends[0] + (joint.ends[1] - joint.ends[0]) * position;
                let area = weight * height * assembly.width;
                let mut attach = |block: usize| {
                    let body = self.body_of[block];
                    let slot = elastic(block).then(|| {
                        self.bodies[body].points.push(point);
                        self.bodies[body].points.len() - 1
                    });
                    Attachment { body, slot }
                };
                let law = match joint.bond {
                    Bond::Bonded => PointLaw::Bonded,
                    Bond::Law(law) => {
                        laws[law].clone().ok_or("a joint law gives neither facets nor tractions from gaps")?
                    }
                };
                let compliance = match &law {
                    PointLaw::Response(_) => [0.0; 2],
                    _ => stiffness.map_or([0.0; 2], |k| k.map(|k| 1.0 / (k * area))),
                };
                self.contacts.push(Contact {
                    joint: index,
                    position: point,
                    normal,
                    tangent,
                    minus: attach(joint.minus),
                    plus: attach(joint.plus),
                    area,
                    gap: joint.gap.at(position * height),
                    law,
                    compliance,
                    sliding: sliding(faces, height, position),
                });
            }
        }
        self.regularise_nonmatching_joints(assembly, nonmatching);
        Ok(())
    }

    /// Where two meshes do not match, or joints meet at a corner, more points than nodes meet and the
    /// flexibility is singular: springs far stiffer than the blocks share the forces. They are part of
    /// the model, proportional to area (a uniform pressure stays uniform), and move no limit load.
    fn regularise_nonmatching_joints(&mut self, assembly: &Assembly, mut nonmatching: BTreeSet<usize>) {
        let grid = 1e-7 * self.length;
        let mut met: HashMap<[i64; 2], usize> = HashMap::new();
        for contact in &self.contacts {
            let key = [contact.position.x, contact.position.y].map(|x| (x / grid).round() as i64);
            match met.get(&key) {
                Some(&other) if other != contact.joint => nonmatching.extend([other, contact.joint]),
                _ => _ = met.insert(key, contact.joint),
            }
        }
        let rigid = |c: &Contact| c.compliance == [0.0; 2] && c.law.response().is_none();
        for contact in self.contacts.iter_mut().filter(|c| nonmatching.contains(&c.joint) && rigid(c)) {
            let joint = &assembly.joints[contact.joint];
            let sides = [joint.minus, joint.plus].into_iter();
            let softest = sides.filter_map(|side| modulus(assembly, side)).fold(f64::INFINITY, f64::min);
            if softest.is_finite() {
                contact.compliance = [joint.height() / (REGULARISATION * softest * contact.area); 2];
            }
        }
    }

    fn load_steps(&mut self, stages: &[Stage], elastic: &dyn Fn(usize) -> bool) -> Result<(), String> {
        // What turns about a point has its pole there, so that the point's displacement is the pole's
        // however far the body turns.
        for settlement in stages.iter().flat_map(|stage| &stage.settlements).rev() {
            self.bodies[self.body_of[settlement.body]].pole = settlement.about;
        }
        let mut gravity = Vec2::zeros();
        for (index, stage) in stages.iter().enumerate() {
            let change = stage.gravity.map_or(Vec2::zeros(), |new| new - gravity);
            if change != Vec2::zeros() {
                gravity += change;
                self.load_steps.push(LoadStep {
                    stage: index,
                    gravity: true,
                    loading: Loading { acceleration: change, ..Loading::default() },
                    start: 0.0,
                    end: LoadStepEnd::Factor(1.0),
                });
            }
            let mut loading = Loading { acceleration: stage.accelerations.iter().sum(), ..Loading::default() };
            for force in &stage.forces {
                let body = self.body_of[force.body];
                let slot = elastic(force.body).then(|| {
                    let points = &mut self.bodies[body].points;
                    points.iter().position(|p| *p == force.point).unwrap_or_else(|| {
                        points.push(force.point);
                        points.len() - 1
                    })
                });
                loading.forces.push((body, slot, force.point, force.force));
            }
            for settlement in &stage.settlements {
                let body = self.body_of[settlement.body];
                let pole = self.bodies[body].pole;
                let u = settlement.displacement + turned(pole - settlement.about) * settlement.rotation;
                loading.settlements.push((body, [u.x, u.y, settlement.rotation]));
            }
            let idle = loading.forces.iter().all(|f| f.3 == Vec2::zeros())
                && loading.acceleration == Vec2::zeros()
                && loading.settlements.iter().all(|s| s.1 == [0.0; 3]);
            if idle {
                continue;
            }
            let load_step = |start, end, loading| LoadStep { stage: index, gravity: false, loading, start, end };
            match stage.target {
                Target::Factor(factor) => self.load_steps.push(load_step(0.0, LoadStepEnd::Factor(factor), loading)),
                Target::Collapse => {
                    let start = 0.0f64.clamp(stage.factor_min, stage.factor_max);
                    if start != 0.0 {
                        self.load_steps.push(load_step(0.0, LoadStepEnd::Factor(start), loading.clone()));
                    }
                    self.load_steps.push(load_step(start, LoadStepEnd::Collapse(stage.factor_max), loading));
                }
            }
        }
        if self.load_steps.is_empty() {
            return Err("no stage has a load".into());
        }
        Ok(())
    }

    fn condense(&mut self, assembly: &Assembly, elastic: &dyn Fn(usize) -> bool) -> Result<(), String> {
        let mut condenser = Condenser::new(assembly.plane, assembly.width);
        let mut updates: HashMap<usize, Arc<PlanarUpdate>> = HashMap::new();
        for body in self.bodies.iter_mut().filter(|body| body.members.len() == 1) {
            let block = body.members[0];
            if !elastic(block) {
                continue;
            }
            let index = assembly.bodies[block].material;
            let material = &assembly.catalogue.materials[index].1;
            let Some(elasticity) = material.elasticity() else { continue };
            let vertices = &assembly.bodies[block].vertices;
            if let Some(law) = material.inelastic() {
                let update = match updates.get(&index) {
                    Some(update) => update.clone(),
                    None => {
                        let update = PlanarUpdate::new(law, assembly.plane).map_err(|why| why.to_string())?;
                        updates.entry(index).or_insert(Arc::new(update)).clone()
                    }
                };
                assembly.fine_enough(block)?;
                let inelastic = condenser.inelastic(vertices, &elasticity, update, &assembly.mesh, &body.points)?;
                body.flexibility = Some(inelastic.flexibility());
                body.inelastic = Some(Arc::new(inelastic));
                continue;
            }
            let condensed = condenser.condense(vertices, &elasticity, &assembly.mesh, &body.points)?;
            body.flexibility = Some(Arc::new(condensed.flexibility));
        }
        self.counters.insert("condensation_factorisations".into(), condenser.factorisations());
        Ok(())
    }

    /// Whether some body's material yields.
    pub fn yields(&self) -> bool {
        self.bodies.iter().any(|body| body.inelastic.is_some())
    }

    /// Whether anything can deform: a scene of rigid bodies without joint compliance has no path
    /// before its collapse.
    pub fn deforms(&self) -> bool {
        self.bodies.iter().any(|body| body.flexibility.is_some())
            || self.contacts.iter().any(|c| c.compliance[0] > 0.0 || c.law.response().is_some())
    }

    /// The law of a contact point, where it gives tractions from gaps.
    pub fn response(&self, contact: usize) -> Option<&dyn InterfaceResponse> {
        self.contacts[contact].law.response().map(|law| &**law)
    }

    /// How much of each load step's loading is applied at a factor of one of them.
    pub fn applied(&self, load_step: usize, factor: f64) -> Vec<f64> {
        let reached = |(index, d): (usize, &LoadStep)| match (index.cmp(&load_step), d.end) {
            (std::cmp::Ordering::Less, LoadStepEnd::Factor(end) | LoadStepEnd::Collapse(end)) => end - d.start,
            (std::cmp::Ordering::Equal, _) => factor - d.start,
            (std::cmp::Ordering::Greater, _) => 0.0,
        };
        self.load_steps.iter().enumerate().map(reached).collect()
    }

    /// Wrench of a loading on each body about its pole, undeformed positions \[N, N m\].
    pub fn wrenches(&self, loading: &Loading) -> Vec<[f64; 3]> {
        let mut wrenches: Vec<[f64; 3]> = self
            .bodies
            .iter()
            .map(|body| [loading.acceleration.x * body.mass, loading.acceleration.y * body.mass, 0.0])
            .collect();
        for &(body, _, point, force) in &loading.forces {
            let wrench = &mut wrenches[body];
            wrench[0] += force.x;
            wrench[1] += force.y;
            wrench[2] += cross(point - self.bodies[body].pole, force);
        }
        wrenches
    }

    /// Displacement (x, y) of point `slot` of a body by the deformation that a loading causes, small
    /// displacements \[m\].
    pub fn deformation(&self, loading: &Loading, body: usize, slot: usize) -> Vec2 {
        let mut u = Vec2::zeros();
        let Some(flexibility) = &self.bodies[body].flexibility else { return u };
        for &(on, at, _, force) in &loading.forces {
            if let (true, Some(at)) = (on == body, at) {
                for (i, u) in u.iter_mut().enumerate() {
                    *u += flexibility[(2 * slot + i, 2 * at)] * force.x
                        + flexibility[(2 * slot + i, 2 * at + 1)] * force.y;
                }
            }
        }
        u
    }

    /// Gap (n, t) that a loading opens at each contact point with all bodies' motions and contact
    /// forces zero: deformation and settlements, small displacements \[m\].
    pub fn loading_gaps(&self, loading: &Loading) -> Vec<[f64; 2]> {
        let settled = |body: usize, point: Vec2| {
            let mut u = Vec2::zeros();
            for (held, [x, y, theta]) in &loading.settlements {
                if *held == body {
                    u += Vec2::new(*x, *y) + turned(point - self.bodies[body].pole) * *theta;
                }
            }
            u
        };
        let side = |attachment: Attachment, point: Vec2| {
            let elastic =
                attachment.slot.map_or(Vec2::zeros(), |slot| self.deformation(loading, attachment.body, slot));
            elastic + settled(attachment.body, point)
        };
        self.contacts
            .iter()
            .map(|c| {
                let jump = side(c.plus, c.position) - side(c.minus, c.position);
                [jump.dot(&c.normal), jump.dot(&c.tangent)]
            })
            .collect()
    }

    /// Rows of G at a contact point for one side: (n, t) of the displacement of the point per
    /// (u_x, u_y, θ) of the body about its pole, with the side's sign.
    pub fn kinematics(&self, contact: &Contact, plus: bool) -> [[f64; 3]; 2] {
        let (body, sign) = if plus { (contact.plus.body, 1.0) } else { (contact.minus.body, -1.0) };
        let arm = contact.position - self.bodies[body].pole;
        [contact.normal, contact.tangent].map(|e| [sign * e.x, sign * e.y, sign * cross(arm, e)])
    }
}

impl PathProblem {
    /// Contact forces and loads of a state on the points of every body, in axes that turn with the
    /// body where displacements are `finite` \[N\]: there a contact's frame has the mean rotation of
    /// its two bodies.
    pub fn forces_on_points(&self, state: &PathState, finite: bool) -> Vec<Vec<Vec2>> {
        let mut forces: Vec<Vec<Vec2>> = self.bodies.iter().map(|b| vec![Vec2::zeros(); b.points.len()]).collect();
        let turn = |angle: f64, v: Vec2| if finite { v * angle.cos() + turned(v) * angle.sin() } else { v };
        let angle = |body: usize| state.motion[body][2];
        let on_points = |c: &Contact| c.minus.slot.is_some() || c.plus.slot.is_some();
        for (contact, f) in self.contacts.iter().zip(&state.force).filter(|(c, _)| on_points(c)) {
            let on_plus = contact.normal * f[0] + contact.tangent * f[1];
            let mean = (angle(contact.minus.body) + angle(contact.plus.body)) / 2.0;
            for (side, sign) in [(contact.minus, -1.0), (contact.plus, 1.0)] {
                if let Some(slot) = side.slot {
                    forces[side.body][slot] += turn(mean - angle(side.body), on_plus) * sign;
                }
            }
        }
        for (load_step, factor) in self.load_steps.iter().zip(self.applied(state.load_step, state.factor)) {
            for (body, slot, _, f) in &load_step.loading.forces {
                if let Some(slot) = slot {
                    forces[*body][*slot] += turn(-angle(*body), *f) * factor;
                }
            }
        }
        forces
    }
}
