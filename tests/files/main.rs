//! Files: the format and its specification, the formats of other programs, and hostile bytes.

#[path = "../../fuzz/bodies/attributes.rs"]
mod attributes;
#[path = "../../fuzz/bodies/mod.rs"]
mod bodies;
#[path = "../../fuzz/bodies/contacts.rs"]
mod contacts;
#[path = "../../fuzz/bodies/direct.rs"]
mod direct;
#[cfg(feature = "volumes")]
#[path = "../../fuzz/bodies/volumes.rs"]
mod fuzzed_volumes;
#[path = "../../fuzz/bodies/layouts.rs"]
mod layouts;
#[allow(dead_code)]
#[path = "../../format_spec/make_vectors.rs"]
mod make_vectors;
#[path = "../../fuzz/bodies/measures.rs"]
mod measures;
#[cfg(feature = "threemf")]
#[path = "../../fuzz/bodies/packages.rs"]
mod packages;
#[path = "../../fuzz/bodies/records.rs"]
mod records;
#[cfg(feature = "scene")]
#[path = "../../fuzz/bodies/scenes.rs"]
mod scenes;
#[path = "../../fuzz/bodies/surfaces.rs"]
mod surfaces;

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
