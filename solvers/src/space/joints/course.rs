//! The course of the steps: dead load, then growing steps of the live load's power, until forces and motion are constant.
//!
//! A step with the friction of the law may have no solution, for example where elastic energy would set blocks in motion. A few steps
//! with a fictitious cohesion then replace it; the cohesion follows from the normal forces of the steps before. Then the law's own
//! friction is tried again. A course ends only at a state of the law, so the steps before it need not obey the law.

use super::point::{Contact, Spring};
use super::step::{Control, Joints, Step};
use crate::space::interior_point::dot;
use crate::space::program::{Bodies, Program};
use crate::space::settings::JOINTS;

/// A state with the laws' own flow.
#[derive(Debug, Clone)]
pub struct State {
    /// Factor above the start.
    pub lambda: f64,
    /// Forces (n, s, t) of all points.
    pub forces: Vec<[f64; 3]>,
    /// Mechanism with p·q = 1.
    pub motion: Bodies,
}

/// The end of a course.
pub enum End {
    /// A state, accurate within rounding.
    Settled(State),
    /// Least and greatest factor of the last steps, the greatest shear force beyond friction relative to the loads, and the last step.
    Wanders([f64; 2], f64, State),
    /// No step under the live load was solved.
    Stuck,
    /// The dead load was not carried.
    Fell,
}

/// Applies the dead load at zero stress. One step is enough: the response of joints without stress is homogeneous, so smaller steps give
/// the same forces.
pub fn dead_load(joints: &mut Joints) -> Option<()> {
    if joints.loads(0.0) == 0.0 {
        return Some(());
    }
    let still = vec![0.0; joints.program.base.len()];
    let held = Control::Factor(0.0);
    let step = match joints.coulomb(still.clone(), 0.0, held) {
        Some(step) => step,
        None => {
            let endless = vec![joints.loads(0.0) * JOINTS.endless; joints.springs.len()];
            by_cohesion(joints, still, 0.0, held, endless)?
        }
    };
    joints.contacts = step.contacts;
    Some(())
}

/// Finds a step with the friction of the law from steps with fictitious cohesion, at first that of known normal forces.
pub fn by_cohesion(
    joints: &mut Joints,
    mut motion: Bodies,
    lambda: f64,
    control: Control,
    mut normals: Vec<f64>,
) -> Option<Step> {
    for pass in 0..JOINTS.passes {
        let step = joints.lagged(motion, lambda, control, &normals)?;
        let share = if pass == 0 { 1.0 } else { JOINTS.relaxed };
        relax(&mut normals, share, &step.contacts);
        motion = step.motion;
        if let Some(step) = joints.coulomb(motion.clone(), step.lambda, control) {
            return Some(step);
        }
    }
    None
}

fn relax(normals: &mut [f64], share: f64, contacts: &[Contact]) {
    normals.iter_mut().zip(contacts).for_each(|(normal, contact)| *normal += share * (contact.force[0] - *normal));
}

/// Runs the course from zero stress.
pub fn course(joints: &mut Joints) -> End {
    if dead_load(joints).is_none() { End::Fell } else { live_load(joints, 0.0) }
}

/// Runs the course from the present state in equilibrium at a factor.
pub fn live_load(joints: &mut Joints, lambda: f64) -> End {
    let rate = along(joints.program, 1.0);
    follow(joints, lambda, rate, JOINTS.first)
}

/// Runs the course from the present forces at a factor, with a first guess of the rate and the power of the first step.
pub fn follow(joints: &mut Joints, mut lambda: f64, mut rate: Bodies, first_power: f64) -> End {
    let compliance = compliance(joints);
    let mut power = first_power * compliance;
    let first = joints.iterations;
    let most = first + JOINTS.iterations;
    let (mut lag, mut wait) = (0, 0);
    let mut normals = Vec::new();
    let mut factors = Vec::new();
    // A step whose guess is its solution costs no iteration: the number of steps has a limit too.
    while joints.iterations.max(first + factors.len() as u64) < most && power >= JOINTS.least * compliance {
        let guess: Bodies = rate.iter().map(|q| q * power).collect();
        let mut step = None;
        if wait == 0 {
            step = own_step(joints, &guess, lambda, power);
            lag = if step.is_some() { 0 } else { (2 * lag + 1).min(JOINTS.longest) };
            wait = lag;
            normals = joints.contacts.iter().map(|contact| contact.force[0]).collect();
        }
        let own = step.is_some();
        if !own {
            wait -= 1;
            step = joints.lagged(guess, lambda, Control::Power, &normals);
        }
        let Some(Step { motion, lambda: reached, contacts }) = step else {
            power *= JOINTS.shorter;
            continue;
        };
        if !own {
            relax(&mut normals, JOINTS.relaxed, &contacts);
        }
        (joints.contacts, lambda) = (contacts, reached);
        rate = motion.iter().map(|u| u / power).collect();
        factors.push(lambda);
        if own && settled(joints, &rate, lambda) {
            let forces = joints.contacts.iter().map(|contact| contact.force).collect();
            return End::Settled(State { lambda, forces, motion: rate });
        }
        power = (power * JOINTS.growth).min(JOINTS.greatest * compliance);
    }
    wanders(joints, &factors, lambda, rate)
}

/// Returns the power of the live load per factor in a small first step.
pub fn compliance(joints: &mut Joints) -> f64 {
    let unit = dot(&joints.program.varying, &joints.program.varying).sqrt();
    if let Some(known) = joints.compliance {
        return known;
    }
    let small = JOINTS.probe * unit;
    let step = joints.coulomb(along(joints.program, small), 0.0, Control::Power);
    let compliance = step.map_or(unit, |step| small / step.lambda.abs()).max(unit);
    joints.compliance = Some(compliance);
    compliance
}

/// Tries the law's own friction, from the last rate and from rest.
pub fn own_step(joints: &mut Joints, guess: &[f64], lambda: f64, power: f64) -> Option<Step> {
    let first = joints.coulomb(guess.to_vec(), lambda, Control::Power);
    first.or_else(|| joints.coulomb(along(joints.program, power), lambda, Control::Power))
}

/// Returns the motion along the live load with a power.
pub fn along(program: &Program, power: f64) -> Bodies {
    let live = &program.varying;
    let share = power / dot(live, live);
    live.iter().map(|p| p * share).collect()
}

/// Returns true if the rates follow the flow of the laws, and no contact has power left, within rounding.
pub fn settled(joints: &Joints, rate: &[f64], lambda: f64) -> bool {
    let (mut largest, mut closing, mut idle) = (0.0f64, 0.0f64, 0.0);
    for ((spring, contact), v) in joints.springs.iter().zip(&joints.contacts).zip(joints.jumps(rate)) {
        let slip = v[1].hypot(v[2]);
        let opening = v[0] - spring.dilatancy * slip;
        let [n, s, t] = contact.force;
        largest = largest.max(v[0].hypot(slip));
        closing = closing.max(-opening);
        idle += (n * opening).abs() + (spring.friction * n * slip + s * v[1] + t * v[2]).abs();
    }
    closing <= joints.settled * largest && idle <= joints.settled * largest * joints.loads(lambda)
}

/// Returns the end of a course without a state.
fn wanders(joints: &Joints, factors: &[f64], lambda: f64, motion: Bodies) -> End {
    if factors.is_empty() {
        return End::Stuck;
    }
    let last = &factors[factors.len().saturating_sub(JOINTS.reported)..];
    let least = last.iter().copied().fold(f64::INFINITY, f64::min);
    let greatest = last.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let beyond = |(contact, spring): (&Contact, &Spring)| {
        contact.force[1].hypot(contact.force[2]) - spring.friction * contact.force[0]
    };
    let excess = joints.contacts.iter().zip(&joints.springs).map(beyond).fold(0.0, f64::max);
    let forces = joints.contacts.iter().map(|contact| contact.force).collect();
    End::Wanders([least, greatest], excess / joints.loads(lambda), State { lambda, forces, motion })
}
