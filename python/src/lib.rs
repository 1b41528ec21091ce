//! The Python interface of Leafless. Each class or function converts Python's values, calls the library with
//! the interpreter released, and returns the results. Parts that are easier in Python are in
//! `package/leafless`.
//!
//! From the bottom up: `error`, `work` (long operations that can be watched and interrupted), `words` (the
//! names of enumeration values), `arguments`, `arrays`, `interval` and `frame` (conversion of arguments),
//! `answers` (conversion of answers), `callback` (calls of methods in Python), `solid` (the class of all
//! solids), `shape` (solids written in Python), `affine`, `octree` (the class), `ask` (the default frame of
//! a query), `csg`, `mesh`, `volume` and the other kinds of solids, `measures`, `pairs`, `surface` and
//! `picture` (queries), `building`, `operators`, `octree_methods` and `solid_methods` (the methods of the
//! two classes), `note` (the threshold of a volume in its file), `files` (reading and writing). No two files
//! use each other.

mod affine;
mod answers;
mod anywhere;
mod arguments;
mod arrays;
mod ask;
mod building;
mod callback;
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
mod octree_methods;
mod operators;
mod pairs;
mod picture;
mod shape;
mod shards;
mod solid;
mod solid_methods;
mod surface;
mod surface_report;
mod volume;
mod voxels;
mod words;
mod work;

use pyo3::prelude::*;

/// The extension module, which `leafless` re-exports.
#[pymodule(gil_used = true)]
mod _leafless {
    #[pymodule_export]
    use super::affine::Affine;
    #[pymodule_export]
    use super::building::{build, frame_of};
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
    use super::octree::{Octree, Proof};
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
    use super::surface::{simplify, surface};
    #[pymodule_export]
    use super::surface_report::SurfaceReport;
    #[pymodule_export]
    use super::volume::Volume;
    #[pymodule_export]
    use super::voxels::VoxelRecords;
}

/// Returns a class or function of a module of the package, looked up once.
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
