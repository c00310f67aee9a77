//! Orthotropic blocks against closed forms.

use nalgebra::Matrix2;
use voussoir::core::elastic::{Condenser, MeshDensity, edge_breaks, joint_points};
use voussoir::core::law::{BulkMaterial, Plane};
use voussoir::core::model::geometry::Vec2;
use voussoir::laws::orthotropic_elastic::OrthotropicElastic;
use voussoir_tests::{Arch, answered, assert_close, elastic};

fn timber(axis_angle: f64) -> OrthotropicElastic {
    OrthotropicElastic {
        young_modulus_1: 12e9,
        young_modulus_2: 0.9e9,
        young_modulus_3: 0.5e9,
        shear_modulus_12: 0.7e9,
        poisson_ratio_12: 0.4,
        poisson_ratio_13: 0.3,
        poisson_ratio_23: 0.35,
        axis_angle,
        density: 500.0,
    }
}

/// A bar in plane stress, pulled at an angle to its axes, at any position, follows the closed form: strain along it by
/// the apparent modulus 1/E_θ = cos⁴θ/E_1 + (1/G_12 − 2 ν_12/E_1) sin²θ cos²θ + sin⁴θ/E_2, and its shear γ = η_xy,x σ /
/// E_x. Source: Jones (1999), Mechanics of Composite Materials, eqs. 2.97 (E_x, ν_xy and η_xy,x).
#[test]
fn a_bar_pulled_at_an_angle_to_its_axes() {
    let (width, stress, place) = (0.7, 1e6, 0.3f64);
    let turn = Matrix2::new(place.cos(), -place.sin(), place.sin(), place.cos());
    let bar: Vec<Vec2> =
        [[0.0, 0.0], [2.0, 0.0], [2.0, 0.5], [0.0, 0.5]].map(|x| turn * Vec2::from(x) + Vec2::new(3.0, -1.0)).into();
    for (degrees, order) in [0.0, 17.0, 30.0, 45.0, 90.0, 135.0].iter().flat_map(|&a| [1, 2, 3].map(|p| (a, p))) {
        let law = timber(degrees);
        let mesh = MeshDensity { elements: [3, 2], order, grading: [1.0; 2] };
        let (mut points, mut forces) = (Vec::new(), Vec::new());
        for (edge, sense) in [(1, 1.0), (3, -1.0)] {
            let (a, b) = (bar[edge], bar[(edge + 1) % 4]);
            let (places, shares) = joint_points(&edge_breaks(&bar, &mesh, edge), 4);
            for (t, share) in places.iter().zip(&shares) {
                points.push(a * (1.0 - t) + b * *t);
                forces.push(turn * Vec2::new(sense * stress * share * 0.5 * width, 0.0));
            }
        }
        let elasticity = law.elasticity().unwrap();
        let mut condenser = Condenser::new(Plane::Stress, width);
        let found = condenser.recover(&bar, &elasticity, &mesh, &points, &forces, Vec2::zeros()).unwrap();
        // Axis 1 is at θ from the bar, the bar at −θ from the axis.
        let (s, c) = degrees.to_radians().sin_cos();
        let (e_1, e_2) = (law.young_modulus_1, law.young_modulus_2);
        let (g, nu) = (law.shear_modulus_12, law.poisson_ratio_12);
        let along = c.powi(4) / e_1 + (1.0 / g - 2.0 * nu / e_1) * s * s * c * c + s.powi(4) / e_2;
        let across = -nu / e_1 * (s.powi(4) + c.powi(4)) + (1.0 / e_1 + 1.0 / e_2 - 1.0 / g) * s * s * c * c;
        let by = |one: f64, other: f64| {
            one * (2.0 / e_1 + 2.0 * nu / e_1 - 1.0 / g) - other * (2.0 / e_2 + 2.0 * nu / e_1 - 1.0 / g)
        };
        let shear = by(s * c.powi(3), s.powi(3) * c);
        let gradient = turn * Matrix2::new(along, shear / 2.0, shear / 2.0, across) * turn.transpose() * stress;
        let (x_0, u_0) = (found.nodes[0], found.displacement[0]);
        // The mean rotation of the bar is free: its antisymmetric part follows from the far corner.
        let far = found.nodes.iter().position(|x| (x - bar[2]).norm() < 1e-9).unwrap();
        let (dx, du) = (found.nodes[far] - x_0, found.displacement[far] - u_0);
        let rest = du - gradient * dx;
        let spin = (dx.x * rest.y - dx.y * rest.x) / dx.norm_squared();
        for (x, u) in found.nodes.iter().zip(&found.displacement) {
            let dx = x - x_0;
            let exact = gradient * dx + Vec2::new(-dx.y, dx.x) * spin;
            assert!((u - u_0 - exact).norm() < 1e-9 * stress * along, "{degrees} deg, order {order}");
        }
        for value in found.stress.iter().chain(&found.element_stress) {
            let [xx, yy, zz, xy] = *value;
            let local = turn.transpose() * Matrix2::new(xx, xy, xy, yy) * turn;
            let off = (local - Matrix2::new(stress, 0.0, 0.0, 0.0)).amax().max(zz.abs());
            assert!(off < 1e-8 * stress, "{degrees} deg, order {order}: {value:?}");
        }
    }
}

/// In plane strain σ_zz keeps ε_zz = 0: ε_zz = S_13 σ_1 + S_23 σ_2 + S_33 σ_zz.
#[test]
fn stress_across_in_plane_strain() {
    let law = timber(0.0);
    let mesh = MeshDensity { elements: [1, 1], order: 2, grading: [1.0; 2] };
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Vec2::from);
    let mut points = Vec::new();
    let mut forces = Vec::new();
    for (edge, force) in
        [(1, Vec2::new(3.0, 0.0)), (3, Vec2::new(-3.0, 0.0)), (0, Vec2::new(0.0, -2.0)), (2, Vec2::new(0.0, 2.0))]
    {
        let (a, b) = (square[edge], square[(edge + 1) % 4]);
        let (places, shares) = joint_points(&[0.0, 1.0], 4);
        for (t, share) in places.iter().zip(&shares) {
            points.push(a * (1.0 - t) + b * *t);
            forces.push(force * *share);
        }
    }
    let elasticity = law.elasticity().unwrap();
    let mut condenser = Condenser::new(Plane::Strain, 1.0);
    let found = condenser.recover(&square, &elasticity, &mesh, &points, &forces, Vec2::zeros()).unwrap();
    let e_3 = law.young_modulus_3;
    let expected =
        e_3 * (law.poisson_ratio_13 / law.young_modulus_1 * 3.0 + law.poisson_ratio_23 / law.young_modulus_2 * 2.0);
    for [xx, yy, zz, xy] in found.stress {
        assert!((xx - 3.0).abs() < 1e-12 && (yy - 2.0).abs() < 1e-12 && xy.abs() < 1e-12);
        assert_close(zz, expected, 1e-12);
    }
}

/// With equal moduli along all axes and G = E / (2(1 + ν)) the law is the same as `elastic`, at any angle.
#[test]
fn the_isotropic_special_case_is_elastic() {
    let factor = |material: String| {
        let result = answered(&Arch { voussoirs: 12, material, ..Arch::default() }.study());
        assert!(result.certificate.passed, "{:?}", result.certificate.failures);
        (result.solver.clone(), result.load_factor.expect("a load"))
    };
    let (solver, isotropic) = factor(elastic(5e9, 0.3));
    assert_eq!(solver, "event_path");
    for angle in [0.0, 33.0] {
        let (solver, other) = factor(format!(
            "law = \"orthotropic_elastic\"\nyoung_modulus_1 = 5e9\nyoung_modulus_2 = 5e9\nyoung_modulus_3 = 5e9\n\
             shear_modulus_12 = {:?}\npoisson_ratio_12 = 0.3\npoisson_ratio_13 = 0.3\npoisson_ratio_23 = 0.3\naxis_angle = {angle:?}",
            5e9 / 2.6
        ));
        assert_eq!(solver, "event_path");
        assert!((other / isotropic - 1.0).abs() < 1e-12, "{angle} deg: {other} {isotropic}");
    }
}
