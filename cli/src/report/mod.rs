//! What is told of solids, for programs (JSON) and for people.

pub mod channel;
pub mod dexels;
pub mod octree;
