//! Simple marching cubes: all vertices are samples.

use super::blocks::{Block, Blocks, FINDING};
use super::chunks;
use super::cubes::Around;
use super::key::{self, Key};
use super::lattice::Lattice;
use super::masks::{CORNER_AT, bits, configuration, rank};
use super::resolve::{Resolve, resolved};
use super::samples::Samples;
use super::size::Least;
use super::snapped::{FAT, Snapped, THIN};
use crate::control::{Control, Job, WHOLE};
use crate::dispatch::{Hot, with_popcount};
use crate::error::{Error, MeshError};
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::morton;
use crate::memory;
use crate::mesh::TriangleMesh;
use crate::octree::OctreeRef;
use alloc::vec::Vec;
use core::ops::Range;

/// The end of an edge at which simple marching cubes puts a vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Snap {
    /// The outer end of each edge between an inside and an outside sample: the mesh contains the centres of
    /// all inside cells.
    Fat,
    /// The inner end: the vertices of the mesh are centres of inside cells. A part that is one cell thick
    /// then has no thickness, and a part that is one cell long, wide and thick vanishes.
    Thin,
}

impl Snap {
    pub(super) fn table(self) -> &'static Snapped {
        match self {
            Snap::Fat => &FAT,
            Snap::Thin => &THIN,
        }
    }
}

/// Extracts the surface of an octree by simple marching cubes. Each vertex of marching cubes is moved to one
/// end of its edge, so that all vertices are centres of finest cells, and triangles without area are dropped.
/// All normals have one of 13 directions up to sign, with components −1, 0 and 1.
///
/// The mesh is closed and *balanced*: every edge is used as often in one direction as in the other. It is not
/// a 2-manifold where sheets touch: where inside cells meet in an edge or a corner only, where a gap between
/// them is one cell wide ([`Snap::Fat`]), or where they are one cell thick ([`Snap::Thin`]). There four or
/// more triangles meet on an edge, and two may coincide with opposite orientations. Vertices at the centre of
/// one cell are one vertex. All vertices are used. Vertices and triangles are in Morton order of the cells.
///
/// Everything outside the universe counts as EMPTY. `resolve` is as in
/// [`marching_cubes`](crate::marching_cubes).
///
/// O(elements of the tree + mesh). In addition to the mesh, up to 128 bytes are needed for each block of 4³
/// cells at the surface. The result is the same for any number of threads.
///
/// # Errors
/// As [`marching_cubes`](crate::marching_cubes).
///
/// ```
/// use leafless::{Control, Csg, Frame, Rule, build, surface::{Snap, simple_marching_cubes}};
/// let frame = Frame::new([0.0; 3], 8.0, 3)?;
/// let block = build(&Csg::cuboid([2.0; 3], [5.0; 3])?, &frame, Rule::Sampled, &Control::default())?;
/// // From the centre of the cell before the block to that of the cell behind it.
/// let mesh = simple_marching_cubes(block.view(), Snap::Fat, None, &Control::default())?;
/// assert_eq!(mesh.bounds(), ([1.5; 3], [5.5; 3]));
/// let mesh = simple_marching_cubes(block.view(), Snap::Thin, None, &Control::default())?;
/// assert_eq!(mesh.bounds(), ([2.5; 3], [4.5; 3]));
/// assert_eq!(mesh.volume(), 8.0);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn simple_marching_cubes(
    tree: &OctreeRef<'_>,
    snap: Snap,
    resolve: Option<Resolve<'_>>,
    control: &Control<'_>,
) -> Result<TriangleMesh, Error> {
    resolved(tree, resolve, control, |tree, partial, control| {
        extract(&Samples::new(tree, partial, u32::MAX)?, &Lattice::new(tree.frame())?, snap, control)
    })
}

/// Extracts the surface of samples.
pub(super) fn extract(
    samples: &Samples<'_>,
    lattice: &Lattice,
    snap: Snap,
    control: &Control<'_>,
) -> Result<TriangleMesh, Error> {
    let job = Job::new(control);
    job.check()?;
    control.run(samples.levels() > 3, |parallel| {
        let mut blocks = Blocks::find(samples, &Least::SAMPLES, &job, parallel)?;
        let table = snap.table();
        let places = places(&mut blocks, table, &job, parallel)?;
        let vertices = vertices(&places, blocks.bias, lattice, &job, parallel)?;
        let triangles = triangles(&blocks, &places, table, &job, parallel)?;
        Ok(TriangleMesh::from_welded(vertices, triangles, 0, 0))
    })
}

/// A block of samples of which some are vertices.
#[derive(Debug, Clone, Copy)]
struct Place {
    key: Key,
    used: u64,
    /// The number of vertices before those of this block.
    vertex: u32,
}

/// Returns the samples that are vertices, and stores in each block the number of triangles before it.
fn places(blocks: &mut Blocks, table: &Snapped, job: &Job<'_>, parallel: bool) -> Result<Vec<Place>, Error> {
    let list = &blocks.list;
    let weight = WHOLE - FINDING - 2 * ((WHOLE - FINDING) / 3);
    let found =
        chunks::map(list.len(), weight, job, parallel, |range| with_popcount(Used { list, range, table }))?;
    let mut places = memory::with_capacity(found.iter().map(|(places, _)| places.len()).sum())?;
    found.iter().for_each(|(of_chunk, _)| places.extend_from_slice(of_chunk));
    merge(&mut places);
    let mut vertices = 0u64;
    for place in &mut places {
        place.vertex = vertices as u32;
        vertices += u64::from(place.used.count_ones());
    }
    let mut triangles = 0u64;
    for (block, count) in blocks.list.iter_mut().zip(found.iter().flat_map(|(_, counts)| counts)) {
        block.triangle = triangles as u32;
        triangles += u64::from(*count);
    }
    if vertices.max(triangles) > u64::from(u32::MAX) {
        return Err(MeshError::TooMany.into());
    }
    (blocks.vertices, blocks.triangles) = (vertices as usize, triangles as usize);
    Ok(places)
}

/// Merges places with the same key.
fn merge(places: &mut Vec<Place>) {
    places.sort_unstable_by_key(|place| place.key);
    places.dedup_by(|next, first| {
        let same = next.key == first.key;
        if same {
            first.used |= next.used;
        }
        same
    });
}

/// The samples that the blocks of a range use, and the blocks' counts of triangles.
struct Used<'a> {
    list: &'a [Block],
    range: Range<usize>,
    table: &'a Snapped,
}

impl Hot for Used<'_> {
    type Output = Result<(Vec<Place>, Vec<u16>), Error>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        let mut counts = memory::with_capacity(self.range.len())?;
        let mut places = Vec::new();
        for i in self.range {
            let block = &self.list[i];
            let corners = Around::of(self.list, i).corners();
            let (mut used, mut count) = ([0u64; 8], 0);
            for c in bits(block.mixed) {
                let configuration = configuration(&corners, c);
                count += u16::from(self.table.triangles[configuration].count);
                for corner in bits(self.table.used[configuration].into()) {
                    let (node, inner) = CORNER_AT[c as usize][corner as usize];
                    used[node as usize] |= 1 << inner;
                }
            }
            counts.push(count);
            places.try_reserve(8)?;
            let nodes = used.into_iter().enumerate().filter(|&(_, used)| used != 0);
            places.extend(nodes.map(|(j, used)| Place { key: key::node(block.key, j), used, vertex: 0 }));
        }
        merge(&mut places);
        Ok((places, counts))
    }
}

fn vertices(
    places: &[Place],
    bias: i32,
    lattice: &Lattice,
    job: &Job<'_>,
    parallel: bool,
) -> Result<Vec<[f64; 3]>, Error> {
    let count = places.last().map_or(0, |last| last.vertex as usize + last.used.count_ones() as usize);
    let mut vertices = memory::filled(count, [0.0; 3])?;
    let (start, weight) = (|i: usize| places[i].vertex as usize, (WHOLE - FINDING) / 3);
    chunks::for_each(places.len(), &mut vertices, start, weight, job, parallel, |range, piece| {
        let mut piece = piece.iter_mut();
        for place in &places[range] {
            let at = key::position(place.key, bias);
            for (c, vertex) in bits(place.used).zip(&mut piece) {
                let inner = morton::position(c);
                *vertex = axes(|axis| lattice.coordinate(axis, 8 * at[axis] + 2 * inner[axis] as i32 + 1));
            }
        }
        Ok(())
    })?;
    Ok(vertices)
}

fn triangles(
    blocks: &Blocks,
    places: &[Place],
    table: &Snapped,
    job: &Job<'_>,
    parallel: bool,
) -> Result<Vec<[u32; 3]>, Error> {
    let mut triangles = memory::filled(blocks.triangles, [0; 3])?;
    let (list, weight) = (&blocks.list, (WHOLE - FINDING) / 3);
    let start = |i: usize| list[i].triangle as usize;
    chunks::for_each(list.len(), &mut triangles, start, weight, job, parallel, |range, piece| {
        with_popcount(Fill { list, range, places, table, piece });
        Ok(())
    })?;
    Ok(triangles)
}

struct Fill<'a> {
    list: &'a [Block],
    range: Range<usize>,
    places: &'a [Place],
    table: &'a Snapped,
    piece: &'a mut [[u32; 3]],
}

impl Hot for Fill<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let mut free = self.piece.iter_mut();
        let mut from = 0;
        for i in self.range {
            let block = &self.list[i];
            let corners = Around::of(self.list, i).corners();
            from = key::seek(self.places, from, block.key, |place| place.key);
            let mut nodes = [Place { key: 0, used: 0, vertex: 0 }; 8];
            for (j, node) in nodes.iter_mut().enumerate() {
                let wanted = key::node(block.key, j);
                let found = self.places.get(key::seek(self.places, from, wanted, |place| place.key));
                if let Some(place) = found.filter(|place| place.key == wanted) {
                    *node = *place;
                }
            }
            for c in bits(block.mixed) {
                let of_cell = &self.table.triangles[configuration(&corners, c)];
                for (triangle, free) in of_cell.list().iter().zip(&mut free) {
                    *free = triangle.each(|corner| {
                        let (node, inner) = CORNER_AT[c as usize][corner as usize];
                        let node = &nodes[node as usize];
                        node.vertex + rank(node.used, inner.into())
                    });
                }
            }
        }
    }
}
