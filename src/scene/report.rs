//! What is told about a scene.

use alloc::string::String;
use alloc::vec::Vec;

use crate::mesh::MeshReport;

/// What was found while a scene was read: how its curves were drawn, what was left out of account, and what
/// its meshes are like.
#[derive(Debug, Clone, Default)]
pub struct SceneReport {
    /// Calls of `circle`, `sphere`, `cylinder` and `rotate_extrude` that were drawn as polygons.
    pub polygons: u64,
    /// Calls of these that are exact. OpenSCAD draws them as polygons.
    pub exact: u64,
    /// Calls of `linear_extrude` of which `slices` has no effect though it has one in OpenSCAD: the scales
    /// along x and y differ, and the sides are the curved ones that OpenSCAD comes closer to with more
    /// slices.
    pub ignored_slices: u64,
    /// The meshes and polyhedra that have triangles, in the order of the text.
    pub meshes: Vec<SceneMesh>,
}

/// A mesh in a scene.
#[derive(Debug, Clone)]
pub struct SceneMesh {
    /// Line of the call, counted from 1.
    pub line: u64,
    /// Column of the call in characters, counted from 1.
    pub column: u64,
    /// The file as the text names it; empty for a polyhedron.
    pub file: String,
    /// What was found while the mesh was taken in, as for a mesh file.
    pub report: MeshReport,
    /// Facets that face the other way than most facets of their body.
    pub turned: u64,
}
