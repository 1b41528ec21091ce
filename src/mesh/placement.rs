//! Affine maps of meshes.

use super::triangle_mesh::TriangleMesh;
use crate::error::Error;
use crate::lattice::exact::Expansion;
use crate::lattice::exact::two_product;
use crate::lattice::{Affine, SMALLEST};

impl TriangleMesh {
    /// Returns the mesh mapped by an affine map. Vertices are rounded to doubles; the maximum rounding error
    /// is added to the [`displacement`](Self::displacement), so that proofs about the solid hold for the
    /// exact image. A stated [`deviation`](Self::deviation) is multiplied by the maximum factor by which the
    /// map stretches lengths. A reflection also reverses the triangles, so that outside stays outside. The
    /// report starts anew.
    ///
    /// O(v + t). Fails as [`new`](Self::new) does.
    pub fn placed(&self, placement: &Affine) -> Result<TriangleMesh, Error> {
        let (mut rounded, mut dropped) = (0f64, 0f64);
        let mut placed = self.transformed(|point| {
            let image = placement.apply(point);
            for (row, &coordinate) in placement.rows().iter().zip(&image) {
                if !is_exact(row, point, coordinate) {
                    rounded = rounded.max(size(row, point));
                }
                if coordinate.abs() < SMALLEST && coordinate != 0.0 {
                    // It counts as zero.
                    dropped = SMALLEST;
                }
            }
            image
        })?;
        if placement.orientation() < 0 {
            placed.turn_round();
        }
        let moved = placement.stretched(self.vertex_displacement());
        // The error of `apply` is at most 2^-50 of the summands; twice that for the sums here.
        let rounding = rounded * (8.0 * f64::EPSILON);
        let displacement = moved + rounding + dropped;
        let displacement = if displacement > 0.0 { displacement.next_up() } else { 0.0 };
        Ok(placed.displaced(displacement, placement.lengthened(self.deviation())))
    }
}

/// Returns the sum of the magnitudes of a coordinate's terms.
fn size([x, y, z, t]: &[f64; 4], [a, b, c]: [f64; 3]) -> f64 {
    (x * a).abs() + (y * b).abs() + (z * c).abs() + t.abs()
}

/// Returns whether a coordinate is exactly the map's row applied to a point.
fn is_exact([x, y, z, t]: &[f64; 4], [a, b, c]: [f64; 3], coordinate: f64) -> bool {
    let products = [two_product(*x, a), two_product(*y, b), two_product(*z, c)];
    let parts = products.iter().flat_map(|&(high, low)| [low, high]);
    Expansion::sum(parts.chain([*t, -coordinate])).sign() == 0
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec;

    fn tetrahedron() -> TriangleMesh {
        let vertices = vec![[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]];
        TriangleMesh::new(vertices, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]).unwrap()
    }

    #[test]
    fn what_is_exact_is_not_displaced() {
        let mirror = [[0.0, 2.0, 0.0, 0.5], [1.0, 0.0, 0.0, -3.0], [0.0, 0.0, 1.0, 0.0]];
        let placed = tetrahedron().placed(&Affine::new(mirror).unwrap()).unwrap();
        assert_eq!(placed.displacement(), 0.0);
        assert_eq!(placed.vertices()[2], [2.5, -3.0, 0.0]);
        assert!(placed.volume() > 0.0, "a reflection turns it inside out");
        assert_eq!(placed.volume(), 2.0 / 6.0);
    }

    #[test]
    fn what_is_rounded_is_displaced_by_that() {
        let turn = [[0.6, -0.8, 0.0, 1e10], [0.8, 0.6, 0.0, 0.1], [0.0, 0.0, 1.0, 0.3]];
        let placed = tetrahedron().placed(&Affine::new(turn).unwrap()).unwrap();
        // Twice the spacing of doubles there covers the error; sixteen times the spacing is too much.
        let spacing = 1e10 * f64::EPSILON;
        assert!((spacing..32.0 * spacing).contains(&placed.displacement()), "{}", placed.displacement());
        let again = placed.placed(&Affine::translation([0.0, 0.0, 1.0]).unwrap()).unwrap();
        assert!(again.displacement() >= placed.displacement());
    }
}
