//! Elastic bodies against closed solutions: patch tests, orders of convergence, bending, own weight, invariances of the
//! condensed flexibility, and a dense Ritz solution.

use nalgebra::{Complex, DMatrix, DVector, Matrix2};
use voussoir::core::elastic::*;
use voussoir::core::law::{Elasticity, Plane};
use voussoir::core::model::geometry::{Vec2, area_and_centroid, cross, edges, turned};
use voussoir_tests::{Arch, assert_close, first_case};

/// An isotropic material.
#[derive(Clone, Copy)]
struct Isotropic {
    young_modulus: f64,
    poisson_ratio: f64,
    density: f64,
}

impl Isotropic {
    fn elasticity(&self) -> Elasticity {
        Elasticity::isotropic(self.young_modulus, self.poisson_ratio)
    }
}

const STONE: Isotropic = Isotropic { young_modulus: 5e9, poisson_ratio: 0.3, density: 2200.0 };
const WIDTH: f64 = 0.7;
const PLANES: [Plane; 2] = [Plane::Strain, Plane::Stress];

fn polygon(points: &[[f64; 2]]) -> Vec<Vec2> {
    points.iter().copied().map(Vec2::from).collect()
}

fn distorted() -> Vec<Vec2> {
    polygon(&[[0.1, 0.0], [1.3, 0.2], [1.1, 0.9], [-0.1, 1.1]])
}

fn rectangle(length: f64, height: f64) -> Vec<Vec2> {
    polygon(&[[0.0, -height / 2.0], [length, -height / 2.0], [length, height / 2.0], [0.0, height / 2.0]])
}

fn density(elements: [usize; 2], order: usize) -> MeshDensity {
    MeshDensity { elements, order, grading: [1.0; 2] }
}

/// Returns G and Kolosov's constant κ.
fn moduli(plane: Plane, material: Isotropic) -> (f64, f64) {
    let nu = material.poisson_ratio;
    let kappa = if plane == Plane::Strain { 3.0 - 4.0 * nu } else { (3.0 - nu) / (1.0 + nu) };
    (material.young_modulus / (2.0 * (1.0 + nu)), kappa)
}

/// Returns the strain of a stress (xx, yy, xy).
fn strain(plane: Plane, material: Isotropic, [xx, yy, xy]: [f64; 3]) -> Matrix2<f64> {
    let (g, kappa) = moduli(plane, material);
    let mean = (xx + yy) * (3.0 - kappa) / 4.0;
    Matrix2::new(xx - mean, xy, xy, yy - mean) / (2.0 * g)
}

/// Returns points and forces of a traction on a part of an edge between fractions: a rule for any function, six points
/// per segment.
fn on_edge(a: Vec2, b: Vec2, breaks: &[f64], traction: impl Fn(Vec2, Vec2) -> Vec2) -> Vec<(Vec2, Vec2)> {
    let (places, shares) = joint_points(breaks, 6);
    let outward = -turned((b - a).normalize());
    let area = (b - a).norm() * WIDTH;
    let force = |(t, share): (&f64, &f64)| {
        let x = a * (1.0 - t) + b * *t;
        (x, traction(x, outward) * (share * area))
    };
    places.iter().zip(&shares).map(force).collect()
}

/// Returns the forces of a stress field on a whole boundary.
fn on_boundary(vertices: &[Vec2], mesh: &MeshDensity, stress: impl Fn(Vec2) -> [f64; 3]) -> (Vec<Vec2>, Vec<Vec2>) {
    let traction = |x: Vec2, n: Vec2| {
        let [xx, yy, xy] = stress(x);
        Matrix2::new(xx, xy, xy, yy) * n
    };
    let edge = |(i, (a, b))| on_edge(a, b, &edge_breaks(vertices, mesh, i), traction);
    edges(vertices).enumerate().flat_map(edge).unzip()
}

/// Returns the greatest component of displacements after the best rigid motion is subtracted.
fn beyond_rigid(points: &[Vec2], displacement: &[Vec2]) -> f64 {
    without_rigid(points, displacement).iter().fold(0.0, |max, u| max.max(u.amax()))
}

fn without_rigid(points: &[Vec2], displacement: &[Vec2]) -> Vec<Vec2> {
    let count = points.len() as f64;
    let middle = points.iter().sum::<Vec2>() / count;
    let mean = displacement.iter().sum::<Vec2>() / count;
    let turn: f64 = points.iter().zip(displacement).map(|(x, u)| cross(x - middle, *u)).sum();
    let polar: f64 = points.iter().map(|x| (x - middle).norm_squared()).sum();
    points.iter().zip(displacement).map(|(x, u)| u - mean - turned(x - middle) * (turn / polar)).collect()
}

fn flat(vectors: &[Vec2]) -> DVector<f64> {
    DVector::from_iterator(2 * vectors.len(), vectors.iter().flat_map(|v| [v.x, v.y]))
}

fn paired(values: &DVector<f64>) -> Vec<Vec2> {
    (0..values.len() / 2).map(|i| Vec2::new(values[2 * i], values[2 * i + 1])).collect()
}

/// Patch test: boundary tractions of a uniform stress give this stress at every node and in every element, and its
/// strain, within rounding, for every order, both planes, any polygon, graded or not.
#[test]
fn patch_test_on_any_polygon() {
    let shapes = [
        distorted(),
        polygon(&[[0.0, 0.0], [1.0, 0.0], [0.3, 0.8]]),
        polygon(&[[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]]),
        polygon(&[[0.0, 0.0], [2.0, 0.0], [2.5, 1.0], [1.0, 2.0], [-0.5, 1.0]]),
        polygon(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]),
    ];
    let stress = [1.0e5, -3.0e5, 0.7e5];
    for (shape, plane) in shapes.iter().flat_map(|s| PLANES.map(|plane| (s, plane))) {
        for (order, grading) in [(1, 1.0), (2, 1.0), (3, 1.0), (1, 5.0), (2, 5.0), (3, 5.0)] {
            let mesh = MeshDensity { elements: [3, 4], order, grading: [grading; 2] };
            let (points, forces) = on_boundary(shape, &mesh, |_| stress);
            let mut condenser = Condenser::new(plane, WIDTH);
            let found = condenser.recover(shape, &STONE.elasticity(), &mesh, &points, &forces, Vec2::zeros()).unwrap();
            for value in found.stress.iter().chain(&found.element_stress) {
                let value = [value[0], value[1], value[3]];
                assert!((0..3).all(|i| (value[i] - stress[i]).abs() < 1e-6), "{order} {plane:?}: {value:?}");
            }
            let exact = strain(plane, STONE, stress);
            let rest: Vec<_> = found.nodes.iter().zip(&found.displacement).map(|(x, u)| u - exact * x).collect();
            assert!(beyond_rigid(&found.nodes, &rest) < 1e-16, "{order} {plane:?}");
            assert!(found.imbalance.iter().all(|f| f.abs() < 1e-9));
        }
    }
}

/// Contact patch test: two blocks in running bond with meshes that do not match, each of any order and grading. Forces
/// at the points of the joint, pressure × share × area, are the consistent forces of a uniform traction on both sides.
/// Both blocks have a uniform stress, and their displacements differ by a rigid motion at every contact point, so the
/// gap is zero everywhere.
#[test]
fn contact_patch_test_across_meshes_that_do_not_match() {
    let lower = polygon(&[[0.0, 0.0], [0.4, 0.0], [0.4, 0.175], [0.0, 0.175]]);
    let upper = polygon(&[[0.13, 0.175], [0.61, 0.175], [0.55, 0.4], [0.2, 0.37]]);
    let stress = [-2.0e4, -1.0e5, 3.0e4];
    let traction = |_: Vec2, n: Vec2| Matrix2::new(stress[0], stress[2], stress[2], stress[1]) * n;
    for (order, grading) in [(1, 1.0), (2, 1.0), (3, 1.0), (2, 6.0), (3, 6.0)] {
        let meshes = [
            MeshDensity { elements: [3, 2], order, grading: [1.0; 2] },
            MeshDensity { elements: [5, 4], order, grading: [grading; 2] },
        ];
        let ends = [lower[2], upper[0]];
        let sides = [(&lower, &meshes[0]), (&upper, &meshes[1])];
        let [one, other] = sides.map(|(shape, mesh)| breaks_on_joint(shape, mesh, ends).unwrap());
        let (places, shares) = joint_points(&union_breaks(&one, &other), order);
        let contact: Vec<Vec2> = places.iter().map(|t| ends[0] * (1.0 - t) + ends[1] * *t).collect();
        let area = (ends[1] - ends[0]).norm() * WIDTH;
        let mut displacements = Vec::new();
        for (body, (shape, mesh)) in sides.into_iter().enumerate() {
            let normal = Vec2::new(0.0, if body == 0 { 1.0 } else { -1.0 });
            let mut points = contact.clone();
            let mut forces: Vec<Vec2> =
                shares.iter().map(|share| traction(Vec2::zeros(), normal) * (share * area)).collect();
            // The rest of the boundary has the same traction, with its own breaks.
            for (i, (a, b)) in edges(shape).enumerate() {
                let covered = [2, 0][body] == i;
                let place = |p: Vec2| (p - a).dot(&(b - a)) / (b - a).norm_squared();
                let free = match (covered, body) {
                    (false, _) => (a, b),
                    (true, 0) => (a + (b - a) * place(ends[1]), b),
                    (true, _) => (a + (b - a) * place(ends[0]), b),
                };
                let breaks = breaks_on_joint(shape, mesh, [free.0, free.1]).unwrap();
                let (x, f): (Vec<_>, Vec<_>) = on_edge(free.0, free.1, &breaks, traction).into_iter().unzip();
                points.extend(x);
                forces.extend(f);
            }
            let mut condenser = Condenser::new(Plane::Strain, WIDTH);
            let found = condenser.recover(shape, &STONE.elasticity(), mesh, &points, &forces, Vec2::zeros()).unwrap();
            for value in found.stress.iter().chain(&found.element_stress) {
                let value = [value[0], value[1], value[3]];
                assert!((0..3).all(|i| (value[i] - stress[i]).abs() < 1e-6), "order {order}: {value:?}");
            }
            let c = condenser.condense(shape, &STONE.elasticity(), mesh, &points).unwrap().flexibility;
            displacements.push(paired(&(c * flat(&forces))));
        }
        let gaps: Vec<Vec2> = (0..contact.len()).map(|i| displacements[1][i] - displacements[0][i]).collect();
        let rest = beyond_rigid(&contact, &gaps);
        assert!(rest < 1e-16, "order {order}: gaps {rest:.1e} m");
    }
}

/// A solution of Kolosov and Muskhelishov without body force: f = e^z, g' part = sin z. 2 G (u + i v) = κ f − z f̄' −
/// ḡ; σ_xx + σ_yy = 4 Re f'; σ_yy − σ_xx + 2 i σ_xy = 2 (z̄ f'' + g').
fn analytic(plane: Plane, x: Vec2) -> (Vec2, [f64; 3]) {
    let (g, kappa) = moduli(plane, STONE);
    let z = Complex::new(x.x, x.y);
    let e = (z * 1.5).exp();
    let (first, second) = (e * 1.5, e * 2.25);
    let u = (e * kappa - z * first.conj() - (z * 2.0).sin().conj()) / (2.0 * g);
    let (sum, rest) = (4.0 * first.re, (z.conj() * second + (z * 2.0).cos() * 2.0) * 2.0);
    (Vec2::new(u.re, u.im), [(sum - rest.re) / 2.0, (sum + rest.re) / 2.0, rest.im / 2.0])
}

/// Returns the errors of energy and displacement against the analytic solution with n × n elements.
fn errors(plane: Plane, order: usize, n: usize) -> [f64; 2] {
    let (shape, mesh) = (distorted(), density([n, n], order));
    let (points, forces) = on_boundary(&shape, &mesh, |x| analytic(plane, x).1);
    let mut condenser = Condenser::new(plane, WIDTH);
    let c = condenser.condense(&shape, &STONE.elasticity(), &mesh, &points).unwrap().flexibility;
    let f = flat(&forces);
    // The exact energy, by the divergence theorem on a fixed fine rule.
    let (fine_points, fine_forces) = on_boundary(&shape, &density([16, 16], order), |x| analytic(plane, x).1);
    let exact: f64 = fine_points.iter().zip(&fine_forces).map(|(x, f)| f.dot(&analytic(plane, *x).0)).sum();
    let energy = (exact - f.dot(&(&c * &f))).abs() / exact;
    let found = condenser.recover(&shape, &STONE.elasticity(), &mesh, &points, &forces, Vec2::zeros()).unwrap();
    let rest: Vec<_> = found.nodes.iter().zip(&found.displacement).map(|(x, u)| u - analytic(plane, *x).0).collect();
    let reference: Vec<_> = found.nodes.iter().map(|x| analytic(plane, *x).0).collect();
    let rms = |v: &[Vec2]| (v.iter().map(Vec2::norm_squared).sum::<f64>() / v.len() as f64).sqrt();
    [energy, rms(&without_rigid(&found.nodes, &rest)) / rms(&without_rigid(&found.nodes, &reference))]
}

/// Orders of convergence on a distorted block are those of theory: the error of the energy decreases as h^(2p), that of
/// the displacement as h^(p+1); the errors equal the stored values within 1 %.
#[test]
fn orders_of_convergence() {
    for plane in PLANES {
        for (order, sizes, stored) in TABLE {
            let found: Vec<[f64; 2]> = sizes.iter().map(|&n| errors(plane, *order, n)).collect();
            let last = found.len() - 1;
            let rate = |i: usize| (found[last - 1][i] / found[last][i]).log2();
            assert!(rate(0) > 2.0 * *order as f64 - 0.1, "energy, order {order}: {:.3}", rate(0));
            assert!(rate(1) > *order as f64 + 0.9, "displacement, order {order}: {:.3}", rate(1));
            if plane == Plane::Strain {
                for (found, stored) in found.iter().flatten().zip(stored.iter().flatten()) {
                    assert_close(*found, *stored, 0.01);
                }
            }
        }
    }
}

/// Errors of energy and displacement in plane strain by order and elements per side.
#[expect(clippy::type_complexity, reason = "a table")]
const TABLE: &[(usize, &[usize], &[[f64; 2]])] = &[
    (1, &[2, 4, 8, 16], &[[4.657e-2, 1.559e-1], [1.364e-2, 4.934e-2], [3.668e-3, 1.270e-2], [9.411e-4, 2.963e-3]]),
    (2, &[2, 4, 8, 16], &[[2.375e-3, 6.165e-3], [1.621e-4, 7.289e-4], [1.044e-5, 7.698e-5], [6.596e-7, 7.459e-6]]),
    (3, &[2, 4, 8], &[[2.417e-5, 3.119e-4], [3.976e-7, 1.873e-5], [6.316e-9, 9.419e-7]]),
];

/// Pure bending is exact with one element of order 1 across the depth, ten times as long as deep, also for ν → 0.5 in
/// plane strain: no locking. u = M x y / E'I, v = −M (x² + ν' y²) / 2E'I.
#[test]
fn pure_bending_is_exact_for_every_order() {
    for (plane, nu) in [(Plane::Strain, 0.49), (Plane::Strain, 0.4999), (Plane::Stress, 0.3)] {
        let material = Isotropic { poisson_ratio: nu, ..STONE };
        let (young, contraction) = match plane {
            Plane::Strain => (STONE.young_modulus / (1.0 - nu * nu), nu / (1.0 - nu)),
            Plane::Stress => (STONE.young_modulus, nu),
        };
        let shape = rectangle(20.0, 1.0);
        for order in 1..=3 {
            let mesh = density([2, 1], order);
            let stress = |x: Vec2| [1e5 * x.y, 0.0, 0.0];
            let (points, forces) = on_boundary(&shape, &mesh, stress);
            let found = Condenser::new(plane, WIDTH)
                .recover(&shape, &material.elasticity(), &mesh, &points, &forces, Vec2::zeros())
                .unwrap();
            let exact = |x: &Vec2| Vec2::new(x.x * x.y, -(x.x * x.x + contraction * x.y * x.y) / 2.0) * (1e5 / young);
            let rest: Vec<_> = found.nodes.iter().zip(&found.displacement).map(|(x, u)| u - exact(x)).collect();
            assert!(beyond_rigid(&found.nodes, &rest) < 1e-9 * 1e5 / young * 200.0, "order {order}, ν = {nu}");
        }
    }
}

/// A cantilever under an end shear, σ_xx = −P (L − x) y / I, σ_xy = P (c² − y²) / 2I (Timoshenko & Goodier, art. 21),
/// has v(0) + v(L) − 2 v(L/2) = P L³ / 8E'I on the axis. This is exact for order 3, whose elements contain the cubic
/// solution: the remaining error is rounding times the condition number of a slender body.
#[test]
fn end_shear_of_a_cantilever() {
    let (length, height, nu) = (10.0, 1.0, 0.49);
    let material = Isotropic { poisson_ratio: nu, ..STONE };
    let young = STONE.young_modulus / (1.0 - nu * nu);
    let shape = rectangle(length, height);
    let stress = |x: Vec2| [-12e5 * (length - x.x) * x.y, 0.0, 6e5 * (0.25 - x.y * x.y)];
    for (order, elements, tolerance) in
        [(1, [20, 2], 0.01), (1, [40, 4], 0.0025), (2, [10, 2], 2e-3), (3, [4, 2], 1e-9)]
    {
        let mesh = density(elements, order);
        let (mut points, mut forces) = on_boundary(&shape, &mesh, stress);
        let first = points.len();
        points.extend([0.0, 0.5, 1.0].map(|t| Vec2::new(t * length, 0.0)));
        forces.extend([Vec2::zeros(); 3]);
        let c = Condenser::new(Plane::Strain, WIDTH)
            .condense(&shape, &material.elasticity(), &mesh, &points)
            .unwrap()
            .flexibility;
        let u = paired(&(c * flat(&forces)));
        let sag = u[first].y + u[first + 2].y - 2.0 * u[first + 1].y;
        assert_close(sag, 12e5 * length.powi(3) / (8.0 * young), tolerance);
    }
}

/// Own weight needs no extra term: a column on a uniform pressure has the displacement of the closed form, u = ν ρ g x
/// (h − y) / E, v = −ρ g (h y − y²/2 − ν x²/2) / E in plane stress.
#[test]
fn own_weight_of_a_column() {
    let (length, height, gravity) = (0.6, 2.0, 9.81);
    let shape = polygon(&[[-0.3, 0.0], [0.3, 0.0], [0.3, height], [-0.3, height]]);
    for order in [2, 3] {
        let mesh = density([3, 4], order);
        let weight = STONE.density * gravity;
        let base = on_edge(shape[0], shape[1], &edge_breaks(&shape, &mesh, 0), |_, n| -n * (weight * height));
        let (mut points, mut forces): (Vec<_>, Vec<_>) = base.into_iter().unzip();
        points.extend([[0.0, 1.0], [0.1, 1.7], [0.3, 2.0], [-0.3, 0.4]].map(Vec2::from));
        forces.resize(points.len(), Vec2::zeros());
        let mut condenser = Condenser::new(Plane::Stress, WIDTH);
        let condensed = condenser.condense(&shape, &STONE.elasticity(), &mesh, &points).unwrap();
        let found = paired(&(&condensed.flexibility * flat(&forces)));
        let (nu, unit) = (STONE.poisson_ratio, weight / STONE.young_modulus);
        let exact = |x: &Vec2| {
            Vec2::new(nu * x.x * (height - x.y), -(height * x.y - x.y * x.y / 2.0) + nu * x.x * x.x / 2.0) * unit
        };
        let rest: Vec<_> = points.iter().zip(&found).map(|(x, u)| u - exact(x)).collect();
        assert!(beyond_rigid(&points, &rest) < 1e-12 * unit, "order {order}");
        let recovered =
            condenser.recover(&shape, &STONE.elasticity(), &mesh, &points, &forces, Vec2::new(0.0, -weight)).unwrap();
        for (x, stress) in recovered.nodes.iter().zip(&recovered.stress) {
            let expected = [0.0, -weight * (height - x.y), 0.0, 0.0];
            assert!((0..4).all(|i| (stress[i] - expected[i]).abs() < 1e-9 * weight), "{x:?} {stress:?}");
        }
        let total = weight * length * height * WIDTH;
        assert!(recovered.imbalance.iter().all(|f| f.abs() < 1e-12 * total), "{:?}", recovered.imbalance);
    }
}

fn some_points(shape: &[Vec2]) -> Vec<Vec2> {
    let (_, centre) = area_and_centroid(shape);
    let on_edges = edges(shape).flat_map(|(a, b)| [a, a + (b - a) * 0.37]);
    on_edges.chain([centre, centre + (shape[0] - centre) * 0.3]).collect()
}

/// C is symmetric and positive semi-definite; its displacements have no mean motion. It rotates with the body, does not
/// depend on the position, and scales with E and the width but not with the size.
#[test]
fn invariances_of_the_flexibility() {
    let shapes = [distorted(), polygon(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]])];
    for (shape, order) in shapes.iter().flat_map(|s| (1..=3).map(move |order| (s, order))) {
        let (mesh, points) = (density([3, 4], order), some_points(shape));
        let of = |shape: &[Vec2], points: &[Vec2], material: Isotropic| {
            Condenser::new(Plane::Strain, WIDTH)
                .condense(shape, &material.elasticity(), &mesh, points)
                .unwrap()
                .flexibility
        };
        let c = of(shape, &points, STONE);
        assert_eq!(c, c.transpose());
        let values = c.clone().symmetric_eigenvalues();
        assert!(values.min() > -1e-13 * values.max(), "{:?}", values.min() / values.max());
        let (angle, shift) = (1.234f64, Vec2::new(300.0, -70.0));
        let q = Matrix2::new(angle.cos(), -angle.sin(), angle.sin(), angle.cos());
        let moved = |list: &[Vec2]| list.iter().map(|x| q * x + shift).collect::<Vec<_>>();
        let turned = of(&moved(shape), &moved(&points), STONE);
        let turn = DMatrix::from_fn(c.nrows(), c.nrows(), |i, j| if i / 2 == j / 2 { q[(i % 2, j % 2)] } else { 0.0 });
        assert!((&turned - &turn * &c * turn.transpose()).amax() < 1e-11 * c.amax(), "order {order}");
        let grown = |list: &[Vec2]| list.iter().map(|x| x * 1000.0).collect::<Vec<_>>();
        let soft = Isotropic { young_modulus: 5.0, ..STONE };
        let scaled = of(&grown(shape), &grown(&points), soft) * 1e-9;
        assert!((scaled - &c).amax() < 1e-11 * c.amax(), "order {order}");
    }
}

/// The flexibility equals a dense Ritz solution of another kind: monomials in the reference coordinates of one
/// distorted element and a bordered system that enforces ∫u = 0 and ∫X×u = 0 by multipliers.
#[test]
fn flexibility_equals_a_dense_ritz_solution() {
    let shape = distorted();
    let (order, root) = (2usize, 0.6f64.sqrt());
    let rule = [(-root, 5.0 / 9.0), (0.0, 8.0 / 9.0), (root, 5.0 / 9.0)];
    let terms: Vec<(i32, i32)> = (0..9).map(|k| (k % 3, k / 3)).collect();
    let map = |[s, t]: [f64; 2]| {
        let corner = |a: f64, b: f64| (1.0 + a * s) * (1.0 + b * t) / 4.0;
        shape[0] * corner(-1.0, -1.0)
            + shape[1] * corner(1.0, -1.0)
            + shape[2] * corner(1.0, 1.0)
            + shape[3] * corner(-1.0, 1.0)
    };
    let value = |(a, b): (i32, i32), [s, t]: [f64; 2]| s.powi(a) * t.powi(b);
    let slope = |(a, b): (i32, i32), [s, t]: [f64; 2]| {
        let power = |x: f64, n: i32| if n == 0 { 0.0 } else { f64::from(n) * x.powi(n - 1) };
        [power(s, a) * t.powi(b), s.powi(a) * power(t, b)]
    };
    let (_, centre) = area_and_centroid(&shape);
    for plane in PLANES {
        let (n, (g, kappa)) = (18, moduli(plane, STONE));
        let bulk = g * (3.0 - kappa) / (kappa - 1.0);
        let mut system = DMatrix::zeros(n + 3, n + 3);
        for (s, ws) in rule {
            for (t, wt) in rule {
                let at = [s, t];
                // Central differences of a bilinear map are exact.
                let along = (map([s + 1.0, t]) - map([s - 1.0, t])) / 2.0;
                let across = (map([s, t + 1.0]) - map([s, t - 1.0])) / 2.0;
                let jacobian = Matrix2::from_columns(&[along, across]);
                let (inverse, area) = (jacobian.try_inverse().unwrap(), ws * wt * jacobian.determinant() * WIDTH);
                let gradient = |k: usize| inverse.transpose() * Vec2::from(slope(terms[k / 2], at));
                let strain = |k: usize| {
                    let mut h = Matrix2::zeros();
                    h.row_mut(k % 2).copy_from(&gradient(k).transpose());
                    (h + h.transpose()) / 2.0
                };
                for i in 0..n {
                    for j in 0..n {
                        let (a, b): (Matrix2<f64>, Matrix2<f64>) = (strain(i), strain(j));
                        system[(i, j)] += area * (2.0 * g * a.dot(&b) + bulk * a.trace() * b.trace());
                    }
                    let (x, v) = (map(at) - centre, value(terms[i / 2], at) * area * g);
                    let rigid = [[1.0, 0.0, -x.y], [0.0, 1.0, x.x]][i % 2];
                    for k in 0..3 {
                        system[(i, n + k)] += rigid[k] * v;
                        system[(n + k, i)] += rigid[k] * v;
                    }
                }
            }
        }
        let places = [[-1.0, -1.0], [0.3, -1.0], [1.0, 0.2], [1.0, 1.0], [-0.4, 1.0], [-1.0, 0.7], [0.2, -0.5]];
        let points: Vec<Vec2> = places.iter().map(|&at| map(at)).collect();
        let loads = DMatrix::from_fn(n + 3, 2 * points.len(), |i, j| {
            if i < n && i % 2 == j % 2 { value(terms[i / 2], places[j / 2]) } else { 0.0 }
        });
        let expected = loads.transpose() * system.full_piv_lu().solve(&loads).unwrap();
        let found = Condenser::new(plane, WIDTH)
            .condense(&shape, &STONE.elasticity(), &density([1, 1], order), &points)
            .unwrap()
            .flexibility;
        assert!((&found - &expected).amax() < 1e-11 * found.amax(), "{:e}", (&found - &expected).amax() / found.amax());
    }
}

/// The 13 congruent voussoirs of a segmental arch share one factorisation, for any E; another ν or another mesh needs
/// another one.
#[test]
fn congruent_voussoirs_share_one_factorisation() {
    let case = first_case(&Arch { voussoirs: 13, ends: "jointed", ..Arch::default() }.study());
    let (assembly, mesh) = (&case.assembly, case.assembly.mesh);
    assert_eq!(mesh, density([4, 6], 2));
    let mut condenser = Condenser::new(assembly.plane, assembly.width);
    for (index, body) in assembly.bodies.iter().enumerate().filter(|(_, body)| !body.vertices.is_empty()) {
        let mut points = Vec::new();
        for joint in assembly.joints.iter().filter(|joint| joint.minus == index || joint.plus == index) {
            let breaks = breaks_on_joint(&body.vertices, &mesh, joint.ends).unwrap();
            points.extend(
                joint_points(&breaks, mesh.order).0.iter().map(|t| joint.ends[0] * (1.0 - t) + joint.ends[1] * *t),
            );
        }
        assert_eq!(points.len(), 26);
        let material = Isotropic { young_modulus: 1e9 * (1.0 + index as f64), ..STONE };
        condenser.condense(&body.vertices, &material.elasticity(), &mesh, &points).unwrap();
    }
    assert_eq!(condenser.factorisations(), 1);
    let body = &assembly.bodies[1].vertices;
    condenser.condense(body, &Isotropic { poisson_ratio: 0.2, ..STONE }.elasticity(), &mesh, &[]).unwrap();
    assert_eq!(condenser.factorisations(), 2);
    condenser.condense(body, &STONE.elasticity(), &density([4, 6], 3), &[]).unwrap();
    assert_eq!(condenser.factorisations(), 3);
}

/// An invalid body gives an error with the reason and no panic.
#[test]
fn impossible_bodies_are_refused() {
    let mut condenser = Condenser::new(Plane::Strain, WIDTH);
    let (shape, mesh) = (distorted(), density([4, 6], 2));
    let mut refused = |shape: &[Vec2], material: Isotropic, mesh: &MeshDensity, points: &[Vec2], reason: &str| {
        let message = condenser.condense(shape, &material.elasticity(), mesh, points).unwrap_err();
        assert!(message.contains(reason), "{message}");
    };
    refused(&shape, STONE, &mesh, &[Vec2::new(5.0, 0.0)], "lies outside its body");
    refused(&shape, STONE, &mesh, &[Vec2::new(f64::NAN, 0.0)], "lies outside its body");
    refused(&shape[..2], STONE, &mesh, &[], "three finite vertices");
    let backwards: Vec<Vec2> = shape.iter().rev().copied().collect();
    refused(&backwards, STONE, &mesh, &[], "anticlockwise");
    refused(&shape, Isotropic { poisson_ratio: 0.5, ..STONE }, &mesh, &[], "no elastic material");
    refused(&shape, STONE, &density([4, 6], 4), &[], "order 1 to 3");
    refused(&shape, STONE, &MeshDensity { grading: [1.0, 0.5], ..mesh }, &[], "at least 1");
}
