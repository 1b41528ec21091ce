//! Normals at vertices.

use super::TriangleMesh;
use crate::error::Error;
use crate::lattice::Each;
use crate::memory;
use alloc::vec::Vec;
use glam::DVec3;

impl TriangleMesh {
    /// Returns the unit normal at each vertex, outward if triangles turn counter-clockwise as seen from
    /// outside: the mean of the normals of the adjacent triangles, each weighted by its angle (Thürmer and
    /// Wüthrich 1998). The normal does not depend on how plane parts are triangulated. If the mean is zero,
    /// as at a vertex without triangles, the normal is zero.
    ///
    /// O(t + v) time; 24 bytes a vertex.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    ///
    /// ```
    /// let vertices = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    /// let mesh = leafless::TriangleMesh::new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
    /// let [x, y, z] = mesh.vertex_normals()?[0];
    /// assert!(x < 0.0 && x == y && y == z && (3.0 * x * x - 1.0).abs() < 1e-15);
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn vertex_normals(&self) -> Result<Vec<[f64; 3]>, Error> {
        let mut sums = memory::filled(self.vertices().len(), DVec3::ZERO)?;
        for triangle in self.triangles() {
            let [a, b, c] = triangle.each(|v| DVec3::from(self.vertices()[v as usize]));
            // Unit vectors only, so that lengths neither overflow nor vanish.
            let [u, v, w] = [b - a, c - b, a - c].each(unit);
            let Some(normal) = unit(u.cross(v)).try_normalize() else { continue };
            let angles = [-w.dot(u), -u.dot(v), -v.dot(w)].each(|cosine| libm::acos(cosine.clamp(-1.0, 1.0)));
            for (&vertex, angle) in triangle.iter().zip(angles) {
                sums[vertex as usize] += angle * normal;
            }
        }
        memory::collected(sums.into_iter().map(|sum| sum.normalize_or_zero().to_array()))
    }
}

/// Returns a vector of length 1 with this direction, or zero.
fn unit(v: DVec3) -> DVec3 {
    let size = v.abs().max_element();
    if size > 0.0 { (v / size).normalize_or_zero() } else { DVec3::ZERO }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec;

    fn normals(vertices: Vec<[f64; 3]>, triangles: Vec<[u32; 3]>) -> Vec<[f64; 3]> {
        TriangleMesh::new(vertices, triangles).unwrap().vertex_normals().unwrap()
    }

    /// A cube has the same normals at its corners however its faces are cut, and of any size.
    #[test]
    fn corners_of_a_cube() {
        for size in [1e-70, 1.0, 1e70] {
            let corners: Vec<[f64; 3]> =
                (0..8).map(|k| [0, 1, 2].map(|axis| f64::from(k >> axis & 1) * size)).collect();
            let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
            for turn in 0..64usize {
                let cut = |(i, face): (usize, &[u32; 4])| {
                    let mut face = *face;
                    face.rotate_left(turn >> i & 1);
                    [[face[0], face[1], face[2]], [face[0], face[2], face[3]]]
                };
                let triangles = faces.iter().enumerate().flat_map(cut).collect();
                for (k, normal) in normals(corners.clone(), triangles).into_iter().enumerate() {
                    for axis in 0..3 {
                        let expected = if k >> axis & 1 == 1 { 1.0 } else { -1.0 } / libm::sqrt(3.0);
                        assert!((normal[axis] - expected).abs() < 1e-12, "{k}: {normal:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn vertices_without_a_normal() {
        let line = vec![[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [5.0; 3]];
        assert_eq!(normals(line, vec![[0, 1, 2]]), [[0.0; 3]; 4]);
        let sheet = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        assert_eq!(normals(sheet, vec![[0, 1, 2], [0, 2, 1]]), [[0.0; 3]; 3]);
    }
}
