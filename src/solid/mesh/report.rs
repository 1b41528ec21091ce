//! What is told about a mesh.

use super::surface::TriangleMesh;
use crate::error::Error;

/// What was found while a mesh was taken in, and how its triangles hang together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshReport {
    /// Triangles that were handed in, `triangles` + `degenerate`.
    pub facets_read: u64,
    /// Triangles of the mesh.
    pub triangles: u64,
    /// Vertices of the mesh, all at different places. Some may be used by no triangle.
    pub vertices: u64,
    /// Vertices that were handed in and lay on an earlier one: of a triangle soup that was not
    /// sewn, 3 `facets_read` - `vertices`.
    pub welded: u64,
    /// Triangles that were dropped because two of their corners lie at one place.
    pub degenerate: u64,
    /// Edges that an odd number of triangles use. A mesh is closed if there is none.
    pub boundary_edges: u64,
    /// Edges that an even number of triangles use, but not half of them in each direction. A closed mesh is
    /// consistently oriented if there is none.
    pub misoriented_edges: u64,
    /// Edges that more than two triangles use, for instance where two bodies touch. They do no harm.
    pub non_manifold_edges: u64,
    /// Sets of triangles that hang together over edges. Bodies that touch only in single vertices count
    /// separately, and so does the outer from the inner surface of a hollow body.
    pub bodies: u64,
    /// Vertices that [`sewn`](TriangleMesh::sewn) moved onto another one.
    pub sewn: u64,
    /// The farthest that any of them was moved along an axis, in model units.
    pub displacement: f64,
}

impl TriangleMesh {
    /// What was found when the mesh was made, and how its triangles hang together.
    ///
    /// The first call of this or of [`check_closed`](Self::check_closed) analyses the edges, in O(t + v) time
    /// and with 28 bytes per triangle and 8 per vertex of scratch memory; later calls are free. Fails with
    /// [`Error::OutOfMemory`].
    pub fn report(&self) -> Result<MeshReport, Error> {
        let topology = self.topology()?;
        let triangles = self.triangles().len() as u64;
        Ok(MeshReport {
            facets_read: triangles + self.degenerate,
            triangles,
            vertices: self.vertices().len() as u64,
            welded: self.welded,
            degenerate: self.degenerate,
            boundary_edges: topology.boundary_edges,
            misoriented_edges: topology.misoriented_edges,
            non_manifold_edges: topology.non_manifold_edges,
            bodies: topology.bodies,
            sewn: self.sewn,
            displacement: self.displacement(),
        })
    }
}
