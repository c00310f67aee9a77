//! The proof of a lower bound of the load factor with non-associated flow, stored as data. The certificate checks it.

use serde::{Deserialize, Serialize};

/// Used instead of a row index: p·q̇ among the first factors, λ − a among the second factors.
pub const FIRST: i64 = -1;
/// Used instead of a row index among the second factors: t − λ.
pub const LAST: i64 = -2;

/// The kind of proof of a lower bound.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LowerProofKind {
    /// Multipliers of products; they are stored and checked.
    Products,
    /// An exhaustive search; it leaves no data to check.
    Search,
    /// The bound is the associated collapse load, because all laws have associated flow.
    Associated,
    /// The bound is the factor at which the stage starts, because no better bound was proved.
    Start,
}

/// The algorithm that improved an end of a bracket, with the unit of its work.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BracketWork {
    /// The local search for states; work in 10⁹ matrix entries swept.
    Local,
    /// The exhaustive search; work in 10⁹ matrix entries swept.
    Search,
    /// The interior-point program of products; work in iterations.
    Products,
    /// The program of all products, solved by operator splitting; work in 10⁹ multiplications.
    Splitting,
    /// The sequence of linear programs; its work is not counted.
    Sequence,
}

/// A point of the curve that shows how the bracket became narrower.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BracketPoint {
    /// The algorithm.
    pub by: BracketWork,
    /// Its work up to this point, in its own unit.
    pub work: f64,
    /// The lower bound proved up to this point.
    pub lower: f64,
    /// The least factor found up to this point, if any.
    pub found: Option<f64>,
}

/// The proof of a lower bound.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LowerProof {
    /// The kind of proof.
    pub by: LowerProofKind,
    /// Steps of a proof by products: each range begins at the end of the one before.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub steps: Vec<ProductStep>,
}

impl LowerProof {
    /// Creates a proof without data.
    pub fn by(by: LowerProofKind) -> Self {
        LowerProof { by, steps: Vec::new() }
    }
}

/// The statement that no state with a factor in the range lies below `bound`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ProductStep {
    /// Range \[a, t\] of the factor.
    pub range: [f64; 2],
    /// The bound β.
    pub bound: f64,
    /// Multipliers Λ: first factor, then pairs of second factor and multiplier. The number of a row is four times the
    /// index of its joint, plus 0 or 1 for opening at that end, 2 or 3 for sliding with a_t > 0 or < 0; [`FIRST`] and
    /// [`LAST`] are the other factors. γ \[m/s for p·q̇ = 1 W\] and s \[N\] are in SI units.
    pub multipliers: Vec<(i64, Vec<(i64, f64)>)>,
}
