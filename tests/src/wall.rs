//! Walls of bricks with their variations.

use crate::friction;

/// A wall under gravity that is pushed until it collapses, with all parameters that tests change.
#[derive(Debug, Clone)]
pub struct Wall {
    /// Pattern of the bricks: [`Wall::of_rows`] or [`Wall::in_bond`].
    pub pattern: String,
    /// Length and height of a brick \[m\].
    pub brick: [f64; 2],
    /// Width out of plane \[m\].
    pub width: f64,
    /// Density ρ \[kg/m³\].
    pub density: f64,
    /// Table of the joint law, without brackets.
    pub joint: String,
    /// Table of the solver, without brackets.
    pub solver: String,
    /// Gravity, downwards \[m/s²\].
    pub gravity: f64,
    /// Acceleration that pushes the wall at factor 1 \[m/s²\].
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

    /// Creates a wall from courses from the bottom; lengths of bricks in units of a whole brick, negative for an
    /// opening.
    pub fn of_rows(rows: &[&[f64]]) -> Wall {
        Wall::new(format!("rows = {rows:?}"))
    }

    /// Creates a wall of 62 bricks around a window, with compliant joints that slide without dilatancy.
    pub fn around_a_window(friction: &str, solver: &str) -> Wall {
        let joint = crate::compliant(&format!("law = \"coulomb\"\n{friction}"), 1e10, 4e9);
        let solver = format!("solver = \"{solver}\"");
        let wall = Wall::in_bond(8, 8).with_opening([1.25, 0.5], [2.25, 1.5]);
        Wall { width: 0.24, brick: [0.5, 0.25], joint, solver, ..wall }
    }

    /// Creates a wall in running bond.
    pub fn in_bond(courses: usize, bricks: usize) -> Wall {
        Wall::new(format!("courses = {courses}\nbricks = {bricks}"))
    }

    /// Returns the wall with an opening between two corners \[m\].
    pub fn with_opening(mut self, from: [f64; 2], to: [f64; 2]) -> Wall {
        self.pattern += &format!("\nopenings = [{{ from = {from:?}, to = {to:?} }}]");
        self
    }

    /// Returns the study.
    pub fn study(&self) -> String {
        let push = format!("loads = [{{ kind = \"body\", acceleration = {:?} }}]", self.push);
        format!("{}[[stages]]\nname = \"push\"\nuntil = \"collapse\"\n{push}\n", self.under_its_weight())
    }

    /// Returns the study without the stage that pushes it.
    pub fn under_its_weight(&self) -> String {
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
"#,
            self.width, self.brick, self.pattern, self.density, self.joint, self.solver, self.gravity
        )
    }
}
