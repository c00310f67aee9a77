//! Mechanisms: which joints rotate, slide and crush in a motion, and what kind of collapse it is.

use serde::{Deserialize, Serialize};

/// What kind of collapse a mechanism is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MechanismKind {
    /// Three hinges.
    ThreeHinge,
    /// Four hinges.
    FourHinge,
    /// Five hinges.
    FiveHinge,
    /// Any other number of hinges.
    Rocking,
    /// Sliding only.
    Sliding,
    /// Crushing only.
    Crushing,
    /// Several of these together.
    Mixed,
}

/// The face of an arch on which a hinge closes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// Inner face.
    Intrados,
    /// Outer face.
    Extrados,
}

/// A joint that rotates while its blocks keep touching.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Hinge {
    /// Index of the joint.
    pub joint: usize,
    /// Names of the bodies [minus, plus].
    pub between: [String; 2],
    /// On arches, where the blocks touch.
    pub side: Option<Side>,
    /// Where the blocks touch [m].
    pub point: [f64; 2],
    /// Rotation of plus relative to minus [rad per unit of motion].
    pub rotation: f64,
}

/// A joint that slides.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Sliding {
    /// Index of the joint.
    pub joint: usize,
    /// Names of the bodies [minus, plus].
    pub between: [String; 2],
    /// Slip of plus relative to minus along t [m per unit of motion].
    pub slip: f64,
}

/// A joint of which more than half the height crushes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Crushing {
    /// Index of the joint.
    pub joint: usize,
    /// Names of the bodies [minus, plus].
    pub between: [String; 2],
    /// Crushed share of the height.
    pub share: f64,
}

/// A collapse mechanism.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Mechanism {
    /// Its kind.
    pub kind: MechanismKind,
    /// Hinges, neighbouring joints of equal side and sense counted as one.
    pub hinge_count: usize,
    /// Whether it is the only one; `null` where not known.
    pub unique: Option<bool>,
    /// Every rotating joint whose blocks touch.
    pub hinges: Vec<Hinge>,
    /// Every sliding joint.
    pub sliding: Vec<Sliding>,
    /// Every joint that crushes over more than half its height.
    pub crushing: Vec<Crushing>,
}
