//! Faces of any number of corners, on the way to a triangle mesh.

use alloc::vec::Vec;

use crate::error::{Error, MeshError};
use crate::solid::TriangleMesh;

/// A mesh of polygons with shared vertices, whose vertices need not be known before the faces.
///
/// A face of n corners is stored as the n - 2 triangles of a fan, and if n is more than three it is noted, so that
/// it can be cut in another way once all vertices are there.
#[derive(Default)]
pub(super) struct Polygons {
    pub vertices: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    /// Of each face that is no triangle its first triangle and the number of its triangles.
    fans: Vec<[u32; 2]>,
}

impl Polygons {
    /// Makes room for vertices and for faces, of which so many must be backed by data that exists.
    pub fn reserve(&mut self, vertices: usize, faces: usize) -> Result<(), Error> {
        self.vertices.try_reserve_exact(vertices).map_err(|_| Error::OutOfMemory)?;
        self.triangles.try_reserve_exact(faces).map_err(|_| Error::OutOfMemory)
    }

    #[inline]
    pub fn push_vertex(&mut self, vertex: [f64; 3]) -> Result<(), Error> {
        push(&mut self.vertices, vertex)
    }

    /// Adds a face; one of fewer than three corners adds nothing.
    #[inline]
    pub fn push_face(&mut self, corners: &[u32]) -> Result<(), Error> {
        match *corners {
            [a, b, c] => push(&mut self.triangles, [a, b, c]),
            [first, ref others @ ..] => self.push_fan(first, others),
            [] => Ok(()),
        }
    }

    fn push_fan(&mut self, first: u32, others: &[u32]) -> Result<(), Error> {
        let Some(count) = others.len().checked_sub(1).filter(|&count| count > 0) else { return Ok(()) };
        let start = u32::try_from(self.triangles.len()).map_err(|_| MeshError::TooMany)?;
        let fan = [start, u32::try_from(count).map_err(|_| MeshError::TooMany)?];
        self.triangles.try_reserve(count).map_err(|_| Error::OutOfMemory)?;
        self.triangles.extend(others.windows(2).map(|pair| [first, pair[0], pair[1]]));
        push(&mut self.fans, fan)
    }

    /// The mesh. All corners must be vertices.
    pub fn finish(self) -> Result<TriangleMesh, Error> {
        TriangleMesh::new(self.vertices, self.triangles)
    }
}

#[inline]
pub(super) fn push<T>(items: &mut Vec<T>, item: T) -> Result<(), Error> {
    items.try_reserve(1).map_err(|_| Error::OutOfMemory)?;
    items.push(item);
    Ok(())
}
