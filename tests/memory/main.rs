//! Memory that is counted, and memory that is refused. The allocator of this program does both, thread by
//! thread.

#[path = "../../fuzz/bodies/mod.rs"]
mod bodies;
#[path = "../common/mod.rs"]
mod common;
#[path = "../common/zip.rs"]
mod zip;

mod allocator;
mod failures;
mod objects;
mod surfaces;
