//! Compares cut cubes with exact arithmetic.
//!
//! The oracle divides the cube into tetrahedra and cuts these by one plane after the other. Corners are
//! integers over a common denominator, so that nothing is rounded before the last sums, which have 200
//! fractional bits.

extern crate std;

use super::*;
use crate::lattice::PAIRS;
use crate::lattice::axes;
use alloc::vec::Vec;
use num_bigint::BigInt;
use num_traits::{Signed, ToPrimitive, Zero};
use std::println;

/// The number of fractional bits of sums.
const POINT: usize = 200;

/// x, y and z times w, and w > 0.
type Corner = [BigInt; 4];

/// Integers in proportion to doubles.
fn integers<const N: usize>(values: [f64; N]) -> [BigInt; N] {
    let parts = values.map(|x| {
        let (bits, magnitude) = (x.to_bits(), x.to_bits() & ((1 << 52) - 1));
        match bits >> 52 & 0x7FF {
            0 => (x < 0.0, magnitude, -1074),
            biased => (x < 0.0, magnitude | 1 << 52, biased as i32 - 1075),
        }
    });
    let least = parts.iter().filter(|part| part.1 != 0).map(|part| part.2).min().unwrap_or(0);
    parts.map(|(negative, magnitude, exponent)| match magnitude {
        0 => BigInt::zero(),
        _ => {
            let shifted = BigInt::from(magnitude) << (exponent - least) as usize;
            if negative { -shifted } else { shifted }
        }
    })
}

/// Appends the parts of a tetrahedron with n · x ≤ offset.
fn clip_tetrahedron(plane: &[BigInt; 4], corners: [Corner; 4], out: &mut Vec<[Corner; 4]>) {
    let value =
        |p: &Corner| (0..3).fold(-(&plane[3] * &p[3]), |sum: BigInt, axis| sum + &plane[axis] * &p[axis]);
    let mut inner = Vec::new();
    let mut outer = Vec::new();
    for p in corners {
        let at = value(&p);
        if at.is_positive() { outer.push((p, at)) } else { inner.push((p, at)) }
    }
    // The inner end has a value ≤ 0 and the outer one a value > 0, both multiplied by the corner's w.
    let between = |a: usize, b: usize| {
        let ((p, at_p), (q, at_q)) = (&inner[a], &outer[b]);
        [0, 1, 2, 3].map(|i| at_q * &p[i] - at_p * &q[i])
    };
    let inside = |a: usize| inner[a].0.clone();
    match inner.len() {
        0 => {}
        1 => out.push([inside(0), between(0, 0), between(0, 1), between(0, 2)]),
        2 => {
            // A prism between two triangles.
            let [a, b] = [0, 1].map(|k| [inside(k), between(k, 0), between(k, 1)]);
            out.push([a[0].clone(), a[1].clone(), a[2].clone(), b[2].clone()]);
            out.push([a[0].clone(), a[1].clone(), b[1].clone(), b[2].clone()]);
            out.push([a[0].clone(), b[0].clone(), b[1].clone(), b[2].clone()]);
        }
        3 => {
            let (a, b): ([Corner; 3], [Corner; 3]) = (axes(inside), axes(|k| between(k, 0)));
            out.push([a[0].clone(), a[1].clone(), a[2].clone(), b[2].clone()]);
            out.push([a[0].clone(), a[1].clone(), b[1].clone(), b[2].clone()]);
            out.push([a[0].clone(), b[0].clone(), b[1].clone(), b[2].clone()]);
        }
        _ => out.push([0, 1, 2, 3].map(inside)),
    }
}

/// Volume, first and second moments, in units of 2^-[`POINT`].
#[derive(Clone)]
struct Exactly([BigInt; 10]);

impl Exactly {
    fn of(moments: &CubeMoments) -> [f64; 10] {
        let [x, y, z] = moments.first;
        let [xx, yy, zz, xy, xz, yz] = moments.second;
        [moments.volume, x, y, z, xx, yy, zz, xy, xz, yz]
    }

    /// The moments of the cube's points on the inner sides of planes.
    fn cut(halves: &[Half]) -> Exactly {
        let planes: Vec<[BigInt; 4]> = halves
            .iter()
            .map(|half| {
                let [a, b, c] = half.normal;
                integers([a, b, c, half.offset])
            })
            .collect();
        // For each order of the axes, a path along the edges from one corner to the opposite one.
        let mut pieces = Vec::new();
        for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
            let mut corner = [-1, -1, -1, 1];
            let mut path = std::vec![corner];
            for axis in order {
                corner[axis] = 1;
                path.push(corner);
            }
            pieces.push([0, 1, 2, 3].map(|k| path[k].map(BigInt::from)));
        }
        for plane in &planes {
            let mut kept = Vec::new();
            for piece in pieces {
                clip_tetrahedron(plane, piece, &mut kept);
            }
            pieces = kept;
        }
        let mut sums: [BigInt; 10] = Default::default();
        for corners in &pieces {
            let p = corners.each_ref().map(|c| axes(|i| (&c[i] << POINT) / &c[3]));
            let d = [1, 2, 3].map(|k| axes(|i| &p[k][i] - &p[0][i]));
            let minor = |i: usize, j: usize| &d[1][i] * &d[2][j] - &d[1][j] * &d[2][i];
            let determinant = &d[0][0] * minor(1, 2) + &d[0][1] * minor(2, 0) + &d[0][2] * minor(0, 1);
            let volume: BigInt = (determinant.abs() / 6) >> (2 * POINT);
            let s = axes(|i| p.iter().map(|p| &p[i]).sum::<BigInt>());
            for i in 0..3 {
                sums[1 + i] += (&volume * &s[i] / 4) >> POINT;
            }
            for (k, (i, j)) in PAIRS.into_iter().enumerate() {
                let products: BigInt = p.iter().map(|p| &p[i] * &p[j]).sum();
                sums[4 + k] += (&volume * (products + &s[i] * &s[j]) / 20) >> (2 * POINT);
            }
            sums[0] += volume;
        }
        Exactly(sums)
    }

    fn complement(&self) -> Exactly {
        let one = || BigInt::from(1) << POINT;
        let whole = [24, 0, 0, 0, 8, 8, 8, 0, 0, 0].map(|thirds| one() * thirds / 3);
        let mut rest = whole;
        rest.iter_mut().zip(&self.0).for_each(|(rest, taken)| *rest -= taken);
        Exactly(rest)
    }

    fn volume(&self) -> f64 {
        difference(0.0, &self.0[0]).abs()
    }

    /// The greatest difference from the computed moments.
    fn error(&self, moments: &CubeMoments) -> f64 {
        let errors = Exactly::of(moments).into_iter().zip(&self.0).map(|(a, b)| difference(a, b).abs());
        errors.fold(0.0, f64::max)
    }
}

/// a − b, with b in units of 2^-[`POINT`].
fn difference(a: f64, b: &BigInt) -> f64 {
    let [a, one] = integers([a, 1.0]);
    // (The smaller of the two exponents belongs to `one` or to `a`; only their ratio counts.)
    let scaled: BigInt = (a << POINT) / one - b;
    (scaled.clone() >> (POINT - 120)).to_f64().unwrap_or(f64::NAN) / 2f64.powi(120)
}

#[test]
fn the_oracle_knows_simple_cuts() {
    let half = |normal, offset| Half { normal, offset };
    let all = Exactly::cut(&[]);
    assert!(all.error(&CubeMoments::FULL) < 1e-15 && all.complement().error(&CubeMoments::EMPTY) < 1e-30);
    let eighth = Exactly::cut(&[
        half([1.0, 0.0, 0.0], 0.0),
        half([0.0, 3.0, 0.0], 0.0),
        half([0.0, 0.0, -1e-300], 0.0),
    ]);
    let known = CubeMoments {
        volume: 1.0,
        first: [-0.5, -0.5, 0.5],
        second: [1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0, 0.25, -0.25, -0.25],
    };
    assert!(eighth.error(&known) < 1e-16);
    // A corner: the simplex of edge 1 at (1, 1, 1), with its centroid a quarter of the way inside.
    let corner = Exactly::cut(&[half([-1.0; 3], -2.0)]);
    assert!(difference(1.0 / 6.0, &corner.0[0]).abs() < 1e-16);
    assert!(difference(0.125, &corner.0[1]).abs() < 1e-16);
}

pub(super) struct Random(pub(super) u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let x = (self.0 ^ self.0 >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let x = (x ^ x >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        x ^ x >> 31
    }

    pub(super) fn below(&mut self, end: u64) -> u64 {
        self.next() % end
    }

    /// Between −1 and 1.
    pub(super) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// 10^-3 to 10^-17.
    pub(super) fn tiny(&mut self) -> f64 {
        10f64.powf(-3.0 - 14.0 * self.unit().abs())
    }

    fn component(&mut self) -> f64 {
        let sign = if self.below(2) == 0 { 1.0 } else { -1.0 };
        match self.below(12) {
            0 | 1 => 0.0,
            2 | 3 => sign * self.tiny(),
            4 => sign,
            5 => sign * 0.5,
            6 => sign * 0.48,
            _ => self.unit(),
        }
    }

    pub(super) fn normal(&mut self, others: &[Slab]) -> [f64; 3] {
        let mut normal = [self.component(), self.component(), self.component()];
        if let Some(other) = others.last() {
            match self.below(8) {
                // Parallel, equal, nearly parallel, rotated.
                0 => normal = other.normal,
                1 => normal = other.normal.map(|c| -c),
                2 => normal = other.normal.map(|c| c * (1.0 + self.unit() * self.tiny())),
                3 => normal = other.normal.map(|c| self.unit() * self.tiny() - c),
                4 => normal = [other.normal[1], -other.normal[0], other.normal[2]],
                _ => {}
            }
        }
        normal
    }

    /// An offset for a plane with this normal.
    pub(super) fn offset(&mut self, normal: [f64; 3], range: f64) -> f64 {
        let sign = |random: &mut Self| [1.0, -1.0, 0.0][random.below(3) as usize];
        let signs = [sign(self), sign(self), sign(self)];
        // Through the centre, or that of an edge or of a face, or a corner.
        let through = (signs[0] * normal[0] + signs[1] * normal[1]) + signs[2] * normal[2];
        match self.below(10) {
            0 | 1 => through,
            2 => through + range * self.unit() * self.tiny(),
            3 => through.next_up(),
            4 => [range, -range][self.below(2) as usize],
            5 => 1.5 * range * self.unit(),
            _ => range * self.unit(),
        }
    }

    pub(super) fn slab(&mut self, others: &[Slab]) -> Slab {
        let mut normal = self.normal(others);
        let scale = match self.below(12) {
            0 => 2f64.powi(900),
            1 => 2f64.powi(-900),
            2 => 2f64.powi(-1060),
            3 => 1e-3,
            _ => 1.0,
        };
        let scaled = normal.map(|c| c * scale);
        if scaled.iter().map(|c| c.abs()).sum::<f64>().is_finite() {
            normal = scaled;
        }
        let range: f64 = normal.iter().map(|c| c.abs()).sum();
        let one = self.offset(normal, range);
        let other = match self.below(6) {
            0 => one,
            1 => one + range * self.tiny(),
            2 => f64::INFINITY,
            _ => self.offset(normal, range),
        };
        let (mut inner, outer) = (one.min(other), one.max(other));
        match self.below(40) {
            0 => inner = f64::NAN,
            1 => inner = f64::NEG_INFINITY,
            _ => {}
        }
        Slab { normal, inner, outer }
    }

    fn enclosure(&mut self) -> Enclosure {
        let nothing = Slab { normal: [0.0; 3], inner: f64::NEG_INFINITY, outer: f64::INFINITY };
        let mut slabs = [nothing; 3];
        for k in 0..self.below(4) as usize {
            slabs[k] = self.slab(&slabs[..k]);
        }
        let shift = self.below(3) as usize;
        slabs.rotate_left(shift);
        let join = if self.below(2) == 0 { SlabJoin::All } else { SlabJoin::Any };
        Enclosure { slabs, join, cone: f64::INFINITY }
    }
}

/// The moments of the points that are inside by an enclosure, and of the points that are not outside by it.
fn exact_bounds(enclosure: &Enclosure) -> (Exactly, Exactly) {
    let of = |slabs: [Slab; 3], outer: bool| {
        let (mut halves, mut is_known) = (Vec::new(), false);
        for Slab { normal, inner, outer: last } in slabs.into_iter().filter(|s| s.normal != [0.0; 3]) {
            is_known = true;
            let offset = if outer { last } else { inner };
            // No number is less or greater than NaN.
            let is_nothing = if outer { false } else { offset.is_nan() };
            if is_nothing || offset == f64::NEG_INFINITY {
                return None;
            }
            if offset.is_finite() {
                halves.push(Half { normal, offset });
            }
        }
        if !is_known && !outer { None } else { Some(Exactly::cut(&halves)) }
    };
    let empty = || Exactly::cut(&[]).complement();
    let both = |slabs| [false, true].map(|outer| of(slabs, outer).unwrap_or_else(empty));
    match enclosure.join {
        SlabJoin::All => both(enclosure.slabs).into(),
        SlabJoin::Any => {
            let [low, high] = both(enclosure.slabs.map(|slab| slab.complement()));
            (high.complement(), low.complement())
        }
    }
}

/// Checks enclosures, and prints the greatest errors by the number of slabs.
fn bounds_hold(seed: u64, count: u64, make: fn(&mut Random) -> Enclosure) {
    let mut random = Random(seed);
    let mut greatest = [0.0f64; 4];
    for _ in 0..count {
        let enclosure = make(&mut random);
        let (low, high) = bounds(&enclosure);
        let (inner, outer) = exact_bounds(&enclosure);
        let at = std::format!("{enclosure:?}\n{low:?}\n{high:?}");
        if enclosure.slabs.iter().all(|slab| !slab.inner.is_nan()) {
            let error = inner.error(&low).max(outer.error(&high));
            let known = enclosure.slabs.iter().filter(|slab| slab.normal != [0.0; 3]).count();
            greatest[known] = greatest[known].max(error);
            assert!(error <= ERROR / 2.0, "{error}: {at}");
        } else {
            // Bounds may be too wide, but not too narrow.
            assert!(difference(low.volume, &inner.0[0]) <= ERROR, "{at}");
            assert!(difference(high.volume, &outer.0[0]) >= -ERROR, "{at}");
        }
        let (between, doubt) = (outer.volume() - inner.volume(), doubt(&enclosure));
        assert!(doubt <= 8.0 && doubt >= between * (1.0 - 1e-14) - 1e-14, "{doubt}, {between}: {at}");
        let (low_rest, high_rest) = bounds(&enclosure.complement());
        let near = |a: &CubeMoments, b: &CubeMoments| {
            Exactly::of(a).into_iter().zip(Exactly::of(b)).all(|(a, b)| (a - b).abs() <= 2.0 * ERROR)
        };
        assert!(near(&low_rest, &high.complement()) && near(&high_rest, &low.complement()), "{at}");
    }
    println!("{count} enclosures: greatest errors by the number of slabs {greatest:?}");
}

/// Three planes near one point, two or all of them nearly parallel: rounding bends faces.
fn nearly_parallel(random: &mut Random) -> Enclosure {
    let point = [random.unit(), random.unit(), random.unit()];
    let first = [random.component(), random.component(), random.component()];
    let close = random.tiny();
    let mut slab = |k: u64| {
        let turned = if k < 2 || random.below(2) == 0 {
            first.map(|c| c * (1.0 + close * random.unit()) + 1e-3 * close * random.unit())
        } else {
            random.normal(&[])
        };
        let normal = if random.below(2) == 0 { turned } else { turned.map(|c| -c) };
        let offset = (normal[0] * point[0] + normal[1] * point[1]) + normal[2] * point[2];
        let outer = offset + if random.below(2) == 0 { 0.0 } else { random.tiny() * close };
        Slab { normal, inner: offset, outer }
    };
    let slabs = [slab(0), slab(1), slab(2)];
    let join = if random.below(2) == 0 { SlabJoin::All } else { SlabJoin::Any };
    Enclosure { slabs, join, cone: f64::INFINITY }
}

fn any(random: &mut Random) -> Enclosure {
    random.enclosure()
}

#[test]
fn bounds_are_exact_but_for_the_error() {
    bounds_hold(1, 4_000, any);
    bounds_hold(3, 4_000, nearly_parallel);
}

#[test]
#[ignore = "minutes"]
fn a_hundred_thousand_bounds() {
    bounds_hold(2, 100_000, any);
    bounds_hold(4, 100_000, nearly_parallel);
}

#[test]
fn no_number_is_too_large() {
    let values =
        [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, f64::MIN_POSITIVE, 5e-324, 1.0, 0.0, -1.0];
    let mut random = Random(5);
    for _ in 0..100_000 {
        let mut value = || values[random.below(9) as usize];
        let mut slab = || Slab { normal: [value(), value(), value()], inner: value(), outer: value() };
        let slabs = [slab(), slab(), slab()];
        let join = if random.below(2) == 0 { SlabJoin::All } else { SlabJoin::Any };
        let enclosure = Enclosure { slabs, join, cone: 0.0 };
        let (low, high) = bounds(&enclosure);
        for moments in [low, high].iter().map(Exactly::of) {
            assert!((-ERROR..=8.0 + ERROR).contains(&moments[0]), "{enclosure:?}");
            assert!(moments.iter().all(|m| m.abs() <= 8.0 + ERROR), "{enclosure:?}");
        }
        assert!((0.0..=8.0).contains(&doubt(&enclosure)), "{enclosure:?}");
    }
}
