//! Elastic voussoirs in a chain, from event to event at a cost that hardly grows with their number.
//!
//! The joints of a chain stand in a binary tree. A node is a joint with all that lies on both sides of it condensed, up to
//! the next joints outside ([`node`]): what it hands on is how the gaps there answer the forces there, the redundants and
//! the load. A point that changes its mode changes one direction of one joint, which is a change of rank one of each node
//! above it ([`tree`]), log₂ of the number of joints; the cycles close at the root.
//!
//! Rates are found on the way down, to the joints that are asked for. Which are is said by bounds ([`quiet`]): each joint
//! that was examined has room in which its rates may change while nothing happens before some arc of the load, and what
//! changes outside a node uses up a share of that room which dies away with distance, but for what the redundants do.
//! What happened meanwhile waits at the nodes and is handed down where somebody looks ([`state`]).
//!
//! For associated flow, whose equations are symmetric; all else goes on by [`elastic_chain`](super::elastic_chain).

mod examine;
mod node;
mod quiet;
mod run;
mod state;
mod tree;

pub use run::by_joint_tree;
