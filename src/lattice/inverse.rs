//! Inverses of affine maps, with proven error bounds.

use super::array::Each;
use super::{Affine, Interval, axes};

/// The inverse of an affine map, or of a composition: y = L x + o, with intervals that contain the exact
/// numbers. For a map that permutes and mirrors axes, scales them by powers of two, and translates, the
/// intervals are single numbers. For a composition of such maps they are, too, unless the sum of the offsets
/// is rounded.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Inverse {
    linear: [[Interval; 3]; 3],
    offset: [Interval; 3],
}

impl Inverse {
    /// The inverse of one map.
    pub(crate) fn of(placement: &Affine) -> Inverse {
        // The relative error of each entry of the inverse is at most 5 · 2^-53. The inverse of a monomial map
        // is exact.
        let slack = if placement.is_monomial() { 0.0 } else { 4.0 * f64::EPSILON };
        let share = Interval::between(1.0 - slack, 1.0 + slack);
        let linear =
            placement.inverse_linear().each(|row| row.each(|entry| Interval::exactly(entry).times(share)));
        let moved = placement.rows().each(|[.., t]| Interval::exactly(-t));
        Inverse { linear, offset: linear.each(|row| dot(&row, &moved)) }
    }

    /// The inverse of this map followed by another one.
    pub(crate) fn then(&self, placement: &Affine) -> Inverse {
        let next = Inverse::of(placement);
        let linear = self.linear.each(|row| axes(|j| dot(&row, &next.column(j))));
        let offset = axes(|i| dot(&self.linear[i], &next.offset).plus(self.offset[i]));
        Inverse { linear, offset }
    }

    /// The inverse image of a box, or of a point.
    pub(crate) fn image(&self, x: &[Interval; 3]) -> [Interval; 3] {
        axes(|axis| dot(&self.linear[axis], x).plus(self.offset[axis]))
    }

    /// The inverse image of a point, if its coordinates are exact doubles.
    pub(crate) fn exact_image(&self, point: [f64; 3]) -> Option<[f64; 3]> {
        let image = self.image(&point.each(Interval::exactly));
        let is_exact = image.iter().all(|c| c.lower == c.upper && c.lower.is_finite());
        is_exact.then(|| image.each(|c| c.lower))
    }

    /// Lᵀ n: converts a gradient n before the maps to a gradient after them.
    pub(crate) fn pulled_back(&self, n: &[Interval; 3]) -> [Interval; 3] {
        axes(|j| dot(n, &self.column(j)))
    }

    fn column(&self, j: usize) -> [Interval; 3] {
        self.linear.each(|row| row[j])
    }

    /// All numbers, for a fingerprint.
    pub(crate) fn numbers(&self) -> impl Iterator<Item = f64> {
        let all = self.linear.into_iter().flatten().chain(self.offset);
        all.flat_map(|interval| [interval.lower, interval.upper])
    }
}

fn dot(a: &[Interval; 3], b: &[Interval; 3]) -> Interval {
    a[0].times(b[0]).plus(a[1].times(b[1])).plus(a[2].times(b[2]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pseudo-random number that is no power of two.
    fn noise(k: u32) -> f64 {
        f64::from(k.wrapping_mul(2_654_435_761) >> 8) / f64::from(1u32 << 23) - 1.0
    }

    #[test]
    fn images_of_images_are_enclosed() {
        for k in 0..2000u32 {
            let rows = |seed: u32| axes(|i| [0, 1, 2, 3].map(|j: u32| noise(seed + 7 * i as u32 + j)));
            let (Ok(first), Ok(second)) = (Affine::new(rows(31 * k)), Affine::new(rows(31 * k + 1013)))
            else {
                continue;
            };
            // Points whose images are exact: integers under integer maps.
            let whole = |map: &Affine| Affine::new(map.rows().map(|row| row.map(|c| (8.0 * c).round())));
            let (Ok(first), Ok(second)) = (whole(&first), whole(&second)) else { continue };
            let point = axes(|axis| (100.0 * noise(k + axis as u32)).round());
            let inverse = Inverse::of(&first).then(&second);
            let image = inverse.image(&second.apply(first.apply(point)).map(Interval::exactly));
            for axis in 0..3 {
                assert!(image[axis].contains(point[axis]), "{first:?} {second:?} {point:?}: {image:?}");
                assert!(image[axis].width() < 1e-6, "{first:?} {second:?}: {image:?}");
            }
        }
    }

    #[test]
    fn nothing_is_rounded_where_axes_change_places() {
        let map =
            Affine::new([[0.0, -2.0, 0.0, 0.125], [0.25, 0.0, 0.0, -3.0], [0.0, 0.0, 1.0, 0.0]]).unwrap();
        let inverse = Inverse::of(&map).then(&Affine::translation([0.5, 0.0, 1.0]).unwrap());
        assert_eq!(inverse.exact_image([0.5, -2.0, 4.0]), Some([4.0, 0.0625, 3.0]));
        // Half of 0.1 from 0.3125 is no double.
        assert_eq!(inverse.exact_image([0.1, -2.0, 4.0]), None);
    }
}
