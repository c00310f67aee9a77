//! Placeholder of the elastic blocks; replaced by the real ones.
use crate::assembly::Plane;
use crate::geometry::Vec2;
use nalgebra::DMatrix;

/// How bodies are meshed.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshDensity {
    /// Along, across.
    pub elements: [usize; 2],
    /// Order.
    pub order: usize,
    /// Grading.
    pub grading: f64,
}
/// Material.
#[derive(Debug, Clone, Copy)]
pub struct IsotropicElastic {
    /// E.
    pub young_modulus: f64,
    /// ν.
    pub poisson_ratio: f64,
    /// ρ.
    pub density: f64,
}
/// Flexibility.
pub struct Condensed {
    /// Points.
    pub points: Vec<Vec2>,
    /// C.
    pub flexibility: DMatrix<f64>,
    /// From acceleration.
    pub gravity: DMatrix<f64>,
}
/// Condenser.
pub struct Condenser {}
impl Condenser {
    /// New.
    pub fn new(_plane: Plane, _width: f64) -> Self {
        Condenser {}
    }
    /// Condense.
    pub fn condense(
        &mut self,
        _v: &[Vec2],
        _m: IsotropicElastic,
        _mesh: &MeshDensity,
        _points: &[Vec2],
    ) -> Result<Condensed, String> {
        Err("no elastic blocks yet".into())
    }
    /// Count.
    pub fn factorisations(&self) -> u64 {
        0
    }
}
/// Element boundaries along an edge.
pub fn edge_breaks(_v: &[Vec2], density: &MeshDensity, _edge: usize) -> Vec<f64> {
    let n = density.elements[1];
    (0..=n).map(|i| i as f64 / n as f64).collect()
}
/// Points and weights.
pub fn joint_points(breaks: &[f64], _order: usize) -> (Vec<f64>, Vec<f64>) {
    let (mut p, mut w) = (vec![breaks[0]], vec![0.0]);
    for s in breaks.windows(2) {
        let h = s[1] - s[0];
        *w.last_mut().unwrap() += h / 6.0;
        p.push((s[0] + s[1]) / 2.0);
        w.push(h * 4.0 / 6.0);
        p.push(s[1]);
        w.push(h / 6.0);
    }
    (p, w)
}

impl Default for MeshDensity {
    fn default() -> Self {
        MeshDensity { elements: [4, 6], order: 2, grading: 1.0 }
    }
}
