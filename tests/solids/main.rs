//! Solids: half-spaces and expressions of them, transforms, volumes, and shapes of a host program.

mod csg;
mod enclosure;
mod host;
mod host_enclosure;
mod metaball;
mod moments;
mod transform;
mod volume;
