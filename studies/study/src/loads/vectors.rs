//! Vectors of loads: two components in a plane scene, three in space.

use voussoir_core::model::geometry::Vec2;
use voussoir_core::plugin::Keys;
use voussoir_core::space::Vec3;

/// Reads the components for a plane scene and for a scene in space.
pub trait Components {
    /// Returns the components, two or three.
    fn components(&self) -> &[f64];

    /// Returns the vector in a plane scene; `None` if it has three components.
    fn plane(&self) -> Option<Vec2> {
        <[f64; 2]>::try_from(self.components()).ok().map(Vec2::from)
    }

    /// Returns the vector in space; `None` if it has two components.
    fn space(&self) -> Option<Vec3> {
        <[f64; 3]>::try_from(self.components()).ok().map(Vec3::from)
    }
}

/// Acceleration \[m/s²\].
#[derive(Debug, Clone, Copy, PartialEq, Keys)]
#[keys(untagged)]
pub enum Acceleration {
    /// In a plane scene, y upwards.
    #[key(names = ["x", "y"], unit = "m/s2")]
    Plane([f64; 2]),
    /// In space, z upwards.
    #[key(names = ["x", "y", "z"], unit = "m/s2")]
    Space([f64; 3]),
}

/// Force \[N\].
#[derive(Debug, Clone, Copy, PartialEq, Keys)]
#[keys(untagged)]
pub enum Force {
    /// In a plane scene, y upwards.
    #[key(names = ["x", "y"], unit = "N")]
    Plane([f64; 2]),
    /// In space, z upwards.
    #[key(names = ["x", "y", "z"], unit = "N")]
    Space([f64; 3]),
}

/// Point or displacement \[m\].
#[derive(Debug, Clone, Copy, PartialEq, Keys)]
#[keys(untagged)]
pub enum Place {
    /// In a plane scene.
    #[key(names = ["x", "y"], unit = "m")]
    Plane([f64; 2]),
    /// In space.
    #[key(names = ["x", "y", "z"], unit = "m")]
    Space([f64; 3]),
}

macro_rules! components {
    ($($vector:ty),*) => {
        $(impl Components for $vector {
            fn components(&self) -> &[f64] {
                match self {
                    Self::Plane(components) => components,
                    Self::Space(components) => components,
                }
            }
        })*
    };
}

components!(Acceleration, Force, Place);
