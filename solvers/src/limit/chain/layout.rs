//! Chains of bodies and the joint forces as affine forms of their redundants.

use nalgebra::Vector3;
use voussoir_core::limit::LimitProblem;
use voussoir_core::model::Wrenches;

/// A row of bodies, each touching the next.
#[derive(Debug, Clone)]
pub struct Chain {
    /// Joints in order from a support, each with the group behind it (`None`: the far support).
    pub links: Vec<(usize, Option<usize>)>,
    /// Whether the last joint is at a support too.
    pub closed: bool,
}

/// The problem's bodies as chains that each begin at a support, if they are that.
pub fn chains(problem: &LimitProblem) -> Option<Vec<Chain>> {
    if problem.joints.iter().any(|joint| joint.fill.is_some()) {
        return None;
    }
    let mut joints_of: Vec<Vec<usize>> = vec![Vec::new(); problem.groups];
    let mut at_ground = Vec::new();
    for (index, joint) in problem.joints.iter().enumerate() {
        match (joint.minus, joint.plus) {
            (Some(a), Some(b)) => {
                joints_of[a].push(index);
                joints_of[b].push(index);
            }
            (Some(a), None) | (None, Some(a)) => {
                joints_of[a].push(index);
                at_ground.push(index);
            }
            (None, None) => return None,
        }
    }
    if joints_of.iter().any(|joints| joints.is_empty() || joints.len() > 2) {
        return None;
    }
    let mut used = vec![false; problem.joints.len()];
    let mut all = Vec::new();
    for &first in &at_ground {
        if used[first] {
            continue;
        }
        let mut chain = Chain { links: Vec::new(), closed: false };
        let (mut joint, mut behind) = (first, None);
        loop {
            used[joint] = true;
            let LimitJointEnds(minus, plus) = ends(problem, joint);
            let ahead = if minus == behind { plus } else { minus };
            chain.links.push((joint, ahead));
            let Some(group) = ahead else {
                chain.closed = true;
                break;
            };
            match joints_of[group].iter().find(|&&next| next != joint) {
                Some(&next) => (joint, behind) = (next, Some(group)),
                None => break,
            }
        }
        all.push(chain);
    }
    // Joints never reached belong to rings that touch no support.
    used.iter().all(|&u| u).then_some(all)
}

struct LimitJointEnds(Option<usize>, Option<usize>);

fn ends(problem: &LimitProblem, joint: usize) -> LimitJointEnds {
    LimitJointEnds(problem.joints[joint].minus, problem.joints[joint].plus)
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
    /// Variables: three redundants per closed chain, then one factor per entry of `columns`
    /// (loads with the factor that one unit of the variable stands for).
    pub fn new(
        problem: &LimitProblem,
        chains: &[Chain],
        constant: (&Wrenches, f64),
        columns: &[(&Wrenches, f64)],
        force: f64,
    ) -> Self {
        let redundants = 3 * chains.iter().filter(|chain| chain.closed).count();
        let variables = redundants + columns.len();
        let stride = 3 * (variables + 1);
        let mut values = vec![0.0; stride * problem.joints.len()];
        let mut offset = 0;
        for chain in chains {
            for (place, &(wrenches, factor)) in columns.iter().chain([&constant]).enumerate() {
                for (position, wrench) in transmitted(chain, wrenches).into_iter().enumerate() {
                    let joint = chain.links[position].0;
                    let forces = resolved(problem, chain, position, wrench * (factor / force));
                    (0..3).for_each(|i| values[joint * stride + i * (variables + 1) + redundants + place] = forces[i]);
                }
            }
            if chain.closed {
                for k in 0..3 {
                    let mut wrench = Vector3::zeros();
                    wrench[k] = if k == 2 { problem.length } else { 1.0 };
                    for (position, &(joint, _)) in chain.links.iter().enumerate() {
                        let forces = resolved(problem, chain, position, wrench);
                        (0..3).for_each(|i| values[joint * stride + i * (variables + 1) + offset + k] = forces[i]);
                    }
                }
                offset += 3;
            }
        }
        Forms { variables, values }
    }
}

/// The wrench transmitted at each joint onto what lies ahead, with zero redundants: for a closed
/// chain relative to that at its middle, so that neither end collects all the rounding.
fn transmitted(chain: &Chain, wrenches: &Wrenches) -> Vec<Vector3<f64>> {
    let load = |link: &(usize, Option<usize>)| link.1.map_or(Vector3::zeros(), |g| Vector3::from(wrenches[g]));
    let mut sums = vec![Vector3::zeros(); chain.links.len()];
    // Ahead of joint k: R_k + load = R_{k+1}.
    if chain.closed {
        let middle = chain.links.len() / 2;
        for k in middle + 1..chain.links.len() {
            sums[k] = sums[k - 1] + load(&chain.links[k - 1]);
        }
        for k in (0..middle).rev() {
            sums[k] = sums[k + 1] - load(&chain.links[k]);
        }
    } else {
        let mut behind = Vector3::zeros();
        for k in (0..chain.links.len()).rev() {
            behind -= load(&chain.links[k]);
            sums[k] = behind;
        }
    }
    sums
}

/// (N_0, N_1, T) of a joint that transmits `wrench` (about the pole) onto what lies ahead.
fn resolved(problem: &LimitProblem, chain: &Chain, position: usize, wrench: Vector3<f64>) -> [f64; 3] {
    let (index, ahead) = chain.links[position];
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
