//! Linear programs of rigid blocks, written from blocks and joints alone: the associated limit load, and the least load by
//! enumeration of modes. Nothing is shared with limit analysis but the ends and axes of joints.

mod least;
mod least_loads;
mod rigid;
mod small_paths;
