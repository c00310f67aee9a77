//! Static condensation of a body's mesh onto the points at which forces act.
//!
//! All quantities are computed for modulus 1 and width 1 in the frame of the shape, in units of its size. In plane
//! problems the flexibility then does not depend on the size, and C = Q C̃ Qᵀ / (E width), where Q is the rotation of
//! the body and E the modulus of the material. The axes of the material are those of the shape.

use super::inelastic::{InelasticBody, Strains};
use super::shape::{Form, Placement, Response, Shape, agree, placed, spread};
use super::shared;
use super::stress::{Recovered, recovered};
use crate::law::{Elasticity, PlanarUpdate, Plane, PlaneElasticity};
use crate::model::MeshDensity;
use crate::model::geometry::Vec2;
use nalgebra::DMatrix;
use std::collections::HashMap;
use std::sync::Arc;

/// The flexibility of a body at some of its points, in world axes of its undeformed placement. Displacements are
/// relative to the mean rigid motion of the body.
#[derive(Debug, Clone)]
pub struct Condensed {
    /// The points \[m\], in the given order.
    pub points: Vec<Vec2>,
    /// C, 2m × 2m with rows and columns (x, y) per point \[m/N\]: u = C f. It is symmetric and positive semi-definite;
    /// forces that are not in equilibrium are balanced by the inertia of the body. The body force of a uniform
    /// acceleration is the inertia force of a rigid motion and adds nothing relative to the mean motion. The weight is
    /// therefore included in C f if contact forces carry it.
    pub flexibility: DMatrix<f64>,
}

/// A shape with its computed quantities.
struct Known {
    form: Form,
    shape: Option<Arc<Shape>>,
    /// Flexibilities by local points.
    condensed: Vec<(Vec<Vec2>, Arc<DMatrix<f64>>)>,
    /// Strains at the quadrature points.
    strains: Option<Arc<Strains>>,
    /// Places of points, and displacements of all nodes from forces there, by local points.
    responses: Vec<(Vec<Vec2>, Arc<Response>)>,
}

impl Known {
    /// Returns the shape, which is meshed and factorised when it is needed first.
    fn shape(&mut self) -> Result<Arc<Shape>, String> {
        match &self.shape {
            Some(shape) => Ok(shape.clone()),
            None => Ok(self.shape.insert(Arc::new(Shape::new(&self.form)?)).clone()),
        }
    }

    /// Returns C̃ of points given in the frame of the shape.
    fn flexibility(&mut self, local: Vec<Vec2>, asked: &[Vec2]) -> Result<Arc<DMatrix<f64>>, String> {
        if let Some((_, flexibility)) = self.condensed.iter().find(|(points, _)| agree(points, &local)) {
            return Ok(flexibility.clone());
        }
        let form = self.form.clone();
        let flexibility = shared::local(&form, &local, || {
            let shape = self.shape()?;
            let begins = |points: &[Vec2]| local.get(..points.len()).is_some_and(|first| agree(points, first));
            let known = self.condensed.iter().find(|(points, _)| begins(points));
            let known = known.map_or_else(|| Arc::new(DMatrix::zeros(0, 0)), |(_, known)| known.clone());
            shape.flexibility(&shape.places(&local, asked)?, &known)
        })?;
        self.condensed.push((local, flexibility.clone()));
        Ok(flexibility)
    }
}

/// Condenses bodies. Congruent shapes share one factorisation, and one flexibility if their points agree too. Shapes
/// are congruent if they are equal up to translation and rotation, with vertices in the same order and the same mesh
/// density and elasticity, except for its modulus.
pub struct Condenser {
    plane: Plane,
    width: f64,
    shapes: Vec<Known>,
    /// Indices of shapes by a rounded logarithm of their area.
    by_area: HashMap<i64, Vec<usize>>,
}

impl Condenser {
    /// Creates a condenser for bodies of this width \[m\].
    pub fn new(plane: Plane, width: f64) -> Self {
        Condenser { plane, width, shapes: Vec::new(), by_area: HashMap::new() }
    }

    /// Returns the number of different shapes: each has a mesh and its factorisation.
    pub fn factorisations(&self) -> u64 {
        self.shapes.len() as u64
    }

    /// Returns the index of a shape.
    fn shape(&mut self, form: Form) -> usize {
        let area = (form.size.ln() * 1e6).floor() as i64;
        let near = (area - 1..=area + 1).filter_map(|key| self.by_area.get(&key)).flatten();
        if let Some(&index) = near.into_iter().find(|&&index| self.shapes[index].form.is_congruent(&form)) {
            return index;
        }
        let (condensed, responses) = (Vec::new(), Vec::new());
        self.shapes.push(Known { form, shape: None, condensed, strains: None, responses });
        self.by_area.entry(area).or_default().push(self.shapes.len() - 1);
        self.shapes.len() - 1
    }

    fn prepare(
        &mut self,
        vertices: &[Vec2],
        elasticity: &Elasticity,
        mesh: &MeshDensity,
        points: &[Vec2],
        strains: bool,
    ) -> Result<(Placement, usize, Vec<Vec2>), String> {
        elasticity.check()?;
        mesh.check()?;
        if !(self.width.is_finite() && self.width > 0.0) {
            return Err(format!("a body's width is greater than 0, not {} m", self.width));
        }
        let placement = Placement::new(vertices)?;
        let (vertices, size, density, plane) = (placement.local.clone(), placement.size, *mesh, self.plane);
        let elasticity = PlaneElasticity::new(elasticity, plane);
        let of_strains = strains && mesh.order == 1;
        let shape = self.shape(Form { vertices, size, density, elasticity, plane, of_strains });
        let local = points.iter().map(|&p| placement.local(p)).collect();
        Ok((placement, shape, local))
    }

    /// Condenses the body with simple anticlockwise `vertices` \[m\] onto `points` \[m\] on or in it. An error names
    /// the fault of the body, its mesh or a point.
    pub fn condense(
        &mut self,
        vertices: &[Vec2],
        elasticity: &Elasticity,
        mesh: &MeshDensity,
        points: &[Vec2],
    ) -> Result<Condensed, String> {
        let flexibility = Arc::unwrap_or_clone(self.flexibility(vertices, elasticity, mesh, points)?);
        Ok(Condensed { points: points.to_vec(), flexibility })
    }

    /// The same, but returns only C, which is shared (see [`SharedFlexibilities`](super::SharedFlexibilities)).
    ///
    /// # Errors
    /// Names the fault of the body, its mesh or a point.
    pub fn flexibility(
        &mut self,
        vertices: &[Vec2],
        elasticity: &Elasticity,
        mesh: &MeshDensity,
        points: &[Vec2],
    ) -> Result<Arc<DMatrix<f64>>, String> {
        let (placement, index, local) = self.prepare(vertices, elasticity, mesh, points, false)?;
        let flexibility = self.shapes[index].flexibility(local, points)?;
        let (rotation, scale) = (placement.rotation, 1.0 / (elasticity.modulus * self.width));
        let turned = || placed(&flexibility, rotation, scale, true);
        Ok(shared::placed(&flexibility, (rotation, scale), turned))
    }

    /// Condenses a body whose material yields. Before yielding its flexibility is the flexibility of
    /// [`condense`](Self::condense) with the same elasticity, to the last bit for elements of order 2 and 3.
    ///
    /// # Errors
    /// Names the fault of the body, its mesh or a point.
    pub fn inelastic(
        &mut self,
        vertices: &[Vec2],
        elasticity: &Elasticity,
        update: Arc<PlanarUpdate>,
        mesh: &MeshDensity,
        points: &[Vec2],
    ) -> Result<InelasticBody, String> {
        let (placement, index, local) = self.prepare(vertices, elasticity, mesh, points, true)?;
        let (plane, width) = (self.plane, self.width);
        let known = &mut self.shapes[index];
        let shape = known.shape()?;
        let flexibility = known.flexibility(local.clone(), points)?;
        let scale = 1.0 / (elasticity.modulus * width);
        let flexibility = Arc::new(placed(&flexibility, placement.rotation, scale, true));
        let strains = known.strains.get_or_insert_with(|| Arc::new(Strains::new(&shape, plane))).clone();
        let response = known.responses.iter().find(|(points, _)| agree(points, &local));
        let response = match response.map(|(_, response)| response.clone()) {
            Some(response) => response,
            None => {
                let response = Arc::new(Response::new(&shape, shape.places(&local, points)?)?);
                known.responses.push((local, response.clone()));
                response
            }
        };
        Ok(InelasticBody::new(shape, strains, response, flexibility, placement, elasticity, update, width))
    }

    /// Returns displacements and stresses of the whole mesh from `forces` \[N\] at `points` and a uniform `body_force`
    /// \[N/m³\]. The body is in equilibrium: a remaining resultant is stored in [`Recovered::imbalance`] and balanced by
    /// inertia.
    ///
    /// # Errors
    /// Returns an error if the body, its mesh or a point is invalid, or if the numbers of points and forces differ.
    pub fn recover(
        &mut self,
        vertices: &[Vec2],
        elasticity: &Elasticity,
        mesh: &MeshDensity,
        points: &[Vec2],
        forces: &[Vec2],
        body_force: Vec2,
    ) -> Result<Recovered, String> {
        if points.len() != forces.len() {
            return Err(format!("{} forces act at {} points", forces.len(), points.len()));
        }
        let (placement, index, local) = self.prepare(vertices, elasticity, mesh, points, false)?;
        let shape = self.shapes[index].shape()?;
        let scale = 1.0 / (elasticity.modulus * self.width * placement.size);
        let to_local = placement.rotation.transpose();
        let acting: Vec<f64> = forces.iter().flat_map(|force| <[f64; 2]>::from(to_local * force * scale)).collect();
        let count = shape.mesh.nodes.len();
        let loads = DMatrix::from_vec(2 * count, 1, spread(&shape.places(&local, points)?, count, &acting));
        let weight = body_force * (placement.size.powi(2) * self.width);
        let all = shape.displacements(loads)?;
        let displacement: Vec<Vec2> =
            (0..shape.mesh.nodes.len()).map(|i| Vec2::new(all[(2 * i, 0)], all[(2 * i + 1, 0)])).collect();
        let mut imbalance = [weight.x, weight.y, 0.0];
        for (point, force) in points.iter().zip(forces) {
            crate::model::add_force(&mut imbalance, point - placement.origin, *force, 1.0);
        }
        let local = recovered(&shape.mesh, &shape.reference, &shape.elasticity, &displacement);
        Ok(local.placed(placement.origin, placement.rotation, placement.size, elasticity.modulus, imbalance))
    }
}
