//! Convex polygons in the coordinates of a cell, from its centre in half edges.

use super::piece::dot;
use crate::lattice::axes;

/// The maximal number of corners of a polygon: four of a face, and one more for each plane.
const MOST: usize = 16;

/// A convex polygon.
#[derive(Clone, Copy)]
pub(super) struct Polygon {
    corners: [[f64; 3]; MOST],
    count: usize,
}

impl Polygon {
    /// Builds a square across an axis, at a coordinate.
    pub(super) fn square(axis: usize, at: f64, half: f64) -> Polygon {
        let mut corners = [[0.0; 3]; MOST];
        for (corner, [u, v]) in corners.iter_mut().zip([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]) {
            (corner[axis], corner[(axis + 1) % 3], corner[(axis + 2) % 3]) = (at, u * half, v * half);
        }
        Polygon { corners, count: 4 }
    }

    /// Builds the intersection of the plane n · x = level with the cube [-half, half]³, up to rounding.
    pub(super) fn of_plane(normal: [f64; 3], level: f64, half: f64) -> Polygon {
        let axis =
            (1..3).fold(0, |most, axis| if normal[axis].abs() > normal[most].abs() { axis } else { most });
        let mut polygon = Polygon::square(axis, 0.0, half);
        for corner in &mut polygon.corners[..4] {
            corner[axis] = (level - dot(normal, *corner)) / normal[axis];
        }
        for side in [1.0, -1.0] {
            let mut towards = [0.0; 3];
            towards[axis] = side;
            polygon.clip(towards, half);
        }
        polygon
    }

    /// Removes the part outside of n · x ≤ offset.
    pub(super) fn clip(&mut self, normal: [f64; 3], offset: f64) {
        let old = *self;
        let height = |k: usize| dot(normal, old.corners[k]) - offset;
        self.count = 0;
        for k in 0..old.count {
            let next = (k + 1) % old.count;
            let (a, b) = (height(k), height(next));
            // (NaN does not lie there.)
            if a <= 0.0 {
                self.push(old.corners[k]);
            }
            if a < 0.0 && b > 0.0 || a > 0.0 && b < 0.0 {
                let t = a / (a - b);
                let (from, to) = (old.corners[k], old.corners[next]);
                self.push(axes(|axis| from[axis] + t * (to[axis] - from[axis])));
            }
        }
    }

    fn push(&mut self, corner: [f64; 3]) {
        if let Some(place) = self.corners.get_mut(self.count) {
            *place = corner;
            self.count += 1;
        }
    }

    /// The corners, if there are at least three.
    pub(super) fn corners(&self) -> &[[f64; 3]] {
        if self.count < 3 { &[] } else { &self.corners[..self.count] }
    }
}
