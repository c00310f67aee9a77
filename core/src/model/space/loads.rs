//! Loads in space, stage by stage.

use super::assembly::{SpaceAssembly, SpaceFill};
use super::vector::{Vec3, Wrench};
use crate::model::loads::{Stage, Target};

/// A force on a body in space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpaceForce {
    /// Index of the body.
    pub body: usize,
    /// Point of action \[m\].
    pub point: Vec3,
    /// Force \[N\].
    pub force: Vec3,
}

/// The loads of a stage in space. The [`Stage`] beside it has its name, target and range of factors.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SpaceStage {
    /// Gravity from this stage on \[m/s²\]; `None` keeps the previous gravity. The factor of the stage does not
    /// multiply it.
    pub gravity: Option<Vec3>,
    /// Forces, multiplied by the stage's factor.
    pub forces: Vec<SpaceForce>,
    /// Accelerations (× mass) on every free body, multiplied by the stage's factor \[m/s²\].
    pub accelerations: Vec<Vec3>,
    /// Movements of supports; a factor given for the stage multiplies them.
    pub settlements: Vec<SpaceSettlement>,
}

/// The movement of a support in a stage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpaceSettlement {
    /// The support, a held body.
    pub body: usize,
    /// Displacement of the point `about` \[m\].
    pub displacement: Vec3,
    /// Rotation vector \[rad\].
    pub rotation: Vec3,
    /// Centre of rotation \[m\].
    pub about: Vec3,
}

/// The loads of a stage in space: `fixed + factor × varying`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SpaceLoads {
    /// Fixed wrench per body, about the origin.
    pub fixed: Vec<Wrench>,
    /// Wrench per body for factor 1, about the origin.
    pub varying: Vec<Wrench>,
}

/// Adds `factor` times a force at a point to a wrench about the origin.
pub fn add_space_force(wrench: &mut Wrench, point: &Vec3, force: &Vec3, factor: f64) {
    let moment = point.cross(force);
    for (sum, part) in wrench.iter_mut().zip(force.iter().chain(moment.iter())) {
        *sum += factor * part;
    }
}

/// Returns the loads of each stage, with the loads of earlier stages at the factors that they reached. The gravity of a
/// stage acts on all bodies and on their fill.
pub fn space_loads(assembly: &SpaceAssembly, stages: &[(&Stage, &SpaceStage)]) -> Vec<SpaceLoads> {
    let bodies: Vec<(f64, Vec3)> = (0..assembly.bodies.len()).map(|body| assembly.mass_and_centroid(body)).collect();
    let accelerate = |wrenches: &mut [Wrench], acceleration: &Vec3| {
        for (wrench, (mass, centroid)) in wrenches.iter_mut().zip(&bodies) {
            add_space_force(wrench, centroid, acceleration, *mass);
        }
    };
    let mut gravity = Vec3::zeros();
    let mut earlier = vec![[0.0; 6]; bodies.len()];
    let of_stage = |(stage, loads): &(&Stage, &SpaceStage)| {
        gravity = loads.gravity.unwrap_or(gravity);
        let mut fixed = earlier.clone();
        accelerate(&mut fixed, &gravity);
        for SpaceFill { body, point, mass } in &assembly.fill {
            add_space_force(&mut fixed[*body], point, &gravity, *mass);
        }
        let mut varying = vec![[0.0; 6]; bodies.len()];
        for SpaceForce { body, point, force } in &loads.forces {
            add_space_force(&mut varying[*body], point, force, 1.0);
        }
        loads.accelerations.iter().for_each(|acceleration| accelerate(&mut varying, acceleration));
        if let Target::Factor(factor) = stage.target {
            for (sum, add) in earlier.iter_mut().flatten().zip(varying.iter().flatten()) {
                *sum += factor * add;
            }
        }
        SpaceLoads { fixed, varying }
    };
    stages.iter().map(of_stage).collect()
}
