//! The C interface, which `include/leafless.h` declares.
//!
//! Every function has a few lines: it checks the arguments, calls the one function of the library that does
//! the work, and passes on the result. The header's preface states the rules that hold for all functions.
//! `boundary` enforces these rules. The doc blocks here become those of the header.
//!
//! # A new function
//!
//! 1. Put it into the file of its topic, with its documentation. The entries of a doc block have a fixed
//!    order; the header's preface says which of them may be left out. Mark an array of a fixed length by
//!    `/// cbindgen:ptrs-as-arrays=[…]`.
//! 2. Add a new struct or enumeration to `layout`. An enumeration that is an argument also needs
//!    `enumeration!`, and its name in `include/cbindgen.toml`.
//! 3. Add a new file to `SECTIONS` of `c_tests/generated.rs`, and to the table below.
//! 4. Run `cargo test --test c_api refused`. It calls the function with every pointer NULL and misaligned,
//!    and with every number out of range, and says what to add to `c_tests/refused.txt` and
//!    `c_tests/refused.c`.
//!    In a program in `c_tests`, compare the function's results with a known truth.
//! 5. Run `LEAFLESS_BLESS=1 cargo test --test c_api generated`, which writes the headers for C and C++ anew.
//!
//! # Files
//!
//! | file | section of the header |
//! |---|---|
//! | `version` | versions of library and interface |
//! | `status` | status codes, messages |
//! | `control` | options, cancelling, progress |
//! | `frame` | frames, intervals |
//! | `source` | sources and sinks of files |
//! | `mesh` | triangle meshes |
//! | `mesh_arrays` | triangle meshes from the host's arrays |
//! | `mesh_file` | reading mesh files, units |
//! | `mesh_simplify` | meshes with fewer triangles |
//! | `mesh_write` | writing mesh files |
//! | `polyhedron` | triangle meshes from faces with holes, shells and voids |
//! | `mesh_moments` | volume and moments of meshes, triangles that intersect |
//! | `metadata` | metadata of octrees and channels |
//! | `number` | numbers of the host for members of enumerations |
//! | `octree` | octrees: describing, statistics, metadata |
//! | `operation` | set operations for operands of every kind |
//! | `solid` | solids from meshes and octrees |
//! | `csg` | half-spaces, primitives and their expressions |
//! | `host` | solids by functions of the host |
//! | `volume` | bitmaps and arrays of samples, and solids from them |
//! | `volume_arrays` | volumes from the host's arrays |
//! | `volume_file` | volume files |
//! | `attribute` | attributes: constants, placed attributes, values and ranges |
//! | `mesh_attribute` | attributes of meshes, and attributes from the nearest point of a surface |
//! | `attribute_host` | the host's own attributes |
//! | `channel` | channels: describing, metadata |
//! | `channel_fill` | channels: filling from attributes, values at points, changes in regions |
//! | `channel_summary` | least, greatest, mean and integral of channels, their regions, materials; volumes as attributes |
//! | `octree_channels` | channels of octrees, carried to other octrees |
//! | `scene` | scenes in the language of OpenSCAD's CSG dumps |
//! | `op` | building, resolving, Booleans |
//! | `extended` | extended octrees, whose PARTIAL cells keep surfaces |
//! | `shard` | octrees in parts: building, cutting, joining, counting, and use as one solid |
//! | `contains` | queries of points and boxes |
//! | `cursor` | cursors on the nodes of an octree |
//! | `point_cursor` | cursors and tables for points |
//! | `rays` | rays: first hits, intervals, line of sight |
//! | `columns` | columns of cells along an axis, height maps |
//! | `content` | cells and volumes in regions |
//! | `voxel` | voxel records in arrays |
//! | `cells` | neighbours of cells, iterators over cells and boundary faces |
//! | `bitmap` | the cells of a box as bits |
//! | `surface` | surfaces: closed meshes of octrees and solids |
//! | `solid_boundary` | boundaries of solids that provide their surfaces: faces as polygons, kinds and numbers of surfaces |
//! | `contour` | contours: meshes of any solid, from cells of several sizes |
//! | `camera` | cameras |
//! | `layer` | layers of pictures, transfer functions |
//! | `layer_surface` | surfaces of octrees, solids and meshes in pictures, lines |
//! | `layer_section` | plane sections and voxels in pictures |
//! | `picture` | pictures, PNG files, legends |
//! | `lazy` | octrees that are split on demand |
//! | `interference`, `clearance` | solids under affine maps; overlap and distance of two solids |
//! | `distance` | distances of points from solids |
//! | `deviation` | distances of the boundaries of two solids |
//! | `bay` | bays: containers, obstacles and items |
//! | `placing` | layouts: placing, moving and checking copies of items |
//! | `layout_search` | layouts: searching placements, measuring the layout |
//! | `measure` | volume, centroid, inertia, areas of surfaces and sections, bounding boxes of solids |
//! | `mass_sum` | exact sums of measures of the cells of a frame |
//! | `tridexel` | tri-dexel models: building from solids, description, metadata |
//! | `tridexel_read` | cells, rays and intervals of tri-dexel models, statistics |
//! | `tridexel_op` | set algebra and storage formats of tri-dexel models |
//! | `tridexel_editor` | tri-dexel models that are changed in place |
//! | `tridexel_arrays` | tri-dexel models from the host's arrays |
//! | `tridexel_surface` | meshes, octrees, solids and voxels of tri-dexel models |
//! | `tridexel_file` | files of tri-dexel models |
//! | `file` | files: description, verification; files of octrees |
//! | `layout` | for tests: the layout of the structs |

#![allow(unsafe_code, non_camel_case_types)]
// The doc blocks state the duties of callers in C's terms, and the header's preface those for all functions.
#![allow(clippy::missing_safety_doc)]

mod attribute;
mod attribute_host;
mod bay;
mod bitmap;
mod boundary;
mod camera;
mod cells;
mod channel;
mod channel_fill;
mod channel_summary;
mod clearance;
mod columns;
mod contains;
mod content;
mod contour;
mod control;
mod csg;
mod cursor;
mod deviation;
mod distance;
mod extended;
mod file;
mod frame;
mod host;
mod interference;
mod layer;
mod layer_section;
mod layer_surface;
#[cfg(feature = "test")]
mod layout;
mod layout_search;
mod lazy;
mod mass_sum;
mod measure;
mod mesh;
mod mesh_arrays;
mod mesh_attribute;
mod mesh_file;
mod mesh_moments;
mod mesh_simplify;
mod mesh_write;
mod metadata;
mod number;
mod octree;
mod octree_channels;
mod op;
mod operation;
mod picture;
mod placing;
mod point_cursor;
mod polyhedron;
mod rays;
mod scene;
mod shard;
mod solid;
mod solid_boundary;
mod source;
mod status;
mod surface;
mod tridexel;
mod tridexel_arrays;
mod tridexel_editor;
mod tridexel_file;
mod tridexel_op;
mod tridexel_read;
mod tridexel_surface;
mod version;
mod volume;
mod volume_arrays;
mod volume_file;
mod voxel;

pub use attribute::*;
pub use attribute_host::*;
pub use bay::*;
pub use bitmap::*;
#[cfg(feature = "test")]
pub use boundary::leafless_test_panic;
pub use camera::*;
pub use cells::*;
pub use channel::*;
pub use channel_fill::*;
pub use channel_summary::*;
pub use clearance::*;
pub use columns::*;
pub use contains::*;
pub use content::*;
pub use contour::*;
pub use control::*;
pub use csg::*;
pub use cursor::*;
pub use deviation::*;
pub use distance::*;
pub use extended::*;
pub use file::*;
pub use frame::*;
pub use host::*;
pub use interference::*;
pub use layer::*;
pub use layer_section::*;
pub use layer_surface::*;
#[cfg(feature = "test")]
pub use layout::*;
pub use layout_search::*;
pub use lazy::*;
pub use mass_sum::*;
pub use measure::*;
pub use mesh::*;
pub use mesh_arrays::*;
pub use mesh_attribute::*;
pub use mesh_file::*;
pub use mesh_moments::*;
pub use mesh_simplify::*;
pub use mesh_write::*;
pub use octree::*;
pub use octree_channels::*;
pub use op::*;
pub use operation::*;
pub use picture::*;
pub use placing::*;
pub use point_cursor::*;
pub use polyhedron::*;
pub use rays::*;
pub use scene::*;
pub use shard::*;
pub use solid::*;
pub use solid_boundary::*;
pub use source::*;
pub use status::*;
pub use surface::*;
pub use tridexel::*;
pub use tridexel_arrays::*;
pub use tridexel_editor::*;
pub use tridexel_file::*;
pub use tridexel_op::*;
pub use tridexel_read::*;
pub use tridexel_surface::*;
pub use version::*;
pub use volume::*;
pub use volume_arrays::*;
pub use volume_file::*;
pub use voxel::*;
