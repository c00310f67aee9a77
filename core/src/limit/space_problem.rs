//! The problem of limit analysis in space.

use super::space_points::{PointSet, point_sets};
use crate::law::FrictionCone;
use crate::model::space::{SpaceAssembly, Vec3, Wrench};

/// A contact between two free bodies, or between a body and the ground (`None`).
#[derive(Debug, Clone)]
pub struct SpaceContact {
    /// Index of the contact in the assembly.
    pub contact: usize,
    /// Free body on the minus side.
    pub minus: Option<usize>,
    /// Free body on the plus side.
    pub plus: Option<usize>,
    /// Frame (n, s, t).
    pub frame: [Vec3; 3],
    /// Strength of the contact.
    pub law: FrictionCone,
    /// Points whose forces are certainly admissible: forces act here.
    pub inner: PointSet,
    /// Points whose dissipation is certainly not too small: motions are evaluated here.
    pub outer: PointSet,
}

impl SpaceContact {
    /// Creates a contact with these vertices relative to the pole. `parts` divides contacts whose strength is more than a cone.
    pub fn new(
        contact: usize,
        bodies: [Option<usize>; 2],
        vertices: &[Vec3],
        frame: [Vec3; 3],
        (law, parts): (FrictionCone, usize),
    ) -> Self {
        let [inner, outer] = point_sets(vertices, &law, parts);
        SpaceContact { contact, minus: bodies[0], plus: bodies[1], frame, law, inner, outer }
    }

    /// Returns the wrench on the plus body per unit of force along a direction at a point; minus gets the opposite.
    pub fn wrench(point: &Vec3, direction: &Vec3) -> Wrench {
        let moment = point.cross(direction);
        [direction.x, direction.y, direction.z, moment.x, moment.y, moment.z]
    }
}

/// Rigid bodies with the wrenches `fixed + λ varying` about the pole, and their contacts.
#[derive(Debug, Clone)]
pub struct SpaceProblem {
    /// Free body of the problem for each body of the assembly; `None` if the ground holds it.
    pub free: Vec<Option<usize>>,
    /// Number of free bodies.
    pub bodies: usize,
    /// Contacts with at least one free body.
    pub contacts: Vec<SpaceContact>,
    /// Fixed wrench of each free body about the pole \[N, N m\].
    pub fixed: Vec<Wrench>,
    /// Wrench of each free body about the pole for λ = 1 \[N, N m\].
    pub varying: Vec<Wrench>,
    /// Centre of the scene, the pole of all moments \[m\].
    pub pole: Vec3,
    /// Length scale \[m\].
    pub length: f64,
}

impl SpaceProblem {
    /// Reduces an assembly whose contacts have these cones, one for each law of the catalogue, under fixed and varying wrenches
    /// on each body about the origin. `parts` divides contacts whose strength is more than a cone.
    pub fn new(
        assembly: &SpaceAssembly,
        (cones, parts): (&[FrictionCone], usize),
        [fixed, varying]: [&[Wrench]; 2],
    ) -> Self {
        let mut bodies = 0;
        let number = |fixed: bool| {
            (!fixed).then(|| {
                bodies += 1;
                bodies - 1
            })
        };
        let free: Vec<Option<usize>> = assembly.bodies.iter().map(|body| body.fixed).map(number).collect();
        let (low, high) = assembly.bounding_box();
        let (pole, length) =
            if assembly.bodies.is_empty() { (Vec3::zeros(), 1.0) } else { ((low + high) / 2.0, (high - low).norm()) };
        let contacts = assembly.contacts.iter().enumerate().filter_map(|(index, contact)| {
            let (minus, plus) = (free[contact.minus], free[contact.plus]);
            (minus.is_some() || plus.is_some()).then(|| {
                let vertices: Vec<Vec3> = contact.points.iter().map(|point| point - pole).collect();
                let frame = [contact.normal, contact.tangents[0], contact.tangents[1]];
                SpaceContact::new(index, [minus, plus], &vertices, frame, (cones[contact.law], parts))
            })
        });
        let contacts = contacts.collect();
        let gather = |wrenches: &[Wrench]| {
            let kept = free.iter().zip(wrenches).filter(|(free, _)| free.is_some());
            kept.map(|(_, wrench)| about(&pole, wrench)).collect()
        };
        SpaceProblem { fixed: gather(fixed), varying: gather(varying), free, bodies, contacts, pole, length }
    }

    /// Returns true if the flow of some contact is not associated.
    pub fn non_associated(&self) -> bool {
        !self.contacts.iter().all(|contact| contact.law.is_associated())
    }

    /// Returns true if forces at the vertices represent all tractions: both bounds can meet.
    pub fn is_exact(&self) -> bool {
        self.contacts.iter().all(|contact| contact.law.has_one_tip())
    }
}

/// Returns a wrench about the origin as one about a pole.
fn about(pole: &Vec3, [x, y, z, mx, my, mz]: &Wrench) -> Wrench {
    let moment = Vec3::new(*mx, *my, *mz) - pole.cross(&Vec3::new(*x, *y, *z));
    [*x, *y, *z, moment.x, moment.y, moment.z]
}
