//! Files for ParaView of scenes in space: the blocks with the velocities of a mechanism, and the forces of contacts.

use super::vtu_text::{array, head, tail};
use voussoir_core::space::{SpaceAssembly, SpaceBody, Vec3, velocity_at};
use voussoir_study::results::{CaseResult, SpaceProof};
use voussoir_study::study::SpaceCase;

fn three(vector: &Vec3) -> String {
    format!("{:e} {:e} {:e}", vector.x, vector.y, vector.z)
}

/// Creates the file of the blocks: one cell for each face, with the velocity of the mechanism at its corners.
pub(super) fn blocks_text(space: &SpaceCase, case: &CaseResult) -> String {
    let bodies = &space.assembly.bodies;
    let points: usize = bodies.iter().map(|body| body.shape.vertices.len()).sum();
    let cells: usize = bodies.iter().map(|body| body.shape.faces.len()).sum();
    let mut text = head(points, cells);
    array(&mut text, "Points", "Float64", 3, bodies.iter().flat_map(|body| body.shape.vertices.iter().map(three)));
    text.push_str("      </Points>\n      <Cells>\n");
    let (mut first, mut end) = (0, 0);
    let (mut connectivity, mut offsets) = (Vec::new(), Vec::new());
    for body in bodies {
        for face in &body.shape.faces {
            let corners: Vec<String> = face.iter().map(|corner| (corner + first).to_string()).collect();
            connectivity.push(corners.join(" "));
            end += face.len();
            offsets.push(end.to_string());
        }
        first += body.shape.vertices.len();
    }
    array(&mut text, "connectivity", "Int64", 1, connectivity.into_iter());
    array(&mut text, "offsets", "Int64", 1, offsets.into_iter());
    // VTK_POLYGON.
    array(&mut text, "types", "UInt8", 1, (0..cells).map(|_| "7".into()));
    text.push_str("      </Cells>\n      <PointData Vectors=\"velocity [m per unit of motion]\">\n");
    let velocities = velocities(&space.assembly, case.proof.space.as_deref());
    array(&mut text, "velocity [m per unit of motion]", "Float64", 3, velocities.iter().map(three));
    text.push_str("      </PointData>\n      <CellData>\n");
    let of_cells = |value: &dyn Fn(usize) -> usize| -> Vec<String> {
        let each = bodies.iter().enumerate();
        each.flat_map(|(index, body)| std::iter::repeat_n(value(index).to_string(), body.shape.faces.len())).collect()
    };
    array(&mut text, "block", "Int64", 1, of_cells(&|index| index).into_iter());
    array(&mut text, "fixed", "UInt8", 1, of_cells(&|index| usize::from(bodies[index].fixed)).into_iter());
    text + "      </CellData>\n" + tail()
}

/// Returns the velocity of every corner of every block; zero without a mechanism.
fn velocities(assembly: &SpaceAssembly, proof: Option<&SpaceProof>) -> Vec<Vec3> {
    let motion = proof.and_then(|proof| proof.motion.as_deref()).unwrap_or_default();
    let of_body = |(index, body): (usize, &SpaceBody)| {
        let velocity = motion.get(index).map_or([0.0; 6], |entry| entry.velocity);
        let centroid = assembly.centroid(index);
        let at = move |point: &Vec3| velocity_at(&velocity, &(point - centroid));
        body.shape.vertices.iter().map(at).collect::<Vec<Vec3>>()
    };
    assembly.bodies.iter().enumerate().flat_map(of_body).collect()
}

/// Creates the file of the forces at the points of contacts, in the axes of the scene. `None` without forces.
pub(super) fn forces_text(space: &SpaceCase, case: &CaseResult) -> Option<String> {
    let field = case.proof.space.as_ref()?.field.as_ref()?;
    let count = field.len();
    let mut text = head(count, count);
    array(&mut text, "Points", "Float64", 3, field.iter().map(|entry| three(&Vec3::from(entry.point))));
    text.push_str("      </Points>\n      <Cells>\n");
    array(&mut text, "connectivity", "Int64", 1, (0..count).map(|i| i.to_string()));
    array(&mut text, "offsets", "Int64", 1, (1..=count).map(|i| i.to_string()));
    // VTK_VERTEX.
    array(&mut text, "types", "UInt8", 1, (0..count).map(|_| "1".into()));
    text.push_str("      </Cells>\n      <PointData Vectors=\"force on the plus block [N]\">\n");
    let force = |entry: &voussoir_study::results::SpaceFieldEntry| {
        let contact = &space.assembly.contacts[entry.joint];
        let [n, s, t] = entry.force;
        three(&(contact.normal * n + contact.tangents[0] * s + contact.tangents[1] * t))
    };
    array(&mut text, "force on the plus block [N]", "Float64", 3, field.iter().map(force));
    array(&mut text, "contact", "Int64", 1, field.iter().map(|entry| entry.joint.to_string()));
    Some(text + "      </PointData>\n" + tail())
}
