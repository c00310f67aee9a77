//! The motion of one contact in a mechanism in space.

use serde::{Deserialize, Serialize};

/// A way in which a contact moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactMode {
    /// It opens about an edge or a vertex; if it crushes, about an axis inside it.
    Hinge,
    /// Its closed points slip to one side.
    Sliding,
    /// Its closed points slip about a point between them: torsion.
    Twisting,
    /// All its points open.
    Separating,
    /// More than half of its area crushes.
    Crushing,
}

/// The part of a contact that stays closed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ClosedPart {
    /// Points that are not on one line.
    Face,
    /// Points on one line.
    Edge,
    /// One point.
    Vertex,
    /// No point.
    Nothing,
}

/// The motion of a contact in space.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MovingContact {
    /// Index of the contact.
    pub joint: usize,
    /// Names of the bodies \[minus, plus\].
    pub between: [String; 2],
    /// The ways in which it moves.
    pub modes: Vec<ContactMode>,
    /// The part that stays closed.
    pub closed: ClosedPart,
    /// The ends of a closed edge, or the closed vertex \[m\]; empty otherwise.
    pub points: Vec<[f64; 3]>,
    /// Rotation of plus relative to minus \[rad per unit of motion\].
    pub rotation: [f64; 3],
    /// Slip of plus relative to minus at the mean of the closed points \[m per unit of motion\]; zero if all points open.
    pub slip: [f64; 3],
    /// Greatest opening of its points \[m per unit of motion\].
    pub opening: f64,
    /// Crushed share of its area.
    pub share: f64,
}

impl MovingContact {
    /// Returns true if it moves in this way, perhaps among others.
    pub fn has(&self, mode: ContactMode) -> bool {
        self.modes.contains(&mode)
    }
}
