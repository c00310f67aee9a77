//! Outputs of laws at the points of a state, which plug-ins declare on their cards.

use super::law_step::LawStep;
use super::problem::PathProblem;
use super::state::PathState;
use crate::elastic::GaussOutputs;
use crate::law::TractionPoint;

/// The outputs of a law at one point.
#[derive(Debug, Clone, PartialEq)]
pub struct PointOutputs {
    /// Index of the joint or of the block in the assembly.
    pub place: usize,
    /// Position in the undeformed scene \[m\].
    pub position: [f64; 2],
    /// Length of the joint \[m\] or area of the block \[m²\] that the point represents.
    pub size: f64,
    /// One value for each output of points on the card; NaN if the law has not written it.
    pub values: Vec<f64>,
}

impl PointOutputs {
    /// Returns the outputs at the contact points of joints, in their order. `count` returns the number of outputs of the
    /// law of a joint.
    ///
    /// # Errors
    /// If an update of a law fails or the state does not fit the problem.
    pub fn of_joints(
        problem: &PathProblem,
        state: &PathState,
        count: impl Fn(usize) -> usize,
    ) -> Result<Vec<PointOutputs>, String> {
        state.check_form(problem)?;
        let step = LawStep::to(problem, state);
        let (mut found, mut at) = (Vec::new(), 0);
        for (index, contact) in problem.contacts.iter().enumerate() {
            let Some(law) = problem.response(index) else { continue };
            let old = &state.memory[at..at + law.state_size()];
            at += law.state_size();
            let count = count(contact.joint);
            if count == 0 {
                continue;
            }
            let (gap, context, mut new) = (state.gap[index], step.context(problem, index), old.to_vec());
            let point: TractionPoint = law
                .respond_point(gap, &context, old, &mut new)
                .map_err(|why| format!("joint {}: {why}", contact.joint))?;
            let mut values = vec![f64::NAN; count];
            law.outputs(gap, &context, &new, &point, &mut values);
            let (place, position, size) = (contact.joint, contact.position.into(), contact.area / problem.width);
            found.push(PointOutputs { place, position, size, values });
        }
        Ok(found)
    }

    /// Returns the outputs at the stress points of blocks whose material can yield, block by block. `count` returns the
    /// number of outputs of the material of a block.
    ///
    /// # Errors
    /// If an update of a material fails or the state does not fit the problem.
    pub fn of_blocks(
        problem: &PathProblem,
        state: &PathState,
        finite: bool,
        count: impl Fn(usize) -> usize,
    ) -> Result<Vec<PointOutputs>, String> {
        let (mut found, mut forces) = (Vec::new(), None);
        for (index, body) in problem.bodies.iter().enumerate() {
            let (Some(inelastic), Some(&place)) = (&body.inelastic, body.members.first()) else { continue };
            let count = count(place);
            if count == 0 {
                continue;
            }
            let forces = forces.get_or_insert_with(|| problem.forces_on_points(state, finite));
            let own: Vec<f64> = forces[index].iter().flat_map(|force| [force.x, force.y]).collect();
            let points = match state.inelastic(index) {
                Some(own) => inelastic.outputs(&own.displacement, &own.state.history, count),
                None => {
                    let (displacement, state) = inelastic.elastic_state(&own);
                    inelastic.outputs(&displacement, &state.history, count)
                }
            };
            let points = points.map_err(|why| format!("block {place}: {why}"))?;
            let one =
                |own: GaussOutputs| PointOutputs { place, position: own.position, size: own.area, values: own.values };
            found.extend(points.into_iter().map(one));
        }
        Ok(found)
    }
}
