//! The response of one point of an elastic joint with friction to a step.
//!
//! The trial force is that without slip. If it leaves |t| ≤ m n + c, the point slips against the force, and opens by ψ per unit of
//! slip; a point in tension opens. With c = 0 and m = μ this is the law itself. With m = ψ and c = (μ − ψ) n̄, where n̄ is a known
//! force, slip is associated, and the response is the gradient of a convex function. Source: implicit Euler steps with friction as in
//! Simo and Laursen (1992), *Comput. Struct.* 42, 97–116; fictitious cohesion as in Gilbert, Casapulla and Ahmed (2006).

/// A 3 × 3 matrix by rows.
pub type Matrix = [[f64; 3]; 3];

/// Limit of the shear force: |t| ≤ `slope` n + `cohesion`.
#[derive(Debug, Clone, Copy)]
pub struct Limit {
    /// m.
    pub slope: f64,
    /// c.
    pub cohesion: f64,
}

/// Constants of a point.
#[derive(Debug, Clone, Copy)]
pub struct Spring {
    /// Normal and tangential stiffness.
    pub stiffness: [f64; 2],
    /// ψ.
    pub dilatancy: f64,
    /// μ.
    pub friction: f64,
}

/// Force (n, s, t) and opening of a point.
#[derive(Debug, Clone, Copy, Default)]
pub struct Contact {
    /// Force on the plus body.
    pub force: [f64; 3],
    /// Gap of an open point.
    pub gap: f64,
}

impl Spring {
    /// Returns the contact after a jump (n, s, t), and minus the derivative of its force.
    pub fn response(&self, before: &Contact, jump: &[f64; 3], limit: Limit) -> (Contact, Matrix) {
        let [k, shear] = self.stiffness;
        let Limit { slope, cohesion } = limit;
        let trial = before.force[0] - k * (before.gap + jump[0]);
        let tau = [before.force[1] - shear * jump[1], before.force[2] - shear * jump[2]];
        let size = tau[0].hypot(tau[1]);
        if trial >= 0.0 && size <= slope * trial + cohesion {
            let contact = Contact { force: [trial, tau[0], tau[1]], gap: 0.0 };
            return (contact, [[k, 0.0, 0.0], [0.0, shear, 0.0], [0.0, 0.0, shear]]);
        }
        let ratio = k / shear * self.dilatancy;
        let along = if size > 0.0 { tau.map(|x| x / size) } else { [1.0, 0.0] };
        let share = (1.0 + ratio * slope).recip();
        let normal = (trial + ratio * (size - cohesion)) * share;
        let closed = normal > 0.0;
        let n = normal.max(0.0);
        let bound = (slope * n + cohesion).min(size);
        let gap = if closed { 0.0 } else { (-trial / k).max(0.0) };
        let contact = Contact { force: [n, bound * along[0], bound * along[1]], gap };
        let turning = if size > 0.0 { bound / size * shear } else { 0.0 };
        let stuck = if !closed && size <= cohesion { shear } else { 0.0 };
        let mut tangent = [[0.0; 3]; 3];
        if closed {
            tangent[0] = [k * share, self.dilatancy * k * share * along[0], self.dilatancy * k * share * along[1]];
        }
        for i in 0..2 {
            tangent[1 + i][0] = slope * along[i] * tangent[0][0];
            for j in 0..2 {
                let across = f64::from(u8::from(i == j)) - along[i] * along[j];
                tangent[1 + i][1 + j] =
                    slope * along[i] * tangent[0][1 + j] + turning * across + stuck * along[i] * along[j];
            }
        }
        (contact, tangent)
    }

    /// Returns the limit of the law.
    pub fn law(&self) -> Limit {
        Limit { slope: self.friction, cohesion: 0.0 }
    }

    /// Returns the limit of associated flow with the fictitious cohesion of a known normal force.
    pub fn lagged(&self, normal: f64) -> Limit {
        Limit { slope: self.dilatancy, cohesion: (self.friction - self.dilatancy) * normal.max(0.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPRING: Spring = Spring { stiffness: [2.0, 0.7], dilatancy: 0.2, friction: 0.6 };
    const BEFORE: Contact = Contact { force: [1.0, 0.2, -0.1], gap: 0.0 };
    const JUMPS: [[f64; 3]; 5] =
        [[-0.1, 0.1, 0.2], [0.1, 2.0, -1.0], [-0.3, -0.5, 3.0], [0.9, 0.1, 0.0], [0.6, 0.4, 5.0]];

    /// Each response obeys its limit, and slip opens the point by the dilatancy.
    #[test]
    fn responses_are_admissible() {
        for jump in JUMPS {
            for limit in [SPRING.law(), SPRING.lagged(0.8)] {
                let (Contact { force, gap }, _) = SPRING.response(&BEFORE, &jump, limit);
                let bound = limit.slope * force[0] + limit.cohesion;
                let shear = force[1].hypot(force[2]);
                assert!(force[0] >= 0.0 && gap >= 0.0 && shear <= bound + 1e-14 && force[0] * gap == 0.0);
                if force[0] > 0.0 {
                    // The springs take the rest of the jump.
                    let slip: [f64; 2] =
                        std::array::from_fn(|i| jump[1 + i] + (force[1 + i] - BEFORE.force[1 + i]) / 0.7);
                    let opened = jump[0] + (force[0] - BEFORE.force[0]) / 2.0;
                    assert!((opened - 0.2 * slip[0].hypot(slip[1])).abs() < 1e-14, "{jump:?}");
                    assert!(slip[0].hypot(slip[1]) < 1e-14 || (shear - bound).abs() < 1e-14);
                }
            }
        }
    }

    /// The tangent is the derivative of the force; with the lagged limit it is symmetric.
    #[test]
    fn the_tangent_is_the_derivative() {
        for jump in JUMPS {
            for (limit, lagged) in [(SPRING.law(), false), (SPRING.lagged(0.8), true)] {
                let (_, tangent) = SPRING.response(&BEFORE, &jump, limit);
                for j in 0..3 {
                    let at = |step: f64| {
                        let mut moved = jump;
                        moved[j] += step;
                        SPRING.response(&BEFORE, &moved, limit).0.force
                    };
                    let (up, down) = (at(1e-6), at(-1e-6));
                    for i in 0..3 {
                        let difference = -(up[i] - down[i]) / 2e-6;
                        assert!((difference - tangent[i][j]).abs() < 1e-7, "{jump:?} {i} {j}");
                        assert!(!lagged || (tangent[i][j] - tangent[j][i]).abs() < 1e-14);
                    }
                }
            }
        }
    }
}
