//! Faces with any number of corners, collected for a triangle mesh.
//!
//! A face of more than three corners is triangulated within the face, also if it is not convex. If that is
//! impossible, because its edges cross or it has no area in the projection along its normal, it becomes the
//! fan around its first corner. In both cases the triangles keep the face's boundary, so neighbours still
//! meet.

use alloc::vec::Vec;

use crate::error::{Error, MeshError};
use crate::memory;
use crate::mesh::{Faces, MeshAttribute, TriangleMesh, flatness, triangulate_facet};

/// A mesh of polygons with shared vertices. The vertices need not be known before the faces.
///
/// A face of n corners is stored as the n - 2 triangles of a fan, and recorded if n is more than three. The
/// final triangulation is made once all vertices are known.
#[derive(Default)]
pub(crate) struct Polygons {
    pub vertices: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    /// The first triangle and the number of triangles of each face that is no triangle.
    fans: Vec<[u32; 2]>,
}

impl Polygons {
    /// Makes room for vertices and for faces. The data of that many must exist.
    pub fn reserve(&mut self, vertices: usize, faces: usize) -> Result<(), Error> {
        self.vertices.try_reserve_exact(vertices)?;
        Ok(self.triangles.try_reserve_exact(faces)?)
    }

    #[inline]
    pub fn push_vertex(&mut self, vertex: [f64; 3]) -> Result<(), Error> {
        memory::push(&mut self.vertices, vertex)
    }

    /// Adds a face; a face of fewer than three corners adds nothing.
    #[inline]
    pub fn push_face(&mut self, corners: &[u32]) -> Result<(), Error> {
        match *corners {
            [a, b, c] => memory::push(&mut self.triangles, [a, b, c]),
            [first, ref others @ ..] => self.push_fan(first, others),
            [] => Ok(()),
        }
    }

    fn push_fan(&mut self, first: u32, others: &[u32]) -> Result<(), Error> {
        let Some(count) = others.len().checked_sub(1).filter(|&count| count > 0) else { return Ok(()) };
        let start = u32::try_from(self.triangles.len()).map_err(|_| MeshError::TooMany)?;
        let fan = [start, u32::try_from(count).map_err(|_| MeshError::TooMany)?];
        self.triangles.try_reserve(count)?;
        self.triangles.extend(others.windows(2).map(|pair| [first, pair[0], pair[1]]));
        memory::push(&mut self.fans, fan)
    }

    /// Returns the number of triangles of the faces so far. The final triangulation keeps each triangle in
    /// its face.
    #[inline]
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// Returns the mesh. All corners must be vertices.
    pub fn finish(self) -> Result<TriangleMesh, Error> {
        self.finish_with(|_| Ok(Vec::new()))
    }

    /// Returns the mesh with attributes of its triangles. The corners of these triangles are numbers of the
    /// vertices as they were added. All corners must be vertices.
    pub fn finish_with(
        mut self,
        attributes: impl FnOnce(&[[u32; 3]]) -> Result<Vec<MeshAttribute>, Error>,
    ) -> Result<TriangleMesh, Error> {
        let (mut corners, mut cut, mut found) = (Vec::new(), Vec::new(), Faces::default());
        for &[start, count] in &self.fans {
            let fan = &mut self.triangles[start as usize..][..count as usize];
            corners.clear();
            corners.try_reserve(fan.len() + 2)?;
            corners.extend(fan.first().map_or([0; 2], |&[first, second, _]| [first, second]));
            corners.extend(fan.iter().map(|triangle| triangle[2]));
            cut.clear();
            // A face without area has no plane.
            let (deviation, extent) = flatness(&self.vertices, &corners, &corners).unwrap_or_default();
            found.add(deviation, extent);
            triangulate_facet(&self.vertices, &corners, &mut cut)?;
            // If corners coincide there are fewer triangles; the mesh counts the rest as degenerate.
            if cut.len() <= fan.len() {
                fan.fill([corners[0]; 3]);
                fan[..cut.len()].copy_from_slice(&cut);
            }
        }
        let attributes = attributes(&self.triangles)?;
        Ok(TriangleMesh::with_attributes(self.vertices, self.triangles, attributes)?.made_from(found))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec;

    /// Returns twice the area of each triangle in the xy plane.
    fn areas(mesh: &TriangleMesh) -> Vec<f64> {
        let of = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| mesh.vertices()[v as usize]);
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        };
        mesh.triangles().iter().map(of).collect()
    }

    /// Reads the faces before the vertices, as in some OBJ files.
    fn mesh(vertices: &[[f64; 3]], faces: &[&[u32]]) -> TriangleMesh {
        let mut polygons = Polygons::default();
        faces.iter().for_each(|face| polygons.push_face(face).unwrap());
        vertices.iter().for_each(|&vertex| polygons.push_vertex(vertex).unwrap());
        polygons.finish().unwrap()
    }

    /// An L, whose fan around the first corner leaves the polygon.
    const L: [[f64; 3]; 6] =
        [[2., 0., 0.], [2., 1., 0.], [1., 1., 0.], [1., 2., 0.], [0., 2., 0.], [0., 0., 0.]];

    #[test]
    fn convex_faces_are_fans() {
        let square = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
        assert_eq!(mesh(&square, &[&[0, 1, 2, 3]]).triangles(), [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(mesh(&square, &[&[3, 2, 1, 0]]).triangles(), [[3, 2, 1], [3, 1, 0]]);
        assert_eq!(mesh(&square, &[&[0, 1], &[2], &[], &[1, 2, 3]]).triangles(), [[1, 2, 3]]);
    }

    #[test]
    fn no_triangle_leaves_a_face() {
        for first in 0..6 {
            let face: Vec<u32> = (0..6).map(|k| (first + k) % 6).collect();
            let found = areas(&mesh(&L, &[&face]));
            assert!(found.len() == 4 && found.iter().all(|&area| area > 0.0), "{found:?}");
            assert_eq!(found.iter().sum::<f64>(), 6.0);
            let turned: Vec<u32> = face.into_iter().rev().collect();
            let found = areas(&mesh(&L, &[&turned]));
            assert!(found.len() == 4 && found.iter().all(|&area| area < 0.0), "{found:?}");
        }
        let dart = [[0., 0., 0.], [2., 1., 0.], [0., 2., 0.], [1., 1., 0.]];
        for first in 0..4 {
            let face: Vec<u32> = (0..4).map(|k| (first + k) % 4).collect();
            assert_eq!(areas(&mesh(&dart, &[&face])), [1.0, 1.0]);
        }
    }

    #[test]
    fn triangles_keep_the_order_of_faces() {
        let mesh = mesh(&L, &[&[0, 1, 2], &[0, 1, 2, 3, 4, 5], &[3, 4, 5]]);
        let triangles = mesh.triangles();
        assert_eq!((triangles.len(), triangles[0], triangles[5]), (6, [0, 1, 2], [3, 4, 5]));
    }

    #[test]
    fn faces_that_cannot_be_cut_keep_their_boundary() {
        // A bow tie, and a face on one line.
        let mesh = mesh(
            &[[0., 0., 0.], [1., 1., 0.], [1., 0., 0.], [0., 1., 0.], [0., 2., 0.], [0., 3., 0.]],
            &[&[0, 1, 2, 3], &[0, 3, 5, 4]],
        );
        assert_eq!(mesh.triangles(), [[0, 1, 2], [0, 2, 3], [0, 3, 5], [0, 5, 4]]);
    }

    #[test]
    fn corners_that_coincide_are_counted() {
        let report = mesh(&L, &[&[0, 1, 1, 2, 3, 4, 5], &[0, 0, 1, 1]]).report().unwrap();
        assert_eq!((report.facets_read, report.triangles, report.degenerate), (7, 4, 3));
        // The same by position.
        let twice: Vec<[f64; 3]> = L.iter().flat_map(|&vertex| [vertex, vertex]).collect();
        let face: Vec<u32> = (0..12).collect();
        let mesh = mesh(&twice, &[&face]);
        assert_eq!(mesh.report().unwrap().facets_read, 10);
        assert_eq!(areas(&mesh).iter().sum::<f64>(), 6.0);
        assert_eq!(mesh.triangles().len(), 4);
    }

    #[test]
    fn the_wall_with_a_hole() {
        // A face that runs around its hole and back along a bridge.
        let vertices: Vec<[f64; 3]> = vec![
            [0., 0., 0.],
            [3., 0., 0.],
            [3., 3., 0.],
            [0., 3., 0.],
            [1., 1., 0.],
            [1., 2., 0.],
            [2., 2., 0.],
            [2., 1., 0.],
        ];
        let mesh = mesh(&vertices, &[&[0, 1, 2, 3, 0, 4, 5, 6, 7, 4]]);
        let found = areas(&mesh);
        assert!(found.iter().all(|&area| area > 0.0), "{found:?}");
        assert_eq!((found.len(), found.iter().sum::<f64>()), (8, 16.0));
    }
}
