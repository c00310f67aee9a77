//! C: gaps that contact forces open.

use super::super::rows::{flexibility_rows, merged};
use super::{system, uneven};
use crate::path::two_blocks::{SPRINGS, assert_close, two_degrees};
use voussoir_core::path::PathProblem;

/// C in physical units as a dense matrix.
fn dense(problem: &PathProblem) -> Vec<Vec<f64>> {
    let size = 2 * problem.contacts.len();
    let rows = flexibility_rows(problem).into_iter().map(|row| merged(row, |value| value));
    let spread = |row: Vec<(usize, f64)>| {
        let mut all = vec![0.0; size];
        row.into_iter().for_each(|(j, value)| all[j] += value);
        all
    };
    rows.map(spread).collect()
}

/// Entries of one column are added and sorted, by the factor that scales them.
#[test]
fn repeated_entries_are_added() {
    let row = merged(vec![(4, 1.0), (1, 2.0), (4, 0.5), (1, -1.0)], |value| 10.0 * value);
    assert_eq!(row, [(1, 10.0), (4, 15.0)]);
}

/// Without elastic bodies a force opens its own gap by its compliance: g = c r.
#[test]
fn a_joint_is_a_spring() {
    let problem = uneven();
    let system = system(&problem);
    for (c, contact) in problem.contacts.iter().enumerate() {
        for k in 0..2 {
            let mut x = vec![0.0; system.size()];
            x[2 * c + k] = 1.0 / system.units.force;
            let gaps = system.gaps(&x);
            for (other, gap) in gaps.iter().flatten().enumerate() {
                let right = if other == 2 * c + k { contact.compliance[k] } else { 0.0 };
                assert_close(gap * system.units.displacement, right, 1e-18);
            }
        }
    }
}

/// Two springs K over (t, n) have the flexibility K⁻¹: of [[1, −1], [−1, 2]] that is [[2, 1], [1, 1]].
#[test]
fn two_springs_have_the_inverse_flexibility() {
    let found = dense(&two_degrees(SPRINGS, 0.5, Vec::new()));
    // Rows of a contact are (n, t).
    let right = [[1.0, 1.0], [1.0, 2.0]];
    for (row, right) in found.iter().zip(right) {
        row.iter().zip(right).for_each(|(found, right)| assert_close(*found, right, 1e-14));
    }
}

/// The compliance of a joint adds to the diagonal of its body.
#[test]
fn compliance_of_a_joint_adds_to_the_body() {
    let mut problem = two_degrees(SPRINGS, 0.5, Vec::new());
    let before = dense(&problem);
    problem.contacts[0].compliance = [0.25, 0.5];
    let after = dense(&problem);
    assert_close(after[0][0] - before[0][0], 0.25, 1e-15);
    assert_close(after[1][1] - before[1][1], 0.5, 1e-15);
    assert_close(after[0][1] - before[0][1], 0.0, 1e-15);
}

/// A law of tractions from gaps adds its own compliance to the diagonal of C.
#[test]
fn softening_adds_to_the_compliance_of_points() {
    let problem = uneven();
    let found = super::super::System::new(&problem, |c| [0.1 * c as f64, 0.0]).compliance;
    for (c, contact) in problem.contacts.iter().enumerate() {
        assert_close(found[c][0], contact.compliance[0] + 0.1 * c as f64, 1e-15);
        assert_close(found[c][1], contact.compliance[1], 1e-18);
    }
}
