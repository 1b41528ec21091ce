//! A mesh on a lattice.
//!
//! Vertices become lattice coordinates in doubles, each with a bound of its error (zero if the position is a
//! double, as in lattice-aligned parts), and with its exact *ranks* among the planes of cell centres. Bulk
//! work uses these coordinates and ranks. Exact arithmetic on the original coordinates decides the rest.

use crate::error::{Error, MeshError};
use crate::lattice::Each;
use crate::lattice::Frame;
use crate::lattice::exact::{floor, two_diff, two_product};
use crate::memory;
use crate::mesh::TriangleMesh;
use alloc::sync::Arc;
use alloc::vec::Vec;

/// A bound of the relative error of one rounded subtraction and one rounded division: slightly more than
/// 2^-52.
const UNIT: f32 = f32::EPSILON * f32::EPSILON / 32.0;

/// A vertex in finest cells, from the frame's origin.
#[derive(Debug, Clone, Copy)]
pub(super) struct Vertex {
    /// The position.
    pub(super) at: [f64; 3],
    /// A bound of the position's error along each axis.
    pub(super) error: [f32; 3],
    /// For each axis, the first plane of cell centres that counts as above the vertex: the least k with k + ½
    /// ≥ position. Exact. (All centres are shifted by (ε, ε², ε³), so that a centre at the vertex's own
    /// height lies above it.) Far outside the universe only the side is right.
    pub(super) rank: [i32; 3],
    /// Whether the position is exact and has so few bits that determinants of such vertices and cell centres
    /// are computed without rounding.
    pub(super) short: bool,
}

/// A mesh on the lattice of a frame.
pub(super) struct Placed {
    pub(super) frame: Frame,
    pub(super) mesh: Arc<TriangleMesh>,
    /// The greatest distance of the surface from the mesh along an axis, in finest cells: moves that closed
    /// hair cracks, and the stated deviation.
    pub(super) displacement: f64,
    /// The greatest Euclidean distance of the surface from the mesh, in finest cells.
    pub(super) radius: f64,
    vertices: Vertices,
    /// The triangles that close the surface. Their numbers follow the numbers of the mesh's triangles.
    pub(super) caps: Vec<[u32; 3]>,
}

/// The vertices as one array per field, because most triangles need only the ranks. 37 bytes a vertex.
#[derive(Default)]
struct Vertices {
    at: Vec<[f64; 3]>,
    ranks: Vec<[i32; 3]>,
    /// Bit k < 3: the position is exact along axis k. Bit 3: the vertex is short.
    flags: Vec<u8>,
}

const SHORT: u8 = 1 << 3;

impl Vertices {
    fn new(mesh: &TriangleMesh, frame: &Frame) -> Result<Vertices, Error> {
        let mut vertices = Vertices::default();
        let count = mesh.vertices().len();
        vertices.at.try_reserve_exact(count)?;
        vertices.ranks.try_reserve_exact(count)?;
        vertices.flags.try_reserve_exact(count)?;
        for &vertex in mesh.vertices() {
            let (at, rank, flags) = place(frame, vertex);
            vertices.at.push(at);
            vertices.ranks.push(rank);
            vertices.flags.push(flags);
        }
        Ok(vertices)
    }

    #[inline(always)]
    fn get(&self, vertex: u32) -> Vertex {
        let (at, flags) = (self.at[vertex as usize], self.flags[vertex as usize]);
        let error = |axis: usize| if flags >> axis & 1 != 0 { 0.0 } else { error_of(at[axis]) };
        let rank = self.ranks[vertex as usize];
        Vertex { at, error: [error(0), error(1), error(2)], rank, short: flags & SHORT != 0 }
    }
}

/// A bound of the error of a rounded position.
#[inline(always)]
fn error_of(at: f64) -> f32 {
    (at.abs() as f32 * UNIT).max(UNIT)
}

/// The three corners of a triangle.
pub(super) type Corners = [Vertex; 3];

impl Placed {
    /// The bytes of the vertices and caps.
    pub(super) fn bytes(&self) -> usize {
        let Vertices { at, ranks, flags } = &self.vertices;
        memory::bytes_of(at)
            + memory::bytes_of(ranks)
            + memory::bytes_of(flags)
            + memory::bytes_of(&self.caps)
    }

    /// Places a mesh, without caps.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub(super) fn new(mesh: Arc<TriangleMesh>, frame: &Frame) -> Result<Placed, Error> {
        let vertices = Vertices::new(&mesh, frame)?;
        let [displacement, radius] = [mesh.displacement(), mesh.radius()]
            .each(|distance| distance / frame.cell_size() * (1.0 + 4.0 * f64::EPSILON));
        Ok(Placed { frame: *frame, mesh, displacement, radius, vertices, caps: Vec::new() })
    }

    /// Adds the caps.
    ///
    /// # Errors
    /// [`MeshError::TooMany`] if `u32` cannot number all triangles.
    pub(super) fn close(&mut self, caps: Vec<[u32; 3]>) -> Result<(), Error> {
        if u32::try_from(self.mesh.triangles().len() + caps.len()).is_err() {
            return Err(MeshError::TooMany.into());
        }
        self.caps = caps;
        Ok(())
    }

    /// The number of triangles of the surface and its caps.
    pub(super) fn count(&self) -> u32 {
        (self.mesh.triangles().len() + self.caps.len()) as u32
    }

    /// The number of a cap among all triangles.
    pub(super) fn cap(&self, cap: u32) -> u32 {
        self.mesh.triangles().len() as u32 + cap
    }

    pub(super) fn is_cap(&self, triangle: u32) -> bool {
        triangle as usize >= self.mesh.triangles().len()
    }

    #[inline(always)]
    pub(super) fn vertex(&self, vertex: u32) -> Vertex {
        self.vertices.get(vertex)
    }

    /// The position of a vertex.
    #[inline(always)]
    pub(super) fn at(&self, vertex: u32) -> [f64; 3] {
        self.vertices.at[vertex as usize]
    }

    #[inline(always)]
    fn triangle(&self, triangle: u32) -> [u32; 3] {
        let of_mesh = self.mesh.triangles();
        match of_mesh.get(triangle as usize) {
            Some(&triangle) => triangle,
            None => self.caps[triangle as usize - of_mesh.len()],
        }
    }

    #[inline(always)]
    pub(super) fn corners(&self, triangle: u32) -> Corners {
        self.triangle(triangle).each(|vertex| self.vertex(vertex))
    }

    /// The lowest and the highest rank of a triangle's corners along each axis.
    #[inline(always)]
    pub(super) fn rank_box(&self, triangle: u32) -> [[i32; 3]; 2] {
        let [a, b, c] = self.triangle(triangle).each(|vertex| self.vertices.ranks[vertex as usize]);
        let least = |axis: usize| a[axis].min(b[axis]).min(c[axis]);
        let most = |axis: usize| a[axis].max(b[axis]).max(c[axis]);
        [[least(0), least(1), least(2)], [most(0), most(1), most(2)]]
    }

    /// Returns whether the surface lies less than half a cell from the mesh. A vertex of a rank below k is
    /// then below the plane k, a vertex of a rank above k is above it.
    pub(super) fn ranks_tell(&self) -> bool {
        self.displacement < 0.25
    }

    /// The corners as the mesh stores them, in model units.
    pub(super) fn original(&self, triangle: u32) -> [[f64; 3]; 3] {
        self.triangle(triangle).each(|vertex| self.mesh.vertices()[vertex as usize])
    }
}

/// A vertex's position, ranks and flags.
fn place(frame: &Frame, vertex: [f64; 3]) -> ([f64; 3], [i32; 3], u8) {
    let depth = frame.depth() as i32;
    // With `grain` bits behind the binary point, a 3 × 3 determinant of differences needs 51 bits: 3·(depth +
    // grain + 1) + 3.
    let grain = (1u64 << (15 - depth.min(14))) as f64;
    let (mut position, mut ranks, mut exact, mut short) = ([0.0; 3], [0; 3], 0, depth <= 14);
    for axis in 0..3 {
        let (offset, lost) = two_diff(vertex[axis], frame.origin()[axis]);
        // A division returns the exact quotient if it is a double; a product with the reciprocal may miss it.
        let at = offset / frame.cell_size();
        let is_exact = two_product(at, frame.cell_size()) == (offset, lost);
        let error = if is_exact { 0.0 } else { error_of(at) };
        let steps = at * grain;
        short &= is_exact && at.abs() <= frame.cells() as f64 && steps == floor(steps) as f64;
        position[axis] = at;
        ranks[axis] = rank(frame, axis, vertex[axis], at, error as f64);
        exact |= (is_exact as u8) << axis;
    }
    (position, ranks, exact | if short { SHORT } else { 0 })
}

/// The least k with k + ½ ≥ position, exactly.
fn rank(frame: &Frame, axis: usize, original: f64, at: f64, error: f64) -> i32 {
    // Positions beyond all centres of the universe are clamped: they only count as outside.
    let far = frame.cells() as f64 + 1.0;
    let below = (at - 0.5).clamp(-far, far);
    let nearest = floor(below + 0.5);
    if (below - nearest as f64).abs() > error + f64::EPSILON * far.min(at.abs() + 1.0) {
        return -floor(-below) as i32;
    }
    // The position is extremely near to a plane of centres, or on it.
    (nearest + (frame.side(axis, original, 2 * nearest + 1) > 0) as i64) as i32
}

/// The range of planes `first..end` between the lowest and the highest corner along `axis`: a line of centres
/// at k can meet the triangle only if k lies in the range.
#[inline(always)]
pub(super) fn ranks(corners: &Corners, axis: usize) -> (i32, i32) {
    let [a, b, c] = [corners[0].rank[axis], corners[1].rank[axis], corners[2].rank[axis]];
    (a.min(b).min(c), a.max(b).max(c))
}

/// The bounding box of a triangle, widened by its corners' errors; exact if these are zero.
#[inline(always)]
pub(super) fn bounds(placed: &Placed, corners: &Corners) -> ([f64; 3], [f64; 3]) {
    let mut min = [f64::INFINITY; 3];
    let mut max = [f64::NEG_INFINITY; 3];
    for corner in corners {
        for axis in 0..3 {
            let error = corner.error[axis] as f64 + placed.displacement;
            min[axis] = min[axis].min(corner.at[axis] - error);
            max[axis] = max[axis].max(corner.at[axis] + error);
        }
    }
    if placed.displacement > 0.0 {
        // The sums were rounded, too.
        (min, max) = (min.each(f64::next_down), max.each(f64::next_up));
    }
    (min, max)
}

/// The largest error of the corners' positions, and the largest magnitude in computations with them.
pub(super) fn accuracy(placed: &Placed, corners: &Corners) -> (f64, f64) {
    let mut error = 0f32;
    let mut magnitude = placed.frame.cells() as f64;
    for corner in corners {
        for axis in 0..3 {
            error = error.max(corner.error[axis]);
            magnitude = magnitude.max(corner.at[axis].abs());
        }
    }
    (error as f64, magnitude)
}

/// Returns whether determinants of the corners and lattice points are those of the surface, without rounding.
#[inline(always)]
pub(super) fn is_exact(placed: &Placed, corners: &Corners) -> bool {
    placed.displacement == 0.0 && are_short(corners)
}

/// Returns whether determinants of the corners and cell centres are computed without rounding.
#[inline(always)]
pub(super) fn are_short(corners: &Corners) -> bool {
    corners.iter().all(|corner| corner.short)
}
