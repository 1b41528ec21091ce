//! Division of intersecting triangles into pieces that do not intersect.
//!
//! If no other triangle meets the interior of a piece, the winding number is constant right in front of the
//! piece and constant behind it: the whole piece belongs to the boundary, or no part of it does. Pieces that
//! do meet triangles are divided into four until they are small.
//!
//! Corners of pieces are midpoints of midpoints, and rounding moves them off their triangle. The test whether
//! a piece meets a triangle therefore uses a margin that is many times as wide. Triangles that are too thin
//! for the margin are not divided.

use super::intersections::corners;
use super::sheets::in_front_at;
use super::sides::Sides;
use super::signs::Point;
use super::triangle_mesh::{FillRule, TriangleMesh};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::sqrt;
use crate::memory;
use alloc::collections::VecDeque;
use alloc::vec::Vec;
use core::array::from_fn as array;

/// The distance within which the test of a piece against a triangle is undecided, relative to the largest
/// coordinate. (Sums of three products are right to 2^-50 of that, and corners of pieces to 2^-46.)
const MARGIN: f64 = 1.0 / (1u64 << 40) as f64;

/// Triangles are divided if twice their area is at least `THIN` times the square of their longest side, and
/// pieces if their longest side is at least `SHORT` times the largest coordinate: their inscribed circle then
/// has a radius of at least 2^-41 of the coordinate.
const THIN: f64 = 1.0 / (1u64 << 17) as f64;
const SHORT: f64 = 1.0 / (1u64 << 22) as f64;

/// Maximum number of pieces to process.
const MOST: usize = 1 << 19;

/// The triangles of a closed mesh for which it is unknown whether they bound the solid, as pieces.
pub(crate) struct Pieces {
    /// The pieces that belong to the boundary.
    pub(crate) sure: Vec<[Point; 3]>,
    /// The pieces that may belong to the boundary; no other pieces do.
    pub(crate) doubtful: Vec<[Point; 3]>,
    /// Maximum distance of corners from the mesh.
    pub(crate) rounding: f64,
}

/// A piece to process, and the triangles that may meet it.
struct Piece {
    corners: [Point; 3],
    owner: u32,
    others: Vec<u32>,
}

impl TriangleMesh {
    /// Divides the triangles of a mesh, closed under `rule`, for which `sides` has no answer. Pieces that
    /// meet other triangles have sides no longer than `size` (model units). `None` if there would be too many
    /// pieces, or if triangles lie on each other and would meet everywhere.
    ///
    /// O(l / size) pieces for lines of intersection of the length l; a piece costs time in proportion to the
    /// number of triangles that meet it.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`], and [`Error::Cancelled`] by `control`.
    pub(crate) fn pieces(
        &self,
        sides: &Sides,
        rule: FillRule,
        size: f64,
        control: &Control<'_>,
    ) -> Result<Option<Pieces>, Error> {
        if sides.lie_on_each_other(self, control)? {
            return Ok(None);
        }
        let tree = self.tree(control)?;
        let most = self.vertices().iter().flatten().fold(0.0, |most: f64, c| most.max(c.abs()));
        // (Moved vertices may lie elsewhere, each by this distance.)
        let margin = MARGIN * most + 4.0 * self.radius();
        let mut found = Pieces { sure: Vec::new(), doubtful: Vec::new(), rounding: MARGIN * most };
        let mut open = VecDeque::new();
        for triangle in 0..self.triangles().len() as u32 {
            if sides.of(triangle).is_none() && !sides.is_flat(triangle) {
                let mut others = Vec::new();
                sides.meeting(triangle).try_for_each(|other| memory::push(&mut others, other))?;
                open.try_reserve(1)?;
                open.push_back(Piece { corners: corners(self, triangle), owner: triangle, others });
            }
        }
        let mut count = 0;
        while let Some(mut piece) = open.pop_front() {
            count += 1;
            if count % 1024 == 0 {
                control.check()?;
            }
            piece.others.retain(|&other| !are_apart(&piece.corners, &corners(self, other), margin));
            let (length, area) = shape(&piece.corners);
            let is_plump = area >= THIN * length * length && length >= SHORT * most;
            if piece.others.is_empty() && is_plump {
                let [a, b, c] = piece.corners;
                let middle: Point = array(|k| a[k] + ((b[k] - a[k]) + (c[k] - a[k])) / 3.0);
                match in_front_at(self, tree, piece.owner, &middle, rule) {
                    None => memory::push(&mut found.doubtful, piece.corners)?,
                    Some(front) if rule.encloses(front + 1) != rule.encloses(front) => {
                        memory::push(&mut found.sure, piece.corners)?;
                    }
                    Some(_) => {}
                }
                continue;
            }
            if length <= size || !is_plump {
                memory::push(&mut found.doubtful, piece.corners)?;
                continue;
            }
            if count + open.len() >= MOST {
                return Ok(None);
            }
            let [a, b, c] = piece.corners;
            let between = |p: Point, q: Point| -> Point { array(|k| p[k].midpoint(q[k])) };
            let [ab, bc, ca] = [between(a, b), between(b, c), between(c, a)];
            open.try_reserve(4)?;
            for corners in [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]] {
                open.push_back(Piece { corners, owner: piece.owner, others: memory::copied(&piece.others)? });
            }
        }
        Ok(Some(found))
    }
}

fn minus(a: &Point, b: &Point) -> Point {
    array(|k| a[k] - b[k])
}

fn cross(a: &Point, b: &Point) -> Point {
    array(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
}

fn dot(a: &Point, b: &Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Returns the longest side, and twice the area.
fn shape([a, b, c]: &[Point; 3]) -> (f64, f64) {
    let [u, v, w] = [minus(b, a), minus(c, a), minus(c, b)];
    let normal = cross(&u, &v);
    let square = dot(&u, &u).max(dot(&v, &v)).max(dot(&w, &w));
    (sqrt(square), sqrt(dot(&normal, &normal)))
}

/// Returns whether two triangles are surely more than `margin` apart, along a direction in which one of them
/// ends. (The rounding of the direction's coordinates does no harm: any direction is valid.)
fn are_apart(a: &[Point; 3], b: &[Point; 3], margin: f64) -> bool {
    let is_between = |way: &Point| {
        let ends = |corners: &[Point; 3]| {
            let [x, y, z] = corners.each(|corner| dot(way, &corner));
            [x.min(y).min(z), x.max(y).max(z)]
        };
        let ([low, high], [from, to]) = (ends(a), ends(b));
        // (False for NaN.)
        (from - high).max(low - to) > margin * sqrt(dot(way, way))
    };
    let sides = |[p, q, r]: &[Point; 3]| [minus(q, p), minus(r, q), minus(p, r)];
    let (of_a, of_b) = (sides(a), sides(b));
    let mut axes = [[0.0; 3]; 3];
    (0..3).for_each(|k| axes[k][k] = 1.0);
    let normals = [cross(&of_a[0], &of_a[1]), cross(&of_b[0], &of_b[1])];
    let within =
        |normal: &Point, sides: &[Point; 3]| sides.iter().any(|side| is_between(&cross(normal, side)));
    axes.iter().chain(&normals).any(is_between)
        || of_a.iter().any(|one| of_b.iter().any(|other| is_between(&cross(one, other))))
        || within(&normals[0], &of_a)
        || within(&normals[1], &of_b)
}
