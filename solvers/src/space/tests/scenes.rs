//! Problems built from convex prisms, with contacts given by their corners.

use voussoir_core::certificate::ROUNDING;
use voussoir_core::law::FrictionCone;
use voussoir_core::limit::{LimitQuestion, Status};
use voussoir_core::space::{SpaceAnswer, SpaceClaim, SpaceContact, SpaceProblem, SpaceVerdict, Vec3, certify_space};

/// Distance of the bounds that is accepted.
pub const GAP: f64 = 1e-8;

/// Minus and plus body, corners, normal, friction.
pub type Face = (Option<usize>, Option<usize>, Vec<Vec3>, Vec3, f64);

/// A scene of bodies with weights and centroids; `None` is the ground.
#[derive(Clone, Default)]
pub struct Scene {
    /// Weight and centroid.
    pub bodies: Vec<(f64, Vec3)>,
    /// All contacts.
    pub contacts: Vec<Face>,
}

/// Returns two unit vectors that complete a normal to a right-handed frame.
pub fn frame(normal: &Vec3) -> [Vec3; 3] {
    let normal = normal.normalize();
    let other = if normal.x.abs() < 0.6 { Vec3::x() } else { Vec3::y() };
    let first = (other - normal * normal.dot(&other)).normalize();
    [normal, first, normal.cross(&first)]
}

/// Returns the corners of a horizontal rectangle.
pub fn rectangle([x0, x1]: [f64; 2], [y0, y1]: [f64; 2], z: f64) -> Vec<Vec3> {
    [[x0, y0], [x1, y0], [x1, y1], [x0, y1]].map(|[x, y]| Vec3::new(x, y, z)).to_vec()
}

impl Scene {
    /// Returns the problem with gravity along −z and a live load of λ times the weight along `direction`.
    pub fn problem(&self, direction: &Vec3) -> SpaceProblem {
        let loads = |along: &Vec3| {
            self.bodies.iter().map(|(weight, centroid)| SpaceContact::wrench(centroid, &(along * *weight))).collect()
        };
        let contact = |(index, (minus, plus, points, normal, friction)): (usize, &Face)| {
            let law = FrictionCone::dry(*friction, *friction);
            SpaceContact::new(index, [*minus, *plus], points, frame(normal), (law, 1))
        };
        SpaceProblem {
            free: (0..self.bodies.len()).map(Some).collect(),
            bodies: self.bodies.len(),
            contacts: self.contacts.iter().enumerate().map(contact).collect(),
            fixed: loads(&-Vec3::z()),
            varying: loads(direction),
            pole: Vec3::zeros(),
            length: 2.0,
        }
    }

    /// Adds a box on the ground or on another box.
    pub fn add_box(&mut self, x: [f64; 2], y: [f64; 2], z: [f64; 2]) -> usize {
        let volume = (x[1] - x[0]) * (y[1] - y[0]) * (z[1] - z[0]);
        self.bodies.push((volume, Vec3::new(x[0] + x[1], y[0] + y[1], z[0] + z[1]) / 2.0));
        self.bodies.len() - 1
    }
}

/// Returns the horizontal direction at an angle to x \[°\].
pub fn at_angle(degrees: f64) -> Vec3 {
    let angle = degrees.to_radians();
    Vec3::new(angle.cos(), angle.sin(), 0.0)
}

/// A search for collapse without an end.
pub const COLLAPSE: LimitQuestion = LimitQuestion::Collapse { start: 0.0, max: f64::INFINITY };

/// Certifies an answer to a question.
pub fn certified(problem: &SpaceProblem, answer: &SpaceAnswer, question: LimitQuestion) -> SpaceVerdict {
    let (start, target) = match question {
        LimitQuestion::Admissible(factor) => (factor, factor),
        LimitQuestion::Collapse { start, max } => (start, max),
    };
    let claim = SpaceClaim {
        hint: answer.status,
        target,
        factor: answer.factor,
        field_factor: answer.field_factor,
        start,
        field: answer.field.as_ref(),
        motion: answer.motion.as_deref(),
        ray: answer.ray.as_ref(),
        non_associated: answer.non_associated.as_ref(),
        search_is_trusted: true,
    };
    certify_space(problem, &claim, GAP)
}

/// Solves for collapse, certifies the answer and returns its factor.
pub fn collapse(problem: &SpaceProblem) -> f64 {
    let answer = crate::space::solve(problem, COLLAPSE);
    let verdict = certified(problem, &answer, COLLAPSE);
    assert_eq!(verdict.status, Status::Collapse, "{:?} {:?}", answer.notes, verdict.certificate);
    assert!(verdict.certificate.residuals["equilibrium"] < 0.1 * ROUNDING);
    answer.factor.unwrap()
}
