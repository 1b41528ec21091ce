//! What a mesh remembers of how it was made, for those who store meshes in a way of their own.

use super::triangle_mesh::{Faces, TriangleMesh};
use crate::error::Error;
use crate::lattice::LARGEST;

/// What a [`TriangleMesh`] remembers of how it was made, which its vertices, triangles and attributes do not
/// tell. Without it, a mesh that is stored and made again proves more than it did.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MeshHistory {
    /// Vertices that became one with an equal one.
    pub welded: u64,
    /// Triangles that were dropped, because two of their corners were one vertex.
    pub degenerate: u64,
    /// Vertices that [`sewn`](TriangleMesh::sewn) moved onto another one.
    pub sewn: u64,
    /// How far along an axis vertices may be off, in model units: moved to close cracks, or rounded by a
    /// placement.
    pub displacement: f64,
    /// The [`deviation`](TriangleMesh::deviation) that was stated, in model units.
    pub deviation: f64,
    /// Faces of more than three corners that the triangles were made from.
    pub polygons: u64,
    /// Those that are not flat.
    pub bent_polygons: u64,
    /// How far corners lie beside the planes of such faces at the most, in model units.
    pub polygon_deviation: f64,
}

impl TriangleMesh {
    /// What the mesh remembers of how it was made.
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

    /// The same mesh with the history of the one that it is a copy of, in the place of its own.
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
