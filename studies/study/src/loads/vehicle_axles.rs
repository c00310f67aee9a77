//! `[vehicles.NAME]`: axles that move together.

use voussoir_core::plugin::Keys;

/// An axle.
#[derive(Debug, Clone, Copy, PartialEq, Keys)]
pub struct Axle {
    /// distance of the axle from the vehicle's origin
    #[key(unit = "m")]
    pub at: f64,
    /// force of the axle, downwards
    #[key(unit = "N")]
    pub force: f64,
    /// width of the loaded area, across the road
    #[key(unit = "m", range = "> 0", optional = "the whole width")]
    pub wheel_width: Option<f64>,
    /// length of the loaded area, along the road
    #[key(unit = "m", range = ">= 0", default = 0.0)]
    pub length: f64,
    /// factor of the axle's force
    #[key(unit = "-", range = ">= 0", default = 1.0)]
    pub lift_off: f64,
}

/// A vehicle.
#[derive(Debug, Clone, PartialEq, Keys)]
pub struct VehicleAxles {
    /// its axles, which move together
    #[key(len = ">= 1, <= 1000")]
    pub axles: Vec<Axle>,
}

/// Axles this near to the mirror images of others are those \[m\].
const SAME: f64 = 1e-9;

impl VehicleAxles {
    /// The place about which the vehicle is symmetric; `None` if it is not.
    pub fn centre_of_symmetry(&self) -> Option<f64> {
        let mut axles = self.axles.clone();
        axles.sort_by(|a, b| a.at.total_cmp(&b.at));
        let centre = (axles.first()?.at + axles.last()?.at) / 2.0;
        let mirrored = |(a, b): (&Axle, &Axle)| {
            let alike = Axle { at: b.at, ..*a } == *b;
            alike && (a.at + b.at - 2.0 * centre).abs() <= SAME
        };
        axles.iter().zip(axles.iter().rev()).all(mirrored).then_some(centre)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn symmetry_is_of_places_and_forces() {
        let axle = |at: f64, force: f64| Axle { at, force, wheel_width: None, length: 0.3, lift_off: 1.0 };
        let centre = |axles: &[Axle]| VehicleAxles { axles: axles.to_vec() }.centre_of_symmetry();
        assert_eq!(centre(&[axle(1.8, 1.0), axle(0.0, 1.0)]), Some(0.9));
        assert_eq!(centre(&[axle(-2.0, 1.0), axle(0.0, 3.0), axle(2.0, 1.0)]), Some(0.0));
        assert_eq!(centre(&[axle(0.0, 1.0), axle(1.8, 1.1)]), None);
        assert_eq!(centre(&[axle(0.0, 1.0), axle(1.0, 1.0), axle(3.0, 1.0)]), None);
        assert_eq!(centre(&[]), None);
    }
}
