//! Search for the triangles that may meet a box.
//!
//! A triangle misses a box if a plane separates them: across an axis, along the triangle, or along an edge of
//! each (separating axis theorem; for boxes Akenine-Möller 2001). Only a separation that exceeds the rounding
//! errors counts.

use crate::lattice::Each;
use core::array::from_fn as array;

use super::intersections::corners;
use super::nearest::TriangleTree;
use super::signs::Point;
use crate::lattice::Bounds;

/// Upper bound of the rounding error of a product of two coordinates, relative to their magnitudes.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// Maximum error of the tree's boxes, in the scale of the grid: 2^-22.
const SINGLE: f64 = 1.0 / (1 << 22) as f64;

impl TriangleTree<'_> {
    /// Calls `visit` with every triangle that meets a closed box (model units), and perhaps with some that
    /// come very near it.
    pub(crate) fn in_box(&self, bounds: &Bounds, visit: &mut impl FnMut(u32)) {
        self.in_box_of(bounds, |_| true, visit);
    }

    /// Does the same for the triangles that `wanted` accepts.
    pub(crate) fn in_box_of(
        &self,
        bounds: &Bounds,
        wanted: impl Fn(u32) -> bool,
        visit: &mut impl FnMut(u32),
    ) {
        let displacement = self.mesh.displacement();
        let centre: Point = array(|axis| 0.5 * bounds.min[axis] + 0.5 * bounds.max[axis]);
        let half: Point = array(|axis| {
            let half = (bounds.max[axis] - centre[axis]).max(centre[axis] - bounds.min[axis]);
            half + displacement + ROUNDING * (half + centre[axis].abs())
        });
        let grid = &self.tree.grid;
        let (at, scale) = (grid.scaled(&centre), grid.scale());
        let slack = SINGLE * at.iter().fold(1.0, |most: f64, x| most.max(x.abs()));
        // (Single precision rounds to nearest, within the slack.)
        let [low, high] = [-1.0, 1.0].each(|sign| {
            array(|axis| (at[axis] + sign * (half[axis] * scale * (1.0 + SINGLE) + slack)) as f32)
        });
        self.tree.within(low, high, &mut |triangle| {
            if !wanted(triangle) {
                return;
            }
            let seen = corners(self.mesh, triangle).each(|corner| array(|axis| corner[axis] - centre[axis]));
            if !is_separated(&seen, &half) {
                visit(triangle);
            }
        });
    }
}

/// Returns whether a plane surely separates a triangle from the box around the origin with these half edges.
fn is_separated(corners: &[Point; 3], half: &Point) -> bool {
    let [a, b, c] = corners;
    let edge = |p: &Point, q: &Point| -> Point { array(|axis| q[axis] - p[axis]) };
    let edges = [edge(a, b), edge(b, c), edge(c, a)];
    let units: [Point; 3] = array(|axis| array(|k| if k == axis { 1.0 } else { 0.0 }));
    // Upper bounds of the edges' lengths, and of the distances of corners and box.
    let length = edges.iter().flatten().fold(0.0, |most: f64, c| most.max(c.abs()));
    let far = corners.iter().flatten().chain(half).fold(0.0, |most: f64, c| most.max(c.abs()));
    // Each direction with the magnitude of its terms.
    let across = edges.iter().flat_map(|edge| units.iter().map(|unit| (cross(unit, edge), length)));
    let along = [(cross(&edges[0], &edges[1]), length * length)];
    units.iter().map(|&unit| (unit, 0.0)).chain(along).chain(across).any(|(way, size)| {
        let places = corners.each(|corner| (0..3).map(|k| way[k] * corner[k]).sum::<f64>());
        let reach: f64 = (0..3).map(|k| way[k].abs() * half[k]).sum();
        let most = way.iter().fold(size, |most, c| most.max(c.abs()));
        let wrong = ROUNDING * most * far;
        let (low, high) = (places[0].min(places[1]).min(places[2]), places[0].max(places[1]).max(places[2]));
        low > reach + wrong || high < -reach - wrong
    })
}

fn cross(u: &Point, v: &Point) -> Point {
    array(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        u[i] * v[j] - u[j] * v[i]
    })
}
