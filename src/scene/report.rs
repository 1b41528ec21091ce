//! Reports about scenes.

use alloc::string::String;
use alloc::vec::Vec;

use crate::mesh::MeshReport;

/// The findings of reading a scene: how its curves are drawn, what is ignored, and the properties of its
/// meshes.
#[derive(Debug, Clone, Default)]
pub struct SceneReport {
    /// Number of calls of `circle`, `sphere`, `cylinder` and `rotate_extrude` that are drawn as polygons.
    pub polygons: u64,
    /// Number of these calls that are exact. OpenSCAD draws them as polygons.
    pub exact: u64,
    /// Number of calls of `linear_extrude` whose `slices` has an effect in OpenSCAD but none here: the scales
    /// along x and y differ, and the sides are the curved surfaces that OpenSCAD approximates better with
    /// more slices.
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
    /// The findings of building the mesh, as for a mesh file.
    pub report: MeshReport,
    /// Number of facets that face the other way than most facets of their body.
    pub turned: u64,
}
