//! A cube clipped by up to three planes.
//!
//! Faces are closed polygons, and each edge of a face belongs to another face in the opposite direction. That
//! holds however corners are rounded: both faces of an edge find the same point on it. The edges that a plane
//! leaves without a second face make loops, which become faces. So the surface stays closed. Its corners have
//! rounding errors only, and so have its moments, even where planes are nearly parallel and rounding bends a
//! face so that a line crosses its outline four times.

use super::Half;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::{CubeMoments, PAIRS};

/// The greatest number of corners of a face. A face of the cube has four, a section six, and each further
/// plane adds one. Bent faces may have more.
const CORNERS: usize = 10;
/// The greatest number of faces: six, and one for each plane. Bent faces need more.
const FACES: usize = 12;
/// The greatest number of pieces of a section's boundary: one for each face, two for a bent face.
const PIECES: usize = 16;

/// A polygon, counter-clockwise as seen from outside.
#[derive(Clone, Copy)]
struct Polygon {
    corners: [[f64; 3]; CORNERS],
    count: usize,
}

impl Polygon {
    const EMPTY: Polygon = Polygon { corners: [[0.0; 3]; CORNERS], count: 0 };

    /// Appends a corner unless it equals the last one; `None` if there is no space.
    fn push(&mut self, corner: [f64; 3]) -> Option<()> {
        if self.count > 0 && self.corners[self.count - 1] == corner {
            return Some(());
        }
        *self.corners.get_mut(self.count)? = corner;
        self.count += 1;
        Some(())
    }
}

/// Edges without a second face.
struct Pieces {
    ends: [([f64; 3], [f64; 3]); PIECES],
    count: usize,
}

impl Pieces {
    fn push(&mut self, from: [f64; 3], to: [f64; 3]) -> Option<()> {
        if from != to {
            *self.ends.get_mut(self.count)? = (from, to);
            self.count += 1;
        }
        Some(())
    }

    /// Removes a loop of edges and returns it.
    fn take_loop(&mut self) -> Option<Polygon> {
        let mut polygon = Polygon::EMPTY;
        self.count = self.count.checked_sub(1)?;
        let (start, mut end) = self.ends[self.count];
        polygon.push(start)?;
        while end != start {
            polygon.push(end)?;
            let next = self.ends[..self.count].iter().position(|piece| piece.0 == end)?;
            end = self.ends[next].1;
            self.count -= 1;
            self.ends[next] = self.ends[self.count];
        }
        Some(polygon)
    }
}

/// Returns the moments of the points of [-1, 1]³ with n · x ≤ offset for all `halves`; `None` if rounding
/// makes more faces than there is space for.
pub(super) fn moments(halves: &[Half]) -> Option<CubeMoments> {
    let Clipped { faces, count } = clipped(halves)?;
    let mut sum = CubeMoments::EMPTY;
    for face in &faces[..count] {
        for k in 2..face.count {
            add_pyramid(&mut sum, [face.corners[0], face.corners[k - 1], face.corners[k]]);
        }
    }
    Some(sum)
}

/// Returns the mean of the corners of the same set; `Some(None)` if the set is empty. `None` as for
/// `moments`.
pub(super) fn middle(halves: &[Half]) -> Option<Option<[f64; 3]>> {
    let Clipped { faces, count } = clipped(halves)?;
    let (mut sum, mut corners) = ([0.0; 3], 0);
    for face in &faces[..count] {
        for corner in &face.corners[..face.count] {
            (0..3).for_each(|k| sum[k] += corner[k]);
            corners += 1;
        }
    }
    Some((corners > 0).then(|| sum.each(|c| c / f64::from(corners))))
}

/// The faces of a clipped cube.
struct Clipped {
    faces: [Polygon; FACES],
    count: usize,
}

fn clipped(halves: &[Half]) -> Option<Clipped> {
    let mut faces = [Polygon::EMPTY; FACES];
    let mut count = 6;
    for (k, face) in faces[..6].iter_mut().enumerate() {
        let (axis, side) = (k / 2, if k % 2 == 0 { -1.0 } else { 1.0 });
        for (u, v) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
            let mut corner = [0.0; 3];
            corner[axis] = side;
            corner[(axis + 1) % 3] = u * side;
            corner[(axis + 2) % 3] = v;
            face.push(corner)?;
        }
    }
    for half in halves {
        let mut pieces = Pieces { ends: [([0.0; 3], [0.0; 3]); PIECES], count: 0 };
        for face in &mut faces[..count] {
            *face = clip(face, half, &mut pieces)?;
        }
        while pieces.count > 0 {
            *faces.get_mut(count)? = pieces.take_loop()?;
            count += 1;
        }
    }
    Some(Clipped { faces, count })
}

/// Returns the part of a polygon on the inner side of a plane. Where the outline runs along the plane, the
/// reverse edge lacks a face and goes to `pieces`.
fn clip(face: &Polygon, half: &Half, pieces: &mut Pieces) -> Option<Polygon> {
    let value = |p: [f64; 3]| {
        let [a, b, c] = half.normal;
        ((a * p[0] + b * p[1]) + c * p[2]) - half.offset
    };
    let mut clipped = Polygon::EMPTY;
    // The point where the outline left last, and the point where it entered first without having left.
    let (mut left, mut entered) = (None, None);
    for k in 0..face.count {
        let (p, q) = (face.corners[k], face.corners[(k + 1) % face.count]);
        let (at_p, at_q) = (value(p), value(q));
        let leaves = at_p <= 0.0;
        if leaves {
            clipped.push(p)?;
        }
        if leaves != (at_q <= 0.0) {
            // From the inner end to the outer, so that both faces of an edge find the same point.
            let (a, b, at_a, at_b) = if leaves { (p, q, at_p, at_q) } else { (q, p, at_q, at_p) };
            let t = at_a / (at_a - at_b);
            let point = axes(|i| if a[i] == b[i] { a[i] } else { a[i] + t * (b[i] - a[i]) });
            clipped.push(point)?;
            if leaves {
                left = Some(point);
            } else if let Some(from) = left.take() {
                pieces.push(point, from)?;
            } else {
                entered = Some(point);
            }
        }
    }
    if let Some((from, point)) = left.zip(entered) {
        pieces.push(point, from)?;
    }
    if clipped.count > 1 && clipped.corners[0] == clipped.corners[clipped.count - 1] {
        clipped.count -= 1;
    }
    Some(clipped)
}

/// Adds the moments of the tetrahedron from the origin to a triangle.
fn add_pyramid(sum: &mut CubeMoments, [a, b, c]: [[f64; 3]; 3]) {
    let det = a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0]);
    let volume = det / 6.0;
    sum.volume += volume;
    let s = axes(|i| (a[i] + b[i]) + c[i]);
    for i in 0..3 {
        sum.first[i] += 0.25 * volume * s[i];
    }
    for (sum, (i, j)) in sum.second.iter_mut().zip(PAIRS) {
        *sum += volume / 20.0 * (((a[i] * a[j] + b[i] * b[j]) + c[i] * c[j]) + s[i] * s[j]);
    }
}
