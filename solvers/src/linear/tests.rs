//! Tests: factorisations against dense elimination, and products against their definition.

use super::bordered::{BorderedFactors, BorderedSystem};
use super::condensed::{Condensed, Elimination, pair};
use super::csr::CsrMatrix;
use super::dense::add_block_and_sizes;
use super::factorised::row_error;
use super::updated::UpdatedFactorisation;
use super::{inner, largest};
use nalgebra::{DMatrix, DVector};
use std::rc::Rc;
use voussoir_core::linear::Entries;

/// Numbers of contact points and of unknowns after their forces.
const CONTACTS: usize = 4;
const OTHERS: usize = 6;
const SIZE: usize = 2 * CONTACTS + OTHERS;

fn value(i: usize, j: usize) -> f64 {
    ((7 * i + 11 * j * j + 3) as f64).sin()
}

/// Equations of contact points and bodies. The last contact point depends on the force of the previous one.
fn entries() -> Entries {
    let mut entries = Vec::new();
    for i in 0..SIZE {
        for j in 0..SIZE {
            let (own, forces) = (i / 2 == j / 2, 2 * CONTACTS);
            let feels = i / 2 == CONTACTS - 1 && j / 2 == CONTACTS - 2;
            let stands = match (i < forces, j < forces) {
                (true, true) => own || feels,
                _ => (i + j) % 3 != 0,
            };
            if stands {
                entries.push((i, j, value(i, j) + if i == j { 4.0 } else { 0.0 }));
            }
        }
    }
    entries
}

fn dense(entries: &Entries) -> DMatrix<f64> {
    let mut matrix = DMatrix::zeros(SIZE, SIZE);
    entries.iter().for_each(|&(i, j, value)| matrix[(i, j)] += value);
    matrix
}

fn condensed(entries: &Entries, shift: f64) -> Condensed {
    let shifts: Entries = (0..2 * CONTACTS).map(|i| (i, i, shift)).filter(|_| shift != 0.0).collect();
    Condensed::new(SIZE, CONTACTS, (entries, &shifts), &mut Elimination::default()).unwrap()
}

fn right() -> Vec<f64> {
    (0..SIZE).map(|i| (i as f64 + 0.5).cos()).collect()
}

fn solved(matrix: DMatrix<f64>, right: &[f64]) -> DVector<f64> {
    matrix.lu().solve(&DVector::from_column_slice(right)).unwrap()
}

fn distance(x: &[f64], y: &DVector<f64>) -> f64 {
    x.iter().zip(y.iter()).fold(0.0, |worst, (x, y)| worst.max((x - y).abs()))
}

/// Points that depend only on their own forces are condensed out; the solution is that of dense elimination.
#[test]
fn condensed_equations_have_the_solution_of_all_equations() {
    let (entries, right) = (entries(), right());
    let own = condensed(&entries, 0.0);
    assert_eq!(own.kept_of(&right).len(), OTHERS + 2);
    let (known, found) = (solved(dense(&entries), &right), own.solve(&right, 1).unwrap());
    // Dense elimination is itself rounded by 8e-15 of the solution.
    assert!(distance(&found, &known) < 1e-14 * known.amax());
    assert!(largest(&own.left(&right, &found)) < 1e-13);
}

/// Shifts added for the factorisation are not part of the equations: each refinement removes them.
#[test]
fn refinement_takes_out_what_is_added_to_the_factors() {
    let (entries, right) = (entries(), right());
    let own = condensed(&entries, 1e-5);
    let exact = solved(dense(&entries), &right);
    let errors = [0, 1, 3].map(|refinements| distance(&own.solve(&right, refinements).unwrap(), &exact));
    assert!(errors[0] > 1e-7 && errors[1] < 1e-4 * errors[0] && errors[2] < 1e-11, "{errors:?}");
    assert!(largest(&own.left(&right, exact.as_slice())) < 1e-13);
}

/// The solution does not depend on the order of elimination, sparse or along ranks.
#[test]
fn elimination_along_a_chain_gives_the_same_solution() {
    let (entries, right) = (entries(), right());
    let ranks: Vec<usize> = (0..SIZE).map(|i| if i < 2 * CONTACTS { i / 2 } else { CONTACTS + i / 3 }).collect();
    let mut chain = Elimination::along(Some(ranks.into()));
    let along = Condensed::new(SIZE, CONTACTS, (&entries, &Vec::new()), &mut chain).unwrap();
    assert!(distance(&along.solve(&right, 1).unwrap(), &solved(dense(&entries), &right)) < 1e-13);
}

/// The response to a unit right-hand side of a point's row is a column of the inverse.
#[test]
fn units_are_columns_of_the_inverse() {
    let entries = entries();
    let own = condensed(&entries, 0.0);
    let inverse = dense(&entries).try_inverse().unwrap();
    for contact in 0..CONTACTS {
        for (k, y) in own.units(contact).unwrap().into_iter().enumerate() {
            let mut unit = vec![0.0; SIZE];
            unit[2 * contact + k] = 1.0;
            let column = inverse.column(2 * contact + k).clone_owned();
            assert!(distance(&own.expand(&unit, &y), &column) < 1e-13, "{contact} {k}");
            let force = own.force(contact, pair(k, 1.0), &y);
            assert!(
                (force[0] - column[2 * contact]).abs() < 1e-13 && (force[1] - column[2 * contact + 1]).abs() < 1e-13
            );
        }
    }
}

/// Equations with dependent rows have no factors, or no finite solution.
#[test]
fn singular_equations_are_refused() {
    let twice: Entries = entries()
        .into_iter()
        .filter(|e| e.0 != SIZE - 1)
        .chain(
            (0..SIZE)
                .flat_map(|j| entries().into_iter().filter(move |e| e.0 == SIZE - 2 && e.1 == j))
                .map(|e| (SIZE - 1, e.1, e.2)),
        )
        .collect();
    let own = Condensed::new(SIZE, CONTACTS, (&twice, &Vec::new()), &mut Elimination::default());
    let solution = own.and_then(|own| own.solve(&right(), 0));
    assert!(solution.is_none_or(|x| largest(&x) > 1e12));
}

/// After a change of the two rows of a point, the responses to their right-hand sides give the changed solution.
#[test]
fn a_few_changed_rows_are_followed_without_a_factorisation() {
    let entries = entries();
    let mut own = UpdatedFactorisation::new(condensed(&entries, 0.0));
    let contact = 1;
    assert_eq!((own.respond(contact, 0), own.respond(contact, 0)), (Some(2), Some(0)));
    // In the changed equations the forces of the point are prescribed.
    let (given, right) = ([0.3, -0.7], right());
    let mut changed = dense(&entries);
    (0..2).for_each(|k| changed.row_mut(2 * contact + k).fill(0.0));
    (0..2).for_each(|k| changed[(2 * contact + k, 2 * contact + k)] = 1.0);
    let mut rights = right.clone();
    rights[2 * contact..2 * contact + 2].copy_from_slice(&given);
    let equations = &own.factors;
    let base = equations.solve(&right, 0).unwrap();
    let columns = own.columns(contact).unwrap();
    let own_force = |k: usize| equations.force(contact, pair(k, 1.0), &columns[k].y);
    let small = DMatrix::from_fn(2, 2, |i, k| own_force(k)[i]);
    let wanted = DVector::from_fn(2, |i, _| given[i] - base[2 * contact + i]);
    let epsilon = small.lu().solve(&wanted).unwrap();
    let mut y = equations.kept_of(&base);
    own.add(contact, [epsilon[0], epsilon[1]], &mut y);
    let mut rights_of_factors = right;
    (0..2).for_each(|k| rights_of_factors[2 * contact + k] += epsilon[k]);
    assert!(distance(&equations.expand(&rights_of_factors, &y), &solved(changed, &rights)) < 1e-12);
}

/// The equations above a last row that is a dense control.
fn bordered(entries: &Entries, control: &[f64]) -> BorderedSystem<Condensed> {
    let above: Entries = entries.iter().filter(|e| e.0 + 1 < SIZE).copied().collect();
    let held = BorderedFactors::new(CONTACTS, control, |last| {
        let all: Entries = above.iter().copied().chain(last.into_iter().map(|(j, v)| (SIZE - 1, j, v))).collect();
        Condensed::new(SIZE, CONTACTS, (&all, &Vec::new()), &mut Elimination::default())
    });
    BorderedSystem::new(Rc::new(held.unwrap()), control).unwrap()
}

fn with_last_row(entries: &Entries, control: &[f64]) -> DMatrix<f64> {
    let mut matrix = dense(entries);
    matrix.row_mut(SIZE - 1).copy_from_slice(control);
    matrix
}

/// A dense control outside the equations gives the solution and the residual of all rows.
#[test]
fn a_control_beside_the_equations_is_their_last_row() {
    let (entries, right) = (entries(), right());
    let control: Vec<f64> = (0..SIZE).map(|j| value(3, j)).collect();
    let own = bordered(&entries, &control);
    let mut along = vec![0.0; SIZE];
    own.onto_control(&mut along, 0, 1.0);
    assert!((inner(&control, &along) - 1.0).abs() < 1e-12);
    let x = own.apply(&right).unwrap();
    assert!(distance(&x, &solved(with_last_row(&entries, &control), &right)) < 1e-12);
    let (left, error) = own.left(&right, &x);
    assert!(largest(&left) < 1e-12 && error < 1e-12, "{left:?}");
    let mut away = x;
    away[SIZE - 2] += 1e-3;
    let exact =
        DVector::from_column_slice(&right) - with_last_row(&entries, &control) * DVector::from_column_slice(&away);
    assert!(distance(&own.left(&right, &away).0, &exact) < 1e-12);
}

/// At a limit point the equations without the column of the factor are singular. A control outside them works there.
#[test]
fn a_control_beside_the_equations_serves_at_a_limit_point() {
    let mut singular = entries();
    // One other unknown appears only in the last row: it moves along the path while the factor is constant.
    singular.retain(|e| e.1 != SIZE - 2);
    singular.extend((2 * CONTACTS..SIZE - 1).map(|i| (i, SIZE - 1, 1.0 + i as f64)));
    let control: Vec<f64> = (0..SIZE).map(|j| if j == SIZE - 2 { 2.0 } else { value(5, j) }).collect();
    let x = bordered(&singular, &control).apply(&right()).unwrap();
    assert!(distance(&x, &solved(with_last_row(&singular, &control), &right())) < 1e-11);
}

/// Factors serve every control that changes along the path: it is their last row, or a border.
#[test]
fn factors_say_which_controls_they_serve() {
    let above: Entries = entries().into_iter().filter(|e| e.0 + 1 < SIZE).collect();
    let factors = |control: &[f64]| {
        BorderedFactors::new(CONTACTS, control, |last| {
            let all: Entries = above.iter().copied().chain(last.into_iter().map(|(j, v)| (SIZE - 1, j, v))).collect();
            Condensed::new(SIZE, CONTACTS, (&all, &Vec::new()), &mut Elimination::default())
        })
        .unwrap()
    };
    let of_factor: Vec<f64> = (0..SIZE).map(|j| f64::from(u8::from(j + 1 == SIZE))).collect();
    let of_other: Vec<f64> = (0..SIZE).map(|j| f64::from(u8::from(j + 2 == SIZE))).collect();
    let full: Vec<f64> = (0..SIZE).map(|j| value(3, j)).collect();
    let [few, many] = [factors(&of_factor), factors(&full)];
    assert!(few.serves(&of_factor) && few.serves(&of_other) && few.serves(&full));
    assert!(many.serves(&full) && many.serves(&of_factor) && many.serves(&of_other));
}

/// Rows of a sparse matrix add repeated entries, in any order, short or long.
#[test]
fn rows_of_a_sparse_matrix_are_those_of_the_dense_one() {
    for columns in [5, 40] {
        let mut entries: Entries = (0..3).flat_map(|i| (0..columns).map(move |j| (i, j, value(i, j)))).collect();
        entries.extend((0..columns).step_by(3).map(|j| (1, j, value(9, j))));
        entries.reverse();
        let own = CsrMatrix::new(3, &entries);
        let x: Vec<f64> = (0..columns).map(|j| value(j, 2)).collect();
        for i in 0..3 {
            let terms: Vec<f64> = entries.iter().filter(|e| e.0 == i).map(|e| e.2 * x[e.1]).collect();
            let (sum, size): (f64, f64) = (terms.iter().sum(), terms.iter().map(|t| t.abs()).sum());
            assert!((own.row_dot(i, &x) - sum).abs() < 1e-13);
            let (left, sizes) = own.left_of_row(i, 0.25, &x);
            assert!((left - (0.25 - sum)).abs() < 1e-13 && (sizes - (0.25 + size)).abs() < 1e-12, "{columns} {i}");
        }
    }
}

/// Products with sizes, for odd and even numbers of columns.
#[test]
fn block_products_are_those_of_the_definition() {
    for columns in [1, 2, 7] {
        let a = DMatrix::from_fn(5, columns, value);
        let x: Vec<f64> = (0..columns).map(|j| value(j, 1)).collect();
        let (mut out, mut sizes) = (vec![1.0; 5], vec![2.0; 5]);
        add_block_and_sizes((&mut out, &mut sizes), a.as_slice(), &x);
        for i in 0..5 {
            let terms: Vec<f64> = (0..columns).map(|j| a[(i, j)] * x[j]).collect();
            assert!((out[i] - 1.0 - terms.iter().sum::<f64>()).abs() < 1e-14);
            assert!((sizes[i] - 2.0 - terms.iter().map(|t| t.abs()).sum::<f64>()).abs() < 1e-14);
        }
    }
}

/// The greatest size counts every number of a list of any length. The error of a row of zeros is zero; the error of a NaN is infinite.
#[test]
fn sizes_and_errors_of_rows_are_safe() {
    for n in [0, 1, 7, 8, 9, 31] {
        let values: Vec<f64> = (0..n).map(|i| -(i as f64)).collect();
        assert_eq!(largest(&values), (n as f64 - 1.0).max(0.0));
    }
    assert_eq!(row_error(0.0, 0.0), 0.0);
    assert_eq!(row_error(1.0, 0.0), f64::INFINITY);
    assert_eq!(row_error(f64::NAN, 1.0), f64::INFINITY);
}
