//! Builds the path problem: groups of bodies, contact points, flexibilities, load steps.

use super::fill::{add_fill, least_forces};
use super::period::Period;
use super::point_law::PointLaw;
use super::problem::{Attachment, Contact, LoadStep, LoadStepEnd, Loading, PathBody, PathProblem};
use super::response_check::check_response;
use super::sliding::Sliding;
use crate::elastic::{Condenser, breaks_on_joint, fine_enough, joint_points, union_breaks};
use crate::law::PlanarUpdate;
use crate::limit::Counters;
use crate::model::geometry::{Vec2, turned};
use crate::model::{Assembly, Bond, Joint, PointForce, Stage, Target, fill_weights, root};
use std::collections::{BTreeSet, HashMap};
use std::sync::Arc;

/// Stiffness of the springs between meshes that do not match, relative to the stiffness of a block as high as the
/// joint.
const REGULARISATION: f64 = 1e5;

impl PathProblem {
    /// Builds the problem. An error names the feature that paths do not support.
    pub fn new(assembly: &Assembly, stages: &[Stage]) -> Result<Self, String> {
        let (bodies, body_of) = bodies(assembly);
        let mut problem = PathProblem {
            contacts: Vec::new(),
            load_steps: Vec::new(),
            length: assembly.size(),
            span: assembly.span(),
            width: assembly.width,
            counters: Counters::new(),
            bodies,
            body_of,
        };
        let nonmatching = contact_points(&mut problem, assembly)?;
        regularise_nonmatching_joints(&mut problem, assembly, nonmatching);
        add_fill(&mut problem, assembly, stages)?;
        // A body that rotates about a point has its pole there: the displacement of this point is then the displacement
        // of the pole, whatever the rotation.
        for settlement in stages.iter().flat_map(|stage| &stage.settlements).rev() {
            problem.bodies[problem.body_of[settlement.body]].pole = settlement.about;
        }
        problem.load_steps = load_steps(&mut problem, assembly, stages)?;
        condense(&mut problem, assembly)?;
        Ok(problem)
    }
}

/// Returns the bodies (rigid blocks that are bonded form one), and the body of each block.
fn bodies(assembly: &Assembly) -> (Vec<PathBody>, Vec<usize>) {
    let count = assembly.bodies.len();
    let mut parent: Vec<usize> = (0..count).collect();
    for joint in assembly.joints.iter().filter(|joint| joint.bond == Bond::Bonded) {
        if !assembly.is_deformable(joint.minus) && !assembly.is_deformable(joint.plus) {
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
            bodies.push(PathBody::default());
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
    (bodies, body_of)
}

/// Returns the contact points of a joint as shares of its height, their shares of its area, and true if the meshes of
/// both sides match.
fn points_of_joint(assembly: &Assembly, joint: &Joint) -> Result<(Vec<f64>, Vec<f64>, bool), String> {
    let compliant = assembly.law(joint).is_some_and(|law| law.stiffness().is_some());
    let mut breaks = vec![0.0, 1.0];
    let mut meshes: Vec<Vec<f64>> = Vec::new();
    for side in [joint.minus, joint.plus].into_iter().filter(|side| assembly.is_deformable(*side)) {
        let own = breaks_on_joint(&assembly.bodies[side].vertices, &assembly.mesh, joint.ends)?;
        breaks = union_breaks(&breaks, &own);
        meshes.push(own);
    }
    if meshes.is_empty() && compliant {
        let across = assembly.mesh.elements[1];
        breaks = (0..=across).map(|i| i as f64 / across as f64).collect();
    }
    // A rigid joint without compliance has its two ends as points: they represent every resultant.
    let order = match (meshes.is_empty(), compliant) {
        (false, _) => assembly.mesh.order,
        (true, true) => assembly.mesh.order.max(2),
        (true, false) => 1,
    };
    let (positions, weights) = joint_points(&breaks, order);
    let matching = meshes.windows(2).all(|pair| pair[0].len() == breaks.len() && pair[1].len() == breaks.len());
    Ok((positions, weights, matching))
}

/// Adds the contact points of all joints between bodies. Returns the joints on which meshes do not match.
fn contact_points(problem: &mut PathProblem, assembly: &Assembly) -> Result<BTreeSet<usize>, String> {
    let laws: Vec<Option<PointLaw>> = assembly.catalogue.laws.iter().map(|(_, law)| PointLaw::of(&**law)).collect();
    let mut nonmatching = BTreeSet::new();
    let mut checked = BTreeSet::new();
    for (index, joint) in assembly.joints.iter().enumerate() {
        if problem.body_of[joint.minus] == problem.body_of[joint.plus] {
            continue;
        }
        let stiffness = assembly.law(joint).and_then(|law| law.stiffness());
        let (positions, weights, matching) = points_of_joint(assembly, joint)?;
        if !matching {
            nonmatching.insert(index);
        }
        let (normal, tangent) = joint.frame();
        let height = joint.height();
        let law = match joint.bond {
            Bond::Bonded => &PointLaw::Bonded,
            Bond::Law(law) => laws[law].as_ref().ok_or("a joint law gives neither facets nor tractions from gaps")?,
        };
        if let (PointLaw::Response(response), Bond::Law(own)) = (law, joint.bond)
            && checked.insert(own)
        {
            let (name, interface) = &assembly.catalogue.laws[own];
            check_response((name, &**interface), &**response, (index, joint.middle()))?;
        }
        for (position, weight) in positions.into_iter().zip(weights) {
            let point = joint.ends[0] + (joint.ends[1] - joint.ends[0]) * position;
            let area = weight * height * assembly.width;
            let mut attach = |block: usize| {
                let body = problem.body_of[block];
                let slot = assembly.is_deformable(block).then(|| {
                    problem.bodies[body].points.push(point);
                    problem.bodies[body].points.len() - 1
                });
                Attachment { body, slot }
            };
            let (minus, plus) = (attach(joint.minus), attach(joint.plus));
            problem.contacts.push(Contact {
                joint: index,
                position: point,
                normal,
                tangent,
                minus,
                plus,
                area,
                gap: joint.gap.at(position * height),
                law: law.clone(),
                compliance: match law {
                    PointLaw::Response(_) => [0.0; 2],
                    _ => stiffness.map_or([0.0; 2], |k| k.map(|k| 1.0 / (k * area))),
                },
                sliding: Sliding::of(assembly, joint, position, 1e-9 * problem.length),
            });
        }
    }
    Ok(nonmatching)
}

/// If two meshes do not match, or joints meet at a corner, there are more contact points than nodes and the flexibility
/// is singular. Springs much stiffer than the blocks then distribute the forces. They are part of the model, their
/// stiffness is proportional to area (a uniform pressure stays uniform), and they do not change limit loads.
fn regularise_nonmatching_joints(problem: &mut PathProblem, assembly: &Assembly, mut nonmatching: BTreeSet<usize>) {
    let grid = 1e-7 * problem.length;
    let mut met: HashMap<[i64; 2], usize> = HashMap::new();
    for contact in &problem.contacts {
        let key = [contact.position.x, contact.position.y].map(|x| (x / grid).round() as i64);
        match met.get(&key) {
            Some(&other) if other != contact.joint => nonmatching.extend([other, contact.joint]),
            _ => _ = met.insert(key, contact.joint),
        }
    }
    let rigid = |c: &Contact| c.compliance == [0.0; 2] && c.law.response().is_none();
    for contact in problem.contacts.iter_mut().filter(|c| nonmatching.contains(&c.joint) && rigid(c)) {
        let joint = &assembly.joints[contact.joint];
        let sides = [joint.minus, joint.plus].into_iter().filter(|side| assembly.is_deformable(*side));
        let moduli = sides.filter_map(|side| assembly.material(side).elasticity()).map(|elasticity| elasticity.modulus);
        let softest = moduli.fold(f64::INFINITY, f64::min);
        if softest.is_finite() {
            contact.compliance = [joint.height() / (REGULARISATION * softest * contact.area); 2];
        }
    }
}

/// Returns the loads of a stage without gravity. Their points on deformable blocks become points of bodies.
fn loading(problem: &mut PathProblem, assembly: &Assembly, stage: &Stage) -> Loading {
    let mut loading = Loading { acceleration: stage.accelerations.iter().sum(), ..Loading::default() };
    add_forces(problem, assembly, &stage.forces, &mut loading);
    for settlement in &stage.settlements {
        let body = problem.body_of[settlement.body];
        let pole = problem.bodies[body].pole;
        let u = settlement.displacement + turned(pole - settlement.about) * settlement.rotation;
        loading.settlements.push((body, [u.x, u.y, settlement.rotation]));
    }
    loading
}

/// Adds forces at points. Their points on deformable blocks become points of bodies.
fn add_forces(problem: &mut PathProblem, assembly: &Assembly, forces: &[PointForce], loading: &mut Loading) {
    for force in forces {
        let body = problem.body_of[force.body];
        let slot = assembly.is_deformable(force.body).then(|| {
            let points = &mut problem.bodies[body].points;
            points.iter().position(|p| *p == force.point).unwrap_or_else(|| {
                points.push(force.point);
                points.len() - 1
            })
        });
        loading.forces.push((body, slot, force.point, force.force));
    }
}

/// Returns the load steps in order: for each stage the change of gravity, then the loads.
fn load_steps(problem: &mut PathProblem, assembly: &Assembly, stages: &[Stage]) -> Result<Vec<LoadStep>, String> {
    let mut steps = Vec::new();
    // Without laws of tractions from gaps nothing depends on time or fields.
    let responds = problem.contacts.iter().any(|contact| contact.law.response().is_some());
    let mut gravity = Vec2::zeros();
    for (index, stage) in stages.iter().enumerate() {
        let period = Period::of_stage(stages, index);
        let change = stage.gravity.map_or(Vec2::zeros(), |new| new - gravity);
        if change != Vec2::zeros() {
            gravity += change;
            let mut loading = Loading { acceleration: change, ..Loading::default() };
            add_forces(problem, assembly, &fill_weights(assembly, change), &mut loading);
            add_forces(problem, assembly, &least_forces(assembly, change), &mut loading);
            let (end, period) = (LoadStepEnd::Factor(1.0), period.start());
            steps.push(LoadStep { stage: index, gravity: true, loading, start: 0.0, end, period });
        }
        let loading = loading(problem, assembly, stage);
        let idle = loading.forces.iter().all(|f| f.3 == Vec2::zeros())
            && loading.acceleration == Vec2::zeros()
            && loading.settlements.iter().all(|s| s.1 == [0.0; 3]);
        if idle && !(responds && period.passes()) {
            continue;
        }
        let step = |start, end, loading| {
            let period = period.clone();
            LoadStep { stage: index, gravity: false, loading, start, end, period }
        };
        match stage.target {
            Target::Factor(factor) => steps.push(step(0.0, LoadStepEnd::Factor(factor), loading)),
            Target::Collapse => {
                let start = 0.0f64.clamp(stage.factor_min, stage.factor_max);
                if start != 0.0 {
                    steps.push(step(0.0, LoadStepEnd::Factor(start), loading.clone()));
                }
                steps.push(step(start, LoadStepEnd::Collapse(stage.factor_max), loading));
            }
        }
    }
    if steps.is_empty() { Err("no stage has a load".into()) } else { Ok(steps) }
}

/// Computes the flexibilities of deformable bodies at their points.
fn condense(problem: &mut PathProblem, assembly: &Assembly) -> Result<(), String> {
    let mut condenser = Condenser::new(assembly.plane, assembly.width);
    let mut updates: HashMap<usize, Arc<PlanarUpdate>> = HashMap::new();
    for body in problem.bodies.iter_mut().filter(|body| body.members.len() == 1) {
        let block = body.members[0];
        let material = assembly.material(block);
        let Some(elasticity) = material.elasticity().filter(|_| assembly.is_deformable(block)) else { continue };
        let vertices = &assembly.bodies[block].vertices;
        let Some(law) = material.inelastic() else {
            let flexibility = condenser.flexibility(vertices, &elasticity, &assembly.mesh, &body.points)?;
            body.flexibility = Some(flexibility);
            continue;
        };
        let index = assembly.bodies[block].material;
        let update = match updates.get(&index) {
            Some(update) => update.clone(),
            None => {
                let update = PlanarUpdate::new(law, assembly.plane).map_err(|why| why.to_string())?;
                updates.entry(index).or_insert(Arc::new(update)).clone()
            }
        };
        fine_enough(assembly, block)?;
        let inelastic = condenser.inelastic(vertices, &elasticity, update, &assembly.mesh, &body.points)?;
        body.flexibility = Some(inelastic.flexibility());
        body.inelastic = Some(Arc::new(inelastic));
    }
    problem.counters.insert("condensation_factorisations".into(), condenser.factorisations());
    Ok(())
}
