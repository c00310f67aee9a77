//! Random walks of a law at a point. Updates must be pure, finite, and the same in batches; the tangent is the derivative;
//! branches describe the step; the state has only the declared content.

use super::findings::Recorder;
use super::options::{CountAllocations, Options};
use super::point::{Point, Said};
use super::random::random_step;
use super::subject::Subject;
use std::collections::BTreeMap;
use voussoir_core::law::UpdateBranch;
use voussoir_core::plugin::{Property, Sample};
use voussoir_core::random::Random;

/// Number of walks of each sample, the number if a branch is rare, and the number of steps of each walk.
const WALKS: usize = 200;
const MAX_WALKS: usize = 400;
const STEPS: usize = 25;
/// Least number of visits of each branch of a sample, and of comparisons of its tangent.
const LEAST: usize = 50;
/// Points of a batch.
const BATCH: usize = 64;

/// Counts of the walks of a sample.
#[derive(Default)]
struct Seen {
    met: BTreeMap<&'static str, usize>,
    compared: BTreeMap<&'static str, usize>,
    dissipated: f64,
    depends_on_state: bool,
}

/// Returns the scale of stiffnesses of a point. Records a finding and returns `None` if the law cannot be walked.
pub(super) fn measure(recorder: &mut Recorder, point: &Point, sample: &Sample) -> Option<f64> {
    let untouched = point.untouched();
    let written = untouched.iter().all(|x| x.is_finite());
    recorder.hold("state", written, || {
        format!("the untouched state {untouched:?} is not finite: initial_state must write every number")
    });
    let stiffness = point.stiffness(sample.size);
    recorder.hold("untouched", stiffness.is_some() || !written, || {
        "its tangent, pressed a little, is nothing or not finite".into()
    });
    stiffness
}

/// Makes all walks of a subject, then checks their counts.
pub(super) fn check(recorder: &mut Recorder, subject: &Subject, options: &Options) {
    state(recorder, subject);
    extremes(recorder, subject);
    let (mut random, mut seen) = (Random::new(3), Seen::default());
    let branches = subject.sample.branches;
    let is_rare = |map: &BTreeMap<&str, usize>| branches.iter().any(|own| map.get(own).is_none_or(|&n| n < LEAST));
    for index in 0..MAX_WALKS {
        if index >= WALKS && !is_rare(&seen.met) && !is_rare(&seen.compared) {
            break;
        }
        walk(recorder, subject, &mut random, &mut seen);
    }
    recorder.hold("branches", !branches.is_empty(), || "the sample names no branch".into());
    for branch in branches {
        let count = |map: &BTreeMap<&str, usize>| map.get(branch).copied().unwrap_or(0);
        let (met, compared) = (count(&seen.met), count(&seen.compared));
        recorder.hold("branches", met >= LEAST, || {
            format!("the walks met \"{branch}\" {met} times, {LEAST} are needed: give the sample another size")
        });
        recorder.hold("tangent", met < LEAST || compared >= LEAST, || {
            format!(
                "in \"{branch}\" only {compared} of {met} tangents could be compared: elsewhere ±h changes branch or is not smooth"
            )
        });
    }
    let worth = seen.dissipated > 1e-9 * subject.stiffness * subject.sample.size.powi(2);
    recorder.hold("memory", !worth || seen.depends_on_state, || {
        "dissipates, but its answers never depend on the state: what happened is forgotten".into()
    });
    match options.allocations {
        Some(count) => allocations(recorder, subject, count),
        None => recorder.leave_out("allocations: only a program whose allocator counts can see them"),
    }
}

/// Checks the state of the untouched point.
fn state(recorder: &mut Recorder, subject: &Subject) {
    let Subject { point, .. } = subject;
    let (size, names) = (point.state_size(), point.state_names());
    recorder.hold("state", names.len() == size, || format!("{} names for a state of {size} numbers", names.len()));
    for name in names {
        recorder.hold("state", super::scaled::state_unit(name).is_some(), || {
            format!("\"{name}\" names no unit: write it as \"slip [m]\", or [-] for a pure number")
        });
    }
    let untouched = point.untouched();
    let mut new = vec![9.0; size];
    match point.update(&[0.0; 6], &untouched, &mut new) {
        Err(why) => recorder.fail("untouched", format!("refuses the untouched point: {why}")),
        Ok(said) => {
            let n = point.components();
            let finite = numbers(&said, &new).iter().all(|x| x.is_finite());
            let stiff = (0..n).all(|i| said.tangent[i][i] * point.sign() > 0.0);
            recorder.hold_on("untouched", finite, &[[0.0; 6]], || {
                format!("is not finite at the untouched point: {said:?}")
            });
            recorder.hold_on("untouched", !finite || stiff, &[[0.0; 6]], || {
                format!("its tangent at the untouched point is not stiff: {:?}", &said.tangent[..n])
            });
            let nothing = said.force.iter().all(|f| f.abs() <= 1e-12 * subject.stiffness * subject.sample.size);
            recorder
                .hold_on("untouched", nothing, &[[0.0; 6]], || format!("the untouched point carries {:?}", said.force));
        }
    }
}

fn numbers(said: &Said, state: &[f64]) -> Vec<f64> {
    let own = said.force.iter().chain(said.tangent.as_flattened()).chain([&said.stored, &said.dissipated]);
    own.chain(state).copied().collect()
}

/// Checks arguments at which formulas often fail: a zero gap in one component, very large, very small, not a number.
fn extremes(recorder: &mut Recorder, subject: &Subject) {
    let Subject { point, sample, .. } = subject;
    let (untouched, n) = (point.untouched(), point.components());
    let mut new = vec![0.0; point.state_size()];
    for size in [1e-300, 1e-20, 1e-6, 1e-3, 1.0, 30.0, 1e4] {
        for i in 0..n {
            for j in i..n {
                for signs in [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]] {
                    let mut at = [0.0; 6];
                    at[j] = signs[1] * size * sample.size;
                    at[i] = signs[0] * size * sample.size;
                    match point.update(&at, &untouched, &mut new) {
                        Ok(said) => {
                            let finite = numbers(&said, &new).iter().all(|x| x.is_finite());
                            recorder.hold_on("finite", finite, &[at], || format!("at {:?} it says {said:?}", &at[..n]));
                        }
                        // For very large arguments a law may return an error instead of a finite result.
                        Err(why) => {
                            recorder.hold_on("finite", size > 1.0, &[at], || format!("refuses {:?}: {why}", &at[..n]))
                        }
                    }
                }
            }
        }
    }
    for i in 0..n {
        let mut at = [0.0; 6];
        at[i] = f64::NAN;
        let refused = point.update(&at, &untouched, &mut new).is_err();
        recorder.hold("finite", refused, || "answers what is no number: return UpdateFailure::NotFinite".into());
    }
}

fn walk(recorder: &mut Recorder, subject: &Subject, random: &mut Random, seen: &mut Seen) {
    let Subject { point, again, sample, .. } = subject;
    let (n, size) = (point.components(), point.state_size());
    let (mut old, mut at, mut path) = (point.untouched(), [0.0; 6], Vec::new());
    for _ in 0..STEPS {
        random_step(random, &mut at, n, sample.size);
        path.push(at);
        let (mut new, mut other) = (vec![0.0; size], vec![9.0; size]);
        let here = match point.update(&at, &old, &mut new) {
            Ok(here) => here,
            Err(why) => return recorder.hold_on("finite", false, &path, || format!("refuses {:?}: {why}", &at[..n])),
        };
        let finite = numbers(&here, &new).iter().all(|x| x.is_finite());
        recorder.hold_on("finite", finite, &path, || format!("at {:?} it says {here:?}, state {new:?}", &at[..n]));
        if !finite {
            return;
        }
        let kept = old.clone();
        let twice = again.update(&at, &old, &mut other);
        let same = twice == Ok(here) && new == other && old == kept;
        recorder.hold_on("purity", same, &path, || {
            format!("the same call says {here:?} with state {new:?}, then {twice:?} with state {other:?}")
        });
        let batch = point.batch(&[at], &old, &mut other);
        let same = batch.as_deref() == Ok(&[here]) && new == other;
        recorder.hold_on("batch", same, &path, || format!("a batch of one says {batch:?}, the point {here:?}"));
        *seen.met.entry(here.branch.name).or_default() += 1;
        seen.dissipated += here.dissipated;
        said_of_itself(recorder, subject, &here, (&old, &new), &path);
        remembers(recorder, subject, &here, &new, &path);
        if !seen.depends_on_state {
            let fresh = point.update(&at, &point.untouched(), &mut other);
            let far = |a: f64, b: f64| (a - b).abs() > 1e-6 * subject.stiffness * sample.size;
            seen.depends_on_state = fresh.is_ok_and(|fresh| (0..n).any(|i| far(fresh.force[i], here.force[i])));
        }
        if tangent(recorder, subject, random, (&here, &old), &path) {
            *seen.compared.entry(here.branch.name).or_default() += 1;
        }
        old = new;
    }
}

/// Checks dissipation, stored energy, symmetry and branch of one step.
fn said_of_itself(
    recorder: &mut Recorder,
    subject: &Subject,
    here: &Said,
    (old, new): (&[f64], &[f64]),
    path: &[[f64; 6]],
) {
    let Subject { card, sample, stiffness, point, .. } = subject;
    let work = stiffness * sample.size * sample.size;
    let creates = here.dissipated < -3e-14 * work;
    recorder.hold_on("dissipation", !creates || !card.claims(Property::DISSIPATIVE), path, || {
        format!("a step dissipates {:e}: it creates energy", here.dissipated)
    });
    recorder.hold_on("energy", here.stored >= -3e-14 * work, path, || format!("it stores {:e}", here.stored));
    let n = point.components();
    let pairs = (0..n).flat_map(|i| (0..i).map(move |j| (i, j)));
    let skew = pairs.map(|(i, j)| (here.tangent[i][j] - here.tangent[j][i]).abs()).fold(0.0, f64::max);
    recorder.hold_on("symmetry", skew <= 1e-12 * stiffness || !card.claims(Property::SYMMETRIC_TANGENT), path, || {
        format!("claims a symmetric tangent; in \"{}\" it is skew by {skew:e}", here.branch.name)
    });
    // If the flow is not normal to the yield surface, the tangent is not symmetric.
    recorder.hold_on("associated", skew <= 1e-9 * stiffness || !card.claims(Property::ASSOCIATED), path, || {
        format!("claims associated flow; in \"{}\" the tangent is skew by {skew:e}", here.branch.name)
    });
    let elastic = here.branch.is_elastic();
    recorder.hold_on("regions", !elastic || here.dissipated.abs() <= 1e-12 * work, path, || {
        format!("calls the step elastic, but dissipates {:e}", here.dissipated)
    });
    // The state of an open joint follows its position.
    let keeps = old == new || here.branch == UpdateBranch::OPEN;
    recorder.hold_on("regions", !elastic || keeps, path, || {
        format!(
            "calls the step \"{}\", which is elastic, but changes the state from {old:?} to {new:?}",
            here.branch.name
        )
    });
    recorder.hold_on("regions", elastic || old != new, path, || {
        format!("calls the step \"{}\", but the state is the same after it", here.branch.name)
    });
}

/// A second update to the same point, from the state after the step, gives the same result and does not change the state.
fn remembers(recorder: &mut Recorder, subject: &Subject, here: &Said, new: &[f64], path: &[[f64; 6]]) {
    let (Some(at), mut after) = (path.last(), vec![9.0; new.len()]) else { return };
    let n = subject.point.components();
    let again = subject.point.update(at, new, &mut after);
    let off = again.map(|again| (0..n).map(|i| (again.force[i] - here.force[i]).abs()).fold(0.0, f64::max));
    let worst = 1e-7 * subject.stiffness * subject.sample.size;
    recorder.hold_on("memory", off.is_ok_and(|off| off <= worst), path, || {
        format!(
            "at the same place again it carries {:?}, not {:?}: the state has not kept what happened",
            again.map(|said| said.force),
            here.force
        )
    });
    let near = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-7 * (a.abs() + b.abs()) + 1e-9 * subject.sample.size;
    recorder.hold_on("memory", after.iter().zip(new).all(near), path, || {
        format!("at the same place again the state goes from {new:?} to {after:?}")
    });
}

/// Compares the tangent in a random direction with central differences, if ±h stays in one branch and two step widths agree.
/// Returns true if the comparison was possible.
fn tangent(
    recorder: &mut Recorder,
    subject: &Subject,
    random: &mut Random,
    (here, old): (&Said, &[f64]),
    path: &[[f64; 6]],
) -> bool {
    /// Greatest difference between differences and tangent, as a share of the stiffness.
    const SHARE: f64 = 4e-6;
    let Subject { point, sample, stiffness, .. } = subject;
    let (Some(at), n) = (path.last(), point.components()) else { return false };
    let mut direction = [0.0; 6];
    direction[..n].iter_mut().for_each(|d| *d = random.signed());
    let h = 1e-6 * (sample.size + at.iter().fold(0.0_f64, |a, b| a.max(b.abs())));
    let mut other = vec![0.0; old.len()];
    let mut ends = [here.force; 4];
    for (end, factor) in ends.iter_mut().zip([1.0, -1.0, 0.5, -0.5]) {
        let moved: [f64; 6] = std::array::from_fn(|i| at[i] + factor * h * direction[i]);
        match point.update(&moved, old, &mut other) {
            Ok(said) if said.branch == here.branch => *end = said.force,
            _ => return false,
        }
    }
    let [a, b, c, d] = ends;
    let worst = |f: &dyn Fn(usize) -> f64| (0..n).fold(0.0_f64, |m, i| m.max(f(i).abs())) / stiffness;
    if worst(&|i| (a[i] - b[i]) / (2.0 * h) - (c[i] - d[i]) / h) >= SHARE {
        return false;
    }
    let error = worst(&|i| (0..n).map(|j| here.tangent[i][j] * direction[j]).sum::<f64>() - (c[i] - d[i]) / h);
    recorder.hold_on("tangent", error < SHARE, path, || {
        format!("in \"{}\" the tangent is off its differences by {error:.1e} of the stiffness", here.branch.name)
    });
    true
}

/// No update may allocate, in any branch, alone or in a batch. An update that fails may allocate.
fn allocations(recorder: &mut Recorder, subject: &Subject, count: CountAllocations) {
    let Subject { point, sample, .. } = subject;
    let mut random = Random::new(7);
    let size = point.state_size();
    let (mut old, mut new) = (point.untouched(), vec![0.0; size]);
    let (mut alone, mut in_batches) = (0, 0);
    let mut at = [0.0; 6];
    for index in 0..4 * BATCH {
        if index % STEPS == 0 {
            (old, at) = (point.untouched(), [0.0; 6]);
        }
        random_step(&mut random, &mut at, point.components(), sample.size);
        let mut done = false;
        let own = count(&mut || done = point.update(&at, &old, &mut new).is_ok());
        if done {
            alone += own;
            in_batches += point.allocations_in_batch(&at, &old, count);
            old.copy_from_slice(&new);
        }
    }
    recorder.hold("allocation", alone == 0, || format!("{} updates allocate {alone} times", 4 * BATCH));
    recorder.hold("allocation", in_batches == 0, || {
        format!("{} updates through the loop over points allocate {in_batches} times", 4 * BATCH)
    });
}
