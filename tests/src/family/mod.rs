//! Five families of random scenes of three to nine blocks: random, mirror-symmetric, equal bricks, settlements, finite.
//!
//! Each scene is a list of blocks. It can be written as a study in several forms that must not change the answer: its
//! mirror image, and its blocks in another order.

mod shapes;
mod written;

use voussoir::core::random::Random;

/// A family of scenes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// Stacks, portals, arches and walls of unequal blocks.
    Random,
    /// The same shapes with a vertical axis of symmetry; several contact points change their mode at the same load.
    Symmetric,
    /// Walls, stacks and arches of equal blocks with round numbers.
    Bricks,
    /// A support moves before the load grows.
    Settlements,
    /// Finite displacements with soft joints, slender stacks and shallow arches.
    Finite,
}

impl Family {
    /// All families.
    pub const ALL: [Family; 5] =
        [Family::Random, Family::Symmetric, Family::Bricks, Family::Settlements, Family::Finite];

    /// Name in lower case.
    pub fn name(self) -> &'static str {
        match self {
            Family::Random => "random",
            Family::Symmetric => "symmetric",
            Family::Bricks => "bricks",
            Family::Settlements => "settlements",
            Family::Finite => "finite",
        }
    }

    /// Returns the family with this name.
    pub fn of_name(name: &str) -> Option<Family> {
        Family::ALL.into_iter().find(|family| family.name() == name)
    }
}

/// Joint law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Law {
    /// No slip.
    Stuck,
    /// Slip along the normal of the friction cone.
    Associated,
    /// Slip without dilatancy.
    Coulomb,
    /// Slip with half the friction angle as dilatancy.
    Dilatant,
}

/// A quadrilateral block; mesh elements count along edges 0 and 2, and along edges 1 and 3.
#[derive(Debug, Clone)]
struct Block {
    vertices: [[f64; 2]; 4],
    fixed: bool,
}

/// A load of the last stage.
#[derive(Debug, Clone, Copy)]
enum Load {
    /// A force \[N\] at a point of a block.
    Point { block: usize, point: [f64; 2], force: [f64; 2] },
    /// A horizontal acceleration of all blocks \[m/s²\].
    Body { acceleration: f64 },
}

/// A scene of a family.
#[derive(Debug, Clone)]
pub struct FamilyScene {
    /// Name of the shape.
    pub shape: &'static str,
    /// Joint law.
    pub law: Law,
    /// True if displacements are finite.
    pub finite: bool,
    friction: f64,
    /// Normal and shear stiffness of the joints \[Pa/m\] if the blocks are rigid.
    stiffness: Option<[f64; 2]>,
    /// Young's modulus of each block \[Pa\] if they are elastic.
    moduli: Vec<f64>,
    blocks: Vec<Block>,
    elements: [usize; 2],
    loads: Vec<Load>,
    /// Displacement and rotation of supports.
    settlements: Vec<(usize, [f64; 3])>,
}

/// A form of a scene that must not change the answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// The scene as it was drawn.
    Given,
    /// The mirror image.
    Mirrored,
    /// The blocks in another order.
    Renumbered,
}

/// Returns scene `seed` of a family.
pub fn family_scene(family: Family, seed: u64) -> FamilyScene {
    let salt = family as u64 + 1;
    let mut numbers = Random::new(seed.wrapping_mul(11).wrapping_add(salt).wrapping_add(7_000_000_000));
    let mut scene = shapes::drawn(family, &mut numbers);
    let round = family == Family::Bricks;
    scene.law = match numbers.unit() {
        share if share < 0.6 => Law::Coulomb,
        share if share < 0.8 => Law::Associated,
        share if share < 0.9 => Law::Dilatant,
        _ => Law::Stuck,
    };
    let friction = numbers.between(0.25, 0.9);
    scene.friction = if round { (10.0 * friction).round() / 10.0 } else { friction };
    let softer = if family == Family::Finite { 1.5 } else { 0.0 };
    let decade = numbers.between(0.0, 1.5) - softer;
    if numbers.chance(0.5) {
        let normal = 10f64.powf(9.0 + decade);
        scene.stiffness = Some([normal, normal * numbers.between(0.3, 0.8)]);
    } else {
        let spread = if family == Family::Random && numbers.chance(0.5) { 2.0 } else { 0.0 };
        let modulus = |numbers: &mut Random| 10f64.powf(9.0 + decade - spread * numbers.unit());
        scene.moduli = (0..scene.blocks.len()).map(|_| modulus(&mut numbers)).collect();
    }
    scene.elements = [numbers.whole(1, 3), numbers.whole(1, 2)];
    scene.finite = family == Family::Finite || seed.is_multiple_of(2);
    scene
}

impl FamilyScene {
    /// Returns the scene with rigid blocks, joints without compliance, small displacements and supports that do not
    /// move.
    pub fn rigid(mut self) -> FamilyScene {
        (self.stiffness, self.finite) = (None, false);
        self.moduli.clear();
        self.settlements.clear();
        self
    }

    /// Returns the scene with rigid blocks on compliant joints without slip, and finite displacements.
    pub fn on_springs(mut self) -> FamilyScene {
        (self.law, self.finite) = (Law::Stuck, true);
        self.stiffness = self.stiffness.or_else(|| self.moduli.first().map(|modulus| [*modulus, 0.5 * modulus]));
        self.moduli.clear();
        self
    }

    /// Returns the scene with joints and blocks that are softer by a factor.
    pub fn softer(mut self, by: f64) -> FamilyScene {
        self.stiffness.iter_mut().flatten().chain(&mut self.moduli).for_each(|value| *value /= by);
        self
    }

    /// Returns true if all loads are forces at points.
    pub fn has_point_loads(&self) -> bool {
        self.loads.iter().all(|load| matches!(load, Load::Point { .. }))
    }

    /// Returns the scene with small displacements.
    pub fn small(self) -> FamilyScene {
        FamilyScene { finite: false, ..self }
    }

    /// Returns the scene with another law.
    pub fn with_law(self, law: Law) -> FamilyScene {
        FamilyScene { law, ..self }
    }

    /// Returns μ, or `None` if joints do not slip.
    pub fn friction(&self) -> Option<f64> {
        (self.law != Law::Stuck).then_some(self.friction)
    }

    /// Returns the opening per slip.
    pub fn dilatancy(&self) -> f64 {
        match self.law {
            Law::Stuck | Law::Coulomb => 0.0,
            Law::Associated => self.friction,
            Law::Dilatant => (self.friction.atan() / 2.0).tan(),
        }
    }
}
