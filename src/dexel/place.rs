//! Positions along a ray.
//!
//! A position lies in a *gap*: gap g reaches from the centre of cell g − 1, which it excludes, to the centre
//! of cell g, which it includes. The gap of a position determines the centres below the position. Rounding
//! keeps the gap.

use bytemuck::{Pod, Zeroable};

/// The number of fixed-point units in an edge of the universe.
pub(crate) const EDGE_UNITS: u32 = 1 << 31;

/// A position along a ray, measured from the universe's lower face.
pub(crate) trait Place:
    Copy + PartialOrd + PartialEq + Send + Sync + core::fmt::Debug + 'static
{
    /// The lower face.
    const LOW: Self;

    /// The upper face of a universe of 2^depth cells.
    fn high(depth: u8) -> Self;

    /// The place nearest to `x` cells from the lower face (0 to the number of cells of an axis) in a gap.
    /// `gap` is the gap of `x` or, as far as `x` was rounded, a neighbouring one.
    fn rounded_in(x: f64, gap: u32, depth: u8) -> Self;

    /// The place nearest to `x` cells from the lower face in the same gap.
    #[inline(always)]
    fn rounded(x: f64, depth: u8) -> Self {
        Self::rounded_in(x, gap(x) as u32, depth)
    }

    /// The distance from the lower face, in cells.
    fn cells(self, depth: u8) -> f64;

    /// The gap.
    fn gap(self, depth: u8) -> u32;

    /// Returns whether the place has the same bits as all places that are equal to it.
    fn is_plain(self) -> bool;
}

/// The gap of a position in cells: the first cell whose centre is not below the position.
#[inline(always)]
pub(crate) fn gap(x: f64) -> i64 {
    -crate::lattice::exact::floor(0.5 - x)
}

/// The position nearest to `x` cells in a gap of a universe of `cells` cells, and not outside it.
#[inline(always)]
pub(crate) fn within(x: f64, gap: i32, cells: f64) -> f64 {
    let centre = f64::from(gap) + 0.5;
    let x = if x <= centre - 1.0 { (centre - 1.0).next_up() } else { x.min(centre) };
    x.clamp(0.0, cells)
}

impl Place for f64 {
    const LOW: f64 = 0.0;

    #[inline(always)]
    fn high(depth: u8) -> f64 {
        f64::from(1u32 << depth)
    }

    #[inline(always)]
    fn rounded_in(x: f64, gap: u32, depth: u8) -> f64 {
        // Zero has one sign, so that equal places have equal bits.
        within(x, gap as i32, f64::high(depth)) + 0.0
    }

    #[inline(always)]
    fn rounded(x: f64, _: u8) -> f64 {
        x + 0.0
    }

    #[inline(always)]
    fn cells(self, _: u8) -> f64 {
        self
    }

    #[inline(always)]
    fn gap(self, _: u8) -> u32 {
        // (Arrays from a file may contain any numbers.)
        gap(self.clamp(0.0, f64::from(EDGE_UNITS))) as u32
    }

    #[inline(always)]
    fn is_plain(self) -> bool {
        self.to_bits() != (-0.0f64).to_bits()
    }
}

impl Place for u32 {
    const LOW: u32 = 0;

    #[inline(always)]
    fn high(_: u8) -> u32 {
        EDGE_UNITS
    }

    #[inline(always)]
    fn rounded_in(x: f64, beyond: u32, depth: u8) -> u32 {
        let unit = 1u32 << (31 - depth);
        let nearest = (x * f64::from(unit) + 0.5) as u32;
        // Only a position next to a centre may leave its gap.
        let low = if beyond == 0 { 0 } else { (beyond * unit).wrapping_sub(unit / 2) + 1 };
        let high = if beyond >> depth != 0 { EDGE_UNITS } else { beyond * unit + unit / 2 };
        nearest.clamp(low, high)
    }

    #[inline(always)]
    fn cells(self, depth: u8) -> f64 {
        f64::from(self) * (1.0 / f64::from(1u32 << (31 - depth)))
    }

    #[inline(always)]
    fn gap(self, depth: u8) -> u32 {
        // The first k with (2 k + 1) half cells at least as high.
        let half = 1u32 << (30 - depth);
        // (Arrays from a file may contain any numbers.)
        self.saturating_add(half - 1) >> (31 - depth)
    }

    #[inline(always)]
    fn is_plain(self) -> bool {
        true
    }
}

/// The stored form of the part of a ray between two places.
pub(crate) trait Span: Pod + Send + Sync + core::fmt::Debug + PartialEq {
    type Place: Place;

    fn new(ends: [Self::Place; 2]) -> Self;

    fn ends(self) -> [Self::Place; 2];
}

/// Start and length in units of 2^-31 edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct FixedSpan {
    pub start: u32,
    pub length: u32,
}

/// Start and end in cells. (Start and length would not determine the end exactly.)
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct DoubleSpan {
    pub start: f64,
    pub end: f64,
}

impl Span for FixedSpan {
    type Place = u32;

    #[inline(always)]
    fn new([start, end]: [u32; 2]) -> FixedSpan {
        FixedSpan { start, length: end - start }
    }

    #[inline(always)]
    fn ends(self) -> [u32; 2] {
        // Arrays from a file may contain any numbers.
        [self.start, self.start.wrapping_add(self.length)]
    }
}

impl Span for DoubleSpan {
    type Place = f64;

    #[inline(always)]
    fn new([start, end]: [f64; 2]) -> DoubleSpan {
        DoubleSpan { start, end }
    }

    #[inline(always)]
    fn ends(self) -> [f64; 2] {
        [self.start, self.end]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_keeps_the_gap() {
        for depth in [1, 5, 10, 20] {
            let cells = f64::from(1u32 << depth);
            for k in [0, 1, (1u32 << depth) - 1] {
                let centre = f64::from(k) + 0.5;
                for x in [centre.next_down(), centre, centre.next_up(), centre + 0.25, centre - 0.4999] {
                    let g = gap(x);
                    assert_eq!(g as u32, k + u32::from(x > centre), "x {x}");
                    let place = u32::rounded(x, depth);
                    assert_eq!(place.gap(depth), g as u32, "x {x} depth {depth}");
                    assert_eq!(gap(place.cells(depth)), g);
                    let unit = cells / f64::from(EDGE_UNITS);
                    assert!((place.cells(depth) - x).abs() <= unit);
                    assert_eq!(u32::rounded(place.cells(depth), depth), place);
                }
            }
            assert_eq!(u32::rounded(cells, depth), EDGE_UNITS);
            assert_eq!(u32::rounded(0.0, depth), 0);
            assert_eq!((gap(0.0), EDGE_UNITS.gap(depth)), (0, 1 << depth));
        }
        assert_eq!(within(3.0, 4, 8.0), 3.5f64.next_up());
        assert_eq!(within(9.0, 8, 8.0), 8.0);
        assert_eq!(within(-3.0, 0, 8.0), 0.0);
        assert_eq!(within(4.6, 4, 8.0), 4.5);
    }
}
