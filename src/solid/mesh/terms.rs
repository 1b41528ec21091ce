//! The contributions of caps and their edges to winding numbers and derivatives, many at a time.
//!
//! Loops over arrays compute the terms. Compilers turn such loops into vector instructions if they contain no
//! call (so the arrays do without `map`). The caller sums the terms in order, so that the sums are bit for
//! bit those of one term after the other.

use crate::lattice::exact::sqrt;
use core::f64::consts::PI;
use glam::DVec3;

pub(super) const SCALE: f64 = 1.0 / (4.0 * PI);

/// The most terms that are computed at a time.
pub(super) const MOST: usize = 16;

/// Loops go over whole vectors: values beyond the last term are computed and ignored.
const WIDTH: usize = 4;

/// One coordinate of all terms.
type Row = [f64; MOST];

/// A corner as seen from a point.
#[derive(Clone, Copy)]
pub(super) struct End {
    pub(super) at: DVec3,
    pub(super) distance: f64,
    /// One over the distance.
    pub(super) inverse: f64,
    pub(super) direction: DVec3,
}

impl End {
    #[inline(always)]
    pub(super) fn new(at: DVec3) -> End {
        let distance = length(at);
        let inverse = 1.0 / distance;
        End { at, distance, inverse, direction: at * inverse }
    }
}

/// Half a cap's solid angle: the argument of (real, imaginary), and a bound of its error.
#[derive(Clone, Copy)]
pub(super) struct Angle {
    pub(super) real: f64,
    pub(super) imaginary: f64,
    pub(super) modulus: f64,
    pub(super) wrong: f64,
}

impl Angle {
    #[inline(always)]
    pub(super) fn new(ends: [End; 3], vertex_error: f64) -> Angle {
        let [a, b, c] = [ends[0].direction, ends[1].direction, ends[2].direction];
        let (ab, bc, ca) = (a.dot(b), b.dot(c), c.dot(a));
        let imaginary = a.dot(b.cross(c));
        let real = 1.0 + ab + bc + ca;
        let modulus = sqrt(real * real + imaginary * imaginary);
        let inverses = ends[0].inverse + ends[1].inverse + ends[2].inverse;
        let wrong = 64.0 * f64::EPSILON + 8.0 * vertex_error * inverses;
        Angle { real, imaginary, modulus, wrong }
    }

    /// Computes the angle from numbers that are not divided by the corners' distances.
    #[inline(always)]
    fn undivided([a, b, c]: [DVec3; 3], vertex_error: f64) -> Angle {
        let [far, farther, farthest] = [length(a), length(b), length(c)];
        let pairs = [farther * farthest, farthest * far, far * farther];
        let all = pairs[0] * far;
        let real = all + a.dot(b) * farthest + b.dot(c) * far + c.dot(a) * farther;
        let imaginary = a.dot(b.cross(c));
        let modulus = sqrt(real * real + imaginary * imaginary);
        let wrong = 64.0 * f64::EPSILON * all + 8.0 * vertex_error * (pairs[0] + pairs[1] + pairs[2]);
        Angle { real, imaginary, modulus, wrong }
    }
}

/// Caps, and their terms.
pub(super) struct CapTerms {
    count: usize,
    corners: [[Row; 3]; 3],
    area: Row,
    longest: Row,
    angles: [Row; 4],
    third: Row,
}

impl CapTerms {
    #[inline(always)]
    pub(super) fn new() -> CapTerms {
        let row = [0.0; MOST];
        CapTerms { count: 0, corners: [[row; 3]; 3], area: row, longest: row, angles: [row; 4], third: row }
    }

    pub(super) fn clear(&mut self) {
        self.count = 0;
    }

    /// Appends a cap by its corners; its size matters only to derivatives.
    #[inline(always)]
    pub(super) fn push(&mut self, corners: &[DVec3; 3], area: f64, longest: f64) {
        let i = self.count;
        for (rows, corner) in self.corners.iter_mut().zip(corners) {
            (rows[0][i], rows[1][i], rows[2][i]) = (corner.x, corner.y, corner.z);
        }
        (self.area[i], self.longest[i]) = (area, longest);
        self.count += 1;
    }

    /// Computes the terms as seen from a point; derivatives are valid in the ball of `radius`.
    #[inline(always)]
    pub(super) fn find(&mut self, point: DVec3, vertex_error: f64, radius: f64) {
        let CapTerms { count, corners, area, longest, angles, third } = self;
        for i in 0..count.next_multiple_of(WIDTH).min(MOST) {
            let [a, b, c] = [at(&corners[0], i), at(&corners[1], i), at(&corners[2], i)];
            let ends = [End::new(a - point), End::new(b - point), End::new(c - point)];
            let angle = Angle::new(ends, vertex_error);
            (angles[0][i], angles[1][i], angles[2][i], angles[3][i]) =
                (angle.real, angle.imaginary, angle.modulus, angle.wrong);
            // The distance of any point of the triangle is at least that of its farthest corner minus its
            // longest edge.
            let farthest = 0f64.max(ends[0].distance).max(ends[1].distance).max(ends[2].distance);
            let inverse = 1.0 / (farthest * (1.0 - 1e-9) - longest[i] - radius);
            let square = inverse * inverse;
            third[i] = if inverse > 0.0 {
                SCALE * 24.0 * area[i] * square * square * inverse
            } else {
                f64::INFINITY
            };
        }
    }

    /// Computes the angles alone, from numbers that are not divided by the corners' distances.
    #[inline(always)]
    pub(super) fn find_undivided(&mut self, point: DVec3, vertex_error: f64) {
        let CapTerms { count, corners, angles, .. } = self;
        for i in 0..count.next_multiple_of(WIDTH).min(MOST) {
            let [a, b, c] = [at(&corners[0], i), at(&corners[1], i), at(&corners[2], i)];
            let angle = Angle::undivided([a - point, b - point, c - point], vertex_error);
            (angles[0][i], angles[1][i], angles[2][i], angles[3][i]) =
                (angle.real, angle.imaginary, angle.modulus, angle.wrong);
        }
    }

    #[inline(always)]
    pub(super) fn angle(&self, i: usize) -> Angle {
        let [real, imaginary, modulus, wrong] = &self.angles;
        Angle { real: real[i], imaginary: imaginary[i], modulus: modulus[i], wrong: wrong[i] }
    }

    /// A bound of the third derivative.
    #[inline(always)]
    pub(super) fn third(&self, i: usize) -> f64 {
        self.third[i]
    }
}

/// The contribution of an edge to the derivatives. The gradient is the magnetic field of a current along the
/// edge.
#[derive(Clone, Copy)]
pub(super) struct Edge {
    /// Whether the contribution is known: the edge does not pass through the ball.
    pub(super) is_known: bool,
    pub(super) gradient: DVec3,
    /// The columns of the second derivative.
    pub(super) hessian: [DVec3; 3],
    /// Bounds of the rounding errors of gradient and second derivative.
    pub(super) gradient_error: f64,
    pub(super) hessian_error: f64,
    /// As in [`Local`](super::winding::Local).
    pub(super) position_sensitivity: f64,
    pub(super) third: f64,
}

impl Edge {
    #[inline(always)]
    fn new([from, to]: [End; 2], length: f64, radius: f64) -> Edge {
        let (a, b) = (from.direction, to.direction);
        let cosine = a.dot(b);
        let (both, inverse_product) = (from.distance + to.distance, from.inverse * to.inverse);
        let edge = to.at - from.at;
        let along = if length > 0.0 { (-from.at.dot(edge) / (length * length)).clamp(0.0, 1.0) } else { 0.0 };
        let nearest = self::length(from.at + along * edge);
        let distance = nearest * (1.0 - 1e-9) - 8.0 * f64::EPSILON * both - radius;
        // NaN fails this test, too.
        let is_apart = distance > 0.0;
        let field = a.cross(b);
        let square = field.length_squared();
        let sine = sqrt(square);
        // 1 + cosine, precise also for an edge so near that its ends lie in opposite directions.
        let open = if cosine < 0.0 { square / (1.0 - cosine) } else { 1.0 + cosine };
        let is_told = (cosine >= 0.0) | (sine > 1e-12);
        let inverse_open = 1.0 / open;
        let strength = SCALE * both * inverse_product * inverse_open;
        // Along v, the derivative of from × to is edge × v, and the derivative of `strength` over both
        // distances is `weaker` · v.
        let mixed = (a * to.distance + b * from.distance) * inverse_product;
        let weaker =
            strength * (mixed + (a + b) * (both * inverse_product * inverse_open) - (a + b) * (1.0 / both));
        let turning = edge * (strength * inverse_product);
        // The rounding of the field's direction, and of `open`.
        let rounding = 256.0 * f64::EPSILON * strength * if cosine < 0.0 { 2.0 } else { 1.0 + sine };
        // ∫ 6 ds / distance⁴ along the edge, and at most along its whole line.
        let inverse = 1.0 / distance;
        let angle = length * inverse;
        Edge {
            is_known: is_apart & is_told,
            gradient: field * strength,
            hessian: [
                DVec3::new(0.0, turning.z, -turning.y) + field * weaker.x,
                DVec3::new(-turning.z, 0.0, turning.x) + field * weaker.y,
                DVec3::new(turning.y, -turning.x, 0.0) + field * weaker.z,
            ],
            gradient_error: rounding,
            hessian_error: rounding * both * inverse_product * inverse_open.max(1.0),
            position_sensitivity: SCALE * angle.min(PI) * inverse,
            third: SCALE * 6.0 * angle.min(PI / 2.0) * inverse * inverse * inverse,
        }
    }
}

/// Edges, and their terms.
pub(super) struct EdgeTerms {
    count: usize,
    ends: [[Row; 3]; 2],
    length: Row,
    /// One if the edge is known; the gradient; the columns of the second derivative.
    known: Row,
    gradient: [Row; 3],
    hessian: [[Row; 3]; 3],
    /// The numbers of [`Edge`] in their order.
    bounds: [Row; 4],
}

impl EdgeTerms {
    #[inline(always)]
    pub(super) fn new() -> EdgeTerms {
        let row = [0.0; MOST];
        EdgeTerms {
            count: 0,
            ends: [[row; 3]; 2],
            length: row,
            known: row,
            gradient: [row; 3],
            hessian: [[row; 3]; 3],
            bounds: [row; 4],
        }
    }

    pub(super) fn clear(&mut self) {
        self.count = 0;
    }

    /// Returns how many more edges fit.
    pub(super) fn room(&self) -> usize {
        MOST - self.count
    }

    #[inline(always)]
    pub(super) fn push(&mut self, ends: [DVec3; 2], length: f64) {
        let i = self.count;
        for (rows, end) in self.ends.iter_mut().zip(ends) {
            (rows[0][i], rows[1][i], rows[2][i]) = (end.x, end.y, end.z);
        }
        self.length[i] = length;
        self.count += 1;
    }

    /// Computes the terms as seen from a point, for the ball of `radius`.
    #[inline(always)]
    pub(super) fn find(&mut self, point: DVec3, radius: f64) {
        let EdgeTerms { count, ends, length, known, gradient, hessian, bounds } = self;
        for i in 0..count.next_multiple_of(WIDTH).min(MOST) {
            let (from, to) = (at(&ends[0], i) - point, at(&ends[1], i) - point);
            let edge = Edge::new([End::new(from), End::new(to)], length[i], radius);
            known[i] = if edge.is_known { 1.0 } else { 0.0 };
            put(gradient, i, edge.gradient);
            put(&mut hessian[0], i, edge.hessian[0]);
            put(&mut hessian[1], i, edge.hessian[1]);
            put(&mut hessian[2], i, edge.hessian[2]);
            (bounds[0][i], bounds[1][i]) = (edge.gradient_error, edge.hessian_error);
            (bounds[2][i], bounds[3][i]) = (edge.position_sensitivity, edge.third);
        }
    }

    #[inline(always)]
    pub(super) fn edge(&self, i: usize) -> Edge {
        let [gradient_error, hessian_error, position_sensitivity, third] = &self.bounds;
        Edge {
            is_known: self.known[i] != 0.0,
            gradient: at(&self.gradient, i),
            hessian: [at(&self.hessian[0], i), at(&self.hessian[1], i), at(&self.hessian[2], i)],
            gradient_error: gradient_error[i],
            hessian_error: hessian_error[i],
            position_sensitivity: position_sensitivity[i],
            third: third[i],
        }
    }
}

#[inline(always)]
fn at(rows: &[Row; 3], i: usize) -> DVec3 {
    DVec3::new(rows[0][i], rows[1][i], rows[2][i])
}

#[inline(always)]
fn put(rows: &mut [Row; 3], i: usize, v: DVec3) {
    (rows[0][i], rows[1][i], rows[2][i]) = (v.x, v.y, v.z);
}

#[inline(always)]
pub(super) fn length(v: DVec3) -> f64 {
    sqrt(v.length_squared())
}
