//! Solids: half-spaces and expressions of them, transforms, volumes, and shapes of a host program.

#[path = "../../fuzz/bodies/csg.rs"]
mod any_bytes;

mod csg;
mod enclosure;
mod host;
mod host_enclosure;
mod metaball;
mod moments;
mod transform;
mod volume;
