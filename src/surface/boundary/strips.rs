//! Triangles of polygons on curved surfaces: corners are cut off one after the other, first where the new
//! side stays nearest to the surface.

use super::figures::{Figures, dot, middle, minus};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::memory;
use alloc::vec::Vec;

/// A polygon whose corners are cut off.
struct Clipper<'p> {
    figures: &'p Figures,
    surface: u32,
    corners: Vec<u32>,
    places: Vec<[f64; 3]>,
    /// The corners projected along the surface's normal.
    flat: Vec<[f64; 2]>,
    next: Vec<usize>,
    previous: Vec<usize>,
    /// The distance from the surface of the side that would cut off a corner; infinite where the corner
    /// cannot be cut off.
    cost: Vec<f64>,
}

/// Adds the triangles of a polygon on a nearly flat part of a surface. Returns the greatest distance of their
/// sides and their middles from the surface; infinite if the polygon overlaps itself as seen along the
/// normal.
pub(super) fn triangulate(
    figures: &Figures,
    surface: u32,
    corners: &[u32],
    vertices: &[[f64; 3]],
    triangles: &mut Vec<[u32; 3]>,
) -> Result<f64, Error> {
    let count = corners.len();
    if count < 3 {
        return Ok(0.0);
    }
    let places = memory::collected(corners.iter().map(|&corner| vertices[corner as usize]))?;
    let mut clipper = Clipper {
        figures,
        surface,
        corners: memory::copied(corners)?,
        flat: seen(&places)?,
        next: memory::collected((0..count).map(|k| (k + 1) % count))?,
        previous: memory::collected((0..count).map(|k| (k + count - 1) % count))?,
        cost: memory::filled(count, f64::INFINITY)?,
        places,
    };
    for k in 0..count {
        clipper.cost[k] = clipper.cost_of(k);
    }
    let mut most: f64 = 0.0;
    let mut left = count;
    let mut at = 0;
    while left > 3 {
        let (mut best, mut k) = (at, at);
        for _ in 0..left {
            if clipper.cost[k] < clipper.cost[best] {
                best = k;
            }
            k = clipper.next[k];
        }
        most = most.max(clipper.cost[best]).max(clipper.middle(best));
        let (p, n) = (clipper.previous[best], clipper.next[best]);
        memory::push(triangles, [clipper.corners[p], clipper.corners[best], clipper.corners[n]])?;
        clipper.next[p] = n;
        clipper.previous[n] = p;
        left -= 1;
        at = n;
        // A corner that lay in one of these triangles may be gone.
        for k in [p, n] {
            clipper.cost[k] = clipper.cost_of(k);
        }
        let mut k = clipper.next[n];
        while k != p {
            if clipper.cost[k] == f64::INFINITY {
                clipper.cost[k] = clipper.cost_of(k);
            }
            k = clipper.next[k];
        }
    }
    let (p, n) = (clipper.previous[at], clipper.next[at]);
    memory::push(triangles, [clipper.corners[p], clipper.corners[at], clipper.corners[n]])?;
    Ok(most.max(clipper.middle(at)))
}

/// Projects the places of a loop along its normal.
fn seen(places: &[[f64; 3]]) -> Result<Vec<[f64; 2]>, Error> {
    let origin = places[0];
    let mut normal = [0.0; 3];
    for pair in places.windows(2) {
        let (p, q) = (minus(pair[0], origin), minus(pair[1], origin));
        normal = axes(|k| normal[k] + p[(k + 1) % 3] * q[(k + 2) % 3] - p[(k + 2) % 3] * q[(k + 1) % 3]);
    }
    // Two directions across the normal.
    let least = (0..3).fold(0, |best, k| if normal[k].abs() < normal[best].abs() { k } else { best });
    let unit: [f64; 3] = axes(|k| f64::from(u8::from(k == least)));
    let cross = |a: [f64; 3], b: [f64; 3]| {
        axes(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
    };
    let first = cross(unit, normal);
    let size = dot(first, first);
    let first = first.each(|c| c / libm::sqrt(size));
    let size = dot(normal, normal);
    let second = cross(normal.each(|c| c / libm::sqrt(size)), first);
    memory::collected(places.iter().map(|&place| {
        let away = minus(place, origin);
        [dot(first, away), dot(second, away)]
    }))
}

fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

impl Clipper<'_> {
    /// The distance from the surface of the side that cuts off a corner.
    fn cost_of(&self, k: usize) -> f64 {
        let (p, n) = (self.previous[k], self.next[k]);
        let [a, b, c] = [p, k, n].each(|k| self.flat[k]);
        let area = turn(a, b, c);
        if area.is_nan() || area <= 0.0 {
            return f64::INFINITY;
        }
        let mut other = self.next[n];
        while other != p {
            let at = self.flat[other];
            if turn(a, b, at) >= 0.0 && turn(b, c, at) >= 0.0 && turn(c, a, at) >= 0.0 {
                return f64::INFINITY;
            }
            other = self.next[other];
        }
        self.figures.distance(self.surface, middle(self.places[p], self.places[n]))
    }

    /// The distance of the middle of a corner's triangle from the surface.
    fn middle(&self, k: usize) -> f64 {
        let [a, b, c] = [self.previous[k], k, self.next[k]].each(|k| self.places[k]);
        self.figures.distance(self.surface, axes(|i| (a[i] + b[i] + c[i]) / 3.0))
    }
}
