//! Linear programs of rigid blocks, written from blocks and joints alone: the associated limit load, and the least load
//! by enumeration of modes. They share only the ends and axes of joints with limit analysis.

mod least;
mod least_loads;
mod rigid;
mod small_paths;
