//! The intersection of a plane with a cube, and the part of it that belongs to a solid with known slabs.
//!
//! The figure is seen along the axis nearest to the plane's normal: a polygon in the square [-1, 1]². Each of
//! its sides is known up to a margin. A figure that is clipped a margin further in is contained in the true
//! one, and a figure that is clipped a margin further out contains it. That holds however nearly parallel
//! sides are.

use super::enclosure::{Enclosure, Slab, SlabJoin};
use super::polygon::{Line, Polygon};
use crate::lattice::Each;
use crate::lattice::{Interval, axes};

/// A bound of the error of a side's linear function at any point of the square: some dozen roundings of
/// numbers below 8.
const MARGIN: f64 = 1.0 / (1u64 << 45) as f64;

/// A bound of the error of an area, including the rounding of corners.
const ROUNDING: f64 = 1.0 / (1u64 << 43) as f64;

/// A bound of the width of an area's interval where only rounding separates its ends.
pub(crate) const SETTLED: f64 = 1.0 / (1u64 << 38) as f64;

/// The length below which normals may have lost digits.
const SHORTEST: f64 = f64::from_bits((1023 - 900) << 52);

/// The area of the whole square.
const ALL: f64 = 4.0;

/// A plane in a cube: the points with x[k] = −(a x[i] + b x[j] + c) for the axes i, j and k.
pub(crate) struct Section {
    order: [usize; 3],
    plane: [f64; 3],
}

impl Section {
    /// Makes the plane with these axes and a, b and c. The slopes a and b are at most 1 in magnitude and
    /// rounded once; c may have an error of 2^-50. With slopes of zero the plane is parallel to a face, and
    /// must meet the closed cube.
    pub(crate) fn new(order: [usize; 3], [a, b]: [f64; 2], c: f64) -> Section {
        let c = if [a, b] == [0.0; 2] { c.clamp(-1.0, 1.0) } else { c };
        Section { order, plane: [a, b, c] }
    }

    /// Returns whether the plane is parallel to a face.
    fn is_parallel(&self) -> bool {
        self.plane[..2] == [0.0; 2]
    }

    /// Bounds of the area of the intersection of plane and cube, as seen along the axis, in squares of the
    /// half edge. If the plane is parallel to a face, the bounds are exact.
    pub(crate) fn whole(&self) -> Interval {
        self.clipped(&[])
    }

    /// Bounds of the area of the part that belongs to a solid with this enclosure.
    pub(crate) fn of(&self, enclosure: &Enclosure) -> Interval {
        let whole = self.whole();
        if enclosure.slabs.iter().all(|slab| slab.normal == [0.0; 3]) {
            return Interval::between(0.0, whole.upper);
        }
        let known = match enclosure.join {
            SlabJoin::All => self.clipped(&enclosure.slabs),
            // The union is the complement of the complements' intersection.
            SlabJoin::Any => whole.minus(self.clipped(&enclosure.slabs.each(|slab| slab.complement()))),
        };
        let upper = known.upper.clamp(0.0, whole.upper);
        Interval::between(known.lower.clamp(0.0, upper), upper)
    }

    /// Bounds of the area of the part on the inner side of all slabs.
    fn clipped(&self, slabs: &[Slab]) -> Interval {
        let [inner, outer] = [false, true].each(|outer| {
            self.rectangle(slabs, outer).unwrap_or_else(|| match self.figure(slabs, outer) {
                Some(figure) => area(&figure, if outer { ROUNDING } else { -ROUNDING }),
                // A polygon with more corners than there is space for gives no bound.
                None => f64::from(u8::from(outer)) * ALL,
            })
        });
        Interval::between(inner.min(outer), outer)
    }

    /// The area of `figure`, if plane and slabs are parallel to faces of the cube: a rectangle, where numbers
    /// that are doubles are not rounded.
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
                // The whole plane lies on one side, unless rounding leaves that open.
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
        let [a, b] = sides.each(|[low, high]| Interval::exactly(high.max(low)).minus(Interval::exactly(low)));
        let area = a.times(b);
        Some(if outer { area.upper.min(ALL) } else { area.lower })
    }

    /// A figure that contains the part on the inner side of all slabs, or that is contained in it.
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

/// The slab with its normal scaled to a sum of magnitudes of 1. If its numbers are not usable, the result
/// leaves everything open.
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

/// The area of a polygon with an error added; the empty polygon and the whole square have no error.
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

    /// A plane z = a x + b y and a slab without thickness that crosses it along y = end at a slope of 2^-k.
    /// Two roundings give the true area, which must lie between the bounds.
    #[test]
    fn bounds_hold_however_nearly_parallel_a_slab_is() {
        let mut state = 1u64;
        let mut next = |bits: u32| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> (64 - bits)) as f64 / (1u64 << bits) as f64
        };
        for round in 0..60_000i32 {
            let k = round % 60;
            // The product with `end` is a double, and so is the sum with b as long as the slope is not too
            // small.
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
                // The width is at most the margin divided by the slope.
                assert!(found.width() < 2f64.powi(k - 40), "{k} {a} {b} {end} {join:?}: {truth} {found:?}");
            }
        }
    }
}
