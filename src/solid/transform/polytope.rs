//! A cube that is clipped by planes.
//!
//! Faces are closed polygons, and each edge belongs to two faces, once in each direction. Both faces find the
//! same point where a plane cuts the edge. The edges that are left without a second face make loops, which
//! become faces. So the surface stays closed, however corners are rounded. The part that a plane cuts off
//! lies beyond that plane, up to roundings, and winds around no point before the plane. So the surface keeps
//! winding around every point whose distance before each plane exceeds the rounding of corners relative to
//! their planes. Such points lie in the convex hull of the corners. Each plane is moved outward by more than
//! that rounding.

use crate::lattice::Each;

/// The greatest numbers of corners, of faces, and of corners of a face. A body that would have more is not
/// clipped, so that it stays larger.
const CORNERS: usize = 64;
const FACES: usize = 32;
const AROUND: usize = 24;

/// The distance by which planes are moved outward, relative to their coefficients. Each plane interpolates a
/// corner at most once, with an error of some units in the last place.
const SLACK: f64 = 256.0 * f64::EPSILON;

/// A convex body in the cube [−1, 1]³. Each point of the cube on the inner sides of all planes lies in the
/// convex hull of the corners.
#[derive(Clone)]
pub(super) struct Polytope {
    corners: [[f64; 3]; CORNERS],
    count: usize,
    faces: [Face; FACES],
    face_count: usize,
}

/// The numbers of the corners around a face.
#[derive(Clone, Copy)]
struct Face {
    corners: [u8; AROUND],
    count: usize,
}

impl Face {
    const EMPTY: Face = Face { corners: [0; AROUND], count: 0 };

    fn push(&mut self, corner: u8) -> Option<()> {
        *self.corners.get_mut(self.count)? = corner;
        self.count += 1;
        Some(())
    }

    fn corners(&self) -> &[u8] {
        &self.corners[..self.count]
    }
}

impl Polytope {
    /// The whole cube.
    pub(super) fn cube() -> Polytope {
        let mut own =
            Polytope { corners: [[0.0; 3]; CORNERS], count: 8, faces: [Face::EMPTY; FACES], face_count: 6 };
        for (k, corner) in own.corners.iter_mut().enumerate().take(8) {
            *corner = [0, 1, 2].each(|axis| if k >> axis & 1 == 0 { -1.0 } else { 1.0 });
        }
        const AROUND_FACES: [[u8; 4]; 6] =
            [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        for (face, around) in own.faces.iter_mut().zip(AROUND_FACES) {
            face.corners[..4].copy_from_slice(&around);
            face.count = 4;
        }
        own
    }

    pub(super) fn corners(&self) -> &[[f64; 3]] {
        &self.corners[..self.count]
    }

    /// The least and the greatest value of a linear function, rounded outward.
    pub(super) fn extremes(&self, normal: [f64; 3]) -> (f64, f64) {
        let size: f64 = normal.iter().map(|c| c.abs()).sum();
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for corner in self.corners() {
            let value = dot(normal, *corner);
            (least, most) = (least.min(value), most.max(value));
        }
        (least - SLACK * size, most + SLACK * size)
    }

    /// The part of the body where `normal` · x + `offset` is not negative; `None` if it is empty.
    pub(super) fn clipped(&self, normal: [f64; 3], offset: f64) -> Option<Polytope> {
        let size: f64 = normal.iter().map(|c| c.abs()).sum::<f64>() + offset.abs();
        let offset = offset + SLACK * size;
        let mut values = [0.0; CORNERS];
        let (mut is_cut, mut is_left) = (false, false);
        for (value, corner) in values.iter_mut().zip(self.corners()) {
            *value = dot(normal, *corner) + offset;
            if is_negative(*value) { is_cut = true } else { is_left = true }
        }
        if !is_left {
            return None;
        }
        Some(if is_cut { self.cut(&values).unwrap_or_else(|| self.clone()) } else { self.clone() })
    }

    /// The body without the corners whose values are negative; `None` if it has too many corners or faces.
    fn cut(&self, values: &[f64; CORNERS]) -> Option<Polytope> {
        const NONE: u8 = u8::MAX;
        let mut own = Polytope { count: 0, face_count: 0, ..*self };
        let mut names = [NONE; CORNERS];
        // For each edge that is cut: the corner before the plane, the corner beyond it, and the new corner
        // between.
        let (mut cuts, mut cut_count) = ([(0u8, 0u8, 0u8); CORNERS], 0);
        // For each new corner where the path around a face leaves the body, the corner where the path
        // returns.
        let mut bridges = [NONE; CORNERS];
        for face in &self.faces[..self.face_count] {
            let (mut left, mut exit, mut first_entry) = (Face::EMPTY, NONE, NONE);
            for (i, &a) in face.corners().iter().enumerate() {
                let b = face.corners[if i + 1 == face.count { 0 } else { i + 1 }];
                let is_in = |corner: u8| !is_negative(values[usize::from(corner)]);
                if is_in(a) {
                    let name = &mut names[usize::from(a)];
                    if *name == NONE {
                        *name = own.add(self.corners[usize::from(a)])?;
                    }
                    left.push(*name)?;
                }
                if is_in(a) == is_in(b) {
                    continue;
                }
                let (before, beyond) = if is_in(a) { (a, b) } else { (b, a) };
                let known = cuts[..cut_count].iter().find(|cut| (cut.0, cut.1) == (before, beyond));
                let at = match known {
                    Some(cut) => cut.2,
                    None => {
                        let at = own.add(self.between(before, beyond, values))?;
                        *cuts.get_mut(cut_count)? = (before, beyond, at);
                        cut_count += 1;
                        at
                    }
                };
                left.push(at)?;
                if is_in(a) {
                    exit = at;
                } else if exit == NONE {
                    first_entry = at;
                } else {
                    bridges[usize::from(exit)] = at;
                    exit = NONE;
                }
            }
            if exit != NONE && first_entry != NONE {
                bridges[usize::from(exit)] = first_entry;
            }
            if left.count > 2 {
                *own.faces.get_mut(own.face_count)? = left;
                own.face_count += 1;
            }
        }
        // The new face runs along each bridge in the opposite direction.
        let mut back = [NONE; CORNERS];
        for (from, &to) in bridges.iter().enumerate().filter(|(_, to)| **to != NONE) {
            back[usize::from(to)] = from as u8;
        }
        for start in 0..own.count {
            let (mut face, mut at) = (Face::EMPTY, start);
            while back[at] != NONE {
                face.push(at as u8)?;
                at = usize::from(core::mem::replace(&mut back[at], NONE));
            }
            if face.count > 2 {
                *own.faces.get_mut(own.face_count)? = face;
                own.face_count += 1;
            }
        }
        Some(own)
    }

    fn add(&mut self, corner: [f64; 3]) -> Option<u8> {
        *self.corners.get_mut(self.count)? = corner;
        self.count += 1;
        Some(self.count as u8 - 1)
    }

    /// The point where an edge is cut.
    fn between(&self, before: u8, beyond: u8, values: &[f64; CORNERS]) -> [f64; 3] {
        let [a, b] = [before, beyond].each(usize::from);
        let share = (values[a] / (values[a] - values[b])).clamp(0.0, 1.0);
        let (from, to) = (self.corners[a], self.corners[b]);
        [0, 1, 2].each(|axis| from[axis] + share * (to[axis] - from[axis]))
    }

    /// Returns whether the body lies within `radius` of a straight line.
    pub(super) fn is_needle(&self, radius: f64) -> bool {
        let corners = self.corners();
        let minus = |a: &[f64; 3], b: &[f64; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
        let farthest = |from: &[f64; 3]| {
            let square = |to: &[f64; 3]| dot(minus(to, from), minus(to, from));
            corners.iter().copied().max_by(|a, b| square(a).total_cmp(&square(b)))
        };
        let Some(from) = corners.first().and_then(farthest) else { return true };
        let Some(to) = farthest(&from) else { return true };
        let along = minus(&to, &from);
        let square = dot(along, along);
        corners.iter().all(|corner| {
            let off = minus(corner, &from);
            let share = if square > 0.0 { dot(off, along) / square } else { 0.0 };
            let off = [0, 1, 2].each(|axis| off[axis] - share * along[axis]);
            dot(off, off) <= radius * radius
        })
    }
}

/// Returns whether a corner is cut off; a NaN cuts nothing off.
fn is_negative(value: f64) -> bool {
    value < 0.0
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Six times the volume.
    fn volume(body: &Polytope) -> f64 {
        let mut sum = 0.0;
        for face in &body.faces[..body.face_count] {
            let at = |i: usize| body.corners[usize::from(face.corners[i])];
            for i in 1..face.count - 1 {
                let ([a, b, c], [p, q, r]) = (at(0), at(i));
                let [u, v, w] = at(i + 1);
                sum += a * (q * w - r * v) + b * (r * u - p * w) + c * (p * v - q * u);
            }
        }
        sum
    }

    #[test]
    fn bodies_have_their_volume() {
        let cube = Polytope::cube();
        assert_eq!(volume(&cube), 48.0);
        let half = cube.clipped([1.0, 1.0, 0.0], 0.0).unwrap();
        assert!((volume(&half) - 24.0).abs() < 1e-9);
        let corner = cube.clipped([1.0, 1.0, 1.0], -2.0).unwrap();
        assert!((volume(&corner) - 1.0).abs() < 1e-9);
        assert_eq!(corner.corners().len(), 4);
        assert!(cube.clipped([1.0, 1.0, 1.0], -3.1).is_none());
        // A thin body along an edge.
        let needle = cube.clipped([1.0, 1.0, 0.0], -1.999).unwrap();
        assert!(needle.is_needle(2e-3) && !needle.is_needle(2e-4));
    }

    #[test]
    fn no_point_before_all_planes_is_lost() {
        let mut state = 0x9E37_79B9_7F4A_7C15u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        for round in 0..2000 {
            // Planes through or near one point, so that many are nearly coplanar.
            let near = [random(), random(), random()];
            let mut body = Some(Polytope::cube());
            let mut sure = 48.0;
            for k in 0..12 {
                let normal = if round % 3 == 0 && k % 2 == 1 {
                    [1.0, 1e-9 * random(), 0.0]
                } else {
                    [random(), random(), random()]
                };
                let offset = -dot(normal, near) + if round % 2 == 0 { 1e-9 } else { 0.0 };
                body = body.and_then(|body| body.clipped(normal, offset));
                // (The point is before all of them.)
                let body = body.as_ref().unwrap();
                let (least, most) = body.extremes(normal);
                assert!(least <= dot(normal, near) && dot(normal, near) <= most);
                let volume = volume(body);
                assert!(volume <= sure + 1e-9 && volume > -1e-9);
                sure = volume;
                let [x, y, z] = [0, 1, 2].map(|axis| {
                    let mut unit = [0.0; 3];
                    unit[axis] = 1.0;
                    body.extremes(unit)
                });
                assert!([x, y, z].into_iter().zip(near).all(|((a, b), c)| a <= c && c <= b));
            }
        }
    }
}
