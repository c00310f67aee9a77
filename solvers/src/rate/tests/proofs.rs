//! Proofs are complete trees of modes with a Farkas vector at each leaf, checked here from facets and stiffness alone.

use super::*;
use crate::contact::facet::dot;
use crate::rate::proof::{ModeTree, NoRate};
use crate::rate::tree::{point_modes, search};
use voussoir_core::path::{FarkasVector, ModeTree as CertifiedTree, PointMode};

/// Checks a proof; panics if it does not hold.
pub fn check(problem: &RateProblem, proof: &NoRate) {
    walk(problem, proof, &proof.tree, &mut vec![None; problem.points.len()]);
}

fn walk(problem: &RateProblem, proof: &NoRate, tree: &ModeTree, modes: &mut Vec<Option<PointMode>>) {
    match tree {
        ModeTree::Point { point, modes: children } => {
            assert!(modes[*point].is_none());
            let all: Vec<PointMode> = children.iter().map(|child| child.0).collect();
            assert_eq!(all, point_modes(&problem.points[*point]));
            for (mode, child) in children {
                modes[*point] = Some(*mode);
                walk(problem, proof, child, modes);
                modes[*point] = None;
            }
        }
        ModeTree::Rate(_) => assert!(proof.factor < 0.0),
        ModeTree::Contradiction(y) => contradicts(problem, proof, y, modes),
    }
}

fn contradicts(problem: &RateProblem, proof: &NoRate, y: &[f64], modes: &[Option<PointMode>]) {
    let rows = &proof.rows;
    let facet = |i: usize| &problem.points[rows[i].0].facets[rows[i].1];
    let block = |i: usize, j: usize, v: [f64; 2]| {
        let (k, l) = (2 * rows[i].0, 2 * rows[j].0);
        [0, 1].map(|a| problem.s[(k + a, l)] * v[0] + problem.s[(k + a, l + 1)] * v[1])
    };
    let load = |i: usize| [0, 1].map(|a| problem.load_rate[2 * rows[i].0 + a]);
    let work = if proof.factor == 0.0 { y[rows.len()] } else { 0.0 };
    let mut right = -work;
    let size = y.iter().fold(0.0, |a: f64, y| a.max(y.abs()));
    assert!(size > 0.0 && work >= 0.0);
    for (j, (k, f)) in rows.iter().enumerate() {
        // The mode of its point sets w_j or z_j to zero.
        let flows = modes[*k].map(|mode| mode == PointMode::Vertex || mode == PointMode::Facet(*f));
        let open = problem.points[*k].open == Some(*f);
        let of_z = -(0..rows.len()).map(|i| y[i] * dot(facet(i).normal, block(i, j, facet(j).flow))).sum::<f64>()
            - work * dot(facet(j).flow, load(j));
        assert!(open || flows == Some(true) || y[j] >= -1e-9 * size, "w of {j}: {} of {size}", y[j]);
        assert!(!open || of_z <= 1e-9 * size, "free z of {j}: {of_z} of {size}");
        assert!(flows == Some(false) || of_z >= -1e-9 * size, "z of {j}: {of_z} of {size}");
        right -= proof.factor * y[j] * dot(facet(j).normal, load(j));
    }
    assert!(right < -1e-12 * size, "{right} of {size}");
}

/// The vector of a fold with one point is positive.
#[test]
fn the_vector_of_a_fold_is_positive() {
    let laws = dry(0.5, 0.0);
    let case = Case::slipping(&laws, 1, &[10.0, 2.5, 2.5, 1.0], &[0.0, 1.0]).arriving(0, ContactMode::Stick, true);
    let proof = case.answer().none_rises.expect("a proof");
    let ModeTree::Contradiction(y) = &proof.tree else { panic!("{proof:?}") };
    assert!(y[0] > 0.0);
    check(&case.problem, &proof);
}

/// Two points need decisions: the tree is complete and each leaf is a contradiction.
#[test]
fn a_tree_is_complete() {
    let laws = dry(0.5, 0.0);
    #[rustfmt::skip]
    let s = [
        10.0, 2.5, 0.0, 1.0,
        2.5, 1.0, 0.0, 0.0,
        0.0, 0.0, 10.0, 2.5,
        0.0, 0.0, 2.5, 1.0,
    ];
    let case = Case::slipping(&laws, 2, &s, &[0.0, 1.0, 0.0, 1.0]).arriving(0, ContactMode::Stick, true).arriving(
        1,
        ContactMode::Stick,
        true,
    );
    let found = search(&case.problem, 1.0, 100, &mut 0);
    let proof = found.proof.expect("complete");
    assert!(found.rates.is_empty());
    check(&case.problem, &proof);
}

/// All rates of one sense are found by the search.
#[test]
fn a_search_finds_all_rates() {
    let laws = dry(0.5, 0.0);
    let s = tangential(2, 0.0, |i, j| if i == j { 1.0 } else { 1.5 });
    let case = Case::slipping(&laws, 2, &s, &[0.0, 1.0, 0.0, 1.0]);
    assert_eq!(search(&case.problem, 1.0, 100, &mut 0).rates.len(), 3);
}

/// Without a budget no continuation is decided; pivoting alone excludes a rising rate here.
#[test]
fn a_small_budget_leaves_the_answer_open() {
    let laws = dry(0.5, 0.0);
    let case = only_unloading(&laws);
    let budget = Budget { combinations: 100, leaves: 0 };
    let found = answer(&case.problem, &case.arrival, &budget, &mut RateCounts::default());
    assert!(matches!(found.continuation, Continuation::Open(_)), "{found:?}");
}

/// A tree that is larger than the budget proves nothing: a falling rate is found, but no limit point is proved.
#[test]
fn a_tree_beyond_the_budget_proves_nothing() {
    let laws = dry(4.0, 0.0);
    let mut random = voussoir_core::random::Random::from_state(23);
    let mut large = 0;
    for number in 0..300 {
        let case = super::random::case(&laws, 3, &mut random, number);
        let Some(proof) = case.answer().none_rises else { continue };
        let leaves = proof.tree.leaves();
        let within = |leaves| {
            let budget = Budget { combinations: 4096, leaves };
            answer(&case.problem, &case.arrival, &budget, &mut RateCounts::default()).none_rises.is_some()
        };
        if leaves > 2 {
            assert!(within(2 * leaves + 2) && !within(1), "{leaves}");
            large += 1;
        }
    }
    assert!(large > 3, "{large}");
}

/// If no rate continues there is a proof for each sense of λ.
#[test]
fn no_continuation_has_three_proofs() {
    let laws = dry(5.0, 0.0);
    let case = super::random::without_continuation(&laws);
    let found = case.answer();
    let Continuation::NoneContinues(proofs) = found.continuation else { panic!("{found:?}") };
    assert_eq!(proofs.clone().map(|proof| proof.factor), [1.0, 0.0, -1.0]);
    proofs.iter().for_each(|proof| check(&case.problem, proof));
}

/// A mechanism on which the load does no work is excluded by the row of the load's work.
#[test]
fn a_neutral_mechanism_is_excluded_by_the_work_of_the_load() {
    let laws = dry(0.5, 0.0);
    let case = Case::slipping(&laws, 1, &[0.0; 4], &[1.0, 0.0]);
    let found = search(&case.problem, 0.0, 100, &mut 0);
    assert!(found.rates.is_empty());
    check(&case.problem, &found.proof.expect("complete"));
}

/// In the form of the certificate a leaf has α·s < 0 and β = −Sᵀα, over the contact points of the structure.
#[test]
fn a_certified_tree_names_contact_points() {
    let laws = dry(0.5, 0.0);
    #[rustfmt::skip]
    let s = [
        10.0, 2.5, 0.0, 1.0,
        2.5, 1.0, 0.0, 0.0,
        0.0, 0.0, 10.0, 2.5,
        0.0, 0.0, 2.5, 1.0,
    ];
    let case = Case::slipping(&laws, 2, &s, &[0.0, 1.0, 0.0, 1.0]);
    let proof = search(&case.problem, 1.0, 100, &mut 0).proof.expect("complete");
    let vector = |alpha: &[[f64; 2]], _: f64| {
        let alpha = DVector::from_iterator(4, alpha.iter().flatten().copied());
        assert!(alpha.dot(&case.problem.load_rate) < 0.0);
        let beta = -case.problem.s.tr_mul(&alpha);
        let gap = beta.as_slice().chunks(2).map(|b| [b[0], b[1]]).collect();
        FarkasVector { gap, ..FarkasVector::default() }
    };
    let tree = proof.certified(&case.problem.points, &[7, 9], &vector).expect("a tree");
    assert_eq!(tree.leaves(100), proof.tree.leaves());
    if let CertifiedTree::Split { contact, .. } = tree {
        assert!([7, 9].contains(&contact));
    }
}

/// A point that is open with a tensile strength has a multiplier of any sign: its row is kept.
#[test]
fn an_open_point_with_strength_keeps_its_row() {
    let laws = [vec![Facet::opening(0.4)], Facet::friction(0.5, 1.0, 0.0).to_vec()].concat();
    #[rustfmt::skip]
    let s = [
        10.0, 2.5, 0.5, 0.0,
        2.5, 1.0, 0.0, 0.0,
        0.5, 0.0, 3.0, 0.0,
        0.0, 0.0, 0.0, 1.0,
    ];
    let mut case = Case::new(&laws, &[(&[1], [1.0, 0.5]), (&[0], [-0.4, 0.0])], &s, &[0.0, 1.0, 0.0, 0.0])
        .arriving(0, ContactMode::Stick, true)
        .arriving(1, ContactMode::Facet(0), false);
    case.problem.points[1].open = Some(0);
    let answer = case.answer();
    let proof = answer.none_rises.expect("a proof");
    assert_eq!(proof.rows, [(0, 1), (1, 0)]);
    check(&case.problem, &proof);
    let Continuation::Goes { rate, .. } = answer.continuation else { panic!() };
    assert!(rate.factor == -1.0 && rate.modes[0] == SLIP && case.problem.admits(&rate));
}
