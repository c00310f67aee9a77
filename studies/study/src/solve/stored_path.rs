//! Converts paths to and from their stored form.

use crate::results::stored_path::{StoredClaim, StoredNode, StoredPath, StoredState, StoredWitness};
use voussoir_core::certificate::{PathChain, in_range};
use voussoir_core::path::{ModeTree, NoneContinues, PathAnswer, PathState, RateClaim, Witness};

/// Greatest depth of a tree of decisions.
const MAX_DEPTH: usize = 1_000;

/// Returns the states of a chain with the proof of its end. `None` if the end is not one of the states, if they have more than
/// `most` numbers, or if laws have a history, which is not stored.
pub(super) fn stored(chain: &PathChain, solved: &PathAnswer, most: usize) -> Option<StoredPath> {
    let states: Vec<&PathState> = chain.states().skip(1).collect();
    let numbers = |state: &&PathState| state.force.as_flattened().len() + state.motion.as_flattened().len();
    let has_history = |state: &&PathState| !state.memory.is_empty() || !state.yielded.is_empty();
    if states.iter().map(numbers).sum::<usize>() > most || states.iter().any(has_history) {
        return None;
    }
    let place = |wanted: &PathState| {
        let same = |own: &&PathState| {
            own.load_step == wanted.load_step
                && own.factor == wanted.factor
                && own.force == wanted.force
                && own.motion == wanted.motion
        };
        states.iter().rposition(same)
    };
    let witness = |own: &Witness| Some(StoredWitness { state: place(&own.state)?, claim: stored_claim(&own.claim) });
    Some(StoredPath {
        status: solved.status,
        end: place(&solved.state)?,
        motion: solved.motion.clone(),
        ray: solved.ray.clone(),
        witnesses: solved.witnesses.iter().filter_map(witness).collect(),
        states: states.iter().map(|state| stored_state(state)).collect(),
    })
}

fn stored_state(state: &PathState) -> StoredState {
    StoredState {
        load_step: state.load_step,
        factor: state.factor,
        displacement: state.displacement,
        energies: [state.stored, state.dissipated, state.work],
        force: state.force.clone(),
        motion: state.motion.clone(),
    }
}

fn stored_claim(claim: &RateClaim) -> StoredClaim {
    match claim {
        RateClaim::Rate(rate) => StoredClaim::Rate(rate.clone()),
        RateClaim::NoneRises(tree) => StoredClaim::NoneRises(nodes(tree)),
        RateClaim::NoneContinues(proofs) => {
            StoredClaim::NoneContinues([&proofs.rises, &proofs.stands, &proofs.falls].map(nodes))
        }
    }
}

/// Returns the nodes of a tree, each before its branches.
fn nodes(tree: &ModeTree) -> Vec<StoredNode> {
    let (mut nodes, mut left) = (Vec::new(), vec![tree]);
    while let Some(tree) = left.pop() {
        nodes.push(match tree {
            ModeTree::Leaf(vector) => StoredNode::Leaf(vector.clone()),
            ModeTree::Split { contact, branches } => {
                left.extend(branches.iter().rev().map(|(_, branch)| branch));
                StoredNode::Split(*contact, branches.iter().map(|(mode, _)| *mode).collect())
            }
            ModeTree::Before => StoredNode::Before,
        });
    }
    nodes
}

/// Returns the states of a stored path. Gaps are not set: they follow from forces and motions.
///
/// # Errors
/// A number is too great to be checked.
pub(super) fn states(path: &StoredPath, points: usize) -> Result<Vec<PathState>, String> {
    let state = |(index, own): (usize, &StoredState)| {
        let mut numbers = own.force.as_flattened().iter().chain(own.motion.as_flattened()).chain(&own.energies);
        if !numbers.all(|number| in_range(*number)) || !in_range(own.factor) || !in_range(own.displacement) {
            return Err(format!("state {index}: a number is not finite, or too great to be checked"));
        }
        let [stored, dissipated, work] = own.energies;
        Ok(PathState {
            load_step: own.load_step,
            factor: own.factor,
            force: own.force.clone(),
            gap: vec![[0.0; 2]; points],
            motion: own.motion.clone(),
            stored,
            dissipated,
            work,
            displacement: own.displacement,
            ..PathState::default()
        })
    };
    path.states.iter().enumerate().map(state).collect()
}

/// Returns the answer that the states of a stored path prove.
///
/// # Errors
/// An index or a tree of decisions is not valid.
pub(super) fn answer(path: &StoredPath, states: &[PathState]) -> Result<PathAnswer, String> {
    let at = |index: usize| states.get(index).cloned().ok_or(format!("there is no state {index}"));
    let witness = |own: &StoredWitness| {
        let claim = match &own.claim {
            StoredClaim::Rate(rate) => RateClaim::Rate(rate.clone()),
            StoredClaim::NoneRises(nodes) => RateClaim::NoneRises(whole_tree(nodes)?),
            StoredClaim::NoneContinues([rises, stands, falls]) => RateClaim::NoneContinues(NoneContinues {
                rises: whole_tree(rises)?,
                stands: whole_tree(stands)?,
                falls: whole_tree(falls)?,
            }),
        };
        Ok::<_, String>(Witness { state: at(own.state)?, claim })
    };
    let state = at(path.end)?;
    Ok(PathAnswer {
        status: path.status,
        load_step: state.load_step,
        factor: Some(state.factor),
        state,
        motion: path.motion.clone(),
        ray: path.ray.clone(),
        witnesses: path.witnesses.iter().map(witness).collect::<Result<_, _>>()?,
        ..PathAnswer::default()
    })
}

/// Returns the tree of a list of nodes, all of which belong to it.
fn whole_tree(nodes: &[StoredNode]) -> Result<ModeTree, String> {
    let mut left = nodes.iter();
    let tree = tree(&mut left, 0)?;
    match left.next() {
        None => Ok(tree),
        Some(_) => Err("a tree of decisions has more nodes than branches".into()),
    }
}

fn tree<'a>(left: &mut impl Iterator<Item = &'a StoredNode>, depth: usize) -> Result<ModeTree, String> {
    if depth > MAX_DEPTH {
        return Err(format!("a tree of decisions is deeper than {MAX_DEPTH}"));
    }
    match left.next().ok_or("a tree of decisions has fewer nodes than branches")? {
        StoredNode::Leaf(vector) => Ok(ModeTree::Leaf(vector.clone())),
        StoredNode::Before => Ok(ModeTree::Before),
        StoredNode::Split(contact, modes) => {
            let mut branch = |mode: &_| Ok((*mode, tree(left, depth + 1)?));
            let branches = modes.iter().map(&mut branch).collect::<Result<_, String>>()?;
            Ok(ModeTree::Split { contact: *contact, branches })
        }
    }
}
