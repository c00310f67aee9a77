//! Tests of profiles and their rings.

use super::*;
use voussoir_core::model::geometry::cross;

fn profiles() -> Vec<Profile> {
    vec![
        Profile::Segmental { span: 9.42, rise: 2.99 },
        Profile::Segmental { span: 2.0, rise: 1.0 },
        Profile::Segmental { span: 2.0, rise: 1.7 },
        Profile::Elliptical { span: 8.0, rise: 1.5 },
        Profile::Elliptical { span: 3.0, rise: 4.0 },
        Profile::Parabolic { span: 6.0, rise: 2.0 },
        Profile::Parabolic { span: 6.0, rise: 0.01 },
        Profile::Catenary { span: 6.0, rise: 2.0 },
        Profile::Catenary { span: 2.0, rise: 9.0 },
        Profile::Pointed { span: 4.0, rise: 3.0 },
        Profile::Pointed { span: 4.0, rise: 2.0 },
        Profile::ThreeCentred { span: 10.0, rise: 3.0, crown_radius: 8.0 },
    ]
}

fn ring(profile: &Profile, voussoirs: usize) -> Ring {
    profile.ring(Some(0.3.into()), Some(voussoirs), None).unwrap()
}

#[test]
fn segmental_vertices_lie_on_both_circles_at_equal_angles() {
    for (span, rise) in [(9.42_f64, 2.99_f64), (2.0, 1.0), (2.0, 1.7)] {
        let ring = ring(&Profile::Segmental { span, rise }, 15);
        let radius = (span * span / 4.0 + rise * rise) / (2.0 * rise);
        let centre = Vec2::new(0.0, rise - radius);
        let half = 2.0 * (2.0 * rise / span).atan();
        for k in 0..=15 {
            let angle = half * (2.0 * k as f64 / 15.0 - 1.0);
            for (point, r) in [(ring.intrados[k], radius), (ring.extrados[k], radius + 0.3)] {
                assert!((point - centre - Vec2::new(angle.sin(), angle.cos()) * r).norm() < 4e-15 * r, "{k}");
            }
        }
    }
}

#[test]
fn more_rise_than_half_the_span_is_more_than_a_half_circle() {
    let ring = ring(&Profile::Segmental { span: 2.0, rise: 1.7 }, 20);
    let widest = ring.intrados.iter().fold(0.0, |w: f64, p| w.max(p.x));
    assert!(widest > 1.1 && ring.extrados[0].y < 0.0);
    assert_eq!((ring.intrados[20], ring.rise), (Vec2::new(1.0, 0.0), 1.7));
}

/// y of the intrados at x ≥ 0 from its textbook equation, upper branch.
fn height(profile: &Profile, x: f64) -> f64 {
    match *profile {
        Profile::Elliptical { span, rise } => rise * (1.0 - 4.0 * x * x / (span * span)).max(0.0).sqrt(),
        Profile::Parabolic { span, rise } => rise * (1.0 - 4.0 * x * x / (span * span)),
        Profile::Catenary { span, rise } => {
            let (mut low, mut high) = (1e-3, 1e4);
            for _ in 0..200 {
                let c: f64 = (low + high) / 2.0;
                if c * ((span / (2.0 * c)).cosh() - 1.0) > rise { low = c } else { high = c }
            }
            rise - low * ((x / low).cosh() - 1.0)
        }
        Profile::Pointed { span, rise } => {
            let radius = (rise * rise + span * span / 4.0) / span;
            (radius * radius - (x - span / 2.0 + radius).powi(2)).max(0.0).sqrt()
        }
        Profile::ThreeCentred { span, rise, crown_radius: big } => {
            let small = (2.0 * big * rise - rise * rise - span * span / 4.0) / (2.0 * big - span);
            let centre = span / 2.0 - small;
            let contact = centre * big / (big - small);
            if x < contact {
                rise - big + (big * big - x * x).sqrt()
            } else {
                (small * small - (x - centre).powi(2)).max(0.0).sqrt()
            }
        }
        _ => unreachable!(),
    }
}

#[test]
fn joints_lie_on_the_curve_at_equal_arc_length_of_an_independent_fine_polyline() {
    for profile in profiles().into_iter().filter(|p| !matches!(p, Profile::Segmental { .. })) {
        let (n, steps) = (12, 20_000);
        let ring = ring(&profile, n);
        let half = ring.span / 2.0;
        // x = half sin t gives many points near the vertical part of the curve.
        let point = |i: usize| {
            let x = half * (std::f64::consts::FRAC_PI_2 * i as f64 / steps as f64).sin();
            Vec2::new(x, height(&profile, x))
        };
        let mut lengths = vec![0.0];
        for i in 0..steps {
            lengths.push(lengths[i] + (point(i + 1) - point(i)).norm());
        }
        for k in n / 2..=n {
            let vertex = ring.intrados[k];
            assert!((vertex.y - height(&profile, vertex.x)).abs() < 1e-7, "{profile:?} {k}");
            let place = (vertex.x / half).min(1.0).asin() / std::f64::consts::FRAC_PI_2 * steps as f64;
            let index = (place.floor() as usize).min(steps - 1);
            let length = lengths[index] + (place - index as f64) * (lengths[index + 1] - lengths[index]);
            let share = (2 * k - n) as f64 / n as f64;
            assert!((length / lengths[steps] - share).abs() < 1e-7, "{profile:?} joint {k}: {length}");
        }
    }
}

#[test]
fn joints_are_perpendicular_to_the_curve_and_as_long_as_the_ring_is_thick() {
    for profile in profiles() {
        let fine = ring(&profile, 12_000);
        for k in (500..12_000).step_by(500).filter(|&k| k != 6000) {
            let tangent = (fine.intrados[k + 1] - fine.intrados[k - 1]).normalize();
            let joint = fine.extrados[k] - fine.intrados[k];
            assert!((joint.norm() - 0.3).abs() < 1e-14, "{profile:?}");
            assert!(tangent.dot(&joint).abs() < 1e-6 && cross(tangent, joint) > 0.0, "{profile:?} {k}");
        }
    }
}

#[test]
fn rings_are_exact_mirror_images_with_the_crown_at_zero() {
    for profile in profiles() {
        for n in
            [1, 2, 7, 10, 33].into_iter().filter(|&n| n > 2 || profile.ring(Some(0.3.into()), Some(n), None).is_ok())
        {
            let ring = ring(&profile, n);
            for points in [&ring.intrados, &ring.extrados] {
                for k in 0..=n {
                    assert_eq!((points[k].x, points[k].y), (-points[n - k].x, points[n - k].y));
                }
            }
            assert_eq!(ring.intrados[n], Vec2::new(ring.span / 2.0, 0.0));
        }
    }
}

#[test]
fn a_springing_at_the_radial_angle_reproduces_the_default() {
    for profile in profiles() {
        let default = ring(&profile, 16);
        let joint = default.extrados[16] - default.intrados[16];
        let degrees = joint.y.atan2(joint.x).to_degrees();
        for springing in [Springing::Both(degrees), Springing::Each([degrees, degrees])] {
            let moved = profile.ring(Some(0.3.into()), Some(16), Some(springing)).unwrap();
            for (a, b) in default.extrados.iter().zip(&moved.extrados) {
                assert!((a - b).norm() < 1e-14 * default.span.max(default.rise), "{profile:?} {a} {b}");
            }
        }
    }
}

#[test]
fn a_springing_puts_the_end_vertex_on_the_plane_and_on_the_extrados_circle() {
    let (span, rise) = (9.42, 2.99);
    let radius: f64 = (span * span / 4.0 + rise * rise) / (2.0 * rise);
    let ring =
        Profile::Segmental { span, rise }.ring(Some(0.6.into()), Some(15), Some(Springing::Each([0.0, 60.0]))).unwrap();
    let centre = Vec2::new(0.0, rise - radius);
    let (left, right) = (ring.extrados[0], ring.extrados[15]);
    assert_eq!(left.y, 0.0);
    for end in [left, right] {
        assert!(((end - centre).norm() - radius - 0.6).abs() < 1e-14);
    }
    let plane = right - ring.intrados[15];
    assert!((plane.y / plane.x - 60.0_f64.to_radians().tan()).abs() < 1e-13);
}

fn path(profile: Profile, springing: Option<Springing>) -> String {
    profile.ring(Some(0.3.into()), Some(60), springing).unwrap_err()[0].path.clone()
}

#[test]
fn impossible_profiles_are_refused_at_their_key() {
    assert_eq!(path(Profile::Segmental { span: 2.0, rise: 0.0 }, None), "profile.rise");
    assert_eq!(path(Profile::Segmental { span: f64::NAN, rise: 1.0 }, None), "profile.span");
    assert_eq!(path(Profile::Pointed { span: 4.0, rise: 1.9 }, None), "profile.rise");
    for crown_radius in [5.0, 5.6, -1.0] {
        assert_eq!(path(Profile::ThreeCentred { span: 10.0, rise: 3.0, crown_radius }, None), "profile.crown_radius");
    }
    assert_eq!(path(Profile::ThreeCentred { span: 4.0, rise: 3.0, crown_radius: 8.0 }, None), "profile.rise");
    let points = |extrados: &[[f64; 2]]| Profile::Points {
        intrados: vec![[0.0, 0.0], [1.0, 0.0]],
        extrados: extrados.to_vec(),
        file: None,
    };
    let only = |profile: Profile| profile.ring(None, None, None);
    assert_eq!(only(points(&[[0.0, 1.0]])).unwrap_err()[0].path, "profile.extrados");
    assert_eq!(only(points(&[[1.0, 1.0], [0.0, 1.0]])).unwrap_err()[0].path, "profile.intrados.0");
    assert!(only(points(&[[0.0, 1.0], [1.0, 1.0]])).is_ok());
    assert_eq!(points(&[[0.0, 1.0], [1.0, 1.0]]).ring(None, Some(2), None).unwrap_err()[0].path, "voussoirs");
}

#[test]
fn impossible_springings_are_refused() {
    let flat = Profile::Segmental { span: 9.42, rise: 2.99 };
    assert_eq!(path(flat.clone(), Some(Springing::Both(89.0))), "springing");
    assert_eq!(path(flat.clone(), Some(Springing::Each([20.0, 89.0]))), "springing.1");
    assert_eq!(path(flat, Some(Springing::Both(120.0))), "springing");
    // A plane that is steeper than the legs of the arch would make the voussoir below it concave.
    assert_eq!(path(Profile::Parabolic { span: 4.0, rise: 1.0 }, Some(Springing::Both(-89.0))), "springing");
}

#[test]
fn a_fine_segmental_ring_tends_to_the_annulus_sector() {
    let (span, rise, t) = (9.42_f64, 2.99_f64, 0.6);
    let radius = (span * span / 4.0 + rise * rise) / (2.0 * rise);
    let sector = 2.0 * (2.0 * rise / span).atan() * ((radius + t).powi(2) - radius * radius);
    let error = |n: usize| {
        let ring = Profile::Segmental { span, rise }.ring(Some(t.into()), Some(n), None).unwrap();
        let area: f64 = (0..n).map(|k| area_and_centroid(&ring.voussoir(k)).0).sum();
        (area / sector - 1.0).abs()
    };
    assert!(error(2000) < 1e-6);
    assert!((error(100) / error(200) - 4.0).abs() < 0.01);
}
