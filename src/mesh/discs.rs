//! Thick discs around the triangles of the lowest nodes of a tree.
//!
//! A box around some triangles of a curved, oblique surface is about as thick as it is wide. A disc parallel
//! to the triangles is much thinner, and bounds the distance across the surface to second order.

use super::signs::Point;
use super::tree::{Place, Tree};
use super::triangle_mesh::TriangleMesh;
use super::triangle_pair::dot;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::sqrt;
use crate::memory;
use alloc::vec::Vec;
use core::array::from_fn as array;

/// Levels of nodes that have discs.
const LEVELS: u8 = 3;

/// An upper bound of rounding errors for coordinates of magnitude at most 1.
const MARGIN: f64 = 1.0 / (1_u64 << 47) as f64;

/// A disc, in the units of the tree's grid.
#[derive(Clone, Copy)]
struct Disc {
    centre: Point,
    /// A unit vector.
    normal: Point,
    /// Half of the thickness.
    half: f64,
    radius: f64,
}

/// The discs of a mesh. 21 bytes a triangle.
pub(crate) struct Discs(Vec<Disc>);

impl Discs {
    /// Builds the discs for the tree of a mesh. O(t).
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub(super) fn new(mesh: &TriangleMesh, tree: &Tree) -> Result<Discs, Error> {
        let Some(root) = tree.root() else { return Ok(Discs(Vec::new())) };
        let count =
            if root.level < LEVELS { tree.count() } else { tree.index(Place { level: LEVELS, number: 0 }) };
        let mut discs = memory::with_capacity(count)?;
        let mut corners = Vec::new();
        for level in 0..LEVELS.min(root.level + 1) {
            let mut number = 0;
            while discs.len() < count && tree.index(Place { level, number }) == discs.len() {
                let place = Place { level, number };
                if level < root.level && discs.len() == tree.index(Place { level: level + 1, number: 0 }) {
                    break;
                }
                corners.clear();
                add_corners(mesh, tree, place, &mut corners)?;
                discs.push(Disc::around(&corners));
                number += 1;
            }
        }
        Ok(Discs(discs))
    }

    /// Returns the end of a node's triangles along a vector. `None` if the node has no disc.
    #[inline(always)]
    pub(super) fn end(&self, tree: &Tree, place: Place, way: &Point) -> Option<f64> {
        if place.level >= LEVELS {
            return None;
        }
        let Disc { centre, normal, half, radius } = self.0.get(tree.index(place))?;
        let across = dot(way, normal);
        let along: Point = array(|axis| way[axis] - across * normal[axis]);
        Some(dot(way, centre) + across.abs() * half + sqrt(dot(&along, &along)) * radius)
    }
}

fn add_corners(
    mesh: &TriangleMesh,
    tree: &Tree,
    place: Place,
    corners: &mut Vec<[Point; 3]>,
) -> Result<(), Error> {
    for k in 0..tree.parts(place) {
        if place.level > 0 {
            add_corners(mesh, tree, place.child(k), corners)?;
        } else if let Some(triangle) = tree.triangle(place, k) {
            let at = mesh.triangles()[triangle as usize].each(|vertex| mesh.vertices()[vertex as usize]);
            memory::push(corners, at.each(|p| tree.grid.scaled(&p)))?;
        }
    }
    Ok(())
}

impl Disc {
    fn around(triangles: &[[Point; 3]]) -> Disc {
        let (mut low, mut high, mut sum) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3], [0.0; 3]);
        for [a, b, c] in triangles {
            let [u, v]: [Point; 2] = [b, c].each(|p| array(|axis| p[axis] - a[axis]));
            for axis in 0..3 {
                let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
                sum[axis] += u[i] * v[j] - u[j] * v[i];
                low[axis] = low[axis].min(a[axis]).min(b[axis]).min(c[axis]);
                high[axis] = high[axis].max(a[axis]).max(b[axis]).max(c[axis]);
            }
        }
        // (Any direction of length 1 will do.)
        let length = sqrt(dot(&sum, &sum));
        let normal = if length > 1e-150 { sum.each(|c| c / length) } else { [0.0, 0.0, 1.0] };
        let middle: Point = array(|axis| 0.5 * (low[axis] + high[axis]));
        let from = |p: &Point| -> Point { array(|axis| p[axis] - middle[axis]) };
        let (mut below, mut above) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut square: f64 = 0.0;
        for p in triangles.as_flattened() {
            let way = from(p);
            let across = dot(&way, &normal);
            (below, above) = (below.min(across), above.max(across));
            let along: Point = array(|axis| way[axis] - across * normal[axis]);
            square = square.max(dot(&along, &along));
        }
        let shift = 0.5 * (below + above);
        Disc {
            centre: array(|axis| middle[axis] + shift * normal[axis]),
            normal,
            half: 0.5 * (above - below) + MARGIN,
            radius: sqrt(square) + MARGIN,
        }
    }
}
