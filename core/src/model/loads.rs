//! Loads, the stages in which they are applied, and the resultants of each stage.

use super::assembly::Assembly;
use super::geometry::Vec2;
use super::wrench::{Wrenches, add_force};

/// A force on a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointForce {
    /// Index of the body.
    pub body: usize,
    /// Point of action \[m\].
    pub point: Vec2,
    /// Force \[N\].
    pub force: Vec2,
}

/// The spread of a load from the road of a bridge to the extrados; drawings use it, it is not a force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadSpread {
    /// Ends of the patch on the road \[m\].
    pub on_road: [Vec2; 2],
    /// Ends of the loaded length, on the level at which the spread is computed \[m\].
    pub below: [Vec2; 2],
}

/// A movement imposed on a support.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settlement {
    /// Index of the held body.
    pub body: usize,
    /// Displacement \[m\].
    pub displacement: Vec2,
    /// Rotation about `about` \[rad\].
    pub rotation: f64,
    /// Pole of the rotation \[m\].
    pub about: Vec2,
}

/// One stage of loading.
#[derive(Debug, Clone)]
pub struct Stage {
    /// Name of the stage.
    pub name: String,
    /// Gravity from this stage on \[m/s²\]; `None` keeps the previous gravity. The factor of the stage does not
    /// multiply it.
    pub gravity: Option<Vec2>,
    /// Forces, multiplied by the stage's factor.
    pub forces: Vec<PointForce>,
    /// Accelerations (× mass) on every free body, multiplied by the stage's factor \[m/s²\].
    pub accelerations: Vec<Vec2>,
    /// Spreads of the forces that come from a road.
    pub spreads: Vec<LoadSpread>,
    /// Prescribed movements of supports, multiplied by the stage's factor.
    pub settlements: Vec<Settlement>,
    /// End of the stage.
    pub target: Target,
    /// Least factor of the search; 0 if not given.
    pub factor_min: f64,
    /// Greatest factor of the search.
    pub factor_max: f64,
    /// Duration \[s\]; 0 if no time passes.
    pub duration: f64,
    /// Values of named fields at the end of the stage, in SI units.
    pub fields: Vec<(String, f64)>,
}

/// The end of a stage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Target {
    /// The stage ends at this factor.
    Factor(f64),
    /// The stage ends at collapse.
    Collapse,
}

/// The loads of a stage: `fixed + factor × varying`.
#[derive(Debug, Clone)]
pub struct StageLoads {
    /// Fixed wrench per body, about the origin.
    pub fixed: Wrenches,
    /// Wrench per body for factor 1, about the origin.
    pub varying: Wrenches,
    /// Least and greatest force of each reaction of the fill under the gravity of the stage \[N\].
    pub fill_bounds: Vec<[f64; 2]>,
}

/// Returns the weight of the fill on the blocks under it. Accelerations of blocks do not act on the fill.
pub fn fill_weights(assembly: &Assembly, gravity: Vec2) -> Vec<PointForce> {
    let masses = assembly.bridge.iter().flat_map(|bridge| &bridge.masses);
    masses.map(|fill| PointForce { body: fill.body, point: fill.point, force: gravity * fill.mass }).collect()
}

/// Returns the least and greatest force of each reaction of the fill \[N\]. Only downward gravity presses the fill.
pub fn fill_bounds(assembly: &Assembly, gravity: Vec2) -> Vec<[f64; 2]> {
    let down = (-gravity.y).max(0.0);
    assembly.fill_reactions().iter().map(|reaction| reaction.bounds(down)).collect()
}

/// Returns the loads of each stage, with the loads of earlier stages at the factors that they reached. The gravity of a
/// stage acts on all bodies.
pub fn stage_loads(assembly: &Assembly, stages: &[Stage]) -> Vec<StageLoads> {
    let count = assembly.bodies.len();
    let inertia: Vec<_> = (0..count).map(|body| assembly.inertia(body)).collect();
    let accelerate = |wrenches: &mut Wrenches, acceleration: Vec2| {
        for (wrench, inertia) in wrenches.iter_mut().zip(&inertia) {
            add_force(wrench, inertia.centroid, acceleration * inertia.mass, 1.0);
        }
    };
    let mut gravity = Vec2::zeros();
    let mut earlier: Wrenches = vec![[0.0; 3]; count];
    stages
        .iter()
        .map(|stage| {
            gravity = stage.gravity.unwrap_or(gravity);
            let mut fixed = earlier.clone();
            accelerate(&mut fixed, gravity);
            for weight in fill_weights(assembly, gravity) {
                add_force(&mut fixed[weight.body], weight.point, weight.force, 1.0);
            }
            let mut varying: Wrenches = vec![[0.0; 3]; count];
            for force in &stage.forces {
                add_force(&mut varying[force.body], force.point, force.force, 1.0);
            }
            for &acceleration in &stage.accelerations {
                accelerate(&mut varying, acceleration);
            }
            if let Target::Factor(factor) = stage.target {
                for (sum, add) in earlier.iter_mut().zip(&varying) {
                    (0..3).for_each(|i| sum[i] += factor * add[i]);
                }
            }
            let fill_bounds = fill_bounds(assembly, gravity);
            StageLoads { fixed, varying, fill_bounds }
        })
        .collect()
}
