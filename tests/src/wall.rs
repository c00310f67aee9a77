//! Walls of bricks with their variations.

use crate::friction;

/// A wall under gravity, pushed until it collapses: everything a test may want to change.
#[derive(Debug, Clone)]
pub struct Wall {
    /// How bricks lie: [`Wall::of_rows`] or [`Wall::in_bond`].
    pub pattern: String,
    /// Length and height of a brick \[m\].
    pub brick: [f64; 2],
    /// Out of plane \[m\].
    pub width: f64,
    /// ρ \[kg/m³\].
    pub density: f64,
    /// Table of the joint law, without brackets.
    pub joint: String,
    /// Table of the solver, without brackets.
    pub solver: String,
    /// Downwards \[m/s²\].
    pub gravity: f64,
    /// What the wall is pushed by at factor 1 \[m/s²\].
    pub push: [f64; 2],
}

impl Wall {
    fn new(pattern: String) -> Wall {
        Wall {
            pattern,
            brick: [0.4, 0.175],
            width: 1.0,
            density: 2000.0,
            joint: friction(0.65),
            solver: "solver = \"auto\"".into(),
            gravity: 9.81,
            push: [9.81, 0.0],
        }
    }

    /// Courses from the bottom; lengths of bricks in units of a whole one, a negative number is an opening.
    pub fn of_rows(rows: &[&[f64]]) -> Wall {
        Wall::new(format!("rows = {rows:?}"))
    }

    /// A wall in running bond.
    pub fn in_bond(courses: usize, bricks: usize) -> Wall {
        Wall::new(format!("courses = {courses}\nbricks = {bricks}"))
    }

    /// The wall with an opening between two corners \[m\].
    pub fn with_opening(mut self, from: [f64; 2], to: [f64; 2]) -> Wall {
        self.pattern += &format!("\nopenings = [{{ from = {from:?}, to = {to:?} }}]");
        self
    }

    /// The study.
    pub fn study(&self) -> String {
        format!(
            r#"name = "wall"
[scene]
scene = "wall"
width = {:?}
brick = {:?}
{}
material = "stone"
joint = "dry"
[materials.stone]
law = "rigid"
density = {:?}
[joints.dry]
{}
[solver]
{}
[[stages]]
name = "dead"
gravity = {:?}
[[stages]]
name = "push"
until = "collapse"
loads = [{{ kind = "body", acceleration = {:?} }}]
"#,
            self.width, self.brick, self.pattern, self.density, self.joint, self.solver, self.gravity, self.push
        )
    }
}
