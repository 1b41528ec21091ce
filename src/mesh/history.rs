//! The history of a mesh, for programs that store meshes in their own format.

use super::triangle_mesh::{Faces, TriangleMesh};
use crate::error::Error;
use crate::lattice::LARGEST;

/// The part of a [`TriangleMesh`]'s origin that its vertices, triangles and attributes do not show. A mesh
/// that is stored and rebuilt without it claims more certainty than the original had.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MeshHistory {
    /// Number of vertices that were welded to an equal one.
    pub welded: u64,
    /// Number of triangles that were dropped because two of their corners were one vertex.
    pub degenerate: u64,
    /// Number of vertices that [`sewn`](TriangleMesh::sewn) moved onto another one.
    pub sewn: u64,
    /// Maximum error of a vertex along an axis, in model units: vertices were moved to close cracks, or
    /// rounded by a placement.
    pub displacement: f64,
    /// The [`deviation`](TriangleMesh::deviation) that was stated, in model units.
    pub deviation: f64,
    /// Number of faces of more than three corners from which the triangles were made.
    pub polygons: u64,
    /// Number of faces of more than three corners that are not flat.
    pub bent_polygons: u64,
    /// Maximum distance of a corner from the plane of its face, in model units.
    pub polygon_deviation: f64,
}

impl TriangleMesh {
    /// Returns the history of the mesh.
    pub fn history(&self) -> MeshHistory {
        let Faces { polygons, bent, deviation } = self.faces;
        MeshHistory {
            welded: self.welded,
            degenerate: self.degenerate,
            sewn: self.sewn,
            displacement: self.vertex_displacement(),
            deviation: self.deviation(),
            polygons,
            bent_polygons: bent,
            polygon_deviation: deviation,
        }
    }

    /// Returns the mesh with the given history in place of its own. Meant for a mesh that is a copy.
    ///
    /// # Errors
    /// [`Error::Argument`] unless displacement and deviation are finite, not negative, and at most 2^256.
    ///
    /// ```
    /// use leafless::TriangleMesh;
    /// let mesh = TriangleMesh::new(vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0; 3]], vec![[0, 1, 2], [3, 2, 1]])?;
    /// let (vertices, triangles) = (mesh.vertices().to_vec(), mesh.triangles().to_vec());
    /// let again = TriangleMesh::new(vertices, triangles)?.with_history(mesh.history())?;
    /// assert_eq!((again.report()?, again.report()?.welded), (mesh.report()?, 1));
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn with_history(mut self, history: MeshHistory) -> Result<TriangleMesh, Error> {
        if !(0.0..=LARGEST).contains(&history.displacement) {
            let problem = "must be finite, not negative, and at most 2^256";
            return Err(Error::Argument { name: "displacement", problem });
        }
        let MeshHistory { welded, degenerate, sewn, displacement, deviation, .. } = history;
        (self.welded, self.degenerate, self.sewn) = (welded, degenerate, sewn);
        self.faces = Faces {
            polygons: history.polygons,
            bent: history.bent_polygons,
            deviation: history.polygon_deviation,
        };
        self.displaced(displacement + 0.0, 0.0).with_deviation(deviation)
    }
}
