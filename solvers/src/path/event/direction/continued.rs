//! The answer of a rate problem on the path.

use crate::path::event::piece::rates::Direction;
use crate::rate::proof::NoRate;

/// The continuation of the path.
pub enum Next {
    /// With λ rising or constant.
    Go(Direction),
    /// With λ falling; on a path that has risen it is proved that no rate rises.
    Falling(Direction),
    /// It is proved that no rate continues the path.
    Nothing,
    /// It is proved that no rate rises; the reason why rates with constant or falling λ are undecided.
    NoneRises(String),
    /// Undecided, with the reason.
    Lost(String),
}

/// The continuation of the path and, if it was sought and found, the proof that no rate raises the load.
pub struct Continued {
    pub next: Next,
    pub none_rises: Option<NoRate>,
    /// True if the chain of joints gave the direction.
    pub by_chain: bool,
}

impl From<Next> for Continued {
    fn from(next: Next) -> Self {
        Continued { next, none_rises: None, by_chain: false }
    }
}
