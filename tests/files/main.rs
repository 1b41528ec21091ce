//! Files: the format and its specification, the formats of other programs, and hostile bytes.

#[allow(dead_code)]
#[path = "../../format_spec/make_vectors.rs"]
mod make_vectors;

mod attacks;
mod dexels;
mod format_reader;
mod format_spec;
mod hostile_bytes;
#[cfg(feature = "threemf")]
mod mesh_attributes;
mod mesh_colours;
mod mesh_write;
mod octrees;
#[cfg(feature = "scene")]
mod scene;
#[cfg(feature = "scene")]
mod scene_openscad;
#[cfg(feature = "threemf")]
mod threemf;
#[cfg(feature = "volumes")]
mod volumes;
