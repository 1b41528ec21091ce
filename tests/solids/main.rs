//! Solids: half-spaces and expressions of them, transforms, volumes, and shapes of a host program.

#[path = "../../fuzz/bodies/csg.rs"]
mod any_bytes;
#[path = "../common/mod.rs"]
mod common;

mod csg;
mod enclosure;
mod host;
mod host_enclosure;
mod metaball;
mod moments;
mod transform;
mod volume;

// The path at which the body of the fuzz target expects the model.
use csg::{model, random};
