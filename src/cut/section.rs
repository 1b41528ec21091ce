//! What a plane has in common with a cube, and how much of that belongs to a solid whose slabs are known.
//!
//! The figure is seen along the axis to which the plane's normal is nearest: a polygon in the square [-1,
//! 1]². Each of its sides is known up to a margin. A figure that is clipped a margin further in is contained
//! in the true one, and one that is clipped a margin further out contains it; that holds however nearly
//! parallel sides are.

use super::enclosure::{Enclosure, Slab, SlabJoin};
use super::polygon::{Line, Polygon};
use crate::lattice::{Interval, axes};

/// More than what a side's linear function is off by, at any point of the square: some dozen roundings of
/// numbers below 8.
const MARGIN: f64 = 1.0 / (1u64 << 45) as f64;

/// More than what an area is off by, and the rounding of corners makes of it.
const ROUNDING: f64 = 1.0 / (1u64 << 43) as f64;

/// More than the width of an area's bounds where nothing but rounding keeps them apart.
pub(crate) const SETTLED: f64 = 1.0 / (1u64 << 38) as f64;

/// Shorter normals may have lost digits.
const SHORTEST: f64 = f64::from_bits((1023 - 900) << 52);

/// All of the square.
const ALL: f64 = 4.0;

/// A plane in a cube: the points with x[k] = −(a x[i] + b x[j] + c) for the axes i, j and k.
pub(crate) struct Section {
    order: [usize; 3],
    plane: [f64; 3],
}

impl Section {
    /// The plane with these axes and a, b and c. The slopes a and b are at most 1 in magnitude, and they are
    /// rounded once; c may be off by 2^-50. With slopes of zero the plane is parallel to a face, and it meets
    /// the closed cube.
    pub(crate) fn new(order: [usize; 3], [a, b]: [f64; 2], c: f64) -> Section {
        let c = if [a, b] == [0.0; 2] { c.clamp(-1.0, 1.0) } else { c };
        Section { order, plane: [a, b, c] }
    }

    /// Whether the plane is parallel to a face.
    fn is_parallel(&self) -> bool {
        self.plane[..2] == [0.0; 2]
    }

    /// Bounds of the area of what plane and cube have in common, in squares of the half edge, as it is seen.
    /// If the plane is parallel to a face, they are exact.
    pub(crate) fn whole(&self) -> Interval {
        self.clipped(&[])
    }

    /// Bounds of the area of what belongs to a solid of which this is known.
    pub(crate) fn of(&self, enclosure: &Enclosure) -> Interval {
        let whole = self.whole();
        if enclosure.slabs.iter().all(|slab| slab.normal == [0.0; 3]) {
            return Interval::between(0.0, whole.upper);
        }
        let known = match enclosure.join {
            SlabJoin::All => self.clipped(&enclosure.slabs),
            // The union is what lies outside of the complements' intersection.
            SlabJoin::Any => whole.minus(self.clipped(&enclosure.slabs.map(|slab| slab.complement()))),
        };
        let upper = known.upper.clamp(0.0, whole.upper);
        Interval::between(known.lower.clamp(0.0, upper), upper)
    }

    /// Bounds of the area of what lies on the inner side of all slabs.
    fn clipped(&self, slabs: &[Slab]) -> Interval {
        let [inner, outer] = [false, true].map(|outer| {
            self.rectangle(slabs, outer).unwrap_or_else(|| match self.figure(slabs, outer) {
                Some(figure) => area(&figure, if outer { ROUNDING } else { -ROUNDING }),
                // A polygon with more corners than there is place for tells nothing.
                None => f64::from(u8::from(outer)) * ALL,
            })
        });
        Interval::between(inner.min(outer), outer)
    }

    /// The area of a figure as the next function has it, if plane and slabs are parallel to faces of the
    /// cube: a rectangle, of which nothing is rounded that is a double.
    fn rectangle(&self, slabs: &[Slab], outer: bool) -> Option<f64> {
        if !self.is_parallel() {
            return None;
        }
        let mut sides = [[-1.0f64, 1.0]; 2];
        for Slab { normal, inner, outer: end } in slabs.iter().filter(|slab| slab.normal != [0.0; 3]) {
            let mut places = (0..3).filter(|&place| normal[self.order[place]] != 0.0);
            let (Some(place), None) = (places.next(), places.next()) else { return None };
            let (length, offset) = (normal[self.order[place]].abs(), if outer { *end } else { *inner });
            if !(SHORTEST..=f64::MAX).contains(&length) || inner.is_nan() || end.is_nan() {
                return None;
            }
            if offset >= length {
                continue;
            }
            if offset <= -length {
                return Some(0.0);
            }
            let share = Interval::exactly(offset).over(Interval::exactly(length));
            let share = if outer { share.upper } else { share.lower };
            let is_lower = normal[self.order[place]] < 0.0;
            match (place, is_lower) {
                // All of the plane lies on one side, unless rounding leaves that open.
                (2, _) => {
                    let height = if is_lower { self.plane[2] } else { -self.plane[2] };
                    if height > share + if outer { MARGIN } else { -MARGIN } {
                        return Some(0.0);
                    }
                }
                (_, true) => sides[place][0] = sides[place][0].max(-share),
                (_, false) => sides[place][1] = sides[place][1].min(share),
            }
        }
        let [a, b] = sides.map(|[low, high]| Interval::exactly(high.max(low)).minus(Interval::exactly(low)));
        let area = a.times(b);
        Some(if outer { area.upper.min(ALL) } else { area.lower })
    }

    /// A figure that contains what lies on the inner side of all slabs, or that is contained in it.
    fn figure(&self, slabs: &[Slab], outer: bool) -> Option<Polygon> {
        let margin = if outer { MARGIN } else { -MARGIN };
        let mut figure = Polygon::SQUARE;
        if !self.is_parallel() {
            for side in [1.0, -1.0] {
                figure.clip(&Line::new(&[0, 1, 2], &self.plane, &[0.0, 0.0, side], 1.0 + margin))?;
            }
        }
        for slab in slabs.iter().filter(|slab| slab.normal != [0.0; 3]) {
            let Slab { normal, inner, outer: end } = normalised(slab);
            let offset = if outer { end } else { inner };
            figure.clip(&Line::new(&self.order, &self.plane, &normal, offset + margin))?;
        }
        Some(figure)
    }
}

/// The slab with a normal of which the magnitudes have the sum 1. If its numbers tell nothing, it leaves all
/// open.
fn normalised(slab: &Slab) -> Slab {
    let range: f64 = slab.normal.iter().map(|c| c.abs()).sum();
    let is_usable = (SHORTEST..=f64::MAX).contains(&range) && !slab.inner.is_nan() && !slab.outer.is_nan();
    if !is_usable {
        return Slab::NONE;
    }
    Slab {
        normal: axes(|axis| slab.normal[axis] / range),
        inner: slab.inner / range,
        outer: slab.outer / range,
    }
}

/// The area of a polygon and an error of it; the error of nothing, and of the whole square, is none.
fn area(figure: &Polygon, error: f64) -> f64 {
    match figure.corners() {
        [] => 0.0,
        corners if corners == Polygon::SQUARE.corners() => ALL,
        _ => (figure.area() + error).clamp(0.0, ALL),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A plane z = a x + b y and a slab without thickness that crosses it along y = end at a slope of 2^-k:
    /// the true area is told by two roundings, and lies between the bounds.
    #[test]
    fn bounds_hold_however_nearly_parallel_a_slab_is() {
        let mut state = 1u64;
        let mut next = |bits: u32| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> (64 - bits)) as f64 / (1u64 << bits) as f64
        };
        for round in 0..60_000i32 {
            let k = round % 60;
            // The product with `end`, and the sum with b as long as the slope is not too small, are doubles.
            let (end, a) = (2.0 * next(12) - 1.0, next(52) - 0.5);
            let b = (next(8) - 0.5) * f64::from(u8::from(k < 30));
            let slope = (1.0 + next(12)) / 2f64.powi(k);
            let slab = Slab { normal: [a, b + slope, -1.0], inner: slope * end, outer: slope * end };
            let truth = 2.0 * (1.0 + end);
            for join in [SlabJoin::All, SlabJoin::Any] {
                let enclosure =
                    Enclosure { slabs: [slab, Slab::NONE, Slab::NONE], join, cone: f64::INFINITY };
                let found = Section::new([0, 1, 2], [-a, -b], 0.0).of(&enclosure);
                assert!(found.contains(truth), "{k} {a} {b} {end} {join:?}: {truth} {found:?}");
                // As wide as the margin over the slope.
                assert!(found.width() < 2f64.powi(k - 40), "{k} {a} {b} {end} {join:?}: {truth} {found:?}");
            }
        }
    }
}
