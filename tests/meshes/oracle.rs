//! The verdicts of a mesh about the cells of a frame, by definition and in integers. The oracle is slow, and
//! no rounding affects it: a sign comes from doubles if it is far beyond any rounding error, else from
//! integers.

// Each test program uses its own part of this.
#![allow(dead_code)]

use leafless::{FillRule, Frame, TriangleMesh};
use num_bigint::{BigInt, Sign};

/// A bound of the relative rounding error of every polynomial below, a hundred times too large.
const SAFE: f64 = 1e-12;

/// The contact of the triangles with a finest cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contact {
    /// No triangle comes near.
    Clear,
    /// A triangle comes within the tolerance, but none meets the open cell.
    Near,
    /// A triangle meets the open cell.
    Meets,
}

/// A mesh in units of finest cells (approximately) and in integers (exactly), relative to the frame's origin.
pub struct Oracle {
    pub cells: i64,
    approximate: Vec<[f64; 3]>,
    exact: Vec<[BigInt; 3]>,
    /// Half a cell, in the exact unit.
    half: BigInt,
    triangles: Vec<[usize; 3]>,
    /// Largest magnitude of a coordinate, in cells.
    size: f64,
}

fn sign(x: &BigInt) -> i32 {
    match x.sign() {
        Sign::Minus => -1,
        Sign::NoSign => 0,
        Sign::Plus => 1,
    }
}

fn sure(x: f64, bound: f64) -> Option<i32> {
    if x > bound {
        Some(1)
    } else if x < -bound {
        Some(-1)
    } else {
        None
    }
}

/// A double as mantissa · 2^exponent.
fn dyadic(x: f64) -> (BigInt, i64) {
    assert!(x.is_finite());
    let bits = x.to_bits();
    let (biased, fraction) = ((bits >> 52 & 0x7FF) as i64, bits & ((1 << 52) - 1));
    let (magnitude, exponent) =
        if biased == 0 { (fraction, -1074) } else { (fraction | 1 << 52, biased - 1075) };
    let mantissa = BigInt::from(magnitude);
    let zeros = magnitude.trailing_zeros() as i64;
    if magnitude == 0 {
        return (mantissa, i64::MAX);
    }
    (if x < 0.0 { -(mantissa >> zeros) } else { mantissa >> zeros }, exponent + zeros)
}

fn cross<T>(a: &[T; 3], b: &[T; 3]) -> [T; 3]
where
    for<'a> &'a T: std::ops::Mul<&'a T, Output = T> + std::ops::Sub<&'a T, Output = T>,
{
    [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        &(&a[j] * &b[k]) - &(&a[k] * &b[j])
    })
}

impl Oracle {
    pub fn new(mesh: &TriangleMesh, frame: &Frame) -> Oracle {
        let half = dyadic(frame.edge());
        let half = (half.0, half.1 - frame.depth() as i64 - 1);
        let origin = frame.origin().map(dyadic);
        let all = mesh.vertices().iter().flatten().map(|&x| dyadic(x).1);
        let unit = all.chain(origin.iter().map(|o| o.1)).chain([half.1]).min().unwrap();
        let scaled = |(mantissa, exponent): (BigInt, i64)| match exponent {
            i64::MAX => mantissa,
            exponent => mantissa << (exponent - unit) as usize,
        };
        let origin = origin.map(scaled);
        let exact = mesh
            .vertices()
            .iter()
            .map(|vertex| [0, 1, 2].map(|axis| scaled(dyadic(vertex[axis])) - &origin[axis]));
        let cell = frame.edge() / (1u64 << frame.depth()) as f64;
        let approximate: Vec<[f64; 3]> = (mesh.vertices().iter())
            .map(|vertex| [0, 1, 2].map(|axis| (vertex[axis] - frame.origin()[axis]) / cell))
            .collect();
        let size = approximate.iter().flatten().fold(frame.cells() as f64, |most, x| most.max(x.abs()));
        let mut oracle = Oracle {
            cells: frame.cells() as i64,
            exact: exact.collect(),
            half: scaled(half),
            triangles: mesh.triangles().iter().map(|t| t.map(|v| v as usize)).collect(),
            approximate,
            size,
        };
        // A triangle without area bounds nothing. The solid is the same with and without it.
        let proper = oracle.triangles.iter().copied().filter(|&t| !oracle.is_flat(t)).collect();
        oracle.triangles = proper;
        oracle
    }

    fn is_flat(&self, t: [usize; 3]) -> bool {
        let [a, b, c] = t.map(|v| &self.exact[v]);
        let edge = |to: &[BigInt; 3]| [0, 1, 2].map(|i| &to[i] - &a[i]);
        cross(&edge(b), &edge(c)).iter().all(|n| sign(n) == 0)
    }

    /// The lattice plane `k` half cells from the origin: even k are planes, odd ones centres.
    fn plane(&self, k: i64) -> BigInt {
        &self.half * k
    }

    /// Returns the side of the centre (y, z), shifted by (ε², ε³), relative to the line from `a` to `b` seen
    /// along x: 1 on the left. It is 0 only if the line is a point.
    fn side(&self, a: usize, b: usize, [y, z]: [i64; 2]) -> i32 {
        let (p, q) = (self.approximate[a], self.approximate[b]);
        let (cy, cz) = (y as f64 + 0.5, z as f64 + 0.5);
        let estimate = (q[1] - p[1]) * (cz - p[2]) - (q[2] - p[2]) * (cy - p[1]);
        if let Some(side) = sure(estimate, SAFE * self.size * self.size) {
            return side;
        }
        let (p, q) = (&self.exact[a], &self.exact[b]);
        let (cy, cz) = (self.plane(2 * y + 1), self.plane(2 * z + 1));
        let (ey, ez) = (&q[1] - &p[1], &q[2] - &p[2]);
        let side = sign(&(&ey * (cz - &p[2]) - &ez * (cy - &p[1])));
        [side, -sign(&ez), sign(&ey)].into_iter().find(|&s| s != 0).unwrap_or(0)
    }

    /// If the line along x through the shifted centre (y, z) pierces the triangle, returns the sign of its
    /// normal's x.
    fn pierces(&self, [a, b, c]: [usize; 3], at: [i64; 2]) -> Option<i32> {
        let first = self.side(a, b, at);
        (first != 0 && first == self.side(b, c, at) && first == self.side(c, a, at)).then_some(first)
    }

    /// Returns the side of the triangle's plane on which the shifted centre lies: 1 where the normal points.
    fn over(&self, t: [usize; 3], at: [i64; 3]) -> i32 {
        let [a, b, c] = t.map(|v| self.approximate[v]);
        let edge = |to: [f64; 3]| [0, 1, 2].map(|i| to[i] - a[i]);
        let normal = cross(&edge(b), &edge(c));
        let estimate: f64 = (0..3).map(|i| normal[i] * (at[i] as f64 + 0.5 - a[i])).sum();
        if let Some(side) = sure(estimate, SAFE * self.size * self.size * self.size) {
            return side;
        }
        let [a, b, c] = t.map(|v| &self.exact[v]);
        let edge = |to: &[BigInt; 3]| [0, 1, 2].map(|i| &to[i] - &a[i]);
        let normal = cross(&edge(b), &edge(c));
        let value: BigInt = (0..3).map(|i| &normal[i] * (self.plane(2 * at[i] + 1) - &a[i])).sum();
        let [x, y, z] = [0, 1, 2].map(|i| sign(&normal[i]));
        [sign(&value), x, y, z].into_iter().find(|&s| s != 0).unwrap()
    }

    /// Returns the cells along an axis whose closed extent the triangle may reach.
    fn reach(&self, t: [usize; 3], axis: usize) -> std::ops::Range<i64> {
        let at = t.map(|v| self.approximate[v][axis]);
        let margin = 1.0 + SAFE * self.size;
        let (low, high) = (at[0].min(at[1]).min(at[2]) - margin, at[0].max(at[1]).max(at[2]) + margin);
        (low.floor() as i64).clamp(0, self.cells)..(high.ceil() as i64).clamp(0, self.cells)
    }

    /// Returns the winding number of every finest cell's centre, shifted by (ε, ε², ε³), x fastest. By the
    /// definition, it counts along a ray from x = −∞.
    pub fn windings(&self) -> Vec<i32> {
        let n = self.cells;
        let mut windings = vec![0; (n * n * n) as usize];
        for &t in &self.triangles {
            for z in self.reach(t, 2) {
                for y in self.reach(t, 1) {
                    let Some(facing) = self.pierces(t, [y, z]) else { continue };
                    let (mut low, mut high) = (0, n);
                    while low < high {
                        let x = (low + high) / 2;
                        if self.over(t, [x, y, z]) == facing { high = x } else { low = x + 1 }
                    }
                    // Going up, a surface that faces down is entered through.
                    let row = ((z * n + y) * n) as usize;
                    windings[row + low as usize..row + n as usize].iter_mut().for_each(|w| *w -= facing);
                }
            }
        }
        windings
    }

    /// Returns the triangles' contact with every finest cell, x fastest; `tolerance` in cells.
    pub fn contacts(&self, tolerance: f64) -> Vec<Contact> {
        let mut contacts = vec![Contact::Clear; (self.cells * self.cells * self.cells) as usize];
        self.descend([0; 3], self.cells, &self.triangles, tolerance, &mut contacts);
        contacts
    }

    fn descend(
        &self,
        at: [i64; 3],
        size: i64,
        from: &[[usize; 3]],
        tolerance: f64,
        contacts: &mut [Contact],
    ) {
        let near = |t: &[usize; 3]| !self.is_clear(*t, at, size, tolerance);
        let near: Vec<[usize; 3]> = from.iter().copied().filter(near).collect();
        if near.is_empty() {
            return;
        }
        if size > 1 {
            for octant in 0..8 {
                let child = [0, 1, 2].map(|axis| at[axis] + size / 2 * (octant >> axis & 1));
                self.descend(child, size / 2, &near, tolerance, contacts);
            }
            return;
        }
        let cell = ((at[2] * self.cells + at[1]) * self.cells + at[0]) as usize;
        let meets = near.iter().any(|&t| self.meets(t, at));
        contacts[cell] = if meets { Contact::Meets } else { Contact::Near };
    }

    /// For each axis that can separate the triangle from a cube, returns the gap between the two along the
    /// axis (positive if they are apart), the sum of the magnitudes of the axis' components, and the degree
    /// of the polynomials.
    fn gaps(&self, t: [usize; 3], at: [i64; 3], size: i64) -> [(f64, f64, i32); 13] {
        let half = size as f64 / 2.0;
        let [a, b, c] = t.map(|v| [0, 1, 2].map(|axis| self.approximate[v][axis] - (at[axis] as f64 + half)));
        axes(&a, &b, &c).map(|(axis, degree)| {
            let on = [a, b, c].map(|p| axis[0] * p[0] + axis[1] * p[1] + axis[2] * p[2]);
            let reach = axis[0].abs() + axis[1].abs() + axis[2].abs();
            let (low, high) = (on[0].min(on[1]).min(on[2]), on[0].max(on[1]).max(on[2]));
            ((low - half * reach).max(-high - half * reach), reach, degree)
        })
    }

    /// True if the triangle keeps more than `tolerance` away from the cube along some axis.
    fn is_clear(&self, t: [usize; 3], at: [i64; 3], size: i64, tolerance: f64) -> bool {
        let gaps = self.gaps(t, at, size);
        gaps.iter().any(|&(gap, reach, degree)| gap - tolerance * reach > SAFE * self.size.powi(degree))
    }

    /// True if the triangle meets the open cell: no axis separates them. Contact counts as separation.
    fn meets(&self, t: [usize; 3], at: [i64; 3]) -> bool {
        let bound = |degree| SAFE * self.size.powi(degree);
        let gaps = self.gaps(t, at, 1);
        if gaps.iter().any(|&(gap, _, degree)| gap > bound(degree)) {
            return false;
        }
        if gaps.iter().all(|&(gap, _, degree)| gap < -bound(degree)) {
            return true;
        }
        let corners = t.map(|v| [0, 1, 2].map(|axis| &self.exact[v][axis] - self.plane(2 * at[axis] + 1)));
        let [a, b, c] = &corners;
        !axes(a, b, c).iter().any(|(axis, _)| {
            let on = [a, b, c].map(|p| (0..3).map(|i| &axis[i] * &p[i]).sum::<BigInt>());
            let reach = &self.half * axis.iter().map(|n| BigInt::from(n.magnitude().clone())).sum::<BigInt>();
            let apart = on.iter().all(|x| *x >= reach) || on.iter().all(|x| -x >= reach);
            apart && axis.iter().any(|n| sign(n) != 0)
        })
    }

    /// True if a point of this winding number is inside.
    pub fn inside(fill: FillRule, winding: i32) -> bool {
        match fill {
            FillRule::NonZero => winding != 0,
            FillRule::EvenOdd => winding.rem_euclid(2) == 1,
            FillRule::Positive => winding > 0,
        }
    }
}

/// Returns the thirteen separating axes of a triangle and a cube, each with the degree of a measure along it.
fn axes<T>(a: &[T; 3], b: &[T; 3], c: &[T; 3]) -> [([T; 3], i32); 13]
where
    T: Clone + From<i32>,
    for<'a> &'a T: std::ops::Mul<&'a T, Output = T> + std::ops::Sub<&'a T, Output = T>,
{
    let edge = |from: &[T; 3], to: &[T; 3]| [0, 1, 2].map(|i| &to[i] - &from[i]);
    let edges = [edge(a, b), edge(b, c), edge(c, a)];
    let unit = |axis: usize| [0, 1, 2].map(|i| T::from((i == axis) as i32));
    let normal = cross(&edges[0], &edges[1]);
    std::array::from_fn(|i| match i {
        0..3 => (unit(i), 1),
        3 => (normal.clone(), 3),
        i => (cross(&edges[(i - 4) / 3], &unit((i - 4) % 3)), 2),
    })
}

/// An oracle for the winding number of points, by rays along x through a grid of bins.
pub struct PointOracle {
    vertices: Vec<[f64; 3]>,
    triangles: Vec<[usize; 3]>,
    low: [f64; 3],
    high: [f64; 3],
    bins: Vec<Vec<u32>>,
}

const BINS: usize = 256;

impl PointOracle {
    pub fn new(mesh: &TriangleMesh) -> PointOracle {
        let (low, high) = mesh.bounds();
        let mut oracle = PointOracle {
            vertices: mesh.vertices().to_vec(),
            triangles: mesh.triangles().iter().map(|t| t.map(|v| v as usize)).collect(),
            low,
            high,
            bins: vec![Vec::new(); BINS * BINS],
        };
        for (i, t) in oracle.triangles.iter().enumerate() {
            let [ys, zs] = [1, 2].map(|axis| {
                let at = t.map(|v| oracle.vertices[v][axis]);
                // The same monotone function for corners and points, so no point slips between bins.
                let bin = |x: f64| oracle.bin(axis, x);
                bin(at[0].min(at[1]).min(at[2]))..=bin(at[0].max(at[1]).max(at[2]))
            });
            for z in zs {
                for y in ys.clone() {
                    oracle.bins[z * BINS + y].push(i as u32);
                }
            }
        }
        oracle
    }

    fn bin(&self, axis: usize, x: f64) -> usize {
        let scale = (self.high[axis] - self.low[axis]) / BINS as f64;
        (((x - self.low[axis]) / scale) as usize).min(BINS - 1)
    }

    /// The winding number at `p`, or `None` on the surface.
    pub fn winding(&self, p: [f64; 3]) -> Option<i32> {
        if (0..3).any(|axis| p[axis] < self.low[axis] || p[axis] > self.high[axis]) {
            return Some(0);
        }
        let mut winding = 0;
        for &t in &self.bins[self.bin(2, p[2]) * BINS + self.bin(1, p[1])] {
            let corners = self.triangles[t as usize].map(|v| self.vertices[v]);
            let [a, b, c] = corners;
            if p[0] < a[0].min(b[0]).min(c[0]) {
                continue;
            }
            // Half-open in y and z: the ray is shifted by (0, ε, ε²).
            let sides = [(a, b), (b, c), (c, a)].map(|(from, to)| side(from, to, p));
            if sides[0] == 0 || sides[0] != sides[1] || sides[1] != sides[2] {
                continue;
            }
            match over(corners, p) {
                0 => return None,
                over if over == sides[0] => winding -= sides[0],
                _ => {}
            }
        }
        Some(winding)
    }
}

/// Returns, exactly, the side of `p`, shifted by (0, ε, ε²), relative to the line from `a` to `b` seen along
/// x.
fn side(a: [f64; 3], b: [f64; 3], p: [f64; 3]) -> i32 {
    let size = [a, b, p].iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
    let estimate = (b[1] - a[1]) * (p[2] - a[2]) - (b[2] - a[2]) * (p[1] - a[1]);
    sure(estimate, SAFE * size * size).unwrap_or_else(|| {
        let [a, b, p] = common([a, b, p]);
        let (ey, ez) = (&b[1] - &a[1], &b[2] - &a[2]);
        let side = sign(&(&ey * (&p[2] - &a[2]) - &ez * (&p[1] - &a[1])));
        [side, -sign(&ez), sign(&ey)].into_iter().find(|&s| s != 0).unwrap_or(0)
    })
}

/// Returns, exactly, the side of the triangle's plane on which `p` lies: 1 where the normal points.
pub fn over(corners: [[f64; 3]; 3], p: [f64; 3]) -> i32 {
    let [a, b, c] = corners;
    let size = corners.iter().flatten().chain(&p).fold(0.0, |most: f64, x| most.max(x.abs()));
    let edge = |to: [f64; 3]| [0, 1, 2].map(|i| to[i] - a[i]);
    let normal = cross(&edge(b), &edge(c));
    let estimate: f64 = (0..3).map(|i| normal[i] * (p[i] - a[i])).sum();
    sure(estimate, SAFE * size * size * size).unwrap_or_else(|| {
        let [a, b, c, p] = common([a, b, c, p]);
        let edge = |to: &[BigInt; 3]| [0, 1, 2].map(|i| &to[i] - &a[i]);
        let normal = cross(&edge(&b), &edge(&c));
        sign(&(0..3).map(|i| &normal[i] * (&p[i] - &a[i])).sum())
    })
}

/// Returns, exactly, the side of the triangle's plane to which (ε, ε², ε³) leads; 0 for a triangle without
/// area.
pub fn facing(corners: [[f64; 3]; 3]) -> i32 {
    let [a, b, c] = common(corners);
    let edge = |to: [BigInt; 3]| [0, 1, 2].map(|i| &to[i] - &a[i]);
    cross(&edge(b), &edge(c)).iter().map(sign).find(|&s| s != 0).unwrap_or(0)
}

/// Converts points to integers of one common unit.
fn common<const N: usize>(points: [[f64; 3]; N]) -> [[BigInt; 3]; N] {
    let points = points.map(|p| p.map(dyadic));
    let unit = points.iter().flatten().map(|x| x.1).min().unwrap();
    points.map(|p| {
        p.map(|(mantissa, exponent)| match exponent {
            i64::MAX => mantissa,
            exponent => mantissa << (exponent - unit) as usize,
        })
    })
}

/// Checks of the oracle itself, on shapes whose answers are obvious.
#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn separating_axes_agree_with_samples() {
        // Corners on a grid of half cells; the open cell (1, 2)³ is met if one of the triangle's points at
        // barycentric multiples of 1/60 lies in it, and (but for small corners of triangles) only if.
        let mut random = leafless_testkit::Random(7);
        let frame = Frame::new([0.0; 3], 4.0, 2).unwrap();
        let (mut met, mut missed, mut unsampled) = (0, 0, 0);
        for _ in 0..3000 {
            let corner = |random: &mut leafless_testkit::Random| {
                [0; 3].map(|_: i32| random.below(11) as f64 / 2.0 - 1.0)
            };
            let vertices = vec![corner(&mut random), corner(&mut random), corner(&mut random)];
            let mesh = TriangleMesh::new(vertices.clone(), vec![[0, 1, 2]]).unwrap();
            if mesh.triangles().is_empty() {
                continue;
            }
            let oracle = Oracle::new(&mesh, &frame);
            let Some(&t) = oracle.triangles.first() else { continue };
            let meets = oracle.meets(t, [1, 1, 1]);
            let sampled = (0..=60).any(|i| {
                (0..=60 - i).any(|j| {
                    let k = 60 - i - j;
                    (0..3).all(|axis| {
                        let x = vertices[0][axis] * i as f64
                            + vertices[1][axis] * j as f64
                            + vertices[2][axis] * k as f64;
                        x > 60.0 && x < 120.0
                    })
                })
            });
            assert!(meets || !sampled, "{vertices:?} meets the cell");
            met += meets as i32;
            missed += !meets as i32;
            unsampled += (meets && !sampled) as i32;
        }
        assert!(met > 200 && missed > 200 && unsampled * 50 < met, "{met} {missed} {unsampled}");
    }
}
