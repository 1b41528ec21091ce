//! Where the lattice lies in model space.

use super::exact::{Expansion, floor, sign_of_sum, two_diff, two_product, two_sum};
use super::{Interval, MAX_DEPTH, valid};
use crate::error::{Error, MeshError};

/// Where a tree lies: the cube `[origin, origin + edge]³` in model units, cut into 2^depth cells per axis.
///
/// The lattice planes are the *real* numbers origin + i·edge/2^depth, whether or not they are representable;
/// comparisons with them are exact.
///
/// ```
/// use leafless::Frame;
/// let frame = Frame::new([0.0; 3], 1.0, 4)?;
/// assert_eq!(frame.cell_size(), 0.0625);
/// assert_eq!(frame.cell_at(0, 0.3), Some(4));
/// assert_eq!(frame.cell_at(0, 1.1), None);
/// # Ok::<(), leafless::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    origin: [f64; 3],
    edge: f64,
    depth: u8,
    // Derived from the two above, kept because every query needs them.
    cell: f64,
    per_unit: f64,
}

impl Frame {
    /// A universe with its lower corner at `origin` (model units; each coordinate zero or of a magnitude
    /// between 2^-256 and 2^256), of edge length `edge` (2^-256 to 2^256) and `depth` (1 to [`MAX_DEPTH`])
    /// levels.
    ///
    /// # Errors
    /// [`Error::Argument`] names the parameter that is out of range.
    pub fn new(origin: [f64; 3], edge: f64, depth: u8) -> Result<Frame, Error> {
        valid::numbers("origin", &origin)?;
        valid::length("edge", edge)?;
        if !(1..=MAX_DEPTH).contains(&depth) {
            return Err(Error::Argument { name: "depth", problem: "must be 1 to 20" });
        }
        let cells = (1u32 << depth) as f64;
        Ok(Frame { origin: origin.map(|c| c + 0.0), edge, depth, cell: edge / cells, per_unit: cells / edge })
    }

    /// The default frame of a shape with the bounds `min`, `max`: the cube of edge L·(1 + 1/32) around its
    /// centre, L being its longest extent; the same universe at every depth.
    ///
    /// # Errors
    /// [`MeshError::NoExtent`] if L is zero; [`Error::Argument`] if min > max on an axis, if a bound is not a
    /// finite number in range, or lies so far from the origin that the cube around it cannot be told in
    /// doubles.
    pub fn around(min: [f64; 3], max: [f64; 3], depth: u8) -> Result<Frame, Error> {
        valid::ordered("bounds", min, max)?;
        let extent = |axis: usize| max[axis] - min[axis];
        let longest = extent(0).max(extent(1)).max(extent(2));
        if longest == 0.0 {
            return Err(MeshError::NoExtent.into());
        }
        let edge = longest * (1.0 + 1.0 / 32.0);
        let origin = [0, 1, 2].map(|axis| (min[axis] + extent(axis) / 2.0) - edge / 2.0);
        let frame = Frame::new(origin, edge, depth)?;
        let top = 2 * frame.cells() as i64;
        if (0..3).any(|axis| frame.side(axis, min[axis], 0) < 0 || frame.side(axis, max[axis], top) > 0) {
            let problem = "so far from the origin that doubles cannot resolve them";
            return Err(Error::Argument { name: "bounds", problem });
        }
        Ok(frame)
    }

    /// The same universe with another depth.
    ///
    /// # Errors
    /// [`Error::Argument`] if `depth` is not 1 to [`MAX_DEPTH`].
    pub fn with_depth(&self, depth: u8) -> Result<Frame, Error> {
        Frame::new(self.origin, self.edge, depth)
    }

    /// Lower corner of the universe, in model units.
    pub fn origin(&self) -> [f64; 3] {
        self.origin
    }

    /// Edge length of the universe, in model units.
    pub fn edge(&self) -> f64 {
        self.edge
    }

    /// Levels below the universe; the finest lattice has 2^depth cells per axis.
    #[inline]
    pub fn depth(&self) -> u8 {
        self.depth
    }

    /// Cells per axis of the finest level, 2^depth.
    #[inline]
    pub fn cells(&self) -> u32 {
        1 << self.depth
    }

    /// Edge length of a finest cell, in model units: edge / 2^depth, exactly.
    pub fn cell_size(&self) -> f64 {
        self.cell
    }

    /// Whether both lie on one universe; the depths may differ.
    pub fn same_universe(&self, other: &Frame) -> bool {
        self.origin == other.origin && self.edge == other.edge
    }

    /// The tightest interval of doubles that contains lattice plane `i` (0 ≤ i ≤ 2^depth) of `axis`.
    pub fn plane(&self, axis: usize, i: u32) -> Interval {
        // `i` has at most 21 bits, so the product has an error term; three doubles make up the plane.
        let (product, product_error) = two_product(i as f64, self.cell);
        let (sum, sum_error) = two_sum(self.origin[axis], product);
        let rounded = sum + (sum_error + product_error);
        match sign_of_sum(&[sum, sum_error, product_error, -rounded]) {
            0 => Interval::exactly(rounded),
            1 => Interval { lower: rounded, upper: rounded.next_up() },
            _ => Interval { lower: rounded.next_down(), upper: rounded },
        }
    }

    /// `x − (origin + k·cell/2)` on an axis: how far a coordinate lies from a lattice plane (even k) or a
    /// plane of cell centres (odd k).
    pub(crate) fn offset(&self, axis: usize, x: f64, k: i64) -> Expansion {
        Expansion::sum(self.offset_terms(axis, x, k))
    }

    /// Exact sign of `x − (origin + k·cell/2)` on `axis`: even k are lattice planes, odd k cell centres.
    pub(crate) fn side(&self, axis: usize, x: f64, k: i64) -> i32 {
        sign_of_sum(&self.offset_terms(axis, x, k))
    }

    #[inline(always)]
    fn offset_terms(&self, axis: usize, x: f64, k: i64) -> [f64; 4] {
        let (high, low) = two_diff(x, self.origin[axis]);
        let (product, error) = two_product(k as f64, 0.5 * self.cell);
        [low, -error, high, -product]
    }

    /// `(x − origin) / cell` on `axis`: lattice coordinates, with a relative error below 2^-51.
    #[inline(always)]
    pub(crate) fn scaled(&self, axis: usize, x: f64) -> f64 {
        (x - self.origin[axis]) * self.per_unit
    }

    /// Index along `axis` of the finest cell that contains the model coordinate `x`; the universe's upper
    /// face belongs to the last cell. `None` outside the universe and for NaN. Exact for every double.
    #[inline]
    pub fn cell_at(&self, axis: usize, x: f64) -> Option<u32> {
        let (cell, sure) = self.cell_nearby(axis, x);
        if sure && cell < self.cells() as u64 { Some(cell as u32) } else { self.cell_at_exactly(axis, x) }
    }

    /// Indices of the finest cell that contains a model point; see [`cell_at`](Self::cell_at).
    #[inline(always)]
    pub fn cell_of(&self, point: [f64; 3]) -> Option<[u32; 3]> {
        let (x, x_sure) = self.cell_nearby(0, point[0]);
        let (y, y_sure) = self.cell_nearby(1, point[1]);
        let (z, z_sure) = self.cell_nearby(2, point[2]);
        // Their number is a power of two, so one comparison tells whether all three are cells.
        if x_sure & y_sure & z_sure && (x | y | z) < self.cells() as u64 {
            return Some([x as u32, y as u32, z as u32]);
        }
        self.cell_of_exactly(point)
    }

    /// First and last finest cell along `axis` whose interior meets `[min, max]` (numbers, min ≤ max), and
    /// whether some of that lies outside of the universe; `None` if all of it does.
    pub(crate) fn cells_between(&self, axis: usize, min: f64, max: f64) -> Option<(u32, u32, bool)> {
        let cells = self.cells();
        // Far outside the comparison with a plane needs no exactness, and must not overflow.
        const FAR: f64 = f64::from_bits((1023 + 400) << 52);
        let (min, max) = (min.clamp(-FAR, FAR), max.clamp(-FAR, FAR));
        let (low, high) = (0, 2 * cells as i64);
        // What has thickness and only touches the universe has no cell in common with it; what has none may
        // lie in the face.
        let thick = (min < max) as i32;
        if self.side(axis, max, low) < thick || self.side(axis, min, high) > -thick {
            return None;
        }
        let (below, above) = (self.side(axis, min, low) < 0, self.side(axis, max, high) > 0);
        let first = if below { 0 } else { self.cell_at(axis, min)? };
        let mut last = if above { cells - 1 } else { self.cell_at(axis, max)? };
        if last > first && self.side(axis, max, 2 * last as i64) == 0 {
            last -= 1;
        }
        Some((first, last, below || above))
    }

    /// The rounded-down lattice coordinate of `x`, and whether rounding errors cannot have changed it. What
    /// is outside of the universe comes out as a number that is no cell, or as unsure.
    #[inline(always)]
    fn cell_nearby(&self, axis: usize, x: f64) -> (u64, bool) {
        // Adding this leaves the nearest integer in the low bits (and NaN and the far outside elsewhere).
        const SHIFT: f64 = (3u64 << 51) as f64;
        // Inside the universe the scaled coordinate is at most 2^20 and its error below 2^-31.
        const SURE: f64 = 0.5 - 1.0 / (1u64 << 30) as f64;
        let scaled = self.scaled(axis, x) - 0.5;
        let shifted = scaled + SHIFT;
        let cell = shifted.to_bits().wrapping_sub(SHIFT.to_bits());
        (cell, (scaled - (shifted - SHIFT)).abs() < SURE)
    }

    #[cold]
    fn cell_of_exactly(&self, point: [f64; 3]) -> Option<[u32; 3]> {
        Some([self.cell_at(0, point[0])?, self.cell_at(1, point[1])?, self.cell_at(2, point[2])?])
    }

    #[cold]
    fn cell_at_exactly(&self, axis: usize, x: f64) -> Option<u32> {
        let cells = self.cells() as i64;
        let scaled = self.scaled(axis, x);
        if !(scaled > -1.0 && scaled < cells as f64 + 1.0) {
            return None;
        }
        let nearest = floor(scaled + 0.5);
        match self.side(axis, x, 2 * nearest) {
            // Exactly on a plane: the cell above it, or the last one on the universe's upper face.
            0 if nearest == cells => Some(cells as u32 - 1),
            0 | 1 if (0..cells).contains(&nearest) => Some(nearest as u32),
            -1 if (1..=cells).contains(&nearest) => Some(nearest as u32 - 1),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offsets_are_exact() {
        let frame = Frame::new([0.1; 3], 0.7, 20).unwrap();
        for k in [0i64, 1, 3, 1_000_001, 2_097_152] {
            let plane = 0.1 + k as f64 * (0.7 / 2_097_152.0);
            for x in [plane.next_down(), plane, plane.next_up()] {
                assert_eq!(frame.offset(1, x, k).sign(), frame.side(1, x, k));
            }
        }
    }

    #[test]
    fn what_is_refused() {
        for (origin, edge, depth) in [
            ([f64::NAN, 0.0, 0.0], 1.0, 4),
            ([0.0, f64::INFINITY, 0.0], 1.0, 4),
            ([0.0, 0.0, -1e-300], 1.0, 4),
            ([0.0; 3], 0.0, 4),
            ([0.0; 3], -1.0, 4),
            ([0.0; 3], f64::NAN, 4),
            ([0.0; 3], 1e-100, 4),
            ([0.0; 3], 1.0, 0),
            ([0.0; 3], 1.0, 21),
        ] {
            assert!(Frame::new(origin, edge, depth).is_err(), "{origin:?} {edge} {depth}");
        }
        assert!(Frame::around([1.0; 3], [1.0; 3], 5).is_err());
        assert!(Frame::around([f64::NAN; 3], [1.0; 3], 5).is_err());
    }

    #[test]
    fn a_frame_around_a_part_is_centred_and_depth_free() {
        let frame = Frame::around([0.0, 10.0, 0.0], [32.0, 26.0, 8.0], 7).unwrap();
        assert_eq!((frame.edge(), frame.origin()), (33.0, [-0.5, 1.5, -12.5]));
        assert!(frame.same_universe(&Frame::around([0.0, 10.0, 0.0], [32.0, 26.0, 8.0], 8).unwrap()));
    }

    #[test]
    fn cells_are_exact_next_to_every_plane() {
        // Neither the cell size nor the planes are representable.
        let frame = Frame::new([0.1, -7.3, 1e5 / 3.0], 10.0 / 3.0, 20).unwrap();
        for axis in 0..3 {
            for i in [0u32, 1, 2, 3, 12_345, 524_288, 1_048_575, 1_048_576] {
                let plane = frame.plane(axis, i);
                assert!(plane.upper == plane.lower || plane.upper == plane.lower.next_up());
                for x in [plane.lower.next_down(), plane.lower, plane.upper, plane.upper.next_up()] {
                    let below = frame.side(axis, x, 2 * i as i64) < 0;
                    let on = frame.side(axis, x, 2 * i as i64) == 0;
                    let expected = match (below, on) {
                        (true, _) if i == 0 => None,
                        (true, _) => Some(i - 1),
                        (_, true) if i == frame.cells() => Some(i - 1),
                        _ if i == frame.cells() => None,
                        _ => Some(i),
                    };
                    assert_eq!(frame.cell_at(axis, x), expected, "axis {axis} plane {i} x {x:e}");
                }
            }
        }
        assert_eq!(frame.cell_at(0, f64::NAN), None);
        assert_eq!(frame.cell_at(0, f64::INFINITY), None);
        assert_eq!(frame.cell_at(0, -1e300), None);
    }
}
