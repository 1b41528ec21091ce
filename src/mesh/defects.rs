//! Where a mesh is not as it should be.
//!
//! A scan may have a hundred thousand holes, and a list of them is of no use. What belongs together is one defect, and
//! the worst come first.

use alloc::vec::Vec;
use core::cmp::Ordering;

use glam::DVec3;

use super::surface::TriangleMesh;
use super::topology::{Coincident, DisjointSets, for_each_edge};
use crate::error::Error;
use crate::memory;

/// What is wrong with a part of a mesh, the most harmful first.
#[non_exhaustive]
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum DefectKind {
    /// A loop of edges that an odd number of triangles use: around a hole, or around a sheet.
    Hole,
    /// Edges that an even number of triangles use, but not half of them in each direction: across them the facing
    /// changes.
    Misoriented,
    /// Triangles with the same corners as an earlier one, in the same or the opposite direction.
    Duplicate,
    /// Edges that more than two triangles use. They do no harm.
    NonManifold,
    /// Triangles without area. They do no harm.
    Flat,
}

/// A part of a mesh that is not as it should be: one loop of a [`Hole`](DefectKind::Hole), or, of the other kinds, edges or
/// triangles that hang together over common vertices.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshDefect {
    /// What is wrong.
    pub kind: DefectKind,
    /// The least and the greatest coordinates of all its vertices, in model units.
    pub bounds: ([f64; 3], [f64; 3]),
    /// Edges, or triangles of a [`Duplicate`](DefectKind::Duplicate) or [`Flat`](DefectKind::Flat) defect.
    pub count: u64,
    /// The edges' lengths, added up, in model units; 0 where triangles are counted.
    pub length: f64,
}

impl MeshDefect {
    /// The longest side of the bounds.
    pub fn extent(&self) -> f64 {
        let (low, high) = (DVec3::from(self.bounds.0), DVec3::from(self.bounds.1));
        (high - low).max_element()
    }
}

impl TriangleMesh {
    /// Where the mesh is not as it should be: the `limit` worst places, in the order of [`DefectKind`], and those of one
    /// kind by descending [extent](MeshDefect::extent), then by descending count, then by position.
    ///
    /// O(t + v) time and 24 bytes per triangle and 8 per vertex of scratch memory; O(n log n) time and about 100 bytes
    /// for each of n edges and triangles that are part of a defect. Fails with [`Error::OutOfMemory`].
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
        for edges in OpenLoops::of(&open)?.iter() {
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

    /// Adds a defect for each set of items that hang together over vertices.
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

/// The order of two places, by their first coordinates that differ.
fn compare(a: &[f64; 3], b: &[f64; 3]) -> Ordering {
    a.iter().zip(b).map(|(x, y)| x.total_cmp(y)).find(|order| order.is_ne()).unwrap_or(Ordering::Equal)
}

/// Loops of edges without regard to their directions.
#[derive(Default)]
pub(super) struct OpenLoops {
    edges: Vec<u32>,
    /// One past the last edge of each loop.
    ends: Vec<usize>,
}

impl OpenLoops {
    /// Takes `open` apart: different edges of which every vertex has an even number, as the edges have that an odd
    /// number of triangles use. No loop has a vertex twice, and each edge belongs to one loop.
    ///
    /// O(n log n). Fails with [`Error::OutOfMemory`].
    pub fn of(open: &[[u32; 2]]) -> Result<OpenLoops, Error> {
        // The edges of each vertex are consecutive, and vertices are numbered by theirs.
        let mut uses: Vec<(u32, u32)> = memory::with_capacity(open.len() * 2)?;
        uses.extend(open.iter().zip(0..).flat_map(|(edge, e)| edge.map(|vertex| (vertex, e))));
        uses.sort_unstable();
        let mut firsts: Vec<usize> = memory::with_capacity(uses.len() + 1)?;
        firsts.extend((0..uses.len()).filter(|&u| u == 0 || uses[u - 1].0 != uses[u].0));
        let count = firsts.len();
        firsts.push(uses.len());
        let number = |vertex: u32| firsts[..count].partition_point(|&first| uses[first].0 < vertex);

        let mut next = memory::copied(&firsts[..count])?;
        let mut walked: Vec<bool> = memory::filled(open.len(), false)?;
        // Where on the path a vertex stands.
        let mut places = memory::filled(count, usize::MAX)?;
        // Each vertex of the path, and the edge that led there.
        let mut path: Vec<(usize, u32)> = memory::with_capacity(count)?;
        let mut loops = OpenLoops::default();
        loops.edges.try_reserve_exact(open.len())?;
        for start in 0..count {
            path.push((start, 0));
            places[start] = 0;
            // The walk can only end where it began: everywhere else an edge leads on.
            while let Some(&(last, _)) = path.last()
                && next[last] < firsts[last + 1]
            {
                let edge = uses[next[last]].1;
                next[last] += 1;
                if core::mem::replace(&mut walked[edge as usize], true) {
                    continue;
                }
                let [a, b] = open[edge as usize];
                let onto = number(if uses[firsts[last]].0 == a { b } else { a });
                if places[onto] == usize::MAX {
                    places[onto] = path.len();
                    path.push((onto, edge));
                    continue;
                }
                let place = places[onto];
                loops.edges.push(edge);
                loops.edges.extend(path[place + 1..].iter().map(|&(_, edge)| edge));
                memory::push(&mut loops.ends, loops.edges.len())?;
                path.drain(place + 1..).for_each(|(vertex, _)| places[vertex] = usize::MAX);
            }
            places[start] = usize::MAX;
            path.clear();
        }
        Ok(loops)
    }

    pub fn count(&self) -> usize {
        self.ends.len()
    }

    /// The edges of each loop.
    pub fn iter(&self) -> impl Iterator<Item = &[u32]> {
        let starts = core::iter::once(0).chain(self.ends.iter().copied());
        starts.zip(&self.ends).map(|(start, &end)| &self.edges[start..end])
    }
}
