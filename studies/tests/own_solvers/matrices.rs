//! The matrices of a limit problem against the certificate, in other units and about another pole.

use super::scenes::scenes;
use voussoir::core::certificate::{Claim, ContactForce, certify};
use voussoir::core::limit::{JointForce, LimitMatrices, LimitProblem, LimitQuestion, LimitSolver, Status};
use voussoir::core::model::geometry::{Vec2, cross};
use voussoir::core::model::{Assembly, StageLoads, stage_loads};
use voussoir::core::random::Random;
use voussoir::solvers::limit::conic::LimitConic;
use voussoir::study::load;

/// A check of a scene by its name, the loads of its last stage, its problem and a field.
type Check<'c> = dyn FnMut(&str, (&Assembly, &StageLoads), &LimitProblem, &[JointForce]) + 'c;

/// Calls `check` with the last stage of each scene, and a random field.
fn each(check: &mut Check) {
    let mut random = Random::from_state(7);
    for (name, text) in scenes() {
        let case = load(&text, "a.toml", &[]).expect("a study").cases.remove(0);
        let loads = stage_loads(&case.assembly, &case.stages).pop().expect("a stage");
        let problem = LimitProblem::new(&case.assembly, &loads).expect("a problem");
        let size = problem.magnitude(&problem.fixed);
        let mut force = || size * random.signed();
        let field: Vec<JointForce> =
            problem.joints.iter().map(|_| JointForce { normal: [force(), force()], shear: force() }).collect();
        check(name, (&case.assembly, &loads), &problem, &field);
    }
}

/// The forces of a field at the ends of its joints.
fn contacts(problem: &LimitProblem, field: &[JointForce]) -> Vec<ContactForce> {
    let of = |(joint, force): (&voussoir::core::limit::LimitJoint, &JointForce)| {
        [(0, force.shear), (1, 0.0)].map(|(end, shear)| ContactForce {
            joint: joint.joint,
            point: joint.ends[end],
            force: [force.normal[end], shear],
        })
    };
    problem.joints.iter().zip(field).flat_map(of).collect()
}

/// The wrench (x, y, moment about a point) of each group that the forces leave without balance.
fn left(matrices: &LimitMatrices, r: &[f64], factor: f64, about: impl Fn(usize) -> Vec2) -> Vec<[f64; 3]> {
    let rows = matrices.unbalanced(r, factor);
    let of =
        |(group, w): (usize, &[f64])| [w[0], w[1], w[2] * matrices.length - cross(about(group), Vec2::new(w[0], w[1]))];
    rows.chunks_exact(3).enumerate().map(of).collect()
}

/// The rows of equilibrium leave the same forces without balance as the sums of the certificate, for any field.
#[test]
fn the_rows_of_equilibrium_are_the_sums_of_the_certificate() {
    each(&mut |name, (assembly, loads), problem, field| {
        let matrices = problem.matrices();
        let (r, factor) = (matrices.forces(field), 1.7);
        assert_eq!(matrices.joint_forces(&r), field, "{name}");
        let centroids = assembly.centroids();
        let first = |group: usize| problem.group_of.iter().position(|of| *of == Some(group)).expect("a body");
        let sums = left(&matrices, &r, factor, |group| centroids[first(group)] - problem.pole);
        let largest = sums.iter().map(|s| s[0].abs().max(s[1].abs()).max(s[2].abs() / assembly.size()));
        let forces = contacts(problem, field);
        let claim = Claim {
            hint: Status::Stands,
            target: factor,
            factor: None,
            field_factor: factor,
            start: 0.0,
            field: Some(&forces),
            fill: &[],
            start_field: None,
            motion: None,
            ray: None,
            supports: None,
            feasible_interval: None,
            non_associated: None,
        };
        let free = || (0..assembly.bodies.len()).filter(|body| problem.group_of[*body].is_some());
        let size = |w: &[[f64; 3]]| free().map(|body| w[body][0].hypot(w[body][1])).sum::<f64>();
        let scale = size(&loads.fixed) + factor * size(&loads.varying);
        let known = certify(assembly, loads, &claim, 1e-9).certificate.residuals["equilibrium"] * scale;
        let found = largest.fold(0.0, f64::max);
        assert!((found - known).abs() <= 1e-11 * known, "{name}: {found} {known}");
    });
}

/// The field of a collapse by `limit_conic` satisfies the rows of equilibrium and of strength.
#[test]
fn a_collapse_satisfies_the_rows() {
    let mut collapses = 0;
    each(&mut |name, _, problem, _| {
        let answer = LimitConic {}.solve(problem, LimitQuestion::Collapse { start: 0.0, max: f64::INFINITY });
        let (Some(factor), Some(field)) = (answer.factor, &answer.field) else { return };
        let matrices = problem.matrices();
        let r = matrices.forces(field);
        let scale = matrices.force_unit.max(problem.magnitude(&problem.varying) * factor.abs());
        assert!(matrices.unbalanced(&r, factor).iter().all(|left| left.abs() <= 1e-10 * scale), "{name}");
        for (row, bound) in matrices.strength.iter().zip(&matrices.bounds) {
            let reached: f64 = row.iter().map(|&(k, value)| value * r[k]).sum();
            assert!(reached <= bound + 1e-10 * scale, "{name}: {reached} {bound}");
        }
        collapses += 1;
    });
    assert!(collapses >= 6, "{collapses}");
}

/// Moments about another pole change the rows of moments by the moment of the rows of forces, and nothing else.
#[test]
fn another_pole_changes_moments_only() {
    each(&mut |name, _, problem, field| {
        let mut moved = problem.clone();
        let shift = Vec2::new(3.0, -7.0);
        moved.pole += shift;
        for w in moved.fixed.iter_mut().chain(&mut moved.varying) {
            w[2] -= cross(shift, Vec2::new(w[0], w[1]));
        }
        let [one, two] = [problem, &moved].map(LimitProblem::matrices);
        let r = one.forces(field);
        let known = left(&one, &r, 0.3, |_| shift);
        let found = left(&two, &r, 0.3, |_| Vec2::zeros());
        let size = known.iter().flatten().fold(0.0, |a: f64, x| a.max(x.abs()));
        for (known, found) in known.iter().flatten().zip(found.iter().flatten()) {
            assert!((known - found).abs() <= 1e-12 * size, "{name}: {known} {found}");
        }
        assert_eq!((one.strength, one.bounds), (two.strength, two.bounds), "{name}");
    });
}

/// With lengths in millimetres and forces in kN the matrices are the same, and loads and bounds are a thousandth.
#[test]
fn the_matrices_have_no_units() {
    each(&mut |name, _, problem, field| {
        let mut scaled = problem.clone();
        let (length, force) = (1e3, 1e-3);
        scaled.length *= length;
        scaled.pole *= length;
        for joint in &mut scaled.joints {
            joint.ends.iter_mut().for_each(|end| *end *= length);
            joint.strength.rows.iter_mut().for_each(|row| row.bound *= force);
        }
        for w in scaled.fixed.iter_mut().chain(&mut scaled.varying) {
            *w = [w[0] * force, w[1] * force, w[2] * force * length];
        }
        let [one, two] = [problem, &scaled].map(LimitProblem::matrices);
        let entries = |rows: &[Vec<(usize, f64)>]| rows.iter().flatten().copied().collect::<Vec<_>>();
        let (a, b) = (entries(&one.equilibrium), entries(&two.equilibrium));
        assert!(
            a.len() == b.len() && a.iter().zip(&b).all(|(a, b)| a.0 == b.0 && (a.1 - b.1).abs() <= 1e-12),
            "{name}"
        );
        assert_eq!(one.strength, two.strength, "{name}");
        let r = one.forces(field);
        let small: Vec<f64> = r.iter().map(|r| r * force).collect();
        let [known, found] = [one.unbalanced(&r, 0.7), two.unbalanced(&small, 0.7)];
        let size = one.force_unit;
        assert!(known.iter().zip(&found).all(|(a, b)| (a * force - b).abs() <= 1e-12 * size), "{name}");
        assert!((two.force_unit - force * one.force_unit).abs() <= 1e-12 * size, "{name}");
    });
}
