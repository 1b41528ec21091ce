//! Dual contouring: a vertex in each cube between eight samples, where the planes at its crossings meet.
//!
//! This module makes a mesh from samples and, for each cut edge, a crossing with a normal. Rays, expressions
//! and meshes provide such data. Cubes are numbered block by block, in the order of their lowest samples;
//! vertices are numbered loop by loop in each cube. The quadrilateral of a cut edge belongs to the lowest of
//! the four cubes around the edge. In that cube the edge is the last one along its axis.
//!
//! **Joints.** The sides of quadrilaterals lead from cube to cube. Suppose that a face has two segments, and
//! that in each of its two cubes both segments belong to one loop. Then two sides have the same ends, and
//! four triangles would meet on them. To avoid this, each of the two sides gets a vertex of its own on the
//! face, in the middle of its segment: a joint. So exactly two triangles meet on every edge. Joints are
//! numbered after all other vertices.

use super::blocks::{Block, Blocks, FINDING};
use super::chunks;
use super::cubes::{AT_NODE, Around};
use super::hermite::Hermite;
use super::key;
use super::lattice::Lattice;
use super::loops::LOOPS;
use super::masks::{CORNER_AT, bits, configuration, rank};
use super::qef::Qef;
use super::table::{ENDS, OTHERS};
use super::vanished::is_kept;
use super::weld::weld;
use crate::control::{Job, WHOLE};
use crate::error::{Error, MeshError};
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::morton;
use crate::memory;
use crate::mesh::TriangleMesh;
use alloc::vec::Vec;
use core::sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed};

/// Counts of exceptional vertices and bodies.
#[derive(Debug, Clone, Copy)]
pub(super) struct DualCounts {
    /// Vertices without a plane.
    pub means: u64,
    /// Vertices that would fit better outside of their cubes.
    pub clamped: u64,
    /// Bodies without triangles.
    pub vanished: u64,
}

/// Two diagonals count as equal if their distances from the crossing differ by less than this part of a cell.
const ALIKE: f64 = 1.0 / (1 << 20) as f64;

/// The crossings of the cut edges. Edges have the numbers of the vertices of marching cubes.
pub(super) trait Crossings: Sync {
    fn at(&self, edge: u32) -> Hermite;

    /// Returns the number of bodies without a triangle; `covered` says for each edge whether it has one.
    fn vanished(&self, blocks: &Blocks, covered: &[bool]) -> Result<u64, Error>;
}

/// Makes the mesh of the crossings.
///
/// # Errors
/// [`MeshError::TooMany`], [`Error::OutOfMemory`], [`Error::Cancelled`].
pub(super) fn extract(
    crossings: &impl Crossings,
    blocks: &Blocks,
    lattice: &Lattice,
    job: &Job<'_>,
    parallel: bool,
) -> Result<(TriangleMesh, DualCounts), Error> {
    let cubes = Cubes::of(blocks, job, parallel)?;
    let weight = (WHOLE - FINDING) / 4;
    let dual = Dual { blocks, lattice, cubes: &cubes };
    let mut vertices = memory::filled(cubes.vertices + cubes.joints, [0.0; 3])?;
    let (own, joints) = vertices.split_at_mut(cubes.vertices);
    let start = |i: usize| cubes.first_vertex(i);
    let [means, clamped] = [const { AtomicUsize::new(0) }; 2];
    let is_welded = AtomicBool::new(true);
    chunks::for_each(blocks.list.len(), own, start, weight, job, parallel, |range, piece| {
        let mut places = piece.iter_mut();
        for i in range {
            let found = dual.vertices(i, crossings, &mut places);
            means.fetch_add(found.means, Relaxed);
            clamped.fetch_add(found.clamped, Relaxed);
            if !found.is_welded {
                is_welded.store(false, Relaxed);
            }
        }
        Ok(())
    })?;
    let start = |i: usize| cubes.list[i].joint as usize;
    chunks::for_each(blocks.list.len(), joints, start, 0, job, parallel, |range, piece| {
        let mut places = piece.iter_mut();
        for i in range {
            if !dual.joints(i, crossings, &mut places) {
                is_welded.store(false, Relaxed);
            }
        }
        Ok(())
    })?;
    let mut triangles = memory::filled(cubes.triangles, [0; 3])?;
    let start = |i: usize| cubes.list[i].triangle as usize;
    chunks::for_each(blocks.list.len(), &mut triangles, start, weight, job, parallel, |range, piece| {
        let mut places = piece.iter_mut();
        for i in range {
            dual.quads(i, crossings, &vertices, |_, triangle| {
                if let Some(place) = places.next() {
                    *place = triangle;
                }
            });
        }
        Ok(())
    })?;
    let mut bodies = 0;
    let mesh = if is_welded.into_inner() {
        TriangleMesh::from_welded(vertices, triangles, 0, 0)
    } else {
        let mut covered = memory::filled(blocks.vertices, false)?;
        for i in 0..blocks.list.len() {
            job.check()?;
            dual.quads(i, crossings, &vertices, |crossing, triangle| {
                covered[crossing as usize] |= is_kept(&vertices, triangle);
            });
        }
        bodies = crossings.vanished(blocks, &covered)?;
        weld(vertices, triangles)?
    };
    let [means, clamped] = [means, clamped].each(|count| count.into_inner() as u64);
    Ok((mesh, DualCounts { means, clamped, vanished: bodies }))
}

/// A cube between eight samples that the surface crosses.
#[derive(Debug, Clone, Copy, Default)]
struct Cube {
    /// The number of its first vertex.
    vertex: u32,
    configuration: u8,
}

/// The cubes of a block.
#[derive(Debug, Clone, Copy, Default)]
struct CubesOfBlock {
    /// The numbers of the first cube, of the first triangle, and of the first joint among joints.
    cube: u32,
    triangle: u32,
    joint: u32,
    /// For each axis, the cubes with joints at their upper faces.
    jointed: [u64; 3],
}

/// All cubes that the surface crosses.
struct Cubes {
    list: Vec<CubesOfBlock>,
    cubes: Vec<Cube>,
    vertices: usize,
    joints: usize,
    triangles: usize,
}

impl Cubes {
    fn of(blocks: &Blocks, job: &Job<'_>, parallel: bool) -> Result<Cubes, Error> {
        let mut list = memory::with_capacity(blocks.list.len())?;
        let mut count = 0u64;
        for block in &blocks.list {
            list.push(CubesOfBlock { cube: count as u32, ..CubesOfBlock::default() });
            count += u64::from(block.mixed.count_ones());
            if count > u64::from(u32::MAX) {
                return Err(MeshError::TooMany.into());
            }
        }
        let mut cubes = memory::filled(count as usize, Cube::default())?;
        let start = |i: usize| list[i].cube as usize;
        let weight = (WHOLE - FINDING) / 4;
        chunks::for_each(blocks.list.len(), &mut cubes, start, weight, job, parallel, |range, piece| {
            let mut places = piece.iter_mut();
            for i in range {
                let corners = Around::of(&blocks.list, i).corners();
                for (c, place) in bits(blocks.list[i].mixed).zip(&mut places) {
                    place.configuration = configuration(&corners, c) as u8;
                }
            }
            Ok(())
        })?;
        let mut cubes = Cubes { list, cubes, vertices: 0, joints: 0, triangles: 0 };
        cubes.find_joints(blocks, job, parallel)?;
        cubes.number(blocks)?;
        Ok(cubes)
    }

    /// Finds the faces with joints.
    fn find_joints(&mut self, blocks: &Blocks, job: &Job<'_>, parallel: bool) -> Result<(), Error> {
        let mut jointed = memory::filled(blocks.list.len(), [0u64; 3])?;
        let known = &*self;
        chunks::for_each(
            blocks.list.len(),
            &mut jointed,
            |i| i,
            0,
            job,
            parallel,
            |range, piece| {
                for (i, jointed) in range.zip(piece) {
                    let mut candidates = [0u64; 3];
                    for (c, cube) in bits(blocks.list[i].mixed).zip(known.at(i)) {
                        for axis in 0..3 {
                            candidates[axis] |= u64::from(cube.meets_twice(2 * axis + 1)) << c;
                        }
                    }
                    if candidates == [0; 3] {
                        continue;
                    }
                    let nodes = nodes(&blocks.list, i);
                    for axis in 0..3 {
                        for c in bits(candidates[axis]) {
                            let (_, above) = known.beside(blocks, &nodes, c, 1 << axis);
                            jointed[axis] |= u64::from(above.meets_twice(2 * axis)) << c;
                        }
                    }
                }
                Ok(())
            },
        )?;
        for (block, jointed) in self.list.iter_mut().zip(jointed) {
            block.jointed = jointed;
        }
        Ok(())
    }

    /// Numbers vertices, joints and triangles.
    fn number(&mut self, blocks: &Blocks) -> Result<(), Error> {
        let [mut vertices, mut joints, mut triangles] = [0u64; 3];
        let mut rest = self.cubes.iter_mut();
        for (block, own) in blocks.list.iter().zip(&mut self.list) {
            for cube in rest.by_ref().take(block.mixed.count_ones() as usize) {
                cube.vertex = vertices as u32;
                vertices += u64::from(LOOPS[cube.configuration as usize].count);
            }
            own.joint = joints as u32;
            joints += own.jointed.iter().map(|word| 2 * u64::from(word.count_ones())).sum::<u64>();
        }
        // Each joint lies on a side of two quadrilaterals.
        for i in 0..self.list.len() {
            self.list[i].triangle = triangles as u32;
            for cube in self.at(i).iter().take(blocks.list[i].mixed.count_ones() as usize) {
                triangles += 2 * (0..3).filter(|&axis| cube.last_edge(axis).is_some()).count() as u64;
            }
            if joints > 0 {
                triangles += self.sides_with_joints(blocks, i);
            }
            if (vertices + joints).max(triangles) > u64::from(u32::MAX) {
                return Err(MeshError::TooMany.into());
            }
        }
        (self.vertices, self.joints) = (vertices as usize, joints as usize);
        self.triangles = triangles as usize;
        Ok(())
    }

    /// The number of sides of a block's quadrilaterals that have joints.
    fn sides_with_joints(&self, blocks: &Blocks, i: usize) -> u64 {
        let (mut count, nodes) = (0, nodes(&blocks.list, i));
        for (c, cube) in bits(blocks.list[i].mixed).zip(self.at(i)) {
            for axis in (0..3).filter(|&axis| cube.last_edge(axis).is_some()) {
                let sides = sides(axis).into_iter();
                count += sides.filter(|&side| self.joint(blocks, &nodes, c, side).is_some()).count() as u64;
            }
        }
        count
    }

    /// The first of the two joints on a side of a quadrilateral of cube `c`, among all joints.
    #[inline(always)]
    fn joint(
        &self,
        blocks: &Blocks,
        nodes: &[Option<usize>; 8],
        c: u32,
        (step, axis): (usize, usize),
    ) -> Option<u32> {
        let (node, inner) = CORNER_AT[c as usize][step];
        let own = &self.list[nodes[node as usize].filter(|&i| i < blocks.list.len())?];
        if own.jointed[axis] >> inner & 1 == 0 {
            return None;
        }
        let before = own.jointed[..axis].iter().map(|word| word.count_ones()).sum::<u32>();
        Some(own.joint + 2 * (before + rank(own.jointed[axis], inner.into())))
    }

    /// Returns the cube one step further than cube `c` along the axes of `step`, and its block.
    #[inline(always)]
    fn beside(&self, blocks: &Blocks, nodes: &[Option<usize>; 8], c: u32, step: usize) -> (usize, Cube) {
        let (node, inner) = CORNER_AT[c as usize][step];
        let Some(i) = nodes[node as usize] else { unreachable!("a cube at a cut edge is in the list") };
        let before = rank(blocks.list[i].mixed, inner.into());
        (i, self.at(i)[before as usize])
    }

    /// The cubes of a block and all later ones.
    fn at(&self, i: usize) -> &[Cube] {
        &self.cubes[self.list[i].cube as usize..]
    }

    /// The number of the first vertex in a block.
    fn first_vertex(&self, i: usize) -> usize {
        self.at(i).first().map_or(self.vertices, |cube| cube.vertex as usize)
    }
}

impl Cube {
    /// Returns whether the last edge along an axis begins inside; `None` if the edge is not cut.
    #[inline(always)]
    fn last_edge(&self, axis: usize) -> Option<bool> {
        let [low, high] = ENDS[4 * axis + 3].each(|corner| self.configuration >> corner & 1);
        (low != high).then_some(low == 1)
    }

    /// Returns whether one loop has two segments in a face: −x, +x, −y, +y, −z, +z.
    #[inline(always)]
    fn meets_twice(&self, face: usize) -> bool {
        LOOPS[self.configuration as usize].twice >> face & 1 != 0
    }
}

/// The sides of the quadrilaterals along an axis, in cyclic order: the step to the lower one of the two
/// cubes, and the axis along which the other cube lies.
#[inline(always)]
fn sides(axis: usize) -> [(usize, usize); 4] {
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    [(0, u), (1 << u, v), (1 << v, u), (0, v)]
}

/// The blocks that contain the neighbours of block `i`'s cubes.
fn nodes(list: &[Block], i: usize) -> [Option<usize>; 8] {
    let block = &list[i];
    let wanted = (1..7).fold(0, |wanted, j| wanted | u64::from(block.mixed & AT_NODE[j] != 0) << j);
    key::find_nodes(list, i, block.key, wanted, |block| block.key)
}

struct Dual<'a> {
    blocks: &'a Blocks,
    lattice: &'a Lattice,
    cubes: &'a Cubes,
}

/// Counts for the vertices of a block.
struct Found {
    means: usize,
    clamped: usize,
    /// Whether all vertices are distinct, and lie inside their cubes.
    is_welded: bool,
}

impl Dual<'_> {
    /// Places the vertices of a block.
    fn vertices<'p>(
        &self,
        i: usize,
        crossings: &impl Crossings,
        places: &mut impl Iterator<Item = &'p mut [f64; 3]>,
    ) -> Found {
        let block = &self.blocks.list[i];
        let (around, at) = (Around::of(&self.blocks.list, i), key::position(block.key, self.blocks.bias));
        let mut found = Found { means: 0, clamped: 0, is_welded: true };
        for (c, cube) in bits(block.mixed).zip(self.cubes.at(i)) {
            let loops = &LOOPS[cube.configuration as usize];
            let mut qefs = [Qef::default(); 4];
            for (edge, &of) in (0u8..).zip(&loops.of_edge) {
                if let Some(qef) = qefs.get_mut(of as usize) {
                    let hermite = crossings.at(around.vertex(c, edge));
                    let lower = ENDS[edge as usize][0];
                    let mut point = axes(|axis| f64::from(lower >> axis & 1));
                    point[edge as usize / 4] = hermite.t;
                    qef.add(point, hermite.normal());
                }
            }
            let inner = morton::position(c);
            let lower = axes(|axis| f64::from(4 * at[axis] + inner[axis] as i32) + 0.5);
            let bounds =
                |axis: usize| [0.0, 1.0].each(|side| self.lattice.position(axis, lower[axis] + side));
            let bounds = [bounds(0), bounds(1), bounds(2)];
            let mut set = [[0.0; 3]; 4];
            let count = (loops.count as usize).min(4);
            for k in 0..count {
                let minimum = qefs[k].solve();
                found.means += usize::from(minimum.is_mean);
                found.clamped += usize::from(minimum.clamped);
                for axis in 0..3 {
                    let [low, high] = bounds[axis];
                    let x = self.lattice.position(axis, lower[axis] + minimum.at[axis]).clamp(low, high);
                    set[k][axis] = x;
                    found.is_welded &= low < x && x < high;
                }
                found.is_welded &= !set[..k].contains(&set[k]);
            }
            for (vertex, place) in set[..count].iter().zip(places.by_ref()) {
                *place = *vertex;
            }
        }
        found
    }

    /// Places the joints of a block. Returns whether all joints certainly lie at distinct places.
    fn joints<'p>(
        &self,
        i: usize,
        crossings: &impl Crossings,
        places: &mut impl Iterator<Item = &'p mut [f64; 3]>,
    ) -> bool {
        let (block, own) = (&self.blocks.list[i], &self.cubes.list[i]);
        if own.jointed == [0; 3] {
            return true;
        }
        let (around, at) = (Around::of(&self.blocks.list, i), key::position(block.key, self.blocks.bias));
        let mut is_welded = true;
        for axis in 0..3 {
            for c in bits(own.jointed[axis]) {
                let before = rank(block.mixed, c) as usize;
                let configuration = self.cubes.at(i)[before].configuration;
                let inner = morton::position(c);
                let lower = axes(|axis| f64::from(4 * at[axis] + inner[axis] as i32) + 0.5);
                let [b, t] = OTHERS[axis];
                for which in 0..2u8 {
                    // The inside corner that the segment cuts off. The two inside corners are the ends of a
                    // diagonal.
                    let face = 1 << axis | which << b;
                    let corner = face | (!configuration >> face & 1) << t;
                    let mut point = lower;
                    point[axis] += 1.0;
                    for along in [b, t] {
                        let ends = [corner & !(1 << along), corner | 1 << along];
                        let edge = ENDS.iter().position(|&edge| edge == ends);
                        let edge = edge.unwrap_or(0) as u8;
                        let crossing = crossings.at(around.vertex(c, edge)).t;
                        let off = if corner >> along & 1 == 0 { crossing } else { crossing - 1.0 };
                        point[along] += f64::from(corner >> along & 1) + 0.5 * off;
                    }
                    let place = axes(|axis| self.lattice.position(axis, point[axis]));
                    for along in [b, t] {
                        let half = 0.5 * f64::from(corner >> along & 1);
                        let [low, high] =
                            [half, half + 0.5].each(|part| self.lattice.position(along, lower[along] + part));
                        is_welded &= low < place[along] && place[along] < high;
                    }
                    if let Some(vertex) = places.next() {
                        *vertex = place;
                    }
                }
            }
        }
        is_welded
    }

    /// Makes the triangles of a block, each with the number of its crossing.
    fn quads(
        &self,
        i: usize,
        crossings: &impl Crossings,
        vertices: &[[f64; 3]],
        mut each: impl FnMut(u32, [u32; 3]),
    ) {
        let list = &self.blocks.list;
        let block = &list[i];
        let nodes = nodes(list, i);
        let (around, at) = (Around::of(list, i), key::position(block.key, self.blocks.bias));
        for (c, cube) in bits(block.mixed).zip(self.cubes.at(i)) {
            for axis in 0..3 {
                let Some(starts_inside) = cube.last_edge(axis) else { continue };
                // Counter-clockwise as seen from above.
                let (u, v) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
                let mut quad = [0, u, u | v, v].each(|step| self.vertex(&nodes, c, axis, step));
                let mut joints = sides(axis).each(|side| {
                    let first = self.cubes.joint(self.blocks, &nodes, c, side)?;
                    // The number of the segment that ends at this edge: the segment around its inside end.
                    let b = OTHERS[side.1][0];
                    let which = if b == axis { !starts_inside } else { side.0 >> b & 1 == 0 };
                    Some(self.cubes.vertices as u32 + first + u32::from(which))
                });
                let edge = 4 * axis as u8 + 3;
                let inner = morton::position(c);
                let mut crossing = axes(|axis| {
                    let corner = ENDS[edge as usize][0] >> axis & 1;
                    let lower = 4 * at[axis] + inner[axis] as i32 + i32::from(corner);
                    f64::from(lower) + 0.5
                });
                let number = around.vertex(c, edge);
                crossing[axis] += crossings.at(number).t;
                let crossing = axes(|axis| self.lattice.position(axis, crossing[axis]));
                if self.turns(axis, crossing, quad.each(|vertex| vertices[vertex as usize])) {
                    quad.rotate_left(1);
                    joints.rotate_left(1);
                }
                let mut put = |triangle: [u32; 3]| {
                    let [p, q, r] = triangle;
                    each(number, if starts_inside { triangle } else { [p, r, q] });
                };
                let [p, q, r, s] = quad;
                split([p, q, r], [joints[0], joints[1]], &mut put);
                split([r, s, p], [joints[2], joints[3]], &mut put);
            }
        }
    }

    /// Returns the vertex that belongs to the last edge of cube `c` along an axis. It lies in the cube one
    /// step further along the axes of `step`.
    #[inline(always)]
    fn vertex(&self, nodes: &[Option<usize>; 8], c: u32, axis: usize, step: usize) -> u32 {
        let (_, cube) = self.cubes.beside(self.blocks, nodes, c, step);
        let [b, c] = OTHERS[axis].each(|other| !step >> other & 1);
        let edge = 4 * axis + b + 2 * c;
        cube.vertex + u32::from(LOOPS[cube.configuration as usize].of_edge[edge])
    }

    /// Returns whether the diagonal of a quadrilateral between its second and fourth corner is better than
    /// the other one: its triangles meet the edge nearer to the crossing, or the diagonal is shorter.
    fn turns(&self, axis: usize, crossing: [f64; 3], corners: [[f64; 3]; 4]) -> bool {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let cell = self.lattice.cell();
        let [p, q, r, s] =
            corners.each(|corner| [u, v, axis].each(|axis| (corner[axis] - crossing[axis]) / cell));
        let distances = [height([p, q, r, s]), height([q, r, s, p])];
        if let [Some(first), Some(second)] = distances
            && (first.abs() - second.abs()).abs() > ALIKE
        {
            return second.abs() < first.abs();
        }
        let length = |a: [f64; 3], b: [f64; 3]| (0..3).map(|i| (a[i] - b[i]) * (a[i] - b[i])).sum::<f64>();
        length(q, s) < length(p, r)
    }
}

/// Passes on a triangle with joints on its first and its second side. No new edge joins two corners of the
/// triangle.
#[inline(always)]
fn split([p, q, r]: [u32; 3], joints: [Option<u32>; 2], put: &mut impl FnMut([u32; 3])) {
    match joints {
        [None, None] => put([p, q, r]),
        [Some(j), None] => {
            put([p, j, r]);
            put([j, q, r]);
        }
        [None, Some(k)] => {
            put([p, q, k]);
            put([p, k, r]);
        }
        [Some(j), Some(k)] => {
            put([p, j, r]);
            put([j, q, k]);
            put([j, k, r]);
        }
    }
}

/// The height above the origin of a quadrilateral that is split by the diagonal from its first to its third
/// corner. Its corners surround the origin, as seen from above.
fn height([p, q, r, s]: [[f64; 3]; 4]) -> Option<f64> {
    let cross = |a: [f64; 3], b: [f64; 3]| a[0] * b[1] - a[1] * b[0];
    // The last corner lies on the left of the diagonal.
    let [a, b, c] = if cross(p, r) > 0.0 { [p, r, s] } else { [p, q, r] };
    let weights = [cross(b, c), cross(c, a), cross(a, b)];
    let sum = weights[0] + weights[1] + weights[2];
    (sum > ALIKE).then(|| (weights[0] * a[2] + weights[1] * b[2] + weights[2] * c[2]) / sum)
}
