//! Counted memory and refused memory. The allocator of this program does both, for each thread.

#[path = "../../fuzz/bodies/mod.rs"]
mod bodies;

mod allocator;
mod failures;
mod objects;
mod surfaces;
