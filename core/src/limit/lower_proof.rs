//! The proof of a lower bound of the load factor with non-associated flow, as data; the certificate
//! checks it.

use serde::{Deserialize, Serialize};

/// In place of a row: p·q̇ among the first factors, λ − a among the second ones.
pub const FIRST: i64 = -1;
/// In place of a row among the second factors: t − λ.
pub const LAST: i64 = -2;

/// What a proved lower bound rests on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LowerProofKind {
    /// Multipliers of products, which are stored and checked.
    Products,
    /// An exhaustive search, of which nothing is stored.
    Search,
    /// The bound is the associated load: nothing flows otherwise.
    Associated,
    /// The bound is where the stage starts: nothing better was proved.
    Start,
}

/// Who has moved an end of a bracket.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BracketWork {
    /// The local search for states: 10⁹ matrix entries swept.
    Local,
    /// The exhaustive search: 10⁹ matrix entries swept.
    Search,
    /// The interior-point program of products: its iterations.
    Products,
    /// The program of all products by splitting: 10⁹ multiplications.
    Splitting,
    /// The sequence of linear programs, which is not counted.
    Sequence,
}

/// A point of the curve along which a bracket has closed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BracketPoint {
    /// Who was at work.
    pub by: BracketWork,
    /// Its work until then, in its own unit.
    pub work: f64,
    /// The factor below which nothing is: proved until then.
    pub lower: f64,
    /// The least factor found until then, if any.
    pub found: Option<f64>,
}

/// The proof of a lower bound.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LowerProof {
    /// What it rests on.
    pub by: LowerProofKind,
    /// For products: each range begins where the one before ends.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub steps: Vec<ProductStep>,
}

impl LowerProof {
    /// A proof without data.
    pub fn by(by: LowerProofKind) -> Self {
        LowerProof { by, steps: Vec::new() }
    }
}

/// No state with a factor in the range lies below `bound`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ProductStep {
    /// \[a, t\].
    pub range: [f64; 2],
    /// β.
    pub bound: f64,
    /// Λ: first factor, then pairs of second factor and multiplier. A row is four times the index of its joint plus
    /// 0 or 1 for opening at that end, 2 or 3 for sliding with a_t > 0 or < 0; [`FIRST`] and [`LAST`] are the other
    /// factors. γ \[m/s for p·q̇ = 1 W\] and s \[N\] are in SI units.
    pub multipliers: Vec<(i64, Vec<(i64, f64)>)>,
}
