//! Closing the hair cracks of exported meshes.
//!
//! CAD systems export parts whose faces were tessellated one by one, and a vertex that two faces share may
//! come out as 0 on one side and as 2·10⁻¹⁶ on the other. Bit for bit such a mesh is open. Sewing welds
//! vertices of open edges that lie closer together than single precision can tell, remembers how far any of
//! them was moved, and the certified classification then counts that distance as an error of every position:
//! what is proven about the sewn surface is proven about any way of closing the cracks within that distance.

use super::surface::TriangleMesh;
use crate::error::Error;
use crate::lattice::exact::floor;
use crate::memory;
use alloc::vec::Vec;
use hashbrown::HashMap;

/// Vertices of open edges at most this fraction of the mesh's longest extent apart become one: the spacing of
/// single-precision numbers just below that extent.
const REACH: f64 = f32::EPSILON as f64 / 2.0;

impl TriangleMesh {
    /// The mesh with hair cracks closed: of the vertices at open edges, those that lie within 2^-24 of the
    /// mesh's longest extent of an earlier one are moved onto it. A mesh without open edges is returned as it
    /// is, and wider gaps stay open. [`report`](Self::report) tells how many vertices were moved and how far.
    ///
    /// O(t + v). Fails with [`Error::OutOfMemory`].
    pub fn sewn(self) -> Result<TriangleMesh, Error> {
        let (low, high) = self.bounds();
        let reach = REACH * (0..3).fold(0.0, |most: f64, axis| most.max(high[axis] - low[axis]));
        let open = self.open_vertices()?;
        if open.is_empty() || reach == 0.0 {
            return Ok(self);
        }
        // Of a grid with this spacing, vertices within reach of each other lie in neighbouring boxes.
        let boxed = |p: [f64; 3]| [0, 1, 2].map(|axis| floor((p[axis] - low[axis]) / reach));
        let mut kept: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
        let mut moves: Vec<(u32, u32)> = Vec::new();
        let mut displacement = 0.0f64;
        for &vertex in open {
            let position = self.vertices()[vertex as usize];
            let distance = |other: u32| {
                let other = self.vertices()[other as usize];
                (0..3).fold(0.0, |most: f64, axis| most.max((other[axis] - position[axis]).abs()))
            };
            let home = boxed(position);
            let neighbours = (0..27).flat_map(|n| {
                let step = [n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1];
                kept.get(&[0, 1, 2].map(|axis| home[axis] + step[axis])).into_iter().flatten().copied()
            });
            match neighbours.filter(|&other| distance(other) <= reach).min() {
                Some(onto) => {
                    displacement = displacement.max(distance(onto));
                    memory::push(&mut moves, (vertex, onto))?;
                }
                None => {
                    kept.try_reserve(1)?;
                    let neighbours = kept.entry(home).or_default();
                    memory::push(neighbours, vertex)?;
                }
            }
        }
        self.moved(&moves, displacement)
    }
}

#[cfg(test)]
mod tests {
    use super::super::surface::{FillRule, TriangleMesh};
    use alloc::vec::Vec;

    /// A tetrahedron whose four faces do not share vertices; `noise` is added to z in one of them.
    fn cracked(noise: f64) -> TriangleMesh {
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let faces = [[0usize, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let facets: Vec<[[f64; 3]; 3]> = (faces.iter().enumerate())
            .map(|(i, face)| {
                face.map(|corner| {
                    let [x, y, z] = corners[corner];
                    [x, y, if i == 0 { z + noise } else { z }]
                })
            })
            .collect();
        TriangleMesh::from_facets(facets).unwrap()
    }

    #[test]
    fn hair_cracks_are_closed_and_reported() {
        for noise in [1e-70, 2.7e-16, -5e-8] {
            let mesh = cracked(noise);
            assert!(mesh.check_closed(FillRule::NonZero).is_err());
            let sewn = mesh.sewn().unwrap();
            sewn.check_closed(FillRule::NonZero).unwrap();
            let report = sewn.report().unwrap();
            assert_eq!((report.sewn, report.displacement), (3, noise.abs()));
            assert_eq!((report.vertices, report.bodies), (4, 1));
        }
    }

    #[test]
    fn wider_gaps_stay_open_and_closed_meshes_as_they_are() {
        let sewn = cracked(1e-6).sewn().unwrap();
        assert!(sewn.check_closed(FillRule::NonZero).is_err());
        let closed = cracked(0.0).sewn().unwrap();
        assert_eq!(closed.report().unwrap().sewn, 0);
        assert_eq!(closed.displacement(), 0.0);
    }
}
