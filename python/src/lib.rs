//! The Python interface of Leafless. A class or a function of Python is some lines here: it takes Python's
//! values, asks the library with the interpreter released, and hands back what was found. What is easier said
//! in Python is in `package/leafless`.
//!
//! From the bottom up: `error`, `work` (long work that can be watched and interrupted), `words` (what
//! enumerations are called), `arguments` (what functions take), `arrays`, `interval`, `frame` and `affine`
//! are what values are taken from; `solid` is the class of all that has a shape, and `ask` what is asked of
//! it on which frame; `csg`, `mesh`, `octree` and the others are its kinds; `measures`, `pairs`, `surface`
//! and `picture` are questions; `files` reads and writes, and `note` is what a volume adds to its file.

mod affine;
mod anywhere;
mod arguments;
mod arrays;
mod ask;
mod channel;
mod csg;
mod dexels;
mod error;
mod files;
mod frame;
mod interval;
mod lazy;
mod measures;
mod mesh;
mod note;
mod octree;
mod operators;
mod pairs;
mod picture;
mod shape;
mod shards;
mod solid;
mod surface;
mod volume;
mod voxels;
mod words;
mod work;

use pyo3::prelude::*;

/// What `leafless` re-exports.
#[pymodule(gil_used = true)]
mod _leafless {
    #[pymodule_export]
    use super::affine::Affine;
    #[pymodule_export]
    use super::channel::Channel;
    #[pymodule_export]
    use super::csg::Csg;
    #[pymodule_export]
    use super::dexels::{DexelSolid, TriDexel, dexelize};
    #[pymodule_export]
    use super::files::{map_path, open_bytes, open_path, save_bytes, save_path};
    #[pymodule_export]
    use super::frame::Frame;
    #[pymodule_export]
    use super::interval::Interval;
    #[pymodule_export]
    use super::lazy::LazyOctree;
    #[pymodule_export]
    use super::measures::{bounding_box, measure, surface_area};
    #[pymodule_export]
    use super::mesh::Mesh;
    #[pymodule_export]
    use super::octree::{Octree, Proof, build, frame_of};
    #[pymodule_export]
    use super::pairs::{clearance, deviation, frame_of_pair, gap_at_least, interference};
    #[pymodule_export]
    use super::picture::{Picture, render};
    #[pymodule_export]
    use super::shape::Shape;
    #[pymodule_export]
    use super::shards::{MassSum, Shard, ShardedSolid, join, joined_statistics, measure_cell, surface_in};
    #[pymodule_export]
    use super::solid::Solid;
    #[pymodule_export]
    use super::surface::{SurfaceReport, simplify, surface};
    #[pymodule_export]
    use super::volume::Volume;
    #[pymodule_export]
    use super::voxels::VoxelRecords;
}

/// The class or function of that name in a module of the package, looked up once.
macro_rules! from_package {
    ($py:expr, $module:literal, $name:literal) => {{
        static FOUND: pyo3::sync::PyOnceLock<pyo3::Py<pyo3::PyAny>> = pyo3::sync::PyOnceLock::new();
        FOUND
            .get_or_try_init($py, || {
                let module = pyo3::types::PyModule::import($py, $module)?;
                pyo3::types::PyAnyMethods::getattr(module.as_any(), $name).map(pyo3::Bound::unbind)
            })
            .map(|found| found.bind($py).clone())
    }};
}
pub(crate) use from_package;
