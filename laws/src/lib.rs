//! Interface laws and bulk materials, one file each; file = tag.
#![forbid(unsafe_code)]

mod parameters;

pub mod coulomb;
pub mod coulomb_associated;
pub mod elastic;
pub mod mohr_coulomb;
pub mod rigid;
pub mod unilateral;
