//! Loads and the stages in which they come, and the resultants of each stage.

use super::assembly::Assembly;
use super::geometry::Vec2;
use super::wrench::{Wrenches, add_force};

/// A force on a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointForce {
    /// Index of the body.
    pub body: usize,
    /// Where it acts \[m\].
    pub point: Vec2,
    /// \[N\].
    pub force: Vec2,
}

/// How a load on the road of a bridge reaches the extrados; for drawings, no force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadSpread {
    /// Ends of the patch on the road \[m\].
    pub on_road: [Vec2; 2],
    /// Ends of what it loads, on the level at which the spread is taken \[m\].
    pub below: [Vec2; 2],
}

/// A movement imposed on a support.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settlement {
    /// Index of the held body.
    pub body: usize,
    /// \[m\].
    pub displacement: Vec2,
    /// About `about` \[rad\].
    pub rotation: f64,
    /// Pole of the rotation \[m\].
    pub about: Vec2,
}

/// One stage of loading.
#[derive(Debug, Clone)]
pub struct Stage {
    /// Its name.
    pub name: String,
    /// Gravity from this stage on \[m/s²\]; `None` leaves it as it was. Not multiplied by the factor.
    pub gravity: Option<Vec2>,
    /// Forces, multiplied by the stage's factor.
    pub forces: Vec<PointForce>,
    /// Accelerations (× mass) on every free body, multiplied by the stage's factor \[m/s²\].
    pub accelerations: Vec<Vec2>,
    /// How those of the forces that come from a road have spread.
    pub spreads: Vec<LoadSpread>,
    /// Movements of supports, multiplied by the stage's factor.
    pub settlements: Vec<Settlement>,
    /// How far it goes.
    pub target: Target,
    /// Least factor searched; 0 where it is not given.
    pub factor_min: f64,
    /// Greatest factor searched.
    pub factor_max: f64,
}

/// How far a stage goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Target {
    /// To this factor.
    Factor(f64),
    /// Until it collapses.
    Collapse,
}

/// What a stage applies: `fixed + factor × varying`.
#[derive(Debug, Clone)]
pub struct StageLoads {
    /// Wrench per body, about the origin.
    pub fixed: Wrenches,
    /// Wrench per body, about the origin, for factor 1.
    pub varying: Wrenches,
    /// Least and greatest force of each element of the fill under the gravity of the stage \[N\].
    pub fill_bounds: Vec<[f64; 2]>,
}

/// Weight of the fill on the blocks under it; accelerations of blocks do not move it.
pub fn fill_weights(assembly: &Assembly, gravity: Vec2) -> Vec<PointForce> {
    let masses = assembly.bridge.iter().flat_map(|bridge| &bridge.masses);
    masses.map(|fill| PointForce { body: fill.body, point: fill.point, force: gravity * fill.mass }).collect()
}

/// Least and greatest force of each element of the fill \[N\]; only the downward part of gravity presses fill.
pub fn fill_bounds(assembly: &Assembly, gravity: Vec2) -> Vec<[f64; 2]> {
    let down = (-gravity.y).max(0.0);
    assembly.fill_reactions().iter().map(|reaction| reaction.bounds(down)).collect()
}

/// The loads of each stage, those of earlier stages at the factors they reached included.
/// The gravity in force at each stage acts on all bodies.
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
