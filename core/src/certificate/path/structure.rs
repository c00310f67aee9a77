//! The structure that a path is checked against, derived from the assembly and the stages alone: areas, initial gaps,
//! laws, compliances, masses, loads and settlements.
//!
//! This code shares nothing with the code that builds the solver's problem. Both use the elastic library (element
//! boundaries on a joint, bodies condensed onto their points) and the rule by which a contact point slides
//! ([`Sliding`]). They also share the convention of the order: bodies by their first block, contact points joint by
//! joint and along each joint.

use crate::elastic::{Condenser, breaks_on_joint, union_breaks};
use crate::law::{Facet, PlanarUpdate};
use crate::limit::Counters;
use crate::model::geometry::{Vec2, turned};
use crate::model::{Assembly, Bond, Joint, Stage, Target};
use crate::path::{
    Attachment, Contact, LoadStep, LoadStepEnd, Loading, PathBody, PathProblem, Period, PointLaw, Sliding,
};
use std::sync::Arc;

/// Returns the Gauss–Lobatto rule on \[0, 1\] for elements of an order: points and weights, exact for degree 2 × order
/// − 1.
fn rule(order: usize) -> (Vec<f64>, Vec<f64>) {
    let inner = (1.0 - 0.2f64.sqrt()) / 2.0;
    match order {
        1 => (vec![0.0, 1.0], vec![0.5, 0.5]),
        2 => (vec![0.0, 0.5, 1.0], vec![1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0]),
        _ => (vec![0.0, inner, 1.0 - inner, 1.0], vec![1.0 / 12.0, 5.0 / 12.0, 5.0 / 12.0, 1.0 / 12.0]),
    }
}

/// Stiffness of the springs between meshes that do not match, relative to the stiffness of a block as high as the
/// joint.
const REGULARISATION: f64 = 1e5;

/// Returns the structure and its load steps. An error names the feature that is not supported.
pub fn path_structure(assembly: &Assembly, stages: &[Stage]) -> Result<PathProblem, String> {
    let (bodies, body_of) = bodies(assembly, stages);
    let (contacts, load_steps, counters) = (Vec::new(), Vec::new(), Counters::new());
    let (length, span) = (assembly.size(), assembly.span());
    let width = assembly.width;
    let mut read = PathProblem { bodies, body_of, contacts, load_steps, length, span, width, counters };
    let laws: Vec<Option<PointLaw>> = assembly.catalogue.laws.iter().map(|(_, law)| PointLaw::of(&**law)).collect();
    for (index, joint) in assembly.joints.iter().enumerate() {
        if read.body_of[joint.minus] != read.body_of[joint.plus] {
            let points = contact_points(&mut read, assembly, &laws, index)?;
            read.contacts.extend(points);
        }
    }
    stiffen_shared_places(&mut read, assembly)?;
    read_fill(&mut read, assembly, stages)?;
    read.load_steps = load_steps_of(&mut read, assembly, stages);
    condense(&mut read, assembly)?;
    Ok(read)
}

/// Returns the bodies. Bonded rigid blocks have the label of the first of them; each label is a body. A moving support
/// has its pole at the point about which it first rotates, any other body at the centroid of its mass.
fn bodies(assembly: &Assembly, stages: &[Stage]) -> (Vec<PathBody>, Vec<usize>) {
    let rigid = |block: usize| !assembly.is_deformable(block);
    let mut label: Vec<usize> = (0..assembly.bodies.len()).collect();
    loop {
        let mut changed = false;
        for joint in assembly.joints.iter().filter(|j| j.bond == Bond::Bonded && rigid(j.minus) && rigid(j.plus)) {
            let least = label[joint.minus].min(label[joint.plus]);
            for side in [joint.minus, joint.plus] {
                changed |= label[side] != least;
                label[side] = least;
            }
        }
        if !changed {
            break;
        }
    }
    let firsts: Vec<usize> = (0..label.len()).filter(|&block| label[block] == block).collect();
    let body_of: Vec<usize> = label.iter().map(|first| firsts.partition_point(|f| f < first)).collect();
    let bodies = firsts.iter().map(|first| {
        let members: Vec<usize> = (0..label.len()).filter(|&block| label[block] == *first).collect();
        let [mut mass, mut x, mut y] = [0.0; 3];
        for inertia in members.iter().map(|&block| assembly.inertia(block)) {
            mass += inertia.mass;
            x += inertia.mass * inertia.centroid.x;
            y += inertia.mass * inertia.centroid.y;
        }
        let settles = stages.iter().flat_map(|stage| &stage.settlements).find(|s| label[s.body] == *first);
        let centroid = if mass > 0.0 { Vec2::new(x / mass, y / mass) } else { Vec2::zeros() };
        let held = members.iter().any(|&block| assembly.bodies[block].fixed);
        PathBody { members, pole: settles.map_or(centroid, |s| s.about), held, mass, ..PathBody::default() }
    });
    (bodies.collect(), body_of)
}

/// Returns the positions of contact points on a joint as shares of its height, each with its share of the area. There
/// is a rule on every segment between element boundaries. A rigid joint without compliance has its two ends.
fn places(assembly: &Assembly, joint: &Joint) -> Result<Vec<(f64, f64)>, String> {
    let compliant = assembly.law(joint).is_some_and(|law| law.stiffness().is_some());
    let deformable = [joint.minus, joint.plus].into_iter().filter(|side| assembly.is_deformable(*side));
    let sides = deformable.map(|side| breaks_on_joint(&assembly.bodies[side].vertices, &assembly.mesh, joint.ends));
    let sides = sides.collect::<Result<Vec<_>, String>>()?;
    let parts = assembly.mesh.elements[1];
    let (breaks, order) = match sides.as_slice() {
        [] if compliant => ((0..=parts).map(|i| i as f64 / parts as f64).collect(), assembly.mesh.order.max(2)),
        [] => (vec![0.0, 1.0], 1),
        [one] => (one.clone(), assembly.mesh.order),
        [one, other, ..] => (union_breaks(one, other), assembly.mesh.order),
    };
    let (at, share) = rule(order);
    let mut found: Vec<(f64, f64)> = vec![(breaks[0], 0.0)];
    for segment in breaks.windows(2) {
        let length = segment[1] - segment[0];
        if let Some(last) = found.last_mut() {
            last.1 += share[0] * length;
        }
        let inner = at.iter().zip(&share).take(order).skip(1);
        found.extend(inner.map(|(at, share)| (segment[0] + at * length, share * length)));
        found.push((segment[1], share[order] * length));
    }
    Ok(found)
}

/// Returns the contact points of one joint; contact points on deformable blocks become points of their bodies.
fn contact_points(
    read: &mut PathProblem,
    assembly: &Assembly,
    laws: &[Option<PointLaw>],
    index: usize,
) -> Result<Vec<Contact>, String> {
    let joint = &assembly.joints[index];
    let (normal, tangent) = joint.frame();
    let law = match joint.bond {
        Bond::Bonded => &PointLaw::Bonded,
        Bond::Law(law) => laws[law].as_ref().ok_or("a joint law gives neither facets nor tractions from gaps")?,
    };
    let stiffness = assembly.law(joint).filter(|_| law.facets().is_some()).and_then(|law| law.stiffness());
    let mut found = Vec::new();
    for (place, share) in places(assembly, joint)? {
        let position = joint.ends[0] + (joint.ends[1] - joint.ends[0]) * place;
        let area = share * joint.height() * assembly.width;
        let [minus, plus] = [joint.minus, joint.plus].map(|block| {
            let points = &mut read.bodies[read.body_of[block]].points;
            let slot = assembly.is_deformable(block).then(|| {
                points.push(position);
                points.len() - 1
            });
            Attachment { body: read.body_of[block], slot }
        });
        found.push(Contact {
            joint: index,
            position,
            normal,
            tangent,
            minus,
            plus,
            area,
            gap: joint.gap.at(place * joint.height()),
            law: law.clone(),
            compliance: stiffness.map_or([0.0; 2], |[normal, shear]| [1.0 / (normal * area), 1.0 / (shear * area)]),
            sliding: Sliding::of(assembly, joint, place, 1e-9 * read.length),
        });
    }
    Ok(found)
}

/// Adds springs at joints on which two meshes do not match, or which meet another joint in a point: there are more such
/// points than nodes.
fn stiffen_shared_places(read: &mut PathProblem, assembly: &Assembly) -> Result<(), String> {
    let grid = 1e-7 * read.length;
    let place = |c: &Contact| ((c.position.x / grid).round() as i64, (c.position.y / grid).round() as i64);
    let mut all: Vec<_> = read.contacts.iter().map(|c| (place(c), c.joint)).collect();
    all.sort_unstable();
    let mut shared = vec![false; assembly.joints.len()];
    for pair in all.windows(2).filter(|pair| pair[0].0 == pair[1].0 && pair[0].1 != pair[1].1) {
        pair.iter().for_each(|(_, joint)| shared[*joint] = true);
    }
    for (index, joint) in assembly.joints.iter().enumerate() {
        let blocks = [joint.minus, joint.plus].map(|side| (side, assembly.is_deformable(side)));
        if let [(minus, true), (plus, true)] = blocks {
            let on = |side: usize| breaks_on_joint(&assembly.bodies[side].vertices, &assembly.mesh, joint.ends);
            let (one, other) = (on(minus)?, on(plus)?);
            let both = union_breaks(&one, &other).len();
            shared[index] |= one.len() != both || other.len() != both;
        }
    }
    let stiff = |c: &Contact| c.compliance == [0.0; 2] && c.law.response().is_none();
    for contact in read.contacts.iter_mut().filter(|c| shared[c.joint] && stiff(c)) {
        let joint = &assembly.joints[contact.joint];
        let moduli = [joint.minus, joint.plus].map(|side| {
            let elasticity = assembly.material(side).elasticity().filter(|_| assembly.is_deformable(side));
            elasticity.map_or(f64::INFINITY, |elasticity| elasticity.modulus)
        });
        contact.compliance = [joint.height() / (REGULARISATION * moduli[0].min(moduli[1]) * contact.area); 2];
    }
    Ok(())
}

/// Returns for each stage the change of gravity, then its loads, if there are any.
fn load_steps_of(read: &mut PathProblem, assembly: &Assembly, stages: &[Stage]) -> Vec<LoadStep> {
    let mut steps: Vec<LoadStep> = Vec::new();
    let mut before = Vec2::zeros();
    for (stage, own) in stages.iter().enumerate() {
        let now = own.gravity.unwrap_or(before);
        let period = Period::of_stage(stages, stage);
        if now != before {
            let mut loading = Loading { acceleration: now - before, ..Loading::default() };
            fill_at_gravity(read, assembly, now - before, &mut loading);
            let (end, period) = (LoadStepEnd::Factor(1.0), period.start());
            steps.push(LoadStep { stage, gravity: true, loading, start: 0.0, end, period });
        }
        before = now;
        let mut loading = Loading { acceleration: own.accelerations.iter().sum(), ..Loading::default() };
        for load in &own.forces {
            let body = read.body_of[load.body];
            let slot = assembly.is_deformable(load.body).then(|| {
                read.bodies[body].points.push(load.point);
                read.bodies[body].points.len() - 1
            });
            loading.forces.push((body, slot, load.point, load.force));
        }
        for moved in &own.settlements {
            let body = read.body_of[moved.body];
            let swing = turned(read.bodies[body].pole - moved.about) * moved.rotation;
            let [x, y]: [f64; 2] = (moved.displacement + swing).into();
            loading.settlements.push((body, [x, y, moved.rotation]));
        }
        let zero = Vec2::zeros();
        let moves = loading.settlements.iter().any(|(_, motion)| *motion != [0.0; 3]);
        let passes = period.passes() && read.contacts.iter().any(|contact| contact.law.response().is_some());
        if !passes && !moves && loading.acceleration == zero && loading.forces.iter().all(|load| load.3 == zero) {
            continue;
        }
        let ends: Vec<(f64, LoadStepEnd)> = match own.target {
            Target::Factor(factor) => vec![(0.0, LoadStepEnd::Factor(factor))],
            Target::Collapse => {
                let start = own.factor_min.max(0.0f64.min(own.factor_max));
                let to_start = (start != 0.0).then_some((0.0, LoadStepEnd::Factor(start)));
                to_start.into_iter().chain([(start, LoadStepEnd::Collapse(own.factor_max))]).collect()
            }
        };
        let step = |(start, end)| {
            let (loading, period) = (loading.clone(), period.clone());
            LoadStep { stage, gravity: false, loading, start, end, period }
        };
        steps.extend(ends.into_iter().map(step));
    }
    steps
}

/// Adds weight and least pressure of the fill under a gravity as loads.
fn fill_at_gravity(read: &mut PathProblem, assembly: &Assembly, gravity: Vec2, loading: &mut Loading) {
    let Some(bridge) = &assembly.bridge else { return };
    let weights = bridge.masses.iter().map(|fill| (fill.body, fill.point, gravity * fill.mass));
    let least = bridge.reactions.iter().map(|reaction| {
        let [least, _] = reaction.bounds((-gravity.y).max(0.0));
        (reaction.body, reaction.point, reaction.direction * least)
    });
    for (block, point, force) in weights.chain(least).filter(|(_, _, force)| force.norm() > 0.0) {
        let body = read.body_of[block];
        let slot = assembly.is_deformable(block).then(|| {
            read.bodies[body].points.push(point);
            read.bodies[body].points.len() - 1
        });
        loading.forces.push((body, slot, point, force));
    }
}

/// Adds the reactions of the fill: the force above the least force acts between the block and ground that does not
/// move.
fn read_fill(read: &mut PathProblem, assembly: &Assembly, stages: &[Stage]) -> Result<(), String> {
    let reactions = assembly.fill_reactions();
    if reactions.is_empty() {
        return Ok(());
    }
    let gravities: Vec<Vec2> = stages.iter().filter_map(|stage| stage.gravity).collect();
    if gravities.windows(2).any(|pair| pair[0] != pair[1]) {
        return Err("gravity changes between stages, and the strength of the fill with it".into());
    }
    let down = gravities.first().map_or(0.0, |gravity| (-gravity.y).max(0.0));
    let ground = read.bodies.len();
    read.bodies.push(PathBody { held: true, ..PathBody::default() });
    for (index, reaction) in reactions.iter().enumerate() {
        let ([least, greatest], body) = (reaction.bounds(down), read.body_of[reaction.body]);
        if greatest <= least || read.bodies[body].held {
            continue;
        }
        let area: f64 = reaction.parts.iter().map(|part| part.area).sum();
        let strength = Facet::crushing((greatest - least) / area);
        let law: Vec<Facet> =
            [Facet::opening(0.0), strength].into_iter().chain(Facet::friction(0.0, 0.0, 0.0)).collect();
        let slot = assembly.is_deformable(reaction.body).then(|| {
            read.bodies[body].points.push(reaction.point);
            read.bodies[body].points.len() - 1
        });
        read.contacts.push(Contact {
            joint: assembly.joints.len() + index,
            position: reaction.point,
            normal: reaction.direction,
            tangent: turned(reaction.direction),
            minus: Attachment { body: ground, slot: None },
            plus: Attachment { body, slot },
            area,
            gap: 0.0,
            law: PointLaw::Facets(law.into()),
            compliance: [reaction.stiffness().map_or(0.0, f64::recip); 2],
            sliding: Sliding::fixed(if slot.is_some() { 0.5 } else { 0.0 }),
        });
    }
    Ok(())
}

/// Computes the flexibilities of deformable blocks at their points.
fn condense(read: &mut PathProblem, assembly: &Assembly) -> Result<(), String> {
    let mut condenser = Condenser::new(assembly.plane, assembly.width);
    let mut laws: Vec<(usize, Arc<PlanarUpdate>)> = Vec::new();
    for (block, shape) in assembly.bodies.iter().enumerate().filter(|(block, _)| assembly.is_deformable(*block)) {
        let Some(elasticity) = assembly.material(block).elasticity() else { continue };
        let body = &mut read.bodies[read.body_of[block]];
        let Some(yielding) = assembly.material(block).inelastic() else {
            let flexibility = condenser.flexibility(&shape.vertices, &elasticity, &assembly.mesh, &body.points)?;
            body.flexibility = Some(flexibility);
            continue;
        };
        if !laws.iter().any(|(material, _)| *material == shape.material) {
            let law = PlanarUpdate::new(yielding, assembly.plane).map_err(|why| why.to_string())?;
            laws.push((shape.material, Arc::new(law)));
        }
        let law = laws.iter().find(|(material, _)| *material == shape.material).map(|(_, law)| law.clone());
        let law = law.ok_or("a material that yields has no stresses")?;
        let inelastic = condenser.inelastic(&shape.vertices, &elasticity, law, &assembly.mesh, &body.points)?;
        body.flexibility = Some(inelastic.flexibility());
        body.inelastic = Some(Arc::new(inelastic));
    }
    Ok(())
}
