//! The range of numbers that a certificate accepts. Beyond it products overflow, and a comparison with NaN proves nothing.

use super::limit::Claim;

/// Greatest size of a force, velocity or coordinate of a claim: a product of three is still finite.
pub const GREATEST_NUMBER: f64 = 1e100;

/// Returns true if a number is finite and at most [`GREATEST_NUMBER`] in size.
pub fn in_range(number: f64) -> bool {
    number.abs() <= GREATEST_NUMBER
}

impl Claim<'_> {
    /// Returns true if all forces and velocities are in range.
    pub(super) fn in_range(&self) -> bool {
        let own = self.non_associated.and_then(|own| own.associated_motion);
        let beside = [self.start_field, self.non_associated.and_then(|own| own.associated_field)];
        let beside = beside.map(|beside| beside.map(|(field, _)| field));
        let forces = [self.field, self.ray].into_iter().chain(beside).flatten().flatten();
        let motions = [self.motion, own].into_iter().flatten().flatten();
        forces.flat_map(|contact| contact.force.iter().chain(contact.point.iter())).all(|x| in_range(*x))
            && [self.factor.unwrap_or(0.0), self.field_factor].iter().all(|x| in_range(*x))
            && motions.flatten().chain(self.fill).all(|x| in_range(*x))
    }
}
