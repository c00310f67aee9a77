//! The thrust line of an arch from its contact forces.

use voussoir_core::certificate::ContactForce;
use voussoir_core::model::Assembly;
use voussoir_core::model::geometry::Vec2;

/// Returns the point at which the resultant crosses each joint of an arch.
pub fn thrust_line(assembly: &Assembly, field: &[ContactForce]) -> Option<Vec<Option<[f64; 2]>>> {
    assembly.arch.as_ref()?;
    let largest = field.iter().map(|c| c.force[0].abs()).fold(0.0, f64::max);
    let mut sums = vec![(0.0, Vec2::zeros()); assembly.joints.len()];
    for contact in field {
        sums[contact.joint].0 += contact.force[0];
        sums[contact.joint].1 += contact.point * contact.force[0];
    }
    Some(sums.into_iter().map(|(n, moment)| (n > 1e-12 * largest).then(|| (moment / n).into())).collect())
}
