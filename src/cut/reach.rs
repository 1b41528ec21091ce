//! The extent of a solid in a cell whose enclosure is known.
//!
//! Both answers are linear programs over the cube [-1, 1]³ and one to three half-spaces. Plain doubles choose
//! a solution among all bases, and intervals prove it. Any multipliers that are not negative bound the
//! program from above (weak duality), and any point that satisfies the constraints bounds it from below.

use super::{Enclosure, SlabJoin};
use crate::lattice::Each;
use crate::lattice::Interval;
use crate::lattice::axes;

/// The distances by which offsets are moved inward, as shares of the normal's range.
const MARGINS: [f64; 3] = [1.0 / (1u64 << 50) as f64, 1.0 / (1u64 << 46) as f64, 1.0 / (1u64 << 30) as f64];

/// The points with n · x ≤ offset.
#[derive(Debug, Clone, Copy)]
struct Half {
    normal: [f64; 3],
    offset: f64,
    /// The sum of the magnitudes of the normal's components.
    range: f64,
}

/// Up to three half-spaces.
#[derive(Debug, Clone, Copy)]
struct Halves {
    all: [Half; 3],
    count: usize,
}

impl Halves {
    const NONE: Halves = Halves { all: [Half { normal: [0.0; 3], offset: 0.0, range: 0.0 }; 3], count: 0 };

    fn push(&mut self, half: Half) {
        self.all[self.count] = half;
        self.count += 1;
    }

    fn one(half: Half) -> Halves {
        let mut halves = Halves::NONE;
        halves.push(half);
        halves
    }

    fn as_slice(&self) -> &[Half] {
        &self.all[..self.count]
    }

    /// The bound that [`dual`] proves, up to rounding.
    fn estimate(&self, rows: &[[f64; 3]], multipliers: [f64; 3], direction: [f64; 3]) -> f64 {
        let (mut bound, mut rest) = (0.0, direction);
        for (k, half) in self.as_slice().iter().enumerate() {
            bound += multipliers[k] * (half.offset / half.range);
            (0..3).for_each(|i| rest[i] -= multipliers[k] * rows[k][i]);
        }
        bound + magnitude(rest)
    }

    /// Returns whether a point is proven to lie in all half-spaces, or in the interior of all of them.
    fn hold(&self, point: [f64; 3], strictly: bool) -> bool {
        self.as_slice().iter().all(|half| {
            let terms = axes(|i| Interval::exactly(half.normal[i]).times(Interval::exactly(point[i])));
            let most = terms[0].plus(terms[1]).plus(terms[2]).upper;
            most < half.offset || !strictly && most == half.offset
        })
    }

    /// The rows of the program's constraints, normalised to length 1: the half-spaces, then the axes.
    fn rows(&self) -> ([[f64; 3]; 6], usize) {
        let mut rows = [[0.0; 3]; 6];
        for (row, half) in rows.iter_mut().zip(self.as_slice()) {
            *row = half.normal.each(|c| c / half.range);
        }
        for axis in 0..3 {
            rows[self.count + axis][axis] = 1.0;
        }
        (rows, self.count + 3)
    }
}

/// Returns an upper bound of `direction` · x over the points of the solid in a cell. x is measured from the
/// cell's centre in half edges. The bound is at most the sum of the direction's magnitudes, and −∞ if the
/// cell contains no point of the solid.
pub(crate) fn upper(enclosure: &Enclosure, direction: [f64; 3]) -> f64 {
    let known = slabs(enclosure, true);
    match enclosure.join {
        SlabJoin::All => {
            let mut halves = Halves::NONE;
            known.filter(|half| half.offset.is_finite()).for_each(|half| halves.push(half));
            greatest(&halves, direction)
        }
        SlabJoin::Any => {
            let of = |half: Half| {
                let halves = if half.offset.is_finite() { Halves::one(half) } else { Halves::NONE };
                greatest(&halves, direction)
            };
            // Without a slab nothing is known.
            known.map(of).reduce(f64::max).unwrap_or_else(|| greatest(&Halves::NONE, direction))
        }
    }
}

/// Returns a point of the closed cell that is a limit of points of the solid in the open cell. It lies as far
/// along `direction` as a search in doubles finds.
pub(crate) fn witness(enclosure: &Enclosure, direction: [f64; 3]) -> Option<[f64; 3]> {
    let mut known = slabs(enclosure, false).peekable();
    known.peek()?;
    match enclosure.join {
        SlabJoin::All => {
            let mut halves = Halves::NONE;
            for half in known {
                match half.offset {
                    f64::INFINITY => {}
                    offset if offset.is_finite() => halves.push(half),
                    _ => return None,
                }
            }
            farthest(&halves, direction)
        }
        SlabJoin::Any => {
            let points = known.filter_map(|half| match half.offset {
                f64::INFINITY => farthest(&Halves::NONE, direction),
                offset if offset.is_finite() => farthest(&Halves::one(half), direction),
                _ => None,
            });
            points.max_by(|a, b| dot(*a, direction).total_cmp(&dot(*b, direction)))
        }
    }
}

/// The half-spaces of the outer or of the inner ends of an enclosure's slabs.
fn slabs(enclosure: &Enclosure, outer: bool) -> impl Iterator<Item = Half> {
    enclosure.slabs.into_iter().filter(|slab| slab.normal != [0.0; 3]).map(move |slab| Half {
        normal: slab.normal,
        offset: if outer { slab.outer } else { slab.inner },
        range: slab.normal.iter().map(|c| c.abs()).sum(),
    })
}

/// An upper bound of `direction` · x over the cube's points in all half-spaces; −∞ if there are none.
fn greatest(halves: &Halves, direction: [f64; 3]) -> f64 {
    let (rows, count) = halves.rows();
    let mut best = (magnitude(direction), [0.0; 3]);
    bases(&rows[..count], |basis, columns| {
        let mut multipliers = [0.0f64; 3];
        for (&row, column) in basis.iter().zip(columns).filter(|(row, _)| **row < halves.count) {
            multipliers[row] = dot(direction, column).max(0.0);
        }
        let bound = halves.estimate(&rows, multipliers, direction);
        if bound < best.0 {
            best = (bound, multipliers);
        }
    });
    if is_empty(halves, &rows[..count]) {
        return f64::NEG_INFINITY;
    }
    dual(halves, best.1, direction).min(magnitude(direction))
}

/// Returns whether multipliers prove that no point of the cube lies in all half-spaces (Farkas' lemma).
fn is_empty(halves: &Halves, rows: &[[f64; 3]]) -> bool {
    // The minors of four rows are the coefficients of their linear dependence.
    for set in (0u32..1 << rows.len()).filter(|set| set.count_ones() == 4) {
        let mut of = [0; 4];
        (0..rows.len()).filter(|row| set >> row & 1 != 0).zip(&mut of).for_each(|(row, place)| *place = row);
        let [a, b, c, d] = of.each(|row| rows[row]);
        let (ab, cd) = (cross(a, b), cross(c, d));
        let minors = [dot(b, cd), -dot(a, cd), dot(d, ab), -dot(c, ab)];
        for sign in [1.0, -1.0] {
            let mut multipliers = [0.0f64; 3];
            for (row, minor) in of.into_iter().zip(minors).filter(|(row, _)| *row < halves.count) {
                multipliers[row] = (sign * minor).max(0.0);
            }
            if halves.estimate(rows, multipliers, [0.0; 3]) < 0.0 && dual(halves, multipliers, [0.0; 3]) < 0.0
            {
                return true;
            }
        }
    }
    false
}

/// A proven upper bound of `direction` · x over the cube's points in all half-spaces, by these multipliers of
/// normals with range 1. For the direction 0, the bound is negative only if there are no such points.
fn dual(halves: &Halves, multipliers: [f64; 3], direction: [f64; 3]) -> f64 {
    let (mut bound, mut rest) = (Interval::exactly(0.0), direction.each(Interval::exactly));
    for (half, multiplier) in halves.as_slice().iter().zip(multipliers) {
        let multiplier = multiplier / half.range;
        if !(multiplier > 0.0 && multiplier.is_finite()) {
            continue;
        }
        let multiplier = Interval::exactly(multiplier);
        bound = bound.plus(multiplier.times(Interval::exactly(half.offset)));
        for (rest, c) in rest.iter_mut().zip(half.normal) {
            *rest = rest.minus(multiplier.times(Interval::exactly(c)));
        }
    }
    for rest in rest {
        bound = bound.plus(Interval::exactly((-rest.lower).max(rest.upper)));
    }
    bound.upper
}

/// A point of the cube that is a limit of interior points of all half-spaces, as far along `direction` as the
/// search finds.
fn farthest(halves: &Halves, direction: [f64; 3]) -> Option<[f64; 3]> {
    // Offsets are moved inward by more than the error of a solution; where planes are nearly parallel, by
    // more.
    let inside = MARGINS
        .into_iter()
        .find_map(|margin| vertex(halves, direction, margin).filter(|p| halves.hold(*p, true)))?;
    // The set is convex with a non-empty interior, so that each of its points is such a limit.
    let on = vertex(halves, direction, 0.0).filter(|p| halves.hold(*p, false));
    Some(on.unwrap_or(inside))
}

/// The farthest vertex along `direction`, up to rounding, of the cube's part in all half-spaces with their
/// offsets moved inward.
fn vertex(halves: &Halves, direction: [f64; 3], margin: f64) -> Option<[f64; 3]> {
    let (rows, count) = halves.rows();
    let offsets = halves.all.each(|half| half.offset / half.range - margin);
    // A rounded vertex may lie slightly outside; the proof comes later.
    let slack = 0.5 * margin.max(MARGINS[0]);
    let mut best: Option<(f64, [f64; 3])> = None;
    bases(&rows[..count], |basis, columns| {
        let free = basis.iter().filter(|row| **row >= halves.count).count();
        for signs in 0..1u32 << free {
            // The axes come last.
            let value = |place: usize| match basis[place] {
                row if row < halves.count => offsets[row],
                _ if signs >> (2 - place) & 1 != 0 => 1.0,
                _ => -1.0,
            };
            let [a, b, c] = [value(0), value(1), value(2)];
            let point = axes(|i| a * columns[0][i] + b * columns[1][i] + c * columns[2][i]);
            let point = point.each(|c| if c.abs() <= 1.0 + slack { c.clamp(-1.0, 1.0) } else { f64::NAN });
            let is_inside = |row: usize| dot(rows[row], point) <= offsets[row] + slack;
            let reach = dot(point, direction);
            // (A comparison with NaN is false.)
            if reach > best.map_or(f64::NEG_INFINITY, |best| best.0) && (0..halves.count).all(is_inside) {
                best = Some((reach, point));
            }
        }
    });
    best.map(|best| best.1)
}

/// Calls `visit` with every three linearly independent rows, and the columns of their inverse.
fn bases(rows: &[[f64; 3]], mut visit: impl FnMut([usize; 3], [[f64; 3]; 3])) {
    for i in 0..rows.len() {
        for j in i + 1..rows.len() {
            for k in j + 1..rows.len() {
                let columns = [cross(rows[j], rows[k]), cross(rows[k], rows[i]), cross(rows[i], rows[j])];
                let inverse = 1.0 / dot(rows[i], columns[0]);
                if inverse.is_finite() {
                    visit([i, j, k], columns.each(|column| column.each(|c| inverse * c)));
                }
            }
        }
    }
}

/// The greatest dot product with a point of the cube.
fn magnitude(a: [f64; 3]) -> f64 {
    a[0].abs() + a[1].abs() + a[2].abs()
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cut::Slab;
    use leafless_testkit::Random;

    /// The law of an enclosure at one point: whether it is certainly inside, and whether it may be inside.
    fn at(enclosure: &Enclosure, point: [f64; 3]) -> (bool, bool) {
        let known = || enclosure.slabs.iter().filter(|slab| slab.normal != [0.0; 3]);
        let (inside, outside) =
            (|s: &Slab| dot(s.normal, point) < s.inner, |s: &Slab| dot(s.normal, point) > s.outer);
        match enclosure.join {
            SlabJoin::All => (known().all(inside), !known().any(outside)),
            SlabJoin::Any => (known().any(inside), !known().all(outside)),
        }
    }

    #[test]
    fn bounds_hold_for_all_points_and_meet() {
        // Integers, so that all sums are exact and planes meet in all degenerate ways.
        let mut random = Random(5);
        let mut whole = |end: u64| random.below(end) as f64;
        let grid = || (0..13).map(|i| f64::from(i) / 6.0 - 1.0);
        let (mut empty, mut exact) = (0, 0);
        for round in 0..4000 {
            let mut slabs = [Slab { normal: [0.0; 3], inner: 0.0, outer: 0.0 }; 3];
            let count = 1 + round % 3;
            for slab in &mut slabs[..count] {
                slab.normal = [0; 3].map(|_| whole(7) - 3.0);
                slab.inner = whole(33) / 4.0 - 4.0;
                let width = whole(3) * whole(3) / 4.0;
                slab.outer = slab.inner + width;
                match whole(12) as u32 {
                    0 => slab.inner = f64::NEG_INFINITY,
                    1 => slab.outer = f64::INFINITY,
                    _ => {}
                }
            }
            let join = if whole(2) == 0.0 { SlabJoin::All } else { SlabJoin::Any };
            let enclosure = Enclosure { slabs, join, cone: f64::INFINITY };
            if slabs.iter().all(|slab| slab.normal == [0.0; 3]) {
                assert_eq!(
                    (upper(&enclosure, [1.0, 0.0, 0.0]), witness(&enclosure, [1.0, 0.0, 0.0])),
                    (1.0, None)
                );
                continue;
            }
            let mut direction = [0.0; 3];
            direction[whole(3) as usize] = 2.0 * whole(2) - 1.0;
            let bound = upper(&enclosure, direction);
            assert!(bound <= 1.0);
            let found = witness(&enclosure, direction);
            let mut inside = f64::NEG_INFINITY;
            for [x, y, z] in grid().flat_map(|x| grid().flat_map(move |y| grid().map(move |z| [x, y, z]))) {
                let (is_inside, may_be) = at(&enclosure, [x, y, z]);
                let reach = dot([x, y, z], direction);
                // (Grid points are rounded.)
                let is_clear = slabs.iter().all(|s| (dot(s.normal, [x, y, z]) - s.outer).abs() > 1e-12);
                assert!(
                    !may_be || !is_clear || reach <= bound + 1e-12,
                    "{enclosure:?} {direction:?} {bound}"
                );
                if is_inside && is_clear {
                    inside = inside.max(reach);
                }
            }
            // No point that is certainly inside lies farther than the witness.
            let reach = found.map_or(f64::NEG_INFINITY, |point| dot(point, direction));
            assert!(inside <= reach + 1e-7 && reach <= bound, "{enclosure:?} {direction:?} {found:?}");
            if let Some(point) = found {
                // Slightly further inside, all inequalities are strict.
                let loose = Enclosure {
                    slabs: slabs.map(|s| Slab { inner: s.inner + 1e-12, outer: f64::INFINITY, ..s }),
                    ..enclosure
                };
                assert!(
                    at(&loose, point).0 && point.iter().all(|c| c.abs() <= 1.0),
                    "{enclosure:?} {point:?}"
                );
            }
            if slabs.iter().all(|slab| slab.inner == slab.outer) {
                exact += 1;
                let tight = |bound: f64, reach: f64| bound == reach || bound - reach < 1e-7;
                if bound == f64::NEG_INFINITY {
                    empty += 1;
                    assert_eq!(found, None, "{enclosure:?}");
                } else if found.is_none() {
                    // A set without interior is proven empty once its planes are moved slightly inward.
                    let less = slabs.map(|s| Slab { outer: s.outer - 1e-6, ..s });
                    assert_eq!(upper(&Enclosure { slabs: less, ..enclosure }, direction), f64::NEG_INFINITY);
                } else {
                    assert!(tight(bound, reach), "{enclosure:?} {direction:?} {bound} {found:?}");
                }
            }
        }
        assert!(empty > 50 && exact > 500, "{empty} {exact}");
    }
}
