//! One piece of the path: the modes of its points, its equations and its rates.

pub mod factorisation;
pub mod point;
pub mod rates;
pub mod schur;
