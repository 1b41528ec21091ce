//! Reports of solids and of their sources, for programs (JSON) and for people.

pub mod bounds;
pub mod channel;
pub mod cuts;
pub mod dexels;
pub mod fitness;
pub mod layout;
pub mod mesh;
pub mod octree;
pub mod scene;
pub mod volume;
