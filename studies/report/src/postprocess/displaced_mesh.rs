//! Blocks at the end of a path: displacements and stresses on their meshes, computed from the result alone (contact
//! forces, loads and motions of the blocks).

use voussoir_core::elastic::{Condenser, Recovered};
use voussoir_core::limit::Status;
use voussoir_core::model::geometry::{Vec2, turned};
use voussoir_core::model::{Assembly, Stage};
use voussoir_core::path::{PathProblem, PathState};
use voussoir_core::plugin::OutputOf;
use voussoir_study::checks::fields::{path_forces, path_motion};
use voussoir_study::results::inelastic_state;
use voussoir_study::results::{CaseResult, OutputEntry};

/// A block with its mesh; a rigid block is a single cell with its vertices as nodes.
#[derive(Debug, Clone)]
pub struct DisplacedBlock {
    /// Index of the block.
    pub block: usize,
    /// Positions before any load \[m\].
    pub nodes: Vec<Vec2>,
    /// Displacement of each node \[m\].
    pub displacement: Vec<Vec2>,
    /// Stress (σ_xx, σ_yy, σ_zz, σ_xy) at each node, tension positive \[Pa\]. If displacements are finite, the axes rotate with
    /// the block. Empty for a rigid block.
    pub stress: Vec<[f64; 4]>,
    /// Stress in the middle of each cell \[Pa\]; empty for a rigid block.
    pub cell_stress: Vec<[f64; 4]>,
    /// Nodes of each cell, in VTK's order.
    pub cells: Vec<Vec<usize>>,
    /// Order of the elements; 0 for a rigid block.
    pub order: usize,
    /// Mean equivalent plastic strain of each cell; empty if the block has not yielded.
    pub plastic_strain: Vec<f64>,
    /// Outputs of the material: name with unit, and one value for each cell (the mean over its points, or the value of the
    /// block); NaN if a value is missing.
    pub outputs: Vec<(String, Vec<f64>)>,
    /// Greatest residual resultant on the block, including its weight, relative to the forces on it (moments are divided by the
    /// size of the scene); 0 for a rigid block.
    pub imbalance: f64,
}

/// Returns the state at the end of `result`, for the problem of its case.
fn end_state(
    problem: &PathProblem,
    assembly: &Assembly,
    result: &CaseResult,
    finite: bool,
) -> Result<PathState, String> {
    let stage = result.stages.len().checked_sub(1).ok_or("no stage was begun")?;
    let first =
        problem.load_steps.iter().position(|d| d.stage == stage).filter(|_| result.status == Status::NoEquilibrium);
    let load_step = first.or(problem.load_steps.iter().rposition(|d| d.stage <= stage)).ok_or("no load was applied")?;
    let force =
        path_forces(assembly, problem, result.proof.field.as_deref().ok_or("no contact forces")?, &result.proof.fill)?;
    let motion = path_motion(assembly, problem, result, finite)?;
    let factor = result.proof.field_factor.ok_or("no factor of the contact forces")?;
    let yielded = inelastic_state::read(assembly, problem, &result.path.yielded)?;
    Ok(PathState { load_step, factor, force, motion, yielded, ..PathState::default() })
}

/// Returns the blocks of a case at the end of its path. Blocks without a shape are omitted. The error gives the reason if no
/// blocks are available.
pub fn displaced_blocks(
    assembly: &Assembly,
    stages: &[Stage],
    result: &CaseResult,
    finite: bool,
) -> Result<Vec<DisplacedBlock>, String> {
    if result.path.displacements.is_none() {
        return Err("limit analysis leaves no deformed state".into());
    }
    let problem = PathProblem::new(assembly, stages)?;
    let state = end_state(&problem, assembly, result, finite)?;
    let applied = problem.applied(state.load_step, state.factor);
    let gravity: Vec2 =
        problem.load_steps.iter().zip(applied).map(|(load_step, factor)| load_step.loading.acceleration * factor).sum();
    let forces = problem.forces_on_points(&state, finite);
    let end = EndState { assembly, problem: &problem, state: &state, forces: &forces, gravity, finite, result };
    let mut condenser = Condenser::new(assembly.plane, assembly.width);
    let shaped = (0..assembly.bodies.len()).filter(|block| assembly.bodies[*block].vertices.len() >= 3);
    shaped
        .map(|block| match problem.bodies[problem.body_of[block]].flexibility {
            None => Ok(end.rigid_block(block)),
            Some(_) => end.deformable_block(block, &mut condenser),
        })
        .collect()
}

/// The state at which a path ends, with the forces on the points of its bodies.
struct EndState<'a> {
    assembly: &'a Assembly,
    problem: &'a PathProblem,
    state: &'a PathState,
    forces: &'a [Vec<Vec2>],
    gravity: Vec2,
    finite: bool,
    result: &'a CaseResult,
}

impl EndState<'_> {
    /// Rotates a vector by an angle if displacements are finite.
    fn turn(&self, angle: f64, v: Vec2) -> Vec2 {
        if self.finite { v * angle.cos() + turned(v) * angle.sin() } else { v }
    }

    /// Returns the displacement of a point that moves with a body of the path.
    fn rigid(&self, body: usize, place: Vec2) -> Vec2 {
        let [x, y, theta] = self.state.motion[body];
        let arm = place - self.problem.bodies[body].pole;
        let swing = if self.finite { self.turn(theta, arm) - arm } else { turned(arm) * theta };
        Vec2::new(x, y) + swing
    }

    fn rigid_block(&self, block: usize) -> DisplacedBlock {
        let (vertices, body) = (&self.assembly.bodies[block].vertices, self.problem.body_of[block]);
        DisplacedBlock {
            block,
            displacement: vertices.iter().map(|v| self.rigid(body, *v)).collect(),
            cells: vec![(0..vertices.len()).collect()],
            nodes: vertices.clone(),
            stress: Vec::new(),
            cell_stress: Vec::new(),
            plastic_strain: Vec::new(),
            outputs: Vec::new(),
            order: 0,
            imbalance: 0.0,
        }
    }

    /// Returns the outputs of the material of a block, cell by cell.
    fn outputs(&self, block: usize, cells: usize) -> Vec<(String, Vec<f64>)> {
        let Some(inelastic) = &self.problem.bodies[self.problem.body_of[block]].inelastic else { return Vec::new() };
        let of_block = |entry: &&OutputEntry| entry.is_of_blocks() && entry.places.contains(&block);
        let column = |entry: &OutputEntry| {
            let own = entry.places.iter().zip(&entry.values).filter(|(place, _)| **place == block);
            let values: Vec<f64> = own.map(|(_, value)| value.unwrap_or(f64::NAN)).collect();
            let by_cell = match entry.of {
                OutputOf::Point if values.len() == inelastic.gauss_points() => inelastic.by_element(&values),
                OutputOf::Block if values.len() == 1 => vec![values[0]; cells],
                _ => return None,
            };
            Some((entry.header(), by_cell))
        };
        self.result.outputs.iter().filter(of_block).filter_map(column).collect()
    }

    fn deformable_block(&self, block: usize, condenser: &mut Condenser) -> Result<DisplacedBlock, String> {
        let (assembly, shape, body) = (self.assembly, &self.assembly.bodies[block], self.problem.body_of[block]);
        let material = &assembly.catalogue.materials[shape.material].1;
        let Some(elasticity) = material.elasticity() else {
            return Err(format!("the material of \"{}\" does not deform", shape.name));
        };
        let (points, own) = (&self.problem.bodies[body].points, &self.forces[body]);
        let theta = self.state.motion[body][2];
        let weight = self.turn(-theta, self.gravity);
        let body_force = weight * material.density();
        let mut recovered = condenser.recover(&shape.vertices, &elasticity, &assembly.mesh, points, own, body_force)?;
        let mut plastic_strain = Vec::new();
        if let (Some(inelastic), Some(own)) = (&self.problem.bodies[body].inelastic, self.state.inelastic(body)) {
            let imbalance = recovered.imbalance;
            recovered = Recovered { imbalance, ..inelastic.recover(&own.displacement, &own.state)? };
            plastic_strain = inelastic.by_element(&own.state.equivalent);
        }
        let outputs = self.outputs(block, recovered.elements.len());
        let [fx, fy, moment] = recovered.imbalance;
        let size = own.iter().map(|f| f.norm()).sum::<f64>() + weight.norm() * self.problem.bodies[body].mass;
        let displaced = recovered.nodes.iter().zip(&recovered.displacement);
        Ok(DisplacedBlock {
            block,
            displacement: displaced.map(|(node, u)| self.rigid(body, *node) + self.turn(theta, *u)).collect(),
            stress: recovered.stress,
            cell_stress: recovered.element_stress,
            nodes: recovered.nodes,
            cells: recovered.elements,
            order: recovered.order,
            plastic_strain,
            outputs,
            imbalance: fx.hypot(fy).max(moment.abs() / self.problem.length) / size.max(f64::MIN_POSITIVE),
        })
    }
}
