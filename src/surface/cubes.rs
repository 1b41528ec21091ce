//! Marching cubes: a surface through the edges between samples.

use super::blocks::{Block, Blocks, FINDING};
use super::chunks;
use super::key;
use super::lattice::Lattice;
use super::masks::{CORNER_AT, bits, configuration, next, rank};
use super::resolve::{Resolve, resolved};
use super::samples::Samples;
use super::size::Least;
use super::table::{ENDS, MARCHING_CUBES};
use crate::control::{Control, Job, WHOLE};
use crate::dispatch::{Hot, with_popcount};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Cell, morton};
use crate::memory;
use crate::mesh::TriangleMesh;
use crate::octree::OctreeRef;
use alloc::vec::Vec;

/// Extracts the surface of an octree by marching cubes. The surface is a closed mesh. Each vertex lies
/// half-way between the centres of two finest cells, one inside and one outside.
///
/// Everything outside the universe counts as EMPTY, so that the mesh is closed. Every edge belongs to exactly
/// two triangles, in opposite directions, even where cells touch in an edge or a corner: inside cells are
/// connected by faces only, outside cells by faces and edges. Triangles turn counter-clockwise as seen from
/// outside. No triangle is degenerate, and no two vertices are equal. Vertices and triangles are in Morton
/// order of the cells.
///
/// `resolve` defines the side of PARTIAL cells; `None` suffices for trees without PARTIAL cells.
///
/// The method is that of Lorensen and Cline (1987). The table follows one rule for faces, so that
/// neighbouring cells always fit together.
///
/// O(elements of the tree + mesh). In addition to the mesh, 56 bytes are needed for each block of 4³ cells at
/// the surface. This is less than a fifth of the mesh, unless the surface consists of corners only. The
/// result is the same for any number of threads.
///
/// # Errors
/// [`Error::Argument`] if the tree has PARTIAL cells and `resolve` is `None`, or if the frame is so far from
/// the origin that doubles cannot distinguish its cells;
/// [`MeshError::TooMany`](crate::error::MeshError::TooMany) for more than 2^32 − 1 vertices or triangles;
/// [`Error::TooLarge`] or [`Error::Limit`] beyond the limits of `control`; [`Error::Damaged`];
/// [`Error::OutOfMemory`]; [`Error::Cancelled`]; and with [`Resolve::Source`] the errors of the solid.
///
/// ```
/// use leafless::{Control, Csg, FillRule, Frame, Rule, build, marching_cubes};
/// let frame = Frame::new([-1.0; 3], 2.0, 6)?;
/// let ball = build(&Csg::ball([0.0; 3], 0.75)?, &frame, Rule::Sampled, &Control::default())?;
/// let mesh = marching_cubes(ball.view(), None, &Control::default())?;
/// mesh.check_closed(FillRule::NonZero)?;
/// assert!((mesh.volume() - 1.767).abs() < 0.01);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn marching_cubes(
    tree: &OctreeRef<'_>,
    resolve: Option<Resolve<'_>>,
    control: &Control<'_>,
) -> Result<TriangleMesh, Error> {
    in_memory((Vec::new(), Vec::new()), tree, resolve, control)
}

/// [`marching_cubes`] in the memory of a mesh that is no longer needed, for a part that changes and is drawn
/// repeatedly. Memory is allocated only if the new mesh is larger.
///
/// # Errors
/// As [`marching_cubes`]; the memory of the old mesh is then released.
///
/// ```
/// use leafless::{Control, Csg, Frame, Rule, build, marching_cubes, surface::marching_cubes_reusing};
/// let (frame, control) = (Frame::new([-1.0; 3], 2.0, 5)?, Control::default());
/// let [large, small] =
///     [0.9, 0.5].map(|radius| build(&Csg::ball([0.0; 3], radius)?, &frame, Rule::Sampled, &control));
/// let mesh = marching_cubes(large?.view(), None, &control)?;
/// let place = mesh.vertices().as_ptr();
/// let mesh = marching_cubes_reusing(mesh, small?.view(), None, &control)?;
/// assert_eq!(mesh.vertices().as_ptr(), place);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn marching_cubes_reusing(
    mesh: TriangleMesh,
    tree: &OctreeRef<'_>,
    resolve: Option<Resolve<'_>>,
    control: &Control<'_>,
) -> Result<TriangleMesh, Error> {
    in_memory(mesh.into_arrays(), tree, resolve, control)
}

/// Extracts the triangles of [`marching_cubes`] in one cell of the frame, with their vertices: the triangles
/// of the dual cells whose first sample lies in the cell. The surfaces of all cells of a level together are
/// the surface of the tree, each triangle once. Vertices at one place have bit-identical coordinates. So the
/// surface of a [sharded](crate::Shard) octree can be made cell by cell. Each cell needs its own shard and
/// those of up to seven neighbours towards +x, +y and +z, and nothing further away.
///
/// # Errors
/// As [`marching_cubes`]; [`Error::Argument`] if the cell does not belong to the frame, or has less than 4³
/// finest cells.
///
/// ```
/// use leafless::surface::{Resolve, marching_cubes_in};
/// use leafless::{Cell, Control, Csg, Frame, Rule, build, marching_cubes};
/// let (frame, control) = (Frame::new([-1.0; 3], 2.0, 6)?, Control::default());
/// let ball = build(&Csg::ball([0.0; 3], 0.75)?, &frame, Rule::Sampled, &control)?;
/// let part = |octant| marching_cubes_in(ball.view(), None, Cell::ROOT.child(octant), &control);
/// let parts = (0..8).map(|octant| Ok(part(octant)?.triangles().len()));
/// let count: usize = parts.collect::<Result<Vec<_>, leafless::Error>>()?.iter().sum();
/// assert_eq!(count, marching_cubes(ball.view(), None, &control)?.triangles().len());
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn marching_cubes_in(
    tree: &OctreeRef<'_>,
    resolve: Option<Resolve<'_>>,
    cell: Cell,
    control: &Control<'_>,
) -> Result<TriangleMesh, Error> {
    let depth = tree.frame().depth();
    if cell.level > depth
        || cell.level + BLOCK_LEVELS > depth
        || cell.at.iter().any(|&a| a >> cell.level != 0)
    {
        return Err(Error::Argument {
            name: "cell",
            problem: "must belong to the frame and contain at least 4³ finest cells",
        });
    }
    resolved(tree, resolve, control, |tree, partial, control| {
        let samples = Samples::new(tree, partial, u32::MAX)?;
        let lattice = Lattice::new(tree.frame())?;
        let job = Job::new(control);
        job.check()?;
        control.run(samples.levels() > 3, |parallel| {
            let blocks = Blocks::find(&samples, &Least::CUBES, &job, parallel)?;
            let vertices = midpoints(Vec::new(), &blocks, &lattice, &job, parallel)?;
            let triangles = triangles(Vec::new(), &blocks, &job, parallel)?;
            let shift = depth - BLOCK_LEVELS - cell.level;
            let is_inside = |block: &Block| {
                // Dual cells before the first samples belong to the cells of the first samples.
                let at = key::position(block.key, blocks.bias);
                at.iter().zip(cell.at).all(|(&at, own)| at.max(0) as u32 >> shift == own)
            };
            let (mut own, mut list, mut used) = (Vec::new(), Vec::new(), Vec::new());
            let mut numbers = memory::refilled(Vec::new(), vertices.len(), u32::MAX)?;
            for (i, _) in blocks.list.iter().enumerate().filter(|(_, block)| is_inside(block)) {
                let end = blocks.list.get(i + 1).map_or(triangles.len(), |next| next.triangle as usize);
                for triangle in &triangles[blocks.list[i].triangle as usize..end] {
                    memory::push(&mut list, *triangle)?;
                    for &vertex in triangle {
                        let number = &mut numbers[vertex as usize];
                        if *number == u32::MAX {
                            *number = 0;
                            memory::push(&mut used, vertex)?;
                        }
                    }
                }
            }
            used.sort_unstable();
            for (number, &vertex) in (0..).zip(&used) {
                numbers[vertex as usize] = number;
                memory::push(&mut own, vertices[vertex as usize])?;
            }
            for triangle in &mut list {
                *triangle = triangle.each(|vertex| numbers[vertex as usize]);
            }
            Ok(TriangleMesh::from_welded(own, list, 0, 0))
        })
    })
}

/// The number of levels between a block and its samples.
const BLOCK_LEVELS: u8 = 2;

fn in_memory(
    memory: (Vec<[f64; 3]>, Vec<[u32; 3]>),
    tree: &OctreeRef<'_>,
    resolve: Option<Resolve<'_>>,
    control: &Control<'_>,
) -> Result<TriangleMesh, Error> {
    resolved(tree, resolve, control, |tree, partial, control| {
        let samples = Samples::new(tree, partial, u32::MAX)?;
        let lattice = Lattice::new(tree.frame())?;
        let job = Job::new(control);
        job.check()?;
        control.run(samples.levels() > 3, |parallel| {
            let blocks = Blocks::find(&samples, &Least::CUBES, &job, parallel)?;
            let vertices = midpoints(memory.0, &blocks, &lattice, &job, parallel)?;
            let triangles = triangles(memory.1, &blocks, &job, parallel)?;
            Ok(TriangleMesh::from_welded(vertices, triangles, 0, 0))
        })
    })
}

/// Places vertices in the middles of cut edges, in the memory of a list.
pub(super) fn midpoints(
    memory: Vec<[f64; 3]>,
    blocks: &Blocks,
    lattice: &Lattice,
    job: &Job<'_>,
    parallel: bool,
) -> Result<Vec<[f64; 3]>, Error> {
    let mut vertices = memory::refilled(memory, blocks.vertices, [0.0; 3])?;
    let (list, weight) = (&blocks.list, (WHOLE - FINDING) / 2);
    let start = |i: usize| list[i].vertex as usize;
    chunks::for_each(list.len(), &mut vertices, start, weight, job, parallel, |range, piece| {
        with_popcount(Midpoints { blocks: &list[range], bias: blocks.bias, lattice, piece });
        Ok(())
    })?;
    Ok(vertices)
}

struct Midpoints<'a> {
    blocks: &'a [Block],
    bias: i32,
    lattice: &'a Lattice,
    piece: &'a mut [[f64; 3]],
}

impl Hot for Midpoints<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let mut places = self.piece.iter_mut();
        for block in self.blocks {
            let at = key::position(block.key, self.bias);
            let mut along = [[0.0; 9]; 3];
            for axis in 0..3 {
                for (k, x) in (0..).zip(&mut along[axis]) {
                    *x = self.lattice.coordinate(axis, 8 * at[axis] + 1 + k);
                }
            }
            for axis in 0..3 {
                for (c, vertex) in bits(block.cut[axis]).zip(&mut places) {
                    let mut place = morton::position(c).each(|place| 2 * place as usize);
                    place[axis] += 1;
                    *vertex = [along[0][place[0]], along[1][place[1]], along[2][place[2]]];
                }
            }
        }
    }
}

/// Makes the triangles of a surface, in the memory of a list.
pub(super) fn triangles(
    memory: Vec<[u32; 3]>,
    blocks: &Blocks,
    job: &Job<'_>,
    parallel: bool,
) -> Result<Vec<[u32; 3]>, Error> {
    let mut triangles = memory::refilled(memory, blocks.triangles, [0; 3])?;
    let (list, weight) = (&blocks.list, (WHOLE - FINDING) / 2);
    let start = |i: usize| list[i].triangle as usize;
    chunks::for_each(list.len(), &mut triangles, start, weight, job, parallel, |range, piece| {
        with_popcount(Fill { list, range, piece });
        Ok(())
    })?;
    Ok(triangles)
}

struct Fill<'a> {
    list: &'a [Block],
    range: core::ops::Range<usize>,
    piece: &'a mut [[u32; 3]],
}

impl Hot for Fill<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let mut places = self.piece.iter_mut();
        for i in self.range {
            let around = Around::of(self.list, i);
            let corners = around.corners();
            for c in bits(self.list[i].mixed) {
                let of_cell = &MARCHING_CUBES[configuration(&corners, c)];
                for (triangle, place) in of_cell.list().iter().zip(&mut places) {
                    *place = triangle.each(|edge| around.vertex(c, edge));
                }
            }
        }
    }
}

/// A block and its neighbours: their cut edges, and the first vertices of these.
pub(super) struct Around {
    inside: u64,
    cut: [[u64; 3]; 8],
    vertex: [[u32; 3]; 8],
}

/// The dual cells that have samples in node j.
pub(super) const AT_NODE: [u64; 8] = {
    let mut masks = [!0; 8];
    let mut i = 0;
    while i < 24 {
        let (j, axis) = (i / 3, i % 3);
        if j >> axis & 1 != 0 {
            masks[j] &= morton::SLAB[axis][3];
        }
        i += 1;
    }
    masks
};

impl Around {
    /// Collects block `i` of a list and its neighbours. Neighbours with cut edges are always in the list.
    #[inline(always)]
    pub fn of(list: &[Block], i: usize) -> Around {
        let block = &list[i];
        // No edge of a dual cell begins at its last corner.
        let wanted = (1..7).fold(0, |wanted, j| wanted | u64::from(block.mixed & AT_NODE[j] != 0) << j);
        let nodes = key::find_nodes(list, i, block.key, wanted, |block| block.key);
        let mut around = Around { inside: block.inside, cut: [[0; 3]; 8], vertex: [[0; 3]; 8] };
        for (j, node) in nodes.iter().enumerate() {
            if let Some(block) = node.and_then(|place| list.get(place)) {
                let [x, y, _] = block.cut;
                let second = block.vertex + x.count_ones();
                around.cut[j] = block.cut;
                around.vertex[j] = [block.vertex, second, second + y.count_ones()];
            }
        }
        around
    }

    /// The samples at the corners of dual cells. Correct for mixed dual cells only.
    #[inline(always)]
    pub fn corners(&self) -> [u64; 8] {
        let cut = |j: usize, axis: usize| self.cut[j][axis];
        let [x, y, z] = self.cut[0];
        let z_at_x = next(z, cut(1, 2), 0);
        let z_at_xy = next(z_at_x, next(cut(2, 2), cut(3, 2), 0), 1);
        let first = self.inside;
        let (at_x, at_y) = (first ^ x, first ^ y);
        let at_xy = at_x ^ next(y, cut(1, 1), 0);
        [first, at_x, at_y, at_xy, first ^ z, at_x ^ z_at_x, at_y ^ next(z, cut(2, 2), 1), at_xy ^ z_at_xy]
    }

    /// Returns the number of the vertex on an edge of dual cell `c`.
    #[inline(always)]
    pub fn vertex(&self, c: u32, edge: u8) -> u32 {
        let lower = ENDS[edge as usize][0];
        let (node, inner) = CORNER_AT[c as usize][lower as usize];
        let (node, axis) = (node as usize, edge as usize / 4);
        self.vertex[node][axis] + rank(self.cut[node][axis], inner.into())
    }
}
