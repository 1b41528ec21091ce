//! Exact tests of the samples that a triangle covers.
//!
//! A corner is a vector from the eye, and a sample is the vector d = (x, y, 1) of its line of sight. The line
//! meets the triangle in front of the eye if d · (a × b), d · (b × c) and d · (c × a) have the sign of a · (b
//! × c). So no triangle has to be clipped at the plane of the eye. Under a parallel lens the corners are (x,
//! y, 1), and everything else is the same.
//!
//! The signs are those of the exact determinants of the rounded corners. So two triangles with a common edge
//! never both cover one sample, and never leave out a sample between them, however small they are. A sample
//! on an edge counts as shifted by (ε, −ε²), to the right and downward: edges on the left and on top belong
//! to a triangle.

use crate::lattice::Each;
use crate::lattice::exact::{certain, sign, sign_of_products, sign_of_sum, two_product};
use core::ops::Range;
use glam::{DVec3, Vec3Swizzles};

/// The determinant d · (a × b) as a function of d = (x, y, 1).
struct EdgeFunction {
    a: DVec3,
    b: DVec3,
    /// a × b, rounded.
    normal: DVec3,
    /// A bound of the error of the value, at any sample of the picture.
    error: f64,
}

impl EdgeFunction {
    /// `reach`: the greatest |x| and |y| of samples.
    fn new(a: DVec3, b: DVec3, reach: [f64; 2]) -> EdgeFunction {
        // Not a × b itself, which loses digits if both are far away and close to each other.
        let along = b - a;
        let (left, right) = (a.yzx() * along.zxy(), a.zxy() * along.yzx());
        let size = (left.abs() + right.abs()).dot(DVec3::new(reach[0], reach[1], 1.0));
        // Each product has at most eight roundings.
        let error = 16.0 * f64::EPSILON * size + f64::MIN_POSITIVE;
        EdgeFunction { a, b, normal: left - right, error }
    }

    /// The value, rounded.
    #[inline(always)]
    fn value(&self, x: f64, y: f64) -> f64 {
        self.normal.x * x + (self.normal.y * y + self.normal.z)
    }

    /// The sign of the value; 0 only if a and b lie in one direction.
    #[inline(always)]
    fn sign(&self, value: f64, x: f64, y: f64) -> i32 {
        if value.abs() > self.error { sign(value) } else { self.exact_sign(x, y) }
    }

    #[cold]
    fn exact_sign(&self, x: f64, y: f64) -> i32 {
        let (a, b) = (self.a, self.b);
        match exact_determinant(DVec3::new(x, y, 1.0), a, b) {
            0 => match sign_of_products(&[(a.y, b.z), (-a.z, b.y)]) {
                0 => -sign_of_products(&[(a.z, b.x), (-a.x, b.z)]),
                sign => sign,
            },
            sign => sign,
        }
    }
}

/// The sign of d · (a × b).
fn exact_determinant(d: DVec3, a: DVec3, b: DVec3) -> i32 {
    let mut terms = [0.0; 24];
    let factors = [
        [d.x, a.y, b.z],
        [-d.x, a.z, b.y],
        [d.y, a.z, b.x],
        [-d.y, a.x, b.z],
        [d.z, a.x, b.y],
        [-d.z, a.y, b.x],
    ];
    for (terms, [p, q, r]) in terms.chunks_exact_mut(4).zip(factors) {
        let (high, low) = two_product(q, r);
        (terms[0], terms[1]) = two_product(low, p);
        (terms[2], terms[3]) = two_product(high, p);
    }
    sign_of_sum(&terms)
}

/// The sign of a · (b × c).
fn determinant_sign(a: DVec3, b: DVec3, c: DVec3) -> i32 {
    let (u, v) = (b - a, c - a);
    let (left, right) = (u.yzx() * v.zxy(), u.zxy() * v.yzx());
    let value = (left - right).dot(a);
    let error = 16.0 * f64::EPSILON * (left.abs() + right.abs()).dot(a.abs());
    certain(value, error).unwrap_or_else(|| exact_determinant(a, b, c))
}

/// The samples that a triangle covers.
pub struct Coverage {
    /// The edges opposite to the corners 0, 1 and 2.
    edges: [EdgeFunction; 3],
    /// 1 if the corners turn counter-clockwise as seen from the eye, −1 if clockwise.
    pub facing: i32,
}

impl Coverage {
    /// The coverage of a triangle with these corners, for samples with |x| and |y| up to `reach`; `None` if
    /// the triangle is seen edge-on.
    pub fn new([a, b, c]: [DVec3; 3], reach: [f64; 2]) -> Option<Coverage> {
        let facing = determinant_sign(a, b, c);
        let edges = [(b, c), (c, a), (a, b)].each(|(from, to)| EdgeFunction::new(from, to, reach));
        (facing != 0).then_some(Coverage { edges, facing })
    }

    /// The weights of the corners at the sample (x, y), with a sum of 1; `None` if the triangle does not
    /// cover the sample.
    #[inline(always)]
    pub fn weights(&self, x: f64, y: f64) -> Option<[f64; 3]> {
        let mut weights = [0.0; 3];
        for (weight, edge) in weights.iter_mut().zip(&self.edges) {
            let value = edge.value(x, y);
            if edge.sign(value, x, y) != self.facing {
                return None;
            }
            // The rounded value of a tiny triangle may have the other sign.
            *weight = (value * f64::from(self.facing)).max(0.0);
        }
        let sum = weights[0] + weights[1] + weights[2];
        Some(if sum > 0.0 { weights.each(|weight| weight / sum) } else { [1.0 / 3.0; 3] })
    }

    /// Returns a range of `columns`, with x = x₀ + i · step for column i, that contains all covered samples
    /// in the row y.
    #[inline]
    pub fn columns(&self, y: f64, [x, step]: [f64; 2], columns: Range<usize>) -> Range<usize> {
        let (mut low, mut high) = (columns.start as f64, columns.end as f64);
        for edge in &self.edges {
            let slope = edge.normal.x * step * f64::from(self.facing);
            let first = edge.value(x, y) * f64::from(self.facing);
            let root = -first / slope;
            // Rounding moves the root by less than a column if the slope is greater than the error.
            if slope.abs() <= edge.error || root.is_nan() {
                continue;
            }
            if slope > 0.0 {
                low = low.max(libm::floor(root) - 1.0);
            } else {
                high = high.min(libm::ceil(root) + 2.0);
            }
        }
        if low >= high { columns.start..columns.start } else { low as usize..high as usize }
    }
}
