//! Interface laws and bulk materials, one file each; file = tag.
#![forbid(unsafe_code)]

mod damage;
mod meridian;
mod principal;
mod shared;

pub mod backing;
pub mod barton_bandis;
pub mod cohesive;
pub mod coulomb;
pub mod coulomb_associated;
pub mod coulomb_directional;
pub mod coulomb_wearing;
pub mod creeping_mortar;
pub mod damage_plasticity;
pub mod drucker_prager_cap;
pub mod drucker_prager_softening;
pub mod elastic;
pub mod fill_pressure;
pub mod lourenco_rots;
pub mod mazars_damage;
pub mod mohr_coulomb;
pub mod mohr_coulomb_solid;
pub mod orthotropic_elastic;
pub mod rankine;
pub mod rigid;
pub mod strength_envelope;
pub mod unilateral;
pub mod uplift_joint;
