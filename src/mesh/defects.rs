//! Defects of a mesh.
//!
//! A scan may have a hundred thousand holes, and a list of them is of no use. Connected edges or triangles
//! are one defect, and the worst defects come first.

use alloc::vec::Vec;
use core::cmp::Ordering;

use glam::DVec3;

use super::boundary::EdgeLoops;
use super::topology::{Coincident, DisjointSets, for_each_edge};
use super::triangle_mesh::TriangleMesh;
use crate::error::Error;
use crate::memory;

/// The kind of a defect, the most harmful first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum DefectKind {
    /// A loop of edges, each used by an odd number of triangles: around a hole, or around a sheet.
    Hole,
    /// Edges used by an even number of triangles, but not by equally many in each direction: the orientation
    /// flips.
    Misoriented,
    /// Triangles with the same corners as an earlier one, in the same or the opposite direction.
    Duplicate,
    /// Edges used by more than two triangles. They do no harm.
    NonManifold,
    /// Triangles without area. They do no harm.
    Flat,
}

/// A defective part of a mesh: one loop of a [`Hole`](DefectKind::Hole) or, for the other kinds, edges or
/// triangles that are connected by common vertices.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshDefect {
    /// The kind of the defect.
    pub kind: DefectKind,
    /// The least and the greatest coordinates of all its vertices, in model units.
    pub bounds: ([f64; 3], [f64; 3]),
    /// Number of edges, or of triangles for a [`Duplicate`](DefectKind::Duplicate) or
    /// [`Flat`](DefectKind::Flat) defect.
    pub count: u64,
    /// The sum of the edges' lengths, in model units; 0 if triangles are counted.
    pub length: f64,
}

impl MeshDefect {
    /// Returns the longest side of the bounds.
    pub fn extent(&self) -> f64 {
        let (low, high) = (DVec3::from(self.bounds.0), DVec3::from(self.bounds.1));
        (high - low).max_element()
    }
}

impl TriangleMesh {
    /// Returns the `limit` worst defects, in the order of [`DefectKind`]; within one kind by descending
    /// [extent](MeshDefect::extent), then by descending count, then by position.
    ///
    /// O(t + v) time and 24 bytes per triangle and 8 per vertex of scratch memory; O(n log n) time and about
    /// 100 bytes for each of n edges and triangles that are part of a defect.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn defects(&self, limit: usize) -> Result<Vec<MeshDefect>, Error> {
        let mut defects = Vec::new();
        let triangles = self.triangles();
        let [mut open, mut misoriented, mut non_manifold] = [const { Vec::<[u32; 2]>::new() }; 3];
        let [mut repeated, mut flat] = [const { Vec::<[u32; 3]>::new() }; 2];
        let mut coincident = Coincident::default();
        for_each_edge(triangles, self.vertices().len(), |edge| {
            let ends = [edge.low, edge.high];
            if edge.is_open() {
                memory::push(&mut open, ends)?;
            } else if edge.excess() != 0 {
                memory::push(&mut misoriented, ends)?;
            }
            if edge.count() > 2 {
                memory::push(&mut non_manifold, ends)?;
            }
            coincident.on(edge, triangles)?;
            for &triangle in &coincident.repeated {
                memory::push(&mut repeated, triangles[triangle as usize])?;
            }
            Ok(())
        })?;
        for triangle in triangles.iter().filter(|triangle| self.is_flat(triangle)) {
            memory::push(&mut flat, *triangle)?;
        }
        for edges in EdgeLoops::of(&open, false)?.iter() {
            let mut defect = MeshDefect::new(DefectKind::Hole);
            edges.iter().for_each(|edge| self.extend(&mut defect, &open[*edge as usize]));
            memory::push(&mut defects, defect)?;
        }
        self.clusters(DefectKind::Misoriented, &misoriented, &mut defects)?;
        self.clusters(DefectKind::Duplicate, &repeated, &mut defects)?;
        self.clusters(DefectKind::NonManifold, &non_manifold, &mut defects)?;
        self.clusters(DefectKind::Flat, &flat, &mut defects)?;

        defects.sort_unstable_by(|a, b| {
            (a.kind.cmp(&b.kind))
                .then(b.extent().total_cmp(&a.extent()))
                .then(b.count.cmp(&a.count))
                .then_with(|| compare(&a.bounds.0, &b.bounds.0))
                .then_with(|| compare(&a.bounds.1, &b.bounds.1))
                .then(b.length.total_cmp(&a.length))
        });
        defects.truncate(limit);
        Ok(defects)
    }

    /// Adds a defect for each set of items that are connected by common vertices.
    fn clusters<const N: usize>(
        &self,
        kind: DefectKind,
        items: &[[u32; N]],
        defects: &mut Vec<MeshDefect>,
    ) -> Result<(), Error> {
        let mut users: Vec<(u32, u32)> = memory::with_capacity(items.len() * N)?;
        users.extend(items.iter().zip(0..).flat_map(|(item, i)| item.map(|vertex| (vertex, i))));
        users.sort_unstable();
        let mut sets = DisjointSets::new(items.len())?;
        for pair in users.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
            sets.unite(pair[0].1, pair[1].1);
        }
        let first = defects.len();
        for (item, set) in items.iter().zip(sets.numbers()) {
            // Sets are numbered by their least members.
            if first + set as usize == defects.len() {
                memory::push(defects, MeshDefect::new(kind))?;
            }
            self.extend(&mut defects[first + set as usize], item);
        }
        Ok(())
    }

    /// Adds an edge or a triangle to a defect.
    fn extend<const N: usize>(&self, defect: &mut MeshDefect, item: &[u32; N]) {
        for corner in item.map(|vertex| self.position(vertex)) {
            defect.bounds.0 = DVec3::from(defect.bounds.0).min(corner).to_array();
            defect.bounds.1 = DVec3::from(defect.bounds.1).max(corner).to_array();
        }
        if let [a, b] = item[..] {
            defect.length += self.position(a).distance(self.position(b));
        }
        defect.count += 1;
    }
}

impl MeshDefect {
    fn new(kind: DefectKind) -> MeshDefect {
        MeshDefect { kind, bounds: ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]), count: 0, length: 0.0 }
    }
}

/// Orders two positions by the first coordinate in which they differ.
fn compare(a: &[f64; 3], b: &[f64; 3]) -> Ordering {
    a.iter().zip(b).map(|(x, y)| x.total_cmp(y)).find(|order| order.is_ne()).unwrap_or(Ordering::Equal)
}
