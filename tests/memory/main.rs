//! Counted memory and refused memory. The allocator of this program does both, for each thread.

mod allocator;
mod failures;
mod objects;
mod surfaces;
