//! Rows of the flexibility C and of the kinematics G of contact points.

use voussoir_core::path::PathProblem;

/// Returns the rows of C in physical units: the points of an elastic body are coupled.
pub fn flexibility_rows(problem: &PathProblem) -> Vec<Vec<(usize, f64)>> {
    let mut on_body: Vec<Vec<(usize, usize, f64)>> = vec![Vec::new(); problem.bodies.len()];
    for (index, contact) in problem.contacts.iter().enumerate() {
        for (side, sign) in [(contact.minus, -1.0), (contact.plus, 1.0)] {
            if let Some(slot) = side.slot {
                on_body[side.body].push((index, slot, sign));
            }
        }
    }
    let mut rows: Vec<Vec<(usize, f64)>> = vec![Vec::new(); 2 * problem.contacts.len()];
    for (points, body) in on_body.iter().zip(&problem.bodies) {
        let Some(matrix) = &body.flexibility else { continue };
        for &(a, slot_a, sign_a) in points {
            let (ca, sa) = (&problem.contacts[a], 2 * slot_a);
            (0..2).for_each(|i| rows[2 * a + i].reserve(2 * points.len() + 1));
            for &(b, slot_b, sign_b) in points {
                let (cb, sb) = (&problem.contacts[b], 2 * slot_b);
                let at = |i: usize, j: usize| matrix[(sa + i, sb + j)];
                for (i, ea) in [ca.normal, ca.tangent].into_iter().enumerate() {
                    for (j, eb) in [cb.normal, cb.tangent].into_iter().enumerate() {
                        let value =
                            ea.x * (at(0, 0) * eb.x + at(0, 1) * eb.y) + ea.y * (at(1, 0) * eb.x + at(1, 1) * eb.y);
                        rows[2 * a + i].push((2 * b + j, sign_a * sign_b * value));
                    }
                }
            }
        }
    }
    for (index, contact) in problem.contacts.iter().enumerate() {
        for i in 0..2 {
            if contact.compliance[i] > 0.0 {
                rows[2 * index + i].push((2 * index + i, contact.compliance[i]));
            }
        }
    }
    rows
}

/// Returns the sorted entries of a row, repeated entries added, scaled by a factor.
pub fn merged(mut row: Vec<(usize, f64)>, scaled: impl Fn(f64) -> f64) -> Vec<(usize, f64)> {
    row.sort_by_key(|e| e.0);
    let mut merged: Vec<(usize, f64)> = Vec::with_capacity(row.len());
    for (column, value) in row {
        match merged.last_mut() {
            Some(last) if last.0 == column => last.1 += scaled(value),
            _ => merged.push((column, scaled(value))),
        }
    }
    merged
}

/// Returns the rows of G over the motions of the free bodies.
pub fn kinematic_rows(problem: &PathProblem, free: &[Option<usize>]) -> Vec<Vec<(usize, f64)>> {
    let mut kinematics: Vec<Vec<(usize, f64)>> = Vec::with_capacity(2 * problem.contacts.len());
    for contact in &problem.contacts {
        let rows = [problem.kinematics(contact, false), problem.kinematics(contact, true)];
        for i in 0..2 {
            let mut row = Vec::with_capacity(6);
            for (side, body) in rows.iter().zip([contact.minus.body, contact.plus.body]) {
                if let Some(free) = free[body] {
                    let [x, y, theta] = side[i];
                    row.extend([(3 * free, x), (3 * free + 1, y), (3 * free + 2, theta / problem.length)]);
                }
            }
            kinematics.push(row);
        }
    }
    kinematics
}
