//! Fill on paths: each of its reactions is a contact point between a block and ground that never moves.
//!
//! The force above the least force is a normal force r_n between 0 and the greatest force minus the least, without
//! friction. The least force is a load that grows with gravity. The strength is always the strength at the gravity of
//! the stage: while gravity grows, the full strength of the fill is available. With associated flow the collapse load
//! does not depend on this.

use super::point_law::PointLaw;
use super::problem::{Attachment, Contact, PathBody, PathProblem};
use super::sliding::Sliding;
use crate::law::Facet;
use crate::model::geometry::{Vec2, turned};
use crate::model::{Assembly, PointForce, Stage, fill_bounds};

/// Returns the gravity that determines the strength of the fill.
///
/// # Errors
/// If gravity changes between stages.
pub fn fill_gravity(stages: &[Stage]) -> Result<Vec2, String> {
    let mut set = stages.iter().filter_map(|stage| stage.gravity);
    let first = set.next().unwrap_or_default();
    match set.find(|gravity| *gravity != first) {
        Some(_) => {
            Err("gravity changes between stages, and the strength of the fill with it: limit analysis only".into())
        }
        None => Ok(first),
    }
}

/// Returns the least forces of the fill, which act as loads together with gravity.
pub fn least_forces(assembly: &Assembly, gravity: Vec2) -> Vec<PointForce> {
    let reactions = assembly.fill_reactions().iter().zip(fill_bounds(assembly, gravity));
    let force = |(reaction, bounds): (&crate::model::FillReaction, [f64; 2])| PointForce {
        body: reaction.body,
        point: reaction.point,
        force: reaction.direction * bounds[0],
    };
    reactions.map(force).filter(|f| f.force != Vec2::zeros()).collect()
}

/// Adds the reactions of the fill as contact points with a separate ground.
pub(super) fn add_fill(problem: &mut PathProblem, assembly: &Assembly, stages: &[Stage]) -> Result<(), String> {
    if assembly.fill_reactions().is_empty() {
        return Ok(());
    }
    let bounds = fill_bounds(assembly, fill_gravity(stages)?);
    let ground = problem.bodies.len();
    problem.bodies.push(PathBody { held: true, ..PathBody::default() });
    for (index, (reaction, [least, greatest])) in assembly.fill_reactions().iter().zip(bounds).enumerate() {
        let body = problem.body_of[reaction.body];
        if problem.bodies[body].held || greatest <= least {
            continue;
        }
        let slot = assembly.is_deformable(reaction.body).then(|| {
            problem.bodies[body].points.push(reaction.point);
            problem.bodies[body].points.len() - 1
        });
        let area = reaction.area();
        let [left, right] = Facet::friction(0.0, 0.0, 0.0);
        let facets = vec![Facet::opening(0.0), Facet::crushing((greatest - least) / area), left, right];
        let compliance = reaction.stiffness().map_or(0.0, |stiffness| 1.0 / stiffness);
        problem.contacts.push(Contact {
            joint: assembly.joints.len() + index,
            position: reaction.point,
            normal: reaction.direction,
            tangent: turned(reaction.direction),
            minus: Attachment { body: ground, slot: None },
            plus: Attachment { body, slot },
            area,
            gap: 0.0,
            law: PointLaw::Facets(facets.into()),
            compliance: [compliance; 2],
            // The force stays horizontal at the point of the block; on a block that deforms it rotates with half of its
            // rotation.
            sliding: match slot {
                None => Sliding::fixed(0.0),
                Some(_) => Sliding::middle(0.0),
            },
        });
    }
    Ok(())
}
