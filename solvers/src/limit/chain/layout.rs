//! Bodies as trees rooted at supports, closed by a few joints, and the joint forces as affine forms of the redundants.
//!
//! Each joint of the trees transmits a force that depends on the loads beyond it and on the redundants of the closing
//! joints (force method; Livesley 1978). An arch is a tree of two branches that one joint closes: three redundants.

use crate::limit::settings::SETTINGS;
use nalgebra::Vector3;
use std::collections::VecDeque;
use voussoir_core::limit::{LimitJoint, LimitProblem};
use voussoir_core::model::Wrenches;

/// Greatest number of closing joints: with more, sparse programs are faster.
const MAX_CLOSING_JOINTS: usize = 8;

/// A joint of a tree.
#[derive(Debug, Clone, Copy)]
pub struct Link {
    /// Index of the joint.
    pub joint: usize,
    /// Group towards the root, `None` for the ground.
    pub behind: Option<usize>,
    /// Group away from the root.
    pub ahead: usize,
}

/// Trees that reach every group, breadth first from the supports. Closing joints then lie midway between supports, and
/// rounding errors do not accumulate in one branch.
#[derive(Debug, Clone)]
pub struct Trees {
    /// Links, each after the one behind it.
    pub links: Vec<Link>,
    /// Joints that close the trees.
    pub cuts: Vec<usize>,
}

/// Returns the problem's bodies as trees, if few joints close them, no fill resists, and one facet bounds sliding in each
/// sense.
pub fn trees(problem: &LimitProblem) -> Option<Trees> {
    if problem.joints.len() > problem.groups + MAX_CLOSING_JOINTS
        || problem.joints.iter().any(|joint| joint.fill.is_some() || !joint.strength.envelopes.is_empty())
    {
        return None;
    }
    let mut queue: VecDeque<(usize, Option<usize>)> = VecDeque::new();
    for (index, joint) in problem.joints.iter().enumerate() {
        match (joint.minus, joint.plus) {
            (None, None) => return None,
            (None, _) | (_, None) => queue.push_back((index, None)),
            _ => {}
        }
    }
    let touching = Touching::of(problem);
    let (mut reached, mut used) = (vec![false; problem.groups], vec![false; problem.joints.len()]);
    let mut trees = Trees { links: Vec::with_capacity(problem.groups), cuts: Vec::new() };
    while let Some((joint, behind)) = queue.pop_front() {
        if std::mem::replace(&mut used[joint], true) {
            continue;
        }
        let own = &problem.joints[joint];
        let ahead = if own.minus == behind { own.plus } else { own.minus };
        match ahead.filter(|group| !reached[*group]) {
            Some(ahead) => {
                reached[ahead] = true;
                trees.links.push(Link { joint, behind, ahead });
                queue.extend(
                    touching.joints(ahead).iter().filter(|next| !used[**next]).map(|next| (*next, Some(ahead))),
                );
            }
            None => trees.cuts.push(joint),
        }
    }
    // Groups that are not reached have no support.
    (reached.iter().all(|&r| r) && trees.cuts.len() <= MAX_CLOSING_JOINTS).then_some(trees)
}

/// The joints of every group, group by group.
struct Touching {
    joints: Vec<usize>,
    ends: Vec<usize>,
}

impl Touching {
    fn of(problem: &LimitProblem) -> Self {
        let groups = |joint: &LimitJoint| [joint.minus, joint.plus].into_iter().flatten();
        let mut places = vec![0; problem.groups + 1];
        problem.joints.iter().flat_map(groups).for_each(|group| places[group + 1] += 1);
        (0..problem.groups).for_each(|group| places[group + 1] += places[group]);
        let mut joints = vec![0; places[problem.groups]];
        for (index, joint) in problem.joints.iter().enumerate() {
            for group in groups(joint) {
                joints[places[group]] = index;
                places[group] += 1;
            }
        }
        // Each place is now at the end of its group.
        Touching { joints, ends: places }
    }

    fn joints(&self, group: usize) -> &[usize] {
        let first = if group == 0 { 0 } else { self.ends[group - 1] };
        &self.joints[first..self.ends[group]]
    }
}

/// (N_0, N_1, T) of every joint as functions of the redundants, three for each closing joint.
#[derive(Debug, Clone)]
pub struct Redundants {
    /// Number of redundants.
    count: usize,
    /// For each joint three rows of `count` numbers.
    values: Vec<f64>,
}

impl Redundants {
    /// Computes the forms of a problem whose bodies are trees.
    pub fn new(problem: &LimitProblem, trees: &Trees) -> Self {
        let count = 3 * trees.cuts.len();
        let mut values = vec![0.0; 3 * count * problem.joints.len()];
        let mut set = |joint: usize, column: usize, forces: [f64; 3]| {
            (0..3).for_each(|i| values[(3 * joint + i) * count + column] = forces[i]);
        };
        let mut loads = vec![Vector3::zeros(); problem.groups];
        for (number, &cut) in trees.cuts.iter().enumerate() {
            let joint = &problem.joints[cut];
            for k in 0..3 {
                let mut wrench = Vector3::zeros();
                wrench[k] = if k == 2 { problem.length } else { 1.0 };
                loads.fill(Vector3::zeros());
                for (group, sign) in [(joint.plus, 1.0), (joint.minus, -1.0)] {
                    group.into_iter().for_each(|group| loads[group] += wrench * sign);
                }
                set(cut, 3 * number + k, resolved(problem, cut, joint.plus, wrench));
                transmit(trees, &mut loads, |link, wrench| {
                    // Branches that the cut does not close have no forces.
                    if wrench != Vector3::zeros() {
                        set(link.joint, 3 * number + k, resolved(problem, link.joint, Some(link.ahead), wrench));
                    }
                });
            }
        }
        Redundants { count, values }
    }
}

/// The result of [`Forms::aim_at`].
pub enum Aim {
    /// The last variable is the form.
    Last,
    /// The loads alone determine the joint's normal forces.
    Determined([f64; 3]),
    /// The form has the same value in all fields, but other forms of the joint vary.
    Constant,
}

/// (N_0, N_1, T) of every joint as affine forms of the variables, in units of the force scale.
#[derive(Debug, Clone)]
pub struct Forms {
    /// Number of variables.
    pub variables: usize,
    /// For each joint three rows of `variables + 1` numbers, the constant last.
    pub values: Vec<f64>,
}

impl Forms {
    /// Creates the forms. Variables are the redundants, then one factor per entry of `columns`: a load, and the load
    /// factor for a unit of the variable.
    pub fn new(
        problem: &LimitProblem,
        trees: &Trees,
        redundants: &Redundants,
        (constant, columns): (&Wrenches, &[(&Wrenches, f64)]),
        force: f64,
    ) -> Self {
        let variables = redundants.count + columns.len();
        let mut values = vec![0.0; 3 * (variables + 1) * problem.joints.len()];
        if redundants.count > 0 {
            let rows = values.chunks_exact_mut(variables + 1).zip(redundants.values.chunks_exact(redundants.count));
            rows.for_each(|(row, own)| row[..redundants.count].copy_from_slice(own));
        }
        let mut loads = vec![Vector3::zeros(); problem.groups];
        for (place, &(wrenches, factor)) in columns.iter().chain([&(constant, 1.0)]).enumerate() {
            loads.iter_mut().zip(wrenches).for_each(|(load, wrench)| *load = Vector3::from(*wrench));
            transmit(trees, &mut loads, |link, wrench| {
                let forces = resolved(problem, link.joint, Some(link.ahead), wrench * (factor / force));
                let rows = &mut values[3 * (variables + 1) * link.joint..];
                (0..3).for_each(|i| rows[i * (variables + 1) + redundants.count + place] = forces[i]);
            });
        }
        Forms { variables, values }
    }

    /// Changes the variables so that the last one is a form over (N_0, N_1, T) of a joint.
    pub fn aim_at(&mut self, joint: usize, form: [f64; 3]) -> Aim {
        let (n, own) = (self.variables, self.of_joint(joint));
        let is_zero = |row: &[f64]| row[..n].iter().all(|x| *x == 0.0);
        if own.chunks_exact(n + 1).take(2).all(is_zero) {
            return Aim::Determined(std::array::from_fn(|i| own[i * (n + 1) + n]));
        }
        let target: Vec<f64> = (0..=n).map(|k| (0..3).map(|i| form[i] * own[i * (n + 1) + k]).sum::<f64>()).collect();
        let greatest = own.chunks_exact(n + 1).flat_map(|row| &row[..n]).fold(0.0f64, |most, x| most.max(x.abs()));
        let Some(pivot) = (0..n).max_by(|&a, &b| target[a].abs().total_cmp(&target[b].abs())) else {
            return Aim::Constant;
        };
        if target[pivot].abs() <= SETTINGS.negligible * greatest {
            return Aim::Constant;
        }
        for row in self.values.chunks_exact_mut(n + 1) {
            let share = row[pivot] / target[pivot];
            row.iter_mut().zip(&target).for_each(|(own, target)| *own -= share * target);
            row[pivot] = row[n - 1];
            row[n - 1] = share;
        }
        Aim::Last
    }

    /// Returns the form of N_0, N_1 or T of a joint; its constant is last.
    pub fn form(&self, joint: usize, i: usize) -> &[f64] {
        let length = self.variables + 1;
        &self.values[(3 * joint + i) * length..][..length]
    }

    /// Returns the forms of N_0, N_1 and T of a joint.
    pub fn of_joint(&self, joint: usize) -> &[f64] {
        let length = 3 * (self.variables + 1);
        &self.values[joint * length..][..length]
    }
}

/// Adds the weighted coefficients of the forms of a joint to `a`. Returns the bound minus the weighted constants.
#[inline(always)]
pub fn add_weighted(variables: usize, forms: &[f64], weights: &[f64; 3], mut bound: f64, a: &mut [f64]) -> f64 {
    let a = &mut a[..variables];
    for (form, weight) in forms.chunks_exact(variables + 1).zip(weights).filter(|(_, weight)| **weight != 0.0) {
        a.iter_mut().zip(form).for_each(|(a, c)| *a += weight * c);
        bound -= weight * form[variables];
    }
    bound
}

/// Calls `each` with every link, starting at the links farthest from the roots, and the wrench that it transmits to the
/// groups ahead. The wrench balances all loads there; loads are summed towards the roots.
fn transmit(trees: &Trees, loads: &mut [Vector3<f64>], mut each: impl FnMut(&Link, Vector3<f64>)) {
    for link in trees.links.iter().rev() {
        let sum = loads[link.ahead];
        link.behind.into_iter().for_each(|behind| loads[behind] += sum);
        each(link, -sum);
    }
}

/// Returns (N_0, N_1, T) of a joint that transmits `wrench` (about the pole) to the groups ahead.
fn resolved(problem: &LimitProblem, index: usize, ahead: Option<usize>, wrench: Vector3<f64>) -> [f64; 3] {
    let joint = &problem.joints[index];
    let sign = if joint.plus == ahead { 1.0 } else { -1.0 };
    let force = nalgebra::Vector2::new(sign * wrench[0], sign * wrench[1]);
    let lever = joint.ends[0] - problem.pole;
    let about_end = sign * wrench[2] - (lever.x * force.y - lever.y * force.x);
    let height = (joint.ends[1] - joint.ends[0]).norm();
    // N_1 at end 1 turns clockwise about end 0.
    let n_1 = -about_end / height;
    [force.dot(&joint.normal) - n_1, n_1, force.dot(&joint.tangent)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limit::tests::scenes::{STUCK, block, lintel};

    /// A block on the ground is one link. Two half lintels between supports are one link each, closed by a joint.
    #[test]
    fn trees_reach_every_group() {
        let alone = trees(&block(1.0, 2.0, STUCK)).expect("a tree");
        assert_eq!((alone.links.len(), alone.cuts.len()), (1, 0));
        let between = trees(&lintel(4.0, 1.0, 10.0)).expect("trees");
        let mut ahead: Vec<usize> = between.links.iter().map(|link| link.ahead).collect();
        ahead.sort_unstable();
        assert_eq!((ahead, between.cuts.len()), (vec![0, 1], 1));
    }

    /// A group without a joint is in no tree.
    #[test]
    fn a_floating_group_has_no_tree() {
        let mut problem = lintel(4.0, 1.0, 10.0);
        problem.joints.retain(|joint| joint.plus == Some(0));
        assert!(trees(&problem).is_none());
    }

    /// The joints of a group are the joints that name it, in their order.
    #[test]
    fn groups_know_their_joints() {
        let problem = lintel(4.0, 1.0, 10.0);
        let touching = Touching::of(&problem);
        assert_eq!((touching.joints(0), touching.joints(1)), (&[0, 1][..], &[1, 2][..]));
    }
}
