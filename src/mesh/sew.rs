//! Sewing: closes the hair cracks of exported meshes.
//!
//! CAD systems export parts whose faces were tessellated one by one. A vertex that two faces share may come
//! out as 0 on one side and as 2·10⁻¹⁶ on the other. Compared bit by bit, such a mesh is open. Sewing welds
//! vertices of open edges that lie closer together than single precision can distinguish, and records how far
//! any of them was moved. The certified classification then counts that distance as an error of every
//! position: every proof about the sewn surface holds for any way of closing the cracks within that distance.

//!
//! The reach of sewing depends on the *piece* to which a vertex belongs: all triangles that are connected by
//! common vertices. Cracks come from rounding, in single precision at worst, and a rounding error is
//! proportional to the numbers with which an exporter computes, which are of the size of the part. Other
//! scales would be wrong. The magnitude of the coordinates is too large for a small part far from the origin,
//! whose details doubles can represent. The edges at the vertex are too short, because exporters make short
//! edges in large parts. The extent of all pieces together is unrelated to a single piece.

use super::topology::DisjointSets;
use super::triangle_mesh::TriangleMesh;
use crate::error::Error;
use crate::lattice::Each;
use crate::memory;
use alloc::vec::Vec;
use hashbrown::HashMap;

/// The reach of a piece, relative to its longest extent: the spacing of single-precision numbers just below
/// that extent.
const REACH: f64 = f32::EPSILON as f64 / 2.0;

/// Vertices that stay in place, in boxes at least as large as their reach: all vertices within reach of a
/// position lie in neighbouring boxes.
struct Grid {
    /// Edge of a box, a power of two.
    spacing: f64,
    boxes: HashMap<[u64; 3], Vec<u32>>,
}

impl Grid {
    /// Returns the box at some steps from the box of a position. Dividing by the spacing is exact. If the
    /// quotient exceeds 2^53, steps are lost, but no neighbours: different positions are then further apart
    /// than the spacing.
    fn place(&self, position: [f64; 3], step: [f64; 3]) -> [u64; 3] {
        // Makes -0.0 equal to 0.0.
        [0, 1, 2].each(|axis| (libm::floor(position[axis] / self.spacing) + step[axis] + 0.0).to_bits())
    }

    fn add(&mut self, position: [f64; 3], vertex: u32) -> Result<(), Error> {
        let place = self.place(position, [0.0; 3]);
        self.boxes.try_reserve(1)?;
        memory::push(self.boxes.entry(place).or_default(), vertex)
    }

    /// Returns the vertices in the 27 boxes around a position.
    fn around(&self, position: [f64; 3]) -> impl Iterator<Item = u32> {
        let step = |n: i32| f64::from(n % 3 - 1);
        (0..27)
            .map(move |n| [step(n), step(n / 3), step(n / 9)])
            .filter_map(move |step| self.boxes.get(&self.place(position, step)))
            .flatten()
            .copied()
    }
}

impl TriangleMesh {
    /// Returns the mesh with hair cracks closed. A vertex at an open edge is moved onto another one if their
    /// distance is at most 2^-24 of the longest extent of the larger of their pieces. (A piece is all
    /// triangles that are connected by common vertices.) The vertex of the smaller piece moves, or the later
    /// vertex. A mesh without open edges is returned unchanged, and wider gaps stay open.
    /// [`report`](Self::report) returns how many vertices were moved and how far.
    ///
    /// O(t + v) for each power of two between the extents of the pieces.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn sewn(self) -> Result<TriangleMesh, Error> {
        if self.open_vertices()?.is_empty() {
            return Ok(self);
        }
        let reaches = self.reaches()?;
        let reach = |vertex: u32| reaches[vertex as usize];
        let mut open = memory::copied(self.open_vertices()?)?;
        // Sort by reach, longest first.
        open.sort_unstable_by(|&a, &b| reach(b).total_cmp(&reach(a)).then(a.cmp(&b)));
        let mut grids: Vec<Grid> = Vec::new();
        let mut moves: Vec<(u32, u32)> = Vec::new();
        let mut displacement = 0.0f64;
        for vertex in open {
            let position = self.vertices()[vertex as usize];
            let distance = |other: u32| {
                let other = self.vertices()[other as usize];
                (0..3).fold(0.0, |most: f64, axis| most.max((other[axis] - position[axis]).abs()))
            };
            // Below the smallest normal numbers, no other vertex is within reach.
            let own = reach(vertex);
            if own < f64::MIN_POSITIVE {
                continue;
            }
            let near = grids.iter().find_map(|grid| {
                grid.around(position).filter(|&other| distance(other) <= reach(other)).min()
            });
            match near {
                Some(onto) => {
                    displacement = displacement.max(distance(onto));
                    memory::push(&mut moves, (vertex, onto))?;
                }
                None => {
                    if grids.last().is_none_or(|grid| own <= grid.spacing / 2.0) {
                        memory::push(&mut grids, Grid { spacing: power_of_two(own), boxes: HashMap::new() })?;
                    }
                    if let Some(grid) = grids.last_mut() {
                        grid.add(position, vertex)?;
                    }
                }
            }
        }
        self.moved(&moves, displacement)
    }

    /// Returns the reach of each vertex.
    fn reaches(&self) -> Result<Vec<f64>, Error> {
        let mut sets = DisjointSets::new(self.vertices().len())?;
        for &[a, b, c] in self.triangles() {
            sets.unite(a, b);
            sets.unite(a, c);
        }
        let pieces = sets.numbers();
        let count = pieces.iter().max().map_or(0, |&last| last as usize + 1);
        let mut extents = memory::filled(count, ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]))?;
        for (&piece, position) in pieces.iter().zip(self.vertices()) {
            let (low, high) = &mut extents[piece as usize];
            for axis in 0..3 {
                low[axis] = low[axis].min(position[axis]);
                high[axis] = high[axis].max(position[axis]);
            }
        }
        memory::collected(pieces.iter().map(|&piece| {
            let (low, high) = extents[piece as usize];
            REACH * (0..3).fold(0.0, |most: f64, axis| most.max(high[axis] - low[axis]))
        }))
    }
}

/// Returns the least power of two that is not less than a normal number.
fn power_of_two(x: f64) -> f64 {
    const FRACTION: u64 = (1 << 52) - 1;
    f64::from_bits((x.to_bits() + FRACTION) & !FRACTION)
}

#[cfg(test)]
mod tests {
    use crate::mesh::triangle_mesh::{FillRule, TriangleMesh};
    use alloc::vec::Vec;

    /// A tetrahedron whose four faces share no vertices; `noise` is added to z in one of them.
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

    /// A box without a lid, its corners moved by `at`, and one triangle with `edge` far away.
    fn box_and_triangle(size: f64, at: f64, far: f64, edge: f64) -> TriangleMesh {
        let corner = |k: usize| [0, 1, 2].map(|axis| at + if k >> axis & 1 == 0 { 0.0 } else { size });
        let sides = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1]];
        let mut facets: Vec<[[f64; 3]; 3]> = Vec::new();
        for [a, b, c, d] in sides.map(|side: [usize; 4]| side.map(corner)) {
            facets.extend([[a, b, c], [a, c, d]]);
        }
        facets.push([[far, 0.0, 0.0], [far + edge, 0.0, 0.0], [far, edge, 0.0]]);
        TriangleMesh::from_facets(facets).unwrap()
    }

    #[test]
    fn what_lies_far_away_does_not_matter() {
        for (at, far, edge) in [(0.0, 1e8, 1.0), (-3.0, 1e60, 1e50), (1e6, 0.0, 1e-3), (0.0, 1e12, 1e9)] {
            let mesh = box_and_triangle(1.0, at, far, edge);
            let sewn = mesh.sewn().unwrap();
            assert_eq!((sewn.vertices().len(), sewn.report().unwrap().sewn), (11, 0));
        }
    }

    /// Unconnected facets, and bodies of very different sizes, each with its own cracks.
    #[test]
    fn every_piece_has_its_own_reach() {
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let faces = [[0usize, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let mut facets: Vec<[[f64; 3]; 3]> = Vec::new();
        for (body, size) in [1.0, 1e-20, 1e30, 3e-7, 1e9].into_iter().enumerate() {
            for (i, face) in faces.iter().enumerate() {
                let noise = if body % 2 == 0 { 5e-8 } else { 1e-9 } * i as f64 / 3.0;
                facets.push(face.map(|corner| corners[corner].map(|x| size * (x + 2.0 + noise))));
            }
        }
        let mesh = TriangleMesh::from_facets(facets).unwrap();
        assert_eq!(mesh.vertices().len(), 60);
        let sewn = mesh.sewn().unwrap();
        sewn.check_closed(FillRule::NonZero).unwrap();
        let report = sewn.report().unwrap();
        assert_eq!((report.vertices, report.bodies, report.sewn), (20, 5, 40));
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
